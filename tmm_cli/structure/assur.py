"""Mobility, pairs and Assur groups of a linkage, from who is joined to whom alone.

Class and order after I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 3: a group of two links is of class
II; otherwise the class is the number of sides of its largest closed contour of inner pairs, or of the inner pairs of
its richest link when it has no contour; the order is the number of leads (outer pairs).
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from tmm_cli.linkage import FRAME, Driver, Hinge, Linkage, Slide
from tmm_cli.structure.graph import Count, Tie, components, count

ROMAN = ("0", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X")


@dataclass(frozen=True)
class Pair:
    """A lower pair of two links. `i` comes first: the frame, the carrier, or the link that is placed earlier."""

    name: str
    kind: Literal["R", "P"]
    i: str
    j: str
    point: str
    slide: Slide | None = None

    def other(self, link: str) -> str:
        """The link at the other side."""
        return self.j if link == self.i else self.i


@dataclass(frozen=True)
class Group:
    """An Assur group: its links, inner and outer pairs (outer in the order of its links), class, order and type."""

    links: tuple[str, ...]
    inner: tuple[Pair, ...]
    outer: tuple[Pair, ...]
    grade: int
    type: str

    @property
    def order(self) -> int:
        return len(self.outer)

    @property
    def title(self) -> str:
        """II(2,3): class and links, as the formula of structure writes it."""
        return f"{ROMAN[min(self.grade, 10)]}({','.join(self.links)})"


@dataclass(frozen=True)
class Structure:
    """The structure of a linkage.

    mobility is Chebyshev's 3n - 2 p1; freedom is what the count on all sub-chains leaves (equal unless a part is
    over-held). groups are in solving order. loose and idle name what is wrong when the mobility is not one.
    """

    links: tuple[str, ...]
    pairs: tuple[Pair, ...]
    driver: Driver
    driving_pair: Pair | None
    groups: tuple[Group, ...]
    mobility: int
    freedom: int
    loose: tuple[str, ...] = ()
    idle: tuple[tuple[str, tuple[str, ...]], ...] = ()

    @property
    def contours(self) -> int:
        """Independent closed contours, K = p - n."""
        return len(self.pairs) - len(self.links)

    @property
    def formula(self) -> str:
        """Formula of structure: I(0,1) -> II(2,3) -> II(4,5)."""
        return " -> ".join([f"I({FRAME},{self.driver.link})", *(g.title for g in self.groups)])

    @property
    def mechanism_class(self) -> int:
        """The class of its highest group."""
        return max((g.grade for g in self.groups), default=1)

    def pair(self, name: str) -> Pair:
        return next(p for p in self.pairs if p.name == name)

    def needed_by(self, links: Iterable[str]) -> tuple[Group, ...]:
        """The groups on the way to the given links, in solving order."""
        wanted, chosen = set(links), []
        for group in reversed(self.groups):
            if wanted & set(group.links):
                chosen.append(group)
                wanted |= {pair.i for pair in group.outer} | {pair.j for pair in group.outer}
        return tuple(reversed(chosen))


def analyse(linkage: Linkage) -> Structure:
    """Structure of a linkage; never fails: what is wrong with it is in the result."""
    ties = list(_ties(linkage))
    pins = tuple(_pin(h) for h in linkage.hinges if len(h.links) > 2)
    bodies = tuple(linkage.links)
    undriven = count(bodies, FRAME, ties, pins)
    driver = linkage.driver
    driven = count(bodies, FRAME, [*ties, Tie("driver", FRAME, driver.link, 1)], pins)
    parts = [tuple(b for b in part if b in linkage.links) for part in components(driven.depends)]
    solved = [tuple(sorted(part, key=linkage.moving.index)) for part in parts if part and part != (FRAME,)]
    rank = {FRAME: -1} | {link: k for k, part in enumerate(solved) for link in part}
    pairs = tuple(_pairs(linkage, rank))
    mobility = 3 * len(linkage.moving) - 2 * len(pairs)
    sound = undriven.free == 1 and not undriven.idle and not driven.idle and driven.free == 0
    groups = tuple(_group(part, pairs, rank) for part in solved if part != (driver.link,)) if sound else ()
    driving = next((p for p in pairs if {p.i, p.j} == {FRAME, driver.link}), None)
    return Structure(
        linkage.moving,
        pairs,
        driver,
        driving,
        groups,
        mobility,
        undriven.free,
        *_faults(linkage, undriven, driven),
    )


def _pin(hinge: Hinge) -> str:
    return f"pin {hinge.point}"


def _ties(linkage: Linkage) -> Iterable[Tie]:
    for hinge in linkage.hinges:
        if len(hinge.links) == 2:
            yield Tie(hinge.point, *hinge.links, 2)
        else:
            yield from (Tie(hinge.point, _pin(hinge), link, 2) for link in hinge.links)
    yield from (Tie(slide.name, slide.carrier, slide.runner, 2) for slide in linkage.slides)


def _pairs(linkage: Linkage, rank: Mapping[str, int]) -> Iterable[Pair]:
    """Pairs of the linkage; a compound hinge becomes a chain in solving order, or a star about the frame.

    In solving order, because then a group is always hinged to links that are placed before it.
    """
    order = {name: k for k, name in enumerate(linkage.links)}
    for hinge in linkage.hinges:
        links = sorted(hinge.links, key=lambda name: (rank[name], order[name]))
        joined = [(FRAME, b) for b in links[1:]] if links[0] == FRAME else list(pairwise(links))
        for number, (i, j) in enumerate(joined):
            yield Pair(hinge.point + ("'" * (number + 1) if number else ""), "R", i, j, hinge.point)
    for slide in linkage.slides:
        yield Pair(slide.name, "P", slide.carrier, slide.runner, slide.point, slide)


def _group(links: tuple[str, ...], pairs: tuple[Pair, ...], rank: Mapping[str, int]) -> Group:
    here = rank[links[0]]
    inner = tuple(p for p in pairs if rank[p.i] == rank[p.j] == here)
    outer = [p for p in pairs if max(rank[p.i], rank[p.j]) == here != min(rank[p.i], rank[p.j])]
    own = {p.name: p.i if rank[p.i] == here else p.j for p in outer}
    outer.sort(key=lambda p: links.index(own[p.name]))
    if len(links) == 2 and len(inner) == 1 and len(outer) == 2:
        # The standard names write the turning end first: RRP, RPP.
        outer.sort(key=lambda p: p.kind == "P")
        kind = outer[0].kind + inner[0].kind + outer[1].kind
        return Group(tuple(own[p.name] for p in outer), inner, tuple(outer), 2, kind)
    grade = max(3, _largest_contour(links, inner), *(sum(link in (p.i, p.j) for p in inner) for link in links))
    kind = "".join(sorted((p.kind for p in (*inner, *outer)), reverse=True))
    return Group(links, inner, tuple(outer), grade, kind)


def _largest_contour(links: tuple[str, ...], inner: tuple[Pair, ...]) -> int:
    """Sides of the largest closed contour of inner pairs (groups are small: a plain search of all simple cycles)."""
    joined: dict[str, list[str]] = {link: [] for link in links}
    for pair in inner:
        joined[pair.i].append(pair.j)
        joined[pair.j].append(pair.i)
    best, budget = 0, 20_000
    stack: list[tuple[str, tuple[str, ...]]] = [(link, (link,)) for link in links]
    while stack and budget:
        budget -= 1
        link, path = stack.pop()
        for after in joined[link]:
            if after == path[0] and len(path) > 2:
                best = max(best, len(path))
            elif after not in path and links.index(after) > links.index(path[0]):
                stack.append((after, (*path, after)))
    return best


def _faults(
    linkage: Linkage, undriven: Count, driven: Count
) -> tuple[tuple[str, ...], tuple[tuple[str, tuple[str, ...]], ...]]:
    """Loose links and over-held pairs, in the words of the file."""
    order = {name: k for k, name in enumerate(linkage.links)}

    def named(count_: Count) -> tuple[tuple[str, tuple[str, ...]], ...]:
        return tuple((tie.name, tuple(sorted(bodies, key=order.__getitem__))) for tie, bodies in count_.idle)

    # With the driver in, a link is loose when it moves on its own; without it, every link may move with the crank.
    loose = tuple(sorted(driven.loose, key=order.__getitem__))
    return loose, named(undriven) or named(driven)
