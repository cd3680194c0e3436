"""Numerical tools: planar vectors, roots and extremes, interpolation, tolerances, linear equations, double-doubles."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
