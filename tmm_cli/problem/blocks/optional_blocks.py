"""Building of the tasks for the blocks dynamics, balancing and intermittent, which few files have.

The module is imported only for files with such a block.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.analysis import WheelSetting, WheelTask
from tmm_cli.mechanics.dynamics import (
    BalancingTask,
    CorrectionPlane,
    CounterweightPlace,
    DiskFlywheel,
    DriveProfile,
    KlossMotor,
    LinearMotor,
    MotorCharacteristic,
    RimFlywheel,
    RunTask,
    SteadyTask,
    UnbalancedShaft,
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
from tmm_cli.problem.blocks import optional_keys
from tmm_cli.problem.errors import Path, ProblemError, nearest_name, quote
from tmm_cli.problem.units import ExtendedUnits
from tmm_cli.problem.values import FileSection, ValueReader, check_name, unit_vector

MOTOR_KEYS = {"linear": ("stall", "free"), "asynchronous": ("synchronous", "speed", "moment", "overload")}  # of a motor
MAX_RUN_TURNS = 20  # from the x axis: as far as a run is integrated


def build_dynamics(shape: schema.File, linkage: Linkage, values: ValueReader) -> SteadyTask | RunTask | None:
    """Build the task for the law of motion: steady running or a single run. Raises ProblemError.

    Returns None if the file has no block `dynamics`.
    """
    keys, driver = shape.dynamics, linkage.driver
    if keys is None:
        return None
    section = FileSection(keys, ("dynamics",), values)
    mean = driver.rate if keys.mean_speed is None else section.positive("mean_speed", ANGULAR_SPEED)
    delta = None if keys.delta is None else section.positive("delta", NUMBER)
    if delta is not None and delta >= 1:
        raise section.refusal(
            "delta",
            _("no machine can run with such a large fluctuation of speed"),
            quote(keys.delta),
            _("less than 1; usual values are 1/5 to 1/100"),
        )
    wheel = FileSection(keys.flywheel, ("dynamics", "flywheel"), values)
    ratio = wheel.positive("ratio", NUMBER)
    inertia = 0.0 if keys.flywheel.inertia is None else wheel.positive("inertia", INERTIA)
    form = DiskFlywheel if keys.flywheel.shape == "disk" else RimFlywheel
    dimensions = form(
        wheel.positive("density", DENSITY), wheel.positive("width", NUMBER), wheel.positive("height", NUMBER)
    )
    if form is RimFlywheel and dimensions.height >= 1:
        raise wheel.refusal(
            "height",
            _("a rim of this height leaves no hole in the middle"),
            quote(keys.flywheel.height),
            _("less than 1 (ratio to the mean diameter)"),
        )
    motor = None if keys.motor is None else _build_motor(FileSection(keys.motor, ("dynamics", "motor"), values))
    if keys.run is not None:
        return _build_run(
            section, FileSection(keys.run, ("dynamics", "run"), values), driver, motor, inertia * ratio**2
        )
    if mean == 0:
        raise section.refusal(
            "", _("the speed of the driver is zero, so the law of motion cannot be computed"), allowed="mean speed"
        )
    return SteadyTask(mean, delta, motor, inertia * ratio**2, ratio, dimensions)


def _build_run(
    whole: FileSection, section: FileSection, driver: Driver, motor: MotorCharacteristic | None, flywheel: float
) -> RunTask:
    keys: optional_keys.RunKeys = section.keys
    for key in ("mean_speed", "delta"):
        if getattr(whole.keys, key) is not None:
            raise whole.refusal(
                key,
                _(
                    "this key applies only to steady running: a single run has no mean speed and no coefficient of "
                    "fluctuation"
                ),
                at_key=True,
            )
    turns = driver.kind == "turn"
    place, effort = (ANGLE, MOMENT) if turns else (LENGTH, FORCE)
    first, last = (None if getattr(keys, key) is None else section.number(key, place) for key in ("from_", "to"))
    for key, end in (("from_", first), ("to", last)):
        if turns and end is not None and abs(end) > MAX_RUN_TURNS * 2 * math.pi:
            raise section.refusal(
                key,
                _("this run is too long"),
                str(getattr(keys, key)),
                _("an angle from the x axis of at most {most} turns").format(most=MAX_RUN_TURNS),
            )
    if first is not None and first == last:
        raise section.refusal("to", _("the run begins and ends at the same driver coordinate"), str(keys.to))
    drive = None
    if isinstance(keys.drive, optional_keys.ProfileKeys):
        drive = _build_profile(FileSection(keys.drive, (*section.path, "drive"), section.values), place, effort)
    elif keys.drive is not None:
        drive = DriveProfile("time", (0.0,), (section.number("drive", effort),))
    speed = section.positive("speed", ANGULAR_SPEED if turns else SPEED, zero=True)
    return RunTask(speed, motor, drive, section.positive("brake", effort, zero=True), flywheel, first, last)


def _build_profile(section: FileSection, place: Dimension, effort: Dimension) -> DriveProfile:
    keys: optional_keys.ProfileKeys = section.keys
    area = 1.0
    if keys.area is not None and effort == MOMENT:
        raise section.refusal(
            "area",
            _("a pressure can drive only a piston, but this driver is a crank"),
            quote(keys.area),
            _("a table of moments without `area`, or a slider as the driver"),
            at_key=True,
        )
    if keys.area is not None:
        effort, area = PRESSURE, section.positive("area", AREA)
    arguments, sizes = section.columns("table", NUMBER if keys.against == "time" else place, effort)
    return DriveProfile(keys.against, arguments, tuple(area * effort_value for effort_value in sizes))


def _format_speed(speed: float) -> str:
    """Format a speed in rad/s and in rpm: a speed without a unit is read in rad/s, but often rpm is meant."""
    return f"{speed:.6g} rad/s = {speed * 30 / math.pi:.6g} rpm"


def _build_motor(section: FileSection) -> MotorCharacteristic:
    """Build the motor characteristic, with speeds and torques referred to the driver."""
    keys: optional_keys.MotorKeys = section.keys
    ratio = section.positive("ratio", NUMBER)
    required = MOTOR_KEYS[keys.kind]
    for key in required:
        if getattr(keys, key) is None:
            raise section.refusal("", _("a motor of this kind requires other keys"), allowed=", ".join(required))
    for key in keys.model_fields_set - {"kind", "ratio", *required}:
        raise section.refusal(
            key, _("a motor of this kind requires other keys"), quote(key), ", ".join(required), at_key=True
        )
    if keys.kind == "linear":
        return LinearMotor(ratio * section.positive("stall", MOMENT), section.positive("free", ANGULAR_SPEED) / ratio)
    synchronous, speed = section.positive("synchronous", ANGULAR_SPEED), section.positive("speed", ANGULAR_SPEED)
    if speed >= synchronous:
        raise section.refusal(
            "speed",
            _("the rated speed must be less than the synchronous speed"),
            f"{quote(keys.speed)} = {_format_speed(speed)}",
            _("less than {speed}").format(speed=_format_speed(synchronous)),
        )
    overload = section.positive("overload", NUMBER)
    if overload < 1:
        raise section.refusal(
            "overload",
            _("the breakdown torque cannot be less than the rated torque"),
            quote(keys.overload),
            _("1 or more"),
        )
    return KlossMotor.rated(synchronous / ratio, speed / ratio, ratio * section.positive("moment", MOMENT), overload)


def build_balancing(shape: schema.File, linkage: Linkage, values: ValueReader) -> BalancingTask | None:
    """Build the balancing task. Raises ProblemError.

    Returns None if the file has no block `balancing`, or if the problem is built with double-double numbers, because
    balancing is computed in ordinary floating-point numbers only.
    """
    keys = shape.balancing
    if keys is None or isinstance(values.units, ExtendedUnits):
        return None
    section = FileSection(keys, ("balancing",), values)
    heavy = any(np.any(linkage.links[name].mass != 0) for name in linkage.moving)
    if not heavy and (keys.counterweights or keys.rotor is None):
        raise section.refusal(
            "", _("there is nothing to balance: no link has a mass"), allowed=_("masses: {1: {mass: 2 kg, ...}}")
        )
    counterweights = tuple(
        _build_counterweight_place(name, counterweight, linkage, values)
        for name, counterweight in keys.counterweights.items()
    )
    share, along = 0.5, 1 + 0j
    if keys.share is not None:
        share = values.fraction(keys.share, section.at("share"), zero=True)
        guides = [slide for slide in linkage.slides if slide.carrier == FRAME]
        output = linkage.output_guide(linkage.output.link) if linkage.output is not None else None
        if not guides:
            raise section.refusal(
                "share",
                _("`share` applies to the force along a guide on the frame, but this mechanism has no such guide"),
                str(keys.share),
                _("omit `share`; the force then counts equally in all directions"),
            )
        along = unit_vector((output if output in guides else guides[0]).direction)
    rotor = None if keys.rotor is None else _build_rotor(keys.rotor, values)
    return BalancingTask(counterweights, share, along, rotor)


def _build_counterweight_place(
    name: str, keys: optional_keys.CounterweightKeys, linkage: Linkage, values: ValueReader
) -> CounterweightPlace:
    section = FileSection(keys, ("balancing", "counterweights", name), values)
    values.known_name(name, linkage.moving, section.path, "link", key=True)
    if linkage.slides_on_frame(name):
        raise section.refusal("", _("a counterweight on a link that does not rotate balances nothing"))
    points = linkage.links[name].points
    fixed = [p for p in points if any(h.point == p and {FRAME, name} <= set(h.links) for h in linkage.hinges)]
    about = points[(fixed or list(points))[0]] if keys.about is None else section.place("about", points, name)
    radius = 0.0 if keys.radius is None else section.positive("radius", LENGTH)
    if not radius and not any(about == points[p] for p in fixed):
        raise section.refusal(
            "radius",
            _(
                "the point from which the radius of this counterweight is measured moves, so the mass must be "
                "known: `radius` is missing"
            ),
            allowed=_("give `radius`, e.g. 80 mm, or in `about` the hinge of this link on the frame"),
        )
    return CounterweightPlace(name, about, radius)


def _build_rotor(keys: optional_keys.RotorKeys, values: ValueReader) -> UnbalancedShaft:
    path = ("balancing", "rotor")
    products, at = [], []
    for k, mass in enumerate(keys.masses):
        section = FileSection(mass, (*path, "masses", k), values)
        product = section.positive("mass", MASS) * section.positive("radius", LENGTH)
        products.append(product * unit_vector(section.number("angle", ANGLE)))
        at.append(section.number("at", LENGTH))
    planes = []
    for k, plane in enumerate(keys.planes):
        section = FileSection(plane, (*path, "planes", k), values)
        planes.append(
            CorrectionPlane(
                section.number("at", LENGTH), 0.0 if plane.radius is None else section.positive("radius", LENGTH)
            )
        )
    if len(planes) > 1 and planes[0].at == planes[1].at:
        raise FileSection(keys, path, values).refusal(
            "planes", _("the two planes must be different"), str(keys.planes[1].at)
        )
    return UnbalancedShaft(np.array(products), np.array(at), tuple(planes))


LinkageWith = Callable[[Mapping[str, object]], Linkage]  # the linkage with other values of parameters


def build_wheels(
    shape: schema.File, linkage: Linkage, values: ValueReader, other: LinkageWith
) -> tuple[WheelTask, ...]:
    """Build the tasks of all wheels that move intermittently. Raises ProblemError.

    other: function that returns the linkage with other values of the parameters, as the settings of a wheel need it.
    """
    return tuple(_build_wheel(name, keys, shape, linkage, values, other) for name, keys in shape.intermittent.items())


def _build_wheel(
    name: str,
    keys: optional_keys.WheelKeys,
    shape: schema.File,
    linkage: Linkage,
    values: ValueReader,
    other: LinkageWith,
) -> WheelTask:
    section = FileSection(keys, ("intermittent", name), values)
    check_name(name, section.path, "link", linkage.links)
    link = section.known_name("moves_with", linkage.moving, "moving link")
    turning = [moving for moving in linkage.moving if linkage.hinged_to_frame(moving)]
    if link not in turning:
        raise section.refusal(
            "moves_with",
            _("the link that moves the wheel must be hinged to the frame"),
            quote(link),
            ", ".join(turning),
        )
    settings = [
        _build_setting(moving, (*section.path, "settings", k), shape.parameters, other)
        for k, moving in enumerate(keys.settings)
    ]
    return WheelTask(name, link, keys.when, tuple(settings))


def _build_setting(
    keys: Mapping[str, object], path: Path, parameters: Mapping[str, object], other: LinkageWith
) -> WheelSetting:
    for name in keys:
        if name not in parameters:
            raise ProblemError(
                _("no parameter has this name"),
                path=(*path, name),
                found=quote(name),
                key=True,
                allowed=", ".join(parameters) or _("none, since the file has no block `parameters`"),
                near=nearest_name(name, parameters),
            )
    if not keys:
        return WheelSetting()
    try:
        return WheelSetting({name: str(value) for name, value in keys.items()}, other(keys))
    except ProblemError as error:  # somewhere in the file, but it is this setting that does not fit there
        wrong = [name for name in keys if error.path == ("parameters", name)]
        path = (*path, *wrong)
        raise ProblemError(error.message, path=path, found=error.found, allowed=error.allowed) from None
