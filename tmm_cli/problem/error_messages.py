"""Messages for errors raised by the package mechanics, each with the key of the file that causes the error.

There is one function for each error class.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from functools import singledispatch

from tmm_cli.language import _, numeral
from tmm_cli.mechanics.errors import (
    AmbiguousSketchError,
    AssemblyError,
    ChangePointSearchError,
    CounterweightError,
    GroupTooLargeError,
    LinkageError,
    LongRunError,
    LostDigitsError,
    MissingStrokesError,
    MobilityError,
    NoCycleError,
    NoFlywheelError,
    NoInertiaError,
    NotOnFrameError,
    NoTurnError,
    OutOfRangeError,
    RunawayError,
    SettingError,
    SketchMismatchError,
    SpeedDependentForceError,
    SpeedTableError,
    StandstillError,
    TableBeyondCycleError,
    UnknownNameError,
    UnknownPositionError,
    WeakMotorError,
)
from tmm_cli.mechanics.quantities import ANGLE, ANGULAR_SPEED, LENGTH, MOMENT, coordinate_dimension
from tmm_cli.problem.errors import ProblemError, quote, unknown_name_error, unknown_position_error
from tmm_cli.problem.mobility_errors import list_loose_ends, mobility_error
from tmm_cli.problem.problems import Problem
from tmm_cli.problem.units import UnitSystem


@singledispatch
def problem_error(error: LinkageError, problem: Problem) -> ProblemError:
    """Convert an error of mechanics to a ProblemError with the path of the key, not yet with line and column."""
    return ProblemError(str(error))


def format_coordinate(value: complex | float, units: UnitSystem) -> str:
    """Format a point (complex, m) or an angle (rad) in the units of the file."""
    if isinstance(value, complex):
        return f"[{units.from_si(value.real, LENGTH):.6g}, {units.from_si(value.imag, LENGTH):.6g}]"
    return units.format_value(value, ANGLE)


# Mobility and assembly.


MAX_CHOICES = 4  # points and angles listed that distinguish two assemblies; a large group has many


def _driver_at(problem: Problem) -> str:
    """Format the driver coordinate of the sketch for a message."""
    return problem.units.format_value(problem.linkage.sketch.at, coordinate_dimension(problem.linkage.driver.kind))


@problem_error.register
def _never_closes(error: AssemblyError, problem: Problem) -> ProblemError:
    short = _("the loop does not close at any position")
    if error.residual is not None:
        short = _("the loop does not close: the gap is {size}").format(
            size=problem.units.format_value(error.residual, LENGTH)
        )
    return ProblemError(
        _("group {group} cannot be assembled when the driver coordinate is {place}").format(
            group=error.group.title, place=_driver_at(problem)
        ),
        path=("sketch", "at"),
        found=short,
        allowed=_("lengths with which the links can be joined, or another driver coordinate"),
    )


@problem_error.register
def _ambiguous(error: AmbiguousSketchError, problem: Problem) -> ProblemError:
    group, place, units = error.group.title, _driver_at(problem), problem.units
    if not error.choices:
        return ProblemError(
            _("in the sketch group {group} is in a dead position").format(group=group),
            path=("sketch", "at"),
            found=place,
            allowed=_("another driver coordinate"),
        )
    choices = list(error.choices.items())[:MAX_CHOICES]
    ways = "; ".join(
        f"{name}: {format_coordinate(a, units)} or {format_coordinate(b, units)}" for name, (a, b) in choices
    )
    undecided = _(
        "the sketch does not determine the assembly of group {group}; to see all assemblies, run tmm "
        "kinematics {file} --assemblies"
    ).format(group=group, file=problem.file or "FILE")
    return ProblemError(
        undecided,
        path=("sketch",),
        key=True,
        allowed=_("add one of these to the sketch for the driver coordinate {place}: {ways}").format(
            place=place, ways=ways
        ),
    )


@problem_error.register
def _no_such_assembly(error: SketchMismatchError, problem: Problem) -> ProblemError:
    return ProblemError(
        _("the sketch does not match any assembly of the mechanism"),
        path=("sketch", error.name),
        found=format_coordinate(error.sketched, problem.units),
        allowed=_("about {value} when the driver coordinate is {place}").format(
            value=format_coordinate(error.found, problem.units), place=_driver_at(problem)
        ),
    )


@problem_error.register
def _too_large(error: GroupTooLargeError, problem: Problem) -> ProblemError:
    return ProblemError(
        _("this group has too many links to be solved: {title}").format(title=error.group.title),
        path=("links",),
        found=str(len(error.group.links)),
        allowed=_("at most {most} links in one group; any number of groups").format(most=error.most),
        key=True,
    )


@problem_error.register
def _searched_too_long(error: ChangePointSearchError, problem: Problem) -> ProblemError:
    return ProblemError(
        _(
            "the search for the change points of group {title} would take too long, as the group depends on "
            "too many others"
        ).format(title=error.group.title),
        path=("links",),
        key=True,
        found=_("groups: {groups}, turns of the driver: {turns}").format(groups=error.groups, turns=error.turns),
        allowed=_("a product of the two numbers of at most {most}").format(most=error.most),
    )


@problem_error.register
def _immobile(error: MobilityError, problem: Problem) -> ProblemError:
    lone = list_loose_ends(problem.linkage, error.structure.under_constrained)
    hint = _("point {point} belongs only to link {link}; for a hinge on the frame write points: {{{point}: [x, y]}}")
    return mobility_error(error.structure, [hint.format(point=point, link=link) for link, point in lone[:1]])


# Strokes, cycles and the range of the driver.


@problem_error.register
def _no_strokes(error: MissingStrokesError, problem: Problem) -> ProblemError:
    block, *__, key = error.path
    if block == "intermittent" and key == "moves_with":
        return ProblemError(
            _("this link never reverses its rotation, so the wheel would never come to rest"),
            path=error.path,
            found=quote(error.link),
            allowed=_("a link that swings (a rocker)"),
        )
    text = _("this mechanism has no working stroke")
    if block == "intermittent":
        return ProblemError(
            text, path=error.path, allowed=_("forward, backward, or another output link, one that has strokes")
        )
    if error.limits is not None:
        first, last = (format_coordinate(limit, problem.units) for limit in error.limits)
        return ProblemError(
            _(
                "a load table with `against: stroke` requires a driver that rotates fully, so that the output "
                "makes full strokes"
            ),
            path=error.path,
            found=_("the driver moves from {first} to {last}").format(first=first, last=last),
            allowed=_("against: crank angle"),
        )
    missing = _("no output link is joined to the frame")
    if error.link is not None:
        missing = _("link {link} has no extreme positions").format(link=error.link)
    return ProblemError(
        text, path=error.path, found=missing, allowed=_("an output link that has a stroke (see the key `output`)")
    )


@problem_error.register
def _speeds_end(error: SpeedTableError, problem: Problem) -> ProblemError:
    first, last, end = (
        format_coordinate(x, problem.units) for x in (error.first, error.last, error.first + error.cycle)
    )
    ends = _("the table covers {first} to {last}").format(first=first, last=last)
    if error.at is not None:
        ends = _("{ends}, but a position is requested at {place}").format(
            ends=ends, place=format_coordinate(error.at, problem.units)
        )
    closing = _(
        "a last row at {end} with the speed of the first row, or positions: {{at: [...]}} within the range of the table"
    )
    return ProblemError(
        _("the table of speeds does not cover all positions"),
        path=("driver", "speed", "table"),
        key=True,
        found=ends,
        allowed=closing.format(end=end),
    )


@problem_error.register
def _no_turn(error: NoTurnError, problem: Problem) -> ProblemError:
    full = _("for a cycle of several turns ({turns}) the crank must rotate fully").format(turns=error.turns)
    return ProblemError(full, path=("cycle",), key=True)


@problem_error.register
def _no_cycle(error: NoCycleError, problem: Problem) -> ProblemError:
    message = _("the law of motion is computed only for a single crank that rotates fully")
    allowed = _("a single driver that rotates fully")
    if error.path[0] == "balancing":
        message = _("shaking force and moment are computed only for a single crank that rotates fully")
    if error.path[0] == "intermittent":
        message = _("intermittent motion is computed over a cycle, but this driver has no cycle")
        fit = _("a crank that rotates fully, or a driver with a stroke that the mechanism can complete")
        allowed = f"{fit}; driver: {{stroke: [0, 100]}}"
    return ProblemError(message, path=error.path, key=True, allowed=allowed)


@problem_error.register
def _out_of_range(error: OutOfRangeError, problem: Problem) -> ProblemError:
    first, last = format_coordinate(error.start, problem.units), format_coordinate(error.end, problem.units)
    return ProblemError(
        _("the run extends beyond the range of the driver"),
        path=("dynamics", "run"),
        key=True,
        allowed=_("{first} to {last}").format(first=first, last=last),
    )


@problem_error.register
def _beyond_cycle(error: TableBeyondCycleError, problem: Problem) -> ProblemError:
    turns, units = round(error.cycle / (2 * math.pi)), problem.units
    text = _("this row is never used: the motion repeats after several turns of the driver, number of turns: {turns}")
    if turns == 1:
        text = _("this row is never used: the motion repeats after one turn of the driver")
    allowed = _("0 to {end} {unit}; if the loads repeat after a longer cycle, write cycle: {turns} turns").format(
        end=f"{units.from_si(error.cycle, ANGLE):.6g}",
        unit=units.spelt(ANGLE),
        turns=max(2, math.ceil(error.argument / math.tau)),
    )
    return ProblemError(
        text.format(turns=turns), path=error.path, found=format_coordinate(error.argument, units), allowed=allowed
    )


# Laws of motion and balancing.


@problem_error.register
def _unsettled(error: CounterweightError, problem: Problem) -> ProblemError:
    return ProblemError(
        _(
            "counterweights with these radii cannot balance the mechanism: the inertia forces of their own "
            "masses exceed those that they balance"
        ),
        path=("balancing", "counterweights"),
        key=True,
        allowed=_("larger radii, or other points of the links for `about`"),
    )


@problem_error.register
def _by_speed(error: SpeedDependentForceError, problem: Problem) -> ProblemError:
    return ProblemError(
        _("the law of motion is not computed if forces depend on reactions or on speeds"),
        path=error.path,
        key=True,
        allowed=_(
            "loads that depend neither on reactions nor on speeds; for a constant friction force write force: "
            "{resists: 200 N}"
        ),
    )


@problem_error.register
def _long_run(error: LongRunError, problem: Problem) -> ProblemError:
    reason = _("the run takes too long to compute: the time reached after {count} evaluations is {time} s")
    return ProblemError(
        reason.format(count=error.count, time=f"{error.time:.4g}"),
        path=("dynamics", "run"),
        allowed=_("a shorter run, or moments of inertia that vary less during the run"),
    )


@problem_error.register
def _standstill(error: StandstillError, problem: Problem) -> ProblemError:
    if problem.dynamics is not None and not problem.dynamics.cyclic:
        return ProblemError(
            _("the machine does not start: the driving moment or force does not exceed the loads"),
            path=("dynamics", "run"),
            key=True,
            allowed=_("a larger `drive` (positive along the guide or counterclockwise), or an initial `speed`"),
        )
    return ProblemError(
        _("the machine stops before the end of the cycle: the driving moment cannot overcome the load"),
        path=("dynamics",),
        key=True,
        found=_("driver coordinate: {place}").format(place=format_coordinate(error.place, problem.units)),
        allowed=_("a heavier flywheel, a higher speed, or a stronger motor"),
    )


@problem_error.register
def _no_inertia(error: NoInertiaError, problem: Problem) -> ProblemError:
    return ProblemError(
        _("the law of motion cannot be computed: no link that moves in this position has mass or moment of inertia"),
        path=("dynamics", "run") if hasattr(problem.dynamics, "speed") else ("dynamics",),
        key=True,
        found=_("driver coordinate: {place}").format(place=format_coordinate(error.place, problem.units)),
        allowed=_("masses of the links, or flywheel: {inertia: 0.5}"),
    )


@problem_error.register
def _lost_digits(error: LostDigitsError, problem: Problem) -> ProblemError:
    return ProblemError(
        _(
            "the law of motion cannot be computed because of rounding errors: the links and the flywheel are "
            "too heavy for the motor to change their speed"
        ),
        path=("dynamics",),
        key=True,
        found=_("fraction of a speed difference that the motor makes up in one cycle: {share}").format(
            share=numeral(error.share, ".1g")
        ),
        allowed=_("masses and moments of inertia that suit the motor; check their units"),
    )


@problem_error.register
def _runaway(error: RunawayError, problem: Problem) -> ProblemError:
    units, unit = problem.units, problem.units.spelt(MOMENT)
    described = _(
        "mean moment with which the loads drive the crank: {moment} {unit}, largest at driver coordinate "
        "{place}; largest braking moment of the motor: {most} {unit}"
    )
    allowed = _("a motor with a larger braking moment, a larger ratio, or smaller loads")
    if not math.isnan(error.speed):
        described = _(
            "{speed} at driver coordinate {place} and still increasing, no-load speed {idle}; mean moment with "
            "which the loads drive the crank: {moment} {unit}, largest braking moment of the motor: {most} {unit}"
        )
        allowed = _("a heavier flywheel, a stronger motor, or smaller loads")
    return ProblemError(
        _("the loads drive the machine and the motor cannot brake it: its speed increases without limit"),
        path=("dynamics", "motor"),
        key=True,
        allowed=allowed,
        found=described.format(
            moment=f"{units.from_si(error.pushing, MOMENT):.4g}",
            unit=unit,
            most=f"{units.from_si(error.most, MOMENT):.4g}",
            place=format_coordinate(error.place, units),
            speed=units.format_value(error.speed, ANGULAR_SPEED, 4),
            idle=units.format_value(error.idle, ANGULAR_SPEED, 4),
        ),
    )


@problem_error.register
def _weak_motor(error: WeakMotorError, problem: Problem) -> ProblemError:
    units, unit = problem.units, problem.units.spelt(MOMENT)
    return ProblemError(
        _(
            "the motor cannot overcome the load: the mean moment of the load over the cycle exceeds the "
            "largest moment of the motor"
        ),
        path=("dynamics", "motor"),
        key=True,
        found=_(
            "largest moment of the motor, reduced to the driver: {moment} {unit}; the load is largest at "
            "driver coordinate {place}"
        ).format(
            moment=f"{units.from_si(error.most, MOMENT):.4g}", unit=unit, place=format_coordinate(error.place, units)
        ),
        allowed=_("more than {moment} {unit}, the mean over the cycle: a stronger motor or a larger ratio").format(
            moment=f"{units.from_si(error.wanted, MOMENT):.4g}", unit=unit
        ),
    )


@problem_error.register
def _no_flywheel(error: NoFlywheelError, problem: Problem) -> ProblemError:
    text, allowed = _("with this motor no flywheel achieves this coefficient of fluctuation"), _("a larger `delta`")
    if not math.isnan(error.own):
        text = _("the coefficient of fluctuation is smaller than this even without a flywheel")
        allowed = _("less than {own}, or omit `delta`").format(own=f"{error.own:.4g}")
        if problem.dynamics is not None and problem.dynamics.flywheel:
            text = _("with the given flywheel the coefficient of fluctuation is already smaller than this")
    return ProblemError(text, path=("dynamics", "delta"), found=f"{error.wanted:.6g}", allowed=allowed)


# Unknown names and numbers, and errors of one setting of several.


@problem_error.register
def _position(error: UnknownPositionError, problem: Problem) -> ProblemError:
    return unknown_position_error(error.number, error.count, "positions")


@problem_error.register
def _name(error: UnknownNameError, problem: Problem) -> ProblemError:
    message = _("there is no point, link or centre of mass of that name")
    return unknown_name_error(error.name, error.allowed, message, path=("links",), key=True)


@problem_error.register
def _on_frame(error: NotOnFrameError, problem: Problem) -> ProblemError:
    message = _("this link cannot be the driver: it is not joined to the frame")
    return unknown_name_error(error.link, error.allowed, message, path=("links",), key=True)


@problem_error.register
def _setting(error: SettingError, problem: Problem) -> ProblemError:
    inner = problem_error(error.error, problem)
    return ProblemError(inner.message, path=error.path, found=inner.found, allowed=inner.allowed)


@contextmanager
def translate_errors(problem: Problem) -> Iterator[None]:
    """Context manager that converts errors of mechanics to ProblemErrors in the terms of the file, with line and
    column.
    """
    try:
        yield
    except LinkageError as error:
        raise located_problem_error(error, problem) from None


def located_problem_error(error: LinkageError, problem: Problem) -> ProblemError:
    """Convert an error of mechanics to a ProblemError with line and column in the file."""
    refusal = problem_error(error, problem)
    return refusal.located(problem.file, problem.source) if problem.file else refusal
