"""A single run over the way of the driver: moments, works and energy, speed, acceleration, time."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_cli.drawing.paper import Across, Drawing, Sheet, across, axis_room, draw_chart, scale_words, with_unit
from tmm_cli.drawing.sheets.diagrams import plotted
from tmm_cli.drawing.sheets.over_cycle import Course, Quantities
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


PLACES = 480  # of all pieces of a run together
LEAST, FEWEST = 40, 4  # of each: where there are few pieces, and where there are very many


def draw_single_run(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Of a file that asks for one."""
    single = results.single
    if single is None or results.motion is None:
        return
    crank, units = results.linkage.driver.kind == "turn", results.problem.units
    factor = np.pi / 180 if crank else units.factor(LENGTH)
    count = len(single.run.steps)
    pieces = single.run.closely(max(FEWEST, min(LEAST, 4 * PLACES // count), PLACES // count))
    times, states = (np.concatenate(part, axis=-1) for part in zip(*pieces, strict=True))
    ends = (np.cumsum([len(own) for own, __ in pieces])[:-1] - 1).tolist()
    here = single.way(results.motion.q)
    time, speed = single.run.at(here)
    sheet = Sheet(
        results.problem.title, _("Single run over the way of the driver; dots: computed positions"), paper=PORTRAIT
    )
    start, most = axis_room(sheet)
    axis = across(0.0, float(single.run.way[-1]) / factor, start, most, degrees=crank)
    if crank:
        told = _("turn of the crank from the beginning of the run, deg")
        words = f"{told};  ", *scale_words("φ", axis.mu, "deg/mm")
    else:
        told = with_unit(_("way of the driver from the beginning of the run"), LENGTH, units)
        words = f"{told};  ", *scale_words("s", axis.mu * factor, "m/mm")
    reached = np.isfinite(time)
    numbers = [(float(x) / factor, str(n)) for x, n, there in zip(here, results.numbers, reached, strict=True) if there]
    every = _quantities(single, (times, states), (time, here, speed), crank=crank)
    plots = [plotted(one, units, states[0] / factor, here / factor, ends) for one in every]
    draw_chart(sheet, plots, Across(axis, words, sorted(numbers)))
    yield "single-run", sheet.finish()


def _quantities(
    single: SingleRun, curve: tuple[Real, Any], points: tuple[Real, Real, Real], *, crank: bool
) -> list[Quantities]:
    """Over the times and states of the curve; at the times, ways and speeds of the points."""
    times, (way, speed, driven, loaded, braked) = curve
    time, here, there = points
    changes, at_points = single.acceleration(times, way, speed), single.acceleration(time, here, there)
    none = np.full(np.shape(here), np.nan)
    moments = [
        Course(_("what drives"), single.driving(way, speed, changes), single.driving(here, there, at_points)),
        Course(_("loads"), single.machine.moment(way), np.where(np.isfinite(time), single.machine.moment(here), none)),
    ]
    works = [Course(_("what drives"), driven, none), Course(_("loads"), loaded, none)]
    if single.task.brake:
        works.append(Course(_("brake"), braked, none))
    works.append(Course(_("kinetic energy"), single.energy(way, speed), single.energy(here, there)))
    return [
        Quantities(_("moments") if crank else _("forces"), MOMENT if crank else FORCE, moments),
        Quantities(_("works and kinetic energy, J"), NUMBER, works, "A"),
        Quantities(
            _("angular velocity ω") if crank else _("speed v"),
            ANGULAR_SPEED if crank else SPEED,
            [Course("", speed, there)],
        ),
        Quantities(
            _("angular acceleration ε") if crank else _("acceleration a"),
            ANGULAR_ACCELERATION if crank else ACCELERATION,
            [Course("", changes, at_points)],
        ),
        Quantities(_("time t, s"), NUMBER, [Course("", times, time)], "t"),
    ]
