"""Reading of a single answer as students write it.

A number: `1,31 m/s`, `3·10^-3`, `1 200.5`, `II`. A vector by components: `(1,2; -3,4) N`, `Fx = 1.2 N, Fy = -3.4 N`; by
magnitude and direction: `1.2 kN at 34 deg`, `1200 N, 34°`. Expressions are not evaluated. A text has at most LONGEST
characters.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal, cast, get_args

from tmm_cli.grading.record import ReadAnswer
from tmm_cli.language import _
from tmm_cli.mechanics.quantities import ANGLE
from tmm_cli.problem import (
    ProblemError,
    clean,
    dotted_unit_error,
    finite_float,
    parse_unit,
    plain_text,
    quote,
    to_latin,
)

LONGEST = 200
CLASSES = {name: float(n) for n, name in enumerate(("I", "II", "III", "IV", "V", "VI"), start=1)}

_SIGNS = {
    **dict.fromkeys(map(ord, "\u2010\u2011\u2012\u2014\u2015\ufe63\uff0d"), "-"),
    **dict.fromkeys((*range(0x2000, 0x200B), 0x205F, 0x3000), " "),
    **dict.fromkeys((0x200B, 0x2060, 0xFEFF), None),
}
_PLAIN = re.compile(r"[+-]?\d+(?:[.,]\d+)?")
_DIGITS = (
    r"\d{1,3}(?: \d{3})+(?:[.,]\d+)?(?!\d)|\d{1,3}(?:,\d{3})+\.\d+|\d{1,3}(?:\.\d{3})+,\d+|\d+(?:[.,]\d*)?|[.,]\d+"
)
_POWER = r"10 *\^ *[({]? *([+-]? *\d+) *[)}]?"
_NUMBER = re.compile(rf"([+-]?) *(?:{_POWER}|({_DIGITS})(?:[eEеЕ]([+-]?\d+)| *[·*xх] *{_POWER})?)")
_BEHIND = re.compile(r" *([^\W\d_]|[°%]|1 */|$)")  # what may follow a number: a unit
_NOT_FINITE = re.compile(r"[+-]?(nan|inf|infinity)\b.*", re.IGNORECASE)
_DATE = re.compile(r"\d{4}-\d\d-\d\d.*|\d\d:\d\d:\d\d.*")
_BRACKETS = re.compile(r"[(\[]([^()\[\]]*)[)\]](.*)")
_DIRECTION = re.compile(r"\bat\b|∠|\bпод углом\b")
_LABEL = re.compile(r"([^\W\d]\w*) *= *")
_LABELLED = re.compile(r"[ ,;]+(?=[^\W\d]\w* *=)")
_BETWEEN = re.compile(r", +|(?<=[^\d ]),")
_DIRECTIONS = ("phi", "φ", "angle", "alpha", "α")


def read_answer(text: str, unit: str = "", turn_unit: str = "") -> ReadAnswer | None:
    """Read the answer in a cell.

    Args:
        text: Text of the cell.
        unit: Unit if the text has none.
        turn_unit: Unit of the direction if the text has none.

    Returns:
        The answer; None for an empty cell or a dash.

    Raises:
        ProblemError: The text is not an answer.
    """
    if len(text) < LONGEST and _PLAIN.fullmatch(text):
        return ReadAnswer(read_number(text)[0], unit=unit, text=text)
    source = use_keyboard_characters(text)
    if not source.strip("- "):
        return None
    told = clean(source, 80)
    if roman := CLASSES.get(to_latin(source).upper()):
        return ReadAnswer(roman, unit=unit, text=told)
    parts, of_both, polar = _split_answer(source)
    if parts == [source]:
        number, own = read_number(source)
        return ReadAnswer(number, unit=own or unit, text=told)
    if len(parts) != 2:
        raise ProblemError(
            _("a vector must be given by two numbers"),
            found=quote(source),
            allowed=_("(1,2; -3,4) N or 1,2 kN at 34 deg"),
        )
    labels, numbers = zip(*(_split_label(part) for part in parts), strict=True)
    (first, one), (second, other) = (read_number(part) for part in numbers)
    polar = polar or labels[1] in _DIRECTIONS or (_is_angle_unit(other) and not _is_angle_unit(one))
    if polar:
        if other and not _is_angle_unit(other):
            raise ProblemError(_("the direction must be an angle"), found=quote(other), allowed=_("1,2 kN at 34 deg"))
        return ReadAnswer(first, second, "polar", one or of_both or unit, other or turn_unit, told)
    units = {name for name in (one, other, of_both) if name}
    if len(units) > 1:
        raise ProblemError(_("the components have different units"), found=quote(source), allowed=_("(1,2; -3,4) N"))
    ends = tuple(label[-1:].lower() for label in labels)
    if ends not in (("", ""), ("x", "y"), ("y", "x")):
        raise ProblemError(
            _("these are not the components x and y"), found=quote(source), allowed=_("Fx = 1,2 N, Fy = -3,4 N")
        )
    x, y = (second, first) if ends == ("y", "x") else (first, second)
    return ReadAnswer(x, y, "components", units.pop() if units else unit, text=told)


def use_keyboard_characters(text: str) -> str:
    """Replace typographic minus signs, dots, spaces and superscripts by characters of a keyboard.

    Raises:
        ProblemError: The text is too long.
    """
    if len(text) > LONGEST:
        raise ProblemError(
            _("this expression is too long"),
            found=quote(text),
            allowed=_("at most {most} characters").format(most=LONGEST),
        )
    return plain_text(text.translate(_SIGNS)).strip()


def read_number(source: str) -> tuple[float, str]:
    """Read a number and the unit after it; return both, "" if there is no unit.

    Raises:
        ProblemError: The text is not a number.
    """
    if _PLAIN.fullmatch(source):
        return finite_float(source.replace(",", ".")), ""
    found = _NUMBER.match(source)
    if found is None or not _BEHIND.match(source, found.end()):
        if _NOT_FINITE.fullmatch(source):
            raise ProblemError(_("the number must be finite"), found=quote(source))
        if _DATE.fullmatch(source):
            raise ProblemError(
                _("the spreadsheet has turned this number into a date"),
                found=quote(source),
                allowed=_("a number in a cell formatted as text"),
            )
        raise ProblemError(_("not a number"), found=quote(source), allowed=_("1,31 m/s, 1.31 or 3·10^-3"))
    sign, alone, digits, exponent, power = found.groups()
    digits = (digits or "1").replace(" ", "")
    if "," in digits and "." in digits:  # the first parts thousands
        digits = digits.replace(min(".,", key=digits.index), "")
    tens = (alone or exponent or power or "0").replace(" ", "")
    if len(tens) > 4:
        raise ProblemError(_("the number is too large or too small"), found=quote(source))
    number = finite_float(f"{sign}{digits.replace(',', '.')}e{tens}")
    return number, check_unit(source[found.end() :])


@lru_cache(maxsize=1024)
def check_unit(text: str) -> str:
    """Return the unit as written, without a final full stop; "" for an empty text.

    Raises:
        UnitError: The unit is unknown.
    """
    name = text.strip().removesuffix(".")
    if name:
        if "." in name:
            raise dotted_unit_error(name)
        parse_unit(name)
    return name


@lru_cache(maxsize=1024)
def _is_angle_unit(unit: str) -> bool:
    return bool(unit) and parse_unit(unit).dimension == ANGLE


def _split_label(part: str) -> tuple[str, str]:
    """Split a text such as `Fx = 1.2 N` into label and value; the label is "" if there is none."""
    label = _LABEL.match(part)
    return (label[1], part[label.end() :]) if label else ("", part)


def _split_answer(source: str) -> tuple[list[str], str, bool]:
    """Split an answer into the texts of its numbers.

    Returns:
        Texts of the numbers, their common unit ("" if none), and True if the second is written as a direction (`at
        34°`).
    """
    inside, unit = source, ""
    brackets = _BRACKETS.fullmatch(source)
    if brackets:
        inside, unit = brackets[1], check_unit(brackets[2])
    if not brackets and _DIRECTION.search(source):
        return [part.strip() for part in _DIRECTION.split(source)], "", True
    if "=" in inside:
        parts = _LABELLED.split(inside)
    elif ";" in inside:
        parts = inside.split(";")
    elif len(found := _BETWEEN.split(inside)) > 1 or not brackets:
        parts = found
    else:
        parts = inside.split("," if inside.count(",") == 1 else None)
    return [part.strip() for part in parts], unit, False


# What a heading of an answer sheet asks for: `v of E at 7, m/s`, `R_34 x at 7 [N]`, `R_34 at phi = 210 deg, angle`.


Part = Literal["", "x", "y", "size", "angle"]
PARTS: tuple[Part, ...] = get_args(Part)[1:]

_POSITION = r"(?:(?:phi|φ) *= *)?[+-]?\d+(?:[.,]\d+)?(?: *(?:deg|rad|°|град|рад)\b\.?|°)?"
_REST = re.compile(rf"(?:[ ,]+(x|y|size|angle))?(?: +at +({_POSITION}))?(?: *((?:,[^,\[\]]*)+))?(?: *\[([^\[\]]*)\])?")
_PLACE = re.compile(r"(?:(phi|φ) *= *)?(.*)")


@dataclass(frozen=True)
class Heading:
    """Heading of an answer sheet: quantity, and the position number or driver angle (rad) at which it is given.

    part: component of a vector, "" if none. unit: unit, "" if none.
    """

    quantity: str
    position: int | None = None
    angle: float | None = None
    part: Part = ""
    unit: str = ""


class UnknownQuantityError(ProblemError):
    """A heading contains a name that belongs to no quantity of the mechanism."""

    def __init__(self, name: str) -> None:
        super().__init__(_("there is no quantity with this name"), found=quote(name))
        self.name = name


class Headings:
    """Reader of headings that begin with the name of a quantity. Cyrillic letters that look like Latin ones are
    accepted.
    """

    def __init__(self, names: Iterable[str]) -> None:
        self.names = {to_latin(name): name for name in sorted(names, key=len, reverse=True)}

    def read(self, text: str) -> Heading:
        """Read a heading, e.g. `v of E at 7, m/s`.

        Raises:
            ProblemError: The heading cannot be read.
        """
        source = " ".join(use_keyboard_characters(text).split())
        alike = to_latin(source)
        for known, name in self.names.items():
            if not alike.startswith(known):
                continue
            if rest := _REST.fullmatch(source, len(known)):
                return _heading(name, *rest.groups(default=""))
        called = re.split(r" at |, | ?\[", source)[0]
        if to_latin(called) in self.names:
            raise ProblemError(
                _("this column heading is not recognised"), found=quote(source), allowed=_("v of E at 7, m/s")
            )
        raise UnknownQuantityError(called)


def _heading(name: str, part: str, position: str, rest: str, unit: str) -> Heading:
    for piece in (piece.strip() for piece in rest.split(",")):
        if piece in PARTS:
            part = piece
        elif piece:
            unit = piece
    number, angle = read_position(position)
    return Heading(name, number, angle, cast(Part, part), check_unit(unit))


def read_position(text: str) -> tuple[int | None, float | None]:
    """Read a position number, e.g. `7`, or a driver angle, e.g. `phi = 210 deg` or `210 deg`.

    Returns:
        Position number and angle (rad); the one that is not given is None, both for an empty text.

    Raises:
        ProblemError: The text is not a position.
    """
    source = use_keyboard_characters(text)
    if not source.strip("- "):
        return None, None
    by_angle, rest = _PLACE.fullmatch(source).groups()  # type: ignore[union-attr]  # anything matches
    value, unit = read_number(rest)
    if by_angle or unit:
        if unit and parse_unit(unit).dimension != ANGLE:
            raise ProblemError(
                _("expected a position number or an angle of the driver"),
                found=quote(source),
                allowed=_("7, or phi = 210 deg"),
            )
        return None, parse_unit(unit or "deg").si(value)
    if value != int(value):
        raise ProblemError(
            _("expected a position number or an angle of the driver"),
            found=quote(source),
            allowed=_("7, or phi = 210 deg"),
        )
    return int(value), None
