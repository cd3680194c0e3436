"""Calculation of a sweep.

The points are solved in jobs, on one or more cores or on a cluster. Then the boundaries between states are located.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from tmm_cli.batch import JobRunner, run_here
from tmm_cli.language import _
from tmm_cli.mechanics.numerics import Real, bisect
from tmm_cli.problem import WORK_BUDGET, Problem, ProblemError, refuse_work, work_size
from tmm_cli.sweep.mechanisms import SweepPoints, SweptMechanisms
from tmm_cli.sweep.options import MOST_VALUES, SweepAxis, grid_points
from tmm_cli.sweep.results import STATES, Border, SweepResults
from tmm_cli.sweep.scan import SCAN
from tmm_cli.sweep.traced_stages import CYCLE

CHUNK, SINGLE_CHUNK = 20_000, 20  # points per job: by trace, one by one
TRACED_COST, SINGLE_COST = (
    1 / 1_200,
    1 / 4,
)  # what a part at a position costs, against a run of one file (problem.budget)
SEARCH_POSITIONS = 720  # extra positions of a point solved alone, for its range and strokes
HALVINGS = 46  # of a grid step, by trace: to the last digits
SINGLE_HALVINGS = (20, 4)  # of a grid step, one by one: with one parameter, with two


@dataclass(frozen=True, eq=False)
class BorderSearch:
    """Job that locates boundary points by bisection between pairs of points with different states.

    When called, it returns for each pair the last point that still has the state in `state`, the first point beyond the
    boundary, and the state and the reason at the latter.

    Attributes:
        mechanisms: the mechanisms of the sweep.
        inside: first point of each pair, which has the state in `state`, (pairs, parameters).
        outside: second point of each pair, which has another state, (pairs, parameters).
        state: state of each point in `inside`, (pairs,).
        halvings: number of bisection steps.
    """

    mechanisms: SweptMechanisms
    inside: Real
    outside: Real
    state: Real
    halvings: int

    def __call__(self) -> tuple[Real, Real, Real, list[str]]:
        def at(share: Real) -> Real:
            points: Real = self.inside + share[:, None] * (self.outside - self.inside)
            return points

        def holds(share: Real) -> Real:
            same_state: Real = self.mechanisms.at(at(share), values=False).state == self.state
            return same_state

        low, high = bisect(holds, np.zeros(len(self.state)), np.ones(len(self.state)), self.halvings)
        beyond = self.mechanisms.at(at(high), values=False)
        return at(low), at(high), beyond.state, beyond.why


def refuse_points(problem: Problem, points: int, *, peaks: bool, taped: bool, cores: int | None) -> None:
    """Refuse a sweep that would take longer than a minute on all cores.

    Args:
        problem: the problem of the file.
        points: number of points.
        peaks: True if the largest value of a quantity over the cycle is shown, which takes a search.
        taped: True if the points are computed by replaying a trace.
        cores: number of cores; None for a cluster.

    Raises:
        ProblemError: There are too many points.
    """
    refuse_work(problem.linkage, problem.request)
    positions = 2 * CYCLE if peaks else 0  # a scan, and finer grids about its peaks
    each = (
        work_size(problem.linkage)
        * (positions + (SCAN if taped else SEARCH_POSITIONS))
        * (TRACED_COST if taped else SINGLE_COST)
    )
    most = MOST_VALUES if cores is None else min(MOST_VALUES, int(WORK_BUDGET * cores / each))
    if points > most:
        raise ProblemError(
            _("too many mechanisms"),
            file="--over",
            found=_("number of mechanisms: {points}").format(points=points),
            allowed=_("at most {most}").format(most=most),
        )


def run_sweep(
    mechanisms: SweptMechanisms, runner: JobRunner = run_here, seen: Callable[[int], None] = lambda count: None
) -> SweepResults:
    """Solve all points of the grid and locate the boundaries between states.

    Args:
        mechanisms: the mechanisms and their grid.
        runner: runs the jobs, for example on several cores.
        seen: called with the number of points solved by each job.
    """
    axes, points = mechanisms.axes, grid_points(mechanisms.axes)
    taped = mechanisms.crank_variants is not None
    chunk_size = CHUNK if taped else SINGLE_CHUNK
    chunks = [points[first : first + chunk_size] for first in range(0, len(points), chunk_size)]
    by_chunk: dict[int, SweepPoints] = {}
    for number, solved in runner([partial(mechanisms.at, chunk) for chunk in chunks], lambda: False):
        by_chunk[number] = solved
        seen(len(solved.state))
    whole = [by_chunk[number] for number in range(len(chunks))]
    state = np.concatenate([solved.state for solved in whole])
    why = [text for solved in whole for text in solved.why]
    values = np.concatenate([solved.values for solved in whole])
    marks = _find_borders(mechanisms, _find_edges(axes, points, state, why), runner)
    reach = np.concatenate([solved.reach for solved in whole])
    of_loads = {
        name: reach[np.all(np.isfinite(reach[:, k]), axis=1), k].tolist() for k, name in enumerate(mechanisms.tables)
    }
    return SweepResults(axes, mechanisms.shown, points, state, why, values, marks, taped, of_loads)


@dataclass(frozen=True, eq=False)
class GridEdge:
    """Edge of the grid between two neighbouring points with different states.

    Attributes:
        along: index of the parameter that differs between the points.
        points: parameter values of both points.
        states: states at both points.
        why: for each point the exceeded limit, or the reason why there is no mechanism.
    """

    along: int
    points: tuple[Real, Real]
    states: tuple[int, int]
    why: tuple[str, str]


def _find_edges(axes: Sequence[SweepAxis], points: Real, state: Real, why: Sequence[str]) -> list[GridEdge]:
    """Return the grid edges whose ends have different states."""
    number = np.arange(len(points)).reshape([len(axis.values) for axis in axes])
    edges = []
    for along in range(len(axes)):
        lines = np.moveaxis(number, along, -1)
        before, after = lines[..., :-1].ravel(), lines[..., 1:].ravel()
        change = state[before] != state[after]
        for b, a in zip(before[change].tolist(), after[change].tolist(), strict=True):
            edges.append(GridEdge(along, (points[b], points[a]), (int(state[b]), int(state[a])), (why[b], why[a])))
    return edges


def _find_borders(mechanisms: SweptMechanisms, edges: Sequence[GridEdge], runner: JobRunner) -> tuple[Border, ...]:
    """Locate the boundary points on these grid edges; an edge may contain several."""
    taped = mechanisms.crank_variants is not None
    halvings = HALVINGS if taped else SINGLE_HALVINGS[len(mechanisms.axes) - 1]
    chunk_size = CHUNK if taped else max(1, SINGLE_CHUNK // halvings)
    borders: list[Border] = []
    for _round in STATES:
        work_size = [edges[first : first + chunk_size] for first in range(0, len(edges), chunk_size)]
        jobs = []
        for chunk in work_size:
            inside, outside = (np.array([edge.points[side] for edge in chunk]) for side in (0, 1))
            state = np.array([edge.states[0] for edge in chunk])
            jobs.append(BorderSearch(mechanisms, inside, outside, state, halvings))
        left: list[GridEdge] = []
        for k, (last, first, state, why) in runner(jobs, lambda: False):
            for n, edge in enumerate(work_size[k]):
                before, after = edge.states
                reached = after if int(state[n]) == before else int(state[n])  # what only the ordinary stages tell
                reason = (why[n] or edge.why[1]) if reached > before else edge.why[0]
                borders.append(Border(tuple(((last[n] + first[n]) / 2).tolist()), edge.along, before, reached, reason))
                if reached != after:
                    left.append(
                        GridEdge(edge.along, (first[n], edge.points[1]), (reached, after), (why[n], edge.why[1]))
                    )
        edges = left
    return tuple(sorted(borders, key=lambda mark: (mark.along, *mark.at[:: -1 if mark.along == 0 else 1])))
