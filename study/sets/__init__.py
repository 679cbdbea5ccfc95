"""Sets of motions: what a cube with an axis `motion` says of fragility, of growing intensity and of measures."""
