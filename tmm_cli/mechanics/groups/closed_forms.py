"""Register of the group solvers in closed form. A new type is a module and an entry here."""

from tmm_cli.mechanics.groups.dyads import DYAD_SOLVERS
from tmm_cli.mechanics.groups.group_solver import ClosedFormSolver
from tmm_cli.mechanics.groups.telescope import Telescope

CLOSED_FORM_SOLVERS: tuple[type[ClosedFormSolver], ...] = (*DYAD_SOLVERS.values(), Telescope)
