"""Bounds by rounding that cost next to nothing: of numbers at positions, by the margins of the groups."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.quantities import FORCE, INERTIA, LENGTH, MOMENT, NUMBER, SPEED, Dimension
from tmm_cli.results.table import Column, Table
from tmm_cli.vectors import Real

HUGE = 1e300  # a bound of what is zero as far as is known
SLOPES = ("dJ/dphi, SI", "dm/ds, SI")
RATIOS = {  # columns that are something over a force: the less of it there is the less they are known, of zero nothing
    ("reactions", "angle"): "F",
    ("reactions", "acts at"): "F",
    ("lever", "arm"): "force",
}


def by_margins(
    results: Results, relative: Real, sizes: Mapping[Dimension, float], table: Table, column: Column
) -> Real:
    """Bounds of a column whose rows are positions: shares (margins.relative) of the largest of its kind."""
    values = np.abs(column.array)
    own = float(np.max(values, where=np.isfinite(values), initial=0.0))
    assert column.dimension is not None
    size = sizes.get(column.dimension, own)
    if column.dimension == NUMBER and table.name in ("energy", "cycle"):
        power = sizes.get(FORCE, 0.0) * sizes[SPEED]
        size = _percent(results, table.name, power, sizes) if column.header.endswith("%") else max(power, own)
        if column.header in SLOPES and results.energy is not None:  # which has nothing of speeds in it
            size = 2 * sizes[NUMBER] * sizes[INERTIA]
    bound = np.repeat(relative, table.rows // len(relative)) * size
    over = RATIOS.get((table.name, column.header))
    if over is not None:
        force = np.abs(next(other.array for other in table.columns if other.header == over))
        share = np.repeat(relative, table.rows // len(relative))
        known = force > share * sizes[FORCE]
        if column.dimension == LENGTH:  # both what stands over the force and the force are known to the share
            bound = bound + share * values
        return np.where(known, bound * (sizes[FORCE] / np.where(known, force, 1.0)), np.inf)
    return np.asarray(np.minimum(bound, HUGE))


def _percent(results: Results, table: str, power: float, sizes: Mapping[Dimension, float]) -> float:
    """What all forces come to, as a share of what it is compared with."""
    assert results.reactions is not None
    if table == "energy" and results.energy is not None:
        of, size = [results.energy.drivers, results.energy.rate], power
    else:
        of, size = [balance.generalized for balance in results.reactions.balances], sizes[MOMENT]
    largest = max(float(np.max(np.abs(part), where=np.isfinite(part), initial=0.0)) for part in of)
    return 100 * size / largest if largest > 0 else HUGE
