"""Counting freedoms: the pebble game on bodies, and what it says of mobility and solving order.

Each link is a body with three freedoms (pebbles), a pair takes two of them, the driver one more. A compound hinge is
a point with two freedoms, the pin, joined to each of its links. The orientation that the game leaves is a map of
dependence: its strongly connected components are the Assur groups, in solving order.
Source: A. Sljoka, O. Shai, W. Whiteley, Checking mobility and decomposition of linkages via pebble game algorithm,
ASME DETC 2011, sections 3 and 4; the count 3n - 2p for all sub-chains is the (3, 3) game of A. Lee and I. Streinu,
Pebble game algorithms and sparse graphs, Discrete Mathematics 308 (2008).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise

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
class Count:
    """What the game found.

    free: freedoms left to all bodies together, the root's three excepted. depends: body -> bodies its place depends
    on directly. redundant_pairs: ties with a condition that repeats others, with the bodies that were rigid already.
    under_constrained: bodies that still have a freedom.
    """

    free: int
    depends: dict[str, tuple[str, ...]]
    redundant_pairs: tuple[tuple[Tie, tuple[str, ...]], ...]
    under_constrained: tuple[str, ...]


class PebbleGame:
    """The (3, 3) pebble game with one root that never moves, and pins that have two pebbles."""

    def __init__(self, bodies: Iterable[str], root: str, pins: Iterable[str]) -> None:
        self.pebbles = dict.fromkeys(bodies, FREEDOMS) | dict.fromkeys(pins, PIN_FREEDOMS)
        self.out: dict[str, list[str]] = {body: [] for body in self.pebbles}
        self.root = root

    def bring(self, to: str, reserved: Mapping[str, int]) -> bool:
        """Move one free pebble to a body along a path of dependence; `reserved` pebbles stay where they are."""
        seen = {to}
        stack = [(to, iter(self.out[to]))]
        path = [to]
        while stack:
            targets = stack[-1][1]
            for target in targets:
                if target in seen:
                    continue
                seen.add(target)
                path.append(target)
                if self.pebbles[target] > reserved.get(target, 0):
                    self.pebbles[target] -= 1
                    self.pebbles[to] += 1
                    for tail, head in pairwise(path):
                        self.out[tail].remove(head)
                        self.out[head].append(tail)
                    return True
                stack.append((target, iter(self.out[target])))
                break
            else:
                stack.pop()
                path.pop()
        return False

    def add(self, a: str, b: str) -> bool:
        """Add one condition between a and b; False when it repeats what already holds."""
        while self.pebbles[a] + self.pebbles[b] <= FREEDOMS:
            keep = {a: FREEDOMS, b: FREEDOMS}  # their own stay
            if not ((self.pebbles[a] < FREEDOMS and self.bring(a, keep)) or self.bring(b, keep)):
                return False
        tail, head = (a, b) if self.pebbles[a] > 0 and a != self.root else (b, a)
        self.pebbles[tail] -= 1
        self.out[tail].append(head)
        return True

    def reach(self, *starts: str) -> tuple[str, ...]:
        """All that the given bodies depend on, themselves included."""
        seen = dict.fromkeys(starts)
        todo = list(starts)
        while todo:
            for target in self.out[todo.pop()]:
                if target not in seen:
                    seen[target] = None
                    todo.append(target)
        return tuple(seen)

    def settle(self) -> None:
        """Give the root its three pebbles back: it depends on nothing."""
        while self.pebbles[self.root] < FREEDOMS and self.bring(self.root, {}):
            pass


def count(bodies: Iterable[str], root: str, ties: Iterable[Tie], pins: Iterable[str] = ()) -> Count:
    """Play the game over all ties of the bodies and pins (names of pins are none of the bodies')."""
    bodies, pins = tuple(bodies), frozenset(pins)
    game = PebbleGame(bodies, root, pins)
    redundant_pairs = []
    for tie in ties:
        added = [game.add(tie.a, tie.b) for _ in range(tie.constraints)]
        if not all(added):
            redundant_pairs.append((tie, tuple(b for b in game.reach(tie.a, tie.b) if b not in pins)))
    game.settle()
    free = sum(game.pebbles.values()) - FREEDOMS
    under_constrained = tuple(
        body for body in bodies if body != root and any(game.pebbles[b] for b in game.reach(body) if b != root)
    )
    depends = {body: tuple(dict.fromkeys(targets)) for body, targets in game.out.items()}
    return Count(free, depends, tuple(redundant_pairs), under_constrained)


def components(depends: dict[str, tuple[str, ...]]) -> Iterator[tuple[str, ...]]:
    """Strongly connected components, each after all that it depends on (R. Tarjan 1972), without recursion."""
    index: dict[str, int] = {}
    low: dict[str, int] = {}
    held: list[str] = []
    on_hold: set[str] = set()
    for start in depends:
        if start in index:
            continue
        work = [(start, iter(depends[start]))]
        index[start] = low[start] = len(index)
        held.append(start)
        on_hold.add(start)
        while work:
            body, targets = work[-1]
            for target in targets:
                if target not in index:
                    index[target] = low[target] = len(index)
                    held.append(target)
                    on_hold.add(target)
                    work.append((target, iter(depends[target])))
                    break
                if target in on_hold:
                    low[body] = min(low[body], index[target])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[body])
                if low[body] == index[body]:
                    at = held.index(body)
                    found = tuple(held[at:])
                    del held[at:]
                    on_hold.difference_update(found)
                    yield found
