"""Which mistakes explain a student's wrong answers: the whole sheet is compared with what each would have given.

A mistake is named where it explains best by a margin. What looks alike within the drawing error is named together, and
what changes nothing there is not claimed. Two mistakes at once are looked for where one leaves answers unexplained.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from tmm_cli.errors import _
from tmm_cli.grading.mistakes import cases
from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.grading.mistakes.scale_inverted import ScaleInverted
from tmm_cli.grading.sheet import Right, Written, predicted, written_down
from tmm_cli.grading.solution import solve
from tmm_cli.variants.family import Family
from tmm_cli.vectors import Real, Vector

PER_ALLOWED = 3.0  # an answer may be off by so many standard errors of a drawing
CAP = 5.0  # standard errors: what is farther off is off for another reason, and counts no more
GAIN = 12.0  # squares of standard errors that a mistake must explain
MARGIN = 9.0  # by which it must explain more than the next
TRIED = 8  # pairs of mistakes that are computed for a student, the best by a first estimate
ALIKE = 3  # kinds of mistakes that may be named together


Explanation = tuple[float, tuple[int, ...], Vector]  # its cost, which cases, and what they would have given


@dataclass(frozen=True)
class Claim:
    """What explains some answers (places in what is asked) of a student. alternatives: each alone does so."""

    alternatives: tuple[Mistake, ...]
    answers: tuple[int, ...]

    @property
    def told(self) -> str:
        """For the student."""
        sentences = list(dict.fromkeys(case.told for case in self.alternatives))
        if len(sentences) == 1:
            return sentences[0]
        return _("One of these, which look alike here: {sentences}").format(sentences=" ".join(sentences))

    @property
    def called(self) -> str:
        """For the statistics of the group."""
        return " / ".join(sorted({case.called for case in self.alternatives}))


def diagnose(family: Family, right: Right, written: Written) -> dict[int, list[Claim]]:
    """Claims by student, for those who have wrong answers."""
    wrong = right.error(written) > right.allowed
    rows = np.flatnonzero(np.any(wrong, axis=1))
    if not rows.size:
        return {}
    return dict(
        zip(rows.tolist(), _Sheets(family.take(rows), right.take(rows), written.take(rows)).claims(), strict=True)
    )


class _Sheets:
    """Students with wrong answers, and what every mistake would have made of their variants."""

    def __init__(self, family: Family, right: Right, written: Written) -> None:
        self.family, self.right, self.written, self.cases = family, right, written, cases(family)
        plain = solve(family)
        asked = right.asked
        with np.errstate(all="ignore"):
            self.values = np.stack([
                predicted(family, asked, [case]) if case.solves else written_down(plain, asked, [case])
                for case in self.cases
            ])  # fmt: skip
        self.costs = np.stack([self.cost(value) for value in self.values])
        self.none = self.cost(right.value)
        self.wrong = right.error(written) > right.allowed

    def errors(self, value: Vector, rows: Real | None = None) -> Real:
        """In standard errors; of answers that are not there zero, of values that are not there many."""
        right, written = self.right, self.written
        if rows is not None:
            right, written = right.take(rows), written.take(rows)
        with np.errstate(all="ignore"):
            scale = np.maximum(1.0, np.abs(value) / right.scale)  # drawn off a plan of the wrong values
            found = right.error(written, value) / scale / (right.allowed / PER_ALLOWED)
        return np.where(written.there, np.nan_to_num(found, nan=np.inf), 0.0)

    def cost(self, value: Vector, rows: Real | None = None) -> Real:
        """How badly a value explains the sheets: squares of standard errors, as far as they count."""
        total: Real = np.sum(np.minimum(self.errors(value, rows), CAP) ** 2, axis=-1)
        return total

    def claims(self) -> Iterator[list[Claim]]:
        """Student by student."""
        pairs = self._pairs()
        for n in range(len(self.none)):
            yield self._claims(n, pairs.get(n, []))

    def _claims(self, n: int, pairs: Sequence[Explanation]) -> list[Claim]:
        own = self.right.take(np.array([n]))
        order = np.argsort(self.costs[:, n])
        single: list[Explanation] = [(float(self.costs[c, n]), (int(c),), self.values[c, n]) for c in order]
        best = single[0]
        if pairs and pairs[0][0] < best[0] - GAIN:
            best = pairs[0]
        found: list[Claim] = []
        value = own.value[0]
        if best[0] < self.none[n] - GAIN:
            rivals = [rival for rival in (pairs if len(best[1]) == 2 else single) if rival[0] < best[0] + MARGIN]
            found = self._named(n, best, rivals)
            value = best[2] if found else value
        return [*found, *self._slips(n, value, {k for claim in found for k in claim.answers})]

    def _named(self, n: int, best: Explanation, rivals: Sequence[Explanation]) -> list[Claim]:
        """The mistakes of the best explanation, each with what explains as well in its place."""
        found = []
        for c in best[1]:
            others = {
                c,
                *(d for _, own, _ in rivals for d in own if len(best[1]) == 1 or set(own) & set(best[1]) - {c}),
            }
            others -= set(best[1]) - {c}
            alike = [self.cases[d] for d in sorted(others, key=lambda d: self.costs[d, n])]
            answers = self._explained(n, best, c)
            if answers and len({type(case) for case in alike}) <= ALIKE:
                found.append(Claim(tuple(alike), answers))
        return found

    def _explained(self, n: int, best: Explanation, c: int) -> tuple[int, ...]:
        """Wrong answers that it explains, and that this mistake of it changes."""
        fits = self.errors(best[2][None], np.array([n]))[0] <= PER_ALLOWED
        rest = [d for d in best[1] if d != c]
        without = self.values[rest[0], n] if rest else self.right.value[n]
        with np.errstate(all="ignore"):
            moved = np.abs(best[2] - without) > self.right.allowed[n] * self.right.scale[n] * 0.5
        return tuple(np.flatnonzero(self.wrong[n] & fits & moved).tolist())

    def _slips(self, n: int, value: Vector, known: set[int]) -> Iterator[Claim]:
        """Mistakes in writing down single answers."""
        at = np.array([n])
        for k in np.flatnonzero(self.wrong[n]):
            if k in known:
                continue
            fits = []
            for c, case in enumerate(self.cases):
                if case.solves or isinstance(case, ScaleInverted):
                    continue
                with np.errstate(all="ignore"):
                    moved = np.abs(self.values[c, n, k] - self.right.value[n, k]) / self.right.scale[n, k]
                near = self.errors(self.values[c, n][None], at)[0, k] <= PER_ALLOWED
                if near and moved > 4 / PER_ALLOWED * self.right.allowed[n, k]:
                    fits.append(case)
            if len({type(case) for case in fits}) == 1:
                yield Claim(tuple(fits), (int(k),))

    def _pairs(self) -> dict[int, list[Explanation]]:
        """For students whom no single mistake explains: the best pairs, their costs and values."""
        best = np.argmin(self.costs, axis=0)
        rows = np.arange(len(best))
        left = np.any(self.errors(self.values[best, rows]) > PER_ALLOWED, axis=1)
        wanted: dict[tuple[int, int], list[int]] = {}
        for n in np.flatnonzero(left).tolist():
            for pair in self._likely(n):
                wanted.setdefault(pair, []).append(n)
        found: dict[int, list[Explanation]] = {}
        for pair, students in wanted.items():
            at = np.array(students)
            with np.errstate(all="ignore"):
                value = predicted(self.family.take(at), self.right.asked, [self.cases[c] for c in pair])
            for n, cost, own in zip(students, self.cost(value, at), value, strict=True):
                found.setdefault(n, []).append((float(cost), pair, own))
        for own in found.values():
            own.sort(key=lambda one: one[0])
        return found

    def _likely(self, n: int) -> list[tuple[int, int]]:
        """Pairs that explain a sheet best if their changes add up, or multiply."""
        right, values = self.right.value[n], self.values[:, n]
        moving = [c for c in range(len(values)) if np.all(np.isfinite(values[c])) and np.any(values[c] != right)]
        two = [(a, b) for a, b in combinations(moving, 2) if type(self.cases[a]) is not type(self.cases[b])]
        pairs = np.array(two).reshape(-1, 2)
        if not len(pairs):
            return []
        one, other = values[pairs[:, 0]], values[pairs[:, 1]]
        rows = np.full(len(pairs), n)
        with np.errstate(all="ignore"):
            added = self.cost(one + other - right, rows)
            multiplied = self.cost(np.where(right == 0, 0, one * other / right), rows)
        order = np.argsort(np.minimum(added, multiplied))[:TRIED]
        return [(int(a), int(b)) for a, b in pairs[order]]
