"""Grading: variants of a task, submissions of students, marks, and explanations of mistakes."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
