"""Data of an Assur group along the driver range: change points, states of groups solved by iteration, accumulated
angles.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, reduce

import numpy as np

from tmm_cli.mechanics.groups.state import GroupState, Pose
from tmm_cli.mechanics.numerics import Real, Vector, pi, to_float


@dataclass(frozen=True)
class ChangePoints:
    """Change points of a group that it passes smoothly; the sign of its determinant changes at each of them.

    Attributes:
        places: driver coordinates of the change points within a cycle, in increasing order.
        start: driver coordinate at the beginning of the cycle.
        at: driver coordinate of the sketch, where the sign is that of the sketch.
        cycle: length of the cycle; None if the motion does not repeat.
    """

    places: Real
    start: float
    at: float
    cycle: float | None

    def side(self, q: Real) -> Real:
        """Return the sign of the determinant at driver coordinates q, relative to that in the sketch.

        It is -1 where an odd number of change points lies between the sketch and q, otherwise 1.
        """
        return 1.0 - 2.0 * ((self._count_passed(q) - self._count_passed(np.array(self.at))) % 2)

    def within(self, low: float, high: float) -> Real:
        """Return the driver coordinates of the change points between low and high, in increasing order."""
        return repeat_in_cycles(self.places, self.start, self.cycle, low, high)

    def _count_passed(self, q: Real) -> Real:
        """Return the number of change points between the beginning of the cycle and the driver coordinates q."""
        within = to_float(q)
        whole = np.zeros(np.shape(q)) if self.cycle is None else np.floor((within - self.start) / self.cycle)
        inside = within - whole * (self.cycle or 0.0)
        passed: Real = whole * len(self.places) + np.searchsorted(self.places, inside)
        return passed


def repeat_in_cycles(coordinates: Real, start: float, cycle: float | None, low: float, high: float) -> Real:
    """Repeat driver coordinates of one cycle in all cycles between low and high, in increasing order.

    Args:
        coordinates: driver coordinates within one cycle.
        start: beginning of that cycle.
        cycle: length of a cycle; None if the coordinates do not repeat.
        low, high: ends of the interval; high is excluded.
    """
    turns = np.zeros(1)
    if cycle is not None:
        turns = np.arange(np.floor((low - start) / cycle) - 1, np.ceil((high - start) / cycle) + 1)
    repeated = np.sort((coordinates[:, None] + (cycle or 0.0) * turns).ravel())
    return repeated[(repeated >= low) & (repeated < high)]


# States of a group along the range of the driver: nodes from which Newton's method starts at any position on its own.


@dataclass(frozen=True)
class BranchTrace:
    """States of a group at increasing driver coordinates (nodes), for estimates at the coordinates between them.

    Attributes:
        q: driver coordinates of the nodes, increasing.
        states: states of the group at the nodes.
        first, second: first and second derivatives of the states with respect to q.
        closed: True if the last node is the first one, a cycle later. Otherwise the trace ends where the group cannot
            continue, or where tracing was stopped.
        open_ends: for the lower and the upper end, True if tracing was stopped there although the group could continue.
        limits: for the first and the last node, True if it is a limit position of the driver; derivatives are infinite
            there.
        lost: for the first and the last node, True if the trace ends for another reason: links on which the group
            depends move no further, or links of the group go to infinity.
        unit: unit of residuals: 1 rad for a rotating driver, the size of the group (m) for a sliding one.
        dead: driver coordinates of dead positions that the group passes smoothly.
        flips: for each of these, True if the determinant changes sign.
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
        """Magnitude of the second derivative of the group's state at each node."""
        bend: Real = np.max(np.abs(self.second.x), axis=-1) + np.max(np.abs(self.second.unwrapped), axis=-1)
        return bend

    def within(self, q: Real) -> Real:
        """Reduce driver coordinates q by whole cycles to the traced cycle.

        They are returned unchanged if the trace is not closed.
        """
        cycle = self.q[-1] - self.q[0]
        return q - np.floor((q - self.q[0]) / cycle) * cycle if self.closed else q

    def in_dead(self, q: Real, rounding: float) -> Real:
        """Return True where q cannot be distinguished from a dead position that the group passes.

        At a distance h from it, errors of the data move the group by error/h, or error/h^2 if the determinant touches
        zero without changing sign. This must be less than h.

        Args:
            q: driver coordinates.
            rounding: relative error of the data.
        """
        if not self.dead.size:
            return np.zeros(np.shape(q), dtype=bool)
        width = np.where(self.flips, rounding ** (1 / 2), rounding ** (1 / 3)) * self.unit
        near: Real = np.any(np.abs(self.within(q)[..., None] - self.dead) < width, axis=-1)
        return near

    def side(self, q: Real) -> Real:
        """Return the sign of the determinant at driver coordinates q, relative to that at the beginning of the
        trace.
        """
        passed = np.searchsorted(self.dead[self.flips], self.within(q))
        return 1.0 - 2.0 * (passed % 2)

    def dead_within(self, low: float, high: float) -> Real:
        """Return the driver coordinates between low and high at which the group passes dead positions, increasing."""
        cycle = self.q[-1] - self.q[0]
        return repeat_in_cycles(self.dead, float(self.q[0]), float(cycle) if self.closed else None, low, high)

    def start(self, q: Real) -> tuple[GroupState, Real]:
        """Estimate the states of the group at driver coordinates q by extrapolation from the nearest nodes.

        Returns:
            The states, and a residual for each q: the distance of q beyond the ends of the trace in units of `unit`.
            The residual is negative inside the trace, but not below -1; it is -1 for a closed trace.
        """
        low, high = self.q[0], self.q[-1]
        cycle = high - low
        whole = np.floor((q - low) / cycle) if self.closed else np.zeros(np.shape(q))
        within = np.clip(q - whole * cycle, low, high)
        right = np.clip(np.searchsorted(self.q, within), 1, len(self.q) - 1)
        left = right - 1
        # the node with the smaller second-order term: near a limit that is the one farther from it
        bend = self._bend
        from_left = bend[left] * (within - self.q[left]) ** 2 <= bend[right] * (within - self.q[right]) ** 2
        node = np.where(from_left, left, right)
        step = (within - self.q[node])[..., None]
        turns = self.states.unwrapped[-1] - self.states.unwrapped[0]
        near_limit = (self.limits[0] & (left == 0)) | (self.limits[1] & (right == len(self.q) - 1))
        limit = np.where(left == 0, 0, len(self.q) - 1)
        inner = np.where(left == 0, right, left)
        interval = np.abs(self.q[limit] - self.q[inner])
        share = np.sqrt(np.abs(self.q[limit] - within) / np.where(interval > 0, interval, 1.0))[..., None]

        def at(value: Vector, first: Vector, second: Vector) -> Vector:
            taylor = value[node] + step * (first[node] + step / 2 * second[node])
            # near a limit the group moves as the square root of the distance of the driver from it
            root = value[limit] + (value[inner] - value[limit]) * share
            extrapolated: Vector = np.where(near_limit[..., None], root, taylor)
            return extrapolated

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


# Angles accumulated through full turns, as functions of the driver coordinate.
#
# The position of a gear depends on the number of turns of its mating gear; nothing else does, so only the angles of
# links on which gears depend are accumulated. Each position is still solved on its own: the number of turns comes from
# a table that is made once.


TAU = 2 * np.pi


@dataclass(frozen=True)
class AccumulatedAngles:
    """Table of accumulated angles of links against the driver coordinate.

    Attributes:
        q: driver coordinates, increasing.
        angles: angles (rad, unwrapped) of each link at q, by name of the link.
        closed: True if q covers a full cycle.
    """

    q: Real
    angles: Mapping[str, Real]
    closed: bool

    def followed(self, links: tuple[str, ...], poses: tuple[Pose, ...], q: Real) -> tuple[Pose, ...]:
        """Add to the poses of links the full turns that the links have made up to driver coordinates q.

        links: names of the links, one for each pose.
        """
        accumulated = []
        for link, pose in zip(links, poses, strict=True):
            if link not in self.angles:
                accumulated.append(pose)
                continue
            angle = np.arctan2(pose.z.imag, pose.z.real)
            turned = angle + 2 * pi(angle) * np.round((self._interpolate_angle(link, q) - angle) / TAU)
            accumulated.append(replace(pose, unwrapped=turned))
        return tuple(accumulated)

    def sure(self, links: tuple[str, ...], poses: tuple[Pose, ...], q: Real) -> Real:
        """Return True at driver coordinates q where the number of full turns of the links is certain.

        There the angles of the poses are within 90 degrees of the table.

        links: names of the links, one for each pose.
        """
        off = [
            np.abs(pose.turned - self._interpolate_angle(n, q))
            for n, pose in zip(links, poses, strict=True)
            if n in self.angles
        ]
        sure: Real = reduce(np.maximum, off) < np.pi / 2
        return sure

    def _interpolate_angle(self, link: str, q: Real) -> Real:
        """Interpolate the accumulated angle of a link in the table."""
        cycle = self.q[-1] - self.q[0]
        whole = np.floor((q - self.q[0]) / cycle) if self.closed else np.zeros(np.shape(q))
        table = self.angles[link]
        about: Real = np.interp((q - whole * cycle).astype(float), self.q, table) + whole * (table[-1] - table[0])
        return about
