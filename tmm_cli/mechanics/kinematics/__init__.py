"""Motion, range of the driver, strokes, pressure angles."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
