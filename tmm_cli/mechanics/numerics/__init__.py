"""Numbers: planar vectors, roots, interpolation, tolerances, linear equations, numbers of 31 digits."""
