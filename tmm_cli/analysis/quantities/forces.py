"""Inertia forces and couples, reactions, what balances the driver."""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from itertools import permutations
from typing import Any

import numpy as np

from tmm_cli.analysis.quantities.base import Quantity, Solved
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.quantities import FORCE, LENGTH, MOMENT
from tmm_cli.structure.assur import Structure

NEARLY_ZERO = 0.05  # of a reaction's largest size: then where it acts cannot be drawn


def forces(linkage: Linkage, structure: Structure) -> dict[str, Quantity]:
    """U3 and M3 of inertia; R_34, the force of link 3 on link 4; R_A, the whole pin of a compound hinge; M_b or F_b."""
    found: dict[str, Quantity] = {}

    def put(quantity: Quantity) -> None:
        found.setdefault(quantity.name, quantity)

    for name in linkage.moving:
        link = linkage.links[name]
        if np.any(link.mass != 0):
            put(Quantity(f"U of {name}", "forces", FORCE, partial(_inertia, name, "force"), True, thing=name))
        if np.any(link.inertia != 0):
            put(Quantity(f"M of {name}", "forces", MOMENT, partial(_inertia, name, "moment"), thing=name))
    common_links = _common_links(linkage, structure)
    for pair in structure.pairs:
        alone = sum({other.i, other.j} == {pair.i, pair.j} for other in structure.pairs) == 1
        for by, on in ((pair.i, pair.j), (pair.j, pair.i)):
            called = _reaction_name(by, on) if alone else f"{_reaction_name(by, on)} in {pair.name}"
            force = Quantity(called, "forces", FORCE, partial(_reaction, pair.name, on), True, thing=pair.name, on=on)
            if pair.point in common_links and pair.kind == "R":
                common = common_links[pair.point]
                read = partial(_pin_force, pair.point, common, 1 if on == common else -1)
                force = replace(force, otherwise=replace(force, read=read))
            put(force)
            if pair.slide is not None:
                put(Quantity(f"arm of {called}", "forces", LENGTH, partial(_arm, pair.name), thing=pair.name))
    for hinge in linkage.hinges:
        if hinge.point in common_links:
            common = common_links[hinge.point]
            put(Quantity(f"R_{hinge.point}", "forces", FORCE, partial(_pin_force, hinge.point, common, -1), True))
            for by, on in permutations([link for link in hinge.links if link != common], 2):
                force = Quantity(_reaction_name(by, on), "forces", FORCE, partial(_pin_force, hinge.point, on, 1), True)
                put(replace(force, otherwise=replace(force, read=partial(_pin_force, hinge.point, by, -1))))
    for driver in linkage.drivers:
        own = "" if len(linkage.drivers) == 1 else f" of {driver.link}"
        if driver.kind == "turn":
            put(Quantity(f"M_b{own}", "balance", MOMENT, partial(_balance, driver.link, "moment"), thing=driver.link))
        if driver.kind == "slide" or driver.base == FRAME:
            put(Quantity(f"F_b{own}", "balance", FORCE, partial(_balance, driver.link, "force"), thing=driver.link))
    return found


def _common_links(linkage: Linkage, structure: Structure) -> dict[str, str]:
    """For the point of each compound hinge the link to which the others are attached."""
    found = {}
    for hinge in linkage.hinges:
        ends = [{pair.i, pair.j} for pair in structure.pairs if pair.kind == "R" and pair.point == hinge.point]
        if len(ends) > 1:
            (found[hinge.point],) = set.intersection(*ends)
    return found


def _reaction_name(by: str, on: str) -> str:
    return f"R_{by}{on}" if len(by) == len(on) == 1 else f"R_{by},{on}"


def _pin_force(point: str, link: str, sense: int, solution: Solved) -> Any:
    """The force of the pin of a compound hinge on one of its links, or its opposite."""
    return sense * solution.reactions.pin_force(point, link)


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
