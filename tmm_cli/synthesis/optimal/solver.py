"""Optimal synthesis: the search, the polish of its best candidates, what is said where constraints are not met."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Final

import numpy as np

from tmm_cli.errors import _
from tmm_cli.synthesis.optimal.choices import Choices, every, foremost
from tmm_cli.synthesis.optimal.closely import Best, exactly, polished
from tmm_cli.synthesis.optimal.evolution import Evolved, evolve
from tmm_cli.synthesis.optimal.outcome import outcome_of
from tmm_cli.synthesis.optimal.quantities.base import Goal
from tmm_cli.synthesis.optimal.search import LOST, Search
from tmm_cli.synthesis.optimal.task import Constraint, Task
from tmm_cli.synthesis.record import Infeasible, Outcome
from tmm_cli.vectors import Real

__all__ = ["PARAMETERS", "Best", "Constraint", "Task", "best", "solve"]
PARAMETERS: Final[dict[str, str]] = {}
STARTS = 3  # of the polish: the best that differ; one where candidates are moved one by one
HOPE = 1.0  # a start that is worse than the best by more of it is not polished
APART = 0.02  # in shares of the ranges: what counts as different
PAST = 0.5  # of a bound: so far past it is aimed, as it may seem to be met between the positions of the search
KEPT = 1e-7  # by so much of its scale a constraint may be missed


def solve(task: Task) -> Outcome:
    """The task of one file. Raises Infeasible."""
    search = Search(task)
    found = best(search)
    return outcome_of(search, _mended(search, found) if found.missed else found)


def best(search: Search) -> Best:
    """Search and polish. Raises Infeasible."""
    task = search.task
    few = every(search)
    if few is not None:
        try:
            return _best_of(search, foremost(search, few) if not few.stopped else few.population[:STARTS], few)
        except KeyboardInterrupt:
            return _best_of(search, few.population[:STARTS], replace(few, stopped=True))
    choices = Choices(search) if task.values else None
    evolved = evolve(
        choices or search.evaluate, len(search.low), population=search.population, generations=search.generations,
        seed=task.seed, equalities=any(constraint.equal for constraint in search.constraints), progress=task.progress,
    )  # fmt: skip
    starts: list[Real] = []
    first = evolved.objective[0]
    population = search.shares(search.numbers(evolved.population))  # where they have some values only, at those
    for x, f in zip(population, evolved.objective, strict=True):
        if (
            len(starts) < (STARTS if search.taped else 1)
            and (f == first or not f - first > HOPE * abs(first))
            and all(np.max(np.abs(x - s)) > APART for s in starts)
        ):
            starts.append(x)
    return _best_of(search, starts if choices is None else [*starts, *choices.starts()], evolved)


def _best_of(search: Search, starts: Iterable[Real], evolved: Evolved) -> Best:
    """The best of what the polish leads to from some starts, and of themselves."""
    found: list[tuple[float, float, Real, list[float]]] = []

    def take(x: Real) -> None:
        try:
            values = exactly(search, x)
        except ValueError:
            return
        both = zip(search.constraints, values[1:], strict=True)
        missed = float(sum(constraint.missed(value) for constraint, value in both))
        missed += LOST * (search.constraints[0].missed(values[1]) > KEPT)
        found.append((missed if missed > KEPT else 0.0, float(search.wanted(np.array(values[0]))), x, values))

    try:
        for start in starts:
            take(start)
            if search.task.free:
                take(polished(search, start))
    except KeyboardInterrupt:
        if not found:
            raise
        evolved = replace(evolved, stopped=True)
    goes = any(search.constraints[0].missed(values[1]) <= KEPT for *__, values in found)
    found = [one for one in found if not np.isnan(one[0] + one[1])]
    if not found:
        if goes or evolved.violation[0] == 0.0:
            raise Infeasible("objective", *_none(search, search.task.objective))
        raise _never(search)
    missed, __, x, values = min(found, key=lambda one: one[:2])
    return Best(x, search.numbers(x), values, missed, evolved)


def _never(search: Search) -> Infeasible:
    """Where no candidate comes all the way: the place to look at is how far the driver is to go."""
    return Infeasible(
        "vary", _("no mechanism within these bounds can go the whole way of its driver"),
        _("other bounds; or, where the crank is not to turn fully, over: [from, to] or over: positions")
        if search.closed else _("other bounds; or another way of the driver (over, stroke or positions)"),
    )  # fmt: skip


def _none(search: Search, quantity: Goal) -> tuple[str, str]:
    """Words on a quantity that no candidate has: forces are lost where an accelerated driver does not come by."""
    if quantity.forces and search.variant.accelerated:
        return (
            _("the driver does not come to all places of its way with this acceleration: it stops before, or they lie "
              "before position 0"),
            _("less to brake it, a higher speed, or a way from position 0 on in its sense"),
        )  # fmt: skip
    return _("no mechanism within the bounds was found that has this quantity"), _("other bounds, or another quantity")


def _mended(search: Search, found: Best) -> Best:
    """Searched for again with the constraint that is farthest from being met as what is wanted.

    Raises Infeasible when it cannot be met while all the others are kept: how near to it one comes then.
    """
    misses = [float(c.missed(value)) for c, value in zip(search.constraints, found.values[1:], strict=True)]
    if misses[0] > KEPT:
        raise _never(search)
    n = int(np.argmax(misses))
    constraint = search.constraints[n]
    if np.isnan(found.values[n + 1]):
        raise Infeasible(constraint.at, *_none(search, constraint.quantity))
    bound = constraint.passed(found.values[n + 1])
    others = tuple(other for k, other in enumerate(search.constraints[1:], 1) if k != n)
    beyond = not search.task.values and None in (constraint.least, constraint.most)
    past = np.copysign(PAST * (abs(bound) or 1.0), bound - found.values[n + 1]) if beyond else 0.0
    again = replace(search.task, objective=constraint.quantity, constraints=others, target=bound + float(past))
    reason = _("no mechanism within the bounds was found that meets this and the other constraints")
    try:
        nearest = best(Search(again, search.first))
    except Infeasible:
        nearest = found
    if nearest.missed:
        raise Infeasible(constraint.key(bound), reason, _("other bounds, or other constraints: several are not met"))
    if constraint.missed(nearest.values[0]) <= KEPT:
        mended = _best_of(search, [nearest.x], found.evolved)
        if not mended.missed:
            return mended
    side = "exact" if constraint.equal else "below" if nearest.values[0] < bound else "above"
    value = nearest.values[0], constraint.quantity.kind(search.linkage, search.groups), side
    raise Infeasible(constraint.key(bound), reason, _("with the others kept, the nearest is {value}"), {"value": value})
