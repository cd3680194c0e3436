"""Which drawings stand on which large sheet, and how large they usually are. A further drawing is a line in CONTENTS."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass

from tmm_cli.analysis.pipeline import Results
from tmm_cli.draw.diagrams import diagrams
from tmm_cli.draw.drawing import Drawing
from tmm_cli.draw.groups import groups
from tmm_cli.draw.layout.values import balance_table, forces_table, motion_tables, structure_tables
from tmm_cli.draw.mechanism import Position, all_positions, detailed, position
from tmm_cli.draw.plans import forces, lever, motion_plans
from tmm_cli.draw.structure import at_sketch, scheme
from tmm_cli.draw.synthesis import synthesised
from tmm_cli.errors import _

SUBJECTS = (_("Structure and synthesis"), _("Kinematics"), _("Forces"))
Drawn = Iterable[tuple[str, Drawing]]


@dataclass(frozen=True)
class Choice:
    """What is drawn: the results, the positions of the motion plans and those of the forces."""

    results: Results
    plans: tuple[Position, ...]
    detail: tuple[Position, ...]


@dataclass(frozen=True)
class Source:
    """What draws some of the drawings of a sheet. usual: longest side on A1, mm; None: as it comes (tables)."""

    sheet: int
    draw: Callable[[Choice], Drawn]
    usual: float | None = None


def chosen(results: Results, *, every: bool) -> Choice:
    """The positions in detail; with `every` the motion plans of all positions that could be computed."""
    motion = results.motion
    if motion is None:
        return Choice(results, (), ())
    detail = tuple(detailed(results))
    moving = motion.moving & ~results.locked
    plans = [Position(results, motion, k) for k in range(len(results.numbers)) if moving[k]] if every else detail
    return Choice(results, tuple(plans), detail)


def _structure(choice: Choice) -> Drawn:
    found, title = at_sketch(choice.results), choice.results.problem.title
    if found is not None:
        yield "structure", scheme(title, *found).finish()


def _groups(choice: Choice) -> Drawn:
    found, title = at_sketch(choice.results), choice.results.problem.title
    if found is not None:
        yield from groups(title, *found, choice.results.roles)


def _of_cycle(draw: Callable[[Results], Drawn]) -> Callable[[Choice], Drawn]:
    """A drawing that needs a mechanism that moves."""
    def drawn(choice: Choice) -> Drawn:
        motion = choice.results.motion
        return draw(choice.results) if motion is not None and bool(motion.placed.any()) else ()

    return drawn


def _of_plans(draw: Callable[[Position], Drawn]) -> Callable[[Choice], Drawn]:
    return lambda choice: (found for here in choice.plans for found in draw(here))


def _of_detail(draw: Callable[[Position], Drawn]) -> Callable[[Choice], Drawn]:
    return lambda choice: (found for here in choice.detail for found in draw(here))


CONTENTS = (
    Source(0, _structure, 240),
    Source(0, _groups, 300),
    Source(0, _of_cycle(synthesised), 200),
    Source(0, lambda choice: structure_tables(choice.results)),
    Source(1, _of_cycle(all_positions), 200),
    Source(1, _of_plans(motion_plans), 300),
    Source(1, _of_cycle(motion_tables)),
    Source(1, _of_cycle(diagrams), 160),
    Source(2, _of_detail(position), 200),
    Source(2, _of_detail(forces), 100),
    Source(2, _of_detail(lever), 200),
    Source(2, _of_detail(forces_table)),
    Source(2, _of_cycle(balance_table)),
)
