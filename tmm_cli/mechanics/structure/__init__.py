"""Structure of a linkage: its mobility, pairs and Assur groups, and the names of links and of the mechanism."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
