"""Velocities and accelerations of points, links and prismatic pairs, from link states and the speed of the driver."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, reduce
from typing import Any, TypeVar

import numpy as np

from tmm_cli.mechanics.groups import (
    Accel,
    DriverMotion,
    GroupSolver,
    LawOfMotion,
    LinkStates,
    Rate,
    drives_at,
    drives_in_time,
    link_states,
)
from tmm_cli.mechanics.kinematics.jerk import ThirdDerivative, third_derivatives
from tmm_cli.mechanics.linkage import Linkage, Slide
from tmm_cli.mechanics.numerics import (
    AT_REST,
    Real,
    Record,
    Vector,
    dot,
    map_record,
    to_float,
    unit,
    with_slope,
)

Value = TypeVar("Value")

FIELDS_WITHOUT_POSITIONS = frozenset(
    {"linkage", "kernels", "group", "pair", "driver", "finer", "where", "order", "bare", "law"}
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


@dataclass(frozen=True)
class TimeDerivatives:
    """Velocities (m/s, rad/s) and accelerations (m/s2, rad/s2) of the links, by name of the link."""

    rates: Mapping[str, Rate]
    accels: Mapping[str, Accel]


@dataclass(frozen=True)
class ForwardMotion:
    """Derivatives of the poses of the links, and the direction in which the mechanism moves.

    The derivatives (`rates`, `accels`) are taken with respect to time or to the driver coordinate, so only directions
    and signs should be read from them. `largest` are the largest derivatives in the mechanism. `sense` is the factor
    (+1 or -1) by which `rates` must be multiplied to have the direction of the motion.
    """

    rates: Mapping[str, Rate]
    accels: Mapping[str, Accel]
    largest: LargestRates
    sense: Real | float


@dataclass(frozen=True, kw_only=True)
class Motion(LinkStates):
    """States of the links in time; values are nan where the driver never arrives.

    However the motion was solved, `first` and `second` are derivatives with respect to the coordinate of the first
    driver, and `rate` and `acceleration` are the time derivatives of this coordinate. If the motion was solved with
    time as the parameter, the former are computed when they are read.

    Attributes:
        time: time (s) at which the driver reaches each position.
        rate: velocity of the driver (rad/s or m/s).
        acceleration: acceleration of the driver (rad/s2 or m/s2).
        law: law of motion of the driver, which gives these three.
        in_time: derivatives of the poses with respect to time, if the groups were solved with time as the parameter; or
            None.
        finer: motion in extended precision, at the positions of the mask `where`; or None.
        where: mask of positions that are also computed in extended precision, or None.
        limits: mask of change points in which velocities and accelerations are limit values (see fill_in_limits), or
            None.
        bare: the same motion without these limit values, or None.
    """

    time: Real
    rate: Real
    acceleration: Real
    law: LawOfMotion
    in_time: TimeDerivatives | None = None
    finer: Motion | None = None
    where: Real | None = None
    limits: Real | None = None
    bare: Motion | None = None

    def point(self, link: str, local: complex) -> PointMotion:
        """Return the motion of a point of a link; local: its position in the axes of the link (m)."""
        if local is self.linkage.links[link].centre:  # point of action of weight and inertia force
            return self.centre(link)
        return self._evaluate_finest(lambda motion: motion._point(link, local))

    @cached_property
    def _known(self) -> dict[tuple[str, ...], Any]:
        """Cache of the motions of points and links, by name; several stages request the same ones."""
        return {}

    def _compute_once(self, kind: str, name: str, compute: Callable[[], Record]) -> Record:
        if (kind, name) not in self._known:
            self._known[kind, name] = compute()
        motion: Record = self._known[kind, name]
        return motion

    @cached_property
    def largest(self) -> LargestRates:
        """Largest velocities and accelerations at every position, per unit of the driver coordinate."""
        return LargestRates.of(self)

    @property
    def _solved(self) -> tuple[Mapping[str, Rate], Mapping[str, Accel]]:
        """First and second derivatives of the poses with respect to the parameter used in solving the groups."""
        return (self.first, self.second) if self.in_time is None else (self.in_time.rates, self.in_time.accels)

    def forward(self) -> ForwardMotion:
        """Return first and second derivatives of the links in the direction in which the mechanism moves.

        They are derivatives with respect to time, or to the driver coordinate counted in the direction of its motion,
        whichever the groups were solved with. For a driver at rest that direction is the one given in the problem file.
        """
        rates, accels = self._solved
        if self.in_time is not None:
            return ForwardMotion(rates, accels, LargestRates.of(self, rates, accels), 1.0)
        sense = np.where(self.rate == 0, self.linkage.driver.sense, np.sign(self.rate))
        return ForwardMotion(rates, accels, self.largest, sense)

    def _both_ways(self, first: Any, second: Any) -> tuple[Any, Any, Any, Any]:
        """Return the velocity, the acceleration, and the first and second transfer function of a quantity.

        first, second: its derivatives with respect to time or the driver coordinate, whichever the groups were solved
        with.
        """
        if self.in_time is None:
            return first * self.rate, second * self.rate**2 + first * self.acceleration, first, second
        with np.errstate(invalid="ignore", divide="ignore"):  # of a driver at rest they are unknown
            ratio = first / self.rate
            return first, second, ratio, (second - ratio * self.acceleration) / self.rate**2

    def _evaluate_finest(self, evaluate: Callable[[Motion], Record]) -> Record:
        """Evaluate a function of the motion, in extended precision at positions where this is available."""
        values = evaluate(self)
        return (
            values
            if self.finer is None or self.where is None
            else splice_positions(values, evaluate(self.finer), self.where)
        )

    def _point(self, link: str, local: complex) -> PointMotion:
        rates, accels = self._solved
        pose, rate = self.poses[link], rates[link]
        arm = local * pose.z
        return PointMotion(pose.x + arm, *self._both_ways(rate.at(arm), accels[link].at(arm, rate.w)))

    def named(self, point: str) -> PointMotion:
        """Return the motion of a named point.

        If several links have the point, it is computed from the link with the smallest motion, which loses the fewest
        digits.
        """
        owners = [link for link in self.linkage.carriers(point) if link in self.poses]
        return self._compute_once(
            "point", point, lambda: self.named_on(min(owners, key=lambda link: self._largest_term(link, point)), point)
        )

    def _largest_term(self, link: str, point: str) -> float:
        """Return the largest magnitude of the terms that add up to the acceleration of a point of a link.

        It is infinite in a trace, which has no numbers to compare.
        """
        rates, accels = self._solved
        rate, accel, arm = rates[link], accels[link], abs(self.linkage.local(link, point))
        terms = np.abs(to_float(accel.a)) + (np.abs(to_float(accel.e)) + to_float(rate.w) ** 2) * to_float(arm)
        if not isinstance(terms, np.ndarray | float):
            return np.inf
        return float(np.max(np.where(np.isfinite(terms), terms, 0.0), initial=0.0))

    def named_on(self, link: str, point: str) -> PointMotion:
        """Return the motion of a named point, computed as a point of this link."""
        return self._evaluate_finest(lambda motion: motion._point(link, motion.linkage.local(link, point)))

    def centre(self, link: str) -> PointMotion:
        return self._compute_once(
            "centre",
            link,
            lambda: self._evaluate_finest(lambda motion: motion._point(link, motion.linkage.links[link].centre)),
        )

    def link(self, name: str) -> LinkMotion:
        """Return the angle, angular velocity and angular acceleration of a link."""

        def turning() -> LinkMotion:
            rates, accels = self._solved
            return LinkMotion(self.angle(name), *self._both_ways(rates[name].w, accels[name].e))

        return self._compute_once("link", name, turning)

    def slide(self, slide: Slide) -> SlidingMotion:
        """Return the relative motion in a prismatic pair."""
        return self._compute_once(
            "slide",
            slide.name,
            lambda: self._evaluate_finest(lambda motion: motion._slide(motion.linkage.slide(slide.name))),
        )

    def _slide(self, slide: Slide) -> SlidingMotion:
        carrier, runner = self.poses[slide.carrier], self.poses[slide.runner]
        u = carrier.z * unit(slide.direction)
        rates, accels = self._solved
        w = rates[slide.carrier].w
        arm, on_runner = runner.at(slide.at) - carrier.x, slide.at * runner.z
        first = super().sliding_rate(slide, rates)
        # along the guide the Coriolis part vanishes, so the rest of the difference is the relative acceleration
        runner_accel = accels[slide.runner].at(on_runner, rates[slide.runner].w)
        second = dot(u, runner_accel - accels[slide.carrier].at(arm, w))
        v, a, first, second = self._both_ways(first, second)
        coriolis = 2j * (w if self.in_time else w * self.rate) * v * u
        return SlidingMotion(super().run(slide), v, a, coriolis, u, first, second)

    def jerk(self, point: str) -> Vector:
        """Return the jerk of a named point (m/s3), the time derivative of its acceleration.

        It is nan for a law of motion whose third derivative is unknown (a motor, a table of speeds).
        """
        owners = [link for link in self.linkage.carriers(point) if link in self.poses]
        link = min(owners, key=lambda name: self._largest_term(name, point))
        return self._jerk_at(link, lambda motion: motion.linkage.local(link, point))

    def jerk_of_centre(self, link: str) -> Vector:
        return self._jerk_at(link, lambda motion: motion.linkage.links[link].centre)

    def _jerk_at(self, link: str, local: Callable[[Motion], Any]) -> Vector:
        def evaluate(motion: Motion) -> Vector:
            rates, accels = motion._solved
            arm = local(motion) * motion.poses[link].z
            rate, accel = rates[link], accels[link]
            parts = rate.at(arm), accel.at(arm, rate.w), motion.third[link].at(arm, rate, accel)
            jerk: Vector = motion._third_in_time(*parts)
            return jerk

        return self._evaluate_finest(evaluate)

    def angular_jerk(self, link: str) -> Real:
        """Return the time derivative of the angular acceleration of a link (rad/s3)."""

        def evaluate(motion: Motion) -> Real:
            rates, accels = motion._solved
            jerk: Real = motion._third_in_time(rates[link].w, accels[link].e, motion.third[link].i)
            return jerk

        return self._evaluate_finest(evaluate)

    def _third_in_time(self, first: Any, second: Any, third: Any) -> Any:
        """Convert derivatives of a quantity to its third time derivative; nan if the law of motion does not give it.

        first, second, third: derivatives with respect to the parameter with which the groups were solved.
        """
        if not isinstance(self.law, DriverMotion):
            return third * np.nan
        if self.in_time is not None:
            return third
        rate, acceleration = self.rate, self.acceleration
        return rate * (third * rate * rate + 3 * second * acceleration)

    @cached_property
    def third(self) -> Mapping[str, ThirdDerivative]:
        """Third derivatives of the poses, with respect to the parameter used in solving the groups.

        The driver must have a constant acceleration.
        """
        rates, accels = self._solved
        q = with_slope(self.q, 1.0 + 0 * self.q if self.in_time is None else self.rate)
        drives = drives_at(self.linkage, q)
        if self.in_time is not None:
            drives = drives_in_time(drives, self.law.speed(q), self.law.accelerated(q))
        return third_derivatives(self, rates, accels, drives)

    def run(self, slide: Slide) -> Real:
        """Return the displacement in a prismatic pair (m)."""
        return self._evaluate_finest(lambda motion: LinkStates.run(motion, motion.linkage.slide(slide.name)))

    def slope(self, slide: Slide) -> Real:
        """Return the derivative of the displacement in a prismatic pair with respect to the driver coordinate."""
        return self._evaluate_finest(lambda motion: LinkStates.slope(motion, motion.linkage.slide(slide.name)))


def compute_motion(
    linkage: Linkage,
    kernels: Iterable[GroupSolver],
    q: Real,
    law: LawOfMotion,
    order: int = 2,
    *,
    blank: bool = True,
    in_time: bool = False,
) -> Motion:
    """Compute the motion of all links at the coordinates q of the first driver (rad or m).

    Args:
        linkage: the linkage.
        kernels: solvers of its groups, as in link_states.
        q: coordinates of the first driver, shape (positions,).
        law: law of motion of the driver.
        order, blank: as in link_states.
        in_time: True to solve the groups with time as the parameter. This saves operations if only velocities and
            accelerations are read; the result has the same meaning.
    """
    q = np.atleast_1d(q)
    rate, acceleration, time = law.speed(q), law.accelerated(q), law.time(q)
    if not in_time:
        states = link_states(linkage, kernels, q, order, blank=blank)
        whole = vars(states) | {"moving": states.moving & np.isfinite(rate)}
        return Motion(**whole, time=time, rate=rate, acceleration=acceleration, law=law)
    drives = drives_at(linkage, q)
    states = link_states(linkage, kernels, q, order, blank=blank, drives=drives_in_time(drives, rate, acceleration))
    first, second = _transfer_functions(states, rate, acceleration)
    whole = vars(states) | {
        "moving": states.moving & np.isfinite(rate),
        "drives": drives,
        "first": first,
        "second": second,
    }
    timed = TimeDerivatives(states.first, states.second)
    return Motion(**whole, time=time, rate=rate, acceleration=acceleration, law=law, in_time=timed)


def _transfer_functions(
    states: LinkStates, rate: Real, acceleration: Real
) -> tuple[Mapping[str, Rate], Mapping[str, Accel]]:
    """Convert derivatives with respect to time to derivatives with respect to the driver coordinate."""

    def first(link: str) -> Rate:
        by_time = states.first[link]
        with np.errstate(invalid="ignore", divide="ignore"):
            return Rate(by_time.v / rate, by_time.w / rate)

    def second(link: str) -> Accel:
        by_time, slope = states.second[link], firsts[link]
        with np.errstate(invalid="ignore", divide="ignore"):
            square = rate**2
            return Accel((by_time.a - slope.v * acceleration) / square, (by_time.e - slope.w * acceleration) / square)

    firsts = _OnAccess(states.first, first)
    return firsts, _OnAccess(states.second, second)


class _OnAccess(Mapping[str, Value]):
    """A mapping that computes each value when it is first read."""

    def __init__(self, names: Mapping[str, Any], compute: Callable[[str], Value]) -> None:
        self._names, self._compute = names, compute
        self._computed: dict[str, Value] = {}

    def __getitem__(self, name: str) -> Value:
        if name not in self._computed:
            self._computed[name] = self._compute(name)
        return self._computed[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)


@dataclass(frozen=True)
class LargestRates:
    """Largest velocities and accelerations in a mechanism at every position. They serve to recognise links at rest.

    Because of rounding, a link that never moves would seem to move if it were compared with its own largest velocity.

    Attributes:
        size: size of the mechanism (m).
        speed: largest speed of a point, or angular speed times `size` (m per unit of the driver coordinate).
        acceleration: the same for accelerations (m per unit of the driver coordinate squared).
    """

    size: Real | float
    speed: Real
    acceleration: Real

    @classmethod
    def of(
        cls,
        states: LinkStates,
        rates: Mapping[str, Rate] | None = None,
        accels: Mapping[str, Accel] | None = None,
    ) -> LargestRates:
        """Find the largest velocities and accelerations of all links.

        Accelerations are estimated from velocities if they were not computed. `rates` and `accels` replace the
        derivatives with respect to the driver coordinate by those with respect to another parameter.
        """
        linkage = states.linkage
        rates, accels = (states.first, states.second) if rates is None or accels is None else (rates, accels)
        size: Any = reduce(np.maximum, [kernel.size for kernel in states.kernels], 0.0)
        size = np.where(size > 0, size, 1.0)  # all links have a single point and only slide
        speeds, gains = [], []
        for link, rate in rates.items():
            arm = next(iter(linkage.links[link].points.values()), 0j) * states.poses[link].z
            speeds += [np.abs(rate.at(arm)), np.abs(rate.w) * size]
            if states.order > 1:
                accel = accels[link]
                gains += [np.abs(accel.at(arm, rate.w)), np.abs(accel.e) * size]
        speed = reduce(np.maximum, speeds)
        return cls(size, speed, reduce(np.maximum, gains, speed * speed / size))


def zero_at_rest(rates: Real | Vector, largest: Real) -> Real | Vector:
    """Replace velocities or accelerations by zero if they are negligible compared with the largest in the mechanism."""
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
