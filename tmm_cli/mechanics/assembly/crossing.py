"""Dead positions that a group passes smoothly: change points, where two branches of assemblies cross.

At a distance h from such a point Newton's method determines a state only to roundoff/h, and at the point itself it
fails. The smooth branch is therefore sampled at some distance on both sides. Polynomials through the samples give the
state and the point, which is a root of the determinant. E. L. Allgower, K. Georg, Introduction to Numerical
Continuation Methods, ch. 8.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import Chebyshev

from tmm_cli.mechanics.assembly.corrector import (
    BranchNode,
    Source,
    join_states,
    predict_state,
    state_components,
    states_from_components,
)
from tmm_cli.mechanics.groups import GroupState, NewtonSolver
from tmm_cli.mechanics.numerics import (
    CROSSING_AGREES,
    CROSSING_FITTED,
    CROSSING_KNOWN,
    CROSSING_ROUNDED,
    LAST_STEP,
    NO_DETERMINANT,
    SAMPLES_ROUNDED,
    Real,
    to_double_double,
    to_float,
)

RADII = (0.2, 0.1, 0.05, 0.025, 0.012, 0.005)  # distances of the samples, in units of the driver coordinate
SAMPLES = 28  # Chebyshev nodes, including those in the middle
MIDDLE = 0.2  # fraction of the radius: samples nearer to the middle are omitted
DEGREES = (10, 13)  # of two polynomials, whose roots must agree
PROBES = (
    1e-3,
    1e-4,
    1e-5,
    1e-6,
)  # units of the driver coordinate; for a determinant that falls as h^2 only the first two
FOUND = 0.02  # sizes of the group, rad: largest correction of a predicted state
ROUNDS = 12  # iterations for a root
SMALL = 0.3  # fraction of the largest determinant, below which it may touch zero
AHEAD = 1e-5  # units of the driver coordinate, step for the slope of the determinant
CLOSER = 10  # factor: a dead position that was not found is searched again from a distance smaller by it
EDGE = 1e-3  # units of the driver coordinate: a dead position this near to an end of the range is at the end


Correct = Callable[[float, GroupState], "tuple[BranchNode, float] | None"]
Finest = Callable[[list[BranchNode]], list[BranchNode]]


@dataclass(frozen=True)
class _Fit:
    """Polynomials in t = (q - middle)/radius that approximate a branch near a dead position.

    They are fitted to the states of the group and to the determinant of its equations.
    """

    middle: float
    radius: float
    parts: tuple[Chebyshev, ...]
    det: Chebyshev

    def state(self, q: float, order: int = 0) -> GroupState:
        """Return the fitted state at q, or its derivative of this order with respect to q."""
        t = (q - self.middle) / self.radius
        components = (
            np.array([(polynomial.deriv(order) if order else polynomial)(t) for polynomial in self.parts])
            / self.radius**order
        )
        return states_from_components(components[None, :])


class CrossingFinder:
    """Finds the dead positions that one group passes smoothly, while its branch is followed.

    Args:
        kernel: solver of the group.
        source: function that returns the states of the known links.
        correct: function that solves the group at a driver coordinate from an initial guess.
        scale: unit of the driver coordinate.
    """

    def __init__(self, kernel: NewtonSolver, source: Source, correct: Correct, scale: float) -> None:
        self.kernel, self.source, self.correct, self.scale = kernel, source, correct, scale
        self.refused: list[tuple[float, float]] = []

    def find_between(self, nodes: list[BranchNode], beyond: BranchNode, largest: float) -> BranchNode | None:
        """Find a dead position that the group passes smoothly between the last of `nodes` and the node `beyond`.

        largest: largest determinant found on the branch so far.

        Returns:
            The dead position, or None.
        """
        node = nodes[-1]
        if self.kernel.passive or node.dead:
            return None
        if beyond.side == node.side and not self._touches_zero(node, beyond, largest):
            return None
        middle, span = (node.q + beyond.q) / 2, abs(beyond.q - node.q)
        if any(abs(middle - q) < 2 * old and span > old / CLOSER for q, old in self.refused):
            return None
        crossing = find_crossing(self.correct, self._refine_nodes, nodes, beyond, self.scale)
        if crossing is None or (crossing.q - node.q) * (beyond.q - node.q) <= 0:
            self.refused.append((middle, span))
            return None
        return crossing

    def _refine_nodes(self, nodes: list[BranchNode]) -> list[BranchNode]:
        """Solve the group at the nodes again in double-doubles, and round the results to float64."""
        kernel = self.kernel
        before = self.source(to_double_double([n.q for n in nodes]), 0)
        states = join_states(n.state for n in nodes)
        with np.errstate(all="ignore"):
            states, step_size = kernel.close(
                GroupState(to_double_double(states.x), to_double_double(states.unwrapped)), before.poses, before.drives
            )
            det = np.linalg.det(to_float(kernel.matrix({**before.poses, **kernel.poses_of(states)})))
        states = GroupState(to_float(states.x), to_float(states.unwrapped))
        return [
            replace(n, state=states.part(slice(k, k + 1)), det=float(det[k])) if step_size[k] < LAST_STEP else n
            for k, n in enumerate(nodes)
        ]

    def _touches_zero(self, node: BranchNode, beyond: BranchNode, largest: float) -> bool:
        """Return True if the determinant seems to touch zero between two nodes without changing sign.

        It then falls as the square of the distance from its zero. From each node, the zero is therefore twice as far as
        the point at which the tangent is zero.
        """
        if max(abs(node.det), abs(beyond.det)) > SMALL * largest:
            return False
        distance, middle = beyond.q - node.q, (node.q + beyond.q) / 2
        with np.errstate(all="ignore"):
            ends = [n.q - 2 * n.det / self._slope(n) for n in (node, beyond)]
        return all(abs(end - middle) < abs(distance) for end in ends)

    def _slope(self, node: BranchNode) -> np.float64:
        """Return the approximate derivative of the determinant with respect to q at a node."""
        step = AHEAD * self.scale
        before, state = self.source(np.array([node.q + step]), 0), predict_state(node, node.q + step)
        moved = np.linalg.det(self.kernel.matrix({**before.poses, **self.kernel.poses_of(state)}))
        return np.float64(moved[0] - node.det) / step


def is_far_from_dead(end: BranchNode, nodes: list[BranchNode]) -> bool:
    """Return True if a node is not close to a dead position, judged by the determinants of all nodes."""
    return abs(end.det) > 2 * EDGE * max(abs(n.det) for n in nodes)


def find_crossing(
    correct: Correct, finest: Finest, nodes: list[BranchNode], beyond: BranchNode, scale: float
) -> BranchNode | None:
    """Find the dead position between the last node and the node beyond it.

    Args:
        correct: function that solves the group at q from an initial guess and returns the node and its distance from
            the guess.
        finest: function that solves nodes in extended precision.
        nodes: nodes before the dead position.
        beyond: the next node.
        scale: unit of the driver coordinate.

    Returns:
        The dead position; None if the branch does not pass it smoothly.
    """
    flips = beyond.side != nodes[-1].side
    about = _bracket_crossing(correct, nodes[-1], beyond) if flips else (nodes[-1].q + beyond.q) / 2
    best, error = None, CROSSING_KNOWN * scale
    for radius in RADII:
        fitted = _fit_crossing(correct, finest, nodes, about, radius * scale, flips)
        if fitted is None:
            continue
        dead, uncertainty, fit = fitted
        uncertainty += scale * SAMPLES_ROUNDED / (MIDDLE * radius) ** (1 if flips else 2)
        if not uncertainty < error:
            continue
        if not _is_passed_smoothly(correct, dead, fit, scale):
            return None
        best, error = dead, uncertainty
        if error < CROSSING_AGREES * scale:
            break
    return best


def _bracket_crossing(correct: Correct, low: BranchNode, high: BranchNode) -> float:
    """Estimate the root of the determinant between two nodes by false position.

    The search stops early where Newton's method no longer converges.
    """
    for _ in range(ROUNDS):
        q = low.q + (high.q - low.q) * low.det / (low.det - high.det)
        near = low if abs(q - low.q) < abs(high.q - q) else high
        corrected = correct(q, predict_state(near, q))
        if corrected is None or corrected[1] > FOUND:
            return q
        if corrected[0].side == low.side:
            low = corrected[0]
        else:
            high = corrected[0]
    return low.q + (high.q - low.q) * low.det / (low.det - high.det)


def _fit_crossing(
    correct: Correct, finest: Finest, nodes: list[BranchNode], about: float, radius: float, flips: bool
) -> tuple[BranchNode, float, _Fit] | None:
    """Locate a dead position from samples within `radius` of an estimate.

    Returns:
        The dead position, its uncertainty, and the fitted polynomials; None if the samples do not determine it.
    """
    for _ in range(3):
        samples = _sample_branch(correct, nodes, about, radius, flips)
        if samples is None:
            return None
        roots = [_root(_fit_samples(samples, about, radius, degree), flips) for degree in DEGREES]
        if not all(abs(root) < 1 for root in roots):
            return None
        if abs(roots[-1]) < MIDDLE / 4:
            break
        about += radius * roots[-1]
    else:
        return None
    samples = finest(samples)
    fits = [_fit_samples(samples, about, radius, degree) for degree in DEGREES]
    roots, fit = [_root(each, flips) for each in fits], fits[-1]
    if abs(fit.det(roots[-1])) > NO_DETERMINANT * max(abs(s.det) for s in samples):
        return None
    side = -nodes[-1].side if flips else nodes[-1].side
    q = about + radius * roots[-1]
    state, first, second = (fit.state(q, order) for order in range(3))
    return BranchNode(q, state, first, second, 0.0, side, True, flips), radius * abs(roots[0] - roots[1]), fit


def _sample_branch(
    correct: Correct, nodes: list[BranchNode], about: float, radius: float, flips: bool
) -> list[BranchNode] | None:
    """Solve the group at driver coordinates on both sides of a point; None if it cannot be solved at one of them.

    The initial guess of the first sample beyond the point is extrapolated from the samples before it.
    """
    sense = np.sign(about - nodes[-1].q)
    nodes_t = np.cos(np.pi * (np.arange(SAMPLES) + 0.5) / SAMPLES)
    nodes_t = nodes_t[np.abs(nodes_t) > MIDDLE]
    before = [about + sense * radius * t for t in nodes_t if t < 0]
    after = sorted((about + sense * radius * t for t in nodes_t if t > 0), key=lambda q: abs(q - about))
    last = max((k for k, n in enumerate(nodes) if n.dead), default=0)
    far = [n for n in nodes[last:] if abs(n.q - about) > MIDDLE * radius]
    start = min(far or nodes[-1:], key=lambda n: abs(n.q - before[0]))
    samples_before = _correct_along(correct, start, sorted(before, key=lambda q: abs(q - start.q)), nodes[-1].side)
    if samples_before is None:
        return None
    reaching = _fit_samples(samples_before, about, radius, len(samples_before) - 4)
    first = correct(after[0], reaching.state(after[0]))
    side = -nodes[-1].side if flips else nodes[-1].side
    if first is None or first[1] > FOUND or first[0].side != side:
        return None
    samples_beyond = _correct_along(correct, first[0], after[1:], side)
    return None if samples_beyond is None else sorted([*samples_before, first[0], *samples_beyond], key=lambda n: n.q)


def _correct_along(
    correct: Correct, start: BranchNode, coordinates: list[float], side: float
) -> list[BranchNode] | None:
    samples: list[BranchNode] = []
    for q in coordinates:
        nodes = [start, *samples]
        near = nodes[int(np.argmin([abs(n.q - q) for n in nodes]))]
        corrected = correct(q, predict_state(near, q))
        if corrected is None or corrected[1] > FOUND or corrected[0].side != side:
            return None
        samples.append(corrected[0])
    return samples


def _fit_samples(samples: list[BranchNode], about: float, radius: float, degree: int) -> _Fit:
    t = np.array([(n.q - about) / radius for n in samples])
    parts = np.array([state_components(n.state) for n in samples])
    dets = np.array([n.det for n in samples])

    def fit(values: Real) -> Chebyshev:
        return Chebyshev.fit(t, values, degree, domain=[-1, 1])

    return _Fit(about, radius, tuple(fit(column) for column in parts.T), fit(dets))


def _root(fit: _Fit, flips: bool) -> float:
    """Return the root of the fitted determinant, or its extreme if it does not change sign."""
    function = fit.det if flips else fit.det.deriv()
    slope = function.deriv()
    t = 0.0
    for _ in range(ROUNDS):
        t -= float(function(t) / slope(t))
        if not abs(t) < 2:
            return np.inf
    return t


def _is_passed_smoothly(correct: Correct, dead: BranchNode, fit: _Fit, scale: float) -> bool:
    """Return True if the group passes a dead position smoothly.

    Close to the dead position, on both sides, its solved states must agree with the fitted polynomials. If instead the
    branch turned back at a gap of any small width w, it would deviate from them by w^2/h at the distance h.
    """
    for h in PROBES if dead.flips else PROBES[:2]:
        probes = (dead.q - h * scale, dead.q + h * scale)
        corrected = [correct(q, fit.state(q)) for q in probes]
        most = CROSSING_FITTED + CROSSING_ROUNDED / h ** (1 if dead.flips else 2)
        if any(result is None or result[1] > most for result in corrected):
            return False
        low, high = (result[0].side for result in corrected if result is not None)
        if (low != high) != dead.flips:
            return False
    return True
