"""Forces: what balances the driver, reactions."""

from __future__ import annotations

from collections.abc import Mapping
from functools import reduce
from typing import Any

import numpy as np

from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.language import N_
from tmm_cli.linkage import Linkage
from tmm_cli.quantities import BALANCING, REACTION_SIZE
from tmm_cli.synthesis.optimal.quantities.base import Peak


class Moment(Peak):
    """On the driver, N m, or N where it slides."""

    of, text, forces = "moment", N_("largest balancing moment"), True

    def kind(self, linkage: Linkage, groups: Any) -> str:
        return str(BALANCING.measures(linkage.driver.kind == "slide").name)

    def title(self, linkage: Linkage) -> str:
        return self.text if linkage.driver.kind == "turn" else N_("largest balancing force")

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        assert reactions is not None
        return {"y": np.abs(BALANCING.value(reactions.balance))}


class Reaction(Peak):
    """In a pair, N; of a compound hinge the largest of its pairs."""

    of, text, forces, dimension = "reaction", N_("largest reaction in the pair"), True, "force"
    keys, named = ("pair",), "pair"

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        assert reactions is not None
        return {"y": reduce(np.maximum, [REACTION_SIZE.value(r) for r in reactions.all if r.pair.name == self.name])}
