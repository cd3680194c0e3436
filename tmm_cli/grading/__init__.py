"""Grading: variants of a task, what students hand in, how right it is, and what went wrong where it is not."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
