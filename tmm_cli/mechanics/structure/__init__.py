"""Who is joined to whom: mobility, Assur groups, names of links."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
