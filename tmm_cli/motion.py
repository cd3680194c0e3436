"""Stage: places, velocities and accelerations of all links, by walking the groups forward.

Everything is found per unit of the driver's motion first (transfer functions) and then scaled with its speed.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

import numpy as np

from tmm_cli.groups.base import Accel, Dyad, Placement, Pose, Rate
from tmm_cli.linkage import FRAME, Driver, Linkage, Slide
from tmm_cli.vectors import Real, Vector, dot, unit


@dataclass(frozen=True)
class Point:
    """Motion of a point: x (m), v (m/s), a (m/s2); first and second are its transfer functions."""

    x: Vector
    v: Vector
    a: Vector
    first: Vector
    second: Vector


@dataclass(frozen=True)
class Turning:
    """Motion of a link: angle (rad, in -pi..pi), omega (rad/s), epsilon (rad/s2) and its transfer functions."""

    angle: Real
    omega: Real
    epsilon: Real
    first: Real
    second: Real


@dataclass(frozen=True)
class Sliding:
    """Motion in a sliding pair: run (m) along the guide u, v (m/s), a (m/s2), Coriolis acceleration (vector, m/s2)."""

    run: Real
    v: Real
    a: Real
    coriolis: Vector
    u: Vector
    first: Real
    second: Real


@dataclass(frozen=True)
class Law:
    """How the driver moves: from `start` at t = 0 with a rate and an acceleration, both in its sense."""

    start: float
    rate: float
    acceleration: float
    sense: int

    def time(self, q: Real) -> Real:
        """t (s) at which the driver comes to q; nan where it stops before."""
        way = self.sense * (q - self.start)
        with np.errstate(invalid="ignore", divide="ignore"):
            root = np.sqrt(self.rate * self.rate + 2 * self.acceleration * way)
            return np.where(way == 0, 0.0, 2 * way / (self.rate + root))

    def speed(self, q: Real) -> Real:
        """dq/dt at q, with its sign; nan where the driver stops before."""
        if self.acceleration == 0:
            return np.full(np.shape(q), float(self.sense * self.rate))
        with np.errstate(invalid="ignore"):
            way = self.sense * (q - self.start)
            return self.sense * np.sqrt(self.rate * self.rate + 2 * self.acceleration * way)


@dataclass(frozen=True)
class Motion:
    """Kinematics at the places q of the driver. Arrays are (positions,); nan where `placed` or `moving` is False.

    margins: for each group its distance from a dead position, 1 at best. gaps: what it lacks to assemble (> 0), m.
    """

    linkage: Linkage
    dyads: tuple[Dyad, ...]
    q: Real
    time: Real
    rate: Real
    acceleration: Real
    poses: Mapping[str, Pose]
    first: Mapping[str, Rate]
    second: Mapping[str, Accel]
    placements: tuple[Placement, ...]
    placed: Real
    moving: Real
    dead: Mapping[str, Real] = field(default_factory=dict)
    missing: Mapping[str, Real] = field(default_factory=dict)

    def point(self, link: str, local: complex) -> Point:
        """Motion of a point given in the axes of a link (m)."""
        pose, first, second = self.poses[link], self.first[link], self.second[link]
        arm = local * pose.z
        v1, a1 = first.at(arm), second.at(arm, first.w)
        return Point(pose.x + arm, v1 * self.rate, a1 * self.rate**2 + v1 * self.acceleration, v1, a1)

    def named(self, point: str) -> Point:
        """Motion of a named point."""
        link = self.linkage.owner(point)
        return self.point(link, self.linkage.local(link, point))

    def centre(self, link: str) -> Point:
        """Motion of a centre of mass."""
        return self.point(link, self.linkage.links[link].centre)

    def link(self, name: str) -> Turning:
        """Turning of a link."""
        w1, e1 = self.first[name].w, self.second[name].e
        driver = self.linkage.driver
        own = self.q if name == driver.link and driver.kind == "turn" else None
        angle = np.angle(self.poses[name].z) if own is None else own
        return Turning(angle, w1 * self.rate, e1 * self.rate**2 + w1 * self.acceleration, w1, e1)

    def slide(self, slide: Slide) -> Sliding:
        """Relative motion in a sliding pair: of the runner's point along the carrier's guide."""
        carrier, runner = self.poses[slide.carrier], self.poses[slide.runner]
        u = carrier.z * unit(slide.direction)
        here = runner.at(slide.at)
        run = dot(u, here - carrier.at(slide.through))
        point = self.point(slide.runner, slide.at)
        w = self.first[slide.carrier].w
        arm = here - carrier.x
        first = dot(u, point.first - self.first[slide.carrier].at(arm))
        # along the guide the Coriolis part vanishes, so the rest of the difference is the relative acceleration
        second = dot(u, point.second - self.second[slide.carrier].at(arm, w))
        v = first * self.rate
        coriolis = 2j * (w * self.rate) * v * u
        return Sliding(run, v, second * self.rate**2 + first * self.acceleration, coriolis, u, first, second)


def frame_state(q: Real) -> tuple[Pose, Rate, Accel]:
    """The frame's pose and its rest, one value a position."""
    zero, one = np.zeros(np.shape(q), dtype=complex), np.ones(np.shape(q), dtype=complex)
    return Pose(zero, one), Rate(zero, zero.real), Accel(zero, zero.real)


def driven_state(linkage: Linkage, driver: Driver, q: Real) -> tuple[Pose, Rate, Accel]:
    """Pose of the driving link at q, and its transfer functions."""
    zero = np.zeros(np.shape(q))
    if driver.kind == "turn":
        pivot, here = linkage.local(FRAME, driver.joint), linkage.local(driver.link, driver.joint)
        z = unit(q)
        arm = -here * z
        return Pose(pivot + arm, z), Rate(1j * arm, zero + 1), Accel(-arm, zero)
    slide = next(s for s in linkage.slides if s.name == driver.joint)
    if slide.runner == driver.link:
        z = unit(np.full(np.shape(q), slide.turned))
        u = unit(slide.direction)
        origin = slide.through + q * u - slide.at * z
    else:
        z = unit(np.full(np.shape(q), -slide.turned))
        u = -unit(slide.direction) * z
        origin = slide.at + q * u - slide.through * z
    return Pose(origin, z), Rate(zero + u, zero), Accel(zero + 0j, zero)


def move(linkage: Linkage, dyads: Iterable[Dyad], q: Real, law: Law) -> Motion:
    """Kinematics at the driver's places q (rad or m), each found alone.

    A position that a group cannot reach, or where it is dead, is marked for that group and all that hang on it.
    """
    dyads = tuple(dyads)
    q = np.atleast_1d(np.asarray(q))
    driver = linkage.driver
    poses, first, second = {}, {}, {}
    poses[FRAME], first[FRAME], second[FRAME] = frame_state(q)
    poses[driver.link], first[driver.link], second[driver.link] = driven_state(linkage, driver, q)
    placed = np.ones(np.shape(q), dtype=bool)
    moving = placed.copy()
    placements, dead, missing = [], {}, {}
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        for dyad in dyads:
            at = dyad.place(poses)
            sound = at.assembled & np.isfinite(at.a.x + at.b.x + at.a.z + at.b.z)
            missing[dyad.group.title] = placed & ~sound
            dead[dyad.group.title] = placed & sound & at.dead
            placed = placed & sound
            moving = moving & placed & ~at.dead
            lost, det = ~placed, np.where(at.dead, np.nan, at.det)
            at = Placement(_without(at.a, lost), _without(at.b, lost), det, at.margin, at.gap, at.slack)
            a, b = dyad.group.links
            poses[a], poses[b] = at.a, at.b
            first[a], first[b] = dyad.rates(at, poses, first)
            second[a], second[b] = dyad.accelerations(at, poses, first, second)
            placements.append(at)
    rate = law.speed(q)
    moving = moving & np.isfinite(rate)
    acceleration = np.full(np.shape(q), float(law.sense * law.acceleration))
    return Motion(
        linkage, dyads, q, law.time(q), rate, acceleration, poses, first, second,
        tuple(placements), placed, moving, dead, missing,
    )  # fmt: skip


def _without(pose: Pose, lost: Real) -> Pose:
    """A pose that is nothing where it is lost."""
    return Pose(np.where(lost, np.nan, pose.x), np.where(lost, np.nan, pose.z))
