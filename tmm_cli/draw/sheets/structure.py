"""The structural scheme: links and pairs at the sketch, the driver and every Assur group in a colour of its own."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tmm_cli.analysis.pipeline import Results, at_positions
from tmm_cli.draw.paper.drawing import Drawing
from tmm_cli.draw.paper.labels import extent
from tmm_cli.draw.paper.picture import on_large_sheet
from tmm_cli.draw.paper.room import snug
from tmm_cli.draw.paper.sheet import DARK, Sheet
from tmm_cli.draw.sheets.mechanism import place_of_driver
from tmm_cli.draw.symbols.parts import FREE, PALETTE, STRUCTURAL, numbers, symbol_size
from tmm_cli.draw.symbols.render import arrows, names, render, spot
from tmm_cli.draw.symbols.scene import Scene, fitted, scale_to
from tmm_cli.draw.symbols.wheels import outline, replacement
from tmm_cli.language import _, printed, typeset
from tmm_cli.linkage import FRAME
from tmm_cli.plans.record import LANDSCAPE, MARGIN, PORTRAIT, ground_of
from tmm_cli.results.reports.structure import counted_mobility, left_out
from tmm_cli.structure.assur import Group, Structure
from tmm_cli.structure.reduction import RedundantLink
from tmm_cli.vectors import Real, dot

PAD = 20.0  # mm kept free about the pairs, for guides, supports and names
LEAST, A_LINK = 45.0, 25.0  # mm: a scheme is not drawn larger than this and so much more a moving link
WIDEST = 190.0  # mm: the legend on a large sheet, unless the scheme is wider
ROW = 5.4  # mm of a line of the legend
JOINT = 0.9  # mm: pairs of a link in place of a higher pair
PLACES, MANY = 47, 40  # of the driver that are looked at, unless there are so many pairs that some hide others anyway
HIDDEN = 0.03  # share of the mechanism's size: pairs nearer than that to others hide them


@dataclass(frozen=True)
class Part:
    """A driver on the frame (no group), an Assur group, or a redundant link; with its colour."""

    title: str
    links: tuple[str, ...]
    colour: str
    group: Group | None = None
    redundant: RedundantLink | None = None


def parts(structure: Structure) -> tuple[Part, ...]:
    """The primary mechanisms and the groups, in solving order; then the redundant links."""
    cranks = [driver for driver in structure.drivers if driver.base == FRAME]
    every: list[tuple[str, tuple[str, ...], Group | None]] = [
        *((structure.driver_title(d), structure.rigid_with(d.link), None) for d in cranks),
        *((group.title, group.links, group) for group in structure.groups),
    ]
    coloured = [Part(title, links, PALETTE[n % len(PALETTE)], g) for n, (title, links, g) in enumerate(every)]
    redundant = [Part(", ".join(r.links), r.links, FREE, redundant=r) for r in structure.reduction.links]
    return tuple(coloured + redundant)


def colours(structure: Structure) -> dict[str, str]:
    """The colour of every link, by solving order; the frame, and what is rigid to it, is dark."""
    of_frame = dict.fromkeys((FRAME, *structure.rigid_with(FRAME)), DARK)
    return of_frame | {link: part.colour for part in parts(structure) for link in part.links}


def at_sketch(results: Results) -> tuple[str, Scene] | None:
    """Where to draw, in words, and the scene there: the sketch, or a place at which no pair hides another.

    None when the linkage cannot be assembled at the sketch.
    """
    linkage, structure = results.linkage, results.structure
    driver_range = results.driver_range
    if driver_range is None:
        return None
    others = PLACES if len(structure.pairs) <= MANY else 0
    places = np.linspace(driver_range.start, driver_range.end, others + 2)
    motion = at_positions(results, np.array([linkage.sketch.at, *places[1:-1]]), 0)
    if not bool(motion.placed[0]):
        return None
    scenes = [Scene(linkage, structure, motion.poses, k) for k in range(len(motion.q))]
    clear = np.where(motion.placed, np.nan_to_num(_clearness(scenes), nan=-1.0), -1.0)
    best = int(np.argmax(clear))
    k = best if clear[0] < HIDDEN and clear[best] > 2 * clear[0] else 0
    return place_of_driver(results, float(motion.q[k])), scenes[k]


def _clearness(scenes: Sequence[Scene]) -> Real:
    """Least distance of a pair from another, or from a bar of other links, as a share of the size; a value a scene.

    Pairs that always coincide do not count.
    """
    moving, every = scenes[0].structure.links, scenes[0].structure.pairs
    # a guide on the frame may be drawn anywhere along itself
    pairs = [p for p in every if p.kind == "R" or (p.slide is not None and p.slide.carrier != FRAME)]
    spots = np.array([[s.at(p) for p in pairs] for s in scenes])
    spines = [[[*s.joints(link), *(stone for stone, __ in s.guides(link))] for link in moving] for s in scenes]
    bars = np.array([[bar for spine in here for bar in pairwise(spine)] for here in spines], complex)
    bars = bars.reshape(len(scenes), 1, bars.size // (2 * len(scenes)), 2)
    start, span = bars[..., 0], bars[..., 1] - bars[..., 0]
    share = np.clip(dot(span, spots[:, :, None] - start) / np.maximum(np.abs(span) ** 2, 1e-300), 0, 1)
    others = np.concatenate([np.broadcast_to(spots[:, None], (*spots.shape, len(pairs))), start + share * span], axis=2)
    gaps = np.abs(others - spots[:, :, None]).reshape(len(scenes), -1)
    size = np.nanmax(np.abs(spots - spots[:, :1])) or 1.0
    gaps = gaps[:, np.nanmax(gaps, axis=0) > 1e-6 * size]
    return np.asarray(np.min(gaps / size, axis=1, initial=1.0))


def whole_scheme(results: Results) -> Iterator[tuple[str, Drawing]]:
    """The sheet of the scheme at the sketch; none when the linkage cannot be assembled there."""
    found = at_sketch(results)
    if found is not None:
        yield "structure", scheme(results.problem.title, *found).finish()


def scheme(title: str, place: str, scene: Scene) -> Sheet:
    """The whole mechanism with its legend below; labels are placed."""
    legend = Legend(scene.structure)
    links, pairs, hue = scene.structure.links, scene.structure.pairs, colours(scene.structure)
    places, most = scene.extent(links), LEAST + A_LINK * len(links)

    def scale(paper: tuple[float, float]) -> float:
        low, high = ground_of(paper)
        return scale_to(places, high - low - 2 * PAD * (1 + 1j) - 1j * legend.height(paper[0]), most)

    subject = _("Structural scheme, {place} (not to scale)").format(place=place)
    if on_large_sheet():
        most = math.inf
        sheet = Sheet(title, subject, room=snug(places, PAD, WIDEST, legend.height))
    else:
        # upright only where the mechanism becomes much larger
        paper = LANDSCAPE if scale(LANDSCAPE) < 1.4 * scale(PORTRAIT) else PORTRAIT
        sheet = Sheet(title, subject, paper=paper)
    sheet.ground.low += 1j * legend.height(sheet.paper[0])
    scene = fitted(sheet, scene, links, PAD, most)
    look = STRUCTURAL.sized(symbol_size(sheet, scene, links))
    drawn = render(sheet, scene, links, pairs, look, hue)
    arrows(sheet, scene, drawn, look, hue)
    _replacements(sheet, scene)
    numbers(sheet, drawn.forms, hue)
    names(sheet, [(spot(sheet, scene, p, look), p.name, DARK) for p in pairs])
    sheet.settle()
    legend.draw(sheet)
    return sheet


def _replacements(sheet: Sheet, scene: Scene) -> None:
    """The links in place of higher pairs, dashed: with a turning pair at an end, or a stone on a straight profile."""
    with sheet.on_layer("links"):
        for mesh in scene.linkage.meshes:
            link = replacement(outline(scene, mesh))
            start, end = sheet.on(link.start), sheet.on(link.end)
            sheet.line([start, end], DARK, 0.9, "--", 6)
            sheet.circle(start, JOINT, "white", DARK, 0.7)
            if link.slides:
                along = (end - start) / (abs(end - start) or 1.0)
                corners = [end + JOINT * along * way for way in (1 + 2j, -1 + 2j, -1 - 2j, 1 - 2j)]
                sheet.area(corners, "white", DARK, 0.7, 7)
            else:
                sheet.circle(end, JOINT, "white", DARK, 0.7)


class Legend:
    """The band below the scheme: colours of the parts on the left; formula, mobility and class on the right."""

    def __init__(self, structure: Structure) -> None:
        self.structure, self.parts = structure, parts(structure)
        lower = sum(p.lower for p in structure.pairs)
        n, higher = len(structure.links), len(structure.pairs) - lower
        self.facts = [
            _("Formula of structure: {formula}").format(formula=structure.formula.replace("->", "→")),
            _("n = {n} moving links, p₁ = {p1} lower pairs ({r} turning, {p} sliding), p₂ = {p2} higher pairs").format(
                n=n, p1=lower, r=sum(p.kind == "R" for p in structure.pairs),
                p=sum(p.kind == "P" for p in structure.pairs), p2=higher),
            _("W = 3n − 2p₁ − p₂ = 3·{n} − 2·{p1} − {p2} = {w}").format(n=n, p1=lower, p2=higher, w=structure.mobility),
            _("Mechanism of class {roman}").format(roman=structure.roman),
        ]  # fmt: skip
        if structure.reduction:
            formula = _("W of the formula of structure: {count}").format(
                count=typeset(counted_mobility(structure.count))
            )
            self.facts[1:1] = [*left_out(structure), formula]
        points = [p.point for p in structure.pairs if p.kind == "R"]
        inner = [d for d in structure.drivers if d.base != FRAME]
        if inner:
            drivers = ", ".join(f"I({printed(d.base)},{d.link})" for d in inner)
            self.facts.append(_("Drivers between links of groups: {drivers}").format(drivers=drivers))
        if higher:
            self.facts.append(_("Dashed: the links that replace higher pairs"))
        compound = [point for point in dict.fromkeys(points) if points.count(point) > 1]
        if compound:
            self.facts.append(_("Compound hinge {points}: a circle for every pair").format(points=", ".join(compound)))

    def split(self, paper: float) -> tuple[float, list[str]]:
        """Where the right part begins (mm), and its lines."""
        width = paper - 2 * MARGIN
        left = min(0.5 * width, 14 + max(extent(self.words(part), 9)[0] for part in self.parts))
        chars = int((width - left - 6) / 1.75)
        wrapped = (textwrap.wrap(fact, chars, subsequent_indent="   ", max_lines=4) for fact in self.facts)
        return left, [line for lines in wrapped for line in lines]

    def words(self, part: Part) -> str:
        """What a part is."""
        if part.redundant is not None:
            return _("{title}: redundant, adds q = {q}").format(title=part.title, q=part.redundant.constraints)
        if part.group is None:
            return _("{title}: primary mechanism (driver and frame)").format(title=part.title)
        group = part.group
        return _("{title}: class {roman}, order {order}, {type}").format(
            title=part.title, roman=group.roman, order=group.order, type=counted(group.type)
        )

    def height(self, paper: float) -> float:
        __, lines = self.split(paper)
        return ROW * min(max(len(self.parts), len(lines)), 14) + 4

    def draw(self, sheet: Sheet) -> None:
        """Into the band that was kept free."""
        rows, (left, lines) = len(self.parts), self.split(sheet.paper[0])
        top = MARGIN + self.height(sheet.paper[0])
        sheet.line([complex(MARGIN, top), complex(sheet.paper[0] - MARGIN, top)], DARK, 0.6, blocks=False)
        most = int((top - MARGIN - 4) / ROW + 0.5)
        for row, part in enumerate(self.parts[:most]):
            at = complex(MARGIN, top - 4 - ROW * row)
            sheet.line([at, at + 9], part.colour, 3.2, blocks=False)
            hidden = row == most - 1 and rows > most
            text = _("... and {count} parts more").format(count=rows - most + 1) if hidden else self.words(part)
            sheet.text(at + 12, text, 9, colour=part.colour)
        for row, line in enumerate(lines[:most]):
            sheet.text(complex(MARGIN + left + 4, top - 4 - ROW * row), line, 9)


def counted(kind: str) -> str:
    """RRRRRR as 6R: types of large groups only count their pairs."""
    if len(kind) <= 5:
        return kind
    return "".join(f"{kind.count(letter)}{letter}" for letter in dict.fromkeys(kind))
