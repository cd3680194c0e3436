"""All real assemblies of a group side by side, at one scale, with the links that it hangs on."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from tmm_cli.drawing.paper import DARK, THIN, Drawing, Ground, Sheet, cells, scale_words
from tmm_cli.drawing.sheets.structure import colours
from tmm_cli.drawing.symbols import STRUCTURAL, Look, Scene, names, numbers, render_scene, spot, symbol_size
from tmm_cli.language import _, numeral
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.assembly import Assemblies, Assembly, GroupAssemblies, listed
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import DEAD
from tmm_cli.mechanics.plans import LANDSCAPE, MARGIN, PORTRAIT, extent, ground_of, round_scale
from tmm_cli.mechanics.structure import Pair, Structure
from tmm_cli.reports import place

A_SHEET = 12  # assemblies on one
PAD, GAP = 10.0, 4.0  # mm: room about a group for its symbols and names, between two cells
CAPTION = 6.0  # mm of the words below a group
SMALLEST_ROOM = 5.0  # mm: in a smaller cell nothing is drawn
SMALLEST = 0.7  # size of symbols: smaller ones cannot be read


def sheets(results: Results) -> Iterable[tuple[str, Drawing]]:
    """The sheets with the stems of their files, more than one of a group with many; none without a real assembly."""
    for stem, here, group in listed(results.assemblies or ()):
        every = list(enumerate(group.assemblies, 1))
        for first in range(0, len(every), A_SHEET):
            name = stem if first == 0 else f"{stem}-sheet-{first // A_SHEET + 1}"
            yield name, sheet_of(results, here, group, every[first : first + A_SHEET]).finish()


def sheet_of(
    results: Results, here: Assemblies, group: GroupAssemblies, every: Sequence[tuple[int, Assembly]]
) -> Sheet:
    """One sheet of these assemblies with their numbers; those of the group that are not on it count for the scale."""
    shown = _shown(results.structure, group)
    structure = replace(results.structure, pairs=shown)
    links = [*group.group.links, *_neighbours(group)]
    scenes = {
        n: Scene(results.linkage, structure, {**here.poses, **a.poses}) for n, a in enumerate(group.assemblies, 1)
    }
    boxes = {n: _box(scene, links) for n, scene in scenes.items()}
    sizes = [size for __, size in boxes.values()]
    largest = complex(max(size.real for size in sizes), max(size.imag for size in sizes))
    mu, paper, places = _layout(len(every), largest)
    where = place(results.problem, here.q, here.number)
    title = _("Real assemblies of {group}, {place}").format(group=group.group.title, place=where)
    sheet = Sheet(results.problem.title, title, paper=paper)
    sheet.mu = mu
    look = STRUCTURAL.sized(max(SMALLEST, min(symbol_size(sheet, scene, links) for scene in scenes.values())))
    for (n, assembly), (low, high) in zip(every, places, strict=False):
        sheet.ground = Ground(low + 1j * CAPTION, high)
        sheet.origin = (low + 1j * CAPTION + high) / 2 - boxes[n][0] / sheet.mu
        _drawn(sheet, scenes[n], group, look)
        _framed(sheet, low, high, n, assembly)
    sheet.text(
        complex(sheet.paper[0] - MARGIN, sheet.paper[1] - MARGIN - 2), scale_words("l", sheet.mu, "m/mm"), 9, ha="right"
    )
    return sheet


def _neighbours(group: GroupAssemblies) -> list[str]:
    """The moving links that a group hangs on."""
    own = group.group.links
    known = (pair.i if pair.j in own else pair.j for pair in group.group.outer)
    return list(dict.fromkeys(link for link in known if link != FRAME))


def _shown(structure: Structure, group: GroupAssemblies) -> tuple[Pair, ...]:
    """Pairs of the group, those of its neighbours on the frame, and hinges in which later groups are joined to it."""
    own = set(group.group.links)
    drawn = own | {FRAME} | set(_neighbours(group))
    return tuple(p for p in structure.pairs if {p.i, p.j} <= drawn or (p.kind == "R" and p.i in own))


def _box(scene: Scene, links: Sequence[str]) -> tuple[complex, complex]:
    """Middle of an assembly, and its width and height, m."""
    places = [*scene.extent(links), *(scene.at(pair) for pair in scene.structure.pairs)]
    __, across, up, middle = extent([p for p in places if np.isfinite(p)] or [0j])
    return middle, complex(across, up)


def _layout(count: int, largest: complex) -> tuple[float, tuple[float, float], list[tuple[complex, complex]]]:
    """Metres a millimetre, paper and cells (mm) for as many drawings up to this width and height (m).

    As large as can be, with few empty cells when it does not matter.
    """
    found = []
    for paper in (LANDSCAPE, PORTRAIT):
        for columns in range(1, count + 1):
            size, places = cells(*ground_of(paper), columns, math.ceil(count / columns), GAP)
            room = size - complex(2 * PAD, 2 * PAD + CAPTION)
            if min(room.real, room.imag) > SMALLEST_ROOM:
                found.append((round_scale(largest.real, largest.imag, room.real, room.imag), paper, places))
    return min(found, key=lambda one: (one[0], len(one[2]), one[1] == PORTRAIT))


def _drawn(sheet: Sheet, scene: Scene, group: GroupAssemblies, look: Look) -> None:
    """The group in its colour, its neighbours grey, the frame dark."""
    own, known, pairs = group.group.links, _neighbours(group), scene.structure.pairs
    hue = colours(scene.structure) | dict.fromkeys(known, THIN)
    drawn = render_scene(sheet, scene, (*known, *own), pairs, look, hue)
    numbers(sheet, drawn.forms, hue)
    hinged = {p.point for p in pairs if p.kind == "R"}
    named = [(p, p.point) for p in pairs if p.kind == "R"]
    named += [(p, p.name) for p in pairs if p.slide and (p.slide.carrier == FRAME or p.point not in hinged)]
    names(sheet, [(spot(sheet, scene, p, look), name, DARK) for p, name in named])
    sheet.settle()


def _framed(sheet: Sheet, low: complex, high: complex, number: int, assembly: Assembly) -> None:
    """The cell with the number of the assembly; that of the sketch is marked."""
    corners = [low, complex(high.real, low.imag), high, complex(low.real, high.imag), low]
    mark = assembly.of_sketch
    sheet.line(corners, DARK if mark else THIN, 2.2 if mark else 0.5, z=1, blocks=False)
    words = _("assembly {number} (sketch)") if mark else _("assembly {number}")
    sheet.text(low + complex(3, 3.5), words.format(number=number), 10, weight="bold" if mark else "normal")
    margin = assembly.margin if assembly.margin > DEAD else 0
    sheet.text(
        complex(high.real - 3, low.imag + 3.5),
        _("margin {margin}").format(margin=numeral(margin, ".3g")),
        8.5,
        ha="right",
    )
