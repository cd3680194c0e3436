"""Distance of a point's path from wanted points."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.errors import _
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.synthesis.measures import Ends
from tmm_cli.synthesis.optimal.peaks import peak
from tmm_cli.synthesis.optimal.quantities.base import Over, Read, Windows, highest_on, motion_at
from tmm_cli.synthesis.optimal.quantities.deviation import Deviation
from tmm_cli.synthesis.optimal.readings import apart_squared, nearest
from tmm_cli.vectors import Real


class Path(Deviation):
    """Metres; without places it is to pass through the points in any of its positions."""

    of, text, largest = (
        "path", _("root mean square distance from the wanted points"), _("largest distance from the wanted points")
    )  # fmt: skip
    keys, named, given = ("point", "through", "at", "norm"), "point", "through"

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        place = motion.spot(self.name)
        return {"px": place.real, "py": place.imag}

    def deviations(self, read: Read, over: Over) -> Real:
        x, y = read("px"), read("py")
        if self.places:
            apart: Real = np.hypot(x - np.real(self.wanted), y - np.imag(self.wanted))
            return apart
        return nearest(x, y, np.array(self.wanted), closed=over.closed)

    def windows(self, read: Read, over: Over) -> list[tuple[Any, int]]:
        place = read("px")[0] + 1j * read("py")[0]
        return [] if self.places else [(w, int(np.argmin(np.abs(place - w)))) for w in self.wanted]

    def fine(self, parts: Windows, exact: Read, over: Over, step: float) -> Real:
        if self.places:
            return super().fine(parts, exact, over, step)
        near = [-peak(-apart_squared(read("px"), read("py"), wanted)) for wanted, __, read in parts]
        off = np.sqrt(np.maximum(np.stack(near, axis=1), 0))
        return off if self.norm == "largest" else self.counted(off)[:, None]

    def deviations_on(self, results: Results, ends: Ends) -> Real:
        if self.places:
            apart: Real = np.abs(motion_at(results, np.array(self.places)).spot(self.name) - np.array(self.wanted))
            return apart

        def near(wanted: complex) -> float:
            return highest_on(lambda q: -(np.abs(motion_at(results, q).spot(self.name) - wanted) ** 2), results, ends)

        return np.sqrt(np.maximum([-near(wanted) for wanted in self.wanted], 0.0))
