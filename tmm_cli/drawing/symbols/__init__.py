"""The symbols of a mechanism in one position: links, pairs, supports, wheels, cylinders, what acts on them."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
