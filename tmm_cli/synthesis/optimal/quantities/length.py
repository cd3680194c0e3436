"""Sum of link lengths: of each link the largest distance of its points."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from itertools import combinations
from typing import Any

import numpy as np

from tmm_cli.errors import _
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.synthesis.optimal.quantities.base import CLOSELY, Constant, Over, Read, Windows
from tmm_cli.synthesis.optimal.readings import sums
from tmm_cli.vectors import Real


class Length(Constant):
    """Metres, of all links, or of some."""

    of, text, keys = "length", _("sum of link lengths"), ("links",)

    def counts(self, linkage: Linkage) -> tuple[int, ...]:
        return tuple(len(own) for own in self._spans(linkage))

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        spans = self._spans(motion.linkage)
        closely = {f"{CLOSELY}{n}.{k}": span for n, own in enumerate(spans) for k, span in enumerate(own)}
        return closely | {"value": sum(reduce(np.maximum, own, 0.0) for own in spans)}

    def fine(self, parts: Windows, exact: Read, over: Over, step: float) -> Real:
        return sums([[exact(f"{CLOSELY}{n}.{k}")[:, 0] for k in range(m)] for n, m in enumerate(over.counts)])

    def _spans(self, linkage: Linkage) -> list[list[Any]]:
        """Distances of each link's points, of the frame those of its hinges, m."""
        hinged = {hinge.point for hinge in linkage.hinges if FRAME in hinge.links}
        found = []
        for link in self.links or tuple(linkage.links):
            points = linkage.links[link].points
            names = [name for name in points if link != FRAME or name in hinged]
            found.append([np.abs(points[a] - points[b]) for a, b in combinations(names, 2)])
        return found
