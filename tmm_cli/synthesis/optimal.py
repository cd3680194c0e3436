"""Optimal synthesis: numbers of a linkage within bounds that make an objective least and keep constraints.

A global search finds where the best candidate lies (evolution), then sequential quadratic programming on exact peaks
finds it (polish).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from tmm_cli.synthesis.candidates import Asked, Limit, Search, W
from tmm_cli.synthesis.construction import Diagram, Line
from tmm_cli.synthesis.evolution import Evolved, evolve
from tmm_cli.synthesis.goals import LEAST, PLAIN
from tmm_cli.synthesis.measured_goals import measure
from tmm_cli.synthesis.measures import crank_turns
from tmm_cli.synthesis.record import Demand, Infeasible, Outcome, Value
from tmm_cli.vectors import Real

__all__ = ["PARAMETERS", "Asked", "Limit", "best", "solve"]
PARAMETERS: Final[dict[str, str]] = {}
STARTS = 3  # of the polish: the best that differ
SHRINKING = 40  # generations a parameter, for equalities
HOPE = 1.0  # a start that is worse than the best by more of it is not polished
APART = 0.02  # in shares of the ranges: what counts as different
KEPT = 1e-7  # by so much of its scale a constraint may be missed
ACTIVE = 1e-6


@dataclass(frozen=True)
class Best:
    """The best candidate: its numbers (SI), objective and constrained quantities, by how much it misses constraints."""

    x: Real
    numbers: Real
    values: list[float]
    missed: float
    evolved: Evolved


def best(search: Search) -> Best:
    """Search and polish."""
    asked, size = search.asked, len(search.low)
    shrinking = min(SHRINKING * size, int(0.6 * search.generations))
    evolved = evolve(
        search.evaluate, size, population=search.population, generations=search.generations, seed=asked.seed,
        shrinking=shrinking if any(limit.equal for limit in search.limits) else 0, progress=asked.progress,
    )  # fmt: skip
    starts: list[Real] = []
    first = evolved.objective[0]
    for x, f in zip(evolved.population, evolved.objective, strict=True):
        if (
            len(starts) < STARTS
            and not f - first > HOPE * abs(first)
            and all(np.max(np.abs(x - s)) > APART for s in starts)
        ):
            starts.append(x)
    found: list[tuple[float, float, Real, list[float]]] = []
    for start in starts:
        for x in (search.polished(start), start):
            try:
                values = search.exactly(x)
            except ValueError:
                continue
            missed = float(sum(limit.missed(v) for limit, v in zip(search.limits, values[1:], strict=True)))
            found.append((missed if missed > KEPT else 0.0, float(search.wanted(np.array(values[0]))), x, values))
    found = [one for one in found if not np.isnan(one[0] + one[1])]
    if not found:
        raise Infeasible("vary", f"{W}.never", f"{W}.wider")
    missed, _, x, values = min(found, key=lambda one: one[:2])
    return Best(x, search.numbers(x), values, missed, evolved)


def solve(asked: Asked) -> Outcome:
    """The task of one file. Raises Infeasible."""
    search = Search(asked)
    found = best(search)
    kinds = [goal.kind(search.linkage, search.groups) for goal in search.goals]
    if found.missed:
        misses = [limit.missed(v) for limit, v in zip(search.limits, found.values[1:], strict=True)]
        n = int(np.argmax(misses))
        if n == 0:
            raise Infeasible("vary", f"{W}.never", f"{W}.wider")
        raise Infeasible(
            search.limits[n].at, f"{W}.unmet", f"{W}.nearest", {"value": (found.values[n + 1], kinds[n + 1])}
        )  # fmt: skip
    given = [
        Value(name, side[name], asked.kinds[name], f"{W}.{word}")
        for name in asked.low for word, side in (("low", asked.low), ("high", asked.high))
    ]  # fmt: skip
    numbers = [
        Value(name, float(x), asked.kinds[name], f"{W}.parameter")
        for name, x in zip(asked.low, found.numbers, strict=True)
    ]
    more = [Value("", found.values[0], kinds[0], f"{W}.best_{asked.objective.of}")]
    demands = [Demand(f"{W}.crank", 1.0, "number", crank_turns, asked=False)]
    demands.append(_demand(search, 0, found.values[0], kinds[0], asked=False))
    for n, limit in enumerate(search.limits[1:], 2):
        value = found.values[n]
        given += [
            Value("", side, kinds[n], f"{W}.{word}_{limit.goal.of}")
            for word, side in (("least", limit.least), ("most", limit.most)) if side is not None
        ]  # fmt: skip
        margin = limit.margin(value)
        state = "equal" if limit.equal else "active" if margin <= ACTIVE * limit.scale else "free"
        more.append(Value("", value, kinds[n], f"{W}.{limit.goal.of}"))
        more.append(Value("", margin, kinds[n], f"{W}.margin_{limit.goal.of}"))
        more.append(Value("", state, "word", f"{W}.state_{limit.goal.of}", f"{W}.{state}"))
        demands.append(_demand(search, n, limit.least or 0.0 if limit.equal else value, kinds[n], asked=limit.equal))
    for name, x in zip(asked.low, found.x, strict=True):
        if min(x, 1 - x) < ACTIVE:
            more.append(Value("", name, "word", f"{W}.bound", name))
    history = found.evolved.history
    kept = history[:, 1] == 0
    generation = np.arange(len(history))
    so_far = _shown(search, np.fmin.accumulate(np.where(kept, history[:, 0], np.nan)))
    curve = Diagram(
        "history", f"{W}.history", (f"{W}.generation", "number"), (f"{W}.best_{asked.objective.of}", kinds[0]),
        (Line(f"{W}.evolution", generation, so_far),
         Line(f"{W}.polished", np.array([len(history)]), np.array([found.values[0]]), dots=True)),
    )  # fmt: skip
    notes = (f"{W}.stopped",) if found.evolved.stopped else ()
    return Outcome(tuple(given), (*numbers, *more), f"{W}.source", tuple(demands), (curve,), notes)


def _shown(search: Search, f: Real) -> Real:
    """The history of the objective in its own unit; of a target as far above it as the best candidate is from it."""
    if search.asked.target is not None:
        return search.asked.target * (1 + f)
    return -f if search.asked.objective.of in LEAST else f


def _demand(search: Search, n: int, value: float, kind: str, *, asked: bool) -> Demand:
    goal = search.goals[n]
    at = 1e-6 if kind in ("length", "angle") and goal.of not in PLAIN else 0.0
    return Demand(f"{W}.{goal.of}", value, kind, lambda results: measure(goal, results), asked=asked, at=at)
