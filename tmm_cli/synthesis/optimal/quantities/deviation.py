"""Deviation of a motion from required values: path of a point, law of motion of a link."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from typing import Any

import numpy as np

from tmm_cli.batch import WANTED
from tmm_cli.language import N_
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.forces import Reactions
from tmm_cli.mechanics.kinematics import Motion, output_coordinate
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import WINDOW_FIT, WINDOW_SIDE, Real, dot, polynomial_value, window_peak
from tmm_cli.synthesis.measures import DriverEnds
from tmm_cli.synthesis.optimal.quantities.base import (
    MechanismQuantity,
    QuantityRange,
    Read,
    Windows,
    highest_over_range,
    motion_at,
)

AWAY = 1e100  # coordinate of a variant that cannot be assembled
FOOT_STEPS = 3  # Newton steps from the nearest corner, at most half a step away
FOOT = 1e-3  # sine of the angle from the normal above which the nearest point is an end or a corner of the path


class Deviation(MechanismQuantity):
    """Root mean square or largest deviation from the required values."""

    largest: str  # description of the largest deviation

    def title(self, linkage: Linkage) -> str:
        return self.largest if self.norm == "largest" else self.text

    @abstractmethod
    def deviations(self, read: Read, over: QuantityRange) -> Real:
        """Return the deviation of the motion from each required value (m or rad), shape (variants, required values)."""

    @abstractmethod
    def measure_deviations(self, results: Results, ends: DriverEnds) -> Real:
        """Return the deviations of an analysed mechanism from the required values (m or rad), shape (required
        values,).
        """

    @abstractmethod
    def residuals(self, read: Read, over: QuantityRange, each: int) -> Real:
        """Return the residuals whose squares are minimised, shape (variants, residuals).

        Args:
            read: function that reads outputs by name.
            over: range of the driver.
            each: number of consecutive variants in a set. The first of a set determines the nearest positions for all
                of them.
        """

    @abstractmethod
    def curve(self, read: Read) -> Any:
        """Return the motion that is compared with the required values, shape (variants, positions).

        The path of a point is returned as x + iy.
        """

    @property
    def spread(self) -> float:
        """Standard deviation of the required values, used as the unit of the residuals."""
        required = np.array(self.wanted)
        return float(np.sqrt(np.mean(np.abs(required - np.mean(required)) ** 2))) or 1.0

    def aggregate(self, off: Real) -> Real:
        """Combine deviations to the root mean square or the largest deviation, shape (variants,)."""
        if self.norm == "largest":
            off = np.max(np.abs(off), axis=1, keepdims=True)
        aggregated: Real = np.sqrt(np.mean(off * off, axis=1))
        return aggregated

    def coarse(self, read: Read, over: QuantityRange) -> Real:
        return self.aggregate(self.deviations(read, over))

    def fine(self, parts: Windows, exact: Read, over: QuantityRange, step: float) -> Real:
        off = self.deviations(exact, over)
        return np.hstack([off, -off]) if self.norm == "largest" else self.aggregate(off)[:, None]

    def smooth(self, pieces: Real) -> Real:
        return pieces if self.norm == "largest" else pieces**2

    def measure_range(self, results: Results, ends: DriverEnds) -> float:
        return float(self.aggregate(self.measure_deviations(results, ends)[None, :])[0])


class LawDeviation(Deviation):
    """Deviation of a link's motion from a required law of motion (m or rad).

    With `relative`, both motions are measured from their first position.
    """

    of, text = "law", N_("root mean square deviation from the required law")
    largest = N_("largest deviation from the required law")
    keys, named, given = ("link", "values", "at", "relative", "norm"), "link", "values"

    def output(self, linkage: Linkage, groups: Any) -> str | None:
        return self.name

    def kind(self, linkage: Linkage, groups: Any) -> str:
        return "length" if self.slides(linkage, groups) else "angle"

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        return {"run": output_coordinate(motion, self.name)}

    def deviations(self, read: Read, over: QuantityRange) -> Real:
        off = read("run") - read(WANTED)
        off = off - off[:, :1] if self.relative else off
        return np.angle(np.exp(1j * off)) if over.swings else off

    def residuals(self, read: Read, over: QuantityRange, each: int) -> Real:
        return self.deviations(read, over)

    def curve(self, read: Read) -> Any:
        return read("run")

    def measure_deviations(self, results: Results, ends: DriverEnds) -> Real:
        run = output_coordinate(motion_at(results, np.array(self.places)), self.name)
        over = QuantityRange(results.linkage, results.linkage.output_swings(self.name))
        deviations: Real = self.deviations({"run": run[None, :], WANTED: np.array([self.wanted])}.__getitem__, over)[0]
        return deviations


class PathDeviation(Deviation):
    """Distance of a point's path from required points (m).

    Without driver coordinates the path may pass the required points at any position of the driver.
    """

    of, text = "path", N_("root mean square distance from the required points")
    largest = N_("largest distance from the required points")
    keys, named, given = ("point", "through", "at", "norm"), "point", "through"

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        place = motion.spot(self.name)
        return {"px": place.real, "py": place.imag}

    def deviations(self, read: Read, over: QuantityRange) -> Real:
        x, y = read("px"), read("py")
        if self.places:
            apart: Real = np.hypot(x - np.real(self.wanted), y - np.imag(self.wanted))
            return apart
        return distances_to_points(x, y, np.array(self.wanted), closed=over.closed)

    def residuals(self, read: Read, over: QuantityRange, each: int) -> Real:
        x, y = read("px"), read("py")
        if self.places:
            return np.hstack([x - np.real(self.wanted), y - np.imag(self.wanted)])
        place = (x + 1j * y).reshape(len(x) // each, each, -1)
        return _measure_across_path(place, np.array(self.wanted), over.closed).reshape(len(x), -1)

    def curve(self, read: Read) -> Any:
        return read("px") + 1j * read("py")

    def windows(self, read: Read, over: QuantityRange) -> list[tuple[Any, int]]:
        place = read("px")[0] + 1j * read("py")[0]
        return [] if self.places else [(w, int(np.argmin(np.abs(place - w)))) for w in self.wanted]

    def fine(self, parts: Windows, exact: Read, over: QuantityRange, step: float) -> Real:
        if self.places:
            return super().fine(parts, exact, over, step)
        squares = [-((read("px") - w.real) ** 2 + (read("py") - w.imag) ** 2) for w, __, read in parts]
        off = np.sqrt(np.maximum(np.stack([-window_peak(square) for square in squares], axis=1), 0))
        return off if self.norm == "largest" else self.aggregate(off)[:, None]

    def measure_deviations(self, results: Results, ends: DriverEnds) -> Real:
        if self.places:
            apart: Real = np.abs(motion_at(results, np.array(self.places)).spot(self.name) - np.array(self.wanted))
            return apart

        def near(point: complex) -> float:
            return highest_over_range(
                lambda q: -(np.abs(motion_at(results, q).spot(self.name) - point) ** 2), results, ends
            )

        return np.sqrt(np.maximum([-near(point) for point in self.wanted], 0.0))


def _measure_across_path(place: Any, points: Real, closed: bool) -> Real:
    """Return the signed distances of required points from the paths of variants, measured perpendicular to a path.

    Each distance is measured where the first variant of the set is nearest to the point. Its sign changes when the path
    passes through the point, so that the distance is a smooth function there.

    Args:
        place: corners of the paths (complex, m), shape (sets, variants, corners).
        points: required points (complex, m).
        closed: True if the paths are closed.

    Returns:
        Distances (m), shape (sets, variants, points).
    """
    sets, __, count = place.shape
    lead = np.where(np.isnan(place[:, 0]), AWAY, place[:, 0])
    near = nearest_corners(lead.real.copy(), lead.imag.copy(), points)
    middle = near if closed else np.clip(near, WINDOW_SIDE, count - 1 - WINDOW_SIDE)
    about = (np.arange(-WINDOW_SIDE, WINDOW_SIDE + 1)[:, None, None] + middle) % count  # (corners, points, sets)
    off = place[np.arange(sets), :, about] - points[:, None, None]  # (corners, points, sets, variants)
    fit = np.moveaxis(np.tensordot(WINDOW_FIT.T, off[..., 0], 1), 0, -1)
    u = (near - middle).astype(float)
    low, high = u - 1, u + 1
    if not closed:
        low, high = np.maximum(low, -middle), np.minimum(high, count - 1 - middle)
    for __ in range(FOOT_STEPS):
        at, along, bend = (polynomial_value(fit, u, order) for order in range(3))
        slope, curve = dot(at, along), dot(along, along) + dot(at, bend)
        u = np.clip(u - np.where(curve > 0, slope / curve, 0.0), low, high)
    at, along = polynomial_value(fit, u), polynomial_value(fit, u, 1)
    end = np.abs(dot(at, along)) > FOOT * np.abs(at) * np.abs(along)
    normal = np.where(end, at / np.abs(at), 1j * along / np.abs(along))
    share = np.tensordot(
        WINDOW_FIT, np.cumprod([np.ones_like(u), *[u] * (2 * WINDOW_SIDE)], axis=0), 1
    )  # weight of each corner
    distances: Real = dot(normal[..., None], np.sum(share[..., None] * off, axis=0))
    return distances.transpose(1, 2, 0)


def distances_to_points(x: Real, y: Real, points: Real, *, closed: bool = True) -> Real:
    """Return the distances of points from polygons (m), shape (variants, points).

    Each is the distance from the nearest corner or from one of the two sides that meet there.

    Args:
        x, y: corners of the polygons (m), shape (variants, corners).
        points: points (complex, m).
        closed: True if the last corner is joined to the first.
    """
    x, y = np.ascontiguousarray(x), np.ascontiguousarray(y)
    near, rows, count = nearest_corners(x, y, points), np.arange(len(x)), x.shape[1]
    wx, wy = np.real(points)[:, None], np.imag(points)[:, None]
    px, py = x[rows, near] - wx, y[rows, near] - wy
    best = px * px + py * py
    after = np.where(near + 1 == count, 0 if closed else near, near + 1)
    for beside in (near - 1 if closed else np.maximum(near - 1, 0), after):
        sx, sy = x[rows, beside] - wx - px, y[rows, beside] - wy - py
        with np.errstate(all="ignore"):
            share = np.minimum(np.maximum(-(px * sx + py * sy) / (sx * sx + sy * sy), 0), 1)
        best = np.fmin(best, (px + share * sx) ** 2 + (py + share * sy) ** 2)
    distances: Real = np.sqrt(best).T
    return distances


def nearest_corners(x: Real, y: Real, points: Real) -> Any:
    """Return the index of the polygon corner that is nearest to each point, shape (points, variants).

    Args:
        x, y: corners of the polygons (m), shape (variants, corners).
        points: points (complex, m).
    """
    square, near = (x * x + y * y) / 2, np.empty((len(points), len(x)), dtype=int)
    work, other = np.empty_like(x), np.empty_like(x)
    for k, w in zip(near, points, strict=True):  # minimises half the squared distance, without the constant w^2
        np.multiply(x, w.real, out=work)
        np.subtract(square, work, out=work)
        np.multiply(y, w.imag, out=other)
        np.subtract(work, other, out=work)
        np.argmin(work, axis=1, out=k)
    return near
