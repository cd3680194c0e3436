"""Assembly of all groups as the sketch shows them, and change points that groups in closed form pass smoothly.

At a change point two branches of assemblies meet (a parallelogram has two such points). The determinant of the group's
equations is zero there, and only its sign distinguishes the branches. Along the smooth branch, on which velocities are
continuous, the sign changes.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np

from tmm_cli.mechanics.assembly.sketch_matching import (
    assemble_by_iteration,
    check_fit,
    nearest_to_sketch,
    refuse_large_group,
)
from tmm_cli.mechanics.errors import AmbiguousSketchError, AssemblyError, ChangePointSearchError
from tmm_cli.mechanics.groups import (
    CLOSED_FORM_SOLVERS,
    AccumulatedAngles,
    ChangePoints,
    ClosedFormSolver,
    DriverStates,
    GroupSolver,
    HingeEnd,
    Placement,
    Pose,
    driven_state,
    drives_at,
    frame_state,
    link_states,
    slider_search_range,
    solvers_towards,
)
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import Real, find_minima, find_roots
from tmm_cli.mechanics.structure import Group, Structure, turns_of_cycle

SCANNED_PER_TURN = 360  # samples per turn
LARGEST_SEARCH = 5_000  # groups times turns of the driver in one search: a second and a tenth of a gigabyte
CLOSER = 129  # finer samples where the reserve seems to vanish
BESIDE = 1e-3  # steps of the scan: at this distance a determinant with a simple zero is proportional to it
SHARED_POINT = 1e-4  # steps of the scan: a change point this near to one of an earlier group is the same point
VANISHED_BESIDE = 0.1  # fraction of the determinant at BESIDE: rounding of earlier groups leaves less in a shared point
SIMPLE = 3.0  # ratio at twice the distance: 2 for a simple zero, 4 for a double one


def find_change_points(
    linkage: Linkage, before: tuple[GroupSolver, ...], kernel: ClosedFormSolver
) -> ChangePoints | None:
    """Find the change points that a group passes smoothly.

    Args:
        linkage: the linkage.
        before: solvers of the groups on which this group depends, in solving order.
        kernel: solver of the group.

    Returns:
        The change points; None if the determinant of the group never changes sign.

    Raises:
        ChangePointSearchError: the groups in `before` repeat only after too many turns of the driver.
    """
    upto = solvers_towards((*before, kernel), kernel.group.links)
    turns = linkage.driver.kind == "turn"
    number = turns_of_cycle(linkage) or 1
    for other in upto[:-1]:
        change_points = other.way if isinstance(other, ClosedFormSolver) else None
        if change_points is not None and change_points.cycle is not None and len(change_points.places) % 2:
            number *= 2
    if number * len(upto) > LARGEST_SEARCH:
        raise ChangePointSearchError(kernel.group, len(upto), number, LARGEST_SEARCH)
    half = np.pi * number if turns else slider_search_range(linkage)
    start, step = linkage.sketch.at - half, 2 * half / (SCANNED_PER_TURN * number)
    q = start + step * np.arange(-2, SCANNED_PER_TURN * number + 3)
    at = link_states(linkage, upto, q, 0, blank=False).placements[-1]
    residual = np.where(np.isfinite(at.residual), at.residual, -np.inf)
    inner = residual[1:-1]
    with np.errstate(invalid="ignore"):  # of positions without assembly
        rise = np.abs(np.diff(residual))
        near = (inner >= residual[:-2]) & (inner > residual[2:]) & (inner + 2 * np.maximum(rise[1:], rise[:-1]) >= 0)
    earlier = _change_points_before(upto, float(q[0]), float(q[-1]))
    candidates = np.sort(_refine_change_points(linkage, upto, q[np.flatnonzero(near) + 1], float(step), earlier))
    if turns:
        candidates = np.sort(candidates - 2 * half * np.floor((candidates - start) / (2 * half)))
    coordinates = candidates[np.diff(candidates, prepend=-np.inf) > step]
    if len(coordinates) > 1 and turns and coordinates[0] + 2 * half - coordinates[-1] < step:
        coordinates = coordinates[:-1]
    return (
        ChangePoints(coordinates, start, linkage.sketch.at, 2 * half if turns else None) if coordinates.size else None
    )


def _change_points_before(upto: tuple[GroupSolver, ...], low: float, high: float) -> Real:
    """Return the change points of the groups on which the last group depends, in increasing order.

    low, high: ends of the interval of driver coordinates in which they lie.
    """
    ways = [kernel.way for kernel in upto[:-1] if isinstance(kernel, ClosedFormSolver) and kernel.way is not None]
    return np.sort(np.concatenate([np.zeros(0), *(change_points.within(low, high) for change_points in ways)]))


def _refine_change_points(
    linkage: Linkage, upto: tuple[GroupSolver, ...], candidates: Real, step: float, earlier: Real
) -> Real:
    """Refine estimates of change points to the last bit, and drop those that the group cannot pass.

    Next to its own change point an earlier group is accurate to half the digits only. A result next to such a point is
    therefore replaced by the point itself; otherwise the points of a chain of parallelograms would drift apart.

    Args:
        linkage: the linkage.
        upto: solvers of the group (last) and of the groups on which it depends.
        candidates: estimates of the change points (driver coordinates).
        step: step of the scan that gave the estimates.
        earlier: change points of the earlier groups, increasing.
    """
    if not candidates.size:
        return candidates
    to_spare = partial(assembly_reserve, linkage, upto)
    closer = _values_at_steps(to_spare, candidates, step * np.linspace(-1, 1, CLOSER))
    with np.errstate(invalid="ignore"):
        falls = np.abs(np.min(closer, axis=1)) <= 2 * np.max(np.abs(np.diff(closer, axis=1)), axis=1)
    candidates = candidates[np.all(np.isfinite(closer), axis=1) & falls]
    if not candidates.size:
        return candidates
    best = refine_dead_positions(linkage, upto, find_minima(to_spare, candidates - step, candidates + step)[0], step)
    shared = np.zeros(best.size, dtype=bool)
    if earlier.size:
        nearest = earlier[np.argmin(np.abs(best[:, None] - earlier), axis=1)]
        shared = np.abs(best - nearest) <= step * SHARED_POINT
        best = np.where(shared, nearest, best)
    beside = best[:, None] + step * BESIDE * np.array([-2, -1, 0, 1, 2])
    states = link_states(linkage, upto, beside.ravel(), 0, blank=False)
    at = states.placements[-1]
    det, dead, placed = (
        np.broadcast_to(values, beside.size).reshape(beside.shape)
        for values in (np.abs(at.det), at.dead, states.placed)
    )
    passes = (det[:, 0] <= SIMPLE * det[:, 1]) & (det[:, 4] <= SIMPLE * det[:, 3])
    vanishes = dead[:, 2] | shared & (det[:, 2] <= VANISHED_BESIDE * np.minimum(det[:, 1], det[:, 3]))
    exact: Real = best[vanishes & np.all(placed, axis=1) & passes]
    return exact


def _values_at_steps(function: Callable[[Real], Real], centres: Real, steps: Real) -> Real:
    """Evaluate a function at the same distances from each centre, shape (centres, steps)."""
    q = centres[:, None] + steps
    return np.broadcast_to(function(q.ravel()), q.size).reshape(q.shape)


def assembly_reserve(linkage: Linkage, kernels: tuple[GroupSolver, ...], q: Real) -> Real:
    """Return how far the last group is from losing its assembly at driver coordinates q (m); see `Placement.residual`.

    It is negative where the group cannot be assembled.
    """
    return -link_states(linkage, kernels, q, 0).placements[-1].residual


def refine_dead_positions(linkage: Linkage, kernels: tuple[GroupSolver, ...], positions: Real, step: float) -> Real:
    """Refine estimates of dead positions of the last group, inside the range of the driver, to the last bit.

    The residual of the group has an extreme in a dead position. Comparing values locates an extreme to half the digits
    only, so the root of the derivative is found instead.

    Args:
        linkage: the linkage.
        kernels: solvers of the group (last) and of the groups on which it depends.
        positions: estimates of the dead positions (driver coordinates).
        step: distance on both sides in which each of them lies.
    """
    last = kernels[-1]
    if not isinstance(last, ClosedFormSolver):
        return positions

    def residual_rate(q: Real) -> Real:
        before = link_states(linkage, kernels[:-1], q, 1)
        return last.residual_rate(last.closed(before.poses, before.drives), before.poses, before.first, before.drives)

    low, high = positions - step, positions + step
    with np.errstate(all="ignore"):
        changes = np.sign(residual_rate(low)) * np.sign(residual_rate(high)) < 0
        if not np.any(changes):
            return positions
        refined = positions.copy()
        refined[changes] = find_roots(residual_rate, low[changes], high[changes])
    return refined


# Selection of the assembly of each group from the sketch; it is kept in every position.


MISPLACED = 0.25  # sizes of the linkage: larger deviations of sketched points are mistakes; of angles twice this (rad)
ANGLES_PER_TURN = 720  # samples per turn for the accumulation of angles


def assemble(
    linkage: Linkage, structure: Structure, groups: tuple[Group, ...] | None = None, like: tuple[GroupSolver, ...] = ()
) -> tuple[GroupSolver, ...]:
    """Return the solvers of the groups in the assemblies that the sketch shows, in solving order.

    Args:
        linkage: the linkage.
        structure: its structure.
        groups: groups to assemble; all groups of the structure if None.
        like: solvers of a linkage with other lengths; their traces are corrected instead of being computed anew.

    Raises:
        GroupTooLargeError: a group has too many links for iteration.
        ChangePointSearchError: a search for change points would be too long.
        AssemblyError: a group cannot be assembled.
        AmbiguousSketchError: the sketch does not determine the assembly of a group.
        SketchMismatchError: the sketch does not fit the dimensions.
    """
    groups = structure.solved if groups is None else groups
    for group in groups:
        if not any(kind.fits(group) for kind in CLOSED_FORM_SOLVERS):
            refuse_large_group(group)
    q = np.array([linkage.sketch.at])
    drives = drives_at(linkage, q)
    poses = {FRAME: frame_state(q)[0]}
    for driver in linkage.cranks:
        poses[driver.link] = driven_state(linkage, driver, drives[driver.link])[0]
    chosen: list[GroupSolver] = []
    for group in groups:
        other = like[len(chosen)] if like else None
        try:
            kernel, at = _assemble_group(group, linkage, poses, drives, tuple(chosen), other)
        except (AssemblyError, AmbiguousSketchError):
            check_fit(linkage, poses, MISPLACED)  # an earlier group that is sketched wrongly may be the cause
            raise
        poses.update(zip(kernel.group.links, at.poses, strict=True))
        chosen.append(kernel)
    check_fit(linkage, poses)
    return tuple(chosen)


def _assemble_group(
    group: Group,
    linkage: Linkage,
    poses: dict[str, Pose],
    drives: DriverStates,
    before: tuple[GroupSolver, ...],
    like: GroupSolver | None,
) -> tuple[GroupSolver, Placement]:
    q = np.array([linkage.sketch.at])
    closed = closed_form_solver(group, linkage)
    if closed is not None:
        kernel, at = _choose_assembly(closed, linkage, poses, drives)
        if kernel.assemblies > 1 and not linkage.keep_side:
            kernel = replace(kernel, way=find_change_points(linkage, before, kernel))
        geared = {name for mesh in linkage.meshes for name in (mesh.i, mesh.j, mesh.carrier)} & set(group.links)
        if geared:
            kernel = replace(kernel, winding=_accumulate_angles(linkage, (*before, kernel), tuple(geared)))
            at = kernel.place(poses, q, drives)
        return kernel, at
    return assemble_by_iteration(group, linkage, poses, drives, before, like)


def closed_form_solver(group: Group, linkage: Linkage) -> ClosedFormSolver | None:
    """Return the solver of a group in closed form, not yet assembled; None if the group has no closed form."""
    return next((kind.of(group, linkage) for kind in CLOSED_FORM_SOLVERS if kind.fits(group)), None)


def _accumulate_angles(linkage: Linkage, kernels: tuple[GroupSolver, ...], links: tuple[str, ...]) -> AccumulatedAngles:
    """Tabulate the angles of links of the last group, accumulated through full turns, over a cycle about the sketch.

    The table ends where the links can no longer be assembled.
    """
    turns, at = turns_of_cycle(linkage) or 1, linkage.sketch.at
    half = turns * np.pi if linkage.driver.kind == "turn" else slider_search_range(linkage)
    q = at + half * np.linspace(-1, 1, ANGLES_PER_TURN * turns + 1)
    motion = link_states(linkage, solvers_towards(kernels, links), q, 0)
    middle = len(q) // 2
    lost = np.flatnonzero(~motion.placed)
    first = int(lost[lost < middle].max(initial=-1)) + 1
    last = int(lost[lost > middle].min(initial=len(q)))
    angles = {}
    for link in links:
        z = motion.poses[link].z[first:last]
        angle = np.unwrap(np.angle(z))
        sketch_index = middle - first
        angles[link] = angle + (np.angle(z[sketch_index]) - angle[sketch_index])
    closed = first == 0 and last == len(q) and linkage.driver.kind == "turn"
    return AccumulatedAngles(q[first:last], angles, closed)


def _choose_assembly(
    kernel: ClosedFormSolver, linkage: Linkage, poses: dict[str, Pose], drives: DriverStates
) -> tuple[ClosedFormSolver, Placement]:
    signed = [replace(kernel, sign=s) for s in (1, -1)[: kernel.assemblies]]
    with np.errstate(invalid="ignore", divide="ignore"):
        ways = [(variant, variant.closed(poses, drives)) for variant in signed]
    first = ways[0][1]
    if not first.assembled[0] or not np.isfinite(first.a.x[0] + first.b.x[0]):
        raise AssemblyError(kernel.group, float(first.residual[0]))
    if len(ways) == 1:
        return ways[0]
    if first.dead[0]:
        raise AmbiguousSketchError(kernel.group, {})
    placed = [dict(zip(kernel.group.links, at.poses, strict=True)) for _, at in ways]
    return ways[nearest_to_sketch(kernel, linkage, placed, _sketch_shift(kernel, linkage, poses))]


def _sketch_shift(kernel: ClosedFormSolver, linkage: Linkage, poses: dict[str, Pose]) -> complex:
    """Return the mean displacement (m) of the known hinges in the sketch from their computed positions.

    The sketch shows on which side of these hinges the group lies. Before an assembly is compared with the sketch, the
    sketch is therefore shifted so that these hinges coincide.
    """
    shifts = []
    for pair, end in kernel.outer_pairs:
        if isinstance(end, HingeEnd):
            if end.known == FRAME:
                shifts.append(0j)
            elif pair.point in linkage.sketch.points:
                shifts.append(linkage.sketch.points[pair.point] - complex(poses[end.known].at(end.there)[0]))
    return sum(shifts) / len(shifts) if shifts else 0j
