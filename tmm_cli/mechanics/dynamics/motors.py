"""Motor characteristics: the driving moment as a function of the speed of the input link.

A new kind of motor is a class in this module. S. A. Popov, G. A. Timofeev, Course project in the theory of
mechanisms (2017), ch. 5.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Protocol

from tmm_cli.mechanics.numerics import Real


class MotorCharacteristic(Protocol):
    """Driving moment of a motor, reduced to the input link, as a function of the slip s = 1 - w / w0 (w0: no-load
    speed).

    If the motor is strong compared with the load, the moment can be computed from the slip with all digits, but from
    the speed with only a few.
    """

    @property
    @abstractmethod
    def idle(self) -> float:
        """No-load speed, rad/s (m/s for a slider)."""

    @property
    @abstractmethod
    def most(self) -> float:
        """Largest driving moment between standstill and no-load speed, N m (N for a slider)."""

    @property
    @abstractmethod
    def holds(self) -> float:
        """Largest braking moment above the no-load speed, N m (N for a slider)."""

    @abstractmethod
    def at_slip(self, slip: Real) -> tuple[Real, Real]:
        """Return the driving moment, N m (N for a slider), and its derivative with respect to the slip."""

    def moment(self, speed: Real) -> Real:
        """Return the driving moment, N m (N for a slider), at these speeds, rad/s (m/s for a slider)."""
        return self.at_slip(1 - speed / self.idle)[0]


@dataclass(frozen=True)
class LinearMotor(MotorCharacteristic):
    """Shunt-wound DC motor: the moment falls linearly from `stall` (N m) at rest to zero at the speed `free`
    (rad/s).
    """

    stall: float
    free: float

    @property
    def idle(self) -> float:
        return self.free

    @property
    def most(self) -> float:
        return self.stall

    @property
    def holds(self) -> float:
        return float("inf")

    def at_slip(self, slip: Real) -> tuple[Real, Real]:
        return self.stall * slip, self.stall + 0.0 * slip


@dataclass(frozen=True)
class KlossMotor(MotorCharacteristic):
    """Induction motor by Kloss's formula, M = 2 Mk / (s / sk + sk / s). M. Kloss, Archiv fuer Elektrotechnik 5
    (1916).

    Attributes:
        synchronous: synchronous speed, rad/s.
        breakdown: breakdown torque Mk, N m.
        slip: slip sk at the breakdown torque.
    """

    synchronous: float
    breakdown: float
    slip: float

    @classmethod
    def rated(cls, synchronous: float, speed: float, moment: float, overload: float) -> KlossMotor:
        """Build the characteristic of an induction motor from its rated speed (rad/s) and rated torque (N m).

        overload: breakdown torque divided by rated torque, at least 1.
        """
        rated_slip = 1 - speed / synchronous
        return cls(synchronous, overload * moment, rated_slip * (overload + (overload**2 - 1) ** 0.5))

    @property
    def idle(self) -> float:
        return self.synchronous

    @property
    def most(self) -> float:
        return self.breakdown

    @property
    def holds(self) -> float:
        return self.breakdown

    def at_slip(self, slip: Real) -> tuple[Real, Real]:
        # 2 Mk s sk / (s^2 + sk^2): Kloss's formula without division by zero at the synchronous speed
        under = slip**2 + self.slip**2
        moment = 2 * self.breakdown * slip * self.slip / under
        return moment, 2 * self.breakdown * self.slip * (self.slip**2 - slip**2) / under**2
