"""The slow plain route of a wall between linear layers: scipy's DOP853 with dense events."""
