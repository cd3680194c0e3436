"""Tables as CSV and records as JSON, a chunk of text at a time: a long cycle never stands in memory as text.

Numbers are formatted many at once, and one that stands several times in succession (the driver's place before every
point, the angle of a slider) once only.
"""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Iterator
from typing import Any

import numpy as np

from tmm_cli.problem.dimensions import NUMBER
from tmm_cli.problem.units import UnitSystem
from tmm_cli.results.table import Column, Table, true_digits
from tmm_cli.results.terminal import heading
from tmm_cli.vectors import Real

FORMULA = ("=", "+", "-", "@", "\t", "\r")
PLAIN = re.compile(r"-?\d+(\.\d*)?(e[+-]?\d+)?")  # a number that stands among words
ROWS, NUMBERS = 2048, 8192  # of a table, of an array in a chunk: they stay in the cache
FIGURES = ["%.0s0", *(f"%.{n}g" for n in range(1, 18)), ""]  # by how many are true; the last one: not known
REPEATED = 0.5  # of an array: with more repetitions than that it is worth to format each number once


def csv_text(table: Table, units: UnitSystem) -> Iterator[str]:
    """A table as CSV in the units of the file; a cell that a spreadsheet would run as a formula is quoted."""
    yield ",".join(_cell(heading(c, units)) for c in table.columns) + "\n"
    told: dict[str, str] = {}
    columns = [_values(column, units) for column in table.columns]
    figures = [_figures(column, units, values) for column, values in zip(table.columns, columns, strict=True)]
    for start in range(0, table.rows, ROWS):
        here = slice(start, start + ROWS)
        part = [
            _texts(values[here], told, None if true is None else true[here])
            for values, true in zip(columns, figures, strict=True)
        ]
        line = ",".join(form for form, _ in part) + "\n"
        cells = [cell for row in zip(*(texts for _, texts in part), strict=True) for cell in row]
        yield line * (len(cells) // len(part)) % tuple(cells)


def _values(column: Column, units: UnitSystem) -> Any:
    """Words as they are, numbers as an array in the units of the file."""
    if column.dimension is None:
        return column.values
    given = column.values
    values = np.array([np.nan if v is None else v for v in given] if isinstance(given, list) else given, dtype=float)
    return values if column.dimension == NUMBER else units.unit(column.dimension).from_si(values)


def _figures(column: Column, units: UnitSystem, values: Any) -> Any:
    """How many figures of each number are true; None where it was not judged, -1 where it is not known."""
    if column.bound is None:
        return None
    factor = 1.0 if column.dimension in (None, NUMBER) else units.unit(column.dimension).from_si(1.0)
    known = np.isfinite(values) & np.isfinite(column.bound)
    true = true_digits(np.where(known, values, 0.0), np.where(known, column.bound, 0.0) * factor)
    return np.where(known, true, -1)


def _texts(values: Any, told: dict[str, str], true: Any = None) -> tuple[str, list[Any]]:
    """How the cells of a column are put into a line, and what is put there. told: words met before as cells.

    true: how many figures of each number are.
    """
    if not isinstance(values, np.ndarray):
        for word in set(values):
            if word not in told:
                told[word] = _cell(word)
        return "%s", [told[word] for word in values]
    if true is not None:
        formats = [FIGURES[n] for n in true.tolist()]
        return "%s", [form % v if form else "" for form, v in zip(formats, values.tolist(), strict=True)]
    if not np.all(np.isfinite(values)):
        return "%s", [f"{v:.15g}" if math.isfinite(v) else "" for v in values.tolist()]
    once, again = _runs(values)
    if again is None:
        return "%.15g", values.tolist()
    texts = [f"{v:.15g}" for v in once.tolist()]
    return "%s", [texts[k] for k in again.tolist()]


def _runs(values: Real) -> tuple[Real, Real | None]:
    """Each run of equal numbers once, and which of them stands at every place; None where it would save little."""
    bits = values.view(np.int64)  # -0.0 is not 0.0
    new = np.ones(len(values), dtype=bool)
    new[1:] = bits[1:] != bits[:-1]
    if np.count_nonzero(new) > (1 - REPEATED) * len(values):
        return values, None
    return values[new], np.cumsum(new) - 1


def _cell(text: str) -> str:
    safe = "'" + text if text.startswith(FORMULA) and not PLAIN.fullmatch(text) else text
    return '"' + safe.replace('"', '""') + '"' if any(c in safe for c in ',"\r\n') else safe


def json_bytes(content: Any) -> bytes:
    """JSON with a line for every series of numbers, so that two results can be compared line by line."""
    return ("".join(_lines(content, "")) + "\n").encode()


def json_text(parts: Iterable[tuple[str, Any]]) -> Iterator[str]:
    """The same of a record that is given part by part; arrays become text as they are, nan and infinity null."""
    opening = "{\n "
    for key, part in parts:
        yield f"{opening}{json.dumps(key, ensure_ascii=False)}: "
        yield from _lines(part, " ")
        opening = ",\n "
    yield "\n}\n"


def _lines(value: Any, indent: str) -> Iterator[str]:
    if isinstance(value, np.ndarray) and value.ndim == 1:
        yield from _series(value)
    elif isinstance(value, dict) and value:
        yield "{\n"
        for k, (key, part) in enumerate(value.items()):
            yield f"{indent} {json.dumps(key, ensure_ascii=False)}: "
            yield from _lines(part, indent + " ")
            yield ",\n" if k < len(value) - 1 else "\n"
        yield indent + "}"
    elif isinstance(value, list | tuple) and any(isinstance(part, dict | list | tuple | np.ndarray) for part in value):
        yield "[\n"
        for k, part in enumerate(value):
            yield indent + " "
            yield from _lines(part, indent + " ")
            yield ",\n" if k < len(value) - 1 else "\n"
        yield indent + "]"
    else:
        yield json.dumps(plain(value), ensure_ascii=False, allow_nan=False)


def _series(values: Any) -> Iterator[str]:
    """An array on one line."""
    yield "["
    for start in range(0, len(values), NUMBERS):
        if start:
            yield ", "
        part = np.ascontiguousarray(values[start : start + NUMBERS])
        once, again = _runs(part) if part.dtype == float and bool(np.all(np.isfinite(part))) else (part, None)
        if again is None:
            yield json.dumps(plain(part), allow_nan=False)[1:-1]
        else:
            texts = [repr(v) for v in once.tolist()]
            yield ", ".join([texts[k] for k in again.tolist()])
    yield "]"


def plain(value: Any) -> Any:
    """Numbers and arrays as JSON has them: no nan, no infinity."""
    if isinstance(value, np.ndarray):
        sound = value.dtype.kind != "f" or bool(np.all(np.isfinite(value)))
        return value.tolist() if sound else [plain(v) for v in value.tolist()]
    if isinstance(value, np.generic):
        return plain(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, dict):
        return {key: plain(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [plain(v) for v in value]
    return value
