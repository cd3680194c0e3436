"""Deviation of a link from a wanted law of motion."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.errors import _
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.kinematics.strokes import output_place
from tmm_cli.linkage import Linkage
from tmm_cli.synthesis.measures import Ends
from tmm_cli.synthesis.optimal.quantities.base import Over, Read, motion_at
from tmm_cli.synthesis.optimal.quantities.deviation import Deviation
from tmm_cli.vectors import Real


class Law(Deviation):
    """Metres, or radians; relative: from the first place on."""

    of, text, largest = (
        "law", _("root mean square deviation from the wanted law"), _("largest deviation from the wanted law")
    )  # fmt: skip
    keys, named, given = ("link", "values", "at", "relative", "norm"), "link", "values"

    def output(self, linkage: Linkage, groups: Any) -> str | None:
        return self.name

    def kind(self, linkage: Linkage, groups: Any) -> str:
        return "length" if self.slides(linkage, groups) else "angle"

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        return {"run": output_place(motion, self.name)}

    def deviations(self, read: Read, over: Over) -> Real:
        off = read("run") - np.array(self.wanted)
        off = off - off[:, :1] if self.relative else off
        turned: Real = np.angle(np.exp(1j * off)) if over.swings else off
        return turned

    def deviations_on(self, results: Results, ends: Ends) -> Real:
        run = output_place(motion_at(results, np.array(self.places)), self.name)
        swings = not results.linkage.slides_on_frame(self.name)
        found: Real = self.deviations(lambda __: run[None, :], Over(swings))[0]
        return found
