"""Sheet of the mechanism in all positions: trajectories, position numbers, extreme positions, stroke, lengths."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    GREY_TEXT,
    LOAD_COLOUR,
    Drawing,
    DrawingSheet,
    FigureExtent,
    NoteBlock,
    Ruler,
    RulerNumber,
    choose_scale,
    draw_angle,
    draw_dimension,
    draw_ruler,
    fit_ruler,
    gather_coincident as in_place,
    gather_numbers,
    least_crowded_ruler,
    ruler_reach,
    scale_words,
)
from tmm_cli.drawing.sheets.length_table import length_rows
from tmm_cli.drawing.sheets.mechanism import detailed_drawings, draw_measured, draw_paths, draw_skeleton, point_paths
from tmm_cli.drawing.symbols import MEASURED, MechanismScene, draw_driver_arrows, frame_pivots, points_to_scale
from tmm_cli.language import _, numeral
from tmm_cli.mechanics.analysis import Results, motion_at_positions
from tmm_cli.mechanics.forces import subscript
from tmm_cli.mechanics.groups import LinkStates
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import SAME_DRIVER_POSITION, Vector, unit
from tmm_cli.mechanics.plans import sheet_scale
from tmm_cli.mechanics.quantities import ANGLE, LENGTH


@dataclass(frozen=True)
class OutputExtreme:
    """An extreme position of the output link.

    Attributes:
        q: driver coordinate, rad or m.
        mark: number of the computed position that coincides with it; if there is none, a letter such as "k".
    """

    q: float
    mark: str


@dataclass(frozen=True)
class NumberedPath:
    """Path of a point, beside which position numbers are written.

    Attributes:
        kind: straight line, arc about a pivot, or any curve.
        link: link to which the point belongs.
        local: point in the axes of the link, m.
        line: direction of a straight path.
        pivot: centre of an arc, m.
    """

    kind: Literal["line", "arc", "any"]
    link: str
    local: complex
    line: complex = 1.0
    pivot: complex = 0j

    def places(self, states: LinkStates) -> Vector:
        """Return the positions of the point, (positions,), m."""
        return states.poses[self.link].at(self.local)


def output_extremes(results: Results) -> list[OutputExtreme]:
    """Return the extreme positions of the output link, at the ends of its strokes or of the requested range."""
    strokes, travels = results.strokes, results.travels
    if strokes is not None and strokes.strokes:
        cycle, ends = strokes.cycle, [stroke.start for stroke in strokes.strokes]
        last = strokes.strokes[-1]
        if len(ends) == 1:
            ends.append(last.start + results.linkage.driver.sense * last.length)
    elif travels and travels[0].high - travels[0].low > SAME_DRIVER_POSITION:
        cycle, ends = np.inf, [travels[0].low_at, travels[0].high_at]
    else:
        return []
    extremes: list[OutputExtreme] = []
    coordinates = results.asked[list(results.numbers)]
    for q in ends:
        off = np.abs(coordinates - q) if np.isinf(cycle) else np.abs((coordinates - q + cycle / 2) % cycle - cycle / 2)
        nearest = int(np.argmin(off))
        extremes.append(
            OutputExtreme(float(q), str(results.numbers[nearest]) if off[nearest] < SAME_DRIVER_POSITION else "")
        )
    between = [extreme for extreme in extremes if not extreme.mark]
    for number, extreme in enumerate(between, 1):
        mark = "k" + ("" if len(between) == 1 else "′" * (number - 1) if len(between) == 2 else subscript(str(number)))
        extremes[extremes.index(extreme)] = OutputExtreme(extreme.q, mark)
    return extremes


def output_travel(results: Results) -> float:
    """Return the stroke (m) or the swing angle (rad) of the main output; 0 if it has none."""
    strokes, travels = results.strokes, results.travels
    if strokes is not None and strokes.strokes:
        return strokes.travel
    return abs(travels[0].high - travels[0].low) if travels else 0.0


def output_path(results: Results) -> NumberedPath | None:
    """Return the path of the main output, or None if there is no output."""
    linkage, link = results.linkage, results.mechanism.output
    if link is None:
        return None
    point = linkage.output_point(link)
    if point is not None:
        return NumberedPath("any", linkage.owner(point), linkage.local(linkage.owner(point), point))
    slide = linkage.output_guide(link)
    if slide is None:
        return swinging_path(linkage, link)
    runs = linkage.slides_on_frame(link)
    if slide.runner == FRAME:  # a moving guide
        return NumberedPath("any", link, 0j)
    return NumberedPath("line" if runs else "any", link, slide.at, line=complex(unit(slide.direction)))


def swinging_path(linkage: Linkage, link: str) -> NumberedPath:
    """Return the path of the point of a link that is farthest from its fixed hinge.

    For a link without a fixed hinge it is the path of its first point.
    """
    points = linkage.links[link].points
    pivot = next((p for p in points if p in linkage.links[FRAME].points and linkage.hinged_to_frame(link)), None)
    if pivot is None or len(points) < 2:
        return NumberedPath("any", link, next(iter(points.values()), 0j))
    pivot_point = points[pivot]
    end = max(points.values(), key=lambda local: abs(local - pivot_point))
    return NumberedPath("arc", link, end, pivot=linkage.local(FRAME, pivot))


def driver_path(results: Results) -> NumberedPath | None:
    """Return the path of the crank pin or of the driving slider; None for a driving gear without a named point."""
    linkage, driver = results.linkage, results.linkage.driver
    if driver.kind == "turn":
        ends = [local for name, local in linkage.links[driver.link].points.items() if name != driver.joint]
        return NumberedPath("any", driver.link, ends[0]) if ends else None
    slide = linkage.slide(driver.joint)
    if driver.base == FRAME and slide.runner == driver.link:
        return NumberedPath("line", driver.link, slide.at, line=complex(unit(slide.direction)))
    return NumberedPath("any", driver.link, slide.at)


def extreme_states(results: Results, extremes: list[OutputExtreme]) -> LinkStates:
    """Return the positions of all links when the output link is in its extreme positions."""
    return motion_at_positions(results, np.array([extreme.q for extreme in extremes]), 0)


# The sheet of all positions: numbers at driver and output, extreme positions, stroke, a table of lengths.


MOST_SHOWN, MOST_NUMBERED = 48, 24  # positions drawn as thin lines, and positions with numbers
EXTRA_SCALES = (0.015, 0.075)  # m/mm: scales of GOST 2.302 in one decade only, 1:15 and 1:75
LARGEST_ANGLE = 0.95 * math.pi  # rad: a larger swing angle is not drawn, because the side of its arc would be ambiguous
STROKE_OFFSET = 13.0  # mm beside a ruler for the stroke
RULER_OVERHANG = 4.0  # mm for numbers at either end of the ruler
SHORT_STROKE = 30.0  # mm: the dimension text of a shorter stroke stands beside it
EXTREME_COLOUR = "#6a6a6a"
BOLD_WEIGHT = 4  # weight of lines drawn in full relative to thin ones
LINE_SHARES = np.linspace(0, 1, 30)  # sample points of a line
THIN_CLEARANCE, BOLD_CLEARANCE = 3.0, 8.0  # mm about thin lines and about the position drawn in full
PIVOT_CLEARANCE, GUIDE_CLEARANCE = 11.0, 13.0  # mm about fixed hinges and sliders
RIM_CLEARANCE = 10.0  # mm about a pitch circle, for a hatched rim


@dataclass(frozen=True)
class PositionMark:
    """Number or letter of a position beside a path.

    Attributes:
        place: point of the path, m.
        text: number or letter.
        end: True for an extreme position of the output.
        working: True in the working stroke.
    """

    place: complex
    text: str
    end: bool
    working: bool


@dataclass(frozen=True)
class PositionsView:
    """What the sheet of positions shows.

    Attributes:
        results: computed results.
        motion: motion in the computed positions.
        scene: position of the mechanism that is drawn with all symbols.
        ends: extreme positions of the output.
        states: positions of all links in the extreme positions; None if there are no extreme positions.
    """

    results: Results
    motion: Motion
    scene: MechanismScene
    ends: list[OutputExtreme]
    states: LinkStates | None

    def lines(self, k: int) -> Vector:
        """Return closely spaced points (m) along the links in the computed position k."""
        scene, points = replace(self.scene, k=k), []
        for link in self.results.linkage.moving:
            link_points = [scene.place(link, local) for local in self.results.linkage.links[link].points.values()]
            points += [place + (link_points[n - 1] - place) * LINE_SHARES for n, place in enumerate(link_points)]
        return np.concatenate(points)

    @property
    def shown(self) -> list[int]:
        """Indices of the computed positions that are drawn as thin lines."""
        step = max(1, len(self.results.numbers) // MOST_SHOWN)
        return [k for k in range(0, len(self.results.numbers), step) if self.motion.placed[k]]

    @property
    def numbered(self) -> list[int]:
        """Indices of the computed positions that are numbered on the sheet."""
        step = math.ceil(len(self.results.numbers) / MOST_NUMBERED)
        return [k for k in range(0, len(self.results.numbers), step) if self.motion.placed[k]]

    def marks(self, track: NumberedPath) -> list[PositionMark]:
        """Return the marks of the numbered positions and of the extreme positions along a path."""
        named, strokes, points = [end.mark for end in self.ends], self.results.strokes, track.places(self.motion)
        working = np.ones(len(points), bool)
        if strokes is not None and strokes.strokes:
            working = strokes.share(self.motion.q, self.results.linkage.driver.sense)
        marks = [
            PositionMark(complex(points[k]), text, text in named, bool(working[k]))
            for k in self.numbered
            for text in [str(self.results.numbers[k])]
        ]
        if self.states is not None:
            texts = [mark.text for mark in marks]
            ends = zip(track.places(self.states), named, strict=True)
            marks += [PositionMark(complex(place), mark, True, True) for place, mark in ends if mark not in texts]
        return marks


def draw_all_positions(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Yield the sheet of the mechanism in all positions, as (stem of the file name, drawing).

    One position is drawn with all symbols, the others as thin lines. Trajectories, position numbers, the stroke and a
    table of lengths are added.
    """
    motion, linkage = results.motion, results.linkage
    assert motion is not None
    chosen = detailed_drawings(results)
    k = chosen[0].k if chosen else int(np.argmax(motion.placed))
    ends = output_extremes(results)
    states = extreme_states(results, ends) if ends else None
    view = PositionsView(results, motion, MechanismScene(linkage, results.structure, motion.poses, k), ends, states)
    whole, track = point_paths(results), output_path(results)
    marks = view.marks(track) if track is not None else []
    ruled = track is not None and track.kind != "any" and bool(marks) and bool(ends)
    notes, rows = list(_position_notes(view, track, marks)), length_rows(results)
    figure = _figure_extent(view, whole)
    off = _reserve_ruler(figure, view, track, marks, whole) if track is not None and ruled else 0.0
    layout = choose_scale(
        figure, NoteBlock([(*scale_words("l", 0.0125, "m/mm"), ", 1:12.5"), *notes], rows), EXTRA_SCALES
    )
    caption = _("Mechanism in {count} positions, with the trajectories of its points").format(
        count=len(results.numbers)
    )
    sheet = DrawingSheet(results.problem.title, caption, room=layout)
    draw_paths(sheet, whole)
    for other in view.shown:
        if other != k:
            draw_skeleton(sheet, replace(view.scene, k=other))
    if states is not None:
        for other in range(len(ends)):
            draw_skeleton(sheet, replace(view.scene, poses=states.poses, k=other), EXTREME_COLOUR, 0.9, 1.1)
    if motion.placed[k]:
        draw_driver_arrows(
            sheet, view.scene, draw_measured(sheet, view.scene), MEASURED, dict.fromkeys(linkage.links, LOAD_COLOUR)
        )
    driver = driver_path(results)
    if driver is not None:
        _number_points(sheet, view.marks(driver))
    if track is not None and ruled:
        _draw_output_ruler(sheet, view, track, marks, off)
    elif track is not None and track != driver:
        _number_points(sheet, marks)
    sheet.note((*scale_words("l", sheet.mu, "m/mm"), f", {scale_ratio(sheet.mu)}"))
    for note in notes:
        sheet.note(note)
    sheet.table(rows, 1)
    yield "mechanism", sheet.finish()


def scale_ratio(mu: float) -> str:
    """Convert a scale factor (m/mm) to a ratio as text, e.g. 1:4."""
    return f"1:{numeral(1000 * mu, '.6g')}" if mu >= 1e-3 else f"{numeral(1e-3 / mu, '.6g')}:1"


def _figure_extent(view: PositionsView, whole: list[Vector]) -> FigureExtent:
    """Return the points that must be on the sheet of positions, except those of the ruler of the output."""
    figure, pivots = FigureExtent(), frame_pivots(view.results.linkage)
    used = [*pivots, *(place for path in whole for place in path.tolist())]
    figure.spots(pivots, PIVOT_CLEARANCE)
    figure.spots(used, THIN_CLEARANCE)
    figure.spots(points_to_scale(view.scene, used)[len(used) :], RIM_CLEARANCE)
    for k in view.shown:
        figure.spots(view.lines(k), BOLD_CLEARANCE if k == view.scene.k else THIN_CLEARANCE)
    sliding = [pair for pair in view.scene.structure.pairs if pair.slide is not None]
    figure.spots([view.scene.at(pair) for pair in sliding], GUIDE_CLEARANCE)
    crank = driver_path(view.results)
    if crank is not None:
        figure.spots([mark.place for mark in view.marks(crank)], BOLD_CLEARANCE)
    return figure


def _reserve_ruler(
    figure: FigureExtent, view: PositionsView, track: NumberedPath, marks: list[PositionMark], whole: list[Vector]
) -> float:
    """Add points to `figure` so that the ruler of the output and the dimension of its stroke fit on the sheet.

    Returns:
        Distance of the ruler from the path, mm. It is the same at any scale.
    """
    mu = sheet_scale([place for path in whole for place in path.tolist()])[1]
    plain, numbers = _ruler_numbers(track, marks, lambda place: place / mu)
    bold = [view.lines(view.scene.k)] * BOLD_WEIGHT
    lines = np.concatenate([*(view.lines(k) for k in view.shown), *bold]) / mu
    ruler = least_crowded_ruler(plain, numbers, lines)
    low, high = min(number.run for number in numbers), max(number.run for number in numbers)
    more = (
        RULER_OVERHANG if high - low > SHORT_STROKE else RULER_OVERHANG + SHORT_STROKE
    )  # room for the text beside a short stroke
    for run in np.linspace(low - more, high + more, len(LINE_SHARES)).tolist():
        path_point = ruler.path_point(min(max(run, low), high))
        for out in (0.0, ruler_reach(ruler, numbers), ruler_reach(ruler, numbers) + STROKE_OFFSET):
            figure.spots([path_point * mu], THIN_CLEARANCE, ruler.at(run, out) - path_point)
    return ruler.off


def _ruler_numbers(
    track: NumberedPath, marks: list[PositionMark], on: Callable[[complex], complex]
) -> tuple[Ruler, list[RulerNumber]]:
    """Return the ruler along the path of the output, and its numbers.

    Args:
        track: path of the output.
        marks: positions along the path.
        on: function that converts a point (m) to paper (mm).
    """
    pivot = on(track.pivot) if track.kind == "arc" else None
    plain = fit_ruler([on(mark.place) for mark in marks], track.line, pivot)
    numbers = gather_numbers([RulerNumber(float(plain.run(on(m.place))), m.text, m.working, m.end) for m in marks])
    return plain, numbers


def _draw_output_ruler(
    sheet: DrawingSheet, view: PositionsView, track: NumberedPath, marks: list[PositionMark], off: float
) -> None:
    """Draw the ruler of the output `off` mm from its path, with the dimension of the stroke or of the swing angle."""
    plain, numbers = _ruler_numbers(track, marks, sheet.on)
    ruler = replace(plain, off=off)
    draw_ruler(sheet, ruler, numbers)
    if view.states is None:
        return
    first, last = _farthest_ends(track.places(view.states))
    with sheet.on_layer("dimensions"):
        if track.kind == "line":
            ends = [ruler.at(float(ruler.run(sheet.on(place))), ruler_reach(ruler, numbers)) for place in (first, last)]
            draw_dimension(sheet, ends[0], ends[1], _travel_text(view))
        elif output_travel(view.results) < LARGEST_ANGLE:
            draw_angle(sheet, sheet.on(track.pivot), sheet.on(first), sheet.on(last), _travel_text(view), right=False)


def _travel_text(view: PositionsView) -> str:
    """Return the text of the stroke H or the swing angle ψ, e.g. "H = 120 mm"."""
    results, units = view.results, view.results.problem.units
    turns = results.mechanism.output is not None and results.linkage.output_swings(results.mechanism.output)
    measure, letter = (ANGLE, "ψ") if turns else (LENGTH, "H")
    return f"{letter} = {numeral(units.from_si(output_travel(results), measure), '.4g')} {units.spelt(measure)}"


def _farthest_ends(points: Vector) -> tuple[complex, complex]:
    """Return the two of several points that are farthest from each other."""
    pairs = [(p, q) for n, p in enumerate(points.tolist()) for q in points.tolist()[:n]]
    return max(pairs, key=lambda ends: abs(ends[0] - ends[1]))


def _number_points(sheet: DrawingSheet, marks: list[PositionMark]) -> None:
    """Write position numbers beside the points of a path, on its outer side."""
    finite = [mark for mark in marks if np.isfinite(mark.place)]
    if not finite:
        return
    middle = sheet.on(sum(mark.place for mark in finite) / len(finite))
    # in a cycle of several revolutions the crank passes its positions again
    for at, marks_there in in_place((sheet.on(mark.place), mark) for mark in finite):
        out = at - middle
        end = any(mark.end for mark in marks_there)
        sheet.circle(at, 0.7 if end else 0.5, DARK_COLOUR, DARK_COLOUR, 0.3, 5)
        text = ", ".join(mark.text for mark in marks_there)
        sheet.label(text, at + 1.5 * out / (abs(out) or 1.0), 9 if end else 8, DARK_COLOUR if end else GREY_TEXT)


def _position_notes(view: PositionsView, track: NumberedPath | None, marks: list[PositionMark]) -> Iterable[str]:
    """Yield notes on the position drawn with all symbols, on the extreme positions and on the position numbers.

    A further note gives the stroke if it is not drawn as a dimension.
    """
    yield _("position {number} is drawn in detail").format(number=view.results.numbers[view.scene.k])
    if view.ends:
        yield _("extreme positions of the output: {ends}").format(ends=", ".join(end.mark for end in view.ends))
        if track is not None and (
            track.kind == "any" or (track.kind == "arc" and output_travel(view.results) >= LARGEST_ANGLE)
        ):
            yield _travel_text(view)
        if track is not None and track.kind != "any" and not all(mark.working for mark in marks):
            yield _("outer numbers: positions of the working stroke")
