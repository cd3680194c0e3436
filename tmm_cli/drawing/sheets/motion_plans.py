"""Plans of velocities and accelerations to scale, with a table of what is read off them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal

from tmm_cli.drawing.paper import (
    THIN_COLOUR,
    VECTOR_COLOURS,
    Drawing,
    FigureExtent,
    NoteBlock,
    TableRow,
    choose_scale,
    distance_to_segment,
    scale_words,
)
from tmm_cli.drawing.sheets.group_loads import format_figures
from tmm_cli.drawing.sheets.lever import draw_plan_points
from tmm_cli.drawing.sheets.mechanism import Position
from tmm_cli.language import _, numeral, spelt
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.plans import (
    ACCELERATION_POLE,
    NamedVector,
    Plan,
    acceleration_plan,
    angular_values,
    plan_readings,
    velocity_plan,
    with_subscripts,
)

PLAN_MARGIN = 9.0  # mm about the lines of a plan, for letters
CORNER_WITHIN = 1.5  # mm: a corner that is nearer to a lettered end is lettered with it
NAME_SHARES, NAME_CLEARANCE = (
    (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8),
    0.02,
)  # of a vector: where its name may be; of a plan: too near
LEAST_NAMED = 4.0  # mm: a shorter vector has no name beside it, only in the table


@dataclass(frozen=True)
class MotionPlanKind:
    """One of the two plans. unit, turning: of its vectors and of what links turn with."""

    stem: str
    title: str
    plan: Callable[[Motion, int], Plan]
    pole: str
    letter: str
    unit: str
    what: Literal["omega", "epsilon"]
    turning: str


def motion_plan_kinds() -> tuple[MotionPlanKind, MotionPlanKind]:
    """The velocity plan and the acceleration plan."""
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


def draw_motion_plans(here: Position) -> Iterable[tuple[str, Drawing]]:
    """Velocity plan and acceleration plan of a position, with the parts of each link."""
    for sort in motion_plan_kinds():
        plan = sort.plan(here.motion, here.k)
        figure = FigureExtent()
        figure.spots([0j], PLAN_MARGIN)
        for vector in plan.vectors:
            figure.line(vector.start, vector.end, PLAN_MARGIN)
        # how wide the table is hardly hangs on the scale
        found = choose_scale(
            figure, NoteBlock(["μ = 0.0000 (m/s²)/mm"], motion_plan_rows(here, sort, plan, plan.size / 100 or 1.0), 2)
        )
        sheet = here.sheet(sort.title, room=found)
        for vector in plan.drawn():
            # of points of mass a thin ray is enough: the letters say the rest
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
        draw_plan_points(sheet, {**plan.ends, **corners_on_paper(plan, sheet.mu)}, sort.pole)
        if plan.size == 0:
            sheet.note(_("everything is at rest"))
        sheet.note(scale_words(sort.letter, sheet.mu, f"({sort.unit})/mm"))
        sheet.table(motion_plan_rows(here, sort, plan, sheet.mu), 2)
        yield here.stem(sort.stem), sheet.finish()


def corners_on_paper(plan: Plan, mu: float) -> dict[str, complex]:
    """Corners; one that cannot be told from a lettered end on paper shares its place, and so its label."""
    nearest = {
        letter: min(plan.ends.values(), key=lambda end: abs(end - place)) for letter, place in plan.corners.items()
    }
    return {
        letter: place if abs(place - nearest[letter]) > CORNER_WITHIN * mu else nearest[letter]
        for letter, place in plan.corners.items()
    }


def name_position(vector: NamedVector, plan: Plan) -> complex:
    """A place on a vector, near its middle, that is as far as can be from what is drawn over it."""
    others = [v for v in plan.drawn() if v is not vector and v.kind != "absolute"]
    places = [vector.start + share * vector.value for share in NAME_SHARES]
    room = [min((distance_to_segment(place, v.start, v.end) for v in others), default=plan.size) for place in places]
    return next(
        (place for place, free in zip(places, room, strict=True) if free > NAME_CLEARANCE * plan.size), places[0]
    )


def motion_plan_rows(here: Position, sort: MotionPlanKind, plan: Plan, mu: float) -> list[TableRow]:
    """Every vector with its segment, its length on paper and its value; what each link turns with."""
    rows = [TableRow((_("vector"), _("segment"), spelt("mm"), spelt(sort.unit)), head=True)]
    for reading in plan_readings(plan):
        first, *others = reading.symbols
        names = (first, *(part for symbol in others for part in (" = ", symbol)))
        length = numeral(reading.size / mu, ".1f") if reading.size else "0"
        rows.append(TableRow((names, with_subscripts(reading.segment), length, format_figures(reading.size))))
    rows.append(TableRow((_("link"), _("sense"), "", spelt(sort.turning)), head=True))
    for turn in angular_values(here.motion, here.k, sort.what):
        sense = _("ccw") if turn.value > 0 else _("cw") if turn.value < 0 else ""
        rows.append(TableRow((turn.symbol, sense, "", format_figures(abs(turn.value)))))
    return rows
