"""Drawing on paper, independent of mechanisms: marks, texts, labels, note blocks, charts and dimension lines."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
