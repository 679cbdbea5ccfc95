"""Proving the diagnosis on concealed cases: answers before keys, scores with their intervals, figures."""
