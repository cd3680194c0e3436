"""Records of arrays over positions, some positions of which are taken from another record of the same kind."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any, TypeVar

import numpy as np

from tmm_cli.vectors import Real

KEPT = ("linkage", "kernels", "group", "pair", "driver", "finer", "where", "order")  # what is no array over positions

Part = TypeVar("Part")


def taken(record: Part, chosen: Real, count: int) -> Part:
    """A record of arrays over so many positions with the chosen ones only; all that are in a finer one are chosen."""
    found: Any = record
    if isinstance(record, np.ndarray):
        if record.shape[-1:] == (count,):
            found = record[..., chosen]
    elif is_dataclass(record) and not isinstance(record, type):
        kept = tuple(name for name in (*KEPT, "mechanism", "problem", "structure") if name != "where")
        changed = {f.name: taken(getattr(record, f.name), chosen, count) for f in fields(record) if f.name not in kept}
        found = replace(record, **changed)
    elif isinstance(record, Mapping):
        found = {key: taken(value, chosen, count) for key, value in record.items()}
    elif isinstance(record, tuple) and not all(isinstance(part, int | float | str) for part in record):
        found = tuple(taken(part, chosen, count) for part in record)
    part: Part = found
    return part


def spliced(full: Part, part: Part, where: Real) -> Part:
    """A record of arrays over positions with those of `where` taken from another one, rounded to its own precision."""
    found: Any = full
    if isinstance(full, np.ndarray) and isinstance(part, np.ndarray):
        if full.shape[-1:] == where.shape:
            found = full.copy()
            found[..., where] = part.astype(full.dtype)
    elif is_dataclass(full) and not isinstance(full, type):
        changed = {
            f.name: spliced(getattr(full, f.name), getattr(part, f.name), where)
            for f in fields(full) if f.name not in KEPT
        }  # fmt: skip
        found = replace(full, **changed)
    elif isinstance(full, Mapping) and isinstance(part, Mapping):
        found = {key: spliced(value, part[key], where) for key, value in full.items()}
    elif isinstance(full, tuple) and isinstance(part, tuple):
        found = tuple(spliced(a, b, where) for a, b in zip(full, part, strict=True))
    chosen: Part = found
    return chosen
