"""One file a command: parse, call, print. Heavy packages are imported inside, when their command runs."""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
