"""Degrees of freedom beyond the rotation, lane by lane: sliding, free flight, bending of the wall.

A lane in one of these never moves in the vector loop, so that a lane without them pays nothing.
"""
