"""Mass of the moving links."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from tmm_cli.errors import _
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.synthesis.optimal.quantities.base import Constant


class Mass(Constant):
    """kg."""

    of, text = "mass", _("mass of the moving links")

    dimension = "mass"

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        linkage = motion.linkage
        return {"value": sum(linkage.links[name].mass for name in linkage.moving)}
