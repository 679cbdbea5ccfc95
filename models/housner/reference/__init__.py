"""The slow plain routes of one block: scipy's DOP853 with dense events, and the paper's Newmark rule."""
