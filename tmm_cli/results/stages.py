"""What each stage computes: the groups it solves and how, at how many places, how far, and what it leaves out.

A row says what the stages do, not what they could: the groups come from the same function that the stages ask.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from tmm_cli.cycle import DENSE
from tmm_cli.groups.base import Closed, Kernel
from tmm_cli.linkage import Linkage
from tmm_cli.motion import towards
from tmm_cli.pipeline import CYCLE, Results
from tmm_cli.quality import SCAN
from tmm_cli.words import say

Row = tuple[str, str, str, str, str]
ORDERS = ("stages.places", "stages.velocities", "stages.accelerations")


def how(kernel: Kernel) -> str:
    """How a group is solved, in a word."""
    if isinstance(kernel, Closed):
        return say("stages.closed" if kernel.winding is None else "stages.closed_followed")
    return say("stages.newton" if kernel.followed is None else "stages.newton_followed")


def heavy(linkage: Linkage) -> list[str]:
    """Links that carry inertia."""
    links = linkage.links
    return [n for n in linkage.moving if np.any(links[n].mass != 0) or np.any(links[n].inertia != 0)]


def stages(results: Results) -> Iterable[Row]:
    """Stage, groups, how many places, what of the motion, and notes; nothing but counting where nothing assembles."""
    way, linkage, request = results.way, results.linkage, results.problem.request
    yield say("stages.structure"), "-", "-", "-", say("stages.counted")
    if way is None:
        return
    kernels, turns = results.kernels, way.turns
    asked, scan = len(request.places) or request.count, SCAN * turns + 1

    def row(key: str, groups: Sequence[Kernel], places: int, order: int, note: str = "") -> Row:
        return say(key), _titles(groups, kernels), str(places), say(ORDERS[order]), note

    yield row("stages.range", kernels, scan, 0, say("stages.whole"))
    mechanism = results.mechanism
    for link in mechanism.outputs:
        what = say("stages.strokes", link=link)
        if not way.full:
            yield what, _titles(kernels, kernels), str(SCAN + 1), say(ORDERS[1]), say("stages.travel")
            continue
        only = towards(kernels, [link])
        note = say("stages.for_start") if request.start == "working stroke" and not request.places else ""
        yield what, _titles(only, kernels), str(scan + 1), say(ORDERS[1]), note
    yield row("stages.dead", kernels, scan, 0)
    yield row("stages.pressure", kernels, scan, 0, say("stages.statics"))
    yield row("stages.kinematics", kernels, asked, 2, say("stages.of"))
    masses, loads = heavy(linkage), [x.name for x in linkage.loads] + [x.name for x in linkage.springs]
    borne = say("stages.inertia", links=", ".join(masses)) if masses else say("stages.no_inertia")
    acting = say("stages.acting", loads=", ".join(loads)) if loads else say("stages.no_loads")
    yield say("stages.forces"), _titles(kernels, kernels), str(asked), say("stages.reactions"), f"{borne}; {acting}"
    yield say("stages.lever"), "-", str(asked), say(ORDERS[1]), say("stages.by_velocities")
    if linkage.friction:
        yield row("stages.losses", kernels, CYCLE + 1, 2, say("stages.losses_note"))
    yield row("stages.drawings", kernels, DENSE, 0, say("stages.by_run"))
    yield row("stages.diagrams", kernels, min((DENSE - 1) * turns, SCAN) + 1, 2, say("stages.by_run"))


def _titles(groups: Sequence[Kernel], every: Sequence[Kernel]) -> str:
    if len(groups) == len(every) > 1:
        return say("stages.all", count=len(every))
    return " ".join(kernel.group.title for kernel in groups) or "-"
