"""Independent contours of a chain, and how a linkage is classed by them and by its groups.

A contour is independent when it has a pair that no other of the list has: K = p - n of them, one for every pair that
is left over when a tree of pairs has reached all links. The tree is grown from the frame, nearest links first, so the
contours are short and run through the frame where they can.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Protocol

from tmm_cli.language import printed
from tmm_cli.linkage import FRAME
from tmm_cli.structure.assur import Structure


class Joint(Protocol):
    """Whatever joins two links: a planar pair or a pair in space."""

    @property
    def name(self) -> str: ...
    @property
    def i(self) -> str: ...
    @property
    def j(self) -> str: ...


@dataclass(frozen=True)
class Contour:
    """A closed contour: its links in order, from the one nearest the frame on, and the pairs between them."""

    links: tuple[str, ...]
    pairs: tuple[str, ...]

    @property
    def title(self) -> str:
        """0-1-2-3-0."""
        return "-".join(map(printed, (*self.links, self.links[0])))


def contours(pairs: Sequence[Joint], links: Iterable[str]) -> tuple[Contour, ...]:
    """Independent contours of the links that pairs join to the frame; `links` says in which order they are named."""
    ways = _ways(pairs)
    rank = {link: number for number, link in enumerate((FRAME, *links))}
    found = []
    for pair in pairs:
        if pair.i not in ways or pair.j not in ways or pair in (ways[pair.i][0][1], ways[pair.j][0][1]):
            continue  # out of reach, or itself on a way
        one, other = list(ways[pair.i]), list(ways[pair.j])
        while len(one) > 1 and len(other) > 1 and one[-2][0] == other[-2][0]:
            one.pop()
            other.pop()
        if (rank[_second(one, other)], len(one) == 1) > (rank[_second(other, one)], len(other) == 1):
            one, other = other, one
        # down the one path from the link both have in common, over the pair, back up the other
        names = [link for link, _ in reversed(one)] + [link for link, _ in other[:-1]]
        joints = [p.name for _, p in reversed(one[:-1]) if p] + [pair.name] + [p.name for _, p in other[:-1] if p]
        found.append(Contour(tuple(names), tuple(joints)))
    return tuple(sorted(found, key=lambda c: [rank[link] for link in c.links]))


def classification(structure: Structure) -> tuple[str, ...]:
    """Words for a linkage: closed or open; elementary, simple or complex; groups of one type or of several.

    Elementary: the driver alone; simple: one group on it; complex: two groups or more. Combined: some of its groups are
    alike and others are not.
    """
    chain = "closed" if structure.contours > 0 else "open"
    if not structure.groups:
        return (chain, "elementary") if len(structure.links) == 1 else (chain,)
    if len(structure.groups) == 1:
        return (chain, "simple")
    types = {(group.group_class, group.order, group.type) for group in structure.groups}
    if len(types) == 1:
        return (chain, "complex", "same type")
    return (chain, "complex", "combined" if len(types) < len(structure.groups) else "several types")


def is_dependent(contour: Contour, structure: Structure) -> bool:
    """Return True if the contour repeats another one: a link or pair of it is redundant."""
    pairs = {redundant.pair for redundant in structure.reduction.pairs if not redundant.left}
    return not structure.reduction.removed.isdisjoint(contour.links) or not pairs.isdisjoint(contour.pairs)


def reached(pairs: Sequence[Joint]) -> set[str]:
    """The links that some way of pairs joins to the frame, the frame among them."""
    return set(_ways(pairs))


Way = list[tuple[str, Joint | None]]  # links on the way to the frame, each with the pair that leads on


def _ways(pairs: Sequence[Joint]) -> dict[str, Way]:
    """The shortest way to the frame of every link that has one."""
    ways: dict[str, Way] = {FRAME: [(FRAME, None)]}
    todo = [FRAME]
    for link in todo:  # grows while it is walked: nearest links first
        for pair in pairs:
            if link in (pair.i, pair.j):
                after = pair.j if link == pair.i else pair.i
                if after not in ways:
                    ways[after] = [(after, pair), *ways[link]]
                    todo.append(after)
    return ways


def _second(path: Way, other: Way) -> str:
    """The link after the common one, going down the path and then up the other."""
    return path[-2][0] if len(path) > 1 else other[0][0]
