"""Which sign the determinant of a group of two assemblies has, where it goes smoothly through exact change points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, reduce

import numpy as np

from tmm_cli.mechanics.groups.state import GroupState, Pose
from tmm_cli.mechanics.numerics import Real, Vector, pi, to_float


@dataclass(frozen=True)
class ChangePoints:
    """Growing places of the driver at which the sign of a group's determinant changes, within a `cycle` that begins at
    `start` and is repeated (None: it is not); at the place `at` the sign is that of the sketch.
    """

    places: Real
    start: float
    at: float
    cycle: float | None

    def side(self, q: Real) -> Real:
        """1, or -1 where the group has passed an odd number of them from the sketch on."""
        return 1.0 - 2.0 * ((self._passed(q) - self._passed(np.array(self.at))) % 2)

    def within(self, low: float, high: float) -> Real:
        """Those from one place to another, in growing order."""
        return repeat_in_cycles(self.places, self.start, self.cycle, low, high)

    def _passed(self, q: Real) -> Real:
        """How many there are from the start to places q."""
        within = to_float(q)
        whole = np.zeros(np.shape(q)) if self.cycle is None else np.floor((within - self.start) / self.cycle)
        inside = within - whole * (self.cycle or 0.0)
        passed: Real = whole * len(self.places) + np.searchsorted(self.places, inside)
        return passed


def repeat_in_cycles(places: Real, start: float, cycle: float | None, low: float, high: float) -> Real:
    """Places of a cycle that begins at `start`, as often as they come between two others; None: they come once."""
    turns = np.zeros(1)
    if cycle is not None:
        turns = np.arange(np.floor((low - start) / cycle) - 1, np.ceil((high - start) / cycle) + 1)
    found = np.sort((places[:, None] + (cycle or 0.0) * turns).ravel())
    return found[(found >= low) & (found < high)]


# Where a group's links are along the driver's range: nodes from which Newton's method starts at any place alone.


@dataclass(frozen=True)
class BranchTrace:
    """States at growing places q of the driver with their first and second derivatives by q.

    closed: the last node is the first one again, a cycle later (then the driver may go on for ever). Else the trace
    ends where the group cannot follow, or where one stopped looking (`open_ends`: below, above). limits: whether the
    first, the last node is a place where the driver turns back; derivatives are infinite there. lost: whether the trace
    ends there for another reason: the links it hangs on go no further, or links of its own go to infinity. unit: what
    residuals are counted in, 1 rad for a driver that turns, the group's size (m) for one that slides. dead: places of
    nodes in dead positions that are passed smoothly; flips: whether the determinant changes its sign there.
    """

    q: Real
    states: GroupState
    first: GroupState
    second: GroupState
    closed: bool
    open_ends: tuple[bool, bool] = (False, False)
    limits: tuple[bool, bool] = (False, False)
    lost: tuple[bool, bool] = (False, False)
    unit: float = 1.0
    dead: Real = field(default_factory=lambda: np.zeros(0))
    flips: Real = field(default_factory=lambda: np.zeros(0, dtype=bool))

    @cached_property
    def _bend(self) -> Real:
        """Size of the second derivative at each node."""
        bend: Real = np.max(np.abs(self.second.x), axis=-1) + np.max(np.abs(self.second.unwrapped), axis=-1)
        return bend

    def within(self, q: Real) -> Real:
        """Places q of a closed trace in its own cycle."""
        cycle = self.q[-1] - self.q[0]
        return q - np.floor((q - self.q[0]) / cycle) * cycle if self.closed else q

    def in_dead(self, q: Real, rounding: float) -> Real:
        """Whether places cannot be told from a dead position that is passed, for relative errors of the data.

        At a distance h they move the group by their h-th part, the h^2-th where the determinant only touches zero, and
        that has to be less than h.
        """
        if not self.dead.size:
            return np.zeros(np.shape(q), dtype=bool)
        width = np.where(self.flips, rounding ** (1 / 2), rounding ** (1 / 3)) * self.unit
        found: Real = np.any(np.abs(self.within(q)[..., None] - self.dead) < width, axis=-1)
        return found

    def side(self, q: Real) -> Real:
        """1, or -1 where the determinant has another sign than at the trace's beginning."""
        passed = np.searchsorted(self.dead[self.flips], self.within(q))
        return 1.0 - 2.0 * (passed % 2)

    def dead_within(self, low: float, high: float) -> Real:
        """Dead positions that are passed between two places, in growing order."""
        cycle = self.q[-1] - self.q[0]
        return repeat_in_cycles(self.dead, float(self.q[0]), float(cycle) if self.closed else None, low, high)

    def start(self, q: Real) -> tuple[GroupState, Real]:
        """A state near that at each place q, from the nearest node, and the residual: how far q is beyond the trace's
        ends, in its units. Negative inside, by the distance to the nearer end; -1 on a closed trace.
        """
        low, high = self.q[0], self.q[-1]
        cycle = high - low
        whole = np.floor((q - low) / cycle) if self.closed else np.zeros(np.shape(q))
        within = np.clip(q - whole * cycle, low, high)
        right = np.clip(np.searchsorted(self.q, within), 1, len(self.q) - 1)
        left = right - 1
        # the node from which the second derivative carries least far: near a limit that is the one farther from it
        bend = self._bend
        from_left = bend[left] * (within - self.q[left]) ** 2 <= bend[right] * (within - self.q[right]) ** 2
        node = np.where(from_left, left, right)
        step = (within - self.q[node])[..., None]
        turns = self.states.unwrapped[-1] - self.states.unwrapped[0]
        near_limit = (self.limits[0] & (left == 0)) | (self.limits[1] & (right == len(self.q) - 1))
        limit = np.where(left == 0, 0, len(self.q) - 1)
        inner = np.where(left == 0, right, left)
        way = np.abs(self.q[limit] - self.q[inner])
        share = np.sqrt(np.abs(self.q[limit] - within) / np.where(way > 0, way, 1.0))[..., None]

        def at(value: Vector, first: Vector, second: Vector) -> Vector:
            taylor = value[node] + step * (first[node] + step / 2 * second[node])
            # at a limit the group moves as the root of the way that is left to the driver
            root = value[limit] + (value[inner] - value[limit]) * share
            here: Vector = np.where(near_limit[..., None], root, taylor)
            return here

        state = GroupState(
            at(self.states.x, self.first.x, self.second.x),
            at(self.states.unwrapped, self.first.unwrapped, self.second.unwrapped) + whole[..., None] * turns,
        )
        if self.closed:
            return state, np.full(np.shape(q), -1.0)
        under, over = (low - q) / self.unit, (q - high) / self.unit
        below = np.where(self.open_ends[0], -np.inf, under)
        above = np.where(self.open_ends[1], -np.inf, over)
        residual = np.maximum(np.maximum(below, above), -1.0)
        return state, np.where((q < low) | (q > high), np.maximum(np.maximum(under, over), 1e-12), residual)


# Angles followed through full turns: which of the angles 2 pi apart a link has at each place of the driver.
#
# A toothed wheel's place depends on how often its partner has gone round; nothing else does, so only links that wheels
# depend on are followed. A position is still found alone: the number of turns comes from a table made once.


TAU = 2 * np.pi


@dataclass(frozen=True)
class AccumulatedAngles:
    """Angles of links (rad, unwrapped) at places q of the driver that grow; when closed they go on by full cycles."""

    q: Real
    angles: Mapping[str, Real]
    closed: bool

    def followed(self, links: tuple[str, ...], poses: tuple[Pose, ...], q: Real) -> tuple[Pose, ...]:
        """The same poses with their angles followed through full turns."""
        found = []
        for link, pose in zip(links, poses, strict=True):
            if link not in self.angles:
                found.append(pose)
                continue
            angle = np.arctan2(pose.z.imag, pose.z.real)
            turned = angle + 2 * pi(angle) * np.round((self._about(link, q) - angle) / TAU)
            found.append(replace(pose, unwrapped=turned))
        return tuple(found)

    def sure(self, links: tuple[str, ...], poses: tuple[Pose, ...], q: Real) -> Real:
        """Where the table tells the turns of such poses: it is less than a quarter of a turn off."""
        off = [
            np.abs(pose.turned - self._about(n, q)) for n, pose in zip(links, poses, strict=True) if n in self.angles
        ]
        sure: Real = reduce(np.maximum, off) < np.pi / 2
        return sure

    def _about(self, link: str, q: Real) -> Real:
        """The angle of a link at places q, by the table."""
        cycle = self.q[-1] - self.q[0]
        whole = np.floor((q - self.q[0]) / cycle) if self.closed else np.zeros(np.shape(q))
        table = self.angles[link]
        about: Real = np.interp((q - whole * cycle).astype(float), self.q, table) + whole * (table[-1] - table[0])
        return about
