"""Input data of dynamics: shapes of flywheels, and the tasks of steady running and of a single run.

J = m D^2 / 8 for a disk, m D^2 / 4 for a rim of mean diameter D: I. I. Artobolevsky, Theory of Mechanisms
and Machines (1988), ch. 19. A new shape of flywheel is a class in this module.
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
    """Flywheel in the shape of a solid disk.

    Attributes:
        density: density of the material, kg/m3.
        width: width divided by the diameter.
        height: not used for a disk.
    """

    shape: ClassVar[Literal["disk", "rim"]] = "disk"
    density: float
    width: float
    height: float = 0.0

    def diameter(self, inertia: float) -> float:
        """Return the diameter (m) of a disk of this moment of inertia (kg m2)."""
        return float((32 * inertia / (math.pi * self.density * self.width)) ** 0.2)

    def mass(self, diameter: float) -> float:
        """Return the mass (kg) of a disk of this diameter (m)."""
        return math.pi / 4 * self.density * self.width * diameter**3


@dataclass(frozen=True)
class RimFlywheel:
    """Flywheel in the shape of a rim; spokes and hub are neglected.

    Attributes:
        density: density of the material, kg/m3.
        width, height: dimensions of the section of the rim, divided by its mean diameter.
    """

    shape: ClassVar[Literal["disk", "rim"]] = "rim"
    density: float
    width: float
    height: float

    def diameter(self, inertia: float) -> float:
        """Return the mean diameter (m) of a rim of this moment of inertia (kg m2)."""
        return float((4 * inertia / (math.pi * self.density * self.width * self.height)) ** 0.2)

    def mass(self, diameter: float) -> float:
        """Return the mass (kg) of a rim of this mean diameter (m)."""
        return math.pi * self.density * self.width * self.height * diameter**3


FlywheelForm = DiskFlywheel | RimFlywheel


# Tasks for the law of motion, as given in a problem file.


@dataclass(frozen=True)
class SteadyTask:
    """Task of steady running.

    Attributes:
        mean: mean of the largest and the least speed of the driver (rad/s, or m/s), used with a constant driving
            moment.
        delta: required coefficient of fluctuation of speed; None if no flywheel is to be computed.
        motor: motor that drives instead of a constant moment; the speed then follows from its characteristic.
        flywheel: inertia of a flywheel that the machine already has, reduced to the driver, kg m2 or kg.
        ratio: speed of the flywheel shaft divided by that of the driver.
        size: shape of the flywheel, from which its dimensions are computed.
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
    """Driving moment (N m) or force (N) as a function of time (s) or travel, interpolated linearly.

    Two equal arguments mark a jump; at the jump itself the second value holds.
    """

    against: Literal["time", "way"]
    arguments: tuple[float, ...]
    values: tuple[float, ...]

    def __call__(self, time: Real, travel: Real) -> Real:
        """Return the values at times or travels; before the first argument and after the last one they are constant."""
        return np.interp(time if self.against == "time" else travel, self.arguments, self.values)


@dataclass(frozen=True)
class RunTask:
    """Task of a single run.

    Attributes:
        speed: initial speed, rad/s or m/s.
        motor: motor that drives in the direction of motion.
        drive: driving moment or force as a function of time and travel, positive counterclockwise or along the
            guide; it is added to that of the motor.
        brake: moment against the motion, N m or N.
        flywheel: inertia of the flywheel, kg m2 or kg.
        first, last: driver coordinates at the beginning and the end (rad, or m); None for the first or last
            requested position.
        longest: time limit, s.
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
        """Return the task with its drive counted positive in the direction of the run.

        sense: direction of the run, +1 or -1.
        """
        drive = self.drive
        if sense > 0 or drive is None:
            return self
        if isinstance(drive, DriveProfile):
            return replace(self, drive=replace(drive, values=tuple(-value for value in drive.values)))
        return replace(self, drive=lambda time, travel: -drive(time, travel))

    @property
    def edges(self) -> tuple[float, ...]:
        """Times (s) at which the drive may jump or have a kink."""
        return self.drive.arguments if isinstance(self.drive, DriveProfile) and self.drive.against == "time" else ()

    @property
    def way_edges(self) -> tuple[float, ...]:
        """Distances covered by the driver (rad, or m) at which the drive may jump or have a kink."""
        return self.drive.arguments if isinstance(self.drive, DriveProfile) and self.drive.against == "way" else ()
