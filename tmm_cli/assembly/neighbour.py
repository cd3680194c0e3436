"""A group whose lengths differ little from those of one that was followed: the nodes of its cycle found all at once.

They have to pass the tests of nodes that are found one after another (continuation): each is where its neighbour's
derivatives lead to, and no dead position lies between them.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tmm_cli.assembly.corrector import CORRECTION, Corrector
from tmm_cli.assembly.nodes import Source, ahead
from tmm_cli.groups.branch_trace import BranchTrace
from tmm_cli.groups.newton import Newton
from tmm_cli.groups.state import State
from tmm_cli.tolerances import SAME_STATE

NEARLY_DEAD = 0.05  # of the largest determinant: beside a dead position nodes have to lie closer


def corrected(kernel: Newton, source: Source, trace: BranchTrace, at: float, state: State) -> BranchTrace | None:
    """The trace of a group from that of its neighbour; None where the neighbour does not tell it.

    source: links placed before the group. state: the group at the driver's place `at`, in the assembly that is meant.
    """
    here = np.flatnonzero(trace.q == at)
    if not trace.closed or trace.dead.size or not here.size or kernel.passive:
        return None
    corrector = Corrector(kernel, source)
    motion = corrector.motion(trace.q, trace.states)
    if motion is None:
        return None
    states, first, second, det, sound = motion
    but_last = slice(-1)
    led = ahead(states.part(but_last), first.part(but_last), second.part(but_last), np.diff(trace.q)[:, None])
    same_way = np.all(det * np.sign(det[0]) > NEARLY_DEAD * np.max(np.abs(det)))
    found = (
        bool(np.all(sound) and same_way)
        and corrector.apart(led, states.part(slice(1, None))) < CORRECTION
        and corrector.returned(states.part(slice(1)), states.part(slice(-1, None)))
        and corrector.apart(State(states.x[here], states.unwrapped[here]), state) < SAME_STATE
    )
    return replace(trace, states=states, first=first, second=second) if found else None
