"""How large a flywheel is: a disk, or a rim whose spokes and hub are left out. A new form is a class here.

J = m D^2 / 8 of a disk, m D^2 / 4 of a rim of mean diameter D: I. I. Artobolevsky, Theory of Mechanisms and Machines
(1988), ch. 19.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from typing import ClassVar, Literal

import numpy as np

from tmm_cli.mechanics.dynamics.motors import MotorCharacteristic
from tmm_cli.mechanics.numerics import Real


@dataclass(frozen=True)
class DiskFlywheel:
    """density: kg/m3; width over diameter. height is of rims alone."""

    shape: ClassVar[Literal["disk", "rim"]] = "disk"
    density: float
    width: float
    height: float = 0.0

    def diameter(self, inertia: float) -> float:
        """m, of a disk of this inertia (kg m2)."""
        return float((32 * inertia / (math.pi * self.density * self.width)) ** 0.2)

    def mass(self, diameter: float) -> float:
        """kg."""
        return math.pi / 4 * self.density * self.width * diameter**3


@dataclass(frozen=True)
class RimFlywheel:
    """density: kg/m3; width and height of its section over its mean diameter."""

    shape: ClassVar[Literal["disk", "rim"]] = "rim"
    density: float
    width: float
    height: float

    def diameter(self, inertia: float) -> float:
        """Mean diameter, m, of a rim of this inertia (kg m2)."""
        return float((4 * inertia / (math.pi * self.density * self.width * self.height)) ** 0.2)

    def mass(self, diameter: float) -> float:
        """kg."""
        return math.pi * self.density * self.width * self.height * diameter**3


FlywheelForm = DiskFlywheel | RimFlywheel


# What is asked of the law of motion: numbers alone, as a problem file gives them.


@dataclass(frozen=True)
class SteadyTask:
    """What is wanted. mean: of the largest and the least speed of the driver (rad/s, or m/s), under a constant moment.

    delta: fluctuation that a flywheel is to keep. motor: for a constant moment; the speed is then what it comes to.
    flywheel: a given one, reduced to the driver (kg m2, or kg); without a delta no other is sought. ratio: speed of the
    flywheel's shaft over the driver's; size: how its form is told.
    """

    mean: float
    delta: float | None = None
    motor: MotorCharacteristic | None = None
    flywheel: float = 0.0
    ratio: float = 1.0
    cyclic: ClassVar[Literal[True]] = True
    size: FlywheelForm = field(default_factory=partial(DiskFlywheel, 7800.0, 0.2))


@dataclass(frozen=True)
class DriveProfile:
    """A moment (N m), or a force (N), by the time (s) or the way of the driver, linear between its rows.

    Two equal arguments are a jump: the second value holds from there on.
    """

    against: Literal["time", "way"]
    arguments: tuple[float, ...]
    values: tuple[float, ...]

    def __call__(self, time: Real, way: Real) -> Real:
        """Before the first row as there, after the last as there."""
        return np.interp(time if self.against == "time" else way, self.arguments, self.values)


@dataclass(frozen=True)
class RunTask:
    """What drives a single run, and from what speed (rad/s, or m/s).

    first, last: places of the driver (rad, or m) between which it is; None: the ends of what the file asks for.
    motor: by its characteristic, along the motion; drive: a profile, with it or alone, positive along the guide or
    counterclockwise. brake: moment against the motion.
    flywheel: kg m2, or kg. longest: time of a run (s).
    """

    speed: float = 0.0
    motor: MotorCharacteristic | None = None
    drive: Callable[[Real, Real], Real] | None = None
    brake: float = 0.0
    flywheel: float = 0.0
    first: float | None = None
    last: float | None = None
    longest: float = 3600.0
    cyclic: ClassVar[Literal[False]] = False

    def along(self, sense: int) -> RunTask:
        """The same task with a drive that is positive along the run; sense: of the run, +1 or -1."""
        drive = self.drive
        if sense > 0 or drive is None:
            return self
        if isinstance(drive, DriveProfile):
            return replace(self, drive=replace(drive, values=tuple(-value for value in drive.values)))
        return replace(self, drive=lambda time, way: -drive(time, way))

    @property
    def edges(self) -> tuple[float, ...]:
        """Times at which what drives may bend."""
        return self.drive.arguments if isinstance(self.drive, DriveProfile) and self.drive.against == "time" else ()

    @property
    def way_edges(self) -> tuple[float, ...]:
        """Distances that the driver has moved (rad, or m) at which what drives may bend or jump."""
        return self.drive.arguments if isinstance(self.drive, DriveProfile) and self.drive.against == "way" else ()
