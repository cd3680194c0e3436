"""Bounds by rounding and sensitivity to the data for every number of the tables and of result.json.

Tables and result.json are made by their own functions from the results in longdouble and from those with changed
lengths too, and compared number by number; so no quantity can be forgotten, and none needs a formula of its own.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from importlib import import_module
from typing import Any

import numpy as np

from tmm_cli.accuracy.digits import PAPER, Digits, U, judged
from tmm_cli.accuracy.searches import Searched, searched
from tmm_cli.extended import near_dead
from tmm_cli.linkage import FRAME
from tmm_cli.pipeline import Results, at_positions, given
from tmm_cli.plans.record import sheet_scale
from tmm_cli.problem.dimensions import ANGLE, NUMBER
from tmm_cli.results.as_json import numbers
from tmm_cli.results.reports import REPORTS
from tmm_cli.results.table import Column, Table
from tmm_cli.splice import taken
from tmm_cli.vectors import Real
from tmm_cli.words import say

COMPUTED = ("motion", "reactions", "lever", "energy")  # parts whose tables hold computed numbers
COMPUTED_REPORTS = tuple(name for name, part, _ in REPORTS if part in COMPUTED)
DENSE = 361  # places of a trajectory
LONG = 720  # positions: of a longer cycle only so many are judged, and all that are near dead ones
BETWEEN = 4.0  # times the largest bound of the judged positions about: what holds for those between them
PARTS = ("bound", "lengths", "paper")


@dataclass(frozen=True)
class Trusted:
    """Digits of results: of numbers at positions by key, and of those that were searched for.

    results: at the positions that were judged; chosen: which of all positions these are. In a long cycle they are some
    hundreds, with all that are near dead ones; between them a bound is four times the largest near it.
    """

    results: Results
    chosen: Real
    count: int
    digits: Digits
    found: Searched

    def table(self, table: Table) -> Table:
        """The same table, its numbers with their bounds and sensitivities, and a note of the worst of them."""
        keys = _keys(table, self.count)
        columns = []
        for k, column in enumerate(table.columns):
            if column.dimension is not None and keys is not None:
                parts: dict[str, Any] = {part: self._of(part, keys[k]) for part in PARTS}
                columns.append(replace(column, **parts))
            elif column.dimension is not None and (False, table.name, column.header) in self.found.bound:
                key = (False, table.name, column.header)
                parts = {part: getattr(self.found, part)[key] for part in PARTS}
                columns.append(replace(column, **parts))
            else:
                columns.append(column)
        judged_table = replace(table, columns=tuple(columns))
        note = _note(judged_table, self.digits.mu)
        return replace(judged_table, notes=(*table.notes, note)) if note else judged_table

    def _of(self, part: str, keys: list[Hashable]) -> Real | None:
        values = getattr(self.digits, part)
        nothing = np.full(len(self.chosen), np.nan)
        found = np.empty(
            (self.count, len(keys)), dtype=float if self.count < LONG else np.float32
        )  # two figures tell all
        for k, key in enumerate(keys):
            found[:, k] = self._everywhere(part, values.get(key, nothing))
        return found.ravel()

    def _everywhere(self, part: str, values: Real) -> Real:
        """Values at all positions from those at the chosen ones."""
        if len(self.chosen) == self.count:
            return values
        about = values
        for by in (1, 2) if part == "bound" else (1,):
            about = np.fmax(about, np.fmax(np.roll(values, by), np.roll(values, -by)))
        near = np.searchsorted(self.chosen, np.arange(self.count)).clip(max=len(self.chosen) - 1)
        everywhere: Real = (BETWEEN if part == "bound" else 1.0) * about[near]
        everywhere[self.chosen] = values
        return everywhere

    def summary(self, rows: Sequence[tuple[str | float, ...]]) -> Table:
        """Table by table and column by column: the largest bound, digits to be trusted, sensitivities."""
        keys = ("digits.table", "digits.column", "digits.bound", "digits.true", "digits.lengths", "digits.paper")
        columns = tuple(
            Column(say(key), [row[k] for row in rows])
            if k < 2
            else Column(say(key), [float(f"{row[k]:.2g}") for row in rows], NUMBER, digits=2)
            for k, key in enumerate(keys)
        )  # fmt: skip
        return Table("digits", say("digits.title"), columns, notes=(_scale(self.digits.mu),))

    def json(self) -> dict[str, Any]:
        """The section `digits` of result.json: bounds and sensitivities in the places of their values."""
        content = dict(numbers(self.results))
        named: dict[str, Any] = {"scale": self.digits.mu, "number": list(self.results.numbers)}
        for part in PARTS:
            values = {**getattr(self.digits, part), **getattr(self.found, part)}
            named[part] = _parallel(content, (), {key[1:]: v for key, v in values.items()}) or {}
        return named


def judged_tables(tables: Iterable[Table], found: Trusted) -> Iterator[Table]:
    """Tables with the digits that were found for them, one after the other, and last the table of the worst."""
    worst: list[tuple[str | float, ...]] = []
    for table in tables:
        told = found.table(table)
        worst += [(table.name, *row) for row in _worst(told)]
        yield told
    yield found.summary(worst)


def trusted(results: Results) -> Trusted:
    """Judge all numbers of results that have a motion."""
    motion = results.motion
    assert motion is not None
    count = len(results.numbers)
    asked = near_dead(motion) if motion.where is None else motion.where | near_dead(motion)
    asked[:: -(-count // LONG)] = True
    asked[-1:] = True
    chosen = np.flatnonzero(asked)
    if len(chosen) < count:
        numbers = tuple(results.numbers[k] for k in chosen)
        pressure = taken(results.pressure, chosen, count)
        results = given(taken(results, chosen, count), numbers=numbers, pressure=pressure, travels=results.travels)
    assert results.motion is not None
    with np.errstate(all="ignore"):
        mu = _mu(results)
        found = searched(results, _reader(results), mu)
        blur = found.blur + 3 * U * np.abs(results.motion.q)
        digits = judged(results, cells, mu=mu, blur=blur, turning=_turning)
    for key, bound in digits.bound.items():
        if _turning(key):  # no direction is farther from another one than half a turn
            digits.bound[key] = np.minimum(bound, np.pi)
    return Trusted(results, chosen, count, digits, found)


def _turning(key: Hashable) -> bool:
    return isinstance(key, tuple) and bool(key[0])


def cells(results: Results) -> Mapping[Hashable, Real]:
    """Every number at every position, of tables and of result.json, by a key that says what it is."""
    count, found = len(results.numbers), {}
    for table in computed_tables(results):
        keys = _keys(table, count)
        if keys is not None:
            for column, names in zip(table.columns, keys, strict=True):
                if column.dimension is not None:
                    values = _array(column).reshape(count, -1)
                    found.update({name: values[:, k] for k, name in enumerate(names)})
    turns = results.linkage.driver.kind == "turn"
    for path, value in _leaves(dict(numbers(results)), ()):
        if isinstance(value, np.ndarray) and value.shape == (count,) and value.dtype.kind == "f":
            angle = path[-1] in ("angle", "angles") or (turns and path == ("positions", "driver"))
            found[(angle, *path)] = value
    return found


def _reader(results: Results) -> Callable[[Results], Mapping[Hashable, Real]]:
    """What reads the numbers of searches out of results like these; reports and parts that hold none are left out."""
    count = len(results.numbers)
    reports = [name for name in COMPUTED_REPORTS
               if any(_keys(table, count) is None for table in computed_tables(results, (name,)))]  # fmt: skip
    parts = {path[0] for path, value in _leaves(dict(numbers(results)), ()) if isinstance(value, float)}
    return partial(_single, reports=reports, parts=parts)


def _single(results: Results, reports: Collection[str], parts: Collection[str]) -> Mapping[Hashable, Real]:
    """Every number that belongs to no position: those of searches."""
    found: dict[Hashable, Real] = {}
    for table in computed_tables(results, reports):
        if _keys(table, len(results.numbers)) is None:
            for column in table.columns:
                if column.dimension is not None:
                    found[False, table.name, column.header] = _array(column)
    for path, value in _leaves(dict(numbers(results, parts)), ()):
        if isinstance(value, float):
            found[(False, *path)] = np.array([value])
    return found


def computed_tables(results: Results, reports: Collection[str] = COMPUTED_REPORTS) -> Iterator[Table]:
    """Tables with computed numbers, of these reports."""
    for name, part, _ in REPORTS:
        wanted = name == "kinematics" or not results.of  # else the rest is not there
        if name in reports and wanted and getattr(results, part) is not None:
            yield from import_module(f"tmm_cli.results.reports.{name}").tables(results)


def _array(column: Column) -> Real:
    values = column.values
    return np.array([np.nan if v is None else v for v in values]) if isinstance(values, list) else np.asarray(values)


def _keys(table: Table, count: int) -> list[list[Hashable]] | None:
    """For each column the keys of its rows at one position; None when the rows are no positions."""
    if not count or not table.columns or table.columns[0].header != say("word.position") or table.rows % count:
        return None
    per = table.rows // count
    words = [c.values[:per] for c in table.columns[1:] if c.dimension is None] if per > 1 else []
    rows, headers = Counter[Hashable](), Counter[str]()
    told = []
    for row in range(per):
        name = tuple(column[row] for column in words)
        told.append((*name, rows[name]))
        rows[name] += 1
    keys: list[list[Hashable]] = []
    for column in table.columns:
        which = (column.dimension == ANGLE, table.name, column.header, headers[column.header])
        headers[column.header] += 1
        keys.append([(*which, *name) for name in told])
    return keys


def _leaves(value: Any, path: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Numbers and arrays of nested content with their paths; items of lists are known by name and link."""
    for name, part in _parts(value):
        if isinstance(part, dict | list):
            yield from _leaves(part, (*path, name))
        else:
            yield (*path, name), float(part) if isinstance(part, float | np.floating) else part


def _parts(value: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict):
        yield from value.items()
        return
    seen = Counter[str]()
    for part in value:
        name = " ".join(str(part.get(key, "")) for key in ("name", "link", "group")) if isinstance(part, dict) else ""
        yield f"{name} {seen[name]}", part
        seen[name] += 1


def _parallel(value: Any, path: tuple[str, ...], values: Mapping[Any, Real]) -> Any:
    """The digits of nested content in its shape; what has none is left out, but for items of lists."""
    if isinstance(value, dict):
        inner = {name: _parallel(part, (*path, name), values) for name, part in value.items()}
        return {name: part for name, part in inner.items() if part is not None} or None
    if isinstance(value, list):
        items = [_parallel(part, (*path, name), values) for name, part in _parts(value)]
        return None if all(item is None for item in items) else [{} if item is None else item for item in items]
    found = values.get(path)
    if found is None:
        return None
    short = _short(found)
    return short[0] if isinstance(value, float | np.floating) else short


def _short(values: Real) -> list[float]:
    """Two figures are enough for a bound; the last one is rounded up."""
    with np.errstate(all="ignore"):
        unit = 10.0 ** (np.floor(np.log10(values)) - 1)
        short = np.where(values > 0, np.ceil(values / unit) * unit, values)
    return [float(f"{v:.2g}") for v in short.tolist()]


def _worst(table: Table) -> Iterator[tuple[str, float, float, float, float]]:
    """Of each column with digits: header, largest bound relative to its largest value, true digits, changes in %.

    Of a table in which every row has a unit of its own, the same of each row.
    """
    rows = table.columns[-1].header == say("word.unit")
    for column in table.columns:
        if column.bound is None:
            continue
        digits = [_array(column), *(getattr(column, part) for part in PARTS)]
        for k, name in enumerate(table.columns[0].values) if rows else [(slice(None), column.header)]:
            size, bound, share, paper = (_most(values[k]) for values in digits)
            if size > 0 and bound < size:  # else it is nothing but rounding
                true = np.floor(-np.log10(2 * max(bound / size, U)))
                yield name, bound / size, true, 100 * share / size, 100 * paper / size


def _most(values: Any) -> float:
    """The largest number; nan where there is none."""
    values = np.abs(np.atleast_1d(np.asarray(values, dtype=float)))
    values = values[np.isfinite(values)]
    return float(np.max(values)) if values.size else float("nan")


def _note(table: Table, mu: float) -> str:
    rows = list(_worst(table))
    if not rows:
        return ""
    bound, share, paper = (max(rows, key=lambda row: np.nan_to_num(row[k])) for k in (1, 3, 4))
    if not share[3] > 0:
        return say("digits.note_rounding", bound=f"{bound[1]:.1e}")
    return say(
        "digits.note", bound=f"{bound[1]:.1e}", lengths=f"{share[3]:.2g}", by_lengths=share[0], paper=f"{paper[4]:.2g}",
        by_paper=paper[0],
    )  # fmt: skip


def _scale(mu: float) -> str:
    return say("digits.scale", mm=PAPER, mu=f"{mu:.10g}")


def _mu(results: Results) -> float:
    """Scale (m a mm) at which the mechanism fits on a sheet with all its trajectories."""
    motion, linkage = at_positions(results, results.closely(DENSE)), results.linkage
    places = [complex(linkage.local(FRAME, h.point)) for h in linkage.hinges if FRAME in h.links]
    for name in linkage.moving:
        for point in linkage.links[name].points:
            places += [complex(x) for x in motion.named(point).x if np.isfinite(x)]
    return sheet_scale(places)[1]


def beside(table: Table) -> Table:
    """The table with bound and sensitivities of every number beside it."""
    columns: list[Column] = []
    for k, column in enumerate(table.columns):
        columns.append(column)
        if column.bound is not None and (k > 1 or table.columns[0].header != say("word.position")):
            for part in PARTS:
                columns.append(Column(say(f"digits.beside_{part}"), getattr(column, part), column.dimension, digits=2))
    return replace(table, columns=tuple(columns))
