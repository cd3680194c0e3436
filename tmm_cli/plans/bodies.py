"""What acts on some links of a position taken together: loads, reactions in pairs with other links, drivers."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass

from tmm_cli.forces.applied import Applied
from tmm_cli.forces.plan import Balance, Reaction, Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.linkage import FRAME
from tmm_cli.plans.record import Kind, Symbol, balance_symbol, lettered, reaction_symbol
from tmm_cli.structure.assur import Pair
from tmm_cli.tolerances import NO_FORCE
from tmm_cli.vectors import cross, dot, unit

FAR = 2.0  # sizes of the linkage: a guide's force that acts farther away is told as a force and a couple
DRIVE = "drive"
SHORT = 2  # letters after the first one of a name that is an index of it: Fc, Fcut is a word


@dataclass(frozen=True)
class Acting:
    """A force (N) at a place (m) of a link; or a couple (N m), which has no force.

    pair: the name of the pair, or DRIVE, that it comes from; empty of loads.
    """

    symbol: Symbol
    kind: Kind
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
        """N, or N m of a couple."""
        return abs(self.moment) if self.couple else abs(self.force)

    def about(self, centre: complex) -> float:
        """Its moment about a place, N m, positive counterclockwise."""
        return self.moment + float(cross(self.at - centre, self.force))


@dataclass(frozen=True)
class Loaded:
    """A position under its forces; size of the linkage, m."""

    motion: Motion
    reactions: Reactions
    k: int
    size: float

    @classmethod
    def at(cls, motion: Motion, reactions: Reactions, k: int) -> Loaded:
        """A position by its index. Its size is that of the moving points, at least the longest link.

        In one position all moving points may coincide but for rounding.
        """
        moving = [complex(motion.named(p).x[k]) for p in motion.linkage.moving_points]
        bodies = [moving, *([complex(p) for p in link.points.values()] for link in motion.linkage.links.values())]
        return cls(
            motion, reactions, k, max((abs(p - q) for body in bodies for p in body for q in body), default=0.0) or 1.0
        )

    def place(self, link: str, local: complex) -> complex:
        """A point of a link, m."""
        return complex(local) if link == FRAME else complex(self.motion.poses[link].at(local)[self.k])

    def hinge(self, point: str) -> complex:
        """A named point, m."""
        link = self.motion.linkage.owner(point)
        return self.place(link, self.motion.linkage.local(link, point))

    def pair(self, pair: Pair) -> complex:
        """A hinge, or the running point of a sliding pair, m."""
        return self.hinge(pair.point) if pair.slide is None else self.place(pair.slide.runner, pair.slide.at)

    def guide(self, pair: Pair) -> complex:
        """The direction of a sliding pair's guide."""
        assert pair.slide is not None
        carrier = pair.slide.carrier
        turned = 1.0 if carrier == FRAME else complex(self.motion.poses[carrier].z[self.k])
        return complex(turned * unit(pair.slide.direction))

    def acting(self, links: Collection[str], axes: Mapping[str, complex]) -> tuple[Acting, ...]:
        """All that acts on these links from without; what is zero beside the largest is left out.

        axes: directions, by the names of hinges, along which and across which their reactions are parted.
        """
        found = [*self._loads(links), *self._drives(links)]
        for reaction in self.reactions.all:
            if (reaction.on in links) != (reaction.by in links):
                link = reaction.on if reaction.on in links else reaction.by
                found += self._reaction(reaction, link, axes.get(reaction.pair.name))
        return there(found, self.size)

    def given(self) -> tuple[Acting, ...]:
        """The loads of all links, and what balances each driver, on the link that it drives."""
        drives = [self._drive(balance, balance.driver.link, 1) for balance in self.reactions.balances]
        return there([*self._loads(self.motion.linkage.moving), *drives], self.size)

    def _loads(self, links: Collection[str]) -> Iterable[Acting]:
        for load in self.reactions.applied:
            if load.link in links:
                kind = kind_of(load)
                at = complex(self.motion.point(load.link, load.at).x[self.k])
                force, couple = load_symbols(load)
                yield Acting(force, kind, load.link, at, complex(load.force[self.k]))
                yield Acting(couple, kind, load.link, at, 0j, float(load.moment[self.k]))

    def _drives(self, links: Collection[str]) -> Iterable[Acting]:
        for balance in self.reactions.balances:
            driver = balance.driver
            if driver.link in links and driver.base not in links:
                yield self._drive(balance, driver.link, 1)
            elif driver.base in links and driver.link not in links:
                yield self._drive(balance, driver.base, -1)

    def _drive(self, balance: Balance, link: str, sense: int) -> Acting:
        driver, k, turns = balance.driver, self.k, balance.kind == "moment"
        symbol = balance_symbol(driver.link, len(self.reactions.balances) > 1, turns=turns)
        if sense < 0:
            symbol = symbol.primed
        if turns:
            moment = sense * float(balance.generalized[k])
            return Acting(symbol, "reaction", link, self.hinge(driver.joint), 0j, moment, DRIVE)
        force = sense * complex(balance.vector[k])
        return Acting(symbol, "reaction", link, complex(balance.at[k]), force, pair=DRIVE)

    def _reaction(self, reaction: Reaction, link: str, axis: complex | None) -> Iterable[Acting]:
        """On one of its two links: a guide's where it acts, a hinge's in two parts where it has an axis."""
        k, pair, own = self.k, reaction.pair, link == reaction.on
        by, at, force = reaction.by if own else reaction.on, complex(reaction.at[k]), complex(reaction.onto(link)[k])
        couple = 0.0
        if reaction.couple is not None:
            if pair.slide is None:  # of a cam; a couple may stand anywhere on its link
                at = self.place(link, 0j)
            back = -reaction.couple if reaction.back is None else reaction.back
            couple = float((reaction.couple if own else back)[k])
        if reaction.arm is not None and abs(reaction.arm[k]) < FAR * self.size:
            at, couple = at + float(reaction.arm[k]) * self.guide(pair), 0.0
        if axis is None:
            yield Acting(reaction_symbol(by, link), "reaction", link, at, force, pair=pair.name)
            yield Acting(reaction_symbol(by, link, letter="M"), "reaction", link, at, 0j, couple, pair.name)
        else:
            tangential = part_across(force, axis)
            if reaction.tangential is not None:  # found from moments alone; of the whole force less digits are left
                tangential = complex(reaction.tangential[k])
            yield Acting(reaction_symbol(by, link, "n"), "normal", link, at, force - tangential, pair=pair.name)
            yield Acting(reaction_symbol(by, link, "τ"), "tangential", link, at, tangential, pair=pair.name)


def part_across(force: complex, axis: complex) -> complex:
    """The part of a force that is across an axis."""
    across = axis * 1j / abs(axis)
    return across * float(dot(across, force))


def there(acting: Iterable[Acting], size: float) -> tuple[Acting, ...]:
    """Without what is zero but for rounding beside the largest; size: of the linkage, m."""
    acting = tuple(acting)
    largest = max((a.size / size if a.couple else a.size for a in acting), default=0.0)
    return tuple(a for a in acting if a.size > NO_FORCE * largest * (size if a.couple else 1.0))


def kind_of(load: Applied) -> Kind:
    """As vectors of plans have it."""
    return "inertia" if load.kind == "inertia" else "load"


def load_symbols(load: Applied) -> tuple[Symbol, Symbol]:
    """Of its force and of its couple: with the link, or of friction the pair, below the line if they are not given."""
    if load.kind == "weight":
        return lettered("G", load.link), lettered("G", load.link)
    if load.kind == "inertia":
        return lettered("U", load.link), lettered("M", load.link)
    names = load.name, load.couple_name or load.name
    if load.kind == "friction":
        return Symbol(names[0][:1], names[0][1:]), Symbol(names[1][:1], names[1][1:])
    if load.ambiguous:
        return Symbol("P", load.name), Symbol("M", load.name)
    return named(names[0], "P"), named(names[1], "M")


def load_names(load: Applied) -> tuple[str, str]:
    """The same on one line, as tables of the results have them; one that is given has its name of the file."""
    if load.kind == "load":
        return load.name, load.couple_name or load.name
    force, couple = load_symbols(load)
    return force.plain, couple.plain


def named(name: str, letter: str) -> Symbol:
    """F of F, F₅ of F5, F_c of Fc or F_c; of a word this letter with the word below it: P_press of press."""
    base = name.rstrip("'")
    first, rest = base[:1], base[1:].removeprefix("_")
    short = not rest or rest.isdigit() or base[1] == "_" or (first.isupper() and len(rest) <= SHORT)
    symbol = Symbol(first, rest) if first.isalpha() and short else Symbol(letter, base)
    return symbol.primed if name != base else symbol
