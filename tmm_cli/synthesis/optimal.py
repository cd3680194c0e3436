"""Optimal synthesis: numbers of a linkage within bounds that make an objective least and keep constraints.

A global search finds where the best candidate lies (evolution), then sequential quadratic programming on exact peaks
finds it (polish).
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from tmm_cli.synthesis.candidates import LOST, Search, W
from tmm_cli.synthesis.choices import Choices
from tmm_cli.synthesis.every import every, foremost
from tmm_cli.synthesis.evolution import Evolved, evolve
from tmm_cli.synthesis.first import NoneAssembled
from tmm_cli.synthesis.goals import FORCES, Goal
from tmm_cli.synthesis.optimal_asked import Asked, Limit
from tmm_cli.synthesis.record import Infeasible, Outcome, Shown
from tmm_cli.vectors import Real

if TYPE_CHECKING:
    from tmm_cli.synthesis.wider import Nearest

__all__ = ["PARAMETERS", "Asked", "Limit", "best", "solve"]
PARAMETERS: Final[dict[str, str]] = {}
STARTS = 3  # of the polish: the best that differ
SHRINKING = 40  # generations a parameter, for equalities
HOPE = 1.0  # a start that is worse than the best by more of it is not polished
APART = 0.02  # in shares of the ranges: what counts as different
ALIKE = 3  # mechanisms that are compared
BESIDE = 0.2  # of the ranges: by less than half of it they differ
KEPT = 1e-7  # by so much of its scale a constraint may be missed
SEEMS = 1e-4  # of a bound: what comes so near to it between the positions of the search seems to meet it
PAST = 0.5  # of a bound that only seems to be met: so far past it is aimed then


@dataclass(frozen=True)
class Best:
    """The best candidate: its numbers (SI), objective and constrained quantities, by how much it misses constraints."""

    x: Real
    numbers: Real
    values: list[float]
    missed: float
    evolved: Evolved


def best(search: Search) -> Best:
    """Search and polish. Raises Infeasible."""
    asked, size = search.asked, len(search.low)
    few = every(search)
    if few is not None:
        try:
            return _best_of(search, foremost(search, few) if not few.stopped else few.population[:STARTS], few)
        except KeyboardInterrupt:
            return _best_of(search, few.population[:STARTS], replace(few, stopped=True))
    choices = Choices(search) if asked.values else None
    shrinking = min(SHRINKING * size, int(0.6 * search.generations))
    evolved = evolve(
        choices or search.evaluate, size, population=search.population, generations=search.generations, seed=asked.seed,
        shrinking=shrinking if any(limit.equal for limit in search.limits) else 0, progress=asked.progress,
    )  # fmt: skip
    starts: list[Real] = []
    first = evolved.objective[0]
    population = search.shares(search.numbers(evolved.population))  # where they have some values only, at those
    for x, f in zip(population, evolved.objective, strict=True):
        if (
            len(starts) < STARTS
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
            values = search.exactly(x)
        except ValueError:
            return
        missed = float(sum(limit.missed(v) for limit, v in zip(search.limits, values[1:], strict=True)))
        missed += LOST * (search.limits[0].missed(values[1]) > KEPT)
        found.append((missed if missed > KEPT else 0.0, float(search.wanted(np.array(values[0]))), x, values))

    try:
        for start in starts:
            take(start)
            if search.asked.free:
                take(search.polished(start))
    except KeyboardInterrupt:
        if not found:
            raise
        evolved = replace(evolved, stopped=True)
    goes = any(search.limits[0].missed(values[1]) <= KEPT for *_, values in found)
    found = [one for one in found if not np.isnan(one[0] + one[1])]
    if not found:
        if goes or evolved.violation[0] == 0.0:
            raise Infeasible("objective", *_none(search, search.asked.objective))
        raise Infeasible("vary", f"{W}.never", _other(f"{W}.never", search.closed))
    missed, _, x, values = min(found, key=lambda one: one[:2])
    return Best(x, search.numbers(x), values, missed, evolved)


def solve(asked: Asked) -> Outcome:
    """The task of one file. Raises Infeasible."""
    from tmm_cli.synthesis.optimal_told import told

    try:
        search = Search(asked)
    except NoneAssembled as refusal:
        search = Search(asked, _within(asked, "vary", refusal.reason).first)
    found = best(search)
    if found.missed:
        found = _mended(search, found)
    return told(search, found)


def _none(search: Search, goal: Goal) -> tuple[str, str]:
    """Words on a quantity that no candidate has: forces are lost where an accelerated driver does not come by."""
    if goal.of in FORCES and search.variant.accelerated:
        return f"{W}.stops", f"{W}.goes_on"
    return f"{W}.has_none", f"{W}.another"


def _from(search: Search, found: Best, refusal: tuple[str | tuple[str | int, ...], str]) -> Best:
    """The best that is led to from what a search for the nearest bounds finds within the given ones.

    Raises Infeasible, at a key and for a reason, with the bounds that it finds else.
    """
    again = _best_of(search, [search.shares(_within(search.asked, *refusal).numbers)], found.evolved)
    if again.missed:
        raise Infeasible(*refusal, _other(refusal[1], search.closed))
    return again


def _other(reason: str, closed: bool) -> str:
    """Words where no bounds that would do were found."""
    own = {f"{W}.no_assembly": f"{W}.other_sketch", f"{W}.never": f"{W}.over" if closed else f"{W}.other_way"}
    return own.get(reason, f"{W}.wider")


def _within(asked: Asked, key: str | tuple[str | int, ...], reason: str) -> Nearest:
    """A mechanism within the bounds with which all is met. Raises Infeasible with the nearest bounds."""
    from tmm_cli.synthesis.wider import nearest

    found, early = nearest(asked)
    if found is None:
        low, high = np.array(list(asked.low.values())), np.array(list(asked.high.values()))
        closed = asked.make(asked.near((low + high) / 2).tolist()).ends is None
        words = _other(reason, closed)
        if words in (f"{W}.wider", f"{W}.other_sketch") and not asked.free:
            words = f"{W}.other_values"  # what lies beyond them is not tried
        raise Infeasible(key, reason, words + "_early" * (early and words == f"{W}.wider"))
    if found.beyond:
        name, above, *_ = found.beyond[0]
        words, values = found.told
        if not found.keeps and reason != f"{W}.no_assembly":  # with these bounds it goes its way, and no more is said
            key, reason = "vary", f"{W}.never"
        raise Infeasible(asked.bound(name, above) if key == "vary" else key, reason, f"{W}.{words}", values)
    return found


def _mended(search: Search, found: Best) -> Best:
    """Searched for again with the constraint that is farthest from being met as what is wanted.

    Raises Infeasible when it cannot be met while all the others are kept: how near to it one comes then.
    """
    misses = [float(limit.missed(v)) for limit, v in zip(search.limits, found.values[1:], strict=True)]
    n = 0 if misses[0] > KEPT else int(np.argmax(misses))
    limit = search.limits[n]
    if n == 0 or np.isnan(found.values[n + 1]):
        if n and limit.goal.of in FORCES and search.variant.accelerated:
            raise Infeasible(limit.at, *_none(search, limit.goal))
        return _from(search, found, (limit.at, f"{W}.has_none") if n else ("vary", f"{W}.never"))
    bound = limit.passed(found.values[n + 1])
    others = tuple(other for k, other in enumerate(search.limits[1:], 1) if k != n)
    try:
        nearest = _aimed(search, limit, bound, others)
    except Infeasible:
        nearest = found
    if nearest.missed:  # the others contradict one another too
        return _together(search, found)
    if limit.missed(nearest.values[0]) <= KEPT:
        again = _best_of(search, [nearest.x], found.evolved)
        if not again.missed:
            return again
    told = _beside(search, n, nearest.values[0], bound, nearest.x)
    raise Infeasible(limit.key(bound), f"{W}.unmet", f"{W}.nearest", {"value": told})


def _aimed(search: Search, limit: Limit, bound: float, others: tuple[Limit, ...]) -> Best:
    """The mechanism whose quantity is nearest to a bound while others are kept. Raises Infeasible.

    A search ends where the bound seems to be met at its positions, though it may not be between them, nor as near as it
    can be: then what is farthest past it is searched for, which no bound ends too early.
    """

    def towards(target: float) -> Best:
        return best(Search(replace(search.asked, objective=limit.goal, limits=others, target=target), search.first))

    found = towards(bound)
    short = float(limit.missed(found.values[0]))
    if found.missed or short <= KEPT or not found.evolved.objective[0] <= SEEMS:
        return found
    past = np.copysign(PAST * (abs(bound) or 1.0), bound - found.values[0])
    again = towards(bound + float(past))
    return again if not again.missed and limit.missed(again.values[0]) < short else found


def _together(search: Search, found: Best) -> Best:
    """What keeps all constraints after all.

    Raises Infeasible when they contradict one another: with the limits nearest to those asked that are met together,
    each the nearest with the others as they are told.
    """
    values = found.values[2:]
    limits = [limit.widened(value) for limit, value in zip(search.limits[1:], values, strict=True)]
    missed = [k for k, limit in enumerate(search.limits[1:]) if limit.missed(values[k]) > KEPT]
    told: dict[int, tuple[str, Shown]] = {}
    keys = []
    for k in missed:
        limit, value = search.limits[k + 1], values[k]
        bound, others = limit.passed(value), tuple(other for n, other in enumerate(limits) if n != k)
        try:
            nearest = _aimed(search, limit, bound, others)
            if not nearest.missed and limit.missed(nearest.values[0]) < limit.missed(value):
                value, found = nearest.values[0], nearest
        except Infeasible:
            pass
        limits[k] = limit.widened(value)
        if limit.missed(value) > KEPT:
            side = "equal" if limit.equal else "least" if bound == limit.least else "most"
            told[k] = side, _beside(search, k + 1, value, bound, found.x)
            keys.append(limit.key(bound))
    if not told:
        again = _best_of(search, [found.x], found.evolved)
        if not again.missed:
            return again
        raise Infeasible(search.limits[1 + missed[0]].at, f"{W}.unmet", f"{W}.wider")
    if len(told) == 1:
        raise Infeasible(keys[0], f"{W}.unmet", f"{W}.nearest", {"value": next(iter(told.values()))[1]})
    shown: dict[str, Shown] = {}
    for n, (k, (side, nearby)) in enumerate(told.items(), 1):
        shown |= {f"which{n}": (str(k + 1), "word"), f"side{n}": (side, "word"), f"value{n}": nearby}
    raise Infeasible(keys[0], f"{W}.unmet", f"{W}.together{len(told)}", shown)


def _beside(search: Search, n: int, value: float, bound: float, x: Real) -> Shown:
    """The nearest value of the n-th limit to a bound, that of a candidate x, as it is shown.

    With the search's own errors it is no limit to the last digit; but an equality that hangs on nothing that may have
    all values within its bounds is met by that value alone.
    """
    limit, free = search.limits[n], search.asked.free
    kind = limit.goal.kind(search.linkage, search.groups)
    if limit.equal:
        others = np.tile(x, (ALIKE, 1))
        others[:, free] = np.clip(x[free] + BESIDE * (np.random.default_rng(0).random((ALIKE, len(free))) - 0.5), 0, 1)
        if all(abs(search.exactly(other)[n + 1] - value) <= KEPT * abs(value) for other in others):
            return value, kind, "exact"
    return value, kind, "below" if value < bound else "above"
