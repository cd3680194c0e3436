"""Assur groups that can be solved, a module a type, and the pairs of which they are made."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
