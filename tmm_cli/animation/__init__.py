"""Web pages with moving mechanisms: the page of one mechanism, and a gallery of many mechanisms."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
