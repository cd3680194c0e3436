"""Drivers of a problem file."""

from __future__ import annotations

from tmm_cli.linkage import FRAME, Driver, Hinge, Link, Slide
from tmm_cli.problem import schema
from tmm_cli.problem.errors import Path, ProblemError, quote
from tmm_cli.problem.sense import Sense
from tmm_cli.problem.units import ACCELERATION, ANGLE, ANGULAR_ACCELERATION, ANGULAR_SPEED, LENGTH, SPEED

FASTER = 100  # a further driver may turn so many times as fast as the first; a slider counts by the size of the linkage


def build_drivers(
    shape: schema.File, links: dict[str, Link], hinges: tuple[Hinge, ...], slides: tuple[Slide, ...], sense: Sense
) -> tuple[Driver, ...]:
    """All drivers in the order of the file."""
    if isinstance(shape.driver, schema.Driver):
        return (_driver(shape.driver, links, hinges, slides, sense, ("driver",), True),)
    if not shape.driver:
        raise ProblemError("there is no driver", path=("driver",), found="[]", allowed="{link: 1, speed: 60 rpm}")
    found: list[Driver] = []
    for number, given in enumerate(shape.driver):
        driver = _driver(given, links, hinges, slides, sense, ("driver", number), number == 0)
        if any({driver.link, driver.base} == {d.link, d.base} or driver.link == d.link for d in found):
            raise ProblemError(
                "this link is driven already", path=("driver", number, "link"), found=quote(driver.link),
                allowed="one driver for each freedom, on links of their own",
            )  # fmt: skip
        found.append(driver)
    size = max((abs(p - q) for link in links.values() for p in link.points.values() for q in link.points.values()),
               default=0.0) or 1.0  # fmt: skip
    for number, driver in enumerate(found[1:], 1):
        lead, own = (d.rate / (size if d.kind == "slide" else 1.0) for d in (found[0], driver))
        if lead > 0 and own > FASTER * lead:
            raise ProblemError(
                f"link {driver.link} is driven more than {FASTER} times as fast as link {found[0].link}, whose places "
                "are looked at one by one", path=("driver", number, "speed"),
                found=str(shape.driver[number].speed), allowed="the fastest driver first",
            )  # fmt: skip
    if len(found) > 1 and found[0].rate == 0:
        raise ProblemError(
            "the first of several drivers counts the positions: it must move", path=("driver", 0, "speed"),
            found=str(shape.driver[0].speed), allowed="a speed that is not zero",
        )  # fmt: skip
    return tuple(found)


def _driver(
    given: schema.Driver, links: dict[str, Link], hinges: tuple[Hinge, ...], slides: tuple[Slide, ...], sense: Sense,
    path: Path, first: bool,
) -> Driver:  # fmt: skip
    link = sense.known(given.link, {n: 0 for n in links if n != FRAME}, (*path, "link"), "link")
    base = sense.known(given.on, links, (*path, "on"), "link")
    if base == link:
        raise ProblemError(
            "a link cannot be driven from itself", path=(*path, "on"), found=quote(base),
            allowed="the frame, 0, or another link that it is joined to",
        )  # fmt: skip
    pivots = [h.point for h in hinges if base in h.links and link in h.links]
    runs = [s for s in slides if {s.carrier, s.runner} == {base, link}]
    if not pivots and not runs:
        raise _unjoined(link, base, given, hinges, slides, path)
    turns = bool(pivots)
    speed = sense.number(given.speed, ANGULAR_SPEED if turns else SPEED, (*path, "speed"))
    acceleration = sense.number(
        given.acceleration, ANGULAR_ACCELERATION if turns else ACCELERATION, (*path, "acceleration")
    )
    if speed < 0 and "turns" in given.model_fields_set:
        raise ProblemError(
            "a negative speed and a sense of rotation say the sense twice", path=(*path, "speed"),
            found=str(given.speed), allowed="a positive speed with turns: ccw or cw",
        )  # fmt: skip
    if given.end is not None:
        sense.known(given.end, links[link].points, (*path, "end"), f"point of link {link}")
    if first and given.at is not None:
        raise ProblemError(
            "the first driver's place in the sketch stands in the sketch", path=(*path, "at"), found=str(given.at),
            allowed="sketch: {at: ...}", key=True,
        )  # fmt: skip
    if not first and given.at is None:
        raise ProblemError(
            "the place of this driver in the sketch is missing", path=(*path, "at"),
            allowed=f"at: {ANGLE if turns else LENGTH}",
        )  # fmt: skip
    at = 0.0 if given.at is None else sense.number(given.at, ANGLE if turns else LENGTH, (*path, "at"))
    stroke = None
    if given.stroke is not None:
        low, high = (
            sense.number(value, ANGLE if turns else LENGTH, (*path, "stroke", k))
            for k, value in enumerate(given.stroke)
        )
        if not low < high:
            raise ProblemError(
                "a stroke goes from its lesser end to its greater one", path=(*path, "stroke"), found=str(given.stroke),
                allowed="[from, to]; a negative speed runs it backward",
            )  # fmt: skip
        stroke = (low, high)
    return Driver(
        link, "turn" if turns else "slide", pivots[0] if turns else runs[0].name, abs(speed),
        acceleration if speed >= 0 else -acceleration, -1 if given.turns == "cw" or speed < 0 else 1, given.balance,
        given.end or "", base, at, stroke,
    )  # fmt: skip


def _unjoined(
    link: str, base: str, given: schema.Driver, hinges: tuple[Hinge, ...], slides: tuple[Slide, ...], path: Path
) -> ProblemError:
    if base != FRAME:
        joined = [n for h in hinges if link in h.links for n in h.links if n != link]
        joined += [s.carrier if s.runner == link else s.runner for s in slides if link in (s.carrier, s.runner)]
        return ProblemError(
            f"link {link} is neither hinged to link {base} nor slides on it", path=(*path, "on"), found=quote(base),
            allowed=", ".join(dict.fromkeys(joined)),
        )  # fmt: skip
    cylinders = [s.carrier if s.runner == link else s.runner for s in slides if link in (s.carrier, s.runner)]
    allowed = [n for h in hinges if FRAME in h.links for n in h.links if n != FRAME]
    allowed += [s.runner for s in slides if s.carrier == FRAME]
    also = f"; or on: {cylinders[0]}, if it is a cylinder there" if cylinders else ""
    return ProblemError(
        "the driver is neither hinged to the frame nor slides on it", path=(*path, "link"), found=quote(link),
        allowed=", ".join(allowed) + also,
    )  # fmt: skip
