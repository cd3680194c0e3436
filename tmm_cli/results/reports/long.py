"""Long tables: several things at every position, a row for each."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from tmm_cli.pipeline import Results
from tmm_cli.problem.dimensions import Dimension
from tmm_cli.results.reports.cycle import driver_columns
from tmm_cli.results.table import Column, Table
from tmm_cli.words import say

Values = Sequence[tuple[str, Any, Dimension]]  # key of the header, one value a position (or None), dimension


def long_table(
    results: Results, name: str, words: Mapping[str, Sequence[str]], values: Sequence[Values], note: str = ""
) -> Table:
    """Position by position, a row for each thing. words: what tells the things apart, by key of the header."""
    count, number = len(results.numbers), len(values)
    head = [
        Column(c.header, np.repeat(np.asarray(c.values), number).tolist(), c.dimension) for c in driver_columns(results)
    ]
    told = [Column(say(key), list(texts) * count) for key, texts in words.items()]
    columns = [*head, *told]
    for k, (key, _, dimension) in enumerate(values[0]):
        parts = [np.nan if thing[k][1] is None else thing[k][1] for thing in values]
        stacked = np.stack([np.broadcast_to(part, (count,)) for part in parts], axis=1)
        columns.append(Column(say(key), stacked.ravel(), dimension))
    return Table(name, say(f"{name}.title"), tuple(columns), long=True, notes=(note,) if note else ())
