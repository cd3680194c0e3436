"""Constraint equations of higher pairs (gears, gear and rack, cam and follower), and laws of motion of followers."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tmm_cli.mechanics.groups.pairs.lower import (
    GuideGeometry,
    HigherPairConstraint,
    JacobianRow,
    ToothConstraint,
    carrier_axis,
)
from tmm_cli.mechanics.groups.state import DriverStates, PairReaction, Poses, Rates
from tmm_cli.mechanics.linkage import Linkage, Slide
from tmm_cli.mechanics.numerics import AT_EDGE_OF_CAM, NO_JUMP_OF_CAM, Real, Vector, dot, pi, unit
from tmm_cli.mechanics.structure import Pair


@dataclass(frozen=True)
class GearConstraint(ToothConstraint):
    """Gear pair on a common carrier, fixed or rotating (planetary), external or internal.

    Its equation: the angle of j relative to the carrier is ratio times the angle of i relative to the carrier, plus an
    offset.

    The teeth act at the pitch point P = (A - ratio B)/(1 - ratio), where gears i and j with axes A and B have the same
    velocity. The tangential force is computed first, the radial one (from the pressure angle) afterwards. The radial
    force pushes an external gear towards its own axis, and of an internal pair it pushes the smaller gear towards its
    own axis. The radial force on j therefore points from axis i to axis j in an external pair, and from j to i in an
    internal one, whichever gear is smaller.

    Attributes:
        axis_i, axis_j: axes of the gears, in the axes of the carrier (m).
    """

    axis_i: complex  # on the carrier, m
    axis_j: complex

    kind = "G"
    away = 1j

    @classmethod
    def of(cls, pair: Pair, linkage: Linkage) -> GearConstraint:
        mesh = pair.mesh
        assert mesh is not None
        return cls(
            pair.name, mesh, carrier_axis(linkage, mesh.i, mesh.carrier), carrier_axis(linkage, mesh.j, mesh.carrier)
        )

    @property
    def lengths(self) -> tuple[bool, ...]:
        return (False,)

    def residuals(self, poses: Poses, drives: DriverStates) -> Sequence[Real]:
        mesh = self.mesh
        i, j, c = (poses[name].turned for name in (mesh.i, mesh.j, mesh.carrier))
        return ((j - c) - mesh.ratio * (i - c) - mesh.offset,)

    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        ratio = self.mesh.ratio
        return {
            self.mesh.i: ((0j, -ratio),),
            self.mesh.j: ((0j, 1.0),),
            self.mesh.carrier: ((0j, ratio - 1.0),),
        }

    def turned(self, link: str, angles: Mapping[str, Any], drives: DriverStates) -> Any:
        mesh = self.mesh
        if link == mesh.carrier:
            return (angles[mesh.j] - mesh.ratio * angles[mesh.i] - mesh.offset) / (1 - mesh.ratio)
        carrier = angles[mesh.carrier]
        if link == mesh.j:
            return carrier + mesh.ratio * (angles[mesh.i] - carrier) + mesh.offset
        return carrier + (angles[mesh.j] - carrier - mesh.offset) / mesh.ratio

    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        return (np.zeros(np.shape(rates[self.mesh.i].w)),)

    def contact(self, poses: Poses) -> tuple[Vector, Vector]:
        ratio, carrier = self.mesh.ratio, poses[self.mesh.carrier]
        pitch_point = (self.axis_i - ratio * self.axis_j) / (1 - ratio)
        line = (self.axis_j - self.axis_i) / abs(self.axis_j - self.axis_i)
        return carrier.at(pitch_point), 1j * (line * carrier.z)


# Gear and rack.


@dataclass(frozen=True)
class RackConstraint(ToothConstraint):
    """Gear and rack on a common carrier.

    Its equation: the displacement of the rack along the carrier is ratio (m per radian) times the angle of the gear
    relative to the carrier, plus an offset.

    The rack may be the runner or the carrier of the prismatic pair. The teeth act at the pitch point, where gear and
    rack have the same velocity: at the distance |ratio| from the axis of the gear, perpendicular to the guide.

    Attributes:
        slide: prismatic pair of the rack.
        axis: axis of the gear, in the axes of the carrier (m).
    """

    slide: Slide
    axis: complex  # of the gear, on the carrier, m

    kind = "K"
    away = -1j

    @classmethod
    def of(cls, pair: Pair, linkage: Linkage) -> RackConstraint:
        mesh = pair.mesh
        assert mesh is not None
        return cls(pair.name, mesh, linkage.slide(mesh.slide), carrier_axis(linkage, mesh.i, mesh.carrier))

    @property
    def lengths(self) -> tuple[bool, ...]:
        return (True,)

    def residuals(self, poses: Poses, drives: DriverStates) -> Sequence[Real]:
        guide = GuideGeometry.at(self.slide, poses)
        turned = poses[self.mesh.i].turned - poses[self.mesh.carrier].turned
        return (dot(guide.u, guide.off) - self.mesh.ratio * turned - self.mesh.offset,)

    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        guide = GuideGeometry.at(self.slide, poses)
        rows = {name: [row] for name, row in guide.jacobian_rows(self.slide, guide.u).items()}
        c, m = rows[self.mesh.carrier][0]
        rows[self.mesh.carrier] = [(c, m + self.mesh.ratio)]
        return rows | {self.mesh.i: [(0j, -self.mesh.ratio)]}

    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        guide = GuideGeometry.at(self.slide, poses)
        return (dot(guide.u, guide.bend(self.slide, rates)),)

    def contact(self, poses: Poses) -> tuple[Vector, Vector]:
        """Return the pitch point (m), and the direction in which the rack moves when its displacement increases."""
        guide = GuideGeometry.at(self.slide, poses)
        forward = guide.u if self.slide.runner == self.mesh.j else -guide.u
        return poses[self.mesh.carrier].at(self.axis) - 1j * self.mesh.ratio * forward, forward


# Cam and follower.


@dataclass(frozen=True)
class CamConstraint(HigherPairConstraint):
    """Cam and follower, defined by the law of motion instead of the profile of the cam.

    Its equation: the displacement (or angle) of the follower is the value of the law, at the angle of the cam relative
    to the carrier, plus an offset.

    The carrier is the frame, or a moving link with the guide of the follower. The law does not determine the point of
    contact. A translating follower is assumed to be flat-faced: it touches the cam at the distance ds/da from the axis
    of the cam, and the force is parallel to its guide (I. I. Artobolevsky, ch. 26). An oscillating follower is loaded
    by a couple, and the cam by the couple of equal power.

    Attributes:
        slide: prismatic pair of a translating follower; None for an oscillating one.
        axis: axis of the cam, in the axes of the carrier (m).
    """

    slide: Slide | None
    axis: complex  # of the cam, on the carrier, m

    kind = "C"

    @classmethod
    def of(cls, pair: Pair, linkage: Linkage) -> CamConstraint:
        mesh = pair.mesh
        assert mesh is not None
        slide = linkage.slide(mesh.slide) if mesh.slide else None
        return cls(pair.name, mesh, slide, carrier_axis(linkage, mesh.i, mesh.carrier))

    @property
    def lengths(self) -> tuple[bool, ...]:
        return (self.slide is not None,)

    def _law(self, poses: Poses) -> tuple[Real, Real, Real]:
        assert self.mesh.law is not None
        return self.mesh.law(poses[self.mesh.i].turned - poses[self.mesh.carrier].turned)

    def residuals(self, poses: Poses, drives: DriverStates) -> Sequence[Real]:
        want = self._law(poses)[0] + self.mesh.offset
        if self.slide is None:
            residual = poses[self.mesh.j].z * np.conj(unit(want))
            return (np.arctan2(residual.imag, residual.real),)
        guide = GuideGeometry.at(self.slide, poses)
        return (dot(guide.u, guide.off) - want,)

    def jacobian_rows(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        slope = self._law(poses)[1]
        rows: dict[str, JacobianRow] = {self.mesh.i: (0j, -slope), self.mesh.carrier: (0j, slope)}
        if self.slide is None:
            follower_rows: Mapping[str, JacobianRow] = {self.mesh.j: (0j, 1.0)}
        else:
            guide = GuideGeometry.at(self.slide, poses)
            follower_rows = guide.jacobian_rows(self.slide, guide.u)
        for name, (place, angle) in follower_rows.items():
            other = rows.get(name, (0j, 0.0))
            rows[name] = (place + other[0], angle + other[1])
        return {name: (row,) for name, row in rows.items()}

    def velocity_terms(self, poses: Poses, rates: Rates) -> Sequence[Real]:
        bend = -self._law(poses)[2] * (rates[self.mesh.i].w - rates[self.mesh.carrier].w) ** 2
        if self.slide is None:
            return (bend,)
        guide = GuideGeometry.at(self.slide, poses)
        return (dot(guide.u, guide.bend(self.slide, rates)) + bend,)

    def contact(self, poses: Poses) -> tuple[Vector, Vector]:
        """Return the contact point of a flat-faced follower (m), and the direction in which the follower moves when its
        displacement increases.
        """
        assert self.slide is not None
        guide = GuideGeometry.at(self.slide, poses)
        forward = guide.u if self.slide.runner == self.mesh.j else -guide.u
        return poses[self.mesh.carrier].at(self.axis) - 1j * self._law(poses)[1] * forward, forward

    def pushes(self, poses: Poses) -> Mapping[str, Sequence[JacobianRow]]:
        return self.jacobian_rows(poses) if self.slide is None else super().pushes(poses)

    def reaction(self, poses: Poses, multipliers: Sequence[Real]) -> PairReaction:
        if self.slide is not None:
            return super().reaction(poses, multipliers)
        n = multipliers[0]
        return PairReaction(n * 0j, couple=n, at=poses[self.mesh.j].x, back=-n * self._law(poses)[1])


# Laws of motion of a cam follower: rise, dwell and return, piece by piece over a turn of the cam.
#
# A piece of rise h over the angle d with x = (a - start)/d from 0 to 1 follows s = h f(x). Sources of f: I. I.
# Artobolevsky, Theory of Mechanisms and Machines, ch. 25 (parabolic, cosine, sine); R. L. Norton, Cam Design, ch. 3
# (3-4-5 and 4-5-6-7 polynomials).


Rise = Callable[[Any], tuple[Any, Any, Any]]
TAU = 2 * np.pi


def _linear(x: Any) -> tuple[Any, Any, Any]:
    return x, 1 + np.zeros_like(x), np.zeros_like(x)


def _parabolic(x: Any) -> tuple[Any, Any, Any]:
    early = x < 0.5 - AT_EDGE_OF_CAM
    rest = 1 - x
    return (
        np.where(early, 2 * x * x, 1 - 2 * rest * rest),
        np.where(early, 4 * x, 4 * rest),
        np.where(early, 4.0, -4.0) + np.zeros_like(x),
    )


def _cosine(x: Any) -> tuple[Any, Any, Any]:
    half = pi(x)
    return (1 - np.cos(half * x)) / 2, half / 2 * np.sin(half * x), half**2 / 2 * np.cos(half * x)


def _sine(x: Any) -> tuple[Any, Any, Any]:
    whole = 2 * pi(x)
    # 2 sin^2(pi x) instead of 1 - cos(2 pi x), which rounds to zero before the follower is at rest
    return x - np.sin(whole * x) / whole, 2 * np.sin(pi(x) * x) ** 2, whole * np.sin(whole * x)


def _polynomial5(x: Any) -> tuple[Any, Any, Any]:
    return (
        x**3 * (10 + x * (-15 + 6 * x)),
        30 * x * x * (1 - x) ** 2,
        60 * x * (1 - x) * (1 - 2 * x),
    )


def _polynomial7(x: Any) -> tuple[Any, Any, Any]:
    return (
        x**4 * (35 + x * (-84 + x * (70 - 20 * x))),
        140 * x**3 * (1 - x) ** 3,
        420 * x * x * (1 - x) ** 2 * (1 - 2 * x),
    )


RISE_LAWS: dict[str, Rise] = {
    "linear": _linear,
    "parabolic": _parabolic,
    "cosine": _cosine,
    "sine": _sine,
    "3-4-5": _polynomial5,
    "4-5-6-7": _polynomial7,
}


@dataclass(frozen=True)
class CamLawPiece:
    """A piece of the law of motion of a follower: a rise, a return or a dwell.

    Attributes:
        over: cam angle over which it extends (rad).
        rise: displacement of the follower (m or rad); negative for a return, zero for a dwell.
        shape: name of the law, a key of RISE_LAWS.
    """

    over: float
    rise: float
    shape: str = "sine"


@dataclass(frozen=True)
class CamLaw:
    """Law of motion of a follower. Call it with a cam angle.

    At the boundary of two pieces the acceleration of the following piece holds.

    Attributes:
        pieces: pieces in turn, which together cover a full turn of the cam.
        start: cam angle at which the first piece starts (rad).
        sense: sense of rotation of the cam, +1 or -1.
    """

    pieces: tuple[CamLawPiece, ...]
    start: float = 0.0
    sense: int = 1

    @cached_property
    def _mirrored(self) -> CamLaw:
        """The same law as a function of the clockwise cam angle.

        This is possible because every piece is symmetric about its middle.
        """
        return CamLaw(tuple(replace(p, rise=-p.rise) for p in reversed(self.pieces)), -self.start)

    @cached_property
    def _table(self) -> tuple[Real, Real, Real, Real]:
        """For each piece: cam angle from the start of the law to the piece, cam angle of the piece, displacement, rise.

        The displacement is that at the start of the piece. Shape (pieces,), or (pieces, variants) where values vary.
        """
        both = np.broadcast_arrays(*(p.over for p in self.pieces), *(p.rise for p in self.pieces))
        over, rise = np.stack(both[: len(self.pieces)]), np.stack(both[len(self.pieces) :])
        return np.cumsum(over, axis=0) - over, over, np.cumsum(rise, axis=0) - rise, rise

    def jumps(self) -> tuple[float, ...]:
        """Return the cam angles (rad, within a turn) at which the velocity of the follower is discontinuous."""
        slopes = [RISE_LAWS[piece.shape](np.array([0.0, 1.0]))[1] for piece in self.pieces]
        ends = [piece.rise / piece.over * slope for piece, slope in zip(self.pieces, slopes, strict=True)]
        most = max(abs(piece.rise) for piece in self.pieces)
        jump_angles = [
            float(np.mod(start + self.start, TAU))
            for start, now, before in zip(self._table[0], ends, [ends[-1], *ends[:-1]], strict=True)
            if abs(now[0] - before[1]) > NO_JUMP_OF_CAM * most
        ]
        return tuple(sorted(jump_angles))

    def __call__(self, angle: Real) -> tuple[Real, Real, Real]:
        """Return the displacement of the follower and its first two derivatives with respect to the cam angle."""
        if self.sense < 0:
            value, first, second = self._mirrored(-angle)
            return value, -first, second
        turn = 2 * pi(angle)
        turned, ahead = np.mod(angle - self.start, turn), np.mod(angle - self.start + AT_EDGE_OF_CAM, turn)
        turned = np.where(ahead < turned, 0.0, turned)  # a full turn within rounding
        starts, overs, lows, rises = self._table
        passed = np.searchsorted(starts, ahead, side="right") if starts.ndim == 1 else np.sum(starts <= ahead, axis=0)
        number = np.clip(passed - 1, 0, len(self.pieces) - 1)
        over, rise, start, low = (_select_pieces(column, number) for column in (overs, rises, starts, lows))
        x = np.clip((turned - start) / over, 0.0, 1.0)
        value, first, second = (np.zeros(np.shape(turned)) for _ in range(3))
        shapes = [p.shape for p in self.pieces]
        for shape in dict.fromkeys(shapes):
            of_shape = np.array([name == shape for name in shapes])[number]
            s, ds, dds = RISE_LAWS[shape](x)
            value, first, second = (
                np.where(of_shape, s, value),
                np.where(of_shape, ds, first),
                np.where(of_shape, dds, second),
            )
        return low + rise * value, rise / over * first, rise / over**2 * second


def _select_pieces(column: Real, number: Real) -> Real:
    """Return a value of the pieces with these numbers, one for each cam angle.

    column: this value for all pieces, shape (pieces,) or (pieces, variants).
    """
    return column[number] if column.ndim == 1 else np.take_along_axis(column, number[None], axis=0)[0]
