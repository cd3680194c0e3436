"""What a synthesis asked, found, and what is measured of it on the mechanism."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.pipeline import Results
from tmm_cli.results.synthesis import tables as synthesis_tables
from tmm_cli.results.table import Table


def tables(results: Results) -> Iterable[Table]:
    """As `tmm synthesis` has them."""
    if results.synthesis is not None and results.motion is not None:
        yield from synthesis_tables(results.synthesis, results.measured, results.problem.units)
