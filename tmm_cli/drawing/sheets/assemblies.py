"""Sheets with all real assemblies of an Assur group, side by side at one scale, and the links next to the group."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    THIN_COLOUR,
    Drawing,
    DrawingSheet,
    OccupiedArea,
    divide_into_cells,
    scale_words,
)
from tmm_cli.drawing.sheets.structure import link_colours
from tmm_cli.drawing.symbols import (
    STRUCTURAL,
    MechanismScene,
    SymbolStyle,
    draw_link_numbers,
    draw_names,
    name_anchor,
    render_scene,
    symbol_scale,
)
from tmm_cli.language import _, numeral
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.assembly import Assemblies, Assembly, GroupAssemblies, name_assembly_files
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import DEAD
from tmm_cli.mechanics.plans import LANDSCAPE, MARGIN, PORTRAIT, drawing_area, extent, round_scale
from tmm_cli.mechanics.structure import Pair, Structure
from tmm_cli.reports import describe_position

ASSEMBLIES_PER_SHEET = 12  # on one sheet
ASSEMBLY_PAD = 10.0  # mm about a group for its symbols and names
CELL_GAP = 4.0  # mm
CAPTION_HEIGHT = 6.0  # mm of the caption below a group
LEAST_CELL = 5.0  # mm: in a smaller cell nothing is drawn
LEAST_SYMBOLS = 0.7  # relative size of symbols; smaller ones are illegible


def draw_assemblies(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Yield the sheets, as (stem of the file name, drawing). A group with many assemblies gets more than one sheet."""
    for stem, configuration, group in name_assembly_files(results.assemblies or ()):
        numbered = list(enumerate(group.assemblies, 1))
        for first in range(0, len(numbered), ASSEMBLIES_PER_SHEET):
            name = stem if first == 0 else f"{stem}-sheet-{first // ASSEMBLIES_PER_SHEET + 1}"
            yield (
                name,
                assemblies_sheet(
                    results, configuration, group, numbered[first : first + ASSEMBLIES_PER_SHEET]
                ).finish(),
            )


def assemblies_sheet(
    results: Results, configuration: Assemblies, group: GroupAssemblies, numbered: Sequence[tuple[int, Assembly]]
) -> DrawingSheet:
    """Draw a sheet with some of the assemblies of a group. All assemblies of the group have the same scale.

    Args:
        results: computed results.
        configuration: assembled positions of the links to which the group is connected.
        group: the group with all its assemblies.
        numbered: assemblies on this sheet with their numbers.
    """
    pairs = _drawn_pairs(results.structure, group)
    structure = replace(results.structure, pairs=pairs)
    links = [*group.group.links, *_adjacent_links(group)]
    scenes = {
        n: MechanismScene(results.linkage, structure, {**configuration.poses, **a.poses})
        for n, a in enumerate(group.assemblies, 1)
    }
    boxes = {n: _assembly_box(scene, links) for n, scene in scenes.items()}
    sizes = [box for __, box in boxes.values()]
    largest = complex(max(box.real for box in sizes), max(box.imag for box in sizes))
    mu, paper, corners = _choose_cells(len(numbered), largest)
    where = describe_position(results.problem, configuration.q, configuration.number)
    title = _("Real assemblies of {group}, {place}").format(group=group.group.title, place=where)
    sheet = DrawingSheet(results.problem.title, title, paper=paper)
    sheet.mu = mu
    look = STRUCTURAL.scaled(max(LEAST_SYMBOLS, min(symbol_scale(sheet, scene, links) for scene in scenes.values())))
    for (n, assembly), (low, high) in zip(numbered, corners, strict=False):
        sheet.canvas = OccupiedArea(low + 1j * CAPTION_HEIGHT, high)
        sheet.origin = (low + 1j * CAPTION_HEIGHT + high) / 2 - boxes[n][0] / sheet.mu
        _draw_assembly(sheet, scenes[n], group, look)
        _draw_cell(sheet, low, high, n, assembly)
    sheet.text(
        complex(sheet.paper[0] - MARGIN, sheet.paper[1] - MARGIN - 2), scale_words("l", sheet.mu, "m/mm"), 9, ha="right"
    )
    return sheet


def _adjacent_links(group: GroupAssemblies) -> list[str]:
    """Return the moving links to which the group is connected."""
    group_links = group.group.links
    joined_links = (pair.i if pair.j in group_links else pair.j for pair in group.group.outer)
    return list(dict.fromkeys(link for link in joined_links if link != FRAME))


def _drawn_pairs(structure: Structure, group: GroupAssemblies) -> tuple[Pair, ...]:
    """Return the pairs of the mechanism that are drawn with an assembly of a group.

    They connect the links of the group, the links next to it and the frame. The hinges at which later groups are
    connected are drawn too.
    """
    group_links = set(group.group.links)
    drawn = group_links | {FRAME} | set(_adjacent_links(group))
    return tuple(p for p in structure.pairs if {p.i, p.j} <= drawn or (p.kind == "R" and p.i in group_links))


def _assembly_box(scene: MechanismScene, links: Sequence[str]) -> tuple[complex, complex]:
    """Return the centre of an assembly (m), and its width + i height (m)."""
    points = [*scene.extent(links), *(scene.at(pair) for pair in scene.structure.pairs)]
    __, across, up, middle = extent([p for p in points if np.isfinite(p)] or [0j])
    return middle, complex(across, up)


def _choose_cells(count: int, largest: complex) -> tuple[float, tuple[float, float], list[tuple[complex, complex]]]:
    """Choose scale, paper and layout for `count` drawings of equal size side by side.

    The largest possible scale is chosen. If it is possible with several layouts, the one with the fewest empty cells is
    taken.

    Args:
        count: number of drawings.
        largest: width and height of a drawing as a complex number, width + i height, m.

    Returns:
        Scale (m per mm), paper size (mm), and lower left and upper right corner of each cell (mm).
    """
    layouts = []
    for paper in (LANDSCAPE, PORTRAIT):
        for columns in range(1, count + 1):
            cell, corners = divide_into_cells(*drawing_area(paper), columns, math.ceil(count / columns), CELL_GAP)
            room = cell - complex(2 * ASSEMBLY_PAD, 2 * ASSEMBLY_PAD + CAPTION_HEIGHT)
            if min(room.real, room.imag) > LEAST_CELL:
                layouts.append((round_scale(largest.real, largest.imag, room.real, room.imag), paper, corners))
    return min(layouts, key=lambda layout: (layout[0], len(layout[2]), layout[1] == PORTRAIT))


def _draw_assembly(sheet: DrawingSheet, scene: MechanismScene, group: GroupAssemblies, look: SymbolStyle) -> None:
    """Draw an assembly: the group in its colour, the links to which it is connected in grey, and the frame in black."""
    group_links, adjacent, pairs = group.group.links, _adjacent_links(group), scene.structure.pairs
    hue = link_colours(scene.structure) | dict.fromkeys(adjacent, THIN_COLOUR)
    drawn = render_scene(sheet, scene, (*adjacent, *group_links), pairs, look, hue)
    draw_link_numbers(sheet, drawn.forms, hue)
    hinged = {p.point for p in pairs if p.kind == "R"}
    named = [(p, p.point) for p in pairs if p.kind == "R"]
    named += [(p, p.name) for p in pairs if p.slide and (p.slide.carrier == FRAME or p.point not in hinged)]
    draw_names(sheet, [(name_anchor(sheet, scene, p, look), name, DARK_COLOUR) for p, name in named])
    sheet.place_requested_labels()


def _draw_cell(sheet: DrawingSheet, low: complex, high: complex, number: int, assembly: Assembly) -> None:
    """Draw the border of a cell and the number of the assembly in it.

    The border is thick for the assembly that the sketch in the problem file shows.
    """
    corners = [low, complex(high.real, low.imag), high, complex(low.real, high.imag), low]
    mark = assembly.of_sketch
    sheet.line(corners, DARK_COLOUR if mark else THIN_COLOUR, 2.2 if mark else 0.5, z=1, blocks=False)
    words = _("assembly {number} (sketch)") if mark else _("assembly {number}")
    sheet.text(low + complex(3, 3.5), words.format(number=number), 10, weight="bold" if mark else "normal")
    margin = assembly.margin if assembly.margin > DEAD else 0
    sheet.text(
        complex(high.real - 3, low.imag + 3.5),
        _("margin {margin}").format(margin=numeral(margin, ".3g")),
        8.5,
        ha="right",
    )
