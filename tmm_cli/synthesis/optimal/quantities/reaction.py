"""Largest reaction in a pair."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from typing import Any

import numpy as np

from tmm_cli.errors import _
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.quantities import REACTION_SIZE
from tmm_cli.synthesis.optimal.quantities.base import Peak


class Reaction(Peak):
    """N; of a compound hinge the largest of its pairs."""

    of, text, keys, named, forces = "reaction", _("largest reaction in the pair"), ("pair",), "pair", True

    dimension = "force"

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        assert reactions is not None
        return {"y": reduce(np.maximum, [REACTION_SIZE.value(r) for r in reactions.all if r.pair.name == self.name])}
