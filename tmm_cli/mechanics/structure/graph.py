"""Counting freedoms: the pebble game on bodies, and what it says of mobility and solving order.

Each link is a body with three freedoms (pebbles), a pair takes two of them, the driver one more. A compound hinge is
a point with two freedoms, the pin, joined to each of its links. The orientation that the game leaves is a map of
dependence: its strongly connected components are the Assur groups, in solving order.
Source: A. Sljoka, O. Shai, W. Whiteley, Checking mobility and decomposition of linkages via pebble game algorithm,
ASME DETC 2011, sections 3 and 4; the count 3n - 2p for all sub-chains is the (3, 3) game of A. Lee and I. Streinu,
Pebble game algorithms and sparse graphs, Discrete Mathematics 308 (2008).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Protocol, TypeVar

from tmm_cli.language import printed
from tmm_cli.mechanics.linkage import FRAME

if TYPE_CHECKING:
    from tmm_cli.mechanics.structure.assur import Structure


Node = TypeVar("Node", int, str)
FREEDOMS = 3
PIN_FREEDOMS = 2


@dataclass(frozen=True)
class Tie:
    """`constraints` scalar conditions between two bodies, put there by the pair `name`."""

    name: str
    a: str
    b: str
    constraints: int


@dataclass(frozen=True)
class PebbleCount:
    """What the game found.

    free: freedoms left to all bodies together, the root's three excepted. depends: body -> bodies its place depends
    on directly. redundant_pairs: ties with a condition that repeats others, with the bodies that were rigid already.
    under_constrained: bodies that still have a freedom.
    """

    free: int
    depends: dict[str, tuple[str, ...]]
    redundant_pairs: tuple[tuple[Tie, tuple[str, ...]], ...]
    under_constrained: tuple[str, ...]


def reachable_nodes(out: Mapping[Node, Iterable[Node]], *starts: Node) -> dict[Node, None]:
    """All that can be reached from these nodes, themselves included, in the order in which they are met."""
    seen = dict.fromkeys(starts)
    todo = list(starts)
    while todo:
        new = [target for target in out[todo.pop()] if target not in seen]
        seen |= dict.fromkeys(new)
        todo += new
    return seen


class PebbleGame:
    """The (3, 3) pebble game with one root that never moves, and pins that have two pebbles."""

    def __init__(self, bodies: Iterable[str], root: str, pins: Iterable[str]) -> None:
        self.pebbles = dict.fromkeys(bodies, FREEDOMS) | dict.fromkeys(pins, PIN_FREEDOMS)
        self.out: dict[str, list[str]] = {body: [] for body in self.pebbles}
        self.root = root

    def bring(self, to: str, reserved: Mapping[str, int]) -> bool:
        """Move one free pebble to a body along a path of dependence; `reserved` pebbles stay where they are."""
        path = self.path(to, reserved, {to})
        if path is None:
            return False
        self.pebbles[path[-1]] -= 1
        self.pebbles[to] += 1
        for tail, head in pairwise(path):
            self.out[tail].remove(head)
            self.out[head].append(tail)
        return True

    def path(self, start: str, reserved: Mapping[str, int], seen: set[str]) -> list[str] | None:
        """The bodies from this one to a free pebble."""
        for target in self.out[start]:
            if target not in seen:
                seen.add(target)
                rest = [target] if self.pebbles[target] > reserved.get(target, 0) else None
                if rest := rest or self.path(target, reserved, seen):
                    return [start, *rest]
        return None

    def rigid(self, a: str, b: str) -> bool:
        """True if the conditions added so far leave two bodies no motion relative to one another."""
        while self.pebbles[a] + self.pebbles[b] <= FREEDOMS:
            keep = {a: FREEDOMS, b: FREEDOMS}  # their own stay
            if not ((self.pebbles[a] < FREEDOMS and self.bring(a, keep)) or self.bring(b, keep)):
                return True
        return False

    def add(self, a: str, b: str) -> bool:
        """Add one condition between a and b; False when it repeats what already holds."""
        if self.rigid(a, b):
            return False
        tail, head = (a, b) if self.pebbles[a] > 0 and a != self.root else (b, a)
        self.pebbles[tail] -= 1
        self.out[tail].append(head)
        return True

    def settle(self) -> None:
        """Give the root its three pebbles back: it depends on nothing."""
        while self.pebbles[self.root] < FREEDOMS and self.bring(self.root, {}):
            pass


def count_freedoms(bodies: Iterable[str], root: str, ties: Iterable[Tie], pins: Iterable[str] = ()) -> PebbleCount:
    """Play the game over all ties of the bodies and pins (names of pins are none of the bodies')."""
    bodies, pins = tuple(bodies), frozenset(pins)
    game = PebbleGame(bodies, root, pins)
    redundant_pairs = []
    for tie in ties:
        added = [game.add(tie.a, tie.b) for _ in range(tie.constraints)]
        if not all(added):
            redundant_pairs.append((tie, tuple(b for b in reachable_nodes(game.out, tie.a, tie.b) if b not in pins)))
    game.settle()
    free = sum(game.pebbles.values()) - FREEDOMS
    under_constrained = tuple(
        body
        for body in bodies
        if body != root and any(game.pebbles[b] for b in reachable_nodes(game.out, body) if b != root)
    )
    depends = {body: tuple(dict.fromkeys(targets)) for body, targets in game.out.items()}
    return PebbleCount(free, depends, tuple(redundant_pairs), under_constrained)


def rigid_sets(bodies: Iterable[str], ties: Iterable[Tie], pins: Iterable[str] = ()) -> tuple[tuple[str, ...], ...]:
    """Sets of two bodies or more that are rigid to one another by the count.

    Bodies of such a set are joined within it, so only bodies that share a tie or a pin are compared.
    """
    bodies, pins, ties = tuple(bodies), frozenset(pins), tuple(ties)
    game = PebbleGame(bodies, "", pins)
    joined = [(tie.a, tie.b) for tie in ties if pins.isdisjoint((tie.a, tie.b))]
    for pin in pins:
        joined += combinations((tie.b if tie.a == pin else tie.a for tie in ties if pin in (tie.a, tie.b)), 2)
    for tie in ties:
        for _ in range(tie.constraints):
            game.add(tie.a, tie.b)
    together: dict[str, tuple[str, ...]] = {body: (body,) for body in bodies}
    for a, b in joined:
        if together[a] != together[b] and game.rigid(a, b):
            merged = tuple(body for body in bodies if body in together[a] + together[b])
            together |= dict.fromkeys(merged, merged)
    return tuple(dict.fromkeys(links for links in together.values() if len(links) > 1))


def dependence_components(depends: dict[str, tuple[str, ...]]) -> Iterator[tuple[str, ...]]:
    """Bodies that depend on one another, part by part, each part after all that it depends on."""
    seen: set[str] = set()

    def visit(body: str) -> Iterator[tuple[str, ...]]:
        alone = seen.isdisjoint(parts[body])
        seen.add(body)
        for target in depends[body]:
            if target not in seen:
                yield from visit(target)
        if alone:  # the first of its part to be met is the last to be left
            yield parts[body]

    needs = {body: reachable_nodes(depends, body) for body in depends}
    parts = {body: tuple(other for other in needs[body] if body in needs[other]) for body in depends}
    for body in depends:
        if body not in seen:
            yield from visit(body)


# Independent contours of a chain, and how a linkage is classed by them and by its groups.
#
# A contour is independent when it has a pair that no other of the list has: K = p - n of them, one for every pair that
# is left over when a tree of pairs has reached all links. The tree is grown from the frame, nearest links first, so the
# contours are short and run through the frame where they can.


class AnyPair(Protocol):
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


def find_contours(pairs: Sequence[AnyPair], links: Iterable[str]) -> tuple[Contour, ...]:
    """Independent contours of the links that pairs join to the frame; `links` says in which order they are named."""
    ways = _shortest_paths(pairs)
    rank = {link: number for number, link in enumerate((FRAME, *links))}
    found = []
    for pair in pairs:
        if pair.i not in ways or pair.j not in ways or pair in (ways[pair.i][0][1], ways[pair.j][0][1]):
            continue  # out of reach, or itself on a way
        one, other = list(ways[pair.i]), list(ways[pair.j])
        while len(one) > 1 and len(other) > 1 and one[-2][0] == other[-2][0]:
            one.pop()
            other.pop()
        if (rank[_second_link(one, other)], len(one) == 1) > (rank[_second_link(other, one)], len(other) == 1):
            one, other = other, one
        # down the one path from the link both have in common, over the pair, back up the other
        names = [link for link, _ in reversed(one)] + [link for link, _ in other[:-1]]
        joints = [p.name for _, p in reversed(one[:-1]) if p] + [pair.name] + [p.name for _, p in other[:-1] if p]
        found.append(Contour(tuple(names), tuple(joints)))
    return tuple(sorted(found, key=lambda c: [rank[link] for link in c.links]))


def classify_linkage(structure: Structure) -> tuple[str, ...]:
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


def links_joined_to_frame(pairs: Sequence[AnyPair]) -> set[str]:
    """The links that some way of pairs joins to the frame, the frame among them."""
    return set(_shortest_paths(pairs))


PathToFrame = list[tuple[str, AnyPair | None]]  # links on the way to the frame, each with the pair that leads on


def _shortest_paths(pairs: Sequence[AnyPair]) -> dict[str, PathToFrame]:
    """The shortest way to the frame of every link that has one."""
    ways: dict[str, PathToFrame] = {FRAME: [(FRAME, None)]}
    todo = [FRAME]
    for link in todo:  # grows while it is walked: nearest links first
        for pair in pairs:
            if link in (pair.i, pair.j):
                after = pair.j if link == pair.i else pair.i
                if after not in ways:
                    ways[after] = [(after, pair), *ways[link]]
                    todo.append(after)
    return ways


def _second_link(path: PathToFrame, other: PathToFrame) -> str:
    """The link after the common one, going down the path and then up the other."""
    return path[-2][0] if len(path) > 1 else other[0][0]
