"""Sweeps: quantities of a mechanism over one or two parameters, and the borders of the feasible region."""

from .drawings import sweep_sheets as sweep_sheets
from .mechanisms import SweptMechanisms as SweptMechanisms
from .options import grid_points as grid_points, read_axes as read_axes, read_shown as read_shown
from .results import (
    APART as APART,
    LIMIT as LIMIT,
    REFUSED as REFUSED,
    STOPS as STOPS,
    WORKS as WORKS,
    SweepResults as SweepResults,
    borders_table as borders_table,
    points_table as points_table,
    sections as sections,
)
from .run import refuse_points as refuse_points, run_sweep as run_sweep
