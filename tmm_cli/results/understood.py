"""What was understood of a problem before anything is computed, and what in it is probably a slip."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from tmm_cli.double_double import rounded
from tmm_cli.language import _, numeral
from tmm_cli.linkage import FRAME, Driver, Link, SpeedTable
from tmm_cli.problem.record import Problem, TaskProblem
from tmm_cli.problem.settings import unused
from tmm_cli.problem.tree import Tree
from tmm_cli.problem.units import UnitSystem
from tmm_cli.quantities import ANGLE, ANGULAR_SPEED, FORCE, INERTIA, LENGTH, MASS, MOMENT, SPEED
from tmm_cli.results.table import with_unit

SMALL, LARGE = 0.005, 50.0  # m: links of mechanisms are rarely outside
FAST_TURN, FAST_SLIDE = 1e5, 1e3  # rad/s, m/s: the quickest spindles turn half as fast
SWINGS = 0.02  # of the range of a table: a smooth curve that goes beyond it by more is hardly meant
BULKY = 0.2  # of the largest link: a body of this radius of gyration is no point


def understood(task: Problem | TaskProblem) -> Iterable[str]:
    """Units, driver, gravity, sizes: a sentence each. What a task has to find first is found after the first one."""
    yield bare_units(task.units)
    problem = task.whole
    if problem.source is not None and problem.source.given:
        yield _("in place of the file's: {settings}").format(settings=", ".join(problem.source.given.values()))
    linkage = problem.linkage
    for driver in linkage.drivers:
        yield _("driver: link {link}, {motion}").format(link=driver.link, motion=motion(driver))
    spans = _spans(problem)
    if spans:
        (small, short), (large, long) = min(spans.values()), max(spans.values())
        yield _("sizes: from {small} ({short}) to {large} ({long}); {gravity}").format(
            small=with_unit(problem.units, small, LENGTH), short=short,
            large=with_unit(problem.units, large, LENGTH), long=long, gravity=gravity(linkage.gravity),
        )  # fmt: skip
    else:
        yield gravity(linkage.gravity)


def bare_units(units: UnitSystem) -> str:
    """What numbers without a unit mean."""
    names = [units.spelt(dimension) for dimension in (LENGTH, ANGLE, MASS, FORCE, MOMENT, INERTIA)]
    return _("bare numbers: {units}; a bare speed: {angular} or {linear}").format(
        units=", ".join(names), angular=units.spelt(ANGULAR_SPEED), linear=units.spelt(SPEED)
    )


def motion(driver: Driver) -> str:
    """`70 rad/s = 668 rpm, counterclockwise`."""
    if driver.kind == "slide":
        text = _("{speed} m/s, along its guide") if driver.sense > 0 else _("{speed} m/s, against its guide")
        return text.format(speed=_short(driver.rate))
    if driver.law is not None:
        text = _("{low} to {high} rad/s = {least} to {most} rpm by the rows of a table, counterclockwise; {between}")
        if driver.sense < 0:
            text = _("{low} to {high} rad/s = {least} to {most} rpm by the rows of a table, clockwise; {between}")
        speeds = np.sqrt([float(rounded(square)) for square in driver.law.squares.values])
        low, high = float(speeds.min()), float(speeds.max())
        return text.format(
            low=_short(low), high=_short(high), least=_short(low * 30 / math.pi), most=_short(high * 30 / math.pi),
            between=between_rows(driver.law),
        )  # fmt: skip
    text = _("{speed} rad/s = {turns} rpm, counterclockwise")
    if driver.sense < 0:
        text = _("{speed} rad/s = {turns} rpm, clockwise")
    return text.format(speed=_short(driver.rate), turns=_short(driver.rate * 30 / math.pi))


def between_rows(law: SpeedTable) -> str:
    """What is between rows of a table of speeds, and where accelerations are from."""
    if law.squares.between == "linear":
        text = _("constant acceleration from row to row")
    elif law.squares.closed:
        text = _("a cubic spline of squares of speeds that closes, accelerations from its slope")
    else:
        text = _("a natural cubic spline of squares of speeds, accelerations from its slope")
    if law.accelerations is not None:
        text = _("a spline of squares of speeds; accelerations by a table of their own")
        if law.squares.between == "linear":
            text = _("squares of speeds linear from row to row; accelerations by a table of their own")
    return text


def gravity(pull: complex) -> str:
    """Its size and direction."""
    if not pull:
        return _("no gravity")
    if pull.real == 0 > pull.imag:
        return _("gravity {size} m/s^2 downwards").format(size=numeral(-pull.imag, ".6g"))
    return _("gravity [{x}, {y}] m/s^2").format(x=numeral(pull.real, ".6g"), y=numeral(pull.imag, ".6g"))


def doubts(problem: Problem) -> Iterable[str]:
    """What is allowed and computed, and yet is probably not what was meant."""
    data: Mapping[str, Any] = {} if problem.source is None else problem.source.data
    if problem.source is not None:
        yield from without_effect(problem.source, [path[1] for path in problem.source.given])
    yield from _bare_speed(problem, data)
    for driver in problem.linkage.drivers:
        if driver.rate > (FAST_TURN if driver.kind == "turn" else FAST_SLIDE):
            yield _("the driver's speed, {motion}, is more than machines have: is the unit right?").format(
                motion=motion(driver)
            )
    yield from _sizes(problem)
    yield from _masses(problem, data)
    yield from _smooth_tables(problem)
    yield from _several_strokes(problem)
    positions = data.get("positions", {})
    if "at" in positions and "count" in positions:
        yield _("positions: `count` is not used beside `at`, which gives the places one by one: remove one of them")


def without_effect(tree: Tree, names: Iterable[Any]) -> Iterable[str]:
    """That parameters which are given other values beside the file change nothing."""
    for name in unused(tree, names):
        yield _("parameter {name} is used nowhere in the file, and its value changes nothing").format(name=name)


def _bare_speed(problem: Problem, data: Mapping[str, Any]) -> Iterable[str]:
    """A speed without a unit is in rad/s or m/s also where the file counts in degrees or millimetres."""
    driver, units = problem.linkage.driver, problem.units
    named = {key.replace("_", " ") for key in data.get("units", {})}
    if not problem.bare_speed or not driver.rate:
        return
    fastest = driver.rate if driver.law is None else math.sqrt(max(driver.law.squares.values))  # that stands in a row
    if driver.kind == "turn" and units.factor(ANGLE) != 1 and "angular speed" not in named:
        yield _(
            "the driver's speed has no unit and is taken as {motion}, though angles are in {angle}: "
            "write `{speed} rad/s`, or `{speed} rpm` if turns a minute are meant"
        ).format(motion=motion(driver), angle=units.spelt(ANGLE), speed=numeral(fastest, ".6g"))
    if driver.kind == "slide" and units.factor(LENGTH) != 1 and "speed" not in named:
        yield _(
            "the driver's speed has no unit and is taken as {speed} m/s, though lengths are in {length}: "
            "write `{speed} m/s`, or `{speed} {length}/s` if that is meant"
        ).format(length=units.spelt(LENGTH), speed=numeral(driver.rate, ".6g"))


def _sizes(problem: Problem) -> Iterable[str]:
    for link, (span, points) in _spans(problem).items():
        size = with_unit(problem.units, span, LENGTH)
        if span > LARGE:
            yield _("{points} is {size}, more than 50 m: is the unit right?").format(points=points, size=size)
        elif span < SMALL and link != FRAME:
            yield _("{points} is {size}, less than 5 mm: is the unit right?").format(points=points, size=size)


def _masses(problem: Problem, data: Mapping[str, Any]) -> Iterable[str]:
    """Inertias that do not fit their links, and bodies that are put in one point."""
    linkage, spans = problem.linkage, _spans(problem)
    largest = max((span for span, points in spans.values()), default=math.inf)
    wheels = {link for mesh in linkage.meshes for link in (mesh.i, mesh.j)}
    runners = {slide.runner for slide in linkage.slides}
    for name, given in data.get("masses", {}).items():
        link = linkage.links[name]
        if not link.mass or not link.inertia:
            continue
        radius = math.sqrt(link.inertia / link.mass)
        told = with_unit(problem.units, radius, LENGTH)
        if name in spans and name not in wheels and radius > spans[name][0]:
            yield _(
                "masses.{link}: the radius of gyration sqrt(I/m) is {radius}, more than the link itself "
                "({points}, {size}): are the units of inertia right?"
            ).format(
                link=name, radius=told, points=spans[name][1], size=with_unit(problem.units, spans[name][0], LENGTH)
            )
        elif name not in spans and name in runners and given.get("centre") is None and radius > BULKY * largest:
            yield _(
                "masses.{link}: without a centre the mass is put in {point}, though its radius of gyration "
                "sqrt(I/m) is {radius}: write centre: [x, y], or centre: {point} if that is meant"
            ).format(link=name, point=next(iter(link.points)), radius=told)


def _smooth_tables(problem: Problem) -> Iterable[str]:
    """A spline may swing far beyond its rows."""
    for load in problem.linkage.loads:
        row, share = load.table.overshoot if load.table is not None else (0, 0.0)
        if share > SWINGS:
            yield _(
                "load {load}: between rows {row} and {next} of its table the smooth curve goes beyond all rows by "
                "{share} % of their range: write `between: linear`, or give more rows there"
            ).format(load=load.name, row=row + 1, next=row + 2, share=numeral(100 * share, ".3g"))


def _several_strokes(problem: Problem) -> Iterable[str]:
    """In a cycle of several turns there are several working strokes."""
    turns = problem.linkage.turns
    for load in problem.linkage.loads if turns > 1 else ():
        if load.working_stroke_only:
            yield _(
                "load {load} acts in every working stroke of the {turns} turns: `when: [from, to]` picks one of them"
            ).format(load=load.name, turns=turns)


def _spans(problem: Problem) -> dict[str, tuple[float, str]]:
    """Of each link with several places a large distance of two points (of three points the largest), and which two."""
    found = {}
    for name, link in problem.linkage.links.items():
        points = list(link.points)
        if len(points) < 2:
            continue
        a = _farthest(link, points[0])
        b = _farthest(link, a)
        span = float(abs(link.points[a] - link.points[b]))
        if span > 0:
            found[name] = (span, "".join(sorted((a, b), key=points.index)))
    return found


def _farthest(link: Link, point: str) -> str:
    return max(link.points, key=lambda other: float(abs(link.points[other] - link.points[point])))


def _short(number: float) -> str:
    """Four figures, and all those before the point of a number that people would write so."""
    return f"{number:.0f}" if 1000 <= number < 1e6 else numeral(number, ".4g")
