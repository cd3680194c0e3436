"""Structure of a linkage, from its links and pairs: mobility, Assur groups, names of links and schemes."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
