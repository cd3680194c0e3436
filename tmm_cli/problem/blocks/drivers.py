"""Drivers of a problem file with their speeds, the sketch, and the requested positions."""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable
from dataclasses import replace
from typing import Any, Literal

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.linkage import FRAME, Driver, Link, Request, Sketch, SpeedTable
from tmm_cli.mechanics.numerics import SAME_DRIVER_POSITION, SAME_RATIO, InterpolationTable, to_float
from tmm_cli.mechanics.quantities import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    LENGTH,
    SPEED,
    Dimension,
)
from tmm_cli.mechanics.structure import MOST_TURNS
from tmm_cli.problem import schema
from tmm_cli.problem.blocks.links import LinksAndPairs
from tmm_cli.problem.errors import Path, ProblemError, quote, unknown_position_error
from tmm_cli.problem.values import FileSection, ValueReader

ROUNDING_OF_REST = 1e-12  # relative to the square of the largest speed: less is a rounding error of zero


def _build_speed_table(section: FileSection, turns: int) -> SpeedTable:
    """Build the table of the driver speed squared against the crank angle, with accelerations if the file gives them.

    turns: crank revolutions per cycle.
    """
    keys: schema.DriverKeys = section.keys
    angles, speeds = _columns(section, "speed", ANGULAR_SPEED)
    path = (*section.path, "speed", "table")
    for k, speed in enumerate(speeds):
        if speed < 0:
            raise ProblemError(
                _("speeds in a table must not be negative, as the driver always rotates in one direction"),
                path=(*path, k, 1),
                found=quote(keys.speed.table[k][1]),
                allowed=_("zero or more; for clockwise rotation write turns: cw"),
            )
    if not any(speeds):
        raise ProblemError(_("the speed of the driver is zero in all rows"), path=path, key=True)
    closed = _is_closed(section, "speed", angles, speeds, turns)
    squares = InterpolationTable(angles, tuple(speed * speed for speed in speeds), keys.speed.between, closed)
    row, least = _find_least(squares)
    if least < -ROUNDING_OF_REST * float(to_float(max(speeds))) ** 2:
        below = _("the smooth curve through the squared speeds falls below zero between this row and the next")
        angle, allowed = quote(keys.speed.table[row][0]), _("write between: linear, or add rows between these two")
        raise ProblemError(below, path=(*path, row, 0), found=angle, allowed=allowed)
    if not isinstance(keys.acceleration, schema.Speeds):
        return SpeedTable(squares)
    angles, gains = _columns(section, "acceleration", ANGULAR_ACCELERATION)
    closed_too = _is_closed(section, "acceleration", angles, gains, turns)
    if closed_too != closed or angles[0] > squares.arguments[0] or angles[-1] < squares.arguments[-1]:
        raise section.refusal(
            "acceleration",
            _("the table of accelerations must cover the same angles as the table of speeds"),
            at_key=True,
        )
    return SpeedTable(squares, InterpolationTable(angles, gains, keys.acceleration.between, closed_too))


def _mean_speed(section: FileSection) -> float:
    """Return the arithmetic mean of the speeds in all rows of the table (rad/s)."""
    speeds = _columns(section, "speed", ANGULAR_SPEED)[1]
    whole: float = sum(speeds) / len(speeds)
    return whole


def _columns(section: FileSection, key: str, want: Dimension) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
    table_section = FileSection(getattr(section.keys, key), (*section.path, key), section.values)
    return table_section.columns("table", ANGLE, want, jumps=key == "acceleration")


def _is_closed(section: FileSection, key: str, angles: tuple[Any, ...], values: tuple[Any, ...], turns: int) -> bool:
    """Return True if a table of the file covers the whole cycle.

    Raises ProblemError if it does and its last value differs from the first.
    """
    table, path, units = getattr(section.keys, key).table, (*section.path, key, "table"), section.values.units
    cycle = math.tau * turns
    end = units.format_value(float(angles[0]) + cycle, ANGLE)
    beyond: Iterable[int] = (k for k, angle in enumerate(angles) if angle - angles[0] > cycle + SAME_DRIVER_POSITION)
    if (row := next(iter(beyond), None)) is not None:
        longer = _("at most {end}; for a longer cycle write cycle: {turns} turns").format(end=end, turns=turns + 1)
        never = _("this row is never used: it lies more than one cycle after the first row")
        raise ProblemError(never, path=(*path, row, 0), found=quote(table[row][0]), allowed=longer)
    if angles[-1] - angles[0] < cycle - SAME_DRIVER_POSITION:
        return False
    if abs(values[-1] - values[0]) > SAME_RATIO * max(abs(value) for value in values):
        raise ProblemError(
            _("the table covers the whole cycle, but its last value differs from the first"),
            path=(*path, len(table) - 1, 1),
            found=quote(table[-1][1]),
            allowed=_("{first}, as in the first row").format(first=table[0][1]),
        )
    return True


def _find_least(table: InterpolationTable) -> tuple[int, float]:
    """Find the minimum of an interpolated table.

    Returns:
        Index of the row before the minimum, and the minimum itself.
    """
    rows = np.array([float(to_float(row)) for row in table.arguments])
    squares = to_float(table(rows[:-1, None] + np.diff(rows)[:, None] * np.linspace(0, 1, 33)))
    row = int(np.argmin(np.min(squares, axis=1)))
    return row, float(np.min(squares))


# Drivers, sketch and requested positions.


MAX_SPEED_RATIO = (
    100  # a further driver may turn so many times as fast as the first; a slider counts by the size of the linkage
)
DEFAULT_SKETCH_ANGLE = cmath.pi / 3  # crank angle at which assemblies are compared if the file has no sketch


def build_drivers(shape: schema.File, members: LinksAndPairs, values: ValueReader) -> tuple[Driver, ...]:
    """Build all drivers of the file, in their order there. Raises ProblemError without line and column."""
    if isinstance(shape.driver, schema.DriverKeys):
        section = FileSection(shape.driver, ("driver",), values)
        driver = _build_driver(section, members, True)
        if isinstance(shape.driver.speed, schema.Speeds):
            driver = replace(driver, law=_build_speed_table(section, build_cycle(shape, driver, values)))
        return (driver,)
    if not shape.driver:
        raise ProblemError(_("there is no driver"), path=("driver",), found="[]", allowed=_("{link: 1, speed: 60 rpm}"))
    sections = [FileSection(keys, ("driver", number), values) for number, keys in enumerate(shape.driver)]
    drivers: list[Driver] = []
    for section in sections:
        driver = _build_driver(section, members, section is sections[0])
        if any({driver.link, driver.base} == {d.link, d.base} or driver.link == d.link for d in drivers):
            raise section.refusal("link", _("this link already has a driver"), quote(driver.link))
        drivers.append(driver)
    lead, length = drivers[0], _linkage_size(members.links)
    for section, driver in zip(sections[1:], drivers[1:], strict=True):
        first, rate = (d.rate / (length if d.kind == "slide" else 1.0) for d in (lead, driver))
        if first > 0 and rate > MAX_SPEED_RATIO * first:
            faster = _("this driver is more than 100 times faster than the first one")
            raise section.refusal(
                "speed", faster, str(section.keys.speed), _("write the fastest driver first in the list")
            )
    if len(drivers) > 1 and lead.rate == 0:
        still = _("positions are numbered along the motion of the first driver, so its speed must not be zero")
        raise sections[0].refusal("speed", still, str(sections[0].keys.speed))
    return tuple(drivers)


def _linkage_size(links: dict[str, Link]) -> float:
    """Return the largest distance between two points of the same link (m), or 1 if there is none."""
    spans = (abs(p - q) for link in links.values() for p in link.points.values() for q in link.points.values())
    return max(spans, default=0.0) or 1.0


def _build_driver(section: FileSection, members: LinksAndPairs, first: bool) -> Driver:
    keys: schema.DriverKeys = section.keys
    link = section.known_name("link", [name for name in members.links if name != FRAME], "link")
    base = section.known_name("on", members.links, "link")
    section.values.refuse_same((link, base), (*section.path, "on"))
    pivot, slide = members.hinge(link, base), members.slide(link, base)
    if pivot is None and slide is None:
        raise members.missing_pair_error(link, base, (*section.path, "link"))
    turns = pivot is not None
    want = ANGLE if turns else LENGTH
    by_angle = isinstance(keys.speed, schema.Speeds)
    if by_angle and (not turns or not first or section.path != ("driver",)):
        raise section.refusal(
            "speed", _("a table of speeds is allowed only for a single driver that is a crank"), at_key=True
        )
    if by_angle != isinstance(keys.acceleration, schema.Speeds) and keys.acceleration != 0:
        apart = _("give speed and acceleration in the same way: as two values at position 0, or as two tables")
        raise section.refusal("acceleration", apart, at_key=True)
    speed = _mean_speed(section) if by_angle else section.number("speed", ANGULAR_SPEED if turns else SPEED)
    acceleration = 0.0
    if not by_angle:
        acceleration = section.number("acceleration", ANGULAR_ACCELERATION if turns else ACCELERATION)
    if speed < 0 and "turns" in keys.model_fields_set:
        twice = _("the direction of rotation is given twice: by the sign of the speed and by `turns`")
        raise section.refusal("speed", twice, str(keys.speed), _("a positive speed together with turns: ccw or cw"))
    if keys.end is not None:
        section.known_name("end", members.links[link].points, f"point of link {link}")
        if keys.end == pivot:
            has_no_arm = _("a balancing force applied at the pivot {point} has no moment arm").format(point=pivot)
            raise section.refusal("end", has_no_arm, quote(keys.end), _("another point of the link"))
    if first == (keys.at is not None):
        raise section.refusal(
            "at",
            _(
                "the sketch coordinate of the first driver is given in the block `sketch`; the key `at` is only "
                "for the other drivers"
            ),
            at_key=True,
            allowed=_("for the first driver: sketch: {at: 30 deg}; for the others: at: 30 deg"),
        )
    at = 0.0 if keys.at is None else section.number("at", want)
    stroke = None
    if keys.stroke is not None:
        low, high = (
            section.values.number(value, want, (*section.path, "stroke", k)) for k, value in enumerate(keys.stroke)
        )
        if not low < high:
            raise section.refusal(
                "stroke", _("the first coordinate of the stroke must be less than the second"), str(keys.stroke)
            )
        stroke = (low, high)
    return Driver(
        link,
        "turn" if turns else "slide",
        pivot or (slide.name if slide else ""),
        abs(speed),
        acceleration if speed >= 0 else -acceleration,
        -1 if keys.turns == "cw" or speed < 0 else 1,
        keys.balance,
        keys.end or "",
        base,
        at,
        stroke,
    )


def build_cycle(shape: schema.File, driver: Driver, values: ValueReader) -> int:
    """Return the number of crank revolutions after which the loads repeat. Raises ProblemError."""
    if shape.cycle is None:
        return 1
    if driver.kind != "turn":
        raise ProblemError(
            _("a cycle is given in crank turns, but this driver is a slider"),
            path=("cycle",),
            found=quote(shape.cycle),
        )
    turns = values.number(shape.cycle, ANGLE, ("cycle",)) / (2 * cmath.pi)
    whole = round(float(turns))
    if not 1 <= whole <= MOST_TURNS or abs(turns - whole) > SAME_DRIVER_POSITION:
        raise ProblemError(
            _("a cycle must be a whole number of turns"),
            path=("cycle",),
            found=quote(shape.cycle),
            allowed=_("e.g. 2 turns or 720 deg; largest number of turns: {most}").format(most=MOST_TURNS),
        )
    return whole


def build_sketch(shape: schema.File, links: dict[str, Link], driver: Driver, values: ValueReader) -> Sketch:
    """Build the sketch from the block `sketch`. Raises ProblemError.

    If the file has no such block, the sketch contains only a default driver coordinate.
    """
    keys = dict(shape.sketch)
    dimension = ANGLE if driver.kind == "turn" else LENGTH
    if not keys:
        return Sketch(DEFAULT_SKETCH_ANGLE if driver.kind == "turn" else 0.0)
    if "at" not in keys:
        raise ProblemError(
            _("the driver coordinate of the sketch is missing"),
            path=("sketch", "at"),
            allowed=_("at: {wanted}").format(wanted=dimension),
        )
    at = values.number(keys.pop("at"), dimension, ("sketch", "at"))
    if driver.stroke is not None and not driver.stroke[0] <= at <= driver.stroke[1]:
        beyond = _("in the sketch the driver is outside its stroke")
        raise ProblemError(beyond, path=("sketch", "at"), found=str(shape.sketch["at"]))
    owners = {p: n for n, link in links.items() for p in link.points}
    points, angles = {}, {}
    for name, value in keys.items():
        path: Path = ("sketch", name)
        if name in owners and isinstance(value, list):
            points[name] = values.vector(value, LENGTH, path)
        elif name in links and name != FRAME and not isinstance(value, list):
            angles[name] = values.number(value, ANGLE, path)
        else:
            values.known_name(name, {**owners, **links}, path, "point or link", key=True)
            raise ProblemError(
                _("in a sketch, a point is given by coordinates and a link by an angle"),
                path=path,
                found=quote(value),
                allowed="[x, y]" if name in owners else _("an angle"),
            )
    return Sketch(at, points, angles)


def build_request(shape: schema.File, driver: Driver, values: ValueReader) -> Request:
    """Read the requested positions from the block `positions`. Raises ProblemError."""
    keys = shape.positions
    section = FileSection(keys, ("positions",), values)
    dimension = ANGLE if driver.kind == "turn" else LENGTH
    coordinates = tuple(values.number(v, dimension, ("positions", "at", k)) for k, v in enumerate(keys.at or ()))
    count = len(coordinates) or keys.count
    for k, number in enumerate(keys.detail):
        if not 0 <= number < count:
            raise unknown_position_error(number, count, "positions", "detail", k)
    if keys.from_ is not None and driver.kind == "slide" and not coordinates:
        raise section.refusal(
            "from",
            _(
                "`from` is allowed only for a crank: the positions of a driving slider run from one end of its "
                "stroke to the other"
            ),
            str(keys.from_),
            _("driver: {stroke: [first, last]}, or positions: {at: [...]}"),
            at_key=True,
        )
    start: float | Literal["working stroke"] = 0.0
    if keys.from_ == "working stroke":
        start = "working stroke"
    elif keys.from_ is not None:
        start = values.number(keys.from_, dimension, ("positions", "from"))
    return Request(count, start, coordinates, tuple(keys.detail), keys.centres)
