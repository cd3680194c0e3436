"""Springs and friction in a problem file."""

from __future__ import annotations

from pydantic import Field

from tmm_cli.problem.schema_parts import Name, Place, Strict, Value


class Spring(Strict):
    """A spring between two links, or a cylinder that only pushes; `torsion` instead of `rate` for one that twists."""

    between: list[Name] = Field(min_length=2, max_length=2, description="two links; the frame may be one")
    at: list[Place] | None = Field(
        default=None, min_length=2, max_length=2, description="its ends, one on each link; their first points"
    )
    rate: Value | None = Field(default=None, description="stiffness, N/m; 0 for a constant force")
    torsion: Value | None = Field(default=None, description="stiffness of a torsion spring, N*m/rad")
    free: Value | None = Field(default=None, description="length (or angle) at which it exerts `preload` alone")
    preload: Value = Field(
        default=0, description="pull (negative: push) at the free length; moment of a torsion spring"
    )
    damping: Value = Field(default=0, description="N*s/m, or N*m*s/rad: resists lengthening and shortening")


class PairFriction(Strict):
    """Friction in one pair."""

    coefficient: Value | None = None
    radius: Value | None = Field(default=None, description="of the journal of a hinge")


class Friction(Strict):
    """Coulomb friction in pairs. Without this block nothing of it is computed."""

    coefficient: Value = Field(default=0, description="in every pair that is not named")
    radius: Value = Field(default=0, description="of the journal of every hinge that is not named")
    pairs: dict[Name, PairFriction] = Field(default_factory=dict, max_length=300)
