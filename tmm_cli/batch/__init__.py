"""Batches of linkages that differ only in their numbers, variants whose numbers are given later, and parallel jobs."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
