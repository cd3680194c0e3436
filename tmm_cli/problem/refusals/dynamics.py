"""Refusals of laws of motion and of balancing."""

from __future__ import annotations

import math

from tmm_cli.errors import (
    BySpeedError,
    LongRunError,
    LostDigitsError,
    NoFlywheelError,
    NoInertiaError,
    RunawayError,
    StandstillError,
    UnsettledError,
    WeakMotorError,
)
from tmm_cli.language import _, numeral
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.record import Problem
from tmm_cli.problem.refusals.wording import shown, worded
from tmm_cli.quantities import ANGULAR_SPEED, MOMENT


@worded.register
def _unsettled(error: UnsettledError, problem: Problem) -> ProblemError:
    return ProblemError(
        _("counterweights of these radii balance nothing: their masses load the pivots that they move with"),
        path=("balancing", "counterweights"), key=True, allowed=_("larger radii, or other points of the links"),
    )  # fmt: skip


@worded.register
def _by_speed(error: BySpeedError, problem: Problem) -> ProblemError:
    return ProblemError(
        _("a law of motion is not found where forces hang on reactions or on speeds"), path=error.path, key=True,
        allowed=_("loads that do not: force: {resists: 200 N} for a constant friction"),
    )  # fmt: skip


@worded.register
def _long_run(error: LongRunError, problem: Problem) -> ProblemError:
    reason = _("the run is not computed to its end: after {count} evaluations it has come to {time} s")
    return ProblemError(
        reason.format(count=error.count, time=f"{error.time:.4g}"), path=("dynamics", "run"),
        allowed=_("a shorter run, or inertias that differ less on the way"),
    )  # fmt: skip


@worded.register
def _standstill(error: StandstillError, problem: Problem) -> ProblemError:
    if problem.dynamics is not None and not problem.dynamics.cyclic:
        return ProblemError(
            _("the run does not start: what drives is no more than the loads"), path=("dynamics", "run"), key=True,
            allowed=_("a larger drive (positive along the guide or counterclockwise), or a speed at the beginning"),
        )  # fmt: skip
    return ProblemError(
        _("the machine comes to rest before its cycle ends: what drives it cannot carry the load"),
        path=("dynamics",), key=True,
        found=_("at {place} of the driver's way").format(place=shown(error.place, problem.units)),
        allowed=_("a heavier flywheel, a higher speed, a stronger motor"),
    )  # fmt: skip


@worded.register
def _no_inertia(error: NoInertiaError, problem: Problem) -> ProblemError:
    return ProblemError(
        _("there is no law of motion: nothing that moves with the driver there has mass or inertia"),
        path=("dynamics", "run") if hasattr(problem.dynamics, "speed") else ("dynamics",), key=True,
        found=_("at {place} of the driver's way").format(place=shown(error.place, problem.units)),
        allowed=_("masses of the links, or flywheel: {inertia: 0.5}"),
    )  # fmt: skip


@worded.register
def _lost_digits(error: LostDigitsError, problem: Problem) -> ProblemError:
    return ProblemError(
        _("the law of motion is lost in rounding: the links and the flywheel are too heavy for the motor to change "
          "their speed"),
        path=("dynamics",), key=True,
        found=_("in a cycle the motor makes up for {share} of a difference of speed").format(
            share=numeral(error.share, ".1g")
        ),
        allowed=_("masses and inertias that fit the motor: are their units right?"),
    )  # fmt: skip


@worded.register
def _runaway(error: RunawayError, problem: Problem) -> ProblemError:
    units, unit = problem.units, problem.units.spelt(MOMENT)
    found = _(
        "{moment} {unit} in the mean push the driver, most at {place} of its way; its motor holds {most} "
        "{unit} at its best"
    )
    wanted = _("a motor that holds more, a larger ratio, smaller loads")
    if not math.isnan(error.speed):
        found = _(
            "{speed} at {place} of the driver's way and still quicker, without load {idle}; {moment} "
            "{unit} in the mean push the driver, its motor holds {most} {unit} at its best"
        )
        wanted = _("a heavier flywheel, a stronger motor, smaller loads")
    return ProblemError(
        _("the loads push the machine on, and its motor does not hold it: it runs away"),
        path=("dynamics", "motor"), key=True, allowed=wanted,
        found=found.format(moment=f"{units.from_si(error.pushing, MOMENT):.4g}", unit=unit,
                           most=f"{units.from_si(error.most, MOMENT):.4g}", place=shown(error.place, units),
                           speed=units.told(error.speed, ANGULAR_SPEED, 4),
                           idle=units.told(error.idle, ANGULAR_SPEED, 4)),
    )  # fmt: skip


@worded.register
def _weak_motor(error: WeakMotorError, problem: Problem) -> ProblemError:
    units, unit = problem.units, problem.units.spelt(MOMENT)
    return ProblemError(
        _("the motor cannot carry the load: over the cycle this wants more than it gives at its best"),
        path=("dynamics", "motor"), key=True,
        found=_("{moment} {unit} on the driver, whose loads are largest at {place} of its way")
        .format(moment=f"{units.from_si(error.most, MOMENT):.4g}", unit=unit, place=shown(error.place, units)),
        allowed=_("more than {moment} {unit}, the mean over the cycle: a stronger motor, or a larger ratio")
        .format(moment=f"{units.from_si(error.wanted, MOMENT):.4g}", unit=unit),
    )  # fmt: skip


@worded.register
def _no_flywheel(error: NoFlywheelError, problem: Problem) -> ProblemError:
    text, allowed = _("no flywheel keeps this fluctuation with this motor"), _("a larger delta")
    if not math.isnan(error.own):
        text = _("the fluctuation is smaller than this without any flywheel")
        allowed = _("less than {own}, or no delta").format(own=f"{error.own:.4g}")
        if problem.dynamics is not None and problem.dynamics.flywheel:
            text = _("the fluctuation is smaller than this with the flywheel that is given")
    return ProblemError(text, path=("dynamics", "delta"), found=f"{error.wanted:.6g}", allowed=allowed)
