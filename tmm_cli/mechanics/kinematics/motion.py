"""Velocities and accelerations of points, links and prismatic pairs, from link states and the speed of the driver."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from tmm_cli.mechanics.groups import DriverStates, GroupSolver, LawOfMotion, LinkStates, link_states
from tmm_cli.mechanics.linkage import Linkage, Slide
from tmm_cli.mechanics.numerics import (
    AT_REST,
    LIMIT_AGREES,
    LIMIT_ROUNDED,
    Real,
    Record,
    Vector,
    dot,
    map_record,
    to_float,
    unit,
)

FIELDS_WITHOUT_POSITIONS = frozenset(
    {"linkage", "kernels", "group", "pair", "driver", "finer", "where", "order", "bare"}
)
"""Names of fields of a motion, and of records derived from it, that are not arrays over positions."""


@dataclass(frozen=True)
class PointMotion:
    """Motion of a point.

    Attributes:
        x: position (m).
        v: velocity (m/s).
        a: acceleration (m/s2).
        first, second: first and second derivatives of the position with respect to the driver coordinate.
    """

    x: Vector
    v: Vector
    a: Vector
    first: Vector
    second: Vector


@dataclass(frozen=True)
class LinkMotion:
    """Rotation of a link.

    Attributes:
        angle: angle (rad, in -pi..pi).
        omega: angular velocity (rad/s).
        epsilon: angular acceleration (rad/s2).
        first, second: first and second derivatives of the angle with respect to the driver coordinate.
    """

    angle: Real
    omega: Real
    epsilon: Real
    first: Real
    second: Real


@dataclass(frozen=True)
class SlidingMotion:
    """Relative motion in a prismatic pair: of the sliding point along the guide.

    Attributes:
        run: displacement along the guide (m).
        v: relative velocity (m/s).
        a: relative acceleration (m/s2).
        coriolis: Coriolis acceleration, a vector (m/s2).
        u: unit vector along the guide.
        first, second: first and second derivatives of the displacement with respect to the driver coordinate.
    """

    run: Real
    v: Real
    a: Real
    coriolis: Vector
    u: Vector
    first: Real
    second: Real


@dataclass(frozen=True, kw_only=True)
class Motion(LinkStates):
    """States of the links in time; values are nan where the driver never arrives.

    Attributes:
        time: time (s) at which the driver reaches each position.
        rate: velocity of the driver (rad/s or m/s).
        acceleration: acceleration of the driver (rad/s2 or m/s2).
        finer: motion in extended precision, at the positions of the mask `where`; or None.
        where: mask of positions that are also computed in extended precision, or None.
        limits: mask of change points in which velocities and accelerations are limit values (see fill_in_limits), or
            None.
        bare: the same motion without these limit values, or None.
    """

    time: Real
    rate: Real
    acceleration: Real
    finer: Motion | None = None
    where: Real | None = None
    limits: Real | None = None
    bare: Motion | None = None

    def point(self, link: str, local: complex) -> PointMotion:
        """Return the motion of a point of a link; local: its position in the axes of the link (m)."""
        if local is self.linkage.links[link].centre:  # point of action of weight and inertia force
            return self.centre(link)
        return self._finest(lambda motion: motion._point(link, local))

    @cached_property
    def _known(self) -> dict[tuple[str, ...], Any]:
        """Cache of motions by name. Tables, result.json, forces and energy request the same ones."""
        return {}

    def _once(self, kind: str, name: str, compute: Callable[[], Record]) -> Record:
        if (kind, name) not in self._known:
            self._known[kind, name] = compute()
        motion: Record = self._known[kind, name]
        return motion

    @cached_property
    def largest(self) -> LargestRates:
        """Largest velocities and accelerations in the mechanism at every position."""
        return LargestRates.of(self)

    def _finest(self, evaluate: Callable[[Motion], Record]) -> Record:
        """Evaluate a function of the motion, in extended precision where this is available."""
        values = evaluate(self)
        return (
            values
            if self.finer is None or self.where is None
            else splice_positions(values, evaluate(self.finer), self.where)
        )

    def _point(self, link: str, local: complex) -> PointMotion:
        pose, first, second = self.poses[link], self.first[link], self.second[link]
        arm = local * pose.z
        v1, a1 = first.at(arm), second.at(arm, first.w)
        return PointMotion(pose.x + arm, v1 * self.rate, a1 * self.rate**2 + v1 * self.acceleration, v1, a1)

    def named(self, point: str) -> PointMotion:
        """Return the motion of a named point.

        If several links have the point, it is computed from the link with the smallest motion, which loses the fewest
        digits.
        """
        owners = [link for link in self.linkage.carriers(point) if link in self.poses]
        return self._once(
            "point", point, lambda: self.named_on(min(owners, key=lambda link: self._sway(link, point)), point)
        )

    def _sway(self, link: str, point: str) -> float:
        """Return the largest magnitude of the terms that add up to the acceleration of a point of a link."""
        first, second, arm = self.first[link], self.second[link], abs(self.linkage.local(link, point))
        terms = np.abs(to_float(second.a)) + (np.abs(to_float(second.e)) + to_float(first.w) ** 2) * to_float(arm)
        return float(np.max(np.where(np.isfinite(terms), terms, 0.0), initial=0.0))

    def named_on(self, link: str, point: str) -> PointMotion:
        """Return the motion of a named point, computed as a point of this link."""
        return self._finest(lambda motion: motion._point(link, motion.linkage.local(link, point)))

    def centre(self, link: str) -> PointMotion:
        """Return the motion of the centre of mass of a link."""
        return self._once(
            "centre",
            link,
            lambda: self._finest(lambda motion: motion._point(link, motion.linkage.links[link].centre)),
        )

    def link(self, name: str) -> LinkMotion:
        """Return the angle, angular velocity and angular acceleration of a link."""

        def turning() -> LinkMotion:
            w1, e1 = self.first[name].w, self.second[name].e
            return LinkMotion(self.angle(name), w1 * self.rate, e1 * self.rate**2 + w1 * self.acceleration, w1, e1)

        return self._once("link", name, turning)

    def slide(self, slide: Slide) -> SlidingMotion:
        """Return the relative motion in a prismatic pair."""
        return self._once(
            "slide", slide.name, lambda: self._finest(lambda motion: motion._slide(motion.linkage.slide(slide.name)))
        )

    def _slide(self, slide: Slide) -> SlidingMotion:
        carrier, runner = self.poses[slide.carrier], self.poses[slide.runner]
        u = carrier.z * unit(slide.direction)
        point = self._point(slide.runner, slide.at)
        w = self.first[slide.carrier].w
        arm = runner.at(slide.at) - carrier.x
        run, first = super().run(slide), super().slope(slide)
        # along the guide the Coriolis part vanishes, so the rest of the difference is the relative acceleration
        second = dot(u, point.second - self.second[slide.carrier].at(arm, w))
        v = first * self.rate
        coriolis = 2j * (w * self.rate) * v * u
        return SlidingMotion(run, v, second * self.rate**2 + first * self.acceleration, coriolis, u, first, second)

    def run(self, slide: Slide) -> Real:
        """Return the displacement in a prismatic pair (m)."""
        return self._finest(lambda motion: LinkStates.run(motion, motion.linkage.slide(slide.name)))

    def slope(self, slide: Slide) -> Real:
        """Return the derivative of the displacement in a prismatic pair with respect to the driver coordinate."""
        return self._finest(lambda motion: LinkStates.slope(motion, motion.linkage.slide(slide.name)))


def compute_motion(
    linkage: Linkage,
    kernels: Iterable[GroupSolver],
    q: Real,
    law: LawOfMotion,
    order: int = 2,
    *,
    blank: bool = True,
    drives: DriverStates | None = None,
) -> Motion:
    """Compute the motion of all links at the coordinates q of the first driver (rad or m).

    Args:
        linkage: the linkage.
        kernels: solvers of its groups, as in link_states.
        q: driver coordinates, shape (positions,).
        law: law of motion of the driver; if `drives` have another parameter than q, the law of this parameter.
        order, blank, drives: as in link_states.
    """
    states = link_states(linkage, kernels, q, order, blank=blank, drives=drives)
    rate = law.speed(states.q)
    whole = vars(states) | {"moving": states.moving & np.isfinite(rate)}
    return Motion(**whole, time=law.time(states.q), rate=rate, acceleration=law.accelerated(states.q))


@dataclass(frozen=True)
class LargestRates:
    """Largest velocities and accelerations in a mechanism at every position, with which a link at rest is recognised.

    A link that never moves would seem to move if it were compared with its own largest value, because of rounding.

    Attributes:
        size: size of the mechanism (m).
        speed: largest speed of a point (m per unit of the driver coordinate), or angular speed times size.
        acceleration: largest acceleration likewise (m per unit of the driver coordinate squared).
    """

    size: Real | float
    speed: Real
    acceleration: Real

    @classmethod
    def of(cls, states: LinkStates) -> LargestRates:
        """Find the largest velocities and accelerations of all links.

        Accelerations are estimated from velocities if they were not computed.
        """
        linkage = states.linkage
        size: Any = reduce(np.maximum, [kernel.size for kernel in states.kernels], 0.0)
        size = np.where(size > 0, size, 1.0)  # all links have a single point and only slide
        speeds, gains = [], []
        for link, rate in states.first.items():
            arm = next(iter(linkage.links[link].points.values()), 0j) * states.poses[link].z
            speeds += [np.abs(rate.at(arm)), np.abs(rate.w) * size]
            if states.order > 1:
                accel = states.second[link]
                gains += [np.abs(accel.at(arm, rate.w)), np.abs(accel.e) * size]
        speed = reduce(np.maximum, speeds)
        return cls(size, speed, reduce(np.maximum, gains, speed * speed / size))


def zero_at_rest(rates: Real | Vector, largest: Real) -> Real | Vector:
    """Replace rates that are negligible by zero; largest: largest rate of the same kind in the mechanism."""
    return np.where(np.abs(rates) > AT_REST * largest, rates, 0.0)


def splice_positions(full: Record, finer_record: Record, where: Real) -> Record:
    """Replace some positions of all arrays of a record by those of a record computed in higher precision.

    Args:
        full: the record with all positions.
        finer_record: the record in higher precision; it has only the positions of the mask.
        where: the mask, shape (positions,).
    """

    def joined(path: str, leaf: Any, finer: Any) -> Any:
        if not isinstance(leaf, np.ndarray) or not hasattr(finer, "astype") or leaf.shape[-1:] != where.shape:
            return leaf
        spliced = leaf.copy()
        spliced[..., where] = finer.astype(leaf.dtype)
        return spliced

    return map_record(joined, full, finer_record, skip=FIELDS_WITHOUT_POSITIONS)


# Limits of velocities and accelerations in dead positions that the mechanism passes smoothly.
#
# In a change point of a parallelogram two branches of its motion cross. The equations for velocities are singular
# there, but along each branch the motion is an analytic function of the driver coordinate, so its value, velocity and
# acceleration in the change point follow by interpolation from positions on either side. L. N. Trefethen,
# Approximation Theory and Approximation Practice (2013), ch. 5. Reactions in general grow without bound.


NODES = 16  # about a change point; an even number, so that none coincides with it
RADII = (0.1, 0.05)  # rad, or for a slider sizes of the largest group: distance of the outer nodes
STATE_FIELDS = ("poses", "first", "second")
COMPARED_FIELDS = (
    "x",
    "z",
    "unwrapped",
    "v",
    "w",
    "a",
    "e",
)  # fields of poses, rates and accelerations that are compared
CHEBYSHEV_NODES: Real = np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
WEIGHTS: Real = chebyshev.chebvander(np.zeros(1), NODES - 1)[0] @ np.linalg.inv(
    chebyshev.chebvander(CHEBYSHEV_NODES, NODES - 1)
)
"""Weights of the values at the nodes for the interpolated value in the middle."""


def fill_in_limits(motion: Motion) -> Motion:
    """Fill in limit values of positions, velocities and accelerations in change points that are passed smoothly.

    `moving` stays False in these positions, because forces in general have no limit there. In the result `limits` is
    the mask of these positions, and `bare` the motion without the limit values.
    """
    if motion.order < 2 or not motion.dead:
        return motion
    dead = np.any(list(motion.dead.values()), axis=0) & ~motion.moving & np.isfinite(motion.rate)
    if not np.any(dead):
        return motion
    dead_positions = np.flatnonzero(dead)
    limits, smooth = _interpolate_limits(motion, np.asarray(motion.q, dtype=float)[dead_positions])
    if not np.any(smooth):
        return motion
    filled = dead_positions[smooth]

    def put(_path: str, values: Any, limit: Any) -> Any:
        if not isinstance(values, np.ndarray):
            return values
        replaced, limit_values = values.copy(), limit[smooth]
        agrees = np.abs(values[..., filled] - limit_values) <= LIMIT_ROUNDED * np.maximum(np.abs(limit_values), 1.0)
        replaced[..., filled] = np.where(agrees, values[..., filled], limit_values)  # a known value is kept
        return replaced

    parts = {name: map_record(put, getattr(motion, name), getattr(limits, name)) for name in STATE_FIELDS}
    mask = np.zeros(np.shape(motion.q), dtype=bool)
    mask[filled] = True
    return replace(motion, **parts, limits=mask, bare=motion)


def _interpolate_limits(motion: Motion, q: Real) -> tuple[LinkStates, Real]:
    """Interpolate the states at driver coordinates q from positions on either side.

    Returns:
        The states, and True where the mechanism passes the position smoothly.
    """
    size = float(np.max([np.max(kernel.size) for kernel in motion.kernels], initial=0.0)) or 1.0
    unit = 1.0 if motion.linkage.driver.kind == "turn" else size
    smooth = np.ones(len(q), dtype=bool)
    interpolated = []
    for radius in RADII:
        nodes = q[:, None] + radius * unit * CHEBYSHEV_NODES
        states = link_states(motion.linkage, motion.kernels, nodes.ravel(), 2)
        smooth &= np.all(states.moving.reshape(nodes.shape), axis=1)

        def middle(_path: str, values: Any, shape: tuple[int, ...] = nodes.shape) -> Any:
            if not isinstance(values, np.ndarray):
                return values
            return np.broadcast_to(values, shape[0] * shape[1]).reshape(shape) @ WEIGHTS

        with np.errstate(invalid="ignore"):
            states = replace(states, **{name: map_record(middle, getattr(states, name)) for name in STATE_FIELDS})
        interpolated.append(states)
    far, near = interpolated
    return far, smooth & _limits_agree(far, near, size)


def _limits_agree(states: LinkStates, other_states: LinkStates, size: float) -> Real:
    """Return True where two states of all links agree; size: size of the mechanism (m)."""
    gaps: dict[str, Any] = dict.fromkeys(COMPARED_FIELDS, 0.0)
    largest: dict[str, Any] = dict.fromkeys(COMPARED_FIELDS, 0.0)

    def compare(path: str, values: Any, beside: Any) -> Any:
        if isinstance(values, np.ndarray):
            kind = path.rpartition(".")[2]
            gaps[kind] = np.maximum(gaps[kind], np.abs(values - beside))
            largest[kind] = np.maximum(largest[kind], np.abs(values))
        return values

    for name in STATE_FIELDS:
        map_record(compare, getattr(states, name), getattr(other_states, name))
    speed = np.maximum(largest["v"], largest["w"] * size)
    gain = np.maximum(np.maximum(largest["a"], largest["e"] * size), speed**2 / size)
    scales = {
        "x": np.maximum(largest["x"], size),
        "z": 1.0,
        "unwrapped": np.maximum(largest["unwrapped"], 1.0),
        "v": speed,
        "w": speed / size,
        "a": gain,
        "e": gain / size,
    }
    with np.errstate(invalid="ignore"):
        agree: Real = np.all(
            [np.broadcast_to(gaps[k] <= LIMIT_AGREES * scales[k], np.shape(speed)) for k in COMPARED_FIELDS], axis=0
        )
    return agree
