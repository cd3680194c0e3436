"""Explanation of wrong answers: by typical mistakes, or by the variant of another student.

All answers of a student are compared with the answers that each mistake would produce. A mistake is named only if it
explains them clearly better than any other. Mistakes that cannot be distinguished within the drawing error are named
together. A mistake that changes no answer is not named. Pairs of mistakes are tried if one mistake leaves wrong answers
unexplained.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.batch import VariantFamily
from tmm_cli.grading.mistakes import list_cases
from tmm_cli.grading.mistakes.base import Mistake, solve_with_mistakes
from tmm_cli.grading.mistakes.data import ScaleInverted
from tmm_cli.grading.record import StudentMarks
from tmm_cli.grading.sheet import RightAnswers, WrittenAnswers, predict_answers, write_down_answers
from tmm_cli.language import _
from tmm_cli.mechanics.numerics import Real, Vector

PER_ALLOWED = 3.0  # an answer may be off by so many standard errors of a drawing
CAP = 5.0  # standard errors: what is farther off is off for another reason, and counts no more
GAIN = 12.0  # squares of standard errors that a mistake must explain
MARGIN = 9.0  # by which it must explain more than the next
FIRST = 8  # mistakes that explain most alone: one of a pair is among them
TRIED = 5  # pairs of mistakes that are computed for a student, the best by a first estimate
ALIKE = 3  # kinds of mistakes that may be named together


Explanation = tuple[float, tuple[int, ...], Vector]  # its cost, which cases, and what they would have given


@dataclass(frozen=True)
class Claim:
    """Explanation of some wrong answers of a student by a mistake.

    Attributes:
        alternatives: mistakes that explain these answers equally well; usually one.
        answers: indices of the questions answered wrongly because of it.
    """

    alternatives: tuple[Mistake, ...]
    answers: tuple[int, ...]

    @property
    def description(self) -> str:
        """Sentence for the student about this mistake, or about all alternatives."""
        sentences = list(dict.fromkeys(case.description for case in self.alternatives))
        if len(sentences) == 1:
            return sentences[0]
        return _("One of these mistakes was made; they cannot be distinguished here: {sentences}").format(
            sentences=" ".join(sentences)
        )

    @property
    def label(self) -> str:
        """Name of the mistake in the statistics of the group; alternatives are joined by a slash."""
        return " / ".join(sorted({case.label for case in self.alternatives}))


def diagnose_students(family: VariantFamily, right: RightAnswers, written: WrittenAnswers) -> dict[int, list[Claim]]:
    """Explain the wrong answers of students whose variants form one family.

    Args:
        family: Variants of the students, solved together as arrays.
        right: Right answers, (students, answers).
        written: Answers that the students gave, (students, answers).

    Returns:
        Explanations by the student's index in the family, for students with wrong answers only.
    """
    wrong = right.error(written) > right.allowed
    rows = np.flatnonzero(np.any(wrong, axis=1))
    if not rows.size:
        return {}
    return dict(
        zip(
            rows.tolist(),
            _SheetDiagnosis(family.take(rows), right.take(rows), written.take(rows)).explain_all(),
            strict=True,
        )
    )


class _SheetDiagnosis:
    """Answers of students who made mistakes, and those that each typical mistake would give for their variants."""

    def __init__(self, family: VariantFamily, right: RightAnswers, written: WrittenAnswers) -> None:
        self.family, self.right, self.written, self.cases = family, right, written, list_cases(family)
        plain = solve_with_mistakes(family)
        asked = right.asked
        with np.errstate(all="ignore"):
            self.values = np.stack(
                [
                    predict_answers(family, asked, [case]) if case.solves else write_down_answers(plain, asked, [case])
                    for case in self.cases
                ]
            )
        self.price = np.array([case.price for case in self.cases])
        self.costs = np.stack([self.cost(value) for value in self.values]) + self.price[:, None]
        self.none = self.cost(right.value)
        self.wrong = right.error(written) > right.allowed
        kinds = [type(case) for case in self.cases]
        self.kind = np.array([kinds.index(kind) for kind in kinds])
        self.whole = np.array([kind is not ScaleInverted for kind in kinds])
        self.slips = np.array([c for c, case in enumerate(self.cases) if not case.solves and self.whole[c]])

    def errors(self, value: Vector, rows: Real | None = None) -> Real:
        """Return the differences between the written answers and `value`, in standard errors of a drawing.

        The difference is 0 for a missing answer and infinite where `value` is nan.
        """
        right, written = self.right, self.written
        if rows is not None:
            right, written = right.take(rows), written.take(rows)
        return _errors(right, written, value)

    def cost(self, value: Vector, rows: Real | None = None) -> Real:
        """Return how badly `value` fits the written answers: the sum of squared standard errors, each capped at CAP."""
        return _cost(self.errors(value, rows))

    def explain_all(self) -> Iterator[list[Claim]]:
        """Yield a list of explanations for each student."""
        pairs = self._solve_pairs()
        for n in range(len(self.none)):
            yield self._explain_student(n, pairs.get(n, []))

    def _explain_student(self, n: int, pairs: Sequence[Explanation]) -> list[Claim]:
        costs = self.costs[:, n]
        near = [int(c) for c in np.argsort(costs) if costs[c] <= np.min(costs) + MARGIN]
        single: list[Explanation] = [(float(costs[c]), (c,), self.values[c, n]) for c in near]
        best = single[0]
        if pairs and pairs[0][0] < best[0] - GAIN:
            best = pairs[0]
        found: list[Claim] = []
        if best[0] < self.none[n] - GAIN:
            rivals = [rival for rival in (pairs if len(best[1]) == 2 else single) if rival[0] < best[0] + MARGIN]
            found = self._name_mistakes(n, best, rivals)
        return [*found, *self._find_slips(n, {k for claim in found for k in claim.answers})]

    def _name_mistakes(self, n: int, best: Explanation, rivals: Sequence[Explanation]) -> list[Claim]:
        """Return the mistakes of the best explanation, each with alternatives that explain the answers equally well."""
        found = []
        for c in best[1]:
            others = {
                c,
                *(d for _, own, _ in rivals for d in own if len(best[1]) == 1 or set(own) & set(best[1]) - {c}),
            }
            others -= set(best[1]) - {c}
            alike = [self.cases[d] for d in sorted(others, key=lambda d: self.costs[d, n])]
            answers = self._find_explained_answers(n, best, c)
            if answers and len({type(case) for case in alike}) <= ALIKE:
                found.append(Claim(tuple(alike), answers))
        return found

    def _find_explained_answers(self, n: int, best: Explanation, c: int) -> tuple[int, ...]:
        """Return the indices of the wrong answers that the explanation fits and that mistake number `c` changes."""
        fits = self.errors(best[2][None], np.array([n]))[0] <= PER_ALLOWED
        rest = [d for d in best[1] if d != c]
        without = self.values[rest[0], n] if rest else self.right.value[n]
        with np.errstate(all="ignore"):
            moved = np.abs(best[2] - without) > self.right.allowed[n] * self.right.scale[n] * 0.5
        return tuple(np.flatnonzero(self.wrong[n] & fits & moved).tolist())

    def _find_slips(self, n: int, known: set[int]) -> Iterator[Claim]:
        """Yield mistakes that affect a single answer (e.g. a wrong unit), for answers not explained otherwise."""
        right, at = self.right.take(np.array([n])), self.slips
        with np.errstate(all="ignore"):
            moved = np.abs(self.values[at, n] - right.value) / right.scale > 4 / PER_ALLOWED * right.allowed
        near = _errors(right, self.written.take(np.array([n])), self.values[at, n]) <= PER_ALLOWED
        for k in np.flatnonzero(self.wrong[n]).tolist():
            fits = [self.cases[at[row]] for row in np.flatnonzero(near[:, k] & moved[:, k])]
            if k not in known and len({type(case) for case in fits}) == 1:
                yield Claim(tuple(fits), (k,))

    def _solve_pairs(self) -> dict[int, list[Explanation]]:
        """Try two mistakes at once for each student whose answers no single mistake explains.

        Returns:
            Explanations by two mistakes, the best first, by the index of the student.
        """
        best = np.argmin(self.costs, axis=0)
        rows = np.arange(len(best))
        left = np.any(self.errors(self.values[best, rows]) > PER_ALLOWED, axis=1)
        wanted: dict[tuple[int, int], list[int]] = {}
        for n in np.flatnonzero(left).tolist():
            for pair in self._choose_pairs(n):
                wanted.setdefault(pair, []).append(n)
        found: dict[int, list[Explanation]] = {}
        for pair, students in wanted.items():
            at = np.array(students)
            with np.errstate(all="ignore"):
                value = predict_answers(self.family.take(at), self.right.asked, [self.cases[c] for c in pair])
            price = np.sum(self.price[list(pair)])
            for n, cost, own in zip(students, self.cost(value, at) + price, value, strict=True):
                found.setdefault(n, []).append((float(cost), pair, own))
        for own in found.values():
            own.sort(key=lambda one: one[0])
        return found

    def _choose_pairs(self, n: int) -> list[tuple[int, int]]:
        """Return the pairs of mistakes that are worth computing for student `n`, the most promising first.

        A pair is ranked by how well the answers fit if the changes due to its two mistakes are added or multiplied. One
        of the two must explain much on its own.
        """
        right, values, costs = self.right.take(np.array([n])), self.values[:, n], self.costs[:, n]
        written = self.written.take(np.array([n]))
        moving = np.all(np.isfinite(values), axis=1) & np.any(values != right.value, axis=1)
        first = [c for c in np.argsort(costs).tolist() if moving[c]][:FIRST]
        second = np.flatnonzero(moving & (self.whole | np.isin(np.arange(len(values)), first)))
        if not len(second):
            return []
        one, other = values[first][:, None], values[second][None]
        with np.errstate(all="ignore"):
            added = _cost(_errors(right, written, one + other - right.value))
            multiplied = _cost(_errors(right, written, np.where(right.value == 0, 0, one * other / right.value)))
        cost = np.where(self.kind[first][:, None] == self.kind[second], np.inf, np.minimum(added, multiplied))
        cost = cost + self.price[first][:, None] + self.price[second]
        found: list[tuple[int, int]] = []
        for place in np.argsort(cost, axis=None)[: 2 * TRIED].tolist():
            a, b = sorted((first[place // len(second)], int(second[place % len(second)])))
            if (a, b) not in found and np.isfinite(cost.flat[place]):
                found.append((a, b))
        return found[:TRIED]


def _errors(right: RightAnswers, written: WrittenAnswers, value: Vector) -> Real:
    with np.errstate(all="ignore"):
        scale = np.maximum(1.0, np.abs(value) / right.scale)  # drawn off a plan of the wrong values
        found = right.error(written, value) / scale / (right.allowed / PER_ALLOWED)
    return np.where(written.given, np.nan_to_num(found, nan=np.inf), 0.0)


def _cost(errors: Real) -> Real:
    total: Real = np.sum(np.minimum(errors, CAP) ** 2, axis=-1)
    return total


LEAST = 3  # answers
MOST_OF = 0.8  # of the answers in which the variants differ must fit the other one
TWICE = 2.0  # times as many as the own variant does
DIFFERENT = 0.5  # of what is allowed: variants whose values are nearer than that are alike, and tell nothing
NEAR = 1000  # students before and after one in the table: who copies is in a group with whom he copies from
BLOCK = 50  # students compared with those at once


def find_copies(found: Sequence[StudentMarks]) -> list[StudentMarks]:
    """Find students whose answers fit another student's variant better than their own.

    Returns:
        The marks of all students. Where such a variant is found, `copied` names its owner, and the mistakes of the
        answers that it explains are removed.
    """
    value, size, right, scale, allowed = _mark_arrays(found)
    there = ~np.isnan(value)
    own = _fits(value, size, right, scale, allowed)
    suspects = np.sum(there & ~own, axis=1) >= LEAST
    copied: dict[int, tuple[str, list[bool]]] = {}
    for first in range(0, len(found), BLOCK):
        rows = first + np.flatnonzero(suspects[first : first + BLOCK])
        low, high = max(0, first - NEAR), first + BLOCK + NEAR
        near, room = right[low:high], DIFFERENT * (allowed * scale)[rows][:, None]
        with np.errstate(invalid="ignore"):
            differs = there[rows][:, None] & (np.abs(near - right[rows][:, None]) > room)
        holds = differs & _fits(value[rows][:, None], size[rows][:, None], near, scale[low:high], allowed[low:high])
        fits, most = np.sum(holds, axis=2), np.sum(differs, axis=2)
        mine = np.sum(differs & own[rows][:, None], axis=2)
        likely = np.where((fits >= np.maximum(LEAST, MOST_OF * most)) & (fits >= TWICE * mine), fits - mine, 0)
        for row, n in enumerate(rows.tolist()):
            other = int(np.argmax(likely[row]))
            if likely[row, other]:
                copied[n] = found[low + other].student, holds[row, other].tolist()
    return [_set_copied(marks, *copied[n]) if n in copied else marks for n, marks in enumerate(found)]


def _set_copied(marks: StudentMarks, other: str, explained: Sequence[bool]) -> StudentMarks:
    """Set `copied` to the other student and remove the mistakes of answers that the other variant explains."""
    own = [
        replace(mark, reasons=() if mark.state == "wrong" else mark.reasons, mistakes=()) if of_other else mark
        for mark, of_other in zip(marks.marks, explained, strict=True)
    ]
    return replace(marks, marks=tuple(own), copied=other)


def _fits(value: Real, size: Real, right: Real, scale: Real, allowed: Real) -> Real:
    with np.errstate(all="ignore"):
        gap = np.where(size, np.abs(np.abs(value) - np.abs(right)), np.abs(value - right))
        holds: Real = gap <= allowed * scale
    return holds


def _mark_arrays(found: Sequence[StudentMarks]) -> tuple[Real, Real, Real, Real, Real]:
    """Return the marks as arrays (students, answers).

    The arrays are the values, True where only the magnitude was given, the right values, the reference values of the
    relative errors, and the tolerances.
    """

    def of(part: str, kind: type) -> Real:
        rows = [[getattr(mark, part) for mark in marks.marks] for marks in found]
        return np.array([[np.nan if x is None else x for x in row] for row in rows], dtype=kind)

    return of("value", complex), of("size", bool), of("right", complex), of("scale", float), of("allowed", float)
