"""What is read off a plan: each vector once with its segment and size, and what links turn with."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Literal

import numpy as np

from tmm_cli.kinematics.motion import Motion
from tmm_cli.plans.record import Plan, Symbol
from tmm_cli.tolerances import NO_VECTOR

PARTS = ("normal", "tangential")


@dataclass(frozen=True)
class Reading:
    """symbols: of all vectors that are the same one; segment: its letters on the plan; size: SI, zero of a point."""

    symbols: tuple[Symbol, ...]
    segment: str
    size: float


@dataclass(frozen=True)
class Turn:
    """What a link turns with, omega (rad/s) or epsilon (rad/s2): positive counter-clockwise."""

    symbol: Symbol
    value: float


def readings(plan: Plan) -> list[Reading]:
    """Vectors in the order of the plan; absolute ones that are the same vector stand together.

    Of a link that does not turn there are no parts.
    """
    least = NO_VECTOR * plan.size
    turning = {v.symbol.below for v in plan.vectors if v.kind in PARTS and abs(v.value) > least}
    found: dict[complex | int, Reading] = {}
    for number, vector in enumerate(plan.vectors):
        size = abs(vector.value)
        if vector.kind in PARTS and vector.symbol.below not in turning:
            continue
        key: complex | int = number
        if vector.kind == "absolute":
            key = next(
                (end for end in found if isinstance(end, complex) and abs(end - vector.end) <= least), vector.end
            )
        if key in found:
            found[key] = Reading((*found[key].symbols, vector.symbol), found[key].segment, found[key].size)
        else:
            found[key] = Reading((vector.symbol,), vector.name if size > least else "", size if size > least else 0.0)
    return list(found.values())


def turns(motion: Motion, k: int, what: Literal["omega", "epsilon"]) -> Iterable[Turn]:
    """Of all links that turn in any of the positions."""
    letter = {"omega": "ω", "epsilon": "ε"}[what]
    links = {link: motion.link(link) for link in motion.linkage.moving}
    rates = {link: getattr(own, what) for link, own in links.items()}
    largest = max((float(np.nanmax(np.abs(rate))) for rate in rates.values()), default=0.0)
    if what == "epsilon":  # where all turn evenly, rounding is small against omega squared only
        largest = max([largest, *(float(np.nanmax(np.abs(own.omega))) ** 2 for own in links.values())])
    for link, rate in rates.items():
        if np.nanmax(np.abs(rate)) > NO_VECTOR * largest:
            value = float(rate[k])
            yield Turn(Symbol(letter, link), value if abs(value) > NO_VECTOR * largest else 0.0)
