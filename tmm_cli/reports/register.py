"""What is reported, in the order in which it is shown. A new report is a function and a line in REPORTS.

The function `<report>_tables(results)` gives its tables; it gives none when its stage was not asked for.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from importlib import import_module

from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.structure import ChainResults
from tmm_cli.reports.table import Table

# report, its module here without _tables, the part of Results that it needs, the tables it gives (of other names
# where there are none): a report of a stage that did not run, or of which no table is wanted, is not even imported
REPORTS: tuple[tuple[str, str, str, tuple[str, ...]], ...] = (
    ("synthesis", "synthesis", "motion", ("synthesis-asked", "synthesis-found", "synthesis-measured")),
    ("structure", "structure", "structure", ("structure", "links", "pairs", "groups")),
    ("space", "space", "structure", ("contours", "space", "replacements")),
    ("chain", "space", "chain", ()),
    ("quality", "quality", "motion", ("quality",)),
    ("properties", "quality", "problem", ("properties",)),
    ("intermittent", "dynamics", "wheels", ("intermittent", "intermittent-cycle", "intermittent-course")),
    ("pressure", "quality", "motion", ("pressure",)),
    ("cycle", "cycle", "motion", ("cycle",)),
    ("kinematics", "cycle", "motion", ("points", "link-motion", "slides")),
    ("forces", "force", "reactions", ("reactions", "pins", "loads", "transmission", "balance")),
    ("lever", "force", "lever", ("lever",)),
    ("drawn", "force", "lever", ("lever-drawn",)),
    ("energy", "force", "energy", ("energy", "friction")),
    ("dynamics", "dynamics", "running", ("dynamics", "law-of-motion")),
    ("balancing", "dynamics", "balancing", ("balancing", "shaking")),
    ("centres", "cycle", "centres", ("centres", "advantage")),
    ("extremes", "cycle", "extremes", ("extremes",)),
    ("assemblies", "quality", "assemblies", ()),
    ("checks", "quality", "lever", ("checks",)),
)


def tables(results: Results | ChainResults) -> tuple[Table, ...]:
    """Every table of the results."""
    return tuple(walk(results))


def walk(results: Results | ChainResults, wanted: Collection[str] = ()) -> Iterator[Table]:
    """Every table of the results, or those wanted by name, made one after the other."""
    chosen = [name for name, __, ___, given in REPORTS if not (wanted and given) or set(given) & set(wanted)]
    return (table for table in tables_of(results, chosen) if not wanted or table.name in wanted)


def tables_of(results: Results | ChainResults, reports: Collection[str]) -> Iterator[Table]:
    """The tables of these reports, as far as the stages that they need have run."""
    for name, module, part, __ in REPORTS:
        if name in reports and getattr(results, part, None) is not None:
            yield from getattr(import_module(f"tmm_cli.reports.{module}_tables"), f"{name}_tables")(results)
