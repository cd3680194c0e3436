"""What a structural scheme shows of a linkage: where its links are, and what each is drawn as.

A link is drawn from what it is joined by: a bar between two pairs, a plate between three and more, a bar along every
guide that it carries. Nothing here is to be measured; sizes are millimetres of paper.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from tmm_cli.draw.scheme import outline
from tmm_cli.draw.sheet import Sheet
from tmm_cli.draw.wheels import Shape, contact, shape, shapes
from tmm_cli.draw.wheels import extent as wheels_extent
from tmm_cli.groups.base import Pose
from tmm_cli.linkage import FRAME, Linkage, Slide
from tmm_cli.structure.assur import Pair, Structure
from tmm_cli.vectors import cross, dot, unit

HINGE, BOX = 1.7, (10.0, 6.0)  # radius of a hinge; length and width of a slider
ON_LINE = 0.3  # what still lies on a line
BEYOND = 6.0  # how far a guide goes on beyond its stone


@dataclass(frozen=True)
class Scene:
    """A linkage with its structure at index k of the poses of its links.

    moved: by how much (m) boxes are drawn away from their running points, along their guides.
    """

    linkage: Linkage
    structure: Structure
    poses: Mapping[str, Pose]
    k: int = 0
    moved: Mapping[str, complex] = field(default_factory=dict)

    def place(self, link: str, local: complex) -> complex:
        """A point of a link (its axes, m) in the drawing's axes, m."""
        if link == FRAME:
            return complex(local)
        return self._now(self.poses[link].x) + local * self._now(self.poses[link].z)

    def along(self, slide: Slide) -> complex:
        """Direction of a guide."""
        turned = 1.0 if slide.carrier == FRAME else self._now(self.poses[slide.carrier].z)
        return complex(turned * unit(slide.direction))

    def at(self, pair: Pair) -> complex:
        """Where a pair is: its hinge, or the running point of its runner, m."""
        if pair.slide is not None:
            return self.place(pair.slide.runner, pair.slide.at) + self.moved.get(pair.name, 0j)
        if pair.kind == "R":
            link = pair.j if pair.i == FRAME else pair.i
            return self.place(link, self.linkage.local(link, pair.point))
        return contact(self.higher(pair))

    def higher(self, pair: Pair) -> Shape:
        """The wheels, or the cam and its follower, of a higher pair."""
        assert pair.mesh is not None
        return shape(pair.mesh, self.linkage, self.place)

    def of(self, link: str) -> tuple[Pair, ...]:
        """The lower pairs of a link."""
        return tuple(p for p in self.structure.pairs if link in (p.i, p.j) and p.kind in ("R", "P"))

    def joints(self, link: str) -> list[complex]:
        """Places at which a link is hinged or runs on a guide; of a link with one of them, its named points too."""
        found = [self.at(p) for p in self.of(link) if p.slide is None or p.slide.runner == link]
        if len(found) + len(self.guides(link)) < 2:
            found += [self.place(link, local) for local in self.linkage.links[link].points.values()]
        return found

    def guides(self, link: str) -> list[tuple[complex, complex]]:
        """Guides that a link carries: the place of the stone on each (m), and the direction."""
        carried = [p for p in self.of(link) if p.slide is not None and p.slide.carrier == link]
        return [(self.at(p), self.along(p.slide)) for p in carried if p.slide is not None]

    def spine(self, link: str) -> list[complex]:
        """All that a link is joined by, one after the other: its hinges, its stones, those that run on it."""
        return [*self.joints(link), *(stone for stone, _ in self.guides(link))]

    def ends(self, link: str) -> list[complex]:
        """Named points of a link: those on its guide show how long it is."""
        return [self.place(link, local) for local in self.linkage.links[link].points.values()]

    def extent(self, links: Iterable[str]) -> list[complex]:
        """Places that must be on the paper when these links are drawn, m."""
        links = tuple(links)
        found: list[complex] = []
        for link in links:
            found += self.joints(link)
            for stone, along in self.guides(link):
                found += [stone, *(e for e in self.ends(link) if abs(cross(along, e - stone)) < 1e-6 * abs(e - stone))]
        found = [p for p in found if np.isfinite(p)]
        size = max((abs(p - q) for p in found for q in found[:1]), default=0.0)
        own = {p.name for p in self.structure.pairs if not p.lower and {p.i, p.j} & set(links)}
        drawn = (*links, FRAME) if len(links) == len(self.structure.links) else links
        return found + wheels_extent(shapes(self.linkage, self.place, own), size, drawn)

    def _now(self, values: object) -> complex:
        row = np.ravel(np.asarray(values))
        return complex(row[self.k if row.size > 1 else 0])


def fitted(
    sheet: Sheet, scene: Scene, links: Sequence[str], low: complex, high: complex, pad: float, most: float
) -> Scene:
    """Put these links into a field of the sheet (mm); where a guide on the frame is does not matter for the structure.

    So a slider that would cover another one of its link is drawn further on along its guide.
    """
    fit(sheet, scene.extent(links), low, high, pad, most)
    links = [link for link in links if link != FRAME]
    boxes = [(p, sheet.on(scene.at(p))) for link in links for p in scene.of(link) if p.slide is not None]
    every = apart(sheet.on(scene.at(p)) for link in links for p in scene.of(link))
    moved = {}
    for pair, at in boxes:
        slide = pair.slide
        if slide is None or slide.carrier != FRAME:
            continue
        if any(abs(place - at) < 0.75 * sum(BOX) for other, place in boxes if other.name != pair.name):
            others = [place for place in every if abs(place - at) > ON_LINE]
            ways = [at + way * 1.9 * BOX[0] * scene.along(slide) for way in (1, -1)]
            moved[pair.name] = (_emptier(ways, others) - at) * sheet.mu
    if moved:
        scene = replace(scene, moved=moved)
        fit(sheet, scene.extent(links), low, high, pad, most)
    return scene


def _emptier(ways: Sequence[complex], others: Sequence[complex]) -> complex:
    """The place that is farther from the others; without any, the lower one."""
    return max(ways, key=lambda way: (min((abs(way - place) for place in others), default=0.0), -way.imag))


@dataclass
class Bar:
    """A straight bar along a guide, from low to high (mm) of its base; `holds` are the link's pairs on it."""

    base: complex
    along: complex
    low: float
    high: float
    holds: list[complex] = field(default_factory=list)

    def meets(self, place: complex) -> bool:
        return bool(abs(cross(self.along, place - self.base)) < ON_LINE)

    def take(self, place: complex) -> None:
        """Reach as far as a place on the line."""
        run = float(dot(self.along, place - self.base))
        self.low, self.high = min(self.low, run), max(self.high, run)

    def foot(self, place: complex) -> complex:
        return self.base + self.along * float(dot(self.along, place - self.base))

    @property
    def tips(self) -> tuple[complex, complex]:
        return self.base + self.low * self.along, self.base + self.high * self.along


@dataclass(frozen=True)
class Form:
    """A link on paper: corners of its plate (or the two ends of its bar), bars, struts with rigid corners.

    joints are its pairs but for the stones on its bars; boxes are those of them where it is the stone itself.
    """

    joints: tuple[complex, ...]
    boxes: tuple[complex, ...]
    hull: tuple[complex, ...]
    bars: tuple[Bar, ...]
    struts: tuple[tuple[complex, complex], ...]
    welds: tuple[tuple[complex, complex, complex], ...]

    @property
    def lines(self) -> list[tuple[complex, complex]]:
        """Its straight parts."""
        lines = [bar.tips for bar in self.bars] + list(self.struts)
        if len(self.hull) == 2:
            lines.append((self.hull[0], self.hull[1]))
        return lines

    @property
    def middle(self) -> complex:
        """Where its number goes: the middle of its plate or of the longest free part of its longest line."""
        if len(self.hull) > 2:
            return sum(self.hull) / len(self.hull)
        if not self.lines:
            return self.joints[0] if self.joints else complex(np.nan, np.nan)
        start, end = max(self.lines, key=lambda line: abs(line[1] - line[0]))
        if abs(end - start) < ON_LINE:
            return start
        along = (end - start) / abs(end - start)
        joined = (*self.joints, *(bar.base for bar in self.bars))
        runs = sorted({0.0, abs(end - start), *(float(dot(along, j - start)) for j in joined)})
        runs = [r for r in runs if 0 <= r <= abs(end - start)]
        gap = max(range(len(runs) - 1), key=lambda n: runs[n + 1] - runs[n])
        return start + along * (runs[gap] + runs[gap + 1]) / 2

    @property
    def room(self) -> float:
        """Distance of the middle of its plate from the nearest edge, mm."""
        edges = zip(self.hull, (*self.hull[1:], self.hull[0]), strict=True)
        return min(abs(float(cross(q - p, self.middle - p))) / abs(q - p) for p, q in edges)

    def through(self, place: complex) -> complex | None:
        """The direction of a bar that goes on beyond a hinge on both sides, if there is one."""
        for start, end in self.lines:
            length = abs(end - start)
            if length < 2:
                continue
            along = (end - start) / length
            inside = 1.0 < dot(along, place - start) < length - 1.0
            if inside and abs(cross(along, place - start)) < ON_LINE:
                return along
        return None


def form(sheet: Sheet, scene: Scene, link: str) -> Form:
    """The form of a link from its pairs, on paper."""
    joints = apart(sheet.on(p) for p in scene.joints(link))
    bars: list[Bar] = []
    for stone, along in scene.guides(link):
        at = sheet.on(stone)
        reach = BOX[0] / 2 + BEYOND
        same = next((b for b in bars if abs(cross(b.along, along)) < 1e-6 and b.meets(at)), None)
        if same is None:
            same = Bar(at, along, -reach, reach)
            bars.append(same)
        same.take(at - reach * along)
        same.take(at + reach * along)
    for bar in bars:
        bar.holds += [j for j in joints if bar.meets(j)]
        for place in [*bar.holds, *(sheet.on(e) for e in scene.ends(link))]:
            if bar.meets(place):
                bar.take(place)
    struts: list[tuple[complex, complex]] = []
    welds: list[tuple[complex, complex, complex]] = []
    for number, bar in enumerate(bars[1:], 1):
        _join(bars[:number], bar, struts, welds)
    loose = [j for j in joints if not any(bar.meets(j) for bar in bars)]
    if loose and bars:
        bar, near, foot = _nearest(bars, loose)
        bar.take(foot)
        if len(loose) > 1 and bar.holds:
            loose.append(foot)
        else:
            struts.append((near, foot))
            welds.append((foot, near - foot, _longer(bar, foot)))
            # at a hinge, bars of one link would look like two links without a mark
            welds += [(near, foot - near, other - near) for other in loose if other != near]
    hull = tuple(_flat(outline(loose))) if len(loose) > 1 else ()
    boxes = tuple(sheet.on(scene.at(p)) for p in scene.of(link) if p.slide is not None and p.slide.runner == link)
    return Form(tuple(joints), boxes, hull, tuple(bars), tuple(struts), tuple(welds))


def apart(places: Iterable[complex]) -> list[complex]:
    """Places without those that coincide with an earlier one."""
    found: list[complex] = []
    for place in places:
        if np.isfinite(place) and all(abs(place - other) > ON_LINE for other in found):
            found.append(place)
    return found


def _flat(hull: Sequence[complex]) -> Sequence[complex]:
    """Corners of a plate; the two ends of a plate that is hardly wider than a bar."""
    if len(hull) < 3:
        return hull
    start, end = max(((p, q) for p in hull for q in hull), key=lambda ends: abs(ends[1] - ends[0]))
    along = (end - start) / abs(end - start)
    return hull if max(abs(cross(along, p - start)) for p in hull) > 1.1 * HINGE else (start, end)


def _nearest(bars: Sequence[Bar], loose: Sequence[complex]) -> tuple[Bar, complex, complex]:
    """Where pairs beside the bars are joined to them: at a pair on a bar, or at the foot of the perpendicular."""
    ways = []
    for bar in bars:
        for place in loose:
            foot = min(bar.holds, key=lambda hold: abs(hold - place)) if bar.holds else bar.foot(place)
            ways.append((abs(place - foot), bar, place, foot))
    _, bar, place, foot = min(ways, key=lambda way: way[0])
    return bar, place, foot


def _longer(bar: Bar, foot: complex) -> complex:
    return max((tip - foot for tip in bar.tips), key=abs)


def _join(
    others: Sequence[Bar],
    bar: Bar,
    struts: list[tuple[complex, complex]],
    welds: list[tuple[complex, complex, complex]],
) -> None:
    """Two guides of one link are one body: they are led to where they cross, or joined by a strut."""
    for other in others:
        turn = float(cross(other.along, bar.along))
        if abs(turn) > 0.05:
            meet = other.base + other.along * float(cross(bar.base - other.base, bar.along)) / turn
            if abs(meet - bar.base) < 150 and abs(meet - other.base) < 150:
                bar.take(meet)
                other.take(meet)
                welds.append((meet, _longer(bar, meet), _longer(other, meet)))
                return
    start, end = min(((p, q) for p in bar.tips for other in others for q in other.tips), key=lambda w: abs(w[1] - w[0]))
    struts.append((start, end))


def fit(sheet: Sheet, places: Sequence[complex], low: complex, high: complex, pad: float, most: float) -> None:
    """Put places (m) into the middle of a field of the sheet (mm), as large as the pad and `most` (mm) let them be."""
    array = np.array(places or [0j])
    least = complex(array.real.min(), array.imag.min())
    end = complex(array.real.max(), array.imag.max())
    room = high - low - 2 * pad * (1 + 1j)
    across, up = (end - least).real, (end - least).imag
    size = max(across / room.real, up / room.imag, max(across, up) / most)
    sheet.mu = size if size > 0 else 1.0
    sheet.origin = (low + high) / 2 - (least + end) / 2 / sheet.mu
