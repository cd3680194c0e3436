"""How a variant looks at the place of the sketch: what tells its assembly, wherever the file's own sketch lies."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.groups.base import Kernel
from tmm_cli.linkage import Linkage, Sketch
from tmm_cli.motion import Law, move

ALIKE = 1e-6  # of the farthest point: sketches that differ by no more are of one assembly


def sketch_of(linkage: Linkage, kernels: Iterable[Kernel]) -> Sketch:
    """All points and angles of the moving links, for groups whose assembly is known."""
    at = linkage.sketch.at
    poses = move(linkage, kernels, np.array([at]), Law(at, 1.0, 0.0, 1), 0).poses
    points = {
        point: complex(poses[link].at(local)[0])
        for link in linkage.moving for point, local in linkage.links[link].points.items()
    }  # fmt: skip
    driven = {driver.link for driver in linkage.cranks}
    angles = {link: float(np.angle(poses[link].z)[0]) for link in linkage.moving if link not in driven}
    return Sketch(at, points, angles)


def alike(one: Sketch, other: Sketch) -> bool:
    """Whether both show the same assembly."""
    size = max((abs(place) for place in one.points.values()), default=1.0)
    return all(abs(place - other.points[name]) <= ALIKE * size for name, place in one.points.items())
