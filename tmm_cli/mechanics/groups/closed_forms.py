"""Assur groups that can be solved, one file a type. A new type in closed form is a file and a name here."""

from tmm_cli.mechanics.groups.base import Closed
from tmm_cli.mechanics.groups.dyads import DYADS
from tmm_cli.mechanics.groups.telescope import Telescope

CLOSED: tuple[type[Closed], ...] = (*DYADS.values(), Telescope)
