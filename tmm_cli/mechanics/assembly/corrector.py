"""Nodes of the way of a group: its states at places of the driver with their derivatives, and states between them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.mechanics.groups import BranchTrace, GroupState, LinkStates, NewtonSolver
from tmm_cli.mechanics.numerics import CONVERGED, SAME_STATE, Real

Source = Callable[[Real, int], LinkStates]  # links placed before a group: at places, with derivatives of an order


@dataclass(frozen=True)
class BranchNode:
    """A state of a group at a place q of the driver, its derivatives by q, and its determinant.

    side: the determinant's sign, in a dead position that which it has beyond it. dead: whether it is one, flips:
    whether the determinant changes its sign there.
    """

    q: float
    state: GroupState
    first: GroupState
    second: GroupState
    det: float
    side: float
    dead: bool = False
    flips: bool = False


def join_states(states: Iterable[GroupState]) -> GroupState:
    """Many states as one."""
    states = list(states)
    return GroupState(np.concatenate([s.x for s in states]), np.concatenate([s.unwrapped for s in states]))


def predict_state(node: BranchNode, q: Real | float) -> GroupState:
    """The state at places q from that of a node."""
    return taylor_step(node.state, node.first, node.second, (np.atleast_1d(q) - node.q)[:, None])


def taylor_step(state: GroupState, first: GroupState, second: GroupState, step: Real) -> GroupState:
    """States a step (rad or m) of the driver farther on, by their first and second derivatives."""
    return GroupState(
        state.x + step * (first.x + step / 2 * second.x),
        state.unwrapped + step * (first.unwrapped + step / 2 * second.unwrapped),
    )


def extrapolate_states(nodes: list[BranchNode], q: Real) -> GroupState:
    """States at places q by the polynomial that has the states of some nodes and their first and second derivatives."""
    span, most = q[-1] - nodes[0].q, 3 * len(nodes)
    slope = np.diag(np.arange(1.0, most), 1)  # powers of t times this are their derivatives
    powers = np.vander([(n.q - q[0]) / span for n in nodes], most, increasing=True)
    given = [
        [state_components(n.state) for n in nodes],
        [state_components(n.first) for n in nodes],
        [state_components(n.second) for n in nodes],
    ]
    matrix = np.concatenate([powers, powers @ slope, powers @ slope @ slope])
    found = np.linalg.solve(matrix, np.concatenate([np.array(part) * span**k for k, part in enumerate(given)]))
    return states_from_components(np.vander((q - q[0]) / span, most, increasing=True) @ found)


def state_components(state: GroupState) -> Real:
    """The numbers of one state: x, y and angle of each link."""
    return np.concatenate([state.x[0].real, state.x[0].imag, state.unwrapped[0]])


def states_from_components(parts: Real) -> GroupState:
    """States of which these are the parts (states, parts)."""
    x, y, unwrapped = np.split(parts, 3, axis=-1)
    return GroupState(x + 1j * y, unwrapped)


# One group corrected at places of the driver by Newton's method: at one of them, or at many at once.
#
# A call costs nearly the same for many places as for one, so a step along the way looks ahead.


FEW_ITERATIONS = 6  # rounds of Newton's method: more than that begin too far away
CORRECTION = 0.02  # a corrected step may be this far from the predicted one (sizes of the group, rad)
MANY_TURNS = 50.0  # rad: a link that has gone round so far is followed in longer steps
PATIENCE = 4  # halvings of a step that are tried at once
MOST_AHEAD = 16  # places
NODES = 4  # that a polynomial is laid through


class Corrector:
    """`source` gives the links that the group hangs on; home: where it began."""

    def __init__(self, kernel: NewtonSolver, source: Source) -> None:
        self.kernel, self.source = kernel, source
        self.home: GroupState | None = None
        self.near: dict[tuple[float, float], BranchNode | None] = {}  # found by single steps from a place to another
        self.far: dict[float, BranchNode | None] = {}  # found by a polynomial

    def node(self, q: float, start: GroupState) -> tuple[BranchNode, float] | None:
        """The group at q, from a start, and how far it is from it; None where there is nothing to be found."""
        found = self.nodes(np.array([q]), start)[0]
        return None if found is None else (found, self.apart(found.state, start))

    def nodes(self, q: Real, start: GroupState) -> list[BranchNode | None]:
        """The group at many places at once, each from a start of its own."""
        found = self.motion(q, start)
        if found is None:
            return [None] * len(q)
        *motion, det, sound = found

        def one(k: int) -> BranchNode:
            state, first, second = (part.part(slice(k, k + 1)) for part in motion)
            return BranchNode(float(q[k]), state, first, second, float(det[k]), float(np.sign(det[k])))

        return [one(k) if sound[k] else None for k in range(len(q))]

    def motion(self, q: Real, start: GroupState) -> tuple[GroupState, GroupState, GroupState, Real, Real] | None:
        """States at places, each from a start of its own, with first and second derivatives by q; determinants; where
        all that is sound. None where it is nowhere.
        """
        before = self.source(q, 2)
        if not np.any(before.placed):
            return None
        kernel = self.kernel
        with np.errstate(all="ignore"):
            state, size = kernel.close(start, before.poses, before.drives, FEW_ITERATIONS)
            sound = before.placed & (size < CONVERGED)
            if not np.any(sound):
                return None
            everything = {**before.poses, **kernel.poses_of(state)}
            if kernel.passive:
                sound &= np.max(np.abs(kernel.residuals(everything, before.drives)), axis=-1) <= CONVERGED
            matrix = kernel.matrix(everything)
            det = np.ones(len(q)) if kernel.passive else np.linalg.det(matrix)
            rates = kernel.rates_at(everything, matrix, det, before.first, before.drives)
            both = {**before.first, **dict(zip(kernel.group.links, rates, strict=True))}
            accels = kernel.accelerations_at(everything, matrix, det, both, before.second, before.drives)
        first = GroupState(np.stack([r.v for r in rates], -1), np.stack([r.w for r in rates], -1))
        second = GroupState(np.stack([a.a for a in accels], -1), np.stack([a.e for a in accels], -1))
        return state, first, second, det, sound

    def step(self, smooth: list[BranchNode], places: list[float]) -> tuple[BranchNode, float] | None:
        """The group at the first of some places, as `node` finds it from the last of some nodes on a smooth way.

        Many places are looked at at once: those of halved steps and, from a polynomial through the smooth nodes, as
        many of the others as it has led to so far. What is found is kept for the next steps, and that from the
        polynomial counts only where it is what a single step leads to; if not, `smooth` begins anew.
        """
        here, q = smooth[-1], places[0]
        start = predict_state(here, q)
        there = self.far.get(q)
        if there is not None and (apart := self.apart(there.state, start)) < CORRECTION:
            return there, apart
        if (here.q, q) not in self.near:
            if q in self.far:  # the polynomial did not lead there
                smooth[:-1] = []
            places = places[: max(1, len(smooth) - 1)]
            halves = [q]
            for _ in range(PATIENCE - 1):
                halves.append(here.q + (halves[-1] - here.q) / 2)
            starts = [predict_state(here, np.array(halves))]
            if len(places) > 1:
                starts.append(extrapolate_states(smooth[-NODES:], np.array(places[1:])))
            found = self.nodes(np.array([*halves, *places[1:]]), join_states(starts))
            self.near = dict(zip(((here.q, half) for half in halves), found, strict=False))
            self.far = dict(zip(places[1:], found[PATIENCE:], strict=True))
        there = self.near[here.q, q]
        return None if there is None else (there, self.apart(there.state, start))

    def apart(self, one: GroupState, other: GroupState) -> float:
        """How far two states are apart: lengths against the group's size, angles in rad."""
        away, wound = self.gone(one)
        return float(
            max(
                np.max(np.abs(one.x - other.x)) / (self.kernel.size * max(1.0, away)),
                np.max(np.abs(one.unwrapped - other.unwrapped)) / max(1.0, wound / MANY_TURNS),
            )
        )

    def returned(self, one: GroupState, other: GroupState) -> bool:
        """Whether two states are the same but for full turns."""
        around = (other.unwrapped - one.unwrapped) / (2 * np.pi)
        same = GroupState(other.x, one.unwrapped + (around - np.round(around)) * 2 * np.pi)
        return self.apart(one, same) < SAME_STATE

    def gone(self, state: GroupState) -> tuple[float, float]:
        """How far the group is from where it began: the farthest link (sizes of the group), the most turned one (rad).

        As guides become parallel links go away, and wheels on them round, for ever; steps grow with them then.
        """
        home = self.home or state
        return (
            float(np.max(np.abs(state.x - home.x))) / self.kernel.size,
            float(np.max(np.abs(state.unwrapped - home.unwrapped))),
        )


def places_ahead(q: float, end: float, step: float, growth: float, largest: float) -> list[float]:
    """Places up to `end` in steps that grow."""
    found: list[float] = []
    while q != end and len(found) < MOST_AHEAD:
        step = np.sign(step) * min(abs(step), largest)
        q = end if abs(end - q) <= abs(step) * (1 + 1e-9) else float(q + step)
        found.append(q)
        step *= growth
    return found


# A group whose lengths differ little from those of one that was followed: the nodes of its cycle found all at once.
#
# They have to pass the tests of nodes that are found one after another (continuation): each is where its neighbour's
# derivatives lead to, and no dead position lies between them.


NEARLY_DEAD = 0.05  # of the largest determinant: beside a dead position nodes have to lie closer


def correct_trace(
    kernel: NewtonSolver, source: Source, trace: BranchTrace, at: float, state: GroupState
) -> BranchTrace | None:
    """The trace of a group from that of its neighbour; None where the neighbour does not tell it.

    source: links placed before the group. state: the group at the driver's place `at`, in the assembly that is meant.
    """
    here = np.flatnonzero(trace.q == at)
    if not trace.closed or trace.dead.size or not here.size or kernel.passive:
        return None
    corrector = Corrector(kernel, source)
    motion = corrector.motion(trace.q, trace.states)
    if motion is None:
        return None
    states, first, second, det, sound = motion
    but_last = slice(-1)
    led = taylor_step(states.part(but_last), first.part(but_last), second.part(but_last), np.diff(trace.q)[:, None])
    same_way = np.all(det * np.sign(det[0]) > NEARLY_DEAD * np.max(np.abs(det)))
    found = (
        bool(np.all(sound) and same_way)
        and corrector.apart(led, states.part(slice(1, None))) < CORRECTION
        and corrector.returned(states.part(slice(1)), states.part(slice(-1, None)))
        and corrector.apart(GroupState(states.x[here], states.unwrapped[here]), state) < SAME_STATE
    )
    return replace(trace, states=states, first=first, second=second) if found else None
