"""Drawings of a synthesis: geometric construction, diagrams, and the mechanism in its extreme positions."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import cycle

import numpy as np

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    INERTIA_COLOUR,
    LOAD_COLOUR,
    NAME_COLOUR,
    REACTION_COLOUR,
    THIN_COLOUR,
    ChartCurve,
    CommonAxis,
    Drawing,
    DrawingSheet,
    Label,
    PlotContent,
    Style,
    axis_extent,
    draw_angle,
    draw_chart,
    draw_dimension,
    filling_axis,
    finite_limits,
    leave_field,
    round_axis,
    scale_words,
    with_unit,
)
from tmm_cli.drawing.sheets.mechanism import draw_measured, draw_paths, draw_skeleton, point_paths
from tmm_cli.drawing.symbols import (
    GUIDE_EXTENSION,
    MEASURED,
    MechanismScene,
    Segment,
    cylinder_drivers,
    draw_box,
    draw_guide,
    draw_slider,
    draw_support,
    form_by_points,
    frame_pivots,
    points_to_scale,
    support_side,
)
from tmm_cli.language import _, numeral, translated
from tmm_cli.mechanics.analysis import Results, motion_at_positions
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.plans import LANDSCAPE, sheet_scale
from tmm_cli.mechanics.quantities import ANGLE, DIMENSIONS, Dimension
from tmm_cli.problem import UnitSystem
from tmm_cli.synthesis import (
    CHAIN_LETTERS,
    Arc,
    Chain,
    CircleCentre,
    Diagram,
    DiagramLine,
    DimensionLine,
    GeometricConstruction,
    LetteredPoint,
    SynthesisOutcome,
)

CENTRE_LETTERS = "MNKQSTUVWXYZ"  # letters of centres of circles
BAR_ENDS = {"l1": "AB", "l2": "BC", "l3": "DC", "l4": "AD"}
SAME_LENGTH = 1e-6  # relative difference of equal lengths


def use_problem_names(
    drawn: GeometricConstruction, linkage: Linkage | None, names: Mapping[str, str]
) -> tuple[GeometricConstruction, Mapping[str, str]]:
    """Rename the points and dimensions of a construction as in the problem file.

    Args:
        drawn: construction with standard letters.
        linkage: linkage whose joint names are used; None: standard letters.
        names: parameter names in the file, by standard name.

    Returns:
        The renamed construction, and the names of the points by their standard letters.
    """
    joint_names = {letter: letter for letter in CHAIN_LETTERS.get(drawn.chain, "")}
    if linkage is not None:
        joint_names |= match_joints(linkage, drawn.chain, drawn)
    taken = set(joint_names.values()) | {spot.name[:1] for spot in drawn.spots if spot.name[:1] not in joint_names}
    centre = next(letter for letter in CENTRE_LETTERS if letter not in taken)
    parameters = {name: file_name for name, file_name in names.items() if file_name != name}
    if set(parameters) & set(BAR_ENDS) and drawn.chain == "four-bar":  # name the other sizes in the same way
        parameters = {bar: "".join(joint_names[c] for c in ends) for bar, ends in BAR_ENDS.items()} | parameters

    def point(text: str) -> str:
        letter, number = text[:1], text[1:]
        joint_name = joint_names.get(letter, letter)
        return f"{joint_name}({number})" if number[:1].isdigit() and joint_name[-1:].isdigit() else joint_name + number

    def line(text: str) -> str:
        return re.sub(r"[A-Za-z]+\d*", lambda match: quantity(match[0]), text)

    def quantity(word: str) -> str:
        if word in parameters:
            return parameters[word]
        return "".join(joint_names[c] for c in word) if all(c in joint_names for c in word) else word

    named = replace(
        drawn,
        spots=tuple(replace(s, name=point(s.name)) for s in drawn.spots),
        segments=tuple(replace(s, name=line(s.name)) for s in drawn.segments),
        sizes=tuple(replace(s, name=line(s.name)) for s in drawn.sizes),
        centres=tuple(replace(c, name=centre) for c in drawn.centres),
        values=tuple((line(name), value, kind) for name, value, kind in drawn.values),
    )
    return named, {**joint_names, "M": centre}


def match_joints(linkage: Linkage, chain: Chain, drawn: GeometricConstruction) -> dict[str, str]:
    """Find the joint of a linkage for each standard letter of a construction, along the chain from the driver.

    Returns:
        Joint names by standard letter; empty if the linkage does not match the construction.
    """
    driver, letters = linkage.driver, CHAIN_LETTERS.get(chain, "")
    if not letters or driver.kind != "turn":
        return {}
    link, joints = driver.link, [driver.joint]
    for __ in linkage.links:
        if len(joints) == len(letters):
            break
        hinged = {h.point: h.links for h in linkage.hinges if link in h.links and h.point not in joints}
        ends = hinged or {p: (FRAME, link) for p in linkage.links[link].points if p not in joints}
        pivots = [p for p in hinged if FRAME in hinged[p]]
        candidates = pivots or list(ends)
        across = {s.carrier if s.runner == link else s.runner for s in linkage.slides if link in (s.carrier, s.runner)}
        if len(candidates) == 1:
            joints += candidates
            link = link if pivots else next((n for n in ends[candidates[0]] if n != link), FRAME)
        elif not candidates and len(across) == 1:  # a block: the chain continues with its lever
            (link,) = across
        else:
            return {}
    if len(joints) < len(letters):
        return {}
    at = {spot.name: spot.at for spot in drawn.spots}
    crank = linkage.links[driver.link].points
    crank_length, wished = abs(crank[joints[0]] - crank[joints[1]]), abs(at[f"{letters[1]}1"] - at[letters[0]])
    return dict(zip(letters, joints, strict=True)) if abs(crank_length - wished) <= SAME_LENGTH * wished else {}


# The sheet of a construction: the mechanism as large as possible, lines cut at the edge, dimensions, angles.


LINE_STYLES: Mapping[str, tuple[str, float, Style]] = {  # colour, width, line
    "link": (DARK_COLOUR, 2.2, "-"),
    "link2": (INERTIA_COLOUR, 2.2, "-"),
    "thin": (THIN_COLOUR, 0.8, "-"),
    "dashed": (THIN_COLOUR, 0.7, "--"),
    "axis": (THIN_COLOUR, 0.7, "-."),
    "bold": (LOAD_COLOUR, 1.5, "-"),
}
CONSTRUCTION_PAD = 27.0  # mm about the required points, for dimension lines and labels
MOST_REDUCTION = 1.6  # times: how far the mechanism may be reduced to show optional points
ARC_STEP = 1.0  # mm between points of an arc
NAME_CLEARANCE = 12.0  # mm about a point of a curve that should be free for its name
EDGE_TOLERANCE = 1e-6  # mm: tolerance for points on the edge of the field
CUT_ARROW = 4.0  # mm: length of the arrow on a line that continues beyond the edge
BOX_SIZES = {"slider": MEASURED.box, "stone": MEASURED.block}


def draw_construction(
    title: str,
    drawn: GeometricConstruction,
    units: UnitSystem,
    linkage: Linkage | None = None,
    names: Mapping[str, str] | None = None,
) -> DrawingSheet:
    """Draw a geometric construction with the names of the problem file.

    Args:
        title: title of the project.
        drawn: the construction.
        units: units of the file.
        linkage: linkage whose joint names are used; None: standard letters.
        names: parameter names in the file, by standard name.
    """
    drawn, letters = use_problem_names(drawn, linkage, names or {})
    sheet = DrawingSheet(title, translated(drawn.title).format(**letters), points_on_sheet(drawn), pad=CONSTRUCTION_PAD)
    sheet.canvas.rivals += [sheet.on(s.at) for s in drawn.spots if s.name]
    rods = [(sheet.on(s.start), sheet.on(s.end)) for s in drawn.segments if s.style.startswith("link")]
    for spot in drawn.spots:
        _draw_spot(sheet, spot, rods)
    lines: list[Label] = []
    for s in drawn.segments:
        start, end = sheet.on(s.start), sheet.on(s.end)
        sheet.line([start, end], *LINE_STYLES[s.style], z=3 if s.style.startswith("link") else 1.5)
        if s.name:
            lines.append(Label(s.name, (start + end) / 2, 10, NAME_COLOUR, "italic", (start, end)))
    for arc in drawn.arcs:
        _draw_curve(sheet, _arc_points(sheet, arc), arc.style)
    named: dict[str, list[Sequence[complex]]] = {}
    for curve in drawn.curves:
        pieces = _draw_curve(sheet, [sheet.on(p) for p in curve.places], curve.style)
        named.setdefault(curve.name, []).extend(pieces)
    for name, pieces in named.items():
        _label_curve(sheet, name, pieces)
    for centre in drawn.centres:
        _draw_centre(sheet, centre, units)
    for angle in drawn.angles:
        vertex, first, last = (sheet.on(p) for p in (angle.vertex, angle.first, angle.last))
        draw_angle(sheet, vertex, first, last, angle.name, right=angle.right)
    _write_notes(sheet, drawn, letters, units)
    sheet.draw_note_block()
    for dimension in drawn.sizes:
        _draw_size(sheet, dimension, units)
    for spot in drawn.spots:
        if spot.name:
            sheet.label(spot.name, sheet.on(spot.at), 11)
    sheet.labels += lines
    sheet.canvas.lines += [label.line for label in lines if label.line]
    sheet.labels.sort(key=lambda label: label.size < 11)  # letters of points first
    return sheet


def points_on_sheet(drawn: GeometricConstruction) -> list[complex]:
    """Return the points (m) that must be on the sheet.

    These are the points of the mechanism, and optional points unless they would reduce the scale too much.
    """
    points = drawn.places()
    most = MOST_REDUCTION * sheet_scale(points, CONSTRUCTION_PAD)[1]
    for wish in drawn.wishes:
        if sheet_scale([*points, *wish], CONSTRUCTION_PAD)[1] <= most * (1 + 1e-9):
            points += wish
    return points


def pieces_inside(points: Sequence[complex], low: complex, high: complex) -> list[list[complex]]:
    """Cut a polyline at the edges of a field and return the pieces inside.

    low, high: lower left and upper right corner of the field.
    """
    z = np.asarray(points, dtype=complex)
    within = (z.real >= low.real) & (z.real <= high.real) & (z.imag >= low.imag) & (z.imag <= high.imag)
    pieces = []
    for indices in np.split(np.arange(len(z)), np.flatnonzero(within[1:] != within[:-1]) + 1):
        if len(indices) and within[indices[0]]:
            first, last = indices[0], indices[-1]
            before = [leave_field(z[first], z[first - 1], low, high)] if first > 0 and np.isfinite(z[first - 1]) else []
            after = (
                [leave_field(z[last], z[last + 1], low, high)] if last + 1 < len(z) and np.isfinite(z[last + 1]) else []
            )
            pieces.append([complex(p) for p in (*before, *z[indices], *after)])
    return pieces


def _draw_curve(sheet: DrawingSheet, points: Sequence[complex], style: str) -> list[Sequence[complex]]:
    """Draw a curve and return its pieces inside the field. An arrow shows where it continues beyond the edge."""
    colour, width, line = LINE_STYLES[style]
    pieces: list[Sequence[complex]] = [piece for piece in pieces_inside(points, *sheet.field) if len(piece) > 1]
    low, high = sheet.field
    for piece in pieces:
        sheet.line(piece, colour, width, line, z=2.0 if style == "bold" else 1.2, blocks=False)
        sheet.canvas.path(piece)
        for from_end in (piece, piece[::-1]):
            tip = from_end[0]
            if (
                min(tip.real - low.real, high.real - tip.real, tip.imag - low.imag, high.imag - tip.imag)
                > EDGE_TOLERANCE
            ):
                continue
            tail = next((z for z in from_end if abs(z - tip) > CUT_ARROW), None)
            if tail is not None:
                sheet.arrow(tip + CUT_ARROW * (tail - tip) / abs(tail - tip), tip, colour, 0.5, 2.1)
    return pieces


def _label_curve(sheet: DrawingSheet, name: str, pieces: Sequence[Sequence[complex]]) -> None:
    """Label a curve with its name, where there is most space."""
    points: list[complex] = []
    for piece in pieces:
        run = np.concatenate([[0], np.cumsum(np.abs(np.diff(piece)))])
        points += [complex(np.interp(share * run[-1], run, piece)) for share in np.linspace(0.1, 0.9, 17)]
    if name and points:
        crowd = sheet.canvas.line_points
        free = min(points, key=lambda z: (int(np.count_nonzero(np.abs(crowd - z) < NAME_CLEARANCE)), -abs(z)))
        sheet.label(name, free, 10, NAME_COLOUR, "italic")


def _arc_points(sheet: DrawingSheet, arc: Arc) -> list[complex]:
    """Return closely spaced points (mm) of an arc. Of a very large circle only the part near the sheet is used."""
    centre, radius = sheet.on(arc.centre), arc.radius / sheet.mu
    middle, reach = (sheet.canvas.low + sheet.canvas.high) / 2, abs(sheet.canvas.high - sheet.canvas.low) / 2
    start, end = arc.start, arc.end
    if abs(middle - centre) > 1.01 * reach:  # the sheet subtends a small angle at the centre
        half = float(np.arcsin(reach / abs(middle - centre)))
        towards = float(np.angle(middle - centre))
        towards += 2 * np.pi * np.round(((start + end) / 2 - towards) / (2 * np.pi))
        turns = [towards + 2 * np.pi * n for n in (-1, 0, 1)]
        windows = [(max(start, t - half), min(end, t + half)) for t in turns]
        start, end = max(windows, key=lambda window: window[1] - window[0])
    if not end > start:
        return []
    count = int(np.clip((end - start) * radius / ARC_STEP, 60, 4000))
    return [complex(centre + radius * z) for z in np.exp(1j * np.linspace(start, end, count))]


def _draw_centre(sheet: DrawingSheet, centre: CircleCentre, units: UnitSystem) -> None:
    """Draw the centre of a circle and the radii to it. If it is off the sheet, arrows show its direction."""
    at, (low, high) = sheet.on(centre.at), sheet.field
    legs = [sheet.on(leg) for leg in centre.legs]
    if pieces_inside([at], low, high):
        for leg in legs:
            sheet.line([leg, at], THIN_COLOUR, 0.7, "--", 1.5)
        sheet.circle(at, 0.6, face=DARK_COLOUR)
        sheet.canvas.rivals.append(at)
        sheet.label(centre.name, at, 11)
        sheet.labels.append(Label("R", (legs[0] + at) / 2, 10, NAME_COLOUR, "italic", (legs[0], at)))
        return
    text = _("to {centre}, {radius}").format(
        centre=centre.name, radius=_equation_text("R", centre.radius, "length", units)
    )
    tips = [leave_field(leg, at, low + 3 * (1 + 1j), high - 3 * (1 + 1j)) for leg in legs]
    for leg, tip in zip(legs, tips, strict=True):
        sheet.line([leg, tip], THIN_COLOUR, 0.7, "--", 1.5)
        if abs(tip - leg) > 6:
            sheet.arrow(tip - 5 * (tip - leg) / abs(tip - leg), tip, DARK_COLOUR, 0.8)
    leg, tip = max(zip(legs, tips, strict=True), key=lambda pair: abs(pair[1] - pair[0]))
    ahead = leg + 0.55 * (tip - leg), tip
    sheet.labels.append(Label(text, (ahead[0] + ahead[1]) / 2, 9, DARK_COLOUR, line=ahead))


def _draw_spot(sheet: DrawingSheet, spot: LetteredPoint, rods: Sequence[Segment]) -> None:
    at = sheet.on(spot.at)
    if spot.mark in BOX_SIZES:
        along = spot.along / abs(spot.along)
        draw_box(sheet, at, along, DARK_COLOUR, BOX_SIZES[spot.mark], MEASURED)
        if spot.mark == "slider":
            draw_guide(sheet, at, along, MEASURED, MEASURED.box[0] / 2 + GUIDE_EXTENSION, rods)
    if spot.mark == "support":
        draw_support(sheet, at, support_side(sheet, at, rods), rods=rods)
    if spot.mark == "dot":
        sheet.circle(at, 0.6, face=DARK_COLOUR)
    elif spot.mark != "none":
        sheet.circle(at, MEASURED.hinge)


def _draw_size(sheet: DrawingSheet, dimension: DimensionLine, units: UnitSystem) -> None:
    """Draw a dimension line with the name and the value of the dimension, without its unit."""
    span = dimension.end - dimension.start
    length = abs(span) if dimension.along == 0 else abs((span * np.conj(dimension.along / abs(dimension.along))).real)
    text = _equation_text(dimension.name, length, "length", units, symbol=False)
    draw_dimension(sheet, sheet.on(dimension.start), sheet.on(dimension.end), text, dimension.along)


def _equation_text(name: str, value: float, kind: str, units: UnitSystem, *, symbol: bool = True) -> str:
    """Return the text of an equation, e.g. "H = 120 mm"."""
    measure = DIMENSIONS[kind].dimension
    number = float(units.from_si(value, measure))
    text = numeral(number, ".0f" if "e+" in f"{number:.4g}" else ".4g")
    unit = units.spelt(measure) if symbol else ""
    return f"{name} = {text} {unit}".rstrip()


def _write_notes(
    sheet: DrawingSheet, drawn: GeometricConstruction, letters: Mapping[str, str], units: UnitSystem
) -> None:
    sheet.note(scale_words("l", sheet.mu, "m/mm"))
    values = [_equation_text(*row, units) for row in drawn.values]
    for k in range(0, len(values), 3):
        sheet.note(", ".join(values[k : k + 3]))
    if drawn.sizes:
        sheet.note(_("dimensions in {unit}").format(unit=units.spelt(DIMENSIONS["length"].dimension)))
    for key in drawn.notes:
        sheet.note(translated(key).format(**letters))


STROKE_MARKS = ("ᴵ", "ᴵᴵ", "ᴵᴵᴵ", "ᴵⱽ")  # marks of successive strokes


def draw_synthesis(
    title: str,
    outcome: SynthesisOutcome,
    results: Results | None,
    units: UnitSystem,
    names: Mapping[str, str] | None = None,
) -> Iterable[tuple[str, Drawing]]:
    """Yield the drawings of a synthesis, as (stem of the file name, drawing).

    If the mechanism has strokes, the last drawing shows it in its extreme positions.

    Args:
        title: title of the project.
        outcome: results of the synthesis.
        results: results of the mechanism that the synthesis found; None if it was not computed.
        units: units of the file.
        names: parameter names in the file, by standard name.
    """
    linkage = results.linkage if results is not None else None
    for drawn in outcome.drawings:
        if isinstance(drawn, Diagram):
            yield f"synthesis-{drawn.name}", synthesis_diagram(title, drawn, units)
        else:
            yield f"synthesis-{drawn.name}", draw_construction(title, drawn, units, linkage, names).finish()
    if results is not None and results.strokes is not None and results.strokes.strokes:
        yield "synthesis-extremes", extreme_positions_sheet(results).finish()


def draw_problem_synthesis(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Yield the drawings of the synthesis in a problem file; nothing if there is none."""
    synthesis = results.problem.synthesis
    if synthesis is not None:
        yield from draw_synthesis(
            results.problem.title, synthesis.outcome, results, results.problem.units, synthesis.names
        )


def synthesis_diagram(title: str, drawn: Diagram, units: UnitSystem) -> Drawing:
    """Draw a diagram of a synthesis, in the units of the file."""
    sheet = DrawingSheet(title, translated(drawn.title), paper=LANDSCAPE)
    words, kind = drawn.x
    wide = DIMENSIONS[kind].dimension
    over = finite_limits(
        [np.asarray(line.x, dtype=float) / units.factor(wide) for line in (*drawn.lines, *drawn.lower)]
    )
    degrees = wide == ANGLE and units.symbol(ANGLE) == "deg"
    start, most = axis_extent(sheet)
    axis = filling_axis(*over, start, most) if drawn.equal else round_axis(*over, start, most, degrees=degrees)
    plots = [_diagram_plot(drawn.lines, drawn.y, wide, units)]
    if drawn.lower:
        plots.append(replace(_diagram_plot(drawn.lower, drawn.lower_y, wide, units), logarithmic=True, share=0.6))
    draw_chart(sheet, plots, CommonAxis(axis, with_unit(translated(words), wide, units)), same_scale=drawn.equal)
    return sheet.finish()


def _diagram_plot(lines: Iterable[DiagramLine], y: tuple[str, str], wide: Dimension, units: UnitSystem) -> PlotContent:
    words, kind = y
    high = DIMENSIONS[kind].dimension
    colours = cycle((DARK_COLOUR, LOAD_COLOUR, INERTIA_COLOUR, REACTION_COLOUR))
    curves = [
        ChartCurve(
            np.asarray(line.x, dtype=float) / units.factor(wide),
            np.asarray(line.y, dtype=float) / units.factor(high),
            translated(line.text),
            THIN_COLOUR if line.faint else next(colours),
            width=1.0 if line.faint else 1.3,
            dots=line.dots,
        )
        for line in sorted(lines, key=lambda line: not line.faint)
    ]
    return PlotContent(with_unit(translated(words), high, units), curves)


def extreme_positions_sheet(results: Results) -> DrawingSheet:
    """Draw the mechanism at the start of its working stroke and, in blue, at its end, with the trajectories."""
    strokes, linkage = results.strokes, results.linkage
    assert strokes is not None
    ends = [stroke.start for stroke in strokes.strokes]
    if len(ends) == 1:
        ends.append(ends[0] + linkage.driver.sense * strokes.strokes[0].length)
    motion = motion_at_positions(results, np.array(ends), 2)
    scene = MechanismScene(linkage, results.structure, motion.poses)
    all_paths = point_paths(results)
    used = [*frame_pivots(linkage), *(place for path in all_paths for place in path)]
    sheet = DrawingSheet(results.problem.title, _("Extreme positions of the output"), points_to_scale(scene, used))
    draw_paths(sheet, all_paths)
    others = [replace(scene, k=k) for k in range(1, len(ends))]
    for other in others:
        draw_skeleton(sheet, other, INERTIA_COLOUR, 1.6, 2.9)
        for link in linkage.moving:
            for start, end in form_by_points(sheet, other, link, whole=False).edges:
                sheet.canvas.line(start, end)
        for pair in results.structure.pairs:
            if pair.slide is not None and pair.name not in cylinder_drivers(linkage):
                draw_slider(sheet, other, pair, MEASURED, INERTIA_COLOUR)
    draw_measured(sheet, scene, STROKE_MARKS[0])
    points = linkage.moving_points
    sheet.canvas.rivals += [
        sheet.on(extreme_scene.point(name)) for extreme_scene in (scene, *others) for name in points
    ]
    for other in others:
        for name in points:
            at = sheet.on(other.point(name))
            if any(name in h.point for h in linkage.hinges):
                sheet.circle(at, 0.8 * MEASURED.hinge, edge=INERTIA_COLOUR)
            else:
                sheet.circle(at, 0.6, INERTIA_COLOUR, INERTIA_COLOUR)
            sheet.label(name + STROKE_MARKS[min(other.k, 3)], at, 10, INERTIA_COLOUR)
    sheet.note(scale_words("l", sheet.mu, "m/mm"))
    sheet.note(_("I: start of the working stroke, II: its end"))
    return sheet
