"""Motion of links and points, range of the driver, strokes, pressure angles, instantaneous centres."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
