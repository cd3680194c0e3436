"""Measurements of speed and accuracy against other methods of computation; used only by `tmm bench`."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
