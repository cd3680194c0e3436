"""A mechanism over its parameters: what comes of many variants, and where they cease to be mechanisms."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
