"""A table before it is shown anywhere: columns of SI values with their dimension, or of words."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tmm_cli.problem.dimensions import Dimension


@dataclass(frozen=True)
class Column:
    """A column: header, values in SI (None or nan where there is none) and what they measure; words have none.

    bound: how far each value may be from the truth by rounding; lengths, paper: its change when every length changes by
    0.1 %, by 0.5 mm on paper (SI; None where they were not asked for).
    """

    header: str
    values: Any  # a list or an array, one entry a row
    dimension: Dimension | None = None
    digits: int = 6  # shown on a terminal; files have all that are true
    bound: Any = None
    lengths: Any = None
    paper: Any = None


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
    notes: tuple[str, ...] = field(default=())

    @property
    def rows(self) -> int:
        return len(self.columns[0].values) if self.columns else 0
