"""Power balance, reduced inertia and reduced moment at every position; friction over the cycle."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.language import N_, _, numeral
from tmm_cli.quantities import ENERGY, LENGTH, NUMBER, columns, place_dimension
from tmm_cli.results.reports.cycle import driver_columns
from tmm_cli.results.table import Column, Table
from tmm_cli.tolerances import SAME_PLACE, SAME_RATIO


def tables(results: Results) -> Iterable[Table]:
    """The balance, and where there is friction what it takes."""
    found = results.energy
    assert found is not None
    quantities = [quantity for quantity in ENERGY if quantity.name != "friction" or results.friction is not None]
    columns_of = columns(quantities, found, results.linkage.driver.kind == "slide")
    table = [
        *driver_columns(results),
        *(Column(header, values, dimension) for header, values, dimension in columns_of),
        Column(N_("left over, %"), 100 * np.abs(found.balance), NUMBER, digits=2),
    ]
    note = _(
        "Powers are positive that speed the mechanism up. What is reduced to the driver is by its place, which grows "
        "counterclockwise, or along the guide, however it moves."
    )
    yield Table("energy", _("Power balance and the mechanism reduced to its driver"), tuple(table), notes=(note,))
    if results.friction is not None:
        yield _friction(results)


def _friction(results: Results) -> Table:
    rubbed, lost = results.friction, results.losses
    assert rubbed is not None
    given = results.linkage.friction
    notes = [_("no efficiency over the cycle: the driver is locked somewhere, or does no work")]
    if lost is not None and lost.efficiency is not None:
        notes = [_("efficiency over the cycle: {share} %").format(share=numeral(100 * lost.efficiency, ".4g"))]
    notes += [_("locks itself {range}").format(range=text) for text in locked_ranges(results)]
    return Table(
        "friction", _("Friction"),
        (
            Column(N_("pair"), [f.pair for f in given]),
            Column(N_("mu"), [f.coefficient for f in given], NUMBER),
            Column(N_("journal radius"), [f.radius if f.radius else float("nan") for f in given], LENGTH),
            Column(N_("work in the cycle, J"), [lost.pairs[f.pair] if lost else float("nan") for f in given], NUMBER),
        ),
        notes=tuple(notes),
    )  # fmt: skip


def locked_ranges(results: Results) -> list[str]:
    """Ranges of the driver in which friction locks the mechanism, with the positions in them and the pair."""
    units, measure = results.problem.units, place_dimension(results.linkage.driver.kind)
    cycle, found = 2 * np.pi * results.turns, []
    for locked in results.losses.ranges if results.losses is not None else ():
        ends = np.array([locked.start, locked.end])
        asked = results.asked[list(results.numbers)]
        if cycle:
            whole = ends[1] - ends[0] > cycle * (1 - SAME_RATIO)
            asked = locked.start + np.mod(asked - locked.start + SAME_PLACE, cycle) - SAME_PLACE
            ends = ends - ends[0] if whole else np.mod(ends, cycle)
        inside = (asked > locked.start - SAME_PLACE) & (asked < locked.end + SAME_PLACE)
        numbers = [str(number) for number, here in zip(results.numbers, inside, strict=True) if here]
        start, end = (numeral(float(units.from_si(q, measure)), ".5g") for q in ends)
        pair = results.structure.pair(locked.pair)
        if not numbers:
            text = _(
                "from {start} to {end} {unit}, between the positions, most of all in pair {pair} of links {i} and {j}"
            )
        elif len(numbers) == 1:
            text = _(
                "from {start} to {end} {unit} (position {numbers}), most of all in pair {pair} of links {i} and {j}"
            )
        else:
            text = _(
                "from {start} to {end} {unit} (positions {numbers}), most of all in pair {pair} of links {i} and {j}"
            )
        found.append(text.format(
            start=start, end=end, unit=units.spelt(measure), numbers=", ".join(numbers), pair=locked.pair, i=pair.i,
            j=pair.j,
        ))  # fmt: skip
    return found
