"""Box that the moving points need: width + height."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from typing import Any, Final

import numpy as np

from tmm_cli.errors import _
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.synthesis.optimal.peaks import peak
from tmm_cli.synthesis.optimal.quantities.base import CLOSELY, MOST_PEAKS, Over, Peak, Read, Windows
from tmm_cli.synthesis.optimal.readings import peaks_of, sums
from tmm_cli.vectors import Real

SIDES: Final = (("x", 1), ("x", -1), ("y", 1), ("y", -1))  # right, left, top, bottom
OF_A_SIDE = 3  # points that may come to bear on a side


class Box(Peak):
    """Metres. A curve to look at closely is a side and a point, whose own path is smooth."""

    of, text = "box", _("box of the moving points, width + height")
    curves = ("y0", "y1", "y2", "y3")

    def counts(self, linkage: Linkage) -> tuple[int, ...]:
        return (len(_points(linkage)),)

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        spots = [motion.spot(point) for point in _points(motion.linkage)]
        x, y = [p.real for p in spots], [p.imag for p in spots]
        closely = {f"{CLOSELY}{axis}{k}": v for axis, vs in (("x", x), ("y", y)) for k, v in enumerate(vs)}
        return closely | {
            "y0": reduce(np.maximum, x), "y1": -reduce(np.minimum, x),
            "y2": reduce(np.maximum, y), "y3": -reduce(np.minimum, y),
        }  # fmt: skip

    def windows(self, read: Read, over: Over) -> list[tuple[Any, int]]:
        found: list[tuple[Any, int]] = []
        for side, (axis, sign) in enumerate(SIDES):
            ys = {k: sign * read(f"{CLOSELY}{axis}{k}")[0] for k in range(*over.counts)}
            tops = [(y[at], k, at) for k, y in ys.items() for at in peaks_of(y, MOST_PEAKS, over.closed)]
            tops.sort(reverse=True)
            found += [((side, k), at) for __, k, at in tops[:OF_A_SIDE]]
        return found

    def fine(self, parts: Windows, exact: Read, over: Over, step: float) -> Real:
        sides: list[list[Real]] = [[], [], [], []]
        for (side, k), __, read in parts:
            axis, sign = SIDES[side]
            sides[side].append(peak(sign * read(f"{CLOSELY}{axis}{k}")))
        return sums(sides)


def _points(linkage: Linkage) -> list[str]:
    """Points of moving links, those on the frame first."""
    fixed = linkage.links[FRAME].points
    points = {point for name in linkage.moving for point in linkage.links[name].points}
    return sorted(points, key=lambda point: (point not in fixed, point))
