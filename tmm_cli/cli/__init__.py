"""Command line of `tmm`.

Commands only parse arguments, call other packages and print. Heavy packages are imported when their command runs.
"""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
