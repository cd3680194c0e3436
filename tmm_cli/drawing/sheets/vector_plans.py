"""Force, velocity and acceleration plans to scale, each with a table of its vectors."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    NOTE_SIZE,
    POINT,
    THIN_COLOUR,
    VECTOR_COLOURS,
    Drawing,
    DrawingSheet,
    FigureExtent,
    NoteBlock,
    TableRow,
    Words,
    choose_scale,
    distance_to_segment,
    file_safe_name,
    gather_coincident,
    scale_words,
    wrap_symbols,
    writes_equations,
)
from tmm_cli.drawing.sheets.mechanism import Position
from tmm_cli.drawing.sheets.moment_equations import draw_plan_points, format_figures
from tmm_cli.language import _, numeral, spelt
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.numerics import NO_FORCE, cross, dot
from tmm_cli.mechanics.plans import (
    ACCELERATION_POLE,
    ForcePlan,
    NamedVector,
    Plan,
    acceleration_plan,
    angular_values,
    extent,
    force_plans,
    plan_readings,
    velocity_plan,
    with_subscripts,
)

PLAN_MARGIN = 9.0  # mm about the lines of a plan, for letters
LANE_WIDTH = 5.0  # mm between vectors that would coincide
LEAST_NAMED = 4.0  # mm: a shorter vector is named only in the table
EQUATION_WIDTH = 120.0  # mm: longest line of an equation
OVERLAP_WITHIN = 0.01  # of the plan: closer lines coincide
LEAST_DIFFERENCE = 0.03  # of the plan: vectors that differ by less are drawn once


def draw_force_plans(position: Position) -> Iterable[tuple[str, Drawing]]:
    """Yield the force plan of each group and of the driving link, as (stem of the file name, drawing)."""
    if position.results.reactions is None:
        return
    for plan in force_plans(position.results.reactions, position.k, position.motion):
        title = _("Force plan of link {links}. {caption}")
        if plan.driving:
            title = _("Force plan of the input link {links}. {caption}")
        elif len(plan.links) > 1:
            title = _("Force plan of links {links}. {caption}")
        kind = "links" if len(plan.links) > 1 else "link"
        yield (
            file_safe_name("-".join([position.stem("forces"), kind, *plan.links])),
            _force_plan_sheet(position, plan, title).finish(),
        )


def _force_plan_sheet(position: Position, plan: ForcePlan, title: str) -> DrawingSheet:
    drawn = [*plan.plan.drawn(), *distinct_reactions(plan)]
    aside = lane_offsets(drawn, plan.plan.size)
    figure_extent = FigureExtent()
    figure_extent.spots([0j], PLAN_MARGIN)
    for vector, off in zip(drawn, aside, strict=True):
        figure_extent.line(vector.start, vector.end, PLAN_MARGIN, off)
    equation = list(wrap_symbols(_force_sum(plan), NOTE_SIZE * POINT, EQUATION_WIDTH)) if writes_equations() else []
    # the width of the table hardly depends on the scale
    notes = [*equation, "μ = 0.0000 N/mm"]
    layout = choose_scale(figure_extent, NoteBlock(notes, force_plan_rows(plan, plan.plan.size / 100 or 1.0), 3))
    sheet = position.sheet(title, room=layout, links=", ".join(plan.links))
    _join_corners(sheet, drawn, aside)
    for vector, off in zip(drawn, aside, strict=True):
        _draw_force(sheet, vector, off, full=vector in plan.full)
    for line in equation:
        sheet.note(line)
    sheet.note(scale_words("F", sheet.mu, "N/mm"))
    sheet.table(force_plan_rows(plan, sheet.mu), 3)
    return sheet


def _force_sum(plan: ForcePlan) -> Words:
    """Return the text of the vector equation by which the sum of all forces is zero."""
    symbols = [v.symbol for v in plan.plan.vectors if v.kind != "inner"]
    return (*(piece for symbol in symbols[:-1] for piece in (symbol, " + ")), *symbols[-1:], " = 0")


def distinct_reactions(plan: ForcePlan) -> list[NamedVector]:
    """Return the total reactions that differ visibly from each of their components, and are therefore drawn."""
    least = LEAST_DIFFERENCE * plan.plan.size
    return [
        full
        for full in plan.full
        if abs(full.value) > least and all(abs(full.value - v.value) > least for v in plan.plan.vectors)
    ]


def force_plan_rows(plan: ForcePlan, mu: float) -> list[TableRow]:
    """Return the rows of the table of a force plan: magnitude, length on paper and direction of each force.

    Total reactions come last. mu: scale of the plan, N per mm.
    """
    rows = [TableRow((_("vector"), spelt("N"), spelt("mm"), _("angle")), head=True)]
    least = NO_FORCE * plan.plan.size
    for vector in (*plan.plan.vectors, *plan.full):
        magnitude = abs(vector.value) if abs(vector.value) > least else 0.0
        angle = f"{numeral(round(float(np.degrees(np.angle(vector.value))), 1) % 360, '.1f')}°" if magnitude else ""
        rows.append(TableRow((vector.symbol, format_figures(magnitude), numeral(magnitude / mu, ".1f"), angle)))
    return rows


def lane_offsets(vectors: Sequence[NamedVector], size: float) -> list[complex]:
    """Return the sideways offset (mm) of each vector of a force polygon, so that no vector is drawn on top of another.

    The longest vectors stay in place; the others are moved outwards.
    """
    middle = extent([p for v in vectors for p in (v.start, v.end)] or [0j])[3]
    taken: dict[int, int] = {}
    offsets = [0j] * len(vectors)
    for number in sorted(range(len(vectors)), key=lambda n: (vectors[n].kind == "inner", -abs(vectors[n].value))):
        vector = vectors[number]
        used = {lane for other, lane in taken.items() if _overlaps(vector, vectors[other], size)}
        taken[number] = next(n for n in range(len(vectors) + 1) if n not in used)
        along = vector.value / abs(vector.value)
        upward = along if (round(along.imag, 6), along.real) > (0, 0) else -along
        inward = dot(-1j * upward, (vector.start + vector.end) / 2 - middle) < -OVERLAP_WITHIN * size
        offsets[number] = (1j if inward else -1j) * upward * LANE_WIDTH * taken[number]
    return offsets


def _overlaps(first: NamedVector, other: NamedVector, size: float) -> bool:
    """Return True if two vectors of a plan lie so nearly on one another that they would look like one line.

    size: largest extent of the plan, in the units of the vectors.
    """
    short, long = sorted((first, other), key=lambda vector: abs(vector.value))
    along = long.value / abs(long.value)
    if max(abs(cross(along, p - long.start)) for p in (short.start, short.end)) > OVERLAP_WITHIN * size:
        return False
    low, high = sorted(float(dot(along, p - long.start)) for p in (short.start, short.end))
    return min(high, abs(long.value)) - max(low, 0.0) > OVERLAP_WITHIN * size


def _join_corners(sheet: DrawingSheet, vectors: Sequence[NamedVector], aside: Sequence[complex]) -> None:
    """Connect the ends of vectors by thin lines where they coincide in the polygon but are drawn apart."""
    ends = [(sheet.on(p), sheet.on(p) + off) for v, off in zip(vectors, aside, strict=True) for p in (v.start, v.end)]
    for _at, corner_points in gather_coincident(ends):
        apart = [place for place in corner_points if abs(place - corner_points[0]) > 0.1 * LANE_WIDTH]
        for place in apart:
            sheet.line([corner_points[0], place], THIN_COLOUR, 0.5, z=2.0)


def _draw_force(sheet: DrawingSheet, vector: NamedVector, off: complex, *, full: bool) -> None:
    start, end = sheet.on(vector.start) + off, sheet.on(vector.end) + off
    colour, length = VECTOR_COLOURS[vector.kind], abs(end - start)
    if vector.kind == "inner" or full:
        sheet.line([start, end], colour, 0.9, "-." if full else "--", 4)
        sheet.arrow(end - min(6.0, length) * (end - start) / length, end, colour, 0.9)
    else:
        sheet.arrow(start, end, colour, 1.6)
        sheet.circle(end, 0.45, DARK_COLOUR, DARK_COLOUR, 0.3, 6)
    if length > LEAST_NAMED:
        sheet.label(vector.symbol, (start + end) / 2, 10, colour)


CORNER_WITHIN = 1.5  # mm: a corner closer to a lettered end shares its circle
NAME_SHARES = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8)  # of a vector: positions of its name, in order of preference
NAME_CLEARANCE = 0.02  # of the plan: least distance of a name from other vectors


@dataclass(frozen=True)
class MotionPlanKind:
    """Description of a velocity or acceleration plan.

    Attributes:
        stem: stem of the file name.
        title: title with the field {caption}.
        plan: function that builds the plan for position k of a motion.
        pole: letter of the pole.
        letter: letter in the scale factor.
        unit: unit of the vectors.
        what: angular velocity or angular acceleration, which the table lists for each link.
        turning: unit of the angular velocity or acceleration.
    """

    stem: str
    title: str
    plan: Callable[[Motion, int], Plan]
    pole: str
    letter: str
    unit: str
    what: Literal["omega", "epsilon"]
    turning: str


def motion_plan_kinds() -> tuple[MotionPlanKind, MotionPlanKind]:
    """Return the descriptions of the velocity plan and of the acceleration plan."""
    return (
        MotionPlanKind("velocity", _("Velocity plan. {caption}"), velocity_plan, "p", "v", "m/s", "omega", "rad/s"),
        MotionPlanKind(
            "acceleration",
            _("Acceleration plan. {caption}"),
            acceleration_plan,
            ACCELERATION_POLE,
            "a",
            "m/s²",
            "epsilon",
            "rad/s²",
        ),
    )


def draw_motion_plans(position: Position) -> Iterable[tuple[str, Drawing]]:
    """Yield the velocity plan and the acceleration plan of a position, as (stem of the file name, drawing)."""
    for plan_kind in motion_plan_kinds():
        plan = plan_kind.plan(position.motion, position.k)
        figure = FigureExtent()
        figure.spots([0j], PLAN_MARGIN)
        for vector in plan.vectors:
            figure.line(vector.start, vector.end, PLAN_MARGIN)
        # the width of the table hardly depends on the scale
        layout = choose_scale(
            figure,
            NoteBlock(["μ = 0.0000 (m/s²)/mm"], motion_plan_rows(position, plan_kind, plan, plan.size / 100 or 1.0), 2),
        )
        sheet = position.sheet(plan_kind.title, room=layout)
        for vector in plan.drawn():
            # a thin ray is enough for a centre of mass, which has its letter
            mass = vector.kind == "absolute" and vector.symbol.below.startswith("S")
            width = {"absolute": 0.7 if mass else 1.5, "relative": 1.1}.get(vector.kind, 1.2)
            sheet.arrow(
                sheet.on(vector.start),
                sheet.on(vector.end),
                THIN_COLOUR if mass else VECTOR_COLOURS[vector.kind],
                width,
            )
        for vector in plan.drawn():
            if vector.kind != "absolute" and abs(vector.value) / sheet.mu > LEAST_NAMED:
                sheet.label(vector.symbol, sheet.on(name_position(vector, plan)), 9, VECTOR_COLOURS[vector.kind])
        draw_plan_points(sheet, {**plan.ends, **corners_on_paper(plan, sheet.mu)}, plan_kind.pole)
        if plan.size == 0:
            sheet.note(_("all points and links are at rest"))
        sheet.note(scale_words(plan_kind.letter, sheet.mu, f"({plan_kind.unit})/mm"))
        sheet.table(motion_plan_rows(position, plan_kind, plan, sheet.mu), 2)
        yield position.stem(plan_kind.stem), sheet.finish()


def corners_on_paper(plan: Plan, mu: float) -> dict[str, complex]:
    """Return the corners of a velocity or acceleration plan, by letter.

    A corner that coincides on paper with the lettered end of a vector is moved to that end.
    """
    nearest = {
        letter: min(plan.ends.values(), key=lambda end: abs(end - place)) for letter, place in plan.corners.items()
    }
    return {
        letter: place if abs(place - nearest[letter]) > CORNER_WITHIN * mu else nearest[letter]
        for letter, place in plan.corners.items()
    }


def name_position(vector: NamedVector, plan: Plan) -> complex:
    """Return the point at which the name of a vector is written: near its middle and clear of other vectors."""
    others = [v for v in plan.drawn() if v is not vector and v.kind != "absolute"]
    candidates = [vector.start + share * vector.value for share in NAME_SHARES]
    room = [
        min((distance_to_segment(place, v.start, v.end) for v in others), default=plan.size) for place in candidates
    ]
    return next(
        (place for place, free in zip(candidates, room, strict=True) if free > NAME_CLEARANCE * plan.size),
        candidates[0],
    )


def motion_plan_rows(position: Position, plan_kind: MotionPlanKind, plan: Plan, mu: float) -> list[TableRow]:
    """Return the rows of the table of a velocity or acceleration plan.

    They give the letters, the length on paper and the value of each vector, then the angular velocity or acceleration
    of each link. mu: scale of the plan, SI units per mm.
    """
    rows = [TableRow((_("vector"), _("plan segment"), spelt("mm"), spelt(plan_kind.unit)), head=True)]
    for reading in plan_readings(plan):
        first, *others = reading.symbols
        names = (first, *(piece for symbol in others for piece in (" = ", symbol)))
        length = numeral(reading.size / mu, ".1f") if reading.size else "0"
        rows.append(TableRow((names, with_subscripts(reading.segment), length, format_figures(reading.size))))
    rows.append(TableRow((_("link"), _("sense"), "", spelt(plan_kind.turning)), head=True))
    for turn in angular_values(position.motion, position.k, plan_kind.what):
        sense = _("ccw") if turn.value > 0 else _("cw") if turn.value < 0 else ""
        rows.append(TableRow((turn.symbol, sense, "", format_figures(abs(turn.value)))))
    return rows
