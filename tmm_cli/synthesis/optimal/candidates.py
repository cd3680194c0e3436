"""Candidates of an optimal synthesis: variants of the linkage of a file, evaluated one generation at a time."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from tmm_cli.batch import (
    WANTED,
    DriverSamples,
    SequentialVariants,
    TracedVariants,
    compute_sketch,
    make_variants,
    same_assembly,
)
from tmm_cli.mechanics.assembly import analyse_mobile_structure, assemble
from tmm_cli.mechanics.errors import LinkageError
from tmm_cli.mechanics.forces import Reactions
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import Sketch
from tmm_cli.mechanics.numerics import Real
from tmm_cli.synthesis.optimal.quantities.base import CLOSELY, MechanismQuantity, QuantityRange, Read
from tmm_cli.synthesis.optimal.quantities.transmission import SIDE, AssemblyReserve
from tmm_cli.synthesis.optimal.task import (
    OptimalTask,
    QuantityConstraint,
    check_task,
    find_first,
    has_one_sense,
    nearest_allowed,
)

ROOM = 1e-6  # relative to the size of a group: reserve of its assembly in all positions
EACH = 24  # positions per revolution during the search, at least
SCAN, SCAN_EACH = 720, 240  # positions scanned for peaks before the refinement; per revolution, at least
BLOCK, FOLLOWED = 125, 500  # candidates in a block; with continuation, which makes many calls for each block
POPULATION, LEAST_POPULATION = 20, 80  # for each parameter; at least
GENERATIONS, LEAST_GENERATIONS = (
    25,
    200,
)  # times the squared number of parameters; at least: enough for 3 to 9 parameters
FEW, FEW_GENERATIONS = 8, 15  # for each parameter, if candidates are evaluated one by one, in 5 to 100 ms each
FEWEST = 8  # smallest population
NONE = 1e6  # violation if it is undefined
LOST = 10.0  # violation of linkages that cannot be assembled, above all others


class Candidates:
    """Evaluator of the candidates of a task.

    A candidate is given by x, the fractions 0..1 of the ranges of its parameters; arrays of candidates have the shape
    (variants, parameters). A constraint is added before those of the task: the linkage can be assembled in all
    positions.

    Args:
        task: task of the optimal synthesis.

    Raises:
        Infeasible: the task fails the checks before the search.
    """

    def __init__(self, task: OptimalTask) -> None:
        self.task = task
        self.low, self.high = (np.array([getattr(p, end) for p in task.parameters]) for end in ("low", "high"))
        self.constraints = (QuantityConstraint(AssemblyReserve(), least=ROOM), *task.constraints)
        self.quantities = (task.objective, *(constraint.quantity for constraint in self.constraints))
        self.first = find_first(task)
        check_task(task, self.first)
        self.variant = task.make(self.first)
        self.linkage = self.variant.linkage
        self.groups = analyse_mobile_structure(self.linkage).solved
        self._build_program()
        self._set_positions()

    def _build_program(self) -> None:
        """Prepare the function that computes all quantities of candidates at driver coordinates.

        If possible, the computation is recorded once and then repeated for many candidates at a time.
        """
        self.program: TracedVariants | SequentialVariants = make_variants(
            self.task.make,
            self.first,
            self.outputs,
            forces=any(quantity.forces for quantity in self.quantities),
            one_sense=has_one_sense(self.task, self.first),
        )
        self.traced = isinstance(self.program, TracedVariants)
        self.coarse = self.program.without(CLOSELY)
        kinds = [getattr(kernel, "assemblies", 0) for kernel in self.program.kernels]
        self.single = tuple(f"1.{SIDE}{k}" for k in range(kinds.count(1)))

    def _set_positions(self) -> None:
        """Determine the range of the driver and the positions at which the search evaluates candidates."""
        ranges = self.program.driver_range(np.array([self.first]))
        self.closed, self.cycle = ranges.closed, float(ranges.span[0, 0])
        self.ends = float(ranges.low[0, 0]), float(ranges.low[0, 0] + ranges.span[0, 0])
        self.turns = max(1, round(self.cycle / (2 * np.pi))) if self.closed else 1
        self.count, self.scan = max(self.task.positions, EACH * self.turns), max(SCAN, SCAN_EACH * self.turns)
        rough = bool(self.linkage.friction) or self.linkage.by_strokes
        self.jumps = (
            self.closed and self.variant.accelerated
        )  # forces at the end of the cycle differ from those at its start
        self.overs = tuple(
            QuantityRange(
                self.linkage,
                not quantity.slides(self.linkage, self.groups),
                self.closed and not (self.jumps and quantity.forces),
                self.cycle,
                rough,
                self.traced,
            )
            for quantity in self.quantities
        )
        own_slices = self.slice_own_coordinates(self.count + self.jumps)
        self.exact = [own_slice or self.slice_samples(n, self.count) for n, own_slice in enumerate(own_slices)]
        self.places = DriverSamples(self.sample_range(self.count), self.append_sketch(np.zeros(0)), asked=True)

    def outputs(self, motion: Motion, reactions: Reactions | None) -> dict[str, Any]:
        return {
            f"{n}.{name}": value
            for n, quantity in enumerate(self.quantities)
            for name, value in quantity.outputs(motion, reactions).items()
        }

    @property
    def population(self) -> int:
        each, most = (POPULATION, LEAST_POPULATION) if self.traced else (FEW, 2 * FEW)
        return max(FEWEST, self.task.population or max(most, each * len(self.low)))

    @property
    def generations(self) -> int:
        if not self.traced:
            return self.task.generations or FEW_GENERATIONS * (1 + len(self.low))
        return self.task.generations or max(LEAST_GENERATIONS, GENERATIONS * len(self.low) ** 2)

    def numbers(self, x: Real) -> Real:
        """Convert fractions of the ranges to parameter values (SI)."""
        return nearest_allowed(self.low + x * (self.high - self.low), self.task.parameters)

    def shares(self, numbers: Real) -> Real:
        """Convert parameter values (SI) to fractions of the ranges."""
        fractions: Real = (numbers - self.low) / (self.high - self.low)
        return fractions

    def sample_range(self, count: int) -> Real:
        """Return `count` evenly spaced fractions of the driver range.

        For a full cycle its end, which equals its start, is omitted. It is appended only if forces differ between both.
        """
        shares = np.arange(count) / (count if self.closed else count - 1)
        return np.append(shares, 1.0) if self.jumps else shares

    def slice_samples(self, n: int, count: int) -> slice:
        """Return the samples of the driver range that quantity `n` uses, as a slice of those of `sample_range`."""
        return slice(0, count + 1 if self.jumps and not self.overs[n].closed else count)

    def slice_own_coordinates(self, count: int) -> list[slice | None]:
        """Return, for each quantity, the slice of the driver coordinates at which it has required values.

        The slices refer to an array that contains `count` samples of the driver range, followed by these coordinates of
        all quantities. The slice is None for a quantity without such coordinates.
        """
        ends = count + np.cumsum([0, *(len(quantity.places) for quantity in self.quantities)])
        return [slice(first, last) if first < last else None for first, last in pairwise(ends.tolist())]

    def quantity(self, n: int, numbers: Real) -> MechanismQuantity:
        """Return quantity `n` with the driver coordinates and required values that it has for the parameter values
        `numbers` (SI).
        """
        first, template = sum(len(quantity.places) for quantity in self.quantities[:n]), self.quantities[n]
        variant, last = self.task.make(numbers.tolist()), first + len(template.places)
        template = replace(template, places=tuple(map(float, variant.asked[first:last])))
        return (
            replace(template, wanted=tuple(map(float, variant.wanted[first:last])))
            if template.given == "values"
            else template
        )

    def append_sketch(self, driver: Real) -> Real:
        """Append the driver coordinate of the sketch to an array of driver coordinates, if it is needed.

        It is needed if dead positions are detected by comparing the sign of a determinant with its sign in the sketch.
        """
        return np.append(driver, self.linkage.sketch.at) if self.single else driver

    def run(self, x: Real, positions: DriverSamples) -> Mapping[str, Real]:
        """Compute candidates at driver positions; return the outputs of all quantities by name."""
        return self.program(self.numbers(x), positions)

    def evaluate(self, x: Real) -> tuple[Real, Real]:
        """Return the objective and the constraint violation of candidates, each of shape (variants,).

        Candidates are computed in blocks that fit into the processor's cache.
        """
        block = FOLLOWED if isinstance(self.program, TracedVariants) and self.program.continuation else BLOCK
        blocks = [self._evaluate(chunk) for chunk in np.array_split(x, -(-len(x) * self.turns // block))]
        return np.concatenate([f for f, __ in blocks]), np.concatenate([v for __, v in blocks])

    def _evaluate(self, x: Real) -> tuple[Real, Real]:
        with np.errstate(all="ignore"):
            values = self.values(x)
            both = zip(self.constraints, values[1:], strict=True)
            violation = sum(constraint.compute_violation(value) for constraint, value in both)
            lost = self.constraints[0].compute_violation(values[1])
            violation = np.where(lost > 0, LOST + 10 * lost, violation)
            violation = np.where(np.isfinite(violation), violation, NONE)
            objective = self.objective_value(values[0])
            return np.where(np.isnan(objective), np.inf, objective), violation

    def evaluate_coarsely(
        self, x: Real
    ) -> tuple[Mapping[str, Real], list[tuple[MechanismQuantity, Read, QuantityRange]]]:
        """Compute candidates at the positions of the search.

        Returns:
            Outputs by name. For each quantity also the quantity itself, the function that reads the outputs it needs,
            and the range of the driver.
        """
        outputs = self.coarse(self.numbers(x), self.places)
        numbered = enumerate(zip(self.quantities, self.exact, self.overs, strict=True))
        return outputs, [
            (quantity, quantity_reader(outputs, n, where), over) for n, (quantity, where, over) in numbered
        ]

    def values(self, x: Real) -> list[Real]:
        """Return approximate values of the objective and of the constrained quantities, each of shape (variants,)."""
        outputs, parts = self.evaluate_coarsely(x)
        values = [quantity.coarse(read, over) for quantity, read, over in parts]
        values[1] = np.where(self.passes_dead_position(outputs, self.count), -1.0, values[1])
        return values

    def passes_dead_position(self, outputs: Mapping[str, Real], count: int) -> Real:
        """Return True for each variant in which an Assur group passes through a dead position between samples,
        (variants,).

        Args:
            outputs: outputs of the variants by name.
            count: number of samples of the driver range.
        """
        over: Any = False
        for name in self.single:
            det = np.hstack([outputs[name][:, :count], outputs[name][:, -1:]])
            over = over | (np.min(det, axis=1) * np.max(det, axis=1) <= 0)
        return np.asarray(over)

    def objective_value(self, value: Real) -> Real:
        """Return the value that the search minimises.

        A quantity that is to be maximised (a margin) is multiplied by -1. For a quantity with a target, the value is
        the relative distance from the target.
        """
        if self.task.target is not None:
            return np.abs(value - self.task.target) / (abs(self.task.target) or 1.0)
        return -value if self.task.objective.lowest else value

    def sketch(self, x: Real) -> Sketch | None:
        """Return the assembly of a candidate at the driver coordinate of the sketch.

        The result is None if the sketch of the file selects the same assembly.
        """
        numbers = self.numbers(x)
        candidate_sketch = self.program.sketch(numbers)
        try:
            linkage = self.task.make(numbers.tolist()).linkage
            file_sketch = compute_sketch(linkage, assemble(linkage, analyse_mobile_structure(linkage)))
        except LinkageError:
            return candidate_sketch
        return None if same_assembly(candidate_sketch, file_sketch) else candidate_sketch


def quantity_reader(outputs: Mapping[str, Real], n: int, where: slice) -> Callable[[str], Real]:
    """Return a function that reads an output of quantity `n` by name, at the positions in a slice."""
    return lambda name: outputs[name if name == WANTED else f"{n}.{name}"][:, where]
