"""One thing that acts on a link besides reactions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from tmm_cli.vectors import Real, Vector


@dataclass(frozen=True)
class Applied:
    """A force (N) at a point `at` of a link (its axes, m) and a couple (N m), for every position."""

    name: str
    kind: Literal["weight", "inertia", "load", "friction"]
    link: str
    at: complex
    force: Vector
    moment: Real
    couple_name: str = ""

    @property
    def has_force(self) -> bool:
        """Somewhere; positions that are not come to, with nan, do not count."""
        return bool(np.any(np.abs(self.force) > 0))

    @property
    def has_moment(self) -> bool:
        return bool(np.any(np.abs(self.moment) > 0))
