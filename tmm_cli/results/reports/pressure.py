"""Pressure and transmission angles of every group over the driver's way, with what is allowed."""

from __future__ import annotations

import math
from collections.abc import Iterable

from tmm_cli.analysis.pipeline import Results
from tmm_cli.language import N_, _
from tmm_cli.quantities import ANGLE, NUMBER, place_dimension
from tmm_cli.results.table import Column, Table
from tmm_cli.tolerances import NO_PRESSURE


def tables(results: Results) -> Iterable[Table]:
    """A row for each driven link."""
    found = results.pressure
    if not found:
        return
    driver, driver_range = results.linkage.driver, results.driver_range
    places = [p.place if p.largest > NO_PRESSURE else math.nan for p in found]
    others = [p.other_place for p in found]
    if driver.kind == "turn" and driver_range is not None and driver_range.full:
        places = [place % (2 * math.pi * driver_range.turns) for place in places]
        others = [place % (2 * math.pi * driver_range.turns) for place in others]
    note = (
        _("Allowed: as the file says.")
        if any(results.problem.limits_set)
        else _("Allowed where the file says nothing: 30 deg on a sliding link, 45 deg on a turning one.")
    )
    yield Table(
        "pressure", _("Pressure angles"),
        (
            Column(N_("group"), [p.group for p in found]),
            Column(N_("driven link"), [p.link for p in found]),
            Column(N_("it"), [_("slides") if p.slides else _("turns") for p in found]),
            Column(N_("driven in pair"), [p.pair for p in found]),
            Column(N_("largest"), [p.largest for p in found], ANGLE),
            Column(N_("driver there at"), places, place_dimension(driver.kind)),
            Column(N_("other extreme"), [p.other for p in found], ANGLE),
            Column(N_("driver then at"), others, place_dimension(driver.kind)),
            Column(N_("least transmission angle"), [p.transmission for p in found], ANGLE),
            Column(N_("force increase"), [p.gain for p in found], NUMBER),
            Column(N_("allowed"), [p.allowed for p in found], ANGLE),
            Column(N_("verdict"), [_("within") if p.holds else _("exceeds") for p in found]),
        ),
        notes=(note,),
    )  # fmt: skip
