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
from tmm_cli.note.blocks import Block, Equation, Heading, Line, listed, listed_below, said
from tmm_cli.note.expression import Found, Function, Leaf, read
from tmm_cli.note.forces.equations import MU, along_guide, by_moments, moments, vector_sum
from tmm_cli.note.kinematics.equations import sense
from tmm_cli.note.subject import Subject


@dataclass(frozen=True)
class Part:
    """Group or input link in one position, with its external reactions (for an input link, that of the frame)."""

    subject: Subject
    here: LoadedPosition
    loaded: FreeBody
    plan: ForcePlan
    outer: tuple[Reaction, ...]
    forces: GroupForces | None

    @property
    def links(self) -> tuple[str, ...]:
        return self.loaded.links

    @property
    def sought(self) -> frozenset[Symbol]:
        """Symbols of the external reactions and their components."""
        names = [(r.by, r.on) for r in self.outer]
        return frozenset(
            reaction_symbol(*n, part, letter) for n in names for part in ("", "n", "τ") for letter in ("R", "M")
        )

    @property
    def given(self) -> list[ForceOrCouple]:
        """Forces and couples known before the part is solved."""
        return [one for one in self.loaded.acting if one.symbol not in self.sought and one.pair != DRIVE]

    @property
    def by_moments(self) -> frozenset[Symbol]:
        """Symbols found from equations of moments."""
        return frozenset(e.sought.symbol for e in self.loaded.equations if e.sought and not e.sought.arm)

    @property
    def calculated(self) -> frozenset[Symbol]:
        """Symbols found before the force plan is drawn."""
        return self.by_moments | {s.found.acting.symbol for s in self.sums[0]}

    @property
    def borne(self) -> frozenset[Symbol]:
        """Symbols of the plan known in advance, without balancing loads of drivers."""
        drives = {one.symbol for one in self.loaded.acting if one.pair == DRIVE}
        return frozenset(v.symbol for v in self.plan.plan.vectors) - self.sought - drives

    @property
    def guided(self) -> frozenset[Symbol]:
        """Symbols of forces with a known line of action: reactions of guides and teeth, forces of drivers."""
        outer = {reaction_symbol(r.by, r.on) for r in self.outer if r.pair.slide is not None or not r.pair.lower}
        return frozenset(outer | {one.symbol for one in self.loaded.acting if one.pair == DRIVE})

    @property
    def sums(self) -> tuple[list[ForceSum], list[ForceSum]]:
        """Sums along guides that have one unknown before the force plan is drawn, and the other sums."""
        inner = () if self.forces is None else self.forces.inner
        both = {reaction_symbol(*names) for r in inner for names in ((r.by, r.on), (r.on, r.by))}
        unknown = (self.sought | both) - self.by_moments
        found: tuple[list[ForceSum], list[ForceSum]] = [], []
        for one in self.loaded.sums:
            others = {part.acting.symbol for part in one.parts if part is not one.found}
            found[bool(others & unknown)].append(one)
        return found

    @property
    def inner_first(self) -> bool:
        """True for an RPP group: its two guides leave three unknowns in a plan of both links."""
        return self.forces is not None and self.forces.group.type == "RPP" and len(self.links) == 2

    @property
    def at_once(self) -> bool:
        """True if no equation has a single unknown."""
        return any(e.sought is None for e in self.loaded.equations)

    @property
    def caption(self) -> str:
        """Position of the mechanism in words."""
        return self.subject.at_position(self.here.k)

    @property
    def vectors(self) -> list[NamedVector]:
        """Vectors of the plan without the internal reaction and without negligible loads."""
        least = NO_FORCE * self.plan.plan.size
        return [
            v for v in self.plan.plan.vectors if v.kind != "inner" and (v.symbol in self.sought or abs(v.value) > least)
        ]

    def size(self, reaction: Reaction) -> float:
        """Return the magnitude (N) of a reaction in this position."""
        return abs(complex(reaction.force[self.here.k]))

    def on_paper(self, equation: MomentEquation) -> float | None:
        """Return the scale (m/mm) of the drawing with the arms of an equation; None if arms are in metres."""
        if self.subject.results.problem.note_style.arms != "paper":
            return None
        number = next(n for n, few in enumerate(split_equations(self.loaded.equations)) if equation in few)
        stem = self.stem("group-loads") + (f"-sheet-{number + 1}" if number else "")
        return self.subject.scale("group-loads", self.here.k, stem)

    def stem(self, name: str) -> str:
        """Return the name of the part's drawing."""
        kind = "links" if len(self.links) > 1 else "link"
        return file_safe_name("-".join([self.subject.position(self.here.k).stem(name), kind, *self.links]))


def parts_of(subject: Subject, k: int) -> Iterable[Part]:
    """Yield the groups in one position, last group first, then the input links."""
    motion, reactions = subject.motion, subject.reactions
    here = LoadedPosition.at(motion, reactions, k)
    loaded, plans = list_free_bodies(motion, reactions, k), force_plans(reactions, k, motion)
    owners: list[tuple[tuple[Reaction, ...], GroupForces | None]] = [(g.outer, g) for g in reversed(reactions.groups)]
    owners += [((frame,), None) for frame in reactions.frames]
    for part, plan, (outer, forces) in zip(loaded, plans, owners, strict=True):
        yield Part(subject, here, part, plan, outer, forces)


# The section of a group, or of a driving link: what is sought, equations of moments, force plan, whole reactions.


SIZES = 2  # that a closed polygon gives


def written(part: Part, heading: Heading, *, first: bool) -> Iterable[Block]:
    """Write the section of a group or an input link.

    first: the first section of the note, which explains how to read the vector sum.
    """
    yield heading
    if not part.loaded.acting:
        yield said(_("No loads act here ({links}): all reactions are zero."), links=_links(part.links))
        return
    yield from _taken_apart(part)
    if part.at_once:
        yield said(
            _(
                "There is no point about which only one unknown has a moment, so the equilibrium equations of all "
                "these links are solved together. As a check, the sum of the moments on each link is zero:"
            )
        )
    ready, later = part.sums
    equations = [e for e in part.loaded.equations if e.sought is None or not e.sought.arm]
    yield from chain.from_iterable(_moments(part, e) for e in equations if not e.special)
    yield from chain.from_iterable(map(_projections, ready))
    # what the sums give has moments there
    yield from chain.from_iterable(_moments(part, e) for e in equations if e.special)
    if part.inner_first:
        yield from _guide_between(part)
    yield from _force_plan(part, explained=first)
    if not part.inner_first:
        yield from _inner(part)
    yield from chain.from_iterable(map(_projections, later))
    yield from chain.from_iterable(_moments(part, e) for e in part.loaded.equations if e.sought and e.sought.arm)
    yield from _balance(part)


def _links(names: Sequence[str]) -> str:
    """Return "link 4" or "links 4, 5"."""
    return (_("links {links}") if len(names) > 1 else _("link {links}")).format(links=", ".join(names))


def _projections(forces: ForceSum) -> Iterable[Block]:
    """Write a sum of projections onto a guide."""
    node, found = along_guide(forces)
    yield said(
        _(
            "The sum of the projections of the forces onto the guide {guide} (link {link}) gives {symbol}; {angles} "
            "are the acute angles between the forces and the guide:"
        ),
        guide=forces.guide,
        link=forces.link,
        symbol=found.name,
        angles=Symbol("α", "i"),
    )
    yield from (Equation(node), found)


def _taken_apart(part: Part) -> Iterable[Block]:
    """Write the known loads, the unknown external reactions, and the figure of the part."""
    given = listed(dict.fromkeys(one.symbol for one in part.given))
    group = "" if part.forces is None else part.forces.group.title
    text = _("The input link is considered last. Known: {given}. To be found:")
    if group:
        text = _("Group {group} is separated from the mechanism. Known: {given}. To be found:")
    if group and not given:
        text = _("Group {group} is separated from the mechanism. To be found:")
    yield said(text, group=group, given=given or _("nothing"))
    leads = [] if part.forces is None else external_pairs(part.here, part.forces.group)
    unknown = [_unknown(r, next((lead for lead in leads if lead.pair == r.pair), None)) for r in part.outer]
    moment, force = _("the balancing moment {symbol}"), _("the balancing force {symbol}")
    balances = [one for one in part.loaded.acting if one.pair == DRIVE]
    drives = [filled(moment if one.couple else force, symbol=one.symbol) for one in balances]
    yield listed_below((*unknown, *drives))
    if part.subject.results.problem.note_style.arms == "paper" and part.loaded.equations:
        mu = part.on_paper(part.loaded.equations[0])
        yield said(
            _(
                "The moment arms are given in millimetres of the drawing, whose scale factor is {mu} = {value} "
                "m/mm; couples are divided by this factor."
            ),
            mu=MU,
            value=part.subject.text(mu or 1.0),
        )
    yield from part.subject.figures(
        "group-loads",
        _("All loads and reactions are shown in figure {figure}: the forces not to scale, their moment arms to scale."),
        _("Loads and reactions: {links}; {position}").format(links=_links(part.links), position=part.caption),
        part.here.k,
        part.stem("group-loads"),
        further=_("The other moment arms are shown in figure {figure}."),
    )


def _unknown(reaction: Reaction, lead: ExternalPair | None) -> Line:
    """Return the sentence on the unknowns of an external reaction."""
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
    whole, n, t = (reaction_symbol(reaction.by, reaction.on, part) for part in ("", "n", "τ"))
    places = {"guide": pair.name, "pair": pair.name, "point": pair.point, "link": reaction.on, "line": line}
    return filled(text, **places, R=whole, n=n, t=t)


def _moments(part: Part, equation: MomentEquation) -> Iterable[Block]:
    """Write a moment equation and its unknown: a force, a couple, or the point of action of a guide's reaction."""
    mu = part.on_paper(equation)
    found, sought = by_moments(equation, mu=mu), equation.sought
    if sought is None:
        yield from () if found is None else (found,)
        return
    if sought.arm and found is None:
        text = _("No other force has a moment about point {point} ({links}), so {symbol} passes through this point.")
    elif sought.arm and equation.found is not None and equation.found.acting.couple:
        text = _(
            "The equation of moments about point {point} ({links}) gives the couple that the guide carries in "
            "addition to the reaction {symbol}:"
        )
    elif sought.arm:
        text = _(
            "The equation of moments about point {point} ({links}) gives the distance from it to the line of "
            "action of the reaction {symbol}:"
        )
    elif found is None and not equation.terms:
        text = _("No force has a moment about point {point} ({links}), so {symbol} is zero:")
    elif equation.special:
        text = _(
            "The lines of action of two unknown reactions intersect at the Assur point {point}; the equation "
            "of moments about it ({links}) gives {symbol}:"
        )
    else:
        text = _("The equation of moments about point {point} ({links}) gives {symbol}:")
    yield said(text, point=equation.about, links=_links(equation.links), symbol=sought.symbol)
    if found is not None:
        yield from (Equation(moments(equation, mu)), found)
    elif not sought.arm:
        if equation.terms:  # they cancel
            yield Equation(moments(equation, mu))
        yield read(sought.symbol, 0.0, _("N·m") if sought.symbol.letter == "M" else _("N"))


def _force_plan(part: Part, *, explained: bool) -> Iterable[Block]:
    """Write the closed polygon, the values read off it and the total reactions."""
    known = part.calculated | part.borne
    if part.inner_first:
        known |= {reaction_symbol(r.by, r.on) for r in part.outer if r.pair.slide is not None}
    vectors = part.vectors
    lines = part.guided | {v.symbol for v in vectors if v.kind in ("normal", "tangential")}
    yield said(
        _(
            "The forces form a closed polygon. Vectors known in magnitude and direction are underlined twice, "
            "vectors with a known line of action once:"
        )
        if explained
        else _("The forces form a closed polygon:")
    )
    yield Equation(vector_sum([(v.symbol, 2 if v.symbol in known else 1 if v.symbol in lines else 0) for v in vectors]))
    yield from part.subject.figures(
        "forces",
        _("The force plan is drawn to scale in figure {figure}."),
        _("Force plan: {links}; {position}").format(links=_links(part.links), position=part.caption),
        part.here.k,
        part.stem("forces"),
    )
    unknown = [v for v in vectors if v.symbol not in known]
    if sum(1 if v.symbol in lines else 2 for v in unknown) > SIZES:
        yield said(
            _("The polygon closes with the following reactions, with which each link is also in equilibrium by itself:")
        )
    elif unknown:
        text = _("The lengths of its sides, multiplied by the scale factor {mu}, give the remaining unknowns:")
        yield said(text, mu=Symbol("μ", "F"))
    else:
        yield said(_("All its vectors are already known; the closure of the polygon serves as a check."))
    least = NO_FORCE * part.plan.plan.size
    for vector in unknown:
        size = abs(vector.value)
        yield read(vector.symbol, size if size > least else 0.0, _("N"))
    if part.plan.full:
        yield said(_("The total reactions are:"))
    for reaction in part.outer:
        yield from _whole(part, reaction)


def _whole(part: Part, reaction: Reaction) -> Iterable[Block]:
    """Write a total reaction from its normal and tangential components."""
    names = reaction.by, reaction.on
    parts = {v.symbol: abs(v.value) for v in part.plan.plan.vectors}
    along, across = reaction_symbol(*names, "n"), reaction_symbol(*names, "τ")
    if along in parts and across in parts:
        root = Function("sqrt", Leaf(along, parts[along]) ** 2 + Leaf(across, parts[across]) ** 2)
        yield Found(reaction_symbol(*names), root, part.size(reaction), _("N"))


def _guide_between(part: Part) -> Iterable[Block]:
    """Write the force polygon of the link on which both guides act."""
    assert part.forces is not None
    inner = part.forces.inner[0]
    outer = next(r for r in part.outer if r.pair.slide is not None)
    link = outer.on
    own = reaction_symbol(inner.pair.other(link), link)
    yield said(
        _(
            "The reaction in the internal pair {pair} is perpendicular to the guide of this pair, so the "
            "polygon of the forces on one link ({links}) has only two unknown magnitudes and determines them:"
        ),
        pair=inner.pair.name,
        links=_links([link]),
    )
    sought = {own: inner, reaction_symbol(outer.by, link): outer}
    yield _polygon(part, link, dict.fromkeys(sought, 1))
    for symbol, reaction in sought.items():
        yield read(symbol, part.size(reaction), _("N"))


def _polygon(part: Part, link: str, sought: Mapping[Symbol, int]) -> Equation:
    """Return the force polygon of one link; each unknown with its number of underlines."""
    acting = part.here.acting([link], {})
    known = [one.symbol for one in acting if not one.couple and one.symbol not in sought]
    return Equation(vector_sum([*((symbol, 2) for symbol in known), *sought.items()]))


def _inner(part: Part) -> Iterable[Block]:
    """Write the internal reactions from the equilibrium of one link of each internal pair."""
    inner = () if part.forces is None else part.forces.inner
    if len(inner) == 1:
        (reaction,) = inner
        yield said(
            _(
                "The reaction in the internal pair {pair} closes the polygon of the forces on one of its links "
                "({links}):"
            ),
            pair=reaction.pair.name,
            links=_links([reaction.on]),
        )
        yield _polygon(part, reaction.on, {reaction_symbol(reaction.by, reaction.on): 0})
    elif inner:
        yield said(_("The reactions in the internal pairs follow from the equilibrium of the individual links:"))
    for reaction in inner:
        yield read(reaction_symbol(reaction.by, reaction.on), part.size(reaction), _("N"))


def _balance(part: Part) -> Iterable[Block]:
    """Write the sense or direction of each balancing load."""
    for one in part.loaded.acting:
        if one.pair == DRIVE:
            way = sense(one.moment) if one.couple else part.subject.direction(one.force)
            text = _("{symbol} acts {way}.") if one.couple else _("{symbol} acts at {way} to the x axis.")
            yield said(text, symbol=one.symbol, way=way)
