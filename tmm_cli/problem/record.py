"""A problem, ready for the stages: the linkage and what is asked of it. No YAML, no pydantic."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from tmm_cli.linkage import Linkage, Request
from tmm_cli.problem.units import UnitSystem

if TYPE_CHECKING:
    from tmm_cli.synthesis.record import Outcome


@dataclass(frozen=True)
class Synthesised:
    """What the block `synthesis` of a file gave; names: of its parameters, standard name to that in the file."""

    task: str
    outcome: Outcome
    names: Mapping[str, str]


@dataclass(frozen=True)
class Problem:
    """A problem file that has been read.

    name: of the file, without its ending; lever_limit: allowed difference of the lever, a share of one; titles: the
    file's own names of links; source: what errors found later are located with (a Tree), if there is one.
    pressure_limits: largest pressure angles on sliding and on turning links (rad); limits_set: whether the file gave
    them (then to exceed them is a failed check).
    """

    name: str
    title: str
    linkage: Linkage
    request: Request
    units: UnitSystem
    lever_limit: float = 0.05
    description: str = ""
    file: str = ""
    pressure_limits: tuple[float, float] = (math.radians(30), math.radians(45))
    limits_set: tuple[bool, bool] = (False, False)
    source: Any = field(default=None, compare=False, repr=False)
    synthesis: Synthesised | None = field(default=None, compare=False, repr=False)
    extended: Callable[[], Problem] | None = field(default=None, compare=False, repr=False)
