"""Positions of all links, group by group, and their derivatives with respect to the driver coordinate.

Every position is solved independently. First and second derivatives are the transfer functions (kinematic
coefficients); kinematics/motion.py converts them to velocities and accelerations with the speed of the driver.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Protocol

import numpy as np

from tmm_cli.mechanics.groups.group_solver import GroupSolver
from tmm_cli.mechanics.groups.state import Accel, DriverState, DriverStates, Placement, Pose, Rate
from tmm_cli.mechanics.linkage import FRAME, Driver, Linkage, Slide
from tmm_cli.mechanics.numerics import Real, Vector, dot, unit


@dataclass(frozen=True)
class DriverMotion:
    """Motion of a driver with constant acceleration.

    Attributes:
        start: driver coordinate at t = 0 (rad or m).
        rate: speed at t = 0, in the sense of motion (rad/s or m/s).
        acceleration: acceleration, in the sense of motion (rad/s2 or m/s2).
        sense: sense of motion, +1 or -1.
    """

    start: float
    rate: float
    acceleration: float
    sense: int

    def time(self, q: Real) -> Real:
        """Return the time (s) at which the driver reaches q; nan if it stops before that."""
        gone = self.sense * (q - self.start)
        with np.errstate(invalid="ignore", divide="ignore"):
            root = np.sqrt(self.rate * self.rate + 2 * self.acceleration * gone)
            return np.where(gone == 0, 0.0, 2 * gone / (self.rate + root))

    def accelerated(self, q: Real) -> Real:
        """Return the acceleration d2q/dt2 at driver coordinates q, with its sign."""
        return np.zeros(np.shape(q)) + self.sense * self.acceleration

    def speed(self, q: Real) -> Real:
        """Return the velocity dq/dt at driver coordinates q, with its sign; nan if the driver stops before that."""
        if self.acceleration == 0:
            return np.zeros(np.shape(q)) + self.sense * self.rate
        with np.errstate(invalid="ignore"):
            gone = self.sense * (q - self.start)
            return self.sense * np.sqrt(self.rate * self.rate + 2 * self.acceleration * gone)


class LawOfMotion(Protocol):
    """Velocity, acceleration (both with sign) and time of a driver as functions of its coordinate."""

    def speed(self, q: Real) -> Real: ...
    def accelerated(self, q: Real) -> Real: ...
    def time(self, q: Real) -> Real: ...


@dataclass(frozen=True)
class LinkStates:
    """States of the links at the coordinates q of the first driver.

    Arrays have shape (positions,); values are nan where a link is not assembled or its group is in a dead position.

    Attributes:
        linkage: the linkage.
        kernels: solvers of its groups, in solving order.
        q: coordinates of the first driver (rad or m).
        poses: pose of each link, by name.
        first, second: first and second derivatives of the poses with respect to q, by name of the link.
        placements: placement of each group.
        placed: True where all groups are assembled.
        moving: True where all groups are assembled and none is in a dead position.
        dead: for each group, by its title, the mask of the positions in which it is the first group in a dead position.
        missing: for each group, by its title, the mask of the positions in which it is the first that cannot be
            assembled.
        drives: coordinates of all drivers, by name of the driven link.
        order: 0 positions only, 1 with first derivatives, 2 also with second ones. Access to missing ones raises
            NotComputed.
    """

    linkage: Linkage
    kernels: tuple[GroupSolver, ...]
    q: Real
    poses: Mapping[str, Pose]
    first: Mapping[str, Rate]
    second: Mapping[str, Accel]
    placements: tuple[Placement, ...]
    placed: Real
    moving: Real
    dead: Mapping[str, Real] = field(default_factory=dict)
    missing: Mapping[str, Real] = field(default_factory=dict)
    drives: Mapping[str, DriverState] = field(default_factory=dict)
    order: int = 2

    def spot(self, point: str) -> Vector:
        """Return the position of a named point (m)."""
        link = self.linkage.owner(point)
        return self.poses[link].at(self.linkage.local(link, point))

    def angle(self, name: str) -> Real:
        """Return the angle of a link (rad): for a driven crank the driver coordinate, for other links a value in
        -pi..pi.
        """
        is_driven = any(d.link == name and d.kind == "turn" for d in self.linkage.cranks)
        return self.drives[name].value if is_driven else np.angle(self.poses[name].z)

    def run(self, slide: Slide) -> Real:
        """Return the displacement in a prismatic pair (m)."""
        carrier, runner = self.poses[slide.carrier], self.poses[slide.runner]
        run: Real = dot(carrier.z * unit(slide.direction), runner.at(slide.at) - carrier.at(slide.through))
        return run

    def slope(self, slide: Slide) -> Real:
        """Return the derivative of the displacement in a prismatic pair with respect to the driver coordinate q."""
        return self.sliding_rate(slide, self.first)

    def sliding_rate(self, slide: Slide, rates: Mapping[str, Rate]) -> Real:
        """Return the first derivative of the displacement in a prismatic pair.

        rates: first derivatives of the poses of the links, with respect to time or any other parameter.
        """
        carrier, runner = self.poses[slide.carrier], self.poses[slide.runner]
        arm = runner.at(slide.at) - carrier.x
        relative = rates[slide.runner].at(slide.at * runner.z) - rates[slide.carrier].at(arm)
        rate: Real = dot(carrier.z * unit(slide.direction), relative)
        return rate


class NotComputed(LookupError):  # noqa: N818  the name is the message
    """Velocities or accelerations were requested, but the motion was computed without them."""


class MissingRates(dict[str, Any]):
    """Placeholder for velocities or accelerations that were not computed. Access to any link raises NotComputed."""

    def __init__(self, quantity: str) -> None:
        super().__init__()
        self.what = quantity

    def __missing__(self, link: str) -> Any:
        raise NotComputed(f"{self.what} were not computed")


def solvers_towards(kernels: Iterable[GroupSolver], links: Iterable[str]) -> tuple[GroupSolver, ...]:
    """Select the solvers of these links and of all links on which they depend, in solving order.

    Args:
        kernels: solvers of all groups, in solving order.
        links: names of the links.
    """
    required, kept = set(links), []
    for kernel in reversed(tuple(kernels)):
        group = kernel.group
        if not required.isdisjoint(group.links):
            pairs = (*group.outer, *group.inner)
            required.update(link for pair in pairs for link in (pair.i, pair.j))
            required.update(pair.mesh.carrier for pair in pairs if pair.mesh is not None)
            required.update(link for driver in group.drivers for link in (driver.link, driver.base))
            kept.append(kernel)
    return tuple(reversed(kept))


def frame_state(q: Real) -> tuple[Pose, Rate, Accel]:
    """Return the pose of the frame and its zero velocity and acceleration, with the shape of q."""
    zero, one = np.zeros(np.shape(q), dtype=complex), np.ones(np.shape(q), dtype=complex)
    return Pose(zero, one, zero.real), Rate(zero, zero.real), Accel(zero, zero.real)


def driven_state(linkage: Linkage, driver: Driver, drive: DriverState) -> tuple[Pose, Rate, Accel]:
    """Return the pose of a link driven from the frame, with its first and second derivatives with respect to q."""
    q = drive.value
    zero = np.zeros(np.shape(q))
    if driver.kind == "turn":
        pivot, hinge = linkage.local(FRAME, driver.joint), linkage.local(driver.link, driver.joint)
        z = unit(q)
        arm = -hinge * z
        pose, v, bend, w = Pose(pivot + arm, z, q), 1j * arm, -arm, zero + 1
    else:
        slide = linkage.slide(driver.joint)
        if slide.runner == driver.link:
            z = unit(zero + slide.turned)
            u = unit(slide.direction)
            origin = slide.through + q * u - slide.at * z
        else:
            z = unit(zero - slide.turned)
            u = -unit(slide.direction) * z
            origin = slide.at + q * u - slide.through * z
        pose, v, bend, w = Pose(origin, z), zero + u, zero + 0j, zero
    first, second = drive.first, drive.second
    return pose, Rate(v * first, w * first), Accel(bend * first**2 + v * second, w * second)


def drives_at(linkage: Linkage, q: Real) -> dict[str, DriverState]:
    """Return the coordinates of all drivers when the first driver is at q, by name of the driven link.

    Each driver moves at its own speed. All drivers are in the position of the sketch at the same time.
    """
    zero = np.zeros(np.shape(q))
    states = {linkage.driver.link: DriverState(q, zero + 1, zero)}
    if linkage.others:
        lead = linkage.driver
        law = DriverMotion(linkage.sketch.at, lead.rate, lead.acceleration, lead.sense)
        time, speed = law.time(q), law.speed(q)
        for driver in linkage.others:
            value = driver.at + driver.sense * time * (driver.rate + driver.acceleration * time / 2)
            first = driver.sense * (driver.rate + driver.acceleration * time) / speed
            second = (driver.sense * driver.acceleration - first * lead.sense * lead.acceleration) / speed**2
            states[driver.link] = DriverState(value, first, second)
    return states


def drives_in_time(drives: DriverStates, speed: Real, acceleration: Real) -> dict[str, DriverState]:
    """Convert the derivatives of the driver coordinates from those by the first coordinate to those by time.

    Args:
        drives: coordinates of all drivers, with derivatives with respect to the coordinate of the first one.
        speed, acceleration: velocity and acceleration of the first driver, with sign (rad/s or m/s; rad/s2 or m/s2).
    """
    return {
        link: DriverState(d.value, d.first * speed, d.second * speed * speed + d.first * acceleration)
        for link, d in drives.items()
    }


def link_states(
    linkage: Linkage,
    kernels: Iterable[GroupSolver],
    q: Real,
    order: int = 2,
    *,
    blank: bool = True,
    drives: DriverStates | None = None,
) -> LinkStates:
    """Compute the states of all links at the coordinates q of the first driver, each position independently.

    A position in which a group is dead or cannot be assembled is marked for this group and for all groups that depend
    on it.

    Args:
        linkage: the linkage.
        kernels: solvers of the groups. They must include all groups on which these groups depend (see solvers_towards).
        q: driver coordinates (rad or m).
        order: 0 positions only, 1 with velocities, 2 also with accelerations.
        blank: True to replace values in marked positions by nan; otherwise they are what the formulas give.
        drives: coordinates of the drivers, if the parameter is not the coordinate of the first driver.
    """
    kernels = tuple(kernels)
    q = np.atleast_1d(q)
    poses: dict[str, Pose] = {}
    first: dict[str, Rate] = {} if order > 0 else MissingRates("velocities")
    second: dict[str, Accel] = {} if order > 1 else MissingRates("accelerations")

    def put(link: str, pose: Pose, rate: Rate, accel: Accel) -> None:
        poses[link] = pose
        if order > 0:
            first[link] = rate
        if order > 1:
            second[link] = accel

    put(FRAME, *frame_state(q))
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        drives = drives_at(linkage, q) if drives is None else drives
        for driver in linkage.cranks:
            put(driver.link, *driven_state(linkage, driver, drives[driver.link]))
    placed = np.ones(np.shape(q), dtype=bool)
    moving = placed.copy()
    placements, dead, missing = [], {}, {}
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        for kernel in kernels:
            at = kernel.place(poses, q, drives)
            sound = at.assembled & np.isfinite(sum(pose.x + pose.z for pose in at.poses))
            # with the sliding block exactly at the pivot, the direction of a link is arbitrary: dead, without a pose
            missing[kernel.group.title] = placed & ~sound & ~at.dead
            dead[kernel.group.title] = placed & at.dead
            placed = placed & sound
            moving = moving & placed & ~at.dead
            if blank:
                det = np.where(at.dead, np.nan, at.det)
                at = replace(at, poses=tuple(_blank_pose(pose, ~placed) for pose in at.poses), det=det)
            links = kernel.group.links
            poses.update(zip(links, at.poses, strict=True))
            if order > 0:
                first.update(zip(links, kernel.rates(at, poses, first, drives), strict=True))
            if order > 1:
                second.update(zip(links, kernel.accelerations(at, poses, first, second, drives), strict=True))
            placements.append(at)
    return LinkStates(
        linkage, kernels, q, poses, first, second, tuple(placements), placed, moving, dead, missing, drives, order
    )


def _blank_pose(pose: Pose, lost: Real) -> Pose:
    """Set the pose of a link to nan where `lost` is True."""
    unwrapped = None if pose.unwrapped is None else np.where(lost, np.nan, pose.unwrapped)
    return Pose(np.where(lost, np.nan, pose.x), np.where(lost, np.nan, pose.z), unwrapped)
