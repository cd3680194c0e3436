"""Many linkages of one kind at once: a batch at places of the driver, or variants whose numbers come later."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
