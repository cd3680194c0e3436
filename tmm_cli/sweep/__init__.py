"""Parameter sweep: quantities of a mechanism over one or two parameters, and the boundaries of the feasible region."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
