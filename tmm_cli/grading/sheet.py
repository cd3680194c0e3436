"""Students' answers and right answers as arrays (students, answers), with relative errors and tolerances."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from tmm_cli.batch import Question, VariantFamily, numeric_leaves, with_numbers
from tmm_cli.grading.mistakes.base import Mistake, Solution, solve_with_mistakes
from tmm_cli.mechanics.analysis import NamedQuantity
from tmm_cli.mechanics.groups import ClosedFormSolver
from tmm_cli.mechanics.numerics import Real, Vector
from tmm_cli.mechanics.quantities import (
    MOMENT,
    Dimension,
)

DRAWN, COMPUTED = 0.005, 0.0005  # how exactly lengths are taken off a drawing (0.5 mm of 100 mm), and computed with
STEP = 1e-6  # by which lengths are changed to see what hangs on them
NOTHING = 1e-9  # of the largest value of its kind: what rounding leaves of zero
SAME = 1e-6  # of a number that is exact, as a class is


@dataclass(frozen=True)
class WrittenAnswers:
    """Answers as the students wrote them.

    Attributes:
        value: answers (students, answers), SI; complex for vectors; nan if missing.
        size: True where a vector is given by its magnitude alone, same shape.
    """

    value: Vector
    size: Real

    @cached_property
    def given(self) -> Real:
        return ~np.isnan(self.value)

    def take(self, rows: Real) -> WrittenAnswers:
        """Return the answers of the students with these indices; an index may occur more than once."""
        return WrittenAnswers(self.value[rows], self.size[rows])


@dataclass(frozen=True)
class RightAnswers:
    """Right answers of the students' variants.

    Attributes:
        asked: the questions.
        value: correct values, SI, (students, answers); complex for vectors.
        scale: reference values (SI) of relative errors, same shape.
        allowed: largest permitted relative errors, same shape.
    """

    asked: tuple[Question, ...]
    value: Vector
    scale: Real
    allowed: Real

    def error(self, written: WrittenAnswers, value: Vector | None = None) -> Real:
        """Return the relative errors of written answers, (students, answers); nan for missing answers.

        value: values to compare with, SI; by default the right ones.
        """
        wanted = self.value if value is None else value
        gap = np.abs(written.value - wanted)
        sizes = np.abs(np.abs(written.value) - np.abs(wanted))
        gap = np.where(written.size, sizes, gap)
        turns = [k for k, one in enumerate(self.asked) if one.quantity.against == "angle"]
        gap[..., turns] = np.abs(np.remainder(gap[..., turns] + np.pi, 2 * np.pi) - np.pi)
        with np.errstate(divide="ignore", invalid="ignore"):
            share: Real = gap / self.scale
        return np.where(np.isnan(wanted) & written.given, 0.0, share)  # where nothing is right nothing is judged

    def repeat_question(self, rows: Sequence[int], k: int, count: int) -> RightAnswers:
        """Return the right answers of students `rows` to question `k`, repeated in `count` columns.

        It is used to compare several readings of one answer, e.g. in different units, with the correct value at once.
        """
        own = (part[rows, k][:, None] for part in (self.value, self.scale, self.allowed))
        return RightAnswers((self.asked[k],) * count, *own)

    def take(self, rows: Real) -> RightAnswers:
        """Return the right answers of the students with these indices; an index may occur more than once."""
        return RightAnswers(self.asked, self.value[rows], self.scale[rows], self.allowed[rows])


def predict_answers(family: VariantFamily, asked: Sequence[Question], mistakes: Sequence[Mistake] = ()) -> Vector:
    """Return the answers that students would write if they made these mistakes, (students, answers), SI."""
    return write_down_answers(solve_with_mistakes(family, mistakes), asked, mistakes)


def write_down_answers(solution: Solution, asked: Sequence[Question], mistakes: Sequence[Mistake] = ()) -> Vector:
    """Return the answers that a student with this solution writes down, (students, answers), SI.

    mistakes: mistakes made in writing the answers down, e.g. a wrong unit.
    """
    return np.stack([_write_down_answer(one, solution, mistakes) for one in asked], axis=1)


def _write_down_answer(asked: Question, solution: Solution, mistakes: Sequence[Mistake]) -> Vector:
    values = evaluate_quantity(asked.quantity, solution)
    for mistake in mistakes:
        values = mistake.change_values(asked.quantity, values, solution)
    return values[:, asked.position or 0].astype(complex)


def evaluate_quantity(quantity: NamedQuantity, solution: Solution) -> Real:
    """Return the values of a quantity, (variants, positions); (variants, 1) for a quantity of the whole mechanism."""
    found = np.asarray(quantity.read(solution))
    return np.broadcast_to(found, (len(solution.family), found.shape[-1]))


def compute_right_answers(family: VariantFamily, asked: Sequence[Question]) -> RightAnswers:
    """Compute the right answers of a family of variants with their tolerances.

    A tolerance combines the one set in the task with the change of the answer caused by small errors of the lengths, as
    in drawing or rounding.
    """
    solution = solve_with_mistakes(family)
    value = np.stack([_write_down_answer(one, solution, ()) for one in asked], axis=1)
    scale = _reference_values(asked, solution)
    places = sorted({0, *(one.position or 0 for one in asked)})  # the motion starts in position 0
    there = [replace(one, position=places.index(one.position or 0)) for one in asked]
    close = family.changed(family.linkage, family.q[:, places])
    change = (
        np.abs(
            np.concatenate(
                [predict_answers(other, there).reshape(-1, *value.shape) - value for other in _perturb_lengths(close)]
            )
        )
        / STEP
    )
    with np.errstate(divide="ignore", invalid="ignore"):
        response = np.sqrt(np.sum(change**2, axis=0)) / scale
    exactly = np.array([DRAWN if one.drawn else COMPUTED for one in asked])
    allowed = np.hypot([one.tolerance for one in asked], exactly * np.nan_to_num(response))
    exact = [one.quantity.against == "exact" for one in asked]
    return RightAnswers(tuple(asked), value, scale, np.where(exact, SAME, allowed))


def _reference_values(asked: Sequence[Question], solution: Solution) -> Real:
    """Return the reference values (SI) of relative errors, (variants, answers).

    For a quantity that is zero throughout the cycle, the reference value is a typical magnitude of its dimension.
    """
    found = np.stack([_reference_value(one.quantity, solution) for one in asked], axis=1)
    usual = _typical_magnitudes(solution)
    for k, one in enumerate(asked):
        if one.quantity.against in ("largest", "range"):
            size = usual(one.quantity.dimension)
            found[:, k] = np.where(found[:, k] > NOTHING * size, found[:, k], size)
    return found


def _typical_magnitudes(solution: Solution) -> Callable[[Dimension], Real]:
    """Return a function that gives the typical magnitude (SI) of a dimension, (variants,).

    It is estimated from the longest link, the speed of the driver and the loads.
    """
    motion, loads = solution.motion, solution.reactions.applied
    size = np.reshape(np.max([np.max(kernel.size, initial=0.0) for kernel in motion.kernels] or [1.0]), (-1,))
    rate = np.maximum(np.nanmax(np.abs(motion.rate), axis=1), NOTHING)
    turn = rate if motion.linkage.driver.kind == "turn" else rate / size
    force = np.maximum(sum(np.nanmax(np.abs(load.force), axis=1) for load in loads), NOTHING)
    moment = size * force + sum(np.nanmax(np.abs(load.moment), axis=1) for load in loads)

    def typical(dimension: Dimension) -> Real:
        if dimension == MOMENT:
            return np.asarray(moment)
        masses = dimension.mass  # a force stands for the mass, which it accelerates by size turn^2
        magnitude = force**masses * size ** (dimension.length - masses) * turn ** -(dimension.time + 2 * masses)
        return np.asarray(magnitude)

    return typical


def _reference_value(quantity: NamedQuantity, solution: Solution) -> Real:
    """Return the value (SI) by which errors of a quantity are divided to make them relative, (variants,).

    It is the largest value in the cycle or the range of the quantity; 1 for angles and for quantities that must be
    exact.
    """
    values = evaluate_quantity(quantity, solution)
    if quantity.against in ("angle", "exact"):
        return np.ones(len(values))
    if quantity.against == "range":
        return np.asarray(np.nanmax(values, axis=1) - np.nanmin(values, axis=1))
    return np.asarray(np.nanmax(np.abs(values), axis=1))


def _perturb_lengths(family: VariantFamily) -> Iterator[VariantFamily]:
    """Yield the family with slightly changed data: the lengths of one link after another, then the driver coordinate.

    If the group solvers accept lengths that differ between variants, all changes are made in one large family, in which
    the variants are repeated. Otherwise one family is yielded for each change.
    """
    of = {
        link: [
            path
            for path, value in numeric_leaves(family.linkage)
            if path.startswith(f"links.{link}.points.") and np.any(value != 0)
        ]
        for link in family.linkage.links
    }
    links = [link for link, paths in of.items() if paths]
    if all(not isinstance(kernel, ClosedFormSolver) or kernel.plain for kernel in family.kernels):
        which = np.repeat(np.arange(len(links) + 1), len(family))[:, None]
        parts = [(which, family.take(np.tile(np.arange(len(family)), len(links) + 1)))]
    else:
        parts = [(np.array(k), family) for k in range(len(links) + 1)]
    for which, part in parts:
        found = dict(numeric_leaves(part.linkage))
        lengths = {
            path: found[path] * np.where(which == k, 1 + STEP, 1.0) for k, link in enumerate(links) for path in of[link]
        }
        q = part.q + np.where(which == len(links), STEP, 0.0)
        yield part.changed(with_numbers(part.linkage, lengths), q)
