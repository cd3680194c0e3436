"""Plans of velocities and accelerations to scale, with a table of what is read off them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Literal

from tmm_cli.drawing.paper import COLOURS, THIN, Block, Drawing, Figure, Row, aside, choose_scale, scale_words
from tmm_cli.drawing.sheets.group_loads import figure
from tmm_cli.drawing.sheets.lever import letter_points
from tmm_cli.drawing.sheets.mechanism import Position
from tmm_cli.language import _, numeral, spelt
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.plans import (
    ACCELERATION_POLE,
    NamedVector,
    Plan,
    acceleration_plan,
    in_letters,
    readings,
    turns,
    velocity_plan,
)

ABOUT = 9.0  # mm about the lines of a plan, for letters
APART = 1.5  # mm: a corner that is nearer to a lettered end is lettered with it
SHARES, NEAR = (0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8), 0.02  # of a vector: where its name may be; of a plan: too near
SEEN = 4.0  # mm: a shorter vector has no name beside it, only in the table


@dataclass(frozen=True)
class Sort:
    """One of the two plans. unit, turning: of its vectors and of what links turn with."""

    stem: str
    title: str
    plan: Callable[[Motion, int], Plan]
    pole: str
    letter: str
    unit: str
    what: Literal["omega", "epsilon"]
    turning: str


def sorts() -> tuple[Sort, Sort]:
    """The velocity plan and the acceleration plan."""
    return (
        Sort("velocity", _("Velocity plan. {caption}"), velocity_plan, "p", "v", "m/s", "omega", "rad/s"),
        Sort(
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
    for sort in sorts():
        plan = sort.plan(here.motion, here.k)
        figure = Figure()
        figure.spots([0j], ABOUT)
        for vector in plan.vectors:
            figure.line(vector.start, vector.end, ABOUT)
        # how wide the table is hardly hangs on the scale
        found = choose_scale(
            figure, Block(["μ = 0.0000 (m/s²)/mm"], motion_plan_rows(here, sort, plan, plan.size / 100 or 1.0), 2)
        )
        sheet = here.sheet(sort.title, room=found)
        for vector in plan.drawn():
            # of points of mass a thin ray is enough: the letters say the rest
            mass = vector.kind == "absolute" and vector.symbol.below.startswith("S")
            width = {"absolute": 0.7 if mass else 1.5, "relative": 1.1}.get(vector.kind, 1.2)
            sheet.arrow(sheet.on(vector.start), sheet.on(vector.end), THIN if mass else COLOURS[vector.kind], width)
        for vector in plan.drawn():
            if vector.kind != "absolute" and abs(vector.value) / sheet.mu > SEEN:
                sheet.label(vector.symbol, sheet.on(alone(vector, plan)), 9, COLOURS[vector.kind])
        letter_points(sheet, {**plan.ends, **seen(plan, sheet.mu)}, sort.pole)
        if plan.size == 0:
            sheet.note(_("everything is at rest"))
        sheet.note(scale_words(sort.letter, sheet.mu, f"({sort.unit})/mm"))
        sheet.table(motion_plan_rows(here, sort, plan, sheet.mu), 2)
        yield here.stem(sort.stem), sheet.finish()


def seen(plan: Plan, mu: float) -> dict[str, complex]:
    """Corners; one that cannot be told from a lettered end on paper shares its place, and so its label."""
    nearest = {
        letter: min(plan.ends.values(), key=lambda end: abs(end - place)) for letter, place in plan.corners.items()
    }
    return {
        letter: place if abs(place - nearest[letter]) > APART * mu else nearest[letter]
        for letter, place in plan.corners.items()
    }


def alone(vector: NamedVector, plan: Plan) -> complex:
    """A place on a vector, near its middle, that is as far as can be from what is drawn over it."""
    others = [v for v in plan.drawn() if v is not vector and v.kind != "absolute"]
    places = [vector.start + share * vector.value for share in SHARES]
    room = [min((aside(place, v.start, v.end) for v in others), default=plan.size) for place in places]
    return next((place for place, free in zip(places, room, strict=True) if free > NEAR * plan.size), places[0])


def motion_plan_rows(here: Position, sort: Sort, plan: Plan, mu: float) -> list[Row]:
    """Every vector with its segment, its length on paper and its value; what each link turns with."""
    rows = [Row((_("vector"), _("segment"), spelt("mm"), spelt(sort.unit)), head=True)]
    for reading in readings(plan):
        first, *others = reading.symbols
        names = (first, *(part for symbol in others for part in (" = ", symbol)))
        length = numeral(reading.size / mu, ".1f") if reading.size else "0"
        rows.append(Row((names, in_letters(reading.segment), length, figure(reading.size))))
    rows.append(Row((_("link"), _("sense"), "", spelt(sort.turning)), head=True))
    for turn in turns(here.motion, here.k, sort.what):
        sense = _("ccw") if turn.value > 0 else _("cw") if turn.value < 0 else ""
        rows.append(Row((turn.symbol, sense, "", figure(abs(turn.value)))))
    return rows
