"""Dampers in a problem file: their keys, and how they are built."""

from __future__ import annotations

from pydantic import Field

from tmm_cli.language import _
from tmm_cli.mechanics.elements.dampers import Damper
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.quantities import DAMPING, QUADRATIC_DAMPING, TORSION_DAMPING, TORSION_QUADRATIC_DAMPING
from tmm_cli.problem.blocks.elements import ElementKeys, place_element
from tmm_cli.problem.schema_types import Value
from tmm_cli.problem.values import FileSection

LINEAR_KEYS = {"linear": DAMPING, "quadratic": QUADRATIC_DAMPING}
TORSIONAL_KEYS = {"torsion": TORSION_DAMPING, "torsion_quadratic": TORSION_QUADRATIC_DAMPING}


class DamperKeys(ElementKeys):
    """A damper between two links. With `linear`, `quadratic` or both, its force opposes the change of the distance
    between two points; with `torsion`, `torsion quadratic` or both, its moment opposes the relative rotation of the
    links.
    """

    linear: Value | None = Field(default=None, description="force divided by the speed, N*s/m")
    quadratic: Value | None = Field(default=None, description="force divided by the square of the speed, N*s^2/m^2")
    torsion: Value | None = Field(default=None, description="moment divided by the angular velocity, N*m*s/rad")
    torsion_quadratic: Value | None = Field(
        default=None,
        alias="torsion quadratic",
        description="moment divided by the square of the angular velocity, N*m*s^2/rad^2",
    )

    def build(self, name: str, linkage: Linkage, section: FileSection) -> Damper:
        """Build the damper; see ElementKeys."""
        present = [key for key in (*LINEAR_KEYS, *TORSIONAL_KEYS) if getattr(self, key) is not None]
        turns = any(key in TORSIONAL_KEYS for key in present)
        keys = TORSIONAL_KEYS if turns else LINEAR_KEYS
        if not present or any(key not in keys for key in present):
            raise section.refusal(
                "",
                _("a damper acts either along the line of two points or on the relative rotation of two links"),
                found=", ".join(str(section.at(key)[-1]) for key in present) or None,
                allowed=_("`linear`, `quadratic` or both; or `torsion`, `torsion quadratic` or both"),
            )
        place = place_element(section, linkage, turns=turns)
        linear, quadratic = (
            section.positive(key, dimension, zero=True) if key in present else 0.0 for key, dimension in keys.items()
        )
        return Damper(name, *place, turns, linear, quadratic)
