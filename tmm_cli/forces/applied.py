"""One thing that acts on a link besides reactions."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from tmm_cli.vectors import Real, Vector


@dataclass(frozen=True)
class Applied:
    """A force (N) at a point `at` of a link (its axes, m) and a couple (N m), for every position.

    ambiguous: the name of a load of the task is also the symbol of another quantity, such as M3, the couple of inertia
    of link 3: formulas then write the whole name below the line.
    """

    name: str
    kind: Literal["weight", "inertia", "load", "friction"]
    link: str
    at: complex
    force: Vector
    moment: Real
    couple_name: str = ""
    ambiguous: bool = False

    @property
    def has_force(self) -> bool:
        """Somewhere; positions that are not come to, with nan, do not count."""
        return bool(np.any(np.abs(self.force) > 0))

    @property
    def has_moment(self) -> bool:
        return bool(np.any(np.abs(self.moment) > 0))
