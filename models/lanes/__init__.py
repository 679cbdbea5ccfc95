"""What compiled lane kernels share: the compiler's settings, its cache, and elementary functions."""
