"""The law of motion: what drives the machine, the flywheel, balancing."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
