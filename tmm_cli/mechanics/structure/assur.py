"""Mobility, kinematic pairs and Assur groups of a linkage, from the connections of its links alone.

A compound hinge of n links counts as n - 1 pairs. The order of a group is the number of its external pairs; its class
is explained in `group_class`. The structural report lists the groups that remain without redundant links and pairs (see
Reduction); kinematics solves groups of all links.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from tmm_cli.language import printed
from tmm_cli.mechanics.linkage import FRAME, Driver, Hinge, Linkage
from tmm_cli.mechanics.structure.graph import PebbleCount, Tie, count_freedoms, dependence_components, rigid_sets
from tmm_cli.mechanics.structure.group import (
    NO_REDUCTION,
    ROMAN,
    Group,
    Pair,
    PairRedundancy,
    Reduction,
    RedundantPair,
    RigidSet,
    group_class,
)

HIGHER_PAIR_KINDS: dict[str, Literal["G", "K", "C"]] = {"gear": "G", "rack": "K", "cam": "C"}


@dataclass(frozen=True)
class Structure:
    """Structure of a linkage.

    Attributes:
        links: names of the moving links.
        pairs: all kinematic pairs.
        drivers: the drivers.
        groups: Assur groups of the structural report, in solving order.
        mobility: W = 3n - 2 p1 - p2 (Chebyshev).
        freedom: degrees of freedom by the pebble game, which counts every part of the linkage. They equal the mobility
            unless a part is overconstrained.
        under_constrained: links that can still move when the drivers are fixed.
        redundant_pairs: pairs with a redundant condition, each with the links that are rigid to one another without it.
        passive: redundant constraints found by numerical rank; the true mobility is greater than W by their number.
        all_groups: Assur groups of all links, in solving order.
        reduction: links and pairs that the structural report leaves out.
    """

    links: tuple[str, ...]
    pairs: tuple[Pair, ...]
    drivers: tuple[Driver, ...]
    groups: tuple[Group, ...]
    mobility: int
    freedom: int
    under_constrained: tuple[str, ...] = ()
    redundant_pairs: tuple[tuple[str, tuple[str, ...]], ...] = ()
    passive: tuple[PairRedundancy, ...] = ()
    all_groups: tuple[Group, ...] = ()
    reduction: Reduction = NO_REDUCTION

    @property
    def redundant(self) -> int:
        """Number of redundant constraints of the linkage regarded as a planar one."""
        return sum(passive.constraints for passive in self.passive)

    @property
    def higher(self) -> int:
        """Number p2 of higher pairs."""
        return sum(not pair.lower for pair in self.pairs)

    @property
    def sound(self) -> bool:
        """True if every degree of freedom is driven, and no constraints are redundant except those in `passive`."""
        drivers = len(self.drivers)
        return (
            self.freedom == drivers == self.mobility + self.redundant
            and not self.redundant_pairs
            and not self.under_constrained
        )

    def rebind(self, linkage: Linkage) -> Structure:
        """Return a copy of the structure whose pairs refer to another linkage, which differs in dimensions only."""
        groups, all_groups = (tuple(g.rebind(linkage) for g in some) for some in (self.groups, self.all_groups))
        pairs = tuple(pair.rebind(linkage) for pair in self.pairs)
        return replace(self, pairs=pairs, groups=groups, all_groups=all_groups)

    def driving_pair(self, driver: Driver) -> Pair:
        """Return the pair that a driver drives.

        It is a new pair if both links of the driver are joined to a third link in a compound hinge, and so form no pair
        with each other.
        """
        ends, apart = {driver.base, driver.link}, Pair(driver.joint, "R", driver.base, driver.link, driver.joint)
        pairs = (p for p in self.pairs if p.lower and {p.i, p.j} == ends and driver.joint in (p.point, p.name))
        return next(pairs, apart)

    @property
    def contours(self) -> int:
        """Number of independent closed contours, K = p - n (pairs less moving links)."""
        return len(self.pairs) - len(self.links)

    @property
    def formula(self) -> str:
        """Structural formula, e.g. I(0,1) -> II(2,3) -> II(4,5); see `structural_formula`."""
        titles = {driver.link: self.driver_title(driver) for driver in self.drivers}
        parts: dict[str, Collection[str]] = dict.fromkeys(titles.values(), ())
        title_of = {
            link: titles[driver.link]
            for driver in self.drivers
            if driver.base == FRAME
            for link in self.rigid_with(driver.link)
        }
        title_of |= {link: group.title for group in self.groups for link in group.links}
        for group in self.groups:
            driving = [titles[driver.link] for driver in group.drivers]
            parts[group.title] = [*driving, *(title_of[link] for link in group.known if link in title_of)]
        return structural_formula(parts)

    def rigid_with(self, link: str) -> tuple[str, ...]:
        """Return the links that cannot move relative to this link, including the link itself."""
        return next((rigid.links for rigid in self.reduction.rigid if link in rigid.links), (link,))

    def driver_title(self, driver: Driver) -> str:
        """Return the primary mechanism of a driver as the structural formula shows it, e.g. I(0,1)."""
        base, link = ("+".join(self.rigid_with(n)) if n != FRAME else n for n in (driver.base, driver.link))
        return f"I({printed(base)},{link})"

    @property
    def count(self) -> tuple[int, int, int]:
        """Numbers n of moving links, p1 of lower pairs and p2 of higher pairs in the structural report.

        The mobility is 3n - 2 p1 - p2.
        """
        counts = [group.count for group in self.groups]
        n, lower, higher = (sum(column) for column in zip((0, 0, 0), *counts, strict=True))
        return n + len(self.drivers), lower + len(self.drivers), higher

    @property
    def mechanism_class(self) -> int:
        """Class of the mechanism, which is the highest class of its groups."""
        return max((g.group_class for g in self.groups), default=1)

    @property
    def roman(self) -> str:
        """Class of the mechanism in Roman numerals."""
        return ROMAN[min(self.mechanism_class, 10)]

    @property
    def solved(self) -> tuple[Group, ...]:
        """Groups in the order in which kinematics solves them.

        Groups that share redundant constraints are united into one, with all groups between them in this order. The
        united group can pass positions in which one of its groups alone is in a dead position; redundant constraints
        often serve this purpose.
        """
        among = {link for passive in self.passive for link in passive.among}
        held = [group for group in self.all_groups if among & set(group.links)]
        if len(held) < 2:
            return self.all_groups
        links = {link for group in held for link in group.links}
        needed, dependent = set(links), set(links)
        for group in reversed(self.all_groups):
            if needed & set(group.links):
                needed.update(group.links, group.depends_on)
        for group in self.all_groups:
            if dependent & group.depends_on:
                dependent.update(group.links)
        first = [group for group in self.all_groups if needed.issuperset(group.links)]
        together = [group for group in first if dependent.issuperset(group.links)]
        return (
            *(group for group in first if group not in together),
            self._united(together),
            *(group for group in self.all_groups if group not in first),
        )

    def _united(self, groups: Sequence[Group]) -> Group:
        links = {link for group in groups for link in group.links}
        names = {pair.name for group in groups for pair in (*group.inner, *group.outer)}
        pairs = [pair for pair in self.pairs if pair.name in names]
        return Group(
            tuple(link for link in self.links if link in links),
            tuple(p for p in pairs if {p.i, p.j} <= links),
            tuple(p for p in pairs if not {p.i, p.j} <= links),
            max(g.group_class for g in groups),
            "",
            tuple(driver for group in groups for driver in group.drivers),
        )

    def pair(self, name: str) -> Pair:
        return next(p for p in self.pairs if p.name == name)


def structural_formula(parts: Mapping[str, Collection[str]]) -> str:
    """Write a structural formula.

    A chain is broken where it branches: I(0,1) -> II(2,3), I(0,1) -> II(4,5). A part that is attached to several parts
    follows their sum: I(0,1) + I(0,4) -> II(2,3); of parts attached to one another only the last is named in the sum.

    Args:
        parts: for each driver or group, by its title and in solving order: titles of the parts to which it is attached.
    """
    before: dict[str, set[str]] = {}
    chains: list[list[tuple[str, ...]]] = []
    for title, attached_to in parts.items():
        before[title] = set(attached_to).union(*(before[other] for other in attached_to))
        last = tuple(t for t in parts if t in attached_to and not any(t in before[other] for other in attached_to))
        chain = next((chain for chain in chains if chain[-1] == last), None)
        if chain is not None:
            chain.append((title,))
        else:
            chains.append([last, (title,)] if last else [(title,)])
    longer = [chain for chain in chains if len(chain) > 1]
    heads = {title for chain in longer for title in chain[0]}
    kept = [chain for chain in chains if chain in longer or chain[0][0] not in heads]
    return ", ".join(" -> ".join(" + ".join(titles) for titles in chain) for chain in kept)


def analyse_structure(linkage: Linkage, dropped: Mapping[int, int] | None = None) -> Structure:
    """Analyse the structure of a linkage.

    Never raises an error: faults of the linkage are described in the returned Structure.

    Args:
        linkage: the linkage.
        dropped: number of conditions to be left out of the count for each tie, by its index in `list_ties`. If given,
            the report is not reduced: its groups are those of all links.
    """
    less = dropped or {}
    ties = [replace(tie, constraints=tie.constraints - less.get(k, 0)) for k, tie in enumerate(list_ties(linkage))]
    pins = _list_pins(linkage)
    bodies = tuple(linkage.links)
    undriven, driven = _play_pebble_games(bodies, ties, pins, [(d.base, d.link) for d in linkage.drivers])
    solved = _list_group_bodies(driven, bodies)
    rank = {FRAME: -1} | {link: k for k, bodies_of_group in enumerate(solved) for link in bodies_of_group}
    pairs = tuple(_iterate_pairs(linkage, rank))
    mobility = 3 * len(linkage.moving) - sum(2 if pair.lower else 1 for pair in pairs)
    sound = _is_sound(undriven, driven, linkage)
    cranks = {(driver.link,) for driver in linkage.cranks}
    groups = (
        tuple(
            _make_group(bodies_of_group, pairs, rank, linkage)
            for bodies_of_group in solved
            if bodies_of_group not in cranks
        )
        if sound
        else ()
    )
    order = {name: k for k, name in enumerate(linkage.links)}
    over_held = undriven.redundant_pairs or driven.redundant_pairs
    structure = Structure(
        linkage.moving,
        pairs,
        linkage.drivers,
        groups,
        mobility,
        undriven.free,
        # with the drivers fixed, a link is under-constrained if it still moves; without them all links may move
        tuple(sorted(driven.under_constrained, key=order.__getitem__)),
        tuple((tie.name, tuple(sorted(bodies, key=order.__getitem__))) for tie, bodies in over_held),
        all_groups=groups,
    )
    if sound and not less:
        rigid = Reduction(tuple(RigidSet(links) for links in rigid_sets(bodies, ties, pins)))
        return (reduce_structure(linkage, structure, rigid) or structure) if rigid else structure
    return structure


def reduce_structure(linkage: Linkage, structure: Structure, reduction: Reduction) -> Structure | None:
    """Leave redundant links and pairs out of the structural report.

    A group of all links gets the highest class among the groups of the report that share a link with it.

    Returns:
        The structure with the reduced groups; None if the remaining links do not form Assur groups.
    """
    all_ties = list(list_ties(linkage))
    ties = list(reduction.ties(all_ties))
    tied = {end for tie in ties for end in (tie.a, tie.b)}
    pins = tuple(pin for pin in _list_pins(linkage) if pin in tied)
    bodies = reduction.bodies(linkage.links)
    drivers = [(reduction.body(d.base), reduction.body(d.link)) for d in linkage.drivers]
    undriven, driven = _play_pebble_games(bodies, ties, pins, drivers)
    if not _is_sound(undriven, driven, linkage):
        return None
    solved = _list_group_bodies(driven, bodies)
    rank = dict.fromkeys(reduction.members(FRAME), -1)
    rank |= {
        link: k for k, group_bodies in enumerate(solved) for body in group_bodies for link in reduction.members(body)
    }
    pairs = tuple(reduction.reduced_pairs(linkage, structure.pairs, rank, ties))
    redundant, as_higher = [], set()
    for number, constraints in reduction.conditions.items():
        tie = all_ties[number]
        left = tie.constraints - constraints
        pair = reduction.pair_of(tie, pairs if left else structure.pairs)
        if pair is None:
            return None
        redundant.append(RedundantPair(pair.name, constraints, left))
        if left and tie.constraints > 1:
            as_higher.add(pair.name)
    cranks = {(reduction.body(driver.link),) for driver in linkage.cranks}
    groups = tuple(
        _make_group(group_bodies, pairs, rank, linkage, reduction, as_higher)
        for group_bodies in solved
        if group_bodies not in cranks
    )
    if any(group.mobility for group in groups):
        return None
    grade = {link: group.group_class for group in groups for link in group.links}
    all_groups = tuple(
        replace(group, group_class=max(grade.get(link, 2) for link in group.links)) for group in structure.all_groups
    )
    return replace(
        structure, groups=groups, all_groups=all_groups, reduction=replace(reduction, pairs=tuple(redundant))
    )


def _play_pebble_games(
    bodies: tuple[str, ...], ties: Sequence[Tie], pins: tuple[str, ...], drivers: Iterable[tuple[str, str]]
) -> tuple[PebbleCount, PebbleCount]:
    """Count degrees of freedom by the pebble game (see graph.py), first without and then with the drivers."""
    driving = [Tie("driver", base, link, 1) for base, link in drivers]
    return count_freedoms(bodies, FRAME, ties, pins), count_freedoms(bodies, FRAME, [*ties, *driving], pins)


def _list_group_bodies(driven: PebbleCount, bodies: Sequence[str]) -> list[tuple[str, ...]]:
    """List the links of each group in solving order, without pins of compound hinges and without the frame."""
    parts = [
        tuple(body for body in component if body in bodies and body != FRAME)
        for component in dependence_components(driven.depends)
    ]
    return [tuple(sorted(component, key=bodies.index)) for component in parts if component]


def _is_sound(undriven: PebbleCount, driven: PebbleCount, linkage: Linkage) -> bool:
    """Return True if every degree of freedom is driven and no constraint is redundant."""
    held_twice = undriven.redundant_pairs or driven.redundant_pairs
    return undriven.free == len(linkage.drivers) and not held_twice and driven.free == 0


def _list_pins(linkage: Linkage) -> tuple[str, ...]:
    return tuple(_pin_name(hinge) for hinge in linkage.hinges if len(hinge.links) > 2 and not hinge.attached_to)


def _pin_name(hinge: Hinge) -> str:
    return f"pin {hinge.point}"


def list_ties(linkage: Linkage) -> Iterable[Tie]:
    """Yield the ties (connections with a number of conditions) between links.

    The links of a compound hinge are tied to its pin, or to the link that the file names.
    """
    for hinge in linkage.hinges:
        if len(hinge.links) == 2:
            yield Tie(hinge.point, *hinge.links, 2)
        elif hinge.attached_to:
            yield from (Tie(hinge.point, hinge.attached_to, x, 2) for x in hinge.links if x != hinge.attached_to)
        else:
            yield from (Tie(hinge.point, _pin_name(hinge), link, 2) for link in hinge.links)
    yield from (Tie(slide.name, slide.carrier, slide.runner, 2) for slide in linkage.slides)
    yield from (Tie(mesh.name, mesh.i, mesh.j, 1) for mesh in linkage.meshes)


def list_pairs(linkage: Linkage) -> tuple[Pair, ...]:
    """List the kinematic pairs of a linkage without use of the solving order, which is not known yet."""
    return tuple(_iterate_pairs(linkage, dict.fromkeys(linkage.links, 0)))


def _iterate_pairs(linkage: Linkage, rank: Mapping[str, int]) -> Iterable[Pair]:
    """Yield the kinematic pairs of a linkage. In a compound hinge one link is paired with each of the other links.

    rank: index of the group of each link, in solving order.
    """
    order = {name: k for k, name in enumerate(linkage.links)}
    for hinge in linkage.hinges:
        links = sorted(hinge.links, key=lambda name: (rank[name], order[name]))
        common = hinge.attached_to or _common_link(links, rank, linkage)
        for number, link in enumerate(link for link in links if link != common):
            i, j = sorted((common, link), key=links.index)
            yield Pair(hinge.point + ("'" * (number + 1) if number else ""), "R", i, j, hinge.point)
    for slide in linkage.slides:
        yield Pair(slide.name, "P", slide.carrier, slide.runner, slide.point, slide)
    for mesh in linkage.meshes:
        yield Pair(mesh.name, HIGHER_PAIR_KINDS[mesh.kind], mesh.i, mesh.j, "", mesh=mesh)


def _common_link(links: list[str], rank: Mapping[str, int], linkage: Linkage) -> str:
    """Choose the link of a compound hinge with which each of its other links forms a pair, if the file names no such
    link.

    It is the frame; otherwise the driver; otherwise a link of the group solved first, preferably one connected to the
    frame. `links` are in solving order.
    """
    first = [link for link in links if rank[link] == rank[links[0]]]
    driven = [driver.link for driver in linkage.drivers if driver.link in first]
    connected = [link for link in first if linkage.hinged_to_frame(link) or linkage.slides_on_frame(link)]
    return (*driven, *connected, *first)[0]


def _make_group(
    bodies: tuple[str, ...],
    pairs: tuple[Pair, ...],
    rank: Mapping[str, int],
    linkage: Linkage,
    reduction: Reduction = NO_REDUCTION,
    as_higher: Collection[str] = (),
) -> Group:
    """Make the Assur group of these bodies (links, or sets of links rigid to one another).

    rank: index of the group of each link, in solving order. as_higher: names of lower pairs that count as higher ones.
    """
    group_rank, member = rank[bodies[0]], {body: reduction.members(body) for body in bodies}
    links = tuple(link for body in bodies for link in member[body])
    rigid = tuple(links for links in member.values() if len(links) > 1)
    inner = tuple(p for p in pairs if rank[p.i] == rank[p.j] == group_rank)
    outer = [p for p in pairs if max(rank[p.i], rank[p.j]) == group_rank != min(rank[p.i], rank[p.j])]
    own_link = {p.name: p.i if rank[p.i] == group_rank else p.j for p in outer}
    outer.sort(key=lambda p: links.index(own_link[p.name]))
    drivers = tuple(
        d for d in linkage.drivers if d not in linkage.cranks and max(rank[d.base], rank[d.link]) == group_rank
    )
    halved = tuple(pair.name for pair in (*inner, *outer) if pair.name in as_higher)
    if len(bodies) == 2 and len(inner) == 1 and len(outer) == 2 and not drivers and not halved:
        # The standard names start with the revolute end: RRP, RPP.
        outer.sort(key=lambda p: p.kind == "P")
        kind = outer[0].kind + inner[0].kind + outer[1].kind
        in_order = tuple(link for p in outer for link in member[reduction.body(own_link[p.name])])
        return Group(in_order, inner, tuple(outer), 2, kind, rigid=rigid)
    kind = "".join(sorted((p.kind for p in (*inner, *outer)), key="RPGKC".index))
    grade = group_class([*map(member.__getitem__, bodies)], inner, outer, drivers, halved)
    return Group(links, inner, tuple(outer), grade, kind, drivers, rigid, halved)
