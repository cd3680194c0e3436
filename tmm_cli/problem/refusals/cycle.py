"""Refusals of what hangs on strokes, on the turns of a cycle, or on how far the driver comes."""

from __future__ import annotations

import math

from tmm_cli.errors import (
    MissingStrokesError,
    NoCycleError,
    NoTurnError,
    OutOfRangeError,
    SpeedsEndError,
    TableBeyondCycleError,
)
from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.record import Problem
from tmm_cli.problem.refusals.wording import shown, worded
from tmm_cli.quantities import ANGLE


@worded.register
def _no_strokes(error: MissingStrokesError, problem: Problem) -> ProblemError:
    block, *__, key = error.path
    if block == "intermittent" and key == "moves_with":
        return ProblemError(
            _("this link never turns back: the wheel would not stand"), path=error.path, found=quote(error.link),
            allowed=_("a link that swings"),
        )  # fmt: skip
    text = _("there is no working stroke")
    if block == "intermittent":
        return ProblemError(text, path=error.path, allowed=_("forward, backward, or an output that has strokes"))
    if error.limits is not None:
        first, last = (shown(limit, problem.units) for limit in error.limits)
        return ProblemError(
            _("a table against the stroke needs a driver that turns fully, so that the output makes whole strokes"),
            path=error.path, found=_("the driver moves from {first} to {last}").format(first=first, last=last),
            allowed=_("against: crank angle"),
        )  # fmt: skip
    found = _("no output is joined to the frame")
    if error.link is not None:
        found = _("link {link} has no ends of its stroke").format(link=error.link)
    return ProblemError(text, path=error.path, found=found, allowed=_("see output:"))


@worded.register
def _speeds_end(error: SpeedsEndError, problem: Problem) -> ProblemError:
    first, last, end = (shown(x, problem.units) for x in (error.first, error.last, error.first + error.cycle))
    ends = _("the table goes from {first} to {last}").format(first=first, last=last)
    if error.at is not None:
        ends = _("{ends}, a position is at {place}").format(ends=ends, place=shown(error.at, problem.units))
    closing = _("a last row at {end} with the speed of the first, or positions: {{at: [...]}} within it")
    return ProblemError(
        _("the table of speeds does not reach over all positions"), path=("driver", "speed", "table"), key=True,
        found=ends, allowed=closing.format(end=end),
    )  # fmt: skip


@worded.register
def _no_turn(error: NoTurnError, problem: Problem) -> ProblemError:
    full = _("a cycle of {turns} turns needs a crank that turns fully").format(turns=error.turns)
    return ProblemError(full, path=("cycle",), key=True)


@worded.register
def _no_cycle(error: NoCycleError, problem: Problem) -> ProblemError:
    wanted = _("a law of motion is found for one crank that turns fully")
    allowed = _("one driver that turns round and round")
    if error.path[0] == "balancing":
        wanted = _("what shakes is found for one crank that turns fully")
    if error.path[0] == "intermittent":
        wanted = _("intermittent motion is found over a cycle, and the driver has none")
        fit = _("a crank that turns fully, or a driver with a stroke that the linkage can go")
        allowed = f"{fit}; driver: {{stroke: [0, 100]}}"
    return ProblemError(wanted, path=error.path, key=True, allowed=allowed)


@worded.register
def _out_of_range(error: OutOfRangeError, problem: Problem) -> ProblemError:
    first, last = shown(error.start, problem.units), shown(error.end, problem.units)
    return ProblemError(
        _("the run goes where the driver does not come"), path=("dynamics", "run"), key=True,
        allowed=_("{first} to {last}").format(first=first, last=last),
    )  # fmt: skip


@worded.register
def _beyond_cycle(error: TableBeyondCycleError, problem: Problem) -> ProblemError:
    turns, units = round(error.cycle / (2 * math.pi)), problem.units
    text = _("this row is never reached: all repeats after {turns} turns of the driver")
    if turns == 1:
        text = _("this row is never reached: all repeats after 1 turn of the driver")
    allowed = _("0 to {end} {unit}; a longer cycle of loads is told by cycle: {turns} turns").format(
        end=f"{units.from_si(error.cycle, ANGLE):.6g}", unit=units.spelt(ANGLE),
        turns=max(2, math.ceil(error.argument / math.tau)),
    )  # fmt: skip
    return ProblemError(text.format(turns=turns), path=error.path, found=shown(error.argument, units), allowed=allowed)
