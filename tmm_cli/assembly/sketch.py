"""What the sketch shows of an assembly: which of several it is, and whether it is about that one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from tmm_cli.errors import AmbiguousSketchError, SketchMismatchError
from tmm_cli.groups.base import Kernel
from tmm_cli.groups.state import Pose
from tmm_cli.linkage import Linkage
from tmm_cli.tolerances import SAME_IN_SKETCH

TELLS = 0.6  # a sketch tells two assemblies apart when it lies this much nearer to one of them
FITS = 0.5  # a sketched point may lie this share of the linkage's size from its place, a link 1 rad from its angle

Shown = dict[str, complex | float]  # points (m) and angles of links (rad) by their names


def sketchable(linkage: Linkage, poses: Mapping[str, Pose]) -> Shown:
    """Everything about some links that a sketch may name: points and angles."""
    shown: Shown = {}
    for name, pose in poses.items():
        shown |= {point: complex(pose.at(local)[0]) for point, local in linkage.links[name].points.items()}
        shown[name] = float(np.angle(pose.z)[0])
    return shown


def sketch_distance(sketched: Mapping[str, complex | float], shown: Shown, size: float) -> float:
    """The worst deviation of the sketch from an assembly: points against the group's size, angles against a radian."""
    worst = 0.0
    for name, value in sketched.items():
        if isinstance(value, complex):
            worst = max(worst, abs(value - shown[name]) / size)
        else:
            worst = max(worst, abs(np.angle(np.exp(1j * (value - float(shown[name].real))))))
    return worst


def nearest_to_sketch(
    kernel: Kernel, linkage: Linkage, assemblies: Sequence[Mapping[str, Pose]], shift: complex = 0j
) -> int:  # fmt: skip
    """Which of several assemblies the sketch shows. Raises AmbiguousSketchError when it does not tell.

    shift: how far the sketch has the links that the group hangs on from where they are (m).
    """
    if len(assemblies) == 1:
        return 0
    shown = [sketchable(linkage, poses) for poses in assemblies]
    tells = [
        name for name in shown[0]
        if any(abs(one[name] - shown[0][name]) > SAME_IN_SKETCH * (1.0 if name in linkage.links else kernel.size)
               for one in shown[1:])
    ]  # fmt: skip
    sketched = {p: place - shift for p, place in linkage.sketch.points.items()} | dict(linkage.sketch.angles)
    given = {name: sketched[name] for name in tells if name in sketched}
    errors = [sketch_distance(given, one, kernel.size) for one in shown]
    best, second = (int(k) for k in np.argsort(errors, kind="stable")[:2])
    if not given or errors[best] > TELLS * errors[second]:
        choices = {name: (shown[best][name], shown[second][name]) for name in tells}
        raise AmbiguousSketchError(kernel.group, choices, len(assemblies))
    return best


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


def check_fit(linkage: Linkage, poses: Mapping[str, Pose], fits: float = FITS) -> None:
    """Every sketched point and angle, whether it decided something or not, lies about where it was drawn.

    Raises SketchMismatchError.
    """
    for point, off in sketch_deviations(linkage, poses).items():
        if off > fits:
            owner = linkage.owner(point)
            found = complex(poses[owner].at(linkage.local(owner, point))[0])
            raise SketchMismatchError(point, linkage.sketch.points[point], found)
    for link, angle in linkage.sketch.angles.items():
        if link in poses:
            turned = float(np.angle(poses[link].z)[0])
            if abs(np.angle(np.exp(1j * (angle - turned)))) > 2 * fits:  # rad
                raise SketchMismatchError(link, angle, turned)
