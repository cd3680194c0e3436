"""Velocities and accelerations by central differences of positions that are computed in closed form.

f' = (f(q + h) - f(q - h)) / 2h has the error h^2 f'''/6; f'' = (f(q + h) - 2 f(q) + f(q - h)) / h^2 has the error
h^2 f''''/12. Rounding adds errors proportional to 1/h and to 1/h^2. Forces are computed from these accelerations.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from tmm_cli.bench.methods.case import Case, MethodAnswers, build_answers_from_forces
from tmm_cli.mechanics.forces import solve_reactions
from tmm_cli.mechanics.groups import Accel, Rate
from tmm_cli.mechanics.kinematics import compute_motion
from tmm_cli.mechanics.numerics import Real


def prepare_differences(step: float, case: Case) -> Callable[[Real], MethodAnswers]:
    """Prepare the method for a linkage, with this step of the driver coordinate for the differences.

    The step is in rad; for a sliding driver it is a fraction of the size of the linkage.
    """
    h = step * (1.0 if case.linkage.driver.kind == "turn" else case.size)

    def answer(q: Real) -> MethodAnswers:
        back, on = q - h, q + h
        middle, less, more = (
            compute_motion(case.linkage, case.kernels, at, case.law, 0, blank=False) for at in (q, back, on)
        )
        half = (on - back) / 2  # the step as rounded
        first, second = {}, {}
        for name, pose in middle.poses.items():
            behind, ahead = less.poses[name], more.poses[name]
            # angles relative to the middle one, so that full turns have no effect
            a, b = np.angle(behind.z * np.conj(pose.z)), np.angle(ahead.z * np.conj(pose.z))
            first[name] = Rate((ahead.x - behind.x) / (2 * half), (b - a) / (2 * half))
            second[name] = Accel((ahead.x - 2 * pose.x + behind.x) / half**2, (a + b) / half**2)
        motion = replace(
            case.motion(q, middle.poses, first, second), kernels=case.kernels, placements=middle.placements
        )
        return build_answers_from_forces(case, motion, solve_reactions(motion, case.structure, case.loads(motion)))

    return answer
