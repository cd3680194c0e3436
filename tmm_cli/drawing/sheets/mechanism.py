"""Drawings of the mechanism in one position: with its loads, in the sketched position, or as thin lines.

The trajectories of its points are drawn here too.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    GREY_COLOUR,
    NAME_COLOUR,
    THIN_COLOUR,
    Drawing,
    DrawingSheet,
    FigureExtent,
    NoteBlock,
    PaperLayout,
    choose_scale,
    scale_words,
)
from tmm_cli.drawing.sheets.force_arrows import LOAD_LENGTH, ForceArrows
from tmm_cli.drawing.symbols import (
    MEASURED,
    MechanismScene,
    RenderedLinks,
    draw_driver_arrows,
    draw_higher_pair as draw_wheels,
    draw_mass_centre,
    draw_slider,
    form_by_points,
    frame_pivots,
    points_to_scale,
    render_scene,
)
from tmm_cli.language import _, numeral, typeset
from tmm_cli.mechanics.analysis import Results, detailed_positions, motion_at_positions
from tmm_cli.mechanics.forces import LoadedPosition
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import Real, Vector, dot
from tmm_cli.mechanics.plans import links_with_mass
from tmm_cli.mechanics.quantities import ANGLE, LENGTH
from tmm_cli.mechanics.structure import POSITIONS_PER_TURN

POSITION_MARGIN = 14.0  # mm about the mechanism for couples, rails and labels
SAME_LINE = 0.1  # mm: closer lines look like one
COORDINATE_DECIMALS = 2  # of the driver coordinate, in the unit of the file
COORDINATES_TRIED = 47  # driver coordinates besides the sketch at which the view is tested for hidden pairs
MOST_PAIRS = 40  # with more pairs some hide others at any coordinate, so only the sketch is drawn
HIDDEN_WITHIN = 0.03  # of the size of the mechanism: closer pairs hide each other


@dataclass(frozen=True)
class Position:
    """One of the computed positions, as the subject of sheets.

    Attributes:
        results: computed results.
        motion: motion in all computed positions.
        k: index of the position.
    """

    results: Results
    motion: Motion
    k: int

    def stem(self, name: str) -> str:
        """Return the stem of a file name with the number of the position, e.g. "velocity-03"."""
        return f"{name}-{self.results.numbers[self.k]:02d}"

    def sheet(
        self, title: str, points: Iterable[complex] = (), room: PaperLayout | None = None, **words: str
    ) -> DrawingSheet:
        """Begin a sheet for this position.

        Args:
            title: title of the sheet. Its field {caption} is filled with the number of the position and the driver
                coordinate.
            points: points (SI) that must be on the sheet.
            room: layout chosen beforehand, instead of points.
            words: values of further fields of the title.
        """
        subject = title.format(caption=self.caption, **words)
        return DrawingSheet(self.results.problem.title, subject, points, room=room)

    @property
    def caption(self) -> str:
        """Number of the position and driver coordinate, e.g. "Position 3, crank at 90 deg"."""
        place = driver_caption(self.results, float(self.motion.q[self.k]))
        return _("Position {number}, {place}").format(number=self.results.numbers[self.k], place=place)


def driver_caption(results: Results, q: float, digits: int = 6) -> str:
    """Return the driver coordinate as text, e.g. "crank at 90 deg"."""
    crank, units = results.linkage.driver.kind == "turn", results.problem.units
    measure = ANGLE if crank else LENGTH
    value = round(units.from_si(q % (2 * np.pi) if crank else q, measure), COORDINATE_DECIMALS)
    place = typeset(f"{numeral(value, f'.{digits}g')} {units.spelt(measure)}")
    return (_("crank at {place}") if crank else _("driver at {place}")).format(place=place)


def draw_measured(
    sheet: DrawingSheet, scene: MechanismScene, mark: str = "", links: Sequence[str] = ()
) -> RenderedLinks:
    """Draw the mechanism in a position to scale, with the names of points and centres of mass and the numbers of links.

    Args:
        sheet: sheet to draw on.
        scene: the mechanism in this position.
        mark: suffix to the names of moving points.
        links: links to be drawn, without those to which they are connected; empty for all moving links.
    """
    linkage = scene.linkage
    moving, drawn_links, hue = linkage.moving_points, links or linkage.moving, dict.fromkeys(linkage.links, DARK_COLOUR)
    apart = [p for p in scene.structure.pairs if links and (p.i in links) != (p.j in links)]
    inner = [p for p in scene.structure.pairs if not links or {p.i, p.j} <= {*links}]
    drawn = render_scene(sheet, scene, drawn_links, inner, MEASURED, hue, external=apart)
    for pair in apart:
        if not pair.lower:
            draw_wheels(sheet, scene.higher(pair), dict.fromkeys(links, DARK_COLOUR))
        elif pair.slide is not None and pair.slide.runner in links:
            draw_slider(sheet, drawn.scene, pair, MEASURED, DARK_COLOUR)
    names = {p: [p + mark if p in moving else p] for link in drawn_links for p in linkage.links[link].points}
    for link in drawn_links:
        link_data, centre = linkage.links[link], f"S{link}"
        if np.any(link_data.mass != 0):
            at = sheet.on(scene.place(link, complex(link_data.centre)))
            point = next((p for p in link_data.points if abs(at - sheet.on(scene.point(p))) <= MEASURED.hinge), None)
            if point is None:
                draw_mass_centre(sheet, at)
                join_to_link(sheet, scene, link, at)
            if centre in names:
                continue
            if point is None:
                sheet.label(centre, at, 8, "#6b5310")
            else:
                names[point].append(centre)
    for name, called in names.items():
        at = sheet.on(scene.point(name))
        hinged = any(abs(at - sheet.on(scene.point(hinge.point))) <= MEASURED.hinge for hinge in linkage.hinges)
        if not hinged:  # a dot in a circle would look like two pairs
            sheet.circle(at, 0.6, face=DARK_COLOUR)
        sheet.label(", ".join(called), at, 10)
    for link, form in drawn.forms.items():
        sheet.label(link, form.middle, 10, NAME_COLOUR, "italic")
    return drawn


def join_to_link(sheet: DrawingSheet, scene: MechanismScene, link: str, at: complex) -> None:
    """Connect a point (mm) of a link to the named point of that link by a thin line.

    Nothing is drawn if the link has several named points.
    """
    if len(scene.linkage.links[link].points) == 1:
        (point,) = scene.linkage.links[link].points
        sheet.line([sheet.on(scene.point(point)), at], THIN_COLOUR, 0.9, z=2.1)


def draw_skeleton(
    sheet: DrawingSheet, scene: MechanismScene, colour: str = GREY_COLOUR, width: float = 0.7, z: float = 1.0
) -> None:
    """Draw all moving links in a position as thin lines."""
    for link in scene.linkage.moving:
        for edge in form_by_points(sheet, scene, link, whole=False).edges:
            sheet.line(edge, colour, width, z=z, faint=True)


def point_paths(results: Results) -> list[Vector]:
    """Return the trajectories (m) of all moving points, and of centres of mass that are not at a named point."""
    linkage, whole = results.linkage, motion_at_positions(results, results.closely(POSITIONS_PER_TURN), 0)
    paths = [whole.spot(name) for name in linkage.moving_points]
    for link in links_with_mass(linkage):
        link_data = linkage.links[link]
        if all(abs(complex(link_data.centre) - local) > 0 for local in link_data.points.values()):
            paths.append(whole.poses[link].at(complex(link_data.centre)))
    return paths


def draw_paths(sheet: DrawingSheet, paths: Iterable[Vector]) -> None:
    """Draw trajectories (m) as dashed lines.

    Where a point returns along the same curve, the curve is drawn only once.
    """
    for path in paths:
        sheet.line(drop_retraced(sheet.origin + path / sheet.mu), THIN_COLOUR, 0.7, "--", 1.5, faint=True)


def drop_retraced(path: Vector) -> list[complex]:
    """Return the points of a trajectory (mm), replaced by nan where the trajectory returns along an earlier stretch."""
    steps, middles = np.diff(path), (path[1:] + path[:-1]) / 2
    off = middles[:, None] - path[None, :-1]
    lengths = np.maximum(np.abs(steps), 1e-12)
    share = np.clip(dot(steps[None, :], off) / lengths**2, 0, 1)
    near = np.abs(off - share * steps[None, :]) < SAME_LINE
    back = near & (dot(steps[:, None], steps[None, :]) < 0) & np.tri(len(steps), k=-1, dtype=bool)
    return [path[0], *np.where(back.any(axis=1), np.nan, path[1:]).tolist()]


def detailed_drawings(results: Results) -> list[Position]:
    """Return the positions that the problem requests to be drawn in detail."""
    motion = results.motion
    assert motion is not None
    return [Position(results, motion, k) for k in detailed_positions(results)]


def draw_position(position: Position) -> Iterable[tuple[str, Drawing]]:
    """Yield the drawing of a position with its loads, as (stem of the file name, drawing).

    The loads are weights, inertia forces and couples, external loads and the balancing load.
    """
    results, motion, k = position.results, position.motion, position.k
    linkage, reactions = results.linkage, results.reactions
    scene = MechanismScene(linkage, results.structure, motion.poses, k)
    loads = () if reactions is None else LoadedPosition.at(motion, reactions, k).loads_and_drives()
    points = [*frame_pivots(linkage), *(scene.point(p) for p in linkage.moving_points)]
    points += [scene.place(n, complex(linkage.links[n].centre)) for n in linkage.moving]
    figure, notes = FigureExtent(), [_("loads not to scale")] if reactions is not None else []
    figure.spots(points_to_scale(scene, [*points, *(load.at for load in loads)]), POSITION_MARGIN)
    for load in loads:
        if not load.couple:
            figure.spots([load.at], POSITION_MARGIN / 2, LOAD_LENGTH * load.force / abs(load.force))
    layout = choose_scale(figure, NoteBlock([*notes, scale_words("l", 0.0025, "m/mm")]))
    sheet = position.sheet("{caption}", room=layout)
    draw_measured(sheet, scene)
    for load in loads:
        if load.kind == "load" and not load.couple:
            join_to_link(sheet, scene, load.link, sheet.on(load.at))
    ForceArrows(sheet, whole=True).draw(loads)
    for note in notes:
        sheet.note(note)
    sheet.note(scale_words("l", sheet.mu, "m/mm"))
    yield position.stem("position"), sheet.finish()


def sketch_scene(results: Results) -> tuple[str, MechanismScene] | None:
    """Return the mechanism in the position of the sketch in the file, after the driver coordinate as text.

    If some pairs nearly coincide in this position, another one in which they are farther apart is returned. The result
    is None if the linkage cannot be assembled in the position of the sketch.
    """
    linkage, structure = results.linkage, results.structure
    driver_range = results.driver_range
    if driver_range is None:
        return None
    others = COORDINATES_TRIED if len(structure.pairs) <= MOST_PAIRS else 0
    coordinates = np.linspace(driver_range.start, driver_range.end, others + 2)
    motion = motion_at_positions(results, np.array([linkage.sketch.at, *coordinates[1:-1]]), 0)
    if not bool(motion.placed[0]):
        return None
    scenes = [MechanismScene(linkage, structure, motion.poses, k) for k in range(len(motion.q))]
    clear = np.where(motion.placed, np.nan_to_num(_pair_clearances(scenes), nan=-1.0), -1.0)
    best = int(np.argmax(clear))
    k = best if clear[0] < HIDDEN_WITHIN and clear[best] > 2 * clear[0] else 0
    return driver_caption(results, float(motion.q[k])), scenes[k]


def _pair_clearances(scenes: Sequence[MechanismScene]) -> Real:
    """Return for each position the smallest distance of a pair from another pair or from a bar of another link.

    Distances are divided by the size of the mechanism. Pairs that coincide in all positions are disregarded.
    """
    moving, all_pairs = scenes[0].structure.links, scenes[0].structure.pairs
    # the position of a box along a guide on the frame is arbitrary
    pairs = [p for p in all_pairs if p.kind == "R" or (p.slide is not None and p.slide.carrier != FRAME)]
    spots = np.array([[s.at(p) for p in pairs] for s in scenes])
    spines = [[[*s.joints(link), *(block for block, __ in s.guides(link))] for link in moving] for s in scenes]
    bars = np.array([[bar for spine in spine_points for bar in pairwise(spine)] for spine_points in spines], complex)
    bars = bars.reshape(len(scenes), 1, bars.size // (2 * len(scenes)), 2)
    start, span = bars[..., 0], bars[..., 1] - bars[..., 0]
    share = np.clip(dot(span, spots[:, :, None] - start) / np.maximum(np.abs(span) ** 2, 1e-300), 0, 1)
    others = np.concatenate([np.broadcast_to(spots[:, None], (*spots.shape, len(pairs))), start + share * span], axis=2)
    gaps = np.abs(others - spots[:, :, None]).reshape(len(scenes), -1)
    extent = np.nanmax(np.abs(spots - spots[:, :1])) or 1.0
    gaps = gaps[:, np.nanmax(gaps, axis=0) > 1e-6 * extent]
    return np.asarray(np.min(gaps / extent, axis=1, initial=1.0))


def task_picture(results: Results) -> Drawing | None:
    """Draw the mechanism in the sketched position to scale, for the text of a task. It has names but shows no results.

    Returns:
        The drawing, or None if the linkage cannot be assembled there.
    """
    sketch = sketch_scene(results)
    if sketch is None:
        return None
    place, scene = sketch
    linkage = results.linkage
    points = [*frame_pivots(linkage), *(scene.point(name) for name in linkage.moving_points)]
    points += [scene.place(name, complex(linkage.links[name].centre)) for name in linkage.moving]
    sheet = DrawingSheet(results.problem.title, place, points_to_scale(scene, points), pad=30)
    draw_driver_arrows(sheet, scene, draw_measured(sheet, scene), MEASURED, dict.fromkeys(linkage.links, DARK_COLOUR))
    sheet.note(scale_words("l", sheet.mu, "m/mm"))
    return sheet.finish()
