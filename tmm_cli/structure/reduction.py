"""What the structural report leaves out: redundant links and pairs; links that are rigid to one another count as one.

Kinematics and forces keep all of them. The Assur groups of the report are split off from what is left, so that for each
of them 3n - 2p1 - p2 = 0. I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 2, on redundant constraints.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

from tmm_cli.linkage import FRAME
from tmm_cli.structure.graph import Tie

if TYPE_CHECKING:
    from tmm_cli.linkage import Linkage
    from tmm_cli.structure.assur import Pair


@dataclass(frozen=True)
class RigidSet:
    """Links that are rigid to one another, the frame too; constraints: how many of theirs are redundant."""

    links: tuple[str, ...]
    constraints: int = 0


@dataclass(frozen=True)
class RedundantLink:
    """A redundant link (or links that are rigid to one another), and the redundant constraints it adds."""

    links: tuple[str, ...]
    constraints: int


@dataclass(frozen=True)
class RedundantPair:
    """A pair with redundant constraints; with one constraint left it counts as a higher pair."""

    pair: str
    constraints: int
    left: int = 0


@dataclass(frozen=True)
class Reduction:
    """Rigid sets, redundant links, and how many conditions of which tie (by its number in ties_of) are redundant.

    `pairs` names the pairs of those ties.
    """

    rigid: tuple[RigidSet, ...] = ()
    links: tuple[RedundantLink, ...] = ()
    conditions: Mapping[int, int] = field(default_factory=dict, hash=False)
    pairs: tuple[RedundantPair, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.rigid or self.links or self.conditions)

    @cached_property
    def removed(self) -> frozenset[str]:
        """All redundant links."""
        return frozenset(name for redundant in self.links for name in redundant.links)

    @cached_property
    def _representative(self) -> dict[str, str]:
        first = {rigid: FRAME if FRAME in rigid.links else rigid.links[0] for rigid in self.rigid}
        return {link: first[rigid] for rigid in self.rigid for link in rigid.links}

    def body(self, link: str) -> str:
        """The body that a link belongs to, by the name of its first link; a name of something else (a pin) stays."""
        return self._representative.get(link, link)

    def members(self, body: str) -> tuple[str, ...]:
        """The links of a body."""
        return next((rigid.links for rigid in self.rigid if self.body(rigid.links[0]) == body), (body,))

    def bodies(self, links: Iterable[str]) -> tuple[str, ...]:
        """The bodies that are left of these links."""
        return tuple(dict.fromkeys(self.body(link) for link in links if link not in self.removed))

    def within(self, ties: Sequence[Tie]) -> frozenset[int]:
        """The numbers of the ties within rigid sets; in a compound hinge those of several links of one set."""
        ends = [(tie.name, self.body(tie.a), self.body(tie.b)) for tie in ties]
        return frozenset(k for k, (name, a, b) in enumerate(ends) if a == b or ends.count((name, a, b)) > 1)

    def touched(self, ties: Sequence[Tie]) -> frozenset[int]:
        """The numbers of the ties within rigid sets and of those of redundant links."""
        removed = (k for k, tie in enumerate(ties) if not self.removed.isdisjoint((tie.a, tie.b)))
        return self.within(ties) | {*removed}

    def ties(self, ties: Iterable[Tie]) -> Iterator[Tie]:
        """The ties between the bodies that are left, with the conditions that are left."""
        joined = set()
        for number, tie in enumerate(ties):
            a, b, left = self.body(tie.a), self.body(tie.b), tie.constraints - self.conditions.get(number, 0)
            if left and a != b and self.removed.isdisjoint((tie.a, tie.b)) and (tie.name, a, b) not in joined:
                joined.add((tie.name, a, b))
                yield Tie(tie.name, a, b, left)

    def reduced_pairs(
        self, linkage: Linkage, pairs: Sequence[Pair], rank: Mapping[str, int], ties: Sequence[Tie]
    ) -> Iterator[Pair]:
        """The pairs between the bodies that are left, of `pairs` where these join the same bodies.

        Args:
            rank: the number of a link's group in solving order, of the links that are left.
            ties: what ties() gives.
        """
        tied = {(tie.name, end) for tie in ties for end in (tie.a, tie.b)}
        for hinge in linkage.hinges:
            here = [pair for pair in pairs if pair.point == hinge.point and pair.slide is None]
            links = [n for n in hinge.links if n in rank and (hinge.point, self.body(n)) in tied]
            first = {body: next(n for n in links if self.body(n) == body) for body in self.bodies(links)}
            if len(first) < 2:
                continue
            ends = {pair: {self.body(pair.i), self.body(pair.j)} for pair in here}
            lowest = min(rank[n] for n in links)
            centre = max(
                (body for body in first if rank[first[body]] == lowest or body == self.body(hinge.attached_to)),
                key=lambda body: sum(body in both for both in ends.values()),
            )
            spare = [pair for pair in here if not ends[pair] <= {*first} or centre not in ends[pair]]
            for body, link in first.items():
                if body != centre:
                    joined = next((pair for pair in here if ends[pair] == {centre, body}), None)
                    yield joined or replace(spare.pop(0), i=first[centre], j=link)
        for pair in pairs:
            hinged = pair.slide is None and pair.mesh is None
            if not hinged and pair.i in rank and pair.j in rank and (pair.name, self.body(pair.i)) in tied:
                yield pair

    def pair_of(self, tie: Tie, pairs: Iterable[Pair]) -> Pair | None:
        """The pair that a tie stands for; in a compound hinge the one that attaches its link."""
        ends = {self.body(tie.a), self.body(tie.b)}
        here = (pair for pair in pairs if tie.name == (pair.name if pair.slide or pair.mesh else pair.point))
        return next((pair for pair in here if ends & {self.body(pair.i), self.body(pair.j)}), None)


NOTHING = Reduction()
