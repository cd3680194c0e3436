"""Every number of the tables and of result.json, by a key that says what it is, and back to its place."""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable, Iterable, Iterator, Mapping
from typing import Any

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.quantities import ANGLE
from tmm_cli.results.as_json import LARGE, numbers
from tmm_cli.results.reports import REPORTS, tables_of
from tmm_cli.results.table import Table
from tmm_cli.vectors import Real

MOVING = ("motion", "reactions", "lever", "energy")  # parts of Results that are computed at positions
APART = ("synthesis", "checks", "drawn")  # a search has its own digits, checks count by their words, drawings by 0.5 mm
COMPUTED = tuple(name for name, part, __ in REPORTS if part in MOVING and name not in APART)
SEARCHED = {"quality", "pressure"}  # reports of what was searched for alone
Cells = Mapping[Hashable, Real]


def all_numbers(
    results: Results, reports: Collection[str] = COMPUTED, parts: Collection[str] | None = LARGE
) -> tuple[Cells, Cells]:
    """Those that have one value a position, and the others, which were searched for. Keys of angles begin with True.

    parts: the large ones of result.json that are wanted; None: tables alone.
    """
    count, turns = len(results.numbers), results.linkage.driver.kind == "turn"
    at_positions: dict[Hashable, Real] = {}
    searched: dict[Hashable, Real] = {}
    for table in computed_tables(results, reports):
        keys = keys_of(table, count)
        for k, column in enumerate(table.columns):
            if column.dimension is not None and keys is None:
                searched[False, table.name, k] = column.array
            elif column.dimension is not None and keys is not None:
                at_positions.update(zip(keys[k], column.array.reshape(count, -1).T, strict=True))
    for path, value in () if parts is None else _leaves(dict(numbers(results, parts)), ()):
        if isinstance(value, float):
            searched[(False, *path)] = np.array([value])
        elif getattr(value, "shape", None) == (count,) and value.dtype.kind == "f":
            angle = path[-1] in ("angle", "angles") or (turns and path == ("positions", "driver"))
            at_positions[(angle, *path)] = value
    return at_positions, searched


def cells(results: Results, shown: Collection[str] = ()) -> Cells:
    """The numbers at positions; shown: in reports with these tables alone."""
    reports = {name for name, __, given in REPORTS if not shown or set(given) & set(shown)}
    return all_numbers(results, reports & set(COMPUTED) - SEARCHED, None if shown else LARGE)[0]


def reader(results: Results, whole: bool = True) -> Callable[[Results], Cells]:
    """What reads the numbers of searches out of results like these; whole: those of result.json too."""
    energy = () if results.friction is None else ("energy",)
    return lambda other: all_numbers(other, ("quality", "pressure", *energy), energy if whole else None)[1]


def computed_tables(results: Results, reports: Collection[str] = COMPUTED) -> Iterator[Table]:
    """Tables with computed numbers, of these reports; of chosen points and links there is their motion alone."""
    return tables_of(results, set(reports) & {"kinematics"} if results.of else reports)


def keys_of(table: Table, count: int) -> list[list[Hashable]] | None:
    """For each column the keys of its rows at one position; None when the rows are no positions."""
    if not count or not table.columns or table.columns[0].header != "position" or table.rows % count:
        return None
    rows = range(table.rows // count)
    return [[(c.dimension == ANGLE, table.name, k, row) for row in rows] for k, c in enumerate(table.columns)]


def _leaves(value: Any, path: tuple[str, ...]) -> list[tuple[tuple[str, ...], Any]]:
    """Numbers and arrays of nested content with their paths; items of lists are known by their number."""
    found: list[tuple[tuple[str, ...], Any]] = []
    for name, part in _parts(value):
        if isinstance(part, dict | list):
            found += _leaves(part, (*path, name))
        else:
            found.append(((*path, name), float(part) if isinstance(part, float | np.floating) else part))
    return found


def _parts(value: Any) -> Iterable[tuple[str, Any]]:
    return value.items() if isinstance(value, dict) else ((str(k), part) for k, part in enumerate(value))


def parallel(value: Any, values: Mapping[Any, Real], path: tuple[str, ...] = ()) -> Any:
    """The digits of nested content in its shape; what has none is left out, but for items of lists."""
    if isinstance(value, dict):
        inner = {name: parallel(part, values, (*path, name)) for name, part in value.items()}
        return {name: part for name, part in inner.items() if part is not None} or None
    if isinstance(value, list):
        items = [parallel(part, values, (*path, name)) for name, part in _parts(value)]
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
