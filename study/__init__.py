"""One study: blocks run by dask, the block store, the cube, maps, figures and provenance."""
