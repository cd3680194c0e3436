"""Candidates of an optimal synthesis: variants of a file's linkage, evaluated a whole generation at once."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from tmm_cli.assembly.choose import assemble
from tmm_cli.assembly.solvable import mobile
from tmm_cli.errors import LinkageError, _
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.driver_range import cycle_of
from tmm_cli.kinematics.motion import Motion
from tmm_cli.linkage import Linkage, Sketch
from tmm_cli.synthesis.optimal.quantities.assembles import SIDE, Assembles
from tmm_cli.synthesis.optimal.quantities.base import CLOSELY, Goal, Over
from tmm_cli.synthesis.optimal.task import Constraint, Keys, Task
from tmm_cli.synthesis.record import Infeasible
from tmm_cli.variants.one_by_one import OneByOne, variants_of
from tmm_cli.variants.stack import numbers as numbers_of
from tmm_cli.variants.taped import Taped
from tmm_cli.variants.variant import Places, alike, sketch_of
from tmm_cli.vectors import Real

ROOM = 1e-6  # of the size of a group: it can be assembled in all positions with so much to spare
EACH = 24  # positions of the search in each turn of a cycle of many, at least
SCAN, SCAN_EACH = 720, 240  # places where peaks are looked for before the polish; in each turn of many, at least
BLOCK = 125  # candidates at once
POPULATION, LEAST_POPULATION = 20, 80  # a parameter, at least
GENERATIONS, LEAST_GENERATIONS = 25, 200  # a parameter squared, at least: what problems of 3 to 9 parameters need
FEW, FEW_GENERATIONS = 8, 15  # a parameter, where candidates are moved one by one, which takes 5 to 100 ms each
NONE = 1e6  # violation where nothing can be told
LOST = 10.0  # violation of what cannot be assembled, above all others
TRIES = 40  # of linkages within the bounds, for one that can be assembled
SHARES = (0.0, 0.137, 0.382, 0.618, 0.871, 1.0)  # of its range: where a parameter is looked at
MOST_LOOKED = 100  # of its values, where it has some only


def first_of(task: Task) -> list[float]:
    """Numbers (SI) of a linkage that can be assembled as the file sketches it: the middle of the bounds, or others.

    Raises Infeasible.
    """
    low, high = np.array(list(task.low.values())), np.array(list(task.high.values()))
    chance = np.random.default_rng(0)
    for share in (np.full(len(low), 0.5), *chance.random((TRIES, len(low)))):
        numbers: list[float] = task.near(low + share * (high - low)).tolist()
        linkage = task.make(numbers).linkage
        try:
            assemble(linkage, mobile(linkage))
        except LinkageError:
            continue
        return numbers
    raise Infeasible(
        "vary",
        _("no linkage within these bounds can be assembled as it is sketched"),
        _("other bounds; or a sketch that fits, e.g. with places that rest on the parameters"),
    )


class Search:
    """A task ready for evaluation. Raises Infeasible."""

    def __init__(self, task: Task, first: Sequence[float] | None = None) -> None:
        """first: numbers that can be assembled, if they are known."""
        self.task = task
        self.low, self.high = np.array(list(task.low.values())), np.array(list(task.high.values()))
        self.constraints = (Constraint(Assembles(), least=ROOM), *task.constraints)
        self.quantities = (task.objective, *(constraint.quantity for constraint in self.constraints))
        self.first = first_of(task) if first is None else list(first)
        self.variant = task.make(self.first)
        self.linkage = self.variant.linkage
        self.groups = mobile(self.linkage).solved
        self._check_parameters()
        self._check_quantities()
        self._check_cycle()
        self._record()

    def _check_parameters(self) -> None:
        """Every parameter changes something. Raises Infeasible."""
        before = dict(numbers_of(self.variant))
        for k, name in enumerate(self.task.low):
            other = list(self.first)
            low, high = float(self.low[k]), float(self.high[k])
            other[k] = low if abs(other[k] - low) > abs(other[k] - high) else high
            if dict(numbers_of(self.task.make(other))) == before:
                raise Infeasible(
                    ("vary", name),
                    _("nothing in the file rests on this parameter"),
                    _("a parameter that lengths, places, masses or loads of the file rest on"),
                )

    def _check_quantities(self) -> None:
        """The linkage has what is asked of it. Raises Infeasible."""
        asked: list[tuple[Keys, Goal]] = [(("objective",), self.task.objective)]
        asked += [(constraint.at, constraint.quantity) for constraint in self.task.constraints]
        for at, quantity in asked:
            unfit = quantity.unfit(self.linkage, self.groups, closed=self.variant.ends is None)
            if unfit is not None:
                raise Infeasible(at, *unfit)

    def _check_cycle(self) -> None:
        """All candidates come round again after as many turns of the crank. Raises Infeasible.

        Toothed wheels and further drivers come round together only where their ratios are those of whole numbers.
        """
        geared = any(mesh.kind == "gear" for mesh in self.linkage.meshes) or self.linkage.others
        moves = any(quantity.moves for n, quantity in enumerate(self.quantities) if n != 1)
        if not geared or self.variant.ends is not None or not moves:
            return
        kernels = assemble(self.linkage, mobile(self.linkage))
        for k, name in enumerate(self.task.low):
            turns: set[Any] = set()  # or ratios with which all never comes round again
            own = self.task.values.get(name) or [self.low[k] + x * (self.high[k] - self.low[k]) for x in SHARES]
            for number in own[:: -(-len(own) // MOST_LOOKED)]:
                numbers = [*self.first[:k], float(number), *self.first[k + 1 :]]
                if self.task.accepts(numbers):
                    linkage = self.task.make(numbers).linkage
                    turns.add(cycle_of(linkage, kernels) or _ratios(linkage))
            if len(turns) > 1:
                raise Infeasible(
                    ("vary", name), _("after how many turns all comes round again rests on this parameter"),
                    _("another parameter; or over: [from, to]"),
                )  # fmt: skip

    def _record(self) -> None:
        """The program of all candidates, the driver's range and the places at which they are looked at."""
        self.program: Taped | OneByOne = variants_of(
            self.task.make, self.first, self.outputs, forces=any(quantity.forces for quantity in self.quantities),
            one_sense=self.task.one_sense(self.first),
        )  # fmt: skip
        self.taped = isinstance(self.program, Taped)
        self.coarse = self.program.without(CLOSELY)
        kinds = [getattr(kernel, "assemblies", 0) for kernel in self.program.kernels]
        self.single = tuple(f"1.{SIDE}{k}" for k in range(kinds.count(1)))
        ranges = self.program.driver_range(np.array([self.first]))
        self.closed, self.cycle = ranges.closed, float(ranges.span[0, 0])
        self.ends = float(ranges.low[0, 0]), float(ranges.low[0, 0] + ranges.span[0, 0])
        self.turns = max(1, round(self.cycle / (2 * np.pi))) if self.closed else 1
        self.count, self.scan = max(self.task.positions, EACH * self.turns), max(SCAN, SCAN_EACH * self.turns)
        loads = self.linkage.loads
        rough = bool(self.linkage.friction) or any(x.working_stroke_only or x.table for x in loads)
        self.jumps = self.closed and self.variant.accelerated  # forces at the end of the cycle are not those before it
        self.overs = tuple(
            Over(
                not quantity.slides(self.linkage, self.groups), self.closed and not (self.jumps and quantity.forces),
                self.cycle, rough, quantity.counts(self.linkage), self.taped,
            )
            for quantity in self.quantities
        )  # fmt: skip
        self.exact, at = [], self.count + self.jumps  # places of the quantities after those over the range; else those
        for n, quantity in enumerate(self.quantities):
            own = len(quantity.places)
            self.exact.append(slice(at, at + own) if own else self.along(n, self.count))
            at += own
        wanted = np.concatenate([np.zeros(0), *(np.array(quantity.places) for quantity in self.quantities)])
        self.places = Places(self.over(self.count), self.with_sketch(wanted))

    def sketch(self, x: Real) -> Sketch | None:
        """How a candidate looks at the place of the sketch, where the file's own sketch does not show its assembly."""
        numbers = self.numbers(x)
        own = self.program.sketch(numbers)
        try:
            linkage = self.task.make(numbers.tolist()).linkage
            shown = sketch_of(linkage, assemble(linkage, mobile(linkage)))
        except LinkageError:
            return own
        return None if alike(own, shown) else own

    @property
    def population(self) -> int:
        each, most = (POPULATION, LEAST_POPULATION) if self.taped else (FEW, 2 * FEW)
        return self.task.population or max(most, each * len(self.low))

    @property
    def generations(self) -> int:
        if not self.taped:
            return self.task.generations or FEW_GENERATIONS * (1 + len(self.low))
        return self.task.generations or max(LEAST_GENERATIONS, GENERATIONS * len(self.low) ** 2)

    def outputs(self, motion: Motion, reactions: Reactions | None) -> dict[str, Any]:
        return {
            f"{n}.{name}": value for n, quantity in enumerate(self.quantities)
            for name, value in quantity.outputs(motion, reactions).items()
        }  # fmt: skip

    def numbers(self, x: Real) -> Real:
        """SI numbers of shares of the ranges."""
        found: Real = self.low + x * (self.high - self.low)
        return self.task.near(found) if self.task.values else found

    def shares(self, numbers: Real) -> Real:
        """Shares of the ranges at which numbers lie."""
        found: Real = (numbers - self.low) / (self.high - self.low)
        return found

    def run(self, x: Real, places: Places, *, closely: bool = True) -> Mapping[str, Real]:
        """All outputs for candidates x (variants, n) in 0..1, or but for those that are wanted for windows alone."""
        return (self.program if closely else self.coarse)(self.numbers(x), places)

    def over(self, count: int) -> Real:
        """Shares of the range: of a closed one without its end, but after it where forces are others there."""
        shares = np.arange(count) / (count if self.closed else count - 1)
        return np.append(shares, 1.0) if self.jumps else shares

    def along(self, n: int, count: int) -> slice:
        """Which of these shares count for a quantity."""
        return slice(0, count + 1 if self.jumps and not self.overs[n].closed else count)

    def with_sketch(self, driver: Real) -> Real:
        """Places of the driver, and that of the sketch, where it counts."""
        return np.append(driver, self.linkage.sketch.at) if self.single else driver

    def turned_over(self, found: Mapping[str, Real], count: int) -> Real:
        """Which variants pass a dead position that they do not stop at, (variants,), from so many shares."""
        over: Any = False
        for name in self.single:
            det = np.hstack([found[name][:, :count], found[name][:, -1:]])
            over = over | (np.min(det, axis=1) * np.max(det, axis=1) <= 0)
        return np.asarray(over)

    def evaluate(self, x: Real) -> tuple[Real, Real]:
        """Objective and violation of candidates, block by block, so that all of a block stays in the cache."""
        blocks = [self._evaluate(part) for part in np.array_split(x, -(-len(x) * self.turns // BLOCK))]
        return np.concatenate([f for f, __ in blocks]), np.concatenate([v for __, v in blocks])

    def _evaluate(self, x: Real) -> tuple[Real, Real]:
        with np.errstate(all="ignore"):
            values = self.values(x)
            both = zip(self.constraints, values[1:], strict=True)
            violation = sum(constraint.missed(value) for constraint, value in both)
            lost = self.constraints[0].missed(values[1])
            violation = np.where(lost > 0, LOST + 10 * lost, violation)
            violation = np.where(np.isfinite(violation), violation, NONE)
            wanted = self.wanted(values[0])
            return np.where(np.isnan(wanted), np.inf, wanted), violation

    def values(self, x: Real) -> list[Real]:
        """Objective and constrained quantities, coarsely."""
        found = self.run(x, self.places, closely=False)
        values = [
            quantity.coarse(reader(found, n, self.exact[n]), self.overs[n])
            for n, quantity in enumerate(self.quantities)
        ]  # fmt: skip
        values[1] = np.where(self.turned_over(found, self.count), -1.0, values[1])
        return values

    def wanted(self, value: Real) -> Real:
        """What is made least: of a margin its opposite, of a target the distance from it."""
        if self.task.target is not None:
            return np.abs(value - self.task.target) / (abs(self.task.target) or 1.0)
        return -value if self.task.objective.lowest else value


def _ratios(linkage: Linkage) -> tuple[str, ...]:
    """Of speeds of wheels and drivers, to 12 digits: what they come round together hangs on."""
    wheels = [mesh.ratio for mesh in linkage.meshes if mesh.kind == "gear"]
    return tuple(f"{ratio:.12g}" for ratio in (*wheels, *(o.rate / linkage.driver.rate for o in linkage.others)))


def reader(found: Mapping[str, Real], n: int, where: slice) -> Callable[[str], Real]:
    """Outputs of a quantity by name, at some of the places."""
    return lambda name: found[f"{n}.{name}"][:, where]
