"""Class of an Assur group after I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 3.

A group of two links is of class II; otherwise the class is the number of sides of its largest closed contour of inner
pairs, or of the inner pairs of its richest link when it has no contour.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Literal

from tmm_cli.mechanics.linkage import FRAME, Driver, Linkage, Mesh, Slide
from tmm_cli.mechanics.structure.graph import Tie


def group_class(
    bodies: Iterable[tuple[str, ...]],
    inner: Iterable[Pair],
    outer: Iterable[Pair],
    drivers: Iterable[Driver],
    as_higher: Collection[str] = (),
) -> int:
    """Class of a group after replacing: a higher pair by a link with two hinges, a driven pair by one rigid link.

    Links of one body are rigid to one another; as_higher: names of lower pairs that count as higher ones.
    """
    one = {name: links[0] for links in bodies for name in links}
    for driver in drivers:
        if driver.base in one:
            keep, gone = one[driver.base], one[driver.link]
            one = {name: keep if as_one == gone else as_one for name, as_one in one.items()}
    replaced = list(dict.fromkeys(one.values()))
    joints: list[tuple[str, str]] = []
    for pair in (*inner, *outer):
        ends = [one[link] for link in (pair.i, pair.j) if link in one]
        if not pair.lower or pair.name in as_higher:
            replaced.append(f"tooth {pair.name}")
            joints += [(end, replaced[-1]) for end in ends]
        elif len(set(ends)) == 2:
            joints.append((ends[0], ends[1]))
    if len(replaced) <= 2:
        return 2
    return max(3, _largest_contour(replaced, joints), *(sum(body in joint for joint in joints) for body in replaced))


def _largest_contour(links: list[str], inner: list[tuple[str, str]]) -> int:
    """Sides of the largest closed contour of inner pairs (groups are small: a plain search of all simple cycles)."""
    joined: dict[str, list[str]] = {link: [] for link in links}
    for i, j in inner:
        joined[i].append(j)
        joined[j].append(i)
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


# What the structural report leaves out: redundant links and pairs; links that are rigid to one another count as one.
#
# Kinematics and forces keep all of them. The Assur groups of the report are split off from what is left, so that for
# each of them 3n - 2p1 - p2 = 0. I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 2, on redundant
# constraints.


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


NO_REDUCTION = Reduction()


ROMAN = ("0", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X")


PAIR_CODES = {
    "R": "1в",
    "P": "1п",
}  # K. S. Alyushin: freedoms, then the first letter of "rotational" or "translational"
DYAD_NUMBERS = {"RRR": 1, "RRP": 2, "RPR": 3, "PRP": 4, "RPP": 5}  # types of a class II group with two links
LOWER_PAIR_KINDS = (
    "R",
    "P",
)  # kinds of lower pairs, with one freedom; the others (teeth G and K, cams C) are higher, with two


@dataclass(frozen=True)
class Pair:
    """A pair of two links. `i` comes first: the frame, the carrier, or the link that is placed earlier.

    kind: R turning, P sliding; higher pairs: G toothed wheels, K wheel and rack, C cam and follower.
    """

    name: str
    kind: Literal["R", "P", "G", "K", "C"]
    i: str
    j: str
    point: str
    slide: Slide | None = None
    mesh: Mesh | None = None

    @property
    def lower(self) -> bool:
        """Whether it leaves one freedom only."""
        return self.kind in LOWER_PAIR_KINDS

    @property
    def freedoms(self) -> int:
        """Relative freedoms in the plane: 1 of a lower pair, 2 of a higher one."""
        return 1 if self.lower else 2

    @property
    def pair_class(self) -> int:
        """The class of the pair in space: 5 for a lower pair, 4 for a higher one."""
        return 6 - self.freedoms

    @property
    def code(self) -> str:
        """1в for a revolute pair, 1п for a prismatic one; empty for a higher pair, which has no code."""
        return PAIR_CODES.get(self.kind, "")

    def other(self, link: str) -> str:
        """The link at the other side."""
        return self.j if link == self.i else self.i

    def rebind(self, linkage: Linkage) -> Pair:
        """The same pair with the numbers of another linkage."""
        slide = None if self.slide is None else linkage.slide(self.slide.name)
        mesh = None if self.mesh is None else next(m for m in linkage.meshes if m.name == self.mesh.name)
        return self if slide is None and mesh is None else replace(self, slide=slide, mesh=mesh)


@dataclass(frozen=True)
class Group:
    """An Assur group: its links, inner and outer pairs (outer in the order of its links), class, order and type.

    drivers: those between its own links (a swinging cylinder), which are rows of the group as its pairs are.
    rigid: links of it that are rigid to one another and count as one. as_higher: names of lower pairs that count as
    higher ones, because one of their two conditions is redundant.
    """

    links: tuple[str, ...]
    inner: tuple[Pair, ...]
    outer: tuple[Pair, ...]
    group_class: int
    type: str
    drivers: tuple[Driver, ...] = ()
    rigid: tuple[tuple[str, ...], ...] = ()
    as_higher: tuple[str, ...] = ()

    def own(self, pair: Pair) -> str:
        """The link of the group in one of its outer pairs."""
        return pair.i if pair.i in self.links else pair.j

    @property
    def known(self) -> tuple[str, ...]:
        """The links that it hangs on, pair by pair."""
        return tuple(pair.other(self.own(pair)) for pair in self.outer)

    @property
    def depends_on(self) -> set[str]:
        """All links that must be placed before the group: its neighbours, and the carriers of its gears."""
        meshes = [pair.mesh for pair in (*self.inner, *self.outer) if pair.mesh is not None]
        others = {*self.known, *(mesh.carrier for mesh in meshes), *(driver.base for driver in self.drivers)}
        return others.difference(self.links)

    @property
    def order(self) -> int:
        """The number of its external pairs."""
        return len(self.outer)

    @property
    def bodies(self) -> tuple[tuple[str, ...], ...]:
        """Its links, those that are rigid to one another together."""
        return tuple(dict.fromkeys(next((r for r in self.rigid if link in r), (link,)) for link in self.links))

    @property
    def count(self) -> tuple[int, int, int]:
        """n, p1, p2 of 3n - 2p1 - p2, which is zero; the two links of a driven pair count as one."""
        pairs = (*self.inner, *self.outer)
        lower = sum(pair.lower and pair.name not in self.as_higher for pair in pairs)
        driven = len(self.drivers)
        return len(self.bodies) - driven, lower - driven, len(pairs) - lower

    @property
    def mobility(self) -> int:
        """3n - 2p1 - p2: zero for an Assur group."""
        n, lower, higher = self.count
        return 3 * n - 2 * lower - higher

    def rebind(self, linkage: Linkage) -> Group:
        """The same group with the numbers of another linkage."""
        inner, outer = (tuple(pair.rebind(linkage) for pair in pairs) for pairs in (self.inner, self.outer))
        drivers = tuple(d for own in self.drivers for d in linkage.drivers if d.link == own.link)
        return replace(self, inner=inner, outer=outer, drivers=drivers)

    @property
    def type_number(self) -> int | None:
        """The number 1 to 5 of the type of a class II group of two links; None for any other group."""
        return DYAD_NUMBERS.get(self.type)

    @property
    def letters(self) -> str:
        """The type of such a group in Russian letters: ВВВ, ВВП, ВПВ, ПВП or ВПП; empty for any other group."""
        return self.type.translate({ord("R"): "В", ord("P"): "П"}) if self.type_number else ""

    @property
    def roman(self) -> str:
        """Its class as it is written; those above the tenth, which nobody has met, as the tenth."""
        return ROMAN[min(self.group_class, 10)]

    @property
    def title(self) -> str:
        """II(2,3): class and links, as the formula of structure writes it."""
        return f"{self.roman}({','.join(map('+'.join, self.bodies))})"


@dataclass(frozen=True)
class PairRedundancy:
    """Passive constraints in a pair: its conditions that only repeat others, by special dimensions.

    links: the two that the pair joins, the passive one (whose place follows without it) last. among: all links that are
    held twice by each other.
    """

    pair: str
    constraints: int
    links: tuple[str, str]
    among: tuple[str, ...]
