"""Arithmetic on quantities with units and parameters: precedence climbing over the text, bounded in depth."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from typing import Final

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, quote, unknown_name
from tmm_cli.problem.scalars import comma_error
from tmm_cli.problem.units import PER_TIME, PhysicalValue, UnitSystem, dotted_unit, parse_unit, symbol, unknown_unit
from tmm_cli.quantities import ANGLE, NUMBER, Dimension

MAX_DEPTH: Final = 30
MOST_POWER: Final = 20

_GROUPED = r"[0-9]{1,3}(?: [0-9]{3})+(?![0-9])"  # thousands set apart by spaces, 12 500
_NUMBER = re.compile(rf"\s*((?:{_GROUPED}|[0-9]+)\.?[0-9]*(?:[eE][+-]?[0-9]+)?|\.[0-9]+(?:[eE][+-]?[0-9]+)?)")
_POWER = re.compile(r"\s*([+-]?[0-9]+)(?![0-9.eE])(?!\s*(?:\^|\*\*))")  # a whole number, not the base of a power
_COMMA = re.compile(r",([0-9]+(?:\s*(?:[^\W\d]\S*|[°%]))?)")
_NAME = re.compile(r"\s*([^\W\d]\w*)")
_SIGN = re.compile(r"\s*(\*\*|[-+*/^(),·])")
# A unit right after a number: symbols with powers, joined by * · / or a space.
_FACTOR = rf"(?:{PER_TIME}|(?:[^\W\d_]+|°|%)(?:\^\s*-?\d+|[²³]|\d)?)"
_UNIT = re.compile(rf"\s*((?:1\s*/\s*)?{_FACTOR}(?:(?:\s*[*·/]\s*|\s+){_FACTOR})*)")
_DOTTED = re.compile(r"\s*((?:[^\W\d_]+\s*[./]\s*)*[^\W\d_]+\.(?:\s*/?\s*[^\W\d_]+)*\.?)")  # об.мин, r.p.m.
_SYMBOL = re.compile(r"[^\W\d_]+|°|%")
_JOINT = re.compile(r"\s*[*·/]|\s+")

MOST_ANGLE: Final = 1e6  # rad: of a larger one rounding leaves too few digits of its last turn
_ANGLE_IN: Final = ("sin", "cos", "tan")
_ANGLE_OUT: Final = ("asin", "acos", "atan")
_OF_MANY: Final = ("atan2", "hypot", "min", "max")
FUNCTIONS: Final = (*_ANGLE_IN, *_ANGLE_OUT, *_OF_MANY, "sqrt", "abs")


def taken(found: PhysicalValue, want: Dimension, units: UnitSystem) -> float | None:
    """The value in SI, a bare number taken in the file's unit of `want`; None when the dimension does not fit."""
    if found.dimension is None:
        return units.si(found.value, want)
    return found.value if found.dimension.fits(want) else None


class Parser:
    """Precedence climbing over the text: sums, products, powers, signs, calls."""

    def __init__(
        self, text: str, parameters: Mapping[str, PhysicalValue], units: UnitSystem, pi: Dimension | None = ANGLE
    ) -> None:
        self.text, self.parameters, self.units, self.pi = text, parameters, units, pi
        self.at = 0
        self.depth = 0

    def names(self) -> list[str]:
        """The parameters the text uses. A unit is none, whatever parameters are called: `L: 5 m, m: 2*L`."""
        found = []
        while self.at < len(self.text):
            if number := _NUMBER.match(self.text, self.at):
                self.at = number.end()
                try:
                    self.with_unit(0.0)
                except ProblemError:
                    break  # evaluating says what is wrong
            elif name := _NAME.match(self.text, self.at):
                self.at = name.end()
                found.append(name[1])
            else:
                self.at += 1
        return [name for name in found if name in self.parameters]

    def whole(self) -> PhysicalValue:
        found = self.sum()
        rest = self.text[self.at :].strip()
        if rest and _UNIT.fullmatch(rest) and all(symbol(one) for one in _SYMBOL.findall(rest)):
            raise self.fault(_("a unit follows a number only: here write * 1 {unit}").format(unit=rest))
        if rest:
            raise self.fault(_("this is not arithmetic"))
        return found

    def fault(self, message: str) -> ProblemError:
        rest = self.text[self.at :].strip()
        whole = re.search(rf"(?:{_GROUPED}|[0-9]+)$", self.text[: self.at])
        if whole and (comma := _COMMA.match(rest)):
            return comma_error(whole[0], comma[1])
        found = quote(self.text) + (
            _(", at {rest}").format(rest=quote(rest)) if rest and rest != self.text.strip() else ""
        )
        return ProblemError(message, found=found, allowed=_("numbers, units, parameters, + - * / ^ ( )"))

    def sign(self, *signs: str) -> str | None:
        match = _SIGN.match(self.text, self.at)
        if match and match[1] in signs:
            self.at = match.end()
            return match[1]
        return None

    def deeper(self) -> None:
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise self.fault(_("this is nested too deeply"))

    def sum(self) -> PhysicalValue:
        self.deeper()
        left = self.product()
        while sign := self.sign("+", "-"):
            right = self.product()
            a, b, dimension = self.alike(left, right)
            left = self.finite(a + b if sign == "+" else a - b, dimension)
        self.depth -= 1
        return left

    def product(self) -> PhysicalValue:
        left = self.signed()
        while sign := self.sign("*", "·", "/"):
            right = self.signed()
            if sign == "/" and right.value == 0:
                raise self.fault(_("division by zero"))
            value = left.value / right.value if sign == "/" else left.value * right.value
            left = self.finite(value, self.joined(left, right, -1 if sign == "/" else 1))
        return left

    def signed(self) -> PhysicalValue:
        minus = False
        while sign := self.sign("+", "-"):
            minus ^= sign == "-"
        found = self.power()
        return PhysicalValue(-found.value, found.dimension) if minus else found

    def power(self) -> PhysicalValue:
        number = _NUMBER.match(self.text, self.at)
        base = self.atom()
        literal = number is not None and number.end() == self.at
        if not self.sign("^", "**"):
            return base
        if literal and (whole := _POWER.match(self.text, self.at)) and abs(int(whole[1][:4])) <= MOST_POWER:
            self.at = whole.end()  # the unit of 10^3 N belongs to the power
            return self.with_unit(self.real("this power", lambda: base.value ** int(whole[1])))
        self.deeper()
        exponent = self.signed()
        self.depth -= 1
        if exponent.dimension not in (None, NUMBER) or not abs(exponent.value) <= MOST_POWER:
            raise self.fault(_("an exponent is a small bare number"))
        dimension = base.dimension
        if dimension is not None:
            if exponent.value != int(exponent.value):
                raise self.fault(_("a quantity has whole powers; see sqrt"))
            dimension = dimension.power(int(exponent.value))
        return PhysicalValue(self.real("this power", lambda: base.value**exponent.value), dimension)

    def atom(self) -> PhysicalValue:
        if number := _NUMBER.match(self.text, self.at):
            self.at = number.end()
            return self.with_unit(self.units.number(number[1].replace(" ", "")))
        if self.sign("("):
            inside = self.sum()
            if not self.sign(")"):
                raise self.fault(_("a bracket is not closed"))
            return inside
        if name := _NAME.match(self.text, self.at):
            return self.named(name)
        raise self.fault(_("a number is wanted here") if self.text[self.at :].strip() else _("a number is missing"))

    def with_unit(self, number: float) -> PhysicalValue:
        """The number with the longest unit that follows it (in `10 mm * k` that is mm: k is a parameter)."""
        found = _UNIT.match(self.text, self.at)
        if dotted := _DOTTED.match(self.text, self.at):
            raise dotted_unit(dotted[1])
        if found is None:
            return PhysicalValue(number, None)
        name = _NAME.match(self.text, self.at)
        if name and symbol(name[1]) is None and (name[1] in self.parameters or name[1] in (*FUNCTIONS, "pi")):
            raise self.fault(_("a * is missing before {second}").format(second=name[1]))
        text = found[1]
        for end in [len(text), *sorted((m.start() for m in _JOINT.finditer(text)), reverse=True)]:
            head = text[:end]
            if head.endswith(("*", "·", "/")):
                continue
            free = {factor[1] for factor in re.finditer(r"\s[*·/]?\s*([^\W\d_]+)", head)}  # set apart by spaces
            if all(symbol(f) is not None for f in _SYMBOL.findall(head)) and not free & set(self.parameters):
                self.at = found.start(1) + end
                unit = parse_unit(head)
                return self.finite(unit.si(number), unit.dimension)
        raise unknown_unit(_SYMBOL.findall(text)[0])

    def named(self, match: re.Match[str]) -> PhysicalValue:
        name = match[1]
        self.at = match.end()
        if name in self.parameters:
            return self.parameters[name]
        if name == "pi":
            found = self.with_unit(self.units.functions["pi"])
            return found if found.dimension else PhysicalValue(found.value, self.pi)
        if name in FUNCTIONS:
            return self.call(name)
        called = self.text[self.at :].lstrip().startswith("(")
        names = [*self.parameters, *(FUNCTIONS if called else ()), "pi"]
        message = _("there is no such parameter")
        if symbol(name):
            message = _("there is no parameter {name}, and a unit follows a number: 1 {name}").format(name=name)
        raise unknown_name(name, names, message, ", ".join(self.parameters) or "none is given")

    def call(self, name: str) -> PhysicalValue:
        if not self.sign("("):
            raise self.fault(_("{name} wants its argument in brackets").format(name=name))
        given = [self.sum()]
        while self.sign(","):
            given.append(self.sum())
        if not self.sign(")"):
            raise self.fault(_("a bracket is not closed"))
        least, most = {"atan2": (2, 2), "min": (1, 20), "max": (1, 20), "hypot": (2, 2)}.get(name, (1, 1))
        if not least <= len(given) <= most:
            raise self.fault(_("{name} wants another number of arguments").format(name=name))
        return self.of_many(name, given) if name in _OF_MANY else self.of_one(name, given[0])

    def of_one(self, name: str, given: PhysicalValue) -> PhysicalValue:
        compute, dimension = self.units.functions[name], given.dimension
        if name == "abs":
            return PhysicalValue(abs(given.value), dimension)
        if name in _ANGLE_IN:
            angle = taken(given, ANGLE, self.units)
            if angle is None:
                raise self.fault(_("{name} wants an angle, not {dimension}").format(name=name, dimension=dimension))
            if abs(float(angle)) > MOST_ANGLE:
                raise self.fault(_("{name} of so large an angle has no digit left").format(name=name))
            if name == "tan" and abs(math.cos(angle)) < 1e-15:
                raise self.fault(_("tan of a right angle has no value"))
            return PhysicalValue(compute(angle), None)
        if name in _ANGLE_OUT and dimension not in (None, NUMBER):
            raise self.fault(_("{name} wants a number, not {dimension}").format(name=name, dimension=dimension))
        root = _half(dimension) if dimension else None
        if name == "sqrt" and dimension is not None and root is None:
            raise self.fault(_("{dimension} has no square root").format(dimension=dimension))
        value = self.real(f"{name} of {given.value:.6g}", lambda: compute(given.value))
        return PhysicalValue(value, root if name == "sqrt" else ANGLE)

    def of_many(self, name: str, given: list[PhysicalValue]) -> PhysicalValue:
        """atan2, hypot, min or max of values that all have one dimension, or none."""
        compute = self.units.functions[name]
        dimension = next((one.dimension for one in given if one.dimension is not None), None)
        values = [self.alike(PhysicalValue(0.0, dimension), one)[1] for one in given]
        value = compute(values) if name in ("min", "max") else compute(*values)
        return self.finite(value, ANGLE if name == "atan2" else dimension)

    def alike(self, left: PhysicalValue, right: PhysicalValue) -> tuple[float, float, Dimension | None]:
        """Both values in one dimension, a bare one taken in the file's unit of the other's."""
        a, b = left.dimension, right.dimension
        if a is None and b is not None:
            return self.finite(self.units.si(left.value, b), b).value, right.value, b
        if b is None and a is not None:
            return left.value, self.finite(self.units.si(right.value, a), a).value, a
        if a is not None and b is not None and not (a.fits(b) or b.fits(a)):
            raise self.fault(_("{a} and {b} cannot be added or compared").format(a=a, b=b))
        return left.value, right.value, a

    def finite(self, value: float, dimension: Dimension | None) -> PhysicalValue:
        """What a step of the arithmetic gives, so that the next one never meets what is no number."""
        if not math.isfinite(value):
            raise ProblemError(_("this number is too large"), found=quote(self.text))
        return PhysicalValue(value, dimension)

    @staticmethod
    def joined(left: PhysicalValue, right: PhysicalValue, power: int) -> Dimension | None:
        """Dimension of a product or quotient.

        A bare number is a pure factor, and stays bare beside a number; a ratio of lengths is a number, not bare, so
        that it cannot pass for degrees or millimetres.
        """
        joined = (left.dimension or NUMBER).times(right.dimension or NUMBER, power)
        return None if joined == NUMBER and None in (left.dimension, right.dimension) else joined

    def real(self, what: str, compute: Callable[[], float | complex]) -> float:
        try:
            value = compute()
        except (ValueError, OverflowError, ZeroDivisionError):
            value = math.nan
        if isinstance(value, complex) or not math.isfinite(value):
            raise self.fault(_("{what} has no value").format(what=what))
        return float(value) if isinstance(value, int) else value


def _half(dimension: Dimension) -> Dimension | None:
    powers = (dimension.length, dimension.mass, dimension.time, dimension.angle)
    if any(p % 2 for p in powers):
        return None
    return Dimension(*(p // 2 for p in powers))
