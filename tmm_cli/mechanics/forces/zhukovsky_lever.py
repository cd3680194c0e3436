"""Stage: the Zhukovsky lever. From velocities alone: it shares nothing with the force plan but the loads.

The velocity plan turned through 90 degrees is a rigid lever on its pole; every force stands at the end of its point's
velocity, a couple M on a link as a couple of forces; moments about the pole give what balances the driver. Taken per
unit speed of the driver, so it exists at rest too. N. E. Zhukovsky 1909; I. I. Artobolevsky, ch. 16.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.mechanics.forces.loads import AppliedLoad
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.numerics import NO_MOMENT, Real, Vector, dot


@dataclass(frozen=True)
class LeverItem:
    """A force or couple on the lever. arm: of the force about the pole (m per unit of the driver's motion; nan where
    there is no force), or the ratio omega_link / omega_driver for a couple; moment = size * arm (N m, or N for a
    cylinder)."""

    name: str
    link: str
    size: Real
    arm: Real
    moment: Real
    end: Vector | None = None  # of its point's velocity on the plan, per unit of the driver's motion
    force: Vector | None = None

    @property
    def key(self) -> tuple[str, str, bool]:
        """By which it is known: a force and a couple may have one name."""
        return self.name, self.link, self.end is not None


@dataclass(frozen=True)
class ZhukovskyLever:
    """Moments about the pole, what balances them, and how far the force plan's answer is from it.

    balancing: N m for a crank, N for a cylinder. difference: relative to the largest balancing value of all positions.
    """

    items: tuple[LeverItem, ...]
    balancing: Real
    difference: Real

    def with_rows_of(self, other: ZhukovskyLever, motion: Motion) -> ZhukovskyLever:
        """The same lever, computed from this motion, with the items of another one, each in its place.

        With other numbers a load may be zero everywhere, or no longer be, and has no item, or one more. A force that is
        zero here has no arm; a couple has its ratio of speeds all the same.
        """
        own, zero = dict(zip(_numbered_keys(self.items), self.items, strict=True)), 0 * self.balancing

        def zero_item(item: LeverItem) -> LeverItem:
            arm = motion.link(item.link).first if item.end is None else zero
            return LeverItem(item.name, item.link, zero, arm, zero)

        keys = zip(_numbered_keys(other.items), other.items, strict=True)
        return replace(self, items=tuple(own.get(key) or zero_item(item) for key, item in keys))


def _numbered_keys(items: tuple[LeverItem, ...]) -> list[tuple[tuple[str, str, bool], int]]:
    """Keys of items, each with its number among those of one key: a load may have the name of an inertia couple."""
    seen: Counter[tuple[str, str, bool]] = Counter()
    keys = []
    for item in items:
        seen[item.key] += 1
        keys.append((item.key, seen[item.key]))
    return keys


def compute_lever(motion: Motion, loads: tuple[AppliedLoad, ...], plan: Real) -> ZhukovskyLever:
    """The lever at every position, compared with the force plan's balancing moment (or force)."""
    items = []
    for load in loads:
        if load.has_force:
            end = motion.point(load.link, load.at).first
            size = np.abs(load.force)
            moment = dot(load.force, end)
            with np.errstate(invalid="ignore", divide="ignore"):
                arm = np.where(size > 0, moment / size, np.nan)
            items.append(LeverItem(load.name, load.link, size, arm, moment, end, load.force))
        if load.has_moment:
            ratio = motion.link(load.link).first
            name = load.couple_name or load.name
            items.append(LeverItem(name, load.link, load.moment, ratio, load.moment * ratio))
    total = np.zeros(np.shape(motion.q))
    for item in items:
        total = total + item.moment
    balancing = -total
    # where nothing has an arm (both ends of a stroke) there is only rounding to compare: not against itself
    reach = (
        max((float(np.max(d.size)) for d in motion.kernels), default=1.0)
        if motion.linkage.driver.kind == "turn"
        else 1.0
    )
    acting = sum(np.abs(i.size) * (reach if i.end is not None else 1.0) for i in items)
    known = motion.moving & np.isfinite(plan)  # not where it locks itself by friction
    plan_size = np.where(known, np.abs(plan), 0.0)
    largest = float(np.max(np.where(known, np.maximum(plan_size, NO_MOMENT * acting), 0.0), initial=0.0))
    difference = np.abs(plan - balancing) / largest if largest > 0 else np.abs(plan - balancing)
    return ZhukovskyLever(tuple(items), balancing, difference)
