"""Drivers of a problem file."""

from __future__ import annotations

from tmm_cli.errors import _
from tmm_cli.linkage import FRAME, Driver, Hinge, Link, Slide
from tmm_cli.problem import schema
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.tree import Path
from tmm_cli.problem.values import ValueReader, unjoined
from tmm_cli.quantities import ACCELERATION, ANGLE, ANGULAR_ACCELERATION, ANGULAR_SPEED, LENGTH, SPEED

FASTER = 100  # a further driver may turn so many times as fast as the first; a slider counts by the size of the linkage


def build_drivers(
    shape: schema.File,
    links: dict[str, Link],
    hinges: tuple[Hinge, ...],
    slides: tuple[Slide, ...],
    values: ValueReader,
) -> tuple[Driver, ...]:
    """All drivers in the order of the file."""
    if isinstance(shape.driver, schema.Driver):
        return (_driver(shape.driver, links, hinges, slides, values, ("driver",), True),)
    if not shape.driver:
        raise ProblemError(_("there is no driver"), path=("driver",), found="[]", allowed=_("{link: 1, speed: 60 rpm}"))
    found: list[Driver] = []
    for number, given in enumerate(shape.driver):
        driver = _driver(given, links, hinges, slides, values, ("driver", number), number == 0)
        if any({driver.link, driver.base} == {d.link, d.base} or driver.link == d.link for d in found):
            raise ProblemError(
                _("this link is driven already"), path=("driver", number, "link"), found=quote(driver.link)
            )
        found.append(driver)
    size = max((abs(p - q) for link in links.values() for p in link.points.values() for q in link.points.values()),
               default=0.0) or 1.0  # fmt: skip
    for number, driver in enumerate(found[1:], 1):
        lead, own = (d.rate / (size if d.kind == "slide" else 1.0) for d in (found[0], driver))
        if lead > 0 and own > FASTER * lead:
            raise ProblemError(
                _("a driver is far faster than the first one"), path=("driver", number, "speed"),
                found=str(shape.driver[number].speed), allowed=_("the fastest driver first"),
            )  # fmt: skip
    if len(found) > 1 and found[0].rate == 0:
        raise ProblemError(
            _("the first of several drivers counts the positions: it must move"), path=("driver", 0, "speed"),
            found=str(shape.driver[0].speed),
        )  # fmt: skip
    return tuple(found)


def _driver(
    given: schema.Driver, links: dict[str, Link], hinges: tuple[Hinge, ...], slides: tuple[Slide, ...],
    values: ValueReader, path: Path, first: bool,
) -> Driver:  # fmt: skip
    link = values.known(given.link, {n: 0 for n in links if n != FRAME}, (*path, "link"), "link")
    base = values.known(given.on, links, (*path, "on"), "link")
    values.different((link, base), (*path, "on"))
    pivots = [h.point for h in hinges if base in h.links and link in h.links]
    runs = [s for s in slides if {s.carrier, s.runner} == {base, link}]
    if not pivots and not runs:
        raise unjoined(link, base, hinges, slides, (*path, "link"))
    turns = bool(pivots)
    speed = values.number(given.speed, ANGULAR_SPEED if turns else SPEED, (*path, "speed"))
    acceleration = values.number(
        given.acceleration, ANGULAR_ACCELERATION if turns else ACCELERATION, (*path, "acceleration")
    )
    if speed < 0 and "turns" in given.model_fields_set:
        raise ProblemError(
            _("a negative speed and a sense of rotation say the sense twice"), path=(*path, "speed"),
            found=str(given.speed), allowed=_("a positive speed with turns: ccw or cw"),
        )  # fmt: skip
    if given.end is not None:
        values.known(given.end, links[link].points, (*path, "end"), f"point of link {link}")
    if first == (given.at is not None):
        raise ProblemError(
            _("the place of the first driver stands in the sketch, that of each other one here"), path=(*path, "at"),
            allowed=_("sketch: {at: 30 deg} for the first, at: 30 deg for the others"), key=True,
        )  # fmt: skip
    want = ANGLE if turns else LENGTH
    at = 0.0 if given.at is None else values.number(given.at, want, (*path, "at"))
    stroke = None
    if given.stroke is not None:
        low, high = (values.number(value, want, (*path, "stroke", k)) for k, value in enumerate(given.stroke))
        if not low < high:
            raise ProblemError(
                _("a stroke goes from its lesser end to its greater one"), path=(*path, "stroke"),
                found=str(given.stroke),
            )  # fmt: skip
        stroke = (low, high)
    return Driver(
        link, "turn" if turns else "slide", pivots[0] if turns else runs[0].name, abs(speed),
        acceleration if speed >= 0 else -acceleration, -1 if given.turns == "cw" or speed < 0 else 1, given.balance,
        given.end or "", base, at, stroke,
    )  # fmt: skip
