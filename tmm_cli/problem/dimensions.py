"""Dimensions of the quantities in a problem file, their names, and the units that bare numbers have by default.

An angle is a dimension of its own here, so that a length where an angle is wanted is caught.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final, NamedTuple


@dataclass(frozen=True)
class Dimension:
    """Exponents of length, mass, time and angle."""

    length: int = 0
    mass: int = 0
    time: int = 0
    angle: int = 0

    def times(self, other: Dimension, power: int = 1) -> Dimension:
        """The dimension of a product with other**power."""
        return Dimension(
            self.length + power * other.length,
            self.mass + power * other.mass,
            self.time + power * other.time,
            self.angle + power * other.angle,
        )

    def power(self, exponent: int) -> Dimension:
        return NUMBER.times(self, exponent)

    def fits(self, wanted: Dimension) -> bool:
        """Whether it may stand where `wanted` is asked for.

        Radians may come and go beside other dimensions (1/s for rad/s, rad/s * m for m/s), but a ratio alone
        is not an angle.
        """
        return self == wanted or (self._plain() == wanted._plain() != NUMBER)

    def _plain(self) -> Dimension:
        return Dimension(self.length, self.mass, self.time)

    @property
    def name(self) -> str | None:
        """`length`, `moment of force`, ...; None for a dimension that has no name here."""
        return next((name for name, kind in KINDS.items() if kind.dimension == self), None)

    def __str__(self) -> str:
        """With its article: `a length`, `an angle`."""
        if name := self.name:
            return f"an {name}" if name[0] in "aeiou" else f"a {name}"
        bases = {"m": self.length, "kg": self.mass, "s": self.time, "rad": self.angle}
        return f"a quantity in {product_text(bases)}"

    @property
    def example(self) -> str:
        """The words for `allowed`: `an angle, e.g. 30 deg or 0.5 rad`."""
        name = self.name
        return f"{self}, e.g. {KINDS[name].example}" if name else str(self)


class Kind(NamedTuple):
    """A dimension with a name: the unit of bare numbers unless the file says otherwise, and an example."""

    dimension: Dimension
    default: str
    example: str


NUMBER: Final = Dimension()
LENGTH: Final = Dimension(length=1)
ANGLE: Final = Dimension(angle=1)
TIME: Final = Dimension(time=1)
MASS: Final = Dimension(mass=1)
FORCE: Final = Dimension(1, 1, -2)
MOMENT: Final = Dimension(2, 1, -2)
INERTIA: Final = Dimension(2, 1)
SPEED: Final = Dimension(1, 0, -1)
ACCELERATION: Final = Dimension(1, 0, -2)
ANGULAR_SPEED: Final = Dimension(0, 0, -1, 1)
ANGULAR_ACCELERATION: Final = Dimension(0, 0, -2, 1)
STIFFNESS: Final = Dimension(0, 1, -2)
TORSION: Final = Dimension(2, 1, -2, -1)
DAMPING: Final = Dimension(0, 1, -1)
TORSION_DAMPING: Final = Dimension(2, 1, -1, -1)

KINDS: Final[Mapping[str, Kind]] = {
    "number": Kind(NUMBER, "", "0.5 or 50 %"),
    "length": Kind(LENGTH, "mm", "110 mm or 0.11 m"),
    "angle": Kind(ANGLE, "deg", "30 deg or 0.5 rad"),
    "time": Kind(TIME, "s", "0.5 s"),
    "mass": Kind(MASS, "kg", "22 kg"),
    "force": Kind(FORCE, "N", "1500 N or 1.5 kN"),
    "moment of force": Kind(MOMENT, "N*m", "20 N*m"),
    "moment of inertia": Kind(INERTIA, "kg*m^2", "1.1 kg*m^2"),
    "speed": Kind(SPEED, "m/s", "0.2 m/s"),
    "acceleration": Kind(ACCELERATION, "m/s^2", "3 m/s^2"),
    "angular speed": Kind(ANGULAR_SPEED, "rad/s", "82 rpm or 8.6 rad/s"),
    "angular acceleration": Kind(ANGULAR_ACCELERATION, "rad/s^2", "5 rad/s^2"),
    "stiffness": Kind(STIFFNESS, "N/m", "800 N/m"),
    "torsional stiffness": Kind(TORSION, "N*m/rad", "2 N*m/rad"),
    "damping": Kind(DAMPING, "N*s/m", "50 N*s/m"),
    "torsional damping": Kind(TORSION_DAMPING, "N*m*s/rad", "0.1 N*m*s/rad"),
}


def product_text(powers: Mapping[str, int]) -> str:
    """`m^2·s^-1` from names and powers."""
    return "·".join(name if power == 1 else f"{name}^{power}" for name, power in powers.items() if power)
