"""Tables and JSON of a synthesis: what was asked, what was found, what is measured on the mechanism."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

from tmm_cli.problem.dimensions import KINDS
from tmm_cli.problem.record import Synthesised
from tmm_cli.problem.units import UnitSystem
from tmm_cli.results.table import Column, Table
from tmm_cli.synthesis.check import Measured
from tmm_cli.synthesis.record import Listing, Value
from tmm_cli.words import say

DIGITS = 10  # on a terminal; files have 15


def tables(
    found: Synthesised, measured: Sequence[Measured] | None, units: UnitSystem, digits: int = DIGITS
) -> Iterable[Table]:
    """Asked, found, measured (None: there is no linkage)."""
    outcome = found.outcome
    bounded = found.names if found.names and set(found.names) <= {v.name for v in outcome.asked} else {}
    yield _values("synthesis-asked", say("synthesis.asked", task=found.task), outcome.asked, bounded, units, digits)
    source = say("synthesis.source", source=say(outcome.source))
    notes = (*map(say, outcome.notes), source)
    yield _values("synthesis-found", say("synthesis.found"), outcome.found, found.names, units, digits, notes)
    for listing in outcome.listings:
        yield _listing(listing, units, digits)
    if measured:
        yield _measured(measured, units, digits)


def parameters(found: Synthesised, units: UnitSystem) -> Table:
    """For `tmm explain`: the parameters that were found."""
    values = tuple(found.outcome.parameters[name] for name in found.names if name in found.outcome.parameters)
    note = say("synthesis.asked", task=found.task)
    return _values("synthesis", say("synthesis.explain"), values, found.names, units, DIGITS, (note,))


def _values(
    name: str, title: str, values: Sequence[Value], names: Any, units: UnitSystem, digits: int,
    notes: tuple[str, ...] = (),
) -> Table:  # fmt: skip
    rows = [(names.get(v.name, ""), say(v.words), *_shown(v.value, v.kind, v.text, units, digits)) for v in values]
    keys = ["synthesis.name", "synthesis.quantity", "word.value", "word.unit"]
    columns = [Column(say(key), [row[k] for row in rows]) for k, key in enumerate(keys)]
    return Table(name, title, tuple(columns[0 if names else 1 :]), notes=notes)


def _listing(listing: Listing, units: UnitSystem, digits: int) -> Table:
    unit = next((k for k, (_, kind) in enumerate(listing.columns) if kind == "unit"), None)
    columns = []
    for k, (words, kind) in enumerate(listing.columns):
        if kind == "unit":
            values: list[Any] = [units.symbol(KINDS[row[k]].dimension) if row[k] else "" for row in listing.rows]
            columns.append(Column(say(words), values))
        elif kind == "name":
            columns.append(Column(say(words), [row[k] or "" for row in listing.rows]))
        elif kind == "word":
            columns.append(Column(say(words), [say(row[k]) if row[k] else "" for row in listing.rows]))
        elif kind == "mixed":
            assert unit is not None
            shown = ["" if row[k] is None else _shown(row[k], row[unit], "", units, digits)[0] for row in listing.rows]
            columns.append(Column(say(words), shown))
        else:
            columns.append(Column(say(words), [row[k] for row in listing.rows], KINDS[kind].dimension))
    return Table(f"synthesis-{listing.name}", say(listing.title), tuple(columns), listing.long)


def _shown(value: Any, kind: str, text: str, units: UnitSystem, digits: int) -> tuple[str, str]:
    if kind == "word":
        return (say(text) if text.count(".") else text), ""
    number = float(value)
    if math.isnan(number):
        return say("synthesis.none"), ""
    dimension = KINDS[kind].dimension
    return f"{units.from_si(number, dimension):.{digits}g}", units.symbol(dimension)


def _measured(measured: Sequence[Measured], units: UnitSystem, digits: int) -> Table:
    rows = []
    for m in measured:
        wanted, unit = _shown(m.demand.value, m.demand.kind, "", units, digits)
        on = _shown(m.value, m.demand.kind, "", units, digits)[0]
        by = say("synthesis.by_task" if m.demand.asked else "synthesis.by_formula")
        rows.append((say(m.demand.words), by, wanted, on, unit, f"{m.difference:.2g}"))
    keys = ("quantity", "by", "wanted", "on_mechanism", "unit", "difference")
    columns = tuple(
        Column(say("word.unit" if key == "unit" else f"synthesis.{key}"), [row[k] for row in rows])
        for k, key in enumerate(keys)
    )
    return Table("synthesis-measured", say("synthesis.measured"), columns)


def missed(measured: Sequence[Measured], units: UnitSystem) -> Iterable[str]:
    """What is not met, and what rounding leaves open, in words."""
    for m in measured:
        if m.open:
            yield say("synthesis.open", quantity=say(m.demand.words), by=f"{m.open:.2g}")
        if not m.met:
            wanted, unit = _shown(m.demand.value, m.demand.kind, "", units, DIGITS)
            on = _shown(m.value, m.demand.kind, "", units, DIGITS)[0]
            yield say("synthesis.not_met", quantity=say(m.demand.words), wanted=f"{wanted} {unit}".rstrip(), found=on)


def to_json(found: Synthesised, measured: Sequence[Measured] | None, *, long: bool = True) -> dict[str, Any]:
    """Everything in SI and radians; long: tables for files too."""

    def value(v: Value) -> dict[str, Any]:
        shown = (say(v.text) if "." in v.text else v.text) if v.kind == "word" else _number(v.value)
        return {"name": v.name or None, "quantity": say(v.words), "kind": v.kind, "value": shown}

    return {
        "task": found.task,
        "asked": [value(v) for v in found.outcome.asked],
        "found": [value(v) for v in found.outcome.found],
        "parameters": {found.names[n]: _number(v.value) for n, v in found.outcome.parameters.items()},
        "tables": {listing.name: _records(listing) for listing in found.outcome.listings
                   if long or not listing.long},
        "source": say(found.outcome.source),
        "measured": None if measured is None else [
            {"quantity": say(m.demand.words), "kind": m.demand.kind, "asked": m.demand.asked,
             "wanted": m.demand.value, "measured": _number(m.value), "difference": _number(m.difference),
             "open": m.open, "met": m.met}
            for m in measured
        ],
        "met": None if measured is None else all(m.met for m in measured),
    }  # fmt: skip


def _records(listing: Listing) -> list[dict[str, Any]]:
    """Rows by the names of their columns, SI and radians."""

    def plain(value: Any, kind: str) -> Any:
        if value is None or kind in ("name", "unit"):
            return value
        return say(value) if kind == "word" else _number(value)

    keys = [words.rpartition(".")[2].removeprefix("column_") for words, _ in listing.columns]
    kinds = [kind for _, kind in listing.columns]
    return [
        {key: plain(value, kind) for key, value, kind in zip(keys, row, kinds, strict=True)} for row in listing.rows
    ]


def _number(value: Any) -> float | None:
    return float(value) if math.isfinite(float(value)) else None
