"""A first linkage of an optimal synthesis: one that can be assembled as the file sketches it."""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np

from tmm_cli.assembly import assemble
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.mobile import mobile
from tmm_cli.motion import driven_state, drives_at
from tmm_cli.refused import Refused
from tmm_cli.synthesis.optimal_asked import Asked
from tmm_cli.synthesis.record import Infeasible
from tmm_cli.vectors import Real

W = "synthesis_optimal"
NESTED = (0.01, 0.03, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0)  # of the way to the widest bounds
STEPS = 24  # on the way to what the sketch shows
ITERATIONS, STEP, LEAST = 8, 1e-6, 1e-9  # steps of a derivative in shares of the widest ranges


class NoneAssembled(Infeasible):
    """No candidate that was tried can be assembled as it is sketched."""


def shown(asked: Asked, numbers: Real) -> bool:
    """Whether such a linkage can be assembled, and the file's sketch tells how."""
    linkage = asked.make([float(number) for number in numbers]).linkage
    try:
        assemble(linkage, mobile(linkage))
    except Refused:
        return False
    return True


def first_of(asked: Asked, tries: int) -> list[float]:
    """Numbers (SI) of such a linkage: the middle of the bounds, or others. Raises NoneAssembled."""
    low, high = np.array(list(asked.low.values())), np.array(list(asked.high.values()))
    chance = np.random.default_rng(0)
    for share in (np.full(len(low), 0.5), *chance.random((tries, len(low)))):
        numbers = asked.near(low + share * (high - low))
        if shown(asked, numbers):
            return [float(number) for number in numbers]
    raise NoneAssembled("vary", f"{W}.no_assembly", f"{W}.other_sketch")


def first_near(asked: Asked, tries: int, low: Real, high: Real) -> list[float] | None:
    """Such numbers within the bounds, else near ones beyond them, within wider ones; None: none are found.

    The file's sketch may show no linkage within bounds that hold some of the assembly that it shows beyond them.
    """
    try:
        return first_of(asked, tries)
    except NoneAssembled:
        pass
    own_low, own_high = np.array(list(asked.low.values())), np.array(list(asked.high.values()))
    chance = np.random.default_rng(0)
    drawn, told = _as_sketched(asked, low, high)
    inside = np.clip(drawn, own_low, own_high)
    tried = [inside + np.linspace(0, 1, STEPS + 1)[1:, None] * (drawn - inside)]
    for share in NESTED:
        least, most = own_low + share * (low - own_low), own_high + share * (high - own_high)
        spread = least + chance.random((tries, len(low))) * (most - least)
        tried += [np.where(told, drawn, spread), spread] if not np.all(told) else [spread]
    every = np.vstack(tried)
    for numbers in asked.near(every) if asked.values else every:
        if asked.accepts(numbers.tolist()) and shown(asked, numbers):
            return [float(number) for number in numbers]
    return None


def _as_sketched(asked: Asked, low: Real, high: Real) -> tuple[Real, Any]:
    """Numbers with which the links are about as long as the sketch has them, by Gauss and Newton's method, and which of
    them that tells.
    """
    told: Any = np.zeros(len(low), dtype=bool)
    numbers = (np.array(list(asked.low.values())) + np.array(list(asked.high.values()))) / 2
    for _ in range(ITERATIONS):
        steps = np.where(numbers + STEP * (high - low) > high, -STEP, STEP) * (high - low)
        rows = [numbers, *(numbers + np.diag(steps))]
        if not all(asked.accepts(row.tolist()) for row in rows):
            break
        off = np.array([_too_long(asked.make(row.tolist()).linkage) for row in rows])
        slope = (off[1:] - off[0]) / steps[:, None]
        told = np.any(slope != 0, axis=1)
        numbers = np.clip(numbers - np.linalg.lstsq(slope.T, off[0], rcond=LEAST)[0], low, high)
    return numbers, told


def _too_long(linkage: Linkage) -> list[float]:
    """By how much the distances of points on each link exceed those that they are sketched at (m)."""
    spots = {**linkage.sketch.points, **linkage.links[FRAME].points}
    drives = drives_at(linkage, np.array([linkage.sketch.at]))
    for driver in linkage.cranks:
        pose = driven_state(linkage, driver, drives[driver.link])[0]
        spots |= {name: complex(pose.at(own)[0]) for name, own in linkage.links[driver.link].points.items()}
    return [0.0] + [
        float(abs(link.points[a] - link.points[b]) - abs(spots[a] - spots[b]))
        for link in linkage.links.values() for a, b in combinations(link.points, 2) if a in spots and b in spots
    ]  # fmt: skip
