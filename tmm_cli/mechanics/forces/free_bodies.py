"""Forces and couples on any set of links at one position, with their symbols: loads, reactions in pairs,
drivers.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

from tmm_cli.language import printed, symbol
from tmm_cli.mechanics.forces.loads import AppliedLoad
from tmm_cli.mechanics.forces.reactions import Balance, Reaction, Reactions
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import NO_FORCE, cross, dot, unit
from tmm_cli.mechanics.structure import Group, Pair

VectorKind = Literal[
    "absolute", "relative", "normal", "tangential", "coriolis", "sliding", "load", "inertia", "reaction", "inner"
]


@dataclass(frozen=True)
class Symbol:
    """Symbol of a quantity in a formula: its letter with a subscript (`below`) and a superscript (`above`)."""

    letter: str
    below: str = ""
    above: str = ""

    @property
    def name(self) -> str:
        """Symbol as one line of text, e.g. R₃₄ᵗ."""
        below = f"({self.below})" if "," in self.below else self.below.translate(SUBSCRIPTS)
        return self.letter + below + self.above.translate(_SUPERSCRIPTS)

    @property
    def plain(self) -> str:
        """Symbol with its subscript in ordinary characters, e.g. U3."""
        return self.letter + self.below

    @property
    def primed(self) -> Symbol:
        """Symbol with a prime, e.g. P′ for P."""
        return Symbol(f"{self.letter}′", self.below, self.above)


class CourseSymbol(Symbol):
    """Symbol in the notation of the current language: M_d in English, M_д in Russian."""

    mark: str

    def __init__(self, mark: str) -> None:
        object.__setattr__(self, "mark", mark)

    @property
    def letter(self) -> str:
        return symbol(self.mark).partition("_")[0]

    @property
    def below(self) -> str:
        return symbol(self.mark).partition("_")[2]


SUBSCRIPTS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
_SUPERSCRIPTS = str.maketrans("τn", "ᵗⁿ")


def subscript(text: str) -> str:
    """Return a number as subscript digits, and any other name in parentheses."""
    return text.translate(SUBSCRIPTS) if text.isdecimal() and text.isascii() else f"({text})"


def reaction_symbol(by: str, on: str, mark: str = "", letter: str = "R") -> Symbol:
    """Return the symbol of a reaction: R₃₄ is the force of link 3 on link 4.

    Args:
        by: link that exerts the force.
        on: link on which it acts.
        mark: τ for the tangential component, n for the normal one; empty for the whole reaction.
        letter: M for the couple in a guide or cam pair.
    """
    by, on = printed(by), printed(on)
    return Symbol(letter, by + on if len(by) == len(on) == 1 else f"{by},{on}", mark)


def course_symbol(mark: str, index: str = "") -> Symbol:
    """Return a symbol in the notation of the current language, with an index: U₃ in English, Φ₃ in Russian."""
    letter, _, below = symbol(mark).partition("_")
    return Symbol(letter, below + index)


def balance_symbol(link: str, several: bool, *, turns: bool = False) -> Symbol:
    """Return the symbol of the balancing force F_b or, with `turns`, of the balancing moment M_b.

    With `several` drivers the name of the link is added to the subscript: F_b4.
    """
    index = link if several else ""
    return course_symbol("M_b", index) if turns else course_symbol("F_b", index)


FARTHEST_ARM = 2.0  # sizes of the linkage: beyond it a guide reaction is given as a force and a couple
DRIVE = "drive"
LONGEST_INDEX = 2  # letters after the first one that form an index: Fc; Fcut is a word


@dataclass(frozen=True)
class ForceOrCouple:
    """Force (N) with its point of action on a link (m), or couple (N m). For a couple `force` is zero.

    pair: name of the pair if it is a reaction, DRIVE if it is exerted by a driver, empty for a load.
    """

    symbol: Symbol
    kind: VectorKind
    link: str
    at: complex
    force: complex
    moment: float = 0.0
    pair: str = ""

    @property
    def couple(self) -> bool:
        return self.force == 0

    @property
    def size(self) -> float:
        """Magnitude, N; of a couple N m."""
        return abs(self.moment) if self.couple else abs(self.force)

    def about(self, centre: complex) -> float:
        """Return the moment about a point (N m), positive counterclockwise."""
        return self.moment + float(cross(self.at - centre, self.force))


@dataclass(frozen=True)
class LoadedPosition:
    """Position k of a mechanism with its loads and reactions. `size` is the size of the linkage (m)."""

    motion: Motion
    reactions: Reactions
    k: int
    size: float

    @classmethod
    def at(cls, motion: Motion, reactions: Reactions, k: int) -> LoadedPosition:
        """Select position k of a solved mechanism.

        The size of the linkage is the largest distance between any two moving points or between two points of one
        link: at a single position all moving points may coincide.
        """
        moving = [complex(motion.named(p).x[k]) for p in motion.linkage.moving_points]
        bodies = [moving, *([complex(p) for p in link.points.values()] for link in motion.linkage.links.values())]
        return cls(
            motion, reactions, k, max((abs(p - q) for body in bodies for p in body for q in body), default=0.0) or 1.0
        )

    def place(self, link: str, local: complex) -> complex:
        """Return the position (m) of a point whose coordinates are given in the axes of a link."""
        return complex(local) if link == FRAME else complex(self.motion.poses[link].at(local)[self.k])

    def hinge(self, point: str) -> complex:
        """Return the position (m) of a named point."""
        link = self.motion.linkage.owner(point)
        return self.place(link, self.motion.linkage.local(link, point))

    def pair(self, pair: Pair) -> complex:
        """Return the position (m) of a hinge, or of the sliding point of a prismatic pair."""
        return self.hinge(pair.point) if pair.slide is None else self.place(pair.slide.runner, pair.slide.at)

    def guide(self, pair: Pair) -> complex:
        """Return the unit vector along the guide of a prismatic pair."""
        assert pair.slide is not None
        carrier = pair.slide.carrier
        rotation = 1.0 if carrier == FRAME else complex(self.motion.poses[carrier].z[self.k])
        return complex(rotation * unit(pair.slide.direction))

    def external_forces(self, links: Collection[str], axes: Mapping[str, complex]) -> tuple[ForceOrCouple, ...]:
        """Return the external forces and couples on some links. Those that are negligible compared with the largest are
        left out.

        axes: direction of the normal component, by name of the hinge. The reactions of these hinges are resolved into
        normal and tangential components.
        """
        forces = [*self._loads(links), *self._drives(links)]
        for reaction in self.reactions.all:
            if (reaction.on in links) != (reaction.by in links):
                link = reaction.on if reaction.on in links else reaction.by
                forces += self._reaction(reaction, link, axes.get(reaction.pair.name))
        return drop_negligible(forces, self.size)

    def loads_and_drives(self) -> tuple[ForceOrCouple, ...]:
        """Return the loads on all links and the balancing force or couple of each driver on the link that it drives."""
        drives = [self._drive(balance, balance.driver.link, 1) for balance in self.reactions.balances]
        return drop_negligible([*self._loads(self.motion.linkage.moving), *drives], self.size)

    def _loads(self, links: Collection[str]) -> Iterable[ForceOrCouple]:
        for load in self.reactions.applied:
            if load.link in links:
                kind = vector_kind(load)
                at = complex(self.motion.point(load.link, load.at).x[self.k])
                force, couple = load_symbols(load)
                yield ForceOrCouple(force, kind, load.link, at, complex(load.force[self.k]))
                yield ForceOrCouple(couple, kind, load.link, at, 0j, float(load.moment[self.k]))

    def _drives(self, links: Collection[str]) -> Iterable[ForceOrCouple]:
        for balance in self.reactions.balances:
            driver = balance.driver
            if driver.link in links and driver.base not in links:
                yield self._drive(balance, driver.link, 1)
            elif driver.base in links and driver.link not in links:
                yield self._drive(balance, driver.base, -1)

    def _drive(self, balance: Balance, link: str, sense: int) -> ForceOrCouple:
        driver, k, turns = balance.driver, self.k, balance.kind == "moment"
        symbol = balance_symbol(driver.link, len(self.reactions.balances) > 1, turns=turns)
        if sense < 0:
            symbol = symbol.primed
        if turns:
            moment = sense * float(balance.generalized[k])
            return ForceOrCouple(symbol, "reaction", link, self.hinge(driver.joint), 0j, moment, DRIVE)
        force = sense * complex(balance.vector[k])
        return ForceOrCouple(symbol, "reaction", link, complex(balance.at[k]), force, pair=DRIVE)

    def _reaction(self, reaction: Reaction, link: str, axis: complex | None) -> Iterable[ForceOrCouple]:
        """Yield the reaction on one link of a pair.

        A guide reaction acts at a point of its line of action. A hinge reaction is resolved into two components if
        `axis`, the direction of the normal component, is given.
        """
        k, pair, forward = self.k, reaction.pair, link == reaction.on
        by, at, force = (
            reaction.by if forward else reaction.on,
            complex(reaction.at[k]),
            complex(reaction.onto(link)[k]),
        )
        couple = 0.0
        if reaction.couple is not None:
            if pair.slide is None:  # cam pair; a couple may be drawn anywhere on its link
                at = self.place(link, 0j)
            back = -reaction.couple if reaction.back is None else reaction.back
            couple = float((reaction.couple if forward else back)[k])
        if reaction.arm is not None and abs(reaction.arm[k]) < FARTHEST_ARM * self.size:
            at, couple = at + float(reaction.arm[k]) * self.guide(pair), 0.0
        if axis is None:
            yield ForceOrCouple(reaction_symbol(by, link), "reaction", link, at, force, pair=pair.name)
            yield ForceOrCouple(reaction_symbol(by, link, letter="M"), "reaction", link, at, 0j, couple, pair.name)
        else:
            tangential = component_across(force, axis)
            if reaction.tangential is not None:  # from moments alone, which loses fewer digits
                tangential = complex(reaction.tangential[k])
            yield ForceOrCouple(reaction_symbol(by, link, "n"), "normal", link, at, force - tangential, pair=pair.name)
            yield ForceOrCouple(reaction_symbol(by, link, "τ"), "tangential", link, at, tangential, pair=pair.name)


def component_across(force: complex, axis: complex) -> complex:
    """Return the component of a force perpendicular to an axis."""
    across = axis * 1j / abs(axis)
    return across * float(dot(across, force))


def drop_negligible(acting: Iterable[ForceOrCouple], extent: float) -> tuple[ForceOrCouple, ...]:
    """Drop forces and couples that are zero within rounding, compared with the largest.

    extent: size of the linkage (m), for comparing couples with forces.
    """
    acting = tuple(acting)
    largest = max((a.size / extent if a.couple else a.size for a in acting), default=0.0)
    return tuple(a for a in acting if a.size > NO_FORCE * largest * (extent if a.couple else 1.0))


def vector_kind(load: AppliedLoad) -> VectorKind:
    """Return the kind of vector that represents a load in a force plan: "inertia" or "load"."""
    return "inertia" if load.kind == "inertia" else "load"


def load_symbols(load: AppliedLoad) -> tuple[Symbol, Symbol]:
    """Return the symbols of the force and of the couple of a load.

    Weights and inertia loads carry the number of the link as subscript, friction the name of the pair. A load
    defined in the problem file keeps its name.
    """
    if load.kind == "weight":
        return course_symbol("G", load.link), course_symbol("G", load.link)
    if load.kind == "inertia":
        return course_symbol("U", load.link), course_symbol("M", load.link)
    names = load.name, load.couple_name or load.name
    if load.kind == "friction":
        return Symbol(names[0][:1], names[0][1:]), Symbol(names[1][:1], names[1][1:])
    if load.ambiguous:
        return Symbol("P", load.name), Symbol("M", load.name)
    return symbol_of_name(names[0], "P"), symbol_of_name(names[1], "M")


def load_names(load: AppliedLoad) -> tuple[str, str]:
    """Return the names of the force and of the couple of a load in plain text, as used in tables.

    A load defined in the problem file keeps its name.
    """
    if load.kind == "load":
        return load.name, load.couple_name or load.name
    force, couple = load_symbols(load)
    return force.plain, couple.plain


def symbol_of_name(name: str, letter: str) -> Symbol:
    """Convert a name to a symbol: F₅ for F5, F_c for Fc or F_c. A word becomes a subscript of `letter`, e.g.
    P_press.
    """
    base = name.rstrip("'")
    first, rest = base[:1], base[1:].removeprefix("_")
    short = not rest or rest.isdigit() or base[1] == "_" or (first.isupper() and len(rest) <= LONGEST_INDEX)
    symbol = Symbol(first, rest) if first.isalpha() and short else Symbol(letter, base)
    return symbol.primed if name != base else symbol


# External pairs of a group, through which it is connected to other links; Assur point of three of them.


LEAST_SINE = 0.02  # lines at a smaller angle meet too far away to be drawn


@dataclass(frozen=True)
class ExternalPair:
    """External pair of an Assur group. It describes which component of its reaction each equation gives.

    Attributes:
        pair: the pair.
        links: the group's link in this pair, and all links that rotate together with it because they slide on one
            another.
        axis: direction of the normal component of a hinge reaction; None if the reaction is not resolved into
            components.
        about: hinge about which the moments of `links` give the tangential component; None if there is none.
        rest: point and direction of the line of action of the component that these moments leave unknown.
    """

    pair: Pair
    links: tuple[str, ...]
    axis: complex | None = None
    about: str | None = None
    rest: tuple[complex, complex] | None = None

    @property
    def open_part(self) -> VectorKind:
        """Kind of the reaction component that the moments about `about` leave unknown. It acts along the line
        `rest`.
        """
        if self.pair.slide is not None:
            return "reaction"
        return "tangential" if self.about is None else "normal"


def external_pairs(position: LoadedPosition, group: Group) -> tuple[ExternalPair, ...]:
    """Return the lower external pairs of a group, in the order of the group."""
    return tuple(_external_pair(position, group, pair) for pair in group.outer if pair.lower)


def hinge_names(pairs: Iterable[Pair], links: Collection[str]) -> list[str]:
    """Return the names of the hinges that join one of these links to any other link."""
    return list(dict.fromkeys(p.point for p in pairs if p.kind == "R" and len({p.i, p.j} & {*links}) == 1))


def _external_pair(position: LoadedPosition, group: Group, pair: Pair) -> ExternalPair:
    link_in_group = group.own(pair)
    links = _links_rotating_together(group, link_in_group)
    inner = hinge_names(group.inner, links)
    if pair.slide is not None:
        hinges = hinge_names(group.inner, (link_in_group,))
        rest = (position.hinge(hinges[0]), 1j * position.guide(pair)) if len(hinges) == 1 else None
        return ExternalPair(pair, links, rest=rest)
    at = position.hinge(pair.point)
    outer = [p for p in group.outer if group.own(p) in links]
    if len(inner) == 1 and len(outer) == 1:
        axis = position.hinge(inner[0]) - at
        return ExternalPair(pair, links, axis, inner[0], (at, axis)) if axis else ExternalPair(pair, links)
    driven = {link for driver in group.drivers for link in (driver.base, driver.link)}
    slides = [p for p in group.inner if link_in_group in (p.i, p.j)]
    if len(slides) == 1 and slides[0].slide is not None and link_in_group not in driven:
        axis = position.guide(slides[0])  # only this hinge holds the link along its guide
        others = [p.point for p in outer if p != pair and p.kind == "R"]
        if not inner and len(others) == len(outer) - 1 == 1:
            return ExternalPair(pair, links, axis, others[0])
        return ExternalPair(pair, links, axis if len(group.outer) > 2 else None, rest=(at, 1j * axis))
    return ExternalPair(pair, links)


def _links_rotating_together(group: Group, link: str) -> tuple[str, ...]:
    joined = {link}
    for _ in group.links:
        for pair in group.inner:
            if pair.slide is not None and {pair.i, pair.j} & joined:
                joined |= {pair.i, pair.j}
    return tuple(n for n in group.links if n in joined)


def find_assur_point(
    position: LoadedPosition, group: Group, leads: Sequence[ExternalPair]
) -> tuple[ExternalPair, complex] | None:
    """Find the Assur point of a group with three external pairs.

    The lines of the unknown reaction components of two external pairs meet in it, so the moments about it give
    the reaction of the third pair.

    Returns:
        The third external pair and the point (m); None if there is no such point near the mechanism.
    """
    if len(leads) != 3 or len(group.outer) != 3 or group.drivers or any(lead.rest is None for lead in leads):
        return None
    for lead in sorted(leads, key=lambda lead: lead.open_part == "normal"):
        (p, u), (q, v) = (other.rest for other in leads if other is not lead and other.rest is not None)
        sine = cross(u, v) / (abs(u) * abs(v))
        if abs(sine) > LEAST_SINE:
            centre = p + u * cross(q - p, v) / cross(u, v)
            if abs(centre - position.pair(lead.pair)) < FARTHEST_ARM * position.size:
                return lead, complex(centre)
    return None
