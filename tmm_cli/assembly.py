"""Stage: which of its assemblies each group has, from the sketch. It is kept in every position."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tmm_cli.cycle import turns_of_cycle
from tmm_cli.groups import KERNELS
from tmm_cli.groups.base import Closed, Kernel, Turn, reach
from tmm_cli.groups.state import Drives, Placement, Pose
from tmm_cli.groups.telescope import Chain, Telescope
from tmm_cli.groups.winding import Winding
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.motion import Law, Motion, driven_state, drives_at, frame_state, move, towards
from tmm_cli.refused import Misfit, NoAssembly, Undecided
from tmm_cli.structure.assur import Group, Structure

TELLS = 0.6  # a sketch tells two assemblies apart when it lies this much nearer to one of them
FITS = 0.5  # a sketched point may lie this share of the linkage's size from its place, a link 1 rad from its angle
FOLLOWED = 720  # places a turn at which angles are followed through

Hints = dict[str, complex | float]


def assemble(linkage: Linkage, structure: Structure, groups: tuple[Group, ...] | None = None) -> tuple[Kernel, ...]:
    """The groups with their assemblies, in solving order.

    Raises NoAssembly, Undecided, Misfit.
    """
    q = np.array([linkage.sketch.at])
    drives = drives_at(linkage, q)
    poses = {FRAME: frame_state(q)[0]}
    for driver in linkage.cranks:
        poses[driver.link] = driven_state(linkage, driver, drives[driver.link])[0]
    chosen: list[Kernel] = []
    for group in structure.solved if groups is None else groups:
        kernel, at = _assembled(group, linkage, poses, drives, tuple(chosen))
        poses.update(zip(kernel.group.links, at.poses, strict=True))
        chosen.append(kernel)
    _check_fit(linkage, poses)
    return tuple(chosen)


def _assembled(
    group: Group, linkage: Linkage, poses: dict[str, Pose], drives: Drives, before: tuple[Kernel, ...]
) -> tuple[Kernel, Placement]:
    q = np.array([linkage.sketch.at])
    closed = closed_form(group, linkage)
    if closed is not None:
        kernel, at = _choose(closed, linkage, poses, drives)
        geared = {name for mesh in linkage.meshes for name in (mesh.i, mesh.j, mesh.carrier)} & set(group.links)
        if geared:
            kernel = replace(kernel, winding=_winding(linkage, (*before, kernel), tuple(geared)))
            at = kernel.place(poses, q, drives)
        return kernel, at
    from tmm_cli.assembly_newton import assembled  # class II alone needs none of it

    return assembled(group, linkage, poses, drives, before)


def closed_form(group: Group, linkage: Linkage) -> Closed | None:
    """The group with its numbers, not yet assembled, if it has a closed form."""
    if group.type in KERNELS and not group.drivers:
        return KERNELS[group.type].of(group, linkage)
    chain = Chain.of(group)
    return Telescope.of(group, linkage) if chain is not None and chain.dyad.type in KERNELS else None


def _winding(linkage: Linkage, kernels: tuple[Kernel, ...], links: tuple[str, ...]) -> Winding:
    """Angles of the last group's links over a cycle about the sketch, as far as the driver can go."""
    turns, at = turns_of_cycle(linkage) or 1, linkage.sketch.at
    half = turns * np.pi if linkage.driver.kind == "turn" else reach(linkage)
    q = at + half * np.linspace(-1, 1, FOLLOWED * turns + 1)
    motion = move(linkage, towards(kernels, links), q, Law(at, 1.0, 0.0, 1), 0)
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
        raise NoAssembly(kernel.group, float(first.gap[0]))
    if len(ways) == 1:
        return ways[0]
    if first.dead[0]:
        raise Undecided(kernel.group, {})
    return ways[nearest_to_sketch(kernel, linkage, [at.poses for _, at in ways], _shift(kernel, linkage, poses))]


def nearest_to_sketch(
    kernel: Kernel, linkage: Linkage, ways: list[tuple[Pose, ...]], shift: complex = 0j
) -> int:  # fmt: skip
    """Which of several assemblies the sketch shows. Raises Undecided when it does not tell."""
    if len(ways) == 1:
        return 0
    hints = [_hints(kernel, linkage, poses) for poses in ways]
    tells = [
        name for name in hints[0]
        if any(abs(hint[name] - hints[0][name]) > _scale(name, linkage, kernel) for hint in hints[1:])
    ]  # fmt: skip
    sketched = {p: place - shift for p, place in linkage.sketch.points.items()} | dict(linkage.sketch.angles)
    given = {name: sketched[name] for name in tells if name in sketched}
    errors = [sketch_distance(given, hint, kernel) for hint in hints]
    best, second = (int(k) for k in np.argsort(errors, kind="stable")[:2])
    if not given or errors[best] > TELLS * errors[second]:
        choices = {name: (hints[best][name], hints[second][name]) for name in tells}
        raise Undecided(kernel.group, choices, len(ways))
    return best


def _shift(kernel: Closed, linkage: Linkage, poses: dict[str, Pose]) -> complex:
    """How far the sketch has the hinges that the group hangs on from where they are (m).

    What a sketch tells is on which side of them the group lies, so a group is compared with them put in their places.
    """
    shifts = []
    for pair, end in kernel.leads:
        if isinstance(end, Turn):
            if end.known == FRAME:
                shifts.append(0j)
            elif pair.point in linkage.sketch.points:
                shifts.append(linkage.sketch.points[pair.point] - complex(poses[end.known].at(end.there)[0]))
    return sum(shifts) / len(shifts) if shifts else 0j


def sketch_deviations(linkage: Linkage, poses: Mapping[str, Pose]) -> dict[str, float]:
    """How far every sketched point is from its place, as a share of the linkage's size."""
    places = [complex(pose.at(p)[0]) for name, pose in poses.items() for p in linkage.links[name].points.values()]
    size = max(abs(p - q) for p in places for q in places) or 1.0
    found = {}
    for point, sketched in linkage.sketch.points.items():
        owner = linkage.owner(point)
        if owner in poses:
            found[point] = abs(complex(poses[owner].at(linkage.local(owner, point))[0]) - sketched) / size
    return found


def _check_fit(linkage: Linkage, poses: dict[str, Pose]) -> None:
    """Every sketched point and angle, whether it decided something or not, lies about where it was drawn."""
    for point, off in sketch_deviations(linkage, poses).items():
        if off > FITS:
            owner = linkage.owner(point)
            found = complex(poses[owner].at(linkage.local(owner, point))[0])
            raise Misfit(point, linkage.sketch.points[point], found)
    for link, angle in linkage.sketch.angles.items():
        if link in poses:
            turned = float(np.angle(poses[link].z)[0])
            if abs(np.angle(np.exp(1j * (angle - turned)))) > 2 * FITS:  # rad
                raise Misfit(link, angle, turned)


def _hints(kernel: Kernel, linkage: Linkage, poses: tuple[Pose, ...]) -> Hints:
    """Everything about the group's links that a sketch may name: points and angles."""
    hints: Hints = {}
    for name, pose in zip(kernel.group.links, poses, strict=True):
        hints |= {point: complex(pose.at(local)[0]) for point, local in linkage.links[name].points.items()}
        hints[name] = float(np.angle(pose.z)[0])
    return hints


def _scale(name: str, linkage: Linkage, kernel: Kernel) -> float:
    """Differences below this are rounding."""
    return 1e-9 * (1.0 if name in linkage.links else kernel.size)


def sketch_distance(sketched: Mapping[str, complex | float], hint: Hints, kernel: Kernel) -> float:
    """The worst deviation of the sketch from an assembly: points against the group's size, angles against a radian."""
    worst = 0.0
    for name, value in sketched.items():
        if isinstance(value, complex):
            worst = max(worst, abs(value - hint[name]) / kernel.size)
        else:
            worst = max(worst, abs(np.angle(np.exp(1j * (value - float(hint[name].real))))))
    return worst


def source(linkage: Linkage, kernels: tuple[Kernel, ...], q: np.ndarray, order: int = 2) -> Motion:
    """Motion of the links placed so far by the driver's place alone."""
    return move(linkage, kernels, q, Law(linkage.sketch.at, 1.0, 0.0, 1), order)
