"""Drawings: recorded first, then written in any format. A new sheet is a function in a file here and a line below."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from tmm_cli.analysis.pipeline import Results
from tmm_cli.draw.diagrams import diagrams
from tmm_cli.draw.formats import Drawn
from tmm_cli.draw.formats import files as every_format
from tmm_cli.draw.groups import groups
from tmm_cli.draw.mechanism import all_positions, detailed, position
from tmm_cli.draw.plans import forces, lever, motion_plans
from tmm_cli.draw.structure import at_sketch, scheme
from tmm_cli.draw.synthesis import synthesised


def sheets(results: Results) -> Drawn:
    """Every sheet with its file's stem: those of the structure, of the cycle, then of each position in detail."""
    found = at_sketch(results)
    if found is not None:
        yield "structure", scheme(results.problem.title, *found).finish()
        yield from groups(results.problem.title, *found, results.roles)
    if results.motion is None:
        return
    yield from synthesised(results)
    if bool(results.motion.placed.any()):
        yield from all_positions(results)
        yield from diagrams(results)
    for here in detailed(results):
        for sheets_of in (position, motion_plans, forces, lever):
            yield from sheets_of(here)


def files(results: Results, say: Callable[[str], None] = lambda note: None) -> Iterable[tuple[str, bytes]]:
    """Every sheet in every format; say: where a note on them goes."""
    return every_format(sheets(results), say)
