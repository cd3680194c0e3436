"""What a stage refuses, in the words and at the place of the file."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager

from tmm_cli.errors import (
    AmbiguousSketchError,
    AssemblyError,
    BySpeedError,
    GroupTooLargeError,
    LinkageError,
    LongRunError,
    MissingStrokesError,
    MobilityError,
    NoCycleError,
    NoFlywheelError,
    NotOnFrameError,
    NoTurnError,
    OutOfRangeError,
    RunawayError,
    SettingError,
    SketchMismatchError,
    SpeedsEndError,
    StandstillError,
    TableBeyondCycleError,
    UnknownNameError,
    UnknownPositionError,
    UnsettledError,
    WeakMotorError,
)
from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, no_position, quote, unknown_name
from tmm_cli.problem.record import Problem
from tmm_cli.quantities import ANGLE, ANGULAR_SPEED, LENGTH, MOMENT, place_dimension
from tmm_cli.structure.assur import Structure

MOST_CHOICES = 4  # points and angles that would tell two assemblies apart are many in a large group


@contextmanager
def in_words_of(problem: Problem) -> Iterator[None]:
    """What a stage refuses inside is said in the terms of the file. Raises ProblemError."""
    try:
        yield
    except LinkageError as error:
        raise refusal(error, problem) from None


def refusal(error: LinkageError, problem: Problem) -> ProblemError:
    """A stage's refusal in the words and at the place of the file."""
    found = _stage_error(error, problem)
    return found.located(problem.file, problem.source) if problem.file else found


def _stage_error(error: LinkageError, problem: Problem) -> ProblemError:
    units = problem.units

    def shown(value: complex | float) -> str:
        if isinstance(value, complex):
            return f"[{units.from_si(value.real, LENGTH):.6g}, {units.from_si(value.imag, LENGTH):.6g}]"
        return units.told(value, ANGLE)

    place = units.told(problem.linkage.sketch.at, place_dimension(problem.linkage.driver.kind))
    match error:
        case MobilityError(structure=structure):
            return mobility(structure)
        case AssemblyError(group=group, residual=residual):
            short = _("it never closes")
            if residual is not None:
                short = _("{size} short of closing").format(size=units.told(residual, LENGTH))
            return ProblemError(
                _("group {group} cannot be assembled with the driver at {place}").format(
                    group=group.title, place=place
                ),
                path=("sketch", "at"), found=short, allowed=_("lengths that reach, or another place of the driver"),
            )  # fmt: skip
        case AmbiguousSketchError(group=group, choices=choices) if choices:
            told = list(choices.items())[:MOST_CHOICES]
            ways = "; ".join(f"{name}: {shown(a)} or {shown(b)}" for name, (a, b) in told)
            undecided = _(
                "the sketch does not say how group {group} is assembled; see tmm kinematics {file} --assemblies"
            ).format(group=group.title, file=problem.file or "FILE")
            return ProblemError(
                undecided, path=("sketch",), key=True,
                allowed=_("with the driver at {place}, {ways}").format(place=place, ways=ways),
            )  # fmt: skip
        case AmbiguousSketchError(group=group):
            return ProblemError(
                _("group {group} is in a dead position in the sketch").format(group=group.title),
                path=("sketch", "at"), found=place, allowed=_("another place of the driver"),
            )  # fmt: skip
        case SketchMismatchError(name=name, sketched=sketched, found=value):
            return ProblemError(
                _("the sketch fits no assembly"), path=("sketch", name), found=shown(sketched),
                allowed=_("about {value} with the driver at {place}").format(value=shown(value), place=place),
            )  # fmt: skip
        case GroupTooLargeError(group=group, most=most):
            return ProblemError(
                _("a group of so many links is not solved: {title}").format(title=group.title), path=("links",),
                found=str(len(group.links)),
                allowed=_("at most {most} in one group; any number of groups").format(most=most), key=True,
            )  # fmt: skip
        case UnknownPositionError(number=number, count=count):
            return no_position(number, count, "positions")
        case UnknownNameError(name=name, allowed=allowed):
            what = _("there is no such point, link or centre of mass")
            return unknown_name(name, allowed, what, path=("links",), key=True)
        case NotOnFrameError(link=link, allowed=allowed):
            what = _("this link cannot drive: it is not joined to the frame")
            return unknown_name(link, allowed, what, path=("links",), key=True)
        case SettingError(path=path, error=own):
            within = _stage_error(own, problem)
            return ProblemError(within.message, path=path, found=within.found, allowed=within.allowed)
        case MissingStrokesError(link=link, path=("intermittent", *__, "moves_with") as path):
            return ProblemError(
                _("this link never turns back: the wheel would not stand"), path=path, found=quote(link),
                allowed=_("a link that swings"),
            )  # fmt: skip
        case MissingStrokesError(path=("intermittent", *__) as path):
            return ProblemError(
                _("there is no working stroke"),
                path=path,
                allowed=_("forward, backward, or an output that has strokes"),
            )
        case MissingStrokesError(link=link, path=path):
            what = _("no output is joined to the frame")
            if link is not None:
                what = _("link {link} has no ends of its stroke").format(link=link)
            return ProblemError(_("there is no working stroke"), path=path, found=what, allowed=_("see output:"))
        case SpeedsEndError(at=missed, first=first, last=last, cycle=cycle):
            ends = _("the table goes from {first} to {last}").format(first=shown(first), last=shown(last))
            if missed is not None:
                ends = _("{ends}, a position is at {place}").format(ends=ends, place=shown(missed))
            closing = _("a last row at {end} with the speed of the first, or positions: {{at: [...]}} within it")
            return ProblemError(
                _("the table of speeds does not reach over all positions"), path=("driver", "speed", "table"), key=True,
                found=ends, allowed=closing.format(end=shown(first + cycle)),
            )  # fmt: skip
        case NoTurnError(turns=turns):
            full = _("a cycle of {turns} turns needs a crank that turns fully").format(turns=turns)
            return ProblemError(full, path=("cycle",), key=True)
        case NoCycleError(path=path):
            wanted = _("a law of motion is found for one crank that turns fully")
            if path == ("balancing",):
                wanted = _("what shakes is found for one crank that turns fully")
            if path[0] == "intermittent":
                fit = _("a crank that turns fully, or a driver with a stroke that the linkage can go")
                wanted = _("intermittent motion is found over a cycle, and the driver has none")
                return ProblemError(wanted, path=path, key=True, allowed=f"{fit}; driver: {{stroke: [0, 100]}}")
            return ProblemError(
                wanted, path=path, key=True, allowed=_("one driver that turns round and round"),
            )  # fmt: skip
        case UnsettledError():
            return ProblemError(
                _("counterweights of these radii balance nothing: their masses load the pivots that they move with"),
                path=("balancing", "counterweights"), key=True, allowed=_("larger radii, or other points of the links"),
            )  # fmt: skip
        case OutOfRangeError(start=first, end=last):
            return ProblemError(
                _("the run goes where the driver does not come"), path=("dynamics", "run"), key=True,
                allowed=_("{first} to {last}").format(first=shown(first), last=shown(last)),
            )  # fmt: skip
        case BySpeedError(path=path):
            return ProblemError(
                _("a law of motion is not found where forces hang on reactions or on speeds"), path=path, key=True,
                allowed=_("loads that do not: force: {resists: 200 N} for a constant friction"),
            )  # fmt: skip
        case LongRunError(time=time, count=count):
            reason = _("the run is not computed to its end: after {count} evaluations it has come to {time} s")
            return ProblemError(
                reason.format(count=count, time=f"{time:.4g}"), path=("dynamics", "run"),
                allowed=_("a shorter run, or inertias that differ less on the way"),
            )  # fmt: skip
        case StandstillError() if problem.dynamics is not None and not problem.dynamics.cyclic:
            return ProblemError(
                _("the run does not start: what drives is no more than the loads"), path=("dynamics", "run"), key=True,
                allowed=_("a larger drive, or a speed at the beginning"),
            )  # fmt: skip
        case StandstillError(place=place_of_rest):
            return ProblemError(
                _("the machine comes to rest before its cycle ends: what drives it cannot carry the load"),
                path=("dynamics",), key=True,
                found=_("at {place} of the driver's way").format(place=shown(place_of_rest)),
                allowed=_("a heavier flywheel, a higher speed, a stronger motor"),
            )  # fmt: skip
        case RunawayError(pushing=pushing, most=most) as away:
            unit, held = units.spelt(MOMENT), f"{units.from_si(most, MOMENT):.4g}"
            found = _(
                "{moment} {unit} in the mean push the driver, most at {place} of its way; its motor holds {most} "
                "{unit} at its best"
            )
            wanted = _("a motor that holds more, a larger ratio, smaller loads")
            if not math.isnan(away.speed):
                found = _(
                    "{speed} at {place} of the driver's way and still quicker, without load {idle}; {moment} "
                    "{unit} in the mean push the driver, its motor holds {most} {unit} at its best"
                )
                wanted = _("a heavier flywheel, a stronger motor, smaller loads")
            return ProblemError(
                _("the loads push the machine on, and its motor does not hold it: it runs away"),
                path=("dynamics", "motor"), key=True, allowed=wanted,
                found=found.format(moment=f"{units.from_si(pushing, MOMENT):.4g}", unit=unit, most=held,
                                   place=shown(away.place), speed=units.told(away.speed, ANGULAR_SPEED, 4),
                                   idle=units.told(away.idle, ANGULAR_SPEED, 4)),
            )  # fmt: skip
        case WeakMotorError(wanted=mean, most=most, place=hardest):
            unit = units.spelt(MOMENT)
            return ProblemError(
                _("the motor cannot carry the load: over the cycle this wants more than it gives at its best"),
                path=("dynamics", "motor"), key=True,
                found=_("{moment} {unit} on the driver, whose loads are largest at {place} of its way")
                .format(moment=f"{units.from_si(most, MOMENT):.4g}", unit=unit, place=shown(hardest)),
                allowed=_("more than {moment} {unit}, the mean over the cycle: a stronger motor, or a larger ratio")
                .format(moment=f"{units.from_si(mean, MOMENT):.4g}", unit=unit),
            )  # fmt: skip
        case NoFlywheelError(wanted=delta, own=own):
            if math.isnan(own):
                return ProblemError(
                    _("no flywheel keeps this fluctuation with this motor"), path=("dynamics", "delta"),
                    found=f"{delta:.6g}", allowed=_("a larger delta"),
                )  # fmt: skip
            text = _("the fluctuation is smaller than this without any flywheel")
            if problem.dynamics is not None and problem.dynamics.flywheel:
                text = _("the fluctuation is smaller than this with the flywheel that is given")
            return ProblemError(
                text, path=("dynamics", "delta"),
                found=f"{delta:.6g}", allowed=_("less than {own}, or no delta").format(own=f"{own:.4g}"),
            )  # fmt: skip
        case TableBeyondCycleError(path=path, argument=argument, cycle=cycle):
            turns = round(cycle / (2 * math.pi))
            text = _("this row is never reached: all repeats after {turns} turns of the driver")
            if turns == 1:
                text = _("this row is never reached: all repeats after 1 turn of the driver")
            return ProblemError(
                text.format(turns=turns), path=path, found=shown(argument),
                allowed=_(
                    "0 to {end} {unit}; a longer cycle of loads is told by cycle: {turns} turns"
                ).format(
                    end=f"{units.from_si(cycle, ANGLE):.6g}", unit=units.spelt(ANGLE),
                    turns=max(2, math.ceil(argument / math.tau)),
                ),
            )  # fmt: skip
    return ProblemError(str(error))


def mobility(structure: Structure) -> ProblemError:
    """What a wrong mobility comes from: links that are loose, or pairs that hold what is held already."""
    n, p2, wanted = len(structure.links), structure.higher, len(structure.drivers)
    higher = f" - {p2}" if p2 else ""
    count = f"W = 3*{n} - 2*{len(structure.pairs) - p2}{higher} = {structure.mobility}"
    loose, redundant = structure.under_constrained, structure.redundant_pairs
    held = next((bodies for name, bodies in redundant if name == "driver"), None)
    if not redundant and not loose:
        held = structure.links
    if held is not None:
        number = max((k for k, d in enumerate(structure.drivers) if {d.base, d.link} <= set(held)), default=0)
        return ProblemError(
            _("link {link} cannot be driven: pairs or other drivers hold it already").format(
                link=structure.drivers[number].link
            ),
            path=("driver", number, "link") if wanted > 1 else ("driver", "link"),
            found=_("{count}; over-held: links {links}").format(count=count, links=", ".join(held)),
            allowed=f"W = {wanted}",
        )  # fmt: skip
    if loose:
        return ProblemError(
            _("mobility is not {wanted}: these links are loose: {links}").format(wanted=wanted, links=", ".join(loose)),
            path=("links", loose[0]), found=count,
            allowed=_("W = {wanted}, as many as there are drivers").format(wanted=wanted), key=True,
        )  # fmt: skip
    name, bodies = redundant[0]
    links = tuple(b for b in bodies if b in structure.links)
    return ProblemError(
        _("mobility is not {wanted}: pair {name} holds what is held already").format(wanted=wanted, name=name),
        path=("links", links[0]) if links else ("links",), key=True,
        found=_("{count}; over-held: links {links}").format(count=count, links=", ".join(bodies)),
        allowed=f"W = {wanted}",
    )  # fmt: skip
