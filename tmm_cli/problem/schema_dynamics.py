"""The shape of the block `dynamics`: what drives the machine, and the flywheel that keeps its speed."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from tmm_cli.problem.schema_parts import Strict, Value


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
    density: Value = Field(default=7800, description="kg/m^3")


class Dynamics(Strict):
    """Steady running: the law of motion of the driver follows from what acts on the machine."""

    mean_speed: Value | None = Field(
        default=None, alias="mean speed", description="mean of the largest and the least speed; the driver's"
    )
    delta: Value | None = Field(default=None, description="fluctuation of speed that a flywheel is to keep: 1/30")
    motor: Motor | None = Field(default=None, description="what drives; a constant moment when left out")
    flywheel: Flywheel = Field(default_factory=Flywheel)
