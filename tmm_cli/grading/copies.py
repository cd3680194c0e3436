"""Answers that fit another student's variant better than one's own: for the teacher, who knows what to make of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tmm_cli.grading.record import StudentMarks
from tmm_cli.mechanics.numerics import Real

LEAST = 3  # answers
MOST_OF = 0.8  # of the answers in which the variants differ must fit the other one
TWICE = 2.0  # times as many as the own variant does
DIFFERENT = 0.5  # of what is allowed: variants whose values are nearer than that are alike, and tell nothing
NEAR = 1000  # students before and after one in the table: who copies is in a group with whom he copies from
BLOCK = 50  # students compared with those at once


def with_copies(found: Sequence[StudentMarks]) -> list[StudentMarks]:
    """The marks with the names of those whose variants fit better."""
    value, size, right, scale, allowed = _arrays(found)
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
    return [_told(marks, *copied[n]) if n in copied else marks for n, marks in enumerate(found)]


def _told(marks: StudentMarks, other: str, explained: Sequence[bool]) -> StudentMarks:
    """With the other's name, and without the mistakes that would explain what the other's variant does."""
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


def _arrays(found: Sequence[StudentMarks]) -> tuple[Real, Real, Real, Real, Real]:
    """Values, whether they are sizes alone, what is right, scales, what is allowed: (students, answers)."""

    def of(part: str, kind: type) -> Real:
        rows = [[getattr(mark, part) for mark in marks.marks] for marks in found]
        return np.array([[np.nan if x is None else x for x in row] for row in rows], dtype=kind)

    return of("value", complex), of("size", bool), of("right", complex), of("scale", float), of("allowed", float)
