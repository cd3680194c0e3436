"""What balances the driver as a student draws it: the force plan beside the Zhukovsky lever, in positions in detail."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from tmm_cli.analysis.in_detail import in_detail
from tmm_cli.analysis.pipeline import Results
from tmm_cli.language import N_, Phrase, _
from tmm_cli.plans.drawn import drawn_check, sheets
from tmm_cli.quantities import FORCE, MOMENT, NUMBER
from tmm_cli.results.reports.cycle import driver_columns
from tmm_cli.results.table import Column, Table
from tmm_cli.tolerances import NO_DIFFERENCE


def tables(results: Results) -> Iterable[Table]:
    """A row for each position in detail: what both ways give on paper, and how far apart they are."""
    motion, reactions, lever = results.motion, results.reactions, results.lever
    assert motion is not None and reactions is not None and lever is not None
    positions = [(k, sheets(motion, reactions, lever, k)) for k in in_detail(results) if lever.items]
    checked = [
        (k, drawn_check(motion, reactions, drawn, drawn.scales())) for k, drawn in positions if drawn is not None
    ]
    if not checked:
        return
    moment = reactions.balance.kind == "moment"
    name, dimension = (N_("M_b"), MOMENT) if moment else (N_("F_b"), FORCE)
    chosen = [k for k, __ in checked]
    head = [replace(column, values=[column.values[k] for k in chosen]) for column in driver_columns(results)]
    exact = [100 * float(lever.difference[k]) for k in chosen]
    columns = [
        Column(Phrase("{name} by the force plan", name=name), [abs(c.plan) for __, c in checked], dimension, 4),
        Column(Phrase("{name} by the lever", name=name), [abs(c.lever) for __, c in checked], dimension, 4),
        Column(N_("difference, %"), [100 * c.difference for __, c in checked], NUMBER, 2),
        Column(N_("exact difference, %"), [0.0 if x < 100 * NO_DIFFERENCE else x for x in exact], NUMBER, 2),
    ]
    note = _(
        "As drawn: arms and segments are read off drawings on A4 to 0.5 mm, so this difference is one of drawing; the "
        "limit `checks: lever` is for the exact difference, of what is calculated by both ways."
    )
    yield Table("lever-drawn", _("The force plan and the lever as drawn"), (*head, *columns), notes=(note,))
