"""Files changed at random are solved or refused: a slice of what `python -m tests.fuzz` does."""

from __future__ import annotations

from fuzz import fuzz


def test_no_file_ends_in_anything_but_a_problem_or_the_products_own_error() -> None:
    ended, faults = fuzz(seed=14, loads=100)
    assert faults == {}
    assert ended["solves"] >= 8 and ended["solved"] and ended["loaded"] and ended["refused"]
