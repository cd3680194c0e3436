"""Which stage needs which, and what they found."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
