"""Range of the driver, strokes of the output, dead positions."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from tmm_cli.pipeline import Results
from tmm_cli.problem.dimensions import ANGLE, LENGTH, NUMBER, Dimension
from tmm_cli.results.table import Column, Table
from tmm_cli.words import say


def tables(results: Results) -> Iterable[Table]:
    """One row a fact; values keep their own dimension."""
    way = results.way
    if results.motion is None or way is None:
        return
    place = ANGLE if results.linkage.driver.kind == "turn" else LENGTH
    rows: list[tuple[str, Any, Dimension]] = []
    if way.turns > 1:
        rows.append((say("quality.turns"), way.turns, NUMBER))
    if not way.full:
        rows += [(say("quality.from"), way.start, place), (say("quality.to"), way.end, place)]
    for strokes in (results.strokes, *results.further):
        if strokes is None or not strokes.strokes:
            continue
        run = LENGTH if strokes.kind == "slide" else ANGLE
        rows.append((say(f"quality.{strokes.kind}", link=strokes.link), strokes.travel, run))
        rows.append((say("quality.k"), strokes.k, NUMBER))
        for stroke in strokes.strokes:
            name = say("quality.working" if stroke.working else "quality.idle")
            rows.append((say("quality.start", stroke=name), stroke.start, place))
            rows.append((say("quality.low", link=strokes.link), stroke.low, run))
            rows.append((say("quality.length", stroke=name), stroke.length, place))
            if stroke.rest:
                rows.append((say("quality.rest", stroke=name), stroke.rest, place))
    for travel in results.travels:
        run = LENGTH if travel.kind == "slide" else ANGLE
        rows.append((say(f"quality.travel_{travel.kind}", link=travel.link), travel.high - travel.low, run))
        rows.append((say("quality.lowest", link=travel.link), travel.low, run))
        rows.append((say("quality.there"), travel.low_at, place))
        rows.append((say("quality.highest", link=travel.link), travel.high, run))
        rows.append((say("quality.there"), travel.high_at, place))
    rows += [(say("quality.dead", group=dead.group), dead.place, place) for dead in results.dead]
    if rows:
        yield Table("quality", say("quality.title"), _mixed(rows, results))


def _mixed(rows: list[tuple[str, Any, Dimension]], results: Results) -> tuple[Column, ...]:
    """Rows of different dimensions: the unit stands in a column of its own."""
    units = results.problem.units
    return (
        Column(say("word.what"), [name for name, _, _ in rows]),
        Column(say("word.value"), [units.from_si(float(value), dim) for _, value, dim in rows], NUMBER),
        Column(say("word.unit"), ["" if dim == NUMBER else units.symbol(dim) for _, _, dim in rows]),
    )
