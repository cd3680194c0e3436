"""Velocity, acceleration and force plans and the Zhukovsky lever, as named vectors with scale factors.

Nothing is drawn in this package.
"""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
