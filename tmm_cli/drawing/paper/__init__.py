"""What goes on paper: the record of a drawing, texts, labels, blocks, charts, dimension lines. Knows no mechanism."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
