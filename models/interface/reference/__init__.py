"""The slow plain route of a wall between two layers: scipy's DOP853 with dense events."""
