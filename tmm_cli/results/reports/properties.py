"""Properties that the file shows, beside what it expects."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.analysis.pipeline import Results
from tmm_cli.analysis.spatial_chain import ChainResults
from tmm_cli.language import N_, _
from tmm_cli.quantities import NUMBER
from tmm_cli.results.properties import properties_shown
from tmm_cli.results.table import Column, Table


def tables(results: Results | ChainResults) -> Iterable[Table]:
    """A row a property; values keep their own dimension."""
    rows, units = properties_shown(results), results.problem.units
    if not rows:
        return
    columns = [
        Column(N_("property"), [row.name for row in rows]),
        Column(N_("value"), [units.from_si(row.value, row.dimension) for row in rows], NUMBER),
    ]
    if any(row.expected is not None for row in rows):
        wanted = [None if r.expected is None else units.from_si(r.expected, r.dimension) for r in rows]
        columns.append(Column(N_("expected"), wanted, NUMBER))
    columns.append(Column(N_("unit"), [units.spelt(row.dimension) for row in rows]))
    yield Table("properties", _("Properties"), tuple(columns))
