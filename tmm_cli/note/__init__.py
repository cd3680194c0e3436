"""Explanatory note of a course project: the calculation in sentences, formulas, tables and figures."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
