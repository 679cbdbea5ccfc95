"""A rigid body, or a chain of storeys, on rubber bearings in shear."""
