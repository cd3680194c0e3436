"""The Zhukovsky lever: every force and couple with its arm and moment, a row for each at every position."""

from __future__ import annotations

from collections.abc import Iterable

from tmm_cli.forces.lever import Item
from tmm_cli.pipeline import Results
from tmm_cli.problem.dimensions import FORCE, LENGTH, MOMENT, NUMBER
from tmm_cli.results.reports.long import Values, long_table
from tmm_cli.results.table import Table
from tmm_cli.words import say


def tables(results: Results) -> Iterable[Table]:
    """One table: forces with arms in length per unit turn of the crank, couples with the ratio of angular speeds."""
    lever = results.lever
    if lever is None or not lever.items:
        return
    crank = results.linkage.driver.kind == "turn"
    words = {"forces.name": [i.name for i in lever.items], "word.link": [i.link for i in lever.items]}
    yield long_table(results, "lever", words, [_values(i, crank) for i in lever.items], say("lever.note"))


def _values(item: Item, crank: bool) -> Values:
    force = item.end is not None
    return [
        ("lever.force", item.size if force else None, FORCE),
        ("lever.arm", item.arm if force else None, LENGTH if crank else NUMBER),
        ("lever.couple", None if force else item.size, MOMENT),
        ("lever.ratio", None if force else item.arm, NUMBER),
        ("lever.moment", item.moment, MOMENT if crank else FORCE),
    ]
