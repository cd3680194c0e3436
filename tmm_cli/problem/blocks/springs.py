"""Springs in a problem file: their keys, and how they are built."""

from __future__ import annotations

import math

from pydantic import Field

from tmm_cli.language import _
from tmm_cli.mechanics.elements.springs import Spring
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.quantities import ANGLE, DAMPING, FORCE, LENGTH, MOMENT, STIFFNESS, TORSION, TORSION_DAMPING
from tmm_cli.problem.blocks.elements import ElementKeys, place_element
from tmm_cli.problem.schema_types import Value
from tmm_cli.problem.values import FileSection


class SpringKeys(ElementKeys):
    """A spring between two links, or a cylinder with a constant force. A torsion spring has `torsion` instead of
    `rate`.
    """

    rate: Value | None = Field(default=None, description="stiffness, N/m; 0 for a constant force")
    torsion: Value | None = Field(default=None, description="stiffness of a torsion spring, N*m/rad")
    free: Value | None = Field(default=None, description="length (or angle) at which the spring exerts only `preload`")
    preload: Value = Field(
        default=0, description="tension at the free length (compression if negative); moment of a torsion spring"
    )
    damping: Value = Field(default=0, description="damping coefficient, N*s/m or N*m*s/rad")

    def build(self, name: str, linkage: Linkage, section: FileSection) -> Spring:
        """Build the spring; see ElementKeys."""
        turns = section.one_of("rate", "torsion") == "torsion"
        place = place_element(section, linkage, turns=turns)
        stiffness = ("torsion", TORSION) if turns else ("rate", STIFFNESS)
        rate = section.positive(*stiffness, zero=True)
        free = 0.0
        if self.free is None and rate > 0:
            allowed = str(ANGLE if turns else LENGTH)
            raise section.refusal("free", _("the free length or angle of the spring is missing"), allowed=allowed)
        if self.free is not None:
            free = section.number("free", ANGLE) if turns else section.positive("free", LENGTH, zero=True)
        if turns and abs(free) > math.pi:
            raise section.refusal(
                "free",
                _("the free angle must not exceed half a turn; enter any further winding as `preload`"),
                found=str(self.free),
            )
        preload = section.number("preload", MOMENT if turns else FORCE)
        damping = section.positive("damping", TORSION_DAMPING if turns else DAMPING, zero=True)
        return Spring(name, *place, turns, rate, free, preload, damping)
