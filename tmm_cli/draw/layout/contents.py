"""Which drawings stand on which large sheet, and how large they usually are; a further one is a line in CONTENTS."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from tmm_cli.analysis.pipeline import Results
from tmm_cli.draw.formats import Drawn
from tmm_cli.draw.layout.law_values import law_tables
from tmm_cli.draw.layout.values import balance_table, forces_table, motion_tables, structure_tables
from tmm_cli.draw.sheets.centres import sheets as centres
from tmm_cli.draw.sheets.diagrams import diagrams
from tmm_cli.draw.sheets.force_plans import forces
from tmm_cli.draw.sheets.group_loads import group_loads
from tmm_cli.draw.sheets.groups import all_groups
from tmm_cli.draw.sheets.hodographs import balancing
from tmm_cli.draw.sheets.law_of_motion import law_of_motion
from tmm_cli.draw.sheets.lever import lever
from tmm_cli.draw.sheets.mechanism import Position, detailed, position
from tmm_cli.draw.sheets.motion_plans import motion_plans
from tmm_cli.draw.sheets.positions import all_positions
from tmm_cli.draw.sheets.single_run import single_run
from tmm_cli.draw.sheets.structure import whole_scheme
from tmm_cli.draw.sheets.synthesis import synthesised
from tmm_cli.language import N_

SUBJECTS = (N_("Structure and synthesis"), N_("Kinematics"), N_("Forces"), N_("Law of motion"))


@dataclass(frozen=True)
class Choice:
    """What is drawn: the results, the positions of the motion plans and those of the forces."""

    results: Results
    plans: tuple[Position, ...]
    detail: tuple[Position, ...]

    @property
    def moves(self) -> bool:
        """Whether there is a position in which the mechanism can be drawn."""
        motion = self.results.motion
        return motion is not None and bool(motion.placed.any())


@dataclass(frozen=True)
class Source:
    """What draws some of the drawings of a sheet, from the results or from each of some positions.

    usual: longest side on A1, mm; None: as it comes (tables). over: for which positions of the choice it draws.
    """

    sheet: int
    draw: Callable[[Any], Drawn]
    usual: float | None = None
    over: Literal["", "plans", "detail"] = ""

    def drawings(self, choice: Choice) -> Drawn:
        """They are drawn one after the other, as they are taken."""
        if self.over:
            return (found for here in getattr(choice, self.over) for found in self.draw(here))
        return self.draw(choice.results) if choice.moves or self.sheet == 0 else ()


def chosen(results: Results, *, every: bool) -> Choice:
    """The positions in detail; with `every` the motion plans of all positions that could be computed."""
    motion = results.motion
    if motion is None:
        return Choice(results, (), ())
    detail = tuple(detailed(results))
    moving = motion.moving & ~results.locked
    plans = [Position(results, motion, k) for k in range(len(results.numbers)) if moving[k]] if every else detail
    return Choice(results, tuple(plans), detail)


CONTENTS = (
    Source(0, whole_scheme, 240),
    Source(0, all_groups, 150),
    Source(0, synthesised, 200),
    Source(0, structure_tables),
    Source(1, all_positions, 240),
    Source(1, motion_plans, 300, over="plans"),
    Source(1, motion_tables),
    Source(1, centres, 200),
    Source(1, diagrams, 240),
    Source(2, position, 200, over="detail"),
    Source(2, group_loads, 160, over="detail"),
    Source(2, forces, 100, over="detail"),
    Source(2, lever, 200, over="detail"),
    Source(2, forces_table, over="detail"),
    Source(2, balance_table),
    Source(2, balancing, 100),
    Source(2, single_run, 240),
    Source(3, law_of_motion, 240),
    Source(3, law_tables),
)
