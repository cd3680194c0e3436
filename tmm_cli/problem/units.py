"""Units as people write them, in Latin and Cyrillic, to SI and radians; and what bare numbers mean in a file."""

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
    """A unit that is not known, or that measures something else."""


_RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_LONG: Final = {"moment": "moment of force", "inertia": "moment of inertia"}


@dataclass(frozen=True)
class Unit:
    """One unit in SI and radians: scale * pi**pi. The scale is exact, so 110 mm is 0.11 m to the last bit."""

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
        """The number of these units in SI and radians, in the number's own precision."""
        if self.pi:
            number = number * _pi(number) ** self.pi
        return number * self.scale.numerator / self.scale.denominator

    def from_si(self, value: Any) -> Any:
        """A value, or an array of them, in SI and radians in these units."""
        return value / math.pi**self.pi * self.scale.denominator / self.scale.numerator


def _pi(number: float) -> float:
    """Pi as exactly as the number."""
    return DoubleDouble.decimal(PI) if isinstance(number, DoubleDouble) else math.pi


@dataclass(frozen=True)
class PhysicalValue:
    """A value in SI and radians; without a dimension a bare number, in the file's unit where it is used."""

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
# A power of time without its sign, as in `с-1` and `м·с-2`: of other units a minus is that of a difference.
PER_TIME: Final = r"(?:s|sec|ms|min|h|с|сек|мс|мин|ч|c)-[1-4](?![\w.])"
_PER_TIME = re.compile(rf"(?<![^\W\d_]){PER_TIME}")


def plain_text(text: str) -> str:
    """The text with superscripts as ^n, ** as ^, and typographic signs and spaces as their keyboard ones."""
    text = _SUPERSCRIPT.sub(lambda found: "^" + found[0].translate(_FROM_SUPERSCRIPT), text)
    return text.translate(_TYPOGRAPHY).replace("**", "^")


def find_unit(name: str) -> Unit | None:
    """The unit of one symbol, also when Cyrillic letters stand for their Latin look-alikes or the reverse."""
    return SYMBOLS.get(name) or _LOOKALIKES.get(to_latin(name))


def to_latin_unit(text: str) -> str:
    """A unit that is known, with the names that are not in ASCII by their first ones: deg for ° and for град."""
    text = _sign_powers(text)
    return _LETTERS.sub(lambda name: name[0] if name[0].isascii() else _FIRST.get(to_latin(name[0]), name[0]), text)


def _sign_powers(text: str) -> str:
    """A unit with `s^-1` for `s-1`."""
    return _PER_TIME.sub(lambda found: found[0].replace("-", "^-"), text)


def parse_unit(text: str) -> Unit:
    """The unit written as products, quotients and powers of symbols: `kg·m²`, `об/мин`, `N*m`, `1/s`.

    Raises UnitError naming the nearest known symbol.
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
            found = find_unit(name)
            if found is None:
                raise unknown_unit_error(name)
            unit = unit.times(found, exponent)
            names.append(name)
        position, factors = match.end(), factors + 1
    if not factors:
        raise UnitError(_("a unit is missing"), found=quote(text), allowed=_("e.g. mm, deg, rpm, kN"))
    alone = len(names) == 1 and find_unit(names[0]) == SYMBOLS["min"]
    return _PER_MINUTE if alone and unit.dimension == Dimension(time=-1) else unit


def unknown_unit_error(name: str) -> UnitError:
    """The refusal of a symbol, with the nearest known one."""
    near = nearest_name(name, SYMBOLS)
    return UnitError(_("unknown unit"), found=quote(name), allowed=_("e.g. mm, deg, rpm, kg, N, N*m"), near=near)


def dotted_unit_error(text: str) -> UnitError:
    """The refusal of a unit with dots in it, as in `об.мин`, with the unit that is meant."""
    bare = text.replace("./", "/").rstrip(".")
    meant = next((way for way in (bare.replace(".", sign) for sign in ("", "/", "*")) if _is_known_kind(way)), None)
    return UnitError(_("a unit is written without dots"), found=quote(text), allowed=meant)


def _is_known_kind(text: str) -> bool:
    """Whether this is a unit of something that a file may give."""
    try:
        return parse_unit(text).dimension in {kind.dimension for kind in DIMENSIONS.values()}
    except UnitError:
        return False


class UnitSystem:
    """What bare numbers mean in one file, and in which units its tables are printed."""

    def __init__(self, names: Mapping[str, str] | None = None) -> None:
        """names: unit by kind as in the file, `{length: mm, angular speed: rpm}`; the rest by default.

        Raises ProblemError, its path the key, on an unknown kind, an unknown unit or a unit of another kind.
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
                found = parse_unit(name).dimension
                if not found.fits(kind.dimension):
                    allowed = _("a unit of {full}, e.g. {default}").format(full=full, default=kind.default)
                    raise UnitError(
                        _("this unit measures another quantity"), found=f"{quote(name)}, {found}", allowed=allowed
                    )
            self._names[kind.dimension] = to_latin_unit(name)
        self._units = {dimension: parse_unit(name) if name else Unit(NUMBER) for dimension, name in self._names.items()}

    functions: Mapping[str, Any] = {**vars(math), "min": min, "max": max, "abs": abs}  # what arithmetic computes with

    def number(self, written: str | int | float) -> float:
        """The value of a number as it is written."""
        return finite_float(written) if isinstance(written, str) else float(written)

    def unit(self, dimension: Dimension) -> Unit:
        """The file's unit; without a name of its own, the product of those of length, mass, time and angle."""
        if dimension in self._units:
            return self._units[dimension]
        unit = Unit(NUMBER)
        for base, power in _base_powers(dimension):
            unit = unit.times(self._units[base], power)
        return unit

    def si(self, number: float, dimension: Dimension) -> float:
        """A bare number of the file in SI and radians."""
        return self.unit(dimension).si(number)

    def from_si(self, value: float, dimension: Dimension) -> float:
        """A value in SI and radians as a bare number of the file."""
        number: float = self.unit(dimension).from_si(value)
        return number

    def factor(self, dimension: Dimension) -> float:
        """The file's unit in SI and radians."""
        return self.si(1.0, dimension)

    def symbol(self, dimension: Dimension) -> str:
        """The file's unit in Latin letters, whatever the letters of the file; empty for a number."""
        if dimension in self._names:
            return self._names[dimension]
        return product_text({self._names[base]: power for base, power in _base_powers(dimension)})

    def spelt(self, dimension: Dimension) -> str:
        """The same for people, as their language spells it: N*m, and Н·м in Russian."""
        unit = self.symbol(dimension)
        return unit if language() == ENGLISH else typeset_unit(spelt(unit))

    def format_value(self, value: float, dimension: Dimension, digits: int = 6) -> str:
        """A value in SI and radians as a refusal tells it, `30 deg`."""
        return f"{self.from_si(value, dimension):.{digits}g} {self.spelt(dimension)}"

    def describe(self, quantity: PhysicalValue) -> str:
        """For messages: `a length (110 mm)`, `a bare number (5)`."""
        if quantity.dimension is None:
            return _("a number without a unit ({number})").format(number=f"{quantity.value:.6g}")
        number, unit = self.from_si(quantity.value, quantity.dimension), self.symbol(quantity.dimension)
        return f"{quantity.dimension} ({number:.6g} {unit}".rstrip() + ")"


def _base_powers(dimension: Dimension) -> list[tuple[Dimension, int]]:
    powers = (dimension.length, dimension.mass, dimension.time, dimension.angle)
    return [(base, power) for base, power in zip((LENGTH, MASS, TIME, ANGLE), powers, strict=True) if power]


@cache
def typeset_unit(unit: str) -> str:
    """A unit as it is written by hand: m/s² and N·m for m/s^2 and N*m."""
    return re.sub(r"\^(-?\d+)", lambda power: power[1].translate(_RAISED), unit).replace("*", "·")


# Units of a file whose numbers are no plain floats: of 31 digits, or numbers that vary from linkage to linkage.


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
    """Units whose numbers have 31 digits, from the decimals as they are written."""

    functions = {**FUNCTIONS, "pi": DoubleDouble.decimal(PI)}  # noqa: RUF012  a table

    def number(self, written: str | int | float) -> float:
        super().number(written)  # refuses what float64 has no place for
        found: Any = DoubleDouble.decimal(written if isinstance(written, str) else repr(written))
        return found  # type: ignore[no-any-return]


class VariedUnits(UnitSystem):
    """Units whose functions of arithmetic take numbers that vary (see tmm_cli.batch.traced_arrays)."""

    functions = {**FUNCTIONS, "pi": float(PI)}  # noqa: RUF012  a table

    def __init__(self, own: UnitSystem) -> None:
        vars(self).update(vars(own))
