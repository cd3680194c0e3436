"""All real assemblies of a group side by side, at one scale, with the links that it hangs on."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from matplotlib.figure import Figure

from tmm_cli.assemblies import DEAD, Assemblies, Assembly, GroupAssemblies, listed
from tmm_cli.draw.labels import Ground, Label
from tmm_cli.draw.labels import extent as text_extent
from tmm_cli.draw.scene import Form, Scene, form
from tmm_cli.draw.sheet import DARK, THIN, Sheet, picture, scale_text
from tmm_cli.draw.structure import circles, colours, grounds, higher_pairs, names, sliding, spot
from tmm_cli.draw.symbols import body, settle, symbol_size
from tmm_cli.linkage import FRAME
from tmm_cli.pipeline import Results
from tmm_cli.places import place
from tmm_cli.plans.record import LANDSCAPE, MARGIN, PORTRAIT, STRIP, extent, round_scale
from tmm_cli.structure.assur import Pair, Structure
from tmm_cli.words import say

A_SHEET = 12  # assemblies on one
PAD, GAP = 10.0, 4.0  # mm: room about a group for its symbols and names, between two cells
CAPTION = 6.0  # mm of the words below a group
STEPS, CLEAR = 9, 3.0  # places along a side of a plate that are tried for its number; room that it needs, mm
SMALLEST = 0.7  # size of symbols: smaller ones cannot be read


@dataclass(frozen=True)
class Grid:
    """Cells of one size on a paper, and the scale (m a millimetre) at which every assembly fits into one."""

    paper: tuple[float, float]
    columns: int
    rows: int
    mu: float

    @property
    def cell(self) -> complex:
        """Width and height, mm."""
        return _cell(self.paper, self.columns, self.rows)

    def corner(self, index: int) -> complex:
        """The lower left corner of a cell, mm."""
        row, column = divmod(index, self.columns)
        top = self.paper[1] - MARGIN - STRIP
        across, up = self.cell.real + GAP, self.cell.imag + GAP
        return complex(MARGIN + column * across, top - (row + 1) * up + GAP)


def files(results: Results) -> Iterable[tuple[str, bytes]]:
    """A sheet a group, more where it has many assemblies, as PNG and SVG."""
    for stem, figure in sheets(results):
        for kind in ("png", "svg"):
            yield f"{stem}.{kind}", picture(figure, kind)


def sheets(results: Results) -> Iterable[tuple[str, Figure]]:
    """The sheets with the stems of their files; none for a group without a real assembly."""
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
    grid = _grid(len(every), max(size.real for _, size in boxes.values()), max(size.imag for _, size in boxes.values()))
    where = place(results.problem, here.q, here.number)
    sheet = Sheet(
        results.problem.title, say("assemblies.caption", group=group.group.title, place=where),
        [0j, 9 + 1j if grid.paper == LANDSCAPE else 1 + 9j],
    )  # fmt: skip
    sheet.mu = grid.mu
    size = max(SMALLEST, min(symbol_size(sheet, scene, links) for scene in scenes.values()))
    whole, taken = sheet.ground, []
    for index, (n, assembly) in enumerate(every):
        low = grid.corner(index)
        high = low + grid.cell
        sheet.ground = Ground(low + 1j * CAPTION, high)
        sheet.origin = (low + 1j * CAPTION + high) / 2 - boxes[n][0] / sheet.mu
        _drawn(sheet, scenes[n], group, size)
        _framed(sheet, low, high, n, assembly)
        taken += sheet.ground.boxes
    whole.boxes += taken
    sheet.ground = whole
    sheet.text(
        complex(sheet.paper[0] - MARGIN, sheet.paper[1] - MARGIN - 2), scale_text("l", sheet.mu, "m/mm"), 9, ha="right"
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
    _, across, up, middle = extent([p for p in places if np.isfinite(p)] or [0j])
    return middle, complex(across, up)


def _cell(paper: tuple[float, float], columns: int, rows: int) -> complex:
    across = (paper[0] - 2 * MARGIN - GAP * (columns - 1)) / columns
    return complex(across, (paper[1] - 2 * MARGIN - STRIP - GAP * (rows - 1)) / rows)


def _grid(count: int, across: float, up: float) -> Grid:
    """The paper and the rows that give the largest drawings, with few empty cells when it does not matter."""
    grids = []
    for paper in (LANDSCAPE, PORTRAIT):
        for columns in range(1, count + 1):
            rows = math.ceil(count / columns)
            cell = _cell(paper, columns, rows)
            room = cell - complex(2 * PAD, 2 * PAD + CAPTION)
            if room.real > 5 and room.imag > 5:
                grids.append(Grid(paper, columns, rows, round_scale(across, up, room.real, room.imag)))
    return min(grids, key=lambda g: (g.mu, g.columns * g.rows, g.paper == PORTRAIT))


def _drawn(sheet: Sheet, scene: Scene, group: GroupAssemblies, size: float) -> None:
    """The group in its colour, its neighbours grey, the frame dark."""
    own, known = group.group.links, _neighbours(group)
    hue = colours(scene.structure) | dict.fromkeys(known, THIN)
    forms = {link: form(sheet, scene, link) for link in (*known, *own)}
    for link, shape in forms.items():
        body(sheet, shape, hue[link])
    pairs = scene.structure.pairs
    for pair in pairs:
        sliding(sheet, scene, pair, hue[pair.slide.runner] if pair.slide else DARK, size)
    circles(sheet, scene, pairs, forms, hue, size)
    grounds(sheet, scene, pairs, size)
    higher_pairs(sheet, scene, pairs, hue, bare=False)
    for link, shape in forms.items():
        _number(sheet, link, shape, hue[link])
    hinged = {p.point for p in pairs if p.kind == "R"}
    named = [(p, p.point) for p in pairs if p.kind == "R"]
    named += [(p, p.name) for p in pairs if p.slide and (p.slide.carrier == FRAME or p.point not in hinged)]
    names(sheet, [(spot(sheet, scene, p, size), name, DARK) for p, name in named])
    settle(sheet)


def _number(sheet: Sheet, link: str, shape: Form, colour: str) -> None:
    """The number of a link: on its plate where it is farthest from all that is drawn there, or beside its bar."""
    label = Label(link, shape.middle, 11, colour, "italic")
    if len(shape.hull) > 2:
        corners = np.array(shape.hull)
        shares = np.array([share for share in np.ndindex(*[STEPS] * min(len(corners), 5)) if sum(share) == STEPS - 1])
        places = shares @ corners[: shares.shape[1]] / (STEPS - 1)
        crowd = np.concatenate(sheet.ground.points)
        free = np.min(np.abs(places[:, None] - crowd[None, :]), axis=1)
        best = int(np.argmax(free))
        if free[best] > CLEAR:
            at, (width, height) = complex(places[best]), text_extent(label)
            sheet.ground.boxes.append(
                (at.real - width / 2, at.real + width / 2, at.imag - height / 2, at.imag + height / 2)
            )
            sheet.text(at, link, label.size, colour=colour, ha="center", style=label.style)
            return
    sheet.labels.append(label)


def _framed(sheet: Sheet, low: complex, high: complex, number_: int, assembly: Assembly) -> None:
    """The cell with the number of the assembly; that of the sketch is marked."""
    corners = [low, complex(high.real, low.imag), high, complex(low.real, high.imag), low]
    mark = assembly.of_sketch
    sheet.line(corners, DARK if mark else THIN, 2.2 if mark else 0.5, z=1, blocks=False)
    words = say("assemblies.cell_sketch" if mark else "assemblies.cell", number=number_)
    sheet.text(low + complex(3, 3.5), words, 10, weight="bold" if mark else "normal")
    margin = assembly.margin if assembly.margin > DEAD else 0
    sheet.text(
        complex(high.real - 3, low.imag + 3.5), say("assemblies.cell_margin", margin=f"{margin:.3g}"), 8.5, ha="right"
    )
