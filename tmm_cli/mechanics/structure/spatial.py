"""Chains in space, given by pairs alone: mobility, contours, local freedoms, manoeuvrability.

Mobility after P. I. Somov and A. P. Malyshev, W = 6n - 5 p1 - 4 p2 - 3 p3 - 2 p4 - p5, n moving links and pi pairs with
i freedoms. It is a count: special dimensions (parallel axes, axes through one point) show as redundant constraints,
q = Wo + Wm - W.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from tmm_cli.language import N_
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.structure.graph import Contour, find_contours

SPACE = 6  # freedoms of a free link
PAIR_FREEDOMS: dict[str, int] = {  # of pairs, in the words of a file, by which they are translated too; their freedoms
    N_("turning"): 1,
    N_("sliding"): 1,
    N_("screw"): 1,
    N_("cylindrical"): 2,
    N_("spherical with a pin"): 2,
    N_("universal"): 2,
    N_("spherical"): 3,
    N_("planar"): 3,
    N_("sphere in cylinder"): 4,
    N_("cylinder on plane"): 4,
    N_("sphere on plane"): 5,
}
TELESCOPIC = {"sliding", "screw", "cylindrical"}
BALL_OR_PLATE = {"spherical", "planar"}
AXLE_FREEDOMS = {"turning": 1, "cylindrical": 2}  # of rollers, with the freedoms that a roller on it has by itself
CONTACT_PAIRS = {"sphere in cylinder", "cylinder on plane", "sphere on plane"}  # of rollers


@dataclass(frozen=True)
class SpatialPair:
    """A pair of two links in space with 1 to 5 freedoms; kind is one of KINDS, or empty when it is not known."""

    name: str
    i: str
    j: str
    freedoms: int
    kind: str = ""

    @property
    def pair_class(self) -> int:
        """Class of the pair after I. I. Artobolevsky: the number of its constraints."""
        return SPACE - self.freedoms

    def other(self, link: str) -> str:
        """The link at the other side."""
        return self.j if link == self.i else self.i


@dataclass(frozen=True)
class SpatialChain:
    """Moving links and the pairs that join them to one another and to the frame, link "0"."""

    links: tuple[str, ...]
    pairs: tuple[SpatialPair, ...]

    def p(self, freedoms: int) -> int:
        """Number of pairs with so many freedoms."""
        return sum(pair.freedoms == freedoms for pair in self.pairs)

    @property
    def mobility(self) -> int:
        """Somov-Malyshev's W."""
        return SPACE * len(self.links) - sum(pair.pair_class for pair in self.pairs)

    @property
    def count(self) -> str:
        """The same with its numbers: 6*5 - 5*7 = -5."""
        terms = [(SPACE - i, self.p(i)) for i in range(1, SPACE)]
        parts = "".join(f" - {f'{weight}*' if weight > 1 else ''}{many}" for weight, many in terms if many)
        return f"{SPACE}*{len(self.links)}{parts} = {self.mobility}"

    def around(self, link: str) -> tuple[SpatialPair, ...]:
        """The pairs of a link."""
        return tuple(pair for pair in self.pairs if link in (pair.i, pair.j))

    def only(self, links: Iterable[str]) -> SpatialChain:
        """The chain of some of its links."""
        kept = tuple(links)
        ends = {FRAME, *kept}
        return SpatialChain(kept, tuple(pair for pair in self.pairs if {pair.i, pair.j} <= ends))

    def held(self, link: str) -> SpatialChain:
        """The chain with one more link held: a part of the frame. Its pairs with the frame have nothing to do then."""
        pairs = (
            SpatialPair(p.name, FRAME if p.i == link else p.i, FRAME if p.j == link else p.j, p.freedoms, p.kind)
            for p in self.pairs
        )
        return SpatialChain(tuple(name for name in self.links if name != link), tuple(p for p in pairs if p.i != p.j))


@dataclass(frozen=True)
class LocalFreedom:
    """Freedoms of a link, or of parts in series that slide in one another, which move nothing else.

    ends: the pairs that hold them.
    """

    links: tuple[str, ...]
    freedoms: int
    ends: tuple[SpatialPair, ...]

    @property
    def kinds(self) -> set[str]:
        """The kinds of the pairs that hold them."""
        return {pair.kind for pair in self.ends}


@dataclass(frozen=True)
class ChainCount:
    """What the count says of a chain.

    local: the local freedoms that follow from the kinds of pairs; given_local: those that were told instead (a
    number). wanted: mobility that the chain is meant to have. output: the link to be held for the manoeuvrability.
    """

    chain: SpatialChain
    contours: tuple[Contour, ...]
    local: tuple[LocalFreedom, ...]
    given_local: int | None = None
    wanted: int | None = None
    output: str | None = None

    @property
    def mobility(self) -> int:
        return self.chain.mobility

    @property
    def local_mobility(self) -> int:
        """Wm: as given, or as found."""
        return sum(part.freedoms for part in self.local) if self.given_local is None else self.given_local

    @property
    def redundant(self) -> int | None:
        """Redundant (passive) constraints q = Wo + Wm - W, when the wanted mobility Wo is given."""
        return None if self.wanted is None else self.wanted + self.local_mobility - self.mobility

    @property
    def effective(self) -> int:
        """The mobility without the local freedoms."""
        return self.mobility - self.local_mobility

    @property
    def immobile(self) -> tuple[str, ...]:
        """The links that by the count cannot move: all of them, or those in contours when only the open branches move.

        Empty where a wanted mobility is given: the dimensions then make constraints redundant.
        """
        if self.wanted is not None or not self.contours:
            return ()
        if self.effective < 1:
            return self.chain.links
        closed = self.chain.only(link for link in self.chain.links if link not in self.branches)
        local = sum(part.freedoms for part in self.local if not {*part.links} & {*self.branches})
        return closed.links if self.branches and self.given_local is None and closed.mobility - local < 1 else ()

    @property
    def manoeuvrability(self) -> int | None:
        """Mobility with the output held, when there is one."""
        return None if self.output is None else self.chain.held(self.output).mobility

    @property
    def idle_manoeuvrability(self) -> int:
        """How much of the manoeuvrability is local freedoms, which help around no obstacle."""
        return sum(part.freedoms for part in self.local if self.output is not None and self.output not in part.links)

    @property
    def branches(self) -> tuple[str, ...]:
        """Moving links that lie in no contour."""
        closed = {link for contour in self.contours for link in contour.links}
        return tuple(link for link in self.chain.links if link not in closed)

    @property
    def form(self) -> str:
        """open, closed, or mixed: contours with open branches."""
        if not self.contours:
            return "open"
        return "mixed" if self.branches else "closed"


def count_chain(
    chain: SpatialChain, output: str | None = None, given_local: int | None = None, wanted: int | None = None
) -> ChainCount:
    """Everything that can be counted of a chain."""
    found = find_contours(chain.pairs, chain.links)
    closed = {link for contour in found for link in contour.links}
    certain = local_freedoms(chain)
    spare = chain.mobility - sum(part.freedoms for part in certain) - (1 if wanted is None else wanted)
    pistons = [p for p in pistons_on_balls(chain) if closed.issuperset(p.links) and not _shares_links(p, certain)]
    order = {link: number for number, link in enumerate(chain.links)}
    local = sorted((*certain, *pistons[: max(spare, 0)]), key=lambda part: order[part.links[0]])
    return ChainCount(chain, found, tuple(local), given_local, wanted, output)


def _shares_links(part: LocalFreedom, others: Iterable[LocalFreedom]) -> bool:
    return any({*part.links} & {*other.links} for other in others)


def pistons_on_balls(chain: SpatialChain) -> tuple[LocalFreedom, ...]:
    """Links between a cylindrical pair and a ball: they rotate about the axis of the pair if the ball lies on it.

    Kinds of pairs do not say where the ball lies, so these are local freedoms only of a chain that has freedoms to
    spare.
    """
    return tuple(
        LocalFreedom((link,), 1, ends)
        for link in chain.links
        if len(ends := chain.around(link)) == 2 and {p.kind for p in ends} == {"cylindrical", "spherical"}
    )


def local_freedoms(chain: SpatialChain) -> tuple[LocalFreedom, ...]:
    """Local freedoms that follow from the kinds of pairs, whatever the dimensions.

    A link between two balls turns about the line of their centres; between a ball and a plate, about the normal
    through the centre; between two plates it slides along both. So does a strut of parts that slide in one another. A
    roller turns about its axle on a moving link. Other links have at least the freedoms that are left when their
    neighbours are held.
    """
    around: dict[str, list[SpatialPair]] = {link: [] for link in (FRAME, *chain.links)}
    for pair in chain.pairs:
        around[pair.i].append(pair)
        around[pair.j].append(pair)
    found = []
    for links in _struts(chain, around):
        touching = list(dict.fromkeys(p for link in links for p in around[link]))
        inner = [p for p in touching if p.i in links and p.j in links]
        ends = [p for p in touching if p not in inner]
        freedoms = _certain_freedoms(inner, ends)
        if freedoms > 0 and len({other for p in ends for other in (p.i, p.j) if other not in links}) > 1:
            found.append(LocalFreedom(links, freedoms, tuple(ends)))
    rollers = [part for part in _rollers(chain) if not _shares_links(part, found)]
    return (*found, *rollers)


def _rollers(chain: SpatialChain) -> Iterable[LocalFreedom]:
    """Links that touch another one and have their axle on a moving link; of two that touch one another, the later."""
    contacts: dict[str, LocalFreedom] = {}
    for link in chain.links:
        ends = chain.around(link)
        axles = [p for p in ends if p.kind in AXLE_FREEDOMS and FRAME not in (p.i, p.j)]
        contact = [p for p in ends if p.kind in CONTACT_PAIRS]
        if len(ends) == 2 and len(axles) == len(contact) == 1 and axles[0].other(link) != contact[0].other(link):
            contacts[contact[0].name] = LocalFreedom((link,), AXLE_FREEDOMS[axles[0].kind], ends)
    return contacts.values()


def _certain_freedoms(inner: list[SpatialPair], ends: list[SpatialPair]) -> int:
    """Freedoms of parts in series, or of one link, with all neighbours held."""
    if len(ends) < 2:
        return 0  # the open end of a chain: what it does is not local
    turns = len(ends) == 2 and {p.kind for p in ends} <= BALL_OR_PLATE
    return max(sum(p.freedoms for p in (*inner, *ends)) - SPACE * (len(ends) - 1), int(turns))


def _struts(chain: SpatialChain, around: dict[str, list[SpatialPair]]) -> Iterable[tuple[str, ...]]:
    """The links one by one, or together when they are parts of a strut; in the order of the chain."""
    part_of = {link: [link] for link in chain.links}
    for pair in chain.pairs:
        simple = FRAME not in (pair.i, pair.j) and len(around[pair.i]) == len(around[pair.j]) == 2
        if simple and pair.kind in TELESCOPIC and part_of[pair.i] is not part_of[pair.j]:
            together = sorted(part_of[pair.i] + part_of[pair.j], key=chain.links.index)
            part_of |= dict.fromkeys(together, together)
    # only struts between two balls or plates turn as one; of others, the parts are looked at one by one
    for link in chain.links:
        links = part_of[link]
        ends = [p for x in links for p in around[x] if not (p.i in links and p.j in links)]
        if not {p.kind for p in ends} <= BALL_OR_PLATE:
            yield (link,)
        elif link == links[0]:
            yield tuple(links)


# What is found of a chain given by pairs alone: its count.


@dataclass(frozen=True)
class ChainResults:
    """What was counted of a chain; it has no dimensions, so nothing else is computed. problem: as in Results."""

    problem: Any
    chain: ChainCount
