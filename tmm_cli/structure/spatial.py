"""Chains in space, given by pairs alone: mobility, contours, local freedoms, manoeuvrability.

Mobility after P. I. Somov and A. P. Malyshev, W = 6n - 5 p1 - 4 p2 - 3 p3 - 2 p4 - p5, n moving links and pi pairs with
i freedoms. It is a count: special dimensions (parallel axes, axes through one point) show as redundant constraints,
q = Wo + Wm - W.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

from tmm_cli.language import N_
from tmm_cli.linkage import FRAME
from tmm_cli.structure.contours import Contour, contours

SPACE = 6  # freedoms of a free link
KINDS: dict[str, int] = {  # of pairs, in the words of a file, by which they are translated too; their freedoms
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


@dataclass(frozen=True)
class Findings:
    """What the count says of a chain.

    local: the local freedoms that are certain from the kinds of pairs; given_local: those that were told instead (a
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


def examine(
    chain: SpatialChain, output: str | None = None, given_local: int | None = None, wanted: int | None = None
) -> Findings:
    """Everything that can be counted of a chain."""
    return Findings(chain, contours(chain.pairs, chain.links), local_freedoms(chain), given_local, wanted, output)


def local_freedoms(chain: SpatialChain) -> tuple[LocalFreedom, ...]:
    """Local freedoms that are certain from the kinds of pairs, whatever the dimensions.

    A link between two balls turns about the line of their centres; between a ball and a plate, about the normal
    through the centre; between two plates it slides along both. So does a strut of parts that slide in one another.
    Other links have at least the freedoms that are left when their neighbours are held.
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
        freedoms = _certain(inner, ends)
        if freedoms > 0 and len({other for p in ends for other in (p.i, p.j) if other not in links}) > 1:
            found.append(LocalFreedom(links, freedoms, tuple(ends)))
    return tuple(found)


def _certain(inner: list[SpatialPair], ends: list[SpatialPair]) -> int:
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
