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


class NotAlikeError(ValueError):
    """Two linkages differ in more than their numbers. path: place of the difference."""

    def __init__(self, path: str) -> None:
        super().__init__(f"the linkages differ in {path}, which is no number")
        self.path = path


def numeric_leaves(record: Any) -> Iterator[tuple[str, Any]]:
    """Yield all numbers of a record with their paths, and everything else that must be equal in linkages of one
    kind.
    """
    return record_leaves(record, NOT_COMPARED)


def with_numbers(record: Any, new: Mapping[str, Any]) -> Any:
    """Return a record with the numbers at some paths replaced."""
    return map_record(lambda path, value: new.get(path, value), record, skip=NOT_COMPARED)


def resolve_traced(record: Any) -> Any:
    """Replace traced numbers in a record by the arrays that they stand for."""
    return with_numbers(record, {path: x.stand for path, x in numeric_leaves(record) if isinstance(x, TracedNumber)})


def split_columns(columns: Real) -> list[Real]:
    """Split columns (variants, n) into arrays (variants, 1)."""
    return [columns[:, k : k + 1] for k in range(columns.shape[1])]


def varying_numbers(linkages: Sequence[Linkage]) -> dict[str, Real]:
    """Return the numbers that differ between linkages, (variants, 1), by path. Raises NotAlikeError."""
    first = dict(numeric_leaves(linkages[0]))
    rows = [list(first.values())]
    for linkage in linkages[1:]:
        leaves = dict(numeric_leaves(linkage))
        if leaves.keys() != first.keys():
            raise NotAlikeError(next(iter(leaves.keys() ^ first.keys())))
        rows.append([leaves[path] for path in first])
    varying = {}
    for path, values in zip(first, zip(*rows, strict=True), strict=True):
        if any(value != values[0] for value in values):
            if not all(isinstance(value, (int, float, complex)) and not isinstance(value, bool) for value in values):
                raise NotAlikeError(path)
            varying[path] = np.array(values)[:, None]
    return varying


def split_real_columns(varying: Mapping[str, Real]) -> tuple[list[Real], Callable[..., dict[str, Any]]]:
    """Split varying numbers into real columns.

    Returns:
        The columns, and a function that combines such columns, or placeholders for them, to numbers by path.
    """
    columns: list[Real] = []
    pieces_by_path: dict[str, tuple[int | complex, ...]] = {}
    for path, values in varying.items():
        pieces: list[int | complex] = []
        for piece in (values.real, values.imag) if np.iscomplexobj(values) else (values,):
            if np.all(piece == piece[0]):
                pieces.append(complex(piece[0, 0]))  # a number for all
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


class NoTapeError(ValueError):
    """No trace is possible: friction, loads by strokes, redundant constraints, or passed dead positions."""


@dataclass(frozen=True)
class Variant:
    """A linkage, the requested positions of its file, and the range of its driver.

    ends: range of the driver (rad or m); None: it rotates on and the motion repeats. asked: queried driver
    coordinates of a task. wanted: for each of them, a required number that varies with the variant.
    """

    linkage: Linkage
    request: Request = field(default_factory=Request)
    ends: tuple[Any, Any] | None = None
    asked: tuple[Any, ...] = ()
    wanted: tuple[Any, ...] = ()

    @property
    def accelerated(self) -> bool:
        """True if the driver speed depends on where it started."""
        return bool(self.linkage.driver.acceleration) and not self.linkage.others

    @property
    def start(self) -> Any:
        """Driver coordinate (rad or m) of position 0; None if it does not matter.

        Raises NoTapeError if the variant must be moved first, through its strokes or its whole range.
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
        raise NoTapeError


Make = Callable[[Sequence[Any]], Variant]  # a variant for numbers, which may be TracedNumbers


def placeholder_linkage(make: Make, first: Sequence[float], data: Sequence[Any], sketch: Sketch) -> Linkage:
    """Return the linkage with placeholders (of a trace, or columns) for its numbers.

    first, sketch: numbers and sketch of the first variant.
    """
    varied = make([TracedNumber(x, stand) for x, stand in zip(first, data, strict=True)])
    linkage: Linkage = replace(resolve_traced(varied.linkage), sketch=sketch)
    return linkage


@dataclass(frozen=True)
class DriverSamples:
    """Samples of the driver range: at fractions of it, then at queried coordinates if `asked`, then at fixed
    ones (rad or m).
    """

    shares: Real
    driver: Real
    asked: bool = False


@dataclass(frozen=True)
class DriverRanges:
    """Driver ranges of variants from `low` by `span`, (variants, 1).

    closed: the driver rotates on and the motion repeats. asked, wanted: queried coordinates and required
    numbers, (variants, n).
    """

    low: Real
    span: Real
    closed: bool
    asked: Real
    wanted: Real

    @classmethod
    def of(cls, variant: Variant, variants: int, turns: int, start: Any = None) -> DriverRanges:
        """Build the ranges. turns: revolutions of a cycle; start: driver coordinate at which its law begins, if it
        matters.
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
        """Return driver coordinates of samples, (variants, samples)."""
        fixed = np.broadcast_to(samples.driver, (len(self.low), len(samples.driver)))
        requested = self.asked if samples.asked else self.asked[:, :0]
        return np.concatenate([self.low + samples.shares * self.span, requested, fixed], axis=1)

    def wanted_at(self, samples: DriverSamples) -> Real:
        """Return required numbers in the columns of queried coordinates of `at`; other columns are meaningless."""
        return replace(self, low=self.low * np.nan, asked=self.wanted).at(samples)


def compute_sketch(linkage: Linkage, kernels: Iterable[GroupSolver]) -> Sketch:
    """Compute all points and angles of the moving links at the sketched position, for groups of known assembly."""
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
