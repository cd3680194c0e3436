"""Measurements of the product against other ways to compute the same results; used by `tmm bench` only."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
