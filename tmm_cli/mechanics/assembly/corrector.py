"""Nodes of a branch of assemblies, prediction of states between them, and correction by Newton's method."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.mechanics.groups import BranchTrace, GroupState, LinkStates, NewtonSolver
from tmm_cli.mechanics.numerics import CONVERGED, SAME_STATE, Real

Source = Callable[
    [Real, int], LinkStates
]  # states of the known links at driver coordinates, with derivatives up to an order


@dataclass(frozen=True)
class BranchNode:
    """State of a group at one driver coordinate.

    Attributes:
        q: driver coordinate (rad or m).
        state: state of the group.
        first, second: first and second derivatives of the state with respect to q.
        det: determinant of the equations of the group.
        side: sign of the determinant; in a dead position, its sign just beyond that position.
        dead: True in a dead position.
        flips: True if the determinant changes sign in this dead position.
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
    """Concatenate states along the first axis."""
    states = list(states)
    return GroupState(np.concatenate([s.x for s in states]), np.concatenate([s.unwrapped for s in states]))


def predict_state(node: BranchNode, q: Real | float) -> GroupState:
    """Predict the states at driver coordinates q from the derivatives at a node."""
    return taylor_step(node.state, node.first, node.second, (np.atleast_1d(q) - node.q)[:, None])


def taylor_step(state: GroupState, first: GroupState, second: GroupState, step: Real) -> GroupState:
    """Predict states after a step of the driver (rad or m) from first and second derivatives."""
    return GroupState(
        state.x + step * (first.x + step / 2 * second.x),
        state.unwrapped + step * (first.unwrapped + step / 2 * second.unwrapped),
    )


def extrapolate_states(nodes: list[BranchNode], q: Real) -> GroupState:
    """Predict the states at driver coordinates q by a polynomial through several nodes.

    At each node the polynomial agrees with the state and its first and second derivatives.
    """
    span, most = q[-1] - nodes[0].q, 3 * len(nodes)
    slope = np.diag(np.arange(1.0, most), 1)  # differentiates powers of t
    powers = np.vander([(n.q - q[0]) / span for n in nodes], most, increasing=True)
    derivatives = [
        [state_components(n.state) for n in nodes],
        [state_components(n.first) for n in nodes],
        [state_components(n.second) for n in nodes],
    ]
    matrix = np.concatenate([powers, powers @ slope, powers @ slope @ slope])
    coefficients = np.linalg.solve(
        matrix, np.concatenate([np.array(values) * span**k for k, values in enumerate(derivatives)])
    )
    return states_from_components(np.vander((q - q[0]) / span, most, increasing=True) @ coefficients)


def state_components(state: GroupState) -> Real:
    """Convert one state to a vector of x, y and angle of all links."""
    return np.concatenate([state.x[0].real, state.x[0].imag, state.unwrapped[0]])


def states_from_components(parts: Real) -> GroupState:
    """Convert x, y and angle of all links, shape (states, 3 links), to states."""
    x, y, unwrapped = np.split(parts, 3, axis=-1)
    return GroupState(x + 1j * y, unwrapped)


# Correction of one group by Newton's method, at one or many driver coordinates.
#
# A call costs nearly the same for many coordinates as for one, so a step looks ahead.


FEW_ITERATIONS = 6  # of Newton's method: an initial guess that needs more is too far away
CORRECTION = 0.02  # largest correction of a predicted state (sizes of the group, rad)
MANY_TURNS = 50.0  # rad: links with larger rotations are followed in longer steps
PATIENCE = 4  # halved steps that are tried at once
MOST_AHEAD = 16  # driver coordinates
NODES = 4  # of an extrapolating polynomial


class Corrector:
    """Corrects predicted states of one group, at one or many driver coordinates, by Newton's method.

    Attributes:
        kernel: solver of the group.
        source: function that returns the states of the links on which the group depends.
        home: first state of the branch.
        near: nodes found by single steps. The keys are pairs: driver coordinate before the step, and after it.
        far: nodes predicted by a polynomial, by driver coordinate.
    """

    def __init__(self, kernel: NewtonSolver, source: Source) -> None:
        self.kernel, self.source = kernel, source
        self.home: GroupState | None = None
        self.near: dict[
            tuple[float, float], BranchNode | None
        ] = {}  # found by single steps from one coordinate to another
        self.far: dict[float, BranchNode | None] = {}  # found by a polynomial

    def node(self, q: float, start: GroupState) -> tuple[BranchNode, float] | None:
        """Solve the group at q from an initial guess.

        Returns:
            The node and its distance from the guess; None if there is no solution.
        """
        corrected = self.nodes(np.array([q]), start)[0]
        return None if corrected is None else (corrected, self.distance(corrected.state, start))

    def nodes(self, q: Real, start: GroupState) -> list[BranchNode | None]:
        """Solve the group at many driver coordinates at once, each from its own initial guess.

        Returns:
            One node for each driver coordinate; None where there is no solution.
        """
        corrected = self.motion(q, start)
        if corrected is None:
            return [None] * len(q)
        *motion, det, sound = corrected

        def one(k: int) -> BranchNode:
            state, first, second = (states.part(slice(k, k + 1)) for states in motion)
            return BranchNode(float(q[k]), state, first, second, float(det[k]), float(np.sign(det[k])))

        return [one(k) if sound[k] else None for k in range(len(q))]

    def motion(self, q: Real, start: GroupState) -> tuple[GroupState, GroupState, GroupState, Real, Real] | None:
        """Solve the group at many driver coordinates at once, with derivatives.

        Returns:
            States, first and second derivatives, determinants, and True where all these are valid; None if they are
                valid nowhere.
        """
        before = self.source(q, 2)
        if not np.any(before.placed):
            return None
        kernel = self.kernel
        with np.errstate(all="ignore"):
            state, step_size = kernel.close(start, before.poses, before.drives, FEW_ITERATIONS)
            sound = before.placed & (step_size < CONVERGED)
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

    def step(self, smooth: list[BranchNode], targets: list[float]) -> tuple[BranchNode, float] | None:
        """Solve the group at the next driver coordinate of a branch.

        Solving at many driver coordinates costs little more than at one. Two kinds of coordinates are therefore solved
        in advance, and their results kept for the next steps: those of smaller steps, in case this step fails, and
        those of later steps, which are predicted by a polynomial through the nodes in `smooth`. The number of the
        latter grows as long as the predictions are correct. Their results are used only if a single step confirms them;
        if it does not, only the last node is left in `smooth`.

        Args:
            smooth: last nodes on a smooth branch.
            targets: the next driver coordinate, and those that may follow it.

        Returns:
            The node at targets[0], and the distance of its state from the one predicted by the last node; None if there
                is no solution.
        """
        node, q = smooth[-1], targets[0]
        start = predict_state(node, q)
        predicted = self.far.get(q)
        if predicted is not None and (apart := self.distance(predicted.state, start)) < CORRECTION:
            return predicted, apart
        if (node.q, q) not in self.near:
            if q in self.far:  # the prediction of the polynomial failed
                smooth[:-1] = []
            targets = targets[: max(1, len(smooth) - 1)]
            halves = [q]
            for _ in range(PATIENCE - 1):
                halves.append(node.q + (halves[-1] - node.q) / 2)
            starts = [predict_state(node, np.array(halves))]
            if len(targets) > 1:
                starts.append(extrapolate_states(smooth[-NODES:], np.array(targets[1:])))
            corrected = self.nodes(np.array([*halves, *targets[1:]]), join_states(starts))
            self.near = dict(zip(((node.q, half) for half in halves), corrected, strict=False))
            self.far = dict(zip(targets[1:], corrected[PATIENCE:], strict=True))
        predicted = self.near[node.q, q]
        return None if predicted is None else (predicted, self.distance(predicted.state, start))

    def distance(self, state: GroupState, other: GroupState) -> float:
        """Return the greatest difference between two states: lengths divided by the size of the group, angles in rad.

        If links have moved far from the first state, or have rotated many turns, the differences are reduced in
        proportion.
        """
        away, wound = self.distance_from_home(state)
        return float(
            max(
                np.max(np.abs(state.x - other.x)) / (self.kernel.size * max(1.0, away)),
                np.max(np.abs(state.unwrapped - other.unwrapped)) / max(1.0, wound / MANY_TURNS),
            )
        )

    def returned(self, state: GroupState, other: GroupState) -> bool:
        """Return True if two states differ only by full turns of links."""
        around = (other.unwrapped - state.unwrapped) / (2 * np.pi)
        same = GroupState(other.x, state.unwrapped + (around - np.round(around)) * 2 * np.pi)
        return self.distance(state, same) < SAME_STATE

    def distance_from_home(self, state: GroupState) -> tuple[float, float]:
        """Return how far the group is from its first state.

        As guides become parallel, links recede and gears on them rotate without limit; larger steps are then accepted.

        Returns:
            Distance of the farthest link (sizes of the group) and the largest rotation (rad).
        """
        home = self.home or state
        return (
            float(np.max(np.abs(state.x - home.x))) / self.kernel.size,
            float(np.max(np.abs(state.unwrapped - home.unwrapped))),
        )


def places_ahead(q: float, end: float, step: float, growth: float, largest: float) -> list[float]:
    """Return the driver coordinates of the next steps up to `end`, at most MOST_AHEAD of them.

    Args:
        q: present driver coordinate.
        end: driver coordinate at which the steps end.
        step: first step.
        growth: ratio of each step to the one before.
        largest: largest step.
    """
    coordinates: list[float] = []
    while q != end and len(coordinates) < MOST_AHEAD:
        step = np.sign(step) * min(abs(step), largest)
        q = end if abs(end - q) <= abs(step) * (1 + 1e-9) else float(q + step)
        coordinates.append(q)
        step *= growth
    return coordinates


# A group whose lengths differ little from those of a traced one: all nodes of its cycle are corrected at once.
#
# They must pass the tests of continuation: each node is where the derivatives of its neighbour lead, and no dead
# position lies between them.


NEARLY_DEAD = 0.05  # fraction of the largest determinant: below it nodes would have to be closer


def correct_trace(
    kernel: NewtonSolver, source: Source, trace: BranchTrace, at: float, state: GroupState
) -> BranchTrace | None:
    """Correct the trace of a linkage for another linkage with slightly different lengths.

    Args:
        kernel: solver of the group with the new lengths.
        source: function that returns the states of the links on which the group depends.
        trace: trace of the group with the old lengths.
        at: driver coordinate of the sketch.
        state: state of the group there, in the required assembly.

    Returns:
        The corrected trace; None if the group has to be traced anew.
    """
    sketch_node = np.flatnonzero(trace.q == at)
    if not trace.closed or trace.dead.size or not sketch_node.size or kernel.passive:
        return None
    corrector = Corrector(kernel, source)
    motion = corrector.motion(trace.q, trace.states)
    if motion is None:
        return None
    states, first, second, det, sound = motion
    but_last = slice(-1)
    led = taylor_step(states.part(but_last), first.part(but_last), second.part(but_last), np.diff(trace.q)[:, None])
    same_way = np.all(det * np.sign(det[0]) > NEARLY_DEAD * np.max(np.abs(det)))
    valid = (
        bool(np.all(sound) and same_way)
        and corrector.distance(led, states.part(slice(1, None))) < CORRECTION
        and corrector.returned(states.part(slice(1)), states.part(slice(-1, None)))
        and corrector.distance(GroupState(states.x[sketch_node], states.unwrapped[sketch_node]), state) < SAME_STATE
    )
    return replace(trace, states=states, first=first, second=second) if valid else None
