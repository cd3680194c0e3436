"""What drives a machine: a moment by the speed of the driving link. A new characteristic is a class here.

S. A. Popov, G. A. Timofeev, Course project in the theory of mechanisms (2017), ch. 5: characteristics of motors.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import Protocol

from tmm_cli.mechanics.numerics import Real


class MotorCharacteristic(Protocol):
    """A characteristic, reduced to the driving link, by the slip s = 1 - w / w0 under its speed without load w0.

    Of a motor that is strong for its load the slip has all digits of the moment, the speed only a few.
    """

    @property
    @abstractmethod
    def idle(self) -> float:
        """Its speed without load, rad/s, or m/s of a slider."""

    @property
    @abstractmethod
    def most(self) -> float:
        """Its largest moment from that speed down to rest, N m, or N."""

    @property
    @abstractmethod
    def holds(self) -> float:
        """The largest moment with which it holds a machine that is pushed beyond that speed, N m, or N."""

    @abstractmethod
    def at_slip(self, slip: Real) -> tuple[Real, Real]:
        """N m (N of a slider), and its slope by the slip."""

    def moment(self, speed: Real) -> Real:
        """N m at speeds (rad/s); of a slider N at m/s."""
        return self.at_slip(1 - speed / self.idle)[0]


@dataclass(frozen=True)
class LinearMotor(MotorCharacteristic):
    """Direct current, shunt wound: from `stall` at rest down to nothing at `free` speed (rad/s)."""

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
    """Asynchronous: M = 2 Mk / (s / sk + sk / s), s the slip under the synchronous speed (rad/s).

    M. Kloss, Archiv fuer Elektrotechnik 5 (1916). breakdown: Mk (N m) at the slip sk.
    """

    synchronous: float
    breakdown: float
    slip: float

    @classmethod
    def rated(cls, synchronous: float, speed: float, moment: float, overload: float) -> KlossMotor:
        """From rated speed and moment, and the breakdown moment over the rated one (at least 1)."""
        own = 1 - speed / synchronous
        return cls(synchronous, overload * moment, own * (overload + (overload**2 - 1) ** 0.5))

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
        # 2 Mk s sk / (s^2 + sk^2): the same without a zero under the line at the synchronous speed
        under = slip**2 + self.slip**2
        moment = 2 * self.breakdown * slip * self.slip / under
        return moment, 2 * self.breakdown * self.slip * (self.slip**2 - slip**2) / under**2
