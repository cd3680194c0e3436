"""Units in Latin and Cyrillic letters, their conversion to SI and radians, and the units of a file."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, partial, reduce
from typing import Any, Final

import numpy as np

from tmm_cli.language import ENGLISH, _, language, spelt
from tmm_cli.mechanics.numerics import PI, DoubleDouble
from tmm_cli.mechanics.quantities import (
    ANGLE,
    ANGULAR_SPEED,
    DIMENSIONS,
    FORCE,
    LENGTH,
    MASS,
    MOMENT,
    NUMBER,
    PRESSURE,
    TIME,
    Dimension,
    product_text,
)
from tmm_cli.problem.errors import ProblemError, nearest_name, prefix_errors, quote, to_latin, unknown_name_error
from tmm_cli.problem.scalars import finite_float


class UnitError(ProblemError):
    """Error for a unit that is unknown or belongs to another quantity."""


_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_LONG: Final = {"moment": "moment of force", "inertia": "moment of inertia"}


@dataclass(frozen=True)
class Unit:
    """A unit; its value in SI and radians is scale * math.pi**pi.

    The scale is an exact fraction, so that 110 mm is converted to 0.11 m to the last bit.

    Attributes:
        dimension: dimension of the unit.
        scale: rational factor.
        pi: power of the number pi in the unit.
    """

    dimension: Dimension
    scale: Fraction = Fraction(1)
    pi: int = 0

    def times(self, other: Unit, power: int = 1) -> Unit:
        return Unit(
            self.dimension.times(other.dimension, power),
            self.scale * other.scale**power,
            self.pi + power * other.pi,
        )

    def si(self, number: float) -> float:
        """Convert a number in this unit to SI and radians, without loss of precision for double-double numbers."""
        if self.pi:
            number = number * _pi(number) ** self.pi
        return number * self.scale.numerator / self.scale.denominator

    def from_si(self, value: Any) -> Any:
        """Convert a number or an array from SI and radians to this unit."""
        return value / math.pi**self.pi * self.scale.denominator / self.scale.numerator


def _pi(number: float) -> float:
    """Return pi in the precision of the number."""
    return DoubleDouble.decimal(PI) if isinstance(number, DoubleDouble) else math.pi


@dataclass(frozen=True)
class PhysicalValue:
    """A number with its dimension, in SI and radians.

    If the dimension is None, it is a bare number as written, whose unit follows from its use.
    """

    value: float
    dimension: Dimension | None = None


_ROWS: Final = (  # names, what the unit measures, and how much it is in SI and radians
    ("m м", LENGTH, "1"),
    ("mm мм", LENGTH, "1/1000"),
    ("cm см", LENGTH, "1/100"),
    ("dm дм", LENGTH, "1/10"),
    ("um μm мкм", LENGTH, "1/1000000"),
    ("km км", LENGTH, "1000"),
    ("in", LENGTH, "127/5000"),
    ("rad рад", ANGLE, "1"),
    ("deg ° град", ANGLE, "pi/180"),
    ("rev turn turns об o", ANGLE, "pi*2"),
    ("s sec с сек", TIME, "1"),
    ("ms мс", TIME, "1/1000"),
    ("min мин", TIME, "60"),
    ("h ч", TIME, "3600"),
    ("rpm", ANGULAR_SPEED, "pi/30"),
    ("Hz Гц", ANGULAR_SPEED, "pi*2"),
    ("kg кг", MASS, "1"),
    ("g г", MASS, "1/1000"),
    ("t т", MASS, "1000"),
    ("N Н", FORCE, "1"),
    ("kN кН", FORCE, "1000"),
    ("MN МН", FORCE, "1000000"),
    ("kgf кгс", FORCE, "980665/100000"),
    ("tf тс", FORCE, "980665/100"),
    ("Nm Нм", MOMENT, "1"),
    ("kNm кНм", MOMENT, "1000"),
    ("Nmm Нмм", MOMENT, "1/1000"),
    ("Pa Па", PRESSURE, "1"),
    ("kPa кПа", PRESSURE, "1000"),
    ("MPa МПа", PRESSURE, "1000000"),
    ("bar бар", PRESSURE, "100000"),
    ("at ат", PRESSURE, "980665/10"),
    ("%", NUMBER, "1/100"),
)
SYMBOLS: Final[Mapping[str, Unit]] = {
    name: Unit(kind, Fraction(scale.replace("pi/", "1/").replace("pi*", "")), int("pi" in scale))
    for names, kind, scale in _ROWS
    for name in names.split()
}
_PER_MINUTE: Final = SYMBOLS["rpm"]  # a bare "per minute" counts turns in machine theory, a bare "per second" radians
_LOOKALIKES: Final = {to_latin(name): unit for name, unit in SYMBOLS.items()}
_FIRST: Final = {to_latin(name): names.split()[0] for names, *__ in _ROWS for name in names.split()}

_SUPERSCRIPT = re.compile("[⁺⁻⁰¹²³⁴-⁹]+")
_LETTERS = re.compile("[^\\W\\d_⁰¹²³⁴-⁹]+|°")
_FROM_SUPERSCRIPT = str.maketrans("⁺⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "+-0123456789")
_TYPOGRAPHY = str.maketrans("⋅∙•×−–µº\xa0\u2007\u2009\u202f\t\r\n", "···*--μ°       ")
_FACTOR = re.compile(r"\s*([·*/]?)\s*([^\W\d_]+|°|%|1(?=\s*/))(?:\^\s*\(?([+-]?\d+)\)?|(\d))?")
# A power of time without its sign, as in `с-1` and `м·с-2`: after other units a minus is a subtraction.
PER_TIME: Final = r"(?:s|sec|ms|min|h|с|сек|мс|мин|ч|c)-[1-4](?![\w.])"
_PER_TIME = re.compile(rf"(?<![^\W\d_]){PER_TIME}")


def plain_text(text: str) -> str:
    """Replace typographic characters in a text by those of a keyboard.

    Superscripts become ^n, and ** becomes ^. Typographic signs and spaces become ASCII characters.
    """
    text = _SUPERSCRIPT.sub(lambda match: "^" + match[0].translate(_FROM_SUPERSCRIPT), text)
    return text.translate(_TYPOGRAPHY).replace("**", "^")


def find_unit(name: str) -> Unit | None:
    """Return the unit with this symbol, or None. Cyrillic and Latin letters that look alike may replace each other."""
    return SYMBOLS.get(name) or _LOOKALIKES.get(to_latin(name))


def to_latin_unit(text: str) -> str:
    """Replace the non-ASCII symbols in a known unit by Latin ones, e.g. ° and град by deg."""
    text = _sign_powers(text)
    return _LETTERS.sub(lambda name: name[0] if name[0].isascii() else _FIRST.get(to_latin(name[0]), name[0]), text)


def _sign_powers(text: str) -> str:
    """Insert the sign ^ before negative powers of a unit: `s-1` becomes `s^-1`."""
    return _PER_TIME.sub(lambda match: match[0].replace("-", "^-"), text)


def parse_unit(text: str) -> Unit:
    """Parse a unit written as products, quotients and powers of symbols: `kg·m²`, `об/мин`, `N*m`, `1/s`.

    Raises:
        UnitError: the text is not a unit; the error names the most similar symbol.
    """
    source, unit, position, factors = _sign_powers(plain_text(text).strip()), Unit(NUMBER), 0, 0
    names: list[str] = []
    while position < len(source):
        match = _FACTOR.match(source, position)
        if not match or (match[1] and not position) or factors >= 8:
            raise UnitError(
                _("this is not a valid unit"), found=quote(text), allowed=_("e.g. mm, deg, rpm, kN, N*m, kg*m^2, m/s^2")
            )
        sign, name, power, digit = match.groups()
        exponent = int((power or digit or "1")[:6]) * (-1 if sign == "/" else 1)
        if abs(exponent) > 4:
            raise UnitError(
                _("this is not a valid unit: the power is too large"), found=quote(text), allowed=_("powers up to 4")
            )
        if name != "1":
            factor = find_unit(name)
            if factor is None:
                raise unknown_unit_error(name)
            unit = unit.times(factor, exponent)
            names.append(name)
        position, factors = match.end(), factors + 1
    if not factors:
        raise UnitError(_("a unit is missing"), found=quote(text), allowed=_("e.g. mm, deg, rpm, kN"))
    alone = len(names) == 1 and find_unit(names[0]) == SYMBOLS["min"]
    return _PER_MINUTE if alone and unit.dimension == Dimension(time=-1) else unit


def unknown_unit_error(name: str) -> UnitError:
    """Return the error for an unknown unit, with the most similar known symbol."""
    near = nearest_name(name, SYMBOLS)
    return UnitError(_("unknown unit"), found=quote(name), allowed=_("e.g. mm, deg, rpm, kg, N, N*m"), near=near)


def dotted_unit_error(text: str) -> UnitError:
    """Return the error for a unit with dots, such as `об.мин`; it names the unit that was probably meant."""
    bare = text.replace("./", "/").rstrip(".")
    meant = next(
        (spelling for spelling in (bare.replace(".", sign) for sign in ("", "/", "*")) if _is_known_kind(spelling)),
        None,
    )
    return UnitError(_("a unit is written without dots"), found=quote(text), allowed=meant)


def _is_known_kind(text: str) -> bool:
    """Return True if the text is a unit of a quantity that a file may contain."""
    try:
        return parse_unit(text).dimension in {kind.dimension for kind in DIMENSIONS.values()}
    except UnitError:
        return False


class UnitSystem:
    """Units of the bare numbers in a file and of the tables of its results."""

    def __init__(self, names: Mapping[str, str] | None = None) -> None:
        """Create the unit system of a file.

        Args:
            names: unit by kind of quantity, e.g. `{length: mm, angular speed: rpm}`; other kinds have default units.

        Raises:
            ProblemError: a kind or a unit is unknown, or a unit is of another kind. The path of the error is the key.
        """
        self._names = {kind.dimension: kind.default for kind in DIMENSIONS.values()}
        for key, name in (names or {}).items():
            full = _LONG.get(key, key.replace("_", " "))
            if full not in DIMENSIONS or full == "number":
                short = {long: short for short, long in _LONG.items()}
                keys = [short.get(kind, kind) for kind in DIMENSIONS if kind != "number"]
                raise unknown_name_error(key, keys, _("unknown key"), path=(key,), key=True)
            kind = DIMENSIONS[full]
            with prefix_errors(key):
                named_dimension = parse_unit(name).dimension
                if not named_dimension.fits(kind.dimension):
                    allowed = _("a unit for this quantity: {full}, e.g. {default}").format(
                        full=full, default=kind.default
                    )
                    raise UnitError(
                        _("this is a unit of another quantity"),
                        found=f"{quote(name)}, {named_dimension}",
                        allowed=allowed,
                    )
            self._names[kind.dimension] = to_latin_unit(name)
        self._units = {dimension: parse_unit(name) if name else Unit(NUMBER) for dimension, name in self._names.items()}

    functions: Mapping[str, Any] = {**vars(math), "min": min, "max": max, "abs": abs}  # what arithmetic computes with

    def number(self, written: str | int | float) -> float:
        """Convert a number as written in the file to a float."""
        return finite_float(written) if isinstance(written, str) else float(written)

    def unit(self, dimension: Dimension) -> Unit:
        """Return the unit that the file uses for a dimension.

        If the file specifies no unit for it, this is a product of powers of the units of length, mass, time and angle.
        """
        if dimension in self._units:
            return self._units[dimension]
        unit = Unit(NUMBER)
        for base, power in _base_powers(dimension):
            unit = unit.times(self._units[base], power)
        return unit

    def si(self, number: float, dimension: Dimension) -> float:
        """Convert a number without a unit, as written in the file, to SI and radians."""
        return self.unit(dimension).si(number)

    def from_si(self, value: float, dimension: Dimension) -> float:
        """Convert a value in SI and radians to the unit that the file uses for its dimension."""
        number: float = self.unit(dimension).from_si(value)
        return number

    def factor(self, dimension: Dimension) -> float:
        """Return the value in SI and radians of the unit that the file uses for a dimension."""
        return self.si(1.0, dimension)

    def symbol(self, dimension: Dimension) -> str:
        """Return the symbol, in Latin letters, of the unit that the file uses for a dimension; empty for
        dimensionless numbers.
        """
        if dimension in self._names:
            return self._names[dimension]
        return product_text({self._names[base]: power for base, power in _base_powers(dimension)})

    def spelt(self, dimension: Dimension) -> str:
        """Return the symbol of the unit that the file uses for a dimension, in the current language: N*m, in Russian
        Н·м.
        """
        unit = self.symbol(dimension)
        return unit if language() == ENGLISH else typeset_unit(spelt(unit))

    def format_value(self, value: float, dimension: Dimension, digits: int = 6) -> str:
        """Format a value in SI and radians for a message, e.g. `30 deg`."""
        return f"{self.from_si(value, dimension):.{digits}g} {self.spelt(dimension)}"

    def describe(self, quantity: PhysicalValue) -> str:
        """Describe a value for a message, e.g. `a length (110 mm)` or `a number without a unit (5)`."""
        if quantity.dimension is None:
            return _("a number without a unit ({number})").format(number=f"{quantity.value:.6g}")
        number, unit = self.from_si(quantity.value, quantity.dimension), self.symbol(quantity.dimension)
        return f"{quantity.dimension} ({number:.6g} {unit}".rstrip() + ")"


def _base_powers(dimension: Dimension) -> list[tuple[Dimension, int]]:
    powers = (dimension.length, dimension.mass, dimension.time, dimension.angle)
    return [(base, power) for base, power in zip((LENGTH, MASS, TIME, ANGLE), powers, strict=True) if power]


@cache
def typeset_unit(unit: str) -> str:
    """Typeset a unit for print: m/s² instead of m/s^2, N·m instead of N*m."""
    return re.sub(r"\^(-?\d+)", lambda power: power[1].translate(_RAISED), unit).replace("*", "·")


# Units of files whose numbers are not plain floats: double-doubles, or arrays over varied linkages.


FUNCTIONS = {
    "sin": np.sin,
    "cos": np.cos,
    "tan": np.tan,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    "atan2": np.arctan2,
    "hypot": np.hypot,
    "sqrt": np.sqrt,
    "min": partial(reduce, np.minimum),
    "max": partial(reduce, np.maximum),
    "abs": abs,
}


class ExtendedUnits(UnitSystem):
    """Unit system for double-double numbers (31 digits), which are read from the decimals as written in the file."""

    functions = {**FUNCTIONS, "pi": DoubleDouble.decimal(PI)}  # noqa: RUF012  a table

    def number(self, written: str | int | float) -> float:
        super().number(written)  # refuses what float64 has no place for
        number: Any = DoubleDouble.decimal(written if isinstance(written, str) else repr(written))
        return number  # type: ignore[no-any-return]


class VariedUnits(UnitSystem):
    """Unit system whose calculations also accept arrays of parameter values, one element per variant (see
    tmm_cli.batch).
    """

    functions = {**FUNCTIONS, "pi": float(PI)}  # noqa: RUF012  a table

    def __init__(self, units: UnitSystem) -> None:
        vars(self).update(vars(units))
