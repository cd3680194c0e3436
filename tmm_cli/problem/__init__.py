"""Problem files: text to a linkage, with every message at its line and column."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
