"""Quality of a mechanism found by a synthesis: its table, and warnings if a pressure angle exceeds its limit."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

from tmm_cli.language import N_, _, numeral, translated
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.quantities import ANGLE
from tmm_cli.problem import UnitSystem
from tmm_cli.reports.table import Column, Table, json_value, with_unit
from tmm_cli.synthesis import LEAST_USABLE, SolutionQuality, quality_of

DIGITS = 6


def quality_table(
    quality: SolutionQuality, limits: tuple[float, float], units: UnitSystem, digits: int = DIGITS
) -> Table:
    """Return the table of the quality of a mechanism found by a synthesis.

    It contains the smallest transmission angle, the largest pressure angle, and whether the crank rotates fully and the
    positions are reached in one assembly and in order.

    Args:
        quality: quality of the mechanism.
        limits: largest allowed pressure angles of sliding and of rotating links (rad), as for a run.
        units: units of the table.
        digits: significant figures of the values.
    """
    allowed = limits[0 if quality.slides else 1]

    def text(angle: float) -> str:
        return numeral(units.from_si(angle, ANGLE), f".{digits}g")

    least, most = N_("at least {angle}"), N_("at most {angle}")
    transmission = max(math.pi / 2 - quality.pressure, 0.0)
    rows: tuple[tuple[str, str, str, float], ...] = (
        (N_("smallest transmission angle"), text(transmission), least, math.pi / 2 - allowed),
        (N_("largest pressure angle"), text(quality.pressure), most, allowed),
        (N_("input link rotates fully"), _("yes") if quality.crank else _("no"), "", 0.0),
        (N_("all positions in one assembly"), _("no") if quality.defect == "branch" else _("yes"), "", 0.0),
        (N_("positions reached in order"), _("no") if quality.defect == "order" else _("yes"), "", 0.0),
    )
    unit = units.spelt(ANGLE)
    columns = (
        Column(N_("quantity"), [translated(row[0]) for row in rows]),
        Column(N_("value"), [row[1] for row in rows]),
        Column(N_("unit"), [unit if row[2] else "" for row in rows]),
        Column(N_("usual limit"), [_(bound).format(angle=text(at)) if bound else "" for __, __, bound, at in rows]),
    )
    return Table("synthesis-quality", _("Quality of the mechanism"), columns, False, ())


def quality_json(quality: SolutionQuality | None) -> dict[str, Any] | None:
    """Return the quality of a mechanism as plain data, angles in radians."""
    if quality is None:
        return None
    return {
        "transmission": json_value(max(math.pi / 2 - quality.pressure, 0.0)),
        "pressure": json_value(quality.pressure),
        "crank": quality.crank,
        "defect": quality.defect or None,
    }


def quality_sentences(quality: SolutionQuality, limits: tuple[float, float], units: UnitSystem) -> Iterable[str]:
    """Yield a sentence if the mechanism cannot be used, or if its pressure angle exceeds the limit that applies to a
    run.
    """
    allowed = limits[0 if quality.slides else 1]
    least, largest, usable, limit = (
        with_unit(units, angle, ANGLE, 4)
        for angle in (max(math.pi / 2 - quality.pressure, 0.0), quality.pressure, LEAST_USABLE, allowed)
    )
    if math.pi / 2 - quality.pressure < LEAST_USABLE * (1 - 1e-6):
        yield _(
            "this is no usable mechanism: its smallest transmission angle is {least}; with less than {usable} it does "
            "not move under load"
        ).format(least=least, usable=usable)
    elif quality.pressure > allowed and not quality.limited:
        yield _(
            "the pressure angle of the mechanism found reaches {largest} (transmission angle {least}); usually at most "
            "{limit} is allowed"
        ).format(largest=largest, least=least, limit=limit)


def unusable_mechanism(results: Results) -> Iterable[str]:
    """Warn of a mechanism found by a synthesis that cannot be used.

    If the driver does not rotate fully, a pressure angle above its limit is reported too. For a driver that rotates
    fully the pressure angles of all links are checked elsewhere.
    """
    quality = quality_of(results)
    if quality is None:
        return
    full = results.driver_range is not None and results.driver_range.full
    if not full or math.pi / 2 - quality.pressure < LEAST_USABLE:
        yield from quality_sentences(quality, results.problem.pressure_limits, results.problem.units)
