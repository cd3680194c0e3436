"""Equilibrium equations of an Assur group or a driving link: moments about points, and sums of forces along
guides.

A sum of forces along a guide supplements the moment equations: it gives the component of an external
reaction along the guide, or the driving force of a cylinder. The reaction of the guide itself is
perpendicular to it and has no term in the sum.
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
    """Append primes to `letter` until it differs from all letters in `taken`."""
    while letter in taken:
        letter += "′"
    return letter


@dataclass(frozen=True)
class GuideComponent:
    """A force (`acting`) and its component along a guide (`along`, N)."""

    acting: ForceOrCouple
    along: float

    @property
    def cosine(self) -> float:
        """Cosine of the acute angle between the force and the guide."""
        return min(1.0, abs(self.along) / self.acting.size)


@dataclass(frozen=True)
class ForceSum:
    """Sum of forces along a guide: the components of all forces on one link along the guide add up to zero.

    Attributes:
        link: the link whose forces are summed.
        guide: name of the prismatic pair.
        direction: unit vector along the guide.
        parts: components that are not zero.
        found: the unknown component, one of `parts`, which follows from the others.
    """

    link: str
    guide: str
    direction: complex
    parts: tuple[GuideComponent, ...]
    found: GuideComponent

    @property
    def value(self) -> float:
        """Unknown component (N) computed from the other components; positive in the direction in which it is drawn."""
        others = sum(component.along for component in self.parts if component is not self.found)
        return -others if self.found.along > 0 else others


def sums_along_guides(
    position: LoadedPosition, group: Group, leads: Sequence[ExternalPair], axes: Mapping[str, complex]
) -> tuple[ForceSum, ...]:
    """Return the force sums of a group along its internal guides.

    The sums that give normal components of external hinge reactions come first, then those that give the forces
    of cylinders.

    Args:
        position: position of the mechanism, with its loads and reactions.
        group: the Assur group.
        leads: external pairs of the group.
        axes: direction of the normal component of each external hinge reaction, by name of the pair.
    """
    sums: list[ForceSum] = []
    for lead in leads:
        link = group.own(lead.pair)
        guides = [p for p in group.inner if p.slide is not None and link in (p.i, p.j)]
        if lead.pair.name in axes and len(guides) == 1 and len(lead.links) > 1 and not _is_driven(group, guides[0]):
            sums += _sum_along_guide(position, axes, link, guides[0], lead.pair.name, "normal")
    for guide in (p for p in group.inner if p.slide is not None and _is_driven(group, p)):
        sides = [n for n in (guide.i, guide.j) if any(n in (p.i, p.j) for p in group.outer)] or [guide.j]
        sums += _sum_along_guide(position, axes, sides[0], guide, DRIVE, "reaction")
    return tuple(sums)


def sums_of_driver(position: LoadedPosition, pair: Pair) -> tuple[ForceSum, ...]:
    """Return the force sum along the guide of a slider that is driven from the frame. It gives the driving force."""
    return tuple(_sum_along_guide(position, {}, pair.j if pair.i == FRAME else pair.i, pair, DRIVE, "reaction"))


def _is_driven(group: Group, guide: Pair) -> bool:
    return any({d.link, d.base} == {guide.i, guide.j} for d in group.drivers)


def _sum_along_guide(
    position: LoadedPosition, axes: Mapping[str, complex], link: str, guide: Pair, pair: str, kind: str
) -> Iterable[ForceSum]:
    """Yield the sum of forces on a link along a guide, or nothing if its unknown component is zero.

    The unknown is a component of the reaction in a pair: the one of the given kind.
    """
    u = position.guide(guide)
    forces = [a for a in position.external_forces((link,), axes) if not a.couple]
    largest = max((a.size for a in forces), default=0.0)
    parts = [GuideComponent(a, float(dot(u, a.force))) for a in forces]
    parts = [component for component in parts if abs(component.along) > NO_FORCE * largest]
    sought = [component for component in parts if (component.acting.pair, component.acting.kind) == (pair, kind)]
    if sought:
        yield ForceSum(link, guide.name, u, tuple(parts), sought[0])


# Moment equations of a position: those that the force plan of each group needs, and those of the driving links.
#
# External pairs: moments about the internal hinge of a link give the tangential part of its external reaction; in a
# group with three external pairs, moments about the Assur point, where the unknown parts of two reactions meet, give
# the third.
# Guides: moments of the sliding link give the arm of the guide's reaction.


ASSUR_POINT = "W"  # Assur point of a group with three external pairs
MARKS = {"tangential": "τ", "normal": "n"}


@dataclass(frozen=True)
class MomentTerm:
    """Term of a moment equation: the moment of a force or couple about the centre of the equation.

    Attributes:
        acting: the force or couple.
        moment: its moment, N m.
        arm: moment arm of the force, m; 0 for a couple.
        foot: foot of the perpendicular from the centre on the line of action of the force, m.
        number: number of the arm in h₁, h₂, ...; 0 for a couple.
    """

    acting: ForceOrCouple
    moment: float
    arm: float
    foot: complex
    number: int = 0

    @property
    def letter(self) -> Symbol:
        """Symbol of the moment arm, e.g. h₁."""
        return Symbol("h", str(self.number))


@dataclass(frozen=True)
class EquationUnknown:
    """Unknown of an equilibrium equation.

    It is a force, a couple or a component of a reaction, of this kind and in this pair or driver. If `arm` is True, it
    is the arm of a guide reaction.
    """

    symbol: Symbol
    pair: str
    kind: VectorKind = "reaction"
    arm: bool = False


@dataclass(frozen=True)
class MomentEquation:
    """Moment equation of some links about a point. Forces whose lines of action pass through the point have no term.

    Attributes:
        links: the links that are cut free together.
        about, centre: name and position (m) of the point.
        terms: moments that are not zero.
        sought: the unknown; None if all reactions of the group are solved simultaneously. The equation has no term for
            it if the component is zero, or if the guide reaction passes through the point.
        special: True if the point is an Assur point.
    """

    links: tuple[str, ...]
    about: str
    centre: complex
    terms: tuple[MomentTerm, ...]
    sought: EquationUnknown | None = None
    special: bool = False

    @property
    def found(self) -> MomentTerm | None:
        """Term of the unknown; None if the equation has no such term.

        If the unknown guide reaction also has a couple, it is the term of the couple.
        """
        unknowns = [t for t in self.terms if self.sought and _is_unknown(t.acting, self.sought)]
        return min(unknowns, key=lambda t: not t.acting.couple, default=None)

    @property
    def value(self) -> float:
        """Unknown (N, N m, or m for an arm) computed from the other terms; positive in the direction in which it is
        drawn.
        """
        unknown = self.found
        assert unknown is not None and self.sought is not None
        others = sum(t.moment for t in self.terms if t is not unknown)
        moment = -others if unknown.moment > 0 else others
        if unknown.acting.couple:
            return moment
        return moment / (unknown.acting.size if self.sought.arm else unknown.arm)


@dataclass(frozen=True)
class FreeBody:
    """Free body of an Assur group or a driving link: external forces and couples, moment equations and force sums
    along guides.

    driving: True for a driving link.
    """

    links: tuple[str, ...]
    acting: tuple[ForceOrCouple, ...]
    equations: tuple[MomentEquation, ...]
    sums: tuple[ForceSum, ...] = ()
    driving: bool = False


def list_free_bodies(motion: Motion, reactions: Reactions, k: int) -> tuple[FreeBody, ...]:
    """Return the free bodies at position k: the Assur groups from the last to the first, then the driving links."""
    position = LoadedPosition.at(motion, reactions, k)
    groups = [_group_body(position, group) for group in reversed(reactions.groups)]
    return (*groups, *(_driving_link_body(position, frame) for frame in reactions.frames))


def _group_body(position: LoadedPosition, forces: GroupForces) -> FreeBody:
    group = forces.group
    leads = external_pairs(position, group)
    axes = {lead.pair.name: lead.axis for lead in leads if lead.axis is not None}
    equations = [
        *_equations_of_external_pairs(position, group, leads, axes),
        *_equations_of_higher_pairs(position, group, axes),
    ]
    if not equations and len(group.links) > 2:  # all reactions are solved simultaneously
        equations = [
            _moment_equation(position, axes, (link,), *_moment_centre(position, group, link)) for link in group.links
        ]
    else:
        equations += _equations_of_guides(position, group, axes)
    sums = sums_along_guides(position, group, leads, axes)
    return FreeBody(group.links, position.external_forces(group.links, axes), number_arms(equations), sums)


def _equations_of_external_pairs(
    position: LoadedPosition, group: Group, leads: Sequence[ExternalPair], axes: Mapping[str, complex]
) -> Iterable[MomentEquation]:
    for lead in leads:
        if lead.about is not None:
            sought = _unknown_component(group, lead.pair, "tangential")
            yield _moment_equation(position, axes, lead.links, lead.about, position.hinge(lead.about), sought)
    open_hinges = [lead for lead in leads if lead.rest is None and lead.pair.slide is None and lead.about is None]
    special = find_assur_point(position, group, leads)
    if len(leads) == len(group.outer) == 2 and len(open_hinges) == 1:  # one whole reaction and a component
        other = next(lead for lead in leads if lead not in open_hinges)
        about = open_hinges[0].pair.point
        yield _moment_equation(
            position,
            axes,
            group.links,
            about,
            position.hinge(about),
            _unknown_component(group, other.pair, other.open_part),
        )
    elif special is not None:
        lead, centre = special
        # the moment of a guide reaction about the hinge of its link is already known, but not its line of action
        carried = {other.pair.name: other.rest[0] for other in leads if other.pair.slide is not None and other.rest}
        sought = _unknown_component(group, lead.pair, lead.open_part)
        name = distinct_letter(
            {point for link in position.motion.linkage.links.values() for point in link.points}, ASSUR_POINT
        )
        yield replace(_moment_equation(position, axes, group.links, name, centre, sought, carried), special=True)


def _equations_of_higher_pairs(
    position: LoadedPosition, group: Group, axes: Mapping[str, complex]
) -> Iterable[MomentEquation]:
    """Yield the moment equations of gears and cam followers about their hinges.

    If a hinge is the only other pair of such a link, the moments about it give the reaction in the higher pair.
    """
    for pair in group.outer:
        follower = group.own(pair)
        joined = [p for p in (*group.inner, *group.outer) if follower in (p.i, p.j) and p != pair]
        if not pair.lower and [p.kind for p in joined] == ["R"]:
            point = joined[0].point
            yield _moment_equation(
                position, axes, (follower,), point, position.hinge(point), _unknown_component(group, pair, "reaction")
            )


def _equations_of_guides(
    position: LoadedPosition, group: Group, axes: Mapping[str, complex]
) -> Iterable[MomentEquation]:
    """Yield a moment equation of one link of each prismatic pair, which gives the arm of the guide reaction.

    Internal prismatic pairs are included only for the type RPP, which has no internal hinge.
    """
    pairs = (*group.inner, *group.outer)
    inner = group.inner if group.type == "RPP" else ()
    for pair in (p for p in (*inner, *group.outer) if p.slide is not None):
        sides = [link for link in (pair.i, pair.j) if link in group.links]
        own = min(sides, key=lambda n: (not hinge_names(pairs, (n,)), sum(n in (p.i, p.j) for p in pairs)))
        sought = EquationUnknown(reaction_symbol(pair.other(own), own), pair.name, arm=True)
        yield _moment_equation(position, axes, (own,), *_moment_centre(position, group, own, pair), sought)


def _driving_link_body(position: LoadedPosition, frame: Reaction) -> FreeBody:
    """Build the free body of a driving link, with its moment equation.

    The moments of a crank are taken about its pivot, those of a slider about its sliding point.
    """
    link, pair = frame.on, frame.pair
    if pair.slide is not None:
        sought = EquationUnknown(reaction_symbol(frame.by, link), pair.name, arm=True)
    else:
        balance = next(b for b in position.reactions.balances if b.driver.link == link)
        turns = balance.kind == "moment"
        sought = EquationUnknown(balance_symbol(link, len(position.reactions.balances) > 1, turns=turns), DRIVE)
    equation = _moment_equation(position, {}, (link,), pair.point or pair.name, position.pair(pair), sought)
    sums = sums_of_driver(position, pair) if pair.slide is not None else ()
    return FreeBody((link,), position.external_forces((link,), {}), number_arms([equation]), sums, driving=True)


def _unknown_component(group: Group, pair: Pair, kind: VectorKind) -> EquationUnknown:
    link = group.own(pair)
    return EquationUnknown(reaction_symbol(pair.other(link), link, MARKS.get(kind, "")), pair.name, kind)


def _moment_centre(position: LoadedPosition, group: Group, link: str, guide: Pair | None = None) -> tuple[str, complex]:
    """Choose the point for the moment equation of a link.

    It is an internal hinge if there is one, else an external hinge, else the sliding point.

    Returns:
        Name and position (m) of the point.
    """
    hinges = [p for p in (*group.inner, *group.outer) if link in (p.i, p.j) and p.kind == "R"]
    pair = hinges[0] if hinges else guide or next(p for p in (*group.inner, *group.outer) if link in (p.i, p.j))
    return pair.point or pair.name, position.pair(pair)


def _is_unknown(acting: ForceOrCouple, sought: EquationUnknown) -> bool:
    return (acting.pair, acting.kind) == (sought.pair, sought.kind)


def _moment_equation(
    position: LoadedPosition,
    axes: Mapping[str, complex],
    links: Sequence[str],
    about: str,
    centre: complex,
    sought: EquationUnknown | None = None,
    carried: Mapping[str, complex] | None = None,
) -> MomentEquation:
    """Build the moment equation of all external forces on some links about a centre.

    carried: points (m) to which guide reactions are moved, by name of the pair. For each force that is moved, a couple
    is added.
    """
    new_points = carried or {}
    acting = [
        moved
        for force in position.external_forces(links, axes)
        for moved in _move_force(force, new_points.get(force.pair), position.size)
    ]
    return MomentEquation(tuple(links), about, centre, moment_terms(acting, centre, position.size), sought)


def moment_terms(acting: Iterable[ForceOrCouple], centre: complex, extent: float) -> tuple[MomentTerm, ...]:
    """Compute the moments of forces and couples about a centre; moments that are zero within rounding are left out.

    Args:
        acting: forces and couples.
        centre: point for moments, m.
        extent: size of the linkage (m), with which the arms are compared.
    """
    terms = []
    for force in acting:
        if force.couple:
            terms.append(MomentTerm(force, force.moment, 0.0, force.at))
            continue
        along = force.force / abs(force.force)
        foot = force.at - along * float(dot(force.at - centre, along))
        if abs(foot - centre) > NO_COORDINATE * extent:
            terms.append(MomentTerm(force, force.about(centre), abs(foot - centre), foot))
    least = NO_FORCE * max((abs(term.moment) for term in terms), default=0.0)
    return tuple(term for term in terms if abs(term.moment) > least)


def _move_force(acting: ForceOrCouple, place: complex | None, extent: float) -> Iterable[ForceOrCouple]:
    if place is None or acting.couple:
        yield acting
        return
    yield replace(acting, at=place)
    moment = acting.about(place)
    if abs(moment) > NO_COORDINATE * acting.size * extent:
        symbol = replace(acting.symbol, letter="M")
        yield replace(acting, symbol=symbol, kind="inner", force=0j, moment=moment, at=place)


def number_arms(equations: Iterable[MomentEquation]) -> tuple[MomentEquation, ...]:
    """Number the moment arms h₁, h₂, ... of all equations.

    Forces with the same centre and line of action, such as the weight and the inertia force of a link in
    vertical motion, share a number.
    """
    numbered: list[MomentEquation] = []
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
        numbered.append(replace(equation, terms=tuple(terms)))
    return tuple(numbered)
