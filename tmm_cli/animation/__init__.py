"""Web pages with moving mechanisms: a page for one mechanism, and a gallery of many."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
