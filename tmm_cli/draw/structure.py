"""The structural scheme: links and pairs at the sketch, the driver and every Assur group in a colour of its own."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from matplotlib.figure import Figure

from tmm_cli.draw.actuators import driver_name
from tmm_cli.draw.labels import Label, extent
from tmm_cli.draw.scene import BEYOND, BOX, Form, Scene, fitted, form
from tmm_cli.draw.sheet import DARK, Sheet
from tmm_cli.draw.symbols import (
    PALETTE,
    body,
    box,
    hinge,
    number,
    rails,
    settle,
    sliding_arrow,
    support,
    symbol_size,
    turning_arrow,
)
from tmm_cli.draw.wheels import draw
from tmm_cli.linkage import FRAME
from tmm_cli.motion import Motion
from tmm_cli.pipeline import Results, at_positions
from tmm_cli.plans.record import LANDSCAPE, MARGIN, PORTRAIT, STRIP
from tmm_cli.problem.dimensions import ANGLE, LENGTH
from tmm_cli.structure.assur import ROMAN, Group, Pair, Structure
from tmm_cli.vectors import Real, dot
from tmm_cli.words import say

PAD = 20.0  # mm kept free about the pairs, for guides, supports and names
LEAST, A_LINK = 45.0, 25.0  # mm: a scheme is not drawn larger than this and so much more a moving link
ROW = 5.4  # mm of a line of the legend
PLACES, MANY = 47, 40  # of the driver that are looked at, unless there are so many pairs that some hide others anyway
HIDDEN = 0.03  # share of the mechanism's size: pairs nearer than that to others hide them


@dataclass(frozen=True)
class Part:
    """A driver on the frame (no group), or an Assur group; with its colour."""

    title: str
    links: tuple[str, ...]
    colour: str
    group: Group | None = None


def parts(structure: Structure) -> tuple[Part, ...]:
    """The primary mechanisms and the groups, in solving order."""
    grouped = {link for group in structure.groups for link in group.links}
    primary = [(f"I({FRAME},{link})", (link,), None) for link in structure.links if link not in grouped]
    every = [*primary, *((g.title, g.links, g) for g in structure.groups)]
    return tuple(Part(title, links, PALETTE[n % len(PALETTE)], group) for n, (title, links, group) in enumerate(every))


def colours(structure: Structure) -> dict[str, str]:
    """The colour of every link; the frame is dark."""
    return {FRAME: DARK} | {link: part.colour for part in parts(structure) for link in part.links}


def pair_colour(structure: Structure, pair: Pair) -> str:
    """The colour of the part that a pair came with: that of its later link."""
    order = {FRAME: -1} | {link: n for n, part in enumerate(parts(structure)) for link in part.links}
    return colours(structure)[max((pair.i, pair.j), key=lambda link: order.get(link, -1))]


def at_sketch(results: Results) -> tuple[Motion, int] | None:
    """The motion with the index of the place to draw: the sketch, or a place at which no pair hides another.

    None when the linkage cannot be assembled there.
    """
    linkage, structure = results.linkage, results.structure
    way = results.way
    if way is None:
        return None
    others = PLACES if len(structure.pairs) <= MANY else 0
    places = np.linspace(way.start, way.end, others + 2)
    motion = at_positions(results, np.array([linkage.sketch.at, *places[1:-1]]), 0)
    if not bool(motion.placed[0]):
        return None
    clear = _clearness(Scene(linkage, structure, motion.poses), motion)
    best = int(np.argmax(clear))
    return motion, best if clear[0] < HIDDEN and clear[best] > 2 * clear[0] else 0


def _clearness(scene: Scene, motion: Motion) -> Real:
    """Least distance of a pair from another, or from a bar of other links, as a share of the size; a value a place.

    Pairs that always coincide do not count.
    """
    number = len(motion.q)
    scenes = [Scene(scene.linkage, scene.structure, scene.poses, k) for k in range(number)]
    moving = scene.structure.links
    # a guide on the frame may be drawn anywhere along itself
    pairs = [p for p in scene.structure.pairs if p.kind == "R" or (p.slide is not None and p.slide.carrier != FRAME)]
    spots = np.array([[s.at(p) for p in pairs] for s in scenes])
    bars = np.array([[part for link in moving for part in pairwise(s.spine(link))] for s in scenes])
    size = np.nanmax(np.abs(spots - spots[:, :1])) or 1.0
    gaps = [np.abs(spots[:, a] - spots[:, b]) for a in range(spots.shape[1]) for b in range(a)]
    for a in range(spots.shape[1]):
        for n in range(bars.shape[1] if bars.size else 0):
            start, end, spot = bars[:, n, 0], bars[:, n, 1], spots[:, a]
            way = end - start
            share = np.clip(dot(way, spot - start) / np.maximum(np.abs(way) ** 2, 1e-300), 0, 1)
            gaps.append(np.abs(start + share * way - spot))
    apart = [gap / size for gap in gaps if np.nanmax(gap) > 1e-6 * size]
    clear = np.min(apart, axis=0) if apart else np.ones(number)
    return np.where(motion.placed, np.nan_to_num(clear, nan=-1.0), -1.0)


def structure(results: Results) -> Iterable[tuple[str, Figure]]:
    """The structural scheme on a sheet of its own."""
    found = at_sketch(results)
    if found is not None:
        motion, k = found
        scene = Scene(results.linkage, results.structure, motion.poses, k)
        yield "structure", scheme(results.problem.title, where(results, motion, k), scene).finish()


def where(results: Results, motion: Motion, k: int) -> str:
    """The place of the driver, in words."""
    measure, key = (ANGLE, "scheme.at_crank") if results.linkage.driver.kind == "turn" else (LENGTH, "scheme.at_slider")
    units = results.problem.units
    return say(key, place=f"{units.from_si(float(motion.q[k]), measure):.6g} {units.symbol(measure)}")


def scheme(title: str, place: str, scene: Scene) -> Sheet:
    """The whole mechanism with its legend; labels are placed."""
    legend = Legend(scene.structure)
    sheet, scene = _paper(title, say("scheme.title", place=place), scene, legend)
    size = symbol_size(sheet, scene, scene.structure.links)
    hue = colours(scene.structure)
    forms = {link: form(sheet, scene, link) for link in scene.structure.links}
    higher_pairs(sheet, scene, scene.structure.pairs, hue, bare=False)
    for link, shape in forms.items():
        body(sheet, shape, hue[link])
    for pair in scene.structure.pairs:
        sliding(sheet, scene, pair, hue[pair.slide.runner] if pair.slide else DARK, size)
    circles(sheet, scene, scene.structure.pairs, forms, hue, size)
    grounds(sheet, scene, scene.structure.pairs, size)
    arrows(sheet, scene, forms, hue, size)
    for link, shape in forms.items():
        number(sheet, link, shape, hue[link])
    names(sheet, [(spot(sheet, scene, p, size), p.name, DARK) for p in scene.structure.pairs])
    settle(sheet)
    legend.draw(sheet)
    return sheet


def _paper(title: str, caption: str, scene: Scene, legend: Legend) -> tuple[Sheet, Scene]:
    """A sheet with room for the legend below: landscape, unless the mechanism becomes much larger on an upright one."""
    links = scene.structure.links
    array, most = np.array(scene.extent(links) or [0j]), LEAST + A_LINK * len(links)
    across, up = np.ptp(array.real), np.ptp(array.imag)

    def scale(paper: tuple[float, float]) -> float:
        room = paper[0] - 2 * (MARGIN + PAD), paper[1] - STRIP - legend.height(paper[0]) - 2 * (MARGIN + PAD)
        return float(max(across / room[0], up / room[1], max(across, up) / most))

    wide = scale(LANDSCAPE) < 1.4 * scale(PORTRAIT)
    sheet = Sheet(title, caption, [0j, 9 + 1j if wide else 1 + 9j])
    sheet.ground.low += 1j * legend.height(sheet.paper[0])
    return sheet, fitted(sheet, scene, links, sheet.ground.low, sheet.ground.high, PAD, most)


def sliding(sheet: Sheet, scene: Scene, pair: Pair, colour: str, size: float) -> None:
    """The box of a sliding pair."""
    if pair.slide is not None:
        box(sheet, sheet.on(scene.at(pair)), scene.along(pair.slide), colour, size)


def spot(sheet: Sheet, scene: Scene, pair: Pair, size: float) -> complex:
    """Where the name of a pair belongs: its hinge, the end of its box, or that of its guide on the frame."""
    at = sheet.on(scene.at(pair))
    if pair.slide is None:
        return at
    beyond = BEYOND if pair.slide.carrier == FRAME else 0.0
    return at - scene.along(pair.slide) * (size * BOX[0] / 2 + beyond)


def circles(
    sheet: Sheet, scene: Scene, pairs: Iterable[Pair], forms: Mapping[str, Form], hue: Mapping[str, str], size: float
) -> None:
    """The turning pairs; those in one place are a compound hinge."""
    for at, here in together((sheet.on(scene.at(p)), p) for p in pairs if p.kind == "R"):
        threads = []
        for link in dict.fromkeys(link for p in here for link in (p.i, p.j)):
            along = forms[link].through(at) if link in forms else None
            if along is not None:
                threads.append((along, hue[link]))
        hinge(sheet, at, [pair_colour(scene.structure, p) for p in here], size, threads)


def together(places: Iterable[tuple[complex, Pair]]) -> list[tuple[complex, list[Pair]]]:
    """Pairs gathered by the place on paper."""
    found: list[tuple[complex, list[Pair]]] = []
    for at, pair in places:
        same = next((pairs for place, pairs in found if abs(place - at) < 0.5), None)
        if same is None:
            found.append((at, [pair]))
        else:
            same.append(pair)
    return found


def grounds(sheet: Sheet, scene: Scene, pairs: Iterable[Pair], size: float) -> None:
    """The frame at every pair that it has, with its number."""
    fixed = [p for p in pairs if FRAME in (p.i, p.j)]
    for pair in fixed:
        if pair.slide is None:
            continue
        at, along = sheet.on(scene.at(pair)), scene.along(pair.slide)
        end = rails(sheet, at, along, size) if pair.slide.carrier == FRAME else at + along * size * BOX[0] / 2
        sheet.label(FRAME, end, 9, DARK, "italic")
    for at, _ in together((sheet.on(scene.at(p)), p) for p in fixed if p.kind == "R"):
        sheet.label(FRAME, support(sheet, at, size), 9, DARK, "italic")


def higher_pairs(sheet: Sheet, scene: Scene, pairs: Iterable[Pair], hue: Mapping[str, str], *, bare: bool) -> None:
    """Pairs of toothed wheels and of cams. bare: of a pair with another part only what belongs to links in `hue`."""
    for pair in pairs:
        if not pair.lower:
            draw(sheet, scene.higher(pair), hue, bare=bare)


def arrows(sheet: Sheet, scene: Scene, forms: Mapping[str, Form], hue: Mapping[str, str], size: float) -> None:
    """How the drivers of these links go."""
    for driver in scene.linkage.drivers:
        if driver.link not in forms:
            continue
        pair = scene.structure.driving_pair(driver)
        at = sheet.on(scene.at(pair))
        if pair.slide is not None:
            along = scene.along(pair.slide) * driver.sense * (1 if pair.slide.runner == driver.link else -1)
            sliding_arrow(sheet, at, along, size, driver_name(driver, "v"), hue[driver.link])
        else:
            arm = max((end - at for line in forms[driver.link].lines for end in line), key=abs, default=1 + 0j)
            turning_arrow(sheet, at, float(np.angle(arm)), driver.sense, driver_name(driver, "ω"), hue[driver.link])


def names(sheet: Sheet, named: Iterable[tuple[complex, str, str]]) -> None:
    """Names beside their places; those of one place share a label."""
    found: list[tuple[complex, list[str], str]] = []
    for at, name, colour in named:
        same = next((words for place, words, _ in found if abs(place - at) < 0.5), None)
        if same is None:
            found.append((at, [name], colour))
        elif name not in same:
            same.append(name)
    for at, words, colour in found:
        sheet.label(", ".join(words), at, 10, colour)


class Legend:
    """The band below the scheme: colours of the parts on the left; formula, mobility and class on the right."""

    def __init__(self, structure: Structure) -> None:
        self.structure, self.parts = structure, parts(structure)
        lower = sum(p.lower for p in structure.pairs)
        n, higher = len(structure.links), len(structure.pairs) - lower
        self.facts = [
            say("scheme.formula", formula=structure.formula.replace("->", "→")),
            say("scheme.links", n=n, p1=lower, r=sum(p.kind == "R" for p in structure.pairs),
                p=sum(p.kind == "P" for p in structure.pairs), p2=higher),
            say("scheme.mobility", n=n, p1=lower, p2=higher, w=structure.mobility),
            say("scheme.class", roman=ROMAN[min(structure.mechanism_class, 10)]),
        ]  # fmt: skip
        points = [p.point for p in structure.pairs if p.kind == "R"]
        inner = [d for d in structure.drivers if d.base != FRAME]
        if inner:
            self.facts.append(say("scheme.between", drivers=", ".join(f"I({d.base},{d.link})" for d in inner)))
        compound = [point for point in dict.fromkeys(points) if points.count(point) > 1]
        if compound:
            self.facts.append(say("scheme.compound", points=", ".join(compound)))

    def split(self, paper: float) -> tuple[float, int, list[str]]:
        """Where the right part begins (mm), rows of the left part, lines of the right one."""
        width = paper - 2 * MARGIN
        left = min(0.5 * width, 14 + max(extent(Label(self.words(part), 0j, 9, DARK))[0] for part in self.parts))
        chars = int((width - left - 6) / 1.75)
        lines = [
            line for fact in self.facts for line in textwrap.wrap(fact, chars, subsequent_indent="   ", max_lines=4)
        ]
        return left, len(self.parts), lines

    def words(self, part: Part) -> str:
        """What a part is."""
        if part.group is None:
            return say("scheme.primary", title=part.title)
        group = part.group
        return say("scheme.group", title=part.title, roman=ROMAN[min(group.grade, 10)], order=group.order,
                   type=_short(group.type))  # fmt: skip

    def height(self, paper: float) -> float:
        _, rows, lines = self.split(paper)
        return ROW * min(max(rows, len(lines)), 14) + 4

    def draw(self, sheet: Sheet) -> None:
        """Into the band that was kept free."""
        left, rows, lines = self.split(sheet.paper[0])
        top = MARGIN + self.height(sheet.paper[0])
        sheet.axes.plot([MARGIN, sheet.paper[0] - MARGIN], [top, top], color=DARK, lw=0.6)
        most = int((top - MARGIN - 4) / ROW + 0.5)
        for row, part in enumerate(self.parts[:most]):
            at = complex(MARGIN, top - 4 - ROW * row)
            sheet.axes.plot([at.real, at.real + 9], [at.imag] * 2, color=part.colour, lw=3.2, solid_capstyle="butt")
            hidden = row == most - 1 and rows > most
            text = say("scheme.more", count=rows - most + 1) if hidden else self.words(part)
            sheet.text(at + 12, text, 9, colour=part.colour)
        for row, line in enumerate(lines[:most]):
            sheet.text(complex(MARGIN + left + 4, top - 4 - ROW * row), line, 9)


def _short(kind: str) -> str:
    """RRRRRR as 6R: types of large groups only count their pairs."""
    if len(kind) <= 5:
        return kind
    return "".join(f"{kind.count(letter)}{letter}" for letter in dict.fromkeys(kind))
