"""A single run over the way of the driver: moments, works and energy, speed, acceleration, time."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_cli.drawing.paper import (
    CommonAxis,
    Drawing,
    DrawingSheet,
    axis_extent,
    draw_chart,
    round_axis,
    scale_words,
    with_unit,
)
from tmm_cli.drawing.sheets.diagrams import plot_quantities
from tmm_cli.drawing.sheets.over_cycle import QuantityPlot, SampledCurve
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.plans import PORTRAIT
from tmm_cli.mechanics.quantities import (
    ACCELERATION,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    FORCE,
    LENGTH,
    MOMENT,
    NUMBER,
    SPEED,
)

if TYPE_CHECKING:
    from tmm_cli.mechanics.dynamics import SingleRun


MOST_SAMPLES = 480  # of all pieces of a run together
SAMPLES_PER_PIECE, LEAST_SAMPLES = 40, 4  # of each: where there are few pieces, and where there are very many


def draw_single_run(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Of a file that asks for one."""
    single = results.single
    if single is None or results.motion is None:
        return
    crank, units = results.linkage.driver.kind == "turn", results.problem.units
    factor = np.pi / 180 if crank else units.factor(LENGTH)
    count = len(single.run.steps)
    pieces = single.run.closely(
        max(LEAST_SAMPLES, min(SAMPLES_PER_PIECE, 4 * MOST_SAMPLES // count), MOST_SAMPLES // count)
    )
    times, states = (np.concatenate(part, axis=-1) for part in zip(*pieces, strict=True))
    ends = (np.cumsum([len(own) for own, __ in pieces])[:-1] - 1).tolist()
    here = single.way(results.motion.q)
    time, speed = single.run.at(here)
    sheet = DrawingSheet(
        results.problem.title, _("Single run over the way of the driver; dots: computed positions"), paper=PORTRAIT
    )
    start, most = axis_extent(sheet)
    axis = round_axis(0.0, float(single.run.way[-1]) / factor, start, most, degrees=crank)
    if crank:
        told = _("turn of the crank from the beginning of the run, deg")
        words = f"{told};  ", *scale_words("φ", axis.mu, "deg/mm")
    else:
        told = with_unit(_("way of the driver from the beginning of the run"), LENGTH, units)
        words = f"{told};  ", *scale_words("s", axis.mu * factor, "m/mm")
    reached = np.isfinite(time)
    numbers = [(float(x) / factor, str(n)) for x, n, there in zip(here, results.numbers, reached, strict=True) if there]
    every = _run_plots(single, (times, states), (time, here, speed), crank=crank)
    plots = [plot_quantities(one, units, states[0] / factor, here / factor, ends) for one in every]
    draw_chart(sheet, plots, CommonAxis(axis, words, sorted(numbers)))
    yield "single-run", sheet.finish()


def _run_plots(
    single: SingleRun, curve: tuple[Real, Any], points: tuple[Real, Real, Real], *, crank: bool
) -> list[QuantityPlot]:
    """Over the times and states of the curve; at the times, ways and speeds of the points."""
    times, (way, speed, driven, loaded, braked) = curve
    time, here, there = points
    changes, at_points = single.acceleration(times, way, speed), single.acceleration(time, here, there)
    none = np.full(np.shape(here), np.nan)
    moments = [
        SampledCurve(_("what drives"), single.driving(way, speed, changes), single.driving(here, there, at_points)),
        SampledCurve(
            _("loads"), single.machine.moment(way), np.where(np.isfinite(time), single.machine.moment(here), none)
        ),
    ]
    works = [SampledCurve(_("what drives"), driven, none), SampledCurve(_("loads"), loaded, none)]
    if single.task.brake:
        works.append(SampledCurve(_("brake"), braked, none))
    works.append(SampledCurve(_("kinetic energy"), single.energy(way, speed), single.energy(here, there)))
    return [
        QuantityPlot(_("moments") if crank else _("forces"), MOMENT if crank else FORCE, moments),
        QuantityPlot(_("works and kinetic energy, J"), NUMBER, works, "A"),
        QuantityPlot(
            _("angular velocity ω") if crank else _("speed v"),
            ANGULAR_SPEED if crank else SPEED,
            [SampledCurve("", speed, there)],
        ),
        QuantityPlot(
            _("angular acceleration ε") if crank else _("acceleration a"),
            ANGULAR_ACCELERATION if crank else ACCELERATION,
            [SampledCurve("", changes, at_points)],
        ),
        QuantityPlot(_("time t, s"), NUMBER, [SampledCurve("", times, time)], "t"),
    ]
