"""Evaluation of arithmetic expressions with units and parameters. Expressions are parsed, never run as Python code.

The recursive-descent parser limits the nesting of an expression. A bare number (without a unit) takes its unit from the
context: next to a quantity with a dimension, or where a dimension is required, it is read in the file's unit of that
dimension.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from typing import Final

from tmm_cli.language import _
from tmm_cli.mechanics.quantities import ACCELERATION, ANGLE, ANGULAR_SPEED, DIMENSIONS, NUMBER, Dimension
from tmm_cli.problem.errors import ProblemError, WrittenNumber, quote, unknown_name_error
from tmm_cli.problem.scalars import decimal_comma_error
from tmm_cli.problem.units import (
    PER_TIME,
    PhysicalValue,
    UnitError,
    UnitSystem,
    dotted_unit_error,
    find_unit,
    parse_unit,
    plain_text,
    unknown_unit_error,
)

MAX_DEPTH: Final = 30
MAX_POWER: Final = 20

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

MAX_ANGLE: Final = 1e6  # rad: of a larger one rounding leaves too few digits of its last turn
_OF_ANGLE: Final = ("sin", "cos", "tan")
_TO_ANGLE: Final = ("asin", "acos", "atan")
_MANY_ARGUMENTS: Final = ("atan2", "hypot", "min", "max")
FUNCTIONS: Final = (*_OF_ANGLE, *_TO_ANGLE, *_MANY_ARGUMENTS, "sqrt", "abs")


def to_si(quantity: PhysicalValue, want: Dimension, units: UnitSystem) -> float | None:
    """Convert a quantity to SI; return None if its dimension is not the required one.

    A bare number is read in the file's unit of the dimension `want`.
    """
    if quantity.dimension is None:
        return units.si(quantity.value, want)
    return quantity.value if quantity.dimension.fits(want) else None


class Parser:
    """Recursive-descent parser of one expression with sums, products, powers, signs and function calls.

    Attributes:
        text: expression.
        parameters: values of the parameters, by name.
        units: units of numbers that are written without a unit.
        pi: dimension of the constant pi; None makes it a bare number.
        at: index of the next character to parse.
        depth: current number of nested brackets.
    """

    def __init__(
        self, text: str, parameters: Mapping[str, PhysicalValue], units: UnitSystem, pi: Dimension | None = ANGLE
    ) -> None:
        self.text, self.parameters, self.units, self.pi = text, parameters, units, pi
        self.at = 0
        self.depth = 0

    def names(self) -> list[str]:
        """Return the names of the parameters that the text uses.

        A word after a number is a unit even if a parameter has the same name: in `L: 5 m, m: 2*L` the parameter L does
        not use m.
        """
        names = []
        while self.at < len(self.text):
            if number := _NUMBER.match(self.text, self.at):
                self.at = number.end()
                try:
                    self.with_unit(0.0)
                except ProblemError:
                    break  # evaluating says what is wrong
            elif name := _NAME.match(self.text, self.at):
                self.at = name.end()
                names.append(name[1])
            else:
                self.at += 1
        return [name for name in names if name in self.parameters]

    def whole(self) -> PhysicalValue:
        quantity = self.sum()
        rest = self.text[self.at :].strip()
        if rest and _UNIT.fullmatch(rest) and all(find_unit(symbol_text) for symbol_text in _SYMBOL.findall(rest)):
            raise self.syntax_error(_("a unit must follow a number; write * 1 {unit} here").format(unit=rest))
        if rest:
            raise self.syntax_error(_("this is not a valid arithmetic expression"))
        return quantity

    def syntax_error(self, message: str) -> ProblemError:
        rest = self.text[self.at :].strip()
        whole = re.search(rf"(?:{_GROUPED}|[0-9]+)$", self.text[: self.at])
        if whole and (comma := _COMMA.match(rest)):
            return decimal_comma_error(whole[0], comma[1])
        quoted = quote(self.text) + (
            _(", the error is at {rest}").format(rest=quote(rest)) if rest and rest != self.text.strip() else ""
        )
        return ProblemError(message, found=quoted, allowed=_("numbers, units, parameters and the signs + - * / ^ ( )"))

    def sign(self, *signs: str) -> str | None:
        match = _SIGN.match(self.text, self.at)
        if match and match[1] in signs:
            self.at = match.end()
            return match[1]
        return None

    def enter_brackets(self) -> None:
        self.depth += 1
        if self.depth > MAX_DEPTH:
            raise self.syntax_error(_("the expression has too many nested brackets"))

    def sum(self) -> PhysicalValue:
        self.enter_brackets()
        left = self.product()
        while sign := self.sign("+", "-"):
            right = self.product()
            a, b, dimension = self.match_dimensions(left, right)
            left = self.checked_quantity(a + b if sign == "+" else a - b, dimension)
        self.depth -= 1
        return left

    def product(self) -> PhysicalValue:
        left = self.signed()
        while sign := self.sign("*", "·", "/"):
            right = self.signed()
            if sign == "/" and right.value == 0:
                raise self.syntax_error(_("division by zero"))
            value = left.value / right.value if sign == "/" else left.value * right.value
            left = self.checked_quantity(value, self.product_dimension(left, right, -1 if sign == "/" else 1))
        return left

    def signed(self) -> PhysicalValue:
        minus = False
        while sign := self.sign("+", "-"):
            minus ^= sign == "-"
        quantity = self.power()
        return PhysicalValue(-quantity.value, quantity.dimension) if minus else quantity

    def power(self) -> PhysicalValue:
        number = _NUMBER.match(self.text, self.at)
        base = self.atom()
        literal = number is not None and number.end() == self.at
        if not self.sign("^", "**"):
            return base
        if literal and (whole := _POWER.match(self.text, self.at)) and abs(int(whole[1][:4])) <= MAX_POWER:
            self.at = whole.end()  # the unit of 10^3 N belongs to the power
            return self.with_unit(self.compute_real("this power", lambda: base.value ** int(whole[1])))
        self.enter_brackets()
        exponent = self.signed()
        self.depth -= 1
        if exponent.dimension not in (None, NUMBER) or not abs(exponent.value) <= MAX_POWER:
            raise self.syntax_error(_("an exponent must be a number without a unit, at most 20"))
        dimension = base.dimension
        if dimension is not None:
            if exponent.value != int(exponent.value):
                raise self.syntax_error(
                    _("a quantity with a unit can be raised only to an integer power; for a square root use sqrt")
                )
            dimension = dimension.power(int(exponent.value))
        return PhysicalValue(self.compute_real("this power", lambda: base.value**exponent.value), dimension)

    def atom(self) -> PhysicalValue:
        if number := _NUMBER.match(self.text, self.at):
            self.at = number.end()
            return self.with_unit(self.units.number(number[1].replace(" ", "")))
        if self.sign("("):
            inside = self.sum()
            if not self.sign(")"):
                raise self.syntax_error(_("a bracket is not closed"))
            return inside
        if name := _NAME.match(self.text, self.at):
            return self.parse_name(name)
        raise self.syntax_error(
            _("a number is expected here") if self.text[self.at :].strip() else _("a number is missing")
        )

    def with_unit(self, number: float) -> PhysicalValue:
        """Read the longest unit that follows a number and return the quantity.

        In `10 mm * k` the unit is mm, as k is a parameter.
        """
        unit_match = _UNIT.match(self.text, self.at)
        if dotted := _DOTTED.match(self.text, self.at):
            raise dotted_unit_error(dotted[1])
        if unit_match is None:
            return PhysicalValue(number, None)
        name = _NAME.match(self.text, self.at)
        if name and find_unit(name[1]) is None and (name[1] in self.parameters or name[1] in (*FUNCTIONS, "pi")):
            raise self.syntax_error(_("a * is missing before {second}").format(second=name[1]))
        text = unit_match[1]
        for end in [len(text), *sorted((m.start() for m in _JOINT.finditer(text)), reverse=True)]:
            head = text[:end]
            if head.endswith(("*", "·", "/")):
                continue
            free = {factor[1] for factor in re.finditer(r"\s[*·/]?\s*([^\W\d_]+)", head)}  # set apart by spaces
            if all(find_unit(f) is not None for f in _SYMBOL.findall(head)) and not free & set(self.parameters):
                self.at = unit_match.start(1) + end
                unit = parse_unit(head)
                return self.checked_quantity(unit.si(number), unit.dimension)
        raise unknown_unit_error(_SYMBOL.findall(text)[0])

    def parse_name(self, match: re.Match[str]) -> PhysicalValue:
        name = match[1]
        self.at = match.end()
        if name in self.parameters:
            return self.parameters[name]
        if name == "pi":
            quantity = self.with_unit(self.units.functions["pi"])
            return quantity if quantity.dimension else PhysicalValue(quantity.value, self.pi)
        if name in FUNCTIONS:
            return self.call(name)
        called = self.text[self.at :].lstrip().startswith("(")
        names = [*self.parameters, *(FUNCTIONS if called else ()), "pi"]
        message = _("there is no such parameter")
        if find_unit(name):
            message = _("there is no parameter {name}; if the unit is meant, write 1 {name}").format(name=name)
        raise unknown_name_error(name, names, message, ", ".join(self.parameters) or "none is given")

    def call(self, name: str) -> PhysicalValue:
        if not self.sign("("):
            raise self.syntax_error(_("the argument of the function {name} must be in brackets").format(name=name))
        arguments = [self.sum()]
        while self.sign(","):
            arguments.append(self.sum())
        if not self.sign(")"):
            raise self.syntax_error(_("a bracket is not closed"))
        least, most = {"atan2": (2, 2), "min": (1, 20), "max": (1, 20), "hypot": (2, 2)}.get(name, (1, 1))
        if not least <= len(arguments) <= most:
            raise self.syntax_error(_("the function {name} has the wrong number of arguments").format(name=name))
        return (
            self.call_with_several(name, arguments)
            if name in _MANY_ARGUMENTS
            else self.call_with_one(name, arguments[0])
        )

    def call_with_one(self, name: str, argument: PhysicalValue) -> PhysicalValue:
        compute, dimension = self.units.functions[name], argument.dimension
        if name == "abs":
            return PhysicalValue(abs(argument.value), dimension)
        if name in _OF_ANGLE:
            angle = to_si(argument, ANGLE, self.units)
            if angle is None:
                raise self.syntax_error(
                    _("the argument of {name} must be an angle; found: {dimension}").format(
                        name=name, dimension=dimension
                    )
                )
            if abs(float(angle)) > MAX_ANGLE:
                raise self.syntax_error(
                    _("the angle is too large: because of rounding, no digit of {name} would be correct").format(
                        name=name
                    )
                )
            if name == "tan" and abs(math.cos(angle)) < 1e-15:
                raise self.syntax_error(_("the tangent of a right angle is undefined"))
            return PhysicalValue(compute(angle), None)
        if name in _TO_ANGLE and dimension not in (None, NUMBER):
            raise self.syntax_error(
                _("the argument of {name} must be a number without a unit; found: {dimension}").format(
                    name=name, dimension=dimension
                )
            )
        root = _square_root_dimension(dimension) if dimension else None
        if name == "sqrt" and dimension is not None and root is None:
            raise self.syntax_error(
                _("no square root can be taken of this quantity: {dimension}").format(dimension=dimension)
            )
        value = self.compute_real(f"{name} of {argument.value:.6g}", lambda: compute(argument.value))
        return PhysicalValue(value, root if name == "sqrt" else ANGLE)

    def call_with_several(self, name: str, arguments: list[PhysicalValue]) -> PhysicalValue:
        """Compute atan2, hypot, min or max.

        All arguments must have the same dimension; bare numbers are read in the file's unit of this dimension.
        """
        compute = self.units.functions[name]
        dimension = next((argument.dimension for argument in arguments if argument.dimension is not None), None)
        values = [self.match_dimensions(PhysicalValue(0.0, dimension), argument)[1] for argument in arguments]
        value = compute(values) if name in ("min", "max") else compute(*values)
        return self.checked_quantity(value, ANGLE if name == "atan2" else dimension)

    def match_dimensions(self, left: PhysicalValue, right: PhysicalValue) -> tuple[float, float, Dimension | None]:
        """Return the values of two quantities and their common dimension.

        A bare number is read in the file's unit of the other dimension. Raises ProblemError if the dimensions differ.
        """
        a, b = left.dimension, right.dimension
        if a is None and b is not None:
            return self.checked_quantity(self.units.si(left.value, b), b).value, right.value, b
        if b is None and a is not None:
            return left.value, self.checked_quantity(self.units.si(right.value, a), a).value, a
        if a is not None and b is not None and not (a.fits(b) or b.fits(a)):
            raise self.syntax_error(_("{a} and {b} cannot be added or compared").format(a=a, b=b))
        return left.value, right.value, a

    def checked_quantity(self, value: float, dimension: Dimension | None) -> PhysicalValue:
        """Return a quantity with this value. Raises ProblemError if the value is infinite or nan."""
        if not math.isfinite(value):
            raise ProblemError(_("this number is too large"), found=quote(self.text))
        return PhysicalValue(value, dimension)

    @staticmethod
    def product_dimension(left: PhysicalValue, right: PhysicalValue, power: int) -> Dimension | None:
        """Return the dimension of a product (power 1) or quotient (power -1) of two quantities; None for a bare number.

        A bare factor does not change the dimension. The ratio of two lengths is a dimensionless number but not a bare
        one, so that it is never read in degrees or millimetres.
        """
        joined = (left.dimension or NUMBER).times(right.dimension or NUMBER, power)
        return None if joined == NUMBER and None in (left.dimension, right.dimension) else joined

    def compute_real(self, operation: str, compute: Callable[[], float | complex]) -> float:
        try:
            value = compute()
        except (ValueError, OverflowError, ZeroDivisionError):
            value = math.nan
        if isinstance(value, complex) or not math.isfinite(value):
            raise self.syntax_error(_("{what} is undefined").format(what=operation))
        return float(value) if isinstance(value, int) else value


def _square_root_dimension(dimension: Dimension) -> Dimension | None:
    powers = (dimension.length, dimension.mass, dimension.time, dimension.angle)
    if any(p % 2 for p in powers):
        return None
    return Dimension(*(p // 2 for p in powers))


MAX_LENGTH: Final = 200


def evaluate(source: object, parameters: Mapping[str, PhysicalValue], units: UnitSystem, want: Dimension) -> float:
    """Evaluate a value of the file and return it in SI and radians.

    Args:
        source: number or text of the file.
        parameters: values of the parameters, by name.
        units: units of numbers that are written without a unit.
        want: required dimension.

    Raises:
        ProblemError: the text is not valid arithmetic, or has another dimension. The error contains no path.
    """
    try:
        return _checked_si(source, evaluate_quantity(source, parameters, units), units, want)
    except ProblemError as error:
        if not isinstance(source, str):
            raise
        first = error
    try:
        if "pi" in source:  # perhaps a ratio, as in pi * OA
            return _checked_si(source, evaluate_quantity(source, parameters, units, pi=None), units, want)
    except ProblemError:
        pass

    def fits(others: Mapping[str, PhysicalValue]) -> bool:
        return to_si(evaluate_quantity(source, others, units), want, units) is not None

    raise missing_unit_error(source, parameters, units, fits) or first from None


def missing_unit_error(
    source: str,
    parameters: Mapping[str, PhysicalValue],
    units: UnitSystem,
    fits: Callable[[Mapping[str, PhysicalValue]], bool],
) -> ProblemError | None:
    """Return an error that names the parameter whose missing unit makes the dimension of an expression wrong.

    Each unit of the file is tried on each parameter without a unit. Returns None if this never gives the right
    dimension, or if no parameter in the expression has a unit.

    Args:
        source: expression.
        parameters: values of the parameters, by name.
        units: units of the file.
        fits: returns True if the expression has the required dimension with these parameters.
    """
    used = dict.fromkeys(Parser(plain_text(source[:MAX_LENGTH]), parameters, units).names())
    bare = [name for name in used if parameters[name].dimension is None]
    if len(bare) == len(used):
        return None
    for kind in DIMENSIONS.values():
        for name in bare if kind.dimension != NUMBER else ():
            value = PhysicalValue(units.si(parameters[name].value, kind.dimension), kind.dimension)
            try:
                if not fits({**parameters, name: value}):
                    continue
            except ProblemError:
                continue
            number = f"{parameters[name].value:.6g}"
            written = f"{number} {units.symbol(kind.dimension)}"
            if kind.dimension == ANGULAR_SPEED:  # bare, it counts revolutions as often as radians
                written = _("{a} or {b}").format(a=f"{number} rpm", b=f"{number} rad/s")
            message = _("parameter {name} has no unit: write {name}: {value}").format(name=name, value=written)
            return UnitError(message, found=quote(source))
    return None


def _checked_si(source: object, quantity: PhysicalValue, units: UnitSystem, want: Dimension) -> float:
    value = to_si(quantity, want, units)
    if value is None:
        described = f"{quote(source)}, {units.describe(quantity)}"
        allowed = want.example
        if want == ANGLE and "pi" in str(source):
            allowed = _("{allowed}; pi is already in radians").format(allowed=allowed)
        if quantity.dimension is not None and quantity.dimension.times(ACCELERATION).fits(want):
            allowed = _("{allowed}; the unit kilogram-force is written kgf").format(allowed=allowed)
        raise UnitError(_("expected here: {want}").format(want=want), found=described, allowed=allowed)
    return value


def evaluate_quantity(
    source: object, parameters: Mapping[str, PhysicalValue], units: UnitSystem, pi: Dimension | None = ANGLE
) -> PhysicalValue:
    """Evaluate a value of the file together with its dimension.

    Args:
        source: number or text of the file.
        parameters: values of the parameters, by name.
        units: units of numbers that are written without a unit.
        pi: dimension of the constant pi. By default it is an angle in radians, so that pi/2 is a right angle in any
            unit of angle; None makes it a bare number.

    Returns:
        The quantity in SI and radians; the dimension of a bare number is None.

    Raises:
        ProblemError: the text is not valid arithmetic. The error contains no path.
    """
    if isinstance(source, bool) or not isinstance(source, int | float | str):
        raise ProblemError(
            _("a number is expected here"),
            found=quote(source),
            allowed=_("a number, a number with a unit, or an arithmetic expression"),
        )
    if isinstance(source, int | float):
        if not -1e300 < source < 1e300:
            raise ProblemError(_("the number must lie between -1e300 and 1e300"), found=quote(source))
        return PhysicalValue(units.number(source.written if isinstance(source, WrittenNumber) else source), None)
    if len(source) > MAX_LENGTH:
        raise ProblemError(
            _("this expression is too long"),
            found=quote(source),
            allowed=_("at most {max_length} characters").format(max_length=MAX_LENGTH),
        )
    return Parser(plain_text(source), parameters, units, pi).whole()
