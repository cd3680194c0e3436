"""Coulomb friction in pairs: reactions and the friction that they cause are solved simultaneously.

A journal of radius r resists with the moment mu R r, a guide with the force mu N, both against the relative
motion. I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 11. There is no solution where a growing
reaction increases friction faster than the driver can overcome it: there the mechanism is self-locking.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.mechanics.forces.loads import AppliedLoad
from tmm_cli.mechanics.forces.reactions import Reaction, Reactions, reduced_driving_moment, solve_reactions
from tmm_cli.mechanics.kinematics import Motion, zero_at_rest
from tmm_cli.mechanics.linkage import FRAME, Friction
from tmm_cli.mechanics.numerics import (
    FRICTION_AGREES,
    FRICTION_LOCKS,
    FRICTION_ROUNDED,
    Real,
    Vector,
    array,
    solve,
    unit,
    without_rounding,
)
from tmm_cli.mechanics.structure import Structure

STAGES = 8  # equal increments of friction, so that the solution continues the one without friction
NEWTON_STEPS = 40  # largest number of Newton steps per increment
HALVINGS = 16  # bisections between two positions for the end of a locked range
OUTER_ROUNDS = 30  # largest number of repeated force plans where friction is not linear (gear teeth)


@dataclass(frozen=True)
class FrictionSolution:
    """Reactions with friction at every position.

    Attributes:
        reactions: reactions in all pairs, and the balancing moments or forces.
        loads: all loads, friction included.
        locked: True at the positions where the mechanism is self-locking; all forces are nan there.
        pair: name of the pair with the largest friction work at each position.
        work: for each pair, the power of friction (negative) divided by the speed of the first driver, N m or N.
        drivers: power of all drivers, divided by the speed of the first one (N m or N).
    """

    reactions: Reactions
    loads: tuple[AppliedLoad, ...]
    locked: Real
    pair: tuple[str, ...]
    work: dict[str, Real]
    drivers: Real


@dataclass(frozen=True)
class LockedRange:
    """Range of driver coordinates (rad or m, start < end) in which the mechanism is self-locking.

    pair: name of the pair with the largest friction work.
    """

    start: float
    end: float
    pair: str


@dataclass(frozen=True)
class FrictionLosses:
    """Work of the drivers and of friction over a cycle or over the range of the driver.

    Attributes:
        drivers: work of all drivers, J.
        pairs: work of friction in each pair, J; negative.
        locked: True if the mechanism is self-locking somewhere; then work and efficiency are not defined.
        ranges: the ranges in which it is self-locking.
    """

    drivers: float
    pairs: dict[str, float]
    locked: bool
    ranges: tuple[LockedRange, ...] = ()

    @property
    def efficiency(self) -> float | None:
        """Efficiency: the fraction of the drivers' work that is not lost to friction.

        None if the drivers do no work or the mechanism is self-locking.
        """
        if self.locked or not self.drivers > 0:
            return None
        useful = without_rounding(self.drivers + sum(self.pairs.values()), self.drivers)
        return float(useful / self.drivers)


def compute_losses(rubbed: FrictionSolution, motion: Motion) -> FrictionLosses:
    """Integrate the work of the drivers and of friction over a motion.

    Args:
        rubbed: friction solution of the motion.
        motion: closely spaced positions, from the beginning to the end of a cycle or of the driver's range.
    """
    pairs = {pair: _integrate(work, motion) for pair, work in rubbed.work.items()}
    drivers = without_rounding(_integrate(rubbed.drivers, motion), _integrate(np.abs(rubbed.drivers), motion))
    return FrictionLosses(float(drivers), pairs, bool(np.any(rubbed.locked)))


def _integrate(work: Real, motion: Motion) -> float:
    """Integrate over the driver coordinate by the trapezoidal rule; positions without a value count as zero.

    For a smooth function over a whole cycle the rule is exact within rounding.
    """
    values = np.where(motion.moving & np.isfinite(work), work, 0.0)
    return float(np.sum((values[1:] + values[:-1]) / 2 * np.diff(motion.q)))


def find_locked_ranges(
    q: Real, rubbed: FrictionSolution, locked_at: Callable[[Real], Real], *, cyclic: bool
) -> tuple[LockedRange, ...]:
    """Find the ranges of the driver coordinate in which the mechanism is self-locking; bisection gives their ends.

    Args:
        q: increasing driver coordinates (rad or m) of the friction solution; if cyclic, the last one is also
            the beginning of the next cycle.
        rubbed: friction solution at these coordinates.
        locked_at: function of driver coordinates, True where the mechanism is self-locking.
        cyclic: True if the motion repeats after the last coordinate.
    """
    locked, pairs = rubbed.locked, np.array(rubbed.pair)
    if not np.any(locked):
        return ()
    if np.all(locked):
        return (LockedRange(float(q[0]), float(q[-1]), str(pairs[0])),)
    if cyclic:  # begin where the mechanism moves, so that no range is cut in two
        first, cycle = int(np.argmin(locked[:-1])), q[-1] - q[0]
        q = np.concatenate([q[first:-1], q[: first + 1] + cycle])
        locked, pairs = (np.concatenate([x[first:-1], x[: first + 1]]) for x in (locked, pairs))
    begins = np.flatnonzero(locked & ~np.concatenate([[False], locked[:-1]]))
    ends = np.flatnonzero(locked & ~np.concatenate([locked[1:], [False]]))
    inside = np.concatenate([q[begins], q[ends]])
    outside = np.concatenate([q[np.maximum(begins - 1, 0)], q[np.minimum(ends + 1, len(q) - 1)]])
    for _ in range(HALVINGS):
        middle = (inside + outside) / 2
        locks = locked_at(middle)
        inside, outside = np.where(locks, middle, inside), np.where(locks, outside, middle)
    ranges = zip(inside[: len(begins)], inside[len(begins) :], pairs[(begins + ends) // 2], strict=True)
    return tuple(LockedRange(float(start), float(end), str(pair)) for start, end, pair in ranges)


def solve_friction(
    motion: Motion, structure: Structure, loads: tuple[AppliedLoad, ...], free: Reactions
) -> FrictionSolution:
    """Solve the reactions and the friction that they cause simultaneously.

    Reactions are linear in the friction forces, so the reactions R_k to unit friction in each pair suffice: the
    magnitudes f of the pair forces satisfy f = |R0 + sum f_k R_k| at each position, where R0 are the reactions
    without friction. With gear teeth the relation is not linear, and the solution is iterated.

    Args:
        motion: solved motion.
        structure: structure of the linkage.
        loads: all loads without friction.
        free: reactions under these loads.
    """
    frictions = motion.linkage.friction
    names = [f.pair for f in frictions]
    ones = np.ones(np.shape(motion.q))
    units = [tuple(_friction_loads(f, motion, free, ones)) for f in frictions]
    response = array(
        [_pair_forces(solve_reactions(motion, structure, unit), names) for unit in units]
    )  # (frictions, pairs, positions)
    start = _pair_forces(free, names)
    reactions, locked = free, np.zeros(np.shape(motion.q), dtype=bool)
    rubbed: tuple[AppliedLoad, ...] = ()
    for _ in range(OUTER_ROUNDS):
        sizes, locked = _solve_magnitudes(start, response)
        rubbed = tuple(
            load
            for f, magnitude in zip(frictions, sizes, strict=True)
            for load in _friction_loads(f, motion, free, magnitude)
        )
        reactions = solve_reactions(motion, structure, (*loads, *rubbed))
        new = _pair_forces(reactions, names)
        with np.errstate(invalid="ignore"):
            deviation = np.abs(np.abs(new) - sizes) / (np.max(np.abs(new), axis=0) + 1e-300)
        if not bool(np.any(deviation[:, ~locked & motion.moving] > FRICTION_AGREES)):
            break
        start = new - np.sum(response * sizes[:, None], axis=0)
    work = {f.pair: _friction_work(f, motion, reactions) for f in frictions}
    stacked = np.nan_to_num(np.abs(array(list(work.values()))))
    worst = tuple(names[int(k)] for k in np.argmax(stacked, axis=0))
    locked = locked & motion.moving
    if bool(np.any(locked)):
        rubbed = tuple(_blank_locked(load, locked) for load in rubbed)
        reactions = solve_reactions(motion, structure, (*loads, *rubbed))
        work = {name: np.where(locked, np.nan, value) for name, value in work.items()}
    return FrictionSolution(
        reactions, (*loads, *rubbed), locked, worst, work, reduced_driving_moment(motion, reactions)
    )


def _pair_forces(reactions: Reactions, names: list[str]) -> Vector:
    """Return the forces in the named pairs, shape (pairs, positions)."""
    forces: Vector = array([reactions.of(name).force for name in names])
    return forces


def _solve_magnitudes(start: Vector, response: Vector) -> tuple[Real, Real]:
    """Solve f = |start + sum f_k response_k| for the magnitudes f of the pair forces.

    Friction is increased in steps; at each step Newton's method starts from the solution of the step before.

    Returns:
        The magnitudes, shape (pairs, positions), and a mask of the positions without a solution, where the
        mechanism is self-locking.
    """
    number, count = start.shape
    sizes = np.abs(start)
    locked = np.zeros(count, dtype=bool)
    with np.errstate(all="ignore"):
        for stage in range(1, STAGES + 1):
            partial_response = response * (stage / STAGES)
            last = np.full(count, np.inf)
            for _ in range(NEWTON_STEPS):
                force = start + np.sum(partial_response * sizes[:, None], axis=0)
                along = force / np.where(np.abs(force) > 0, np.abs(force), 1.0)
                slope = (np.conj(along)[None] * partial_response).real  # derivative of |force j| with respect to f_k
                matrix = np.eye(number)[None] - np.moveaxis(slope, (0, 1, 2), (2, 1, 0))
                step = solve(matrix, (np.abs(force) - sizes).T).T
                sizes = sizes + step
                last = np.max(np.abs(step), axis=0) / (np.max(np.abs(sizes), axis=0) + 1e-300)
                if not bool(np.any(last > FRICTION_ROUNDED)):
                    break
            # a negative magnitude or no solution: more friction than the driver can overcome
            locked |= ~(last < FRICTION_LOCKS) | np.any(sizes < -FRICTION_LOCKS * np.max(np.abs(sizes), axis=0), axis=0)
    return np.where(locked, np.abs(start), sizes), locked


def _blank_locked(load: AppliedLoad, locked: Real) -> AppliedLoad:
    """Set the force and the couple of a load to nan at the positions where the mechanism is self-locking."""
    return replace(load, force=np.where(locked, np.nan, load.force), moment=np.where(locked, np.nan, load.moment))


def _relative_motion(pair: Reaction, motion: Motion) -> tuple[Real, Real]:
    """Compute the motion of link `on` of a pair relative to link `by`.

    Returns:
        Sense of this motion (+1, 0 or -1), and the magnitude of its velocity per unit velocity of the driver.
    """
    largest = motion.largest
    if pair.pair.slide is not None:
        slide = pair.pair.slide
        slip = motion.slide(slide).first * (1 if slide.runner == pair.on else -1)
        moving = zero_at_rest(slip, largest.speed)
    else:
        moving = zero_at_rest(motion.first[pair.on].w - motion.first[pair.by].w, largest.speed / largest.size)
    return np.sign(moving * motion.rate), np.abs(moving)


def _friction_loads(friction: Friction, motion: Motion, reactions: Reactions, force: Real) -> Iterable[AppliedLoad]:
    """Yield the friction load on each moving link of a pair; friction acts against the relative motion of its links."""
    pair = reactions.of(friction.pair)
    sign, _ = _relative_motion(pair, motion)
    still = np.zeros(np.shape(motion.q))
    for link, sense in ((pair.on, -1.0), (pair.by, 1.0)):
        if link == FRAME:
            continue
        name = f"T{friction.pair}{link}"  # named like v_A3, the velocity of point A of link 3
        if pair.pair.slide is None:
            moment = sense * friction.coefficient * friction.radius * force * sign
            yield AppliedLoad(
                name, "friction", link, motion.linkage.local(link, pair.pair.point), still + 0j, moment, name
            )
        else:
            slide = pair.pair.slide
            u = motion.poses[slide.carrier].z * unit(slide.direction)
            push = sense * friction.coefficient * force * sign * u
            # the force acts at the sliding point, which moves along the carrier, so its moment is given apart
            arm = pair.at - motion.poses[link].x
            moment = arm.real * push.imag - arm.imag * push.real
            yield AppliedLoad(name, "friction", link, 0j, push, moment, f"M{name}")


def _friction_work(friction: Friction, motion: Motion, reactions: Reactions) -> Real:
    pair = reactions.of(friction.pair)
    _, slip = _relative_motion(pair, motion)
    arm = friction.radius if pair.pair.slide is None else 1.0
    return -friction.coefficient * np.abs(pair.force) * arm * slip
