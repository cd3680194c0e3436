"""Accuracy of the numbers in tables and in result.json: bounds of the rounding error and sensitivity to the input data.

Each number has a key: (True for an angle, table or section, ...). The keys relate numbers of results that were computed
with other lengths or with higher precision.
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
    """Return the numbers with one value per position, and the others, which are found by a search, by their keys.

    Args:
        results: results with a motion.
        reports: reports whose tables are read.
        parts: large sections of result.json that are read; None: tables alone.

    Returns:
        Two mappings of arrays. The first item of a key is True for an angle.
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
    """Return the numbers with one value per position by their keys; `shown`: only those of the reports with these
    tables.
    """
    reports = {r.name for r in REPORTS if not shown or set(r.tables) & set(shown)}
    return collect_numbers(results, reports & set(ASSESSED) - SEARCHED_REPORTS, None if shown else LARGE_SECTIONS)[0]


def search_reader(results: Results, whole: bool = True) -> Callable[[Results], Cells]:
    """Return a function that collects the searched numbers of results; `whole`: those of result.json as well."""
    energy = () if results.friction is None else ("energy",)
    return lambda other: collect_numbers(other, ("quality", "pressure", *energy), energy if whole else None)[1]


def computed_tables(results: Results, reports: Collection[str] = ASSESSED) -> Iterator[Table]:
    """Yield the tables of the given reports; if only some points and links are requested, those of their motion."""
    return tables_of(results, set(reports) & {"kinematics"} if results.of else reports)


def row_keys(table: Table, count: int) -> list[list[Hashable]] | None:
    """Return for each column the keys of its rows at one position; None if the rows are not positions."""
    if not count or not table.columns or table.columns[0].header != "position" or table.rows % count:
        return None
    rows = range(table.rows // count)
    return [[(c.dimension == ANGLE, table.name, k, row) for row in rows] for k, c in enumerate(table.columns)]


def _leaves(value: Any, path: tuple[str, ...]) -> list[tuple[tuple[str, ...], Any]]:
    """Return the numbers and arrays of nested content with their paths; an item of a list is named by its index."""
    found: list[tuple[tuple[str, ...], Any]] = []
    for name, part in _named_parts(value):
        if isinstance(part, dict | list):
            found += _leaves(part, (*path, name))
        else:
            found.append(((*path, name), float(part) if isinstance(part, float | np.floating) else part))
    return found


def _named_parts(value: Any) -> Iterable[tuple[str, Any]]:
    return value.items() if isinstance(value, dict) else ((str(k), part) for k, part in enumerate(value))


def bounds_in_shape(value: Any, values: Mapping[Any, Real], path: tuple[str, ...] = ()) -> Any:
    """Return bounds in the nested shape of the content they belong to; a key without bounds is omitted, a list item is
    {}.
    """
    if isinstance(value, dict):
        inner = {name: bounds_in_shape(part, values, (*path, name)) for name, part in value.items()}
        return {name: part for name, part in inner.items() if part is not None} or None
    if isinstance(value, list):
        items = [bounds_in_shape(part, values, (*path, name)) for name, part in _named_parts(value)]
        return None if all(item is None for item in items) else [{} if item is None else item for item in items]
    found = values.get(path)
    if found is None:
        return None
    short = _round_up(found)
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
    """Return error bounds of a column whose rows are positions, from the bounds of the group margins.

    Args:
        results: results of the table.
        relative: bound at each position as a fraction of the largest value of a dimension, (positions,).
        sizes: largest value by dimension.
        table: the table.
        column: the column of the table.
    """
    values = np.abs(column.array)
    own = float(np.max(values, where=np.isfinite(values), initial=0.0))
    assert column.dimension is not None
    size = sizes.get(column.dimension, own)
    if column.dimension == NUMBER and table.name in ("energy", "cycle"):
        power = sizes.get(FORCE, 0.0) * sizes[SPEED]
        size = _percent_scale(results, table.name, power, sizes) if column.header.endswith("%") else max(power, own)
        if column.header in SLOPES and results.energy is not None:  # which has nothing of speeds in it
            size = 2 * sizes[NUMBER] * sizes[INERTIA]
    bound = np.repeat(relative, table.rows // len(relative)) * size
    over = RATIOS.get((table.name, column.header))
    if over is not None:
        force = np.abs(next(other.array for other in table.columns if other.header == over))
        share = np.repeat(relative, table.rows // len(relative))
        known = force > share * sizes[FORCE]
        if column.dimension == LENGTH:  # both what stands over the force and the force are known to the share
            bound = bound + share * values
        return np.where(known, bound * (sizes[FORCE] / np.where(known, force, 1.0)), np.inf)
    return np.asarray(np.minimum(bound, HUGE))


def _percent_scale(results: Results, table: str, power: float, sizes: Mapping[Dimension, float]) -> float:
    """Return the scale (%) of all forces relative to the reference of a column in per cent."""
    assert results.reactions is not None
    if table == "energy" and results.energy is not None:
        of, size = [results.energy.drivers, results.energy.rate], power
    else:
        of, size = [balance.generalized for balance in results.reactions.balances], sizes[MOMENT]
    largest = max(float(np.max(np.abs(part), where=np.isfinite(part), initial=0.0)) for part in of)
    return 100 * size / largest if largest > 0 else HUGE


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
    "lengths": N_("± change of lengths"),
    "paper": N_("± change on paper"),
}


@dataclass(frozen=True)
class AccuracyReport:
    """Accuracy of the numbers of results, both at positions and found by search.

    Attributes:
        results: the results.
        relative: error bounds as fractions of the largest value of a dimension, (positions,).
        sizes: largest value by dimension.
        found: function that returns the digits of searched numbers; it is called when a table needs them.
        chosen: indices of the positions that were examined.
        there: results at these positions.
        digits: digits of their numbers, by key.
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
        """Yield the tables with their error bounds; if `full`, finally the summary of the least accurate columns."""
        worst: list[tuple[str | float, ...]] = []
        for table in map(self.table, tables):
            rows = list(_worst_columns(table)) if self.full else []
            worst += [(table.name, *row) for row in rows]
            yield replace(table, notes=(*table.notes, _accuracy_note(rows))) if rows else table
        if self.full:
            yield self.summary(worst)

    def table(self, table: Table) -> Table:
        """Return the table with the error bounds and sensitivities of its numbers."""
        keys = row_keys(table, len(self.relative))
        columns = [
            replace(column, **self._parts(table, k, None if keys is None else keys[k]))
            for k, column in enumerate(table.columns)
        ]
        return replace(table, columns=tuple(columns))

    def _parts(self, table: Table, k: int, keys: list[Hashable] | None) -> dict[str, Any]:
        """Return the bounds of column k and, if `full`, its sensitivities.

        keys: keys of the rows at one position; None if rows are not positions.
        """
        column, single = table.columns[k], (False, table.name, k)
        if column.dimension is None or (keys is None and single not in self.found().bound):
            return {}
        if keys is not None and self.chosen.size and keys[0] not in self.digits.bound:  # a law of motion, as it is
            return {}
        wanted = tuple(BOUND_HEADERS) if self.full else ("bound",)
        if keys is None:
            return {part: getattr(self.found(), part)[single] for part in wanted}
        near = np.searchsorted(self.chosen, np.arange(len(self.relative))).clip(max=len(self.chosen) - 1)
        found = {part: self._judged(part, keys)[near] for part in wanted if self.chosen.size}
        if self.chosen.size < len(near):
            rough = bounds_by_margins(self.results, self.relative, self.sizes, table, column).reshape(len(near), -1)
            rough[self.chosen] = found["bound"][self.chosen] if self.chosen.size else rough[self.chosen]
            found["bound"] = rough
        return {part: values.ravel() for part, values in found.items()}

    def _judged(self, part: str, keys: list[Hashable]) -> Real:
        """Return the examined bounds or sensitivities, (chosen positions, rows); nan where there are none."""
        nothing = np.full(len(self.chosen), np.nan)
        return np.stack([getattr(self.digits, part).get(key, nothing) for key in keys], axis=1)

    def summary(self, rows: Sequence[tuple[str | float, ...]]) -> Table:
        """Return the table of the largest bound, the number of true digits and the sensitivities of each column."""
        words = (_("table"), _("column"))
        figures = (
            _("bound of the rounding error"),
            _("true digits"),
            _("change if lengths change by 0.1 %, %"),
            _("change if the drawing is 0.5 mm off, %"),
        )
        columns = [Column(header, [row[k] for row in rows]) for k, header in enumerate(words)]
        for k, header in enumerate(figures, len(words)):
            columns.append(Column(header, [float(f"{row[k]:.2g}") for row in rows], NUMBER, digits=2))
        title = _("Reliable digits: the least accurate value of each column, relative to its largest value")
        return Table("digits", title, tuple(columns), notes=(_sensitivity_note(self.digits.mu),))

    def json(self) -> dict[str, Any] | None:
        """Return the section `digits` of result.json: bounds and sensitivities under the keys of their values; None
        unless `full`.
        """
        if not self.full:
            return None
        content = dict(computed_sections(self.there))
        named: dict[str, Any] = {"scale": self.digits.mu, "number": list(self.there.numbers)}
        for part in BOUND_HEADERS:
            values = {**getattr(self.digits, part), **getattr(self.found(), part)}
            named[part] = bounds_in_shape(content, {key[1:]: v for key, v in values.items()}) or {}
        return named


def select_positions(record: Record, chosen: Real, count: int) -> Record:
    """Return a record reduced to the chosen ones of `count` positions; the array of another length is kept."""

    def of_chosen(path: str, leaf: Any) -> Any:
        return leaf[..., chosen] if isinstance(leaf, np.ndarray) and leaf.shape[-1:] == (count,) else leaf

    return map_record(of_chosen, record, skip=UNSELECTED_FIELDS)


def assess_accuracy(results: Results, full: bool = False, shown: Collection[str] = ()) -> AccuracyReport:
    """Return the accuracy of all numbers of results that have a motion.

    Args:
        results: results with a motion.
        full: examine every number, with sensitivities; else only positions at which six figures are in doubt.
        shown: tables that are shown; if any, numbers that are in result.json only are not examined.
    """
    motion, count = results.motion, len(results.numbers)
    assert motion is not None
    with np.errstate(all="ignore"):
        mu = _sheet_scale(results) if full else float("nan")
        wide = PreciseLinkage(results) if full else choose_precision(results)
        found = cache(lambda: judge_searched(results, search_reader(results, full and not shown), wide, mu))
        start = start_uncertainty(results, wide)
        share = relative_bound(results, start)
        asked = share > SIX_FIGURES
        if full:
            asked[:: -(-count // MOST_JUDGED)] = True
            asked[-1:] = True
        if np.any(asked):
            asked |= is_near_dead(motion) if motion.where is None else motion.where | is_near_dead(motion)
        chosen, there, digits = np.flatnonzero(asked), results, Digits(mu=mu)
        if 0 < len(chosen) < count:
            there = replace(select_positions(results, chosen, count), numbers=tuple(results.numbers[k] for k in chosen))
        if len(chosen):
            away = start + 3 * ROUNDOFF * np.abs(motion.q[chosen])
            digits = judge_values(there, partial(numbers_at_positions, shown=shown), mu=mu, blur=away)
    for key, bound in digits.bound.items():
        if is_angle(key):  # no direction is farther from another one than half a turn: that far tells nothing
            digits.bound[key] = np.where(bound >= np.pi, np.inf, bound)
    return AccuracyReport(results, share, largest_values(results), found, chosen, there, digits, full)


def _worst_columns(table: Table) -> Iterator[tuple[str, float, float, float, float]]:
    """Yield for each column with bounds: header, bound / largest value, true digits, and both changes in %.

    In a table in which every row has its own unit, this is done row by row, relative to the largest value of that unit.
    """
    units = np.array(table.columns[-1].values) if table.columns[-1].header == "unit" else None
    for column in table.columns:
        if column.bound is None:
            continue
        parts = np.stack([column.array, *(getattr(column, part) for part in BOUND_HEADERS)])
        rows = [(slice(None), slice(None), column.header)]
        if units is not None:
            rows = [(slice(k, k + 1), units == unit, table.columns[0].values[k]) for k, unit in enumerate(units)]
        for own, alike, name in rows:
            (size,), (bound, share, paper) = _largest_by_row(parts[:1, alike]), _largest_by_row(parts[1:, own])
            if size > 0 and bound < size:  # else it is nothing but rounding
                true = np.floor(-np.log10(2 * max(bound / size, ROUNDOFF)))
                yield translated(name), bound / size, true, 100 * share / size, 100 * paper / size


def _largest_by_row(values: Real) -> Real:
    """Return the largest magnitude of each row; nan if it has no finite number."""
    values = np.abs(values)
    sound = np.isfinite(values)
    return np.where(sound.any(axis=1), np.max(values, axis=1, where=sound, initial=0.0), np.nan)


def _accuracy_note(rows: Sequence[tuple[str, float, float, float, float]]) -> str:
    """Return a note on the least accurate columns of a table."""
    bound, share, paper = (max(rows, key=lambda row: 0.0 if np.isnan(row[k]) else row[k]) for k in (1, 3, 4))
    if not share[3] > 0:
        return _("Rounding error: at most {bound} of the largest value of a column.").format(
            bound=numeral(bound[1], ".1e")
        )
    return _(
        "Rounding error: at most {bound} of the largest value of a column. If lengths change by 0.1 %: up "
        "to {lengths} % ({by_lengths}); if the drawing is 0.5 mm off: up to {paper} % ({by_paper})."
    ).format(
        bound=numeral(bound[1], ".1e"),
        lengths=numeral(share[3], ".2g"),
        by_lengths=share[0],
        paper=numeral(paper[4], ".2g"),
        by_paper=paper[0],
    )


def _sensitivity_note(mu: float) -> str:
    return _(
        "± change of lengths: if every length is 0.1 % off; ± change on paper: if every coordinate is {mm} "
        "mm off on paper at a scale of {mu} m per mm, at which the mechanism fits on A4. First-order "
        "estimates of the worst case."
    ).format(mm=PAPER_CHANGE, mu=numeral(mu, ".10g"))


def _sheet_scale(results: Results) -> float:
    """Return the scale (m per mm) at which the mechanism fits on a sheet with the paths of all its points."""
    motion, linkage = motion_at_positions(results, results.closely(TRAJECTORY_POSITIONS), 0), results.linkage
    places = [complex(linkage.local(FRAME, h.point)) for h in linkage.hinges if FRAME in h.links]
    for name in linkage.moving:
        for point in linkage.links[name].points:
            way = motion.spot(point)
            way = way[np.isfinite(way)]
            if way.size:
                places += [complex(most(way.real), most(way.imag)) for most in (np.min, np.max)]
    return sheet_scale(places)[1]


def with_bound_columns(table: Table) -> Table:
    """Return the table with columns for the bound and the sensitivities after each column of numbers."""
    columns: list[Column] = []
    for k, column in enumerate(table.columns):
        columns.append(column)
        if column.bound is not None and (k > 1 or table.columns[0].header != "position"):
            for part, header in BOUND_HEADERS.items():
                columns.append(Column(header, getattr(column, part), column.dimension, digits=2, unit=column.unit))
    return replace(table, columns=tuple(columns))
