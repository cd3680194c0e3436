"""What drives a machine: a moment by the speed of the driving link. A new characteristic is a class here.

S. A. Popov, G. A. Timofeev, Course project in the theory of mechanisms (2017), ch. 5: characteristics of motors.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from tmm_cli.vectors import Real


class Motor(Protocol):
    """A characteristic, reduced to the driving link."""

    def moment(self, speed: Real) -> tuple[Real, Real]:
        """N m at speeds (rad/s), and its slope (N m s); of a slider N at m/s."""


@dataclass(frozen=True)
class Constant:
    """The same moment at all speeds."""

    value: float

    def moment(self, speed: Real) -> tuple[Real, Real]:
        return self.value + 0.0 * speed, 0.0 * speed


@dataclass(frozen=True)
class Linear:
    """Direct current, shunt wound: from `stall` at rest down to nothing at `free` speed (rad/s)."""

    stall: float
    free: float

    def moment(self, speed: Real) -> tuple[Real, Real]:
        slope = -self.stall / self.free
        return self.stall + slope * speed, slope + 0.0 * speed


@dataclass(frozen=True)
class Kloss:
    """Asynchronous: M = 2 Mk / (s / sk + sk / s), s the slip under the synchronous speed (rad/s).

    M. Kloss, Archiv fuer Elektrotechnik 5 (1916). breakdown: Mk (N m) at the slip sk.
    """

    synchronous: float
    breakdown: float
    slip: float

    @classmethod
    def rated(cls, synchronous: float, speed: float, moment: float, overload: float) -> Kloss:
        """From rated speed and moment, and the breakdown moment over the rated one (at least 1)."""
        own = 1 - speed / synchronous
        return cls(synchronous, overload * moment, own * (overload + (overload**2 - 1) ** 0.5))

    def moment(self, speed: Real) -> tuple[Real, Real]:
        s = 1 - speed / self.synchronous
        # 2 Mk s sk / (s^2 + sk^2): the same without a zero under the line at the synchronous speed
        under = s**2 + self.slip**2
        moment = 2 * self.breakdown * s * self.slip / under
        slope = -2 * self.breakdown * self.slip * (self.slip**2 - s**2) / under**2 / self.synchronous
        return moment, slope
