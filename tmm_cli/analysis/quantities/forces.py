"""Inertia forces and couples, reactions, what balances the driver."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np

from tmm_cli.analysis.quantities.base import Quantity, Solved
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.quantities import FORCE, LENGTH, MOMENT
from tmm_cli.structure.assur import Structure

NEARLY_ZERO = 0.05  # of a reaction's largest size: then where it acts cannot be drawn


def forces(linkage: Linkage, structure: Structure) -> dict[str, Quantity]:
    """U3 and M3 of inertia; R_34, the force of link 3 on link 4; M_b or F_b, of the plan and by the lever alike."""
    found: dict[str, Quantity] = {}

    def put(quantity: Quantity) -> None:
        found.setdefault(quantity.name, quantity)

    for name in linkage.moving:
        link = linkage.links[name]
        if np.any(link.mass != 0):
            put(Quantity(f"U of {name}", "forces", FORCE, partial(_inertia, name, "force"), True, thing=name))
        if np.any(link.inertia != 0):
            put(Quantity(f"M of {name}", "forces", MOMENT, partial(_inertia, name, "moment"), thing=name))
    pairs = [(pair.i, pair.j, pair.name) for pair in structure.pairs]
    for one, other, name in pairs:
        alone = sum({i, j} == {one, other} for i, j, _ in pairs) == 1
        for by, on in ((one, other), (other, one)):
            both = f"{by}{on}" if len(by) == len(on) == 1 else f"{by},{on}"
            called = f"R_{both}" if alone else f"R_{both} in {name}"
            put(Quantity(called, "forces", FORCE, partial(_reaction, name, on), True, thing=name, on=on))
            if any(slide.name == name for slide in linkage.slides):
                put(Quantity(f"arm of {called}", "forces", LENGTH, partial(_arm, name), thing=name))
    for driver in linkage.drivers:
        own = "" if len(linkage.drivers) == 1 else f" of {driver.link}"
        if driver.kind == "turn":
            put(Quantity(f"M_b{own}", "balance", MOMENT, partial(_balance, driver.link, "moment"), thing=driver.link))
        if driver.kind == "slide" or driver.base == FRAME:
            put(Quantity(f"F_b{own}", "balance", FORCE, partial(_balance, driver.link, "force"), thing=driver.link))
    return found


def _inertia(link: str, part: str, solution: Solved) -> Any:
    return next(getattr(x, part) for x in solution.reactions.applied if x.link == link and x.kind == "inertia")


def _reaction(pair: str, on: str, solution: Solved) -> Any:
    return solution.reactions.of(pair).onto(on)


def _arm(pair: str, solution: Solved) -> Any:
    """Where a guide's force acts, along the guide from its running point; nothing where the force is nearly zero."""
    reaction = solution.reactions.of(pair)
    size = np.abs(reaction.force)
    assert reaction.arm is not None
    return np.where(size > NEARLY_ZERO * np.max(size, axis=-1, keepdims=True), reaction.arm, np.nan)


def _balance(link: str, part: str, solution: Solved) -> Any:
    return next(getattr(balance, part) for balance in solution.reactions.balances if balance.driver.link == link)
