"""Loads, reactions of the Assur groups, friction, and the Zhukovsky lever that checks the balancing moment."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
