"""Tables of results, and their output to the terminal, to CSV and spreadsheet files and to result.json."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
