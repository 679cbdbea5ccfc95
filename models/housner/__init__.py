"""One rigid block that rocks on a rigid base, alone or with a mass on top as one body."""
