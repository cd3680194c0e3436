"""A table before it is shown anywhere: columns of SI values with their dimension, or of words."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from tmm_cli.language import Phrase, _, numeral, spelt, translated, typeset, word_of_files
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import array
from tmm_cli.mechanics.quantities import LENGTH, NUMBER, Dimension
from tmm_cli.problem import Problem, Unit, UnitSystem, parse_unit


@dataclass(frozen=True)
class Column:
    """A column: header, values in SI (None or nan where there is none) and what they measure; words have none.

    header: best a phrase, by which the column is known in every language; it is translated when it is shown.
    bound: how far each value may be from the truth by rounding; lengths, paper: its change when every length changes by
    0.1 %, by 0.5 mm on paper (SI; None where they were not asked for). unit: its own, where it is not the file's.
    """

    header: str
    values: Any  # a list or an array, one entry a row
    dimension: Dimension | None = None
    digits: int = 6  # shown on a terminal; files have all that are true
    bound: Any = None
    lengths: Any = None
    paper: Any = None
    unit: str = ""

    def heading(self, units: UnitSystem) -> str:
        """The header with the unit."""
        if self.dimension is None or self.dimension == NUMBER:
            return translated(self.header)
        return f"{translated(self.header)}, {spelt(self.unit) if self.unit else units.spelt(self.dimension)}"

    def shown_in(self, units: UnitSystem) -> Unit:
        """The unit of its numbers on paper."""
        assert self.dimension is not None
        return parse_unit(self.unit) if self.unit else units.unit(self.dimension)

    @property
    def array(self) -> Any:
        """Its values, nan where there is none."""
        listed = isinstance(self.values, list)
        return array([np.nan if v is None else v for v in self.values] if listed else self.values)

    def numbers(self, units: UnitSystem) -> Any:
        """Its values in the units of the file, nan where there is none."""
        return self.shown_in(units).from_si(self.array.astype(float))

    def true_figures(self, units: UnitSystem) -> Any:
        """How many figures of each number are true, -1 where that is not known; None where it was not judged."""
        if self.dimension is None or self.bound is None:
            return None
        numbers, bound = self.numbers(units), np.asarray(self.bound) * self.shown_in(units).from_si(1.0)
        known = np.isfinite(numbers) & np.isfinite(bound)
        return np.where(known, true_digits(np.where(known, numbers, 0.0), np.where(known, bound, 0.0)), -1)


def with_unit(units: UnitSystem, value: float, dimension: Dimension, digits: int = 6) -> str:
    """A value (SI) in the unit of the file, to so many digits: `110 mm`."""
    number = numeral(units.from_si(value, dimension) + 0.0, f".{digits}g")
    return typeset(f"{number} {units.spelt(dimension)}".rstrip())


def format_value(problem: Problem, value: float, dimension: Dimension) -> str:
    """A value with its unit, of the file where it has one for this dimension."""
    return with_unit(problem.units, float(np.ravel(value)[0]), dimension)


def format_vector(problem: Problem, value: complex, dimension: Dimension = LENGTH) -> str:
    """Both components in the unit of the file: `[120, 0]`."""
    value = complex(np.ravel(value)[0])
    return f"[{', '.join(f'{problem.units.from_si(v, dimension) + 0.0:.6g}' for v in (value.real, value.imag))}]"


def link_name(link: str) -> str:
    """The frame has no number."""
    return _("frame") if link == FRAME else link


def true_digits(values: Any, bound: Any) -> Any:
    """How many figures of each value are true: half a unit of the last one is not below the bound; 0: none is."""
    values, bound = np.abs(values), np.maximum(bound, 2.0**-54 * np.abs(values))
    with np.errstate(divide="ignore", invalid="ignore"):
        figures = np.floor(np.log10(values)) - np.ceil(np.log10(2 * bound)) + 1
        return np.where(bound < values, np.clip(figures, 1, 17), 0).astype(int)


@dataclass(frozen=True)
class Table:
    """A table. name: of its file, without ending; long tables are for files only, not for the terminal."""

    name: str
    title: str
    columns: tuple[Column, ...]
    long: bool = False
    notes: tuple[str, ...] = ()

    @property
    def rows(self) -> int:
        return len(self.columns[0].values) if self.columns else 0


def text_table(
    name: str, title: str, headers: Sequence[str], rows: Iterable[Sequence[str]], notes: Iterable[str] = ()
) -> Table:
    """A table without numbers, row by row."""
    rows = list(rows)
    columns = (Column(header, [row[k] for row in rows]) for k, header in enumerate(headers))
    return Table(name, title, tuple(columns), notes=tuple(notes))


# Tables as CSV and records as JSON, a chunk of text at a time: a long cycle never stands in memory as text.


FORMULA_STARTS = ("=", "+", "-", "@", "\t", "\r")
SEPARATORS = re.compile(r"([,;|\t\r\n])")  # of cells, somewhere: in most of Europe it is the semicolon
RESERVED_WORDS = {
    "nan",
    "inf",
    "infinity",
    "null",
    "none",
    "na",
    "n/a",
}  # that programs read as a number, or as nothing
PLAIN_NUMBER = re.compile(r"-?\d+(\.\d*)?(e[+-]?\d+)?")  # a number that stands among words
CHUNK_ROWS, CHUNK_NUMBERS = 2048, 8192  # of a table, of an array in a chunk: they stay in the cache
FULL_PRECISION = "%.15g"  # of a number that was not judged
FIGURE_FORMATS = ["%.0s0", *(f"%.{n}g" for n in range(1, 18))]  # by how many are true; a zero where none is


def csv_text(table: Table, units: UnitSystem) -> Iterator[str]:
    """A table as CSV in the units of the file; a cell that a spreadsheet would run as a formula is quoted."""
    yield ",".join(csv_cell(column.heading(units)) for column in table.columns) + "\n"
    columns = [_numbers_or_words(column, units) for column in table.columns]
    for start in range(0, table.rows, CHUNK_ROWS):
        here = slice(start, start + CHUNK_ROWS)
        cells = [_cells(values[here], figures if figures is None else figures[here]) for values, figures in columns]
        yield "".join([",".join(row) + "\n" for row in zip(*cells, strict=True)])


def _numbers_or_words(column: Column, units: UnitSystem) -> tuple[Any, Any]:
    """Numbers in the units of the file and how many figures of each are true, or words."""
    if column.dimension is None:
        return column.values, None
    return column.numbers(units), column.true_figures(units)


def _cells(values: Any, figures: Any) -> list[str]:
    if not isinstance(values, np.ndarray):
        return [csv_cell(translated(word)) for word in values]
    if figures is None:
        return [FULL_PRECISION % v if v - v == 0 else "" for v in values.tolist()]  # nan and infinity have no cell
    return [FIGURE_FORMATS[n] % v if n >= 0 else "" for v, n in zip(values.tolist(), figures.tolist(), strict=True)]


@lru_cache(maxsize=1024)
def csv_cell(text: str) -> str:
    """A word as a cell of CSV; what a spreadsheet would run as a formula is quoted."""
    pieces = SEPARATORS.split(text)
    safe = "".join("'" + piece if _is_formula(piece) else piece for piece in pieces)
    safe = "'" + safe if text.startswith(("\t", "\r")) else safe
    quoted = len(pieces) > 1 or '"' in safe or safe.lower() in RESERVED_WORDS
    return '"' + safe.replace('"', '""') + '"' if quoted else safe


def _is_formula(piece: str) -> bool:
    """Whether a spreadsheet would run this piece of a cell as a formula."""
    begun = piece.lstrip(" ")
    return (
        begun.startswith(FORMULA_STARTS)
        and not SEPARATORS.fullmatch(piece)
        and not PLAIN_NUMBER.fullmatch(begun.rstrip(" "))
    )


def json_bytes(content: Any) -> bytes:
    """JSON with a line for every series of numbers, so that two results can be compared line by line."""
    return ("".join(_json_lines(content, "")) + "\n").encode()


def json_text(parts: Iterable[tuple[str, Any]]) -> Iterator[str]:
    """The same of a record that is given part by part; arrays become text as they are, nan and infinity null."""
    yield from _json_block("{", ((_json_key(key), part) for key, part in parts), "}", "")
    yield "\n"


def _json_lines(value: Any, indent: str) -> Iterator[str]:
    if isinstance(value, np.ndarray) and value.ndim == 1:
        yield from _json_array(value)
    elif isinstance(value, dict) and value:
        yield from _json_block("{", ((_json_key(key), part) for key, part in value.items()), "}", indent)
    elif isinstance(value, list | tuple) and any(isinstance(part, dict | list | tuple | np.ndarray) for part in value):
        yield from _json_block("[", (("", part) for part in value), "]", indent)
    else:
        yield json.dumps(json_value(value), ensure_ascii=False, allow_nan=False)


def _json_key(key: str) -> str:
    return f"{json.dumps(key, ensure_ascii=False)}: "


def _json_block(opening: str, parts: Iterable[tuple[str, Any]], closing: str, indent: str) -> Iterator[str]:
    """Parts of an object or of a list, each on its own lines after its label."""
    separator = opening
    for label, part in parts:
        yield f"{separator}\n{indent} {label}"
        yield from _json_lines(part, indent + " ")
        separator = ","
    yield f"\n{indent}{closing}"


def _json_array(values: Any) -> Iterator[str]:
    """An array on one line."""
    yield "["
    for start in range(0, len(values), CHUNK_NUMBERS):
        yield ", " if start else ""
        yield json.dumps(json_value(values[start : start + CHUNK_NUMBERS]), allow_nan=False)[1:-1]
    yield "]"


def json_value(value: Any) -> Any:
    """Numbers and arrays as JSON has them: no nan, no infinity."""
    if isinstance(value, np.ndarray):
        sound = value.dtype.kind != "f" or bool(np.all(np.isfinite(value)))
        return value.tolist() if sound else [json_value(v) for v in value.tolist()]
    if isinstance(value, np.generic):
        return json_value(value.item())
    if isinstance(value, float) and not math.isfinite(value):
        return None
    if isinstance(value, dict):
        return {key: json_value(v) for key, v in value.items()}
    if isinstance(value, list | tuple):
        return [json_value(v) for v in value]
    return word_of_files(value) if isinstance(value, Phrase) else value
