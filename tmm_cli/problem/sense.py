"""Reading the parts of a problem file in the light of its parameters, units and names."""

from __future__ import annotations

import cmath
import re
from collections.abc import Mapping
from typing import Any

import numpy as np

from tmm_cli.problem.errors import Path, ProblemError, nearest, quote
from tmm_cli.problem.expressions import evaluate
from tmm_cli.problem.schema import OnLine
from tmm_cli.problem.units import LENGTH, NUMBER, Dimension, Quantity, UnitSystem

AXIS = 2.5e-16  # the cosine of the double next to a right angle is below this
POINT_NAME = re.compile(r"[^\W\d_][\w'′]{0,15}")
LINK_NAME = re.compile(r"\w[\w'′.-]{0,15}")


class Sense:
    """What values of one file mean. Every method raises ProblemError with the path it was given."""

    def __init__(self, parameters: Mapping[str, Quantity], units: UnitSystem) -> None:
        self.parameters = parameters
        self.units = units

    def number(self, value: Any, want: Dimension, path: Path) -> float:
        """A value in SI."""
        try:
            return evaluate(value, self.parameters, self.units, want)
        except ProblemError as error:
            raise error.at(*path) from None

    def positive(self, value: Any, want: Dimension, path: Path, *, zero: bool = False) -> float:
        """A value in SI that must be above zero (or not below)."""
        number = self.number(value, want, path)
        if number < 0 or (number == 0 and not zero):
            raise ProblemError(
                f"{want} cannot be {'negative' if number < 0 else 'zero'}",
                path=path,
                found=quote(value) if isinstance(value, str) else str(value),
                allowed="zero or more" if zero else "more than zero",
            )
        return number

    def vector(self, value: Any, want: Dimension, path: Path) -> complex:
        """Two coordinates."""
        return planar(self.number(value[0], want, (*path, 0)), self.number(value[1], want, (*path, 1)))

    def place(self, value: Any, points: Mapping[str, complex], path: Path, link: str) -> complex:
        """A place on a link: the name of one of its points, coordinates, or a share of the way between two points."""
        if isinstance(value, str):
            return points[self.known(value, points, path, f"point of link {link}" if link != "0" else "frame point")]
        if isinstance(value, OnLine):
            first, second = self.two_points(value.on, points, (*path, "on"), link)
            way = points[second] - points[first]
            share = self.number(value.at, NUMBER, (*path, "at"))
            side = self.number(value.side, LENGTH, (*path, "side"))
            return points[first] + share * way + (1j * side * way / abs(way) if side else 0)
        return self.vector(value, LENGTH, path)

    @staticmethod
    def known(name: str, names: Mapping[str, Any], path: Path, what: str, *, key: bool = False) -> str:
        """The name, if there is one like it."""
        if name in names:
            return name
        raise ProblemError(
            f"there is no {what} of that name" if not what.startswith("point") else f"no {what} has that name",
            path=path,
            found=quote(name),
            allowed=", ".join(names) or "none is given",
            near=nearest(name, names),
            key=key,
        )

    def two_points(self, text: str, points: Mapping[str, complex], path: Path, link: str) -> tuple[str, str]:
        """Two points of a link written together, CD or C-D."""
        written = re.split(r"\s*[-–, ]\s*", text.strip())
        ways = [(text[:k], text[k:]) for k in range(1, len(text))]
        if len(written) == 2:
            ways = [(written[0], written[1])]
        found = [(a, b) for a, b in ways if a in points and b in points and a != b]
        if len(found) == 1 and points[found[0][0]] != points[found[0][1]]:
            return found[0]
        owner = "the frame" if link == "0" else f"link {link}"
        raise ProblemError(
            f"two points of {owner} are wanted" if not found else "these two points lie on one another"
            if len(found) == 1 else "this can be read in several ways: put a dash between the points",
            path=path,
            found=quote(text),
            allowed=f"two of {', '.join(points)}, such as {_example(points)}",
        )  # fmt: skip


def _example(points: Mapping[str, complex]) -> str:
    names = list(points)
    return names[0] + names[1] if len(names) > 1 else "CD"


def check_name(name: str, path: Path, what: str) -> None:
    """Names go into tables, drawings and file names: letters and figures only."""
    pattern = LINK_NAME if what == "link" else POINT_NAME
    if not pattern.fullmatch(name):
        allowed = "letters and figures, at most 16" + ("" if what == "link" else ", a letter first")
        raise ProblemError(
            f"this cannot be the name of a {what}", path=path, found=quote(name), allowed=allowed, key=True
        )


def planar(x: float, y: float) -> complex:
    """x + iy in the precision of its parts (a longdouble is no float)."""
    return complex(x, y) if isinstance(x, float) and isinstance(y, float) else x + 1j * y


def phase(vector: complex) -> float:
    """The angle of a vector, in its precision."""
    return cmath.phase(vector) if isinstance(vector, complex) else np.angle(vector)


def direction(angle: float) -> complex:
    """e^(i angle), exact across and along the axes."""
    if not isinstance(angle, float):
        return planar(np.cos(angle), np.sin(angle))
    turned = cmath.exp(1j * angle)
    return complex(*(0.0 if abs(part) < AXIS else part for part in (turned.real, turned.imag)))
