"""Loads, the force plan group by group, and the Zhukovsky lever that checks it."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
