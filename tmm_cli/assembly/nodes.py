"""Nodes of the way of a group: its states at places of the driver with their derivatives, and states between them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np

from tmm_cli.groups.sequence import LinkStates
from tmm_cli.groups.state import State
from tmm_cli.vectors import Real

Source = Callable[[Real, int], LinkStates]  # links placed before a group: at places, with derivatives of an order


@dataclass(frozen=True)
class Node:
    """A state of a group at a place q of the driver, its derivatives by q, and its determinant.

    side: the determinant's sign, in a dead position that which it has beyond it. dead: whether it is one, flips:
    whether the determinant changes its sign there.
    """

    q: float
    state: State
    first: State
    second: State
    det: float
    side: float
    dead: bool = False
    flips: bool = False


def joined(states: Iterable[State]) -> State:
    """Many states as one."""
    states = list(states)
    return State(np.concatenate([s.x for s in states]), np.concatenate([s.unwrapped for s in states]))


def predicted(node: Node, q: Real | float) -> State:
    """The state at places q from that of a node."""
    return ahead(node.state, node.first, node.second, (np.atleast_1d(q) - node.q)[:, None])


def ahead(state: State, first: State, second: State, step: Real) -> State:
    """States a step (rad or m) of the driver farther on, by their first and second derivatives."""
    return State(
        state.x + step * (first.x + step / 2 * second.x),
        state.unwrapped + step * (first.unwrapped + step / 2 * second.unwrapped),
    )


def extrapolated(nodes: list[Node], q: Real) -> State:
    """States at places q by the polynomial that has the states of some nodes and their first and second derivatives."""
    span, most = q[-1] - nodes[0].q, 3 * len(nodes)
    slope = np.diag(np.arange(1.0, most), 1)  # powers of t times this are their derivatives
    powers = np.vander([(n.q - q[0]) / span for n in nodes], most, increasing=True)
    given = [
        [parts_of(n.state) for n in nodes],
        [parts_of(n.first) for n in nodes],
        [parts_of(n.second) for n in nodes],
    ]
    matrix = np.concatenate([powers, powers @ slope, powers @ slope @ slope])
    found = np.linalg.solve(matrix, np.concatenate([np.array(part) * span**k for k, part in enumerate(given)]))
    return stated(np.vander((q - q[0]) / span, most, increasing=True) @ found)


def parts_of(state: State) -> Real:
    """The numbers of one state: x, y and angle of each link."""
    return np.concatenate([state.x[0].real, state.x[0].imag, state.unwrapped[0]])


def stated(parts: Real) -> State:
    """States of which these are the parts (states, parts)."""
    x, y, unwrapped = np.split(parts, 3, axis=-1)
    return State(x + 1j * y, unwrapped)
