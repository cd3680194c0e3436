"""Shapes in which links are drawn: a bar between two pairs, a plate between more pairs, a bar along each guide.

In a structural scheme the shape follows from the pairs. In a drawing to scale it follows from the named points, and
guides are as long as the travel along them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from tmm_cli.drawing.paper import DrawingSheet, convex_hull, leave_field
from tmm_cli.drawing.symbols.actuators import Cylinder, cylinder_drivers
from tmm_cli.drawing.symbols.higher_pairs import follower_segments as follower_bars, higher_pair_outline as shape_of
from tmm_cli.drawing.symbols.scene import GUIDE_EXTENSION, ON_LINE, MechanismScene, drop_coincident
from tmm_cli.mechanics.linkage import Slide
from tmm_cli.mechanics.numerics import cross, dot

Segment = tuple[complex, complex]
GUIDE_REACH = 5.0 + GUIDE_EXTENSION  # mm from the middle of a block to the end of its guide
BLOCK_HALF_LENGTH = 3.75  # mm: half the length of a sliding block
GUIDE_OVERHANG = 7.0  # mm by which a guide extends beyond the travel of the middle of its block


@dataclass
class LinkBar:
    """A straight bar of a link.

    Attributes:
        base: a point of the bar, mm.
        along: unit vector along the bar.
        low, high: coordinates of its ends along this vector, measured from `base`, mm.
        holds: pairs of the link that lie on the bar, mm.
    """

    base: complex
    along: complex
    low: float
    high: float
    holds: list[complex] = field(default_factory=list)

    def meets(self, place: complex) -> bool:
        return bool(abs(cross(self.along, place - self.base)) < ON_LINE)

    def extend_to(self, place: complex) -> None:
        """Extend the bar to a point on its line, mm."""
        run = float(dot(self.along, place - self.base))
        self.low, self.high = min(self.low, run), max(self.high, run)

    def foot(self, place: complex) -> complex:
        return self.base + self.along * float(dot(self.along, place - self.base))

    @property
    def tips(self) -> Segment:
        return self.base + self.low * self.along, self.base + self.high * self.along


@dataclass(frozen=True)
class LinkForm:
    """Shape of a link on paper; all points are in mm.

    Attributes:
        joints: pairs of the link, except sliding blocks of other links on its bars.
        boxes: those of these pairs at which the link itself is a sliding block.
        hull: corners of its plate, or both ends of a bar.
        bars: bars along its guides.
        struts: ends of the bars that connect separate parts of the link.
        welds: rigid corners: vertex and vectors along both sides.
    """

    joints: Sequence[complex] = ()
    boxes: Sequence[complex] = ()
    hull: Sequence[complex] = ()
    bars: Sequence[LinkBar] = ()
    struts: Sequence[Segment] = ()
    welds: Sequence[tuple[complex, complex, complex]] = ()

    @property
    def lines(self) -> list[Segment]:
        """Ends of all bars of the link, also of those that connect separate parts of it."""
        lines = [bar.tips for bar in self.bars] + list(self.struts)
        if len(self.hull) == 2:
            lines.append((self.hull[0], self.hull[1]))
        return lines

    @property
    def edges(self) -> list[Segment]:
        """Ends of all bars of the link, and of the sides of its plate."""
        return self.lines + (list(pairwise([*self.hull, self.hull[0]])) if len(self.hull) > 2 else [])

    @property
    def middle(self) -> complex:
        """Point at which the number of the link is written.

        It is the middle of its plate, or the middle of the longest free piece of its longest bar.
        """
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

    def through(self, place: complex) -> complex | None:
        """Return the direction of a bar that continues on both sides of a hinge; None if there is no such bar."""
        for start, end in self.lines:
            length = abs(end - start)
            if length < 2:
                continue
            along = (end - start) / length
            inside = 1.0 < dot(along, place - start) < length - 1.0
            if inside and abs(cross(along, place - start)) < ON_LINE:
                return along
        return None


def form_by_points(sheet: DrawingSheet, scene: MechanismScene, link: str, *, whole: bool = True) -> LinkForm:
    """Return the shape of a link in a drawing to scale, from its named points and pairs.

    whole: True if guides are as long as the travel; False if they end at their blocks, as in thin lines.
    """
    joints = drop_coincident(sheet.on(p) for p in (*scene.ends(link), *scene.joints(link)))
    bars: list[LinkBar] = []
    for slide in _carried_guides(scene, link):
        block, along = sheet.on(scene.place(slide.runner, slide.at)), scene.along(slide)
        (low, high), displacement = scene.travel(slide), scene.run(slide)
        bar = _bar_through(bars, block, along)
        for end, side in ((low - displacement, -along), (high - displacement, along)) if whole else ():
            tip = block + end / sheet.mu * along
            if not any(bar.meets(j) and dot(side, j - tip) > BLOCK_HALF_LENGTH for j in joints):
                bar.extend_to(leave_field(block, tip + GUIDE_OVERHANG * side, *sheet.field))
    return _join_parts(sheet, scene, link, joints, bars)


def form_by_pairs(sheet: DrawingSheet, scene: MechanismScene, link: str) -> LinkForm:
    """Return the shape of a link in a structural scheme, from its pairs."""
    joints = drop_coincident(sheet.on(p) for p in scene.joints(link))
    bars: list[LinkBar] = []
    for slide in _carried_guides(scene, link):
        at, along = sheet.on(scene.place(slide.runner, slide.at)), scene.along(slide)
        bar = _bar_through(bars, at, along)
        bar.extend_to(at - GUIDE_REACH * along)
        bar.extend_to(at + GUIDE_REACH * along)
    for bar in bars:
        for end in scene.ends(link):
            if bar.meets(sheet.on(end)):
                bar.extend_to(sheet.on(end))
    return _join_parts(sheet, scene, link, joints, bars)


def _carried_guides(scene: MechanismScene, link: str) -> list[Slide]:
    """Return the guides on a link, except those of cylinders."""
    slides = [pair.slide for pair in scene.lower_pairs(link) if pair.slide is not None and pair.slide.carrier == link]
    return [slide for slide in slides if slide.name not in cylinder_drivers(scene.linkage)]


def _bar_through(bars: list[LinkBar], at: complex, along: complex) -> LinkBar:
    """Return the bar on the line through a point in this direction. If there is none, it is added to `bars`."""
    same = next((b for b in bars if abs(cross(b.along, along)) < 1e-6 and b.meets(at)), None)
    if same is None:
        same = LinkBar(at, along, 0.0, 0.0)
        bars.append(same)
    return same


def _lay_bar(bars: list[LinkBar], start: complex, end: complex) -> None:
    """Add a bar between two points (mm). If a bar already lies on the line through them, it is extended instead."""
    if abs(end - start) > ON_LINE:
        bar = _bar_through(bars, start, (end - start) / abs(end - start))
        bar.extend_to(start)
        bar.extend_to(end)


def _join_parts(
    sheet: DrawingSheet, scene: MechanismScene, link: str, joints: Sequence[complex], bars: list[LinkBar]
) -> LinkForm:
    """Connect the pairs and bars of a link into one shape.

    Several pairs that are not on a bar form a plate. Separate parts are connected by additional bars.
    """
    driven, boxes = cylinder_drivers(scene.linkage), []
    for pair in scene.lower_pairs(link):
        if pair.slide is not None and pair.name in driven:
            _lay_bar(bars, *Cylinder.of(sheet, scene, pair.slide).part(link))
        elif pair.slide is not None and pair.slide.runner == link:
            boxes.append(sheet.on(scene.at(pair)))
    for mesh in scene.linkage.meshes:
        for start, end in follower_bars(shape_of(scene, mesh)) if mesh.j == link else ():
            _lay_bar(bars, sheet.on(start), sheet.on(end))
    for bar in bars:
        bar.holds += [j for j in joints if bar.meets(j)]
        for place in bar.holds:
            bar.extend_to(place)
    struts: list[Segment] = []
    welds: list[tuple[complex, complex, complex]] = []
    for number, bar in enumerate(bars[1:], 1):
        _join_bars(bars[:number], bar, struts, welds)
    loose = [j for j in joints if not any(bar.meets(j) for bar in bars)]
    if loose and bars:
        bar, near, foot = _nearest_joint(bars, loose)
        bar.extend_to(foot)
        if len(loose) > 1 and bar.holds:
            loose.append(foot)
        else:
            struts.append((near, foot))
            welds.append((foot, near - foot, _longer_arm(bar, foot)))
            # without a mark, bars of one link that meet at a hinge would look like two links
            welds += [(near, foot - near, other - near) for other in loose if other != near]
    hull = _flatten_hull(convex_hull(loose)) if len(loose) > 1 else ()
    return LinkForm(joints, boxes, hull, bars, struts, welds)


def _flatten_hull(hull: Sequence[complex]) -> Sequence[complex]:
    """Return the corners of a plate. If it is so narrow that it looks like a line, only its two ends are returned."""
    if len(hull) < 3:
        return hull
    start, end = max(((p, q) for p in hull for q in hull), key=lambda ends: abs(ends[1] - ends[0]))
    along = (end - start) / abs(end - start)
    return hull if max(abs(cross(along, p - start)) for p in hull) > ON_LINE else (start, end)


def _nearest_joint(bars: Sequence[LinkBar], loose: Sequence[complex]) -> tuple[LinkBar, complex, complex]:
    """Find the shortest connection between the bars of a link and its pairs that are not on a bar.

    Returns:
        The bar, the pair (mm), and the point of the bar (mm).
    """

    def foot(bar: LinkBar, place: complex) -> complex:
        return min(bar.holds, key=lambda hold: abs(hold - place)) if bar.holds else bar.foot(place)

    joint_choices = [(bar, place, foot(bar, place)) for bar in bars for place in loose]
    return min(joint_choices, key=lambda joint: abs(joint[1] - joint[2]))


def _longer_arm(bar: LinkBar, foot: complex) -> complex:
    return max((tip - foot for tip in bar.tips), key=abs)


def _join_bars(
    others: Sequence[LinkBar],
    bar: LinkBar,
    struts: list[Segment],
    welds: list[tuple[complex, complex, complex]],
) -> None:
    """Connect the bar along a guide of a link to the bars along its other guides.

    If two of the bars intersect nearby, both are extended to the point of intersection. Otherwise their nearest ends
    are connected by a further bar.
    """
    for other in others:
        turn = float(cross(other.along, bar.along))
        if abs(turn) > 0.05:
            meet = other.base + other.along * float(cross(bar.base - other.base, bar.along)) / turn
            if abs(meet - bar.base) < 150 and abs(meet - other.base) < 150:
                bar.extend_to(meet)
                other.extend_to(meet)
                welds.append((meet, _longer_arm(bar, meet), _longer_arm(other, meet)))
                return
    start, end = min(((p, q) for p in bar.tips for other in others for q in other.tips), key=lambda w: abs(w[1] - w[0]))
    struts.append((start, end))
