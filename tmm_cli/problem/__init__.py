"""Problem files: reading a text and building a linkage from it; every error names its line and column."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
