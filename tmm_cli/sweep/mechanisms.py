"""States and quantities of the mechanisms at the points of a parameter grid.

If the calculation can be recorded as a trace, the trace is replayed for many points at once. Otherwise the points are
computed one by one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np

from tmm_cli.batch import DependsOnData, NotTraceableError, Task, compute_sketch
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Results, SolvedVariants, pipeline
from tmm_cli.mechanics.errors import AssemblyError, LinkageError
from tmm_cli.mechanics.forces import Reactions, table_lengths
from tmm_cli.mechanics.kinematics import Motion, Strokes
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import Real
from tmm_cli.problem import Problem, ProblemError, Tree, located_problem_error
from tmm_cli.sweep.options import PRESSURE, ShownQuantity, SweepAxis, read_shown
from tmm_cli.sweep.results import APART, LIMIT, REFUSED, STOPS, WORKS
from tmm_cli.sweep.scan import (
    SCAN_APART,
    SCAN_STOPS,
    SCAN_WORKS,
    ScanRequest,
    ScanResults,
    scan_variants,
    variant_strokes,
)
from tmm_cli.sweep.traced_stages import CYCLE, CrankVariants, curve_limit
from tmm_cli.synthesis import inputs_of, measures

MOST_DOUBTFUL = 200  # points of a traced job that are solved again one by one
BLOCK = 1_000  # variants at once: their scan stays in the cache


@dataclass(frozen=True, eq=False)
class SweepPoints:
    """Results at the points of a sweep.

    Attributes:
        state: state of the mechanism at each point, (points,).
        why: for each point the exceeded limit, or the reason why there is no mechanism, (points,).
        values: requested quantities, (points, quantities).
        reach: for each load given by a table: last argument of the table, and the stroke that the table must cover,
            (points,
            loads, 2), m or rad; nan if there is no table.
    """

    state: Real
    why: list[str]
    values: Real
    reach: Real


class SweptMechanisms:
    """Mechanisms of a problem file in which one or two parameters vary.

    Args:
        tree: content of the problem file.
        axes: parameters that vary, with their values.
        show: options `--show`, which name the requested quantities.

    Raises:
        ProblemError: The file itself does not define a mechanism, or a quantity does not exist.
    """

    def __init__(self, tree: Tree, axes: Sequence[SweepAxis], show: Sequence[str]) -> None:
        self.given = tree, tuple(axes), tuple(show)
        self.task, self.axes = Task(tree), tuple(axes)
        self.shown = read_shown(self.task, show)
        self.names = tuple(axis.name for axis in axes)
        self.dimensions = tuple(axis.dimension for axis in axes)
        self.factors = np.array([axis.factor for axis in axes])
        problem = self.task.problem.whole
        self.allowed = problem.pressure_limits
        self.tables = tuple(
            load.name
            for load in problem.linkage.loads
            if load.table is not None and load.table.against == "stroke" and not load.table.shares
        )

    def __reduce__(self) -> tuple[type[SweptMechanisms], tuple[Any, ...]]:
        """Pickle only the arguments of the constructor. Another process computes everything else again from them."""
        return SweptMechanisms, self.given

    @cached_property
    def crank_variants(self) -> CrankVariants | None:
        """Traced calculation for variants with a fully rotating crank; None if the problem cannot be traced."""
        problem = self.task.problem.whole
        if "synthesis" in self.task.tree.data or problem.dynamics is not None:
            return None
        file_numbers = [
            self.task.number(v, d) for v, d in zip(self.task.values_in_file(self.names), self.dimensions, strict=True)
        ]
        at_positions = [quantity for quantity in self.shown if not quantity.whole]

        def read(motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
            solved = SolvedVariants(motion.linkage, motion, reactions)
            return {quantity.name: quantity.at_positions(solved) for quantity in at_positions}

        try:
            crank_variants = CrankVariants(
                lambda numbers: self.task.make(self.names, self.dimensions, numbers),
                file_numbers,
                read,
                forces=any(quantity.forces for quantity in at_positions),
            )
            with np.errstate(all="ignore"):
                scanned = scan_variants(crank_variants, np.array([file_numbers]), ScanRequest())
            return crank_variants if scanned.does[0] == SCAN_WORKS and scanned.sure[0] else None
        except (NotTraceableError, DependsOnData):
            return None
        except LinkageError as error:
            raise located_problem_error(error, problem) from None

    @cached_property
    def limits(self) -> dict[str, float]:
        """Allowed value of each curve that has a limit (pressure angle, travel in a slot), by the name of the curve."""
        assert self.crank_variants is not None
        return {curve.name: curve_limit(curve, self.allowed) for curve in self.crank_variants.limited}

    @cached_property
    def file_completes_range(self) -> bool:
        """True if the driver completes its revolution or its whole stroke with the parameter values of the file."""
        return measures.completes_range(pipeline.solve(inputs_of(self.task.problem.whole), "kinematics"))

    def at(self, points: Real, *, values: bool = True) -> SweepPoints:
        """Solve the mechanisms at points of the grid.

        Args:
            points: parameter values in the units of the file, (points, parameters).
            values: False if only the states are needed, and not the quantities.
        """
        count = len(points)
        solved = SweepPoints(
            np.zeros(count, dtype=int),
            [""] * count,
            np.full((count, len(self.shown)), np.nan),
            np.full((count, len(self.tables), 2), np.nan),
        )
        if self.crank_variants is None:
            self._one_by_one(points, np.arange(count), solved)
            return solved
        parts = np.array_split(np.arange(count), -(-count // BLOCK))
        left = [self._solve_by_trace(points, indices, solved, values) for indices in parts]
        unsure, otherwise = (np.concatenate(rows) for rows in zip(*left, strict=True))
        for row in unsure[MOST_DOUBTFUL:]:
            solved.why[row] = _("the output link moves differently than in the problem file")
        for row in otherwise[MOST_DOUBTFUL:]:
            solved.state[row] = REFUSED
            solved.why[row] = _(
                "not computed: the structure of too many mechanisms differs from that of the mechanism in the file"
            )
        self._one_by_one(points, otherwise[:MOST_DOUBTFUL], solved)
        for row in unsure[:MOST_DOUBTFUL]:
            state, solved.why[row], solved.values[row], solved.reach[row] = self._solve_point(points[row])
            solved.state[row] = (
                solved.state[row] if state == REFUSED else state
            )  # it moves, but a required quantity is missing
        return solved

    def _one_by_one(self, points: Real, rows: Iterable[int], solved: SweepPoints) -> None:
        for row in rows:
            solved.state[row], solved.why[row], solved.values[row], solved.reach[row] = self._solve_point(points[row])

    def _solve_by_trace(self, points: Real, indices: Real, solved: SweepPoints, values: bool) -> tuple[Real, Real]:
        """Solve the points with these indices by replaying the trace, and store the results in `solved`.

        Returns:
            Indices of points whose result is uncertain, and indices of points whose linkage has another structure.
        """
        crank_variants, nothing = self.crank_variants, np.zeros(0, dtype=int)
        assert crank_variants is not None
        columns = points[indices] * self.factors
        with np.errstate(all="ignore"):
            try:
                varied, otherwise = crank_variants.varied(columns)
            except (ProblemError, DependsOnData):
                return nothing, indices
            scanned = scan_variants(
                crank_variants,
                columns,
                ScanRequest(self._shown_pressure_angles() if values else (), self.limits, values),
            )
            works = scanned.does == SCAN_WORKS
            solved.state[indices] = np.select([scanned.does == SCAN_STOPS, scanned.does == SCAN_APART], [STOPS, APART])
            for curve in crank_variants.limited:
                over = indices[works & (scanned.peaks[curve.name] > self.limits[curve.name])]
                for row in over[solved.state[over] == WORKS]:
                    solved.why[row] = f"{curve.kind} {curve.link}"
                solved.state[over] = LIMIT
            unsure = values & works & ~scanned.sure & ~otherwise
            rows = np.flatnonzero(works & scanned.sure & ~otherwise)
            if values and rows.size:
                whole = len(rows) == len(indices)
                kept = varied if whole else crank_variants.varied(columns[rows])[0]
                try:
                    solved.values[indices[rows]], solved.reach[indices[rows]] = self._read_traced_quantities(
                        columns[rows], scanned.take(rows), kept
                    )
                except NotTraceableError:
                    return indices, nothing
        return indices[unsure], indices[otherwise]

    def _shown_pressure_angles(self) -> list[str]:
        """Return the names of the pressure angles whose largest value is shown; empty if `--show` does not request it.

        These are the pressure angles on the output link. If the output has none, they are those on all driven links.
        """
        assert self.crank_variants is not None
        if not any(curve.name == PRESSURE for curve in self.shown):
            return []
        angles = [curve for curve in self.crank_variants.limited if curve.kind == "pressure"]
        return [curve.name for curve in angles if curve.link == self.crank_variants.output] or [
            curve.name for curve in angles
        ]

    def _read_traced_quantities(self, columns: Real, scanned: ScanResults, varied: Any) -> tuple[Real, Real]:
        """Return the requested quantities of feasible variants, and the strokes that load tables must cover.

        Returns:
            Quantities, (variants, quantities), and the result of `_load_table_reach`.
        """
        crank_variants = self.crank_variants
        assert crank_variants is not None
        strokes = variant_strokes(crank_variants, columns, scanned, varied)
        q, at = crank_variants.over_cycle(columns, strokes)
        at_positions = [quantity.name for quantity in self.shown if not quantity.whole]
        rows = np.arange(len(columns))
        over = at(rows, np.broadcast_to(q, (len(columns), len(q))), at_positions) if at_positions else {}
        table = np.full((len(columns), len(self.shown)), np.nan)
        for k, quantity in enumerate(self.shown):
            if quantity.name == PRESSURE:
                peaks = [scanned.peaks[name] for name in self._shown_pressure_angles()]
                table[:, k] = np.fmax.reduce(peaks) if peaks else np.nan
            elif quantity.quantity is not None and quantity.whole:
                table[:, k] = np.ravel(quantity.quantity.read(SolvedVariants(varied.linkage, strokes=strokes)))
            else:
                values = np.broadcast_to(over[quantity.name], (len(columns), len(q)))
                table[:, k] = quantity.over_cycle(_curve_reader(at, quantity.name), q, values)
        return table, self._load_table_reach(varied.linkage, strokes, len(columns))

    def _load_table_reach(self, linkage: Linkage, strokes: Strokes | None, count: int) -> Real:
        """Return the last argument of each load table against the stroke, and the stroke, (variants, loads, 2)."""
        reach = np.full((count, len(self.tables), 2), np.nan)
        for load, last, stroke in table_lengths(linkage, strokes):
            k = self.tables.index(load.name)
            reach[:, k, 0], reach[:, k, 1] = np.ravel(last), np.ravel(stroke)
        return reach

    def _solve_point(self, point: Real) -> tuple[int, str, Real, Real]:
        """Solve one point without the trace.

        Returns:
            State, reason, quantities and reach of the load tables, as in the fields of `SweepPoints`.
        """
        nothing = np.full(len(self.shown), np.nan), np.full((len(self.tables), 2), np.nan)
        texts = {axis.name: axis.text(float(value)) for axis, value in zip(self.axes, point, strict=True)}
        forces = any(check.forces for check in self.shown)
        try:
            problem = self._adopt_file_assembly(self.task.variant(texts).whole)
        except ProblemError as error:
            return REFUSED, error.message, *nothing
        try:
            results = pipeline.solve(inputs_of(problem), "forces" if forces else "kinematics", problem=problem)
        except LinkageError as error:
            state = APART if isinstance(error, AssemblyError) else REFUSED
            return state, located_problem_error(error, problem).message, *nothing
        if self.file_completes_range and not measures.completes_range(results):
            return STOPS, "", *nothing
        over = [f"pressure {check.link}" for check in results.pressure if not check.holds]
        over += [f"slot {check.slide.name}" for check in results.slots if check.ways]
        with np.errstate(all="ignore"):
            reach = self._load_table_reach(results.linkage, results.strokes, 1)[0]
            state, why = (LIMIT, over[0]) if over else (WORKS, "")
            return state, why, self._read_quantities(results), reach

    def _adopt_file_assembly(self, problem: Problem) -> Problem:
        """Return the problem with its sketch recomputed, so that its linkage is assembled like that of the file.

        The problem is returned unchanged if it cannot be traced, or if it cannot be assembled in this way.
        """
        if self.crank_variants is None:
            return problem
        linkage = problem.linkage
        with np.errstate(all="ignore"):
            sketch = compute_sketch(linkage, [kernel.rebind(linkage) for kernel in self.crank_variants.kernels])
        if not all(np.isfinite(place) for place in (*sketch.points.values(), *sketch.angles.values())):
            return problem
        return replace(problem, linkage=replace(linkage, sketch=sketch), extended=None)

    def _read_quantities(self, results: Results) -> Real:
        """Return the requested quantities of one mechanism that was solved without the trace, (quantities,)."""
        assert results.motion is not None
        searched = {
            "H": measures.arc_or_stroke,
            "psi": measures.output_stroke,
            "k": measures.time_ratio,
            PRESSURE: measures.largest_pressure_angle,
        }
        q = results.closely(CYCLE * max(results.turns, 1) + 1)
        read = _ResultsAtCoordinates(results)
        quantities = []
        for quantity in self.shown:
            if quantity.name in searched:
                quantities.append(searched[quantity.name](results))
            elif quantity.quantity is not None and quantity.whole:
                quantities.append(float(np.ravel(quantity.quantity.read(results))[0]))
            else:
                curves = partial(read.curves, quantity)
                quantities.append(float(quantity.over_cycle(curves, q, curves(np.zeros(1), q[None, :]))[0]))
        return np.array(quantities)


def _curve_reader(
    at: Callable[[Real, Real, Sequence[str]], Mapping[str, Real]], name: str
) -> Callable[[Real, Real], Real]:
    return lambda rows, q: np.broadcast_to(at(rows, q, [name])[name], q.shape)


class _ResultsAtCoordinates:
    """A solved mechanism that can be evaluated at other driver coordinates. The last results are cached."""

    def __init__(self, results: Results) -> None:
        self.results, self.q, self.there = results, np.empty(0), results

    def curves(self, quantity: ShownQuantity, rows: Real, q: Real) -> Real:
        """Return a quantity at driver coordinates q, in the shape of q; nan where the mechanism cannot be assembled."""
        if not np.array_equal(q.ravel(), self.q):
            self.q, self.there = q.ravel(), pipeline.results_at(self.results, q.ravel())
        assert self.there.motion is not None
        values = np.broadcast_to(quantity.at_positions(self.there), self.q.shape)
        curves: Real = np.where(self.there.motion.moving & ~self.there.locked, values, np.nan).reshape(q.shape)
        return curves
