"""Quantities of motion, forces and energy: name, dimension, and how each is read from its record.

There is a tuple of quantities for each kind of object: points, links, prismatic pairs, reactions, loads, drivers,
forces on the Zhukovsky lever, and the whole mechanism. An object is a record of arrays with one value for each
position, such as `kinematics.motion.PointMotion` or `forces.plan.Reaction`. The tuples determine

- the columns of tables, one for every header of a quantity (`quantity_columns`);
- the keys of result.json, and in its schema their descriptions and units;
- how goals of optimal synthesis read reactions and the balancing moment;
- which quantities `prepare` and the rounding bounds give for each object: those marked `leading`.

To add a quantity of a point, for example, add an attribute to `PointMotion` and a line to POINT.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import repeat
from typing import Any, Final, NamedTuple

import numpy as np

from tmm_cli.language import N_, _


@dataclass(frozen=True)
class Dimension:
    """A physical dimension, given by the exponents of length, mass, time and angle."""

    length: int = 0
    mass: int = 0
    time: int = 0
    angle: int = 0

    def times(self, other: Dimension, power: int = 1) -> Dimension:
        """Return the dimension of a product: this dimension times other**power."""
        return Dimension(
            self.length + power * other.length,
            self.mass + power * other.mass,
            self.time + power * other.time,
            self.angle + power * other.angle,
        )

    def power(self, exponent: int) -> Dimension:
        return NUMBER.times(self, exponent)

    def fits(self, required: Dimension) -> bool:
        """Return True if a value of this dimension is accepted where the dimension `required` is expected.

        Radians are ignored beside other dimensions (1/s for rad/s, rad/s * m for m/s), but a pure number is not
        accepted as an angle.
        """
        return self == required or (self._plain() == required._plain() != NUMBER)

    def _plain(self) -> Dimension:
        return Dimension(self.length, self.mass, self.time)

    @property
    def name(self) -> str | None:
        """Name of the dimension, e.g. "length" or "moment of force"; None if it is not in DIMENSIONS."""
        return next((name for name, kind in DIMENSIONS.items() if kind.dimension == self), None)

    def __str__(self) -> str:
        """Return the name with its article, in the current language: "a length", "an angle"."""
        if name := self.name:
            return _(NAMES_WITH_ARTICLE[name])
        bases = {"m": self.length, "kg": self.mass, "s": self.time, "rad": self.angle}
        return _("a quantity in {unit}").format(unit=product_text(bases))

    @property
    def example(self) -> str:
        """Name of the dimension with an example, for error messages: "an angle, e.g. 30 deg or 0.5 rad"."""
        name = self.name
        return (
            _("{kind}, e.g. {example}").format(kind=self, example=_translate_example(DIMENSIONS[name].example))
            if name
            else str(self)
        )


def _translate_example(examples: str) -> str:
    """Translate the word "or" of an example such as "30 deg or 0.5 rad"."""
    first, __, second = examples.partition(" or ")
    return _("{one} or {other}").format(one=first, other=second) if second else first


class NamedDimension(NamedTuple):
    """A dimension that has a name.

    Attributes:
        dimension: the dimension.
        default: unit assumed for a number without a unit.
        example: example of a value with its unit, for error messages.
    """

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
AREA: Final = Dimension(2)
PRESSURE: Final = Dimension(-1, 1, -2)
DENSITY: Final = Dimension(-3, 1)
SPEED: Final = Dimension(1, 0, -1)
ACCELERATION: Final = Dimension(1, 0, -2)
ANGULAR_SPEED: Final = Dimension(0, 0, -1, 1)
ANGULAR_ACCELERATION: Final = Dimension(0, 0, -2, 1)
JERK: Final = Dimension(1, 0, -3)
ANGULAR_JERK: Final = Dimension(0, 0, -3, 1)
STIFFNESS: Final = Dimension(0, 1, -2)
TORSION: Final = Dimension(2, 1, -2, -1)
DAMPING: Final = Dimension(0, 1, -1)
TORSION_DAMPING: Final = Dimension(2, 1, -1, -1)
QUADRATIC_DAMPING: Final = Dimension(-1, 1)
TORSION_QUADRATIC_DAMPING: Final = Dimension(2, 1, 0, -2)

DIMENSIONS: Final[Mapping[str, NamedDimension]] = {
    "number": NamedDimension(NUMBER, "", "0.5 or 50 %"),
    "length": NamedDimension(LENGTH, "mm", "110 mm or 0.11 m"),
    "angle": NamedDimension(ANGLE, "deg", "30 deg or 0.5 rad"),
    "time": NamedDimension(TIME, "s", "0.5 s"),
    "mass": NamedDimension(MASS, "kg", "22 kg"),
    "force": NamedDimension(FORCE, "N", "1500 N or 1.5 kN"),
    "moment of force": NamedDimension(MOMENT, "N*m", "20 N*m"),
    "moment of inertia": NamedDimension(INERTIA, "kg*m^2", "1.1 kg*m^2"),
    "speed": NamedDimension(SPEED, "m/s", "0.2 m/s"),
    "acceleration": NamedDimension(ACCELERATION, "m/s^2", "3 m/s^2"),
    "angular speed": NamedDimension(ANGULAR_SPEED, "rad/s", "82 rpm or 8.6 rad/s"),
    "angular acceleration": NamedDimension(ANGULAR_ACCELERATION, "rad/s^2", "5 rad/s^2"),
    "jerk": NamedDimension(JERK, "m/s^3", "40 m/s^3"),
    "angular jerk": NamedDimension(ANGULAR_JERK, "rad/s^3", "90 rad/s^3"),
    "stiffness": NamedDimension(STIFFNESS, "N/m", "800 N/m"),
    "torsional stiffness": NamedDimension(TORSION, "N*m/rad", "2 N*m/rad"),
    "damping": NamedDimension(DAMPING, "N*s/m", "50 N*s/m"),
    "torsional damping": NamedDimension(TORSION_DAMPING, "N*m*s/rad", "0.1 N*m*s/rad"),
    "quadratic damping": NamedDimension(QUADRATIC_DAMPING, "N*s^2/m^2", "30 N*s^2/m^2"),
    "torsional quadratic damping": NamedDimension(TORSION_QUADRATIC_DAMPING, "N*m*s^2/rad^2", "0.2 N*m*s^2/rad^2"),
    "pressure": NamedDimension(PRESSURE, "MPa", "1.2 MPa or 12 bar"),
    "density": NamedDimension(DENSITY, "kg/m^3", "7800 kg/m^3"),
}


NAMES_WITH_ARTICLE: Final[Mapping[str, str]] = {
    "number": N_("a number"),
    "length": N_("a length"),
    "angle": N_("an angle"),
    "time": N_("a time"),
    "mass": N_("a mass"),
    "force": N_("a force"),
    "moment of force": N_("a moment of force"),
    "moment of inertia": N_("a moment of inertia"),
    "speed": N_("a speed"),
    "acceleration": N_("an acceleration"),
    "pressure": N_("a pressure"),
    "angular speed": N_("an angular speed"),
    "angular acceleration": N_("an angular acceleration"),
    "jerk": N_("a jerk"),
    "angular jerk": N_("an angular jerk"),
    "stiffness": N_("a stiffness"),
    "torsional stiffness": N_("a torsional stiffness"),
    "damping": N_("a damping coefficient"),
    "torsional damping": N_("a torsional damping coefficient"),
    "quadratic damping": N_("a coefficient of the squared speed"),
    "torsional quadratic damping": N_("a coefficient of the squared angular velocity"),
    "density": N_("a density"),
}


def product_text(powers: Mapping[str, int]) -> str:
    """Write a product of powers: `m^2*s^-1` for {"m": 2, "s": -1}."""
    return "*".join(name if power == 1 else f"{name}^{power}" for name, power in powers.items() if power)


NamedValues = tuple[str, Any, Dimension]  # header, values at the positions (None if undefined), dimension


@dataclass(frozen=True)
class Quantity:
    """A quantity of an object, with one value for each position (SI units and radians).

    Attributes:
        name: key in result.json, and name of the attribute of the record unless `read` is given.
        text: description in the schema of result.json.
        unit: unit in the schema.
        dimension: physical dimension.
        headers: headings of its table columns. A vector has columns for x, y and possibly the magnitude, or for the
            magnitude alone. Empty if the quantity is in no table.
        vector: True for a vector (complex, x + iy).
        read: function that reads the values from the record; by default the attribute `name`.
        of_slider: heading and dimension for a sliding driver, if they differ.
        leading: True if `prepare` and the rounding bounds give it.
        symbol: name in `prepare`; by default `name`.
        goes_with: name of an attribute that is None for objects without this quantity.
    """

    name: str
    text: str
    unit: str
    dimension: Dimension
    headers: tuple[str, ...] = ()
    vector: bool = False
    read: Callable[[Any], Any] | None = None
    of_slider: tuple[str, Dimension] | None = None
    leading: bool = False
    symbol: str = ""
    goes_with: str = ""

    def value(self, record: Any) -> Any:
        """Return the values of this quantity, read from a record."""
        return getattr(record, self.name) if self.read is None else self.read(record)

    def there(self, record: Any) -> bool:
        """Return True if the object of this record has the quantity."""
        return not self.goes_with or getattr(record, self.goes_with) is not None

    def measures(self, slider: bool) -> Dimension:
        """Return the dimension of the quantity; slider: True for a mechanism with a sliding driver."""
        return self.of_slider[1] if slider and self.of_slider is not None else self.dimension

    def columns(self, record: Any, slider: bool = False) -> Iterator[NamedValues]:
        """Yield the table columns of this quantity: heading, values, dimension.

        Args:
            record: the record of the object; None for columns without values.
            slider: True for a mechanism with a sliding driver.
        """
        value = None if record is None else self.value(record)
        parts: Iterable[Any] = (value,)
        if value is None:
            parts = repeat(None)
        elif self.vector:
            parts = () if len(self.headers) == 1 else (value.real, value.imag)
            parts = parts if len(self.headers) == len(parts) else (*parts, np.abs(value))
        headers = (self.of_slider[0],) if slider and self.of_slider is not None else self.headers
        for header, values in zip(headers, parts, strict=False):
            yield header, values, self.measures(slider)


def quantity_columns(quantities: Iterable[Quantity], record: Any, slider: bool = False) -> list[NamedValues]:
    """Return the table columns of several quantities of one record."""
    return [column for quantity in quantities for column in quantity.columns(record, slider)]


def coordinate_dimension(kind: str) -> Dimension:
    """Return the dimension of the coordinate of a driver or output.

    kind: "slide" for a displacement (m); "turn" or "swing" for an angle (rad).
    """
    return LENGTH if kind == "slide" else ANGLE


PER_UNIT: Final = "SI, per unit of the driver coordinate"

POINT: Final = (
    Quantity("x", "position", "m", LENGTH, (N_("x"), N_("y")), vector=True, leading=True),
    Quantity("v", "velocity", "m/s", SPEED, (N_("vx"), N_("vy"), N_("v")), vector=True, leading=True),
    Quantity("a", "acceleration", "m/s^2", ACCELERATION, (N_("ax"), N_("ay"), N_("a")), vector=True, leading=True),
    Quantity(
        "first",
        "derivative of the position with respect to the driver coordinate",
        PER_UNIT,
        NUMBER,
        (N_("dx/dq, SI"), N_("dy/dq, SI")),
        vector=True,
    ),
    Quantity(
        "second",
        "second derivative with respect to the driver coordinate",
        PER_UNIT,
        NUMBER,
        (N_("d2x/dq2, SI"), N_("d2y/dq2, SI")),
        vector=True,
    ),
)

LINK: Final = (
    Quantity("angle", "angle of the x axis of the link", "rad", ANGLE, (N_("angle"),), leading=True),
    Quantity("omega", "angular speed", "rad/s", ANGULAR_SPEED, (N_("omega"),), leading=True),
    Quantity("epsilon", "angular acceleration", "rad/s^2", ANGULAR_ACCELERATION, (N_("epsilon"),), leading=True),
    Quantity(
        "first",
        "derivative of the angle with respect to the driver coordinate",
        PER_UNIT,
        NUMBER,
        (N_("first transfer function, SI"),),
    ),
    Quantity(
        "second",
        "second derivative with respect to the driver coordinate",
        PER_UNIT,
        NUMBER,
        (N_("second transfer function, SI"),),
    ),
)

SLIDE: Final = (
    Quantity("run", "displacement of the runner along the guide of the carrier", "m", LENGTH, (N_("s"),)),
    Quantity("v", "relative velocity", "m/s", SPEED, (N_("v relative"),)),
    Quantity("a", "relative acceleration", "m/s^2", ACCELERATION, (N_("a relative"),)),
    Quantity(
        "coriolis",
        "Coriolis acceleration",
        "m/s^2",
        ACCELERATION,
        (N_("a Coriolis x"), N_("a Coriolis y"), N_("a Coriolis")),
        vector=True,
    ),
    Quantity(
        "first",
        "derivative of the displacement with respect to the driver coordinate",
        PER_UNIT,
        NUMBER,
        (N_("first transfer function, SI"),),
    ),
    Quantity(
        "second",
        "second derivative with respect to the driver coordinate",
        PER_UNIT,
        NUMBER,
        (N_("second transfer function, SI"),),
    ),
)

REACTION_SIZE: Final = Quantity(
    "size", "magnitude of the force", "N", FORCE, (N_("F"),), read=lambda r: np.abs(r.force)
)
REACTION: Final = (
    Quantity("force", "force on link `on`", "N", FORCE, (N_("Fx"), N_("Fy")), vector=True, leading=True, symbol="R"),
    REACTION_SIZE,
    Quantity("angle", "direction of the force; null where the force is zero", "rad", ANGLE, (N_("angle"),)),
    Quantity("at", "point of action: the hinge or the sliding point", "m", LENGTH, vector=True),
    Quantity(
        "tangential",
        "external hinges: component perpendicular to the link",
        "N",
        FORCE,
        (N_("R tangential"),),
        vector=True,
        goes_with="normal",
    ),
    Quantity(
        "normal",
        "external hinges: component along the link",
        "N",
        FORCE,
        (N_("R normal"),),
        vector=True,
        goes_with="tangential",
    ),
    Quantity("signed", "guides: force, positive towards the left normal of the guide", "N", FORCE, goes_with="couple"),
    Quantity(
        "couple",
        "guides: couple about the sliding point",
        "N*m",
        MOMENT,
        (N_("couple"),),
        leading=True,
        symbol="M",
        goes_with="couple",
    ),
    Quantity(
        "arm",
        "guides: distance from the sliding point to the point of action of the force, along the guide",
        "m",
        LENGTH,
        (N_("point of action"),),
        goes_with="couple",
    ),
)

LOAD: Final = (
    Quantity("force", "force", "N", FORCE, (N_("Fx"), N_("Fy"), N_("F")), vector=True),
    Quantity("moment", "couple", "N*m", MOMENT, (N_("M"),)),
)

TRANSMITTED: Final = (
    Quantity("driving", "reaction in the pair in which the link is driven", "N", FORCE, (N_("P"),)),
    Quantity("useful", "component of this reaction along the velocity of its point of action", "N", FORCE, (N_("Q"),)),
)

BALANCE: Final = (
    Quantity("moment", "balancing moment; null for a driven slider", "N*m", MOMENT, (N_("M_b"),)),
    Quantity(
        "force",
        "balancing force, perpendicular to the crank at its end, or along the driven slider",
        "N",
        FORCE,
        (N_("F_b"),),
    ),
    Quantity("vector", "balancing force", "N", FORCE, vector=True),
    Quantity("at", "point of action of the balancing force", "m", LENGTH, vector=True),
)
BALANCING: Final = Quantity(
    "balancing",
    "balancing moment of a rotating driver, or balancing force of a sliding one",
    "N*m or N",
    MOMENT,
    (N_("M_b"),),
    of_slider=(N_("F_b"), FORCE),
    leading=True,
    symbol="T",
    read=lambda balance: balance.generalized,
)

LEVER_FORCE: Final = (
    Quantity("size", "magnitude of the force", "N", FORCE, (N_("force"),)),
    Quantity("arm", "moment arm about the pole", "m per rad", LENGTH, (N_("arm"),), of_slider=(N_("arm"), NUMBER)),
)
LEVER_COUPLE: Final = (
    Quantity("size", "moment of the couple", "N*m", MOMENT, (N_("couple"),)),
    Quantity("arm", "angular velocity of the link divided by that of the driver", "", NUMBER, (N_("omega / omega_1"),)),
)
LEVER_MOMENT: Final = Quantity(
    "moment", "moment about the pole", "N*m or N", MOMENT, (N_("moment"),), of_slider=(N_("moment"), FORCE)
)

ENERGY: Final = (
    Quantity(
        "inertia",
        "reduced moment of inertia, or reduced mass for a sliding driver",
        "kg*m^2 or kg",
        INERTIA,
        (N_("J reduced"),),
        of_slider=(N_("m reduced"), MASS),
    ),
    Quantity(
        "slope",
        "derivative of the reduced inertia with respect to the driver coordinate",
        "SI",
        NUMBER,
        (N_("dJ/dphi, SI"),),
        of_slider=(N_("dm/ds, SI"), NUMBER),
    ),
    Quantity(
        "moment",
        "reduced moment of all forces except inertia forces; reduced force for a sliding driver",
        "N*m or N",
        MOMENT,
        (N_("M reduced"),),
        of_slider=(N_("F reduced"), FORCE),
    ),
    Quantity("kinetic", "kinetic energy", "J", NUMBER, (N_("kinetic energy, J"),)),
    Quantity("rate", "rate of change of the kinetic energy", "W", NUMBER, (N_("rate of change of kinetic energy, W"),)),
    Quantity("drivers", "power of the drivers", "W", NUMBER, (N_("power of the drivers, W"),)),
    Quantity("weights", "power of weights", "W", NUMBER, (N_("power of the weights, W"),)),
    Quantity("loads", "power of loads", "W", NUMBER, (N_("power of the loads, W"),)),
    Quantity(
        "dampers",
        "power of dampers, contained in the power of loads",
        "W",
        NUMBER,
        (N_("of which dampers, W"),),
        goes_with="dampers",
    ),
    Quantity("friction", "power of friction", "W", NUMBER, (N_("power of friction, W"),)),
    Quantity(
        "balance", "sum of all powers less the rate of the kinetic energy, divided by the largest of them", "", NUMBER
    ),
)
