"""Two rigid blocks, one on the other, that rock on a rigid base and on each other."""
