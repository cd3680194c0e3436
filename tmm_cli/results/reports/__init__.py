"""What is reported, in the order in which it is shown. A new report is a file here and a line in REPORTS.

A report takes Results and gives tables; it gives none when its stage was not asked for.
"""

from collections.abc import Callable, Iterable

from tmm_cli.pipeline import Results
from tmm_cli.results.reports import cycle, forces, kinematics, lever, quality, structure
from tmm_cli.results.table import Table

REPORTS: tuple[Callable[[Results], Iterable[Table]], ...] = (
    structure.tables,
    quality.tables,
    cycle.tables,
    kinematics.tables,
    forces.tables,
    lever.tables,
)


def tables(results: Results) -> tuple[Table, ...]:
    """Every table of the results."""
    return tuple(table for report in REPORTS for table in report(results))
