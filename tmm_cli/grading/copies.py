"""Copies: answers that fit the variant of another student, or that are equal to those of another student."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.grading.record import Mark, StudentMarks
from tmm_cli.mechanics.numerics import Real

LEAST = 3  # answers
MOST_OF = 0.8  # of the answers in which the variants differ must fit the other one
TWICE = 2.0  # times as many as the own variant does
DIFFERENT = 0.5  # of what is allowed: variants whose values are nearer than that are alike, and tell nothing
NEAR = 1000  # students before and after one in the table: who copies is in a group with whom he copies from
NOTHING = 1e-12  # of a value: what conversion of units leaves of a difference
BLOCK = 50  # students compared with those at once


def find_copies(found: Sequence[StudentMarks]) -> list[StudentMarks]:
    """Find students whose answers fit another student's variant better than their own, or are those of another student.

    Returns:
        The marks of all students. If a student's answers fit another variant, `copied` is the name of the student who
        has that variant. Mistakes named for answers that the other variant explains are removed. If many answers equal
        those of another student, `shared` lists them.
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
        fitting = _fits(value[rows][:, None], size[rows][:, None], near, scale[low:high], allowed[low:high])
        holds, wrong = differs & fitting, (there & ~own)[rows][:, None]
        explains = np.sum(wrong & fitting, axis=2) >= MOST_OF * np.sum(wrong, axis=2)
        fits, most = np.sum(holds, axis=2), np.sum(differs, axis=2)
        mine = np.sum(differs & own[rows][:, None], axis=2)
        likely = np.where(
            (fits >= np.maximum(LEAST, MOST_OF * most)) & (fits >= TWICE * mine) & explains, fits - mine, 0
        )
        for row, n in enumerate(rows.tolist()):
            other = int(np.argmax(likely[row]))
            if likely[row, other]:
                copied[n] = found[low + other].student, holds[row, other].tolist()
    marked = [_set_copied(marks, *copied[n]) if n in copied else marks for n, marks in enumerate(found)]
    for n, (other, answers) in _find_shared_digits(found).items():
        name, shared = found[other].student, tuple(_shared_text(found[n].marks[k]) for k in answers)
        marked[n] = replace(marked[n], copied=name, shared=shared)
    return marked


def _set_copied(marks: StudentMarks, other: str, explained: Sequence[bool]) -> StudentMarks:
    """Return the marks with `copied` set to the other student.

    Mistakes named for answers that the other student's variant explains are removed.
    """
    own = [
        replace(mark, reasons=() if mark.state == "wrong" else mark.reasons, mistakes=(), identifiers=())
        if of_other
        else mark
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


# Equality to the digit of many answers is evidence of copying whatever the mark, and so is equality of nearly all
# answers but for a slight retouch. An answer tells nothing where two students who work alone may agree: where both
# variants have the same right value and both answers have it too, or are wrong by the same mistake.


RETOUCHED = 0.0035  # of the value: a copy may be changed by so much
EXACT = 1e-5  # tolerances below are of numbers that must be exact, which all students have in common
MANY, NEARLY_ALL = 0.4, 0.8  # of the common answers: equal to the digit; equal but for a retouch
SHARED = 4  # answers at least
CERTAINTY = 2.0  # powers of ten by which a chance agreement in the whole group must be unlikely
RETOUCH_CERTAINTY = 4.0
DEVIATIONS = 1.18  # tolerances: 2 sqrt(pi) standard deviations of a drawing, by which two drawings differ
CLEARLY = 3.0  # times the difference of two answers


@dataclass(frozen=True)
class _Sheets:
    """Answers of all students as arrays (students, answers); digit: SI value of the last digit written."""

    value: Real
    size: Real
    right: Real
    scale: Real
    allowed: Real
    digit: Real
    wrong: Real


def _find_shared_digits(found: Sequence[StudentMarks]) -> dict[int, tuple[int, list[int]]]:
    """Find students whose answers are those of another student.

    Returns:
        Index of the other student and of the equal answers, by the index of the student. Of two students the one whose
        equal answers are right for the own variant is not named, if those of the other one are not.
    """
    sheets = _read_sheets(found)
    best: dict[int, tuple[float, int, list[int]]] = {}
    for n, m in _similar_pairs(sheets):
        score, answers = _weigh_pair(sheets, n, m)
        if not answers:
            continue
        right = [len(answers) - int(np.sum(sheets.wrong[who, answers])) for who in (n, m)]
        for who, other, own, theirs in ((n, m, *right), (m, n, *reversed(right))):
            innocent = own >= MOST_OF * len(answers) and theirs < own / TWICE
            if not innocent and score > best.get(who, (0.0,))[0]:
                best[who] = score, other, answers
    return {n: (other, answers) for n, (_, other, answers) in best.items()}


def _read_sheets(found: Sequence[StudentMarks]) -> _Sheets:
    value, size, right, scale, allowed = _mark_arrays(found)
    digits = np.array([[_significant_digits(mark.text) for mark in marks.marks] for marks in found])
    value = np.where((allowed <= EXACT) | (value == 0) | (digits < 2), np.nan, value)
    with np.errstate(all="ignore"):
        largest = np.maximum(np.abs(value.real), np.abs(value.imag))
        digit = 10.0 ** (np.floor(np.log10(largest)) - digits + 1)
    wrong = np.array([[mark.state not in ("right", "missing") for mark in marks.marks] for marks in found])
    return _Sheets(value, size, right, scale, allowed, digit, wrong)


def _significant_digits(text: str) -> int:
    """Return the number of significant digits of the first number in a text."""
    number = re.search(r"\d[\d.,]*", text)
    return len(re.sub(r"[.,]", "", number.group()).lstrip("0")) if number else 0


def _similar_pairs(sheets: _Sheets) -> Iterator[tuple[int, int]]:
    """Yield the pairs of students, the first before the second, who have many answers nearly in common."""
    with np.errstate(all="ignore"):
        logs = np.log(np.abs(sheets.value)).astype(np.float32)
    for first in range(0, len(logs), BLOCK):
        rows, near = logs[first : first + BLOCK], logs[first : first + BLOCK + NEAR]
        with np.errstate(all="ignore"):
            gap = np.abs(rows[:, None] - near)
        common = np.sum(~np.isnan(gap), axis=2)
        count = np.sum(gap < RETOUCHED, axis=2)
        pairs = np.argwhere((count >= SHARED) & (count >= MANY * common))
        yield from ((first + n, first + m) for n, m in pairs.tolist() if m > n)


def _weigh_pair(sheets: _Sheets, n: int, m: int) -> tuple[float, list[int]]:
    """Return how unlikely (powers of ten) it is that two students agree by chance, and the answers they share."""
    one, other, rights = sheets.value[n], sheets.value[m], np.abs(sheets.right[n] - sheets.right[m])
    room = np.minimum((sheets.allowed * sheets.scale)[n], (sheets.allowed * sheets.scale)[m])
    common = ~np.isnan(one) & ~np.isnan(other)
    chance = np.log10(len(sheets.value)) * 2
    gap = np.abs(one - other)
    digit = np.maximum(sheets.digit[n], sheets.digit[m])
    off = np.minimum(np.abs(one - sheets.right[n]), np.abs(other - sheets.right[m]))
    for width, agree, share, certainty in (
        (digit, gap <= NOTHING * np.abs(one), MANY, CERTAINTY),
        (2 * RETOUCHED * np.abs(one), gap <= RETOUCHED * np.abs(one), NEARLY_ALL, RETOUCH_CERTAINTY),
    ):
        drawn = ~sheets.wrong[n] & ~sheets.wrong[m] & (off > CLEARLY * width)
        telling = common & agree & ((rights > CLEARLY * width) | drawn)
        with np.errstate(all="ignore"):
            weights = -np.log10(np.clip(width / (DEVIATIONS * room), 1e-3, 1.0))
        score = float(np.sum(weights[telling]))
        enough = np.sum(common & agree) >= max(SHARED, share * np.sum(common)) and np.sum(telling) >= SHARED
        if enough and score > chance + certainty:
            return score, np.flatnonzero(telling).tolist()
    return 0.0, []


def _shared_text(mark: Mark) -> str:
    name, number = mark.key
    return f"{name}: {mark.text}" if number is None else f"{name} at {number}: {mark.text}"
