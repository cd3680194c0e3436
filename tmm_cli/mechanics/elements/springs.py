"""Springs, with dampers beside them; also cylinders that exert a force without prescribing a motion."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from tmm_cli.mechanics.elements.element import LoadElement, Stretch
from tmm_cli.mechanics.numerics import Real


@dataclass(frozen=True)
class Spring(LoadElement):
    """A spring between two links: its pull is preload + rate (length - free) + damping (rate of lengthening).

    A torsional one has the angle of link j relative to link i instead of the length, within half a turn of `free`.

    Attributes:
        rate: stiffness (N/m, or N m/rad).
        free: length (m) or angle (rad) at which only the preload acts.
        preload: force (N) or moment (N m) at this length or angle.
        damping: damping coefficient (N s/m, or N m s/rad).
    """

    block: ClassVar[str] = "springs"

    rate: float = 0.0
    free: float = 0.0
    preload: float = 0.0
    damping: float = 0.0

    @property
    def rest(self) -> float:
        """Angle at which only the preload of a torsional spring acts; see LoadElement."""
        return self.free

    @property
    def speed_key(self) -> str | None:
        """Key of the damping, if there is any; see LoadElement."""
        return "damping" if self.damping else None

    def pull(self, stretch: Stretch) -> Real:
        """Return the force (N) or moment (N m) of the spring; see LoadElement."""
        extension = stretch.size if self.turns else stretch.size - self.free
        pull: Real = self.preload + self.rate * extension + self.damping * stretch.rate
        return pull
