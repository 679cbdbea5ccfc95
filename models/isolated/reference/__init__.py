"""The slow plain route of an isolated building: scipy's DOP853 with dense events."""
