"""All that students may be asked. A further kind is a file here and a word in KINDS."""

from __future__ import annotations

from tmm_cli.grading.quantities.base import Maker, Quantity
from tmm_cli.grading.quantities.forces import forces
from tmm_cli.grading.quantities.motion import motion
from tmm_cli.grading.quantities.whole import whole
from tmm_cli.linkage import Linkage
from tmm_cli.structure.assur import Structure

KINDS: tuple[Maker, ...] = (whole, motion, forces)


def quantities(linkage: Linkage, structure: Structure) -> dict[str, Quantity]:
    """All quantities of a linkage by name, in the order of the kinds."""
    return {name: quantity for kind in KINDS for name, quantity in kind(linkage, structure).items()}
