"""Solvers of Assur groups, one module for each type, and the constraint equations of pairs."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
