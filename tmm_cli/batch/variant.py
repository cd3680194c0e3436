"""Variants of a linkage: their numbers, driver ranges and sketches."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from tmm_cli.batch.traced_arrays import TracedNumber
from tmm_cli.mechanics.groups import DriverMotion, GroupSolver
from tmm_cli.mechanics.kinematics import compute_motion
from tmm_cli.mechanics.linkage import Linkage, Request, Sketch
from tmm_cli.mechanics.numerics import SAME_SKETCH, Real, map_record, record_leaves

NOT_COMPARED = ("sketch",)  # describes the assembly of a linkage, not the linkage


class IncompatibleLinkagesError(ValueError):
    """Raised if linkages differ in more than their numbers. `path` says where they differ."""

    def __init__(self, path: str) -> None:
        super().__init__(f"the linkages differ in {path}, which is no number")
        self.path = path


def numeric_leaves(record: Any) -> Iterator[tuple[str, Any]]:
    """Yield the path and the value of every field of a record.

    The numbers may differ between linkages of one kind; all other fields must be equal.
    """
    return record_leaves(record, NOT_COMPARED)


def with_numbers(record: Any, new: Mapping[str, Any]) -> Any:
    """Return a record with the numbers at some paths replaced."""
    return map_record(lambda path, value: new.get(path, value), record, skip=NOT_COMPARED)


def resolve_traced(record: Any) -> Any:
    """Replace the traced numbers in a record by the arrays or placeholders that they represent."""
    return with_numbers(
        record, {path: x.placeholder for path, x in numeric_leaves(record) if isinstance(x, TracedNumber)}
    )


def split_columns(columns: Real) -> list[Real]:
    """Split an array (variants, n) into n arrays (variants, 1)."""
    return [columns[:, k : k + 1] for k in range(columns.shape[1])]


def varying_numbers(linkages: Sequence[Linkage]) -> dict[str, Real]:
    """Return the numbers that differ between linkages, (variants, 1), by path.

    Raises:
        IncompatibleLinkagesError: the linkages differ in more than their numbers.
    """
    first = dict(numeric_leaves(linkages[0]))
    rows = [list(first.values())]
    for linkage in linkages[1:]:
        leaves = dict(numeric_leaves(linkage))
        if leaves.keys() != first.keys():
            raise IncompatibleLinkagesError(next(iter(leaves.keys() ^ first.keys())))
        rows.append([leaves[path] for path in first])
    varying = {}
    for path, values in zip(first, zip(*rows, strict=True), strict=True):
        if any(value != values[0] for value in values):
            if not all(isinstance(value, (int, float, complex)) and not isinstance(value, bool) for value in values):
                raise IncompatibleLinkagesError(path)
            varying[path] = np.array(values)[:, None]
    return varying


def split_real_columns(varying: Mapping[str, Real]) -> tuple[list[Real], Callable[..., dict[str, Any]]]:
    """Split varying numbers, real or complex, into real columns.

    Returns:
        The columns, each (variants, 1), and the inverse function. From columns, or from placeholders for them, it makes
        a mapping of the numbers by their paths in the linkage.
    """
    columns: list[Real] = []
    pieces_by_path: dict[str, tuple[int | complex, ...]] = {}
    for path, values in varying.items():
        pieces: list[int | complex] = []
        for piece in (values.real, values.imag) if np.iscomplexobj(values) else (values,):
            if np.all(piece == piece[0]):
                pieces.append(complex(piece[0, 0]))  # equal for all linkages
            else:
                pieces.append(len(columns))
                columns.append(np.ascontiguousarray(piece, dtype=float))
        pieces_by_path[path] = tuple(pieces)

    def together(*data: Any) -> dict[str, Any]:
        def one(piece: int | complex) -> Any:
            return piece.real if isinstance(piece, complex) else data[piece]

        return {
            path: one(at[0]) if len(at) == 1 else one(at[0]) + 1j * one(at[1]) for path, at in pieces_by_path.items()
        }

    return columns, together


# Variant of a linkage: its numbers, the range of its driver, its assembly at the sketched position.


WANTED = "wanted"  # output name of required numbers at requested positions


class NotTraceableError(ValueError):
    """Raised if operations cannot be traced.

    Reasons are friction, loads that depend on strokes, redundant constraints, and dead positions on the path.
    """


@dataclass(frozen=True)
class Variant:
    """A linkage with the requested positions of its file and the range of its driver.

    Attributes:
        linkage: the linkage.
        request: requested positions.
        ends: range of the driver, rad or m; None if it rotates fully and the motion repeats.
        asked: driver coordinates at which a synthesis requires certain values, rad or m.
        wanted: the required values, which may differ between variants.
    """

    linkage: Linkage
    request: Request = field(default_factory=Request)
    ends: tuple[Any, Any] | None = None
    asked: tuple[Any, ...] = ()
    wanted: tuple[Any, ...] = ()

    @property
    def accelerated(self) -> bool:
        """True if the speed of the driver depends on the coordinate at which its motion begins.

        That is the case for a single driver with a constant acceleration.
        """
        return bool(self.linkage.driver.acceleration) and not self.linkage.others

    @property
    def start(self) -> Any:
        """Driver coordinate (rad or m) of position 0; None if the driver speed does not depend on it.

        Raises:
            NotTraceableError: it can be found only by solving the motion, through strokes or the range of the driver.
        """
        if not self.accelerated:
            return None
        request, driver = self.request, self.linkage.driver
        if request.places:
            return request.places[0]
        if self.ends is None and not isinstance(request.start, str):
            return request.start
        if self.ends is not None and driver.stroke is not None:
            return driver.stroke[0] if driver.sense > 0 else driver.stroke[1]
        raise NotTraceableError


Make = Callable[[Sequence[Any]], Variant]  # a variant for numbers, which may be TracedNumbers


def placeholder_linkage(make: Make, first: Sequence[float], data: Sequence[Any], sketch: Sketch) -> Linkage:
    """Build the linkage with placeholders, or columns of numbers, in place of its numbers.

    Args:
        make: function that builds a variant from its numbers.
        first, sketch: numbers and sketch of the first variant.
        data: placeholders or columns.
    """
    varied = make([TracedNumber(x, placeholder) for x, placeholder in zip(first, data, strict=True)])
    linkage: Linkage = replace(resolve_traced(varied.linkage), sketch=sketch)
    return linkage


@dataclass(frozen=True)
class DriverSamples:
    """Driver coordinates at which variants are sampled.

    Attributes:
        shares: fractions of the driver range.
        driver: fixed driver coordinates, rad or m.
        asked: True to add the driver coordinates `asked` of the variants.
    """

    shares: Real
    driver: Real
    asked: bool = False


@dataclass(frozen=True)
class DriverRanges:
    """Driver ranges of variants.

    Attributes:
        low, span: beginning and length of each range, (variants, 1).
        closed: True if the driver rotates fully and the motion repeats.
        asked: driver coordinates at which a synthesis requires certain values, (variants, n).
        wanted: the required values, (variants, n).
    """

    low: Real
    span: Real
    closed: bool
    asked: Real
    wanted: Real

    @classmethod
    def of(cls, variant: Variant, variants: int, turns: int, start: Any = None) -> DriverRanges:
        """Build the driver ranges of variants.

        Args:
            variant: a variant whose numbers are scalars or columns (variants, 1).
            variants: number of variants.
            turns: revolutions of the driver in a cycle.
            start: driver coordinate at which the law of motion begins; None if the driver speed does not depend on it.
        """
        ones = np.ones((variants, 1))
        none = np.zeros((variants, 0))
        positions, required = (
            np.hstack([none, *(np.reshape(number, (-1, 1)) * ones for number in numbers)])
            for numbers in (variant.asked, variant.wanted)
        )
        if variant.ends is None:
            sketch, span = variant.linkage.sketch.at, 2 * np.pi * turns
            low = sketch if start is None else start if variant.linkage.driver.sense > 0 else start - span
            return cls(np.reshape(low, (-1, 1)) * ones, span * ones, True, positions, required)
        low, high = (np.reshape(end, (-1, 1)) * ones for end in variant.ends)
        return cls(low, high - low, False, positions, required)

    def at(self, samples: DriverSamples) -> Real:
        """Return the driver coordinates of samples, (variants, samples)."""
        fixed = np.broadcast_to(samples.driver, (len(self.low), len(samples.driver)))
        requested = self.asked if samples.asked else self.asked[:, :0]
        return np.concatenate([self.low + samples.shares * self.span, requested, fixed], axis=1)

    def wanted_at(self, samples: DriverSamples) -> Real:
        """Return the values that a synthesis requires at the samples of `at`.

        Only the columns that belong to the driver coordinates `asked` are meaningful.
        """
        return replace(self, low=self.low * np.nan, asked=self.wanted).at(samples)


def compute_sketch(linkage: Linkage, kernels: Iterable[GroupSolver]) -> Sketch:
    """Compute all points and angles of the moving links at the position of the sketch.

    kernels: the group solvers, in solving order.
    """
    at = linkage.sketch.at
    poses = compute_motion(linkage, kernels, np.array([at]), DriverMotion(at, 1.0, 0.0, 1), 0).poses
    points = {
        point: complex(poses[link].at(local)[0])
        for link in linkage.moving
        for point, local in linkage.links[link].points.items()
    }
    driven = {driver.link for driver in linkage.cranks}
    angles = {link: float(np.angle(poses[link].z)[0]) for link in linkage.moving if link not in driven}
    return Sketch(at, points, angles)


def same_assembly(first: Sketch, second: Sketch) -> bool:
    """Return True if two sketches show the same assembly."""
    extent = max((abs(place) for place in first.points.values()), default=1.0)
    return all(abs(place - second.points[name]) <= SAME_SKETCH * extent for name, place in first.points.items())
