"""What the stages are given: the numbers of a problem, with none of its words."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from tmm_cli.linkage import Linkage, Request


@dataclass(frozen=True)
class Inputs:
    """A linkage, the positions asked for, and what is allowed.

    pressure_limits: largest pressure angles on sliding and on turning links (rad); lever_limit: allowed difference of
    the lever, a share of one. extended: makes the same as double-doubles from the decimals that the numbers were
    written with; None where there are no others than the numbers themselves. sized: False while lengths are still to
    be found, as the structure alone does not need them.
    """

    linkage: Linkage
    request: Request = field(default_factory=Request)
    pressure_limits: tuple[float, float] = (math.radians(30), math.radians(45))
    lever_limit: float = 0.05
    extended: Callable[[], Inputs] | None = None
    sized: bool = True
