"""What is said of a task before its search."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tmm_cli.assembly.choose import assemble
from tmm_cli.assembly.rank import mobile
from tmm_cli.errors import LinkageError
from tmm_cli.kinematics.driver_range import cycle_of
from tmm_cli.language import _
from tmm_cli.linkage import Linkage
from tmm_cli.synthesis.optimal.task import Task, near
from tmm_cli.synthesis.record import Infeasible
from tmm_cli.variants.stack import numbers as numbers_of

TRIES = 40  # of linkages within the bounds, for one that can be assembled
SHARES = (0.0, 0.137, 0.382, 0.618, 0.871, 1.0)  # of its range: where a parameter is looked at
MOST_LOOKED = 100  # of its values, where it has some only


def first_of(task: Task) -> list[float]:
    """Numbers (SI) of a linkage that can be assembled as the file sketches it: the middle of the bounds, or others.

    Raises Infeasible.
    """
    low, high = (np.array([getattr(p, end) for p in task.parameters]) for end in ("low", "high"))
    chance = np.random.default_rng(0)
    for share in (np.full(len(low), 0.5), *chance.random((TRIES, len(low)))):
        numbers: list[float] = near(low + share * (high - low), task.parameters).tolist()
        linkage = task.make(numbers).linkage
        try:
            assemble(linkage, mobile(linkage))
        except LinkageError:
            continue
        return numbers
    raise Infeasible("vary", _("no linkage within these bounds can be assembled as it is sketched"))


def check(task: Task, first: Sequence[float]) -> None:
    """Every parameter changes something, the linkage has what is asked of it, its cycle is that of all candidates.

    Raises Infeasible.
    """
    variant = task.make(first)
    before = dict(numbers_of(variant))
    for k, p in enumerate(task.parameters):
        other = list(first)
        other[k] = p.low if abs(first[k] - p.low) > abs(first[k] - p.high) else p.high
        if dict(numbers_of(task.make(other))) == before:
            raise Infeasible(("vary", p.name), _("nothing in the file rests on this parameter"))
    groups, closed = mobile(variant.linkage).solved, variant.ends is None
    for at, quantity in ((("objective",), task.objective), *((c.at, c.quantity) for c in task.constraints)):
        unfit = quantity.unfit(variant.linkage, groups, closed=closed)
        if unfit is not None:
            raise Infeasible(at, unfit)
    if closed:
        _check_cycle(task, first, variant.linkage)


def _check_cycle(task: Task, first: Sequence[float], linkage: Linkage) -> None:
    """All candidates come round again after as many turns of the crank. Raises Infeasible.

    Toothed wheels and further drivers come round together only where their ratios are those of whole numbers.
    """
    geared = any(mesh.kind == "gear" for mesh in linkage.meshes) or linkage.others
    moves = any(quantity.moves for quantity in (task.objective, *(c.quantity for c in task.constraints)))
    if not geared or not moves:
        return
    kernels = assemble(linkage, mobile(linkage))
    for k, p in enumerate(task.parameters):
        own = p.values or [p.low + share * (p.high - p.low) for share in SHARES]
        turns: set[Any] = set()  # or ratios with which all never comes round again
        for numbers in task.with_one(first, k, own[:: -(-len(own) // MOST_LOOKED)]):
            other = task.make(numbers).linkage
            turns.add(cycle_of(other, kernels) or _ratios(other))
        if len(turns) > 1:
            reason = _("after how many turns all comes round again rests on this parameter")
            raise Infeasible(("vary", p.name), reason)


def _ratios(linkage: Linkage) -> tuple[str, ...]:
    """Of speeds of wheels and drivers, to 12 digits: what they come round together hangs on."""
    wheels = [mesh.ratio for mesh in linkage.meshes if mesh.kind == "gear"]
    return tuple(f"{ratio:.12g}" for ratio in (*wheels, *(o.rate / linkage.driver.rate for o in linkage.others)))


def one_sense(task: Task, first: Sequence[float]) -> bool:
    """Whether no driver goes forth in some candidates and back in others."""
    senses = set()
    for k, p in enumerate(task.parameters):
        for numbers in task.with_one(first, k, (p.low, p.high)):
            linkage = task.make(numbers).linkage
            senses.add(tuple(driver.sense for driver in (linkage.driver, *linkage.others)))
    return len(senses) <= 1
