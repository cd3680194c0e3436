"""The fastest way that there is to move the variants of a linkage."""

from __future__ import annotations

from collections.abc import Sequence

from tmm_cli.batch import Asked
from tmm_cli.family import Iterated
from tmm_cli.tape import DependsOnData
from tmm_cli.variants.apart import Apart
from tmm_cli.variants.taped import Taped
from tmm_cli.variants.together import Together
from tmm_cli.variants.way import Make

Program = Taped | Together | Apart


def fastest(
    make: Make, first: Sequence[float], asked: Asked, *, forces: bool, turns: int = 0, other: Sequence[float] = (),
    alike: bool = True,
) -> Program:  # fmt: skip
    """By the tape, else together, else one after another; turns and other as Together has them.

    alike: all drivers go the same way round, which arrays cannot tell. Raises what assembly raises, for the first
    linkage.
    """
    if not alike:
        return Apart(make, first, asked, forces=forces, turns=turns)
    try:
        return Taped(make, first, asked, forces=forces)
    except (Iterated, DependsOnData):
        pass
    try:
        return Together(make, first, asked, forces=forces, turns=turns, other=other)
    except (Iterated, DependsOnData):
        return Apart(make, first, asked, forces=forces, turns=turns)
