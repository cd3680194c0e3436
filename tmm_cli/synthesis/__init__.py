"""Synthesis: lengths from what a mechanism must do, a module or a package a task."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
