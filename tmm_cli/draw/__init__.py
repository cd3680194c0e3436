"""Drawings: recorded first, then written in any format. A new sheet is a function in a file here and a line below."""

from __future__ import annotations

from collections.abc import Callable, Iterable

from tmm_cli.analysis.in_detail import balancing, chosen_here, in_detail
from tmm_cli.analysis.pipeline import Results
from tmm_cli.draw.diagrams import diagrams
from tmm_cli.draw.force_plans import forces
from tmm_cli.draw.formats import Drawn
from tmm_cli.draw.formats import files as every_format
from tmm_cli.draw.group_loads import group_loads
from tmm_cli.draw.groups import groups
from tmm_cli.draw.lever import lever
from tmm_cli.draw.mechanism import detailed, position
from tmm_cli.draw.motion_plans import motion_plans
from tmm_cli.draw.positions import all_positions
from tmm_cli.draw.structure import at_sketch, scheme
from tmm_cli.draw.synthesis import synthesised
from tmm_cli.errors import _
from tmm_cli.quantities import FORCE, MOMENT


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
        for sheets_of in (position, motion_plans, group_loads, forces, lever):
            yield from sheets_of(here)


def files(results: Results, say: Callable[[str], None] = lambda note: None) -> Iterable[tuple[str, bytes]]:
    """Every sheet in every format; say: where a note on them goes."""
    for remark in remarks(results):
        say(remark)
    yield from every_format(sheets(results), say)


def remarks(results: Results) -> Iterable[str]:
    """Which position is drawn in full where the file names none, and why."""
    if results.motion is not None and chosen_here(results):
        yield from (_chosen(results, k) for k in in_detail(results))


def _chosen(results: Results, k: int) -> str:
    number, size = results.numbers[k], float(balancing(results)[k])
    if size == 0:
        return _("note: no positions.detail in the file, drawn in full is position {number}").format(number=number)
    turns = results.linkage.driver.kind == "turn"
    units, dimension = results.problem.units, MOMENT if turns else FORCE
    told = f"{units.from_si(size, dimension):.4g} {units.symbol(dimension)}"
    return (
        _("note: no positions.detail in the file, drawn in full is position {number}, of the largest balancing moment: "
          "{size}")
        if turns
        else _("note: no positions.detail in the file, drawn in full is position {number}, of the largest balancing "
               "force: {size}")
    ).format(number=number, size=told)  # fmt: skip
