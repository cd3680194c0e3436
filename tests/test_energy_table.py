"""The table of the reduced mechanism has the derivative of the reduced inertia beside it."""

from __future__ import annotations

import numpy as np
import pytest
from bank import solved
from fuzz import beyond
from models import PROBLEMS

from tmm_cli import solve
from tmm_cli.problem import build_any_problem, read_text
from tmm_cli.reports import energy_tables as tables


@pytest.mark.parametrize("name, header", [("crank-slider", "dJ/dphi, SI"), ("cylinder", "dm/ds, SI")])
def test_its_derivative_by_the_driver_stands_beside_the_reduced_inertia(name, header):
    results = solved(name)
    column = next(column for column in next(iter(tables(results))).columns if column.header == header)
    assert np.array_equal(column.array, results.energy.slope)


def test_its_bound_has_nothing_of_speeds_in_it():
    """A parallelogram of equal arms has the same inertia everywhere; what is left of its derivative is rounding."""
    text = (PROBLEMS / "hanger.yaml").read_text(encoding="utf-8")
    slow = text.replace("speed: 10 deg/s", "speed: 1e-8 deg/s")
    assert slow != text
    assert beyond(solve(build_any_problem(read_text(slow, "x.yaml")))) is None
