"""Coulomb friction in pairs: reactions and friction found in turn until they agree.

A hinge with a journal of radius r resists by the moment mu R r, a guide by the force mu N; both against the relative
motion. I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 11. Where a greater reaction needs more friction than
it can overcome, the two never agree: the mechanism locks itself.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.forces.applied import Applied
from tmm_cli.forces.plan import Reaction, Reactions, power, react
from tmm_cli.linkage import FRAME, Friction
from tmm_cli.motion import Motion
from tmm_cli.structure.assur import Structure
from tmm_cli.vectors import Real, unit

ROUNDS = 400
AGREE = 1e-13  # of the largest reaction
NO_GROWTH = 1e6  # times the reactions without friction: what has grown so far has no end


@dataclass(frozen=True)
class Rubbed:
    """Reactions with friction. locked: positions where the mechanism locks itself; pair: the one that rubs most there.

    Where it locks there are no forces with which it would move: they are nan.

    work: power of friction per unit of the first driver's motion (N m or N, negative), pair by pair.
    """

    reactions: Reactions
    loads: tuple[Applied, ...]
    locked: Real
    pair: tuple[str, ...]
    work: dict[str, Real]
    drivers: Real

    def efficiency(self, motion: Motion) -> float | None:
        """Work that is not lost to friction over the work of the drivers, over the positions; None without any."""
        given = _over(self.drivers, motion)
        lost = sum(_over(work, motion) for work in self.work.values())
        return float((given + lost) / given) if given > 0 else None

    def total(self, pair: str, motion: Motion) -> float:
        """Work of friction in one pair over the positions, J (negative)."""
        return _over(self.work[pair], motion)


def _over(work: Real, motion: Motion) -> float:
    """Sum over the driver's way: by equal steps round a turn, by trapezia between limits."""
    q = motion.q
    sound = np.isfinite(work)
    if len(q) < 2:
        return float(work[0]) if sound[0] else 0.0
    steps = np.diff(q)
    around = abs(np.mod(steps.sum() + steps[0] + 1e-9, 2 * np.pi)) < 1e-6 and motion.linkage.driver.kind == "turn"
    values = np.where(sound, work, 0.0) * np.sign(steps[0])
    if around and np.allclose(steps, steps[0]):
        return float(np.sum(values) * abs(steps[0]))
    return float(np.sum((values[1:] + values[:-1]) / 2 * np.abs(steps)))


def rub(motion: Motion, structure: Structure, loads: tuple[Applied, ...], free: Reactions) -> Rubbed:
    """Friction found from the reactions without it, over and over; half-way each time, so that it does not swing."""
    reactions = free
    size = sum(np.abs(r.force) for r in free.all) + 1e-300
    forces: dict[str, Real] = {f.pair: np.abs(free.of(f.pair).force) for f in motion.linkage.friction}
    change = np.full(np.shape(motion.q), np.inf)
    rubbed: tuple[Applied, ...] = ()
    for _ in range(ROUNDS):
        rubbed = tuple(load for f in motion.linkage.friction for load in _loads(f, motion, reactions, forces[f.pair]))
        reactions = react(motion, structure, (*loads, *rubbed))
        new = {name: np.abs(reactions.of(name).force) for name in forces}
        with np.errstate(invalid="ignore"):
            change = sum(np.abs(new[name] - forces[name]) for name in forces) / size
            grown = sum(new.values()) / size
        if not bool(np.any((change > AGREE) & (grown < NO_GROWTH))):
            break
        forces = {name: np.where(grown < NO_GROWTH, (new[name] + forces[name]) / 2, forces[name]) for name in forces}
    with np.errstate(invalid="ignore"):
        locked = motion.moving & ~(change < 1e-9)
    work = {f.pair: _work(f, motion, reactions) for f in motion.linkage.friction}
    stacked = np.array([np.abs(w) for w in work.values()])
    names = list(work)
    worst = tuple(names[int(np.argmax(np.nan_to_num(stacked[:, k])))] for k in range(len(motion.q)))
    if bool(np.any(locked)):
        rubbed = tuple(_nowhere(load, locked) for load in rubbed)
        reactions = react(motion, structure, (*loads, *rubbed))
        work = {name: np.where(locked, np.nan, value) for name, value in work.items()}
    return Rubbed(reactions, (*loads, *rubbed), locked, worst, work, power(motion, reactions))


def _nowhere(load: Applied, lost: Real) -> Applied:
    """A load that is nothing where the mechanism does not move."""
    return replace(load, force=np.where(lost, np.nan, load.force), moment=np.where(lost, np.nan, load.moment))


def _slip(pair: Reaction, motion: Motion) -> tuple[Real, Real]:
    """Direction of the relative motion (+1, 0, -1) and its size per unit of the driver, of link `on` against `by`."""
    if pair.pair.slide is not None:
        slide = pair.pair.slide
        first = motion.slide(slide).first * (1 if slide.runner == pair.on else -1)
    else:
        first = motion.first[pair.on].w - (motion.first[pair.by].w if pair.by != FRAME else 0.0)
    scale = float(np.nanmax(np.abs(first), initial=0.0))
    moving = np.where(np.abs(first) > 1e-12 * scale, first, 0.0)
    return np.sign(moving * motion.rate), np.abs(moving)


def _loads(friction: Friction, motion: Motion, reactions: Reactions, force: Real) -> Iterable[Applied]:
    """Friction on both links of a pair."""
    pair = reactions.of(friction.pair)
    sign, _ = _slip(pair, motion)
    still = np.zeros(np.shape(motion.q))
    for link, sense in ((pair.on, -1.0), (pair.by, 1.0)):
        if link == FRAME:
            continue
        name = f"T{friction.pair}" + ("" if link == pair.on else "'")
        if pair.pair.slide is None:
            moment = sense * friction.coefficient * friction.radius * force * sign
            yield Applied(name, "friction", link, motion.linkage.local(link, pair.pair.point), still + 0j, moment, name)
        else:
            slide = pair.pair.slide
            u = motion.poses[slide.carrier].z * unit(slide.direction)
            push = sense * friction.coefficient * force * sign * u
            # at the running point; seen from the carrier that wanders, so its moment is given apart
            arm = pair.at - motion.poses[link].x
            moment = arm.real * push.imag - arm.imag * push.real
            yield Applied(name, "friction", link, 0j, push, moment, f"M{name}")


def _work(friction: Friction, motion: Motion, reactions: Reactions) -> Real:
    pair = reactions.of(friction.pair)
    _, slip = _slip(pair, motion)
    arm = friction.radius if pair.pair.slide is None else 1.0
    work: Real = -friction.coefficient * np.abs(pair.force) * arm * slip
    return work
