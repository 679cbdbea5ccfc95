"""A wall and a block on top, with a no-tension visco-elastic layer under each."""
