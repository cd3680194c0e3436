"""A construction on its sheet: the mechanism as large as can be, what is beyond the edge cut there, sizes, angles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tmm_cli.draw.annotations import angle_mark, dimension
from tmm_cli.draw.labels import Label
from tmm_cli.draw.lettering import rename
from tmm_cli.draw.sheet import DARK, INERTIA, LOAD, THIN, Sheet, border, hatch, scale_text
from tmm_cli.draw.symbols import MEASURED, box, support
from tmm_cli.errors import _
from tmm_cli.linkage import Linkage
from tmm_cli.plans.record import sheet_scale
from tmm_cli.problem.units import UnitSystem
from tmm_cli.quantities import KINDS
from tmm_cli.synthesis.construction import Arc, Centre, Construction, Spot

STYLES = {  # colour, width, line
    "link": (DARK, 2.2, "-"), "link2": (INERTIA, 2.2, "-"), "thin": (THIN, 0.8, "-"), "dashed": (THIN, 0.7, "--"),
    "axis": (THIN, 0.7, "-."), "bold": (LOAD, 1.5, "-"), "guide": (DARK, 1.0, "-"),
}  # fmt: skip
PAD = 27.0  # mm about what must be on the sheet, for dimension lines and labels
SMALLER = 1.6  # so many times smaller the mechanism may become for what else is wished on the sheet
FINE = 1.0  # mm between places along an arc
QUIET = 12.0  # mm about a place on a curve that should be free for its name
ON_EDGE = 1e-6  # mm from the edge of the field: a line is cut there
ARROW = 4.0  # mm long: the mark of a line that goes on beyond the edge
NAMES = "#7a3d99"


def construction(
    title: str, drawn: Construction, units: UnitSystem, linkage: Linkage | None = None,
    names: Mapping[str, str] | None = None,
) -> Sheet:  # fmt: skip
    """One sheet; joints are called as in the linkage, parameters by their names in the file."""
    drawn, letters = rename(drawn, linkage, names or {})
    sheet = Sheet(title, drawn.title.format(**letters), granted(drawn), pad=PAD)
    sheet.ground.rivals += [sheet.on(s.at) for s in drawn.spots if s.name]
    for spot in drawn.spots:
        _spot(sheet, spot)
    lines: list[Label] = []
    for s in drawn.segments:
        colour, width, line = STYLES[s.style]
        start, end = sheet.on(s.start), sheet.on(s.end)
        if s.style == "guide":
            _guide(sheet, start, end)
            continue
        sheet.line([start, end], colour, width, line, z=3 if s.style.startswith("link") else 1.5)
        if s.name:
            lines.append(Label(s.name, (start + end) / 2, 10, NAMES, "italic", (start, end)))
    for arc in drawn.arcs:
        _curve(sheet, [_along(sheet, arc)], arc.style)
    pieces: dict[tuple[str, str], list[list[complex]]] = {}
    for curve in drawn.curves:
        pieces.setdefault((curve.name, curve.style), []).append([sheet.on(p) for p in curve.places])
    for named in (False, True):  # names when all curves are drawn
        for (name, style), places in pieces.items():
            _curve(sheet, places, style, name, named=named)
    for centre in drawn.centres:
        _centre(sheet, centre, units)
    for angle in drawn.angles:
        vertex, first, last = (sheet.on(p) for p in (angle.vertex, angle.first, angle.last))
        angle_mark(sheet, vertex, first, last, angle.name, right=angle.right)
    _notes(sheet, drawn, letters, units)
    sheet.corner()
    for size in drawn.sizes:
        way = size.end - size.start
        length = abs(way) if size.along == 0 else abs((way * np.conj(size.along / abs(size.along))).real)
        text = _value(size.name, length, "length", units, symbol=False)
        dimension(sheet, sheet.on(size.start), sheet.on(size.end), text, size.along)
    for spot in drawn.spots:
        if spot.name:
            sheet.labels.append(Label(spot.name, sheet.on(spot.at), 11, DARK, far=True))
    sheet.labels += lines
    sheet.ground.lines += [label.line for label in lines if label.line]
    sheet.labels.sort(key=lambda label: label.size < 11)  # letters of points first
    return sheet


def granted(drawn: Construction) -> list[complex]:
    """Places (m) on the sheet: the mechanism, and wishes that do not make it too small."""
    points = drawn.places()
    most = SMALLER * sheet_scale(points, PAD)[1]
    for wish in drawn.wishes:
        if sheet_scale([*points, *wish], PAD)[1] <= most * (1 + 1e-9):
            points += wish
    return points


def inside(places: Sequence[complex], low: complex, high: complex) -> list[list[complex]]:
    """The pieces of a polyline that lie in a field."""
    z = np.asarray(places, dtype=complex)
    with np.errstate(invalid="ignore"):
        within = (z.real >= low.real) & (z.real <= high.real) & (z.imag >= low.imag) & (z.imag <= high.imag)
    cuts = np.flatnonzero(within[1:] != within[:-1]) + 1
    parts = np.split(np.arange(len(z)), cuts)
    found = []
    for part in parts:
        if not len(part) or not within[part[0]]:
            continue
        piece = [complex(p) for p in z[part]]
        for at, outer, front in ((part[0], part[0] - 1, True), (part[-1], part[-1] + 1, False)):
            if 0 <= outer < len(z) and np.isfinite(z[outer]):
                edge = border(complex(z[at]), complex(z[outer]), low, high)
                piece = [edge, *piece] if front else [*piece, edge]
        found.append(piece)
    return found


def _curve(
    sheet: Sheet, whole: Sequence[Sequence[complex]], style: str, name: str = "", *, named: bool = False
) -> None:
    """Pieces of one curve, cut at the edge; its name stands where it is alone."""
    colour, width, line = STYLES[style]
    pieces = [piece for places in whole for piece in inside(places, *sheet.field)]
    pieces = [piece for piece in pieces if len(piece) > 1]
    for piece in pieces if not named else ():
        sheet.line(piece, colour, width, line, z=2.0 if style == "bold" else 1.2, blocks=False)
        sheet.ground.points.append(np.array(piece))
        for tip, before in ((piece[0], piece[1:]), (piece[-1], piece[-2::-1])):
            _goes_on(sheet, tip, before, colour)
    if name and named and pieces:
        places = [place for piece in pieces for place in _evenly(piece)]
        crowd = sheet.ground.crowd
        free = min(places, key=lambda z: (int(np.count_nonzero(np.abs(crowd - z) < QUIET)), -abs(z)))
        sheet.labels.append(Label(name, free, 10, NAMES, "italic", far=True))


def _goes_on(sheet: Sheet, tip: complex, before: Sequence[complex], colour: str) -> None:
    """A small arrow at the end of a line, places before it given, if the edge of the field cuts it there."""
    low, high = sheet.field
    if min(tip.real - low.real, high.real - tip.real, tip.imag - low.imag, high.imag - tip.imag) > ON_EDGE:
        return
    tail = next((z for z in before if abs(z - tip) > ARROW), None)
    if tail is not None:
        sheet.arrow(tip + ARROW * (tail - tip) / abs(tail - tip), tip, colour, 0.5, 2.1)


def _evenly(piece: Sequence[complex]) -> list[complex]:
    """Places along a line at even ways from each other."""
    z = np.array(piece)
    run = np.concatenate([[0], np.cumsum(np.abs(np.diff(z)))])
    return [complex(np.interp(share * run[-1], run, z)) for share in np.linspace(0.1, 0.9, 17)]


def _along(sheet: Sheet, arc: Arc) -> list[complex]:
    """Places of an arc (mm), close together also where its circle is huge: only what is near the sheet is taken."""
    centre, radius = sheet.on(arc.centre), arc.radius / sheet.mu
    middle, reach = (sheet.ground.low + sheet.ground.high) / 2, abs(sheet.ground.high - sheet.ground.low) / 2
    start, end = arc.start, arc.end
    if abs(middle - centre) > 1.01 * reach:  # the sheet is seen from the centre under a small angle
        half = float(np.arcsin(reach / abs(middle - centre)))
        towards = float(np.angle(middle - centre))
        towards += 2 * np.pi * np.round(((start + end) / 2 - towards) / (2 * np.pi))
        turns = [towards + 2 * np.pi * n for n in (-1, 0, 1)]
        windows = [(max(start, t - half), min(end, t + half)) for t in turns]
        start, end = max(windows, key=lambda window: window[1] - window[0])
    if not end > start:
        return []
    count = int(np.clip((end - start) * radius / FINE, 60, 4000))
    return [complex(centre + radius * z) for z in np.exp(1j * np.linspace(start, end, count))]


def _centre(sheet: Sheet, centre: Centre, units: UnitSystem) -> None:
    """The centre with lines to it; where it is off the sheet, arrows towards it with its distance."""
    at, (low, high) = sheet.on(centre.at), sheet.field
    legs = [sheet.on(leg) for leg in centre.legs]
    if inside([at], low, high):
        for leg in legs:
            sheet.line([leg, at], THIN, 0.7, "--", 1.5)
        sheet.circle(at, 0.6, face=DARK)
        sheet.ground.rivals.append(at)
        sheet.labels.append(Label(centre.name, at, 11, DARK, far=True))
        sheet.labels.append(Label("R", (legs[0] + at) / 2, 10, NAMES, "italic", (legs[0], at)))
        return
    text = _("to {centre}, {radius}").format(centre=centre.name, radius=_value("R", centre.radius, "length", units))
    inner = low + 3 * (1 + 1j), high - 3 * (1 + 1j)
    tips = [border(leg, at, *inner) for leg in legs]
    for leg, tip in zip(legs, tips, strict=True):
        sheet.line([leg, tip], THIN, 0.7, "--", 1.5)
        if abs(tip - leg) > 6:
            sheet.arrow(tip - 5 * (tip - leg) / abs(tip - leg), tip, DARK, 0.8)
    longest = max(zip(legs, tips, strict=True), key=lambda pair: abs(pair[1] - pair[0]))
    ahead = longest[0] + 0.55 * (longest[1] - longest[0]), longest[1]
    sheet.labels.append(Label(text, (ahead[0] + ahead[1]) / 2, 9, DARK, line=ahead))


def _spot(sheet: Sheet, spot: Spot) -> None:
    at = sheet.on(spot.at)
    if spot.mark in ("slider", "stone"):
        size = MEASURED.box if spot.mark == "slider" else MEASURED.stone
        box(sheet, at, spot.along / abs(spot.along), DARK, size, MEASURED)
    if spot.mark == "support":
        support(sheet, at, -1j)
    if spot.mark in ("hinge", "support", "slider", "stone"):
        sheet.circle(at, MEASURED.hinge)
    elif spot.mark == "dot":
        sheet.circle(at, 0.6, face=DARK)


def _guide(sheet: Sheet, start: complex, end: complex) -> None:
    """The guide of a slider: its axis, and a hatched rail under the boxes."""
    along = (end - start) / abs(end - start)
    sheet.line([start, end], *STYLES["axis"], z=1.5)
    down = -1j * along if (1j * along).imag >= 0 else 1j * along
    shift = (MEASURED.box[1] / 2 + 0.5) * down
    sheet.line([start + shift, end + shift], DARK, 1.0, z=2.5)
    hatch(sheet, start + shift, end + shift, down)


def _value(name: str, value: float, kind: str, units: UnitSystem, *, symbol: bool = True) -> str:
    """H = 120 mm; sizes on the drawing have no unit."""
    measure = KINDS[kind].dimension
    text = f"{units.from_si(value, measure):.4g}"
    text = f"{units.from_si(value, measure):.0f}" if "e+" in text else text
    unit = units.symbol(measure) if symbol else ""
    return f"{name} = {text} {unit}".rstrip()


def _notes(sheet: Sheet, drawn: Construction, letters: Mapping[str, str], units: UnitSystem) -> None:
    sheet.note(scale_text("l", sheet.mu, "m/mm"))
    values = [_value(*row, units) for row in drawn.values]
    for k in range(0, len(values), 3):
        sheet.note(", ".join(values[k : k + 3]))
    if drawn.sizes:
        sheet.note(_("sizes in {unit}").format(unit=units.symbol(KINDS["length"].dimension)))
    for key in drawn.notes:
        sheet.note(key.format(**letters))
