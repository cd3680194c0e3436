"""Positions of the links, points and pairs of a mechanism at one driver coordinate, and their scale on paper."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from tmm_cli.drawing.paper import DrawingSheet
from tmm_cli.drawing.symbols.higher_pairs import (
    HigherPairOutline,
    contact_point,
    higher_pair_outline,
    outline_extent as wheels_extent,
)
from tmm_cli.mechanics.groups import Pose
from tmm_cli.mechanics.linkage import FRAME, Linkage, Slide
from tmm_cli.mechanics.numerics import cross, dot, unit
from tmm_cli.mechanics.plans import extent
from tmm_cli.mechanics.structure import Pair, Structure

ON_LINE = 0.3  # mm: tolerance for points on a line
GUIDE_EXTENSION = 6.0  # mm by which a guide extends beyond its block
LEAST_BOX_GAP = 12.0  # mm: boxes closer than this would overlap
BOX_SHIFT = 19.0  # mm by which a box that would overlap is moved along its guide


FRAME_POSE = Pose(np.zeros(1, complex), np.ones(1, complex), np.zeros(1))  # of the frame


@dataclass(frozen=True)
class MechanismScene:
    """A mechanism in one position.

    Attributes:
        linkage: the linkage.
        structure: its structure.
        poses: positions and angles of its links in several positions of the mechanism, by link.
        k: index of the position in `poses`.
        moved: displacements (m) of boxes along their guides, by pair; they prevent boxes from overlapping.
    """

    linkage: Linkage
    structure: Structure
    poses: Mapping[str, Pose]
    k: int = 0
    moved: Mapping[str, complex] = field(default_factory=dict)

    def place(self, link: str, local: complex) -> complex:
        """Convert a point from the axes of a link to global coordinates in this position, m."""
        if link == FRAME:
            return complex(local)
        return self._now(self.poses[link].x) + local * self._now(self.poses[link].z)

    def angle(self, link: str) -> float:
        """Return the angle of a link in this position, rad."""
        return float(np.angle(self.place(link, 1 + 0j) - self.place(link, 0j)))

    def along(self, slide: Slide) -> complex:
        """Return the unit vector along a guide in this position."""
        turned = 1.0 if slide.carrier == FRAME else self._now(self.poses[slide.carrier].z)
        return complex(turned * unit(slide.direction))

    def run(self, slide: Slide) -> float:
        """Return the displacement of a sliding block along its guide in this position, m."""
        foot = self.place(slide.carrier, slide.through)
        return float(dot(self.along(slide), self.place(slide.runner, slide.at) - foot))

    def travel(self, slide: Slide) -> tuple[float, float]:
        """Return the smallest and the largest displacement of a sliding block along its guide over all positions, m."""
        carrier, runner = (self.poses.get(link, FRAME_POSE) for link in (slide.carrier, slide.runner))
        runs = dot(carrier.z * unit(slide.direction), runner.at(slide.at) - carrier.at(slide.through))
        return float(np.nanmin(runs)), float(np.nanmax(runs))

    def point(self, name: str) -> complex:
        """Return the position of a named point, m."""
        link = self.linkage.owner(name)
        return self.place(link, self.linkage.local(link, name))

    def at(self, pair: Pair) -> complex:
        """Return the position of a pair (m): its hinge, its sliding block, or its point of contact."""
        if pair.slide is not None:
            return self.place(pair.slide.runner, pair.slide.at) + self.moved.get(pair.name, 0j)
        if pair.kind == "R":
            link = pair.j if pair.i == FRAME else pair.i
            return self.place(link, self.linkage.local(link, pair.point))
        return contact_point(self.higher(pair))

    def higher(self, pair: Pair) -> HigherPairOutline:
        """Return the geometry of a higher pair."""
        assert pair.mesh is not None
        return higher_pair_outline(self, pair.mesh)

    def lower_pairs(self, link: str) -> tuple[Pair, ...]:
        """Return the lower pairs of a link."""
        return tuple(p for p in self.structure.pairs if link in (p.i, p.j) and p.kind in ("R", "P"))

    def joints(self, link: str) -> list[complex]:
        """Return the positions (m) of the hinges and sliding blocks of a link.

        If a link other than a cam has fewer than two pairs, the positions of its named points are added.
        """
        points = [self.at(p) for p in self.lower_pairs(link) if p.slide is None or p.slide.runner == link]
        disk = any(mesh.kind == "cam" and mesh.i == link for mesh in self.linkage.meshes)
        if len(points) + len(self.guides(link)) < 2 and not disk:
            points += self.ends(link)
        return points

    def guides(self, link: str) -> list[tuple[complex, complex]]:
        """Return for each guide on a link the position of its sliding block (m) and the unit vector along the guide."""
        carried = [p for p in self.lower_pairs(link) if p.slide is not None and p.slide.carrier == link]
        return [(self.at(p), self.along(p.slide)) for p in carried if p.slide is not None]

    def ends(self, link: str) -> list[complex]:
        """Return the positions of the named points of a link, m."""
        return [self.place(link, local) for local in self.linkage.links[link].points.values()]

    def extent(self, links: Iterable[str]) -> list[complex]:
        """Return the points (m) that must be on the sheet when these links are drawn."""
        links = tuple(links)
        points: list[complex] = []
        for link in links:
            points += self.joints(link)
            for block, along in self.guides(link):
                points += [block, *(e for e in self.ends(link) if abs(cross(along, e - block)) < 1e-6 * abs(e - block))]
        points = [p for p in points if np.isfinite(p)]
        size = max((abs(p - q) for p in points for q in points[:1]), default=0.0)
        outlines = [self.higher(p) for p in self.structure.pairs if not p.lower and {p.i, p.j} & set(links)]
        drawn = (*links, FRAME) if len(links) == len(self.structure.links) else links
        return points + wheels_extent(outlines, size, drawn)

    def _now(self, values: object) -> complex:
        row = np.ravel(np.asarray(values))
        return complex(row[self.k if row.size > 1 else 0])


def fit_links(
    sheet: DrawingSheet, scene: MechanismScene, links: Sequence[str], pad: float, most: float
) -> MechanismScene:
    """Choose scale and origin of the sheet so that links fill its field.

    Boxes of sliders on the frame are moved along their guides so that they do not overlap.

    Args:
        sheet: sheet to draw on.
        scene: the mechanism in the position to be drawn.
        links: links to be drawn.
        pad: margin on each side, mm.
        most: largest size of the drawing, mm.

    Returns:
        The mechanism with the moved boxes.
    """
    fit_points(sheet, scene.extent(links), pad, most)
    parted = spread_boxes(sheet, scene, links)
    if parted is not scene:
        fit_points(sheet, parted.extent(links), pad, most)
        parted = spread_boxes(sheet, scene, links)
        centre_points(sheet, parted.extent(links))
    return parted


def spread_boxes(sheet: DrawingSheet, scene: MechanismScene, links: Sequence[str]) -> MechanismScene:
    """Move boxes of sliders along guides on the frame so that they do not overlap.

    The drawn position of a box along such a guide is arbitrary.
    """
    boxes = {p.name: sheet.on(scene.at(p)) for link in links for p in scene.lower_pairs(link) if p.slide is not None}
    all_points = drop_coincident(sheet.on(scene.at(p)) for link in links for p in scene.lower_pairs(link))
    moved = {}
    for pair in (p for link in links for p in scene.lower_pairs(link)):
        if pair.slide is None or pair.slide.carrier != FRAME:
            continue
        at = boxes[pair.name]
        if any(abs(place - at) < LEAST_BOX_GAP for name, place in boxes.items() if name != pair.name):
            others = [place for place in (*all_points, *boxes.values()) if abs(place - at) > ON_LINE]
            choices = [at + side * BOX_SHIFT * scene.along(pair.slide) for side in (1, -1)]
            # the side farther from the other boxes; if there are none, the lower one
            free = max(choices, key=lambda z: (min((abs(z - other) for other in others), default=0.0), -z.imag))
            boxes[pair.name] = free
            moved[pair.name] = (free - at) * sheet.mu
    return replace(scene, moved=moved) if moved else scene


def scale_to_fit(points: Sequence[complex], room: complex, most: float) -> float:
    """Return the scale (m per mm) at which points fit into a space on the paper.

    Args:
        points: points, m.
        room: width + i height of the space, mm.
        most: largest size of the drawing, mm.
    """
    larger, across, up, __ = extent(points or [0j])
    return max(across / room.real, up / room.imag, larger / most) or 1.0


def fit_points(sheet: DrawingSheet, points: Sequence[complex], pad: float, most: float) -> None:
    """Choose scale and origin of the sheet so that points fill its field.

    Args:
        sheet: the sheet.
        points: the points, m.
        pad: margin on each side, mm.
        most: largest size of the drawing, mm.
    """
    sheet.mu = scale_to_fit(points, sheet.canvas.high - sheet.canvas.low - 2 * pad * (1 + 1j), most)
    centre_points(sheet, points)


def centre_points(sheet: DrawingSheet, points: Sequence[complex]) -> None:
    """Choose the origin of the sheet so that points (m) are in the middle of its field."""
    sheet.origin = (sheet.canvas.low + sheet.canvas.high) / 2 - extent(points or [0j])[3] / sheet.mu


def drop_coincident(points: Iterable[complex]) -> list[complex]:
    """Return the points (mm) without those that coincide on paper with an earlier point."""
    distinct: list[complex] = []
    for place in points:
        if np.isfinite(place) and all(abs(place - other) > ON_LINE for other in distinct):
            distinct.append(place)
    return distinct


def points_to_scale(scene: MechanismScene, points: Sequence[complex]) -> list[complex]:
    """Return these points (m) with further points of gears, cams and load elements that must also be on the sheet."""
    size = extent([p for p in points if np.isfinite(p)] or [0j])[0]
    all_points = [*points, *wheels_extent((higher_pair_outline(scene, mesh) for mesh in scene.linkage.meshes), size)]
    ends = (end for element in scene.linkage.elements for end in element.ends)
    return [*all_points, *(scene.place(end.link, end.at) for end in ends)]


def frame_pivots(linkage: Linkage) -> list[complex]:
    """Return the positions of the fixed hinges, m."""
    return [complex(linkage.local(FRAME, hinge.point)) for hinge in linkage.hinges if FRAME in hinge.links]
