"""How toothed wheels, racks and cams are drawn: pitch circles with some teeth, toothed bars, disks with rollers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tmm_cli.drawing.paper import DARK, THIN, Sheet, Style, aside, hatch
from tmm_cli.drawing.symbols.forms import Line
from tmm_cli.drawing.symbols.wheels import CamShape, Disc, Outline, Teeth
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import Vector, dot, unit

CHAIN: Style = "-."  # dash and dot
DASHED: Style = "--"
TOOTH, HEIGHT, TEETH = 3.6, 1.1, 5  # mm: pitch, half the height of a tooth; how many are hinted at
RIM = 3.4  # mm: what a wheel with inner teeth and a rack have behind their pitch line
AXLE = 0.9  # mm: the circle in the middle of a roller
ABOVE = 2.3  # plates do not hide wheels
OPEN = 1.1  # mm from a rod in which nothing is hatched


def draw(
    sheet: Sheet,
    found: Outline,
    hue: Mapping[str, str],
    span: tuple[float, float] | None = None,
    rods: Sequence[Line] = (),
) -> None:
    """What belongs to links that have a colour (hue), and a cam of any.

    span: how far the rack goes on both sides of the pitch point (m); rods (mm) keep hatching away.
    """
    if isinstance(found, CamShape):
        _draw_cam(sheet, found, hue)
        return
    pitch = sheet.on(found.pitch)
    for disc in found.discs:
        if disc.link in hue:
            with sheet.part(disc.link):
                _wheel(sheet, disc, hue[disc.link])
            _tooth_hint(sheet, disc, pitch, found.along, hue[disc.link])
            if disc.link == FRAME:
                with sheet.part(FRAME):
                    _hatched(sheet, disc, rods)
    if found.side != 0 and found.mesh.j in hue:
        with sheet.part(found.mesh.j):
            _rack_bar(sheet, found, hue[found.mesh.j], span)
    sheet.circle(pitch, 0.55, DARK, DARK, 0.3, 6.4)


def _curve(sheet: Sheet, places: Vector, colour: str, width: float, style: Style, z: float) -> None:
    """A curve within the drawing's field."""
    low, high = sheet.ground.low, sheet.ground.high
    inside = (places.real > low.real) & (places.real < high.real) & (places.imag > low.imag) & (places.imag < high.imag)
    if bool(np.any(inside)):
        sheet.line(list(np.where(inside, places, complex(np.nan, np.nan))), colour, width, style, z)


def _wheel(sheet: Sheet, disc: Disc, colour: str) -> None:
    """A pitch circle; the rim of inner teeth."""
    centre, radius = sheet.on(disc.centre), disc.radius / sheet.mu
    number = int(np.clip(2 * np.pi * radius / 1.5, 48, 3000))
    ways = unit(np.linspace(0, 2 * np.pi, number + 1))
    _curve(sheet, centre + radius * ways, colour, 0.8, CHAIN, ABOVE)
    if disc.ring:
        _curve(sheet, centre + (radius + RIM) * ways, colour, 1.2, "-", ABOVE)


def _hatched(sheet: Sheet, disc: Disc, rods: Sequence[Line]) -> None:
    """Strokes about a wheel that is the frame, but for those under rods."""
    centre, out = sheet.on(disc.centre), 1.0 if disc.ring else -1.0
    rim = disc.radius / sheet.mu + (RIM if disc.ring else 0.0)
    number = int(np.clip(2 * np.pi * rim / 3.2, 12, 900))
    with sheet.on_layer("supports"):
        for way in unit(np.linspace(0, 2 * np.pi, number, endpoint=False)):
            stroke = centre + way * np.array([rim, rim + 0.85 * out + 0.6j, rim + 1.7 * out + 1.2j])
            if all(aside(complex(place), *rod) > OPEN for place in stroke for rod in rods):
                _curve(sheet, stroke, THIN, 0.6, "-", ABOVE)


def _wave(run: Any) -> Any:
    """Teeth along a pitch line: +1 at tips, -1 at roots."""
    return np.clip(2.6 * np.sin(2 * np.pi * run / TOOTH), -1, 1)


def _tooth_hint(sheet: Sheet, disc: Disc, pitch: complex, along: complex, colour: str) -> None:
    """Some teeth at the pitch point: the same wave on both partners, so those of one fill the gaps of the other."""
    centre, radius, reach = sheet.on(disc.centre), disc.radius / sheet.mu, TEETH / 2 * TOOTH
    if radius < reach or not np.isfinite(pitch):
        return
    run = np.linspace(-reach, reach, 30 * TEETH + 1)
    out = (pitch - centre) / abs(pitch - centre)
    height = HEIGHT * _wave(run) * np.sign(dot(out, -1j * along))
    turn = run / radius * np.sign(dot(1j * out, along))
    _curve(sheet, centre + out * (radius + height) * unit(turn), colour, 0.9, "-", 2.3)


def _rack_bar(sheet: Sheet, found: Teeth, colour: str, span: tuple[float, float] | None) -> None:
    """A bar with teeth on its pitch line, joined to the running point of the rack; hatched where it is the frame."""
    pitch, along, side = sheet.on(found.pitch), found.along, found.side
    low, high = (-16.0, 16.0) if span is None else (span[0] / sheet.mu - 8, span[1] / sheet.mu + 8)
    run = np.linspace(low, high, int(np.clip(30 * (high - low) / TOOTH, 60, 20_000)))
    teeth = pitch + run * along - 1j * along * HEIGHT * _wave(run)
    back = [pitch + high * along + side * RIM, pitch + low * along + side * RIM]
    _curve(sheet, np.concatenate([teeth, back, teeth[:1]]), colour, 1.1, "-", 2.6)
    _curve(sheet, pitch + np.array([low - 3, high + 3]) * along, colour, 0.8, CHAIN, 2.05)
    if found.mesh.j == FRAME:
        hatch(sheet, back[1], back[0], side)
        return
    start = sheet.on(found.start)
    foot = float(np.clip(dot(along, start - pitch), low, high))
    end = pitch + foot * along + side * RIM
    if abs(end - start) > 1.0:
        sheet.line([start, end], colour, 1.6, z=2.9)


def _draw_cam(sheet: Sheet, found: CamShape, hue: Mapping[str, str]) -> None:
    """The disk, and the follower's roller; its other parts are bars of its link."""
    disk = [sheet.on(complex(p)) for p in found.disk]
    if found.mesh.i in hue:
        with sheet.part(found.mesh.i):
            sheet.area(disk[:-1], "#f1f3f6", hue[found.mesh.i], 1.2, 1.9)
    else:
        sheet.line(disk, THIN, 0.8, DASHED, 1.9)
    if found.mesh.j not in hue:
        return
    own = hue[found.mesh.j]
    if found.roller:
        with sheet.part(found.mesh.j):
            sheet.circle(sheet.on(found.face[0]), found.roller / sheet.mu, "white", own, 1.2, 2.9)
            sheet.circle(sheet.on(found.face[0]), AXLE, "white", own, 1.0)
    sheet.circle(sheet.on(found.touch), 0.55, DARK, DARK, 0.3, 6.4)
