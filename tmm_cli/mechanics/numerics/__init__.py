"""Numbers: planar vectors, roots, interpolation, tolerances, linear equations, numbers of 31 digits."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
