"""Register of the solvers in closed form. For a new type of Assur group write a module and add its class here."""

from tmm_cli.mechanics.groups.dyads import DYAD_SOLVERS
from tmm_cli.mechanics.groups.group_solver import ClosedFormSolver
from tmm_cli.mechanics.groups.telescope import Telescope

CLOSED_FORM_SOLVERS: tuple[type[ClosedFormSolver], ...] = (*DYAD_SOLVERS.values(), Telescope)
