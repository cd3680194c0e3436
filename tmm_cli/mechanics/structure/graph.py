"""Degrees of freedom of a linkage by the pebble game; solving order, contours and classification.

Each link is a body with three degrees of freedom (pebbles); a pair takes two of them, a driver one more. A compound
hinge is a point with two degrees of freedom, the pin, which is joined to each of its links. The game ends with a
directed graph that shows which body depends on which. Its strongly connected components are the Assur groups, in
solving order. Source: A. Sljoka, O. Shai, W. Whiteley, Checking mobility and decomposition of linkages via pebble game
algorithm, ASME DETC 2011, sections 3 and 4. The count 3n - 2p for every sub-chain is the (3, 3) game of A. Lee and I.
Streinu, Pebble game algorithms and sparse graphs, Discrete Mathematics 308 (2008).
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
    """A connection of two bodies.

    Attributes:
        name: name of the kinematic pair.
        a, b: names of the bodies (links, or pins of compound hinges).
        constraints: number of scalar conditions that it imposes on their relative motion.
    """

    name: str
    a: str
    b: str
    constraints: int


@dataclass(frozen=True)
class PebbleCount:
    """Result of the pebble game.

    Attributes:
        free: degrees of freedom of all bodies together, relative to the root, the body that never moves.
        depends: for each body, the bodies on whose positions its position directly depends.
        redundant_pairs: ties with a redundant condition, each with the bodies that are rigid to one another without it.
        under_constrained: bodies that can still move.
    """

    free: int
    depends: dict[str, tuple[str, ...]]
    redundant_pairs: tuple[tuple[Tie, tuple[str, ...]], ...]
    under_constrained: tuple[str, ...]


def reachable_nodes(out: Mapping[Node, Iterable[Node]], *starts: Node) -> dict[Node, None]:
    """Return all nodes of a directed graph that can be reached from `starts`, these included, in search order.

    out: successors of each node.
    """
    seen = dict.fromkeys(starts)
    todo = list(starts)
    while todo:
        new = [target for target in out[todo.pop()] if target not in seen]
        seen |= dict.fromkeys(new)
        todo += new
    return seen


class PebbleGame:
    """The (3, 3) pebble game.

    One of the bodies, the root, never moves. Bodies have three pebbles (degrees of freedom), pins of compound hinges
    two.
    """

    def __init__(self, bodies: Iterable[str], root: str, pins: Iterable[str]) -> None:
        self.pebbles = dict.fromkeys(bodies, FREEDOMS) | dict.fromkeys(pins, PIN_FREEDOMS)
        self.out: dict[str, list[str]] = {body: [] for body in self.pebbles}
        self.root = root

    def move_pebble(self, to: str, reserved: Mapping[str, int]) -> bool:
        """Move a free pebble to a body along a path of dependence. Returns False if no pebble can be moved.

        reserved: for each body, number of its pebbles that must not be moved.
        """
        path = self.find_path(to, reserved, {to})
        if path is None:
            return False
        self.pebbles[path[-1]] -= 1
        self.pebbles[to] += 1
        for tail, head in pairwise(path):
            self.out[tail].remove(head)
            self.out[head].append(tail)
        return True

    def find_path(self, start: str, reserved: Mapping[str, int], seen: set[str]) -> list[str] | None:
        """Find a path of dependence from `start` to a body with a free pebble; None if there is no such path."""
        for target in self.out[start]:
            if target not in seen:
                seen.add(target)
                rest = [target] if self.pebbles[target] > reserved.get(target, 0) else None
                if rest := rest or self.find_path(target, reserved, seen):
                    return [start, *rest]
        return None

    def rigid(self, a: str, b: str) -> bool:
        """Return True if the conditions added so far make bodies a and b rigid to each other."""
        while self.pebbles[a] + self.pebbles[b] <= FREEDOMS:
            keep = {a: FREEDOMS, b: FREEDOMS}  # their own pebbles stay
            if not ((self.pebbles[a] < FREEDOMS and self.move_pebble(a, keep)) or self.move_pebble(b, keep)):
                return True
        return False

    def add(self, a: str, b: str) -> bool:
        """Add one scalar condition between bodies a and b. Returns False if it is redundant and was not added."""
        if self.rigid(a, b):
            return False
        tail, head = (a, b) if self.pebbles[a] > 0 and a != self.root else (b, a)
        self.pebbles[tail] -= 1
        self.out[tail].append(head)
        return True

    def settle(self) -> None:
        """Move three pebbles to the root. After that the root depends on no other body."""
        while self.pebbles[self.root] < FREEDOMS and self.move_pebble(self.root, {}):
            pass


def count_freedoms(bodies: Iterable[str], root: str, ties: Iterable[Tie], pins: Iterable[str] = ()) -> PebbleCount:
    """Count the degrees of freedom of bodies and pins joined by ties, by the pebble game.

    Names of pins must differ from names of bodies.
    """
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
    """Find sets of two or more bodies that are rigid to one another, by counting their conditions.

    Such a set is always connected by its own ties, so only bodies that share a tie or a pin are compared.
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
    """Yield sets of bodies that depend on one another (strongly connected components), in solving order."""
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
    """A kinematic pair, planar or spatial, with the names of the pair and of its two links."""

    @property
    def name(self) -> str: ...
    @property
    def i(self) -> str: ...
    @property
    def j(self) -> str: ...


@dataclass(frozen=True)
class Contour:
    """A closed contour of a kinematic chain.

    Attributes:
        links: names of its links in order, from the one nearest the frame.
        pairs: names of the pairs between successive links; the last pair closes the contour.
    """

    links: tuple[str, ...]
    pairs: tuple[str, ...]

    @property
    def title(self) -> str:
        """Links of the contour in order, e.g. 0-1-2-3-0."""
        return "-".join(map(printed, (*self.links, self.links[0])))


def find_contours(pairs: Sequence[AnyPair], links: Iterable[str]) -> tuple[Contour, ...]:
    """Find the independent closed contours of the part of the chain that is connected to the frame.

    They are sorted by their links, in the order of `links`.
    """
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
    """Classify a linkage as open or closed, and by the number and types of its Assur groups.

    Elementary: only the driver. Simple: one group. Complex: two or more groups; these are of the same type, of several
    types, or combined (some of the same type, others not).

    Returns:
        The words that apply, e.g. ("closed", "complex", "same type").
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
    """Return True if a contour contains a redundant link or pair, so that its closure is not an independent
    condition.
    """
    pairs = {redundant.pair for redundant in structure.reduction.pairs if not redundant.left}
    return not structure.reduction.removed.isdisjoint(contour.links) or not pairs.isdisjoint(contour.pairs)


def links_joined_to_frame(pairs: Sequence[AnyPair]) -> set[str]:
    """Return the links that are connected to the frame, directly or through other links; the frame is included."""
    return set(_shortest_paths(pairs))


PathToFrame = list[tuple[str, AnyPair | None]]  # links on the path to the frame, each with the next pair


def _shortest_paths(pairs: Sequence[AnyPair]) -> dict[str, PathToFrame]:
    """Find the shortest path to the frame from every link that is connected to it."""
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
    """Return the link that follows the last common link of two paths to the frame, along the first path.

    If the first path consists of the common link alone, the first link of the other path is returned.
    """
    return path[-2][0] if len(path) > 1 else other[0][0]
