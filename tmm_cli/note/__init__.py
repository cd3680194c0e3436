"""The explanatory note of a course project."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
