"""What follows the mechanism: plans of velocities and accelerations, diagrams, the same frames in all of them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.draw.paper.sheet import COLOURS, THIN, with_unit
from tmm_cli.draw.sheets.motion_plans import Sort
from tmm_cli.draw.sheets.over_cycle import Quantities, balances, output
from tmm_cli.kinematics.motion import Motion
from tmm_cli.language import _, spelt
from tmm_cli.plans.record import in_letters
from tmm_cli.vectors import Real, Vector, largest, without_rounding

PLAN, ROOM = 100.0, 12.0  # units of a plan's longest side, of the room about it
USUAL = 1.5  # times what nearly all places have: beyond it (at dead positions) a plan is cut
MOST_LETTERS = 4  # at one point of a plan
LEAST = 1e-6  # of a plan: nearer points are one


def plan_data(motion: Motion, sort: Sort) -> dict[str, Any]:
    """A plan in all frames: its points (SI, y up), vectors between them, letters at them; units a SI unit, its view."""
    plans = [sort.plan(motion, k) for k in range(len(motion.q))]
    first = plans[0]
    size = float(np.percentile([plan.size for plan in plans], 95)) or 1.0
    points: list[Vector] = []

    def index(places: Iterable[complex]) -> int:
        course = np.array(list(places))
        for number, other in enumerate(points):
            if np.max(np.abs(other - course)) < LEAST * size:
                return number
        points.append(course)
        return len(points) - 1

    letters: dict[int, list[str]] = {}
    for letter in first.ends:
        letters.setdefault(index(plan.ends[letter] for plan in plans), []).append(letter)
    vectors: dict[tuple[int, int], dict[str, Any]] = {}
    for n, vector in enumerate(first.vectors):
        ends = index(plan.vectors[n].start for plan in plans), index(plan.vectors[n].end for plan in plans)
        mass = vector.kind == "absolute" and vector.symbol.below.startswith("S")
        if ends[0] != ends[1] and (ends not in vectors or not mass):
            vectors[ends] = {
                "from": ends[0],
                "to": ends[1],
                "colour": THIN if mass else COLOURS[vector.kind],
                "width": 0.45 if mass or vector.kind != "absolute" else 0.7,
            }
    below = sorted(vectors.values(), key=lambda vector: vector["colour"] != THIN)
    every = np.concatenate(points)
    every = every[np.abs(every) <= USUAL * size]
    scale = PLAN / (max(np.ptp(every.real), np.ptp(every.imag)) or 1.0)
    return {
        "title": (_("Velocity plan, {unit}") if sort.letter == "v" else _("Acceleration plan, {unit}")).format(
            unit=spelt(sort.unit)
        ),
        "points": [[rounded(z.real, 4), rounded(z.imag, 4)] for z in points],
        "vectors": below,
        "letters": [{"point": n, "text": _together(text)} for n, text in letters.items()],
        "scale": float(f"{scale:.5g}"),
        "view": [round(side, 1) for side in sides(every * scale, ROOM)],
    }


def sides(places: Vector, room: float) -> tuple[float, float, float, float]:
    """Of a field with room about places, as a page has it: left, top (y down), width and height."""
    x, y = places.real, -places.imag
    return float(x.min()) - room, float(y.min()) - room, float(np.ptp(x)) + 2 * room, float(np.ptp(y)) + 2 * room


def _together(letters: list[str]) -> str:
    """Letters of one point, not more than have room."""
    few = letters if len(letters) <= MOST_LETTERS else [*letters[:MOST_LETTERS], "…"]
    return ", ".join(map(in_letters, few))


def charts(results: Results, whole: Results) -> Iterable[Quantities]:
    """Motion of the first outputs, and what balances the drivers."""
    assert whole.motion is not None
    for link in results.mechanism.outputs[:2]:
        yield from output(results, whole.motion, link)
    yield from balances(whole, results)


def chart_data(results: Results, quantities: Quantities) -> dict[str, Any]:
    """A diagram in the units of the file."""

    def values(si: Real) -> list[float | None]:
        clean = without_rounding(si, largest(si))
        return rounded(results.problem.units.from_si(clean, quantities.dimension), 5)

    return {
        "title": with_unit(quantities.words, quantities.dimension, results.problem.units),
        "courses": [{"name": course.name, "values": values(course.values)} for course in quantities.courses],
    }


def position_marks(results: Results, motion: Motion) -> list[list[Any]]:
    """Where the numbered positions are among the frames."""
    found = []
    for number, q in zip(results.numbers, results.asked[list(results.numbers)].tolist(), strict=True):
        k = int(np.argmin(np.abs(motion.q - q)))
        step = abs(motion.q[-1] - motion.q[0]) / (len(motion.q) - 1)
        ahead = float((q - motion.q[k]) / (motion.q[-1] - motion.q[0]) * (len(motion.q) - 1))
        if abs(q - motion.q[k]) <= 1.01 * step:
            found.append([round(k + ahead, 3), str(number)])
    return found


def rounded(values: Any, digits: int) -> list[float | None]:
    """To so many significant figures; none where there is no value."""
    array = np.asarray(values, float)
    return [float(f"{value:.{digits}g}") + 0.0 if np.isfinite(value) else None for value in array.tolist()]
