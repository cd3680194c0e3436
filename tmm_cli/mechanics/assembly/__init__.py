"""Selection of the assembly that the sketch shows, continuation along the driver coordinate, and listing of
assemblies.
"""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
