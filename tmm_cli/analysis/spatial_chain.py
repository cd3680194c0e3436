"""What is found of a chain given by pairs alone: its count."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from tmm_cli.structure.spatial import Findings


@dataclass(frozen=True)
class ChainResults:
    """What was counted of a chain; it has no dimensions, so nothing else is computed. problem: as in Results."""

    problem: Any
    chain: Findings
