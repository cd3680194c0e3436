"""Stage: which of its assemblies each group has, from the sketch. The sign found holds for every position."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tmm_cli.groups import KERNELS
from tmm_cli.groups.base import Dyad, Placement, Pose, Turn
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.motion import driven_state, frame_state
from tmm_cli.refused import Misfit, NoAssembly, NotSolvable, Undecided
from tmm_cli.structure.assur import Group, Structure

TELLS = 0.6  # a sketch tells two assemblies apart when it lies this much nearer to one of them
FITS = 0.5  # a sketched point may lie this share of the linkage's size from its place, a link 1 rad from its angle


def assemble(linkage: Linkage, structure: Structure, groups: tuple[Group, ...] | None = None) -> tuple[Dyad, ...]:
    """The groups with their signs, in solving order.

    Raises NotSolvable, NoAssembly, Undecided, Misfit.
    """
    q = np.array([linkage.sketch.at])
    poses = {FRAME: frame_state(q)[0], linkage.driver.link: driven_state(linkage, linkage.driver, q)[0]}
    chosen = []
    for group in structure.groups if groups is None else groups:
        if group.type not in KERNELS:
            raise NotSolvable(group)
        dyad, at = _choose(KERNELS[group.type].of(group, linkage), linkage, poses)
        poses[group.links[0]], poses[group.links[1]] = at.a, at.b
        chosen.append(dyad)
    _check_fit(linkage, poses)
    return tuple(chosen)


def _choose(dyad: Dyad, linkage: Linkage, poses: dict[str, Pose]) -> tuple[Dyad, Placement]:
    with np.errstate(invalid="ignore", divide="ignore"):
        ways = [(replace(dyad, sign=s), replace(dyad, sign=s).place(poses)) for s in (1, -1)[: dyad.assemblies]]
    first = ways[0][1]
    if not first.assembled[0] or not np.isfinite(first.a.x[0] + first.b.x[0]):
        raise NoAssembly(dyad.group, float(first.gap[0]))
    if len(ways) == 1:
        return ways[0]
    if first.dead[0]:
        raise Undecided(dyad.group, {})
    hints = [_hints(dyad, linkage, at) for _, at in ways]
    tells = [name for name in hints[0] if abs(hints[0][name] - hints[1][name]) > _scale(name, linkage, dyad)]
    shift = _shift(dyad, linkage, poses)
    sketched = {p: place - shift for p, place in linkage.sketch.points.items()} | dict(linkage.sketch.angles)
    given = {name: sketched[name] for name in tells if name in sketched}
    errors = [_distance(given, hint, dyad) for hint in hints]
    best = int(np.argmin(errors))
    if not given or errors[best] > TELLS * errors[1 - best]:
        raise Undecided(dyad.group, {name: (hints[0][name], hints[1][name]) for name in tells})
    return ways[best]


def _shift(dyad: Dyad, linkage: Linkage, poses: dict[str, Pose]) -> complex:
    """How far the sketch has the hinges that the group hangs on from where they are (m).

    What a sketch tells is on which side of them the group lies, so a group is compared with them put in their places.
    """
    shifts = []
    for pair, end in zip(dyad.group.outer, dyad.ends, strict=True):
        if isinstance(end, Turn):
            if end.known == FRAME:
                shifts.append(0j)
            elif pair.point in linkage.sketch.points:
                shifts.append(linkage.sketch.points[pair.point] - complex(poses[end.known].at(end.there)[0]))
    return sum(shifts) / len(shifts) if shifts else 0j


def sketch_deviations(linkage: Linkage, poses: Mapping[str, Pose]) -> dict[str, float]:
    """How far every sketched point is from its place, as a share of the linkage's size."""
    places = [complex(pose.at(p)[0]) for name, pose in poses.items() for p in linkage.links[name].points.values()]
    size = max(abs(p - q) for p in places for q in places)
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


def _hints(dyad: Dyad, linkage: Linkage, at: Placement) -> dict[str, complex | float]:
    """Everything about the group's two links that a sketch may name: points and angles."""
    hints: dict[str, complex | float] = {}
    for name, pose in zip(dyad.group.links, (at.a, at.b), strict=True):
        hints |= {point: complex(pose.at(local)[0]) for point, local in linkage.links[name].points.items()}
        hints[name] = float(np.angle(pose.z)[0])
    return hints


def _scale(name: str, linkage: Linkage, dyad: Dyad) -> float:
    """Differences below this are rounding."""
    return 1e-9 * (1.0 if name in linkage.links else dyad.size)


def _distance(sketched: dict[str, complex | float], hint: dict[str, complex | float], dyad: Dyad) -> float:
    """The worst deviation of the sketch from an assembly: points against the group's size, angles against a radian."""
    worst = 0.0
    for name, value in sketched.items():
        if isinstance(value, complex):
            worst = max(worst, abs(value - hint[name]) / dyad.size)
        else:
            worst = max(worst, abs(np.angle(np.exp(1j * (value - float(hint[name].real))))))
    return worst
