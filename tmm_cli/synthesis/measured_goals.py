"""Goals measured on a mechanism that was analysed by the ordinary stages."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.roots import least, top
from tmm_cli.strokes import output_place
from tmm_cli.synthesis import measures
from tmm_cli.synthesis.goals import LEAST, PEAKS, PLAIN, Goal
from tmm_cli.vectors import Real

if TYPE_CHECKING:
    from tmm_cli.pipeline import Results

SCAN = 1440
OWN = {"pressure": measures.pressure, "stroke": measures.stroke, "speed": measures.mean_speed}


def measure(goal: Goal, results: Results) -> float:
    """The value of a goal (SI, rad); nan where the mechanism has none."""
    if goal.of in OWN:
        return OWN[goal.of](results)
    if goal.of == "k":
        k = measures.ratio(results)
        return max(k, 1 / k)
    if results.way is None or not results.way.full:
        return measures.NONE
    if goal.of in PLAIN:
        return float(_outputs(goal, results, np.array([results.start]))["value"])
    if goal.of in PEAKS:
        total = sum(_peak(goal, results, name) for name in goal.curves)
        return -total if goal.of in LEAST else total
    if goal.of == "law":
        off = output_place(_motion(results, np.array(goal.places)), goal.name) - np.array(goal.wanted)
        off = off - off[0] if goal.relative else off
        if not results.linkage.slides_on_frame(goal.name):
            off = np.angle(np.exp(1j * off))
    elif goal.places:
        off = np.abs(_motion(results, np.array(goal.places)).spot(goal.name) - np.array(goal.wanted))
    else:
        off = np.array([_nearest(goal, results, wanted) for wanted in goal.wanted])
    return float(goal.counted(off[None, :])[0])


def _motion(results: Results, q: Real):  # type: ignore[no-untyped-def]
    from tmm_cli.pipeline import at_positions

    return at_positions(results, np.atleast_1d(q))


def _outputs(goal: Goal, results: Results, q: Real):  # type: ignore[no-untyped-def]
    from tmm_cli.forces.loads import applied
    from tmm_cli.forces.plan import react

    motion = _motion(results, q)
    reactions = None
    if goal.of in ("moment", "reaction"):
        reactions = react(motion, results.structure, applied(motion, results.strokes))
    return goal.outputs(motion, reactions)


def _highest(curve, start: float) -> float:  # type: ignore[no-untyped-def]
    """The largest value of a curve over a turn."""
    q = start + np.linspace(0, 2 * np.pi, SCAN + 1)
    y = curve(q)
    k, step = int(np.argmax(y)), q[1] - q[0]
    place, _ = least(lambda x: -curve(x), q[k] - step, q[k] + step)
    place = top(lambda x: -curve(x), place, step)
    return float(max(curve(np.array([place]))[0], y[k]))


def _peak(goal: Goal, results: Results, name: str) -> float:
    return _highest(lambda q: np.asarray(_outputs(goal, results, q)[name]), results.start)


def _nearest(goal: Goal, results: Results, wanted: complex) -> float:
    found = _highest(lambda q: -(np.abs(_motion(results, q).spot(goal.name) - wanted) ** 2), results.start)
    return float(np.sqrt(max(-found, 0.0)))
