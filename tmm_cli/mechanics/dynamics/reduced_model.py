"""The machine reduced to its driver: functions of the driver travel, represented by polynomials on panels.

Panels are intervals of the travel. They end where a function may jump or have a kink (ends of strokes, rows of a
table), and are halved until the polynomials have full precision. So an integral over a cycle is exact within rounding
with a few hundred positions. L. N. Trefethen, Approximation Theory and Approximation Practice (2013), ch. 3 and 19.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev

from tmm_cli.mechanics.numerics import Real

NODES = 16  # per panel
WIDEST_PANEL = np.pi / 6  # rad, or this fraction of pi of a slider range: initial panel width
TAIL = 1e-14  # of the largest value of a function: last coefficients of a resolved panel are smaller
MOST_HALVINGS = 12  # a panel that is still not resolved then contains a jump
MOST_PANELS = 2000  # with more unresolved panels the tails are rounding errors
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
    """Function on the interval from 0 to `length`, a separate polynomial on each of its panels (subintervals).

    Attributes:
        edges: ends of the panels, (panels + 1,).
        coefficients: Chebyshev coefficients on each panel, (nodes, panels).
    """

    edges: Real
    coefficients: Real

    @property
    def length(self) -> float:
        return float(self.edges[-1])

    def __call__(self, x: Real) -> Real:
        """Return the values of the function at x. At an edge, where it may jump, the value is the one after the
        jump.
        """
        x = np.asarray(x, float)
        panel = np.clip(np.searchsorted(self.edges, x, side="right") - 1, 0, len(self.edges) - 2)
        low, high = self.edges[panel], self.edges[panel + 1]
        heights: Real = chebyshev.chebval(
            (2 * x - low - high) / (high - low), self.coefficients[:, panel], tensor=False
        )
        return heights

    def slope(self) -> PanelCurve:
        """Return the derivative of the function."""
        return PanelCurve(self.edges, chebyshev.chebder(self.coefficients) / (np.diff(self.edges) / 2))

    def integrate(self) -> PanelCurve:
        """Return the integral of the function from 0 to x, as a function of x."""
        half = np.diff(self.edges) / 2
        integrals = chebyshev.chebint(self.coefficients, lbnd=-1) * half
        before = np.concatenate([[0.0], np.cumsum(chebyshev.chebval(1.0, integrals))])
        integrals[0] += before[:-1]
        return PanelCurve(self.edges, integrals)

    @property
    def total(self) -> float:
        """Integral of the function over its whole length."""
        integrals = chebyshev.chebval(1.0, chebyshev.chebint(self.coefficients, lbnd=-1))
        return float(np.sum(np.diff(self.edges) / 2 * integrals))

    def sample_points(self) -> Real:
        """Return closely spaced arguments: the nodes of each panel, and two points just inside its ends."""
        return panel_nodes(self.edges, ends=True)


def panel_nodes(edges: Real, *, ends: bool = False) -> Real:
    """Return the nodes of all panels in ascending order.

    edges: ends of the panels. ends: True to add two points just inside the ends of each panel.
    """
    points = np.concatenate([[-1 + 1e-15], NODE_POINTS, [1 - 1e-15]]) if ends else NODE_POINTS
    low, high = edges[:-1, None], edges[1:, None]
    nodes: Real = ((low + high) / 2 + (high - low) / 2 * points).ravel()
    return nodes


def fit_curves(function: Callable[[Real], Sequence[Real]], edges: Sequence[float] | Real) -> tuple[PanelCurve, ...]:
    """Approximate several functions by polynomials on common panels.

    A panel on which a value is not finite is not halved further.

    Args:
        function: returns the values of all functions at an array of arguments.
        edges: arguments at which the functions may jump, including both ends of the interval.
    """
    panel_edges = _divide_wide_panels(np.unique(np.asarray(edges, float)))
    values = _node_values(function, panel_edges)
    for _ in range(MOST_HALVINGS):
        rough = _rough_panels(values)
        if not rough.any() or len(rough) > MOST_PANELS:
            break
        middle = (panel_edges[:-1] + panel_edges[1:])[rough] / 2
        finer = np.sort(np.concatenate([panel_edges, middle]))
        kept = np.repeat(~rough, np.where(rough, 2, 1))
        new = _node_values(function, finer, ~kept)
        full = np.empty((len(values), NODES, len(finer) - 1))
        full[:, :, kept] = values[:, :, ~rough]
        full[:, :, ~kept] = new
        panel_edges, values = finer, full
    return tuple(PanelCurve(panel_edges, VALUES_TO_COEFFICIENTS @ node_values) for node_values in values)


def _divide_wide_panels(edges: Real) -> Real:
    """Divide panels wider than WIDEST_PANEL."""
    parts = [
        np.linspace(low, high, int(np.ceil((high - low) / WIDEST_PANEL - 1e-9)) + 1)[:-1]
        for low, high in pairwise(edges)
    ]
    return np.concatenate([*parts, edges[-1:]])


def _node_values(function: Callable[[Real], Sequence[Real]], edges: Real, selected: Real | None = None) -> Real:
    """Evaluate the functions at the nodes of all panels, or of the selected ones, (functions, nodes, panels)."""
    x = panel_nodes(edges).reshape(-1, NODES)
    x = x if selected is None else x[selected]
    return np.stack([np.asarray(function_values).reshape(x.shape).T for function_values in function(x.ravel())])


def _rough_panels(values: Real) -> Real:
    """Return True for each panel on which some function needs a polynomial of higher degree.

    This is judged by the size of its last coefficients.
    """
    tails = np.abs(VALUES_TO_COEFFICIENTS[-2:] @ values).max(axis=1)
    sizes = np.nanmax(np.abs(values), axis=(1, 2), initial=0.0, where=np.isfinite(values))
    rough: Real = np.any(tails > TAIL * NODES * sizes[:, None], axis=0)
    return rough


# Machine reduced to its driver: inertia, its slope, and the moment of all loads as functions of the driver travel.
#
# I. I. Artobolevsky, Theory of Mechanisms and Machines (1988), ch. 15 and 16: T = J w^2 / 2, J w' + J' w^2 / 2 = M.


Sample = Callable[[Real], tuple[Real, Real, Real]]  # at travels x: inertia, its derivative, moment of the loads


@dataclass(frozen=True)
class ReducedMachine:
    """Machine reduced to its driver over a cycle, as functions of the driver travel x (rad, or m for a slider).

    For a slider as driver, inertias are masses (kg), moments are forces (N) and speeds are in m/s.

    Attributes:
        inertia: reduced inertia, kg m2.
        slope: its derivative with respect to x.
        moment: moment of all loads except inertia, positive in the sense of motion, N m.
        work: work of these loads from the beginning of the cycle, J.
        constant: inertia of the driver and of the links with a constant speed ratio to it, kg m2; together with
            the flywheel it is N. I. Mertsalov's first group.
    """

    inertia: PanelCurve
    slope: PanelCurve
    moment: PanelCurve
    work: PanelCurve
    constant: float = 0.0

    @property
    def work_of_cycle(self) -> float:
        """Work of the loads over a cycle, J."""
        return self.moment.total

    @property
    def length(self) -> float:
        return self.inertia.length


def reduce_machine(sample: Sample, edges: Sequence[float], constant: float = 0.0) -> ReducedMachine:
    """Build the reduced machine from a function that returns its inertia, the derivative of the inertia, and the
    load moment.

    edges: driver travels at which loads may jump, including both ends of the cycle.
    """
    inertia, slope, moment = fit_curves(sample, edges)
    return ReducedMachine(inertia, slope, moment, moment.integrate(), constant)
