"""k of candidates: where strokes end, and how surely that is known."""

from pathlib import Path

import numpy as np
import pytest
from bank import solved

from tmm_cli.synthesis import time_ratio_of_curve as ratio, time_ratio_uncertainty

PROBLEMS = Path(__file__).parent.parent / "problems"
ROUND = np.arange(720) / 720


@pytest.mark.parametrize("power", [1, 3])
@pytest.mark.parametrize("share", [0.1, 0.4])
def test_strokes_end_where_the_slope_changes_its_sign_be_it_a_simple_or_a_triple_zero(power, share):
    def slope(s):
        s = np.mod(s - 0.123, 1.0)
        return (np.sin(np.pi * s) * np.sin(np.pi * (share - s))) ** power

    assert ratio(slope, ROUND) == pytest.approx((1 - share) / share, rel=1e-13)


def test_a_stroke_may_end_at_a_place_of_the_scan_but_for_rounding():
    """There the sign is sure neither way: looked at from both sides it may differ."""
    for rounding in (-1e-16, 0.0, 1e-16):
        for turned in (-1e-16, 1e-16):
            wavering = lambda s: np.sin(2 * np.pi * (s - 0.25)) + np.where(s > 0.3, rounding, turned)  # noqa: E731, B023
            assert ratio(wavering, ROUND) == pytest.approx(1, rel=1e-13)


def test_a_dwell_belongs_to_no_stroke():
    def slope(s):
        s = np.mod(s, 1.0)
        return np.where(s < 0.3, 1.0, np.where(s < 0.5, 0.0, np.where(s < 0.9, -1.0, 0.0)))

    assert ratio(slope, ROUND) == pytest.approx(0.4 / 0.3, rel=1e-13)


def test_an_output_that_goes_one_way_only_has_no_k():
    assert np.isnan(ratio(lambda s: 1.0 + 0.5 * np.sin(2 * np.pi * s), ROUND))


def test_rounding_leaves_k_open_where_the_output_all_but_rests():
    """The planetary press rests where its slope all but vanishes about an end of its stroke."""
    dwell, plain = map(solved, ("three-lobes", "crank-slider"))
    assert 1e-6 < time_ratio_uncertainty(dwell) < 1e-2
    assert abs(dwell.strokes.k - 1) < time_ratio_uncertainty(dwell)  # in exact numbers it is 1
    assert time_ratio_uncertainty(plain) < 1e-12
