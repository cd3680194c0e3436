"""Spatial chains given by their pairs alone: mobility, contours, local (passive) degrees of freedom, manoeuvrability.

Mobility after P. I. Somov and A. P. Malyshev: W = 6n - 5 p1 - 4 p2 - 3 p3 - 2 p4 - p5, with n moving links and pi pairs
of i degrees of freedom. This is only a count: special dimensions (parallel axes, axes through one point) appear as
redundant constraints, q = Wo + Wm - W, with the intended mobility Wo and the number Wm of local degrees of freedom. A
local (passive, idle) degree of freedom is a motion of a link that moves no other link.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

from tmm_cli.language import N_
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.structure.graph import Contour, find_contours

SPACE = 6  # freedoms of a free link
PAIR_FREEDOMS: dict[
    str, int
] = {  # freedoms of the kinds of pairs; the keys are words of problem files and are translated
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
AXLE_FREEDOMS = {
    "turning": 1,
    "cylindrical": 2,
}  # pairs of a roller and its axle, with the local freedoms of the roller
CONTACT_PAIRS = {"sphere in cylinder", "cylinder on plane", "sphere on plane"}  # pairs of a roller and its track


@dataclass(frozen=True)
class SpatialPair:
    """A kinematic pair of two links in space.

    Attributes:
        name: name of the pair.
        i, j: names of its links.
        freedoms: degrees of freedom, 1 to 5.
        kind: a key of PAIR_FREEDOMS, e.g. "spherical"; empty if unknown.
    """

    name: str
    i: str
    j: str
    freedoms: int
    kind: str = ""

    @property
    def pair_class(self) -> int:
        """Class of the pair after I. I. Artobolevsky, the number of its constraints."""
        return SPACE - self.freedoms

    def other(self, link: str) -> str:
        """Return the link that forms this pair with `link`."""
        return self.j if link == self.i else self.i


@dataclass(frozen=True)
class SpatialChain:
    """A spatial kinematic chain.

    Attributes:
        links: names of the moving links.
        pairs: pairs that join the links to one another and to the frame, link "0".
    """

    links: tuple[str, ...]
    pairs: tuple[SpatialPair, ...]

    def p(self, freedoms: int) -> int:
        """Return the number of pairs that have this many freedoms."""
        return sum(pair.freedoms == freedoms for pair in self.pairs)

    @property
    def mobility(self) -> int:
        """Mobility W by the formula of Somov and Malyshev."""
        return SPACE * len(self.links) - sum(pair.pair_class for pair in self.pairs)

    @property
    def count(self) -> str:
        """The mobility formula with numbers inserted, e.g. 6*5 - 5*7 = -5."""
        terms = [(SPACE - i, self.p(i)) for i in range(1, SPACE)]
        parts = "".join(f" - {f'{weight}*' if weight > 1 else ''}{many}" for weight, many in terms if many)
        return f"{SPACE}*{len(self.links)}{parts} = {self.mobility}"

    def around(self, link: str) -> tuple[SpatialPair, ...]:
        """Return all pairs in which a link takes part."""
        return tuple(pair for pair in self.pairs if link in (pair.i, pair.j))

    def only(self, links: Iterable[str]) -> SpatialChain:
        """Return the part of the chain that consists of these links, with their pairs among themselves and with the
        frame.
        """
        kept = tuple(links)
        ends = {FRAME, *kept}
        return SpatialChain(kept, tuple(pair for pair in self.pairs if {pair.i, pair.j} <= ends))

    def held(self, link: str) -> SpatialChain:
        """Return the chain with one link fixed to the frame. Pairs between this link and the frame are omitted."""
        pairs = (
            SpatialPair(p.name, FRAME if p.i == link else p.i, FRAME if p.j == link else p.j, p.freedoms, p.kind)
            for p in self.pairs
        )
        return SpatialChain(tuple(name for name in self.links if name != link), tuple(p for p in pairs if p.i != p.j))


@dataclass(frozen=True)
class LocalFreedom:
    """Local (passive) degrees of freedom: possible motions of a link that move no other link.

    Instead of one link there may be several that slide in one another, as in a telescopic strut, and move together.

    Attributes:
        links: the link, or the links of the strut.
        freedoms: number of local degrees of freedom.
        ends: pairs that connect these links to other links.
    """

    links: tuple[str, ...]
    freedoms: int
    ends: tuple[SpatialPair, ...]

    @property
    def kinds(self) -> set[str]:
        """Kinds of the pairs that connect these links to other links."""
        return {pair.kind for pair in self.ends}


@dataclass(frozen=True)
class ChainCount:
    """Mobility count of a spatial chain.

    Attributes:
        chain: the chain.
        contours: independent closed contours.
        local: local (passive) degrees of freedom that follow from the kinds of the pairs.
        given_local: number of local degrees of freedom that the file gives, used instead of `local`; None if it gives
            none.
        wanted: intended mobility Wo, or None.
        output: link that is fixed to count the manoeuvrability, or None.
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
        """Number of local (passive) degrees of freedom Wm.

        It is the number that the file gives; otherwise it follows from the kinds of the pairs.
        """
        return sum(freedom.freedoms for freedom in self.local) if self.given_local is None else self.given_local

    @property
    def redundant(self) -> int | None:
        """Number of redundant constraints q = Wo + Wm - W; None if the intended mobility Wo is not given."""
        return None if self.wanted is None else self.wanted + self.local_mobility - self.mobility

    @property
    def effective(self) -> int:
        """Mobility without the local (passive) degrees of freedom, W - Wm."""
        return self.mobility - self.local_mobility

    @property
    def immobile(self) -> tuple[str, ...]:
        """Links that cannot move, by the count.

        These are all links, or only the links of the contours if open branches can move. Empty if an intended mobility
        is given, because special dimensions then make constraints redundant.
        """
        if self.wanted is not None or not self.contours:
            return ()
        if self.effective < 1:
            return self.chain.links
        closed = self.chain.only(link for link in self.chain.links if link not in self.branches)
        local = sum(freedom.freedoms for freedom in self.local if not {*freedom.links} & {*self.branches})
        return closed.links if self.branches and self.given_local is None and closed.mobility - local < 1 else ()

    @property
    def manoeuvrability(self) -> int | None:
        """Manoeuvrability: mobility of the chain with the output link fixed; None if no output link is given."""
        return None if self.output is None else self.chain.held(self.output).mobility

    @property
    def idle_manoeuvrability(self) -> int:
        """Part of the manoeuvrability that does not help to avoid obstacles, because it consists of local degrees of
        freedom.
        """
        return sum(
            freedom.freedoms for freedom in self.local if self.output is not None and self.output not in freedom.links
        )

    @property
    def branches(self) -> tuple[str, ...]:
        """Moving links that belong to no closed loop."""
        closed = {link for contour in self.contours for link in contour.links}
        return tuple(link for link in self.chain.links if link not in closed)

    @property
    def form(self) -> str:
        """Form of the chain: "open", "closed", or "mixed" (contours with open branches)."""
        if not self.contours:
            return "open"
        return "mixed" if self.branches else "closed"


def count_chain(
    chain: SpatialChain, output: str | None = None, given_local: int | None = None, wanted: int | None = None
) -> ChainCount:
    """Count mobility, contours and local (passive) degrees of freedom of a spatial chain.

    Args:
        chain: the chain.
        output: link that is fixed to count the manoeuvrability.
        given_local: number of local degrees of freedom, if it is known; by default it follows from the kinds of the
            pairs.
        wanted: intended mobility.
    """
    chain_contours = find_contours(chain.pairs, chain.links)
    closed = {link for contour in chain_contours for link in contour.links}
    certain = local_freedoms(chain)
    spare = chain.mobility - sum(freedom.freedoms for freedom in certain) - (1 if wanted is None else wanted)
    pistons = [p for p in pistons_on_balls(chain) if closed.issuperset(p.links) and not _shares_links(p, certain)]
    order = {link: number for number, link in enumerate(chain.links)}
    local = sorted((*certain, *pistons[: max(spare, 0)]), key=lambda freedom: order[freedom.links[0]])
    return ChainCount(chain, chain_contours, tuple(local), given_local, wanted, output)


def _shares_links(freedom: LocalFreedom, others: Iterable[LocalFreedom]) -> bool:
    return any({*freedom.links} & {*other.links} for other in others)


def pistons_on_balls(chain: SpatialChain) -> tuple[LocalFreedom, ...]:
    """Return the links between a cylindrical and a spherical pair, which may be free to rotate about the cylinder axis.

    They are free only if the centre of the sphere lies on the axis, which the kinds of pairs do not show. Therefore
    they are counted as local degrees of freedom only as far as the mobility of the chain exceeds the intended one.
    """
    return tuple(
        LocalFreedom((link,), 1, ends)
        for link in chain.links
        if len(ends := chain.around(link)) == 2 and {p.kind for p in ends} == {"cylindrical", "spherical"}
    )


def local_freedoms(chain: SpatialChain) -> tuple[LocalFreedom, ...]:
    """Return the local (idle, passive) degrees of freedom that follow from the kinds of pairs, whatever the dimensions.

    A link between two spherical pairs can rotate about the line of their centres. A link between a spherical and a
    planar pair can rotate about the normal of the plane through the centre. A link between two planar pairs can slide
    parallel to both planes. Links joined in series by sliding, screw or cylindrical pairs count as one such link (a
    strut). A roller can rotate about its axle on a moving link. For any other link the number is a lower bound: the
    degrees of freedom that the link has when its neighbours are fixed.
    """
    around: dict[str, list[SpatialPair]] = {link: [] for link in (FRAME, *chain.links)}
    for pair in chain.pairs:
        around[pair.i].append(pair)
        around[pair.j].append(pair)
    struts = []
    for links in _struts(chain, around):
        touching = list(dict.fromkeys(p for link in links for p in around[link]))
        inner = [p for p in touching if p.i in links and p.j in links]
        ends = [p for p in touching if p not in inner]
        freedoms = _certain_freedoms(inner, ends)
        if freedoms > 0 and len({other for p in ends for other in (p.i, p.j) if other not in links}) > 1:
            struts.append(LocalFreedom(links, freedoms, tuple(ends)))
    rollers = [roller for roller in _rollers(chain) if not _shares_links(roller, struts)]
    return (*struts, *rollers)


def _rollers(chain: SpatialChain) -> Iterable[LocalFreedom]:
    """Return the rollers: links that touch another link and have their axle on a moving link.

    Of two rollers that touch each other, only the later one is returned.
    """
    contacts: dict[str, LocalFreedom] = {}
    for link in chain.links:
        ends = chain.around(link)
        axles = [p for p in ends if p.kind in AXLE_FREEDOMS and FRAME not in (p.i, p.j)]
        contact = [p for p in ends if p.kind in CONTACT_PAIRS]
        if len(ends) == 2 and len(axles) == len(contact) == 1 and axles[0].other(link) != contact[0].other(link):
            contacts[contact[0].name] = LocalFreedom((link,), AXLE_FREEDOMS[axles[0].kind], ends)
    return contacts.values()


def _certain_freedoms(inner: list[SpatialPair], ends: list[SpatialPair]) -> int:
    """Return the number of degrees of freedom that a link has when all links around it are fixed.

    Several links that slide in one another (a telescopic strut) count as one link.

    Args:
        inner: pairs between the links of the strut.
        ends: pairs that connect the link or strut to other links.
    """
    if len(ends) < 2:
        return 0  # an open end of a chain has no local freedom
    turns = len(ends) == 2 and {p.kind for p in ends} <= BALL_OR_PLATE
    return max(sum(p.freedoms for p in (*inner, *ends)) - SPACE * (len(ends) - 1), int(turns))


def _struts(chain: SpatialChain, around: dict[str, list[SpatialPair]]) -> Iterable[tuple[str, ...]]:
    """Yield the links of the chain in order.

    Links that slide in one another and form a telescopic strut between spherical or planar pairs are yielded together,
    all others alone.
    """
    part_of = {link: [link] for link in chain.links}
    for pair in chain.pairs:
        simple = FRAME not in (pair.i, pair.j) and len(around[pair.i]) == len(around[pair.j]) == 2
        if simple and pair.kind in TELESCOPIC and part_of[pair.i] is not part_of[pair.j]:
            together = sorted(part_of[pair.i] + part_of[pair.j], key=chain.links.index)
            part_of |= dict.fromkeys(together, together)
    # only struts between two spherical or planar pairs rotate as one; the parts of others are treated one by one
    for link in chain.links:
        links = part_of[link]
        ends = [p for x in links for p in around[x] if not (p.i in links and p.j in links)]
        if not {p.kind for p in ends} <= BALL_OR_PLATE:
            yield (link,)
        elif link == links[0]:
            yield tuple(links)


# Results for a chain given by its pairs alone.


@dataclass(frozen=True)
class ChainResults:
    """Results for a spatial chain that is given by its pairs alone.

    They consist of the mobility count only, as the chain has no dimensions.

    Attributes:
        problem: object of the caller, as in `Results`.
        chain: the mobility count.
    """

    problem: Any
    chain: ChainCount
