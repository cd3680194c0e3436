"""Long tables: several things at every position, a row for each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.language import Phrase
from tmm_cli.quantities import NamedValues
from tmm_cli.results.reports.cycle import driver_columns
from tmm_cli.results.table import Column, Table


def long_table(
    results: Results, name: str, title: str, words: Mapping[Phrase, Sequence[str]],
    things: Sequence[Sequence[NamedValues]], note: str = "",
) -> Table:  # fmt: skip
    """Position by position, a row for each thing. words: what tells the things apart, by header.

    things: their columns (quantities.columns), which have the same headers.
    """
    count, number = len(results.numbers), len(things)
    head = [Column(c.header, _repeated(c.values, number), c.dimension) for c in driver_columns(results)]
    columns = [*head, *(Column(header, list(texts) * count) for header, texts in words.items())]
    for same in zip(*things, strict=True):
        parts = [np.nan if values is None else values for __, values, __ in same]
        stacked = np.stack([p if np.shape(p) == (count,) else np.broadcast_to(p, (count,)) for p in parts], axis=1)
        header, __, dimension = same[0]
        columns.append(Column(header, stacked.ravel(), dimension))
    return Table(name, title, tuple(columns), long=True, notes=(note,) if note else ())


def _repeated(values: Any, number: int) -> Any:
    """Each value so often in a row; words and whole numbers stay such."""
    return [v for v in values for _ in range(number)] if isinstance(values, list) else np.repeat(values, number)
