"""Variants of a linkage as one linkage whose numbers are arrays (variants, 1), with positions and strokes of each
variant.

All stages of the analysis then compute (variants, positions) at once. Some variants cannot be treated in this way:
those with groups that cannot be traced, several drivers, a driver with a stroke, or outputs with more than two strokes.
Each of them forms a family of its own and is solved like a separate file.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from tmm_cli.batch.continuation import LARGEST_CORRECTION, STEPS_PER_TURN, Continuation, ContinuedPaths, LinkageMaker
from tmm_cli.batch.prepare import traceable_groups
from tmm_cli.batch.traced_arrays import DependsOnData, TracedNumber
from tmm_cli.batch.variant import Make, NotTraceableError, placeholder_linkage, resolve_traced, split_columns
from tmm_cli.mechanics.analysis import Inputs, Mechanism
from tmm_cli.mechanics.assembly import SKETCH_CLOSE, analyse_mobile_structure, assemble, sketched_angles
from tmm_cli.mechanics.errors import LinkageError
from tmm_cli.mechanics.groups import (
    ClosedFormSolver,
    DriverState,
    DriverStates,
    GroupSolver,
    GroupState,
    LinkStates,
    NewtonSolver,
    Pose,
    Poses,
    UnrolledNewton,
    link_states,
    solvers_towards,
)
from tmm_cli.mechanics.kinematics import (
    OutputCurve,
    Stroke,
    StrokeCurve,
    Strokes,
    cycle_turns,
    measure_runs,
    moving_slope,
    resisted_direction,
)
from tmm_cli.mechanics.linkage import Linkage, Request
from tmm_cli.mechanics.numerics import SAME_DRIVER_POSITION, Real, find_roots, map_record, unit
from tmm_cli.mechanics.structure import Structure, output_link


@dataclass(frozen=True)
class ContinuedGroup(NewtonSolver):
    """Solver, for many variants, of a group that is solved by iteration.

    Attributes:
        lines: the same group with a fixed number of Newton steps.
        ways: unknowns of the variants along the driver range, from which the iteration starts.
    """

    lines: UnrolledNewton = field(kw_only=True)
    ways: ContinuedPaths = field(kw_only=True)

    def rebind(self, linkage: Linkage) -> ContinuedGroup:
        lines = self.lines.rebind(linkage)
        return replace(self, group=lines.group, size=lines.size, constraints=lines.constraints, lines=lines)

    def take(self, rows: Real) -> ContinuedGroup:
        """Return the solver of the group for the selected variants only."""
        return replace(self, ways=self.ways.take(rows))

    def begun(self, poses: Poses, q: Real, drives: DriverStates) -> tuple[GroupState, Real]:
        posed = self.lines.posed(dict(zip(self.lines.free, self.ways(q), strict=True)), poses, drives)
        parts = [(posed[link].x, posed[link].turned) for link in self.group.links]
        x, turned = (np.stack(np.broadcast_arrays(*components), axis=-1) for components in zip(*parts, strict=True))
        return GroupState(x, turned), np.full(x.shape[:-1], -1.0)

    def follows_path(self, states: LinkStates) -> Real:
        """Return True for the variants whose solved group stays near its initial guesses and away from dead positions.

        The assembly must also be that of the sketch.

        states: states of all variants, (variants, positions), beginning at the position of the sketch.
        """
        number = [kernel.group for kernel in states.kernels].index(self.group)
        at, later = states.placements[number], {link for k in states.kernels[number:] for link in k.group.links}
        start, _ = self.begun(states.poses, states.q, states.drives)
        z = np.stack([pose.z for pose in at.poses], axis=-1)
        earlier = {link: Pose(p.x[:, :1], p.z[:, :1]) for link, p in states.poses.items() if link not in later}
        drives = {
            link: DriverState(d.value[:, :1], d.first[:, :1], d.second[:, :1]) for link, d in states.drives.items()
        }
        sketched = sketched_angles(self, states.linkage, earlier, drives)
        with np.errstate(invalid="ignore"):
            followed = np.all(np.abs(z - unit(start.unwrapped)) < LARGEST_CORRECTION, axis=(1, 2))
            meant = np.all(
                np.abs(z[:, :1] - (z[:1, :1] if sketched is None else unit(sketched))) < SKETCH_CLOSE, axis=(1, 2)
            )
            whole: Real = followed & meant & np.all((at.det * at.det[0, 0] > 0) & (at.margin > self.near), axis=1)
        return whole


def continue_groups(
    varied: LinkageMaker, columns: Real, linkage: Linkage, kernels: tuple[GroupSolver, ...]
) -> tuple[GroupSolver, ...]:
    """Extend the group solvers of the first variant to all variants by continuation.

    The solvers returned must still be rebound to the linkage of all variants.

    Args:
        varied: function that returns the linkage for numbers of the variants.
        columns: numbers of the variants, (variants, n).
        linkage: linkage of the first variant.
        kernels: its group solvers.

    Raises:
        NotTraceableError, DependsOnData: the groups cannot be traced.
    """
    traces = [kernel.trace for kernel in kernels if isinstance(kernel, NewtonSolver) and not kernel.by_angle]
    if not traces:
        return kernels
    lines = traceable_groups(linkage, kernels)
    if lines is None or any(trace is None or not trace.closed or trace.dead.size for trace in traces):
        raise NotTraceableError
    half = np.full((len(columns), 1), np.pi)
    paths = Continuation(varied, columns[0].tolist(), linkage, lines)(columns, -half, half, STEPS_PER_TURN, closed=True)
    continued: list[GroupSolver] = []
    first = 0
    for kernel, line in zip(kernels, lines, strict=True):
        if isinstance(kernel, NewtonSolver) and isinstance(line, UnrolledNewton) and not line.linear:
            last = first + len(line.free)
            arguments = kernel.group, kernel.size, kernel.constraints, kernel.start, None, kernel.passive, kernel.order
            continued.append(ContinuedGroup(*arguments, lines=line, ways=paths.of(slice(first, last))))
            first = last
        else:
            continued.append(kernel)
    return tuple(continued)


# Families of variants.


SCAN = 72  # positions per revolution; ends of strokes closer together than this are not separated


@dataclass(frozen=True, eq=False)
class VariantFamily:
    """Variants in the assembly of the first one, as one linkage whose numbers are scalars or arrays (variants, 1).

    Attributes:
        linkage, structure, kernels: the linkage of all variants, its structure and its group solvers.
        request: requested positions.
        q: driver coordinates, (variants, positions), rad or m.
        strokes: strokes, with numbers of shape (variants, 1); None if no output has any.
        sound: True for feasible variants, which move through the whole cycle and have the same kind of strokes
            as the first, (variants,).
    """

    linkage: Linkage
    structure: Structure
    kernels: tuple[GroupSolver, ...]
    request: Request
    q: Real
    strokes: Strokes | None
    sound: Real

    def __len__(self) -> int:
        return len(self.q)

    def take(self, rows: Sequence[int] | Real) -> VariantFamily:
        """Return the family of the selected variants, which may be repeated."""
        rows = np.asarray(rows)
        kernels = tuple(kernel.take(rows) if isinstance(kernel, ContinuedGroup) else kernel for kernel in self.kernels)
        new = replace(self, kernels=kernels).changed(take_rows(self.linkage, rows), self.q[rows])
        return replace(new, strokes=take_rows(self.strokes, rows), sound=self.sound[rows])

    def changed(self, linkage: Linkage, q: Real | None = None) -> VariantFamily:
        """Return the family with other numbers, and other driver coordinates if they are given.

        Assemblies and strokes are kept.
        """
        kernels = tuple(kernel.rebind(linkage) for kernel in self.kernels)
        structure = self.structure.rebind(linkage)
        return replace(self, linkage=linkage, structure=structure, kernels=kernels, q=self.q if q is None else q)


def take_rows(record: Any, rows: Real) -> Any:
    """Select the rows of some variants in all arrays (variants, 1) of a record."""
    return map_record(lambda _, value: value[rows] if np.ndim(value) == 2 else value, record, skip=("sketch",))


def split_families(make: Make, columns: Real) -> Iterator[tuple[Real, VariantFamily | LinkageError]]:
    """Split variants into families that can be solved together.

    Args:
        make: function that builds a variant from its numbers. Its errors are passed on to the caller.
        columns: numbers of the variants, (variants, n).

    Yields:
        The indices of the variants of a family, and the family. For a variant that cannot be solved, its error takes
        the place of the family.
    """
    rows = np.arange(len(columns))
    family = build_family(make, columns) if len(columns) > 1 else None
    if family is not None and np.any(family.sound):
        yield rows[family.sound], family.take(rows[family.sound])
        rows = rows[~family.sound]
    for row in rows:
        try:
            yield np.array([row]), _single_family(make, columns[row])
        except LinkageError as error:
            yield np.array([row]), error


def build_family(make: Make, columns: Real) -> VariantFamily | None:
    """Build one family of all variants, feasible or not, in the assembly of the first.

    Args:
        make: function that builds a variant from its numbers. Its errors are passed on to the caller.
        columns: numbers of the variants, (variants, n).

    Returns:
        The family; None if the variants cannot be treated together.
    """
    first = columns[0].tolist()
    try:
        varied = make([TracedNumber(x, column) for x, column in zip(first, split_columns(columns), strict=True)])
        plain = make(first).linkage
        structure = analyse_mobile_structure(plain)
        kernels = assemble(plain, structure)
        if plain.others or plain.driver.kind != "turn" or plain.driver.stroke is not None or varied.ends is not None:
            return None
        if not all(
            kernel.plain if isinstance(kernel, ClosedFormSolver) else isinstance(kernel, NewtonSolver)
            for kernel in kernels
        ):
            return None
        if cycle_turns(plain, kernels) != 1:  # strokes are searched for in one revolution
            return None
        kernels = continue_groups(
            lambda data: placeholder_linkage(make, first, data, plain.sketch), columns, plain, kernels
        )
    except (DependsOnData, NotTraceableError, LinkageError):
        return None
    linkage = replace(resolve_traced(varied.linkage), sketch=plain.sketch)
    structure = structure.rebind(linkage)
    kernels = tuple(kernel.rebind(linkage) for kernel in kernels)
    request = resolve_traced(varied.request)
    strokes, sound = _all_strokes(linkage, kernels, len(columns))
    if linkage.stroke_links and strokes is None:
        return None
    q = position_coordinates(request, strokes, linkage.driver.sense, len(columns))
    return None if q is None else VariantFamily(linkage, structure, kernels, request, q, strokes, sound)


def _single_family(make: Make, row: Real) -> VariantFamily:
    """Build the family of one variant, solved like a separate file.

    Raises:
        LinkageError: the variant cannot be solved.
    """
    variant = make(row.tolist())
    structure = analyse_mobile_structure(variant.linkage)
    mechanism = Mechanism(Inputs(variant.linkage, variant.request), structure)
    q = np.asarray(mechanism.asked)[None, :]
    sound = np.array([True])
    return VariantFamily(variant.linkage, structure, mechanism.kernels, variant.request, q, mechanism.strokes, sound)


def _all_strokes(linkage: Linkage, kernels: tuple[GroupSolver, ...], count: int) -> tuple[Strokes | None, Real]:
    """Find the strokes of the main output of all variants, and of further links on which loads depend.

    Returns:
        The strokes, or None if one of these links has none; and a mask of the variants whose driver rotates fully and
        for which each of these links has one working and one return stroke.
    """
    link = output_link(linkage, tuple(kernel.group for kernel in kernels))
    main, sound = _output_strokes(linkage, kernels, count, link)
    others = []
    for link in linkage.stroke_links:
        strokes, have = _output_strokes(linkage, kernels, count, link)
        if main is None or strokes is None:
            return None, sound
        others.append(strokes)
        sound = sound & have
    return main and replace(main, others=tuple(others)), sound


def _output_strokes(
    linkage: Linkage, kernels: tuple[GroupSolver, ...], count: int, link: str | None
) -> tuple[Strokes | None, Real]:
    """Find the strokes of one output link of all variants.

    Returns:
        The strokes or None, and a mask of the variants with one working and one return stroke.
    """
    q = linkage.sketch.at + np.linspace(0, 2 * np.pi, SCAN + 1) + np.zeros((count, 1))
    whole = link_states(linkage, kernels, q, 1)
    sound = np.all(whole.moving, axis=1)
    for kernel in kernels:
        if isinstance(kernel, ContinuedGroup):
            sound = sound & kernel.follows_path(whole)
    if link is None or not (linkage.slides_on_frame(link) or linkage.hinged_to_frame(link)):
        return None, sound
    curve = OutputCurve(linkage, solvers_towards(kernels, [link]), link)
    forward = np.broadcast_to(moving_slope(whole, link), q.shape) >= 0
    turns_back = forward[:, :-1] != forward[:, 1:]
    if not np.any(turns_back):  # the output rotates without reversing
        return Strokes(link, curve.kind, (), ""), sound
    sound = sound & (np.sum(turns_back, axis=1) == 2)
    if not np.any(sound):
        return None, sound
    turns_back = np.where(sound[:, None], turns_back, turns_back[np.argmax(sound)])
    at = np.nonzero(turns_back)[1].reshape(count, 2)
    rows = np.arange(count)[:, None]
    ends = find_roots(curve.slope, q[rows, at], q[rows, at + 1])
    return working_and_idle_strokes(linkage, curve, ends, resisted_direction(linkage, link)), sound


def working_and_idle_strokes(linkage: Linkage, curve: StrokeCurve, ends: Real, resists: Any) -> Strokes:
    """Return the working and the return stroke of each variant, given the two reversals of its output.

    Args:
        linkage: linkage of the variants.
        curve: the output coordinate as a function of the driver coordinate.
        ends: driver coordinates of the two reversals, (variants, 2).
        resists: direction of motion that the loads resist. It decides which stroke is the working one if both take the
            same travel of the driver.
    """
    sense, cycle = linkage.driver.sense, 2 * np.pi
    ends = np.mod(ends, cycle)
    lengths = np.mod(sense * (ends[:, ::-1] - ends), cycle)
    lows, runs = measure_runs(curve, ends, sense * lengths)
    forward = np.where(runs > 0, lengths, 0).sum(axis=1)
    backward = np.where(runs < 0, lengths, 0).sum(axis=1)
    slower = np.sign(np.where(np.abs(forward - backward) > SAME_DRIVER_POSITION, forward - backward, 0))
    load_direction = np.sign(np.ravel(resists) + np.zeros(len(ends)))
    direction = np.where(slower != 0, slower, np.where(load_direction != 0, load_direction, 1.0))
    required = linkage.working_direction(curve.link)
    if required != "auto":
        direction = np.full(len(ends), 1.0 if required == "forward" else -1.0)
    first = (np.sign(runs[:, 1]) == direction).astype(int)
    rows = np.arange(len(ends))
    strokes = []
    for order, working in ((first, True), (1 - first, False)):
        start, length, low, run = (columns[rows, order][:, None] for columns in (ends, lengths, lows, runs))
        strokes.append(Stroke(start, length, low, run, working))
    return Strokes(curve.link, curve.kind, tuple(strokes), "")


def position_coordinates(request: Request, strokes: Strokes | None, sense: int, count: int) -> Real | None:
    """Return the driver coordinates of the positions, (variants, positions); None if they depend on strokes that
    do not exist.
    """
    ones = np.ones((count, 1))
    if request.places:
        return np.concatenate([place * ones for place in request.places], axis=1)
    start: Any = request.start
    if isinstance(start, str):
        if strokes is None or not strokes.strokes:
            return None
        start = strokes.strokes[0].start
    coordinates: Real = start * ones + sense * 2 * np.pi * np.arange(request.count) / request.count
    return coordinates
