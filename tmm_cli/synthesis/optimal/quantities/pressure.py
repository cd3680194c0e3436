"""Largest pressure angle on the output."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from typing import Any

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.errors import _
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.kinematics.pressure import followers, sides
from tmm_cli.synthesis import measures
from tmm_cli.synthesis.measures import Ends
from tmm_cli.synthesis.optimal.quantities.base import Peak


class Pressure(Peak):
    """Radians; its curve is the tangent."""

    of, text = "pressure", _("largest pressure angle")

    dimension = "angle"

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        groups = tuple(kernel.group for kernel in motion.kernels)
        output = self.output(motion.linkage, groups)
        outer = [(n, lead) for n, group in enumerate(groups) for lead in followers(group)]
        outer = [x for x in outer if x[1][0] == output] or outer
        tangents = []
        for n, lead in outer:
            sine, cosine = sides(motion, motion.kernels[n], motion.placements[n], lead)
            tangents.append(sine / cosine)
        return {"y": reduce(np.maximum, tangents)}

    def levelled(self, y: Any) -> Any:
        return np.arctan(y)

    def _measured(self, results: Results, ends: Ends) -> float:
        return measures.pressure(results, ends)
