"""Enumeration of kinematic chains, and a canonical form of small graphs with coloured vertices and edges.

The colour of each vertex is refined by the colours of its neighbours until nothing changes. If several vertices still
have the same colour, each of them in turn receives a different colour, and the smallest of all resulting forms is kept.
Two graphs are isomorphic if and only if their canonical forms are equal. Source: B. D. McKay, Practical graph
isomorphism, Congressus Numerantium 30 (1981).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations, pairwise, permutations

from tmm_cli.mechanics.structure import reachable_nodes

GraphForm = tuple[tuple[int, ...], tuple[tuple[int, int, int], ...]]
"""Colours of the vertices in canonical order, and the edges (i, j, kind), i < j, in that numbering."""


def canonical_form(colours: Sequence[int], edges: Mapping[tuple[int, int], int]) -> GraphForm:
    """Return the canonical form of a simple graph.

    Args:
        colours: colour of each vertex 0, 1, ....
        edges: kind of each edge, by its pair of vertices.
    """
    beyond = 2 * max(len(colours), *colours) + 2  # number of possible colours: one number encodes kind and colour
    beside: list[list[tuple[int, int]]] = [[] for _ in colours]
    for (i, j), kind in edges.items():
        beside[i].append((kind * beyond, j))
        beside[j].append((kind * beyond, i))
    return min(_find_smallest_form(list(colours), colours, beside, edges))


def _find_smallest_form(
    refined: list[int],
    colours: Sequence[int],
    beside: list[list[tuple[int, int]]],
    edges: Mapping[tuple[int, int], int],
) -> list[GraphForm]:
    refined = _refine_colours(refined, beside)
    cells: dict[int, list[int]] = {}
    for vertex, colour in enumerate(refined):
        cells.setdefault(colour, []).append(vertex)
    shared = [(len(cell), colour) for colour, cell in cells.items() if len(cell) > 1]
    if not shared:
        ordered = tuple(colours[cells[colour][0]] for colour in sorted(cells))
        renamed = ((*sorted((refined[i], refined[j])), kind) for (i, j), kind in edges.items())
        return [(ordered, tuple(sorted((i, j, kind) for i, j, kind in renamed)))]
    cell = cells[min(shared)[1]]
    forms = []
    for vertex in cell:
        # half a step below the others of its cell
        apart = [2 * colour + 1 for colour in refined]
        apart[vertex] -= 1
        forms += _find_smallest_form(apart, colours, beside, edges)
    return [min(forms)]


def _refine_colours(colours: list[int], beside: list[list[tuple[int, int]]]) -> list[int]:
    """Refine the colours 0, 1, ... of the vertices of a graph by the colours of their neighbours until nothing
    changes.
    """
    count = 0
    while True:
        keys = [
            (colour, *sorted([kind + colours[other] for kind, other in near]))
            for colour, near in zip(colours, beside, strict=True)
        ]
        rank = {key: k for k, key in enumerate(sorted(set(keys)))}
        colours = [rank[key] for key in keys]
        if len(rank) == count:
            return colours
        count = len(rank)


# Kinematic chains: all chains of n links and revolute pairs with the mobility W.
#
# Convention of the counts. A chain is a set of n links and simple revolute pairs (no compound hinges), two links
# sharing at most one pair, connected, every link with two pairs or more, 3(n - 1) - 2p = W, and no sub-chain of two
# links or more rigid: 3(k - 1) - 2p >= 1 for every sub-chain of k links. Chains that separate when one link or one
# pair is removed (fractionated chains: each part moves independently) are counted, as in the classical tables, and
# marked; with W = 1 there are none. n = 4, 6, 8, 10: 1, 2, 16, 230 for W = 1; n = 5, 7, 9: 1, 4, 40 for W = 2, of
# which 0, 1, 5 are fractionated; n = 6, 8, 10: 1, 7, 98 for W = 3. Source of the counts: T. S. Mruthyunjaya,
# Kinematic structure of mechanisms revisited, Mechanism and Machine Theory 38 (2003) 279-320.
#
# Method: a chain whose binary links are removed from their edges is a multigraph with L = (n - W - 1)/2 independent
# contours and no vertex below degree 3; there are few of them, and the binary links are distributed over their edges.


MOST_LINKS_OF_CHAIN = 11  # 12 links with W = 1 are 6856 chains, and minutes of work

Bundle = tuple[int, int, int]
"""Vertices i <= j of a multigraph and the number of edges between them (of loops, when i = j)."""


@dataclass(frozen=True)
class KinematicChain:
    """A kinematic chain with revolute pairs.

    Attributes:
        links: number of links n; the links are numbered 0 .. n - 1, those with most pairs first.
        pairs: revolute pairs as pairs of links (i, j), i < j.
    """

    links: int
    pairs: tuple[tuple[int, int], ...]

    @property
    def mobility(self) -> int:
        """Mobility 3(n - 1) - 2p of the chain of n links and p pairs, with one link fixed."""
        return 3 * (self.links - 1) - 2 * len(self.pairs)

    @cached_property
    def assortment(self) -> tuple[int, ...]:
        """Numbers of binary, ternary, quaternary, ... links."""
        degrees = Counter(Counter(link for pair in self.pairs for link in pair).values())
        return tuple(degrees[d] for d in range(2, max(degrees) + 1))

    @cached_property
    def fractionated(self) -> bool:
        """True if the chain falls apart when one link is removed.

        A chain that falls apart when a pair is removed always has such a link.
        """
        return any(not _is_connected(set(range(self.links)) - {link}, self.pairs) for link in range(self.links))

    @cached_property
    def form(self) -> GraphForm:
        """Canonical form. Two chains are isomorphic if and only if their forms are equal."""
        return canonical_form([0] * self.links, dict.fromkeys(self.pairs, 0))


def independent_contours(links: int, mobility: int) -> int | None:
    """Return the number of independent contours of a closed chain with this number of links and this mobility.

    The result is None if no such chain exists.
    """
    twice = links - mobility - 1
    return twice // 2 if mobility >= 1 and twice >= 2 and twice % 2 == 0 else None


def enumerate_chains(links: int, mobility: int = 1) -> tuple[KinematicChain, ...]:
    """Enumerate all non-isomorphic kinematic chains with a given number of links.

    Args:
        links: number of links, at most MOST_LINKS_OF_CHAIN.
        mobility: mobility W of the chain with one link fixed.

    Returns:
        The chains, sorted by their numbers of binary, ternary, ... links; () if there is none.

    Raises:
        ValueError: too many links.
    """
    if links > MOST_LINKS_OF_CHAIN:
        raise ValueError(f"chains of at most {MOST_LINKS_OF_CHAIN} links are listed")
    loops = independent_contours(links, mobility)
    if loops is None:
        return ()
    if loops == 1:
        return (KinematicChain(links, tuple(sorted(tuple(sorted((k, (k + 1) % links))) for k in range(links)))),)  # type: ignore[misc]
    chains = [
        _insert_binary_links(bundles, binaries, links)
        for vertices, bundles in _enumerate_multigraphs(loops)
        for binaries in _distribute_binary_links(vertices, bundles, links - vertices)
    ]
    return tuple(sorted(chains, key=lambda chain: (tuple(-k for k in chain.assortment), chain.pairs)))


def _enumerate_multigraphs(loops: int) -> Iterator[tuple[int, tuple[Bundle, ...]]]:
    """Yield connected multigraphs with a given number of independent contours, in which every vertex has degree 3 or
    more.

    Vertices stand for links with three or more pairs. Each multigraph is the number of its vertices and the number of
    edges between every two vertices (the bundles).
    """
    seen = set()
    for extra in _enumerate_partitions(2 * (loops - 1)):
        degrees = [2 + k for k in extra]
        for bundles in _fill_degrees(degrees, 0, 0):
            if not _is_connected(set(range(len(degrees))), [(i, j) for i, j, _ in bundles]):
                continue
            at = {i: count for i, j, count in bundles if i == j}
            colours = [degree * 10 + at.get(v, 0) for v, degree in enumerate(degrees)]
            form = canonical_form(colours, {(i, j): count for i, j, count in bundles if i != j})
            if form not in seen:
                seen.add(form)
                yield len(degrees), tuple(bundles)


def _enumerate_partitions(total: int, most: int | None = None) -> Iterator[list[int]]:
    if total == 0:
        yield []
    for first in range(min(total, most or total), 0, -1):
        for rest in _enumerate_partitions(total - first, first):
            yield [first, *rest]


def _fill_degrees(left: list[int], i: int, j: int) -> Iterator[list[Bundle]]:
    """Yield all multigraphs, as bundles of parallel edges, that give the vertices the required degrees.

    Bundles before (i, j) are already determined; the degrees are those that remain.
    """
    if i == len(left):
        yield []
        return
    if j == len(left):
        if left[i] == 0:
            yield from _fill_degrees(left, i + 1, i + 1)
        return
    most = left[i] // 2 if i == j else min(left[i], left[j])
    for count in range(most + 1):
        after = list(left)
        after[i] -= count
        after[j] -= count
        for rest in _fill_degrees(after, i, j + 1):
            yield [(i, j, count), *rest] if count else rest


def _distribute_binary_links(
    vertices: int, bundles: Sequence[Bundle], binary: int
) -> Iterator[tuple[tuple[int, ...], ...]]:
    """Yield the ways to insert binary links in the edges of a multigraph; of isomorphic ones only the first.

    Each consists of the numbers of binary links on the edges of each bundle of parallel edges. Those with a rigid
    sub-chain are omitted. An edge with m < 2 binary links removes 2 - m degrees of freedom; of all sub-chains around a
    set of vertices, the one with all these edges therefore has the smallest mobility.
    """
    inside = [
        (3 * (size - 1), [k for k, (i, j, _) in enumerate(bundles) if i in vertex_set and j in vertex_set])
        for size in range(2, vertices + 1)
        for vertex_set in combinations(range(vertices), size)
    ]
    same = _find_automorphisms(vertices, bundles)
    seen = set()
    for binaries in _spread_binary_links(bundles, binary):
        taken = [sum(max(0, 2 - m) for m in numbers) for numbers in binaries]
        if any(free - sum(taken[k] for k in vertex_set) < 1 for free, vertex_set in inside):
            continue
        form = min(tuple(binaries[k] for k in order) for order in same)
        if form not in seen:
            seen.add(form)
            yield binaries


def _spread_binary_links(bundles: Sequence[Bundle], binary: int) -> Iterator[tuple[tuple[int, ...], ...]]:
    """Yield the numbers of binary links on the edges of each bundle of parallel edges.

    Numbers with which two edges of a bundle form a rigid contour are omitted.
    """
    if not bundles:
        if binary == 0:
            yield ()
        return
    (i, j, count), rest = bundles[0], bundles[1:]
    least = sum(_count_fewest_binary_links(i == j, count) for i, j, count in rest)
    for numbers in _enumerate_ascending_tuples(count, binary - least, 3 if i == j else 0):
        # two edges of one bundle close a contour of their binary links and two others
        if i != j and count > 1 and numbers[0] + numbers[1] < 2:
            continue
        for others in _spread_binary_links(rest, binary - sum(numbers)):
            yield (numbers, *others)


def _count_fewest_binary_links(loop: bool, count: int) -> int:
    """Return the smallest number of binary links on parallel edges with which every contour of them has four links
    or more.
    """
    return 3 * count if loop else max(0, 2 * (count - 1))


def _enumerate_ascending_tuples(count: int, most: int, least: int) -> Iterator[tuple[int, ...]]:
    """Yield all ascending tuples of `count` numbers, none below `least`, whose sum is at most `most`."""
    if count == 0:
        yield ()
        return
    for first in range(least, most // count + 1):
        for rest in _enumerate_ascending_tuples(count - 1, most - first, first):
            yield (first, *rest)


def _find_automorphisms(vertices: int, bundles: Sequence[Bundle]) -> list[list[int]]:
    """Return all automorphisms of a multigraph. Each lists, for every bundle, the index of its image."""
    counts = {(i, j): count for i, j, count in bundles}
    number = {(i, j): k for k, (i, j, _) in enumerate(bundles)}
    mappings = []
    for order in permutations(range(vertices)):
        moved = [(min(order[i], order[j]), max(order[i], order[j])) for i, j, _ in bundles]
        if all(counts.get(pair) == count for pair, (_, _, count) in zip(moved, bundles, strict=True)):
            mappings.append([number[pair] for pair in moved])
    return mappings


def _insert_binary_links(bundles: Sequence[Bundle], binaries: Sequence[Sequence[int]], links: int) -> KinematicChain:
    """Build the kinematic chain of a multigraph with binary links inserted in its edges."""
    after = 1 + max(j for _, j, _ in bundles)
    pairs = []
    for (i, j, _), numbers in zip(bundles, binaries, strict=True):
        for count in numbers:
            path = [i, *range(after, after + count), j]
            after += count
            pairs += [(min(a, b), max(a, b)) for a, b in pairwise(path)]
    assert after == links
    return KinematicChain(links, tuple(sorted(pairs)))


def _is_connected(links: set[int], pairs: Iterable[tuple[int, int]]) -> bool:
    """Return True if the links are connected by the pairs between them."""
    beside: dict[int, list[int]] = {link: [] for link in links}
    for i, j in pairs:
        if i in links and j in links:
            beside[i].append(j)
            beside[j].append(i)
    return len(reachable_nodes(beside, next(iter(links)))) == len(links)
