"""Error carried forward: an answer that follows correctly from the student's wrong earlier answers earns its points."""

from __future__ import annotations

from collections.abc import Container, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from tmm_cli.batch import Question, VariantFamily
from tmm_cli.grading.diagnose import Claim
from tmm_cli.grading.mistakes.base import Mistake, solve_with_mistakes
from tmm_cli.grading.mistakes.motion import Coriolis, SolverWithCrankPin, SolverWithTerms
from tmm_cli.grading.sheet import RightAnswers, WrittenAnswers, write_down_answers
from tmm_cli.mechanics.analysis import NamedQuantity
from tmm_cli.mechanics.forces import AppliedLoad
from tmm_cli.mechanics.groups import (
    Accel,
    Accels,
    DriverStates,
    GroupReactions,
    GroupSolver,
    Placement,
    Poses,
    Rate,
    Rates,
    WrappedSolver,
    Wrench,
)
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import Real, Vector, cross, squared_length


@dataclass(frozen=True)
class OwnMotion(Mistake):
    """Replacement of a correct velocity or acceleration by the student's answer.

    It may be that of a point, or the angular velocity ω or angular acceleration ε of a link.

    Attributes:
        point: name of the point or centre of mass; empty for ω and ε.
        link: link whose ω, ε or centre of mass is replaced; empty for a point.
        given: the students' values, (students, 1), SI.
        order: 1 for a velocity, 2 for an acceleration.
        rate, gain: velocity and acceleration of the driver, which convert these values to the transfer functions that
            the group solvers use.
    """

    point: str
    link: str
    given: Vector
    order: int
    rate: Real
    gain: Real

    def change_solver(self, kernel: GroupSolver, family: VariantFamily) -> GroupSolver:
        links = family.linkage.links
        if any(name == self.link or self.point in links[name].points for name in kernel.group.links):
            return SolverWithOwnMotion.around(kernel, self, family.linkage)
        return kernel


@dataclass(frozen=True)
class SolverWithOwnMotion(WrappedSolver):
    """Solver of a group in which one link moves as the student answered; links outside the group keep their motion."""

    own: OwnMotion
    linkage: Linkage

    def _find_hinge(self, link: str) -> tuple[str, complex, complex] | None:
        """Find the hinge between a link of the group and a link outside it; return None if there is none.

        Returns:
            Name of the outer link, and coordinates (m) of the hinge in the axes of the outer link and of the link
            itself.
        """
        for pair in self.group.outer:
            if pair.kind == "R" and self.group.own(pair) == link:
                other = pair.other(link)
                return other, self.linkage.local(other, pair.point), self.linkage.local(link, pair.point)
        return None

    def rates(self, at: Placement, poses: Poses, rates: Rates, drives: DriverStates) -> tuple[Rate, ...]:
        found = super().rates(at, poses, rates, drives)
        if self.own.order != 1:
            return found
        value = self.own.given / self.own.rate
        return tuple(self._replace_rate(*of, poses, rates, value) for of in zip(self.group.links, found, strict=True))

    def _replace_rate(self, link: str, right: Rate, poses: Poses, rates: Rates, value: Vector) -> Rate:
        z, hinge, points = poses[link].z, self._find_hinge(link), self.linkage.links[link].points
        if not self.own.point and (link == self.own.link or self._slides_on_link(link)):
            if hinge is None:
                return replace(right, w=np.real(value))
            known, there, here = hinge
            return Rate.through(rates[known].at(there * poses[known].z), np.real(value), here * z)
        if self.own.point not in points and not (link == self.own.link and self.own.point):
            return right
        place = self._local_point(link) * z
        if hinge is None or np.all(place == hinge[2] * z):
            return Rate.through(value, right.w, place)
        known, there, here = hinge
        arm = place - here * z
        w = cross(arm, value - rates[known].at(there * poses[known].z)) / squared_length(arm)
        return Rate.through(value, w, place)

    def _slides_on_link(self, link: str) -> bool:
        """Return True if a link and the link of the student's answer form a prismatic pair, so that they rotate
        together.
        """
        pairs = [pair for pair in self.group.inner if pair.kind == "P"]
        return any({pair.i, pair.j} == {link, self.own.link} for pair in pairs)

    def _local_point(self, link: str) -> complex:
        own = self.linkage.links[link]
        return own.points.get(self.own.point, own.centre)

    def accelerations(
        self, at: Placement, poses: Poses, rates: Rates, accels: Accels, drives: DriverStates
    ) -> tuple[Accel, ...]:
        found = super().accelerations(at, poses, rates, accels, drives)
        if self.own.order != 2:
            return found
        return tuple(
            self._replace_acceleration(*of, poses, rates, accels) for of in zip(self.group.links, found, strict=True)
        )

    def _replace_acceleration(self, link: str, right: Accel, poses: Poses, rates: Rates, accels: Accels) -> Accel:
        z, w, hinge = poses[link].z, rates[link].w, self._find_hinge(link)
        own, points = self.own, self.linkage.links[link].points
        if link == own.link and not own.point:
            e = np.real(own.given - w * own.gain) / own.rate**2
            if hinge is None:
                return replace(right, e=e)
            known, there, here = hinge
            return Accel.through(accels[known].at(there * poses[known].z, rates[known].w), e, w, here * z)
        if own.point not in points and link != own.link:
            return right
        place = self._local_point(link) * z
        value = (own.given - rates[link].at(place) * own.gain) / own.rate**2
        if hinge is None or np.all(place == hinge[2] * z):
            return Accel.through(value, right.e, w, place)
        known, there, here = hinge
        arm = place - here * z
        e = cross(arm, value - accels[known].at(there * poses[known].z, rates[known].w)) / squared_length(arm)
        return Accel.through(value, e, w, place)


@dataclass(frozen=True)
class OwnSpeed(Mistake):
    """Replacement of the correct crank speed by the student's, rad/s."""

    given: Vector

    def change_family(self, family: VariantFamily) -> VariantFamily:
        driver = family.linkage.driver
        rate: Any = np.abs(np.real(self.given))
        return family.changed(replace(family.linkage, driver=replace(driver, rate=rate)))


@dataclass(frozen=True)
class OwnCrankPin(Mistake):
    """A wrong velocity of the crank pin, from which the student computed all other velocities.

    All velocities of the links after the crank are multiplied by `factor`, (students, 1). Accelerations are computed
    with the changed velocities.
    """

    factor: Real

    def change_solver(self, kernel: GroupSolver, family: VariantFamily) -> GroupSolver:
        terms = SolverWithTerms.of(kernel, family.linkage, lambda pair, *states: pair.velocity_terms(*states))
        return SolverWithCrankPin.around(terms, self.factor, frozenset(crank.link for crank in family.linkage.cranks))


@dataclass(frozen=True)
class OwnInertia(Mistake):
    """Replacement of the correct inertia force or inertia couple of a link by the student's."""

    link: str
    part: str
    given: Vector

    def change_load(self, load: AppliedLoad, motion: Motion, family: VariantFamily) -> AppliedLoad:
        if load.kind != "inertia" or load.link != self.link:
            return load
        value = self.given if self.part == "force" else np.real(self.given)
        return replace(load, **{self.part: value + 0 * getattr(load, self.part)})


@dataclass(frozen=True)
class OwnReaction(Mistake):
    """Replacement of the correct reaction in a pair by the student's; on: the link on which the reaction acts."""

    pair: str
    on: str
    given: Vector

    def change_solver(self, kernel: GroupSolver, family: VariantFamily) -> GroupSolver:
        pairs = (*kernel.group.outer, *kernel.group.inner)
        return SolverWithOwnReaction.around(kernel, self) if any(pair.name == self.pair for pair in pairs) else kernel


@dataclass(frozen=True)
class SolverWithOwnReaction(WrappedSolver):
    """Solver of a group in which one reaction is replaced by the student's."""

    own: OwnReaction

    def reactions(self, at: Placement, poses: Poses, applied: tuple[Wrench, ...]) -> GroupReactions:
        found = super().reactions(at, poses, applied)
        outer, inner = list(found.outer), list(found.inner)
        for of, pairs, on in ((outer, self.group.outer, self.group.own), (inner, self.group.inner, self.inner_on)):
            for k, pair in enumerate(pairs):
                if pair.name == self.own.pair:
                    force = self.own.given + 0 * of[k].force
                    of[k] = replace(of[k], force=force if on(pair) == self.own.on else -force)
        return replace(found, outer=tuple(outer), inner=tuple(inner))


def replace_by_own_answer(quantity: NamedQuantity, value: Vector, motion: Motion, right: Vector) -> Mistake | None:
    """Replace a quantity by the students' values, to judge the quantities that depend on it.

    Args:
        quantity: Quantity to replace.
        value: Values of the students, (students, 1), SI.
        motion: Motion of their variants.
        right: Correct values, (students, 1).

    Returns:
        The replacement, which is used in the same way as a mistake; None if no later quantity depends on this one.
    """
    kind, linkage = quantity.name.partition(" of ")[0], motion.linkage
    thing = quantity.thing
    if kind in ("v", "a") and quantity.vector:
        point = thing if any(thing in linkage.links[name].points for name in linkage.moving) else ""
        link = "" if point else thing.removeprefix("S")
        return OwnMotion(point or thing, link, value, 1 if kind == "v" else 2, motion.rate, motion.acceleration)
    if kind == "omega" and thing == linkage.driver.link and linkage.driver.kind == "turn":
        return None if np.any(linkage.driver.acceleration != 0) else OwnSpeed(value)
    if kind in ("omega", "epsilon"):
        return OwnMotion("", thing, value, 1 if kind == "omega" else 2, motion.rate, motion.acceleration)
    if kind == "Coriolis":
        runner, _on, carrier = quantity.name.removeprefix("Coriolis of ").partition(" on ")
        share: Any = np.real(value / np.where(right == 0, 1, right))
        return Coriolis(runner, carrier, share)
    if kind in ("U", "M"):
        return OwnInertia(thing, "force" if kind == "U" else "moment", value)
    if quantity.on:
        return OwnReaction(thing, quantity.on, value)
    return None


# Following errors: an answer that is right given the student's own earlier answers earns its points.
#
# Earlier is what the order of the work has before it, at the same position. Each wrong answer is first tried with one
# earlier answer in the place of the right one, then with all of them.


Cell = tuple[int, int]  # a student and an answer
CRANK_PIN = "crank pin"


def find_carried_errors(
    family: VariantFamily, right: RightAnswers, written: WrittenAnswers
) -> dict[Cell, tuple[int, ...]]:
    """Find wrong answers that follow correctly from the student's wrong earlier answers.

    An answer is earlier if it belongs to the same position and to the same or an earlier stage of the calculation. In
    place of the correct value, each wrong answer is checked first with one wrong earlier answer, then with all of them.
    Finally it is checked with the velocity of a hinge that is wrong by the same factor as an earlier answer. If two
    answers follow from each other, the first in the order of the calculation counts as wrong. The order of the
    questions in the file has no effect.

    Returns:
        Indices of the earlier answers, by the indices (student, answer) of the wrong answer.
    """
    wrong = right.error(written) > right.allowed
    whole = _complete_vectors(right, written)
    check = partial(_find_consistent, family, right, written, whole)
    order = work_order(right.asked)
    cells = [
        (n, k)
        for n in np.flatnonzero(np.sum(wrong, axis=1) > 1).tolist()
        for k in sorted(np.flatnonzero(wrong[n]).tolist(), key=order.__getitem__)
    ]
    earlier = {(n, k): _find_earlier(right, wrong, order, n, k) for n, k in cells}
    possible: dict[Cell, list[tuple[int, ...]]] = {cell: [] for cell in cells}
    for joined in (False, True):
        wanted: dict[tuple[int, ...], list[Cell]] = {}
        for cell in cells:
            if not possible[cell]:
                before = tuple(j for j in earlier[cell] if right.asked[j].quantity.order < _stage(right, cell[1]))
                sets = [before] if joined and len(before) > 1 else [] if joined else [(j,) for j in earlier[cell]]
                for sources in sets:
                    wanted.setdefault(sources, []).append(cell)
        for sources, consistent in check(wanted):
            possible[consistent].append(sources)
    found = _without_circles(possible, order)
    hidden: dict[tuple[int, ...], list[Cell]] = {}
    for cell in cells:
        for j in earlier[cell] if cell not in found else ():
            if order[j] < order[cell[1]] and right.asked[j].quantity.stage == "velocities":
                hidden.setdefault((j,), []).append(cell)
    for point in _moving_hinges(family.linkage) if hidden else ():
        for sources, cell in check(hidden, point):
            found.setdefault(cell, sources)
    return found


def _moving_hinges(linkage: Linkage) -> list[str]:
    """Return the names of the hinges whose velocities may be wrong: hinges between moving links, and the crank pin.

    The first name, "", stands for the speed of the crank.
    """
    names = [name for link in linkage.moving for name in linkage.links[link].points]
    fixed = linkage.links[FRAME].points
    return ["", CRANK_PIN, *(name for name in dict.fromkeys(names) if names.count(name) > 1 and name not in fixed)]


def _replace_wrong_velocity(point: str, factor: Real, motion: Motion) -> Mistake:
    """Return a mistake that multiplies the velocity of a hinge by a factor (students, 1).

    point: name of the hinge; "" for the speed of the crank.
    """
    if not point:
        return OwnSpeed(np.asarray(factor * motion.rate, dtype=complex))
    if point == CRANK_PIN:
        return OwnCrankPin(factor)
    linkage = motion.linkage
    link = next(name for name in linkage.moving if point in linkage.links[name].points)
    velocity = motion.point(link, linkage.links[link].points[point]).v
    return OwnMotion(point, "", factor * velocity, 1, motion.rate, motion.acceleration)


def work_order(asked: Sequence[Question]) -> list[int]:
    """Return the rank of each question in the order of the calculation, which need not be their order in the file."""

    def key(k: int) -> tuple[int, bool, int, str]:
        name = asked[k].quantity.name
        return asked[k].quantity.order, not name.startswith(("omega", "epsilon")), asked[k].position or 0, name

    ranked = sorted(range(len(asked)), key=key)
    return [ranked.index(k) for k in range(len(asked))]


def _stage(right: RightAnswers, k: int) -> int:
    return right.asked[k].quantity.order


def _without_circles(possible: dict[Cell, list[tuple[int, ...]]], order: Sequence[int]) -> dict[Cell, tuple[int, ...]]:
    """Choose for each wrong answer the earlier answers from which it follows, so that no answer follows from itself.

    Args:
        possible: for each answer (student, answer), the sets of earlier answers from which it may follow.
        order: rank of each question in the order of the calculation. Answers late in this order are treated first, so
            that the early ones count as wrong.
    """
    found: dict[Cell, tuple[int, ...]] = {}
    for n, k in sorted(possible, key=lambda cell: -order[cell[1]]):
        for sources in possible[n, k]:
            open_ends, seen = list(sources), {*sources}
            while open_ends:
                more = set(found.get((n, open_ends.pop()), ())) - seen
                open_ends.extend(more)
                seen |= more
            if k not in seen:
                found[n, k] = sources
                break
    return found


def _complete_vectors(right: RightAnswers, written: WrittenAnswers) -> Real:
    """Return the written answers with every vector complete.

    A vector that the student gave only by its magnitude gets the direction of the right vector.
    """
    with np.errstate(all="ignore"):
        direction = np.where(right.value == 0, 1, right.value / np.abs(right.value))
    return np.where(written.size, np.abs(written.value) * direction, written.value)


def _find_earlier(right: RightAnswers, wrong: Real, order: Sequence[int], n: int, k: int) -> list[int]:
    """Return the student's wrong answers from which answer `k` may follow, in the order of the calculation.

    They belong to the position of answer `k` and not to a later stage of the calculation.
    """
    asked = right.asked
    found = [
        j
        for j in np.flatnonzero(wrong[n]).tolist()
        if j != k and asked[j].position == asked[k].position and _stage(right, j) <= _stage(right, k)
    ]
    return sorted(found, key=order.__getitem__)


def _find_consistent(
    family: VariantFamily,
    right: RightAnswers,
    written: WrittenAnswers,
    whole: Real,
    wanted: dict[tuple[int, ...], list[Cell]],
    point: str | None = None,
) -> Iterator[tuple[tuple[int, ...], Cell]]:
    """Yield the answers that become right if earlier answers of the student replace the correct values.

    Args:
        family: variants of the students.
        right, written: right answers, and answers of the students.
        whole: answers of the students with complete vectors, (students, answers).
        wanted: answers (student, answer) to check, by the indices of the earlier answers.
        point: hinge whose velocity is wrong by the same factor as the earlier answer; None to replace the value of the
            earlier answer itself.
    """
    for sources, cells in wanted.items():
        students = np.array(sorted({n for n, _ in cells}))
        own = family.take(students)
        motion = solve_with_mistakes(own).motion
        values = [whole[students, j][:, None] for j in sources]
        rights = [right.value[students, j][:, None] for j in sources]
        if point is not None:
            factor = np.real(values[0]) / np.where(rights[0] == 0, 1, np.real(rights[0]))
            mistakes: list[Mistake] = [_replace_wrong_velocity(point, factor, motion)]
        else:
            replaced = (
                replace_by_own_answer(right.asked[j].quantity, v, motion, r)
                for j, v, r in zip(sources, values, rights, strict=True)
            )
            mistakes = [one for one in replaced if one is not None]
        if not mistakes:
            continue
        with np.errstate(all="ignore"):
            value = write_down_answers(solve_with_mistakes(own, mistakes), right.asked)
            part = right.take(students)
            scale = np.maximum(1.0, np.abs(value) / part.scale)
            fits = part.error(written.take(students), value) / scale <= part.allowed
        at = {n: row for row, n in enumerate(students.tolist())}
        yield from ((sources, (n, k)) for n, k in cells if fits[at[n], k])


def find_repeated_mistakes(
    right: RightAnswers, follows: Container[Cell], claims: Mapping[int, Sequence[Claim]]
) -> dict[Cell, int]:
    """Find wrong answers caused by a mistake that has already cost the points of an earlier answer.

    Args:
        right: Right answers.
        follows: Answers (student, answer) that follow correctly from wrong earlier answers.
        claims: Mistakes named for each student, by the student's index.

    Returns:
        Index of the first answer that is wrong because of the mistake, by the indices (student, answer) of the later
        ones.
    """
    order = work_order(right.asked)
    found: dict[Cell, int] = {}
    for n, named in claims.items():
        for claim in named:
            charged = [k for k in claim.answers if (n, k) not in follows and (n, k) not in found]
            first, *later = sorted(charged, key=order.__getitem__) or [-1]
            found |= {(n, k): first for k in later}
    return found
