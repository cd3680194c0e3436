"""Newton's method on the closure of a whole linkage, started from the nearest of places that were followed once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tmm_cli.bench.methods.case import Case
from tmm_cli.groups.linear import solve
from tmm_cli.groups.state import Pose
from tmm_cli.kinematics.motion import move
from tmm_cli.vectors import Real

ROUNDS = 12  # of Newton's method at most; more help nothing where it converges at all
NODES = 36  # in a turn of the driver, or over the length of the linkage to both sides of the sketch
ROUNDING = 1e-11  # a gap below this that no longer halves is rounding


class Closure(Protocol):
    """The equations of a linkage in coordinates X (positions, unknowns) of its own choice, without dimension."""

    def residuals(self, X: Real, q: Real) -> Real:
        """What each equation is short of zero, (positions, unknowns)."""

    def matrix(self, X: Real, q: Real) -> Real:
        """Their derivatives by the coordinates, (positions, unknowns, unknowns)."""

    def sketched(self, poses: dict[str, Pose], q: Real) -> Real:
        """The coordinates of given poses."""


def close(closure: Closure, X: Real, q: Real, tolerance: float) -> Real:
    """Newton's method, each position until its gaps are within the tolerance, or are rounding; else it is nan."""
    active, last = np.ones(len(q), dtype=bool), np.full(len(q), np.inf)
    for _ in range(ROUNDS):
        residuals = closure.residuals(X, q)
        size = np.max(np.abs(residuals), axis=-1)
        active = active & ~(size <= tolerance) & ~((size < ROUNDING) & (size > last / 2))
        if not np.any(active):
            break
        step = solve(closure.matrix(X, q), -residuals)
        X, last = np.where(active[:, None], X + step, X), size
    if np.any(active):
        size = np.max(np.abs(closure.residuals(X, q)), axis=-1)
        X = np.where((active & ~(size <= max(tolerance, ROUNDING)))[:, None], np.nan, X)
    return X


@dataclass(frozen=True)
class Nodes:
    """Coordinates of a closure along the driver's way, at growing places q."""

    q: Real
    X: Real
    cycle: float | None

    def near(self, q: Real) -> Real:
        """Those of the nearest node."""
        within = q if self.cycle is None else self.q[0] + np.mod(q - self.q[0], self.cycle)
        right = np.clip(np.searchsorted(self.q, within), 1, len(self.q) - 1)
        nearer = np.where(within - self.q[right - 1] < self.q[right] - within, right - 1, right)
        return self.X[nearer]


def follow(case: Case, closure: Closure) -> Nodes:
    """A walk from the sketch to both sides, as far as the linkage goes; half a turn each way for a crank."""
    at = case.linkage.sketch.at
    here = np.array([at])
    poses = dict(move(case.linkage, case.kernels, here, case.law).poses)
    turns = case.linkage.driver.kind == "turn"
    reach = np.pi if turns else case.size
    q, X = [at], [close(closure, closure.sketched(poses, here), here, 0.0)[0]]
    ways = [_walk(closure, X[0], at, sense * reach / (NODES // 2)) for sense in (-1, 1)]
    whole = turns and all(len(way) == NODES // 2 for way in ways)
    q = [*(place for place, _ in reversed(ways[0])), at, *(place for place, _ in ways[1])]
    X = [*(found for _, found in reversed(ways[0])), X[0], *(found for _, found in ways[1])]
    return Nodes(np.array(q), np.array(X), 2 * np.pi if whole else None)


def _walk(closure: Closure, X: Real, at: float, step: float) -> list[tuple[float, Real]]:
    """Places and coordinates one step after the other, until it no longer closes."""
    found: list[tuple[float, Real]] = []
    with np.errstate(all="ignore"):
        for k in range(1, NODES // 2 + 1):
            q = np.array([at + k * step])
            X = close(closure, X[None, :], q, 0.0)[0]
            if not np.max(np.abs(closure.residuals(X[None, :], q))) < ROUNDING:
                break
            found.append((float(q[0]), X))
    return found
