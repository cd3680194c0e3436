"""What a sweep found: a value of every quantity at every point, how the mechanism goes there, where that changes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from tmm_cli.language import N_
from tmm_cli.mechanics.numerics import Real
from tmm_cli.sweep.grid import Axis
from tmm_cli.sweep.quantities import Shown

WORKS, LIMIT, STOPS, APART, REFUSED = range(5)  # how a mechanism goes
STATES = ("works", "limit", "stops", "apart", "refused")  # in files
WORDS = (
    N_("works"),
    N_("beyond a limit"),
    N_("does not turn fully"),
    N_("cannot be assembled"),
    N_("is refused"),
)


@dataclass(frozen=True)
class Mark:
    """Where how the mechanism goes changes: the point (as parameters are written), and how it goes before and after.

    along: the number of the parameter on whose line it was looked for. why: the limit, or what was refused.
    """

    at: tuple[float, ...]
    along: int
    before: int
    after: int
    why: str = ""


@dataclass(frozen=True, eq=False)
class Swept:
    """A sweep. state: how the mechanism goes, (points,); values: (points, quantities), SI, nan where it does not go.

    Points are in the order of sweep.grid. taped: whether a tape did it. reach: by the name of each load tabulated
    against the stroke in lengths, its last row and the stroke of each point that has one (m or rad).
    """

    axes: tuple[Axis, ...]
    shown: tuple[Shown, ...]
    points: Real
    state: Real
    why: list[str]
    values: Real
    marks: tuple[Mark, ...]
    taped: bool
    reach: Mapping[str, Sequence[tuple[float, float]]]

    @property
    def shape(self) -> tuple[int, ...]:
        return tuple(len(axis.values) for axis in self.axes)
