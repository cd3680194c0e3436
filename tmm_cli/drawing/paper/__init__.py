"""Drawing on paper: record of a drawing, texts, labels, note blocks, charts, dimension lines.

Independent of mechanisms.
"""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
