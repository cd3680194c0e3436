"""The shape of the block `dynamics`: what drives the machine, and the flywheel that keeps its speed."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from tmm_cli.problem.schema_parts import Strict, Value, Vector, checked_value


def _profile(found: Any) -> Any:
    return Profile.model_validate(found) if isinstance(found, dict) else None if found is None else checked_value(found)


class Motor(Strict):
    """A motor by its characteristic; speeds and moments are those of its own shaft."""

    kind: Literal["linear", "asynchronous"] = Field(description="direct current; or induction, by Kloss")
    ratio: Value = Field(default=1, description="its speed over that of the driver")
    stall: Value | None = Field(default=None, description="linear: moment at rest")
    free: Value | None = Field(default=None, description="linear: speed without load")
    synchronous: Value | None = Field(default=None, description="asynchronous: speed without load")
    speed: Value | None = Field(default=None, description="asynchronous: rated speed")
    moment: Value | None = Field(default=None, description="asynchronous: rated moment")
    overload: Value = Field(default=2, description="asynchronous: breakdown moment over the rated one")


class Flywheel(Strict):
    """A flywheel: where it sits and what it looks like; with `inertia` it is given, without one it is found."""

    inertia: Value | None = Field(default=None, description="of a given flywheel, on its own shaft")
    ratio: Value = Field(default=1, description="speed of its shaft over that of the driver")
    shape: Literal["disk", "rim"] = "disk"
    width: Value = Field(default="1/5", description="of the disk or the rim, over its mean diameter")
    height: Value = Field(default="1/8", description="of the rim, over its mean diameter")
    density: Value = Field(default=7800, description="of its material; a bare number: kg/m^3")


class Profile(Strict):
    """What drives, by a table; linear between its rows."""

    against: Literal["time", "way"] = Field(description="s since the beginning, or the way that the driver has gone")
    table: list[Vector] = Field(
        min_length=2, max_length=10_000, description="rows [argument, size]; two with one argument: a jump"
    )
    area: Value | None = Field(default=None, description="of a piston: the table is then of pressures")


class Run(Strict):
    """A single run of the driver, integrated by time."""

    from_: Value | None = Field(default=None, alias="from", description="place of the driver; that of position 0")
    to: Value | None = Field(default=None, description="place where it ends; that of the last position")
    speed: Value = Field(default=0, description="at the beginning")
    drive: Annotated[Value | Profile | None, BeforeValidator(_profile)] = Field(
        default=None,
        description="moment, positive ccw, or force, positive along the guide: a value, or {against, table, area}",
    )
    brake: Value = Field(default=0, description="moment or force against the motion")


class Dynamics(Strict):
    """Steady running, or a single run: the law of motion of the driver follows from what acts on the machine."""

    mean_speed: Value | None = Field(
        default=None,
        alias="mean speed",
        description="mean of the largest and the least speed; the driver's",
    )
    delta: Value | None = Field(default=None, description="fluctuation of speed that a flywheel is to keep: 1/30")
    motor: Motor | None = Field(default=None, description="what drives; a constant moment when left out")
    flywheel: Flywheel = Field(default_factory=Flywheel)
    run: Run | None = Field(default=None, description="a single run, in place of steady running")
