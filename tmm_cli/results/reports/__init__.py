"""What is reported, in the order in which it is shown. A new report is a file here and a line in REPORTS.

A report has a function `tables(results)`, which gives its tables; it gives none when its stage was not asked for.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from importlib import import_module

from tmm_cli.analysis.pipeline import Results
from tmm_cli.analysis.spatial_chain import ChainResults
from tmm_cli.results.table import Table

# file here, the part of Results that it needs, the tables it gives (of other names where there are none): a report of a
# stage that did not run, or of which no table is wanted, is not even imported
REPORTS: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    ("synthesis", "motion", ("synthesis-asked", "synthesis-found", "synthesis-measured")),
    ("structure", "structure", ("structure", "links", "pairs", "groups")),
    ("space", "structure", ("contours", "space", "replacements")),
    ("chain", "chain", ()),
    ("quality", "motion", ("quality",)),
    ("properties", "problem", ("properties",)),
    ("intermittent", "wheels", ("intermittent", "intermittent-cycle", "intermittent-course")),
    ("pressure", "motion", ("pressure",)),
    ("cycle", "motion", ("cycle",)),
    ("kinematics", "motion", ("points", "link-motion", "slides")),
    ("forces", "reactions", ("reactions", "pins", "loads", "transmission", "balance")),
    ("lever", "lever", ("lever",)),
    ("drawn", "lever", ("lever-drawn",)),
    ("energy", "energy", ("energy", "friction")),
    ("dynamics", "running", ("dynamics", "law-of-motion")),
    ("balancing", "balancing", ("balancing", "shaking")),
    ("centres", "centres", ("centres", "advantage")),
    ("extremes", "extremes", ("extremes",)),
    ("assemblies", "assemblies", ()),
    ("checks", "lever", ("checks",)),
)


def tables(results: Results | ChainResults) -> tuple[Table, ...]:
    """Every table of the results."""
    return tuple(walk(results))


def walk(results: Results | ChainResults, wanted: Collection[str] = ()) -> Iterator[Table]:
    """Every table of the results, or those wanted by name, made one after the other."""
    chosen = [name for name, __, given in REPORTS if not (wanted and given) or set(given) & set(wanted)]
    return (table for table in tables_of(results, chosen) if not wanted or table.name in wanted)


def tables_of(results: Results | ChainResults, reports: Collection[str]) -> Iterator[Table]:
    """The tables of these reports, as far as the stages that they need have run."""
    for name, part, __ in REPORTS:
        if name in reports and getattr(results, part, None) is not None:
            yield from import_module(f"{__name__}.{name}").tables(results)
