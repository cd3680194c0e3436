"""Accuracy of the numbers in tables and in result.json: bounds of the rounding error and sensitivity to the input data.

Each number is identified by a key. With its key it is found again in results that are computed with changed lengths or
with higher precision. The key is a tuple. Its first element is True if the number is an angle; the others are the name
of the table and the index of the column, or the path in result.json.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from typing import Any

import numpy as np

from tmm_cli.language import N_, _, numeral, translated
from tmm_cli.mechanics.accuracy import (
    PAPER_CHANGE,
    SIX_FIGURES,
    Digits,
    PreciseLinkage,
    choose_precision,
    is_angle,
    judge_searched,
    judge_values,
    largest_values,
    relative_bound,
    start_uncertainty,
)
from tmm_cli.mechanics.analysis import Results, is_near_dead, motion_at_positions
from tmm_cli.mechanics.kinematics import FIELDS_WITHOUT_POSITIONS
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import ROUNDOFF, Real, Record, map_record
from tmm_cli.mechanics.plans import sheet_scale
from tmm_cli.mechanics.quantities import ANGLE, FORCE, INERTIA, LENGTH, MOMENT, NUMBER, SPEED, Dimension
from tmm_cli.reports.register import REPORTS, tables_of
from tmm_cli.reports.result_json import LARGE_SECTIONS, computed_sections
from tmm_cli.reports.table import Column, Table

POSITION_STAGES = ("motion", "reactions", "lever", "energy")  # parts of Results that are computed at positions
# a search has digits of its own, checks are counted by their texts, drawings are exact to 0.5 mm
NOT_ASSESSED = ("synthesis", "checks", "drawn")
ASSESSED = tuple(r.name for r in REPORTS if r.requires in POSITION_STAGES and r.name not in NOT_ASSESSED)
SEARCHED_REPORTS = {"quality", "pressure"}  # reports of what was searched for alone
Cells = Mapping[Hashable, Real]


def collect_numbers(
    results: Results, reports: Collection[str] = ASSESSED, parts: Collection[str] | None = LARGE_SECTIONS
) -> tuple[Cells, Cells]:
    """Collect the numbers of tables and of result.json.

    Args:
        results: results with a motion.
        reports: names of the reports whose tables are read.
        parts: large sections of result.json that are read; None: only the tables are read.

    Returns:
        Two mappings from keys (see the module) to arrays: numbers with one value per position, and numbers found by a
        search, such as strokes and extreme pressure angles.
    """
    count, turns = len(results.numbers), results.linkage.driver.kind == "turn"
    at_positions: dict[Hashable, Real] = {}
    searched: dict[Hashable, Real] = {}
    for table in computed_tables(results, reports):
        keys = row_keys(table, count)
        for k, column in enumerate(table.columns):
            if column.dimension is not None and keys is None:
                searched[False, table.name, k] = column.array
            elif column.dimension is not None and keys is not None:
                at_positions.update(zip(keys[k], column.array.reshape(count, -1).T, strict=True))
    for path, value in () if parts is None else _leaves(dict(computed_sections(results, parts)), ()):
        if isinstance(value, float):
            searched[(False, *path)] = np.array([value])
        elif getattr(value, "shape", None) == (count,) and value.dtype.kind == "f":
            angle = path[-1] in ("angle", "angles") or (turns and path == ("positions", "driver"))
            at_positions[(angle, *path)] = value
    return at_positions, searched


def numbers_at_positions(results: Results, shown: Collection[str] = ()) -> Cells:
    """Return the numbers that have one value per position, by key (see the module).

    Args:
        results: results with a motion.
        shown: names of tables; if any are given, only numbers from the reports of these tables are returned.
    """
    reports = {r.name for r in REPORTS if not shown or set(r.tables) & set(shown)}
    return collect_numbers(results, reports & set(ASSESSED) - SEARCHED_REPORTS, None if shown else LARGE_SECTIONS)[0]


def search_reader(results: Results, whole: bool = True) -> Callable[[Results], Cells]:
    """Return a function that collects the numbers found by search (such as strokes) from other results of the same
    problem.

    Args:
        results: results with a motion; if they include friction, the numbers of the energy balance are collected too.
        whole: True to collect numbers from result.json as well as from the tables.
    """
    energy = () if results.friction is None else ("energy",)
    return lambda other: collect_numbers(other, ("quality", "pressure", *energy), energy if whole else None)[1]


def computed_tables(results: Results, reports: Collection[str] = ASSESSED) -> Iterator[Table]:
    """Yield the tables of the given reports; if only some points and links are requested, only those of their
    motion.
    """
    return tables_of(results, set(reports) & {"kinematics"} if results.of else reports)


def row_keys(table: Table, count: int) -> list[list[Hashable]] | None:
    """Return the keys of the numbers that each column of a table contains for one position.

    A key describes the number, not the position (see the module). The result is None if the rows of the table are not
    positions.
    """
    if not count or not table.columns or table.columns[0].header != "position" or table.rows % count:
        return None
    rows = range(table.rows // count)
    return [[(c.dimension == ANGLE, table.name, k, row) for row in rows] for k, c in enumerate(table.columns)]


def _leaves(value: Any, path: tuple[str, ...]) -> list[tuple[tuple[str, ...], Any]]:
    """Return the numbers and arrays in nested dicts and lists, each with its path. A list item is named by its
    index.
    """
    leaves: list[tuple[tuple[str, ...], Any]] = []
    for name, nested in _named_parts(value):
        if isinstance(nested, dict | list):
            leaves += _leaves(nested, (*path, name))
        else:
            leaves.append(((*path, name), float(nested) if isinstance(nested, float | np.floating) else nested))
    return leaves


def _named_parts(value: Any) -> Iterable[tuple[str, Any]]:
    return value.items() if isinstance(value, dict) else ((str(k), nested) for k, nested in enumerate(value))


def bounds_in_shape(value: Any, values: Mapping[Any, Real], path: tuple[str, ...] = ()) -> Any:
    """Arrange error bounds in the same nested dicts and lists as the content to which they belong.

    Keys without bounds are omitted, and a list item without bounds becomes {}. The result is None if there are no
    bounds at all.

    Args:
        value: content of result.json, or a part of it.
        values: bounds by path.
        path: path of `value`.
    """
    if isinstance(value, dict):
        inner = {name: bounds_in_shape(nested, values, (*path, name)) for name, nested in value.items()}
        return {name: nested for name, nested in inner.items() if nested is not None} or None
    if isinstance(value, list):
        items = [bounds_in_shape(nested, values, (*path, name)) for name, nested in _named_parts(value)]
        return None if all(item is None for item in items) else [{} if item is None else item for item in items]
    bounds = values.get(path)
    if bounds is None:
        return None
    short = _round_up(bounds)
    return short[0] if isinstance(value, float | np.floating) else short


def _round_up(values: Real) -> list[float]:
    """Round each bound up to two significant figures."""
    with np.errstate(all="ignore"):
        unit = 10.0 ** (np.floor(np.log10(values)) - 1)
        short = np.where(values > 0, np.ceil(values / unit) * unit, values)
    return [float(f"{v:.2g}") for v in short.tolist()]


# Bounds by rounding that cost next to nothing: of numbers at positions, by the margins of the groups.


HUGE = 1e300  # a bound of what is zero as far as is known
SLOPES = ("dJ/dphi, SI", "dm/ds, SI")
RATIOS = {  # columns that are something over a force: the less of it there is the less they are known, of zero nothing
    ("reactions", "angle"): "F",
    ("reactions", "point of action"): "F",
    ("lever", "arm"): "force",
}


def bounds_by_margins(
    results: Results, relative: Real, sizes: Mapping[Dimension, float], table: Table, column: Column
) -> Real:
    """Estimate error bounds of a column from the distances of the Assur groups from dead positions.

    Args:
        results: results from which the table was made.
        relative: bound at each position as a fraction of the largest value of the dimension, (positions,).
        sizes: largest value of each dimension.
        table: table that contains the column; its rows are positions.
        column: column of numbers.
    """
    values = np.abs(column.array)
    column_peak = float(np.max(values, where=np.isfinite(values), initial=0.0))
    assert column.dimension is not None
    reference = sizes.get(column.dimension, column_peak)
    if column.dimension == NUMBER and table.name in ("energy", "cycle"):
        power = sizes.get(FORCE, 0.0) * sizes[SPEED]
        reference = (
            _percent_scale(results, table.name, power, sizes)
            if column.header.endswith("%")
            else max(power, column_peak)
        )
        if column.header in SLOPES and results.energy is not None:  # which has nothing of speeds in it
            reference = 2 * sizes[NUMBER] * sizes[INERTIA]
    bound = np.repeat(relative, table.rows // len(relative)) * reference
    over = RATIOS.get((table.name, column.header))
    if over is not None:
        force = np.abs(next(other.array for other in table.columns if other.header == over))
        share = np.repeat(relative, table.rows // len(relative))
        significant = force > share * sizes[FORCE]
        if column.dimension == LENGTH:  # both what stands over the force and the force are known to the share
            bound = bound + share * values
        return np.where(significant, bound * (sizes[FORCE] / np.where(significant, force, 1.0)), np.inf)
    return np.asarray(np.minimum(bound, HUGE))


def _percent_scale(results: Results, table: str, power: float, sizes: Mapping[Dimension, float]) -> float:
    """Return the reference of rounding errors in a column of percentages, in per cent.

    A percentage is the ratio of a power or moment to a fixed divisor. The reference is the largest power or moment,
    divided by the same divisor.
    """
    assert results.reactions is not None
    if table == "energy" and results.energy is not None:
        series, peak = [results.energy.drivers, results.energy.rate], power
    else:
        series, peak = [balance.generalized for balance in results.reactions.balances], sizes[MOMENT]
    largest = max(float(np.max(np.abs(values), where=np.isfinite(values), initial=0.0)) for values in series)
    return 100 * peak / largest if largest > 0 else HUGE


# Bounds by rounding and sensitivity to the data for every number of the tables and of result.json.
#
# Ordinarily the margins of the groups say how many digits are true (accuracy.margins), and only positions where that is
# less than a table prints are judged. When digits are asked for all are: tables and result.json are made by their own
# functions from the results in double-doubles and from those with changed lengths too, and compared one by one; so no
# quantity can be forgotten, and none needs a formula of its own.


TRAJECTORY_POSITIONS = 361  # places of a trajectory
UNSELECTED_FIELDS = (
    *FIELDS_WITHOUT_POSITIONS - {"where"},
    "mechanism",
    "problem",
    "inputs",
    "structure",
)  # fields that hold no array over positions
MOST_JUDGED = 720  # positions: of a longer cycle only so many are judged, and all that are near dead ones
BOUND_HEADERS = {
    "bound": N_("± rounding error"),
    "lengths": N_("± due to length errors"),
    "paper": N_("± due to drawing errors"),
}


@dataclass(frozen=True)
class AccuracyReport:
    """Accuracy of the numbers of results, both at positions and found by search.

    Attributes:
        results: results with a motion.
        relative: error bound at each position as a fraction of the largest value of the dimension, (positions,).
        sizes: largest value of each dimension.
        found: function that returns the accuracy of numbers found by search; called only for tables with such numbers.
        chosen: indices of the positions at which numbers were examined in detail.
        there: results at these positions only.
        digits: bounds and sensitivities of the numbers in `there`, by key.
        full: True if sensitivities are requested too.
    """

    results: Results
    relative: Real
    sizes: Mapping[Dimension, float]
    found: Callable[[], Digits]
    chosen: Real
    there: Results
    digits: Digits
    full: bool

    def with_bounds(self, tables: Iterable[Table]) -> Iterator[Table]:
        """Yield the tables with error bounds added to their columns; if `full`, also a summary of all columns at the
        end.
        """
        worst: list[tuple[str | float, ...]] = []
        for table in map(self.table, tables):
            rows = list(_worst_columns(table)) if self.full else []
            worst += [(table.name, *row) for row in rows]
            yield replace(table, notes=(*table.notes, _accuracy_note(rows))) if rows else table
        if self.full:
            yield self.summary(worst)

    def table(self, table: Table) -> Table:
        """Return the table with error bounds and sensitivities added to its columns."""
        keys = row_keys(table, len(self.relative))
        columns = [
            replace(column, **self._column_accuracy(table, k, None if keys is None else keys[k]))
            for k, column in enumerate(table.columns)
        ]
        return replace(table, columns=tuple(columns))

    def _column_accuracy(self, table: Table, k: int, keys: list[Hashable] | None) -> dict[str, Any]:
        """Return the error bounds of a column and, if `full`, its sensitivities, as values for the fields of `Column`.

        The fields are `bound`, `lengths` and `paper`.

        Args:
            table: table that contains the column.
            k: index of the column.
            keys: keys of its numbers at one position; None if the rows of the table are not positions.
        """
        column, single = table.columns[k], (False, table.name, k)
        if column.dimension is None or (keys is None and single not in self.found().bound):
            return {}
        if keys is not None and self.chosen.size and keys[0] not in self.digits.bound:  # a law of motion, as it is
            return {}
        fields = tuple(BOUND_HEADERS) if self.full else ("bound",)
        if keys is None:
            return {field: getattr(self.found(), field)[single] for field in fields}
        near = np.searchsorted(self.chosen, np.arange(len(self.relative))).clip(max=len(self.chosen) - 1)
        examined = {field: self._examined_values(field, keys)[near] for field in fields if self.chosen.size}
        if self.chosen.size < len(near):
            rough = bounds_by_margins(self.results, self.relative, self.sizes, table, column).reshape(len(near), -1)
            rough[self.chosen] = examined["bound"][self.chosen] if self.chosen.size else rough[self.chosen]
            examined["bound"] = rough
        return {field: values.ravel() for field, values in examined.items()}

    def _examined_values(self, field: str, keys: list[Hashable]) -> Real:
        """Return bounds or sensitivities, (examined positions, keys); nan for numbers that were not examined."""
        nothing = np.full(len(self.chosen), np.nan)
        return np.stack([getattr(self.digits, field).get(key, nothing) for key in keys], axis=1)

    def summary(self, rows: Sequence[tuple[str | float, ...]]) -> Table:
        """Return the summary table: largest bound, number of correct digits and sensitivities of each column."""
        words = (_("table"), _("column"))
        figures = (
            _("bound of the rounding error"),
            _("correct digits"),
            _("change in % if lengths are off by 0.1 %"),
            _("change in % if the drawing is off by 0.5 mm"),
        )
        columns = [Column(header, [row[k] for row in rows]) for k, header in enumerate(words)]
        for k, header in enumerate(figures, len(words)):
            columns.append(Column(header, [float(f"{row[k]:.2g}") for row in rows], NUMBER, digits=2))
        title = _("Correct digits: least accurate value of each column, relative to its largest value")
        return Table("digits", title, tuple(columns), notes=(_sensitivity_note(self.digits.mu),))

    def json(self) -> dict[str, Any] | None:
        """Return the section `digits` of result.json; None if no sensitivities were requested (`full`).

        Bounds and sensitivities have the same keys as the values to which they belong.
        """
        if not self.full:
            return None
        content = dict(computed_sections(self.there))
        section: dict[str, Any] = {"scale": self.digits.mu, "number": list(self.there.numbers)}
        for field in BOUND_HEADERS:
            values = {**getattr(self.digits, field), **getattr(self.found(), field)}
            section[field] = bounds_in_shape(content, {key[1:]: v for key, v in values.items()}) or {}
        return section


def select_positions(record: Record, chosen: Real, count: int) -> Record:
    """Return a copy of a record in which arrays over `count` positions are reduced to the chosen positions.

    Arrays of any other length are kept.
    """

    def of_chosen(path: str, leaf: Any) -> Any:
        return leaf[..., chosen] if isinstance(leaf, np.ndarray) and leaf.shape[-1:] == (count,) else leaf

    return map_record(of_chosen, record, skip=UNSELECTED_FIELDS)


def assess_accuracy(results: Results, full: bool = False, shown: Collection[str] = ()) -> AccuracyReport:
    """Assess the accuracy of all numbers of results that have a motion.

    Args:
        results: results with a motion.
        full: True to examine every number and its sensitivities. Otherwise only those positions are examined in detail
            at which a number may have fewer than six correct figures.
        shown: names of the tables that are printed; if any are given, numbers that occur only in result.json are not
            examined.
    """
    motion, count = results.motion, len(results.numbers)
    assert motion is not None
    with np.errstate(all="ignore"):
        mu = _sheet_scale(results) if full else float("nan")
        wide = PreciseLinkage(results) if full else choose_precision(results)
        searched = cache(lambda: judge_searched(results, search_reader(results, full and not shown), wide, mu))
        start = start_uncertainty(results, wide)
        share = relative_bound(results, start)
        examined = share > SIX_FIGURES
        if full:
            examined[:: -(-count // MOST_JUDGED)] = True
            examined[-1:] = True
        if np.any(examined):
            examined |= is_near_dead(motion) if motion.where is None else motion.where | is_near_dead(motion)
        chosen, examined_results, digits = np.flatnonzero(examined), results, Digits(mu=mu)
        if 0 < len(chosen) < count:
            examined_results = replace(
                select_positions(results, chosen, count), numbers=tuple(results.numbers[k] for k in chosen)
            )
        if len(chosen):
            away = start + 3 * ROUNDOFF * np.abs(motion.q[chosen])
            digits = judge_values(examined_results, partial(numbers_at_positions, shown=shown), mu=mu, blur=away)
    for key, bound in digits.bound.items():
        if is_angle(key):  # no direction is farther from another one than half a turn: that far tells nothing
            digits.bound[key] = np.where(bound >= np.pi, np.inf, bound)
    return AccuracyReport(results, share, largest_values(results), searched, chosen, examined_results, digits, full)


def _worst_columns(table: Table) -> Iterator[tuple[str, float, float, float, float]]:
    """Yield for each column its heading, its relative error bound, the number of correct digits, and two sensitivities.

    The sensitivities are the changes (%) of the values due to errors of the lengths and to errors of the drawing. In a
    table whose rows have different units, each row is treated as a column. Its values are then relative to the largest
    value with the same unit.
    """
    units = np.array(table.columns[-1].values) if table.columns[-1].header == "unit" else None
    for column in table.columns:
        if column.bound is None:
            continue
        parts = np.stack([column.array, *(getattr(column, field) for field in BOUND_HEADERS)])
        rows = [(slice(None), slice(None), column.header)]
        if units is not None:
            rows = [(slice(k, k + 1), units == unit, table.columns[0].values[k]) for k, unit in enumerate(units)]
        for rows_of_value, alike, name in rows:
            (peak,), (bound, share, paper) = (
                _largest_by_row(parts[:1, alike]),
                _largest_by_row(parts[1:, rows_of_value]),
            )
            if peak > 0 and bound < peak:  # else it is nothing but rounding
                true = np.floor(-np.log10(2 * max(bound / peak, ROUNDOFF)))
                yield translated(name), bound / peak, true, 100 * share / peak, 100 * paper / peak


def _largest_by_row(values: Real) -> Real:
    """Return the largest magnitude in each row of an array; nan for a row without finite numbers."""
    values = np.abs(values)
    sound = np.isfinite(values)
    return np.where(sound.any(axis=1), np.max(values, axis=1, where=sound, initial=0.0), np.nan)


def _accuracy_note(rows: Sequence[tuple[str, float, float, float, float]]) -> str:
    """Return a note on the accuracy of the least accurate columns of a table."""
    bound, share, paper = (max(rows, key=lambda row: 0.0 if np.isnan(row[k]) else row[k]) for k in (1, 3, 4))
    if not share[3] > 0:
        return _("Rounding error: at most {bound} of the largest value of a column.").format(
            bound=numeral(bound[1], ".1e")
        )
    return _(
        "Rounding error: at most {bound} of the largest value of a column. If lengths are off by 0.1 %, "
        "values change by up to {lengths} % ({by_lengths}); if the drawing is off by 0.5 mm, by up to "
        "{paper} % ({by_paper})."
    ).format(
        bound=numeral(bound[1], ".1e"),
        lengths=numeral(share[3], ".2g"),
        by_lengths=share[0],
        paper=numeral(paper[4], ".2g"),
        by_paper=paper[0],
    )


def _sensitivity_note(mu: float) -> str:
    return _(
        "Length errors: every length is off by 0.1 %. Drawing errors: every coordinate is off by {mm} mm "
        "on a drawing to the scale of {mu} m per mm, at which the mechanism fits on A4. Both changes are "
        "first-order estimates of the worst case."
    ).format(mm=PAPER_CHANGE, mu=numeral(mu, ".10g"))


def _sheet_scale(results: Results) -> float:
    """Return the scale (m per mm) at which the mechanism and the paths of all its points fit on a sheet."""
    motion, linkage = motion_at_positions(results, results.closely(TRAJECTORY_POSITIONS), 0), results.linkage
    corners = [complex(linkage.local(FRAME, h.point)) for h in linkage.hinges if FRAME in h.links]
    for name in linkage.moving:
        for point in linkage.links[name].points:
            path = motion.spot(point)
            path = path[np.isfinite(path)]
            if path.size:
                corners += [complex(most(path.real), most(path.imag)) for most in (np.min, np.max)]
    return sheet_scale(corners)[1]


def with_bound_columns(table: Table) -> Table:
    """Return the table with the error bounds and sensitivities of each column of numbers after it."""
    columns: list[Column] = []
    for k, column in enumerate(table.columns):
        columns.append(column)
        if column.bound is not None and (k > 1 or table.columns[0].header != "position"):
            for field, header in BOUND_HEADERS.items():
                columns.append(Column(header, getattr(column, field), column.dimension, digits=2, unit=column.unit))
    return replace(table, columns=tuple(columns))
