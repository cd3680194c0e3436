"""What a file was understood to say; then the way of the calculation (results.stages)."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.analysis.pipeline import Results
from tmm_cli.results.given import given
from tmm_cli.results.stages import skipped, stages_table, steps
from tmm_cli.results.table import Table


def explain(results: Results, verbose: bool = False) -> Iterable[Table]:
    """Tables of words: the file in full, then the way of the calculation; verbose: places that each stage computes."""
    yield from given(results.problem)
    yield steps(results)
    if verbose:
        yield stages_table(results)
    yield from skipped(results.problem)
