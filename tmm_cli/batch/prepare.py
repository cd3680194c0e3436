"""Batches: many positions of a linkage, or many linkages of one kind, solved by traced operations.

A trace records the operations of the analysis for one linkage. Operations that its numbers or the requested results
make superfluous are left out. Recording takes some milliseconds and pays off from thousands of positions. Groups solved
by iteration take a fixed number of Newton steps from tabulated guesses; positions at which these do not converge are
solved by the ordinary analysis.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import reduce
from typing import Any

import numpy as np

from tmm_cli.batch.continuation import (
    STEPS_PER_TURN,
    VARIANT_NEWTON_STEPS,
    Continuation,
    ContinuedPaths,
    InitialGuesses,
    accumulated_angles_agree,
    count_initial_guesses,
    newton_converged,
    unroll_groups,
    with_initial_guesses,
)
from tmm_cli.batch.trace_program import TraceOutputs, TraceProgram
from tmm_cli.batch.trace_terms import Term
from tmm_cli.batch.traced_arrays import DependsOnData, trace_function
from tmm_cli.batch.variant import split_real_columns, varying_numbers, with_numbers
from tmm_cli.mechanics.analysis import leading_values
from tmm_cli.mechanics.assembly import analyse_mobile_structure, assemble
from tmm_cli.mechanics.forces import Reactions, collect_loads, solve_friction, solve_reactions
from tmm_cli.mechanics.groups import (
    ClosedFormSolver,
    DriverMotion,
    GroupSolver,
    NotUnrolledError,
)
from tmm_cli.mechanics.kinematics import Motion, Strokes, compute_motion
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.quantities import ANGLE
from tmm_cli.mechanics.structure import Structure

OutputReader = Callable[[Motion, Reactions | None], Mapping[str, Any]]
CHECKS = ("placed", "moving", "margin")
CONVERGED, ANGLES_AGREE = (
    "sure",
    "wound",
)  # Newton steps converged; accumulated angles of gears agree with the tables
CHECK_OUTPUTS = (*CHECKS, CONVERGED, ANGLES_AGREE)


def read_all(motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
    """Read the motion of all points, centres of mass and links, all reactions, and balancing moments or forces.

    Returns:
        Values by name: `A.x`, `A.v`, `A.a` (m, m/s, m/s2), `S2.x`, ..., `2.omega`, `2.epsilon`, `R.A` (force on
            the second link of the pair, N), `M.x` (couple in a guide, N m), `T.1` (balancing moment or force of
            link 1).
    """
    outputs: dict[str, Any] = {}
    for quantity, name, value in leading_values(motion, reactions, first=True):
        if quantity.dimension != ANGLE:  # the points of a link determine its angle
            outputs[f"{quantity.symbol}.{name}" if quantity.symbol else f"{name}.{quantity.name}"] = value
    return outputs


@dataclass(frozen=True)
class Batch:
    """Linkages of one kind in the assembly of the first one, ready to be solved at any driver coordinates.

    Attributes:
        linkages: the linkages.
        structure, kernels: structure and group solvers of the first linkage.
        wanted: function that reads the requested results.
        forces: True if reactions are solved.
        strokes: strokes of a single linkage, or None.
        program: traced operations for the requested results; None if the linkages cannot be traced.
        checks: traced operations for the results of `sound`.
        columns: numbers that vary, each (variants, 1).
        starts: function that returns initial guesses at driver coordinates, (positions,) or (variants,
            positions).
        others: group solvers of linkages that had to be solved by the ordinary stages, by index.
    """

    linkages: tuple[Linkage, ...]
    structure: Structure
    kernels: tuple[GroupSolver, ...]
    wanted: OutputReader
    forces: bool
    strokes: Strokes | None
    program: TraceProgram | None
    checks: TraceProgram | None = None
    columns: tuple[Real, ...] = ()
    starts: Callable[[Real], list[Real]] | None = None
    others: dict[int, tuple[GroupSolver, ...]] = field(default_factory=dict)

    def __call__(self, q: Real) -> TraceOutputs | Mapping[str, Real]:
        """Solve the linkages at driver coordinates q (rad or m).

        q: shape (positions,), or (variants, positions) if each linkage has its own coordinates.

        Returns:
            Requested results by name, (variants, positions), or (positions,) for a single linkage. At positions where a
            linkage cannot be assembled they are meaningless; `sound` finds these positions.
        """
        return self._solve_one_by_one(q) if self.program is None else self._replay(self.program, q)

    def sound(self, q: Real) -> TraceOutputs | Mapping[str, Real]:
        """Check whether the linkages can be solved at driver coordinates q.

        Returns:
            `placed`: True where the linkage can be assembled. `moving`: True where it is also not in a dead
            position. `margin`: least distance of a group from a dead position, at most 1; results lose about as
            many of their 16 digits as the margin has leading zeros. `solve` gives bounds of the errors.
        """
        return self._solve_one_by_one(q) if self.checks is None else self._replay(self.checks, q)

    def closed(self, q: Real) -> Real:
        """Return True at driver coordinates q at which the traced operations solve all groups.

        Elsewhere the ordinary analysis is needed.
        """
        if self.checks is None:
            return np.zeros(np.shape(q), dtype=bool)
        q = np.asarray(q, dtype=float)
        outputs = self.checks.only(*({CONVERGED} & set(self.checks.outputs)))(
            *self.columns, q, *(self.starts(q) if self.starts else ())
        )
        return outputs[CONVERGED] if CONVERGED in outputs else np.ones(outputs.several_shape, dtype=bool)

    def _replay(self, program: TraceProgram, q: Real) -> TraceOutputs:
        """Run traced operations, and solve the positions at which they do not converge by the ordinary analysis."""
        q = np.asarray(q, dtype=float)
        outputs = program(*self.columns, q, *(self.starts(q) if self.starts else ()))
        if CONVERGED not in outputs:
            return outputs
        sure, outputs = np.reshape(outputs.part(CONVERGED), outputs.several_shape), outputs.without(CONVERGED)
        for k in np.flatnonzero(~np.all(sure, axis=1)).tolist():
            outputs = outputs.replace_values(k, ~sure[k], self._solve_one(k, (q[k] if q.ndim > 1 else q)[~sure[k]]))
        return outputs

    def _solve_one(self, k: int, q: Real) -> Mapping[str, Real]:
        """Solve linkage number k by the ordinary stages."""
        linkage = self.linkages[k]
        if k not in self.others:
            self.others[k] = self.kernels if k == 0 else assemble(linkage, self.structure.rebind(linkage))
        outputs = solve_stages(linkage, self.structure, self.others[k], q, self.wanted, self.forces, self.strokes)
        return {
            name: np.broadcast_to(value, np.shape(q))
            for name, value in outputs.items()
            if name not in (CONVERGED, ANGLES_AGREE)
        }

    def _solve_one_by_one(self, q: Real) -> Mapping[str, Real]:
        solved = [self._solve_one(k, q[k] if np.ndim(q) > 1 else q) for k in range(len(self.linkages))]
        if len(solved) == 1:
            return solved[0]
        return {name: np.stack([output[name] for output in solved]) for name in solved[0]}


def prepare_batch(
    linkages: Sequence[Linkage] | Linkage,
    read: OutputReader = read_all,
    *,
    forces: bool = True,
    own_places: bool = False,
    strokes: Strokes | None = None,
) -> Batch:
    """Prepare linkages that differ only in their numbers.

    Args:
        linkages: one linkage or several.
        read: function that reads the requested results.
        forces: True if the results need reactions.
        own_places: True if each linkage will be solved at its own driver coordinates.
        strokes: strokes of a single linkage whose loads act only in strokes; without them such loads act at all
            positions.

    Raises:
        IncompatibleLinkagesError: the linkages differ in more than their numbers.
        ValueError: there are several linkages, with loads that depend on strokes.
        LinkageError: a linkage cannot be assembled.
    """
    linkages = (linkages,) if isinstance(linkages, Linkage) else tuple(linkages)
    first = linkages[0]
    by_stroke = [x.name for x in first.loads if x.table is not None and x.table.against in ("stroke", "crank turn")]
    if by_stroke and (strokes is None or len(linkages) > 1):
        raise ValueError(f"load {by_stroke[0]}: a table by the strokes needs the strokes of one linkage")
    structure = analyse_mobile_structure(first)
    kernels = assemble(first, structure)
    # with several drivers a trace contains the sketched coordinates of the first linkage
    apart = bool(first.others) and any(linkage.sketch.at != first.sketch.at for linkage in linkages)
    alone = Batch(linkages, structure, kernels, read, forces, strokes, None)
    lines = None if apart or first.friction else traceable_groups(first, kernels)
    if lines is None:
        return alone
    columns, together = split_real_columns(varying_numbers(linkages))
    if len(linkages) > 1 and not columns:  # all linkages are equal
        columns = [np.zeros((len(linkages), 1))]
    count = len(columns)
    steps = VARIANT_NEWTON_STEPS if count else None

    def varied(data: Sequence[Any]) -> Linkage:
        return with_numbers(first, together(*data)) if columns else first

    def stages(*data: Any) -> Mapping[str, Any]:
        linkage = varied(data[:count])
        rebound = tuple(kernel.rebind(linkage) for kernel in lines) if columns else lines
        rebound = with_initial_guesses(rebound, data[count + 1 :], steps)
        return solve_stages(linkage, structure, rebound, data[count], read, forces, strokes, blank=False)

    axes = (*[1] * count, 3 if own_places else 2, *[3 if count else 2] * count_initial_guesses(lines))
    try:
        whole = trace_function(stages, *axes, data=dict(enumerate(columns)))
    except DependsOnData:  # e.g. cam laws
        return alone
    starts: Callable[[Real], list[Real]] | None = None
    if count_initial_guesses(lines):
        starts = continue_linkages(varied, columns, first, lines) if columns else InitialGuesses(first, lines)
    convergence = (CONVERGED,) if isinstance(whole.outputs[CONVERGED][0], Term) else ()
    checks = whole.only(*CHECKS, *convergence)
    program = whole.only(*(name for name in whole.outputs if name not in CHECK_OUTPUTS), *convergence)
    return replace(alone, program=program, checks=checks, columns=tuple(columns), starts=starts)


def continue_linkages(
    varied: Callable[[Sequence[Any]], Linkage], columns: Sequence[Real], first: Linkage, lines: Sequence[GroupSolver]
) -> ContinuedPaths:
    """Continue the unknowns of all linkages over the driver range of the first one.

    Args:
        varied: function that returns the linkage for columns of numbers.
        columns: numbers that vary, each (variants, 1).
        first: the first linkage.
        lines: its group solvers in a form that can be traced.
    """
    numbers = np.hstack(list(columns))
    traces = [kernel.followed for kernel in lines if kernel.followed is not None]
    low, high = max(trace.q[0] for trace in traces), min(trace.q[-1] for trace in traces)
    turns = (high - low) / (2 * np.pi) if first.driver.kind == "turn" else 1.0
    closed = all(trace.closed for trace in traces)
    ones = np.ones((len(numbers), 1))
    continuation = Continuation(varied, numbers[0].tolist(), first, lines)
    return continuation(numbers, low * ones, high * ones, int(np.ceil(STEPS_PER_TURN * turns)), closed=closed)


def traceable_groups(linkage: Linkage, kernels: tuple[GroupSolver, ...]) -> tuple[GroupSolver, ...] | None:
    """Return the group solvers in a form that can be traced; None if there is no such form."""
    if any(kernel.way is not None for kernel in kernels if isinstance(kernel, ClosedFormSolver)):
        return None
    try:
        return unroll_groups(linkage, kernels)
    except NotUnrolledError:
        return None


def solve_stages(
    linkage: Linkage,
    structure: Structure,
    kernels: tuple[GroupSolver, ...],
    q: Any,
    read: OutputReader,
    forces: bool,
    strokes: Strokes | None,
    *,
    blank: bool = True,
    start: Any = None,
) -> Mapping[str, Any]:
    """Solve the linkage at driver coordinates q and read the requested results.

    Derivatives are taken with respect to time, so they need not be multiplied by the driver speed.

    Args:
        linkage: the linkage.
        structure: its structure.
        kernels: its group solvers.
        q: driver coordinates.
        read: function that reads the requested results.
        forces: True to solve reactions too.
        strokes: strokes, if loads depend on them.
        blank: True to set results to nan at positions that cannot be reached.
        start: driver coordinate at which the law of motion begins (rad or m); None for that of the sketch.

    Returns:
        The requested results, and the masks named in CHECK_OUTPUTS.
    """
    lead = linkage.driver
    law = DriverMotion(linkage.sketch.at if start is None else start, lead.rate, lead.acceleration, lead.sense)
    motion = compute_motion(linkage, kernels, q, law, blank=blank, in_time=bool(np.any(lead.rate != 0)))
    reactions = solve_forces(motion, structure, strokes) if forces else None
    margin = reduce(np.minimum, [at.margin for at in motion.placements], np.ones(np.shape(q)))
    checks = {"placed": motion.placed, "moving": motion.moving, "margin": margin}
    turns = accumulated_angles_agree(motion)
    return {**read(motion, reactions), **checks, CONVERGED: newton_converged(motion) & turns, ANGLES_AGREE: turns}


def solve_forces(motion: Motion, structure: Structure, strokes: Strokes | None) -> Reactions:
    """Solve the reactions under all loads; friction is included if the linkage has any."""
    acting = collect_loads(motion, strokes)
    free = solve_reactions(motion, structure, acting)
    if not motion.linkage.friction:
        return free
    return solve_friction(motion, structure, acting, free).reactions
