"""All sheets of a run. They are drawn first and then written in each format; a new kind of sheet is added here."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from itertools import chain

from tmm_cli.drawing.formats import JobRunner, NamedDrawings, files_of_parts, run_in_process
from tmm_cli.drawing.sheets import (
    Position,
    draw_all_positions,
    draw_centres as centres,
    draw_diagrams,
    draw_force_plans,
    draw_group_loads,
    draw_groups,
    draw_intermittent,
    draw_law_of_motion,
    draw_lever,
    draw_motion_plans,
    draw_position,
    draw_problem_synthesis,
    draw_shaking_hodograph as shaking,
    draw_single_run,
    scheme_sheet,
    sketch_scene,
)
from tmm_cli.language import _, numeral
from tmm_cli.mechanics.analysis import Results, balancing_magnitude, detail_chosen_by_program, detailed_positions
from tmm_cli.mechanics.quantities import FORCE, MOMENT

POSITION_DRAWINGS = (draw_position, draw_motion_plans, draw_group_loads, draw_force_plans, draw_lever)
MOST_POSITION_PARTS = 32  # of the detailed positions; every job transfers the results to another process

DrawingJob = Callable[[], NamedDrawings]  # may be pickled


def all_sheets(results: Results) -> NamedDrawings:
    """Yield all sheets of a run, as (stem of the file name, drawing).

    The sheets of the structure and of the whole cycle come first, then those of each detailed position.
    """
    return chain.from_iterable(job() for job in sheet_jobs(results))


def sheet_jobs(results: Results) -> list[DrawingJob]:
    """Return jobs that each draw some of the sheets of a run. They can run independently, e.g. on several cores."""
    if results.motion is None:
        return [partial(_draw_mechanism, results)]
    chosen = detailed_positions(results)
    per_job = math.ceil(len(chosen) / MOST_POSITION_PARTS) or 1
    of_positions = [
        partial(_draw_positions, results, chosen[first : first + per_job]) for first in range(0, len(chosen), per_job)
    ]
    return [partial(_draw_mechanism, results), *of_positions]


def _draw_mechanism(results: Results) -> NamedDrawings:
    sketch = sketch_scene(results)
    if sketch is not None:
        yield "structure", scheme_sheet(results.problem.title, *sketch).finish()
        yield from draw_groups(results.problem.title, *sketch, results.roles)
    if results.motion is None:
        return
    yield from draw_problem_synthesis(results)
    if bool(results.motion.placed.any()):
        yield from draw_all_positions(results)
        yield from centres(results)
        yield from draw_diagrams(results)
        yield from shaking(results)
        yield from draw_law_of_motion(results)
        yield from draw_single_run(results)
        yield from draw_intermittent(results)


def _draw_positions(results: Results, chosen: Sequence[int]) -> NamedDrawings:
    assert results.motion is not None
    for k in chosen:
        for sheets_of in POSITION_DRAWINGS:
            yield from sheets_of(Position(results, results.motion, k))


def sheet_files(
    results: Results, say: Callable[[str], None] = lambda note: None, runner: JobRunner = run_in_process
) -> Iterable[tuple[str, bytes]]:
    """Yield the files of all sheets of a run, as (file name, content).

    Args:
        results: computed results.
        say: called with notes on the sheets.
        runner: runs the drawing jobs, for example on several cores.
    """
    for remark in position_remarks(results):
        say(remark)
    yield from files_of_parts(sheet_jobs(results), say, runner)


def position_remarks(results: Results) -> Iterable[str]:
    """Yield a note that explains which position is drawn in detail, if the file does not specify one."""
    if results.motion is not None and detail_chosen_by_program(results):
        yield from (_default_position_note(results, k) for k in detailed_positions(results))


def _default_position_note(results: Results, k: int) -> str:
    number, balance = results.numbers[k], float(balancing_magnitude(results)[k])
    if balance == 0:
        return _("note: the file has no positions.detail; position {number} is drawn in detail").format(number=number)
    turns = results.linkage.driver.kind == "turn"
    units, dimension = results.problem.units, MOMENT if turns else FORCE
    shown_balance = f"{numeral(units.from_si(balance, dimension), '.4g')} {units.spelt(dimension)}"
    return (
        _(
            "note: the file has no positions.detail; position {number} is drawn in detail, as its balancing "
            "moment is the largest: {size}"
        )
        if turns
        else _(
            "note: the file has no positions.detail; position {number} is drawn in detail, as its balancing "
            "force is the largest: {size}"
        )
    ).format(number=number, size=shown_balance)
