"""Section of the note on one group or input link: loads, unknowns, moment equations, force plan, reactions."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain

from tmm_cli.drawing.paper import file_safe_name
from tmm_cli.drawing.sheets import split_equations
from tmm_cli.language import _, filled
from tmm_cli.mechanics.forces import (
    DRIVE,
    ExternalPair,
    ForceOrCouple,
    ForceSum,
    FreeBody,
    GroupForces,
    LoadedPosition,
    MomentEquation,
    Reaction,
    Symbol,
    external_pairs,
    list_free_bodies,
    reaction_symbol,
)
from tmm_cli.mechanics.numerics import NO_FORCE
from tmm_cli.mechanics.plans import ForcePlan, NamedVector, force_plans
from tmm_cli.note.blocks import Block, Equation, Heading, Line, bulleted_list, join_inline, write_sentence
from tmm_cli.note.expression import ComputedQuantity, Function, Leaf, state_value
from tmm_cli.note.forces.equations import (
    MU,
    moment_equation,
    solve_guide_sum,
    solve_moment_equation,
    vector_sum_equation,
)
from tmm_cli.note.kinematics.equations import name_sense
from tmm_cli.note.subject import Subject


@dataclass(frozen=True)
class AnalysedBody:
    """Assur group or input link in one position, with the results of its force analysis.

    Attributes:
        subject: results that the note describes.
        position: position with its loads and reactions.
        free_body: forces on the group or input link, its moment equations and its sums of projections.
        plan: force plan of the group or input link.
        external: reactions in its external pairs; for an input link, the reaction of the frame.
        forces: forces of the group; None for an input link.
    """

    subject: Subject
    position: LoadedPosition
    free_body: FreeBody
    plan: ForcePlan
    external: tuple[Reaction, ...]
    forces: GroupForces | None

    @property
    def links(self) -> tuple[str, ...]:
        return self.free_body.links

    @property
    def unknown_reactions(self) -> frozenset[Symbol]:
        """Symbols of the external reactions and of their components."""
        names = [(r.by, r.on) for r in self.external]
        return frozenset(
            reaction_symbol(*n, component, letter)
            for n in names
            for component in ("", "n", "τ")
            for letter in ("R", "M")
        )

    @property
    def known_loads(self) -> list[ForceOrCouple]:
        """Forces and couples that are known before the equations of this group or input link are solved."""
        return [
            load for load in self.free_body.acting if load.symbol not in self.unknown_reactions and load.pair != DRIVE
        ]

    @property
    def solved_by_moments(self) -> frozenset[Symbol]:
        """Symbols of the forces and couples that follow from moment equations."""
        return frozenset(e.sought.symbol for e in self.free_body.equations if e.sought and not e.sought.arm)

    @property
    def known_before_plan(self) -> frozenset[Symbol]:
        """Symbols of the unknowns that are found by equations before the force plan is drawn."""
        return self.solved_by_moments | {s.found.acting.symbol for s in self.guide_sums[0]}

    @property
    def loads_of_plan(self) -> frozenset[Symbol]:
        """Symbols of the loads in the force plan, without reactions and without balancing loads of drivers."""
        drives = {load.symbol for load in self.free_body.acting if load.pair == DRIVE}
        return frozenset(v.symbol for v in self.plan.plan.vectors) - self.unknown_reactions - drives

    @property
    def known_lines(self) -> frozenset[Symbol]:
        """Symbols of forces with a known line of action: reactions of guides and higher pairs, forces of drivers."""
        outer = {reaction_symbol(r.by, r.on) for r in self.external if r.pair.slide is not None or not r.pair.lower}
        return frozenset(outer | {load.symbol for load in self.free_body.acting if load.pair == DRIVE})

    @property
    def guide_sums(self) -> tuple[list[ForceSum], list[ForceSum]]:
        """Sums of projections of forces onto guides, in two groups.

        The first group contains the sums with a single unknown, which are solved before the force plan is drawn. The
        second contains the others.
        """
        inner = () if self.forces is None else self.forces.inner
        both = {reaction_symbol(*names) for r in inner for names in ((r.by, r.on), (r.on, r.by))}
        unknown = (self.unknown_reactions | both) - self.solved_by_moments
        sums: tuple[list[ForceSum], list[ForceSum]] = [], []
        for force_sum in self.free_body.sums:
            others = {component.acting.symbol for component in force_sum.parts if component is not force_sum.found}
            sums[bool(others & unknown)].append(force_sum)
        return sums

    @property
    def inner_first(self) -> bool:
        """True for an RPP group of two links.

        For such a group the force polygon of one link is drawn before the force plan, because the plan of both links
        has three unknown magnitudes: two at the external hinge, one on the external guide.
        """
        return self.forces is not None and self.forces.group.type == "RPP" and len(self.links) == 2

    @property
    def needs_common_solution(self) -> bool:
        """True if some moment equation has several unknowns, so that the equations must be solved together."""
        return any(e.sought is None for e in self.free_body.equations)

    @property
    def caption(self) -> str:
        """Number of the position and its driver coordinate, as text."""
        return self.subject.describe_position(self.position.k)

    @property
    def vectors(self) -> list[NamedVector]:
        """Vectors of the force plan. Internal reactions and negligible loads are left out."""
        least = NO_FORCE * self.plan.plan.size
        return [
            v
            for v in self.plan.plan.vectors
            if v.kind != "inner" and (v.symbol in self.unknown_reactions or abs(v.value) > least)
        ]

    def magnitude(self, reaction: Reaction) -> float:
        """Return the magnitude (N) of a reaction in this position."""
        return abs(complex(reaction.force[self.position.k]))

    def arm_scale(self, equation: MomentEquation) -> float | None:
        """Return the scale (m/mm) of the drawing with the arms of an equation; None if arms are printed in metres."""
        if self.subject.results.problem.note_style.arms != "paper":
            return None
        number = next(n for n, few in enumerate(split_equations(self.free_body.equations)) if equation in few)
        stem = self.drawing_name("group-loads") + (f"-sheet-{number + 1}" if number else "")
        return self.subject.scale("group-loads", self.position.k, stem)

    def drawing_name(self, name: str) -> str:
        """Return the file name of a drawing of this group or input link, without its extension."""
        kind = "links" if len(self.links) > 1 else "link"
        return file_safe_name("-".join([self.subject.position(self.position.k).stem(name), kind, *self.links]))


def list_bodies(subject: Subject, k: int) -> Iterable[AnalysedBody]:
    """Yield the Assur groups in position k, from the last to the first, then the input links, each with its forces."""
    motion, reactions = subject.motion, subject.reactions
    position = LoadedPosition.at(motion, reactions, k)
    free_bodies, plans = list_free_bodies(motion, reactions, k), force_plans(reactions, k, motion)
    owners: list[tuple[tuple[Reaction, ...], GroupForces | None]] = [(g.outer, g) for g in reversed(reactions.groups)]
    owners += [((frame,), None) for frame in reactions.frames]
    for free_body, plan, (outer, forces) in zip(free_bodies, plans, owners, strict=True):
        yield AnalysedBody(subject, position, free_body, plan, outer, forces)


# Section on a group or an input link: unknowns, moment equations, force plan, total reactions.


SIZES = 2  # unknown magnitudes that a closed polygon gives


def write_section(body: AnalysedBody, heading: Heading, *, first: bool) -> Iterable[Block]:
    """Write the section on a group or an input link.

    first: True for the first such section of the note, which explains how to read the vector equation.
    """
    yield heading
    if not body.free_body.acting:
        yield write_sentence(
            _("No loads act on this part of the mechanism ({links}), so all reactions are zero."),
            links=_name_links(body.links),
        )
        return
    yield from _write_free_body(body)
    if body.needs_common_solution:
        yield write_sentence(
            _(
                "There is no point about which only one unknown has a moment, so the equilibrium equations of all "
                "these links are solved together. As a check, the sum of the moments on each link is zero:"
            )
        )
    ready, later = body.guide_sums
    equations = [e for e in body.free_body.equations if e.sought is None or not e.sought.arm]
    yield from chain.from_iterable(_write_moments(body, e) for e in equations if not e.special)
    yield from chain.from_iterable(map(_write_projections, ready))
    # the forces that the sums give have moments about Assur points
    yield from chain.from_iterable(_write_moments(body, e) for e in equations if e.special)
    if body.inner_first:
        yield from _write_guide_polygon(body)
    yield from _write_force_plan(body, explained=first)
    if not body.inner_first:
        yield from _write_internal_reactions(body)
    yield from chain.from_iterable(map(_write_projections, later))
    yield from chain.from_iterable(
        _write_moments(body, e) for e in body.free_body.equations if e.sought and e.sought.arm
    )
    yield from _write_balancing_direction(body)


def _name_links(names: Sequence[str]) -> str:
    """Return "link 4" or "links 4, 5"."""
    return (_("links {links}") if len(names) > 1 else _("link {links}")).format(links=", ".join(names))


def _write_projections(forces: ForceSum) -> Iterable[Block]:
    """Write the sum of the components of the forces along a guide, and the unknown force that follows from it."""
    node, unknown = solve_guide_sum(forces)
    yield write_sentence(
        _(
            "The sum of the projections of the forces onto the guide {guide} (link {link}) gives {symbol}; {angles} "
            "are the acute angles between the forces and the guide:"
        ),
        guide=forces.guide,
        link=forces.link,
        symbol=unknown.name,
        angles=Symbol("α", "i"),
    )
    yield from (Equation(node), unknown)


def _write_free_body(body: AnalysedBody) -> Iterable[Block]:
    """Write the known loads on a group or input link and its unknown external reactions, with the drawing of both."""
    known_loads = join_inline(dict.fromkeys(load.symbol for load in body.known_loads))
    group = "" if body.forces is None else body.forces.group.title
    text = _("The input link is considered last. Known: {given}. To be found:")
    if group:
        text = _("Group {group} is separated from the mechanism. Known: {given}. To be found:")
    if group and not known_loads:
        text = _("Group {group} is separated from the mechanism. To be found:")
    yield write_sentence(text, group=group, given=known_loads or _("nothing"))
    leads = [] if body.forces is None else external_pairs(body.position, body.forces.group)
    unknown = [
        _describe_unknowns(r, next((lead for lead in leads if lead.pair == r.pair), None)) for r in body.external
    ]
    moment, force = _("the balancing moment {symbol}"), _("the balancing force {symbol}")
    balances = [load for load in body.free_body.acting if load.pair == DRIVE]
    drives = [filled(moment if load.couple else force, symbol=load.symbol) for load in balances]
    yield bulleted_list((*unknown, *drives))
    if body.subject.results.problem.note_style.arms == "paper" and body.free_body.equations:
        mu = body.arm_scale(body.free_body.equations[0])
        yield write_sentence(
            _(
                "The moment arms are given in millimetres of the drawing, whose scale factor is {mu} = {value} "
                "m/mm; couples are divided by this factor."
            ),
            mu=MU,
            value=body.subject.text(mu or 1.0),
        )
    yield from body.subject.figures(
        "group-loads",
        _("All loads and reactions are shown in figure {figure}: the forces not to scale, their moment arms to scale."),
        _("Loads and reactions: {links}; {position}").format(links=_name_links(body.links), position=body.caption),
        body.position.k,
        body.drawing_name("group-loads"),
        further=_("The other moment arms are shown in figure {figure}."),
    )


def _describe_unknowns(reaction: Reaction, lead: ExternalPair | None) -> Line:
    """Return a list item that names the unknowns of an external reaction."""
    pair, line = reaction.pair, ""
    if not pair.lower:
        text = _("in pair {pair}: magnitude of the reaction {R} along the common normal of the profiles")
    elif pair.slide is not None:
        text = _(
            "on guide {guide}: magnitude and point of action of the reaction {R}, which is perpendicular to the guide"
        )
    elif lead is None or lead.axis is None:
        text = _("at hinge {point}: magnitude and direction of the reaction {R}")
    elif lead.rest is not None and lead.about is not None and len(lead.links) == 1:
        line = pair.point + lead.about
        text = _(
            "at hinge {point}: two components of the reaction {R}, {n} along the line {line} and {t} "
            "perpendicular to it"
        )
    else:
        text = _(
            "at hinge {point}: two components of the reaction {R}, {n} along the guide of link {link} and {t} "
            "perpendicular to it"
        )
    whole, n, t = (reaction_symbol(reaction.by, reaction.on, component) for component in ("", "n", "τ"))
    fields = {"guide": pair.name, "pair": pair.name, "point": pair.point, "link": reaction.on, "line": line}
    return filled(text, **fields, R=whole, n=n, t=t)


def _write_moments(body: AnalysedBody, equation: MomentEquation) -> Iterable[Block]:
    """Write a moment equation, and the force, couple or arm of a guide reaction that follows from it."""
    mu = body.arm_scale(equation)
    quantity, sought = solve_moment_equation(equation, mu=mu), equation.sought
    if sought is None:
        yield from () if quantity is None else (quantity,)
        return
    if sought.arm and quantity is None:
        text = _("No other force has a moment about point {point} ({links}), so {symbol} passes through this point.")
    elif sought.arm and equation.found is not None and equation.found.acting.couple:
        text = _(
            "The equation of moments about point {point} ({links}) gives the couple that the guide carries in "
            "addition to the reaction {symbol}:"
        )
    elif sought.arm:
        text = _(
            "The equation of moments about point {point} ({links}) gives the distance from this point to the "
            "line of action of the reaction {symbol}:"
        )
    elif quantity is None and not equation.terms:
        text = _("No force has a moment about point {point} ({links}), so {symbol} is zero:")
    elif equation.special:
        text = _(
            "The lines of action of two unknown reactions intersect at the Assur point {point}; the equation "
            "of moments about it ({links}) gives {symbol}:"
        )
    else:
        text = _("The equation of moments about point {point} ({links}) gives {symbol}:")
    yield write_sentence(text, point=equation.about, links=_name_links(equation.links), symbol=sought.symbol)
    if quantity is not None:
        yield from (Equation(moment_equation(equation, mu)), quantity)
    elif not sought.arm:
        if equation.terms:  # the moments cancel
            yield Equation(moment_equation(equation, mu))
        yield state_value(sought.symbol, 0.0, _("N·m") if sought.symbol.letter == "M" else _("N"))


def _write_force_plan(body: AnalysedBody, *, explained: bool) -> Iterable[Block]:
    """Write the closed force polygon, the values measured on it and the total reactions."""
    known_symbols = body.known_before_plan | body.loads_of_plan
    if body.inner_first:
        known_symbols |= {reaction_symbol(r.by, r.on) for r in body.external if r.pair.slide is not None}
    vectors = body.vectors
    lines = body.known_lines | {v.symbol for v in vectors if v.kind in ("normal", "tangential")}
    yield write_sentence(
        _(
            "The forces form a closed polygon. Vectors known in magnitude and direction are underlined twice, "
            "vectors with a known line of action once:"
        )
        if explained
        else _("The forces form a closed polygon:")
    )
    yield Equation(
        vector_sum_equation(
            [(v.symbol, 2 if v.symbol in known_symbols else 1 if v.symbol in lines else 0) for v in vectors]
        )
    )
    yield from body.subject.figures(
        "forces",
        _("The force plan is drawn to scale in figure {figure}."),
        _("Force plan: {links}; {position}").format(links=_name_links(body.links), position=body.caption),
        body.position.k,
        body.drawing_name("forces"),
    )
    unknown = [v for v in vectors if v.symbol not in known_symbols]
    if sum(1 if v.symbol in lines else 2 for v in unknown) > SIZES:
        yield write_sentence(
            _("The polygon closes with the following reactions; with them each link by itself is also in equilibrium:")
        )
    elif unknown:
        text = _(
            "The lengths of the sides of the polygon, multiplied by the scale factor {mu}, give the remaining unknowns:"
        )
        yield write_sentence(text, mu=Symbol("μ", "F"))
    else:
        yield write_sentence(_("All vectors of the polygon are already known; that it closes serves as a check."))
    least = NO_FORCE * body.plan.plan.size
    for vector in unknown:
        magnitude = abs(vector.value)
        yield state_value(vector.symbol, magnitude if magnitude > least else 0.0, _("N"))
    if body.plan.full:
        yield write_sentence(_("The total reactions are:"))
    for reaction in body.external:
        yield from _write_total_reaction(body, reaction)


def _write_total_reaction(body: AnalysedBody, reaction: Reaction) -> Iterable[Block]:
    """Write a total reaction from its normal and tangential components."""
    names = reaction.by, reaction.on
    magnitudes = {v.symbol: abs(v.value) for v in body.plan.plan.vectors}
    along, across = reaction_symbol(*names, "n"), reaction_symbol(*names, "τ")
    if along in magnitudes and across in magnitudes:
        root = Function("sqrt", Leaf(along, magnitudes[along]) ** 2 + Leaf(across, magnitudes[across]) ** 2)
        yield ComputedQuantity(reaction_symbol(*names), root, body.magnitude(reaction), _("N"))


def _write_guide_polygon(body: AnalysedBody) -> Iterable[Block]:
    """Write the force polygon of the link on which both guides of an RPP group act."""
    assert body.forces is not None
    inner = body.forces.inner[0]
    outer = next(r for r in body.external if r.pair.slide is not None)
    link = outer.on
    inner_symbol = reaction_symbol(inner.pair.other(link), link)
    yield write_sentence(
        _(
            "The reaction in the internal pair {pair} is perpendicular to the guide of this pair, so the "
            "polygon of the forces on one link ({links}) has only two unknown magnitudes and determines them:"
        ),
        pair=inner.pair.name,
        links=_name_links([link]),
    )
    sought = {inner_symbol: inner, reaction_symbol(outer.by, link): outer}
    yield _polygon_of_link(body, link, dict.fromkeys(sought, 1))
    for symbol, reaction in sought.items():
        yield state_value(symbol, body.magnitude(reaction), _("N"))


def _polygon_of_link(body: AnalysedBody, link: str, sought: Mapping[Symbol, int]) -> Equation:
    """Return the vector equation by which the sum of all forces on a link is zero.

    sought: unknown forces, with the number of underlines of each.
    """
    acting = body.position.external_forces([link], {})
    known_symbols = [load.symbol for load in acting if not load.couple and load.symbol not in sought]
    return Equation(vector_sum_equation([*((symbol, 2) for symbol in known_symbols), *sought.items()]))


def _write_internal_reactions(body: AnalysedBody) -> Iterable[Block]:
    """Write the internal reactions, each from the equilibrium of one of its two links."""
    inner = () if body.forces is None else body.forces.inner
    if len(inner) == 1:
        (reaction,) = inner
        yield write_sentence(
            _(
                "The reaction in the internal pair {pair} closes the polygon of the forces on one of its links "
                "({links}):"
            ),
            pair=reaction.pair.name,
            links=_name_links([reaction.on]),
        )
        yield _polygon_of_link(body, reaction.on, {reaction_symbol(reaction.by, reaction.on): 0})
    elif inner:
        yield write_sentence(
            _("The reactions in the internal pairs follow from the equilibrium of the individual links:")
        )
    for reaction in inner:
        yield state_value(reaction_symbol(reaction.by, reaction.on), body.magnitude(reaction), _("N"))


def _write_balancing_direction(body: AnalysedBody) -> Iterable[Block]:
    """Write the sense of each balancing moment and the direction of each balancing force."""
    for load in body.free_body.acting:
        if load.pair == DRIVE:
            direction = name_sense(load.moment) if load.couple else body.subject.direction(load.force)
            text = _("{symbol} acts {way}.") if load.couple else _("{symbol} acts at {way} to the x axis.")
            yield write_sentence(text, symbol=load.symbol, way=direction)
