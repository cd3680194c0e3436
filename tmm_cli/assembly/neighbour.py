"""A group whose lengths differ little from those of one that was followed: the nodes of its cycle found all at once.

They have to pass the tests of nodes that are found one after another (continuation): each is where its neighbour's
derivatives lead to, and no dead position lies between them.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tmm_cli.assembly.corrector import CORRECTION, FEW
from tmm_cli.assembly.crossing import Source
from tmm_cli.groups.branch_trace import BranchTrace
from tmm_cli.groups.newton import Newton
from tmm_cli.groups.state import State
from tmm_cli.tolerances import CONVERGED, SAME_STATE

NEARLY_DEAD = 0.05  # of the largest determinant: beside a dead position nodes have to lie closer


def corrected(kernel: Newton, source: Source, trace: BranchTrace, at: float, state: State) -> BranchTrace | None:
    """The trace of a group from that of its neighbour; None where the neighbour does not tell it.

    source: links placed before the group. state: the group at the driver's place `at`, in the assembly that is meant.
    """
    here = np.flatnonzero(trace.q == at)
    if not trace.closed or trace.dead.size or not here.size or kernel.passive:
        return None
    before = source(trace.q, 2)
    if not np.all(before.placed):
        return None
    with np.errstate(all="ignore"):
        states, size = kernel.close(trace.states, before.poses, before.drives, FEW)
        everything = {**before.poses, **kernel.poses_of(states)}
        matrix = kernel.matrix(everything)
        det = np.linalg.det(matrix)
        rates = kernel.rates_at(everything, matrix, det, before.first, before.drives)
        both = {**before.first, **dict(zip(kernel.group.links, rates, strict=True))}
        accels = kernel.accelerations_at(everything, matrix, det, both, before.second, before.drives)
    first = State(np.stack([r.v for r in rates], -1), np.stack([r.w for r in rates], -1))
    second = State(np.stack([a.a for a in accels], -1), np.stack([a.e for a in accels], -1))
    step = np.diff(trace.q)[:, None]
    ahead = State(
        *(value[:-1] + step * (rate[:-1] + step / 2 * accel[:-1])
          for value, rate, accel in ((states.x, first.x, second.x),
                                     (states.unwrapped, first.unwrapped, second.unwrapped)))
    )  # fmt: skip
    around = states.unwrapped[-1:] - states.unwrapped[:1]
    once = State(states.x[-1:], states.unwrapped[-1:] - 2 * np.pi * np.round(around / (2 * np.pi)))

    def apart(one: State, other: State) -> float:
        away = np.max(np.abs(one.x - other.x)) / kernel.size
        return float(np.maximum(away, np.max(np.abs(one.unwrapped - other.unwrapped))))

    same_way = np.all(det * np.sign(det[0]) > NEARLY_DEAD * np.max(np.abs(det)))
    found = (
        bool(np.all(size < CONVERGED) and same_way)
        and apart(ahead, states.part(slice(1, None))) < CORRECTION
        and apart(states.part(slice(1)), once) < SAME_STATE
        and apart(State(states.x[here], states.unwrapped[here]), state) < SAME_STATE
    )
    return replace(trace, states=states, first=first, second=second) if found else None
