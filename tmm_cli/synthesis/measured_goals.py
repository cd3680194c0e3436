"""Goals measured on a mechanism that was analysed by the ordinary stages."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_cli.roots import least, top
from tmm_cli.strokes import output_place
from tmm_cli.synthesis import measures
from tmm_cli.synthesis.goals import FORCES, LEAST, PEAKS, PLAIN, Goal
from tmm_cli.synthesis.measures import Ends
from tmm_cli.vectors import Real

if TYPE_CHECKING:
    from tmm_cli.motion import Motion
    from tmm_cli.pipeline import Results

SCAN = 1440  # places in a turn, or in a stroke
WAY = {"pressure": measures.pressure, "stroke": measures.stroke}
CYCLE = {"speed": measures.mean_speed, "k": measures.slower_ratio}


def measure(goal: Goal, results: Results, ends: Ends = None) -> float:
    """The value of a goal (SI, rad) over the driver's way between two ends, else over its cycle.

    nan where the mechanism has none.
    """
    if goal.of in CYCLE:
        return CYCLE[goal.of](results)
    if not measures.goes_its_way(results, ends):
        return measures.NONE
    if goal.of in WAY:
        return WAY[goal.of](results, ends)
    if goal.of in PLAIN:
        return float(_outputs(goal, results, np.array([results.start]))["value"])
    if goal.of in PEAKS:
        total = sum(_peak(goal, results, ends, name) for name in goal.curves)
        return -total if goal.of in LEAST else total
    return float(goal.counted(deviations(goal, results, ends)[None, :])[0])


def deviations(goal: Goal, results: Results, ends: Ends = None) -> Real:
    """Of a path or a law from each of what is wanted (m or rad)."""
    if goal.of == "law":
        off = output_place(_motion(results, np.array(goal.places)), goal.name) - np.array(goal.wanted)
        off = off - off[0] if goal.relative else off
        turned: Real = off if results.linkage.slides_on_frame(goal.name) else np.angle(np.exp(1j * off))
        return turned
    if goal.places:
        apart: Real = np.abs(_motion(results, np.array(goal.places)).spot(goal.name) - np.array(goal.wanted))
        return apart
    return np.array([_nearest(goal, results, ends, wanted) for wanted in goal.wanted])


def _motion(results: Results, q: Real) -> Motion:
    from tmm_cli.pipeline import at_positions

    return at_positions(results, np.atleast_1d(q))


def _outputs(goal: Goal, results: Results, q: Real) -> Mapping[str, Any]:
    from tmm_cli.batch import reactions_of

    motion = _motion(results, q)
    forces = goal.of in FORCES
    return goal.outputs(motion, reactions_of(motion, results.structure, results.strokes) if forces else None)


def _highest(curve: Callable[[Real], Real], results: Results, ends: Ends) -> float:
    """The largest value of a curve over the driver's way: in a cycle from position 0 on."""
    assert results.way is not None
    driver, turns = results.linkage.driver, results.way.turns
    if ends is None and not results.way.full:
        ends = results.way.start, results.way.end
    low, high = ends or sorted((results.start, results.start + driver.sense * 2 * np.pi * turns))
    q = np.linspace(low, high, SCAN * turns + 1)
    y = curve(q)
    k, step = int(np.nanargmax(y)), q[1] - q[0]
    if (ends or driver.acceleration) and k in (0, len(q) - 1):
        return float(y[k])
    place, value = least(lambda x: -curve(x), q[k] - step, q[k] + step)
    place = top(lambda x: -curve(x), place, step)
    return float(max(curve(np.array([place]))[0], -value, y[k]))


def _peak(goal: Goal, results: Results, ends: Ends, name: str) -> float:
    return _highest(lambda q: np.asarray(_outputs(goal, results, q)[name]), results, ends)


def _nearest(goal: Goal, results: Results, ends: Ends, wanted: complex) -> float:
    found = _highest(lambda q: -(np.abs(_motion(results, q).spot(goal.name) - wanted) ** 2), results, ends)
    return float(np.sqrt(max(-found, 0.0)))
