"""How far places of the driver move when the linkage changes a little: limits, dead positions, largest pressure angles.

Each is a root of some function f(q, p) of the driver's place and a length, so it moves by -(df/dp)/(df/dq).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.groups.base import Closed, Kernel
from tmm_cli.groups.newton import Newton
from tmm_cli.groups.state import State
from tmm_cli.kinematics.motion import Motion
from tmm_cli.kinematics.pressure import angle, followers
from tmm_cli.kinematics.strokes import output_run
from tmm_cli.vectors import Real

STEP = 1e-5  # rad, or that share of the way: for derivatives by the driver's place
TOP = 1e-3  # the same, for the slope of a pressure angle near its top
NOWHERE = float("nan")


@dataclass(frozen=True)
class Changed:
    """A linkage before and after a small change: motions at any places of the driver, and the groups of both.

    span: rad, or the driver's whole way (m).
    """

    motions: Callable[[Any], tuple[Motion, Motion]]
    kernels: tuple[tuple[Kernel, ...], tuple[Kernel, ...]]
    span: float

    def limit(self, place: float, group: str | None) -> float:
        """Of an end of the driver's way at which a group stops it; nan where none does."""
        number = self._number(group)
        if number is None:
            return NOWHERE
        before, after = (kernels[number] for kernels in self.kernels)
        if isinstance(before, Closed):
            return self._root(place, lambda motion, _: motion.placements[number].residual)
        if not isinstance(before, Newton) or not isinstance(after, Newton) or before.followed is None:
            return NOWHERE
        track = before.followed
        end = 0 if abs(place - track.q[0]) < abs(place - track.q[-1]) else -1
        if not track.limits[end]:
            return NOWHERE
        own = before.poses_of(State(track.states.x[[end]], track.states.unwrapped[[end]]))
        # where the matrix is singular, only the equations' sum by its left null vector tells of q
        (here, _) = self.motions(place)
        null = np.linalg.svd(before.matrix({**here.poses, **own})[0])[0][:, -1]

        def short(motion: Motion, kernel: Kernel) -> Real:
            assert isinstance(kernel, Newton)
            poses = {name: pose for name, pose in motion.poses.items() if name not in own}
            wide = {name: type(pose)(*(np.repeat(part, len(motion.q)) for part in (pose.x, pose.z, pose.turned)))
                    for name, pose in own.items()}  # fmt: skip
            found: Real = kernel.residuals({**poses, **wide}, motion.drives) @ null
            return found

        return self._root(place, lambda motion, side: short(motion, (before, after)[side]))

    def dead(self, place: float, group: str) -> float:
        """Of a dead position inside the way of a group of two links: there its gap stops growing."""
        number = self._number(group)
        if number is None or not isinstance(self.kernels[0][number], Closed):
            return NOWHERE

        def closing(motion: Motion, side: int) -> Real:
            kernel = self.kernels[side][number]
            assert isinstance(kernel, Closed)
            return kernel.residual_rate(
                kernel.closed(motion.poses, motion.drives), motion.poses, motion.first, motion.drives
            )

        return self._root(place, closing)

    def extreme(self, place: float, link: str) -> float:
        """Of the place where an output turns back."""
        return self._root(place, lambda motion, _: output_run(motion, link)[1])

    def pressure(self, place: float, group: str, link: str) -> float:
        """Of the place of a largest pressure angle with a smooth top."""
        number = self._number(group)
        if number is None:
            return NOWHERE
        lead = next(lead for lead in followers(self.kernels[0][number].group) if lead[0] == link)
        q = place + TOP * self.span * np.arange(-2, 3)
        with np.errstate(all="ignore"):
            before, after = (angle(m, m.kernels[number], m.placements[number], lead) for m in self.motions(q))
        slopes = [8 * (v[3] - v[1]) - (v[4] - v[0]) for v in (before, after)]
        bend = 12 * (before[1] + before[3] - 2 * before[2])
        smooth = abs(slopes[0]) < TOP * abs(bend)
        return float(-(slopes[1] - slopes[0]) / bend * TOP * self.span) if smooth else NOWHERE

    def _number(self, group: str | None) -> int | None:
        return next((k for k, kernel in enumerate(self.kernels[0]) if kernel.group.title == group), None)

    def _root(self, place: float, function: Callable[[Motion, int], Real]) -> float:
        step = STEP * self.span
        with np.errstate(all="ignore"):
            before, after = self.motions(place + step * np.array([-1.0, 0.0, 1.0]))
            values, moved = function(before, 0), function(after, 1)
            shift = -(moved[1] - values[1]) * 2 * step / (values[2] - values[0])
        return float(shift) if np.isfinite(shift) else NOWHERE
