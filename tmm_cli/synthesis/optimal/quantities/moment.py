"""Largest balancing moment on the driver, or force where it slides."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from tmm_cli.errors import _
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.linkage import Linkage
from tmm_cli.quantities import BALANCING
from tmm_cli.synthesis.optimal.quantities.base import Peak


class Moment(Peak):
    """N m, or N."""

    of, text, forces = "moment", _("largest balancing moment"), True

    def kind(self, linkage: Linkage, groups: Any) -> str:
        return str(BALANCING.measures(linkage.driver.kind == "slide").name)

    def title(self, linkage: Linkage) -> str:
        return self.text if linkage.driver.kind == "turn" else _("largest balancing force")

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        assert reactions is not None
        return {"y": np.abs(BALANCING.value(reactions.balance))}
