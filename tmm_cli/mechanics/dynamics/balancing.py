"""Balancing of mechanisms and of shafts with masses in several planes.

I. I. Artobolevsky, Theory of Mechanisms and Machines (1988), ch. 13.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.mechanics.errors import CounterweightError, NoCycleError
from tmm_cli.mechanics.groups import DriverMotion
from tmm_cli.mechanics.kinematics import Motion, compute_motion
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import AT_REST, Real, Vector, cross

if TYPE_CHECKING:
    from tmm_cli.mechanics.analysis import Mechanism


@dataclass(frozen=True)
class CounterweightPlace:
    """Position of a counterweight: on a link, at `radius` from a point of it (its axes, m); 0 if the radius is
    not given.
    """

    link: str
    about: complex
    radius: float = 0.0


@dataclass(frozen=True)
class CorrectionPlane:
    """Plane across a shaft at the axial position `at` (m), with a mass at a radius (m; 0 if it is not given)."""

    at: float
    radius: float = 0.0


@dataclass(frozen=True)
class UnbalancedShaft:
    """Shaft with unbalanced masses.

    sizes: mass times radius as complex numbers (kg m). at: axial positions (m). planes: planes of one or two
    correction masses.
    """

    sizes: Vector
    at: Real
    planes: tuple[CorrectionPlane, ...]

    def corrections(self) -> Vector:
        """Return mass times radius of the corrections (kg m, complex).

        One plane removes the resultant force; two planes remove the resultant couple as well.
        """
        force, (first, *more) = -np.sum(self.sizes), self.planes
        if not more:
            return np.array([force])
        second = -np.sum(self.sizes * (self.at - first.at)) / (more[0].at - first.at)
        return np.array([force - second, second])

    def unbalance(self, added: Vector | None = None) -> tuple[complex, complex]:
        """Return the sum of mass times radius (kg m) and of its moments about the first plane (kg m2).

        Times the square of the angular velocity they are the force and the couple on the bearings. added:
        corrections.
        """
        sizes, at = self.sizes, self.at
        if added is not None:
            sizes, at = np.append(sizes, added), np.append(at, [plane.at for plane in self.planes])
        return complex(np.sum(sizes)), complex(np.sum(sizes * (at - self.planes[0].at)))


@dataclass(frozen=True)
class BalancingTask:
    """Counterweights to be found, and a shaft to be balanced.

    share: weight of the force component along the direction `along`; the other component has the weight 1 -
    share. For a crank-slider it is the fraction of the reciprocating masses that a counterweight on the crank
    balances.
    """

    counterweights: tuple[CounterweightPlace, ...] = ()
    share: float = 0.5
    along: complex = 1 + 0j
    rotor: UnbalancedShaft | None = None


# Balancing: shaking loads on the frame over a cycle, and the counterweights that reduce them.
#
# The shaking force is F = -sum m a of all links. It vanishes when the common centre of mass stands still. A
# counterweight on a link adds c z to sum m r, where c = mr exp(i angle) is given in the axes of the link and z is their
# direction, so counterweights follow from linear equations for any linkage. R. S. Berkof, G. G. Lowen, A new method
# for completely force balancing simple linkages, J. Eng. Ind. 91 (1969).


NO_EFFECT = 1e-9  # of the largest singular value: counterweights with nearly the same effect are dependent
ROUNDS = 200  # largest number of iterations for masses that load moving pivots
NO_ANGLE = 1e-12  # of a counterweight: a smaller component across the x axis of its link is rounding
SETTLED = 1e-15  # of the largest counterweight: convergence


@dataclass(frozen=True)
class ShakingLoads:
    """Inertia load of the links on the frame at every position: shaking force (N), shaking moment about `about`
    (N m).
    """

    force: Vector
    moment: Real
    about: complex


@dataclass(frozen=True)
class CounterweightSolution:
    """Counterweight at its place: mass times radius (kg m) at an angle from the x axis of the link (rad)."""

    place: CounterweightPlace
    size: float
    angle: float

    @property
    def mass(self) -> float | None:
        """Mass in kg; None if the radius is not given."""
        return self.size / self.place.radius if self.place.radius else None


@dataclass(frozen=True)
class BalancedCycle:
    """Counterweights, and the shaking loads before and after balancing over a whole cycle.

    alike: some counterweights have the same effect as others, so their sizes are not unique.
    """

    counterweights: tuple[CounterweightSolution, ...]
    before: ShakingLoads
    after: ShakingLoads
    alike: bool = False

    @property
    def shakes(self) -> bool:
        """True if there is a shaking force without counterweights."""
        return bool(np.any(np.nan_to_num(self.before.force) != 0))

    @property
    def left(self) -> float:
        """Largest shaking force after balancing, relative to that before."""
        most = float(np.nanmax(np.abs(self.before.force)))
        return float(np.nanmax(np.abs(self.after.force))) / most if most > 0 else 0.0


def compute_shaking(motion: Motion, about: complex = 0j, weights: Sequence[CounterweightSolution] = ()) -> ShakingLoads:
    """Compute the shaking force and moment of all links with mass and of counterweights.

    A counterweight without a radius counts by its mass times radius alone: neither the mass on its pivot nor
    its own moment of inertia is included.

    Args:
        motion: solved motion.
        about: point of the frame for moments (m).
        weights: counterweights to include.
    """
    force, moment = np.zeros(np.shape(motion.q), complex), np.zeros(np.shape(motion.q))
    for name in motion.linkage.moving:
        link = motion.linkage.links[name]
        centre, turning = motion.centre(name), motion.link(name)
        force = force - link.mass * centre.a
        moment = moment - link.mass * cross(centre.x - about, centre.a) - link.inertia * turning.epsilon
    for weight in weights:
        c, place = weight.size * np.exp(1j * weight.angle), weight.place
        pivot, added, mass = (
            motion.point(place.link, place.about),
            c * _direction_acceleration(motion, place.link),
            weight.mass or 0.0,
        )
        force = force - added - mass * pivot.a
        moment = (
            moment - cross(pivot.x - about, added + mass * pivot.a) - cross(c * motion.poses[place.link].z, pivot.a)
        )
        moment = moment - weight.size * place.radius * motion.link(place.link).epsilon
    return ShakingLoads(force, moment, about)


def balance_cycle(motion: Motion, task: BalancingTask, about: complex = 0j) -> BalancedCycle:
    """Find the counterweights that leave the least shaking force.

    The shaking force is F = -sum m a of all links, and a counterweight on a link adds c z to sum m r, with c
    = mr exp(i angle) in its axes and z their direction, so counterweights follow from linear least squares. A
    given radius gives a mass, which loads the pivot; if the pivot moves, the counterweights are found again
    with that mass until they no longer change.

    Args:
        motion: a whole cycle at equal steps, without the repeated end; dead positions are skipped.
        task: counterweights to be found.
        about: point of the frame for moments (m).

    Raises:
        UnsettledError: the counterweights do not converge.
    """
    before = compute_shaking(motion, about)
    if not task.counterweights:
        return BalancedCycle((), before, before)
    counterweights = task.counterweights
    # force of a counterweight: -c times the second derivative of the link's direction
    columns = np.stack([-_direction_acceleration(motion, place.link) for place in counterweights], axis=1)
    fastest = float(np.max(np.square(motion.rate))) if motion.linkage.driver.kind == "turn" else 0.0
    columns[:, np.nanmax(np.abs(columns), axis=0) <= AT_REST * fastest] = 0.0  # a link that translates balances nothing
    pivots = np.stack([-motion.point(place.link, place.about).a for place in counterweights], axis=1)
    per_mass = np.array([1 / place.radius if place.radius else 0.0 for place in counterweights])
    products, live = (
        np.zeros(len(counterweights), complex),
        motion.moving & np.isfinite(np.column_stack([columns, pivots, before.force])).all(axis=1),
    )
    for _ in range(ROUNDS):
        last = products
        products, rank = _least_squares(columns[live], (before.force + pivots @ (per_mass * np.abs(last)))[live], task)
        if np.max(np.abs(products - last)) <= SETTLED * np.max(np.abs(products)):
            break
    else:
        raise CounterweightError
    weights = tuple(
        CounterweightSolution(place, float(abs(c)), _direction(complex(c)))
        for place, c in zip(counterweights, products, strict=True)
    )
    return BalancedCycle(weights, before, compute_shaking(motion, about, weights), rank < 2 * len(counterweights))


def _least_squares(columns: Vector, force: Vector, task: BalancingTask) -> tuple[Vector, int]:
    """Counterweights (kg m, complex) that leave the least force, and the rank: the number of independent
    components.
    """
    rotated, rest = columns * task.along.conjugate(), -force * task.along.conjugate()
    share, other = np.sqrt(task.share), np.sqrt(1 - task.share)
    matrix = np.block([[share * rotated.real, -share * rotated.imag], [other * rotated.imag, other * rotated.real]])
    parts, _, rank, _ = np.linalg.lstsq(matrix, np.concatenate([share * rest.real, other * rest.imag]), rcond=NO_EFFECT)
    half = len(parts) // 2
    return parts[:half] + 1j * parts[half:], int(rank)


def _direction(c: complex) -> float:
    """Angle of a counterweight, rad; for a direction straight back pi, not -pi."""
    return float(np.angle(c if abs(c.imag) > NO_ANGLE * abs(c) else complex(c.real)))


def _direction_acceleration(motion: Motion, link: str) -> Vector:
    """Second time derivative of the direction of a link's x axis, 1/s2."""
    rotation, z = motion.link(link), motion.poses[link].z
    acceleration: Vector = (1j * rotation.epsilon - rotation.omega**2) * z
    return acceleration


# Balancing of a mechanism: shaking over its cycle and at its positions, at the constant speed of the driver.


STEPS_PER_TURN = 720  # positions per revolution


@dataclass(frozen=True)
class BalancingResults:
    """Results of a balancing task over the whole cycle (driver coordinates q) and at the positions of the
    problem.

    pivot: point for moments. corrections: mass times radius of the corrections of a shaft, kg m.
    """

    task: BalancingTask
    q: Real
    cycle: BalancedCycle
    before: ShakingLoads
    after: ShakingLoads
    pivot: str
    corrections: Vector = field(default_factory=lambda: np.empty(0, complex))

    def at(self, mechanism: Mechanism, q: Real) -> tuple[ShakingLoads, ShakingLoads]:
        """Return the shaking loads at other driver coordinates, without and with counterweights."""
        return _shaking_at(mechanism, self.cycle, q)


def balance_machine(mechanism: Mechanism, start: float, positions: Real, task: BalancingTask) -> BalancingResults:
    """Balance a mechanism over the cycle that begins at the driver coordinate `start`.

    Args:
        mechanism: the mechanism; its driver runs at constant speed.
        start: driver coordinate of position 0 (rad).
        positions: driver coordinates of the positions (rad).
        task: balancing task.

    Raises:
        NoCycleError: the driver is not a fully rotating crank, or not the only one.
        UnsettledError: the counterweights do not converge.
    """
    linkage, whole = mechanism.linkage, mechanism.driver_range
    driver = linkage.driver
    if driver.kind != "turn" or not whole.full or linkage.others:
        raise NoCycleError(("balancing",))

    count = STEPS_PER_TURN * whole.turns
    q = start + driver.sense * 2 * np.pi * whole.turns * np.arange(count) / count
    pivot = _crank_pivot(linkage)
    about = complex(linkage.local(FRAME, pivot)) if pivot else 0j
    cycle = balance_cycle(constant_speed_motion(mechanism, q), task, about)
    corrections = np.empty(0, complex) if task.rotor is None else task.rotor.corrections()
    return BalancingResults(task, q, cycle, *_shaking_at(mechanism, cycle, positions), pivot, corrections)


def _shaking_at(mechanism: Mechanism, balanced: BalancedCycle, q: Real) -> tuple[ShakingLoads, ShakingLoads]:
    """Shaking loads at driver coordinates, without and with counterweights."""
    motion, about = constant_speed_motion(mechanism, q), balanced.before.about
    return compute_shaking(motion, about), compute_shaking(motion, about, balanced.counterweights)


def constant_speed_motion(mechanism: Mechanism, q: Real) -> Motion:
    """Return the motion at constant speed of the driver."""
    driver = mechanism.linkage.driver
    law = DriverMotion(float(q[0]), driver.rate, 0.0, driver.sense)
    return compute_motion(mechanism.linkage, mechanism.kernels, q, law)


def _crank_pivot(linkage: Linkage) -> str:
    """Name of the crank's pivot on the frame; empty if it has no such point."""
    link = linkage.driver.link
    return next((h.point for h in linkage.hinges if {FRAME, link} <= set(h.links)), "")
