"""The block `dynamics` of a problem file."""

from __future__ import annotations

from tmm_cli.dynamics.motors import Kloss, Linear, Motor
from tmm_cli.dynamics.sizes import Disk, Rim
from tmm_cli.dynamics.task import SteadyTask
from tmm_cli.language import _
from tmm_cli.linkage import Driver
from tmm_cli.problem import schema, schema_dynamics
from tmm_cli.problem.errors import quote
from tmm_cli.problem.values import Part, ValueReader
from tmm_cli.quantities import ANGULAR_SPEED, INERTIA, MOMENT, NUMBER


def build_dynamics(shape: schema.File, driver: Driver, values: ValueReader) -> SteadyTask | None:
    """What is asked of the law of motion; None where nothing is."""
    given = shape.dynamics
    if given is None:
        return None
    part = Part(given, ("dynamics",), values)
    mean = driver.rate if given.mean_speed is None else part.positive("mean_speed", ANGULAR_SPEED)
    delta = None if given.delta is None else part.positive("delta", NUMBER)
    if delta is not None and delta >= 1:
        raise part.refusal("delta", _("a machine whose speed changes so much does not run"), quote(given.delta),
                           _("less than 1; usual are 1/5 to 1/100"))  # fmt: skip
    wheel = Part(given.flywheel, ("dynamics", "flywheel"), values)
    ratio = wheel.positive("ratio", NUMBER)
    own = 0.0 if given.flywheel.inertia is None else wheel.positive("inertia", INERTIA)
    form = Disk if given.flywheel.shape == "disk" else Rim
    size = form(wheel.positive("density", NUMBER), wheel.positive("width", NUMBER), wheel.positive("height", NUMBER))
    motor = None if given.motor is None else _motor(Part(given.motor, ("dynamics", "motor"), values))
    return SteadyTask(mean, delta, motor, own * ratio**2, ratio, size)


def _motor(part: Part) -> Motor:
    """Reduced to the driver."""
    given: schema_dynamics.Motor = part.given
    ratio = part.positive("ratio", NUMBER)
    wanted = ("stall", "free") if given.kind == "linear" else ("synchronous", "speed", "moment")
    for key in wanted:
        if getattr(given, key) is None:
            raise part.refusal("", _("this motor is told by other numbers"), allowed=", ".join(wanted))
    if given.kind == "linear":
        return Linear(ratio * part.positive("stall", MOMENT), part.positive("free", ANGULAR_SPEED) / ratio)
    synchronous, speed = part.positive("synchronous", ANGULAR_SPEED), part.positive("speed", ANGULAR_SPEED)
    if speed >= synchronous:
        raise part.refusal("speed", _("the rated speed is below the synchronous one"), quote(given.speed))
    overload = part.positive("overload", NUMBER)
    if overload < 1:
        raise part.refusal("overload", _("the breakdown moment is not below the rated one"), quote(given.overload))
    return Kloss.rated(synchronous / ratio, speed / ratio, ratio * part.positive("moment", MOMENT), overload)
