"""Numerical continuation of a group from the sketch along the driver coordinate.

This is the only place where a position depends on the one before. Steps are predicted with first and second derivatives
and corrected by Newton's method. A step is halved if its correction is too large or if the determinant of the group's
equations changes sign. E. L. Allgower, K. Georg, Introduction to Numerical Continuation Methods, ch. 2 and 6.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from tmm_cli.mechanics.assembly.corrector import (
    CORRECTION,
    PATIENCE,
    BranchNode,
    Corrector,
    Source,
    join_states,
    places_ahead,
)
from tmm_cli.mechanics.assembly.crossing import EDGE, CrossingFinder, is_far_from_dead
from tmm_cli.mechanics.groups import BranchTrace, GroupState, LinkStates, NewtonSolver, Pose
from tmm_cli.mechanics.numerics import LAST_STEP, Real, solve

FIRST_STEP, LARGEST_STEP = 0.02, 0.1  # fractions of the examined range, divided by pi
LEAST_STEP = 1e-9
TURNS = 24  # driver turns after which a group that has not returned to its first state is no longer followed
SPUN = 3e2  # rad, plus the same per radian of the driver: gears that rotate more are no longer followed
FAR = 1e3  # sizes of a group: if a link is farther away where continuation fails, it recedes to infinity
HALVINGS = 80
FARTHEST = 0.3  # sizes of the group, rad: distance along the motion of the group in which a limit is searched
LEFT = (0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6)  # fractions of the distance from a limit at which the branch is checked
AHEAD = 0.1  # fraction of the driver range, divided by pi: largest distance of a limit that is searched
SHIFTS = (0.0, 0.17, -0.23)  # units of the driver coordinate: starts of a cycle that are tried

TraceEnd = Literal["reached", "limit", "lost", "boundary"]


class BranchFollower:
    """Follows the branch of assemblies of one group along the driver coordinate.

    Args:
        kernel: solver of the group.
        source: function that returns the states of the links on which the group depends.
        scale: unit of the driver coordinate.
    """

    def __init__(self, kernel: NewtonSolver, source: Source, scale: float = 1.0) -> None:
        self.kernel, self.source, self.scale = kernel, source, scale
        self.corrector = Corrector(kernel, source)
        self.at = 0.0
        self.crossings = CrossingFinder(kernel, source, self.corrector.node, scale)

    def trace(self, start: BranchNode, end: float) -> tuple[list[BranchNode], TraceEnd]:
        """Follow the group from the node `start` to the driver coordinate `end`.

        Returns:
            The nodes, and the reason for stopping: "reached" (at `end`); "limit" (the last node is a limit of the
                driver); "boundary" (`end` is a dead position); "lost" (the group cannot be followed any further).
        """
        nodes: list[BranchNode] = []
        node, failures, largest = start, 0, 0.0
        distance = end - start.q
        least = LEAST_STEP * abs(distance)
        step, growth = FIRST_STEP * distance / np.pi, 1.0
        smooth = [node]  # the last nodes, found in steps that were not halved
        while node.q != end:
            largest = max(largest, abs(node.det))
            targets = places_ahead(node.q, end, step, growth, LARGEST_STEP * abs(distance) / np.pi)
            q, corrected = targets[0], self.corrector.step(smooth, targets)
            close = corrected is not None and corrected[1] < CORRECTION
            dead = (
                self.crossings.find_between([start, *nodes], corrected[0], largest)
                if corrected is not None and close
                else None
            )
            if dead is not None and abs(dead.q - end) < EDGE * self.scale:
                return nodes, "boundary"
            if dead is not None and (dead.q - end) * distance < 0:
                nodes.append(dead)
                node, step, failures = dead, FIRST_STEP * distance / np.pi, 0
                smooth = [node]
                continue
            if corrected is not None and close and corrected[0].side == node.side:
                growth = 1.6 if corrected[1] < CORRECTION / 8 else 1.0
                step *= growth
                node, failures = corrected[0], 0
                nodes.append(node)
                smooth.append(node)
                if self.spins(node):
                    return [*nodes, *self.nodes_at_infinity(node)], "lost"
                continue
            step = (q - node.q) / 2
            smooth = [node]
            failures += 1
            if failures % PATIENCE == 0 or abs(step) < least:
                limit = self.find_limit(node, float(np.sign(distance)))
                beside = abs(step) < least
                if limit is not None and (limit.q - end) * distance <= 0 and (beside or self.leads_to(node, limit)):
                    return [*nodes, limit], "limit"
            if abs(step) < least:
                lost = [*nodes, *self.nodes_at_infinity(node)]
                return lost, "boundary" if abs(end - node.q) < EDGE * self.scale else "lost"
        return nodes, "reached"

    def spins(self, node: BranchNode) -> bool:
        """Return True if links rotate so much faster than the driver that they cannot be followed."""
        return self.corrector.distance_from_home(node.state)[1] > SPUN * (1 + abs(node.q - self.at) / self.scale)

    def nodes_at_infinity(self, last: BranchNode) -> list[BranchNode]:
        """Return a node at the driver coordinate q* at which links recede to infinity or rotate infinitely far.

        A link that recedes is at a distance c/(q* - q) and moves with the velocity c/(q* - q)^2, from which q* follows.
        The same holds for angles.

        Returns:
            A list with the node; empty if no link recedes or rotates so far.
        """
        home = self.corrector.home or last.state
        if self.corrector.distance_from_home(last.state)[0] > FAR:
            far = (last.state.x - home.x).ravel()
            k = int(np.argmax(np.abs(far)))
            speed = (np.conj(far[k]) * last.first.x.ravel()[k]).real / abs(
                far[k]
            )  # the transverse part grows more slowly
            return [replace(last, q=last.q + float(abs(far[k]) / speed))]
        if self.spins(last):
            wound = (last.state.unwrapped - home.unwrapped).ravel()
            k = int(np.argmax(np.abs(wound)))
            return [replace(last, q=last.q + float(wound[k] / last.first.unwrapped.ravel()[k]))]
        return []

    def leads_to(self, node: BranchNode, limit: BranchNode) -> bool:
        """Return True if the limit lies on the branch of the node.

        Otherwise the limit belongs to another branch, which is separated from this one by a gap narrower than a step.
        """
        near = self.corrector.distance(node.state, limit.state) / 2
        share = np.sqrt(LEFT)[:, None]  # near a limit states vary as the square root of the distance
        starts = GroupState(
            *(
                end + share * (start - end)
                for start, end in ((node.state.x, limit.state.x), (node.state.unwrapped, limit.state.unwrapped))
            )
        )
        checked = self.corrector.nodes(limit.q + np.array(LEFT) * (node.q - limit.q), starts)
        return all(
            start is not None
            and start.side == node.side
            and self.corrector.distance(start.state, starts.part(slice(k, k + 1))) <= near
            for k, start in enumerate(checked)
        )

    def find_limit(self, last: BranchNode, sense: float) -> BranchNode | None:
        """Find the limit position of the driver ahead of a node, to the last bit; None if there is no limit nearby.

        At the limit the driver coordinate q has an extreme while the group keeps moving. Let X be the state of the
        group, X0 its state at the node, and l the direction of its motion there. The equations F(X, q) = 0 and l (X -
        X0) = s give q(s); the limit is the root of the derivative of q(s).

        sense: +1 to search at greater driver coordinates, -1 at smaller ones.
        """
        kernel = self.kernel
        if kernel.passive:
            return None
        with np.errstate(all="ignore"):
            direction = _to_unknowns(last.first, kernel.size) * sense * self.scale
            length = np.linalg.norm(direction)
            if not np.isfinite(length) or length == 0:
                return None
            line = direction / length

            def at(s: float, state: GroupState, q: float) -> tuple[GroupState, float, float] | None:
                for _ in range(15):
                    before = self.source(np.array([q]), 1)
                    if not before.placed[0]:
                        return None
                    everything = {**before.poses, **kernel.poses_of(state)}
                    matrix = self._bordered(everything, before, line)
                    ahead = float(
                        np.dot(line, _to_unknowns(state, kernel.size) - _to_unknowns(last.state, kernel.size))
                    )
                    right = np.concatenate([-kernel.residuals(everything, before.drives)[0], [s - ahead]])
                    step = solve(matrix, right)
                    if not np.all(np.isfinite(step)):
                        return None
                    state, q = state.moved(step[None, :-1], kernel.size), q + float(step[-1]) * self.scale
                    if np.max(np.abs(step)) < LAST_STEP:  # its square is less than rounding
                        break
                before = self.source(np.array([q]), 1)
                if not before.placed[0]:
                    return None
                everything = {**before.poses, **kernel.poses_of(state)}
                unit_step = np.zeros(len(line) + 1)
                unit_step[-1] = 1.0
                slope = solve(self._bordered(everything, before, line), unit_step)
                return state, q, float(slope[-1]) * sense

            good = at(0.0, last.state, last.q)
            if good is None or good[2] <= 0:
                return None
            low, high, best = 0.0, 1e-3, good
            while high < FARTHEST:
                point = at(high, best[0], best[1])
                if point is None:
                    return None
                if point[2] <= 0:
                    break
                low, best, high = high, point, 2 * high
            else:
                return None
            # false position; the slope at an end that is kept twice is halved (Illinois method)
            below, above, last_sign = best[2], point[2], 0.0
            for _ in range(HALVINGS):
                middle = low + (high - low) * below / (below - above)
                if not low < middle < high:
                    middle = (low + high) / 2
                point = at(middle, best[0], best[1])
                if point is None or middle in (low, high):
                    break
                sign = float(np.sign(point[2]))
                if point[2] > 0:
                    low, best, below, above = middle, point, point[2], above / (2 if sign == last_sign else 1)
                else:
                    high, above, below = middle, point[2], below / (2 if sign == last_sign else 1)
                last_sign = sign
                if high - low < 4 * np.finfo(float).eps * high or point[2] == 0:
                    break
        state, q, _ = best
        if (q - last.q) * sense < 0 or abs(q - last.q) > AHEAD * self.scale:
            return None
        return BranchNode(q, state, last.first, last.second, 0.0, last.side)

    def _bordered(self, everything: dict[str, Pose], before: LinkStates, line: Real) -> Real:
        kernel = self.kernel
        by_q = kernel.known(everything, {n: (r.v, r.w) for n, r in before.first.items()})[0]
        by_q = by_q - kernel.asked(before.drives, 1, (1,))[0]
        n = len(line)
        matrix = np.zeros((n + 1, n + 1))
        matrix[:n, :n] = kernel.matrix(everything)[0]
        matrix[:n, n] = by_q * self.scale
        matrix[n, :n] = line
        return matrix

    def follow(self, at: float, state: GroupState, half: float, turns: bool) -> BranchTrace | None:
        """Trace the group from the driver coordinate of the sketch in both directions.

        If the driver rotates, the group is traced for several turns until it returns to its first state, which closes
        the trace.

        Args:
            at: driver coordinate of the sketch.
            state: state of the group there.
            half: half the range, or half a cycle, of the driver.
            turns: True if the driver rotates.

        Returns:
            The trace; None if the equations have no solution at `at`.
        """
        self.corrector.home, self.at = state, at
        start = self.corrector.node(at, state)
        if start is None:
            return None
        middle = start[0]
        for shift in SHIFTS if turns else (0.0,):  # a cycle may start anywhere except in a dead position
            first, last = at - half + shift * self.scale, at + half + shift * self.scale
            up, above = self.trace(middle, last)
            down, below = self.trace(middle, first)
            whole = [*reversed(down), middle, *up]
            ends = [node for node, how in ((whole[0], below), (whole[-1], above)) if how == "reached"]
            if "boundary" not in (above, below) and all(is_far_from_dead(end, whole) for end in ends):
                break
        nodes = whole
        if turns and above == below == "reached" and self.corrector.returned(nodes[0].state, nodes[-1].state):
            return _make_trace(nodes)
        for turn in range(1, TURNS):  # a group that never returns reaches a limit on both sides sooner or later
            if turns and above == "reached":
                more, above = self.trace(nodes[-1], last + 2 * half * turn)
                nodes += more
                if above == below == "reached" and self.corrector.returned(nodes[0].state, nodes[-1].state):
                    return _make_trace(nodes)
        for turn in range(1, TURNS):
            if turns and below == "reached" and above != "reached":
                more, below = self.trace(nodes[0], first - 2 * half * turn)
                nodes = [*reversed(more), *nodes]
        return _make_trace(nodes, (below, above))


def _to_unknowns(state: GroupState, size: float) -> Real:
    """Convert a state to the vector of the unknowns (x, y and angle of each link; lengths divided by `size`)."""
    return np.stack([state.x[0].real / size, state.x[0].imag / size, state.unwrapped[0]], axis=-1).ravel()


def _make_trace(nodes: list[BranchNode], ends: tuple[TraceEnd, TraceEnd] | None = None) -> BranchTrace:
    """Make a trace of nodes with increasing driver coordinates.

    ends: reasons why tracing stopped at the lower and at the upper end (see `BranchFollower.trace`); None if the trace
    is closed.
    """

    def ended(*ways: TraceEnd) -> tuple[bool, bool]:
        return (ends[0] in ways, ends[1] in ways) if ends else (False, False)

    states, first, second = (
        join_states(getattr(node, field) for node in nodes) for field in ("state", "first", "second")
    )
    dead = np.array([n.q for n in nodes if n.dead])
    flips = np.array([n.flips for n in nodes if n.dead], dtype=bool)
    return BranchTrace(
        np.array([n.q for n in nodes]),
        states,
        first,
        second,
        ends is None,
        ended("reached"),
        ended("limit"),
        ended("lost", "boundary"),
        dead=dead,
        flips=flips,
    )
