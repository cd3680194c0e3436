"""Contents of the large sheets: which drawings each sheet contains, and their usual sizes.

To add a drawing, extend CONTENTS.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any, Literal

from tmm_cli.drawing.formats import NamedDrawings
from tmm_cli.drawing.layout.value_tables import (
    draw_balance_table,
    draw_forces_table,
    draw_law_tables,
    draw_motion_tables,
    draw_structure_tables,
)
from tmm_cli.drawing.sheets import (
    Position,
    detailed_drawings,
    draw_all_groups,
    draw_all_positions,
    draw_centres as centres,
    draw_diagrams,
    draw_force_plans,
    draw_group_loads,
    draw_law_of_motion,
    draw_lever,
    draw_motion_plans,
    draw_position,
    draw_problem_synthesis,
    draw_scheme,
    draw_shaking_hodograph,
    draw_single_run,
)
from tmm_cli.language import N_
from tmm_cli.mechanics.analysis import Results

SUBJECTS = (
    ("structure", N_("Structure")),
    ("kinematics", N_("Kinematics")),
    ("forces", N_("Forces")),
    ("law-of-motion", N_("Law of motion")),
)
SYNTHESIS_TITLE = N_("Structure and synthesis")  # if the problem has a synthesis
STRUCTURE_SHEET, FORCES_SHEET = 0, 2
CONTINUATION_SUFFIX = "-sheet-"  # in the names of drawings that continue another one


@dataclass(frozen=True)
class SheetChoice:
    """Results and positions to be drawn on the large sheets.

    Attributes:
        results: computed results.
        plans: positions for which velocity and acceleration plans are drawn.
        detail: positions for which force drawings are made.
    """

    results: Results
    plans: tuple[Position, ...]
    detail: tuple[Position, ...]

    @property
    def moves(self) -> bool:
        """True if the mechanism can be drawn in at least one position."""
        motion = self.results.motion
        return motion is not None and bool(motion.placed.any())

    @property
    def loaded(self) -> bool:
        """True if there are forces to draw. Without weights and loads, every force would be zero."""
        reactions = self.results.reactions
        return reactions is None or reactions.loaded

    def shows(self, sheet: int) -> bool:
        """Return True if the sheet with this index in SUBJECTS contains any drawings."""
        return sheet == STRUCTURE_SHEET or (self.moves and (sheet != FORCES_SHEET or self.loaded))

    def title(self, sheet: int) -> str:
        """Return the untranslated title of the sheet with this index in SUBJECTS."""
        return (
            SYNTHESIS_TITLE
            if sheet == STRUCTURE_SHEET and self.results.problem.synthesis is not None
            else SUBJECTS[sheet][1]
        )


@dataclass(frozen=True)
class DrawingSource:
    """A function that makes all drawings of one kind for the large sheets.

    Attributes:
        sheet: index of the sheet in SUBJECTS.
        draw: function that makes the drawings. It is called with the results, or with each position if `over` is set.
        usual: longest side (mm) on A1 paper; None for tables, which keep their own size.
        over: name of the field of `SheetChoice` that contains the positions; empty for drawings of the whole mechanism.
        about: prefix of the names of its drawings. Drawings whose names agree after the prefix are placed side by side,
            even if different functions make them.
    """

    sheet: int
    draw: Callable[[Any], NamedDrawings]
    usual: float | None = None
    over: Literal["", "plans", "detail"] = ""
    about: str = ""

    def drawings(self, choice: SheetChoice) -> NamedDrawings:
        """Yield the drawings, as (stem of the file name, drawing). A drawing is made only when it is requested."""
        if not choice.shows(self.sheet):
            return ()
        if self.over:
            return (drawing for position in getattr(choice, self.over) for drawing in self.draw(position))
        return self.draw(choice.results)


def reading_order(drawings: Iterable[tuple[DrawingSource, str]]) -> list[int]:
    """Return the indices of the drawings in reading order, with the drawings of each Assur group next to each other.

    Args:
        drawings: source and name of each drawing.
    """
    first: dict[str, int] = {}
    keys: list[tuple[int, int]] = []
    for number, (source, name) in enumerate(drawings):
        thing = name.removeprefix(source.about).partition(CONTINUATION_SUFFIX)[0]
        keys.append((first.setdefault(thing, number) if source.about else number, number))
    return [number for __, number in sorted(keys)]


def choose_positions(results: Results, *, all_positions: bool) -> SheetChoice:
    """Choose the positions that the large sheets show.

    Force drawings are made for the detailed positions. Velocity and acceleration plans are drawn for the same
    positions, or with `all_positions` for every position in which the mechanism can move.
    """
    motion = results.motion
    if motion is None:
        return SheetChoice(results, (), ())
    detail = tuple(detailed_drawings(results))
    moving = motion.moving & ~results.locked
    plans = (
        [Position(results, motion, k) for k in range(len(results.numbers)) if moving[k]] if all_positions else detail
    )
    return SheetChoice(results, tuple(plans), detail)


CONTENTS = (
    DrawingSource(0, draw_scheme, 240),
    DrawingSource(0, draw_all_groups, 150),
    DrawingSource(0, draw_problem_synthesis, 200),
    DrawingSource(0, draw_structure_tables),
    DrawingSource(1, draw_all_positions, 240),
    DrawingSource(1, draw_motion_plans, 300, over="plans"),
    DrawingSource(1, centres, 200),
    DrawingSource(1, draw_diagrams, 240),
    DrawingSource(1, draw_motion_tables),
    DrawingSource(2, draw_position, 200, over="detail"),
    DrawingSource(2, draw_group_loads, 160, over="detail", about="group-loads"),
    DrawingSource(2, draw_force_plans, 100, over="detail", about="forces"),
    DrawingSource(2, draw_lever, 200, over="detail"),
    DrawingSource(2, draw_forces_table, over="detail"),
    DrawingSource(2, draw_balance_table),
    DrawingSource(2, draw_shaking_hodograph, 100),
    DrawingSource(2, draw_single_run, 240),
    DrawingSource(3, draw_law_of_motion, 240),
    DrawingSource(3, draw_law_tables),
)
