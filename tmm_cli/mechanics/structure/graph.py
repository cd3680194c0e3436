"""Freedoms of a linkage by the pebble game on its bodies; solving order, contours and classification.

Each link is a body with three freedoms (pebbles), a pair takes two of them, the driver one more. A compound hinge is a
point with two freedoms, the pin, joined to each of its links. The orientation that the game leaves is a directed graph
of dependence: its strongly connected components are the Assur groups, in solving order.
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
    """Connection of two bodies by `constraints` scalar conditions of the pair `name`."""

    name: str
    a: str
    b: str
    constraints: int


@dataclass(frozen=True)
class PebbleCount:
    """Result of the pebble game.

    Attributes:
        free: freedoms left to all bodies together, without the three of the root.
        depends: for each body, the bodies on whose positions its position directly depends.
        redundant_pairs: ties with a redundant condition, each with the bodies that were already rigid.
        under_constrained: bodies that still have a freedom.
    """

    free: int
    depends: dict[str, tuple[str, ...]]
    redundant_pairs: tuple[tuple[Tie, tuple[str, ...]], ...]
    under_constrained: tuple[str, ...]


def reachable_nodes(out: Mapping[Node, Iterable[Node]], *starts: Node) -> dict[Node, None]:
    """Return all nodes that can be reached from the given ones, these included, in the order of the search."""
    seen = dict.fromkeys(starts)
    todo = list(starts)
    while todo:
        new = [target for target in out[todo.pop()] if target not in seen]
        seen |= dict.fromkeys(new)
        todo += new
    return seen


class PebbleGame:
    """The (3, 3) pebble game with a root that never moves, and with pins that have two pebbles."""

    def __init__(self, bodies: Iterable[str], root: str, pins: Iterable[str]) -> None:
        self.pebbles = dict.fromkeys(bodies, FREEDOMS) | dict.fromkeys(pins, PIN_FREEDOMS)
        self.out: dict[str, list[str]] = {body: [] for body in self.pebbles}
        self.root = root

    def bring(self, to: str, reserved: Mapping[str, int]) -> bool:
        """Move a free pebble to a body along a path of dependence; True if one was found. `reserved` pebbles are not
        moved.
        """
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
        """Return a path of bodies from `start` to one with a free pebble, or None."""
        for target in self.out[start]:
            if target not in seen:
                seen.add(target)
                rest = [target] if self.pebbles[target] > reserved.get(target, 0) else None
                if rest := rest or self.path(target, reserved, seen):
                    return [start, *rest]
        return None

    def rigid(self, a: str, b: str) -> bool:
        """Return True if the conditions added so far make two bodies rigid to each other."""
        while self.pebbles[a] + self.pebbles[b] <= FREEDOMS:
            keep = {a: FREEDOMS, b: FREEDOMS}  # their own pebbles stay
            if not ((self.pebbles[a] < FREEDOMS and self.bring(a, keep)) or self.bring(b, keep)):
                return True
        return False

    def add(self, a: str, b: str) -> bool:
        """Add one condition between a and b; return False if it is redundant."""
        if self.rigid(a, b):
            return False
        tail, head = (a, b) if self.pebbles[a] > 0 and a != self.root else (b, a)
        self.pebbles[tail] -= 1
        self.out[tail].append(head)
        return True

    def settle(self) -> None:
        """Return its three pebbles to the root, which depends on nothing."""
        while self.pebbles[self.root] < FREEDOMS and self.bring(self.root, {}):
            pass


def count_freedoms(bodies: Iterable[str], root: str, ties: Iterable[Tie], pins: Iterable[str] = ()) -> PebbleCount:
    """Play the pebble game over all ties of the bodies and pins; names of pins must differ from names of bodies."""
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
    """Return sets of two or more bodies that the count shows to be rigid to one another.

    The bodies of such a set are connected within it, so only bodies that share a tie or a pin are compared.
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
    """Yield sets of bodies that depend on one another, each after all sets that it depends on."""
    seen: set[str] = set()

    def visit(body: str) -> Iterator[tuple[str, ...]]:
        alone = seen.isdisjoint(parts[body])
        seen.add(body)
        for target in depends[body]:
            if target not in seen:
                yield from visit(target)
        if alone:  # the first body of a component to be visited is the last to be left
            yield parts[body]

    needs = {body: reachable_nodes(depends, body) for body in depends}
    parts = {body: tuple(other for other in needs[body] if body in needs[other]) for body in depends}
    for body in depends:
        if body not in seen:
            yield from visit(body)


# Independent contours of a chain, and classification of a linkage by them and by its groups.
#
# A contour is independent if it contains a pair that no other contour of the list contains: K = p - n contours, one for
# every pair that is not in a spanning tree. The tree is grown from the frame, nearest links first, so the contours are
# short and contain the frame where possible.


class AnyPair(Protocol):
    """A pair of two links, planar or spatial."""

    @property
    def name(self) -> str: ...
    @property
    def i(self) -> str: ...
    @property
    def j(self) -> str: ...


@dataclass(frozen=True)
class Contour:
    """A closed contour: its links in order, from the one nearest the frame, and the pairs between them."""

    links: tuple[str, ...]
    pairs: tuple[str, ...]

    @property
    def title(self) -> str:
        """Links of the contour, e.g. 0-1-2-3-0."""
        return "-".join(map(printed, (*self.links, self.links[0])))


def find_contours(pairs: Sequence[AnyPair], links: Iterable[str]) -> tuple[Contour, ...]:
    """Return the independent contours of the links that the pairs join to the frame, in the order of `links`."""
    ways = _shortest_paths(pairs)
    rank = {link: number for number, link in enumerate((FRAME, *links))}
    independent = []
    for pair in pairs:
        if pair.i not in ways or pair.j not in ways or pair in (ways[pair.i][0][1], ways[pair.j][0][1]):
            continue  # not connected to the frame, or in the tree
        path, other_path = list(ways[pair.i]), list(ways[pair.j])
        while len(path) > 1 and len(other_path) > 1 and path[-2][0] == other_path[-2][0]:
            path.pop()
            other_path.pop()
        if (rank[_second_link(path, other_path)], len(path) == 1) > (
            rank[_second_link(other_path, path)],
            len(other_path) == 1,
        ):
            path, other_path = other_path, path
        # from the common link down one path, over the pair, and back up the other
        names = [link for link, _ in reversed(path)] + [link for link, _ in other_path[:-1]]
        joints = [p.name for _, p in reversed(path[:-1]) if p] + [pair.name] + [p.name for _, p in other_path[:-1] if p]
        independent.append(Contour(tuple(names), tuple(joints)))
    return tuple(sorted(independent, key=lambda c: [rank[link] for link in c.links]))


def classify_linkage(structure: Structure) -> tuple[str, ...]:
    """Classify a linkage: closed or open; elementary, simple or complex; groups of one type or of several.

    Elementary: the driver alone; simple: with one group; complex: with two or more groups. Combined: some groups are of
    the same type, others are not.
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
    """Return True if the contour is redundant: it contains a redundant link or pair."""
    pairs = {redundant.pair for redundant in structure.reduction.pairs if not redundant.left}
    return not structure.reduction.removed.isdisjoint(contour.links) or not pairs.isdisjoint(contour.pairs)


def links_joined_to_frame(pairs: Sequence[AnyPair]) -> set[str]:
    """Return the links that a path of pairs joins to the frame, including the frame."""
    return set(_shortest_paths(pairs))


PathToFrame = list[tuple[str, AnyPair | None]]  # links on the path to the frame, each with the next pair


def _shortest_paths(pairs: Sequence[AnyPair]) -> dict[str, PathToFrame]:
    """Return the shortest path to the frame for every link that has one."""
    ways: dict[str, PathToFrame] = {FRAME: [(FRAME, None)]}
    todo = [FRAME]
    for link in todo:  # the list grows during the loop: nearest links first
        for pair in pairs:
            if link in (pair.i, pair.j):
                after = pair.j if link == pair.i else pair.i
                if after not in ways:
                    ways[after] = [(after, pair), *ways[link]]
                    todo.append(after)
    return ways


def _second_link(path: PathToFrame, other: PathToFrame) -> str:
    """Return the link after the common one, down `path` and then up `other`."""
    return path[-2][0] if len(path) > 1 else other[0][0]
