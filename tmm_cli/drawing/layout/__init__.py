"""Large sheets to hand in: drawings and tables packed into a frame with its title block."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
