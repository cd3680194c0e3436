"""Stage: which of its assemblies each group has, from the sketch. It is kept in every position."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tmm_cli.assembly.change_points import smooth_way
from tmm_cli.assembly.search import assembled
from tmm_cli.assembly.sketch import check_fit, nearest_to_sketch
from tmm_cli.errors import AmbiguousSketchError, AssemblyError
from tmm_cli.groups import CLOSED
from tmm_cli.groups.base import Closed, HingeEnd, Kernel, reach
from tmm_cli.groups.sequence import driven_state, drives_at, frame_state, link_states, towards
from tmm_cli.groups.state import Drives, Placement, Pose
from tmm_cli.groups.unwrapped_angles import Winding
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.structure.assur import Group, Structure
from tmm_cli.structure.cycle import turns_of_cycle

BLAMED = 0.25  # a sketched point this share of the size from its place, a link half a radian: it was sketched wrong
FOLLOWED = 720  # places a turn at which angles are followed through


def assemble(
    linkage: Linkage, structure: Structure, groups: tuple[Group, ...] | None = None, like: tuple[Kernel, ...] = ()
) -> tuple[Kernel, ...]:
    """The groups with their assemblies, in solving order; like: those of a linkage whose lengths differ, which helps.

    Raises AssemblyError, AmbiguousSketchError, SketchMismatchError.
    """
    q = np.array([linkage.sketch.at])
    drives = drives_at(linkage, q)
    poses = {FRAME: frame_state(q)[0]}
    for driver in linkage.cranks:
        poses[driver.link] = driven_state(linkage, driver, drives[driver.link])[0]
    chosen: list[Kernel] = []
    for group in structure.solved if groups is None else groups:
        other = like[len(chosen)] if like else None
        try:
            kernel, at = _assembled(group, linkage, poses, drives, tuple(chosen), other)
        except (AssemblyError, AmbiguousSketchError):
            check_fit(linkage, poses, BLAMED)  # a group before it, sketched wrong, may be what keeps it from closing
            raise
        poses.update(zip(kernel.group.links, at.poses, strict=True))
        chosen.append(kernel)
    check_fit(linkage, poses)
    return tuple(chosen)


def _assembled(
    group: Group, linkage: Linkage, poses: dict[str, Pose], drives: Drives, before: tuple[Kernel, ...],
    like: Kernel | None,
) -> tuple[Kernel, Placement]:  # fmt: skip
    q = np.array([linkage.sketch.at])
    closed = closed_form(group, linkage)
    if closed is not None:
        kernel, at = _choose(closed, linkage, poses, drives)
        if kernel.assemblies > 1 and not linkage.keep_side:
            kernel = replace(kernel, way=smooth_way(linkage, before, kernel))
        geared = {name for mesh in linkage.meshes for name in (mesh.i, mesh.j, mesh.carrier)} & set(group.links)
        if geared:
            kernel = replace(kernel, winding=_winding(linkage, (*before, kernel), tuple(geared)))
            at = kernel.place(poses, q, drives)
        return kernel, at
    return assembled(group, linkage, poses, drives, before, like)


def closed_form(group: Group, linkage: Linkage) -> Closed | None:
    """The group with its numbers, not yet assembled, if it has a closed form."""
    return next((kind.of(group, linkage) for kind in CLOSED if kind.fits(group)), None)


def _winding(linkage: Linkage, kernels: tuple[Kernel, ...], links: tuple[str, ...]) -> Winding:
    """Angles of the last group's links over a cycle about the sketch, as far as the driver can go."""
    turns, at = turns_of_cycle(linkage) or 1, linkage.sketch.at
    half = turns * np.pi if linkage.driver.kind == "turn" else reach(linkage)
    q = at + half * np.linspace(-1, 1, FOLLOWED * turns + 1)
    motion = link_states(linkage, towards(kernels, links), q, 0)
    middle = len(q) // 2
    lost = np.flatnonzero(~motion.placed)
    first = int(lost[lost < middle].max(initial=-1)) + 1
    last = int(lost[lost > middle].min(initial=len(q)))
    angles = {}
    for link in links:
        z = motion.poses[link].z[first:last]
        angle = np.unwrap(np.angle(z))
        here = middle - first
        angles[link] = angle + (np.angle(z[here]) - angle[here])
    closed = first == 0 and last == len(q) and linkage.driver.kind == "turn"
    return Winding(q[first:last], angles, closed)


def _choose(kernel: Closed, linkage: Linkage, poses: dict[str, Pose], drives: Drives) -> tuple[Closed, Placement]:
    signed = [replace(kernel, sign=s) for s in (1, -1)[: kernel.assemblies]]
    with np.errstate(invalid="ignore", divide="ignore"):
        ways = [(one, one.closed(poses, drives)) for one in signed]
    first = ways[0][1]
    if not first.assembled[0] or not np.isfinite(first.a.x[0] + first.b.x[0]):
        raise AssemblyError(kernel.group, float(first.residual[0]))
    if len(ways) == 1:
        return ways[0]
    if first.dead[0]:
        raise AmbiguousSketchError(kernel.group, {})
    placed = [dict(zip(kernel.group.links, at.poses, strict=True)) for _, at in ways]
    return ways[nearest_to_sketch(kernel, linkage, placed, _shift(kernel, linkage, poses))]


def _shift(kernel: Closed, linkage: Linkage, poses: dict[str, Pose]) -> complex:
    """How far the sketch has the hinges that the group hangs on from where they are (m).

    What a sketch tells is on which side of them the group lies, so a group is compared with them put in their places.
    """
    shifts = []
    for pair, end in kernel.outer_pairs:
        if isinstance(end, HingeEnd):
            if end.known == FRAME:
                shifts.append(0j)
            elif pair.point in linkage.sketch.points:
                shifts.append(linkage.sketch.points[pair.point] - complex(poses[end.known].at(end.there)[0]))
    return sum(shifts) / len(shifts) if shifts else 0j
