"""Constraint equations for each kind of pair. For a new kind, write a class and register it here."""

from collections.abc import Callable

from tmm_cli.mechanics.groups.pairs.higher import CamConstraint, GearConstraint, RackConstraint
from tmm_cli.mechanics.groups.pairs.lower import HingeConstraint, PairConstraint, SlideConstraint
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.structure import Pair

PAIR_CONSTRAINTS: dict[str, Callable[[Pair, Linkage], PairConstraint]] = {
    "R": HingeConstraint.of,
    "P": SlideConstraint.of,
    "G": GearConstraint.of,
    "K": RackConstraint.of,
    "C": CamConstraint.of,
}
