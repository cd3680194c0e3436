"""Tables as CSV and records as JSON, a chunk of text at a time: a long cycle never stands in memory as text."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import Any

import numpy as np

from tmm_cli.problem.units import UnitSystem
from tmm_cli.results.table import Column, Table

FORMULA = ("=", "+", "-", "@", "\t", "\r")
SEPARATORS = re.compile(r"([,;|\t\r\n])")  # of cells, somewhere: in most of Europe it is the semicolon
NO_NUMBERS = {"nan", "inf", "infinity", "null", "none", "na", "n/a"}  # that programs read as a number, or as nothing
PLAIN = re.compile(r"-?\d+(\.\d*)?(e[+-]?\d+)?")  # a number that stands among words
ROWS, NUMBERS = 2048, 8192  # of a table, of an array in a chunk: they stay in the cache
FULL = "%.15g"  # of a number that was not judged
FIGURES = ["%.0s0", *(f"%.{n}g" for n in range(1, 18))]  # by how many are true; a zero where none is


def csv_text(table: Table, units: UnitSystem) -> Iterator[str]:
    """A table as CSV in the units of the file; a cell that a spreadsheet would run as a formula is quoted."""
    yield ",".join(csv_cell(column.heading(units)) for column in table.columns) + "\n"
    columns = [_numbers_or_words(column, units) for column in table.columns]
    for start in range(0, table.rows, ROWS):
        here = slice(start, start + ROWS)
        cells = [_cells(values[here], figures if figures is None else figures[here]) for values, figures in columns]
        yield "".join([",".join(row) + "\n" for row in zip(*cells, strict=True)])


def _numbers_or_words(column: Column, units: UnitSystem) -> tuple[Any, Any]:
    """Numbers in the units of the file and how many figures of each are true, or words."""
    if column.dimension is None:
        return column.values, None
    return column.numbers(units), column.true_figures(units)


def _cells(values: Any, figures: Any) -> list[str]:
    if not isinstance(values, np.ndarray):
        return [csv_cell(word) for word in values]
    if figures is None:
        return [FULL % v if v - v == 0 else "" for v in values.tolist()]  # nan and infinity have no cell
    return [FIGURES[n] % v if n >= 0 else "" for v, n in zip(values.tolist(), figures.tolist(), strict=True)]


@lru_cache(maxsize=1024)
def csv_cell(text: str) -> str:
    """A word as a cell of CSV; what a spreadsheet would run as a formula is quoted."""
    pieces = SEPARATORS.split(text)
    safe = "".join("'" + piece if _runs(piece) else piece for piece in pieces)
    safe = "'" + safe if text.startswith(("\t", "\r")) else safe
    quoted = len(pieces) > 1 or '"' in safe or safe.lower() in NO_NUMBERS
    return '"' + safe.replace('"', '""') + '"' if quoted else safe


def _runs(piece: str) -> bool:
    """Whether a spreadsheet would run this piece of a cell as a formula."""
    begun = piece.lstrip(" ")
    return begun.startswith(FORMULA) and not SEPARATORS.fullmatch(piece) and not PLAIN.fullmatch(begun.rstrip(" "))


def json_bytes(content: Any) -> bytes:
    """JSON with a line for every series of numbers, so that two results can be compared line by line."""
    return ("".join(_lines(content, "")) + "\n").encode()


def json_text(parts: Iterable[tuple[str, Any]]) -> Iterator[str]:
    """The same of a record that is given part by part; arrays become text as they are, nan and infinity null."""
    yield from _block("{", ((_label(key), part) for key, part in parts), "}", "")
    yield "\n"


def _lines(value: Any, indent: str) -> Iterator[str]:
    if isinstance(value, np.ndarray) and value.ndim == 1:
        yield from _series(value)
    elif isinstance(value, dict) and value:
        yield from _block("{", ((_label(key), part) for key, part in value.items()), "}", indent)
    elif isinstance(value, list | tuple) and any(isinstance(part, dict | list | tuple | np.ndarray) for part in value):
        yield from _block("[", (("", part) for part in value), "]", indent)
    else:
        yield json.dumps(plain(value), ensure_ascii=False, allow_nan=False)


def _label(key: str) -> str:
    return f"{json.dumps(key, ensure_ascii=False)}: "


def _block(opening: str, parts: Iterable[tuple[str, Any]], closing: str, indent: str) -> Iterator[str]:
    """Parts of an object or of a list, each on its own lines after its label."""
    separator = opening
    for label, part in parts:
        yield f"{separator}\n{indent} {label}"
        yield from _lines(part, indent + " ")
        separator = ","
    yield f"\n{indent}{closing}"


def _series(values: Any) -> Iterator[str]:
    """An array on one line."""
    yield "["
    for start in range(0, len(values), NUMBERS):
        yield ", " if start else ""
        yield json.dumps(plain(values[start : start + NUMBERS]), allow_nan=False)[1:-1]
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
