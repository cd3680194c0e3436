"""Summary of a problem file before the calculation, and warnings about probable mistakes in it."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import combinations
from typing import Any

import numpy as np

from tmm_cli.language import _, numeral
from tmm_cli.mechanics.linkage import FRAME, Driver, Link, SpeedTable
from tmm_cli.mechanics.numerics import PARALLEL, to_float
from tmm_cli.mechanics.quantities import (
    ANGLE,
    ANGULAR_SPEED,
    FORCE,
    INERTIA,
    LENGTH,
    MASS,
    MOMENT,
    NUMBER,
    PRESSURE,
    SPEED,
    Dimension,
)
from tmm_cli.problem import Path, Problem, TaskProblem, Tree, UnitSystem, ValueReader, format_path, unused_parameters
from tmm_cli.reports.table import with_unit

SMALL, LARGE = 0.005, 50.0  # m: links of mechanisms are rarely outside
FAST_TURN, FAST_SLIDE = 1e5, 1e3  # rad/s, m/s: the quickest spindles turn half as fast
OVERSHOOT = 0.02  # of the range of a table: a smooth curve that goes beyond it by more is hardly meant
BULKY = 0.2  # of the largest link: a body of this radius of gyration is no point
SLENDER = 1 / 50  # of a link: a uniform rod has a radius of gyration of 0.29
HEAVY_CRANK = 10  # largest links: cheeks and a flywheel make the radius of gyration of a crank larger than the crank
FAR = 2  # largest links: a mechanism is hardly longer
HIGH_PRESSURE = 1e9  # Pa: no hydraulic or gas drive has such a pressure
LEAST_FLUCTUATION = 1e-3  # fluctuation of speed: the most uniform generators have 1/300
SAME_SPEED = 0.01  # relative: two speeds of one shaft that differ by less differ by rounding on paper
ANGULAR_SPEEDS: tuple[Path, ...] = (  # that a file may give beside those of drivers and of a run
    ("dynamics", "mean speed"),
    ("dynamics", "mean_speed"),
    ("dynamics", "motor", "free"),
    ("dynamics", "motor", "synchronous"),
    ("dynamics", "motor", "speed"),
    ("synthesis", "crank_speed"),
)


def summarise_file(task: Problem | TaskProblem) -> Iterable[str]:
    """Yield sentences on the units of a file, its drivers, the sizes of its links and loads, and gravity.

    The sentence on units comes first, because it does not depend on the dimensions that a synthesis finds.
    """
    yield describe_units(task.units)
    problem = task.whole
    if problem.source is not None and problem.source.given:
        yield _("values used instead of those in the file: {settings}").format(
            settings=", ".join(problem.source.given.values())
        )
    linkage = problem.linkage
    for driver in linkage.drivers:
        yield _("driver: link {link}, {motion}").format(link=driver.link, motion=describe_driver_motion(driver))
    sizes = "; ".join(_size_ranges(problem))
    yield (
        _("lengths: {sizes}; {gravity}").format(sizes=sizes, gravity=describe_gravity(linkage.gravity))
        if sizes
        else describe_gravity(linkage.gravity)
    )


def _size_ranges(problem: Problem) -> Iterator[str]:
    """Yield the ranges of all lengths, masses, forces, moments and pressures of a file as texts.

    Each text names the links or loads with the smallest and the largest value.
    """
    linkage = problem.linkage
    spans = sorted((span, points) for span, points in _link_spans(problem).values())
    if spans:
        (small, short), (large, long) = spans[0], spans[-1]
        yield _("from {small} ({short}) to {large} ({long})").format(
            small=with_unit(problem.units, small, LENGTH),
            short=short,
            large=with_unit(problem.units, large, LENGTH),
            long=long,
        )
    largest = [(load, max(map(abs, load.table.values)) if load.table is not None else 1.0) for load in linkage.loads]
    magnitudes = (
        (MASS, _("masses"), [(link.mass, name) for name, link in linkage.links.items()]),
        (FORCE, _("forces"), [(abs(load.force) * factor, load.name) for load, factor in largest]),
        (MOMENT, _("moments"), [(abs(load.moment) * factor, load.name) for load, factor in largest]),
        (PRESSURE, _("pressures"), [(pressure, str(path[1])) for path, pressure in _pressures(problem)]),
    )
    for dimension, title, values in magnitudes:
        present = sorted((float(to_float(value)), name) for value, name in values if value)
        if present:
            yield f"{title} {_range_text(problem, present, dimension)}"


def _range_text(problem: Problem, values: Sequence[tuple[float, str]], dimension: Dimension) -> str:
    """Return the least and the greatest of sorted values as text, with their names; one value if all are equal."""
    extremes = dict.fromkeys((values[0], values[-1]))
    ends = [f"{with_unit(problem.units, magnitude, dimension)} ({name})" for magnitude, name in extremes]
    if len(ends) == 1 or values[0][0] == values[-1][0]:
        return ends[0]
    return _("from {least} to {largest}").format(least=ends[0], largest=ends[1])


def _pressures(problem: Problem) -> Iterator[tuple[Path, float]]:
    """Yield the path in the file and the largest value (Pa) of each pressure, both of loads and of a piston that
    drives.
    """
    if problem.source is None or problem.values is None:
        return
    data = problem.source.data
    blocks: list[tuple[Path, Any]] = [(("loads", name), load) for name, load in (data.get("loads") or {}).items()]
    blocks = [((*path, "pressure"), load["pressure"]) for path, load in blocks if load.get("pressure")]
    drive = ((data.get("dynamics") or {}).get("run") or {}).get("drive")
    if isinstance(drive, dict) and drive.get("area") is not None:
        blocks.append((("dynamics", "run", "drive"), drive))
    for path, block in blocks:
        rows = [row[1] for row in block["table"]] if block.get("table") else [block["size"]]
        yield path, max(abs(float(to_float(problem.values.number(row, PRESSURE, path)))) for row in rows)


def describe_units(units: UnitSystem) -> str:
    """Return a sentence on the units of numbers that the file gives without a unit."""
    names = [units.spelt(dimension) for dimension in (LENGTH, ANGLE, MASS, FORCE, MOMENT, INERTIA)]
    return _("units of numbers given without a unit: {units}; of speeds: {angular} or {linear}").format(
        units=", ".join(names), angular=units.spelt(ANGULAR_SPEED), linear=units.spelt(SPEED)
    )


def describe_driver_motion(driver: Driver) -> str:
    """Return the speed and the direction of a driver as text: `70 rad/s = 668 rpm, counterclockwise`."""
    if driver.kind == "slide":
        text = (
            _("{speed} m/s, in the direction of its guide")
            if driver.sense > 0
            else _("{speed} m/s, opposite to the direction of its guide")
        )
        return text.format(speed=_short_number(driver.rate))
    if driver.law is not None:
        text = _(
            "from {low} to {high} rad/s = {least} to {most} rpm in the rows of the table, counterclockwise; {between}"
        )
        if driver.sense < 0:
            text = _(
                "from {low} to {high} rad/s = {least} to {most} rpm in the rows of the table, clockwise; {between}"
            )
        speeds = np.sqrt([float(to_float(square)) for square in driver.law.squares.values])
        low, high = float(speeds.min()), float(speeds.max())
        return text.format(
            low=_short_number(low),
            high=_short_number(high),
            least=_short_number(low * 30 / math.pi),
            most=_short_number(high * 30 / math.pi),
            between=describe_interpolation(driver.law),
        )
    text = _("{speed} rad/s = {turns} rpm, counterclockwise")
    if driver.sense < 0:
        text = _("{speed} rad/s = {turns} rpm, clockwise")
    return text.format(speed=_short_number(driver.rate), turns=_short_number(driver.rate * 30 / math.pi))


def describe_interpolation(law: SpeedTable) -> str:
    """Describe how a speed table is interpolated between its rows and where the accelerations come from."""
    if law.squares.between == "linear":
        text = _("constant acceleration between rows")
    elif law.squares.closed:
        text = _("periodic cubic spline of the squared speed, accelerations from its slope")
    else:
        text = _("natural cubic spline of the squared speed, accelerations from its slope")
    if law.accelerations is not None:
        text = _("spline of the squared speed; accelerations from a separate table")
        if law.squares.between == "linear":
            text = _("the squared speed is linear between rows; accelerations from a separate table")
    return text


def describe_gravity(pull: complex) -> str:
    """Return the magnitude and the direction of gravity as text."""
    if not pull:
        return _("no gravity")
    if pull.real == 0 > pull.imag:
        return _("gravity {size} m/s^2 downwards").format(size=numeral(-pull.imag, ".6g"))
    return _("gravity [{x}, {y}] m/s^2").format(x=numeral(pull.real, ".6g"), y=numeral(pull.imag, ".6g"))


def find_slips(problem: Problem) -> Iterable[str]:
    """Yield warnings about input data that are allowed but probably not intended."""
    data: Mapping[str, Any] = {} if problem.source is None else problem.source.data
    if problem.source is not None:
        yield from find_unused_parameters(problem.source, [path[1] for path in problem.source.given])
    yield from _bare_driver_speed(problem, data)
    if problem.values is not None:
        yield from find_bare_speeds(data, problem.values, problem.linkage.drivers)
        yield from _conflicting_speeds(problem, data)
        yield from _small_fluctuation(data, problem.values)
    for driver in problem.linkage.drivers:
        if driver.rate > (FAST_TURN if driver.kind == "turn" else FAST_SLIDE):
            yield _("the speed of the driver, {motion}, is higher than in real machines: is the unit correct?").format(
                motion=describe_driver_motion(driver)
            )
    yield from _unusual_sizes(problem)
    yield from _unusual_masses(problem, data)
    yield from _distant_points(problem)
    yield from _high_pressures(problem)
    yield from _coincident_sliders(problem)
    yield from _overshooting_tables(problem)
    yield from _several_strokes(problem)
    positions = data.get("positions", {})
    if "at" in positions and "count" in positions:
        yield _("positions: `count` has no effect, because `at` lists the positions: remove one of them")


def find_unused_parameters(tree: Tree, names: Iterable[Any]) -> Iterable[str]:
    """Yield a warning for each parameter in `names` that the file does not use."""
    for name in unused_parameters(tree, names):
        yield _("parameter {name} is not used in the file; its value has no effect").format(name=name)


def _bare_driver_speed(problem: Problem, data: Mapping[str, Any]) -> Iterable[str]:
    """Warn of a driver speed without a unit, which is read in rad/s or m/s, in a file with degrees or millimetres."""
    driver, units = problem.linkage.driver, problem.units
    named = {key.replace("_", " ") for key in data.get("units", {})}
    if not problem.bare_speed or not driver.rate:
        return
    fastest = driver.rate if driver.law is None else math.sqrt(max(driver.law.squares.values))  # that stands in a row
    if driver.kind == "turn" and units.factor(ANGLE) != 1 and "angular speed" not in named:
        yield _(
            "the speed of the driver has no unit and is read as {motion}, although angles are in {angle}: "
            "write `{speed} rad/s`, or `{speed} rpm` for revolutions per minute"
        ).format(motion=describe_driver_motion(driver), angle=units.spelt(ANGLE), speed=numeral(fastest, ".6g"))
    if driver.kind == "slide" and units.factor(LENGTH) != 1 and "speed" not in named:
        yield _(
            "the speed of the driver has no unit and is read as {speed} m/s, although lengths are in {length}: "
            "write `{speed} m/s`, or `{speed} {length}/s` if that is intended"
        ).format(length=units.spelt(LENGTH), speed=numeral(driver.rate, ".6g"))


def find_bare_speeds(data: Mapping[str, Any], values: ValueReader, drivers: Sequence[Driver] = ()) -> Iterator[str]:
    """Yield a warning for each speed without a unit in a file with degrees or millimetres.

    The speed of the first driver is not included: `find_slips` checks it separately.

    Args:
        data: content of the file.
        values: reader that converts numbers and units of the file to SI.
        drivers: drivers of the linkage; empty if the file has none.
    """
    units, named = values.units, {key.replace("_", " ") for key in data.get("units") or {}}
    slides = bool(drivers) and drivers[0].kind == "slide"
    speeds: list[tuple[Path, bool]] = [(path, False) for path in ANGULAR_SPEEDS]
    speeds += [(("dynamics", "run", "speed"), slides)]
    speeds += [(("driver", k, "speed"), driver.kind == "slide") for k, driver in enumerate(drivers) if k]
    for path, linear in speeds:
        base, dimension, kind = (LENGTH, SPEED, "speed") if linear else (ANGLE, ANGULAR_SPEED, "angular speed")
        value: Any = data
        for key in path:
            present = isinstance(value, list) or (isinstance(value, dict) and key in value)
            value = value[key] if present else None
        scalar = value is not None and not isinstance(value, dict)
        if not scalar or units.factor(base) == 1 or kind in named or not values.is_bare(value):
            continue
        speed = float(to_float(values.number(value, dimension, path)))
        if not speed:  # rest is rest in any unit
            continue
        text = _(
            "{key} has no unit and is read as {speed} rad/s = {turns} rpm, although angles are in {unit}: "
            "write `{written} rad/s`, or `{written} rpm` for revolutions per minute"
        )
        if linear:
            text = _(
                "{key} has no unit and is read as {speed} m/s, although lengths are in {unit}: write `{written} "
                "m/s`, or `{written} {unit}/s` if that is intended"
            )
        yield text.format(
            key=format_path(path),
            speed=_short_number(speed),
            turns=_short_number(speed * 30 / math.pi),
            unit=units.spelt(base),
            written=numeral(speed, ".6g"),
        )


def _conflicting_speeds(problem: Problem, data: Mapping[str, Any]) -> Iterator[str]:
    """Warn if the mean speed of the law of motion differs from the speed of the driver."""
    task, speed = problem.dynamics, float(to_float(problem.linkage.driver.rate))
    mean = getattr(task, "mean", None)
    if mean is None or not speed or not {"mean speed", "mean_speed"} & set(data.get("dynamics") or {}):
        return
    mean = float(to_float(mean))
    if abs(mean / speed - 1) > SAME_SPEED:
        yield _(
            "dynamics.mean speed is {mean} rad/s = {mean_rpm} rpm, but the speed of the driver is {speed} "
            "rad/s = {speed_rpm} rpm: the law of motion uses the mean speed; give only one of them, or equal "
            "values"
        ).format(
            mean=_short_number(mean),
            mean_rpm=_short_number(mean * 30 / math.pi),
            speed=_short_number(speed),
            speed_rpm=_short_number(speed * 30 / math.pi),
        )


def _small_fluctuation(data: Mapping[str, Any], values: ValueReader) -> Iterator[str]:
    """Warn of an unusually small coefficient of fluctuation, probably a percentage that was divided by 100 twice."""
    written = (data.get("dynamics") or {}).get("delta")
    if written is None:
        return
    delta = float(to_float(values.number(written, NUMBER, ("dynamics", "delta"))))
    if delta < LEAST_FLUCTUATION:
        yield _(
            "dynamics.delta is {written} = 1/{parts}; usual values are 1/5 to 1/300: write `{hundredfold}`, or "
            "`{per_cent} %`, if that is intended"
        ).format(
            written=written,
            parts=f"{1 / delta:.0f}",
            hundredfold=numeral(100 * delta, ".6g"),
            per_cent=numeral(1e4 * delta, ".6g"),
        )


def _distant_points(problem: Problem) -> Iterator[str]:
    """Warn of centres of mass, points of application and ends of elements that lie implausibly far from their link."""
    linkage = problem.linkage
    longest_span, longest = max(_link_spans(problem).values(), default=(math.inf, ""))
    points_of_links: list[tuple[str, str, complex]] = [
        (f"masses.{name}", name, link.centre) for name, link in linkage.links.items() if link.mass
    ]
    points_of_links += [(f"loads.{load.name}", load.link, load.at) for load in linkage.loads if load.force]
    for element in linkage.elements:
        points_of_links += [(f"{element.block}.{element.name}", end.link, end.at) for end in element.ends]
    for key, link, at in points_of_links:
        distances = [float(abs(point - at)) for point in linkage.links[link].points.values()]
        distance = min(distances, default=0.0)
        if distance > FAR * longest_span:
            sentence = _(
                "{key}: this point is at least {distance} from every point of link {link}, which is more than the "
                "size of the mechanism (its largest link is {points}, {size}): is the unit correct? A length "
                "without a unit is in {unit}"
            ).format(
                key=key,
                distance=with_unit(problem.units, distance, LENGTH),
                link=link,
                points=longest,
                size=with_unit(problem.units, longest_span, LENGTH),
                unit=problem.units.spelt(LENGTH),
            )
            names = "".join(list(linkage.links[link].points)[:2])
            share = _("{slip}; a fraction of the length is written {{on: {points}, at: 50 %}}").format(
                slip=sentence, points=names
            )
            yield share if len(distances) > 1 else sentence


def _high_pressures(problem: Problem) -> Iterator[str]:
    """Warn of implausibly high pressures: probably pascals written without a unit, which are read in megapascals."""
    for path, pressure in _pressures(problem):
        if pressure > HIGH_PRESSURE:
            yield _(
                "{key} is {pressure}, more than 1000 MPa: is the unit correct? Write `{number} Pa` for pascals"
            ).format(
                key=format_path(path),
                pressure=with_unit(problem.units, pressure, PRESSURE),
                number=numeral(problem.units.from_si(pressure, PRESSURE), ".6g"),
            )


def _unusual_sizes(problem: Problem) -> Iterable[str]:
    for link, (span, points) in _link_spans(problem).items():
        length = with_unit(problem.units, span, LENGTH)
        if span > LARGE:
            yield _("length {points} is {size}, more than 50 m: is the unit correct?").format(
                points=points, size=length
            )
        elif span < SMALL and link != FRAME:
            yield _("length {points} is {size}, less than 5 mm: is the unit correct?").format(
                points=points, size=length
            )


def _unusual_masses(problem: Problem, data: Mapping[str, Any]) -> Iterable[str]:
    """Warn of moments of inertia that do not fit the size of a link, and of large sliders without a centre of mass.

    Without a given centre the mass of a slider is placed at its point.
    """
    linkage, spans = problem.linkage, _link_spans(problem)
    largest = max((span for span, points in spans.values()), default=math.inf)
    wheels = {link for mesh in linkage.meshes for link in (mesh.i, mesh.j)}
    cranks = {driver.link for driver in linkage.cranks if driver.kind == "turn"}
    runners = {slide.runner for slide in linkage.slides}
    for name, keys in data.get("masses", {}).items():
        link = linkage.links[name]
        if not link.mass or not link.inertia:
            continue
        radius = math.sqrt(link.inertia / link.mass)
        radius_text = with_unit(problem.units, radius, LENGTH)
        allowed = HEAVY_CRANK * largest if name in cranks else spans[name][0] if name in spans else math.inf
        if name in spans and name not in wheels and radius > allowed:
            yield _(
                "masses.{link}: the radius of gyration sqrt(I/m) is {radius}, larger than the link itself "
                "({points}, {size}): is the unit of the moment of inertia correct?"
            ).format(
                link=name,
                radius=radius_text,
                points=spans[name][1],
                size=with_unit(problem.units, spans[name][0], LENGTH),
            )
        elif name in spans and radius < SLENDER * spans[name][0] <= SLENDER * LARGE:
            yield _(
                "masses.{link}: the radius of gyration sqrt(I/m) is {radius}, less than 1/50 of the link "
                "({points}, {size}): is the unit of the moment of inertia correct? For a uniform rod I = {inertia}"
            ).format(
                link=name,
                radius=radius_text,
                points=spans[name][1],
                size=with_unit(problem.units, spans[name][0], LENGTH),
                inertia=with_unit(problem.units, link.mass * spans[name][0] ** 2 / 12, INERTIA, 3),
            )
        elif name not in spans and name in runners and keys.get("centre") is None and radius > BULKY * largest:
            yield _(
                "masses.{link}: no centre is given, so the mass is placed at {point}, although its radius of "
                "gyration sqrt(I/m) is {radius}: write centre: [x, y], or centre: {point} if that is intended"
            ).format(link=name, point=next(iter(link.points)), radius=radius_text)


def _coincident_sliders(problem: Problem) -> Iterator[str]:
    """Warn of two links that share a point and slide in the same direction on a third link, so that they move as one
    body.
    """
    linkage = problem.linkage
    for a, b in combinations(linkage.slides, 2):
        for base in sorted({a.carrier, a.runner} & {b.carrier, b.runner}):
            links = [slide.runner if slide.carrier == base else slide.carrier for slide in (a, b)]
            # a guide as the base sees it
            angles = [slide.direction - (0.0 if slide.carrier == base else slide.turned) for slide in (a, b)]
            points = [h.point for h in linkage.hinges if links[0] != links[1] and set(links) <= set(h.links)]
            if points and abs(math.sin(angles[0] - angles[1])) < PARALLEL:
                yield _(
                    "links {a} and {b} move as one slider: both contain point {point} and slide in the same direction "
                    "on {base}. Remove one of them"
                ).format(
                    a=links[0],
                    b=links[1],
                    point=points[0],
                    base=_("the frame") if base == FRAME else _("link {link}").format(link=base),
                )


def _overshooting_tables(problem: Problem) -> Iterable[str]:
    """Warn of load tables whose smooth interpolation curve goes far beyond the values in the rows."""
    for load in problem.linkage.loads:
        row, share = load.table.overshoot if load.table is not None else (0, 0.0)
        if share > OVERSHOOT:
            yield _(
                "load {load}: between rows {row} and {next} of its table the smooth curve goes beyond the values "
                "of all rows by {share} % of their range: write `between: linear`, or add rows there"
            ).format(load=load.name, row=row + 1, next=row + 2, share=numeral(100 * share, ".3g"))


def _several_strokes(problem: Problem) -> Iterable[str]:
    """Warn of loads that act several times in a cycle of several revolutions, once in every working stroke."""
    turns = problem.linkage.turns
    for load in problem.linkage.loads if turns > 1 else ():
        if load.working_stroke_only:
            yield _(
                "load {load} acts in every working stroke of the cycle (turns: {turns}): select one of them with "
                "`when: [from, to]`"
            ).format(load=load.name, turns=turns)


def _link_spans(problem: Problem) -> dict[str, tuple[float, str]]:
    """Return for each link the largest distance (m) between two of its points, and the names of these points.

    For a link with more than three points the distance is approximate.
    """
    spans = {}
    for name, link in problem.linkage.links.items():
        points = list(link.points)
        if len(points) < 2:
            continue
        a = _farthest_point(link, points[0])
        b = _farthest_point(link, a)
        span = float(abs(link.points[a] - link.points[b]))
        if span > 0:
            spans[name] = (span, "".join(sorted((a, b), key=points.index)))
    return spans


def _farthest_point(link: Link, point: str) -> str:
    return max(link.points, key=lambda other: float(abs(link.points[other] - link.points[point])))


def _short_number(number: float) -> str:
    """Return a number as text with four significant figures; a number from 1000 to a million as an integer."""
    return f"{number:.0f}" if 1000 <= number < 1e6 else numeral(number, ".4g")
