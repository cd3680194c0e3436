"""Geometry of gears, racks and cams, in metres.

Gears are drawn as pitch circles with the pitch point. The file gives a cam only by the motion of its follower. Its
disk is therefore computed for a follower with a flat face if the follower slides (as in the force plan), and for a
roller on an arm if it swings.
"""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.mechanics.groups import carrier_axis
from tmm_cli.mechanics.linkage import Mesh
from tmm_cli.mechanics.numerics import Vector, dot, unit

if TYPE_CHECKING:
    from tmm_cli.drawing.symbols.scene import MechanismScene


ROLLER_ARM, ROLLER_RADIUS = 0.8, 0.1  # of the distance of the axes
PROFILE_STEPS = 361
CIRCLE_ANGLES = [2 * math.pi * n / 24 for n in range(24)]  # rad: points of a pitch circle that must be on the sheet
LARGE_GEAR = 3.0  # times the size of the mechanism or the centre distance: larger gears do not decide the scale


@dataclass(frozen=True)
class GearDisc:
    """Pitch circle of a gear.

    Attributes:
        link: link to which the gear belongs.
        centre: centre, m.
        radius: pitch radius, m.
        ring: True for internal teeth.
    """

    link: str
    centre: complex
    radius: float
    ring: bool = False


@dataclass(frozen=True)
class MeshOutline:
    """Geometry of a gear in mesh with another gear or a rack.

    Attributes:
        mesh: the pair.
        pitch: pitch point, m.
        along: unit vector along the pitch line, the common tangent of the pitch circles.
        discs: pitch circles.
        side: unit vector from the gear axis to the rack; 0 for two gears.
        start: sliding point of the rack, m.
    """

    mesh: Mesh
    pitch: complex
    along: complex
    discs: tuple[GearDisc, ...]
    side: complex = 0j
    start: complex = 0j


@dataclass(frozen=True)
class CamOutline:
    """Geometry of a cam and its follower.

    Attributes:
        mesh: the pair.
        axis: axis of the cam, m.
        disk: profile of the cam, m.
        touch: point of contact, m.
        face: ends of the flat face of the follower, m; if the follower has a roller, both are its centre.
        stem: ends of the stem or arm of the follower, m.
        roller: radius of the roller, m; 0 for a flat face.
        true: True if the profile produces the prescribed motion; False if it is only a symbol.
    """

    mesh: Mesh
    axis: complex
    disk: Vector
    touch: complex
    face: tuple[complex, complex]
    stem: tuple[complex, complex]
    roller: float = 0.0
    true: bool = False


HigherPairOutline = MeshOutline | CamOutline


def higher_pair_outline(scene: MechanismScene, mesh: Mesh) -> HigherPairOutline:
    """Return the geometry of a higher pair in one position of the mechanism."""
    if mesh.kind == "cam":
        return _flat_faced_cam(scene, mesh) if mesh.slide else _roller_cam(scene, mesh)
    return _gear_outline(scene, mesh) if mesh.kind == "gear" else _rack_outline(scene, mesh)


def _axis_point(scene: MechanismScene, mesh: Mesh, link: str) -> complex:
    """Return the axis of a gear or cam, m."""
    return scene.place(mesh.carrier, carrier_axis(scene.linkage, link, mesh.carrier))


def _cam_angle(scene: MechanismScene, mesh: Mesh) -> float:
    """Return the angle of a cam relative to its carrier, rad."""
    return scene.angle(mesh.i) - scene.angle(mesh.carrier)


def contact_point(outline: HigherPairOutline) -> complex:
    """Return the pitch point of a gear mesh, or the point of contact of a cam, m."""
    return outline.pitch if isinstance(outline, MeshOutline) else outline.touch


def follower_segments(outline: HigherPairOutline) -> list[tuple[complex, complex]]:
    """Return the ends (m) of the straight parts of a cam follower: stem and flat face."""
    return (
        []
        if isinstance(outline, MeshOutline)
        else [segment for segment in (outline.stem, outline.face) if segment[0] != segment[1]]
    )


def outline_extent(
    outlines: Iterable[HigherPairOutline], size: float, links: Collection[str] | None = None
) -> list[complex]:
    """Return points (m) of gears, racks and cams that must be on the sheet.

    Args:
        outlines: geometries of higher pairs.
        size: size (m) of the rest of the mechanism; much larger gears are disregarded.
        links: links whose gears are drawn; None: all.
    """
    points: list[complex] = []
    for outline in outlines:
        if isinstance(outline, CamOutline):
            points += [*outline.disk.tolist(), outline.touch, *outline.face]
            continue
        if outline.side != 0 and (links is None or outline.mesh.j in links):
            points.append(outline.pitch)
        apart = max(abs(disc.centre - outline.discs[0].centre) for disc in outline.discs)
        for disc in outline.discs:
            if disc.radius < LARGE_GEAR * max(size, apart) and (links is None or disc.link in links):
                points += [disc.centre + disc.radius * complex(unit(turn)) for turn in CIRCLE_ANGLES]
    return [p for p in points if np.isfinite(p)]


def _gear_outline(scene: MechanismScene, mesh: Mesh) -> MeshOutline:
    first_axis, other = (_axis_point(scene, mesh, link) for link in (mesh.i, mesh.j))
    pitch = (first_axis - mesh.ratio * other) / (1 - mesh.ratio)
    radii = abs(pitch - first_axis), abs(pitch - other)
    inner = mesh.ratio > 0
    discs = (
        GearDisc(mesh.i, first_axis, radii[0], inner and radii[0] > radii[1]),
        GearDisc(mesh.j, other, radii[1], inner and radii[1] > radii[0]),
    )
    return MeshOutline(mesh, pitch, 1j * (other - first_axis) / abs(other - first_axis), discs)


def _guide_direction(scene: MechanismScene, mesh: Mesh) -> tuple[complex, complex]:
    """Return the unit vector along the guide of a rack or a sliding follower, and its sliding point (m)."""
    slide = scene.linkage.slide(mesh.slide)
    if slide.runner == mesh.j:
        return scene.along(slide), scene.place(slide.runner, slide.at)
    return -scene.along(slide), scene.place(slide.carrier, slide.through)


def _rack_outline(scene: MechanismScene, mesh: Mesh) -> MeshOutline:
    forward, start = _guide_direction(scene, mesh)
    centre = _axis_point(scene, mesh, mesh.i)
    side = -1j * forward * math.copysign(1.0, mesh.ratio)
    pitch = centre + side * abs(mesh.ratio)
    return MeshOutline(mesh, pitch, forward, (GearDisc(mesh.i, centre, abs(mesh.ratio)),), side, start)


def _flat_faced_cam(scene: MechanismScene, mesh: Mesh) -> CamOutline:
    """Return the cam of a sliding follower with a flat face.

    Its profile is the envelope of the face: points (h - i h') u from the cam axis, with the unit vector u along the
    guide, fixed to the cam. h is the distance of the face from the axis, the sum of a constant and the displacement.
    """
    assert mesh.law is not None
    forward, runs = _guide_direction(scene, mesh)
    centre, angle = _axis_point(scene, mesh, mesh.i), _cam_angle(scene, mesh)
    turn = np.linspace(0, 2 * np.pi, PROFILE_STEPS)
    rise, slope, bend = mesh.law(turn)
    now, slope_now, _ = (float(v) for v in mesh.law(np.array(angle)))
    height = float(dot(forward, runs - centre)) - now
    true = bool(np.min(height + rise + bend) > 0 and np.min(height + rise) > 0)
    if not true:  # no convex cam fits this face: use the smallest convex one that is not too slender
        height = 1.15 * float(np.max(-(rise + np.maximum(bend, -3 * np.ptp(rise))))) + 0.3 * float(np.ptp(rise))
        height = max(height, 0.8 * float(np.ptp(rise)) - float(np.min(rise)))
    directions = forward * unit(angle - turn)
    disk = (height + rise - 1j * slope) * directions
    # where no cam can follow the law, the envelope has tails beyond the face
    tails = np.max(dot(directions[:, None], disk) - (height + rise)[:, None], axis=0) > 1e-6 * height
    disk = centre + disk[~tails]
    foot = centre + (height + now) * forward
    reach = 1.15 * float(np.max(np.abs(slope))) * 1j * forward
    touch = foot - 1j * slope_now * forward
    return CamOutline(mesh, centre, disk, touch, (foot - reach, foot + reach), (foot, runs), true=true)


def _roller_cam(scene: MechanismScene, mesh: Mesh) -> CamOutline:
    """Return the cam of a swinging follower with a roller."""
    assert mesh.law is not None
    centre, pivot = (_axis_point(scene, mesh, link) for link in (mesh.i, mesh.j))
    turn = np.linspace(0, 2 * np.pi, PROFILE_STEPS)
    rise, angle = mesh.law(turn)[0], _cam_angle(scene, mesh)
    middle = (float(np.max(rise)) + float(np.min(rise))) / 2
    outward = 1.0 if middle >= 0 else -1.0  # a rise leads away from the cam
    arm = ROLLER_ARM * (centre - pivot) * complex(unit(outward * math.acos(ROLLER_ARM)))
    path = centre + (pivot + arm * unit(rise - middle) - centre) * unit(angle - turn)
    now = float(mesh.law(np.array(angle))[0])
    roller_centre = pivot + arm * complex(unit(now - middle))
    tangent = np.gradient(path)
    normal = 1j * tangent / np.maximum(np.abs(tangent), 1e-300)
    normal = normal * np.sign(dot(normal, centre - path))
    roller = ROLLER_RADIUS * abs(centre - pivot)
    disk = path + roller * normal
    touch = roller_centre + roller * normal[int(np.argmin(np.abs(path - roller_centre)))]
    return CamOutline(
        mesh, centre, disk, complex(touch), (roller_centre, roller_centre), (pivot, roller_centre), roller
    )


@dataclass(frozen=True)
class ReplacementLink:
    """Link that replaces a higher pair. It connects the centres of curvature of both profiles.

    Attributes:
        start: centre of curvature of the profile of the first link, m.
        end: centre of curvature of the profile of the second link, or the point of contact if it is straight, m.
        slides: True if the second profile is straight, so that the replacement link slides along it.
    """

    start: complex
    end: complex
    slides: bool


def replacement_link(outline: HigherPairOutline) -> ReplacementLink:
    """Return the link that replaces a higher pair (I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 2).

    The centres of curvature of involute teeth lie on the line of action, a common tangent of the base circles.
    """
    if isinstance(outline, MeshOutline):
        mesh = outline.mesh
        line = outline.along * complex(unit(mesh.pressure))
        centres = [outline.pitch + line * float(dot(line, disc.centre - outline.pitch)) for disc in outline.discs]
        return ReplacementLink(centres[0], centres[1] if len(centres) > 1 else outline.pitch, len(centres) == 1)
    centre = _curvature_centre(outline.disk, outline.touch)
    if outline.roller:
        return ReplacementLink(centre, outline.stem[1], False)
    return ReplacementLink(centre, outline.touch, True)


def _curvature_centre(disk: Vector, touch: complex) -> complex:
    """Return the centre of curvature of a closed profile near a point.

    It is the centre of the circle through three points of the profile.
    """
    size = len(disk)
    at, step = int(np.argmin(np.abs(disk - touch))), max(1, size // 120)
    a, b, c = (complex(disk[(at + k * step) % size]) for k in (-1, 0, 1))
    u, v = b - a, c - a
    turn = 2 * (u.conjugate() * v).imag
    return a + 1j * (abs(u) ** 2 * v - abs(v) ** 2 * u) / turn * -1 if turn else b
