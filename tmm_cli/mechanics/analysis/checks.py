"""Checks of a mechanism. For each one: its value, the limit, and the driver coordinate where they are closest.

The checks cover the whole range of the driver (a cycle, or from the first to the last position), not only the computed
positions.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from typing import Literal

import numpy as np

from tmm_cli.mechanics.analysis.pipeline import Results, motion_at_positions
from tmm_cli.mechanics.forces import problem_loads
from tmm_cli.mechanics.groups import GroupSolver, LinkStates, link_states, solvers_towards
from tmm_cli.mechanics.kinematics import SCAN, Motion
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import NO_DIFFERENCE, NO_PRESSURE, NO_WORK, SEAM_OF_EXTREMES, Real, dot, find_minima

CheckKind = Literal["slot", "pressure", "load", "near dead", "lever"]


@dataclass(frozen=True)
class Check:
    """Value of a check, compared with its limit.

    The kinds of checks and their values are:

    - slot: distance by which a sliding block goes beyond the end of its slot, m; negative if it stays inside.
    - pressure: largest pressure angle of a link, rad.
    - load: work (J) of a permanent load in the stroke in which it drives, although it resists in the other one.
    - near dead: least margin of an Assur group to its dead positions, from 0 (dead) to 1.
    - lever: largest relative difference between the balancing moments of the Zhukovsky lever and of the force plan.

    Attributes:
        kind: kind of the check.
        of: name of the slot, link, load or group in the file; empty for the lever.
        at: driver coordinate, rad or m; None if there is none.
        value: the value.
        limit: the smallest allowed value for "near dead", the largest for all other kinds.
        holds: True if the check is passed.
        detail: end of the slot; group of the driven link; or "working" or "idle", the stroke in which the load drives.
    """

    kind: CheckKind
    of: str
    at: float | None
    value: float
    limit: float
    holds: bool
    detail: str = ""


@lru_cache(maxsize=1)
def run_checks(results: Results) -> tuple[Check, ...]:
    """Run all checks. There are none if forces were not computed, or if only some points and links were requested."""
    if results.lever is None or results.of or results.driver_range is None:
        return ()
    closely = motion_at_positions(results, results.closely(SCAN * results.driver_range.turns + 1), 1)
    checks = (
        *_slot_checks(results),
        *_pressure_checks(results),
        *_load_checks(results, closely),
        *_dead_position_checks(results, closely),
        *_lever_checks(results),
    )
    if not results.driver_range.full:
        return checks
    cycle = results.driver_range.end - results.driver_range.start
    seam = SEAM_OF_EXTREMES
    return tuple(c if c.at is None else replace(c, at=max((c.at + seam) % cycle - seam, 0.0)) for c in checks)


def _slot_checks(results: Results) -> Iterable[Check]:
    """Yield a check for each slot.

    Of its two ends, the one is checked that the sliding block comes closest to or goes farthest beyond.
    """
    for name in dict.fromkeys(excess.slide.name for excess in results.slots):
        worst = max((excess for excess in results.slots if excess.slide.name == name), key=lambda excess: excess.far)
        yield Check("slot", name, worst.place, worst.far, 0.0, not worst.ways, worst.point)


def _pressure_checks(results: Results) -> Iterable[Check]:
    for pressure in results.pressure:
        place = pressure.place if pressure.largest > NO_PRESSURE else None
        yield Check(
            "pressure", pressure.link, place, pressure.largest, pressure.allowed, pressure.holds, pressure.group
        )


def _load_checks(results: Results, motion: Motion) -> Iterable[Check]:
    """Yield a check of each permanent load between a link and the frame, constant or tabulated against the stroke.

    The check fails if the load resists the motion in one stroke and drives it in the other. There are no checks if the
    output has no strokes.
    """
    strokes, loads = results.strokes, results.linkage.loads
    if strokes is None or not strokes.strokes:
        return
    always = {
        x.name: x.table.stroke_link if x.table else ""
        for x in loads
        if not x.working_stroke_only
        and x.window is None
        and not x.resists
        and x.base == FRAME
        and (x.table is None or x.table.against == "stroke")
    }
    between = (motion.q[1:] + motion.q[:-1]) / 2
    for load in problem_loads(motion, strokes):
        if load.name not in always:
            continue
        works = strokes.of_link(always[load.name]).share(between, motion.linkage.driver.sense)
        rate, arm = motion.first[load.link], load.at * motion.poses[load.link].z
        slope: Real = dot(load.force, rate.at(arm)) + load.moment * rate.w
        work = (slope[1:] + slope[:-1]) / 2 * np.diff(motion.q)
        work = np.where(np.isfinite(work), work, 0.0)
        work_by_stroke = {"working": float(np.sum(work[works])), "idle": float(np.sum(work[~works]))}
        drives = max(work_by_stroke, key=lambda stroke: work_by_stroke[stroke])
        resists = -min(work_by_stroke.values()) > NO_WORK * float(np.sum(np.abs(work)))
        both = resists and work_by_stroke[drives] > NO_WORK * float(np.sum(np.abs(work)))
        yield Check(
            "load", load.name, None, work_by_stroke[drives] if both else 0.0, 0.0, not both, drives if both else ""
        )


def _dead_position_checks(results: Results, motion: LinkStates) -> Iterable[Check]:
    """Yield the least margin of each group to its dead positions and change points."""
    step = abs(float(motion.q[1] - motion.q[0]))
    for kernel, placement in zip(motion.kernels, motion.placements, strict=True):
        title = kernel.group.title
        margin = np.where(motion.placed, placement.margin, np.inf)
        if not bool(np.any(np.isfinite(margin))):
            continue
        k = int(np.argmin(margin))
        upto = solvers_towards(motion.kernels, kernel.group.links)
        margins = [
            find_minima(partial(_last_margin, results, upto), float(motion.q[k]) - step, float(motion.q[k]) + step)
        ]
        margins += [(float(motion.q[k]), float(margin[k]))]
        margins += [(dead.place, dead.margin) for dead in results.dead if dead.group == title]
        place, value = min(margins, key=lambda pair: pair[1])
        yield Check("near dead", title, place, value, kernel.near, value >= kernel.near)


def _last_margin(results: Results, upto: tuple[GroupSolver, ...], q: Real) -> Real:
    """Return the margin of the last group in `upto` to its dead positions, at driver coordinates q.

    upto: solvers of the group and of the groups on which it depends, in solving order.
    """
    states = link_states(results.linkage, upto, q, 0)
    return np.where(states.placed, states.placements[-1].margin, np.inf)


def _lever_checks(results: Results) -> Iterable[Check]:
    """Yield the check of the Zhukovsky lever, at the position where it differs most from the force plan."""
    assert results.lever is not None and results.motion is not None
    counted = results.motion.moving & ~results.locked
    if bool(np.any(counted)):
        k = int(np.argmax(np.where(counted, results.lever.difference, -1.0)))
        value, limit = float(results.lever.difference[k]), results.inputs.lever_limit
        place = float(results.motion.q[k]) if value > NO_DIFFERENCE else None
        yield Check("lever", "", place, value, limit, results.lever_holds)
