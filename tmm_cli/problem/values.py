"""Evaluation of the values of a problem file by means of its parameters, units and names."""

from __future__ import annotations

import cmath
import re
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.language import N_, _, translated
from tmm_cli.mechanics.numerics import NO_COSINE
from tmm_cli.mechanics.quantities import ANGLE, LENGTH, NUMBER, Dimension
from tmm_cli.problem.arithmetic import MAX_ANGLE, evaluate, evaluate_quantity
from tmm_cli.problem.errors import Path, ProblemError, nearest_name, prefix_errors, quote, unknown_name_error
from tmm_cli.problem.schema_types import OnLine
from tmm_cli.problem.units import PhysicalValue, UnitSystem

LARGEST = 1e12  # SI, of any value: no machine has more, and what it is added to keeps its digits
SMALLEST = 1e-20  # SI, of what has a size: likewise quotients
MAX_BARE_FRACTION = 10  # of a way between two points: a bare number beyond it is a length, or per cent
UNKNOWN_NAMES = {
    "link": N_("there is no link of that name"),
    "moving link": N_("there is no moving link of that name"),
    "point": N_("there is no point of that name"),
    "point of link": N_("link {link} has no point of that name"),
    "frame point": N_("the frame has no point of that name"),
    "point or link": N_("there is no point or link of that name"),
    "link or point": N_("there is no link or point of that name"),
    "pair": N_("there is no pair of that name"),
    "hinge": N_("there is no hinge of that name"),
    "turning or sliding pair": N_("there is no revolute or prismatic pair of that name"),
}
INVALID_NAMES = {
    "link": N_("invalid name of a link"),
    "point": N_("invalid name of a point"),
    "pair": N_("invalid name of a pair"),
    "guide": N_("invalid name of a guide"),
    "load": N_("invalid name of a load"),
}
POINT_NAME = re.compile(r"[^\W\d_][\w'′]{0,15}")
LINK_NAME = re.compile(r"\w[\w'′.-]{0,15}")


class ValueReader:
    """Reader of the values of one file. Every method raises ProblemError, with the given path, for a wrong value.

    Attributes:
        parameters: values of the parameters, by name.
        units: units of numbers that are written without a unit.
    """

    def __init__(self, parameters: Mapping[str, PhysicalValue], units: UnitSystem) -> None:
        self.parameters = parameters
        self.units = units

    def number(self, value: Any, want: Dimension, path: Path) -> float:
        """Evaluate a value in SI; a value that is too large for a mechanism is refused."""
        with prefix_errors(*path):
            number = self.read_si(value, want, path)
            limit = self.limit(want, path)
            if not -limit <= number <= limit:
                most = f"{self.units.from_si(limit, want):.6g} {self.units.symbol(want)}".rstrip()
                raise ProblemError(
                    _("this value is too large for a mechanism"),
                    found=quote(value),
                    allowed=_("{most} or less").format(most=most),
                )
            return number

    def read_si(self, value: Any, want: Dimension, path: Path) -> float:
        """Evaluate a value in SI, of any magnitude."""
        return evaluate(value, self.parameters, self.units, want)

    def limit(self, want: Dimension, path: Path) -> float:
        """Return the largest absolute value (SI) that a quantity of this dimension may have at a path of the file."""
        return MAX_ANGLE if want == ANGLE else LARGEST

    def is_bare(self, value: Any) -> bool:
        """Return True if a value of the file is a number without a unit."""
        return evaluate_quantity(value, self.parameters, self.units, pi=None).dimension is None

    def positive(self, value: Any, want: Dimension, path: Path, *, zero: bool = False) -> float:
        """Evaluate a value in SI that must be positive; with `zero` it may also be zero."""
        number = self.number(value, want, path)
        if number < 0 or (number == 0 and not zero):
            message = _("{want} cannot be negative") if number < 0 else _("{want} cannot be zero")
            raise ProblemError(
                message.format(want=want),
                path=path,
                found=quote(value) if isinstance(value, str) else str(value),
                allowed=_("zero or more") if zero else _("more than zero"),
            )
        if 0 < number < SMALLEST and not (zero and want == NUMBER):  # a share that may be zero divides nothing
            raise self.too_small(value, SMALLEST, want, path)
        return number

    def fraction(self, value: Any, path: Path, *, zero: bool = False) -> float:
        """Evaluate a fraction, greater than 0 (with `zero`: or 0) and at most 1. A percentage needs its sign %."""
        number = self.positive(value, NUMBER, path, zero=zero)
        if number > 1:
            percent = f"{value} %" if isinstance(value, int | float) and value <= 100 else _("0 to 1, or 0 to 100 %")
            raise ProblemError(_("a fraction cannot be greater than 1"), path=path, found=quote(value), allowed=percent)
        return number

    def too_small(self, value: Any, least: float, want: Dimension, path: Path) -> ProblemError:
        """Return the error for a value of the file that is smaller than the smallest accepted value, `least` (SI)."""
        least_text = f"{self.units.from_si(least, want):.6g} {self.units.symbol(want)}".rstrip()
        return ProblemError(
            _("this value is too small for a mechanism"),
            path=path,
            found=quote(value),
            allowed=_("{least} or more").format(least=least_text),
        )

    def vector(self, value: Any, want: Dimension, path: Path) -> complex:
        """Evaluate two coordinates and return x + iy in SI."""
        if not isinstance(value, list | tuple) or len(value) != 2:
            raise ProblemError(_("expected two coordinates [x, y]"), path=path, found=quote(value))
        return make_complex(self.number(value[0], want, (*path, 0)), self.number(value[1], want, (*path, 1)))

    def place(self, value: Any, points: Mapping[str, complex], path: Path, link: str) -> complex:
        """Return a position on a link (m), in the axes of the link.

        The value is the name of a point, two coordinates, or a fraction of the distance between two points.
        """
        if isinstance(value, str):
            return points[
                self.known_name(value, points, path, f"point of link {link}" if link != "0" else "frame point")
            ]
        if isinstance(value, OnLine):
            first, second = self.two_points(value.on, points, (*path, "on"))
            span = points[second] - points[first]
            share = self.share_of(abs(span), value.at, (first, second), (*path, "at"))
            side = self.number(value.side, LENGTH, (*path, "side"))
            return points[first] + share * span + (1j * side * span / abs(span) if side else 0)
        return self.vector(value, LENGTH, path)

    def share_of(self, length: Any, value: Any, points: tuple[str, str], path: Path) -> float:
        """Return a position on the line through two points as a fraction of the distance between them.

        The file may give this position as a fraction or as a distance from the first point, e.g. 110 mm.

        Args:
            length: distance between the two points (m).
            value: value of the file.
            points: names of the two points.
            path: path of the value.
        """
        with prefix_errors(*path):
            dimension = evaluate_quantity(value, self.parameters, self.units, pi=None).dimension
        if dimension == LENGTH:
            distance: float = self.number(value, LENGTH, path) / length
            return distance
        share = self.number(value, NUMBER, path)
        if dimension is None and not -MAX_BARE_FRACTION <= share <= MAX_BARE_FRACTION:
            number, (first, second) = f"{share:.6g}", points
            raise ProblemError(
                _("expected a fraction of the distance from {first} to {second}").format(first=first, second=second),
                path=path,
                found=quote(value),
                allowed=_(
                    "e.g. 0.5, or {number} % if a percentage is meant; for a distance from {first} write "
                    "{number} {unit}"
                ).format(number=number, unit=self.units.spelt(LENGTH), first=first),
            )
        return share

    @staticmethod
    def known_name(name: str, names: Iterable[str], path: Path, kind: str, *, key: bool = False) -> str:
        """Check that a name is one of the known names, and return it.

        kind: kind of object for the error message, such as `point of link 3`.
        """
        if name in names:
            return name
        raise unknown_name_error(name, names, unknown_name_message(kind), path=path, key=key)

    @staticmethod
    def refuse_same(links: Sequence[str], path: Path) -> None:
        """Refuse a list of links in which a link occurs twice."""
        if len(set(links)) < len(links):
            raise ProblemError(_("the links must be different"), path=path, found=", ".join(links))

    def two_points(self, text: str, points: Mapping[str, complex], path: Path) -> tuple[str, str]:
        """Split the names of two points of a link that are written together, as CD or C-D."""
        written = re.split(r"\s*[-–, ]\s*", text.strip())
        splits = [(text[:k], text[k:]) for k in range(1, len(text))]
        if len(written) == 2:
            splits = [(written[0], written[1])]
        pairs = [(a, b) for a, b in splits if a in points and b in points and a != b]
        if len(pairs) == 1 and points[pairs[0][0]] != points[pairs[0][1]]:
            return pairs[0]
        near = None
        if len(pairs) > 1:
            message = _("this can be read in several ways; put a hyphen between the two points")
        elif pairs:
            message = _("these two points coincide")
        else:
            message = _("expected two points of the same link")
            near = nearest_name(text, [a + b for a in points for b in points if a != b])
        raise ProblemError(
            message,
            path=path,
            found=quote(text),
            allowed=_("two of these points: {points}").format(points=", ".join(points)),
            near=near,
        )


@dataclass(frozen=True)
class FileSection:
    """A section of the file after validation of its keys. Errors contain the path of the wrong value.

    Attributes:
        keys: pydantic model with the keys of the section.
        path: path of the section in the file.
        values: reader of the values of the file.
    """

    keys: Any
    path: Path
    values: ValueReader

    def number(self, key: str, want: Dimension) -> float:
        return self.values.number(getattr(self.keys, key), want, self.at(key))

    def positive(self, key: str, want: Dimension, *, zero: bool = False) -> float:
        return self.values.positive(getattr(self.keys, key), want, self.at(key), zero=zero)

    def at(self, key: str) -> Path:
        """Return the path of a key in the file; the key is spelt as in the file."""
        fields = getattr(type(self.keys), "model_fields", {})
        return (*self.path, fields[key].alias or key if key in fields else key)

    def place(self, key: str, points: Mapping[str, complex], link: str) -> complex:
        return self.values.place(getattr(self.keys, key), points, (*self.path, key), link)

    def columns(
        self, key: str, argument: Dimension, want: Dimension, *, jumps: bool = True
    ) -> tuple[tuple[Any, ...], tuple[Any, ...]]:
        """Evaluate both columns of a table, in SI. Raises ProblemError if the first column does not increase.

        jumps: True if two successive rows may have the same first value, as at a jump.
        """
        rows, path = getattr(self.keys, key), (*self.path, key)
        first = tuple(self.values.number(row[0], argument, (*path, k, 0)) for k, row in enumerate(rows))
        second = tuple(self.values.number(row[1], want, (*path, k, 1)) for k, row in enumerate(rows))
        for k in range(1, len(first)):
            if first[k] > first[k - 1]:
                continue
            allowed = None
            if first[k] == first[k - 1]:
                if jumps and (k < 2 or first[k - 2] < first[k]):
                    continue
                allowed = _("for a jump, two rows: the value before it and the value after it")
                if not jumps:
                    allowed = _("each value only once")
            message = _("the values in the first column must increase")
            raise ProblemError(message, path=(*path, k, 0), found=str(rows[k][0]), allowed=allowed)
        return first, second

    def known_name(self, key: str, names: Iterable[str], kind: str) -> str:
        return self.values.known_name(getattr(self.keys, key), names, (*self.path, key), kind)

    def two_links(self, links: Iterable[str]) -> tuple[str, str]:
        """Return the two links named under `between`. Raises ProblemError if they are unknown or equal."""
        i, j = (
            self.values.known_name(n, links, (*self.path, "between", k), "link")
            for k, n in enumerate(self.keys.between)
        )
        self.values.refuse_same((i, j), (*self.path, "between"))
        return i, j

    def one_of(self, *keys: str) -> str:
        """Return the one key of `keys` that the section contains. Raises ProblemError if it contains none or several
        of them.
        """
        given_keys = [key for key in keys if getattr(self.keys, key) is not None]
        if len(given_keys) != 1:
            quoted, allowed = ", ".join(given_keys) or None, ", ".join(keys)
            raise self.refusal("", _("expected exactly one of these keys"), quoted, allowed)
        return given_keys[0]

    def refusal(
        self, key: str, message: str, found: str | None = None, allowed: str | None = None, *, at_key: bool = False
    ) -> ProblemError:
        """Return the error for the value of a key; for an empty key, for the whole section.

        at_key: True if the key itself is wrong and not its value.
        """
        path = self.at(key) if key else self.path
        return ProblemError(message, path=path, found=found, allowed=allowed, key=at_key or not key)


def unknown_name_message(what: str) -> str:
    """Return the message for an unknown name. what: kind of object, such as "link" or "point of link 3"."""
    kind, __, link = what.partition(" of link ")
    return translated(UNKNOWN_NAMES["point of link" if link else kind]).format(link=link)


def check_name(name: str, path: Path, kind: str, taken: Container[str] = ()) -> None:
    """Refuse a name that is taken, or that cannot be used in tables, drawings and file names."""
    pattern = LINK_NAME if kind == "link" else POINT_NAME
    if not pattern.fullmatch(name):
        raise ProblemError(
            translated(INVALID_NAMES[kind]),
            path=path,
            found=quote(name),
            allowed=_("letters and digits, at most 16 characters")
            if kind == "link"
            else _("letters and digits, at most 16 characters, beginning with a letter"),
            key=True,
        )
    if name in taken:
        raise ProblemError(_("this name is already in use"), path=path, found=quote(name), key=True)


def make_complex(x: float, y: float) -> complex:
    """Return the complex number x + iy with the precision of its coordinates, which may be double-double numbers."""
    return complex(x, y) if isinstance(x, float) and isinstance(y, float) else x + 1j * y


def vector_angle(vector: complex) -> float:
    """Return the angle of a vector (rad), with the precision of its coordinates."""
    return cmath.phase(vector) if isinstance(vector, complex) else np.angle(vector)


def unit_vector(angle: float) -> complex:
    """Return the unit vector e^(i angle), exact along the coordinate axes."""
    if not isinstance(angle, float):
        return make_complex(np.cos(angle), np.sin(angle))
    turned = cmath.exp(1j * angle)
    return complex(*(0.0 if abs(component) < NO_COSINE else component for component in (turned.real, turned.imag)))
