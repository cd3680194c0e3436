"""Candidates of an optimal synthesis: variants of a file's linkage, evaluated a whole generation at once.

Coarsely from places all round the cycle, for the search; exactly from windows about the peaks, for the polish.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from copy import copy
from typing import Any, Final

import numpy as np

from tmm_cli.assembly import assemble
from tmm_cli.forces.plan import Reactions
from tmm_cli.linkage import Sketch
from tmm_cli.mobile import mobile
from tmm_cli.motion import Motion
from tmm_cli.refused import Refused
from tmm_cli.synthesis.cycles import Cycles
from tmm_cli.synthesis.exactly import exactly
from tmm_cli.synthesis.first import first_of
from tmm_cli.synthesis.goals import CLOSELY, FORCES, LEAST, PEAKS, PLAIN, SIDE, Goal, Over, points_of, spans_of
from tmm_cli.synthesis.optimal_asked import Asked, Limit
from tmm_cli.synthesis.peaks import WINDOW
from tmm_cli.synthesis.polish import Local, polish
from tmm_cli.synthesis.record import Infeasible
from tmm_cli.synthesis.usable import asked_goals, check_output, check_use
from tmm_cli.variants.fastest import Program, fastest
from tmm_cli.variants.sketch import alike, sketch_of
from tmm_cli.variants.way import Places
from tmm_cli.vectors import Real

W: Final = "synthesis_optimal"
ROOM = 1e-6  # of the size of a group: it can be assembled in all positions with so much to spare
EACH = 24  # positions of the search in each turn of a cycle of many, at least
SCAN, SCAN_EACH = 720, 240  # places where peaks are looked for before the polish; in each turn of many, at least
NARROWER = (1.0, 0.3, 0.0, 0.0, 0.0)  # windows of the polish: peaks move in them less and less
ABOUT = 2.0  # places of the scan to either side of a peak that a window takes at least
BLOCK = 125  # candidates at once
CYCLIC = ("k", "speed")  # what only a driver that turns on and on has
POPULATION, LEAST_POPULATION = 20, 80  # a parameter, at least
GENERATIONS, LEAST_GENERATIONS = 25, 200  # a parameter squared, at least: what problems of 3 to 9 parameters need
NONE = 1e6  # violation where nothing can be told
LOST = 10.0  # violation of what cannot be assembled, above all others


class Search:
    """A task ready for evaluation. Raises Infeasible."""

    tries = 40  # of linkages that could tell the assembly

    def __init__(self, asked: Asked, first: Sequence[float] | None = None) -> None:
        """first: numbers that can be assembled, if they are known."""
        self.asked = asked
        self.low, self.high = np.array(list(asked.low.values())), np.array(list(asked.high.values()))
        self.limits = (Limit(Goal("crank"), least=ROOM), *asked.limits)
        self.goals = (asked.objective, *(limit.goal for limit in self.limits))
        self.first = first_of(asked, self.tries) if first is None else list(first)
        self.variant = asked.make(self.first)
        self.linkage = self.variant.linkage
        self.groups = mobile(self.linkage).solved
        self.others: dict[int, Search] = {}
        check_use(self)
        check_output(self)
        self.cycles = self._cycles()
        self._over_turns(self.cycles.of(np.array([self.first]))[0] if self.cycles is not None else 0)
        for at, goal in asked_goals(self):
            if goal.of in CYCLIC and not self.closed:
                raise Infeasible(at, f"{W}.no_cycle", f"{W}.a_crank")

    def _cycles(self) -> Cycles | None:
        """After how many turns candidates come round again, where something belongs to that. Raises Infeasible."""
        geared = any(mesh.kind == "gear" for mesh in self.linkage.meshes) or self.linkage.others
        if not geared or self.variant.ends is not None or all(goal.of in PLAIN for _, goal in asked_goals(self)):
            return None
        return Cycles(self.asked, self.first, assemble(self.linkage, mobile(self.linkage)))

    def _over_turns(self, turns: int) -> None:
        """What hangs on after how many turns the driver's way comes round again; 0: as the file's does."""
        self.program = self._program(turns)
        self.coarse = self.program.without(CLOSELY)
        kinds = [getattr(kernel, "assemblies", 0) for kernel in self.program.kernels]
        self.single = tuple(f"1.{SIDE}{k}" for k in range(kinds.count(1)))
        way = self.program.way(np.array([self.first]))
        self.closed, self.cycle = way.closed, float(way.span[0, 0])
        self.ends = float(way.low[0, 0]), float(way.low[0, 0] + way.span[0, 0])
        self.turns = max(1, round(self.cycle / (2 * np.pi))) if self.closed else 1
        self.count, self.scan = max(self.asked.positions, EACH * self.turns), max(SCAN, SCAN_EACH * self.turns)
        loads = self.linkage.loads
        rough = bool(self.linkage.friction) or any(x.working_stroke_only or x.table for x in loads)
        self.jumps = self.closed and self.variant.accelerated  # forces at the end of the cycle are not those before it
        self.overs = tuple(
            Over(
                not goal.slides(self.linkage, self.groups), self.closed and not (self.jumps and goal.of in FORCES),
                self.cycle, rough, self._counts(goal),
            )
            for goal in self.goals
        )  # fmt: skip
        self.exact, at = [], self.count + self.jumps  # places of the goals after those over the way; else the way
        for n, goal in enumerate(self.goals):
            own = len(goal.places)
            self.exact.append(slice(at, at + own) if own else self.along(n, self.count))
            at += own
        wanted = np.concatenate([np.zeros(0), *(np.array(goal.places) for goal in self.goals)])
        self.places = Places(self.over(self.count), self.with_sketch(wanted))

    def own(self, x: Real) -> Search | None:
        """The same over the cycle of a candidate; None where it has none."""
        if self.cycles is None or not self.cycles.varies:
            return self
        return self._over_cycle(self.cycles.of(self.numbers(x)[None])[0])

    def _over_cycle(self, turns: int) -> Search | None:
        if turns and turns not in self.others:
            self.others[turns] = other = copy(self)
            other.cycles = None
            other._over_turns(turns)
        return self.others.get(turns)

    def sketch(self, x: Real) -> Sketch | None:
        """How a candidate looks at the place of the sketch, where the file's own sketch does not show its assembly."""
        search = self.own(x)
        if search is not None and search is not self:
            return search.sketch(x)
        numbers = self.numbers(x)
        own = self.program.sketch(numbers)
        try:
            linkage = self.asked.make([float(number) for number in numbers]).linkage
            shown = sketch_of(linkage, assemble(linkage, mobile(linkage)))
        except Refused:
            return own
        return None if alike(own, shown) else own

    def _counts(self, goal: Goal) -> tuple[int, ...]:
        if goal.of == "box":
            return (len(points_of(self.linkage)),)
        links = (goal.links or tuple(self.linkage.links)) if goal.of == "length" else ()
        return tuple(len(spans_of(self.linkage, link)) for link in links)

    def _program(self, turns: int) -> Program:
        return fastest(
            self.asked.make, self.first, self._outputs, forces=any(goal.of in FORCES for goal in self.goals),
            turns=turns, other=[self.asked.beside(name, x) for name, x in zip(self.asked.low, self.first, strict=True)],
            alike=not self.asked.reverses(self.first),
        )  # fmt: skip

    @property
    def population(self) -> int:
        return self.asked.population or max(LEAST_POPULATION, POPULATION * len(self.low))

    @property
    def generations(self) -> int:
        return self.asked.generations or max(LEAST_GENERATIONS, GENERATIONS * len(self.low) ** 2)

    def _outputs(self, motion: Motion, reactions: Reactions | None) -> dict[str, Any]:
        return {
            f"{n}.{name}": value for n, goal in enumerate(self.goals)
            for name, value in goal.outputs(motion, reactions).items()
        }  # fmt: skip

    def numbers(self, x: Real) -> Real:
        """SI numbers of shares of the ranges."""
        found: Real = self.low + x * (self.high - self.low)
        return self.asked.near(found) if self.asked.values else found

    def shares(self, numbers: Real) -> Real:
        """Shares of the ranges at which numbers lie."""
        found: Real = (numbers - self.low) / (self.high - self.low)
        return found

    def run(self, x: Real, places: Places, *, closely: bool = True) -> Mapping[str, Real]:
        """All outputs for candidates x (variants, n) in 0..1, or but for those that are wanted for windows alone."""
        return (self.program if closely else self.coarse)(self.numbers(x), places)

    def over(self, count: int) -> Real:
        """Shares of the way: of a closed one without its end, but after it where forces are others there."""
        shares = np.arange(count) / (count if self.closed else count - 1)
        return np.append(shares, 1.0) if self.jumps else shares

    def along(self, n: int, count: int) -> slice:
        """Which of these shares count for a goal."""
        return slice(0, count + 1 if self.jumps and not self.overs[n].closed else count)

    def with_sketch(self, driver: Real) -> Real:
        """Places of the driver, and that of the sketch, where it counts."""
        return np.append(driver, self.linkage.sketch.at) if self.single else driver

    def turned_over(self, found: Mapping[str, Real], count: int) -> Real:
        """Which variants pass a dead position that they do not stop at, (variants,), from so many shares of the way."""
        over: Any = False
        for name in self.single:
            det = np.hstack([found[name][:, :count], found[name][:, -1:]])
            over = over | (np.min(det, axis=1) * np.max(det, axis=1) <= 0)
        return np.asarray(over)

    def evaluate(self, x: Real) -> tuple[Real, Real]:
        """Objective and violation of candidates, block by block, so that all of a block stays in the cache."""
        if self.cycles is not None and self.cycles.varies:
            return self._by_cycles(x, np.array(self.cycles.of(self.numbers(x))))
        blocks = [self._evaluate(part) for part in np.array_split(x, -(-len(x) * self.turns // BLOCK))]
        return np.concatenate([f for f, _ in blocks]), np.concatenate([v for _, v in blocks])

    def _by_cycles(self, x: Real, turns: Real) -> tuple[Real, Real]:
        """Each over its own cycle."""
        f, v = np.full(len(x), np.inf), np.full(len(x), NONE)
        for count in set(turns.tolist()):
            search, rows = self._over_cycle(count), turns == count
            if search is not None:
                f[rows], v[rows] = search.evaluate(x[rows])
        return f, v

    def _evaluate(self, x: Real) -> tuple[Real, Real]:
        with np.errstate(all="ignore"):
            values = self.values(x)
            violation = sum(limit.missed(v) for limit, v in zip(self.limits, values[1:], strict=True))
            lost = self.limits[0].missed(values[1]) * self.limits[0].scale
            violation = np.where(lost > 0, LOST + 10 * lost, violation)
            violation = np.where(np.isfinite(violation), violation, NONE)
            wanted = self.wanted(values[0])
            return np.where(np.isnan(wanted), np.inf, wanted), violation

    def values(self, x: Real) -> list[Real]:
        """Objective and constrained quantities, coarsely."""
        found = self.run(x, self.places, closely=False)
        values = [goal.coarse(_reader(found, n, self.exact[n]), self.overs[n]) for n, goal in enumerate(self.goals)]
        values[1] = np.where(self.turned_over(found, self.count), -1.0, values[1])
        return values

    def wanted(self, value: Real) -> Real:
        """What is made least: of a margin its opposite, of a target the distance from it."""
        if self.asked.target is not None:
            return np.abs(value - self.asked.target) / (abs(self.asked.target) or 1.0)
        return -value if self.asked.objective.of in LEAST else value

    def closely(self, x: Real, narrow: float = 0.0) -> Callable[[Real], list[Real]]:
        """Pieces of every goal near x, exactly: windows are where x has its peaks.

        narrow: their width against that for the first steps of the polish; they are never narrower than the scan needs.
        """
        scan = self.over(self.scan)
        found = self.run(np.stack([x, x]), Places(scan, np.zeros(0)))
        half = max(narrow / self.count, ABOUT / self.scan)
        step = 2 * half / (WINDOW - 1)
        blocks, parts = [], []
        at = 0
        for n, goal in enumerate(self.goals):
            own = []
            for name, k in goal.windows(_reader(found, n, self.along(n, self.scan)), self.overs[n]):
                first = scan[k] - half
                if not self.overs[n].closed:
                    first = min(max(first, 0.0), 1 - 2 * half)
                blocks.append(first + step * np.arange(WINDOW))
                own.append((name, float(first), slice(at, at + WINDOW)))
                at += WINDOW
            parts.append(own)
        blocks.append(np.zeros(1))
        at, exact = at + 1, []
        for goal in self.goals:
            exact.append(slice(at, at + len(goal.places)) if goal.places else slice(at - 1, at))
            at += len(goal.places)
        places = Places(np.concatenate(blocks), self.places.driver)
        near = self.program.about(self.numbers(x))

        def pieces(some: Real) -> list[Real]:
            out = near(self.numbers(np.atleast_2d(some)), places)

            return [
                goal.fine(
                    [(c, s, _reader(out, n, w)) for c, s, w in parts[n]], _reader(out, n, exact[n]), self.overs[n],
                    step,
                )
                for n, goal in enumerate(self.goals)
            ]  # fmt: skip

        return pieces

    def exactly(self, x: Real) -> list[float]:
        """Objective and constrained quantities of one candidate."""
        own = self.own(x)
        if own is self:
            return exactly(self, x)
        return [np.nan, -1.0, *(np.nan for _ in self.limits[1:])] if own is None else own.exactly(x)

    def polished(self, x: Real) -> Real:
        """The best place near x, whose numbers that have some values only stay as they are."""
        own = self.own(x)
        if own is not self or not self.asked.free:
            return x if own is None or own is self else own.polished(x)
        free, whole = self.asked.free, x

        def all_of(some: Real) -> Real:
            """Candidates with all their numbers."""
            found = np.repeat(whole[None], len(np.atleast_2d(some)), axis=0)
            found[:, free] = some
            return found

        for narrow in NARROWER:
            before = x
            try:
                pieces = self.closely(x, narrow)
                top = float(np.max(np.abs(self._pieces(pieces(x)[0])))) or 1.0
                with np.errstate(all="ignore"):
                    best = polish(lambda some: self._local(all_of(some), pieces(all_of(some)), top), x[free])  # noqa: B023
                x = all_of(best)[0]
            except np.linalg.LinAlgError:
                return before
            if not narrow and float(np.max(np.abs(x - before))) < 1e-9:
                break
        return x

    def _pieces(self, objective: Real) -> Real:
        if self.asked.target is not None:
            return ((objective - self.asked.target) / (abs(self.asked.target) or 1.0)) ** 2
        if self.asked.objective.of in LEAST:
            return -objective
        squares = self.asked.objective.wanted and self.asked.objective.norm == "least squares"
        return objective**2 if squares else objective

    def _local(self, x: Real, found: list[Real], top: float) -> Local:
        """What the polish needs of candidates x."""
        least, equal = [], []
        for limit, pieces in zip(self.limits, found[1:], strict=True):
            extreme = np.min if limit.goal.of in LEAST else np.max
            value = extreme(pieces, axis=1, keepdims=True)
            if limit.equal:
                equal.append((value - limit.least) / limit.scale)
                continue
            each = limit.goal.of in PEAKS
            if limit.least is not None:
                least.append(((pieces if each and limit.goal.of in LEAST else value) - limit.least) / limit.scale)
            if limit.most is not None:
                least.append((limit.most - (pieces if each and limit.goal.of not in LEAST else value)) / limit.scale)
        none = np.zeros((len(found[0]), 0))
        return Local(self._pieces(found[0]) / top, np.hstack([none, *least]), np.hstack([none, *equal]))


def _reader(found: Mapping[str, Real], n: int, where: slice) -> Callable[[str], Real]:
    """Outputs of a goal by name, at some of the places."""
    return lambda name: found[f"{n}.{name}"][:, where]
