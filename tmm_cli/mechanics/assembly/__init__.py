"""Choosing the assembly of a sketch, following it, and finding all of them."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
