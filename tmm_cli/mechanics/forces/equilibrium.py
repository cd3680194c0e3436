"""Sums of forces along guides: what no equation of moments gives, the part of a reaction along a guide and what drives.

The guide itself does nothing along its direction, so the forces on one of its two links must come to nothing there.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from tmm_cli.mechanics.forces.free_bodies import (
    DRIVE,
    ExternalPair,
    ForceOrCouple,
    LoadedPosition,
    Symbol,
    VectorKind,
    balance_symbol,
    external_pairs,
    find_assur_point,
    hinge_names,
    reaction_symbol,
)
from tmm_cli.mechanics.forces.reactions import GroupForces, Reaction, Reactions
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import NO_COORDINATE, NO_FORCE, SAME_POINTS, dot
from tmm_cli.mechanics.structure import Group, Pair


def distinct_letter(taken: Collection[str], letter: str) -> str:
    """The letter, with as many primes as it needs not to be one of those taken."""
    while letter in taken:
        letter += "′"
    return letter


@dataclass(frozen=True)
class GuideComponent:
    """What acts, and its part along the guide (N)."""

    acting: ForceOrCouple
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
    parts: tuple[GuideComponent, ...]
    found: GuideComponent

    @property
    def value(self) -> float:
        """Of what is found, from the others, N; it is along the guide."""
        others = sum(part.along for part in self.parts if part is not self.found)
        return -others if self.found.along > 0 else others


def sums_along_guides(
    here: LoadedPosition, group: Group, leads: Sequence[ExternalPair], axes: Mapping[str, complex]
) -> tuple[ForceSum, ...]:
    """Normal parts of leads that slide on the group, then what drives a cylinder of it."""
    found: list[ForceSum] = []
    for lead in leads:
        own = group.own(lead.pair)
        guides = [p for p in group.inner if p.slide is not None and own in (p.i, p.j)]
        if lead.pair.name in axes and len(guides) == 1 and len(lead.links) > 1 and not _is_driven(group, guides[0]):
            found += _sum_along_guide(here, axes, own, guides[0], lead.pair.name, "normal")
    for guide in (p for p in group.inner if p.slide is not None and _is_driven(group, p)):
        sides = [n for n in (guide.i, guide.j) if any(n in (p.i, p.j) for p in group.outer)] or [guide.j]
        found += _sum_along_guide(here, axes, sides[0], guide, DRIVE, "reaction")
    return tuple(found)


def sums_of_driver(here: LoadedPosition, pair: Pair) -> tuple[ForceSum, ...]:
    """What drives a slider on the frame."""
    return tuple(_sum_along_guide(here, {}, pair.j if pair.i == FRAME else pair.i, pair, DRIVE, "reaction"))


def _is_driven(group: Group, guide: Pair) -> bool:
    return any({d.link, d.base} == {guide.i, guide.j} for d in group.drivers)


def _sum_along_guide(
    here: LoadedPosition, axes: Mapping[str, complex], link: str, guide: Pair, pair: str, kind: str
) -> Iterable[ForceSum]:
    """None where what is sought is nothing."""
    u = here.guide(guide)
    forces = [a for a in here.acting((link,), axes) if not a.couple]
    largest = max((a.size for a in forces), default=0.0)
    parts = [GuideComponent(a, float(dot(u, a.force))) for a in forces]
    parts = [part for part in parts if abs(part.along) > NO_FORCE * largest]
    sought = [part for part in parts if (part.acting.pair, part.acting.kind) == (pair, kind)]
    if sought:
        yield ForceSum(link, guide.name, u, tuple(parts), sought[0])


# Equations of moments of a position: those that the force plan of each group needs, and those of the driving links.
#
# Leads of a group: moments about the inner hinge of a lead give the tangential part of its reaction; of a group with
# three leads, moments about a special point of L. V. Assur, where what is open of two of them meets, give the third.
# Guides: moments of the link that runs in it say where a guide's reaction acts.


ASSUR_POINT = "W"  # the special point of a group with three leads
MARKS = {"tangential": "τ", "normal": "n"}


@dataclass(frozen=True)
class MomentTerm:
    """What acts, and its moment about the centre (N m); a force's arm (m) leads from there to the foot on its line.

    number: of the arm h₁, h₂, ...; zero of a couple.
    """

    acting: ForceOrCouple
    moment: float
    arm: float
    foot: complex
    number: int = 0

    @property
    def letter(self) -> Symbol:
        """Of its arm: h₁."""
        return Symbol("h", str(self.number))


@dataclass(frozen=True)
class EquationUnknown:
    """What an equation gives: a part of the reaction in a pair (or the driver's), or the arm at which that acts."""

    symbol: Symbol
    pair: str
    kind: VectorKind = "reaction"
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
    terms: tuple[MomentTerm, ...]
    sought: EquationUnknown | None = None
    special: bool = False

    @property
    def found(self) -> MomentTerm | None:
        """The term of what is sought; of a guide that bears a couple, this."""
        own = [t for t in self.terms if self.sought and _is_unknown(t.acting, self.sought)]
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
class FreeBody:
    """A group, or a driving link, apart: all that acts on it from without, its equations of moments, and sums along
    its guides."""

    links: tuple[str, ...]
    acting: tuple[ForceOrCouple, ...]
    equations: tuple[MomentEquation, ...]
    sums: tuple[ForceSum, ...] = ()
    driving: bool = False


def list_free_bodies(motion: Motion, reactions: Reactions, k: int) -> tuple[FreeBody, ...]:
    """Last group first, as force plans are drawn, and the driving links at the end."""
    here = LoadedPosition.at(motion, reactions, k)
    groups = [_group_body(here, group) for group in reversed(reactions.groups)]
    return (*groups, *(_driving_link_body(here, frame) for frame in reactions.frames))


def _group_body(here: LoadedPosition, forces: GroupForces) -> FreeBody:
    group = forces.group
    leads = external_pairs(here, group)
    axes = {lead.pair.name: lead.axis for lead in leads if lead.axis is not None}
    equations = [
        *_equations_of_external_pairs(here, group, leads, axes),
        *_equations_of_higher_pairs(here, group, axes),
    ]
    if not equations and len(group.links) > 2:  # all reactions are found at once
        equations = [_moment_equation(here, axes, (link,), *_moment_centre(here, group, link)) for link in group.links]
    else:
        equations += _equations_of_guides(here, group, axes)
    sums = sums_along_guides(here, group, leads, axes)
    return FreeBody(group.links, here.acting(group.links, axes), number_arms(equations), sums)


def _equations_of_external_pairs(
    here: LoadedPosition, group: Group, leads: Sequence[ExternalPair], axes: Mapping[str, complex]
) -> Iterable[MomentEquation]:
    for lead in leads:
        if lead.about is not None:
            sought = _unknown_component(group, lead.pair, "tangential")
            yield _moment_equation(here, axes, lead.links, lead.about, here.hinge(lead.about), sought)
    open_hinges = [lead for lead in leads if lead.rest is None and lead.pair.slide is None and lead.about is None]
    special = find_assur_point(here, group, leads)
    if len(leads) == len(group.outer) == 2 and len(open_hinges) == 1:  # all of one reaction, and a part of the other
        other = next(lead for lead in leads if lead not in open_hinges)
        about = open_hinges[0].pair.point
        yield _moment_equation(
            here, axes, group.links, about, here.hinge(about), _unknown_component(group, other.pair, other.open_part)
        )
    elif special is not None:
        lead, centre = special
        # of a guide's reaction the moment about its link's hinge is known by now, but not where it acts
        carried = {other.pair.name: other.rest[0] for other in leads if other.pair.slide is not None and other.rest}
        sought = _unknown_component(group, lead.pair, lead.open_part)
        name = distinct_letter(
            {point for link in here.motion.linkage.links.values() for point in link.points}, ASSUR_POINT
        )
        yield replace(_moment_equation(here, axes, group.links, name, centre, sought, carried), special=True)


def _equations_of_higher_pairs(
    here: LoadedPosition, group: Group, axes: Mapping[str, complex]
) -> Iterable[MomentEquation]:
    """A wheel, or a follower of a cam, that hangs on one hinge: moments about it give what the teeth do."""
    for pair in group.outer:
        own = group.own(pair)
        joined = [p for p in (*group.inner, *group.outer) if own in (p.i, p.j) and p != pair]
        if not pair.lower and [p.kind for p in joined] == ["R"]:
            point = joined[0].point
            yield _moment_equation(
                here, axes, (own,), point, here.hinge(point), _unknown_component(group, pair, "reaction")
            )


def _equations_of_guides(here: LoadedPosition, group: Group, axes: Mapping[str, complex]) -> Iterable[MomentEquation]:
    """Moments of one of the two links of a sliding pair: where its reaction acts. An inner one where no hinge is."""
    pairs = (*group.inner, *group.outer)
    inner = group.inner if group.type == "RPP" else ()
    for pair in (p for p in (*inner, *group.outer) if p.slide is not None):
        sides = [link for link in (pair.i, pair.j) if link in group.links]
        own = min(sides, key=lambda n: (not hinge_names(pairs, (n,)), sum(n in (p.i, p.j) for p in pairs)))
        sought = EquationUnknown(reaction_symbol(pair.other(own), own), pair.name, arm=True)
        yield _moment_equation(here, axes, (own,), *_moment_centre(here, group, own, pair), sought)


def _driving_link_body(here: LoadedPosition, frame: Reaction) -> FreeBody:
    """A crank about its pivot, which gives what balances it; a driven slider about its running point."""
    link, pair = frame.on, frame.pair
    if pair.slide is not None:
        sought = EquationUnknown(reaction_symbol(frame.by, link), pair.name, arm=True)
    else:
        balance = next(b for b in here.reactions.balances if b.driver.link == link)
        turns = balance.kind == "moment"
        sought = EquationUnknown(balance_symbol(link, len(here.reactions.balances) > 1, turns=turns), DRIVE)
    equation = _moment_equation(here, {}, (link,), pair.point or pair.name, here.pair(pair), sought)
    sums = sums_of_driver(here, pair) if pair.slide is not None else ()
    return FreeBody((link,), here.acting((link,), {}), number_arms([equation]), sums, driving=True)


def _unknown_component(group: Group, pair: Pair, kind: VectorKind) -> EquationUnknown:
    own = group.own(pair)
    return EquationUnknown(reaction_symbol(pair.other(own), own, MARKS.get(kind, "")), pair.name, kind)


def _moment_centre(here: LoadedPosition, group: Group, link: str, guide: Pair | None = None) -> tuple[str, complex]:
    """About which point moments of a link are taken: a hinge, an inner one first; else the running point of a guide."""
    own = [p for p in (*group.inner, *group.outer) if link in (p.i, p.j) and p.kind == "R"]
    pair = own[0] if own else guide or next(p for p in (*group.inner, *group.outer) if link in (p.i, p.j))
    return pair.point or pair.name, here.pair(pair)


def _is_unknown(acting: ForceOrCouple, sought: EquationUnknown) -> bool:
    return (acting.pair, acting.kind) == (sought.pair, sought.kind)


def _moment_equation(
    here: LoadedPosition,
    axes: Mapping[str, complex],
    links: Sequence[str],
    about: str,
    centre: complex,
    sought: EquationUnknown | None = None,
    carried: Mapping[str, complex] | None = None,
) -> MomentEquation:
    """Moments of all that acts on these links. carried: to which places guides' reactions go, each with a couple."""
    to = carried or {}
    acting = [one for given in here.acting(links, axes) for one in _moved_to(given, to.get(given.pair), here.size)]
    return MomentEquation(tuple(links), about, centre, moment_terms(acting, centre, here.size), sought)


def moment_terms(acting: Iterable[ForceOrCouple], centre: complex, size: float) -> tuple[MomentTerm, ...]:
    """Moments about a place; without what goes through it but for rounding: of a size (m), of the largest moment."""
    found = []
    for one in acting:
        if one.couple:
            found.append(MomentTerm(one, one.moment, 0.0, one.at))
            continue
        along = one.force / abs(one.force)
        foot = one.at - along * float(dot(one.at - centre, along))
        if abs(foot - centre) > NO_COORDINATE * size:
            found.append(MomentTerm(one, one.about(centre), abs(foot - centre), foot))
    least = NO_FORCE * max((abs(term.moment) for term in found), default=0.0)
    return tuple(term for term in found if abs(term.moment) > least)


def _moved_to(acting: ForceOrCouple, place: complex | None, size: float) -> Iterable[ForceOrCouple]:
    if place is None or acting.couple:
        yield acting
        return
    yield replace(acting, at=place)
    moment = acting.about(place)
    if abs(moment) > NO_COORDINATE * acting.size * size:
        symbol = replace(acting.symbol, letter="M")
        yield replace(acting, symbol=symbol, kind="inner", force=0j, moment=moment, at=place)


def number_arms(equations: Iterable[MomentEquation]) -> tuple[MomentEquation, ...]:
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
