"""Dynamics of machines: motors, law of motion, flywheel, single runs, balancing."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
