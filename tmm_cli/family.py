"""All linkages that one problem file describes when some of its numbers vary: one program, any numbers put in.

Unlike a Batch, whose program is for the linkages that it was made of, this one takes numbers anew at every call; which
assembly the groups have is that of the first linkage.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

from tmm_cli.assembly import assemble
from tmm_cli.batch import Asked, solved
from tmm_cli.groups.base import Closed
from tmm_cli.linkage import Linkage
from tmm_cli.mobile import mobile
from tmm_cli.stack import changed, numbers
from tmm_cli.tape import Program, Stand, record
from tmm_cli.tape.varied import Varied

Make = Callable[[Sequence[Any]], Linkage]


class Iterated(ValueError):  # noqa: N818  it says what is the matter
    """Groups that are found by iteration, or friction, cannot be written on a tape."""


def family(
    make: Make, first: Sequence[float], asked: Asked, *, forces: bool = False, start: float | None = None,
    own_places: bool = False,
) -> Program:  # fmt: skip
    """A program of the varying numbers, each (variants, 1), and the driver's places (positions,).

    make: the linkage for given numbers, floats or Varied; first: those of the linkage whose assembly all have; start:
    where the driver's law begins, in the sketch when left out; own_places: whether each variant has places of its own,
    (variants, positions). Raises Iterated, and what assembly raises.
    """
    ordinary = make(first)
    structure = mobile(ordinary)
    kernels = assemble(ordinary, structure)
    if not all(isinstance(kernel, Closed) and kernel.winding is None for kernel in kernels) or ordinary.friction:
        raise Iterated

    def stages(*data: Stand) -> Mapping[str, Any]:
        varied = make([Varied(value, stand) for value, stand in zip(first, data[:-1], strict=True)])
        stands = {path: number.stand for path, number in numbers(varied) if isinstance(number, Varied)}
        linkage = replace(changed(varied, stands), sketch=ordinary.sketch)
        own = tuple(kernel.again(linkage) for kernel in kernels)
        return solved(linkage, structure.again(linkage), own, data[-1], asked, forces, None, blank=False, start=start)

    return record(stages, *[1] * len(first), 3 if own_places else 2)
