"""Registry of the dyad solvers; each type of dyad has a module of its own."""

from typing import Any

from tmm_cli.mechanics.groups.group_solver import Dyad
from tmm_cli.mechanics.groups.prp import PRP
from tmm_cli.mechanics.groups.rpp import RPP
from tmm_cli.mechanics.groups.rpr import RPR
from tmm_cli.mechanics.groups.rrp import RRP
from tmm_cli.mechanics.groups.rrr import RRR

AnyDyad = Dyad[Any, Any, Any]
DYAD_SOLVERS: dict[str, type[AnyDyad]] = {dyad.type: dyad for dyad in (RRR, RRP, RPR, PRP, RPP)}
