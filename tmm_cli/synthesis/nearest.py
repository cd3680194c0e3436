"""The nearest feasible value of one given number of a task that is refused."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from tmm_cli.roots import bisect
from tmm_cli.synthesis.record import Shown

FIRST: Final = 0.002  # of the reach: the least change that is tried
COUNT: Final = 36  # changes that are tried, each larger than the last by one factor
HALVINGS: Final = 24  # of the step between the last change that does not help and the first that does
INWARDS: Final = 1e-7  # of the reach: so far from the edge rounding does not decide
AT_ONCE: Final = 1e-3  # of the least change: an edge so near to the given value is that value
PRINTED: Final = 1e-5  # relative: what six digits may add to a value that is rounded to one side


@dataclass(frozen=True)
class Number:
    """One number of a task (SI, rad) by its name; reach: how far from its value others are tried.

    task: what is asked with another value of it, None where that cannot be asked. key: of the block, that gives it.
    """

    name: str
    kind: str
    value: float
    reach: float
    task: Callable[[float], Any]
    key: str = ""


def nearest(numbers: Sequence[Number], solved: Callable[[Any], bool], count: int = COUNT) -> dict[str, Shown] | None:
    """Name and value of the number whose change, over its reach, is the first that helps; None: no one alone does."""

    def good(number: Number, value: float) -> bool:
        task = number.task(value)
        return task is not None and solved(task)

    last = 0.0
    for share in map(float, np.geomspace(FIRST, 1, count)):
        for number in numbers:
            for sign in (1.0, -1.0):
                if good(number, number.value + sign * share * number.reach):
                    return {"name": (number.name, "word"), "value": _edge(number, good, sign, share, last)}
        last = share
    return None


def _edge(number: Number, good: Callable[[Number, float], bool], sign: float, inside: Any, outside: Any) -> Shown:
    """The value where what is good begins, to be rounded away from the given one where it stays good so."""
    step = sign * number.reach

    def holds(share: Any) -> Any:
        return good(number, number.value + step * float(share))

    edge = float(bisect(holds, inside, outside, HALVINGS)[0])
    if edge > AT_ONCE * FIRST:  # else all but the given value itself is good: that stays a step away
        inside = edge
    value = number.value + step * (inside + INWARDS)
    rounded = value + sign * PRINTED * abs(value)
    if all(good(number, place) for place in (value, (value + rounded) / 2, rounded)):
        return value, number.kind, "least" if sign > 0 else "most"
    return number.value + step * inside, number.kind, "exact"
