"""Tables as data: columns of SI values with a dimension, or of texts, and their output as CSV and JSON."""

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
    """A column of a table.

    Attributes:
        header: heading, preferably a Phrase, which identifies the column in every language and is translated on output.
        values: list or array with one entry per row, in SI units; None or nan where there is no value.
        dimension: dimension of the values; None for texts.
        digits: number of significant figures on a terminal.
        bound: bound of the rounding error of each value (SI); None if not assessed.
        lengths: change of each value when all lengths change by 0.1 % (SI); None if not requested.
        paper: change of each value when all coordinates are 0.5 mm off on paper (SI); None if not requested.
        unit: unit of the column; empty for the unit that the file uses for this dimension.
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
        """Return the heading in the current language, with the unit."""
        if self.dimension is None or self.dimension == NUMBER:
            return translated(self.header)
        return f"{translated(self.header)}, {spelt(self.unit) if self.unit else units.spelt(self.dimension)}"

    def shown_in(self, units: UnitSystem) -> Unit:
        """Return the unit in which the values of the column are printed."""
        assert self.dimension is not None
        return parse_unit(self.unit) if self.unit else units.unit(self.dimension)

    @property
    def array(self) -> Any:
        """Values in SI units as an array; nan where there is no value."""
        listed = isinstance(self.values, list)
        return array([np.nan if v is None else v for v in self.values] if listed else self.values)

    def numbers(self, units: UnitSystem) -> Any:
        """Return the values in the units of the file as an array; nan where there is no value."""
        return self.shown_in(units).from_si(self.array.astype(float))

    def true_figures(self, units: UnitSystem) -> Any:
        """Return the number of correct significant figures of each value, -1 if it is unknown.

        The result is None if the column has no error bounds.
        """
        if self.dimension is None or self.bound is None:
            return None
        numbers, bound = self.numbers(units), np.asarray(self.bound) * self.shown_in(units).from_si(1.0)
        finite = np.isfinite(numbers) & np.isfinite(bound)
        return np.where(finite, true_digits(np.where(finite, numbers, 0.0), np.where(finite, bound, 0.0)), -1)


def with_unit(units: UnitSystem, value: float, dimension: Dimension, digits: int = 6) -> str:
    """Return a value (SI) as text in the unit of the file, rounded to `digits` significant figures: `110 mm`."""
    number = numeral(units.from_si(value, dimension) + 0.0, f".{digits}g")
    return typeset(f"{number} {units.spelt(dimension)}".rstrip())


def format_value(problem: Problem, value: float, dimension: Dimension) -> str:
    """Return a value (SI) as text in the unit of the file for its dimension."""
    return with_unit(problem.units, float(np.ravel(value)[0]), dimension)


def format_vector(problem: Problem, value: complex, dimension: Dimension = LENGTH) -> str:
    """Return the components of a vector (SI) as text in the unit of the file: `[120, 0]`."""
    value = complex(np.ravel(value)[0])
    return f"[{', '.join(f'{problem.units.from_si(v, dimension) + 0.0:.6g}' for v in (value.real, value.imag))}]"


def link_name(link: str) -> str:
    """Return the name of a link in the current language; the frame is called `frame` instead of 0."""
    return _("frame") if link == FRAME else link


def true_digits(values: Any, bound: Any) -> Any:
    """Return the number of correct significant figures of each value; 0 if none is correct.

    A figure is correct if the error bound is at most half a unit of that figure.
    """
    values, bound = np.abs(values), np.maximum(bound, 2.0**-54 * np.abs(values))
    with np.errstate(divide="ignore", invalid="ignore"):
        figures = np.floor(np.log10(values)) - np.ceil(np.log10(2 * bound)) + 1
        return np.where(bound < values, np.clip(figures, 1, 17), 0).astype(int)


@dataclass(frozen=True)
class Table:
    """A table of results or input data.

    Attributes:
        name: name of the table, and of its file without extension.
        title: title in the current language.
        columns: columns, all with the same number of rows.
        long: True if the table is written to files but not printed on a terminal.
        notes: sentences below the table.
    """

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
    """Return a table of text columns, given by its rows."""
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
    """Yield a table as CSV text in the units of the file, a chunk of rows at a time.

    An apostrophe protects cells that a spreadsheet would run as a formula.
    """
    yield ",".join(csv_cell(column.heading(units)) for column in table.columns) + "\n"
    columns = [_numbers_or_words(column, units) for column in table.columns]
    for start in range(0, table.rows, CHUNK_ROWS):
        chunk = slice(start, start + CHUNK_ROWS)
        cells = [_cells(values[chunk], figures if figures is None else figures[chunk]) for values, figures in columns]
        yield "".join([",".join(row) + "\n" for row in zip(*cells, strict=True)])


def _numbers_or_words(column: Column, units: UnitSystem) -> tuple[Any, Any]:
    """Return the numbers of a column in the units of the file, and the number of correct figures of each.

    For a column of texts, return the texts and None.
    """
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
    """Return a text as a CSV cell; an apostrophe prevents a spreadsheet from running it as a formula."""
    pieces = SEPARATORS.split(text)
    safe = "".join("'" + piece if _is_formula(piece) else piece for piece in pieces)
    safe = "'" + safe if text.startswith(("\t", "\r")) else safe
    quoted = len(pieces) > 1 or '"' in safe or safe.lower() in RESERVED_WORDS
    return '"' + safe.replace('"', '""') + '"' if quoted else safe


def _is_formula(piece: str) -> bool:
    """Return True if a spreadsheet would run this part of a cell as a formula."""
    begun = piece.lstrip(" ")
    return (
        begun.startswith(FORMULA_STARTS)
        and not SEPARATORS.fullmatch(piece)
        and not PLAIN_NUMBER.fullmatch(begun.rstrip(" "))
    )


def json_bytes(content: Any) -> bytes:
    """Return content as JSON text, encoded as bytes.

    Each series of numbers is on one line, so that results can be compared line by line.
    """
    return ("".join(_json_lines(content, "")) + "\n").encode()


def json_text(parts: Iterable[tuple[str, Any]]) -> Iterator[str]:
    """Yield a JSON object section by section, in the format of `json_bytes`; nan and infinity become null."""
    yield from _json_block("{", ((_json_key(key), section) for key, section in parts), "}", "")
    yield "\n"


def _json_lines(value: Any, indent: str) -> Iterator[str]:
    if isinstance(value, np.ndarray) and value.ndim == 1:
        yield from _json_array(value)
    elif isinstance(value, dict) and value:
        yield from _json_block("{", ((_json_key(key), nested) for key, nested in value.items()), "}", indent)
    elif isinstance(value, list | tuple) and any(
        isinstance(nested, dict | list | tuple | np.ndarray) for nested in value
    ):
        yield from _json_block("[", (("", nested) for nested in value), "]", indent)
    else:
        yield json.dumps(json_value(value), ensure_ascii=False, allow_nan=False)


def _json_key(key: str) -> str:
    return f"{json.dumps(key, ensure_ascii=False)}: "


def _json_block(opening: str, parts: Iterable[tuple[str, Any]], closing: str, indent: str) -> Iterator[str]:
    """Yield a JSON object or list in pieces; each item begins on a new line with its label."""
    separator = opening
    for label, nested in parts:
        yield f"{separator}\n{indent} {label}"
        yield from _json_lines(nested, indent + " ")
        separator = ","
    yield f"\n{indent}{closing}"


def _json_array(values: Any) -> Iterator[str]:
    """Yield a JSON array on one line."""
    yield "["
    for start in range(0, len(values), CHUNK_NUMBERS):
        yield ", " if start else ""
        yield json.dumps(json_value(values[start : start + CHUNK_NUMBERS]), allow_nan=False)[1:-1]
    yield "]"


def json_value(value: Any) -> Any:
    """Return a value as plain data for JSON: lists for arrays, None for nan and infinity."""
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
