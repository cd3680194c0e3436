"""The Zhukovsky lever: the balancing moment from the velocities alone, independent of the force plan.

The velocity plan, rotated through 90 degrees, is taken as a rigid lever that can rotate about its pole. Every force
acts on it at the end of the velocity vector of its point; a couple on a link is replaced by two forces. The moments
about the pole give the balancing moment. Velocities are taken per unit velocity of the driver, so the lever is defined
for a driver at rest too. N. E. Zhukovsky 1909; I. I. Artobolevsky, ch. 16.
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
    """Force or couple on the lever.

    Attributes:
        name: name of the force or couple.
        link: link on which it acts.
        size: magnitude of the force (N), or the couple with its sign (N m).
        arm: arm of the force about the pole (m per unit of the driver coordinate; nan where the force is zero);
            for a couple the ratio omega_link / omega_driver.
        moment: moment about the pole, size * arm (N m, or N if the driver is a cylinder).
        end: end of the velocity vector of the point of application; None for a couple.
        force: the force as a vector, N; None for a couple.
    """

    name: str
    link: str
    size: Real
    arm: Real
    moment: Real
    end: Vector | None = None
    force: Vector | None = None

    @property
    def key(self) -> tuple[str, str, bool]:
        """Name, link, and True for a force or False for a couple.

        A force and a couple on one link may have the same name.
        """
        return self.name, self.link, self.end is not None


@dataclass(frozen=True)
class ZhukovskyLever:
    """Moments of all loads about the pole and the balancing moment, compared with the force plan.

    Attributes:
        items: forces and couples on the lever.
        balancing: balancing moment of a crank (N m) or force of a cylinder (N).
        difference: deviation from the force plan, relative to the largest balancing value of all positions.
    """

    items: tuple[LeverItem, ...]
    balancing: Real
    difference: Real

    def with_rows_of(self, other: ZhukovskyLever, motion: Motion) -> ZhukovskyLever:
        """Return this lever with the same forces and couples as another lever, in the same order.

        The other lever was computed from other input numbers. It may lack loads of this lever, which are then left out,
        or contain loads that are zero at all positions of this lever. Such a load is added as a zero force without an
        arm, or as a zero couple with the speed ratio of its link.
        """
        items_by_key, zero = dict(zip(_numbered_keys(self.items), self.items, strict=True)), 0 * self.balancing

        def zero_item(item: LeverItem) -> LeverItem:
            arm = motion.link(item.link).first if item.end is None else zero
            return LeverItem(item.name, item.link, zero, arm, zero)

        keys = zip(_numbered_keys(other.items), other.items, strict=True)
        return replace(self, items=tuple(items_by_key.get(key) or zero_item(item) for key, item in keys))


def _numbered_keys(items: tuple[LeverItem, ...]) -> list[tuple[tuple[str, str, bool], int]]:
    """Return the key of each force and couple, numbered among equal keys.

    Keys may be equal because a load may have the same name as an inertia couple.
    """
    seen: Counter[tuple[str, str, bool]] = Counter()
    keys = []
    for item in items:
        seen[item.key] += 1
        keys.append((item.key, seen[item.key]))
    return keys


def compute_lever(motion: Motion, loads: tuple[AppliedLoad, ...], plan: Real) -> ZhukovskyLever:
    """Compute the moments on the lever at every position and compare its balancing moment with that of the force plan.

    Args:
        motion: solved motion.
        loads: all loads on the links.
        plan: balancing moment (N m), or force (N) on a sliding driver, from the force plan, shape (positions,).
    """
    items = []
    for load in loads:
        if load.has_force:
            end = motion.point(load.link, load.at).first
            magnitude = np.abs(load.force)
            moment = dot(load.force, end)
            with np.errstate(invalid="ignore", divide="ignore"):
                arm = np.where(magnitude > 0, moment / magnitude, np.nan)
            items.append(LeverItem(load.name, load.link, magnitude, arm, moment, end, load.force))
        if load.has_moment:
            ratio = motion.link(load.link).first
            name = load.couple_name or load.name
            items.append(LeverItem(name, load.link, load.moment, ratio, load.moment * ratio))
    total = np.zeros(np.shape(motion.q))
    for item in items:
        total = total + item.moment
    balancing = -total
    # where no load has an arm (ends of a stroke) only rounding is left, which is compared with the loads
    reach = (
        max((float(np.max(d.size)) for d in motion.kernels), default=1.0)
        if motion.linkage.driver.kind == "turn"
        else 1.0
    )
    acting = sum(np.abs(i.size) * (reach if i.end is not None else 1.0) for i in items)
    comparable = motion.moving & np.isfinite(plan)  # not where the mechanism is self-locking
    plan_size = np.where(comparable, np.abs(plan), 0.0)
    largest = float(np.max(np.where(comparable, np.maximum(plan_size, NO_MOMENT * acting), 0.0), initial=0.0))
    difference = np.abs(plan - balancing) / largest if largest > 0 else np.abs(plan - balancing)
    return ZhukovskyLever(tuple(items), balancing, difference)
