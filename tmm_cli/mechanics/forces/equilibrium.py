"""Sums of forces along guides: what no equation of moments gives, the part of a reaction along a guide and what drives.

The guide itself does nothing along its direction, so the forces on one of its two links must come to nothing there.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from tmm_cli.mechanics.forces.free_bodies import (
    DRIVE,
    Acting,
    Kind,
    Lead,
    Loaded,
    Symbol,
    assur_point,
    balance_symbol,
    hinges_of,
    leads_of,
    reaction_symbol,
)
from tmm_cli.mechanics.forces.reactions import GroupForces, Reaction, Reactions
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import NO_COORDINATE, NO_FORCE, SAME_POINTS, dot
from tmm_cli.mechanics.structure import Group, Pair


def other_than(taken: Collection[str], letter: str) -> str:
    """The letter, with as many primes as it needs not to be one of those taken."""
    while letter in taken:
        letter += "′"
    return letter


@dataclass(frozen=True)
class Part:
    """What acts, and its part along the guide (N)."""

    acting: Acting
    along: float

    @property
    def cosine(self) -> float:
        """Of the acute angle between the force and the guide."""
        return min(1.0, abs(self.along) / self.acting.size)


@dataclass(frozen=True)
class ForceSum:
    """The parts along a guide of all that acts on a link come to nothing; what is across it is left out."""

    link: str
    guide: str
    direction: complex
    parts: tuple[Part, ...]
    found: Part

    @property
    def value(self) -> float:
        """Of what is found, from the others, N; it is along the guide."""
        others = sum(part.along for part in self.parts if part is not self.found)
        return -others if self.found.along > 0 else others


def along_guides(
    here: Loaded, group: Group, leads: Sequence[Lead], axes: Mapping[str, complex]
) -> tuple[ForceSum, ...]:
    """Normal parts of leads that slide on the group, then what drives a cylinder of it."""
    found: list[ForceSum] = []
    for lead in leads:
        own = group.own(lead.pair)
        guides = [p for p in group.inner if p.slide is not None and own in (p.i, p.j)]
        if lead.pair.name in axes and len(guides) == 1 and len(lead.links) > 1 and not _driven(group, guides[0]):
            found += _sum(here, axes, own, guides[0], lead.pair.name, "normal")
    for guide in (p for p in group.inner if p.slide is not None and _driven(group, p)):
        sides = [n for n in (guide.i, guide.j) if any(n in (p.i, p.j) for p in group.outer)] or [guide.j]
        found += _sum(here, axes, sides[0], guide, DRIVE, "reaction")
    return tuple(found)


def of_driver(here: Loaded, pair: Pair) -> tuple[ForceSum, ...]:
    """What drives a slider on the frame."""
    return tuple(_sum(here, {}, pair.j if pair.i == FRAME else pair.i, pair, DRIVE, "reaction"))


def _driven(group: Group, guide: Pair) -> bool:
    return any({d.link, d.base} == {guide.i, guide.j} for d in group.drivers)


def _sum(here: Loaded, axes: Mapping[str, complex], link: str, guide: Pair, pair: str, kind: str) -> Iterable[ForceSum]:
    """None where what is sought is nothing."""
    u = here.guide(guide)
    forces = [a for a in here.acting((link,), axes) if not a.couple]
    largest = max((a.size for a in forces), default=0.0)
    parts = [Part(a, float(dot(u, a.force))) for a in forces]
    parts = [part for part in parts if abs(part.along) > NO_FORCE * largest]
    sought = [part for part in parts if (part.acting.pair, part.acting.kind) == (pair, kind)]
    if sought:
        yield ForceSum(link, guide.name, u, tuple(parts), sought[0])


# Equations of moments of a position: those that the force plan of each group needs, and those of the driving links.
#
# Leads of a group: moments about the inner hinge of a lead give the tangential part of its reaction; of a group with
# three leads, moments about a special point of L. V. Assur, where what is open of two of them meets, give the third.
# Guides: moments of the link that runs in it say where a guide's reaction acts.


SPECIAL = "W"  # the special point of a group with three leads
MARKS = {"tangential": "τ", "normal": "n"}


@dataclass(frozen=True)
class Term:
    """What acts, and its moment about the centre (N m); a force's arm (m) leads from there to the foot on its line.

    number: of the arm h₁, h₂, ...; zero of a couple.
    """

    acting: Acting
    moment: float
    arm: float
    foot: complex
    number: int = 0

    @property
    def letter(self) -> Symbol:
        """Of its arm: h₁."""
        return Symbol("h", str(self.number))


@dataclass(frozen=True)
class Sought:
    """What an equation gives: a part of the reaction in a pair (or the driver's), or the arm at which that acts."""

    symbol: Symbol
    pair: str
    kind: Kind = "reaction"
    arm: bool = False


@dataclass(frozen=True)
class MomentEquation:
    """The moments about a point of all that acts on some links come to nothing; forces through it are left out.

    special: the point is one of Assur. sought: None where all reactions of the group are found at once. Its term is
    missing where it has no moment: a part of a reaction is nothing then, and a guide's reaction goes through the point.
    """

    links: tuple[str, ...]
    about: str
    centre: complex
    terms: tuple[Term, ...]
    sought: Sought | None = None
    special: bool = False

    @property
    def found(self) -> Term | None:
        """The term of what is sought; of a guide that bears a couple, this."""
        own = [t for t in self.terms if self.sought and _is(t.acting, self.sought)]
        return min(own, key=lambda t: not t.acting.couple, default=None)

    @property
    def value(self) -> float:
        """What it gives, from the moments of the other terms: N, N m or m; positive as it is drawn."""
        found = self.found
        assert found is not None and self.sought is not None
        others = sum(t.moment for t in self.terms if t is not found)
        moment = -others if found.moment > 0 else others
        if found.acting.couple:
            return moment
        return moment / (found.acting.size if self.sought.arm else found.arm)


@dataclass(frozen=True)
class LoadedPart:
    """A group, or a driving link, apart: all that acts on it from without, its equations of moments, and sums along
    its guides."""

    links: tuple[str, ...]
    acting: tuple[Acting, ...]
    equations: tuple[MomentEquation, ...]
    sums: tuple[ForceSum, ...] = ()
    driving: bool = False


def loaded_parts(motion: Motion, reactions: Reactions, k: int) -> tuple[LoadedPart, ...]:
    """Last group first, as force plans are drawn, and the driving links at the end."""
    here = Loaded.at(motion, reactions, k)
    groups = [_group(here, group) for group in reversed(reactions.groups)]
    return (*groups, *(_driving(here, frame) for frame in reactions.frames))


def _group(here: Loaded, forces: GroupForces) -> LoadedPart:
    group = forces.group
    leads = leads_of(here, group)
    axes = {lead.pair.name: lead.axis for lead in leads if lead.axis is not None}
    equations = [*_of_leads(here, group, leads, axes), *_of_teeth(here, group, axes)]
    if not equations and len(group.links) > 2:  # all reactions are found at once
        equations = [_equation(here, axes, (link,), *_hinge(here, group, link)) for link in group.links]
    else:
        equations += _of_guides(here, group, axes)
    sums = along_guides(here, group, leads, axes)
    return LoadedPart(group.links, here.acting(group.links, axes), numbered(equations), sums)


def _of_leads(
    here: Loaded, group: Group, leads: Sequence[Lead], axes: Mapping[str, complex]
) -> Iterable[MomentEquation]:
    for lead in leads:
        if lead.about is not None:
            sought = _part(group, lead.pair, "tangential")
            yield _equation(here, axes, lead.links, lead.about, here.hinge(lead.about), sought)
    open_hinges = [lead for lead in leads if lead.rest is None and lead.pair.slide is None and lead.about is None]
    special = assur_point(here, group, leads)
    if len(leads) == len(group.outer) == 2 and len(open_hinges) == 1:  # all of one reaction, and a part of the other
        other = next(lead for lead in leads if lead not in open_hinges)
        about = open_hinges[0].pair.point
        yield _equation(here, axes, group.links, about, here.hinge(about), _part(group, other.pair, other.open_part))
    elif special is not None:
        lead, centre = special
        # of a guide's reaction the moment about its link's hinge is known by now, but not where it acts
        carried = {other.pair.name: other.rest[0] for other in leads if other.pair.slide is not None and other.rest}
        sought = _part(group, lead.pair, lead.open_part)
        name = other_than({point for link in here.motion.linkage.links.values() for point in link.points}, SPECIAL)
        yield replace(_equation(here, axes, group.links, name, centre, sought, carried), special=True)


def _of_teeth(here: Loaded, group: Group, axes: Mapping[str, complex]) -> Iterable[MomentEquation]:
    """A wheel, or a follower of a cam, that hangs on one hinge: moments about it give what the teeth do."""
    for pair in group.outer:
        own = group.own(pair)
        joined = [p for p in (*group.inner, *group.outer) if own in (p.i, p.j) and p != pair]
        if not pair.lower and [p.kind for p in joined] == ["R"]:
            point = joined[0].point
            yield _equation(here, axes, (own,), point, here.hinge(point), _part(group, pair, "reaction"))


def _of_guides(here: Loaded, group: Group, axes: Mapping[str, complex]) -> Iterable[MomentEquation]:
    """Moments of one of the two links of a sliding pair: where its reaction acts. An inner one where no hinge is."""
    pairs = (*group.inner, *group.outer)
    inner = group.inner if group.type == "RPP" else ()
    for pair in (p for p in (*inner, *group.outer) if p.slide is not None):
        sides = [link for link in (pair.i, pair.j) if link in group.links]
        own = min(sides, key=lambda n: (not hinges_of(pairs, (n,)), sum(n in (p.i, p.j) for p in pairs)))
        sought = Sought(reaction_symbol(pair.other(own), own), pair.name, arm=True)
        yield _equation(here, axes, (own,), *_hinge(here, group, own, pair), sought)


def _driving(here: Loaded, frame: Reaction) -> LoadedPart:
    """A crank about its pivot, which gives what balances it; a driven slider about its running point."""
    link, pair = frame.on, frame.pair
    if pair.slide is not None:
        sought = Sought(reaction_symbol(frame.by, link), pair.name, arm=True)
    else:
        balance = next(b for b in here.reactions.balances if b.driver.link == link)
        turns = balance.kind == "moment"
        sought = Sought(balance_symbol(link, len(here.reactions.balances) > 1, turns=turns), DRIVE)
    equation = _equation(here, {}, (link,), pair.point or pair.name, here.pair(pair), sought)
    sums = of_driver(here, pair) if pair.slide is not None else ()
    return LoadedPart((link,), here.acting((link,), {}), numbered([equation]), sums, driving=True)


def _part(group: Group, pair: Pair, kind: Kind) -> Sought:
    own = group.own(pair)
    return Sought(reaction_symbol(pair.other(own), own, MARKS.get(kind, "")), pair.name, kind)


def _hinge(here: Loaded, group: Group, link: str, guide: Pair | None = None) -> tuple[str, complex]:
    """About which point moments of a link are taken: a hinge, an inner one first; else the running point of a guide."""
    own = [p for p in (*group.inner, *group.outer) if link in (p.i, p.j) and p.kind == "R"]
    pair = own[0] if own else guide or next(p for p in (*group.inner, *group.outer) if link in (p.i, p.j))
    return pair.point or pair.name, here.pair(pair)


def _is(acting: Acting, sought: Sought) -> bool:
    return (acting.pair, acting.kind) == (sought.pair, sought.kind)


def _equation(
    here: Loaded,
    axes: Mapping[str, complex],
    links: Sequence[str],
    about: str,
    centre: complex,
    sought: Sought | None = None,
    carried: Mapping[str, complex] | None = None,
) -> MomentEquation:
    """Moments of all that acts on these links. carried: to which places guides' reactions go, each with a couple."""
    to = carried or {}
    acting = [one for given in here.acting(links, axes) for one in _moved(given, to.get(given.pair), here.size)]
    return MomentEquation(tuple(links), about, centre, terms(acting, centre, here.size), sought)


def terms(acting: Iterable[Acting], centre: complex, size: float) -> tuple[Term, ...]:
    """Moments about a place; without what goes through it but for rounding: of a size (m), of the largest moment."""
    found = []
    for one in acting:
        if one.couple:
            found.append(Term(one, one.moment, 0.0, one.at))
            continue
        along = one.force / abs(one.force)
        foot = one.at - along * float(dot(one.at - centre, along))
        if abs(foot - centre) > NO_COORDINATE * size:
            found.append(Term(one, one.about(centre), abs(foot - centre), foot))
    least = NO_FORCE * max((abs(term.moment) for term in found), default=0.0)
    return tuple(term for term in found if abs(term.moment) > least)


def _moved(acting: Acting, place: complex | None, size: float) -> Iterable[Acting]:
    if place is None or acting.couple:
        yield acting
        return
    yield replace(acting, at=place)
    moment = acting.about(place)
    if abs(moment) > NO_COORDINATE * acting.size * size:
        symbol = replace(acting.symbol, letter="M")
        yield replace(acting, symbol=symbol, kind="inner", force=0j, moment=moment, at=place)


def numbered(equations: Iterable[MomentEquation]) -> tuple[MomentEquation, ...]:
    """Arms get numbers; the same ones of several forces (weight and inertia in one line) have one."""
    found: list[MomentEquation] = []
    feet: list[tuple[complex, complex]] = []
    for equation in equations:
        terms = []
        for term in equation.terms:
            number = 0
            if not term.acting.couple:
                arm, near = (equation.centre, term.foot), SAME_POINTS * term.arm
                same = [n for n, (c, f) in enumerate(feet, 1) if abs(c - arm[0]) < near and abs(f - arm[1]) < near]
                feet += [] if same else [arm]
                number = same[0] if same else len(feet)
            terms.append(replace(term, number=number))
        found.append(replace(equation, terms=tuple(terms)))
    return tuple(found)
