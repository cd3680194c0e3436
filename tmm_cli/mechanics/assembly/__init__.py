"""Assembly of the Assur groups as the sketch shows them.

Groups without a closed form are followed along the driver coordinate by numerical continuation. All assemblies of a
group can be listed too.
"""

from tmm_cli.interfaces import lazy

__getattr__, __all__ = lazy(__name__, __file__)
