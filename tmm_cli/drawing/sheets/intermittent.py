"""Sheets of the intermittent motion of gears and ratchet wheels.

They cover one cycle of the driver. If a wheel is driven with several settings in turn, they cover one cycle for each.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.drawing.paper import (
    CommonAxis,
    Drawing,
    DrawingSheet,
    axis_extent,
    draw_chart,
    file_safe_name,
    round_axis,
    scale_words,
    with_unit,
)
from tmm_cli.drawing.sheets.diagrams import QuantityPlot, SampledCurve, plot_quantities
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.quantities import ANGLE, ANGULAR_SPEED, LENGTH

if TYPE_CHECKING:
    from tmm_cli.mechanics.analysis import IntermittentMotion


def draw_intermittent(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Yield a sheet for each wheel that moves intermittently: its angle and angular speed against the driver travel."""
    for wheel in results.wheels or ():
        yield f"intermittent-{file_safe_name(wheel.task.name)}", _intermittent_sheet(results, wheel)


def _intermittent_sheet(results: Results, wheel: IntermittentMotion) -> Drawing:
    crank, units = results.linkage.driver.kind == "turn", results.problem.units
    factor = np.pi / 180 if crank else units.factor(LENGTH)
    caption = _("Intermittent motion over a cycle: {name}").format(name=wheel.task.name)
    sheet = DrawingSheet(results.problem.title, caption)
    axis = round_axis(0.0, wheel.way / factor, *axis_extent(sheet), degrees=crank)
    if crank:
        title = _("crank angle, deg")
        words = (f"{title};  ", *scale_words("φ", axis.mu, "deg/mm"))
    else:
        axis_title = with_unit(_("travel of the input link, forward and back"), LENGTH, units)
        words = (f"{axis_title};  ", *scale_words("s", axis.mu * factor, "m/mm"))
    ways, angles, omegas = (
        np.concatenate([getattr(stretch, name) for stretch in wheel.parts]) for name in ("ways", "angles", "omegas")
    )
    borders = (np.cumsum([len(stretch.ways) for stretch in wheel.parts])[:-1] - 1).tolist()
    quantity_plots = [
        QuantityPlot(_("angle of rotation of the wheel"), ANGLE, [SampledCurve("", angles, np.nan)]),
        QuantityPlot(_("angular speed of the wheel"), ANGULAR_SPEED, [SampledCurve("", omegas, np.nan)]),
    ]
    spans = [
        (
            stretch.ways[0] / factor,
            stretch.ways[-1] / factor,
            _("wheel driven") if stretch.ride.driven else _("wheel at rest"),
        )
        for stretch in wheel.parts
    ]
    plots = [plot_quantities(plot, units, ways / factor, np.zeros(0), borders) for plot in quantity_plots]
    draw_chart(sheet, plots, CommonAxis(axis, words, spans=spans))
    return sheet.finish()
