"""Laws of motion of a cam's follower: rise, dwell and return, piece by piece over a turn of the cam.

A piece of rise h over the angle d with x = (a - start)/d from 0 to 1 follows s = h f(x). Sources of f: I. I.
Artobolevsky, Theory of Mechanisms and Machines, ch. 25 (parabolic, cosine, sine); R. L. Norton, Cam Design, ch. 3
(3-4-5 and 4-5-6-7 polynomials).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tmm_cli.tolerances import AT_EDGE_OF_CAM, NO_JUMP_OF_CAM
from tmm_cli.vectors import Real, pi

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
    # 2 sin^2(pi x) is 1 - cos(2 pi x), which rounds to zero before the follower rests
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


SHAPES: dict[str, Rise] = {
    "linear": _linear, "parabolic": _parabolic, "cosine": _cosine, "sine": _sine, "3-4-5": _polynomial5,
    "4-5-6-7": _polynomial7,
}  # fmt: skip


@dataclass(frozen=True)
class Piece:
    """A rise (m or rad, negative for a return, zero for a dwell) over an angle of the cam (rad)."""

    over: float
    rise: float
    shape: str = "sine"


@dataclass(frozen=True)
class CamLaw:
    """Pieces one after another from the cam's angle `start` (rad); together a full turn, and back where they began.

    sense: in which the cam turns. Where pieces meet, the acceleration is that of the piece which then begins.
    """

    pieces: tuple[Piece, ...]
    start: float = 0.0
    sense: int = 1

    @cached_property
    def _mirrored(self) -> CamLaw:
        """The law by the angle that grows clockwise: all laws are symmetric about the middle of their piece."""
        return CamLaw(tuple(replace(p, rise=-p.rise) for p in reversed(self.pieces)), -self.start)

    @cached_property
    def _table(self) -> tuple[Real, Real, Real, Real]:
        """Of each piece: where it starts (rad, from the law's start), its angle, the run there, its rise.

        They are (pieces,), or (pieces, variants) where they vary.
        """
        both = np.broadcast_arrays(*(p.over for p in self.pieces), *(p.rise for p in self.pieces))
        over, rise = np.stack(both[: len(self.pieces)]), np.stack(both[len(self.pieces) :])
        return np.cumsum(over, axis=0) - over, over, np.cumsum(rise, axis=0) - rise, rise

    def jumps(self) -> tuple[float, ...]:
        """Angles of the cam (rad, within a turn) at which one piece ends with another speed than the next begins."""
        slopes = [SHAPES[piece.shape](np.array([0.0, 1.0]))[1] for piece in self.pieces]
        ends = [piece.rise / piece.over * slope for piece, slope in zip(self.pieces, slopes, strict=True)]
        most = max(abs(piece.rise) for piece in self.pieces)
        found = [
            float(np.mod(start + self.start, TAU))
            for start, now, before in zip(self._table[0], ends, [ends[-1], *ends[:-1]], strict=True)
            if abs(now[0] - before[1]) > NO_JUMP_OF_CAM * most
        ]
        return tuple(sorted(found))

    def __call__(self, angle: Real) -> tuple[Real, Real, Real]:
        """The follower's run at the cam's angle, and its first and second derivatives by that angle."""
        if self.sense < 0:
            value, first, second = self._mirrored(-angle)
            return value, -first, second
        turn = 2 * pi(angle)
        turned, ahead = np.mod(angle - self.start, turn), np.mod(angle - self.start + AT_EDGE_OF_CAM, turn)
        turned = np.where(ahead < turned, 0.0, turned)  # a turn is over but for rounding
        starts, overs, lows, rises = self._table
        passed = np.searchsorted(starts, ahead, side="right") if starts.ndim == 1 else np.sum(starts <= ahead, axis=0)
        number = np.clip(passed - 1, 0, len(self.pieces) - 1)
        over, rise, start, low = (_of(part, number) for part in (overs, rises, starts, lows))
        x = np.clip((turned - start) / over, 0.0, 1.0)
        value, first, second = (np.zeros(np.shape(turned)) for _ in range(3))
        shapes = [p.shape for p in self.pieces]
        for shape in dict.fromkeys(shapes):
            here = np.array([name == shape for name in shapes])[number]
            s, ds, dds = SHAPES[shape](x)
            value, first, second = np.where(here, s, value), np.where(here, ds, first), np.where(here, dds, second)
        return low + rise * value, rise / over * first, rise / over**2 * second


def _of(part: Real, number: Real) -> Real:
    """Numbers of the pieces with these numbers."""
    return part[number] if part.ndim == 1 else np.take_along_axis(part, number[None], axis=0)[0]
