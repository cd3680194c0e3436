"""Keys of the blocks dynamics, balancing and intermittent, which few files have."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from tmm_cli.problem.schema_types import Name, Place, Strict, Value, Vector, checked_value


def _checked_drive(raw: Any) -> Any:
    return ProfileKeys.model_validate(raw) if isinstance(raw, dict) else None if raw is None else checked_value(raw)


class MotorKeys(Strict):
    """A motor and its torque-speed characteristic; speeds and torques are those of the motor shaft."""

    kind: Literal["linear", "asynchronous"] = Field(
        description=(
            "kind of motor. linear: DC motor with a straight characteristic; asynchronous: induction motor by "
            "the Kloss formula"
        )
    )
    ratio: Value = Field(default=1, description="ratio of the motor speed to the driver speed")
    stall: Value | None = Field(default=None, description="linear: stall torque (at zero speed)")
    free: Value | None = Field(default=None, description="linear: no-load speed")
    synchronous: Value | None = Field(default=None, description="asynchronous: synchronous speed")
    speed: Value | None = Field(default=None, description="asynchronous: rated speed")
    moment: Value | None = Field(default=None, description="asynchronous: rated torque")
    overload: Value = Field(default=2, description="asynchronous: ratio of breakdown torque to rated torque")


class FlywheelKeys(Strict):
    """A flywheel, its shaft and its shape. Without `inertia` its size is computed."""

    inertia: Value | None = Field(
        default=None,
        description="moment of inertia of a given flywheel about its shaft; if omitted, the flywheel is designed",
    )
    ratio: Value = Field(default=1, description="ratio of the speed of the flywheel shaft to the driver speed")
    shape: Literal["disk", "rim"] = "disk"
    width: Value = Field(default="1/5", description="width of the disk or rim, as a fraction of the mean diameter")
    height: Value = Field(default="1/8", description="height of the rim, as a fraction of the mean diameter")
    density: Value = Field(default=7800, description="density of the material; kg/m^3 if no unit is given")


class ProfileKeys(Strict):
    """Driving moment or force as a table with linear interpolation."""

    against: Literal["time", "way"] = Field(
        description=(
            "quantity in the first column of the table. time: seconds from the start; way: displacement of the "
            "driver from the start"
        )
    )
    table: list[Vector] = Field(
        min_length=2,
        max_length=10_000,
        description="rows [argument, value]; two rows with the same argument mean a jump",
    )
    area: Value | None = Field(default=None, description="area of the piston; if given, the table contains pressures")


class RunKeys(Strict):
    """A single run of the driver, computed by integration over time."""

    from_: Value | None = Field(
        default=None, alias="from", description="driver coordinate at the start; default: that of position 0"
    )
    to: Value | None = Field(
        default=None, description="driver coordinate at the end; default: that of the last position"
    )
    speed: Value = Field(default=0, description="speed of the driver at the start")
    drive: Annotated[Value | ProfileKeys | None, BeforeValidator(_checked_drive)] = Field(
        default=None,
        description=(
            "driving moment (positive counterclockwise) or driving force (positive along the guide): a value, "
            "or {against, table, area}"
        ),
    )
    brake: Value = Field(default=0, description="braking moment or force, against the motion")


class DynamicsKeys(Strict):
    """Law of motion of the driver under the acting forces: steady running, or a single run."""

    mean_speed: Value | None = Field(
        default=None,
        alias="mean speed",
        description="mean of the largest and the smallest speed; default: the driver speed",
    )
    delta: Value | None = Field(
        default=None, description="coefficient of fluctuation of speed for which the flywheel is designed, e.g. 1/30"
    )
    motor: MotorKeys | None = Field(default=None, description="motor; a constant driving moment if omitted")
    flywheel: FlywheelKeys = Field(default_factory=FlywheelKeys)
    run: RunKeys | None = Field(default=None, description="a single run instead of steady running")


# Block `balancing`: counterweights to compute, and a shaft with masses in planes.


class CounterweightKeys(Strict):
    """A counterweight on a link; its mass (or radius) and its angle are computed."""

    about: Place | None = Field(
        default=None,
        description=(
            "point of the link from which the radius of the counterweight is measured; default: the hinge on "
            "the frame, otherwise the first point"
        ),
    )
    radius: Value | None = Field(
        default=None,
        description="radius of the centre of mass of the counterweight; if given, the mass is also computed",
    )


class RotorMassKeys(Strict):
    """An unbalanced mass that rotates with the shaft."""

    mass: Value
    radius: Value
    angle: Value = 0
    at: Value = Field(default=0, description="coordinate of the plane of this mass along the shaft")


class RotorPlaneKeys(Strict):
    """A correction plane, in which a balancing mass is computed."""

    at: Value = Field(description="coordinate of the plane along the shaft")
    radius: Value | None = Field(
        default=None,
        description=(
            "radius of the balancing mass; if given, the mass is computed and not only the product of mass and radius"
        ),
    )


def _expand_plane(raw: Any) -> Any:
    return raw if isinstance(raw, dict) else {"at": checked_value(raw)}


class RotorKeys(Strict):
    """A shaft with unbalanced masses, balanced in one plane (statically) or in two planes (dynamically)."""

    masses: list[RotorMassKeys] = Field(min_length=1, max_length=100)
    planes: list[
        Annotated[RotorPlaneKeys, BeforeValidator(_expand_plane, json_schema_input_type=RotorPlaneKeys | Value)]
    ] = Field(min_length=1, max_length=2)


class BalancingKeys(Strict):
    """Shaking force and shaking moment on the frame at constant driver speed, and counterweights that balance them."""

    counterweights: dict[Name, CounterweightKeys] = Field(
        default_factory=dict, max_length=20, description="counterweights by the names of the links that carry them"
    )
    share: Value | None = Field(
        default=None,
        description=(
            "weighting factor, 0 to 1, of the force along the guide of the output link; the factor of the "
            "transverse force is the rest up to 1. In a crank-slider it is the balanced fraction of the "
            "reciprocating masses. If omitted, both directions have the same factor"
        ),
    )
    rotor: RotorKeys | None = None


# Block `intermittent`: wheels that a link carries along in some strokes and that stand still in others.


Values = Annotated[dict[Name, Value], Field(max_length=50)]
Settings = Annotated[list[Values], Field(min_length=1, max_length=12)]


class WheelKeys(Strict):
    """A ratchet wheel, a shaft on a one-way clutch, or a slotted flange, coaxial with the link that moves it."""

    moves_with: Name = Field(description="link that moves the wheel; it must be hinged to the frame")
    when: Literal["forward", "backward", "working stroke", "idle stroke"] = Field(
        description=(
            "when the wheel moves: while that link rotates forward (counterclockwise) or backward, or during a "
            "stroke of the output"
        )
    )
    settings: Settings = Field(
        default=[{}],
        description="values of parameters used in turn, one set for each cycle of the driver: [{}, {R: 125}]",
    )


Wheels = Annotated[dict[Name, WheelKeys], Field(max_length=4)]  # a setting of a class III press takes 0.4 s
