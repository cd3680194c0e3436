"""Kinematic pairs and Assur groups, the class of a group, and the reduction of redundant links and pairs.

Class after I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 3: a group of two links is of class II. The class
of any other group is the number of sides of its largest closed contour of internal pairs, or, if it has no contour, the
largest number of internal pairs on one link.
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
    """Return the class of an Assur group (2 or more) after I. I. Artobolevsky.

    A higher pair counts as a link with two hinges. The two links of a driven pair count as one link.

    Args:
        bodies: links of the group; links that are rigid to one another are in one tuple.
        inner, outer: internal and external pairs.
        drivers: drivers between two links of the group.
        as_higher: names of lower pairs that count as higher pairs.
    """
    representative = {name: links[0] for links in bodies for name in links}
    for driver in drivers:
        if driver.base in representative:
            keep, gone = representative[driver.base], representative[driver.link]
            representative = {name: keep if as_one == gone else as_one for name, as_one in representative.items()}
    replaced = list(dict.fromkeys(representative.values()))
    joints: list[tuple[str, str]] = []
    for pair in (*inner, *outer):
        ends = [representative[link] for link in (pair.i, pair.j) if link in representative]
        if not pair.lower or pair.name in as_higher:
            replaced.append(f"tooth {pair.name}")
            joints += [(end, replaced[-1]) for end in ends]
        elif len(set(ends)) == 2:
            joints.append((ends[0], ends[1]))
    if len(replaced) <= 2:
        return 2
    return max(3, _largest_contour(replaced, joints), *(sum(body in joint for joint in joints) for body in replaced))


def _largest_contour(links: list[str], inner: list[tuple[str, str]]) -> int:
    """Return the number of sides of the largest closed contour of internal pairs, by a search of simple cycles."""
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


# Reduction: the structural report leaves out redundant links and pairs, and counts rigid sets of links as one.
#
# Kinematics and forces keep all links. The Assur groups of the report are those of the remaining links, so that for
# each of them 3n - 2p1 - p2 = 0. I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 2, on redundant
# constraints.


@dataclass(frozen=True)
class RigidSet:
    """Links that cannot move relative to one another and count as one link; the frame may be among them.

    Attributes:
        links: names of the links.
        constraints: number of redundant constraints within the set.
    """

    links: tuple[str, ...]
    constraints: int = 0


@dataclass(frozen=True)
class RedundantLink:
    """A redundant link, or several redundant links that cannot move relative to one another.

    Attributes:
        links: names of the links.
        constraints: number of redundant constraints that they add.
    """

    links: tuple[str, ...]
    constraints: int


@dataclass(frozen=True)
class RedundantPair:
    """A pair with redundant constraints.

    Attributes:
        pair: name of the pair.
        constraints: number of its redundant constraints.
        left: number of constraints that are not redundant. A lower pair with one such constraint counts as a higher
            pair.
    """

    pair: str
    constraints: int
    left: int = 0


@dataclass(frozen=True)
class Reduction:
    """Links, pairs and conditions that the structural report leaves out.

    Below, a body is a link, or a set of links that are rigid to one another.

    Attributes:
        rigid: sets of links that are rigid to one another; each set counts as one link.
        links: redundant links.
        conditions: number of redundant conditions of a tie, by the index of the tie in `list_ties`.
        pairs: pairs with these redundant conditions.
    """

    rigid: tuple[RigidSet, ...] = ()
    links: tuple[RedundantLink, ...] = ()
    conditions: Mapping[int, int] = field(default_factory=dict, hash=False)
    pairs: tuple[RedundantPair, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.rigid or self.links or self.conditions)

    @cached_property
    def removed(self) -> frozenset[str]:
        """Names of all redundant links, which the structural report leaves out."""
        return frozenset(name for redundant in self.links for name in redundant.links)

    @cached_property
    def _representative(self) -> dict[str, str]:
        first = {rigid: FRAME if FRAME in rigid.links else rigid.links[0] for rigid in self.rigid}
        return {link: first[rigid] for rigid in self.rigid for link in rigid.links}

    def body(self, link: str) -> str:
        """Return the name of the body to which a link belongs. Names that are not links (pins) are returned
        unchanged.
        """
        return self._representative.get(link, link)

    def members(self, body: str) -> tuple[str, ...]:
        """Return the names of the links of a body."""
        return next((rigid.links for rigid in self.rigid if self.body(rigid.links[0]) == body), (body,))

    def bodies(self, links: Iterable[str]) -> tuple[str, ...]:
        """Return the bodies of these links, without redundant links."""
        return tuple(dict.fromkeys(self.body(link) for link in links if link not in self.removed))

    def within(self, ties: Sequence[Tie]) -> frozenset[int]:
        """Return the indices of ties that do not join different bodies.

        They lie within a rigid set, or join several of its links to the same pin.
        """
        ends = [(tie.name, self.body(tie.a), self.body(tie.b)) for tie in ties]
        return frozenset(k for k, (name, a, b) in enumerate(ends) if a == b or ends.count((name, a, b)) > 1)

    def touched(self, ties: Sequence[Tie]) -> frozenset[int]:
        """Return the indices of the ties that the structural report does not contain.

        They lie within sets of links that are rigid to one another, or belong to redundant links.
        """
        removed = (k for k, tie in enumerate(ties) if not self.removed.isdisjoint((tie.a, tie.b)))
        return self.within(ties) | {*removed}

    def ties(self, ties: Iterable[Tie]) -> Iterator[Tie]:
        """Yield the ties between the bodies of the structural report, without redundant conditions."""
        joined = set()
        for number, tie in enumerate(ties):
            a, b, left = self.body(tie.a), self.body(tie.b), tie.constraints - self.conditions.get(number, 0)
            if left and a != b and self.removed.isdisjoint((tie.a, tie.b)) and (tie.name, a, b) not in joined:
                joined.add((tie.name, a, b))
                yield Tie(tie.name, a, b, left)

    def reduced_pairs(
        self, linkage: Linkage, pairs: Sequence[Pair], rank: Mapping[str, int], ties: Sequence[Tie]
    ) -> Iterator[Pair]:
        """Yield the kinematic pairs between the bodies of the structural report.

        An existing pair is used wherever it joins two of these bodies.

        Args:
            linkage: the linkage.
            pairs: pairs of all links.
            rank: index of the group of each remaining link, in solving order.
            ties: the remaining ties, from `ties()`.
        """
        tied = {(tie.name, end) for tie in ties for end in (tie.a, tie.b)}
        for hinge in linkage.hinges:
            pairs_of_hinge = [pair for pair in pairs if pair.point == hinge.point and pair.slide is None]
            links = [n for n in hinge.links if n in rank and (hinge.point, self.body(n)) in tied]
            first = {body: next(n for n in links if self.body(n) == body) for body in self.bodies(links)}
            if len(first) < 2:
                continue
            ends = {pair: {self.body(pair.i), self.body(pair.j)} for pair in pairs_of_hinge}
            lowest = min(rank[n] for n in links)
            centre = max(
                (body for body in first if rank[first[body]] == lowest or body == self.body(hinge.attached_to)),
                key=lambda body: sum(body in both for both in ends.values()),
            )
            spare = [pair for pair in pairs_of_hinge if not ends[pair] <= {*first} or centre not in ends[pair]]
            for body, link in first.items():
                if body != centre:
                    joined = next((pair for pair in pairs_of_hinge if ends[pair] == {centre, body}), None)
                    yield joined or replace(spare.pop(0), i=first[centre], j=link)
        for pair in pairs:
            hinged = pair.slide is None and pair.mesh is None
            if not hinged and pair.i in rank and pair.j in rank and (pair.name, self.body(pair.i)) in tied:
                yield pair

    def pair_of(self, tie: Tie, pairs: Iterable[Pair]) -> Pair | None:
        """Return the kinematic pair of a tie, or None if there is none.

        For a tie of a compound hinge it is the pair that attaches the link of the tie.
        """
        ends = {self.body(tie.a), self.body(tie.b)}
        candidates = (pair for pair in pairs if tie.name == (pair.name if pair.slide or pair.mesh else pair.point))
        return next((pair for pair in candidates if ends & {self.body(pair.i), self.body(pair.j)}), None)


NO_REDUCTION = Reduction()


ROMAN = ("0", "I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X")


PAIR_CODES = {
    "R": "1в",
    "P": "1п",
}  # K. S. Alyushin: number of freedoms and the first Russian letter of "rotational" or "translational"
DYAD_NUMBERS = {"RRR": 1, "RRP": 2, "RPR": 3, "PRP": 4, "RPP": 5}  # type numbers of dyads
LOWER_PAIR_KINDS = (
    "R",
    "P",
)  # kinds with one freedom; the others (gears G, racks K, cams C) are higher pairs with two


@dataclass(frozen=True)
class Pair:
    """A kinematic pair of two links.

    Attributes:
        name: name of the pair, e.g. A, or A' for the second pair of a compound hinge.
        kind: R revolute or P prismatic; higher pairs: G two gears, K gear and rack, C cam and follower.
        i, j: names of its links; i is the frame, the carrier of the guide, or the link that is solved first.
        point: name of the hinge point or sliding point; empty for a higher pair.
        slide: data of a prismatic pair, otherwise None.
        mesh: data of a higher pair, otherwise None.
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
        """True for a lower pair (revolute or prismatic), which has one degree of freedom."""
        return self.kind in LOWER_PAIR_KINDS

    @property
    def freedoms(self) -> int:
        """Degrees of freedom in the plane: 1 for a lower pair, 2 for a higher one."""
        return 1 if self.lower else 2

    @property
    def pair_class(self) -> int:
        """Class of the pair, the number of its constraints in space: 5 for a lower pair, 4 for a higher one."""
        return 6 - self.freedoms

    @property
    def code(self) -> str:
        """Code of the pair after K. S. Alyushin: 1в (revolute) or 1п (prismatic); empty for a higher pair."""
        return PAIR_CODES.get(self.kind, "")

    def other(self, link: str) -> str:
        """Return the link that forms this pair with `link`."""
        return self.j if link == self.i else self.i

    def rebind(self, linkage: Linkage) -> Pair:
        """Return a copy of the pair that refers to another linkage, which differs in dimensions only."""
        slide = None if self.slide is None else linkage.slide(self.slide.name)
        mesh = None if self.mesh is None else next(m for m in linkage.meshes if m.name == self.mesh.name)
        return self if slide is None and mesh is None else replace(self, slide=slide, mesh=mesh)


@dataclass(frozen=True)
class Group:
    """An Assur group.

    Attributes:
        links: names of its links.
        inner: internal pairs.
        outer: external pairs, in the order of the links.
        group_class: class of the group, 2 or more.
        type: type of a dyad, e.g. RRP; for other groups the kinds of all pairs; may be empty.
        drivers: drivers between two links of the group (as in a swinging cylinder). Their equations are solved with
            those of the pairs.
        rigid: sets of links that are rigid to one another; each set counts as one link.
        as_higher: names of lower pairs that count as higher pairs, because one of their two conditions is redundant.
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
        """Return the link of the group that takes part in this external pair."""
        return pair.i if pair.i in self.links else pair.j

    @property
    def known(self) -> tuple[str, ...]:
        """Links outside the group to which its external pairs attach it, one for each external pair."""
        return tuple(pair.other(self.own(pair)) for pair in self.outer)

    @property
    def depends_on(self) -> set[str]:
        """Links that must be solved before the group: those to which its external pairs attach it, and carriers of its
        gears.
        """
        meshes = [pair.mesh for pair in (*self.inner, *self.outer) if pair.mesh is not None]
        others = {*self.known, *(mesh.carrier for mesh in meshes), *(driver.base for driver in self.drivers)}
        return others.difference(self.links)

    @property
    def order(self) -> int:
        """Order of the group, the number of its external pairs."""
        return len(self.outer)

    @property
    def bodies(self) -> tuple[tuple[str, ...], ...]:
        """Links of the group, each in a tuple; links that are rigid to one another are in one tuple."""
        return tuple(dict.fromkeys(next((r for r in self.rigid if link in r), (link,)) for link in self.links))

    @property
    def count(self) -> tuple[int, int, int]:
        """Numbers n of links, p1 of lower pairs and p2 of higher pairs, with 3n - 2 p1 - p2 = 0.

        The two links of a driven pair count as one.
        """
        pairs = (*self.inner, *self.outer)
        lower = sum(pair.lower and pair.name not in self.as_higher for pair in pairs)
        driven = len(self.drivers)
        return len(self.bodies) - driven, lower - driven, len(pairs) - lower

    @property
    def mobility(self) -> int:
        """Mobility 3n - 2 p1 - p2, which is zero for an Assur group."""
        n, lower, higher = self.count
        return 3 * n - 2 * lower - higher

    def rebind(self, linkage: Linkage) -> Group:
        """Return a copy of the group that refers to another linkage, which differs in dimensions only."""
        inner, outer = (tuple(pair.rebind(linkage) for pair in pairs) for pairs in (self.inner, self.outer))
        drivers = tuple(d for driver in self.drivers for d in linkage.drivers if d.link == driver.link)
        return replace(self, inner=inner, outer=outer, drivers=drivers)

    @property
    def type_number(self) -> int | None:
        """Number (1 to 5) of the type of a dyad; None for any other group."""
        return DYAD_NUMBERS.get(self.type)

    @property
    def letters(self) -> str:
        """Type of a dyad in Russian letters: ВВВ, ВВП, ВПВ, ПВП or ВПП; empty for any other group."""
        return self.type.translate({ord("R"): "В", ord("P"): "П"}) if self.type_number else ""

    @property
    def roman(self) -> str:
        """Class of the group in Roman numerals, at most X."""
        return ROMAN[min(self.group_class, 10)]

    @property
    def title(self) -> str:
        """Class and links of the group as the structural formula shows them, e.g. II(2,3)."""
        return f"{self.roman}({','.join(map('+'.join, self.bodies))})"


@dataclass(frozen=True)
class PairRedundancy:
    """Redundant constraints of a pair: because of special dimensions they repeat constraints of other pairs.

    Attributes:
        pair: name of the pair.
        constraints: number of redundant constraints.
        links: the two links of the pair. The last one is the redundant link, whose position follows without the pair.
        among: all links whose pairs take part in the redundancy.
    """

    pair: str
    constraints: int
    links: tuple[str, str]
    among: tuple[str, ...]
