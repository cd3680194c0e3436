"""Explanation of wrong answers by typical mistakes.

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
from tmm_cli.grading.sheet import RightAnswers, WrittenAnswers, predict_answers, write_down_answers
from tmm_cli.language import _
from tmm_cli.mechanics.numerics import Real, Vector

PER_ALLOWED = 3.0  # an answer may be off by so many standard errors of a drawing
CAP = 5.0  # standard errors: what is farther off is off for another reason, and counts no more
GAIN = 12.0  # squares of standard errors that a mistake must explain
MARGIN = 9.0  # by which it must explain more than the next
LEAST_ANSWERS = 2  # that a mistake must explain, unless a single one is certain
CERTAIN = 0.25  # of the tolerance: so near must a single answer be to name a mistake
SMALL = 0.1  # of the largest value in the cycle: a smaller single answer names nothing
CONTRARY = 4 / 3  # tolerances by which a right answer contradicts a mistake
MOVED = 0.5  # tolerances: a smaller change of an answer is no effect of a mistake
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
    def identifiers(self) -> str:
        """Stable names of the mistakes in `alternatives`, joined by a vertical bar."""
        return "|".join(dict.fromkeys(case.identifier for case in self.alternatives))

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
        Explanations by the index of the student in the family. Students without wrong answers have none.
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
    """The written answers of some students, compared with the answers that each typical mistake would give."""

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
        kinds = [case.code for case in self.cases]
        self.kind = np.array([kinds.index(kind) for kind in kinds])
        self.scope = np.array([case.scope for case in self.cases])
        self.positions = np.array([-1 if one.position is None else one.position for one in asked])

    def errors(self, value: Vector, rows: Real | None = None) -> Real:
        """Return the differences between the written answers and the predicted answers `value`.

        They are measured in standard errors of a drawing; the tolerance of an answer is PER_ALLOWED of these. The
        difference is 0 for a missing answer and infinite where `value` is nan.
        """
        right, written = self.right, self.written
        if rows is not None:
            right, written = right.take(rows), written.take(rows)
        return _errors(right, written, value)

    def cost(self, value: Vector, rows: Real | None = None) -> Real:
        """Return the misfit of the predicted answers `value`.

        It is the sum of the squares of `errors`, each limited to CAP.
        """
        return _cost(self.errors(value, rows))

    def explain_all(self) -> Iterator[list[Claim]]:
        """Yield a list of explanations for each student."""
        pairs = self._solve_pairs()
        for n in range(len(self.none)):
            yield self._explain_student(n, pairs.get(n, []))

    def _explain_student(self, n: int, pairs: Sequence[Explanation]) -> list[Claim]:
        wrong, values = self.wrong[n], self.values[:, n]
        evidence = _Evidence.of(self, n, values, wrong)
        found: list[Claim] = []
        every = np.unique(self.positions)
        of_sheet, of_position = self.scope != "answer", self.scope == "position"
        for own, positions in [(of_sheet, every), *((of_position, every[[k]]) for k in range(len(every)))]:
            claim = self._name_mistake(n, evidence.at_positions(self.positions, positions), np.flatnonzero(own))
            if claim is not None and not {k for one in found for k in one.answers} & set(claim.answers):
                found.append(claim)
        known = {k for claim in found for k in claim.answers}
        unknown = np.sum(wrong) - len(known)
        if pairs and unknown and not (found and unknown < 2):
            found = self._name_pair(n, pairs, wrong, found)
            known = {k for claim in found for k in claim.answers}
        return [*found, *self._find_slips(n, evidence, known)]

    def _name_mistake(self, n: int, evidence: _Evidence, own: Real) -> Claim | None:
        """Return the mistake that explains the wrong answers of student `n`; None if no mistake does so clearly.

        own: indices of the mistakes considered.
        """
        holds = evidence.holds[own] & (evidence.cost[own] + self.price[own] < evidence.none - GAIN)
        counts = np.sum(evidence.explained[own], axis=1)
        accepted = own[holds & (counts > 0)]
        if not accepted.size:
            return None
        costs = evidence.cost[accepted] + self.price[accepted]
        alike = [int(c) for c in accepted[np.argsort(costs, kind="stable")]]
        best = alike[0]
        alike = [c for c in alike if evidence.cost[c] < np.min(costs) + MARGIN]  # whatever its price
        answers = np.flatnonzero(evidence.explained[best])
        if len({self.kind[c] for c in alike}) > ALIKE:
            return None
        large = [k for k in answers.tolist() if self._is_large(n, best, k)]
        if self.price[best] == 0 and len(answers) >= LEAST_ANSWERS:  # a factor tells nothing where all is near zero
            large = answers.tolist()
        if not large or (len(large) < LEAST_ANSWERS and not self._is_certain(n, best, large[0], evidence, accepted)):
            return None
        return Claim(tuple(self.cases[c] for c in alike), tuple(answers.tolist()))

    def _is_certain(self, n: int, c: int, k: int, evidence: _Evidence, rivals: Real) -> bool:
        """Return True if answer `k` alone is enough evidence that student `n` made mistake `c`.

        The answer must differ from the predicted one by at most a quarter of the tolerance, and no mistake of another
        kind may explain it. Mistakes made in one position only (scope "position") are never certain.
        """
        others = [d for d in rivals if evidence.explained[d, k] and self.kind[d] != self.kind[c]]
        return bool(self.scope[c] != "position" and evidence.errors[c, k] <= PER_ALLOWED * CERTAIN and not others)

    def _is_large(self, n: int, c: int, k: int) -> bool:
        """Return True if answer `k` of student `n` is large enough to be evidence of mistake `c`.

        A small answer is accepted too if it differs from the predicted value by less than the tolerated fraction of
        that value itself.
        """
        written, value = self.written.value[n, k], self.values[c, n, k]
        gap = np.abs(np.abs(written) - np.abs(value)) if self.written.size[n, k] else np.abs(written - value)
        allowed = self.right.allowed[n, k]
        return bool(
            np.abs(written) > SMALL * self.right.scale[n, k] or (np.abs(value) > 0 and gap < allowed * np.abs(value))
        )

    def _name_pair(self, n: int, pairs: Sequence[Explanation], wrong: Real, single: list[Claim]) -> list[Claim]:
        """Return two mistakes that together explain all wrong answers of student `n`.

        If no pair of mistakes does so clearly, the explanations by single mistakes, `single`, are returned.
        """
        best = pairs[0]
        evidence = _Evidence.of(self, n, best[2][None], wrong)
        enough = evidence.holds[0] and np.all(evidence.explained[0] == wrong)
        alone = min((float(evidence.none), *(self.costs[c, n] for claim in single for c in self._cases_of(claim))))
        if not enough or best[0] > alone - GAIN:
            return single
        rivals = [pair for pair in pairs if pair[0] < best[0] + MARGIN]
        found = []
        for c in best[1]:
            (rest,) = (d for d in best[1] if d != c)
            others = {c, *(d for _, own, _ in rivals if rest in own for d in own if d != rest)}
            alike = [self.cases[d] for d in sorted(others, key=lambda d: self.costs[d, n])]
            with np.errstate(all="ignore"):
                moved = np.abs(best[2] - self.values[rest, n]) > self.right.allowed[n] * self.right.scale[n] * MOVED
            answers = tuple(np.flatnonzero(evidence.explained[0] & moved).tolist())
            if len(answers) < (1 if self.scope[c] == "answer" else LEAST_ANSWERS):
                return single
            if len({type(case) for case in alike}) > ALIKE:
                return single
            found.append(Claim(tuple(alike), answers))
        return found

    def _cases_of(self, claim: Claim) -> list[int]:
        return [self.cases.index(case) for case in claim.alternatives]

    def _find_slips(self, n: int, evidence: _Evidence, known: set[int]) -> Iterator[Claim]:
        """Yield mistakes made in writing down an answer (e.g. a wrong unit), for answers that no other mistake
        explains.
        """
        own = np.flatnonzero(self.scope == "answer")
        fits = evidence.explained[own].copy()
        for row, k in np.argwhere(fits).tolist():
            fits[row, k] = self._is_large(n, own[row], k)
        for c in own[np.any(fits, axis=1)].tolist():
            answers = [
                k
                for k in np.flatnonzero(evidence.explained[c]).tolist()
                if k not in known and not np.any(fits[self.kind[own] != self.kind[c], k])
            ]
            large = [k for k in answers if self._is_large(n, c, k)]
            if len(large) >= LEAST_ANSWERS or any(evidence.errors[c, k] <= PER_ALLOWED * CERTAIN for k in large):
                yield Claim((self.cases[c],), tuple(answers))

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

        A pair is rated by an estimate of the answers, in which the changes due to its two mistakes are added or
        multiplied. At least one of the two mistakes must explain much on its own.
        """
        right, values, costs = self.right.take(np.array([n])), self.values[:, n], self.costs[:, n]
        written = self.written.take(np.array([n]))
        moving = np.all(np.isfinite(values), axis=1) & np.any(values != right.value, axis=1)
        first = [c for c in np.argsort(costs).tolist() if moving[c]][:FIRST]
        second = np.flatnonzero(moving & ((self.price == 0) | np.isin(np.arange(len(values)), first)))
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


@dataclass(frozen=True)
class _Evidence:
    """Comparison of one student's answers with the answers predicted by each explanation.

    Arrays have the shape (explanations, answers) or (explanations,).

    Attributes:
        errors: differences from the predicted answers, in standard errors of a drawing.
        explained: True for a wrong answer that agrees with the prediction, if the prediction differs from the right
            value.
        holds: True for an explanation that explains most wrong answers of each position that it concerns and predicts
            the right ones.
        cost: sum of squared standard errors of each explanation.
        none: sum of squared standard errors if no mistake is assumed.
        parts: True for wrong answers; True for answers that an explanation changes visibly; True for right answers that
            contradict it; squared errors from the correct values.
    """

    errors: Real
    explained: Real
    holds: Real
    cost: Real
    none: float
    parts: tuple[Real, Real, Real, Real]

    @classmethod
    def of(cls, sheet: _SheetDiagnosis, n: int, values: Vector, wrong: Real) -> _Evidence:
        """Compare the answers of student `n` with predicted values, (explanations, answers)."""
        row = np.array([n])
        right, written = sheet.right.take(row), sheet.written.take(row)
        errors = _errors(right, written, values)
        with np.errstate(all="ignore"):
            shift = np.abs(values - right.value) / (right.scale * right.allowed)
        shift = np.nan_to_num(shift, nan=np.inf)
        explained = wrong & (errors <= PER_ALLOWED) & (shift > MOVED)
        against = written.given & ~wrong & (errors > PER_ALLOWED * CONTRARY)
        plain = np.minimum(_errors(right, written, right.value), CAP)[0] ** 2
        costs = np.minimum(errors, CAP) ** 2
        whole = cls(errors, explained, explained, costs, 0.0, (wrong, shift > 1, against, plain))
        return whole.at_positions(sheet.positions, np.unique(sheet.positions))

    def at_positions(self, of: Real, positions: Real) -> _Evidence:
        """Return the evidence from the answers at some positions; of: position number of each answer."""
        wrong, moved, against, plain = self.parts
        costs = np.minimum(self.errors, CAP) ** 2
        holds, within = np.ones(len(self.errors), dtype=bool), np.isin(of, positions)
        explained = self.explained & within
        for position in positions:
            at = of == position
            count = np.sum(explained[:, at], axis=1)
            concerned = np.any(moved[:, at], axis=1)
            most = 2 * count > np.sum(wrong[at])
            holds &= ~np.any(against[:, at], axis=1) & (~concerned | (most & (count > 0)) | ~np.any(wrong[at]))
        total, none = np.sum(costs[:, within], axis=1), float(np.sum(plain[within]))
        return replace(self, explained=explained, holds=holds, cost=total, none=none)


def _errors(right: RightAnswers, written: WrittenAnswers, value: Vector) -> Real:
    with np.errstate(all="ignore"):
        scale = np.maximum(1.0, np.abs(value) / right.scale)  # drawn off a plan of the wrong values
        found = right.error(written, value) / scale / (right.allowed / PER_ALLOWED)
    return np.where(written.given, np.nan_to_num(found, nan=np.inf), 0.0)


def _cost(errors: Real) -> Real:
    total: Real = np.sum(np.minimum(errors, CAP) ** 2, axis=-1)
    return total
