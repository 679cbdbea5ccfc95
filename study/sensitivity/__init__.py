"""Sensitivity of a study's outputs to the parameters it draws: Morris screening and Sobol indices."""
