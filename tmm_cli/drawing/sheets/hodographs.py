"""Hodographs of forces: curves traced over the cycle by the end of a force drawn from a fixed pole."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from tmm_cli.drawing.paper import (
    ARROWHEAD_HALF_WIDTH,
    DARK_COLOUR,
    LOAD_COLOUR,
    REACTION_COLOUR,
    THIN_COLOUR,
    Drawing,
    DrawingSheet,
    Style,
    Words,
    file_safe_name,
    scale_words,
)
from tmm_cli.drawing.sheets.diagrams import QuantityPlot, SampledCurve, dense_coordinates, plot_over_driver
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Results, results_at
from tmm_cli.mechanics.forces import Reaction, reaction_symbol
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import NO_FORCE, SAME_DRIVER_POSITION, Vector
from tmm_cli.mechanics.quantities import FORCE

AXIS_OVERHANG = 8.0  # mm of the axes beyond the curves
AXIS_HEAD_LENGTH = 3.0  # mm
FIGURE_PAD = 30.0  # mm about the figure
LEAST_JUMP = 0.5  # mm between two points at the end of a stroke that count as a jump
MOST_NUMBERED = 24  # positions with numbers


@dataclass(frozen=True)
class Hodograph:
    """Curve that the end of a force traces over the cycle if the force is drawn from a fixed pole.

    Attributes:
        name: note that explains its line; empty if there is none.
        cycle: force at closely spaced driver coordinates, x + iy, N.
        positions: force at the computed positions, x + iy, N.
        colour, style: colour and style of the line.
        leaps: indices of `cycle` after which the force may jump.
    """

    name: Words
    cycle: Vector
    positions: Vector
    colour: str
    style: Style = "-"
    leaps: Sequence[int] = ()


def draw_shaking_hodograph(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Yield the hodograph of the shaking force with and without counterweights; nothing if the force is zero."""
    balancing = results.balancing
    if balancing is None or not balancing.cycle.shakes:
        return
    drawn = [
        Hodograph(
            _("dashed: without counterweights"), balancing.cycle.before.force, balancing.before.force, LOAD_COLOUR, "--"
        )
    ]
    if balancing.cycle.counterweights:
        name = _("solid: with counterweights") if balancing.cycle.left > NO_FORCE else _("dot: with counterweights")
        drawn.append(Hodograph(name, balancing.cycle.after.force, balancing.after.force, REACTION_COLOUR))
    yield "shaking-force", hodograph_sheet(results, _("Hodograph of the shaking force on the frame"), drawn, "F")


def draw_reaction_hodographs(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Yield the hodographs of the reaction in each pair, and its magnitude and components over the cycle."""
    assert results.reactions is not None
    coordinates, borders = dense_coordinates(results)
    whole = results_at(results, coordinates)
    assert whole.reactions is not None
    for reaction, cycle in zip(results.reactions.all, whole.reactions.all, strict=True):
        pair, symbol = reaction.pair.name, reaction_symbol(reaction.by, reaction.on)
        title = _("Hodograph of the reaction {name} in pair {pair}").format(name=symbol.name, pair=pair)
        curve = Hodograph("", cycle.force, reaction.force, REACTION_COLOUR, leaps=borders)
        if np.nanmax(np.abs(cycle.force)) > 0:
            yield file_safe_name(f"hodograph-{pair}"), hodograph_sheet(results, title, [curve], "R")
            yield from _hodographs_in_rotating_axes(results, whole, reaction, cycle, borders)
            over = _("Reaction {name} in pair {pair} over the cycle").format(name=symbol.name, pair=pair)
            parts = _force_components(cycle.force, reaction.force)
            yield from plot_over_driver(results, file_safe_name(f"reaction-{pair}"), over, coordinates, borders, parts)


def _hodographs_in_rotating_axes(
    results: Results, whole: Results, reaction: Reaction, cycle: Reaction, leaps: Sequence[int]
) -> Iterable[tuple[str, Drawing]]:
    """Yield the hodographs of a reaction in the axes of each rotating link of its pair.

    If the crank rotates fully, a polar diagram follows: the magnitude of the reaction against the crank angle.
    """
    assert results.motion is not None and whole.motion is not None
    pair, symbol = reaction.pair.name, reaction_symbol(reaction.by, reaction.on)
    for link in (reaction.by, reaction.on):
        if link != FRAME and np.ptp(angles := whole.motion.angle(link)) > SAME_DRIVER_POSITION:
            title = _("Hodograph of the reaction {name} in pair {pair}, in axes rotating with link {link}")
            rotations = np.exp(-1j * angles), np.exp(-1j * results.motion.angle(link))
            curve = Hodograph(
                "", cycle.force * rotations[0], reaction.force * rotations[1], REACTION_COLOUR, leaps=leaps
            )
            named = title.format(name=symbol.name, pair=pair, link=link)
            yield file_safe_name(f"hodograph-{pair}-link-{link}"), hodograph_sheet(results, named, [curve], "R")
    if results.turns:
        title = _("Polar diagram: magnitude of the reaction {name} in pair {pair} against the crank angle")
        polar = np.abs(cycle.force) * np.exp(1j * whole.motion.q)
        curve = Hodograph(
            "", polar, np.abs(reaction.force) * np.exp(1j * results.motion.q), REACTION_COLOUR, leaps=leaps
        )
        yield (
            file_safe_name(f"polar-{pair}"),
            hodograph_sheet(results, title.format(name=symbol.name, pair=pair), [curve], "R"),
        )


def _force_components(cycle: Vector, positions: Vector) -> list[QuantityPlot]:
    """Return the plots of the magnitude of a force and of its x and y components."""
    parts = [("x", cycle.real, positions.real), ("y", cycle.imag, positions.imag)]
    size = SampledCurve("", np.abs(cycle), np.abs(positions))
    return [
        QuantityPlot(_("magnitude of the reaction"), FORCE, [size], "R"),
        QuantityPlot(_("components along x and y"), FORCE, [SampledCurve(*component) for component in parts], "R"),
    ]


def hodograph_sheet(results: Results, caption: str, drawn: Sequence[Hodograph], letter: str) -> Drawing:
    """Draw hodographs from the same pole at the same scale. A negligible force is drawn as a dot.

    Args:
        results: results at the computed positions.
        caption: caption of the sheet.
        drawn: the hodographs.
        letter: letter in the scale factor.
    """
    largest = max(float(np.nanmax(np.abs(curve.cycle))) for curve in drawn)
    points = [0j, *(complex(p) for curve in drawn for p in curve.cycle)]
    sheet = DrawingSheet(results.problem.title, caption, points, pad=FIGURE_PAD)
    _draw_axes(sheet, points)
    for curve in drawn:
        if curve.name:
            sheet.note(curve.name)
        if not np.nanmax(np.abs(curve.cycle)) > NO_FORCE * largest:
            sheet.circle(sheet.on(0j), 1.0, curve.colour, curve.colour, 0.3, 6)
            continue
        _draw_hodograph(sheet, results, curve)
        _number_positions(sheet, results, curve)
    sheet.note(scale_words(letter, sheet.mu, "N/mm"))
    return sheet.finish()


def _draw_hodograph(sheet: DrawingSheet, results: Results, curve: Hodograph) -> None:
    """Draw a hodograph, closed if the driver rotates fully. Jumps are thin dotted lines."""
    closed = np.append(curve.cycle, curve.cycle[:1]) if results.turns else curve.cycle
    points = sheet.origin + closed / sheet.mu
    leaps = [k for k in curve.leaps if abs(points[k + 1] - points[k]) > LEAST_JUMP]
    sheet.line(np.insert(points, np.array(leaps, int) + 1, np.nan).tolist(), curve.colour, 1.4, curve.style)
    for k in leaps:
        sheet.line(points[k : k + 2].tolist(), curve.colour, 0.7, ":")


def _draw_axes(sheet: DrawingSheet, points: Sequence[complex]) -> None:
    """Draw the x and y axes through the pole."""
    on = np.array([sheet.on(place) for place in points if np.isfinite(place)])
    pole = sheet.on(0j)
    for along, low, high, name in (
        (1 + 0j, on.real.min() - pole.real, on.real.max() - pole.real, "x"),
        (1j, on.imag.min() - pole.imag, on.imag.max() - pole.imag, "y"),
    ):
        start, end = pole + along * (low - AXIS_OVERHANG), pole + along * (high + AXIS_OVERHANG)
        sheet.line([start, end], THIN_COLOUR, 0.7, z=1.0, faint=True)
        back, side = AXIS_HEAD_LENGTH * along, ARROWHEAD_HALF_WIDTH * 1j * along
        sheet.area([end, end - back - side, end - back + side], THIN_COLOUR, "none", z=1.0)
        sheet.label(name, end, 9)
    sheet.circle(pole, 0.7, "white", DARK_COLOUR, 0.8)


def _number_positions(sheet: DrawingSheet, results: Results, curve: Hodograph) -> None:
    """Mark the computed positions on a hodograph by dots with their numbers."""
    step = -(-len(results.numbers) // MOST_NUMBERED)
    for number, value in list(zip(results.numbers, curve.positions.tolist(), strict=True))[::step]:
        if np.isfinite(value):
            sheet.circle(sheet.on(value), 0.6, curve.colour, curve.colour, 0.3)
            sheet.label(str(number), sheet.on(value), 8, curve.colour)
