"""The structure that a linkage is solved by: by counting, or by the rank of its equations where the count misleads."""

from __future__ import annotations

from tmm_cli.assembly.rank import by_rank
from tmm_cli.errors import MobilityError
from tmm_cli.linkage import Linkage
from tmm_cli.structure.assur import Structure, analyse


def mobile(linkage: Linkage) -> Structure:
    """The groups of a linkage whose drivers move all of it. Raises MobilityError."""
    structure = analyse(linkage)
    if structure.sound:
        return structure
    moving = by_rank(linkage, structure)
    if moving is None:
        raise MobilityError(structure)
    return moving
