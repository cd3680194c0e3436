"""The table of the reduced mechanism has the derivative of the reduced inertia beside it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from bank import solved

from tmm_cli.results.reports.energy import tables

PROBLEMS = Path(__file__).parent.parent / "problems"


@pytest.mark.parametrize("name, header", [("crank-slider", "dJ/dphi, SI"), ("cylinder", "dm/ds, SI")])
def test_its_derivative_by_the_driver_stands_beside_the_reduced_inertia(name, header):
    results = solved(name)
    column = next(column for column in next(iter(tables(results))).columns if column.header == header)
    assert np.array_equal(column.array, results.energy.slope)
