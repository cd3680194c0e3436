"""The nearest bounds of an optimal synthesis that hold a mechanism which goes its way, where the given ones hold none.

The same search over wider bounds, in which what lies beyond the given ones is made least.
"""

from __future__ import annotations

from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tmm_cli.synthesis.candidates import Search
from tmm_cli.synthesis.evolution import evolve
from tmm_cli.synthesis.first import NoneAssembled, first_of, shown
from tmm_cli.synthesis.goals import Goal
from tmm_cli.synthesis.optimal_asked import Asked
from tmm_cli.synthesis.polish import Local
from tmm_cli.synthesis.record import Infeasible, Shown
from tmm_cli.vectors import Real

TIMES = (5.0, 3.0, 1.5, 1.1)  # as wide: of the larger bound, as far as the file takes it
GENERATIONS = 120
BEYOND = 1e-9  # shares of the range: what is less is within
ROOM = 1e-3  # of what lies beyond, by which the bounds told are wider still, so that the search finds its way there
KEPT = 1e-7
STEPS = 65  # on the way to what the sketch shows, where it does not show the nearest mechanism


class Wider(Search):
    """A task over other bounds, whose objective is by how much a candidate lies beyond those of `asked`.

    In shares of the given ranges, summed up; sides: of each number whether it may lie below, within or above (-1, 0,
    1), or anywhere (nan).
    """

    tries = 400

    def __init__(self, asked: Asked, low: Real, high: Real, sides: Real) -> None:
        self.own_low, self.own_high = np.array(list(asked.low.values())), np.array(list(asked.high.values()))
        self.sides = sides
        names = list(asked.low)
        wide = replace(
            asked, low=dict(zip(names, low.tolist(), strict=True)), high=dict(zip(names, high.tolist(), strict=True)),
            objective=Goal("length"), target=None,
        )  # fmt: skip
        super().__init__(wide)

    def within(self, low: Real, high: Real, sides: Real) -> Wider:
        """The same over other bounds."""
        other = copy(self)
        other.low, other.high, other.sides = low, high, sides
        other.others = {}
        return other

    def beyond(self, x: Real) -> Real:
        """(variants, n)"""
        numbers, span = self.numbers(x), self.own_high - self.own_low
        below, above = (self.own_low - numbers) / span, (numbers - self.own_high) / span
        either = np.maximum(np.maximum(below, above), 0.0)
        found: Real = np.where(
            np.isnan(self.sides), either, np.where(self.sides > 0, above, np.where(self.sides < 0, below, 0))
        )
        return found

    def wanted(self, value: Real) -> Real:
        return value

    def _evaluate(self, x: Real) -> tuple[Real, Real]:
        return self.beyond(x).sum(axis=1), super()._evaluate(x)[1]

    def exactly(self, x: Real) -> list[float]:
        return [float(self.beyond(x[None]).sum()), *super().exactly(x)[1:]]

    def _local(self, x: Real, found: list[Real], top: float) -> Local:
        return replace(super()._local(x, found, top), pieces=self.beyond(np.atleast_2d(x)).sum(axis=1, keepdims=True))

    def kept(self, numbers: Real) -> bool:
        """Whether they keep the constraints."""
        return self.missed(self.exactly(self.shares(numbers))) <= KEPT

    def beyond_by(self, numbers: Real) -> tuple[tuple[str, bool, float, str], ...]:
        """Which bounds they lie beyond, with a little room: name, whether above, value, its kind."""
        found, span = [], self.own_high - self.own_low
        for n, name in enumerate(self.asked.low):
            for above, past in ((False, self.own_low[n] - numbers[n]), (True, numbers[n] - self.own_high[n])):
                if past > BEYOND * span[n]:
                    value = float(numbers[n] + (ROOM if above else -ROOM) * past)
                    found.append((name, above, value, self.asked.kinds[name]))
        return tuple(found)

    def missed(self, values: list[float]) -> float:
        """By how much the constraints are."""
        return float(sum(limit.missed(v) for limit, v in zip(self.limits, values[1:], strict=True)))


@dataclass(frozen=True)
class Nearest:
    """Numbers (SI) of the nearest mechanism, and which bounds it lies beyond: name, whether above, value, its kind.

    keeps: the constraints, which no mechanism was found to keep where it is False. sketched: as the file has it.
    """

    numbers: Real
    beyond: tuple[tuple[str, bool, float, str], ...]
    keeps: bool = True
    sketched: bool = True

    @property
    def told(self) -> tuple[str, dict[str, Shown]]:
        """The end of the key of words that say so, and their values."""
        values: dict[str, Shown] = {}
        for n, (name, above, value, kind) in enumerate(self.beyond, 1):
            values |= {
                f"name{n}": (name, "word"), f"side{n}": ("to" if above else "from", "word"),
                f"value{n}": (value, kind, "least" if above else "most"),
            }  # fmt: skip
        return f"wider{len(self.beyond)}" + ("" if self.sketched else "_sketch"), values


def nearest(asked: Asked) -> Nearest | None:
    """The nearest mechanism that goes its way and keeps the constraints, else one that goes its way; None: none found.

    Near is what lies beyond the bounds by the least sum of shares of their ranges.
    """
    for limits in dict.fromkeys((asked.limits, ())):
        found = _nearest(replace(asked, limits=limits))
        if found is not None:
            return replace(found, keeps=limits == asked.limits)
    return None


def _nearest(asked: Asked) -> Nearest | None:
    low, high = _widest(asked)
    anywhere = np.full(len(low), np.nan)
    try:
        search = Wider(asked, low, high, anywhere)
    except Infeasible:
        return None
    equal = any(limit.equal for limit in search.limits)
    generations = min(search.generations, GENERATIONS)
    evolved = evolve(
        search.evaluate, len(low), population=search.population, generations=generations, seed=asked.seed,
        shrinking=generations // 2 if equal else 0, progress=asked.progress,
    )  # fmt: skip
    if not evolved.violation[0] < 1.0:
        return None
    numbers = search.numbers(evolved.population[0])
    for _ in range(2):
        numbers = _drawn(search, numbers)
    if not search.kept(numbers):
        return None
    found = Nearest(numbers, search.beyond_by(numbers))
    if _sketched(asked, found):
        return found
    way = (numbers + share * (np.array(search.first) - numbers) for share in np.linspace(0, 1, STEPS)[1:])
    there = next((x for x in way if shown(asked, x) and search.kept(x)), None)
    return replace(found, sketched=False) if there is None else Nearest(there, search.beyond_by(there))


def _sketched(asked: Asked, found: Nearest) -> bool:
    """Whether the file's sketch shows a linkage within such bounds, so that a search in them can begin."""
    if shown(asked, found.numbers):
        return True
    low, high = dict(asked.low), dict(asked.high)
    for name, above, value, _ in found.beyond:
        (high if above else low)[name] = value
    try:
        first_of(replace(asked, low=low, high=high), Search.tries)
    except NoneAssembled:
        return False
    return bool(found.beyond)


def _drawn(wide: Wider, numbers: Real) -> Real:
    """As near as the polish leads from some numbers: those that lie within their bounds stay there."""
    span = wide.own_high - wide.own_low
    above, below = numbers > wide.own_high + BEYOND * span, numbers < wide.own_low - BEYOND * span
    sides = above * 1.0 - below
    low = np.where(sides < 0, wide.low, np.where(sides > 0, wide.own_high, wide.own_low))
    high = np.where(sides > 0, wide.high, np.where(sides < 0, wide.own_low, wide.own_high))
    search = wide.within(low, high, sides)
    start = np.clip(search.shares(numbers), 0.0, 1.0)
    best, least = numbers, np.inf  # between the positions of the search it may fail
    for x in (start, search.polished(start)):
        values: Any = search.exactly(x)
        if search.missed(values) <= KEPT and values[0] <= least:
            best, least = search.numbers(x), values[0]
    return best


def _widest(asked: Asked) -> tuple[Real, Real]:
    """As wide bounds as the file takes: of lengths and the like that are above zero they stay so."""
    low, high = np.array(list(asked.low.values())), np.array(list(asked.high.values()))
    middle = (low + high) / 2
    ends: tuple[Real, Real] = (low.copy(), high.copy())
    for n in asked.free:
        for side, end in enumerate(ends):
            for times in TIMES:
                more = (times - 1) * max(abs(low[n]), abs(high[n]))
                far = high[n] + more if side else low[n] / times if low[n] > 0 else low[n] - more
                numbers = middle.copy()
                numbers[n] = far
                if asked.accepts(numbers.tolist()):
                    end[n] = far
                    break
    return ends
