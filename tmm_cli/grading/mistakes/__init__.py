"""Typical mistakes. A further one is a file here and a word in MISTAKES."""

from __future__ import annotations

from tmm_cli.grading.mistakes.base import Mistake
from tmm_cli.grading.mistakes.coriolis import Coriolis
from tmm_cli.grading.mistakes.degrees import Degrees
from tmm_cli.grading.mistakes.guide_through_hinge import GuideThroughHinge
from tmm_cli.grading.mistakes.hinge_inertia import HingeInertia
from tmm_cli.grading.mistakes.inertia_reversed import InertiaReversed
from tmm_cli.grading.mistakes.millimetres import Millimetres
from tmm_cli.grading.mistakes.mirror import Mirror
from tmm_cli.grading.mistakes.neighbour import Neighbour
from tmm_cli.grading.mistakes.no_couple import NoCouple
from tmm_cli.grading.mistakes.no_inertia import NoInertia
from tmm_cli.grading.mistakes.no_weight import NoWeight
from tmm_cli.grading.mistakes.normal import Normal
from tmm_cli.grading.mistakes.opposite_reaction import OppositeReaction
from tmm_cli.grading.mistakes.other_zero import OtherZero
from tmm_cli.grading.mistakes.rpm import Rpm
from tmm_cli.grading.mistakes.scale_inverted import ScaleInverted
from tmm_cli.grading.mistakes.sense import Sense
from tmm_cli.grading.mistakes.tangential import Tangential
from tmm_cli.grading.mistakes.weight_for_mass import WeightForMass
from tmm_cli.grading.mistakes.wrong_stroke import WrongStroke
from tmm_cli.variants.family import Family

MISTAKES: tuple[type[Mistake], ...] = (
    Degrees, Rpm, Millimetres, Sense, Mirror, Coriolis, Normal, Tangential, HingeInertia, NoInertia, NoCouple,
    InertiaReversed, WeightForMass, NoWeight, WrongStroke, GuideThroughHinge, Neighbour, OtherZero, ScaleInverted,
    OppositeReaction,
)  # fmt: skip


def cases(family: Family) -> tuple[Mistake, ...]:
    """All cases of all mistakes that a task has."""
    return tuple(case for kind in MISTAKES for case in kind.cases(family))
