"""Keys of the blocks that few files have: dynamics, balancing, intermittent."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from tmm_cli.problem.schema_types import Name, Place, Strict, Value, Vector, checked_value


def _checked_drive(found: Any) -> Any:
    return (
        ProfileKeys.model_validate(found)
        if isinstance(found, dict)
        else None
        if found is None
        else checked_value(found)
    )


class MotorKeys(Strict):
    """A motor by its characteristic; speeds and moments are those of its own shaft."""

    kind: Literal["linear", "asynchronous"] = Field(description="direct current; or induction, by Kloss")
    ratio: Value = Field(default=1, description="its speed over that of the driver")
    stall: Value | None = Field(default=None, description="linear: moment at rest")
    free: Value | None = Field(default=None, description="linear: speed without load")
    synchronous: Value | None = Field(default=None, description="asynchronous: speed without load")
    speed: Value | None = Field(default=None, description="asynchronous: rated speed")
    moment: Value | None = Field(default=None, description="asynchronous: rated moment")
    overload: Value = Field(default=2, description="asynchronous: breakdown moment over the rated one")


class FlywheelKeys(Strict):
    """A flywheel: where it sits and what it looks like; with `inertia` it is given, without one it is found."""

    inertia: Value | None = Field(default=None, description="of a given flywheel, on its own shaft")
    ratio: Value = Field(default=1, description="speed of its shaft over that of the driver")
    shape: Literal["disk", "rim"] = "disk"
    width: Value = Field(default="1/5", description="of the disk or the rim, over its mean diameter")
    height: Value = Field(default="1/8", description="of the rim, over its mean diameter")
    density: Value = Field(default=7800, description="of its material; a bare number: kg/m^3")


class ProfileKeys(Strict):
    """What drives, by a table; linear between its rows."""

    against: Literal["time", "way"] = Field(description="s since the beginning, or the way that the driver has gone")
    table: list[Vector] = Field(
        min_length=2, max_length=10_000, description="rows [argument, size]; two with one argument: a jump"
    )
    area: Value | None = Field(default=None, description="of a piston: the table is then of pressures")


class RunKeys(Strict):
    """A single run of the driver, integrated by time."""

    from_: Value | None = Field(default=None, alias="from", description="place of the driver; that of position 0")
    to: Value | None = Field(default=None, description="place where it ends; that of the last position")
    speed: Value = Field(default=0, description="at the beginning")
    drive: Annotated[Value | ProfileKeys | None, BeforeValidator(_checked_drive)] = Field(
        default=None,
        description="moment, positive ccw, or force, positive along the guide: a value, or {against, table, area}",
    )
    brake: Value = Field(default=0, description="moment or force against the motion")


class DynamicsKeys(Strict):
    """Steady running, or a single run: the law of motion of the driver follows from what acts on the machine."""

    mean_speed: Value | None = Field(
        default=None,
        alias="mean speed",
        description="mean of the largest and the least speed; the driver's",
    )
    delta: Value | None = Field(default=None, description="fluctuation of speed that a flywheel is to keep: 1/30")
    motor: MotorKeys | None = Field(default=None, description="what drives; a constant moment when left out")
    flywheel: FlywheelKeys = Field(default_factory=FlywheelKeys)
    run: RunKeys | None = Field(default=None, description="a single run, in place of steady running")


# The shape of the block `balancing`: counterweights that are sought, and a shaft with masses in planes.


class CounterweightKeys(Strict):
    """A counterweight on a link; its size and its angle are found."""

    about: Place | None = Field(default=None, description="its hinge on the frame, or its first point, if left out")
    radius: Value | None = Field(default=None, description="of its centre of mass: then its mass is told too")


class RotorMassKeys(Strict):
    """A mass that turns with the shaft."""

    mass: Value
    radius: Value
    angle: Value = 0
    at: Value = Field(default=0, description="place of its plane along the shaft")


class RotorPlaneKeys(Strict):
    """A plane in which a mass is sought."""

    at: Value = Field(description="place along the shaft")
    radius: Value | None = Field(default=None, description="of the mass that is sought there")


def _expand_plane(found: Any) -> Any:
    return found if isinstance(found, dict) else {"at": checked_value(found)}


class RotorKeys(Strict):
    """A shaft with masses, balanced by others in one plane (statically) or in two (dynamically)."""

    masses: list[RotorMassKeys] = Field(min_length=1, max_length=100)
    planes: list[
        Annotated[RotorPlaneKeys, BeforeValidator(_expand_plane, json_schema_input_type=RotorPlaneKeys | Value)]
    ] = Field(min_length=1, max_length=2)


class BalancingKeys(Strict):
    """What shakes the frame at constant speed of the driver, and what balances it."""

    counterweights: dict[Name, CounterweightKeys] = Field(
        default_factory=dict, max_length=20, description="by their links"
    )
    share: Value | None = Field(
        default=None,
        description="how much the force along the guide of the output counts, the rest of one across it; of a "
        "crank-slider the share of the reciprocating masses that is balanced. Without it both count alike",
    )
    rotor: RotorKeys | None = None


# The shape of the block `intermittent`: wheels that a link takes along on some strokes and that stand on others.


Values = Annotated[dict[Name, Value], Field(max_length=50)]
Settings = Annotated[list[Values], Field(min_length=1, max_length=12)]


class WheelKeys(Strict):
    """A ratchet wheel, a shaft on a one-way clutch, or a flange with slots, on the axis of the link that moves it."""

    moves_with: Name = Field(description="the link that takes it along; it turns on the frame")
    when: Literal["forward", "backward", "working stroke", "idle stroke"] = Field(
        description="while that link turns forward (counterclockwise) or backward, or in strokes of the output"
    )
    settings: Settings = Field(
        default=[{}], description="values of parameters that take turns, one a cycle of the driver: [{}, {R: 125}]"
    )


Wheels = Annotated[dict[Name, WheelKeys], Field(max_length=4)]  # a setting of a class III press takes 0.4 s
