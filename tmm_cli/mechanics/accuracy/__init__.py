"""Accuracy of results: bounds of rounding errors, and sensitivity to the lengths in the file."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
