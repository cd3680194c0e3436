"""Pivots that guide a plane through 2, 3 or 4 positions: centres of circles through the positions of one of its points.

A position is a point P (complex, m), the origin of the plane, and an angle theta (rad) of its axis. A dyad AB has its
pivot A on the frame and its pin B in the plane (b, in the plane's axes). For 4 positions B lies on the circle-point
curve and A on the centre-point curve (L. Burmester, Lehrbuch der Kinematik, 1888); with the rotation beta2 of AB from
position 1 to 2,
    W (e^(i beta_j) - 1) + Z (e^(i alpha_j) - 1) = P_j - P_1,
where W = AB and Z = BP in position 1, alpha_j = theta_j - theta_1. The determinant of these equations is a closed four-
bar of the unknown rotations (G. N. Sandor, A. G. Erdman, Advanced Mechanism Design 2, 1984). Extended precision
throughout; leading axes of arrays are dyads or tasks.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Final

import numpy as np

from tmm_cli.mechanics.numerics import DEAD_COSINE, NO_TURN
from tmm_cli.synthesis.four_bar import extreme_cosine

EXACT: Final = np.longdouble
COMPLEX: Final = np.clongdouble


@dataclass(frozen=True)
class CouplerPoses:
    """Positions of the coupler: points (m, complex) and angles (rad), positions on the last axis."""

    places: Any
    angles: Any

    def on_frame(self, local: Any) -> Any:
        """Transform points of the plane to the frame, in every position; positions on an added last axis."""
        return self.places + np.asarray(local, COMPLEX)[..., None] * unit_vector(self.angles)

    def in_plane(self, fixed: Any) -> Any:
        """Transform points of the frame to the plane's axes, in every position."""
        return (np.asarray(fixed, COMPLEX)[..., None] - self.places) * unit_vector(-np.asarray(self.angles))

    @cached_property
    def loop(self) -> tuple[Any, ...]:
        """Coefficients of the closed four-bar of four positions.

        P_j - P_1, e^(i alpha_j) - 1, d2, d3, |d3|, |d4|, d2 + d3 + d4.
        """
        origins, angles = np.asarray(self.places, COMPLEX), np.asarray(self.angles, EXACT)
        d, a = origins[..., 1:] - origins[..., :1], unit_vector(angles[..., 1:] - angles[..., :1]) - 1
        d2, d3, d4 = (
            a[..., 1] * d[..., 2] - a[..., 2] * d[..., 1],
            a[..., 2] * d[..., 0] - a[..., 0] * d[..., 2],
            a[..., 0] * d[..., 1] - a[..., 1] * d[..., 0],
        )
        return d, a, d2, d3, np.abs(d3), np.abs(d4), d2 + d3 + d4


@dataclass(frozen=True)
class Dyads:
    """Pivots on the frame and pins in the plane (m, complex)."""

    pivot: Any
    pin: Any

    def __getitem__(self, at: Any) -> Dyads:
        return Dyads(np.asarray(self.pivot)[at], np.asarray(self.pin)[at])


def unit_vector(angle: Any) -> Any:
    """Return e^(i angle) in extended precision."""
    angle = np.asarray(angle, EXACT)
    return np.cos(angle) + 1j * np.sin(angle)


def equal_angles(angles: Any) -> bool:
    """Return True if the plane does not rotate between positions with these angles (rad)."""
    return bool(np.all(np.abs(unit_vector(np.asarray(angles) - angles[0]) - 1) < NO_TURN))


def circle_centre(points: Any) -> Any:
    """Return the centre of the circle through three points (last axis); infinite or nan if they lie on a line."""
    first, second = points[..., 1] - points[..., 0], points[..., 2] - points[..., 0]
    with np.errstate(all="ignore"):
        area = (np.conj(first) * second).imag
        square = (first * np.conj(first)).real * second - (second * np.conj(second)).real * first
        return points[..., 0] - 1j * square / (2 * area)


def point_at_distance(points: Any, radius: Any, side: float) -> Any:
    """Return the point at equal distance from two points, as for a link of given length with two positions.

    Args:
        points: two points (m, complex) on the last axis.
        radius: distance from both (m).
        side: 1: left of the line from the first to the second point, -1: right of it.

    Returns:
        The point (m, complex); nan if the radius is too small.
    """
    segment = points[..., 1] - points[..., 0]
    half = np.abs(segment) / 2
    with np.errstate(all="ignore"):
        height = np.sqrt((radius - half) * (radius + half))
    return (points[..., 0] + points[..., 1]) / 2 + 1j * side * height * segment / (2 * half)


def dyads_by_rotation(poses: CouplerPoses, turn: Any, branch: Any, ends: bool = False) -> Dyads:
    """Return the dyads through four positions whose link AB rotates by `turn` (rad) from position 1 to 2; nan if there
    is none.

    Args:
        branch: 0 or 1, which of the two solutions.
        ends: True if the rotations are known to have dyads, and exceed the limits only by rounding.
    """
    origins, (d, a, d2, d3, size3, size4, total) = np.asarray(poses.places, COMPLEX), poses.loop
    second = unit_vector(turn)
    rest = total - d2 * second
    with np.errstate(all="ignore"):
        length = np.abs(rest)
        cosine = (length**2 + size3**2 - size4**2) / (2 * length * size3)
        cosine = np.clip(cosine, -1, 1) if ends else cosine
        sine = np.sqrt((1 - cosine) * (1 + cosine)) * np.where(np.equal(branch, 0), 1, -1)
        third = rest / length * (cosine + 1j * sine) * size3 / d3
        least = (second - 1) * a[..., 1] - (third - 1) * a[..., 0]
        w = (d[..., 0] * a[..., 1] - d[..., 1] * a[..., 0]) / least
        z = ((second - 1) * d[..., 1] - (third - 1) * d[..., 0]) / least
    pin = -z * unit_vector(-np.asarray(poses.angles, EXACT)[..., 0])
    return Dyads(origins[..., 0] - z - w, pin)


@dataclass(frozen=True)
class GuidanceQuality:
    """Quality of four-bars ABCD driven by AB from the first to the last position.

    Attributes:
        defect: 0 none, 1 positions on two assemblies, 2 positions not in order, 3 AB locks.
        least: smallest transmission angle (rad).
        turn: rotation of AB (rad, signed).
        worst: angle of AB from AD where the transmission angle is smallest.
    """

    defect: Any
    least: Any
    turn: Any
    worst: Any


def rate_guidance(poses: CouplerPoses, first: Dyads, second: Dyads) -> GuidanceQuality:
    """Rate the four-bars formed by dyads AB and DC (broadcast together)."""
    b, c = poses.on_frame(first.pin), poses.on_frame(second.pin)
    a, d = np.asarray(first.pivot)[..., None], np.asarray(second.pivot)[..., None]
    b, c, a, d = (np.asarray(x, complex) for x in (b, c, a, d))
    with np.errstate(all="ignore"):
        l1, l2, l3, l4 = (np.abs(x)[..., 0] for x in (b - a, c - b, c - d, d - a))
        phi = np.angle((b - a) / (d - a))
        steps = np.mod(np.diff(phi, axis=-1), 2 * np.pi)
        side = np.sign(((c - b) * np.conj(c - d)).imag)
        dead = 1 - DEAD_COSINE * (l1**2 + l2**2 + l3**2 + l4**2) / (
            2 * l2 * l3
        )  # dead position, as for a kite with pin C on pivot A
    branch = np.any(side != side[..., :1], axis=-1)
    ratings = []
    for turn in (steps.sum(-1), (steps - 2 * np.pi).sum(-1)):
        low, high = phi[..., 0] + np.minimum(turn, 0), phi[..., 0] + np.maximum(turn, 0)
        with np.errstate(all="ignore"):
            largest, where = extreme_cosine((l1, l2, l3, l4), low, high)
        locks = ~(largest < dead)
        back = np.abs(turn) >= 2 * np.pi
        defect = np.where(branch, 1, np.where(back, 2, np.where(locks, 3, 0)))
        ratings.append((defect, np.arccos(np.clip(largest, 0, 1)), turn, where))
    forward, backward = ratings
    better = (forward[0] < backward[0]) | ((forward[0] == backward[0]) & (forward[1] >= backward[1]))
    return GuidanceQuality(*(np.where(better, x, y) for x, y in zip(forward, backward, strict=True)))


# The task.


SIDES: Final = {"left": 1.0, "right": -1.0}


@dataclass(frozen=True)
class DyadData:
    """Given data of a dyad: its pin (m, coupler's axes) or its pivot (m).

    With two positions also its length (m) and side; with four positions instead the rotation `turn` from position 1 to
    2 (rad) and the branch (0 or 1), or a point `near` (m) to which its pivot shall be nearest.
    """

    pin: Any = None
    pivot: Any = None
    length: Any = None
    side: str = "left"
    turn: Any = None
    branch: int = 0
    near: Any = None


@dataclass(frozen=True)
class CouplerPositionsTask:
    """Positions (m, rad) of the coupler and the given data of the dyads AB and DC.

    keep: True if solutions with defects are accepted. within: opposite corners (m) of a box that contains the free
    pivots of four positions.
    """

    places: tuple[Any, ...]
    angles: tuple[Any, ...]
    sides: Mapping[str, DyadData] = field(default_factory=dict)
    keep: bool = False
    within: tuple[complex, complex] | None = None

    @property
    def poses(self) -> CouplerPoses:
        return CouplerPoses(np.asarray(self.places, np.clongdouble), np.asarray(self.angles, np.longdouble))

    @property
    def still(self) -> bool:
        """True if the coupler does not rotate between four positions."""
        return len(self.angles) == 4 and equal_angles(self.poses.angles)

    @property
    def size(self) -> float:
        """Characteristic length of the task, m.

        The largest distance between positions, or of a given pin from the coupler's origin; if these are zero, the
        largest distance of a given pivot, or a given length.
        """
        origins = np.asarray(self.places, complex)
        pin_distances = [abs(complex(s.pin)) for s in self.sides.values() if s.pin is not None]
        length = float(max(np.max(np.abs(origins[:, None] - origins)), *pin_distances, 0.0))
        if length == 0:
            away = [abs(complex(s.pivot) - origins[0]) for s in self.sides.values() if s.pivot is not None]
            length = float(max([*away, *(s.length for s in self.sides.values() if s.length is not None), 0.0]))
        return length

    def outside(self, points: Any) -> Any:
        """Return the distance (m) of points from the box, 0 inside it."""
        if self.within is None:
            return np.zeros(np.shape(points))
        (x, y), (u, v) = ((corner.real, corner.imag) for corner in self.within)
        at = np.asarray(points, complex)
        across = np.maximum(min(x, u) - at.real, at.real - max(x, u))
        return np.hypot(np.maximum(across, 0.0), np.maximum(np.maximum(min(y, v) - at.imag, at.imag - max(y, v)), 0.0))
