"""A chain given by pairs alone, ready to be counted. No YAML, no pydantic."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from tmm_cli.problem.units import UnitSystem
from tmm_cli.structure.spatial import Chain


@dataclass(frozen=True)
class ChainProblem:
    """A problem file with `structure.spatial` that has been read; beside the chain what was told of it.

    output: the link to be held; local: local freedoms Wm; wanted: mobility Wo. None: not told.
    """

    name: str
    title: str
    chain: Chain
    output: str | None
    local: int | None
    wanted: int | None
    units: UnitSystem
    description: str = ""
    file: str = ""
    source: Any = field(default=None, compare=False, repr=False)
