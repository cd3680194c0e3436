"""What is reported, in the order in which it is shown. A new report is a file here and a line in REPORTS.

A report has a function `tables(results)`, which gives its tables; it gives none when its stage was not asked for.
"""

from __future__ import annotations

from importlib import import_module

from tmm_cli.chain import ChainResults
from tmm_cli.pipeline import Results
from tmm_cli.results.table import Table

# file here, and the part of Results that it needs: a report of a stage that did not run is not even imported
REPORTS: tuple[tuple[str, str], ...] = (
    ("structure", "structure"),
    ("space", "structure"),
    ("chain", "chain"),
    ("quality", "motion"),
    ("pressure", "motion"),
    ("cycle", "motion"),
    ("kinematics", "motion"),
    ("forces", "reactions"),
    ("lever", "lever"),
    ("energy", "energy"),
    ("assemblies", "assemblies"),
)


def tables(results: Results | ChainResults) -> tuple[Table, ...]:
    """Every table of the results."""
    found: list[Table] = []
    for name, part in REPORTS:
        if getattr(results, part, None) is not None:
            found += import_module(f"{__name__}.{name}").tables(results)
    return tuple(found)
