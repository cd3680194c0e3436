"""A table before it is shown anywhere: columns of SI values with their dimension, or of words."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.double_double import array
from tmm_cli.language import numeral, spelt, translated, typeset
from tmm_cli.problem.units import Unit, UnitSystem, parse_unit
from tmm_cli.quantities import NUMBER, Dimension


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


def table_of_words(
    name: str, title: str, headers: Sequence[str], rows: Iterable[Sequence[str]], notes: Iterable[str] = ()
) -> Table:
    """A table without numbers, row by row."""
    rows = list(rows)
    columns = (Column(header, [row[k] for row in rows]) for k, header in enumerate(headers))
    return Table(name, title, tuple(columns), notes=tuple(notes))
