"""What follows from what in the equations of a group's pairs: angles from angles, then origins from angles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from tmm_cli.groups.elimination import Order
from tmm_cli.pairs.base import Constraint
from tmm_cli.pairs.turning import Turning

GIVE_ANGLES = "PGD"  # kinds of constraints whose first row may give an angle from others


@dataclass(frozen=True)
class Closure:
    """Explicit angles and origins as (number of the constraint, link), in their order, and the order of elimination.

    An unknown is three times the number of its link, and 0, 1 or 2 more for x, y and the angle. shifts: whole turns
    (rad) by which the angle of a link lies beyond what its constraint gives. pushing: order of the equations of forces,
    where some constraint pushes otherwise than it moves.
    """

    angles: tuple[tuple[int, str], ...]
    origins: tuple[tuple[int, str], ...]
    order: Order
    pushing: Order
    shifts: Mapping[str, float] = field(default_factory=dict)


def closure_of(constraints: Sequence[Constraint], links: Sequence[str]) -> Closure:
    """Of constraints on some links; as many unknowns as can be are explicit."""
    alike = {n for n, c in enumerate(constraints) if type(c).pushes is Constraint.pushes}
    own = {n: [link for link in _turned(c) if link in links] for n, c in enumerate(constraints)}
    angles, origins, order = _ordered(constraints, links, own)
    pushing = order
    if len(alike) < len(constraints):
        pushing = _ordered(constraints, links, {n: own[n] for n in alike})[2]
    return Closure(angles, origins, order, pushing)


Explicit = tuple[tuple[int, str], ...]


def _ordered(
    constraints: Sequence[Constraint], links: Sequence[str], turning: dict[int, list[str]]
) -> tuple[Explicit, Explicit, Order]:
    """Explicit angles, those that constraints with these links may give, and origins; and their order."""
    order = {link: k for k, link in enumerate(links)}
    first = [sum(len(c.lengths) for c in constraints[:n]) for n in range(len(constraints))]
    busy = {link: sum(link in c.links for c in constraints) for link in links}
    hinges = {
        n: [link for link in c.links if link in order] for n, c in enumerate(constraints) if isinstance(c, Turning)
    }
    angles, free = _explicit(turning, links, busy)
    origins, loose = _explicit(hinges, links, busy)
    explicit = [(first[n], 3 * order[link] + 2) for n, link in angles]
    for n, link in origins:
        explicit += [(first[n], 3 * order[link]), (first[n] + 1, 3 * order[link] + 1)]
    rows = sum(len(c.lengths) for c in constraints)
    closing = tuple(row for row in range(rows) if row not in {row for row, _ in explicit})
    columns = (*(3 * order[link] + part for link in loose for part in (0, 1)), *(3 * order[link] + 2 for link in free))
    return tuple(angles), tuple(origins), Order(tuple(explicit), closing, columns)


def _turned(constraint: Constraint) -> tuple[str, ...]:
    """Links whose angles are in the first row of a constraint that may give one of them."""
    if constraint.kind not in GIVE_ANGLES or constraint.lengths[0]:
        return ()
    return constraint.links


def _explicit(
    rows: dict[int, list[str]], links: Sequence[str], busy: Mapping[str, int]
) -> tuple[list[tuple[int, str]], list[str]]:
    """Which rows, of links that are not known, give which link, in their order; and links that none gives.

    Where no row has one link alone that is not given yet, the busiest link of one is left free.
    """
    found: list[tuple[int, str]] = []
    free: list[str] = []
    left, rows = list(links), dict(rows)
    while left:
        ready = next((n for n, own in rows.items() if sum(link in left for link in own) == 1), None)
        if ready is not None:
            link = next(link for link in rows.pop(ready) if link in left)
            found.append((ready, link))
        else:
            open_ones = {link for own in rows.values() for link in own if link in left} or set(left)
            link = max((one for one in left if one in open_ones), key=lambda one: busy[one])
            free.append(link)
        left.remove(link)
    return found, free
