"""A first linkage of an optimal synthesis: one that can be assembled as the file sketches it."""

from __future__ import annotations

import numpy as np

from tmm_cli.assembly import assemble
from tmm_cli.mobile import mobile
from tmm_cli.refused import Refused
from tmm_cli.synthesis.optimal_asked import Asked
from tmm_cli.synthesis.record import Infeasible
from tmm_cli.vectors import Real

W = "synthesis_optimal"


class NoneAssembled(Infeasible):
    """No candidate that was tried can be assembled as it is sketched."""


def shown(asked: Asked, numbers: Real) -> bool:
    """Whether such a linkage can be assembled, and the file's sketch tells how."""
    linkage = asked.make([float(number) for number in numbers]).linkage
    try:
        assemble(linkage, mobile(linkage))
    except Refused:
        return False
    return True


def first_of(asked: Asked, tries: int) -> list[float]:
    """Numbers (SI) of such a linkage: the middle of the bounds, or others. Raises NoneAssembled."""
    low, high = np.array(list(asked.low.values())), np.array(list(asked.high.values()))
    chance = np.random.default_rng(0)
    for share in (np.full(len(low), 0.5), *chance.random((tries, len(low)))):
        numbers = asked.near(low + share * (high - low))
        if shown(asked, numbers):
            return [float(number) for number in numbers]
    raise NoneAssembled("vary", f"{W}.no_assembly", f"{W}.other_sketch")
