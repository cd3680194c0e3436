"""The block `dynamics` of a problem file."""

from __future__ import annotations

import math

from tmm_cli.language import _
from tmm_cli.mechanics.dynamics import Disk, Kloss, Linear, Motor, Profile, Rim, RunTask, SteadyTask
from tmm_cli.mechanics.linkage import Driver, Linkage
from tmm_cli.mechanics.quantities import (
    ANGLE,
    ANGULAR_SPEED,
    AREA,
    DENSITY,
    FORCE,
    INERTIA,
    LENGTH,
    MOMENT,
    NUMBER,
    PRESSURE,
    SPEED,
    Dimension,
)
from tmm_cli.problem import schema
from tmm_cli.problem.blocks import keys_on_request as schema_dynamics
from tmm_cli.problem.errors import quote
from tmm_cli.problem.values import Part, ValueReader

NUMBERS = {"linear": ("stall", "free"), "asynchronous": ("synchronous", "speed", "moment", "overload")}  # of a motor
MOST_TURNS = 20  # from the x axis: as far as a run is integrated


def build_dynamics(shape: schema.File, linkage: Linkage, values: ValueReader) -> SteadyTask | RunTask | None:
    """What is asked of the law of motion."""
    given, driver = shape.dynamics, linkage.driver
    if given is None:
        return None
    part = Part(given, ("dynamics",), values)
    mean = driver.rate if given.mean_speed is None else part.positive("mean_speed", ANGULAR_SPEED)
    delta = None if given.delta is None else part.positive("delta", NUMBER)
    if delta is not None and delta >= 1:
        raise part.refusal(
            "delta",
            _("a machine whose speed changes so much does not run"),
            quote(given.delta),
            _("less than 1; usual are 1/5 to 1/100"),
        )
    wheel = Part(given.flywheel, ("dynamics", "flywheel"), values)
    ratio = wheel.positive("ratio", NUMBER)
    own = 0.0 if given.flywheel.inertia is None else wheel.positive("inertia", INERTIA)
    form = Disk if given.flywheel.shape == "disk" else Rim
    size = form(wheel.positive("density", DENSITY), wheel.positive("width", NUMBER), wheel.positive("height", NUMBER))
    if form is Rim and size.height >= 1:
        raise wheel.refusal(
            "height",
            _("a rim as high as that has no hole"),
            quote(given.flywheel.height),
            _("less than 1, the mean diameter"),
        )
    motor = None if given.motor is None else _motor(Part(given.motor, ("dynamics", "motor"), values))
    if given.run is not None:
        return _run(part, Part(given.run, ("dynamics", "run"), values), driver, motor, own * ratio**2)
    if mean == 0:
        raise part.refusal("", _("a driver that stands has no fluctuation of speed"), allowed="mean speed")
    return SteadyTask(mean, delta, motor, own * ratio**2, ratio, size)


def _run(whole: Part, part: Part, driver: Driver, motor: Motor | None, flywheel: float) -> RunTask:
    given: schema_dynamics.Run = part.given
    for key in ("mean_speed", "delta"):
        if getattr(whole.given, key) is not None:
            raise whole.refusal(key, _("a single run has no mean speed and no fluctuation"), at_key=True)
    turns = driver.kind == "turn"
    place, size = (ANGLE, MOMENT) if turns else (LENGTH, FORCE)
    first, last = (None if getattr(given, key) is None else part.number(key, place) for key in ("from_", "to"))
    for key, end in (("from_", first), ("to", last)):
        if turns and end is not None and abs(end) > MOST_TURNS * 2 * math.pi:
            raise part.refusal(
                key,
                _("a run is of few turns"),
                str(getattr(given, key)),
                _("within {most} turns of the x axis").format(most=MOST_TURNS),
            )
    if first is not None and first == last:
        raise part.refusal("to", _("a run ends elsewhere than it begins"), str(given.to))
    drive = None
    if isinstance(given.drive, schema_dynamics.Profile):
        drive = _profile(Part(given.drive, (*part.path, "drive"), part.values), place, size)
    elif given.drive is not None:
        drive = Profile("time", (0.0,), (part.number("drive", size),))
    speed = part.positive("speed", ANGULAR_SPEED if turns else SPEED, zero=True)
    return RunTask(speed, motor, drive, part.positive("brake", size, zero=True), flywheel, first, last)


def _profile(part: Part, place: Dimension, size: Dimension) -> Profile:
    given: schema_dynamics.Profile = part.given
    area = 1.0
    if given.area is not None and size == MOMENT:
        raise part.refusal(
            "area",
            _("a pressure is on a piston, and this driver is a crank"),
            quote(given.area),
            _("a table of moments, or a driver that slides"),
            at_key=True,
        )
    if given.area is not None:
        size, area = PRESSURE, part.positive("area", AREA)
    arguments, sizes = part.columns("table", NUMBER if given.against == "time" else place, size)
    return Profile(given.against, arguments, tuple(area * one for one in sizes))


def _turns(speed: float) -> str:
    """A bare speed is in rad/s, and is often meant in turns a minute."""
    return f"{speed:.6g} rad/s = {speed * 30 / math.pi:.6g} rpm"


def _motor(part: Part) -> Motor:
    """Reduced to the driver."""
    given: schema_dynamics.Motor = part.given
    ratio = part.positive("ratio", NUMBER)
    wanted = NUMBERS[given.kind]
    for key in wanted:
        if getattr(given, key) is None:
            raise part.refusal("", _("this motor is told by other numbers"), allowed=", ".join(wanted))
    for key in given.model_fields_set - {"kind", "ratio", *wanted}:
        raise part.refusal(key, _("this motor is told by other numbers"), quote(key), ", ".join(wanted), at_key=True)
    if given.kind == "linear":
        return Linear(ratio * part.positive("stall", MOMENT), part.positive("free", ANGULAR_SPEED) / ratio)
    synchronous, speed = part.positive("synchronous", ANGULAR_SPEED), part.positive("speed", ANGULAR_SPEED)
    if speed >= synchronous:
        raise part.refusal(
            "speed",
            _("the rated speed is below the synchronous one"),
            f"{quote(given.speed)} = {_turns(speed)}",
            _("less than {speed}").format(speed=_turns(synchronous)),
        )
    overload = part.positive("overload", NUMBER)
    if overload < 1:
        raise part.refusal(
            "overload", _("the breakdown moment is not below the rated one"), quote(given.overload), _("1 or more")
        )
    return Kloss.rated(synchronous / ratio, speed / ratio, ratio * part.positive("moment", MOMENT), overload)
