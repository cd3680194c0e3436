"""A mechanism that turns on a page: what the results say at places close together, and a script that moves it."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
