"""Tables and JSON of a synthesis: input data, solution, and values measured on the mechanism.

Tables and records of result.json are made from the same listings (`Listing` of tmm_cli.synthesis).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from tmm_cli.language import N_, _, numeral, translated
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.quantities import DIMENSIONS
from tmm_cli.problem import Problem, Synthesised, UnitSystem
from tmm_cli.reports.synthesis_quality import quality_json, quality_table
from tmm_cli.reports.table import Column, Table, json_value
from tmm_cli.synthesis import (
    Kind,
    Listing,
    MeasuredDemand,
    NamedValue,
    SolutionQuality,
    measure_problem,
    quality_of,
)

NUMERIC_KINDS = (*DIMENSIONS, "share")
ROUNDING = 1e-13  # relative: a smaller difference is rounding, and is told as none
DIGITS = 10  # on a terminal; files have 15
# columns as those of a listing, and kinds beside its own: `by`, whether the file asks for it; `share`, to two digits.
# what has no header is in result.json only
VALUE_COLUMNS = (("quantity", N_("quantity"), "word"), ("value", N_("value"), "mixed"), ("kind", N_("unit"), "unit"))
MEASURED_COLUMNS = (
    ("quantity", N_("quantity"), "word"),
    ("asked", N_("origin of the value"), "by"),
    ("wanted", N_("required value"), "mixed"),
    ("measured", N_("measured value"), "mixed"),
    ("kind", N_("unit"), "unit"),
    ("difference", N_("relative difference"), "share"),
    ("open", "", "share"),
    ("met", "", "by"),
)


def synthesis_tables(results: Results) -> Iterable[Table]:
    """Yield the tables of the synthesis that found the linkage, as `tmm synthesis` prints them."""
    synthesis = results.problem.synthesis
    if synthesis is not None and results.motion is not None:
        problem = results.problem
        judged = (quality_of(results), problem.pressure_limits)
        yield from tables_of_synthesis(synthesis, measure_problem(results), problem.units, judged=judged)


def tables_of_synthesis(
    synthesis: Synthesised,
    measured: Sequence[MeasuredDemand] | None,
    units: UnitSystem,
    digits: int = DIGITS,
    *,
    judged: tuple[SolutionQuality | None, tuple[float, float]] | None = None,
) -> Iterable[Table]:
    """Yield the tables of input data, solution, quality and measured requirements of a synthesis.

    Args:
        synthesis: the synthesis with its solution.
        measured: requirements with the values measured on the mechanism; None if there is no linkage.
        units: units of the tables.
        digits: significant figures of the values.
        judged: quality of the mechanism, and largest allowed pressure angles of sliding and of rotating links (rad);
            None for the quality that the task knows, with the usual limits.
    """
    outcome = synthesis.outcome
    bounded = synthesis.names if synthesis.names and set(synthesis.names) <= {v.name for v in outcome.asked} else None
    title, source = (
        _("Task: {task}").format(task=synthesis.task),
        _("Source: {source}").format(source=translated(outcome.source)),
    )
    yield _listing_table(_value_listing("asked", title, outcome.asked, bounded), units, digits)
    solution = _value_listing("found", N_("Solution"), outcome.found, synthesis.names or None)
    yield _listing_table(solution, units, digits, (*outcome.notes, source))
    quality, limits = judged or (outcome.quality, Problem.pressure_limits)
    if quality is not None:
        yield quality_table(quality, limits, units, digits)
    for listing in outcome.listings:
        yield _listing_table(listing, units, digits)
    if measured:
        yield _listing_table(_measured_listing(measured), units, digits)


def parameter_table(synthesis: Synthesised, units: UnitSystem) -> Table:
    """Return the table of parameters found by a synthesis, as shown by `tmm explain`."""
    values = tuple(
        synthesis.outcome.parameters[name] for name in synthesis.names if name in synthesis.outcome.parameters
    )
    listing, note = (
        _value_listing("", N_("Parameters found by synthesis"), values, synthesis.names or None),
        _("Task: {task}"),
    )
    return _listing_table(listing, units, DIGITS, (note.format(task=synthesis.task),))


def unmet_demand_sentences(measured: Sequence[MeasuredDemand], units: UnitSystem) -> Iterable[str]:
    """Yield a sentence for each requirement that is not met, or that cannot be decided because of rounding."""
    for m in measured:
        if m.open:
            yield _(
                "{quantity}: the output is almost at rest at the end of the stroke, so rounding leaves a relative "
                "uncertainty of {by}"
            ).format(quantity=translated(m.demand.text), by=numeral(m.open, ".2g"))
        if not m.met:
            required, actual = (_value_text(value, m.demand.kind, units, DIGITS) for value in (m.demand.value, m.value))
            yield _("{quantity}: required value {wanted}, measured value {found}").format(
                quantity=translated(m.demand.text),
                wanted=f"{required} {_unit_text(m.demand.kind, units)}".rstrip(),
                found=actual,
            )


def synthesis_json(
    synthesis: Synthesised,
    measured: Sequence[MeasuredDemand] | None,
    *,
    long: bool = True,
    quality: SolutionQuality | None = None,
) -> dict[str, Any]:
    """Return the synthesis as plain data in SI units and radians.

    long: True to include the tables that are written to files but not printed.
    quality: quality of the mechanism; None for the quality that the task knows.
    """
    outcome = synthesis.outcome
    keys = {value.name: value.name for value in (*outcome.asked, *outcome.found) if value.name}
    return {
        "task": synthesis.task,
        "asked": _listing_records(_value_listing("asked", "", outcome.asked, keys)),
        "found": _listing_records(_value_listing("found", "", outcome.found, keys)),
        "parameters": {synthesis.names[n]: json_value(float(v.value)) for n, v in outcome.parameters.items()},
        "tables": {listing.name: _listing_records(listing) for listing in outcome.listings if long or not listing.long},
        "quality": quality_json(quality or outcome.quality),
        "source": outcome.source,
        "measured": None if measured is None else _listing_records(_measured_listing(measured)),
        "met": None if measured is None else all(m.met for m in measured),
    }


def _value_listing(name: str, title: str, values: Sequence[NamedValue], names: Mapping[str, str] | None) -> Listing:
    """Return values as a table in the form of a `Listing`.

    names: name in the file of each parameter, by its standard name; None to omit the column of parameters.
    """
    rows = tuple((v.text, v.value, v.kind) for v in values)
    if names is None:
        return Listing(name, title, VALUE_COLUMNS, rows)
    named = tuple((names.get(v.name), *row) for v, row in zip(values, rows, strict=True))
    return Listing(name, title, (("name", N_("parameter"), "word"), *VALUE_COLUMNS), named)


def _measured_listing(measured: Sequence[MeasuredDemand]) -> Listing:
    rows = tuple(
        (m.demand.text, m.demand.asked, m.demand.value, m.value, m.demand.kind, m.difference, m.open, m.met)
        for m in measured
    )
    return Listing(
        "measured",
        N_("Values required of the synthesis or predicted by it, and values measured on the mechanism"),
        MEASURED_COLUMNS,
        rows,
    )


def _listing_table(listing: Listing, units: UnitSystem, digits: int, notes: tuple[str, ...] = ()) -> Table:
    columns = []
    for k, (__, header, kind) in enumerate(listing.columns):
        values, dimension = [row[k] for row in listing.rows], None
        if kind in DIMENSIONS:
            dimension = DIMENSIONS[kind].dimension
        elif kind == "mixed":
            values = [
                _value_text(v, row_kind, units, digits) for v, row_kind in zip(values, _row_kinds(listing), strict=True)
            ]
        elif kind == "unit":
            values = [_unit_text(row_kind, units) for row_kind in values]
        elif kind == "by":
            values = [_("specified") if value else _("predicted") for value in values]
        elif kind == "share":
            values = [numeral(0.0 if abs(value) < ROUNDING else value, ".2g") for value in values]
        else:
            values = ["" if v is None else translated(v) for v in values]
        columns += [Column(header, values, dimension)] if header else []
    name = f"synthesis-{listing.name}".rstrip("-")
    return Table(name, translated(listing.title), tuple(columns), listing.long, tuple(map(translated, notes)))


def _listing_records(listing: Listing) -> list[dict[str, Any]]:
    """Return the rows of a listing as records keyed by column, in SI units and radians."""
    return [
        {
            name: json_value(float(value))
            if value is not None and (row_kind if kind == "mixed" else kind) in NUMERIC_KINDS
            else value
            for (name, __, kind), value in zip(listing.columns, row, strict=True)
        }
        for row, row_kind in zip(listing.rows, _row_kinds(listing), strict=True)
    ]


def _row_kinds(listing: Listing) -> list[Kind]:
    """Return the kind of quantity (e.g. length) in each row of a listing, as given by its column of units.

    The result is empty if there is no such column.
    """
    unit = next((k for k, (*__, kind) in enumerate(listing.columns) if kind == "unit"), None)
    return ["" if unit is None else row[unit] for row in listing.rows]


def _value_text(value: Any, kind: Kind, units: UnitSystem, digits: int) -> str:
    if value is None or kind == "word":
        return "" if value is None else translated(value)
    number = float(value)
    return (
        _("none") if math.isnan(number) else numeral(units.from_si(number, DIMENSIONS[kind].dimension), f".{digits}g")
    )


def _unit_text(kind: Kind, units: UnitSystem) -> str:
    return units.spelt(DIMENSIONS[kind].dimension) if kind in DIMENSIONS else ""
