"""Stage: which of its assemblies each group has, from the sketch. The sign found holds for every position."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tmm_cli.groups import KERNELS
from tmm_cli.groups.base import Dyad, Placement, Pose
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.motion import driven_state, frame_state
from tmm_cli.structure.assur import Group, Structure

TELLS = 0.6  # a sketch tells two assemblies apart when it lies this much nearer to one of them
NEAR = 0.5  # and fits when its worst point is within this share of the group's size


class NotSolvable(Exception):
    """A group for which there is no kernel."""

    def __init__(self, group: Group) -> None:
        super().__init__(group.title)
        self.group = group


class NoAssembly(Exception):
    """The sketch cannot be assembled. gap: by how much (m) the group is short of closing at the sketch's place."""

    def __init__(self, group: Group, gap: float) -> None:
        super().__init__(group.title)
        self.group, self.gap = group, gap


class Undecided(Exception):
    """The sketch does not tell two assemblies apart.

    choices: for points (m) and links (rad) that would tell, the values in each assembly. off: the distance (m) from
    the sketched points to the nearest assembly, when it is what rules the sketch out.
    """

    def __init__(self, group: Group, choices: dict[str, tuple[complex | float, ...]], off: float | None) -> None:
        super().__init__(group.title)
        self.group, self.choices, self.off = group, choices, off


def assemble(linkage: Linkage, structure: Structure, groups: tuple[Group, ...] | None = None) -> tuple[Dyad, ...]:
    """The groups with their signs, in solving order.

    Raises NotSolvable, NoAssembly, Undecided.
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
    return tuple(chosen)


def _choose(dyad: Dyad, linkage: Linkage, poses: dict[str, Pose]) -> tuple[Dyad, Placement]:
    signs = (1, -1)[: dyad.assemblies]
    with np.errstate(invalid="ignore", divide="ignore"):
        ways = [(turned := replace(dyad, sign=sign), turned.place(poses)) for sign in signs]
    gap = float(ways[0][1].gap[0])
    if not ways[0][1].assembled[0] or not np.isfinite(ways[0][1].a.x[0]):
        raise NoAssembly(dyad.group, gap)
    if len(ways) == 1:
        return ways[0]
    hints = [_hints(dyad, linkage, at) for _, at in ways]
    tells = [name for name in hints[0] if abs(hints[0][name] - hints[1][name]) > 1e-9 * _scale(name, linkage, dyad)]
    if not tells and hints[0]:
        return ways[0]  # a dead position: both assemblies are one
    sketched = {name: value for name, value in _sketched(linkage).items() if name in tells}
    errors = [_distance(sketched, hint, dyad) for hint in hints]
    best = int(np.argmin(errors))
    choices = {name: (hints[0][name], hints[1][name]) for name in tells}
    if not sketched or errors[best] > TELLS * errors[1 - best]:
        raise Undecided(dyad.group, choices, None)
    if errors[best] > NEAR:
        raise Undecided(dyad.group, choices, errors[best] * dyad.size)
    return ways[best]


def _hints(dyad: Dyad, linkage: Linkage, at: Placement) -> dict[str, complex | float]:
    """Everything about the group's two links that a sketch may name: points and angles."""
    hints: dict[str, complex | float] = {}
    for name, pose in zip(dyad.group.links, (at.a, at.b), strict=True):
        hints |= {point: complex(pose.at(local)[0]) for point, local in linkage.links[name].points.items()}
        hints[name] = float(np.angle(pose.z)[0])
    return hints


def _sketched(linkage: Linkage) -> dict[str, complex | float]:
    return {**linkage.sketch.points, **linkage.sketch.angles}


def _scale(name: str, linkage: Linkage, dyad: Dyad) -> float:
    return 1.0 if name in linkage.links else dyad.size


def _distance(sketched: dict[str, complex | float], hint: dict[str, complex | float], dyad: Dyad) -> float:
    """The worst deviation of the sketch from an assembly: points against the group's size, angles against a radian."""
    worst = 0.0
    for name, value in sketched.items():
        if isinstance(value, complex):
            worst = max(worst, abs(value - hint[name]) / dyad.size)
        else:
            worst = max(worst, abs(np.angle(np.exp(1j * (value - float(hint[name].real))))))
    return worst
