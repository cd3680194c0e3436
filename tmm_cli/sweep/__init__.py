"""Sweeps: quantities of a mechanism over one or two parameters, and the borders of the feasible region."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
