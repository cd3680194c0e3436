"""What a heading of an answer sheet asks for: `v of E at 7, m/s`, `R_34 x at 7 [N]`, `R_34 at phi = 210 deg, angle`."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal, cast, get_args

from tmm_cli.grading.submissions.numbers import checked_unit, plainly, read_number
from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, latin, quote
from tmm_cli.problem.units import parse_unit
from tmm_cli.quantities import ANGLE

Part = Literal["", "x", "y", "size", "angle"]
PARTS: tuple[Part, ...] = get_args(Part)[1:]

_POSITION = r"(?:(?:phi|φ) *= *)?[+-]?\d+(?:[.,]\d+)?(?: *(?:deg|rad|°|град|рад)\b\.?|°)?"
_REST = re.compile(rf"(?:[ ,]+(x|y|size|angle))?(?: +at +({_POSITION}))?(?: *((?:,[^,\[\]]*)+))?(?: *\[([^\[\]]*)\])?")
_PLACE = re.compile(r"(?:(phi|φ) *= *)?(.*)")


@dataclass(frozen=True)
class Heading:
    """A quantity at a position, as the students count it, or at an angle (rad) of the driver; and which part of it."""

    quantity: str
    position: int | None = None
    angle: float | None = None
    part: Part = ""
    unit: str = ""


class UnknownQuantityError(ProblemError):
    """A name that no quantity has."""

    def __init__(self, name: str) -> None:
        super().__init__(_("there is no quantity of this name"), found=quote(name))
        self.name = name


class Headings:
    """Reads headings by the names of quantities. A name may have Cyrillic letters that look like its Latin ones."""

    def __init__(self, names: Iterable[str]) -> None:
        self.names = {latin(name): name for name in sorted(names, key=len, reverse=True)}

    def read(self, text: str) -> Heading:
        """Raises ProblemError."""
        source = " ".join(plainly(text).split())
        alike = latin(source)
        for known, name in self.names.items():
            if not alike.startswith(known):
                continue
            if rest := _REST.fullmatch(source, len(known)):
                return _heading(name, *rest.groups(default=""))
        called = re.split(r" at |, | ?\[", source)[0]
        if latin(called) in self.names:
            raise ProblemError(_("this heading is not understood"), found=quote(source), allowed=_("v of E at 7, m/s"))
        raise UnknownQuantityError(called)


def _heading(name: str, part: str, position: str, rest: str, unit: str) -> Heading:
    for piece in (piece.strip() for piece in rest.split(",")):
        if piece in PARTS:
            part = piece
        elif piece:
            unit = piece
    number, angle = read_position(position)
    return Heading(name, number, angle, cast(Part, part), checked_unit(unit))


def read_position(text: str) -> tuple[int | None, float | None]:
    """`7` as the number of a position, `phi = 210 deg` or `210 deg` as an angle (rad). Raises ProblemError."""
    source = plainly(text)
    if not source.strip("- "):
        return None, None
    by_angle, rest = _PLACE.fullmatch(source).groups()  # type: ignore[union-attr]  # anything matches
    value, unit = read_number(rest)
    if by_angle or unit:
        if unit and parse_unit(unit).dimension != ANGLE:
            raise ProblemError(_("this is no position"), found=quote(source), allowed=_("7, or phi = 210 deg"))
        return None, parse_unit(unit or "deg").si(value)
    if value != int(value):
        raise ProblemError(_("this is no position"), found=quote(source), allowed=_("7, or phi = 210 deg"))
    return int(value), None
