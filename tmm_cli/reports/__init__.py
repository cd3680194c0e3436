"""Records to rows, and rows to the terminal, CSV and JSON."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
