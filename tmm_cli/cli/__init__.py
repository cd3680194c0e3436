"""Command line: the commands parse, call and print. Heavy packages are imported when their command runs."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
