"""Random linkages of all kernels against the textbook multibody way in 60 digits."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from multibody import Multibody
from random_linkages import linkage
from test_properties import solved

CASES = [
    (3, ("RRR",)), (36, ("RRP",)), (41, ("RPR",)), (24, ("RPP", "PRP")), (53, ("RRP", "RPR", "RRR")),
    (72, ("RPP", "RRR", "RPR")), (59, ("RPR", "PRP")), (7, ("PRP", "RRP", "RPP")),
]  # fmt: skip


@pytest.mark.parametrize("seed, kinds", CASES)
def test_everything_agrees_with_lagrange_multipliers(seed, kinds):
    it = linkage(seed, kinds)
    structure, motion, _, reactions = solved(it, (0.0, 0.013))
    body = Multibody(it, structure, motion)
    found, expected = {}, {}

    def compare(kind, mine, reference):
        found.setdefault(kind, []).append(complex(mine))
        expected.setdefault(kind, []).append(reference)

    for k in range(2):
        X, V, A, multipliers = body.at(k)
        for name, i in body.at_row.items():
            centre, turning = motion.centre(name), motion.link(name)
            arm = it.links[name].centre * body.pose(X, name)[1]
            compare("x", centre.x[k], mp.mpc(X[i], X[i + 1]) + arm)
            compare("v", centre.v[k], mp.mpc(V[i], V[i + 1]) + 1j * V[i + 2] * arm)
            compare("a", centre.a[k], mp.mpc(A[i], A[i + 1]) + (1j * A[i + 2] - V[i + 2] ** 2) * arm)
            compare("omega", turning.omega[k], V[i + 2])
            compare("epsilon", turning.epsilon[k], A[i + 2])
        for row, pair in enumerate(structure.pairs):
            one, two = multipliers[2 * row], multipliers[2 * row + 1]
            reaction = reactions.of(pair.name)
            if pair.kind == "R":
                compare("force", reaction.onto(pair.i)[k], mp.mpc(one, two))
            else:
                across = 1j * body.pose(X, pair.i)[1] * mp.expj(pair.slide.direction)
                compare("force", reaction.onto(pair.j)[k], two * across)
                compare("couple", (reaction.couple if reaction.on == pair.j else -reaction.couple)[k], one)
        compare("balancing", reactions.balance.moment[k], multipliers[body.size - 1])
    for kind, values in found.items():
        largest = max(abs(v) for v in expected[kind])
        worst = max(abs(mp.mpc(a) - b) for a, b in zip(values, expected[kind], strict=True))
        assert worst < 1e-12 * largest, (kind, float(worst / largest))
    assert np.all(motion.moving)
