"""Sets of motions."""
