"""All quantities by name: what students may be asked, what a file shows. A further kind: a file, a word in KINDS."""

from __future__ import annotations

from tmm_cli.analysis.quantities.base import Maker, Quantity
from tmm_cli.analysis.quantities.forces import forces
from tmm_cli.analysis.quantities.motion import motion
from tmm_cli.analysis.quantities.whole import whole
from tmm_cli.linkage import Linkage
from tmm_cli.structure.assur import Structure

KINDS: tuple[Maker, ...] = (whole, motion, forces)


def quantities(linkage: Linkage, structure: Structure) -> dict[str, Quantity]:
    """All quantities of a linkage by name, in the order of the kinds."""
    return {name: quantity for kind in KINDS for name, quantity in kind(linkage, structure).items()}
