"""Exact change points of groups in closed form: dead positions that they pass and do not turn back in.

A parallelogram has two. There the determinant is zero and only its sign tells the two ways on; along the smooth one,
on which velocities are continuous, that changes.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from tmm_cli.groups.base import Closed, Kernel, reach
from tmm_cli.groups.sequence import link_states, towards
from tmm_cli.groups.smooth_way import SmoothWay
from tmm_cli.linkage import Linkage
from tmm_cli.roots import least, roots
from tmm_cli.structure.cycle import turns_of_cycle
from tmm_cli.vectors import Real

SCAN = 360  # places a turn
CLOSER = 129  # places between two of these, where it seems to come to nothing
BESIDE = 1e-3  # steps of the scan: so near, a determinant with a simple zero grows as the distance
SIMPLE = 3.0  # times: at twice the distance such a one is twice as large, one with a double zero four times


def smooth_way(linkage: Linkage, before: tuple[Kernel, ...], kernel: Closed) -> SmoothWay | None:
    """The way of a group through its change points; None where it has none, or they are all touched only."""
    upto = towards((*before, kernel), kernel.group.links)
    turns = linkage.driver.kind == "turn"
    number = turns_of_cycle(linkage) or 1
    for other in upto[:-1]:
        way = other.way if isinstance(other, Closed) else None
        if way is not None and way.cycle is not None and len(way.places) % 2:
            number *= 2
    half = np.pi * number if turns else reach(linkage)
    start, step = linkage.sketch.at - half, 2 * half / (SCAN * number)
    q = start + step * np.arange(-2, SCAN * number + 3)
    at = link_states(linkage, upto, q, 0, blank=False).placements[-1]
    residual = np.where(np.isfinite(at.residual), at.residual, -np.inf)
    inner = residual[1:-1]
    with np.errstate(invalid="ignore"):  # of places where nothing is
        rise = np.abs(np.diff(residual))
        near = (inner >= residual[:-2]) & (inner > residual[2:]) & (inner + 2 * np.maximum(rise[1:], rise[:-1]) >= 0)
    found = np.sort(_exact(linkage, upto, q[np.flatnonzero(near) + 1], float(step)))
    if turns:
        found = np.sort(found - 2 * half * np.floor((found - start) / (2 * half)))
    places = found[np.diff(found, prepend=-np.inf) > step]
    if len(places) > 1 and turns and places[0] + 2 * half - places[-1] < step:
        places = places[:-1]
    return SmoothWay(places, start, linkage.sketch.at, 2 * half if turns else None) if places.size else None


def _exact(linkage: Linkage, upto: tuple[Kernel, ...], places: Real, step: float) -> Real:
    """The change points near places (places,), to the last bit, where the group has no room to spare and can pass."""
    if not places.size:
        return places
    to_spare = partial(slack, linkage, upto)
    closer = _rows(to_spare, places, step * np.linspace(-1, 1, CLOSER))
    with np.errstate(invalid="ignore"):
        falls = np.abs(np.min(closer, axis=1)) <= 2 * np.max(np.abs(np.diff(closer, axis=1)), axis=1)
    places = places[np.all(np.isfinite(closer), axis=1) & falls]
    if not places.size:
        return places
    best = pinned(linkage, upto, least(to_spare, places - step, places + step)[0], step)
    beside = best[:, None] + step * BESIDE * np.array([-2, -1, 0, 1, 2])
    states = link_states(linkage, upto, beside.ravel(), 0, blank=False)
    at = states.placements[-1]
    det, dead, placed = (
        np.broadcast_to(values, beside.size).reshape(beside.shape)
        for values in (np.abs(at.det), at.dead, states.placed)
    )
    passes = (det[:, 0] <= SIMPLE * det[:, 1]) & (det[:, 4] <= SIMPLE * det[:, 3])
    exact: Real = best[dead[:, 2] & np.all(placed, axis=1) & passes]
    return exact


def _rows(function: Callable[[Real], Real], places: Real, steps: Real) -> Real:
    """Values of a function at steps from each place, (places, steps)."""
    q = places[:, None] + steps
    return np.broadcast_to(function(q.ravel()), q.size).reshape(q.shape)


def slack(linkage: Linkage, kernels: tuple[Kernel, ...], q: Real) -> Real:
    """How much the last group has to spare before it cannot be assembled."""
    return -link_states(linkage, kernels, q, 0).placements[-1].residual


def pinned(linkage: Linkage, kernels: tuple[Kernel, ...], places: Real, step: float) -> Real:
    """Dead positions inside the range (places,) to the last bit: there the residual of the last group stops growing.

    The least of a quantity is known to half the digits only, the root of its rate to all of them.
    """
    last = kernels[-1]
    if not isinstance(last, Closed):
        return places

    def residual_rate(q: Real) -> Real:
        before = link_states(linkage, kernels[:-1], q, 1)
        return last.residual_rate(last.closed(before.poses, before.drives), before.poses, before.first, before.drives)

    low, high = places - step, places + step
    with np.errstate(all="ignore"):
        changes = np.sign(residual_rate(low)) * np.sign(residual_rate(high)) < 0
        if not np.any(changes):
            return places
        found = places.copy()
        found[changes] = roots(residual_rate, low[changes], high[changes])
    return found
