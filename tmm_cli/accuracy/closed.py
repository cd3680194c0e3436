"""The product's own way: closed-form groups in float64, forces walked backward through them."""

from __future__ import annotations

from collections.abc import Callable

from tmm_cli.accuracy.case import Answers, Case, from_plan
from tmm_cli.forces.plan import react
from tmm_cli.motion import move
from tmm_cli.vectors import Real


def prepare(case: Case) -> Callable[[Real], Answers]:
    """Groups of class II are closed, those of higher classes are found by Newton's method from a track of theirs."""

    def at(q: Real) -> Answers:
        motion = move(case.linkage, case.kernels, q, case.law)
        return from_plan(case, motion, react(motion, case.structure, case.loads(motion)))

    return at
