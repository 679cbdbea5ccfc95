"""The slow plain route of two stacked blocks: scipy's DOP853 with dense events."""
