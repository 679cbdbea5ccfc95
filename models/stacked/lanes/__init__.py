"""Two stacked blocks in compiled lanes."""
