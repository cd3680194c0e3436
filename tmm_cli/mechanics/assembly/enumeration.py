"""All real assemblies of each group at one driver coordinate; the links before the group are placed as in the sketch.

- Groups of class II have one or two assemblies, in closed form.
- The assemblies of triads are the roots of a polynomial (see triad).
- Groups whose angles follow from linear equations between angles (gear trains) have one assembly.
- For all other groups assemblies are searched by Newton's method from many initial guesses. The number of guesses is
  limited, so an assembly may be missed.

Assemblies come in pairs if there is more than one, except in dead positions, in which two of them coincide.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from tmm_cli.mechanics.assembly.assembling import closed_form_solver
from tmm_cli.mechanics.assembly.sketch_matching import all_assemblies, close_from_afar
from tmm_cli.mechanics.assembly.triad import Triad, triad_starts
from tmm_cli.mechanics.groups import (
    ClosedFormSolver,
    DriverStates,
    GroupSolver,
    GroupState,
    LinkStates,
    NewtonSolver,
    Pose,
    link_states,
)
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import ASSEMBLIES_MEET, DEAD, GROUP_CLOSED, SAME_ASSEMBLY, singular_value_ratio
from tmm_cli.mechanics.structure import Group, Structure

Method = Literal["closed form", "polynomial", "angles", "many starts"]

STARTS, LEAST_STARTS, SMALL = 400, 60, 8  # initial guesses; fewer for larger groups, as each then takes longer
ROUNDS = 4  # most rounds of initial guesses, while an odd number shows that an assembly is missing
STEP, STAYS = 0.02, 0.005  # sizes, rad: step that tests whether a group is movable, and least deviation that remains
BACK = 40  # iterations after the step, which would return a group that is not movable


@dataclass(frozen=True)
class Assembly:
    """One assembly of a group.

    Attributes:
        poses: pose of each link, by name.
        angles: angle of each link (rad), by name.
        points: positions (m), by name, of the points that belong to no link solved before the group.
        margin: distance from a dead position; see Placement.
        of_sketch: True if the sketch shows this assembly.
    """

    poses: Mapping[str, Pose]
    angles: Mapping[str, float]
    points: Mapping[str, complex]
    margin: float
    of_sketch: bool = False


@dataclass(frozen=True)
class GroupAssemblies:
    """The assemblies of a group at one driver coordinate.

    Attributes:
        group: the group.
        assemblies: the assemblies.
        method: method by which they were found.
        most: largest possible number of assemblies; None if unknown.
        moves: True if the group can move while the driver is fixed. It then has infinitely many assemblies, of which
            one is listed.
    """

    group: Group
    assemblies: tuple[Assembly, ...]
    method: Method
    most: int | None = None
    moves: bool = False

    @property
    def complete(self) -> bool:
        """True if it is certain that there are no other assemblies."""
        return self.method != "many starts" and not self.moves

    @property
    def dead(self) -> bool:
        """True if the group is in a dead position, in which two assemblies coincide."""
        return any(assembly.margin < DEAD for assembly in self.assemblies)


@dataclass(frozen=True)
class Assemblies:
    """Assemblies of all groups at one driver coordinate.

    Attributes:
        q: driver coordinate (rad or m).
        number: number of the position in the table of positions; None if q is not one of these positions.
        poses: poses of all links in the assembly of the sketch, by name.
        groups: assemblies of each group, in solving order.
        undecided: group whose assembly the sketch does not determine, or None; later groups are not listed.
        lost: groups without assemblies because links on which they depend cannot be assembled here.
    """

    q: float
    number: int | None
    poses: Mapping[str, Pose]
    groups: tuple[GroupAssemblies, ...]
    undecided: Group | None = None
    lost: tuple[Group, ...] = ()


def name_assembly_files(positions: Sequence[Assemblies]) -> list[tuple[str, Assemblies, GroupAssemblies]]:
    """Choose a file name for the assemblies of each group, e.g. assemblies-III-2-3-4-5.

    If there are several positions, the number of the position is appended.

    Returns:
        File name without ending, position and group, for each group.
    """
    files: dict[str, tuple[str, Assemblies, GroupAssemblies]] = {}
    for position in positions:
        for group in position.groups:
            number = f"-{position.number:02d}" if len(positions) > 1 and position.number is not None else ""
            name = "-".join(["assemblies", group.group.title.split("(")[0], *group.group.links])
            stem = re.sub(r"[^A-Za-z0-9_-]", "_", name)[:80] + number
            stem = f"{stem}-{len(files)}" if stem in files else stem
            files[stem] = (stem, position, group)
    return list(files.values())


def find_assemblies(
    linkage: Linkage, structure: Structure, kernels: tuple[GroupSolver, ...], q: float, number: int | None = None
) -> Assemblies:
    """Find all assemblies of each group at the driver coordinate q.

    If the sketch does not determine the assemblies of all groups, the first undetermined group is listed too.

    Args:
        linkage: the linkage.
        structure: its structure.
        kernels: solvers of the groups whose assemblies the sketch determines, in solving order.
        q: driver coordinate (rad or m).
        number: number of the position in the table of positions; None if q is not one of these positions.
    """
    motion = link_states(linkage, kernels, np.array([q]), 0)
    decided = {kernel.group.links for kernel in kernels}
    undecided = next((group for group in structure.solved if group.links not in decided), None)
    listed, lost = [], []
    placed = {link: motion.poses[link] for link in (FRAME, *(driver.link for driver in linkage.cranks))}
    for group in [*(kernel.group for kernel in kernels), *([undecided] if undecided else [])]:
        if all(bool(np.isfinite(motion.poses[link].x[0] + motion.poses[link].z[0])) for link in group.known):
            listed.append(_list_assemblies(group, linkage, motion, dict(placed)))
        else:
            lost.append(group)
        placed |= {link: motion.poses[link] for link in group.links if link in motion.poses}
    return Assemblies(q, number, motion.poses, tuple(listed), undecided, tuple(lost))


def _list_assemblies(group: Group, linkage: Linkage, motion: LinkStates, placed: Mapping[str, Pose]) -> GroupAssemblies:
    kernel = closed_form_solver(group, linkage)
    if kernel is not None:
        assemblies = tuple(_closed_form_assemblies(kernel, linkage, placed, motion.drives))
        listed = GroupAssemblies(group, assemblies, "closed form", kernel.assemblies)
    else:
        listed = _iterated_assemblies(group, linkage, placed, motion)
    sketched = _sketched_poses(group, motion)
    if sketched is None:
        return listed
    size = max((abs(p) for link in group.links for p in linkage.links[link].points.values()), default=1.0) or 1.0
    marked = [replace(a, of_sketch=_pose_distance(a.poses, sketched, size) < SAME_ASSEMBLY) for a in listed.assemblies]
    return replace(listed, assemblies=tuple(marked))


def _sketched_poses(group: Group, motion: LinkStates) -> dict[str, Pose] | None:
    """Return the poses of a group in the assembly of the sketch; None if it is unknown or cannot be assembled here."""
    poses = {link: motion.poses[link] for link in group.links if link in motion.poses}
    sound = len(poses) == len(group.links) and all(np.isfinite(p.x[0] + p.z[0]) for p in poses.values())
    return poses if sound else None


def _pose_distance(poses: Mapping[str, Pose], other_poses: Mapping[str, Pose], size: float) -> float:
    """Return the distance between two sets of poses of the same links; infinite if a pose is undefined.

    Lengths are divided by `size`.
    """
    off = max(
        abs(complex(p.x[0] - other_poses[n].x[0])) / size + abs(complex(p.z[0] - other_poses[n].z[0]))
        for n, p in poses.items()
    )
    return float(off) if np.isfinite(off) else np.inf


def _make_assembly(linkage: Linkage, placed: Iterable[str], poses: Mapping[str, Pose], margin: float) -> Assembly:
    known_points = {point for link in placed for point in linkage.links[link].points}
    points = {
        point: complex(pose.at(local)[0])
        for link, pose in poses.items()
        for point, local in linkage.links[link].points.items()
        if point not in known_points
    }
    angles = {link: float(np.angle(pose.z)[0]) for link, pose in poses.items()}
    return Assembly(poses, angles, points, margin)


def _closed_form_assemblies(
    kernel: ClosedFormSolver, linkage: Linkage, placed: Mapping[str, Pose], drives: DriverStates
) -> Iterable[Assembly]:
    """Yield the assemblies of a group in closed form: two, one in a dead position, none if it cannot be assembled."""
    for sign in (1, -1)[: kernel.assemblies]:
        with np.errstate(invalid="ignore", divide="ignore"):
            at = replace(kernel, sign=sign).closed(placed, drives)
        if not at.assembled[0] or not np.isfinite(at.a.x[0] + at.b.x[0]):
            return
        yield _make_assembly(linkage, placed, dict(zip(kernel.group.links, at.poses, strict=True)), float(at.margin[0]))
        if at.dead[0]:
            return


def _iterated_assemblies(
    group: Group, linkage: Linkage, placed: Mapping[str, Pose], motion: LinkStates
) -> GroupAssemblies:
    """Find the assemblies of a group of class III or higher, or of one with higher pairs or drivers."""
    kernel = NewtonSolver.of(group, linkage)
    with np.errstate(all="ignore"):
        states, method, most = _search_states(kernel, linkage, placed, motion)
        assemblies: list[Assembly] = []
        moves = False
        for state in states:
            poses = kernel.poses_of(state)
            margin = float(singular_value_ratio(kernel.matrix({**placed, **poses}))[0])
            if margin < DEAD and _moves_by_itself(kernel, state, placed, motion.drives):
                if moves:
                    continue
                moves = True
            if not any(_is_listed(kernel.size, poses, margin, other) for other in assemblies):
                assemblies.append(_make_assembly(linkage, placed, poses, margin))
    assemblies.sort(key=lambda a: tuple(round(angle, 6) for angle in a.angles.values()))
    return GroupAssemblies(group, tuple(assemblies), method, most, moves)


def _search_states(
    kernel: NewtonSolver, linkage: Linkage, placed: Mapping[str, Pose], motion: LinkStates
) -> tuple[list[GroupState], Method, int | None]:
    """Find the states of all assemblies of a group by the method that suits it.

    Returns:
        The states (some may be repeated), the method, and the largest possible number of assemblies or None.
    """
    drives = motion.drives
    triad = Triad.of(kernel.group, linkage, kernel.size)
    guesses = None if triad is None else triad_starts(triad, placed)
    if guesses is None and kernel.by_angle:
        return all_assemblies(kernel, placed, drives), "angles", 1
    if guesses is None:
        return _by_many_starts(kernel, placed, motion), "many starts", None
    start, most = guesses
    number = len(start.x)
    if not number:
        return [], "polynomial", most
    known_poses = {name: pose.spread((number,)) for name, pose in placed.items()}
    residuals = np.max(np.abs(kernel.residuals({**known_poses, **kernel.poses_of(start)}, drives)), axis=-1)
    near, closed = close_from_afar(kernel, placed, drives, start)
    # exactly in a dead position Newton's method has no next step, but the initial guess is the solution
    sound = [(near if closed[k] else start, k) for k in range(number) if closed[k] or residuals[k] < GROUP_CLOSED]
    return [states.part(slice(k, k + 1)) for states, k in sound], "polynomial", most


def _by_many_starts(kernel: NewtonSolver, placed: Mapping[str, Pose], motion: LinkStates) -> list[GroupState]:
    """Find the states of a group from many initial guesses, and add the state of the sketch.

    If all pairs are revolute, the number of assemblies is even: with one external pair released, the group moves along
    a closed curve, on which the pair closes an even number of times. An odd number shows that an assembly is missing.
    """
    sketched = _sketched_poses(kernel.group, motion)
    states: list[GroupState] = []
    if sketched is not None:
        poses = [sketched[link] for link in kernel.group.links]
        states.append(GroupState(np.stack([p.x for p in poses], -1), np.stack([p.turned for p in poses], -1)))
    number = max(LEAST_STARTS, int(STARTS * min(1.0, (SMALL / len(kernel.group.links)) ** 3)))
    turning = not kernel.passive and all(c.kind == "R" for c in kernel.constraints)
    for seed in range(1, ROUNDS + 1):
        for state in all_assemblies(kernel, placed, motion.drives, seed, number):
            new_poses = kernel.poses_of(state)
            if not any(
                _pose_distance(new_poses, kernel.poses_of(other), kernel.size) < SAME_ASSEMBLY for other in states
            ):
                states.append(state)
        if not turning or len(states) % 2 == 0:
            break
    return states


def _is_listed(size: float, poses: Mapping[str, Pose], margin: float, other: Assembly) -> bool:
    """Return True if these poses are those of the assembly `other`, which is already listed.

    In a dead position both are accurate to half the digits only.
    """
    apart = _pose_distance(poses, other.poses, size)
    return apart < SAME_ASSEMBLY or (apart < ASSEMBLIES_MEET and max(margin, other.margin) < DEAD)


def _moves_by_itself(kernel: NewtonSolver, state: GroupState, placed: Mapping[str, Pose], drives: DriverStates) -> bool:
    """Return True if a group in a dead position can move while the driver is fixed.

    Its links are displaced in the direction in which they are free, and the group is closed again. If it can move, it
    does not return to its first state.
    """
    free = np.linalg.svd(kernel.matrix({**placed, **kernel.poses_of(state)})[0])[2][-1]
    moved = state.moved(STEP * free / np.max(np.abs(free)), kernel.size)
    residual = np.inf
    for _ in range(BACK):
        poses = {**placed, **kernel.poses_of(moved)}
        residuals = kernel.residuals(poses, drives)[0]
        residual = float(np.max(np.abs(residuals)))
        moved = moved.moved(-np.linalg.pinv(kernel.matrix(poses)[0], rcond=DEAD) @ residuals, kernel.size)
    off = max(np.max(np.abs(moved.x - state.x)) / kernel.size, np.max(np.abs(moved.unwrapped - state.unwrapped)))
    return bool(residual < GROUP_CLOSED and off > STAYS)
