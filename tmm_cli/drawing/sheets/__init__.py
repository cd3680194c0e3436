"""Sheets of a project, one subject in each module. `drawing/run.py` lists those that a run draws."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
