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
    """Position of a counterweight on a link.

    Attributes:
        link: name of the link.
        about: point at which the counterweight is attached, in the axes of the link, m.
        radius: distance of its centre of mass from that point, m; 0 if not given.
    """

    link: str
    about: complex
    radius: float = 0.0


@dataclass(frozen=True)
class CorrectionPlane:
    """Plane perpendicular to a shaft in which a correction mass is placed.

    Attributes:
        at: axial position of the plane, m.
        radius: radius of the correction mass, m; 0 if not given.
    """

    at: float
    radius: float = 0.0


@dataclass(frozen=True)
class UnbalancedShaft:
    """Shaft with unbalanced masses in several planes perpendicular to it.

    Attributes:
        sizes: unbalances, mass times radius as complex numbers, kg m.
        at: axial positions of the masses, m.
        planes: one or two correction planes.
    """

    sizes: Vector
    at: Real
    planes: tuple[CorrectionPlane, ...]

    def corrections(self) -> Vector:
        """Compute the correction masses, as mass times radius (complex, kg m), one for each plane.

        A mass in one plane removes the resultant force; masses in two planes remove the resultant couple as well.
        """
        force, (first, *further_planes) = -np.sum(self.sizes), self.planes
        if not further_planes:
            return np.array([force])
        second = -np.sum(self.sizes * (self.at - first.at)) / (further_planes[0].at - first.at)
        return np.array([force - second, second])

    def unbalance(self, added: Vector | None = None) -> tuple[complex, complex]:
        """Return the resultant unbalance (kg m) and its moment about the first correction plane (kg m2), both complex.

        Multiplied by the square of the angular velocity, they are the force and the couple on the bearings.

        added: unbalances of correction masses to be included, kg m.
        """
        sizes, at = self.sizes, self.at
        if added is not None:
            sizes, at = np.append(sizes, added), np.append(at, [plane.at for plane in self.planes])
        return complex(np.sum(sizes)), complex(np.sum(sizes * (at - self.planes[0].at)))


@dataclass(frozen=True)
class BalancingTask:
    """Counterweights whose size is to be found, and a shaft to be balanced.

    Attributes:
        counterweights: positions of the counterweights.
        share: weight (0 to 1) given to the component of the shaking force along `along`; the other component
            has the weight 1 - share. For a crank-slider it is the fraction of the reciprocating masses that a
            counterweight on the crank balances.
        along: direction of the first component, a unit complex number.
        rotor: the shaft, or None.
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
NO_ANGLE = 1e-12  # relative to a counterweight: a smaller component perpendicular to the x axis of its link is rounding
SETTLED = 1e-15  # of the largest counterweight: convergence


@dataclass(frozen=True)
class ShakingLoads:
    """Resultant at every position of the inertia forces and couples of all links, which the mechanism exerts on the
    frame.

    Attributes:
        force: shaking force, N.
        moment: shaking moment about `about`, N m.
        about: point of the frame, m.
    """

    force: Vector
    moment: Real
    about: complex


@dataclass(frozen=True)
class CounterweightSolution:
    """Counterweight whose size and direction were computed for a given place on a link.

    Attributes:
        place: link, point of attachment and radius.
        size: mass times radius, kg m.
        angle: angle from the x axis of the link, rad.
    """

    place: CounterweightPlace
    size: float
    angle: float

    @property
    def mass(self) -> float | None:
        """Mass of the counterweight, kg; None if its radius is not given."""
        return self.size / self.place.radius if self.place.radius else None


@dataclass(frozen=True)
class BalancedCycle:
    """Counterweights, and the shaking loads over a whole cycle before and after balancing.

    alike: True if some counterweights have the same effect, so that their sizes are not unique.
    """

    counterweights: tuple[CounterweightSolution, ...]
    before: ShakingLoads
    after: ShakingLoads
    alike: bool = False

    @property
    def shakes(self) -> bool:
        """True if the mechanism without counterweights has a shaking force."""
        return bool(np.any(np.nan_to_num(self.before.force) != 0))

    @property
    def left(self) -> float:
        """Largest shaking force after balancing, divided by the largest one before."""
        most = float(np.nanmax(np.abs(self.before.force)))
        return float(np.nanmax(np.abs(self.after.force))) / most if most > 0 else 0.0


def compute_shaking(motion: Motion, about: complex = 0j, weights: Sequence[CounterweightSolution] = ()) -> ShakingLoads:
    """Compute the shaking force and moment of all links with mass, and of counterweights.

    For a counterweight without a given radius only its mass times radius counts; neither the force of its mass
    at the point of attachment nor its moment of inertia is included.

    Args:
        motion: solved motion.
        about: point of the frame for moments, m.
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
    """Find the counterweights that minimize the shaking force.

    The shaking force is F = -sum m a of all links. A counterweight adds c z to the sum of m r over all links, where r
    is the position of a mass, c = mr exp(i angle) is given in the axes of the link that carries the counterweight, and
    z is the direction of these axes. So the counterweights follow from linear least squares. If a radius is given, the
    mass of the counterweight also loads its point of attachment. If that point moves, the solution is repeated with the
    mass until it converges.

    Args:
        motion: a whole cycle at equal steps, without the repeated end; dead positions are skipped.
        task: counterweights to be found.
        about: point of the frame for moments, m.

    Raises:
        CounterweightError: the counterweights do not converge.
    """
    before = compute_shaking(motion, about)
    if not task.counterweights:
        return BalancedCycle((), before, before)
    counterweights = task.counterweights
    # force of a counterweight: -c times the second derivative of the link's direction
    columns = np.stack([-_direction_acceleration(motion, place.link) for place in counterweights], axis=1)
    fastest = float(np.max(np.square(motion.rate))) if motion.linkage.driver.kind == "turn" else 0.0
    columns[:, np.nanmax(np.abs(columns), axis=0) <= AT_REST * fastest] = 0.0  # no effect on a translating link
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
    """Solve for the counterweights (kg m, complex) that minimize the force.

    Returns:
        The counterweights, and the rank of the equations: the number of counterweight components with
            independent effects.
    """
    rotated, rest = columns * task.along.conjugate(), -force * task.along.conjugate()
    share, other = np.sqrt(task.share), np.sqrt(1 - task.share)
    matrix = np.block([[share * rotated.real, -share * rotated.imag], [other * rotated.imag, other * rotated.real]])
    parts, _, rank, _ = np.linalg.lstsq(matrix, np.concatenate([share * rest.real, other * rest.imag]), rcond=NO_EFFECT)
    half = len(parts) // 2
    return parts[:half] + 1j * parts[half:], int(rank)


def _direction(c: complex) -> float:
    """Return the angle of a counterweight, rad. On the negative x axis it is pi, although rounding might give -pi."""
    return float(np.angle(c if abs(c.imag) > NO_ANGLE * abs(c) else complex(c.real)))


def _direction_acceleration(motion: Motion, link: str) -> Vector:
    """Compute the second time derivative of the unit vector along the x axis of a link, 1/s2."""
    rotation, z = motion.link(link), motion.poses[link].z
    acceleration: Vector = (1j * rotation.epsilon - rotation.omega**2) * z
    return acceleration


# Balancing of a mechanism: shaking over its cycle and at its positions, at the constant speed of the driver.


STEPS_PER_TURN = 720  # positions per revolution


@dataclass(frozen=True)
class BalancingResults:
    """Results of a balancing task, over the whole cycle and at the positions of the problem.

    Attributes:
        task: the task.
        q: driver coordinates over the cycle, rad.
        cycle: counterweights and shaking loads over the cycle.
        before, after: shaking loads at the positions of the problem, without and with counterweights.
        pivot: name of the point about which moments are taken.
        corrections: mass times radius of the correction masses of a shaft, kg m.
    """

    task: BalancingTask
    q: Real
    cycle: BalancedCycle
    before: ShakingLoads
    after: ShakingLoads
    pivot: str
    corrections: Vector = field(default_factory=lambda: np.empty(0, complex))

    def at(self, mechanism: Mechanism, q: Real) -> tuple[ShakingLoads, ShakingLoads]:
        """Compute the shaking loads at other driver coordinates, without and with counterweights."""
        return _shaking_at(mechanism, self.cycle, q)


def balance_machine(mechanism: Mechanism, start: float, positions: Real, task: BalancingTask) -> BalancingResults:
    """Balance a mechanism over the cycle that begins at the driver coordinate `start`.

    Args:
        mechanism: the mechanism; its driver runs at constant speed.
        start: driver coordinate of position 0, rad.
        positions: driver coordinates of the positions, rad.
        task: balancing task.

    Raises:
        NoCycleError: the driver is not a fully rotating crank, or there are several drivers.
        CounterweightError: the counterweights do not converge.
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
    motion, about = constant_speed_motion(mechanism, q), balanced.before.about
    return compute_shaking(motion, about), compute_shaking(motion, about, balanced.counterweights)


def constant_speed_motion(mechanism: Mechanism, q: Real) -> Motion:
    """Compute the motion at driver coordinates q (rad) for a driver at constant speed."""
    driver = mechanism.linkage.driver
    law = DriverMotion(float(q[0]), driver.rate, 0.0, driver.sense)
    return compute_motion(mechanism.linkage, mechanism.kernels, q, law)


def _crank_pivot(linkage: Linkage) -> str:
    """Return the name of the point at which the crank is hinged to the frame; empty if it has no such hinge."""
    link = linkage.driver.link
    return next((h.point for h in linkage.hinges if {FRAME, link} <= set(h.links)), "")
