"""Assur groups that can be solved, one file a type. A new type in closed form is a file and a name here."""

from tmm_cli.mechanics.groups.dyads import DYAD_SOLVERS
from tmm_cli.mechanics.groups.group_solver import ClosedFormSolver
from tmm_cli.mechanics.groups.telescope import Telescope

CLOSED_FORM_SOLVERS: tuple[type[ClosedFormSolver], ...] = (*DYAD_SOLVERS.values(), Telescope)
