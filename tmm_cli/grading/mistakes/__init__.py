"""Typical mistakes. To add one, write a class in a module of this package and list it in MISTAKES."""

from __future__ import annotations

from tmm_cli.batch import VariantFamily
from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.grading.mistakes.data import (
    Degrees,
    DegreesInSine,
    Millimetres,
    Neighbour,
    OtherZero,
    Rpm,
    ScaleCarried,
    ScaleInverted,
    Sense,
)
from tmm_cli.grading.mistakes.forces import (
    CentreAtHinge,
    GuideThroughHinge,
    HingeInertia,
    InertiaReversed,
    LoadAtHinge,
    LoadReversed,
    NoCouple,
    NoInertia,
    NoLoad,
    NoWeight,
    OppositeReaction,
    ReactionUnreversed,
    WeightForMass,
    WrongStroke,
)
from tmm_cli.grading.mistakes.motion import Coriolis, Mirror, Normal, Tangential

MISTAKES: tuple[type[Mistake], ...] = (
    Degrees,
    Rpm,
    Millimetres,
    Sense,
    Mirror,
    DegreesInSine,
    Coriolis,
    Normal,
    Tangential,
    HingeInertia,
    NoInertia,
    NoCouple,
    InertiaReversed,
    WeightForMass,
    NoWeight,
    WrongStroke,
    GuideThroughHinge,
    Neighbour,
    OtherZero,
    ScaleInverted,
    ScaleCarried,
    OppositeReaction,
    NoLoad,
    LoadReversed,
    LoadAtHinge,
    CentreAtHinge,
    ReactionUnreversed,
)


def list_cases(family: VariantFamily) -> tuple[Mistake, ...]:
    """Return all typical mistakes that are possible for the variants of a family, e.g. one for each link."""
    return tuple(case for kind in MISTAKES for case in kind.cases(family))
