"""Base class of load elements: two links, two points, and a force or moment between them."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from tmm_cli.mechanics.numerics import Real, Vector, dot, unit

if TYPE_CHECKING:
    from tmm_cli.mechanics.kinematics import Motion


class Stretch(NamedTuple):
    """Length of an element or its angle, and how fast it changes.

    Attributes:
        size: distance of the two points (m), or angle of link j relative to link i from the `rest` angle (rad, from -pi
            to pi); shape (positions,).
        rate: time derivative of `size` (m/s or rad/s), shape (positions,).
        along: unit vector from the point on link i to that on link j, zero where they coincide; zero for an angle.
    """

    size: Real
    rate: Real
    along: Vector


class ElementEnd(NamedTuple):
    """An end of a linear element.

    Attributes:
        link: name of the link.
        field: field of the record that has the point.
        at: the point, in the axes of the link (m).
    """

    link: str
    field: str
    at: complex


class Wrench(NamedTuple):
    """A force (N) at a point of a link and a couple (N m), both of shape (positions,)."""

    link: str
    at: complex
    force: Vector
    moment: Real


@dataclass(frozen=True)
class LoadElement(ABC):
    """A load between two links that depends on their relative motion.

    A linear element pulls its two points together with the force `pull`, in N. A torsional one exerts on link j the
    moment -`pull` and on link i the opposite one, in N m.

    Attributes:
        block: key of the problem file under which elements of this kind are listed; their modules have this name.
        name: name of the element.
        i, j: names of the links.
        at_i, at_j: its points in the axes of each link (m).
        turns: True for a torsional element.
        dissipates: True for a kind of element that takes energy and stores none.
    """

    block: ClassVar[str]
    dissipates: ClassVar[bool] = False

    name: str
    i: str
    j: str
    at_i: complex = 0j
    at_j: complex = 0j
    turns: bool = False

    @abstractmethod
    def pull(self, stretch: Stretch) -> Real:
        """Return the force (N) or moment (N m) of the element, shape (positions,)."""

    @property
    def rest(self) -> float:
        """Angle of link j relative to link i from which the angle of a torsional element is measured (rad)."""
        return 0.0

    @property
    def speed_key(self) -> str | None:
        """Key of the file that makes the load depend on speed.

        "" if the element itself depends on speed; None if the load does not depend on it.
        """
        return None

    @property
    def ends(self) -> tuple[ElementEnd, ...]:
        """Ends of a linear element; empty for a torsional one."""
        return () if self.turns else (ElementEnd(self.i, "at_i", self.at_i), ElementEnd(self.j, "at_j", self.at_j))

    def twist(self, motion: Motion) -> Real:
        """Compute the angle of a torsional element from its `rest` angle (rad, from -pi to pi).

        Only the positions of the links are used.
        """
        rotation = motion.poses[self.j].z * np.conj(motion.poses[self.i].z) * np.conj(unit(self.rest))
        angle: Real = np.angle(rotation)
        return angle

    def stretch(self, motion: Motion) -> Stretch:
        """Compute the length or the angle of the element, and its rate of change."""
        if self.turns:
            moving = motion.linkage.moving
            rate = motion.link(self.j).omega - (motion.link(self.i).omega if self.i in moving else 0.0)
            return Stretch(self.twist(motion), rate, np.zeros(np.shape(motion.q)) + 0j)
        i, j = motion.point(self.i, self.at_i), motion.point(self.j, self.at_j)
        length = np.abs(j.x - i.x)
        with np.errstate(invalid="ignore", divide="ignore"):
            along = np.where(length > 0, (j.x - i.x) / length, 0.0)
        return Stretch(length, dot(along, j.v - i.v), along)

    def wrenches(self, motion: Motion) -> Iterator[Wrench]:
        """Yield the forces and couples that the element exerts on its two links, on the second link first.

        They are equal and opposite.
        """
        stretch, still = self.stretch(motion), np.zeros(np.shape(motion.q))
        pull = self.pull(stretch)
        for link, at, sense in ((self.j, self.at_j, -1), (self.i, self.at_i, 1)):
            if self.turns:
                yield Wrench(link, at, still + 0j, sense * pull)
            else:
                yield Wrench(link, at, sense * pull * stretch.along, still)
