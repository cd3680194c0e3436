"""Letters of a construction: joints as the user's linkage calls them, parameters as the file does."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from tmm_cli.drawing.paper import (
    DARK,
    INERTIA,
    LOAD,
    NAMES,
    THIN,
    Label,
    Sheet,
    Style,
    angle_mark,
    border,
    dimension,
    scale_words,
)
from tmm_cli.drawing.symbols import BEYOND, MEASURED, Line, box, guide, support, support_side
from tmm_cli.language import _, numeral, translated
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.plans import sheet_scale
from tmm_cli.mechanics.quantities import KINDS
from tmm_cli.problem import UnitSystem
from tmm_cli.synthesis import (
    CHAIN_LETTERS,
    Arc,
    Chain,
    CircleCentre,
    DimensionLine,
    GeometricConstruction,
    LetteredPoint,
)

FREE = "MNKQSTUVWXYZ"  # letters of centres of circles
BARS = {"l1": "AB", "l2": "BC", "l3": "DC", "l4": "AD"}
NEAR = 1e-6  # relative: a link as long as that of the construction


def rename(
    drawn: GeometricConstruction, linkage: Linkage | None, names: Mapping[str, str]
) -> tuple[GeometricConstruction, Mapping[str, str]]:
    """The construction in the user's letters, and these letters by those of its words."""
    own = {letter: letter for letter in CHAIN_LETTERS.get(drawn.chain, "")}
    if linkage is not None:
        own |= joints(linkage, drawn.chain, drawn)
    taken = set(own.values()) | {spot.name[:1] for spot in drawn.spots if spot.name[:1] not in own}
    centre = next(letter for letter in FREE if letter not in taken)
    parameters = {name: shown for name, shown in names.items() if shown != name}
    if set(parameters) & set(BARS) and drawn.chain == "four-bar":  # the others are called likewise
        parameters = {bar: "".join(own[c] for c in ends) for bar, ends in BARS.items()} | parameters

    def point(text: str) -> str:
        letter, number = text[:1], text[1:]
        shown = own.get(letter, letter)
        return f"{shown}({number})" if number[:1].isdigit() and shown[-1:].isdigit() else shown + number

    def line(text: str) -> str:
        return re.sub(r"[A-Za-z]+\d*", lambda found: quantity(found[0]), text)

    def quantity(word: str) -> str:
        if word in parameters:
            return parameters[word]
        return "".join(own[c] for c in word) if all(c in own for c in word) else word

    named = replace(
        drawn,
        spots=tuple(replace(s, name=point(s.name)) for s in drawn.spots),
        segments=tuple(replace(s, name=line(s.name)) for s in drawn.segments),
        sizes=tuple(replace(s, name=line(s.name)) for s in drawn.sizes),
        centres=tuple(replace(c, name=centre) for c in drawn.centres),
        values=tuple((line(name), value, kind) for name, value, kind in drawn.values),
    )
    return named, {**own, "M": centre}


def joints(linkage: Linkage, chain: Chain, drawn: GeometricConstruction) -> dict[str, str]:
    """Names of joints along the chain from the driver; none where the linkage is another one, or drives elsewhere."""
    driver, letters = linkage.driver, CHAIN_LETTERS.get(chain, "")
    if not letters or driver.kind != "turn":
        return {}
    link, found = driver.link, [driver.joint]
    for __ in linkage.links:
        if len(found) == len(letters):
            break
        hinged = {h.point: h.links for h in linkage.hinges if link in h.links and h.point not in found}
        ends = hinged or {p: (FRAME, link) for p in linkage.links[link].points if p not in found}
        pivots = [p for p in hinged if FRAME in hinged[p]]
        wanted = pivots or list(ends)
        across = {s.carrier if s.runner == link else s.runner for s in linkage.slides if link in (s.carrier, s.runner)}
        if len(wanted) == 1:
            found += wanted
            link = link if pivots else next((n for n in ends[wanted[0]] if n != link), FRAME)
        elif not wanted and len(across) == 1:  # a stone: the chain goes on along its lever
            (link,) = across
        else:
            return {}
    if len(found) < len(letters):
        return {}
    at = {spot.name: spot.at for spot in drawn.spots}
    crank = linkage.links[driver.link].points
    own, wished = abs(crank[found[0]] - crank[found[1]]), abs(at[f"{letters[1]}1"] - at[letters[0]])
    return dict(zip(letters, found, strict=True)) if abs(own - wished) <= NEAR * wished else {}


# A construction on its sheet: the mechanism as large as can be, what is beyond the edge cut there, sizes, angles.


STYLES: Mapping[str, tuple[str, float, Style]] = {  # colour, width, line
    "link": (DARK, 2.2, "-"),
    "link2": (INERTIA, 2.2, "-"),
    "thin": (THIN, 0.8, "-"),
    "dashed": (THIN, 0.7, "--"),
    "axis": (THIN, 0.7, "-."),
    "bold": (LOAD, 1.5, "-"),
}
PAD = 27.0  # mm about what must be on the sheet, for dimension lines and labels
SMALLER = 1.6  # so many times smaller the mechanism may become for what else is wished on the sheet
FINE = 1.0  # mm between places along an arc
QUIET = 12.0  # mm about a place on a curve that should be free for its name
ON_EDGE = 1e-6  # mm from the edge of the field: a line is cut there
ARROW = 4.0  # mm long: the mark of a line that goes on beyond the edge
BOXES = {"slider": MEASURED.box, "stone": MEASURED.stone}


def draw_construction(
    title: str,
    drawn: GeometricConstruction,
    units: UnitSystem,
    linkage: Linkage | None = None,
    names: Mapping[str, str] | None = None,
) -> Sheet:
    """One sheet; joints are called as in the linkage, parameters by their names in the file."""
    drawn, letters = rename(drawn, linkage, names or {})
    sheet = Sheet(title, translated(drawn.title).format(**letters), granted(drawn), pad=PAD)
    sheet.ground.rivals += [sheet.on(s.at) for s in drawn.spots if s.name]
    rods = [(sheet.on(s.start), sheet.on(s.end)) for s in drawn.segments if s.style.startswith("link")]
    for spot in drawn.spots:
        _spot(sheet, spot, rods)
    lines: list[Label] = []
    for s in drawn.segments:
        start, end = sheet.on(s.start), sheet.on(s.end)
        sheet.line([start, end], *STYLES[s.style], z=3 if s.style.startswith("link") else 1.5)
        if s.name:
            lines.append(Label(s.name, (start + end) / 2, 10, NAMES, "italic", (start, end)))
    for arc in drawn.arcs:
        _curve(sheet, _along(sheet, arc), arc.style)
    named: dict[str, list[Sequence[complex]]] = {}
    for curve in drawn.curves:
        pieces = _curve(sheet, [sheet.on(p) for p in curve.places], curve.style)
        named.setdefault(curve.name, []).extend(pieces)
    for name, pieces in named.items():
        _named(sheet, name, pieces)
    for centre in drawn.centres:
        _centre(sheet, centre, units)
    for angle in drawn.angles:
        vertex, first, last = (sheet.on(p) for p in (angle.vertex, angle.first, angle.last))
        angle_mark(sheet, vertex, first, last, angle.name, right=angle.right)
    _notes(sheet, drawn, letters, units)
    sheet.corner()
    for size in drawn.sizes:
        _size(sheet, size, units)
    for spot in drawn.spots:
        if spot.name:
            sheet.label(spot.name, sheet.on(spot.at), 11)
    sheet.labels += lines
    sheet.ground.lines += [label.line for label in lines if label.line]
    sheet.labels.sort(key=lambda label: label.size < 11)  # letters of points first
    return sheet


def granted(drawn: GeometricConstruction) -> list[complex]:
    """Places (m) on the sheet: the mechanism, and wishes that do not make it too small."""
    points = drawn.places()
    most = SMALLER * sheet_scale(points, PAD)[1]
    for wish in drawn.wishes:
        if sheet_scale([*points, *wish], PAD)[1] <= most * (1 + 1e-9):
            points += wish
    return points


def inside(places: Sequence[complex], low: complex, high: complex) -> list[list[complex]]:
    """The pieces of a polyline that lie in a field, from edge to edge where they leave it."""
    z = np.asarray(places, dtype=complex)
    within = (z.real >= low.real) & (z.real <= high.real) & (z.imag >= low.imag) & (z.imag <= high.imag)
    found = []
    for part in np.split(np.arange(len(z)), np.flatnonzero(within[1:] != within[:-1]) + 1):
        if len(part) and within[part[0]]:
            first, last = part[0], part[-1]
            before = [border(z[first], z[first - 1], low, high)] if first > 0 and np.isfinite(z[first - 1]) else []
            after = [border(z[last], z[last + 1], low, high)] if last + 1 < len(z) and np.isfinite(z[last + 1]) else []
            found.append([complex(p) for p in (*before, *z[part], *after)])
    return found


def _curve(sheet: Sheet, places: Sequence[complex], style: str) -> list[Sequence[complex]]:
    """A curve, cut at the edge with arrows where it goes on beyond it; the pieces that are drawn."""
    colour, width, line = STYLES[style]
    pieces: list[Sequence[complex]] = [piece for piece in inside(places, *sheet.field) if len(piece) > 1]
    low, high = sheet.field
    for piece in pieces:
        sheet.line(piece, colour, width, line, z=2.0 if style == "bold" else 1.2, blocks=False)
        sheet.ground.path(piece)
        for way in (piece, piece[::-1]):
            tip = way[0]
            if min(tip.real - low.real, high.real - tip.real, tip.imag - low.imag, high.imag - tip.imag) > ON_EDGE:
                continue
            tail = next((z for z in way if abs(z - tip) > ARROW), None)
            if tail is not None:
                sheet.arrow(tip + ARROW * (tail - tip) / abs(tail - tip), tip, colour, 0.5, 2.1)
    return pieces


def _named(sheet: Sheet, name: str, pieces: Sequence[Sequence[complex]]) -> None:
    """The name of a curve where it is alone, written once."""
    places: list[complex] = []
    for piece in pieces:
        run = np.concatenate([[0], np.cumsum(np.abs(np.diff(piece)))])
        places += [complex(np.interp(share * run[-1], run, piece)) for share in np.linspace(0.1, 0.9, 17)]
    if name and places:
        crowd = sheet.ground.crowd
        free = min(places, key=lambda z: (int(np.count_nonzero(np.abs(crowd - z) < QUIET)), -abs(z)))
        sheet.label(name, free, 10, NAMES, "italic")


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


def _centre(sheet: Sheet, centre: CircleCentre, units: UnitSystem) -> None:
    """The centre with lines to it; where it is off the sheet, arrows towards it with its distance."""
    at, (low, high) = sheet.on(centre.at), sheet.field
    legs = [sheet.on(leg) for leg in centre.legs]
    if inside([at], low, high):
        for leg in legs:
            sheet.line([leg, at], THIN, 0.7, "--", 1.5)
        sheet.circle(at, 0.6, face=DARK)
        sheet.ground.rivals.append(at)
        sheet.label(centre.name, at, 11)
        sheet.labels.append(Label("R", (legs[0] + at) / 2, 10, NAMES, "italic", (legs[0], at)))
        return
    text = _("to {centre}, {radius}").format(centre=centre.name, radius=_value("R", centre.radius, "length", units))
    tips = [border(leg, at, low + 3 * (1 + 1j), high - 3 * (1 + 1j)) for leg in legs]
    for leg, tip in zip(legs, tips, strict=True):
        sheet.line([leg, tip], THIN, 0.7, "--", 1.5)
        if abs(tip - leg) > 6:
            sheet.arrow(tip - 5 * (tip - leg) / abs(tip - leg), tip, DARK, 0.8)
    leg, tip = max(zip(legs, tips, strict=True), key=lambda pair: abs(pair[1] - pair[0]))
    ahead = leg + 0.55 * (tip - leg), tip
    sheet.labels.append(Label(text, (ahead[0] + ahead[1]) / 2, 9, DARK, line=ahead))


def _spot(sheet: Sheet, spot: LetteredPoint, rods: Sequence[Line]) -> None:
    at = sheet.on(spot.at)
    if spot.mark in BOXES:
        along = spot.along / abs(spot.along)
        box(sheet, at, along, DARK, BOXES[spot.mark], MEASURED)
        if spot.mark == "slider":
            guide(sheet, at, along, MEASURED, MEASURED.box[0] / 2 + BEYOND, rods)
    if spot.mark == "support":
        support(sheet, at, support_side(sheet, at, rods), rods=rods)
    if spot.mark == "dot":
        sheet.circle(at, 0.6, face=DARK)
    elif spot.mark != "none":
        sheet.circle(at, MEASURED.hinge)


def _size(sheet: Sheet, size: DimensionLine, units: UnitSystem) -> None:
    """A dimension line; its value has no unit."""
    way = size.end - size.start
    length = abs(way) if size.along == 0 else abs((way * np.conj(size.along / abs(size.along))).real)
    text = _value(size.name, length, "length", units, symbol=False)
    dimension(sheet, sheet.on(size.start), sheet.on(size.end), text, size.along)


def _value(name: str, value: float, kind: str, units: UnitSystem, *, symbol: bool = True) -> str:
    """H = 120 mm."""
    measure = KINDS[kind].dimension
    number = float(units.from_si(value, measure))
    text = numeral(number, ".0f" if "e+" in f"{number:.4g}" else ".4g")
    unit = units.spelt(measure) if symbol else ""
    return f"{name} = {text} {unit}".rstrip()


def _notes(sheet: Sheet, drawn: GeometricConstruction, letters: Mapping[str, str], units: UnitSystem) -> None:
    sheet.note(scale_words("l", sheet.mu, "m/mm"))
    values = [_value(*row, units) for row in drawn.values]
    for k in range(0, len(values), 3):
        sheet.note(", ".join(values[k : k + 3]))
    if drawn.sizes:
        sheet.note(_("sizes in {unit}").format(unit=units.spelt(KINDS["length"].dimension)))
    for key in drawn.notes:
        sheet.note(translated(key).format(**letters))
