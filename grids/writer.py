"""What files that are written say of their origin: commands know their own by it."""

WRITER = "rocking-study"
"""The program, with which the attribute `source` of histories, cubes and samples begins."""
WRITTEN = f"written by {WRITER}"
"""The first comment of a specimen and the attribute `history` of a motion."""
