"""Families of mechanisms that one task allows: listed from end to end, with the chosen one among them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from test_synthesis_four_bar_by_k import problem
from test_synthesis_slotted_lever import lever

from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import zero_within_rounding
from tmm_cli.synthesis import FourBarByKTask


@pytest.mark.parametrize("k", [1.01, 1.1, 1.5, 2.5])
def test_the_listed_family_goes_from_the_dead_rocker_to_the_dead_rocker_on_every_arc(k):
    found = problem("", k=k).synthesis.outcome
    (family,) = found.listings
    assert family.long
    rows = np.array([row[1:] for row in family.rows])
    beta, x, y, l1, l2, l4, most, least = rows.T
    one = FourBarByKTask(0.2, math.radians(50), math.radians(105), k)
    c1, c2 = (0.2 * np.exp(1j * psi) for psi in (one.psi1, one.psi2))
    for name in dict.fromkeys(row[0] for row in family.rows):
        here = np.array([row[0] == name for row in family.rows])
        assert np.degrees(most[here][[0, -1]]) == pytest.approx([90, 90], abs=1e-4)
        assert np.degrees(np.abs(np.diff(most[here]))).max() < 4
    a = x + 1j * y
    place = a - problem("", k=k).linkage.links[FRAME].points["D"]
    assert np.abs(place) == pytest.approx(l4, rel=1e-9)
    assert np.abs(place - c2) == pytest.approx(l1 + l2, rel=1e-9)
    assert np.abs(place - c1)[1:] == pytest.approx((l2 - l1)[1:], rel=1e-9, abs=1e-9)
    assert most + least == pytest.approx(np.pi / 2) and beta.min() == 0
    chosen = next(float(v.value) for v in found.found if v.text == "largest pressure angle")
    assert most.min() == pytest.approx(chosen, rel=1e-3) and most.min() >= chosen - 1e-12


def test_the_family_within_bounds_is_drawn_and_listed_and_holds_the_chosen_lever():
    outcome = lever("CB: 500, k: 1.8, within: [200, 330]").synthesis.outcome
    drawn = next(d for d in outcome.drawings if getattr(d, "name", "") == "family-lengths")
    (listing,) = outcome.listings
    frame, crank, nearest, farthest = np.array(listing.rows).T
    assert frame[[0, -1]] == pytest.approx([0.2, 0.33]) and listing.long
    share = math.sin(math.pi * 0.8 / 2.8 / 2)
    assert crank == pytest.approx(frame * share) and nearest == pytest.approx(frame - crank)
    assert farthest == pytest.approx(frame + crank)
    (dots,) = [line for line in drawn.lines if line.dots]
    found = {name: float(value.value) for name, value in outcome.parameters.items()}
    assert list(dots.x) == pytest.approx([found["OC"]] * 3) and dots.y[0] == pytest.approx(found["OA"])
    assert not lever("CB: 500, k: 1.8, OC: 250").synthesis.outcome.listings


def test_what_is_zero_within_rounding_of_a_construction_is_zero_and_nothing_else_changes():
    exact = np.longdouble("1e-17")
    assert (
        zero_within_rounding(1e-16, 1.0) == 0
        and zero_within_rounding(1e-14, 1.0) == 1e-14
        and zero_within_rounding(complex(3, 1e-16), 3.0) == 3
    )
    assert zero_within_rounding(exact, 1.0) == exact or np.finfo(np.longdouble).eps > 1e-18
    assert list(zero_within_rounding(np.array([1e-16, -2.0]), 2.0)) == [0, -2]
