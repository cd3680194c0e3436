"""Large sheets to hand in: drawings and tables arranged in a frame with a title block."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
