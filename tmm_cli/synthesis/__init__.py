"""Synthesis of mechanisms: dimensions from required strokes, positions or functions; enumeration of schemes."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
