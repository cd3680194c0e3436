"""Optimal synthesis: the task, and its checks before the search."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tmm_cli.batch import Make, numeric_leaves as numbers_of
from tmm_cli.language import _
from tmm_cli.mechanics.assembly import analyse_mobile_structure, assemble
from tmm_cli.mechanics.errors import LinkageError
from tmm_cli.mechanics.kinematics import cycle_turns
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import Real
from tmm_cli.synthesis.optimal.quantities.base import MechanismQuantity
from tmm_cli.synthesis.record import Infeasible

Keys = tuple[str | int, ...]  # path inside the block


@dataclass(frozen=True)
class Parameter:
    """A varied parameter.

    Attributes:
        name: name of the parameter.
        low, high: bounds (SI).
        kind: name of its dimension.
        values: admissible discrete values (SI) in ascending order; () if the parameter is continuous.
    """

    name: str
    low: float
    high: float
    kind: str
    values: tuple[float, ...] = ()


@dataclass(frozen=True)
class QuantityConstraint:
    """A constraint: least <= quantity <= most. With equal bounds it is an equality.

    Attributes:
        quantity: quantity of the mechanism.
        least, most: bounds (SI); None for no bound.
        at: path of the key of the constraint in the block.
    """

    quantity: MechanismQuantity
    least: float | None = None
    most: float | None = None
    at: Keys = ()

    @property
    def equal(self) -> bool:
        return self.least is not None and self.least == self.most

    @property
    def scale(self) -> float:
        """Value by which violations of the constraint are divided to make them relative."""
        if self.quantity.lowest:
            return 1.0
        return max(abs(self.least or 0.0), abs(self.most or 0.0)) or 1.0

    def compute_violation(self, value: Any) -> Any:
        """Return the violation relative to `scale`: 0 if the constraint is satisfied, inf if the quantity is
        undefined.
        """
        low = 0.0 if self.least is None else self.least - value
        high = 0.0 if self.most is None else value - self.most
        missed = np.maximum(np.maximum(low, high), 0.0) / self.scale
        return np.where(np.isnan(missed), np.inf, missed)

    def rows(self, low: Any, high: Any) -> tuple[list[Any], list[Any]]:
        """Return the values by which an optimiser recognises whether the constraint is satisfied, divided by `scale`.

        Args:
            low, high: values of the quantity to be compared with the lower and with the upper bound.

        Returns:
            Inequalities (satisfied if >= 0) and equalities (satisfied if 0).
        """
        if self.equal:
            return [], [(low - self.least) / self.scale]
        least = [] if self.least is None else [(low - self.least) / self.scale]
        return [*least, *([] if self.most is None else [(self.most - high) / self.scale])], []

    def find_violated_bound(self, value: float) -> tuple[float, Keys]:
        """Return the bound that a value violates, and the path of its key in the file."""
        low = self.least is not None and value < self.least
        bound = self.least if low else self.most
        assert bound is not None
        both = not self.equal and self.least is not None and self.most is not None
        return bound, (*self.at[:-1], "least" if low else "most") if both else self.at


@dataclass(frozen=True)
class OptimalTask:
    """An optimal synthesis.

    Attributes:
        parameters: varied parameters.
        make: function that builds the linkage, with its driver range, for parameter values (SI).
        objective: quantity to be optimised.
        constraints: constraints.
        target: value (SI) to which the objective is brought close; None to minimise the objective.
        positions: number of positions per cycle during the search.
        population, generations: size of a generation and number of generations; 0 to choose them by the number of
            parameters.
        seed: seed of the random numbers.
        accepts: function that returns True if the file is valid with these parameter values (SI).
        progress: function that is called with the current generation and the number of generations.
    """

    parameters: tuple[Parameter, ...]
    make: Make = field(compare=False)
    objective: MechanismQuantity
    constraints: tuple[QuantityConstraint, ...] = ()
    target: float | None = None
    positions: int = 72
    population: int = 0
    generations: int = 0
    seed: int = 1
    accepts: Callable[[Sequence[float]], bool] = field(default=lambda numbers: True, compare=False)
    progress: Callable[[int, int], None] = field(default=lambda at, of: None, compare=False)

    @property
    def free(self) -> list[int]:
        """Indices of the continuous parameters."""
        return [k for k, parameter in enumerate(self.parameters) if not parameter.values]

    def vary_parameter(self, first: Sequence[float], k: int, numbers: Sequence[float]) -> list[list[float]]:
        """Return copies of the parameter values `first` in which parameter k has other values.

        Copies that the file rejects are omitted.
        """
        tried = ([*first[:k], float(number), *first[k + 1 :]] for number in numbers)
        return [numbers_tried for numbers_tried in tried if self.accepts(numbers_tried)]


def nearest_allowed(numbers: Any, parameters: Sequence[Parameter]) -> Real:
    """Return parameter values (..., n) with discrete parameters rounded to the nearest admissible value."""
    nearest = np.array(numbers, dtype=float)
    for k, parameter in enumerate(parameters):
        if parameter.values:
            allowed = np.array(parameter.values)
            nearest[..., k] = allowed[np.searchsorted((allowed[1:] + allowed[:-1]) / 2, nearest[..., k])]
    return nearest


# Checks of a task before its search.


TRIES = 40  # random linkages tried until one can be assembled
SHARES = (0.0, 0.137, 0.382, 0.618, 0.871, 1.0)  # of its range: values at which a parameter is checked
MOST_LOOKED = 100  # values of a discrete parameter that are checked


def find_first(task: OptimalTask) -> list[float]:
    """Return parameter values (SI) with which the linkage can be assembled as sketched.

    The middle of the bounds is tried first, then random values.

    Raises:
        Infeasible: the linkage cannot be assembled with any of them.
    """
    low, high = (np.array([getattr(p, end) for p in task.parameters]) for end in ("low", "high"))
    chance = np.random.default_rng(0)
    for share in (np.full(len(low), 0.5), *chance.random((TRIES, len(low)))):
        numbers: list[float] = nearest_allowed(low + share * (high - low), task.parameters).tolist()
        linkage = task.make(numbers).linkage
        try:
            assemble(linkage, analyse_mobile_structure(linkage))
        except LinkageError:
            continue
        return numbers
    raise Infeasible("vary", _("within these bounds no linkage can be assembled as the sketch shows"))


def check_task(task: OptimalTask, first: Sequence[float]) -> None:
    """Check a task before the search.

    Every parameter must have an effect, the linkage must have all quantities, and all candidates must have the same
    cycle.

    Raises:
        Infeasible: one of these conditions is not met.
    """
    variant = task.make(first)
    before = dict(numbers_of(variant))
    for k, p in enumerate(task.parameters):
        other = list(first)
        other[k] = p.low if abs(first[k] - p.low) > abs(first[k] - p.high) else p.high
        if dict(numbers_of(task.make(other))) == before:
            raise Infeasible(("vary", p.name), _("nothing in the file depends on this parameter"))
    groups, closed = analyse_mobile_structure(variant.linkage).solved, variant.ends is None
    for at, quantity in ((("objective",), task.objective), *((c.at, c.quantity) for c in task.constraints)):
        unfit = quantity.unfit(variant.linkage, groups, closed=closed)
        if unfit is not None:
            raise Infeasible(at, unfit)
    if closed:
        _check_cycle(task, first, variant.linkage)


def _check_cycle(task: OptimalTask, first: Sequence[float], linkage: Linkage) -> None:
    """Raise Infeasible if the number of crank revolutions in a cycle is not the same for all candidates.

    Gears and further drivers have a common cycle only if their speed ratios are ratios of integers.
    """
    geared = any(mesh.kind == "gear" for mesh in linkage.meshes) or linkage.others
    moves = any(quantity.moves for quantity in (task.objective, *(c.quantity for c in task.constraints)))
    if not geared or not moves:
        return
    kernels = assemble(linkage, analyse_mobile_structure(linkage))
    for k, p in enumerate(task.parameters):
        checked_values = p.values or [p.low + share * (p.high - p.low) for share in SHARES]
        turns: set[Any] = set()  # or the ratios, if there is no common cycle
        for numbers in task.vary_parameter(first, k, checked_values[:: -(-len(checked_values) // MOST_LOOKED)]):
            other = task.make(numbers).linkage
            turns.add(cycle_turns(other, kernels) or _list_speed_ratios(other))
        if len(turns) > 1:
            reason = _(
                "the number of revolutions in a cycle depends on this parameter; it must be the same for all candidates"
            )
            raise Infeasible(("vary", p.name), reason)


def _list_speed_ratios(linkage: Linkage) -> tuple[str, ...]:
    """Return the speed ratios of gears and drivers to 12 digits, as texts."""
    wheels = [mesh.ratio for mesh in linkage.meshes if mesh.kind == "gear"]
    return tuple(f"{ratio:.12g}" for ratio in (*wheels, *(o.rate / linkage.driver.rate for o in linkage.others)))


def has_one_sense(task: OptimalTask, first: Sequence[float]) -> bool:
    """Return True if every driver moves in the same direction in all candidates."""
    senses = set()
    for k, p in enumerate(task.parameters):
        for numbers in task.vary_parameter(first, k, (p.low, p.high)):
            linkage = task.make(numbers).linkage
            senses.add(tuple(driver.sense for driver in (linkage.driver, *linkage.others)))
    return len(senses) <= 1
