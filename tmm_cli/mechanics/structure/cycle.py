"""Length of the cycle of a mechanism in revolutions of its driver, with gears and several drivers."""

from __future__ import annotations

import math
from collections.abc import Mapping
from fractions import Fraction

from tmm_cli.mechanics.linkage import FRAME, Linkage, Mesh
from tmm_cli.mechanics.numerics import SAME_RATIO

POSITIONS_PER_TURN = 361  # samples per turn of a drawn curve
MOST_TURNS = 60  # longer cycles are of no practical use
LARGEST_DENOMINATOR = 500  # of gear ratios that count as fractions


def turns_of_cycle(linkage: Linkage, rounds: Mapping[str, int] | None = None) -> int | None:
    """Return the number of revolutions of the first driver after which the motion of the mechanism repeats.

    Args:
        linkage: the linkage.
        rounds: revolutions of links per revolution of the driver, as far as they are known (0 for a rocker).

    Returns:
        The number; None if the motion never repeats, or only after more than MOST_TURNS revolutions.
    """
    turns = 1
    for share in _gear_turns(linkage, rounds or {}).values():
        turns = math.lcm(turns, share.denominator if share is not None else MOST_TURNS + 1)
    lead = linkage.driver
    for driver in linkage.others:
        if driver.kind != "turn" or not lead.rate or driver.acceleration or lead.acceleration:
            return None
        share = _fraction(driver.rate / lead.rate)
        turns = math.lcm(turns, share.denominator if share is not None else MOST_TURNS + 1)
    return turns if turns <= MOST_TURNS else None


def _gear_turns(linkage: Linkage, rounds: Mapping[str, int]) -> dict[str, Fraction | None]:
    """Return the revolutions of each gear per revolution of the driver; None for a gear that never returns to its
    start.

    Links that gears do not drive are in the same position after each revolution of the driver. Their revolutions are
    therefore integers, and where they are unknown any integer serves.
    """
    whole, lead = Fraction(1), linkage.driver
    turns_of: dict[str, Fraction | None] = {FRAME: Fraction(0)}
    for driver in linkage.cranks:
        turns_of[driver.link] = whole if driver is lead or not lead.rate else _fraction(driver.rate / lead.rate)
    gears = [mesh for mesh in linkage.meshes if mesh.kind == "gear"]
    while gears:
        solvable = [m for m in gears if m.carrier in turns_of and (m.i in turns_of or m.j in turns_of)]
        if not solvable:
            together = _solve_gear_turns(gears, turns_of)
            if together:
                turns_of.update(together)
                continue
            wheels = {m.i for m in gears} | {m.j for m in gears}
            free = [n for m in gears for n in (m.carrier, m.i) if n not in turns_of]
            first = next((n for n in free if n not in wheels), free[0])
            turns_of[first] = Fraction(rounds.get(first, 1))
            continue
        mesh = solvable[0]
        gears.remove(mesh)
        ratio, carrier = _fraction(mesh.ratio), turns_of[mesh.carrier]
        for gear, mate, step in ((mesh.i, mesh.j, ratio), (mesh.j, mesh.i, ratio and 1 / ratio)):
            if gear in turns_of and mate not in turns_of:
                turns_of[mate] = _mate_turns(turns_of[gear], carrier, step)
                break
    return turns_of


def _solve_gear_turns(gears: list[Mesh], turns_of: Mapping[str, Fraction | None]) -> dict[str, Fraction]:
    """Solve for the revolutions of gears that follow only from several gear pairs together, as in a planetary gear
    train.

    Each pair gives the equation (turns of j) = ratio (turns of i) + (1 - ratio) (turns of the carrier).
    """
    solved: dict[str, dict[str, Fraction]] = {}  # turns of a link in terms of those of others; "" is the constant term
    for mesh in gears:
        ratio = _fraction(mesh.ratio)
        if ratio is None or any(turns_of.get(link, ratio) is None for link in (mesh.i, mesh.j, mesh.carrier)):
            continue
        row: dict[str, Fraction] = {}
        for link, factor in ((mesh.j, Fraction(1)), (mesh.i, -ratio), (mesh.carrier, ratio - 1)):
            turns = turns_of.get(link)
            _add_multiple(row, {link: Fraction(1)} if turns is None else {"": turns}, factor)
        for link, by in solved.items():
            _add_multiple(row, by, row.pop(link, Fraction(0)))
        first = next((link for link in row if link), None)
        if first is None:
            continue
        share = row.pop(first)
        expression = {link: -factor / share for link, factor in row.items()}
        for by in solved.values():
            _add_multiple(by, expression, by.pop(first, Fraction(0)))
        solved[first] = expression
    return {link: by.get("", Fraction(0)) for link, by in solved.items() if not set(by) - {""}}


def _add_multiple(row: dict[str, Fraction], other: Mapping[str, Fraction], factor: Fraction) -> None:
    """Add a multiple of a linear combination to another one, in place. Terms that become zero are removed."""
    for link, share in other.items():
        row[link] = row.get(link, Fraction(0)) + factor * share
        if not row[link]:
            del row[link]


def _mate_turns(share: Fraction | None, carrier: Fraction | None, step: Fraction | None) -> Fraction | None:
    """Return the revolutions of a gear from those of its mating gear and of their carrier; None if unknown.

    If the mating gear does not move relative to the carrier, neither does the gear.
    """
    if share is None or carrier is None:
        return None
    if share == carrier:
        return carrier
    return None if step is None else carrier + step * (share - carrier)


def _fraction(ratio: float) -> Fraction | None:
    """Return a ratio as a fraction with a small denominator; None if it is not close to such a fraction."""
    near = Fraction(ratio).limit_denominator(LARGEST_DENOMINATOR)
    return near if abs(float(near) - ratio) <= SAME_RATIO * max(1.0, abs(ratio)) else None
