"""Build the tasks of blocks that few files have (dynamics, balancing, intermittent); imported for those files alone."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Setting, WheelTask
from tmm_cli.mechanics.dynamics import (
    BalancingTask,
    Disk,
    Kloss,
    Linear,
    Motor,
    Place,
    Plane,
    Profile,
    Rim,
    Rotor,
    RunTask,
    SteadyTask,
)
from tmm_cli.mechanics.linkage import FRAME, Driver, Linkage
from tmm_cli.mechanics.quantities import (
    ANGLE,
    ANGULAR_SPEED,
    AREA,
    DENSITY,
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
from tmm_cli.problem import schema
from tmm_cli.problem.blocks import optional_keys as keys
from tmm_cli.problem.errors import Path, ProblemError, nearest, quote
from tmm_cli.problem.units import ExtendedUnits
from tmm_cli.problem.values import Part, ValueReader, check_name, direction

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
    given: keys.Run = part.given
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
    if isinstance(given.drive, keys.Profile):
        drive = _profile(Part(given.drive, (*part.path, "drive"), part.values), place, size)
    elif given.drive is not None:
        drive = Profile("time", (0.0,), (part.number("drive", size),))
    speed = part.positive("speed", ANGULAR_SPEED if turns else SPEED, zero=True)
    return RunTask(speed, motor, drive, part.positive("brake", size, zero=True), flywheel, first, last)


def _profile(part: Part, place: Dimension, size: Dimension) -> Profile:
    given: keys.Profile = part.given
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
    given: keys.Motor = part.given
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


def build_balancing(shape: schema.File, linkage: Linkage, values: ValueReader) -> BalancingTask | None:
    """What is asked of balancing, which is found in doubles alone."""
    given = shape.balancing
    if given is None or isinstance(values.units, ExtendedUnits):
        return None
    part = Part(given, ("balancing",), values)
    heavy = any(np.any(linkage.links[name].mass != 0) for name in linkage.moving)
    if not heavy and (given.counterweights or given.rotor is None):
        raise part.refusal("", _("nothing shakes: no link has a mass"), allowed=_("masses: {1: {mass: 2 kg, ...}}"))
    places = tuple(_place(name, own, linkage, values) for name, own in given.counterweights.items())
    share, along = 0.5, 1 + 0j
    if given.share is not None:
        share = values.fraction(given.share, part.at("share"), zero=True)
        guides = [slide for slide in linkage.slides if slide.carrier == FRAME]
        output = linkage.output_guide(linkage.output.link) if linkage.output is not None else None
        if not guides:
            raise part.refusal(
                "share",
                _("a share is of the force along a guide on the frame, and there is none"),
                str(given.share),
                _("no share: the force counts alike in all directions"),
            )
        along = direction((output if output in guides else guides[0]).direction)
    rotor = None if given.rotor is None else _rotor(given.rotor, values)
    return BalancingTask(places, share, along, rotor)


def _place(name: str, given: keys.Counterweight, linkage: Linkage, values: ValueReader) -> Place:
    part = Part(given, ("balancing", "counterweights", name), values)
    values.known(name, linkage.moving, part.path, "link", key=True)
    if linkage.slides_on_frame(name):
        raise part.refusal("", _("a counterweight on a link that does not turn balances nothing"))
    points = linkage.links[name].points
    fixed = [p for p in points if any(h.point == p and {FRAME, name} <= set(h.links) for h in linkage.hinges)]
    about = points[(fixed or list(points))[0]] if given.about is None else part.place("about", points, name)
    radius = 0.0 if given.radius is None else part.positive("radius", LENGTH)
    if not radius and not any(about == points[p] for p in fixed):
        raise part.refusal(
            "radius",
            _("this counterweight moves with its link: its mass counts, and so its radius is wanted"),
            allowed=_("radius: 80 mm, or about: a hinge of this link on the frame"),
        )
    return Place(name, about, radius)


def _rotor(given: keys.Rotor, values: ValueReader) -> Rotor:
    path = ("balancing", "rotor")
    sizes, at = [], []
    for k, one in enumerate(given.masses):
        part = Part(one, (*path, "masses", k), values)
        size = part.positive("mass", MASS) * part.positive("radius", LENGTH)
        sizes.append(size * direction(part.number("angle", ANGLE)))
        at.append(part.number("at", LENGTH))
    planes = []
    for k, own in enumerate(given.planes):
        part = Part(own, (*path, "planes", k), values)
        planes.append(Plane(part.number("at", LENGTH), 0.0 if own.radius is None else part.positive("radius", LENGTH)))
    if len(planes) > 1 and planes[0].at == planes[1].at:
        raise Part(given, path, values).refusal("planes", _("two different planes are wanted"), str(given.planes[1].at))
    return Rotor(np.array(sizes), np.array(at), tuple(planes))


Other = Callable[[Mapping[str, object]], Linkage]  # the linkage with other values of parameters


def build_wheels(shape: schema.File, linkage: Linkage, values: ValueReader, other: Other) -> tuple[WheelTask, ...]:
    """What is asked of each wheel."""
    return tuple(_wheel(name, given, shape, linkage, values, other) for name, given in shape.intermittent.items())


def _wheel(
    name: str, given: keys.Wheel, shape: schema.File, linkage: Linkage, values: ValueReader, other: Other
) -> WheelTask:
    part = Part(given, ("intermittent", name), values)
    check_name(name, part.path, "link", linkage.links)
    link = part.known("moves_with", linkage.moving, "moving link")
    turning = [own for own in linkage.moving if linkage.hinged_to_frame(own)]
    if link not in turning:
        raise part.refusal(
            "moves_with", _("a wheel moves with a link that turns on the frame"), quote(link), ", ".join(turning)
        )
    settings = [
        _setting(own, (*part.path, "settings", k), shape.parameters, other) for k, own in enumerate(given.settings)
    ]
    return WheelTask(name, link, given.when, tuple(settings))


def _setting(given: Mapping[str, object], path: Path, known: Mapping[str, object], other: Other) -> Setting:
    for name in given:
        if name not in known:
            raise ProblemError(
                _("there is no parameter of that name"),
                path=(*path, name),
                found=quote(name),
                key=True,
                allowed=", ".join(known) or _("none: the file has no parameters"),
                near=nearest(name, known),
            )
    if not given:
        return Setting()
    try:
        return Setting({name: str(value) for name, value in given.items()}, other(given))
    except ProblemError as error:  # somewhere in the file, but it is this setting that does not fit there
        own = [name for name in given if error.path == ("parameters", name)]
        path = (*path, *own)
        raise ProblemError(error.message, path=path, found=error.found, allowed=error.allowed) from None
