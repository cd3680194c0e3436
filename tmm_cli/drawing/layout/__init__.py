"""Large sheets for a course project: drawings and tables arranged within a frame with a title block."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
