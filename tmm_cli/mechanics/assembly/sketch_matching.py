"""Comparison of assemblies with the sketch, and assembly of groups of class III and higher.

For given angles the origins of the links follow from linear equations. Initial guesses of Newton's method are therefore
made from angles: those of the sketch, or many pseudo-random ones, the same in every run. A triad of revolute pairs has
up to six assemblies: C. Innocenti, Direct kinematics in analytical form of the planar (Assur) structure, ASME J. Mech.
Design (1992-1995).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tmm_cli.mechanics.assembly.continuation import BranchFollower
from tmm_cli.mechanics.assembly.corrector import correct_trace
from tmm_cli.mechanics.errors import AmbiguousSketchError, AssemblyError, GroupTooLargeError, SketchMismatchError
from tmm_cli.mechanics.groups import (
    BranchTrace,
    DriverStates,
    GroupSolver,
    GroupState,
    LinkStates,
    NewtonSolver,
    Placement,
    Pose,
    link_states,
    slider_search_range,
    solvers_towards,
)
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import (
    CONVERGED,
    DEAD_SKETCH,
    LAST_STEP_AFAR,
    SAME_ASSEMBLY,
    SAME_IN_SKETCH,
    Real,
    singular_value_ratio,
    solve,
    to_float,
    unit,
)
from tmm_cli.mechanics.structure import Group, turns_of_cycle

DISTINCT = 0.6  # ratio of deviations below which the sketch distinguishes the nearest assembly from the next
SKETCH_FITS = 0.5  # allowed deviation of sketched points (sizes of the linkage); of angles twice this (rad)

SketchableValues = dict[str, complex | float]  # points (m) and angles of links (rad) by their names


def sketchable_values(linkage: Linkage, poses: Mapping[str, Pose]) -> SketchableValues:
    """Return the values that a sketch may contain for these links: points (m) and angles (rad), by name."""
    values: SketchableValues = {}
    for name, pose in poses.items():
        values |= {point: complex(pose.at(local)[0]) for point, local in linkage.links[name].points.items()}
        values[name] = float(np.angle(pose.z)[0])
    return values


def sketch_distance(sketched: Mapping[str, complex | float], computed: SketchableValues, size: float) -> float:
    """Return the largest deviation of the sketched points and angles from an assembly.

    Deviations of points are divided by `size` (m); those of angles are in rad.
    """
    worst = 0.0
    for name, value in sketched.items():
        if isinstance(value, complex):
            worst = max(worst, abs(value - computed[name]) / size)
        else:
            worst = max(worst, abs(np.angle(np.exp(1j * (value - float(computed[name].real))))))
    return worst


def nearest_to_sketch(
    kernel: GroupSolver, linkage: Linkage, assemblies: Sequence[Mapping[str, Pose]], shift: complex = 0j
) -> int:
    """Return the index of the assembly that the sketch shows.

    Args:
        kernel: solver of the group.
        linkage: the linkage.
        assemblies: poses of the links in each assembly.
        shift: displacement (m) of the known links in the sketch from their computed positions.

    Raises:
        AmbiguousSketchError: the sketch does not distinguish the assemblies.
    """
    if len(assemblies) == 1:
        return 0
    candidates = [sketchable_values(linkage, poses) for poses in assemblies]
    distinguishing = [
        name
        for name in candidates[0]
        if any(
            abs(candidate[name] - candidates[0][name])
            > SAME_IN_SKETCH * (1.0 if name in linkage.links else kernel.size)
            for candidate in candidates[1:]
        )
    ]
    sketched = {p: place - shift for p, place in linkage.sketch.points.items()} | dict(linkage.sketch.angles)
    deciding = {name: sketched[name] for name in distinguishing if name in sketched}
    errors = [sketch_distance(deciding, candidate, kernel.size) for candidate in candidates]
    best, second = (int(k) for k in np.argsort(errors, kind="stable")[:2])
    if not deciding or errors[best] > DISTINCT * errors[second]:
        choices = {name: (candidates[best][name], candidates[second][name]) for name in distinguishing}
        raise AmbiguousSketchError(kernel.group, choices, len(assemblies))
    return best


def sketch_deviations(linkage: Linkage, poses: Mapping[str, Pose]) -> dict[str, float]:
    """Return the distance of each sketched point from its computed position, divided by the size of the linkage."""
    points = [complex(pose.at(p)[0]) for name, pose in poses.items() for p in linkage.links[name].points.values()]
    size = max(abs(p - q) for p in points for q in points) or 1.0
    deviations = {}
    for point, sketched in linkage.sketch.points.items():
        owner = linkage.owner(point)
        if owner in poses:
            deviations[point] = abs(complex(poses[owner].at(linkage.local(owner, point))[0]) - sketched) / size
    return deviations


def check_fit(linkage: Linkage, poses: Mapping[str, Pose], fits: float = SKETCH_FITS) -> None:
    """Check that every sketched point and angle is near its computed value.

    fits: largest allowed deviation of points, as a fraction of the size of the linkage. Twice this number is the
    largest allowed deviation of angles, in rad.

    Raises:
        SketchMismatchError: a point or an angle deviates too much.
    """
    for point, off in sketch_deviations(linkage, poses).items():
        if off > fits:
            owner = linkage.owner(point)
            computed = complex(poses[owner].at(linkage.local(owner, point))[0])
            raise SketchMismatchError(point, linkage.sketch.points[point], computed)
    for link, angle in linkage.sketch.angles.items():
        if link in poses:
            turned = float(np.angle(poses[link].z)[0])
            if abs(np.angle(unit(to_float(angle - turned)))) > 2 * fits:  # rad
                raise SketchMismatchError(link, angle, turned)


# Assembly of groups of class III and higher: from the sketch if it shows all links, otherwise from all assemblies.


STARTS = 400  # initial guesses in one round of a search for all assemblies
MOST_LINKS = 16  # of a group: its equations are solved some ten thousand times
QUIET_ROUNDS = 3  # rounds without a new assembly, after which the search ends
MOST_ASSEMBLIES = 64  # a group with more is movable there, with an infinite number of assemblies
ROUNDS = 60  # damped steps from an arbitrary initial guess
STRIDE = 0.5  # rad, or sizes of the group: longest damped step
SKETCH_CLOSE = 0.25  # sizes of the group, rad: an assembly this near to a complete sketch is the required one


def refuse_large_group(group: Group) -> None:
    """Raise GroupTooLargeError if a group has more than MOST_LINKS links."""
    if len(group.links) > MOST_LINKS:
        raise GroupTooLargeError(group, MOST_LINKS)


def assemble_by_iteration(
    group: Group,
    linkage: Linkage,
    poses: dict[str, Pose],
    drives: DriverStates,
    before: tuple[GroupSolver, ...],
    like: GroupSolver | None = None,
) -> tuple[NewtonSolver, Placement]:
    """Assemble a group as the sketch shows it, by Newton's method, and trace it along the range of the driver.

    Args:
        group: the group.
        linkage: the linkage.
        poses: poses of the known links in the sketch.
        drives: coordinates of the drivers in the sketch.
        before: solvers of the earlier groups.
        like: solver of the same group with other lengths; its trace is corrected instead of being computed anew.

    Returns:
        The solver of the group, and its placement in the sketch.

    Raises:
        AssemblyError: the group cannot be assembled.
        AmbiguousSketchError: the sketch does not determine the assembly.
    """
    kernel = NewtonSolver.of(group, linkage)
    q = np.array([linkage.sketch.at])
    state = _close_from_sketch(kernel, linkage, poses, drives) or _search_state(kernel, linkage, poses, drives)
    all_poses = {**poses, **kernel.poses_of(state)}
    if float(singular_value_ratio(kernel.matrix(all_poses))[0]) < DEAD_SKETCH:
        raise AmbiguousSketchError(group, {})
    kernel = replace(kernel, start=state)
    if not kernel.by_angle:
        kernel = replace(kernel, trace=_trace_branch(kernel, linkage, before, state, like))
    return kernel, kernel.place(poses, q, drives)


def _trace_branch(
    kernel: NewtonSolver, linkage: Linkage, before: tuple[GroupSolver, ...], state: GroupState, like: GroupSolver | None
) -> BranchTrace | None:
    before = solvers_towards(before, {*kernel.group.known, *(d.base for d in kernel.group.drivers)})

    def source(q: Real, order: int) -> LinkStates:
        return link_states(linkage, before, q, order)

    turns = linkage.driver.kind == "turn"
    half = np.pi * (turns_of_cycle(linkage) or 1) if turns else slider_search_range(linkage)
    earlier_trace = like.followed if like is not None else None
    trace = (
        correct_trace(kernel, source, earlier_trace, linkage.sketch.at, state) if earlier_trace is not None else None
    )
    trace = trace or BranchFollower(kernel, source, half / np.pi).follow(linkage.sketch.at, state, half, turns)
    return trace if trace is None or turns else replace(trace, unit=kernel.size)


def placed_by_angles(
    kernel: NewtonSolver, poses: Mapping[str, Pose], drives: DriverStates, unwrapped: Real
) -> GroupState:
    """Find the origins of the links with which a group is nearest to closing for given angles.

    unwrapped: angles of the links (rad), shape (..., links).
    """
    shape, links = unwrapped.shape[:-1], len(kernel.group.links)
    still = GroupState(np.zeros((*shape, links), complex), unwrapped)
    known_poses = {name: pose.spread(shape) for name, pose in poses.items()}
    everything = {**known_poses, **kernel.poses_of(still)}
    origin_columns = [3 * k + coordinate for k in range(links) for coordinate in (0, 1)]
    matrix = kernel.matrix(everything)[..., origin_columns]
    origins = solve(matrix, -kernel.residuals(everything, drives))
    return GroupState(kernel.size * (origins[..., 0::2] + 1j * origins[..., 1::2]), unwrapped)


def close_from_afar(
    kernel: NewtonSolver, poses: Mapping[str, Pose], drives: DriverStates, state: GroupState
) -> tuple[GroupState, Real]:
    """Find assemblies of a group from arbitrary initial guesses: damped steps first, then Newton's method.

    Returns:
        The states, and True where Newton's method has converged.
    """
    known_poses = {name: pose.spread(state.x.shape[:-1]) for name, pose in poses.items()}
    with np.errstate(all="ignore"):
        for _ in range(ROUNDS):
            everything = {**known_poses, **kernel.poses_of(state)}
            step = solve(kernel.matrix(everything), -kernel.residuals(everything, drives))
            step_size = np.max(np.abs(step), axis=-1, keepdims=True)
            step = step * np.minimum(1.0, STRIDE / step_size)
            state = state.moved(step, kernel.size)
            if bool(np.all((step_size < LAST_STEP_AFAR) | ~np.isfinite(step_size))):
                break
        state, last = kernel.close(state, known_poses, drives)
        everything = {**known_poses, **kernel.poses_of(state)}
        residual = np.max(np.abs(kernel.residuals(everything, drives)), axis=-1)
    return state, (last < CONVERGED) & (residual < CONVERGED)


def all_assemblies(
    kernel: NewtonSolver, poses: Mapping[str, Pose], drives: DriverStates, seed: int = 1, starts: int = STARTS
) -> list[GroupState]:
    """Search for the real assemblies of a group at one driver coordinate, from many initial guesses.

    Of a movable group, which has infinitely many assemblies, some are returned.

    Args:
        kernel: solver of the group.
        poses: poses of the known links.
        drives: coordinates of the drivers.
        seed: seed of the pseudo-random angles.
        starts: number of initial guesses in each round.
    """
    random = np.random.default_rng(seed)
    assemblies: list[GroupState] = []
    quiet = 0
    links = len(kernel.group.links)
    while quiet < QUIET_ROUNDS and len(assemblies) < MOST_ASSEMBLIES:
        unwrapped = random.uniform(-np.pi, np.pi, (starts, links))
        start = placed_by_angles(kernel, poses, drives, unwrapped)
        states, closed = close_from_afar(kernel, poses, drives, start)
        new = False
        for k in np.flatnonzero(closed):
            if len(assemblies) == MOST_ASSEMBLIES:
                break
            state = GroupState(states.x[k : k + 1], np.angle(unit(states.unwrapped[k : k + 1])))
            if not any(_is_same_state(kernel, state, other) for other in assemblies):
                assemblies.append(state)
                new = True
        quiet = 0 if new else quiet + 1
        if kernel.by_angle and assemblies:
            break
    return sorted(assemblies, key=lambda s: tuple(np.round(s.unwrapped[0], 9)))


def _is_same_state(kernel: NewtonSolver, state: GroupState, other_state: GroupState) -> bool:
    turned = np.abs(unit(state.unwrapped) - unit(other_state.unwrapped))
    return bool(
        np.max(turned) < SAME_ASSEMBLY and np.max(np.abs(state.x - other_state.x)) < SAME_ASSEMBLY * kernel.size
    )


def _close_from_sketch(
    kernel: NewtonSolver, linkage: Linkage, poses: Mapping[str, Pose], drives: DriverStates
) -> GroupState | None:
    """Return the assembly of a group near the sketch.

    None if the sketch does not give the angles of all links of the group, or if no assembly is near it.
    """
    unwrapped = sketched_angles(kernel, linkage, poses, drives)
    if unwrapped is None:
        return None
    start = placed_by_angles(kernel, poses, drives, unwrapped)
    state, closed = close_from_afar(kernel, poses, drives, start)
    if not closed[0] or np.max(np.abs(state.unwrapped - start.unwrapped)) > SKETCH_CLOSE:
        return None
    computed = sketchable_values(linkage, kernel.poses_of(state))
    sketched = {**linkage.sketch.points, **linkage.sketch.angles}
    comparable = {name: value for name, value in sketched.items() if name in computed}
    return state if sketch_distance(comparable, computed, kernel.size) < SKETCH_CLOSE else None


def sketched_angles(
    kernel: NewtonSolver, linkage: Linkage, poses: Mapping[str, Pose], drives: DriverStates
) -> Real | None:
    """Return the angles of the links of a group in the sketch, shape (..., links).

    None if the sketch does not determine all of them.
    """
    angles: dict[str, Any] = {name: np.angle(pose.z) for name, pose in poses.items()}
    angles |= {name: angle for name, angle in linkage.sketch.angles.items() if name in kernel.order}
    for driver in kernel.group.drivers:  # the angle of a driven link follows from that of its base
        if driver.kind == "turn" and driver.base in angles:
            angles[driver.link] = angles[driver.base] + drives[driver.link].value
    known_points = {p: pose.at(at) for n, pose in poses.items() for p, at in linkage.links[n].points.items()}
    points: Mapping[str, Any] = {**linkage.sketch.points, **known_points}
    for link in kernel.group.links:
        sketched_points = [(local, points[p]) for p, local in linkage.links[link].points.items() if p in points]
        if link in angles or len(sketched_points) < 2:
            continue
        middle = sum(local for local, _ in sketched_points) / len(sketched_points)
        centre = sum(point for _, point in sketched_points) / len(sketched_points)
        turned = sum((point - centre) * (local - middle).conjugate() for local, point in sketched_points)
        if np.all(np.abs(turned) > 0):
            angles[link] = np.angle(turned)
    for _ in kernel.group.links:
        for slide in linkage.slides:
            if slide.carrier in angles and slide.runner not in angles:
                angles[slide.runner] = angles[slide.carrier] + slide.turned
            elif slide.runner in angles and slide.carrier not in angles:
                angles[slide.carrier] = angles[slide.runner] - slide.turned
    if kernel.by_angle:
        angles = dict.fromkeys(kernel.group.links, 0.0) | angles
    if any(link not in angles for link in kernel.group.links):
        return None
    still = np.zeros(np.shape(poses[FRAME].x))
    return np.stack([angles[link] + still for link in kernel.group.links], axis=-1)


def _search_state(
    kernel: NewtonSolver, linkage: Linkage, poses: Mapping[str, Pose], drives: DriverStates
) -> GroupState:
    states = all_assemblies(kernel, poses, drives)
    if not states:
        raise AssemblyError(kernel.group)
    if len(states) == MOST_ASSEMBLIES:  # positions of a movable group
        raise AmbiguousSketchError(kernel.group, {})
    return states[nearest_to_sketch(kernel, linkage, [kernel.poses_of(state) for state in states])]
