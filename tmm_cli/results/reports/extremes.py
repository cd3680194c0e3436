"""Extreme places of points, links and stones; largest and smallest forces."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.language import N_, _
from tmm_cli.quantities import NUMBER, place_dimension
from tmm_cli.results.table import Column, Table

SEAM = 1e-6  # rad: just before the end of a turn is its beginning


def tables(results: Results) -> Iterable[Table]:
    """A row a quantity; a link that turns fully has no extreme angles."""
    found = results.extremes
    if not found:
        return
    driver, units = results.linkage.driver, results.problem.units
    place, full = place_dimension(driver.kind), results.turns > 0
    words = {
        "x": _("x of {name}"), "y": _("y of {name}"), "angle": _("angle of link {name}"), "s": _("s in {name}"),
        "R": _("R in {name}"), "M": _("couple in {name}"), "R pin": _("force of the pin on the link, {name}"),
        "M_b": _("M_b of {name}"), "F_b": _("F_b of {name}"),
    }  # fmt: skip

    def shown(values: Sequence[float]) -> list[float]:
        return [units.from_si(value, one.dimension) for value, one in zip(values, found or (), strict=True)]

    def places(values: Sequence[float]) -> list[float]:
        turn = 2 * np.pi * max(results.turns, 1)
        return [abs(float(np.mod(q + SEAM, turn)) - SEAM) if full else q for q in values]

    low, high = [one.low for one in found], [one.high for one in found]
    columns = (
        Column(N_("what"), [words[one.kind].format(name=one.name) for one in found]),
        Column(N_("least"), shown(low), NUMBER),
        Column(N_("least, with the driver at"), places([one.low_at for one in found]), place),
        Column(N_("largest"), shown(high), NUMBER),
        Column(N_("largest, with the driver at"), places([one.high_at for one in found]), place),
        Column(N_("range"), shown([most - least for most, least in zip(high, low, strict=True)]), NUMBER),
        Column(N_("unit"), [units.spelt(one.dimension) for one in found]),
    )
    title = _("Largest and smallest forces") if results.reactions is not None else _("Extreme places")
    yield Table("extremes", title, columns, notes=(_("Over the whole cycle, between the positions too."),))
