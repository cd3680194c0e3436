"""Answers that fit another student's variant better than one's own: for the teacher, who knows what to make of it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tmm_cli.grading.record import StudentMarks
from tmm_cli.vectors import Real

LEAST = 3  # answers
MOST_OF = 0.6  # of a student's answers that the other variant must make right
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
    copied: dict[int, str] = {}
    for first in range(0, len(found), BLOCK):
        rows = first + np.flatnonzero(suspects[first : first + BLOCK])
        low, high = max(0, first - NEAR), first + BLOCK + NEAR
        near = right[low:high]
        with np.errstate(invalid="ignore"):
            other = np.abs(near - right[rows][:, None]) > DIFFERENT * (allowed * scale)[rows][:, None]
        holds = _fits(value[rows][:, None], size[rows][:, None], near, scale[low:high], allowed[low:high])
        fits = np.sum(holds & other, axis=2)
        fits[np.arange(len(rows)), rows - low] = 0
        best = np.argmax(fits, axis=1)
        count, mine, all_of = fits[np.arange(len(rows)), best], np.sum(own[rows], axis=1), np.sum(there[rows], axis=1)
        for n, b, c, m, a in zip(rows.tolist(), best.tolist(), count, mine, all_of, strict=True):
            if c >= max(LEAST, MOST_OF * a) and c >= TWICE * m:
                copied[n] = found[low + b].student
    return [replace(marks, copied=copied[n]) if n in copied else marks for n, marks in enumerate(found)]


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
