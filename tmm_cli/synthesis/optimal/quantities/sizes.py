"""Quantities of size: link lengths, mass, bounding box of the moving points."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from itertools import combinations, product
from typing import Any, Final

import numpy as np

from tmm_cli.language import N_
from tmm_cli.mechanics.forces import Reactions
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import Real, highest_peaks, window_peak
from tmm_cli.synthesis.optimal.quantities.base import (
    CLOSELY,
    MOST_PEAKS,
    ConstantQuantity,
    PeakQuantity,
    QuantityRange,
    Read,
    Windows,
)

SIDES: Final = (("x", 1), ("x", -1), ("y", 1), ("y", -1))  # right, left, top, bottom
OF_A_SIDE = 3  # points considered on each side


class LinkLengthSum(ConstantQuantity):
    """Sum of the lengths of all links or of selected links (m).

    The length of a link is the largest distance between two of its points; that of the frame, between two of its
    hinges.
    """

    of, text, keys = "length", N_("sum of link lengths"), ("links",)

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        linkage = motion.linkage
        hinged = {hinge.point for hinge in linkage.hinges if FRAME in hinge.links}
        total: Any = 0.0
        for link in self.links or tuple(linkage.links):
            points = [at for name, at in linkage.links[link].points.items() if link != FRAME or name in hinged]
            total = total + reduce(np.maximum, [np.abs(a - b) for a, b in combinations(points, 2)], 0.0)
        return {"value": total}


class MovingMass(ConstantQuantity):
    """Total mass of the moving links (kg)."""

    of, text, dimension = "mass", N_("mass of the moving links"), "mass"

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        linkage = motion.linkage
        return {"value": sum(linkage.links[name].mass for name in linkage.moving)}


class MotionBox(PeakQuantity):
    """Width plus height (m) of the bounding box of the paths of all moving points.

    Each window of positions is used for one point near one side of the box. The path of a single point is smooth,
    unlike the side of the box.
    """

    of, text = "box", N_("width + height of the bounding box of the moving points")
    curves = ("y0", "y1", "y2", "y3")

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        spots = [motion.spot(point) for point in _list_moving_points(motion.linkage)]
        x, y = [p.real for p in spots], [p.imag for p in spots]
        closely = {f"{CLOSELY}{axis}{k}": v for axis, vs in (("x", x), ("y", y)) for k, v in enumerate(vs)}
        return closely | {
            "y0": reduce(np.maximum, x),
            "y1": -reduce(np.minimum, x),
            "y2": reduce(np.maximum, y),
            "y3": -reduce(np.minimum, y),
        }

    def windows(self, read: Read, over: QuantityRange) -> list[tuple[Any, int]]:
        windows: list[tuple[Any, int]] = []
        for side, (axis, sign) in enumerate(SIDES):
            ys = {k: sign * read(f"{CLOSELY}{axis}{k}")[0] for k in range(len(_list_moving_points(over.linkage)))}
            tops = [(y[at], k, at) for k, y in ys.items() for at in highest_peaks(y, MOST_PEAKS, over.closed)]
            windows += [((side, k), at) for __, k, at in sorted(tops, reverse=True)[:OF_A_SIDE]]
        return windows

    def fine(self, parts: Windows, exact: Read, over: QuantityRange, step: float) -> Real:
        """Return width plus height for all combinations of one peak at each of the four sides of the box.

        The largest of these sums is the value of the quantity.
        """
        runs = [SIDES[side][1] * read(f"{CLOSELY}{SIDES[side][0]}{k}") for (side, k), __, read in parts]
        sides: list[list[Real]] = [[], [], [], []]
        for ((side, __), *__), top in zip(parts, window_peak(np.vstack(runs)).reshape(len(runs), -1), strict=True):
            sides[side].append(top)
        return np.stack([np.sum(some, axis=0) for some in product(*sides)], axis=1)


def _list_moving_points(linkage: Linkage) -> list[str]:
    """Return the points of the moving links; hinges on the frame come first."""
    fixed = linkage.links[FRAME].points
    points = {point for name in linkage.moving for point in linkage.links[name].points}
    return sorted(points, key=lambda point: (point not in fixed, point))
