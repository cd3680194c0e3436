"""Least distance of a group from a dead position."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from typing import Any

import numpy as np

from tmm_cli.errors import _
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.synthesis.optimal.quantities.base import Peak


class Margin(Peak):
    """1 at best."""

    of, text, lowest = "margin", _("least distance from a dead position"), True

    dimension = "number"

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        return {"y": -reduce(np.minimum, [at.margin for at in motion.placements])}
