"""Velocities and accelerations by central differences of positions; positions are the closed form's.

f' = (f(q + h) - f(q - h)) / 2h with the error h^2 f'''/6, f'' = (f(q + h) - 2 f(q) + f(q - h)) / h^2 with h^2 f''''/12;
rounding adds its unit over h and over h^2. Forces are found from what the differences give.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from tmm_cli.accuracy.case import Answers, Case, from_plan
from tmm_cli.forces.plan import react
from tmm_cli.groups.state import Accel, Placement, Pose, Rate
from tmm_cli.linkage import FRAME
from tmm_cli.motion import driven_state, drives_at, frame_state
from tmm_cli.vectors import Real


def places(case: Case, q: Real) -> tuple[dict[str, Pose], tuple[Placement, ...]]:
    """Poses of all links at places q, and nothing more."""
    drives = drives_at(case.linkage, q)
    poses = {FRAME: frame_state(q)[0]}
    for driver in case.linkage.cranks:
        poses[driver.link] = driven_state(case.linkage, driver, drives[driver.link])[0]
    found = []
    for kernel in case.kernels:
        at = kernel.place(poses, q, drives)
        poses.update(zip(kernel.group.links, at.poses, strict=True))
        found.append(at)
    return poses, tuple(found)


def prepare(step: float) -> Callable[[Case], Callable[[Real], Answers]]:
    """The method with one step of the driver (rad, or the linkage's size for a driver that slides)."""

    def of(case: Case) -> Callable[[Real], Answers]:
        h = step * (1.0 if case.linkage.driver.kind == "turn" else case.size)

        def at(q: Real) -> Answers:
            poses, placements = places(case, q)
            back, on = q - h, q + h
            less, more = places(case, back)[0], places(case, on)[0]
            half = (on - back) / 2  # as it was rounded
            first, second = {}, {}
            for name, pose in poses.items():
                behind, ahead = less[name], more[name]
                # angles against the middle one, so that a full turn between them does no harm
                a, b = np.angle(behind.z * np.conj(pose.z)), np.angle(ahead.z * np.conj(pose.z))
                first[name] = Rate((ahead.x - behind.x) / (2 * half), (b - a) / (2 * half))
                second[name] = Accel((ahead.x - 2 * pose.x + behind.x) / half**2, (a + b) / half**2)
            motion = replace(case.motion(q, poses, first, second), kernels=case.kernels, placements=placements)
            return from_plan(case, motion, react(motion, case.structure, case.loads(motion)))

        return at

    return of
