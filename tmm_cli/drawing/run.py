"""Drawings: recorded first, then written in any format. A new sheet is a function in a file here and a line below."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from itertools import chain

from tmm_cli.drawing.formats import Drawn, Way, here, in_parts
from tmm_cli.drawing.sheets import (
    Position,
    all_positions,
    at_sketch,
    balancing as shaking,
    draw_centres as centres,
    draw_diagrams,
    draw_group_loads,
    draw_intermittent,
    draw_law_of_motion,
    draw_lever,
    draw_motion_plans,
    draw_single_run,
    forces,
    groups,
    position,
    scheme,
    synthesised,
)
from tmm_cli.language import _, numeral
from tmm_cli.mechanics.analysis import Results, balancing, chosen_here, detailed_positions
from tmm_cli.mechanics.quantities import FORCE, MOMENT

OF_POSITION = (position, draw_motion_plans, draw_group_loads, forces, draw_lever)
MOST_PARTS = 32  # of the positions in detail, each of which takes the results to another process

Part = Callable[[], Drawn]  # may be pickled


def sheets(results: Results) -> Drawn:
    """Every sheet with its file's stem: those of the structure, of the cycle, then of each position in detail."""
    return chain.from_iterable(part() for part in parts(results))


def parts(results: Results) -> list[Part]:
    """All sheets in parts that can be drawn apart, in their order."""
    if results.motion is None:
        return [partial(_of_mechanism, results)]
    chosen = detailed_positions(results)
    size = math.ceil(len(chosen) / MOST_PARTS) or 1
    of_positions = [
        partial(_of_positions, results, chosen[first : first + size]) for first in range(0, len(chosen), size)
    ]
    return [partial(_of_mechanism, results), *of_positions]


def _of_mechanism(results: Results) -> Drawn:
    found = at_sketch(results)
    if found is not None:
        yield "structure", scheme(results.problem.title, *found).finish()
        yield from groups(results.problem.title, *found, results.roles)
    if results.motion is None:
        return
    yield from synthesised(results)
    if bool(results.motion.placed.any()):
        yield from all_positions(results)
        yield from centres(results)
        yield from draw_diagrams(results)
        yield from shaking(results)
        yield from draw_law_of_motion(results)
        yield from draw_single_run(results)
        yield from draw_intermittent(results)


def _of_positions(results: Results, chosen: Sequence[int]) -> Drawn:
    assert results.motion is not None
    for k in chosen:
        for sheets_of in OF_POSITION:
            yield from sheets_of(Position(results, results.motion, k))


def files(
    results: Results, say: Callable[[str], None] = lambda note: None, way: Way = here
) -> Iterable[tuple[str, bytes]]:
    """Every sheet in every format of a run; say: where a note on them goes; way: who draws."""
    for remark in remarks(results):
        say(remark)
    yield from in_parts(parts(results), say, way)


def remarks(results: Results) -> Iterable[str]:
    """Which position is drawn in full where the file names none, and why."""
    if results.motion is not None and chosen_here(results):
        yield from (_chosen(results, k) for k in detailed_positions(results))


def _chosen(results: Results, k: int) -> str:
    number, size = results.numbers[k], float(balancing(results)[k])
    if size == 0:
        return _("note: no positions.detail in the file, drawn in full is position {number}").format(number=number)
    turns = results.linkage.driver.kind == "turn"
    units, dimension = results.problem.units, MOMENT if turns else FORCE
    told = f"{numeral(units.from_si(size, dimension), '.4g')} {units.spelt(dimension)}"
    return (
        _(
            "note: no positions.detail in the file, drawn in full is position {number}, of the largest "
            "balancing moment: "
            "{size}"
        )
        if turns
        else _(
            "note: no positions.detail in the file, drawn in full is position {number}, of the largest balancing "
            "force: {size}"
        )
    ).format(number=number, size=told)
