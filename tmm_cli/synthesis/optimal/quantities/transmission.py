"""Quantities of the transmission.

They are the possibility of assembly, the distance from dead positions, the pressure angle, the balancing moment and the
reactions.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from typing import Any, Final

import numpy as np

from tmm_cli.language import N_
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.forces import Reactions
from tmm_cli.mechanics.kinematics import Motion, driven_links, pressure_sine_and_cosine
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.quantities import BALANCING, REACTION_SIZE
from tmm_cli.synthesis import measures
from tmm_cli.synthesis.measures import DriverEnds
from tmm_cli.synthesis.optimal.quantities.base import PeakQuantity

SIDE: Final = "side"  # outputs whose sign shows the side of a dead position, for groups with a single assembly


class AssemblyReserve(PeakQuantity):
    """Smallest distance of any group from the limit of its assembly, divided by the size of the group.

    It is negative if the group cannot be assembled. Every candidate must be assembled in all positions.
    """

    of, text, dimension, lowest = "assembles", N_("driver completes its range (1: yes)"), "number", True

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        both = list(zip(motion.kernels, motion.placements, strict=True))
        single = [at.det for kernel, at in both if getattr(kernel, "assemblies", 0) == 1]
        return {f"{SIDE}{k}": det for k, det in enumerate(single)} | {
            "y": reduce(np.maximum, [at.residual / kernel.size for kernel, at in both])
        }


class DeadPositionMargin(PeakQuantity):
    """Smallest distance of any Assur group from a dead position, from 0 in a dead position to 1, the best possible
    value.
    """

    of, text, dimension, lowest = "margin", N_("smallest distance from a dead position"), "number", True

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        return {"y": -reduce(np.minimum, [at.margin for at in motion.placements])}


class LargestPressureAngle(PeakQuantity):
    """Largest pressure angle on the output link (rad). The curve whose peaks are sought is the tangent of this
    angle.
    """

    of, text, dimension = "pressure", N_("largest pressure angle"), "angle"

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        groups = tuple(kernel.group for kernel in motion.kernels)
        output = self.output(motion.linkage, groups)
        outer = [(n, lead) for n, group in enumerate(groups) for lead in driven_links(group)]
        outer = [x for x in outer if x[1][0] == output] or outer
        tangents = []
        for n, lead in outer:
            sine, cosine = pressure_sine_and_cosine(motion, motion.kernels[n], motion.placements[n], lead)
            tangents.append(sine / cosine)
        return {"y": reduce(np.maximum, tangents)}

    def from_curve(self, y: Any) -> Any:
        return np.arctan(y)

    def measure_range(self, results: Results, ends: DriverEnds) -> float:
        return measures.largest_pressure_angle(results, ends)


# Forces: balancing moment, reactions.


class LargestBalancingMoment(PeakQuantity):
    """Largest balancing moment on the driver (N m), or largest balancing force (N) if the driver slides."""

    of, text, forces = "moment", N_("largest balancing moment"), True

    def kind(self, linkage: Linkage, groups: Any) -> str:
        return str(BALANCING.measures(linkage.driver.kind == "slide").name)

    def title(self, linkage: Linkage) -> str:
        return self.text if linkage.driver.kind == "turn" else N_("largest balancing force")

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        assert reactions is not None
        return {"y": np.abs(BALANCING.value(reactions.balance))}


class LargestReaction(PeakQuantity):
    """Largest reaction in a pair (N); in a compound hinge, the largest reaction of its pairs."""

    of, text, forces, dimension = "reaction", N_("largest reaction in the pair"), True, "force"
    keys, named = ("pair",), "pair"

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        assert reactions is not None
        return {"y": reduce(np.maximum, [REACTION_SIZE.value(r) for r in reactions.all if r.pair.name == self.name])}
