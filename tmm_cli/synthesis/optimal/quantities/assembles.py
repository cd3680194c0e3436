"""How far from its end the assembly of a group is: every candidate must have it in all positions."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from typing import Any, Final

import numpy as np

from tmm_cli.errors import _
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.synthesis.optimal.quantities.base import Peak

SIDE: Final = "side"  # outputs whose sign tells on which side of a dead position a group is that has one assembly only


class Assembles(Peak):
    """In sizes of the group; below zero it cannot be assembled."""

    of, text, lowest = "assembles", _("driver goes its whole way (1: yes)"), True

    dimension = "number"

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        both = list(zip(motion.kernels, motion.placements, strict=True))
        single = [at.det for kernel, at in both if getattr(kernel, "assemblies", 0) == 1]
        return {f"{SIDE}{k}": det for k, det in enumerate(single)} | {
            "y": reduce(np.maximum, [at.residual / kernel.size for kernel, at in both])
        }
