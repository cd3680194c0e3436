"""Pivots and pins that guide a coupler plane through 2, 3 or 4 positions.

A position is given by the origin P of the plane (complex, m) and the angle theta of its axis (rad). A dyad AB has its
pivot A on the frame and its pin B in the plane (b, in the plane's axes). Its pivot is the centre of a circle through
all positions of its pin. For 4 positions the pin lies on the circle-point curve and the pivot on the centre-point curve
(L. Burmester, Lehrbuch der Kinematik, 1888). With the rotation beta2 of AB from position 1 to 2,
    W (e^(i beta_j) - 1) + Z (e^(i alpha_j) - 1) = P_j - P_1,
where W = AB and Z = BP in position 1, and alpha_j = theta_j - theta_1. The vanishing determinant of these equations is
the closure condition of an auxiliary four-bar in the unknown rotations (G. N. Sandor, A. G. Erdman, Advanced Mechanism
Design 2, 1984). All calculations use extended precision. Leading axes of arrays count dyads or tasks.
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
    """Required positions of the coupler plane. The last axis of each array is that of the positions.

    Attributes:
        places: origins of the plane's axes (complex, m).
        angles: angles of the plane's x axis (rad).
    """

    places: Any
    angles: Any

    def on_frame(self, local: Any) -> Any:
        """Convert points of the plane to frame coordinates in every position.

        Args:
            local: points in the plane's axes (complex, m), shape (...).

        Returns:
            Points on the frame, shape (..., positions).
        """
        return self.places + np.asarray(local, COMPLEX)[..., None] * unit_vector(self.angles)

    def in_plane(self, fixed: Any) -> Any:
        """Convert fixed points to the plane's axes in every position.

        Args:
            fixed: points on the frame (complex, m), shape (...).

        Returns:
            Points in the plane's axes, shape (..., positions).
        """
        return (np.asarray(fixed, COMPLEX)[..., None] - self.places) * unit_vector(-np.asarray(self.angles))

    @cached_property
    def loop(self) -> tuple[Any, ...]:
        """Coefficients of the auxiliary four-bar d2 e^(i b2) + d3 e^(i b3) + d4 e^(i b4) = d2 + d3 + d4 for four
        positions.

        They are, in this order: P_j - P_1, e^(i alpha_j) - 1 (see the module), d2, d3, |d3|, |d4|, d2 + d3 + d4.
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
    """Dyads, each with a pivot on the frame and a pin in the coupler plane.

    Attributes:
        pivot: pivots on the frame (complex, m).
        pin: pins in the plane's axes (complex, m).
    """

    pivot: Any
    pin: Any

    def __getitem__(self, at: Any) -> Dyads:
        return Dyads(np.asarray(self.pivot)[at], np.asarray(self.pin)[at])


def unit_vector(angle: Any) -> Any:
    """Return e^(i angle) in extended precision, for an angle in rad."""
    angle = np.asarray(angle, EXACT)
    return np.cos(angle) + 1j * np.sin(angle)


def equal_angles(angles: Any) -> bool:
    """Return True if all angles (rad) are equal, so that the plane does not rotate between the positions."""
    return bool(np.all(np.abs(unit_vector(np.asarray(angles) - angles[0]) - 1) < NO_TURN))


def circle_centre(points: Any) -> Any:
    """Return the centre of the circle through three points.

    Args:
        points: three points (complex, m) on the last axis.

    Returns:
        The centre (complex, m); infinite or nan if the points lie on a straight line.
    """
    first, second = points[..., 1] - points[..., 0], points[..., 2] - points[..., 0]
    with np.errstate(all="ignore"):
        area = (np.conj(first) * second).imag
        square = (first * np.conj(first)).real * second - (second * np.conj(second)).real * first
        return points[..., 0] - 1j * square / (2 * area)


def point_at_distance(points: Any, radius: Any, side: float) -> Any:
    """Return the point that has the same given distance from two points.

    It is the pivot of a link of given length whose moving end has two given positions.

    Args:
        points: two points (complex, m) on the last axis.
        radius: distance from both points (m).
        side: side of the line from the first to the second point, 1 left, -1 right.

    Returns:
        The point (complex, m); nan if the distance is too small.
    """
    segment = points[..., 1] - points[..., 0]
    half = np.abs(segment) / 2
    with np.errstate(all="ignore"):
        height = np.sqrt((radius - half) * (radius + half))
    return (points[..., 0] + points[..., 1]) / 2 + 1j * side * height * segment / (2 * half)


def dyads_by_rotation(poses: CouplerPoses, turn: Any, branch: Any, ends: bool = False) -> Dyads:
    """Return the dyads for four positions whose link AB rotates by a given angle from position 1 to 2.

    Args:
        poses: the four positions.
        turn: rotation of AB (rad), number or array.
        branch: which of the two solutions, 0 or 1.
        ends: True if a solution is known to exist. Rounding errors that would make it complex at the limits of the
            rotation are then ignored.

    Returns:
        The dyads; nan where no solution exists.
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
    """Quality of four-bars ABCD whose link AB drives them from the first to the last position.

    Attributes:
        defect: 0 for none, 1 if the positions do not all belong to one assembly, 2 if they are not reached in order, 3
            if AB cannot move from one of them to the next (dead position).
        least: smallest transmission angle (rad).
        turn: rotation of AB from the first to the last position (rad), positive counterclockwise.
        worst: angle of AB, measured from AD, at which the transmission angle is smallest (rad).
    """

    defect: Any
    least: Any
    turn: Any
    worst: Any


def rate_guidance(poses: CouplerPoses, first: Dyads, second: Dyads) -> GuidanceQuality:
    """Return the quality of the four-bars formed by the dyads AB and DC.

    Args:
        poses: required positions of the coupler.
        first, second: dyads AB and DC, arrays that can be broadcast together.
    """
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
    """Given quantities of one dyad; None if not given.

    With two or three positions the pin or the pivot is given; with two positions also the length and the side. With
    four positions the rotation and the branch, or a point near the pivot, may be given.

    Attributes:
        pin: pin in the coupler axes (complex, m).
        pivot: pivot on the frame (complex, m).
        length: length of the link (m).
        side: side of the line from position 1 to 2 on which the other end of the link lies, `left` or `right`.
        turn: rotation of the link from position 1 to 2 (rad).
        branch: which of the two solutions with this rotation, 0 or 1.
        near: point (complex, m) to which the pivot shall be as near as possible.
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
    """Required positions of a coupler, and the given quantities of the dyads AB and DC.

    Attributes:
        places: origins of the coupler axes (complex, m).
        angles: angles of the coupler's x axis (rad).
        sides: given quantities of the dyads, by name (AB, DC).
        keep: True if solutions with branch, order or circuit defects are accepted.
        within: opposite corners (complex, m) of a rectangle in which the pivots that are not given must lie; only with
            four positions. None for no rectangle.
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
        """True if there are four positions between which the coupler does not rotate."""
        return len(self.angles) == 4 and equal_angles(self.poses.angles)

    @property
    def size(self) -> float:
        """Characteristic length of the task (m).

        It is the largest of the distances between positions and of the distances of given pins from the coupler's
        origin. If these are zero, it is the largest distance of a given pivot from position 1, or the largest given
        length.
        """
        origins = np.asarray(self.places, complex)
        pin_distances = [abs(complex(s.pin)) for s in self.sides.values() if s.pin is not None]
        length = float(max(np.max(np.abs(origins[:, None] - origins)), *pin_distances, 0.0))
        if length == 0:
            away = [abs(complex(s.pivot) - origins[0]) for s in self.sides.values() if s.pivot is not None]
            length = float(max([*away, *(s.length for s in self.sides.values() if s.length is not None), 0.0]))
        return length

    def outside(self, points: Any) -> Any:
        """Return the distance (m) of points from the rectangle `within`; 0 inside it, or if there is none."""
        if self.within is None:
            return np.zeros(np.shape(points))
        (x, y), (u, v) = ((corner.real, corner.imag) for corner in self.within)
        at = np.asarray(points, complex)
        across = np.maximum(min(x, u) - at.real, at.real - max(x, u))
        return np.hypot(np.maximum(across, 0.0), np.maximum(np.maximum(min(y, v) - at.imag, at.imag - max(y, v)), 0.0))
