"""Symbols of gears, racks and cams, and marks that show their rigid connection to the bars of their links."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tmm_cli.drawing.paper import DARK_COLOUR, THIN_COLOUR, DrawingSheet, Style, distance_to_segment, draw_hatching
from tmm_cli.drawing.symbols.higher_pairs import CamOutline, GearDisc, HigherPairOutline, MeshOutline
from tmm_cli.drawing.symbols.link_forms import LinkForm, Segment
from tmm_cli.drawing.symbols.link_symbols import WELD_LEG, draw_weld
from tmm_cli.drawing.symbols.scene import ON_LINE
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import Vector, cross, dot, unit

CHAIN_STYLE: Style = "-."  # dash and dot
DASHED_STYLE: Style = "--"
TOOTH_PITCH = 3.6  # mm
TOOTH_HALF_HEIGHT = 1.1  # mm
TEETH_SHOWN = 5  # at the pitch point of each gear
RIM_DEPTH = 3.4  # mm: depth of an internal gear or a rack behind its pitch line
AXLE_RADIUS = 0.9  # mm: the circle in the middle of a roller
GEAR_Z = 2.3  # gears are drawn above plates
HATCH_OPENING = 1.1  # mm about a rod that are kept free of hatching


def draw_higher_pair(
    sheet: DrawingSheet,
    outline: HigherPairOutline,
    hue: Mapping[str, str],
    span: tuple[float, float] | None = None,
    rods: Sequence[Segment] = (),
) -> None:
    """Draw a higher pair. A gear or rack is drawn only if its link has a colour; a cam is always drawn.

    Args:
        sheet: sheet to draw on.
        outline: geometry of the pair.
        hue: colours of links.
        span: range of the rack from the pitch point (m); None: a short piece.
        rods: bars (mm) at which hatching is interrupted.
    """
    if isinstance(outline, CamOutline):
        _draw_cam(sheet, outline, hue)
        return
    pitch = sheet.on(outline.pitch)
    for disc in outline.discs:
        if disc.link in hue:
            with sheet.part(disc.link):
                _draw_pitch_circle(sheet, disc, hue[disc.link])
            _draw_teeth(sheet, disc, pitch, outline.along, hue[disc.link])
            if disc.link == FRAME:
                with sheet.part(FRAME):
                    _hatch_fixed_gear(sheet, disc, rods)
    if outline.side != 0 and outline.mesh.j in hue:
        with sheet.part(outline.mesh.j):
            _draw_rack(sheet, outline, hue[outline.mesh.j], span)
    sheet.circle(pitch, 0.55, DARK_COLOUR, DARK_COLOUR, 0.3, 6.4)


def _draw_in_field(sheet: DrawingSheet, points: Vector, colour: str, width: float, style: Style, z: float) -> None:
    """Draw the part of a curve that is inside the field of the sheet."""
    low, high = sheet.canvas.low, sheet.canvas.high
    inside = (points.real > low.real) & (points.real < high.real) & (points.imag > low.imag) & (points.imag < high.imag)
    if bool(np.any(inside)):
        sheet.line(list(np.where(inside, points, complex(np.nan, np.nan))), colour, width, style, z)


def _draw_pitch_circle(sheet: DrawingSheet, disc: GearDisc, colour: str) -> None:
    """Draw the pitch circle of a gear, and the rim if its teeth are internal."""
    centre, radius = sheet.on(disc.centre), disc.radius / sheet.mu
    number = int(np.clip(2 * np.pi * radius / 1.5, 48, 3000))
    directions = unit(np.linspace(0, 2 * np.pi, number + 1))
    _draw_in_field(sheet, centre + radius * directions, colour, 0.8, CHAIN_STYLE, GEAR_Z)
    if disc.ring:
        _draw_in_field(sheet, centre + (radius + RIM_DEPTH) * directions, colour, 1.2, "-", GEAR_Z)


def _hatch_fixed_gear(sheet: DrawingSheet, disc: GearDisc, rods: Sequence[Segment]) -> None:
    """Draw hatching along the rim of a fixed gear, interrupted where bars of links pass."""
    centre, out = sheet.on(disc.centre), 1.0 if disc.ring else -1.0
    rim = disc.radius / sheet.mu + (RIM_DEPTH if disc.ring else 0.0)
    number = int(np.clip(2 * np.pi * rim / 3.2, 12, 900))
    with sheet.on_layer("supports"):
        for direction in unit(np.linspace(0, 2 * np.pi, number, endpoint=False)):
            stroke = centre + direction * np.array([rim, rim + 0.85 * out + 0.6j, rim + 1.7 * out + 1.2j])
            if all(distance_to_segment(complex(place), *rod) > HATCH_OPENING for place in stroke for rod in rods):
                _draw_in_field(sheet, stroke, THIN_COLOUR, 0.6, "-", GEAR_Z)


def _tooth_wave(run: Any) -> Any:
    """Return the height of the tooth profile along a pitch line: +1 at the tips, -1 at the roots."""
    return np.clip(2.6 * np.sin(2 * np.pi * run / TOOTH_PITCH), -1, 1)


def _draw_teeth(sheet: DrawingSheet, disc: GearDisc, pitch: complex, along: complex, colour: str) -> None:
    """Draw some teeth of a gear at the pitch point. Both gears have the same wave profile, so that their teeth mesh."""
    centre, radius, reach = sheet.on(disc.centre), disc.radius / sheet.mu, TEETH_SHOWN / 2 * TOOTH_PITCH
    if radius < reach or not np.isfinite(pitch):
        return
    run = np.linspace(-reach, reach, 30 * TEETH_SHOWN + 1)
    out = (pitch - centre) / abs(pitch - centre)
    height = TOOTH_HALF_HEIGHT * _tooth_wave(run) * np.sign(dot(out, -1j * along))
    turn = run / radius * np.sign(dot(1j * out, along))
    _draw_in_field(sheet, centre + out * (radius + height) * unit(turn), colour, 0.9, "-", 2.3)


def _draw_rack(sheet: DrawingSheet, mesh: MeshOutline, colour: str, span: tuple[float, float] | None) -> None:
    """Draw a toothed bar connected to the sliding point of the rack; hatched if the rack is fixed."""
    pitch, along, side = sheet.on(mesh.pitch), mesh.along, mesh.side
    low, high = (-16.0, 16.0) if span is None else (span[0] / sheet.mu - 8, span[1] / sheet.mu + 8)
    run = np.linspace(low, high, int(np.clip(30 * (high - low) / TOOTH_PITCH, 60, 20_000)))
    teeth = pitch + run * along - 1j * along * TOOTH_HALF_HEIGHT * _tooth_wave(run)
    back = [pitch + high * along + side * RIM_DEPTH, pitch + low * along + side * RIM_DEPTH]
    _draw_in_field(sheet, np.concatenate([teeth, back, teeth[:1]]), colour, 1.1, "-", 2.6)
    _draw_in_field(sheet, pitch + np.array([low - 3, high + 3]) * along, colour, 0.8, CHAIN_STYLE, 2.05)
    if mesh.mesh.j == FRAME:
        draw_hatching(sheet, back[1], back[0], side)
        return
    start = sheet.on(mesh.start)
    foot = float(np.clip(dot(along, start - pitch), low, high))
    end = pitch + foot * along + side * RIM_DEPTH
    if abs(end - start) > 1.0:
        sheet.line([start, end], colour, 1.6, z=2.9)


def _draw_cam(sheet: DrawingSheet, cam: CamOutline, hue: Mapping[str, str]) -> None:
    """Draw the cam disk and the roller of the follower. The rest of the follower is drawn with its link."""
    disk = [sheet.on(complex(p)) for p in cam.disk]
    if cam.mesh.i in hue:
        with sheet.part(cam.mesh.i):
            sheet.area(disk[:-1], "#f1f3f6", hue[cam.mesh.i], 1.2, 1.9)
    else:
        sheet.line(disk, THIN_COLOUR, 0.8, DASHED_STYLE, 1.9)
    if cam.mesh.j not in hue:
        return
    colour = hue[cam.mesh.j]
    if cam.roller:
        with sheet.part(cam.mesh.j):
            sheet.circle(sheet.on(cam.face[0]), cam.roller / sheet.mu, "white", colour, 1.2, 2.9)
            sheet.circle(sheet.on(cam.face[0]), AXLE_RADIUS, "white", colour, 1.0)
    sheet.circle(sheet.on(cam.touch), 0.55, DARK_COLOUR, DARK_COLOUR, 0.3, 6.4)


SAME_ANGLE = 0.02  # rad: bars of one direction
STRAIGHT_ANGLE = 0.7  # rad from a straight line: there is hardly a corner to fill
SPOKE_WIDTH, THROUGH_WIDTH = 1.2, 2.0  # points


def draw_rigid_marks(
    sheet: DrawingSheet, outline: HigherPairOutline, form: LinkForm, link: str, colour: str, hinge: float
) -> None:
    """Draw marks that show that a gear or a follower is rigidly connected to the bars of its link."""
    if not isinstance(outline, CamOutline):
        for disc in outline.discs:
            if disc.link == link:
                _draw_spoke(sheet, disc, form, colour)
    elif outline.mesh.j == link:
        start, end = (sheet.on(place) for place in outline.stem)
        _draw_corner(sheet, start, end - start, form, colour, hinge)


def _arms_at(form: LinkForm, at: complex) -> list[complex]:
    """Return the vectors (mm) from a point to both ends of each bar of a link that passes through the point."""
    arms = []
    for start, end in form.edges:
        along = (end - start) / (abs(end - start) or 1.0)
        if abs(cross(along, at - start)) < ON_LINE and -ON_LINE < dot(along, at - start) < abs(end - start) + ON_LINE:
            arms += [arm for arm in (start - at, end - at) if abs(arm) > ON_LINE]
    return arms


def _draw_spoke(sheet: DrawingSheet, disc: GearDisc, form: LinkForm, colour: str) -> None:
    """Extend the longest bar at the axis of a gear to its rim, and mark the rigid connection of both there."""
    centre, radius = sheet.on(disc.centre), disc.radius / sheet.mu
    arm = max(_arms_at(form, centre), key=abs, default=0j)
    if abs(arm) < ON_LINE or radius < 2 * WELD_LEG:
        return
    out = arm / abs(arm)
    rim = centre + radius * out
    if abs(arm) < radius:
        sheet.line([centre + arm, rim], colour, SPOKE_WIDTH, z=2.9)
    draw_weld(sheet, rim, -WELD_LEG * out, WELD_LEG * 1j * out, colour)


def _draw_corner(sheet: DrawingSheet, at: complex, arm: complex, form: LinkForm, colour: str, hinge: float) -> None:
    """Mark the arm of a follower as rigidly connected to the nearest bar of its link at the same hinge."""
    others = [other for other in _arms_at(form, at) if abs(arm) > ON_LINE and abs(np.angle(other / arm)) > SAME_ANGLE]
    if not others:
        return
    nearest = min(others, key=lambda other: abs(float(np.angle(other / arm))))
    if abs(float(np.angle(nearest / arm))) < np.pi - STRAIGHT_ANGLE:
        draw_weld(sheet, at, arm, nearest, colour, hinge)
    else:  # the bar continues beyond the hinge
        sheet.line([at + hinge * arm / abs(arm), at, at + hinge * nearest / abs(nearest)], colour, THROUGH_WIDTH, z=6.2)
