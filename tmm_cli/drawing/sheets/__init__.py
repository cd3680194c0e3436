"""Sheets of a project, with one module for each subject. `drawing/run.py` lists the sheets that a run draws."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
