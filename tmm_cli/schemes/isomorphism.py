"""When two structures are the same: a canonical form of small graphs with coloured vertices and edges.

Colours are refined by those of the neighbours until nothing changes; where vertices of one colour are left, each in
turn is given a colour of its own, and the least of all the forms is kept. Two graphs are isomorphic exactly when their
forms are equal. Source of the method: B. D. McKay, Practical graph isomorphism, Congressus Numerantium 30 (1981).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

Form = tuple[tuple[int, ...], tuple[tuple[int, int, int], ...]]
"""Colours of the vertices in canonical order, and the edges (i, j, kind), i < j, in that numbering."""


def canonical(colours: Sequence[int], edges: Mapping[tuple[int, int], int]) -> Form:
    """The form of a simple graph on the vertices 0 .. len(colours) - 1; an edge joins two of them and has a kind."""
    beyond = 2 * max(len(colours), *colours) + 2  # all colours that there can be: one number tells kind and colour
    beside: list[list[tuple[int, int]]] = [[] for _ in colours]
    for (i, j), kind in edges.items():
        beside[i].append((kind * beyond, j))
        beside[j].append((kind * beyond, i))
    return min(_forms(list(colours), colours, beside, edges))


def _forms(
    refined: list[int],
    colours: Sequence[int],
    beside: list[list[tuple[int, int]]],
    edges: Mapping[tuple[int, int], int],
) -> list[Form]:
    refined = _refine(refined, beside)
    cells: dict[int, list[int]] = {}
    for vertex, colour in enumerate(refined):
        cells.setdefault(colour, []).append(vertex)
    shared = [(len(cell), colour) for colour, cell in cells.items() if len(cell) > 1]
    if not shared:
        ordered = tuple(colours[cells[colour][0]] for colour in sorted(cells))
        renamed = ((*sorted((refined[i], refined[j])), kind) for (i, j), kind in edges.items())
        return [(ordered, tuple(sorted((i, j, kind) for i, j, kind in renamed)))]
    cell = cells[min(shared)[1]]
    found = []
    for vertex in cell:
        # half a step below the others of its cell
        apart = [2 * colour + 1 for colour in refined]
        apart[vertex] -= 1
        found += _forms(apart, colours, beside, edges)
    return [min(found)]


def _refine(colours: list[int], beside: list[list[tuple[int, int]]]) -> list[int]:
    """Colours 0, 1, ... that tell apart what the neighbours, their neighbours, ... tell apart."""
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
