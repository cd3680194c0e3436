"""The Zhukovsky lever: every force and couple with its arm and moment, a row for each at every position."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.analysis.pipeline import Results
from tmm_cli.forces.lever import Item
from tmm_cli.language import N_, _
from tmm_cli.plans.bodies import load_names
from tmm_cli.quantities import LEVER_COUPLE, LEVER_FORCE, LEVER_MOMENT, NamedValues, columns
from tmm_cli.results.reports.long import long_table
from tmm_cli.results.table import Table


def tables(results: Results) -> Iterable[Table]:
    """One table: forces with arms in length per unit turn of the crank, couples with the ratio of angular speeds."""
    lever = results.lever
    assert lever is not None
    if not lever.items:
        return
    slider = results.linkage.driver.kind == "slide"
    assert results.reactions is not None
    own: dict[str, str] = {}  # letters of the course
    for load in results.reactions.applied:
        force, couple = load_names(load)
        own |= {load.couple_name: couple, load.name: force}
    words = {N_("name"): [own[i.name] for i in lever.items], N_("link"): [i.link for i in lever.items]}
    note = _(
        "Arms are those of the lever drawn for a crank that turns counterclockwise with 1 rad/s, 1 m for 1 m/s; "
        "moments are positive that drive it so."
    )
    items = [_columns(item, slider) for item in lever.items]
    yield long_table(results, "lever", _("Zhukovsky lever"), words, items, note)


def _columns(item: Item, slider: bool) -> list[NamedValues]:
    force, couple = (item, None) if item.end is not None else (None, item)
    return [
        *columns(LEVER_FORCE, force, slider), *columns(LEVER_COUPLE, couple, slider),
        *LEVER_MOMENT.columns(item, slider),
    ]  # fmt: skip
