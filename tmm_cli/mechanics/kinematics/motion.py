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
    """Motion of a point: position x (m), v (m/s), a (m/s2), and first and second transfer functions."""

    x: Vector
    v: Vector
    a: Vector
    first: Vector
    second: Vector


@dataclass(frozen=True)
class LinkMotion:
    """Rotation of a link: angle (rad, in -pi..pi), omega (rad/s), epsilon (rad/s2), and transfer functions."""

    angle: Real
    omega: Real
    epsilon: Real
    first: Real
    second: Real


@dataclass(frozen=True)
class SlidingMotion:
    """Relative motion in a prismatic pair: run (m) along the guide u, v (m/s), a (m/s2), Coriolis acceleration
    (m/s2).
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
    """States of links in time: time (s), speed (rad/s or m/s) and acceleration of the driver; nan where it never
    arrives.

    Attributes:
        finer: positions of the mask `where` in extended precision.
        limits: mask of change points in which velocities and accelerations are limits (see fill_in_limits).
        bare: the motion without these limits.
    """

    time: Real
    rate: Real
    acceleration: Real
    finer: Motion | None = None
    where: Real | None = None
    limits: Real | None = None
    bare: Motion | None = None

    def point(self, link: str, local: complex) -> PointMotion:
        """Return the motion of a point given in the axes of a link (m)."""
        if local is self.linkage.links[link].centre:  # point of action of weight and inertia force
            return self.centre(link)
        return self._finest(lambda motion: motion._point(link, local))

    @cached_property
    def _known(self) -> dict[tuple[str, ...], Any]:
        """Cache of motions requested by name: tables, result.json, forces and energy request the same ones."""
        return {}

    def _once(self, kind: str, name: str, compute: Callable[[], Record]) -> Record:
        if (kind, name) not in self._known:
            self._known[kind, name] = compute()
        motion: Record = self._known[kind, name]
        return motion

    @cached_property
    def largest(self) -> LargestRates:
        """Largest rates of the links at every position."""
        return LargestRates.of(self)

    def _finest(self, evaluate: Callable[[Motion], Record]) -> Record:
        """Evaluate a function of the motion, taking values from the finer one where available."""
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
        """Return the motion of a named point, from the link with the smallest motion, which loses the fewest digits."""
        owners = [link for link in self.linkage.carriers(point) if link in self.poses]
        return self._once(
            "point", point, lambda: self.named_on(min(owners, key=lambda link: self._sway(link, point)), point)
        )

    def _sway(self, link: str, point: str) -> float:
        """Return the magnitude of the terms that sum to the acceleration of a point."""
        first, second, arm = self.first[link], self.second[link], abs(self.linkage.local(link, point))
        terms = np.abs(to_float(second.a)) + (np.abs(to_float(second.e)) + to_float(first.w) ** 2) * to_float(arm)
        return float(np.max(np.where(np.isfinite(terms), terms, 0.0), initial=0.0))

    def named_on(self, link: str, point: str) -> PointMotion:
        """Return the motion of a named point as a point of the given link."""
        return self._finest(lambda motion: motion._point(link, motion.linkage.local(link, point)))

    def centre(self, link: str) -> PointMotion:
        """Return the motion of the centre of mass of a link."""
        return self._once(
            "centre",
            link,
            lambda: self._finest(lambda motion: motion._point(link, motion.linkage.links[link].centre)),
        )

    def link(self, name: str) -> LinkMotion:
        """Return the rotation of a link."""

        def turning() -> LinkMotion:
            w1, e1 = self.first[name].w, self.second[name].e
            return LinkMotion(self.angle(name), w1 * self.rate, e1 * self.rate**2 + w1 * self.acceleration, w1, e1)

        return self._once("link", name, turning)

    def slide(self, slide: Slide) -> SlidingMotion:
        """Return the relative motion in a prismatic pair: of the sliding point along the guide."""
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
        """Return the run in a prismatic pair, m."""
        return self._finest(lambda motion: LinkStates.run(motion, motion.linkage.slide(slide.name)))

    def slope(self, slide: Slide) -> Real:
        """Return the first transfer function of the run in a prismatic pair."""
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
    """Compute the kinematics at the coordinates q of the first driver (rad or m).

    Args:
        kernels, order, blank, drives: as in link_states.
        law: speed and acceleration of the driver; of the parameter, if `drives` use another one than q.
    """
    states = link_states(linkage, kernels, q, order, blank=blank, drives=drives)
    rate = law.speed(states.q)
    whole = vars(states) | {"moving": states.moving & np.isfinite(rate)}
    return Motion(**whole, time=law.time(states.q), rate=rate, acceleration=law.accelerated(states.q))


@dataclass(frozen=True)
class LargestRates:
    """Largest rates in a mechanism at every position, by comparison with which a link is at rest.

    Compared with its own largest value, a link that never moves would seem to move, because of rounding. size: m; speed
    and acceleration of points, m per unit of the driver coordinate and per its square, including rotation times size.
    """

    size: Real | float
    speed: Real
    acceleration: Real

    @classmethod
    def of(cls, states: LinkStates) -> LargestRates:
        """Return the largest rates of all links; accelerations are estimated from speeds if they were not computed."""
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
    """Return the rates, with zeros at rest; largest: the largest rate of the kind in the mechanism."""
    return np.where(np.abs(rates) > AT_REST * largest, rates, 0.0)


def splice_positions(full: Record, finer_record: Record, where: Real) -> Record:
    """Return a record whose arrays take the positions of the mask `where` from another record, rounded to their
    precision.
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
    """Replace undefined values in change points that are passed smoothly by the limits of positions, velocities,
    accelerations.

    `moving` stays False in these positions, as forces in general have no limit there; `limits` of the result is their
    mask, and `bare` the motion without the limits.
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
    """Return the states in the middle of nodes about q, and which of these positions are passed smoothly."""
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
    """Return where two states of all links agree; size: of the mechanism (m)."""
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
