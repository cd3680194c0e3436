"""Records of arrays over positions, some positions of which are taken from another record of the same kind."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any, TypeVar

import numpy as np

from tmm_cli.vectors import Real

KEPT = ("linkage", "kernels", "group", "pair", "driver", "finer", "where", "order")  # what is no array over positions

Part = TypeVar("Part")


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
