"""Stages of the analysis of a mechanism (structure, assembly, motion, forces, ...), and their results."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
