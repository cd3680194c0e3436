"""The nearest bounds of an optimal synthesis that hold a mechanism which goes its way, where the given ones hold none.

The same search over wider bounds, in which what lies beyond the given ones is made least.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import copy
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tmm_cli.synthesis.candidates import Search
from tmm_cli.synthesis.evolution import FINE, evolve
from tmm_cli.synthesis.first import NESTED, first_near
from tmm_cli.synthesis.goals import Goal
from tmm_cli.synthesis.optimal_asked import Asked
from tmm_cli.synthesis.polish import Local
from tmm_cli.synthesis.record import Infeasible, Shown
from tmm_cli.variants.taped import Taped
from tmm_cli.vectors import Real

TIMES = (5.0, 3.0, 1.5, 1.1)  # as wide: of the larger bound, as far as the file takes it
GENERATIONS = 120  # until some mechanism is found,
CLOSER = 60  # and of each search in what is nearer than the nearest known one
ROUNDS = 2  # of those
SPREAD = 60  # candidates tried first in each of the nested bounds
STARTS = 2  # of the polish: the nearest that differ
QUICK = 2  # times as many of all these, and of generations, where candidates move by their tape
WORK = 600_000  # places times candidates that are evaluated in all, about, for one set of constraints,
TAPED = 50  # times as many by their tape,
FEWEST = 20  # and generations of each search at least
APART = 0.05  # by so much, in shares of the given ranges
BEYOND = 1e-9  # shares of the range: what is less is within
ROOM = 1e-3  # of what lies beyond, by which the bounds told are wider still, so that the search finds its way there
KEPT = 1e-7
HALVES = 12  # of a way on which there are mechanisms at first: finer than ROOM; times QUICK by their tape
FIRSTS = 3  # linkages that tell the assembly


@dataclass
class Work:
    """How many places times candidates are left to evaluate, so that a refusal comes in time on any machine; early:
    whether some search was cut short for that.
    """

    left: float = WORK
    early: bool = False

    def generations(self, wanted: int, places: float) -> int:
        """As many of the generations wanted, each of so many places times candidates, as are left; at least a few."""
        allowed = max(FEWEST, int(self.left / places))
        self.early = self.early or allowed < wanted
        self.left -= min(wanted, allowed) * places
        return min(wanted, allowed)


class Wider(Search):
    """A task over other bounds, whose objective is by how much a candidate lies beyond those of `asked`.

    In shares of the given ranges, summed up; sides: of each number whether it may lie below, within or above (-1, 0,
    1), or anywhere (nan).
    """

    def __init__(self, asked: Asked, low: Real, high: Real, sides: Real, first: Sequence[float]) -> None:
        self.own_low, self.own_high = np.array(list(asked.low.values())), np.array(list(asked.high.values()))
        self.sides = sides
        names = list(asked.low)
        wide = replace(
            asked, low=dict(zip(names, low.tolist(), strict=True)), high=dict(zip(names, high.tolist(), strict=True)),
            objective=Goal("length"), target=None,
        )  # fmt: skip
        super().__init__(wide, first)

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

    def far(self, numbers: Real) -> float:
        """By how much they lie beyond the bounds given."""
        return float(np.sum(self.beyond(self.shares(numbers)[None])))

    def holds(self, numbers: Real) -> bool:
        """Whether the file takes them, and they keep the constraints."""
        return self.asked.accepts(numbers.tolist()) and self.kept(numbers)

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

    first: numbers that tell its assembly, perhaps beyond the bounds. keeps: the constraints, which no mechanism was
    found to keep where it is False. early: the search was cut short.
    """

    numbers: Real
    beyond: tuple[tuple[str, bool, float, str], ...]
    first: Sequence[float]
    keeps: bool = True
    early: bool = False

    @property
    def told(self) -> tuple[str, dict[str, Shown]]:
        """The key of words that say so, and their values."""
        values: dict[str, Shown] = {}
        for n, (name, above, value, kind) in enumerate(self.beyond, 1):
            values |= {
                f"name{n}": (name, "word"), f"side{n}": ("to" if above else "from", "word"),
                f"value{n}": (value, kind, "least" if above else "most"),
            }  # fmt: skip
        return f"wider{len(self.beyond)}{'_early' * self.early}", values


def nearest(asked: Asked) -> tuple[Nearest | None, bool]:
    """The nearest mechanism that goes its way and keeps the constraints, else one that goes its way; None: none found.
    And whether the search was cut short.

    Near is what lies beyond the bounds by the least sum of shares of their ranges.
    """
    early = False
    for limits in dict.fromkeys((asked.limits, ())):
        work = Work()
        found = _nearest(replace(asked, limits=limits), work)
        early = early or work.early
        if found is not None:
            return replace(found, keeps=limits == asked.limits, early=early), early
    return None, early


def _nearest(asked: Asked, work: Work) -> Nearest | None:
    """The nearest of the assembly that a file with the bounds told has."""
    low, high = _widest(asked)
    first = first_near(asked, Search.tries, low, high)
    for _ in range(FIRSTS):
        if first is None:
            return None
        found = _nearest_of(asked, low, high, first, work)
        if found is None or not found.beyond:
            return found
        own = dict(asked.low), dict(asked.high)
        for name, above, value, _kind in found.beyond:
            own[above][name] = value
        wider = replace(asked, low=own[0], high=own[1])
        again = first_near(wider, Search.tries, low, high)
        if again is None:
            return None
        if again == first or Wider(wider, low, high, np.full(len(low), np.nan), again).kept(found.numbers):
            return found
        first = again
    return None


def _nearest_of(asked: Asked, low: Real, high: Real, first: Sequence[float], work: Work) -> Nearest | None:
    """The nearest of the assembly that one linkage has."""
    try:
        search = Wider(asked, low, high, np.full(len(low), np.nan), first)
    except Infeasible:
        return None
    starts = _starts(search, work)
    drawn = [_drawn(search, _drawn(search, start)) for start in starts]
    best = min((x for x in drawn if search.holds(x)), key=search.far, default=None)
    if best is None:
        return None
    within = np.clip(best, search.own_low, search.own_high)
    for start in (*starts, within):  # some of which fail between the positions of the search
        aim = np.where(best == within, np.clip(start, search.own_low, search.own_high), start)
        if search.far(aim) < search.far(best):
            best = _towards(search, best, aim)
    return Nearest(best, search.beyond_by(best), first)


def _towards(search: Wider, inside: Real, outside: Real) -> Real:
    """As far from one mechanism towards another place as there are mechanisms."""
    for _ in range(HALVES * (QUICK if isinstance(search.program, Taped) else 1)):
        middle = search.numbers(search.shares((inside + outside) / 2))
        inside, outside = (middle, outside) if search.holds(middle) else (inside, middle)
    return inside


def _starts(search: Wider, work: Work) -> list[Real]:
    """Numbers of mechanisms that differ, the nearest first: found in what is nearer than the nearest known one, again
    and again.
    """
    span, quick = search.own_high - search.own_low, QUICK if isinstance(search.program, Taped) else 1
    numbers, far, missed = _spread(search, SPREAD * quick * quick)
    equal = any(limit.equal for limit in search.limits)
    places = search.population * search.count / (TAPED if quick > 1 else 1)  # of a generation
    reach, seed = np.inf, search.asked.seed
    for n in range(ROUNDS * quick):
        good = missed <= FINE
        reach = float(np.min(far[good], initial=reach))
        if reach <= BEYOND:
            break
        least, most = search.low, search.high
        if np.isfinite(reach):
            least = np.maximum(least, search.own_low - reach * span)
            most = np.minimum(most, search.own_high + reach * span)
        part = search.within(least, most, search.sides)
        generations = min(search.generations, quick * CLOSER if np.isfinite(reach) else GENERATIONS)
        generations = work.generations(generations, places)
        known = part.shares(numbers[good][np.argsort(far[good])[: STARTS * quick]])
        evolved = evolve(
            part.evaluate, len(least), population=search.population, generations=generations, seed=seed + n,
            shrinking=generations // 2 if equal else 0, progress=search.asked.progress, known=np.clip(known, 0, 1),
        )  # fmt: skip
        numbers = np.vstack([numbers, part.numbers(evolved.population)])
        far, missed = np.append(far, evolved.objective), np.append(missed, evolved.violation)
    starts: list[Real] = []
    for k in np.lexsort((far, np.where(missed <= FINE, 0.0, missed))):
        if len(starts) == STARTS * quick or not missed[k] < 1.0:
            break
        if all(np.max(np.abs(numbers[k] - other) / span) > APART for other in starts):
            starts.append(numbers[k])
    return starts


def _spread(search: Wider, count: int) -> tuple[Real, Real, Real]:
    """Numbers spread over wider and wider bounds, how far beyond they lie and what they violate."""
    chance = np.random.default_rng(search.asked.seed)
    tried = []
    for share in (0.0, *NESTED):
        least = search.own_low + share * (search.low - search.own_low)
        most = search.own_high + share * (search.high - search.own_high)
        tried.append(least + chance.random((count, len(least))) * (most - least))
    numbers = search.numbers(search.shares(np.vstack(tried)))
    return (numbers, *search.evaluate(search.shares(numbers)))


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
    middle = asked.near((low + high) / 2)
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
