"""Random linkages of all kernels against the textbook multibody way in 60 digits."""

from __future__ import annotations

import numpy as np
import pytest
from multibody import compared
from random_linkages import linkage
from test_properties import solved

CASES = [
    (3, ("RRR",)),
    (36, ("RRP",)),
    (41, ("RPR",)),
    (24, ("RPP", "PRP")),
    (53, ("RRP", "RPR", "RRR")),
    (72, ("RPP", "RRR", "RPR")),
    (59, ("RPR", "PRP")),
    (7, ("PRP", "RRP", "RPP")),
]


@pytest.mark.parametrize("seed, kinds", CASES)
def test_everything_agrees_with_lagrange_multipliers(seed, kinds):
    it = linkage(seed, kinds)
    structure, motion, _, reactions = solved(it, (0.0, 0.013))
    worst = compared(it, structure, motion, reactions, range(2))
    assert max(worst.values()) < 1e-12, worst
    assert np.all(motion.moving)
