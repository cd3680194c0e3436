"""File formats of drawings: PDF, DXF, SVG, PNG and EMF."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
