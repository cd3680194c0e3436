"""One symbol for one thing: guides and supports that no rod runs through, hinges, centres of mass."""

from __future__ import annotations

import pytest

from tmm_cli.draw.fixed import free_runs, support_side
from tmm_cli.draw.sheet import Sheet


def test_a_rail_is_open_where_rods_go_through_it():
    assert free_runs(-10, 10, []) == [(-10, 10)]
    assert free_runs(-10, 10, [(-2, 3)]) == [(-10, -2), (3, 10)]
    assert free_runs(-10, 10, [(1, 5), (-2, 3)]) == [(-10, -2), (5, 10)]
    assert free_runs(-10, 10, [(-30, 3), (9, 40)]) == [(3, 9)]
    assert free_runs(-10, 10, [(-9, 9)]) == []  # nothing is hatched that is shorter than its strokes


@pytest.mark.parametrize(
    ("ends", "side"),
    [
        ([30 + 30j], -1j),  # a crank upwards: the support is below
        ([-5 - 40j], 1j),  # a pendulum hangs from above
        ([2 + 40j, -2 - 40j], 1),  # a lever through the hinge: a wall beside it
    ],
)
def test_a_support_is_where_no_rod_runs_through_it(ends, side):
    sheet = Sheet("", "")
    assert support_side(sheet, 100 + 100j, [(100 + 100j, 100 + 100j + end) for end in ends]) == pytest.approx(side)
