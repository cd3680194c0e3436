"""Grading: variants of a task, reading of submissions, marks, and explanations of wrong answers."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
