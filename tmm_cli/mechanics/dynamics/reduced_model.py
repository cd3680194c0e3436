"""Functions of the driver's way, as polynomials on panels: what is summed up along the way is exact to rounding.

Panels end where a function may jump or bend (ends of strokes, rows of a table), and are halved until the polynomials
have all digits; so a sum over a cycle needs a few hundred positions, not a fine grid. L. N. Trefethen, Approximation
Theory and Approximation Practice (2013), ch. 3 and 19.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev

from tmm_cli.mechanics.numerics import Real

NODES = 16  # of a panel
WIDEST_PANEL = np.pi / 6  # rad, and of a slider's way this share of pi: a panel at the beginning
TAIL = 1e-14  # of the largest value of a function: its last coefficients are less
MOST_HALVINGS = 12  # of halving: what still has a tail then has a jump within a panel
MOST_PANELS = 2000  # when so many still have tails, these are rounding errors
NODE_POINTS: Real = np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)[::-1]
VALUES_TO_COEFFICIENTS: Real = np.linalg.inv(
    chebyshev.chebvander(NODE_POINTS, NODES - 1)
)  # values at the nodes to coefficients
VALUES_TO_INTEGRALS: Real = chebyshev.chebvander(np.append(NODE_POINTS, 1.0), NODES) @ chebyshev.chebint(
    VALUES_TO_COEFFICIENTS, lbnd=-1
)
"""Values at the nodes of -1..1 to integrals from -1 to each node and, in the last row, to 1."""


@dataclass(frozen=True)
class PanelCurve:
    """A function on 0..length. edges: (panels + 1,); coefficients: (nodes, panels), of Chebyshev polynomials."""

    edges: Real
    coefficients: Real

    @property
    def length(self) -> float:
        return float(self.edges[-1])

    def __call__(self, x: Real) -> Real:
        """Its values; at an edge, where it may jump, those after it."""
        x = np.asarray(x, float)
        panel = np.clip(np.searchsorted(self.edges, x, side="right") - 1, 0, len(self.edges) - 2)
        low, high = self.edges[panel], self.edges[panel + 1]
        found: Real = chebyshev.chebval((2 * x - low - high) / (high - low), self.coefficients[:, panel], tensor=False)
        return found

    def slope(self) -> PanelCurve:
        """Its derivative, panel by panel."""
        return PanelCurve(self.edges, chebyshev.chebder(self.coefficients) / (np.diff(self.edges) / 2))

    def summed(self) -> PanelCurve:
        """Its integral from 0 on."""
        half = np.diff(self.edges) / 2
        own = chebyshev.chebint(self.coefficients, lbnd=-1) * half
        gone = np.concatenate([[0.0], np.cumsum(chebyshev.chebval(1.0, own))])
        own[0] += gone[:-1]
        return PanelCurve(self.edges, own)

    @property
    def total(self) -> float:
        """Its integral over all of its length."""
        own = chebyshev.chebval(1.0, chebyshev.chebint(self.coefficients, lbnd=-1))
        return float(np.sum(np.diff(self.edges) / 2 * own))

    def places(self) -> Real:
        """Places close together: both ends of each panel, just inside it, and its nodes."""
        return panel_nodes(self.edges, ends=True)


def panel_nodes(edges: Real, *, ends: bool = False) -> Real:
    """Places of the panels at which functions are fitted, in order; ends: with the ends of each, just inside it."""
    own = np.concatenate([[-1 + 1e-15], NODE_POINTS, [1 - 1e-15]]) if ends else NODE_POINTS
    low, high = edges[:-1, None], edges[1:, None]
    found: Real = ((low + high) / 2 + (high - low) / 2 * own).ravel()
    return found


def fit_curves(function: Callable[[Real], Sequence[Real]], edges: Sequence[float] | Real) -> tuple[PanelCurve, ...]:
    """Functions, computed together at many places x, on common panels; edges: where they may jump, both ends too.

    A value that is not finite stays so in its panel, which is not halved.
    """
    at = _divide_wide_panels(np.unique(np.asarray(edges, float)))
    values = _node_values(function, at)
    for _ in range(MOST_HALVINGS):
        rough = _rough_panels(values)
        if not rough.any() or len(rough) > MOST_PANELS:
            break
        middle = (at[:-1] + at[1:])[rough] / 2
        finer = np.sort(np.concatenate([at, middle]))
        kept = np.repeat(~rough, np.where(rough, 2, 1))
        new = _node_values(function, finer, ~kept)
        full = np.empty((len(values), NODES, len(finer) - 1))
        full[:, :, kept] = values[:, :, ~rough]
        full[:, :, ~kept] = new
        at, values = finer, full
    return tuple(PanelCurve(at, VALUES_TO_COEFFICIENTS @ own) for own in values)


def _divide_wide_panels(edges: Real) -> Real:
    """The same with panels that are not too wide."""
    parts = [
        np.linspace(low, high, int(np.ceil((high - low) / WIDEST_PANEL - 1e-9)) + 1)[:-1]
        for low, high in pairwise(edges)
    ]
    return np.concatenate([*parts, edges[-1:]])


def _node_values(function: Callable[[Real], Sequence[Real]], edges: Real, wanted: Real | None = None) -> Real:
    """(functions, nodes, panels), of all panels or of those wanted."""
    x = panel_nodes(edges).reshape(-1, NODES)
    x = x if wanted is None else x[wanted]
    return np.stack([np.asarray(part).reshape(x.shape).T for part in function(x.ravel())])


def _rough_panels(values: Real) -> Real:
    """Panels on which a function has a tail."""
    tails = np.abs(VALUES_TO_COEFFICIENTS[-2:] @ values).max(axis=1)
    sizes = np.nanmax(np.abs(values), axis=(1, 2), initial=0.0, where=np.isfinite(values))
    found: Real = np.any(tails > TAIL * NODES * sizes[:, None], axis=0)
    return found


# The machine reduced to its driver: inertia, its slope, and the moment of all loads, along the driver's way.
#
# I. I. Artobolevsky, Theory of Mechanisms and Machines (1988), ch. 15 and 16: T = J w^2 / 2, J w' + J' w^2 / 2 = M.


Sample = Callable[[Real], tuple[Real, Real, Real]]  # at ways x: inertia, its slope by x, moment of the loads


@dataclass(frozen=True)
class ReducedMachine:
    """Over a cycle, by the way x that the driver has gone in its sense (rad, or m of a slider).

    inertia (kg m2, or kg), slope of it by x, moment of all loads but inertia (N m, or N) along the sense, and work of
    these from the beginning on (J). With a slider as driver, speeds are m/s and moments forces.
    constant: the inertia of the links with a constant speed ratio to the driver, and of the driver itself; with a
    flywheel they are the first group of N. I. Mertsalov (kg m2).
    """

    inertia: PanelCurve
    slope: PanelCurve
    moment: PanelCurve
    work: PanelCurve
    constant: float = 0.0

    @property
    def work_of_cycle(self) -> float:
        """What the loads do in a cycle, J."""
        return self.moment.total

    @property
    def length(self) -> float:
        return self.inertia.length


def reduce_machine(sample: Sample, edges: Sequence[float], constant: float = 0.0) -> ReducedMachine:
    """Of a machine that can be computed at any place; edges: where loads may jump, the ends of the cycle too."""
    inertia, slope, moment = fit_curves(sample, edges)
    return ReducedMachine(inertia, slope, moment, moment.summed(), constant)
