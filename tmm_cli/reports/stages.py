"""What will be computed: step by step, and stage by stage, by which groups, at how many places, and what is left out.

A row says what the stages do, not what they could: the groups come from the same function that the stages ask.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.analysis import CYCLE, Results
from tmm_cli.mechanics.groups import Closed, Kernel, towards
from tmm_cli.mechanics.kinematics import SCAN
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.structure import DENSE, Group
from tmm_cli.problem import Problem
from tmm_cli.reports.table import Table, table_of_words

PANELS = 12 * 16  # places on a turn that a law of motion is computed at, at least

Row = tuple[str, str, str, str, str]


def steps(results: Results) -> Table:
    """The drivers and the groups, with the assembly that each of them has."""
    linkage = results.linkage
    drivers = " + ".join(map(results.structure.driver_title, linkage.drivers))
    given = _("the drivers: their places are given") if linkage.others else _("the driver: its place is given")
    rows = [("1", drivers, given, "", _("in closed form"))]
    solved = {link: kernel for kernel in results.kernels for link in kernel.group.links}
    for number, group in enumerate(results.structure.solved, 2):
        kernel = solved.get(group.links[0])
        how = "" if kernel is None else _how(kernel)
        rows.append((str(number), f"{group.title} {group.type}".strip(), _neighbours(group), _assembly(kernel), how))
    note = _(
        "Each group: places, velocities, accelerations in closed form (places by iteration where "
        "the assembly is followed); then reactions, last group first; then the Zhukovsky lever "
        "from velocities alone."
    )
    return table_of_words(
        "way",
        _("What is computed, in this order; forces in the opposite one"),
        (_("step"), _("group"), _("hangs on"), _("assembly"), _("solved")),
        rows,
        (note,),
    )


def link_name(link: str) -> str:
    """The frame has no number."""
    return _("frame") if link == FRAME else link


def _neighbours(group: Group) -> str:
    told = []
    for pair in group.outer:
        known = pair.i if pair.j in group.links else pair.j
        told.append(_("{pair} of {link}").format(pair=pair.name, link=link_name(known)))
    return "; ".join(told)


def _assembly(kernel: Kernel | None) -> str:
    """Which of its assemblies a group has."""
    if kernel is None:
        return _("not decided: see tmm kinematics")
    if not isinstance(kernel, Closed):
        return _("that of the sketch, followed")
    if kernel.assemblies == 1:
        return _("the only one")
    return _("sign {sign} of two, from the sketch").format(sign=f"{kernel.sign:+d}")


def _how(kernel: Kernel) -> str:
    """How a group is solved."""
    if isinstance(kernel, Closed):
        return _("in closed form") if kernel.winding is None else _("in closed form, turns followed")
    return _("by Newton") if kernel.followed is None else _("by Newton, followed")


def stages_table(results: Results) -> Table:
    """A row a stage."""
    headers = (_("stage"), _("groups"), _("places"), _("of the motion"), _("note"))
    return table_of_words(
        "stages", _("What each stage computes, when it is asked for"), headers, describe_stages(results)
    )


def describe_stages(results: Results) -> Iterable[Row]:
    """Stage, groups, how many places, what of the motion, and notes; nothing but counting where nothing assembles."""
    driver_range, linkage, request = results.driver_range, results.linkage, results.problem.request
    yield _("structure"), "-", "-", "-", _("by counting; a crank and a rocker are told apart by the range")
    if driver_range is None:
        return
    kernels, scan = results.kernels, SCAN * driver_range.turns + 1
    asked = str(len(request.places) or request.count)
    every = _titles(kernels, kernels)
    places, velocities, accelerations = _("places"), _("and velocities"), _("and accelerations")

    yield _("range of the driver"), every, str(scan), places, _("at once, then at what ends it")
    for link in results.mechanism.outputs:
        what = _("strokes of link {link}").format(link=link)
        if not driver_range.full:
            note = _("over the places asked: the driver does not turn fully")
            yield what, every, str(SCAN + 1), velocities, note
            continue
        note = _("position 0 hangs on it") if request.start == "working stroke" and not request.places else ""
        yield what, _titles(towards(kernels, [linkage.output_carrier(link)]), kernels), str(scan + 1), velocities, note
    yield _("dead positions"), every, str(scan), places, ""
    yield _("pressure angles"), every, str(scan), places, _("from statics")
    if results.inputs.dynamics is not None:
        note = _("and more, until sums along the way are exact; then kinematics and forces with it")
        yield _("law of motion"), every, str(PANELS * driver_range.turns), accelerations, note
    if results.inputs.balancing is not None:
        note = _("what shakes the frame, at constant speed of the driver")
        yield _("balancing"), every, str(CYCLE * driver_range.turns), accelerations, note
    note = _("--position: these only; --of: groups on the way only")
    yield _("kinematics"), every, asked, accelerations, note
    yield _("forces"), every, asked, _("reactions"), f"{_inertia(linkage)}; {_acting(linkage)}"
    yield _("lever"), "-", asked, velocities, _("of the same loads; solves nothing anew")
    if linkage.friction:
        yield _("losses by friction"), every, str(CYCLE + 1), accelerations, _("over the whole cycle")
    drawn = _("only where drawings are asked for")
    yield _("trajectories"), every, str(DENSE), places, drawn
    diagrams = min((DENSE - 1) * driver_range.turns, SCAN) + 1
    yield _("diagrams"), every, str(diagrams), accelerations, drawn


def heavy(linkage: Linkage) -> list[str]:
    """Links that carry inertia."""
    links = linkage.links
    return [n for n in linkage.moving if np.any(links[n].mass != 0) or np.any(links[n].inertia != 0)]


def _inertia(linkage: Linkage) -> str:
    links = ", ".join(heavy(linkage))
    return _("inertia of {links}").format(links=links) if links else _("no inertia")


def _acting(linkage: Linkage) -> str:
    loads = ", ".join(linkage.acting)
    return _("loads {loads}").format(loads=loads) if loads else _("no loads")


def _titles(groups: Sequence[Kernel], every: Sequence[Kernel]) -> str:
    if len(groups) == len(every) > 1:
        return _("all {count}").format(count=len(every))
    return " ".join(kernel.group.title for kernel in groups) or "-"


def skipped(problem: Problem) -> Iterable[Table]:
    """What is not computed and why; no table where nothing is skipped."""
    rows = list(_skipped(problem))
    if rows:
        yield table_of_words("skipped", _("What is skipped"), (_("what"), _("why")), rows)


def _skipped(problem: Problem) -> Iterable[tuple[str, str]]:
    linkage = problem.linkage
    light = [n for n in linkage.moving if not np.any(linkage.links[n].mass != 0)]
    if light:
        yield _("weight and inertia of links {links}").format(links=", ".join(light)), _("no masses are given for them")
    spinless = [n for n in linkage.moving if not np.any(linkage.links[n].inertia != 0) and n not in light]
    if spinless:
        what = _("inertia couples of links {links}").format(links=", ".join(spinless))
        yield what, _("no moments of inertia are given for them")
    if not linkage.acting and len(light) == len(linkage.moving):
        yield _("all forces are zero"), _("neither masses nor loads are given")
    if linkage.gravity == 0:
        yield _("weights"), _("gravity is zero")
