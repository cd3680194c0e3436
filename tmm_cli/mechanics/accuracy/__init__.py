"""Accuracy of results: bounds by rounding, and sensitivity to the lengths of the file."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
