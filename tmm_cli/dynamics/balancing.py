"""Balancing: what shakes the frame over a cycle, and the counterweights that take it away.

The frame feels F = -sum m a of all links. It is nothing when the common centre of mass stands still, and a
counterweight on a link adds c z to sum m r, where c = mr exp(i angle) is given in its axes and z their direction: what
counterweights have to be is found linearly, for a linkage of any kind. R. S. Berkof, G. G. Lowen, A new method for
completely force balancing simple linkages, J. Eng. Ind. 91 (1969). Rotating masses in planes: I. I. Artobolevsky,
Theory of Mechanisms and Machines (1988), ch. 13.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tmm_cli.kinematics.motion import Motion
from tmm_cli.vectors import Real, Vector, cross

NO_HELP = 1e-9  # of the largest singular value: counterweights that do the same as others are not told apart


@dataclass(frozen=True)
class Shaking:
    """What the links do to the frame by their inertia, at every position: force (N), couple about `about` (N m)."""

    force: Vector
    moment: Real
    about: complex


@dataclass(frozen=True)
class Counterweight:
    """On a link, about a point of it (its axes, m): mass times radius (kg m) at an angle from the x axis (rad)."""

    link: str
    about: complex
    size: float
    angle: float


@dataclass(frozen=True)
class Balanced:
    """Counterweights, what shakes before and after, and the share of the force's mean square that is left."""

    counterweights: tuple[Counterweight, ...]
    before: Shaking
    after: Shaking

    @property
    def left(self) -> float:
        """Largest shaking force after, over that before."""
        most = float(np.nanmax(np.abs(self.before.force)))
        return float(np.nanmax(np.abs(self.after.force))) / most if most > 0 else 0.0


def shaking(motion: Motion, about: complex = 0j) -> Shaking:
    """Of all links with mass."""
    force, moment = np.zeros(np.shape(motion.q), complex), np.zeros(np.shape(motion.q))
    for name in motion.linkage.moving:
        link = motion.linkage.links[name]
        centre, turning = motion.centre(name), motion.link(name)
        force = force - link.mass * centre.a
        moment = moment - link.mass * cross(centre.x - about, centre.a) - link.inertia * turning.epsilon
    return Shaking(force, moment, about)


def balanced(motion: Motion, about: Mapping[str, complex], share: float = 1.0) -> Balanced:
    """Counterweights on links about points of theirs (their axes, m) that leave the least shaking force.

    motion: over a whole cycle at even steps, without its end twice. share: how much of the first harmonic of what they
    could take is taken. A counterweight adds no mass to its point: what is told is mass times radius alone.
    """
    before = shaking(motion)
    links = list(about)
    # force of a unit counterweight along the x axis of its link: -(second derivative of z); the point's own mass is 0
    columns = np.stack([-_turning(motion, link) for link in links], axis=1)
    found = np.linalg.lstsq(columns, -share * before.force, rcond=NO_HELP)[0]
    weights = tuple(
        Counterweight(link, at, float(abs(c)), float(np.angle(c)))
        for (link, at), c in zip(about.items(), found, strict=True)
    )
    return Balanced(weights, before, _with(motion, before, weights))


def _turning(motion: Motion, link: str) -> Vector:
    """Second derivative by time of the direction of a link's x axis, 1/s2."""
    turning, z = motion.link(link), motion.poses[link].z
    found: Vector = (1j * turning.epsilon - turning.omega**2) * z
    return found


def _with(motion: Motion, before: Shaking, weights: Sequence[Counterweight]) -> Shaking:
    """What shakes with counterweights whose masses are small on long arms: mass times radius counts."""
    force, moment = before.force, before.moment
    for weight in weights:
        c = weight.size * np.exp(1j * weight.angle)
        pivot = motion.point(weight.link, weight.about)
        added = c * _turning(motion, weight.link)
        force = force - added
        moment = moment - cross(pivot.x - before.about, added) - cross(c * motion.poses[weight.link].z, pivot.a)
    return Shaking(force, moment, before.about)
