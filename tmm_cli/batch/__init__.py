"""Many linkages of one kind at once: a batch of linkages, or variants whose numbers are given later; and
parallel work.
"""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
