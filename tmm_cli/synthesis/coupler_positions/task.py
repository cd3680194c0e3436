"""What is asked of a four-bar whose coupler takes given positions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.coupler_positions.burmester import Poses, equal_angles

SIDES: Final = {"left": 1.0, "right": -1.0}


@dataclass(frozen=True)
class Side:
    """What is given of a dyad: its pin (coupler's axes) or its pivot (m); length (m) and side with two positions; with
    four the turn from position 1 to 2 (rad) and branch (0 or 1), or a place (m) that its pivot shall be near to."""

    pin: Any = None
    pivot: Any = None
    length: Any = None
    side: str = "left"
    turn: Any = None
    branch: int = 0
    near: Any = None


@dataclass(frozen=True)
class Task:
    """Places (m) and angles (rad) of the coupler; what is given of AB and of DC; keep: defects are put up with.

    within: opposite corners (m) of a box in which pivots lie that are free with four positions.
    """

    places: tuple[Any, ...]
    angles: tuple[Any, ...]
    sides: Mapping[str, Side] = field(default_factory=dict)
    keep: bool = False
    within: tuple[complex, complex] | None = None

    @property
    def poses(self) -> Poses:
        return Poses(np.asarray(self.places, np.clongdouble), np.asarray(self.angles, np.longdouble))

    @property
    def still(self) -> bool:
        """Whether the coupler does not turn between four positions."""
        return len(self.angles) == 4 and equal_angles(self.poses.angles)

    @property
    def size(self) -> float:
        """The largest distance between positions, or of what is given of the coupler, m; where all that is nothing, of
        pivots that are given, or a length."""
        places = np.asarray(self.places, complex)
        given = [abs(complex(s.pin)) for s in self.sides.values() if s.pin is not None]
        found = float(max(np.max(np.abs(places[:, None] - places)), *given, 0.0))
        if found == 0:
            away = [abs(complex(s.pivot) - places[0]) for s in self.sides.values() if s.pivot is not None]
            found = float(max([*away, *(s.length for s in self.sides.values() if s.length is not None), 0.0]))
        return found

    def outside(self, places: Any) -> Any:
        """How far places lie outside the box (m), 0 within."""
        if self.within is None:
            return np.zeros(np.shape(places))
        (x, y), (u, v) = ((corner.real, corner.imag) for corner in self.within)
        at = np.asarray(places, complex)
        across = np.maximum(min(x, u) - at.real, at.real - max(x, u))
        return np.hypot(np.maximum(across, 0.0), np.maximum(np.maximum(min(y, v) - at.imag, at.imag - max(y, v)), 0.0))
