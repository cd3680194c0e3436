"""Redundant constraints of a planar linkage regarded as a spatial one, and a proposal of pairs that removes them.

With all axes perpendicular to the plane, the constraints separate into two independent parts: motion in the plane, and
motion out of it. Out of the plane a link can translate and tilt, so it is described by the height h(x, y) = a + b x + c
y in its own axes. A pair requires equal heights or slopes of its two links:

    turning, sliding       height and both slopes      3 conditions
    cylindrical for R      both slopes                 2   (free along its axis)
    spherical              height at the centre        1
    cylindrical for P      height along the guide      2   (free to rotate about the guide)
    planar for P           slope across the guide      1   (flat cheeks: free to rise and to rotate in the plane)
    teeth, cams            slope along the normal      1   (line contact parallel to the axes)
    the same, crowned      none                        0   (point contact)

A linkage with W = 1 and K contours has 3K redundant conditions. None of the replacements affects the motion in the
plane. A proposal is accepted if its conditions are independent (by rank) and the remaining freedoms are local freedoms
of single links. The conditions need the coordinates of points on their links, but the angles of the links may be
arbitrary, so no position has to be solved. Such replacements are the subject of L. N. Reshetov, Self-aligning
mechanisms (Mir, 1982).
"""

from __future__ import annotations

import cmath
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import DEPENDENT, Real
from tmm_cli.mechanics.structure.assur import Structure
from tmm_cli.mechanics.structure.group import Pair
from tmm_cli.mechanics.structure.spatial import PAIR_FREEDOMS, SpatialChain, SpatialPair

TOUCHING = ("cylinder on plane", "sphere on plane")
PAIR_CHOICES = {
    "R": ("turning", "cylindrical", "spherical"),
    "P": ("sliding", "cylindrical", "planar"),
    "G": TOUCHING,
    "K": TOUCHING,
    "C": TOUCHING,
}
"""Kinds that may replace a pair, in the order of their conditions out of the plane: 3, 2, 1; of higher pairs 1, 0."""
CONDITIONS = 3  # freedoms of a link out of the plane; conditions of a revolute or prismatic pair
GOLDEN = (
    2.399963229728653  # golden angle, rad: its multiples are well spread, so that no two links are parallel by accident
)
MOST_TRIES = 12


@dataclass(frozen=True)
class PairReplacement:
    """A pair that is to be replaced by one with more degrees of freedom.

    Attributes:
        pair: the pair.
        was: kind of the pair as designed, e.g. "turning".
        kind: proposed kind, e.g. "spherical".
    """

    pair: Pair
    was: str
    kind: str

    @property
    def freedoms(self) -> int:
        return PAIR_FREEDOMS[self.kind]


@dataclass(frozen=True)
class OutOfPlaneRank:
    """Result of the rank analysis of motion out of the plane.

    Attributes:
        redundant: number of redundant conditions.
        free: number of remaining degrees of freedom.
        local: number of these that are motions of a single link and move no other link.
    """

    redundant: int
    free: int
    local: int


@dataclass(frozen=True)
class SpatialCount:
    """Mobility count of a planar linkage in space, as designed and with the proposed pairs.

    Attributes:
        chain: the chain as designed.
        wanted: intended mobility Wo.
        replacements: pairs to be replaced; None if no proposal was found.
        proposed: the chain with the proposed pairs.
        rank: ranks of the proposed chain out of the plane.
    """

    chain: SpatialChain
    wanted: int
    replacements: tuple[PairReplacement, ...] | None
    proposed: SpatialChain
    rank: OutOfPlaneRank

    @property
    def local(self) -> int:
        """Number of local (passive) degrees of freedom Wm as designed: zero, as revolute and prismatic pairs leave
        none.
        """
        return 0

    @property
    def redundant(self) -> int:
        """Number of redundant constraints of the mechanism as designed, q = Wo + Wm - W."""
        return self.wanted + self.local - self.chain.mobility

    @property
    def redundant_then(self) -> int:
        """Number of redundant constraints with the proposed pairs, q = Wo + Wm - W."""
        return self.wanted + self.rank.local - self.proposed.mobility


def count_in_space(linkage: Linkage, structure: Structure) -> SpatialCount:
    """Count the mobility of a planar linkage in space, and propose pairs that leave no redundant constraints.

    The intended mobility is the number of drivers.
    """
    chain, mobility = spatial_chain(structure, {}), len(structure.drivers)
    heights = OutOfPlaneConditions(linkage)
    for pins_first in (True, False):
        kinds = _choose_kinds(heights, structure, pins_first)
        if kinds is not None:
            rank = out_of_plane_rank(linkage, structure, kinds)
            if not rank.redundant and rank.free == rank.local:
                replaced = tuple(
                    PairReplacement(p, PAIR_CHOICES[p.kind][0], kinds[p.name])
                    for p in structure.pairs
                    if kinds.get(p.name, PAIR_CHOICES[p.kind][0]) != PAIR_CHOICES[p.kind][0]
                )
                return SpatialCount(chain, mobility, replaced, spatial_chain(structure, kinds), rank)
    return SpatialCount(chain, mobility, None, chain, out_of_plane_rank(linkage, structure, {}))


def spatial_chain(structure: Structure, kinds: Mapping[str, str]) -> SpatialChain:
    """Describe a planar linkage as a spatial chain.

    kinds: new kinds of replaced pairs, by name of the pair; other pairs are as designed.
    """
    named = ((p, kinds.get(p.name, PAIR_CHOICES[p.kind][0])) for p in structure.pairs)
    return SpatialChain(
        structure.links, tuple(SpatialPair(p.name, p.i, p.j, PAIR_FREEDOMS[kind], kind) for p, kind in named)
    )


def out_of_plane_rank(linkage: Linkage, structure: Structure, kinds: Mapping[str, str]) -> OutOfPlaneRank:
    """Count redundant conditions and freedoms of motion out of the plane, from the rank of the conditions.

    kinds: new kinds of replaced pairs, by name of the pair; other pairs are as designed.
    """
    heights = OutOfPlaneConditions(linkage)
    rows = {
        p.name: heights.rows(p, kinds.get(p.name, PAIR_CHOICES[p.kind][0]), structure.links) for p in structure.pairs
    }
    matrix = _stack(rows.values(), CONDITIONS * len(structure.links))
    rank = _rank(matrix)
    return OutOfPlaneRank(len(matrix) - rank, matrix.shape[1] - rank, _count_local_freedoms(matrix))


class OutOfPlaneConditions:
    """Linear conditions of pairs on the heights h = a + b x + c y of links out of the plane.

    The unknowns are a, b, c of each link, in the axes of the link. Lengths are divided by the size of the linkage.
    """

    def __init__(self, linkage: Linkage) -> None:
        self.linkage = linkage
        lengths = [abs(_first_value(p)) for link in linkage.links.values() for p in link.points.values()]
        lengths += [abs(_first_value(where)) for s in linkage.slides for where in (s.through, s.at)]
        self.size = max(lengths, default=0.0) or 1.0
        self.angle = _generic_angles(linkage)

    def rows(self, pair: Pair, kind: str, links: Sequence[str]) -> Real:
        """Return the conditions of a pair of this kind, shape (conditions, 3 links). Links not in `links` are fixed."""
        slide = pair.slide
        if pair.mesh is not None:  # the normal of the teeth may have any direction in the plane
            points = dict.fromkeys((pair.i, pair.j), 0j)
            ahead = {link: cmath.exp(-1j * self.angle[link]) for link in points}
        elif slide is None:
            points = {link: _first_value(self.linkage.local(link, pair.point)) for link in (pair.i, pair.j)}
            ahead = {link: cmath.exp(-1j * self.angle[link]) for link in points}
        else:
            along = cmath.exp(1j * _first_value(slide.direction))
            ahead = {slide.carrier: along, slide.runner: along * cmath.exp(-1j * _first_value(slide.turned))}
            run = GOLDEN * self.size  # arbitrary: the condition holds along the whole guide or nowhere
            points = {slide.carrier: _first_value(slide.through) + run * along, slide.runner: _first_value(slide.at)}
        height = {link: (1.0, place.real / self.size, place.imag / self.size) for link, place in points.items()}
        slope = {link: (0.0, e.real, e.imag) for link, e in ahead.items()}
        across = {link: (0.0, -e.imag, e.real) for link, e in ahead.items()}
        conditions = {
            "turning": (height, slope, across),
            "sliding": (height, slope, across),
            "spherical": (height,),
            "planar": (across,),
            "cylinder on plane": (slope,),
            "sphere on plane": (),
            "cylindrical": (slope, across) if slide is None else (height, slope),
        }[kind]
        matrix = np.zeros((len(conditions), CONDITIONS * len(links)))
        for row, condition in zip(matrix, conditions, strict=True):
            for link, sign in ((pair.i, 1.0), (pair.j, -1.0)):
                if link in links:
                    at = CONDITIONS * list(links).index(link)
                    row[at : at + CONDITIONS] = sign * np.array(condition[link])
        return matrix


def _first_value(number: Any) -> complex:
    """Return a length or vector as one number. If it has a value for each variant, the first is returned."""
    return complex(np.ravel(number)[0])


def _generic_angles(linkage: Linkage) -> dict[str, float]:
    """Choose arbitrary angles for the links; links joined by prismatic pairs keep the angle between them."""
    angle = {link: GOLDEN * number for number, link in enumerate(linkage.links)}
    fixed = {FRAME}
    for seed in linkage.links:
        todo = [seed]
        fixed.add(seed)
        for link in todo:
            for slide in linkage.slides:
                for near, far, sign in ((slide.carrier, slide.runner, 1), (slide.runner, slide.carrier, -1)):
                    if near == link and far not in fixed:
                        angle[far] = angle[link] + sign * _first_value(slide.turned).real
                        fixed.add(far)
                        todo.append(far)
    return angle


def _choose_kinds(heights: OutOfPlaneConditions, structure: Structure, pins_first: bool) -> dict[str, str] | None:
    """Choose kinds for the pairs of all groups, by name of the pair; None if this fails for one of the groups.

    pins_first: True if pairs of a compound hinge, which share a pin, are the first to become cylindrical.
    """
    pins = [p.point for p in structure.pairs if p.kind == "R"]
    shared = {p.name for p in structure.pairs if p.kind == "R" and pins.count(p.point) > 1} if pins_first else set()
    kinds = {p.name: TOUCHING[1] for p in structure.pairs if not p.lower}
    for group in structure.all_groups:
        chosen = _choose_kinds_of_group(heights, group.links, (*group.inner, *group.outer), shared)
        if chosen is None:
            return None
        kinds |= chosen
    return kinds


def _choose_kinds_of_group(
    heights: OutOfPlaneConditions, links: tuple[str, ...], group_pairs: tuple[Pair, ...], pins: set[str]
) -> dict[str, str] | None:
    """Choose kinds for the pairs of one group, with the links solved before it fixed; None if no choice is possible.

    The choice has the fewest changes, and of these the fewest degrees of freedom. Each group is treated separately,
    because a pair that constrained two groups could become singular in some position. Pairs with the frame locate
    shafts and guides and are not changed. Each other pair first gets the kind that has most degrees of freedom. Then as
    many pairs as possible get their original kind again, and cylindrical pairs take the degrees of freedom that are
    still left.
    """
    on_frame = {p.other(FRAME) for p in group_pairs if p.lower and FRAME in (p.i, p.j)}
    floating = tuple(link for link in links if link not in on_frame)
    pairs = [p for p in group_pairs if p.lower and FRAME not in (p.i, p.j)]
    blocks = {(p.name, kind): heights.rows(p, kind, floating) for p in pairs for kind in PAIR_CHOICES[p.kind]}

    def matrix(kinds: Mapping[str, str]) -> Real:
        return _stack((blocks[item] for item in kinds.items()), CONDITIONS * len(floating))

    def held(kinds: dict[str, str], order: Iterable[Pair], choice: int) -> dict[str, str]:
        """Give the kind number `choice` to pairs that still have the kind with most degrees of freedom.

        A pair is changed only if the conditions stay independent.
        """
        for pair in order:
            trial = kinds | {pair.name: PAIR_CHOICES[pair.kind][choice]}
            if kinds[pair.name] == PAIR_CHOICES[pair.kind][2] and _independent(matrix(trial)):
                kinds = trial
        return kinds

    freest = {p.name: PAIR_CHOICES[p.kind][2] for p in pairs}
    if not _independent(matrix(freest)):
        return None
    proposals = []
    for first in range(min(len(pairs), MOST_TRIES)):
        kinds = held(freest, [pairs[first], *pairs[:first], *pairs[first + 1 :]], 0)
        kinds = held(kinds, sorted(pairs, key=lambda p: p.name not in pins), 1)
        conditions = matrix(kinds)
        if conditions.shape[1] - len(conditions) == _count_local_freedoms(
            conditions
        ):  # only local freedoms of single links remain
            changed = [kind for p in pairs if (kind := kinds[p.name]) != PAIR_CHOICES[p.kind][0]]
            proposals.append(((len(changed), sum(PAIR_FREEDOMS[kind] for kind in changed)), kinds))
    return min(proposals, key=lambda proposal: proposal[0])[1] if proposals else {} if not pairs else None


def _stack(blocks: Iterable[Real], columns: int) -> Real:
    return np.vstack([np.zeros((0, columns)), *blocks])


def _rank(matrix: Real) -> int:
    return int(np.linalg.matrix_rank(matrix, rtol=DEPENDENT)) if matrix.size else 0


def _independent(matrix: Real) -> bool:
    return len(matrix) <= matrix.shape[1] and _rank(matrix) == len(matrix)


def _count_local_freedoms(matrix: Real) -> int:
    """Return the number of local (passive) degrees of freedom: those that remain to a link when all other links are
    fixed.

    They are added up over all links.
    """
    columns = matrix.shape[1]
    return sum(CONDITIONS - _rank(matrix[:, at : at + CONDITIONS]) for at in range(0, columns, CONDITIONS))
