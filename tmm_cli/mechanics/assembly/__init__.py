"""Assembly of the groups as the sketch shows them, continuation along the driver coordinate, list of all assemblies."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
