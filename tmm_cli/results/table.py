"""A table before it is shown anywhere: columns of SI values with their dimension, or of words."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from tmm_cli.problem.dimensions import Dimension


@dataclass(frozen=True)
class Column:
    """A column: header, values in SI (None or nan where there is none) and what they measure; words have none."""

    header: str
    values: Any  # a list or an array, one entry a row
    dimension: Dimension | None = None
    digits: int = 6  # shown on a terminal; files have them all


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
