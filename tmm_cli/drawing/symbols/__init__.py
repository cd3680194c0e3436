"""Symbols of the parts of a mechanism: links, pairs, supports, gears, cams, cylinders, load elements."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
