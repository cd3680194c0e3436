"""Range of the driver, strokes of the output, dead positions."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from tmm_cli.analysis.pipeline import Results
from tmm_cli.errors import _
from tmm_cli.kinematics.strokes import Strokes, Travel
from tmm_cli.quantities import NUMBER, Dimension, place_dimension
from tmm_cli.results.table import Column, Table

Row = tuple[str, Any, Dimension]


def tables(results: Results) -> Iterable[Table]:
    """One row a fact; values keep their own dimension."""
    driver_range = results.driver_range
    assert driver_range is not None
    place = place_dimension(results.linkage.driver.kind)
    rows: list[Row] = []
    if driver_range.turns > 1:
        rows.append((_("turns of the driver in a cycle"), driver_range.turns, NUMBER))
    if not driver_range.full:
        rows += [(_("driver can go from"), driver_range.start, place), (_("driver can go to"), driver_range.end, place)]
    for strokes in (results.strokes, *results.further):
        if strokes is not None and strokes.strokes:
            rows += _strokes(strokes, place)
    for travel in results.travels:
        rows += _travel(travel, place)
    rows += [(_("dead position of {group}").format(group=dead.group), dead.place, place) for dead in results.dead]
    if rows:
        yield Table("quality", _("Quality"), _mixed(rows, results))


def _strokes(strokes: Strokes, place: Dimension) -> Iterable[Row]:
    """Strokes of an output that goes there and back as the driver turns."""
    link, run = strokes.link, place_dimension(strokes.kind)
    name = _("stroke H of link {link}") if strokes.kind == "slide" else _("swing psi of link {link}")
    yield name.format(link=link), strokes.travel, run
    yield _("coefficient of change of mean speed k"), strokes.k, NUMBER
    for stroke in strokes.strokes:
        yield _("working stroke starts at") if stroke.working else _("idle stroke starts at"), stroke.start, place
        yield _("link {link} is then at").format(link=link), stroke.low, run
        yield _("working stroke lasts") if stroke.working else _("idle stroke lasts"), stroke.length, place
        if stroke.rest:
            name = _("dwell after the working stroke") if stroke.working else _("dwell after the idle stroke")
            yield name, stroke.rest, place


def _travel(travel: Travel, place: Dimension) -> Iterable[Row]:
    """How far an output goes over the positions asked."""
    link, run = travel.link, place_dimension(travel.kind)
    name = (
        _("stroke H of link {link} over the positions asked")
        if travel.kind == "slide"
        else _("swing psi of link {link} over the positions asked")
    )
    yield name.format(link=link), travel.high - travel.low, run
    for extreme, at in ((travel.low, travel.low_at), (travel.high, travel.high_at)):
        yield _("extreme position of link {link}").format(link=link), extreme, run
        yield _("with the driver at"), at, place


def _mixed(rows: list[Row], results: Results) -> tuple[Column, ...]:
    """Rows of different dimensions: the unit stands in a column of its own."""
    units = results.problem.units
    return (
        Column(_("what"), [name for name, __, __ in rows]),
        Column(_("value"), [units.from_si(float(value), dim) for __, value, dim in rows], NUMBER),
        Column(_("unit"), [units.symbol(dim) for __, __, dim in rows]),
    )
