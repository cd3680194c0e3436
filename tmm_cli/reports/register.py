"""Register of the tables in the order in which they are shown and written.

To add tables, write a function `<report>_tables(results)` that yields them, and add a line to REPORTS.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from importlib import import_module
from typing import NamedTuple

from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.structure import ChainResults
from tmm_cli.reports.table import Table


class Report(NamedTuple):
    """A group of tables made by one function, `<name>_tables` of the module `tmm_cli.reports.<module>`.

    Attributes:
        name: name of the report.
        module: module of the function, imported when the tables are made.
        requires: attribute of Results that must not be None; otherwise there are no tables.
        tables: names of the tables; empty if they depend on the problem.
    """

    name: str
    module: str
    requires: str
    tables: tuple[str, ...]

    def make_tables(self, results: Results | ChainResults) -> Iterator[Table]:
        """Yield the tables of this report; none if the stage that it requires has not run."""
        if getattr(results, self.requires, None) is not None:
            yield from getattr(import_module(f"tmm_cli.reports.{self.module}"), f"{self.name}_tables")(results)


REPORTS = (
    Report("synthesis", "synthesis_tables", "motion", ("synthesis-asked", "synthesis-found", "synthesis-measured")),
    Report("structure", "structure_tables", "structure", ("structure", "links", "pairs", "groups")),
    Report("space", "space_tables", "structure", ("contours", "space", "replacements")),
    Report("chain", "space_tables", "chain", ()),
    Report("quality", "quality_tables", "motion", ("quality",)),
    Report("properties", "quality_tables", "problem", ("properties",)),
    Report("intermittent", "dynamics_tables", "wheels", ("intermittent", "intermittent-cycle", "intermittent-course")),
    Report("pressure", "quality_tables", "motion", ("pressure",)),
    Report("cycle", "cycle_tables", "motion", ("cycle",)),
    Report("kinematics", "cycle_tables", "motion", ("points", "link-motion", "slides")),
    Report("forces", "force_tables", "reactions", ("reactions", "pins", "loads", "transmission", "balance")),
    Report("lever", "force_tables", "lever", ("lever",)),
    Report("drawn", "force_tables", "lever", ("lever-drawn",)),
    Report("energy", "force_tables", "energy", ("energy", "friction")),
    Report("dynamics", "dynamics_tables", "running", ("dynamics", "law-of-motion")),
    Report("balancing", "dynamics_tables", "balancing", ("balancing", "shaking")),
    Report("centres", "cycle_tables", "centres", ("centres", "advantage")),
    Report("extremes", "cycle_tables", "extremes", ("extremes",)),
    Report("assemblies", "quality_tables", "assemblies", ()),
    Report("checks", "quality_tables", "lever", ("checks",)),
)


def tables(results: Results | ChainResults) -> tuple[Table, ...]:
    """Return all tables of the results."""
    return tuple(walk(results))


def walk(results: Results | ChainResults, names: Collection[str] = ()) -> Iterator[Table]:
    """Yield the tables of the results one at a time: all of them, or only those with the given names."""
    reports = [r.name for r in REPORTS if not (names and r.tables) or set(r.tables) & set(names)]
    return (table for table in tables_of(results, reports) if not names or table.name in names)


def tables_of(results: Results | ChainResults, reports: Collection[str]) -> Iterator[Table]:
    """Yield the tables of the reports with these names. A report is omitted if the stage that it requires has not
    run.
    """
    for report in REPORTS:
        if report.name in reports:
            yield from report.make_tables(results)
