"""A position in detail with its loads; what drawings of a mechanism share: symbols with names, thin lines, paths."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

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
from tmm_cli.drawing.sheets.acting import LOAD_LENGTH, ForceArrows
from tmm_cli.drawing.symbols import (
    MEASURED,
    MechanismScene,
    RenderedLinks,
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
from tmm_cli.mechanics.numerics import Vector, dot
from tmm_cli.mechanics.plans import links_with_mass
from tmm_cli.mechanics.quantities import ANGLE, LENGTH
from tmm_cli.mechanics.structure import POSITIONS_PER_TURN

POSITION_MARGIN = 14.0  # mm about what is to scale on a position's sheet, for couples, rails and labels
SAME_LINE = 0.1  # mm between lines that look like one
COORDINATE_DECIMALS = 2  # of the place of the driver, in the unit of the file


@dataclass(frozen=True)
class Position:
    """A computed position by its index, and what its sheets are called."""

    results: Results
    motion: Motion
    k: int

    def stem(self, name: str) -> str:
        """velocity-03."""
        return f"{name}-{self.results.numbers[self.k]:02d}"

    def sheet(
        self, title: str, places: Iterable[complex] = (), room: PaperLayout | None = None, **words: str
    ) -> DrawingSheet:
        """A sheet for places (SI), or of a room. {caption} in its title: which position it is, and of what driver."""
        subject = title.format(caption=self.caption, **words)
        return DrawingSheet(self.results.problem.title, subject, places, room=room)

    @property
    def caption(self) -> str:
        """Which position it is and where the driver stands."""
        place = driver_caption(self.results, float(self.motion.q[self.k]))
        return _("Position {number}, {place}").format(number=self.results.numbers[self.k], place=place)


def driver_caption(results: Results, q: float, digits: int = 6) -> str:
    """In words."""
    crank, units = results.linkage.driver.kind == "turn", results.problem.units
    measure = ANGLE if crank else LENGTH
    value = round(units.from_si(q % (2 * np.pi) if crank else q, measure), COORDINATE_DECIMALS)
    place = typeset(f"{numeral(value, f'.{digits}g')} {units.spelt(measure)}")
    return (_("crank at {place}") if crank else _("driver at {place}")).format(place=place)


def draw_measured(
    sheet: DrawingSheet, scene: MechanismScene, mark: str = "", links: Sequence[str] = ()
) -> RenderedLinks:
    """One position to scale with its symbols, names of points and centres of mass, numbers of links.

    mark: of the position, after the names of moving points. links: only these, without what they are joined to.
    """
    linkage = scene.linkage
    moving, shown, hue = linkage.moving_points, links or linkage.moving, dict.fromkeys(linkage.links, DARK_COLOUR)
    apart = [p for p in scene.structure.pairs if links and (p.i in links) != (p.j in links)]
    inner = [p for p in scene.structure.pairs if not links or {p.i, p.j} <= {*links}]
    drawn = render_scene(sheet, scene, shown, inner, MEASURED, hue, leads=apart)
    for pair in apart:
        if not pair.lower:
            draw_wheels(sheet, scene.higher(pair), dict.fromkeys(links, DARK_COLOUR))
        elif pair.slide is not None and pair.slide.runner in links:
            draw_slider(sheet, drawn.scene, pair, MEASURED, DARK_COLOUR)
    names = {p: [p + mark if p in moving else p] for link in shown for p in linkage.links[link].points}
    for link in shown:
        own, centre = linkage.links[link], f"S{link}"
        if np.any(own.mass != 0):
            at = sheet.on(scene.place(link, complex(own.centre)))
            point = next((p for p in own.points if abs(at - sheet.on(scene.point(p))) <= MEASURED.hinge), None)
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
    """A thin line from a link of one point to a place (mm) that belongs to it too."""
    if len(scene.linkage.links[link].points) == 1:
        (point,) = scene.linkage.links[link].points
        sheet.line([sheet.on(scene.point(point)), at], THIN_COLOUR, 0.9, z=2.1)


def draw_skeleton(
    sheet: DrawingSheet, scene: MechanismScene, colour: str = GREY_COLOUR, width: float = 0.7, z: float = 1.0
) -> None:
    """One position as thin lines."""
    for link in scene.linkage.moving:
        for edge in form_by_points(sheet, scene, link, whole=False).edges:
            sheet.line(edge, colour, width, z=z, faint=True)


def point_paths(results: Results) -> list[Vector]:
    """Paths of all moving points over the cycle, and of centres of mass that are none of them, m."""
    linkage, whole = results.linkage, motion_at_positions(results, results.closely(POSITIONS_PER_TURN), 0)
    found = [whole.spot(name) for name in linkage.moving_points]
    for link in links_with_mass(linkage):
        own = linkage.links[link]
        if all(abs(complex(own.centre) - local) > 0 for local in own.points.values()):
            found.append(whole.poses[link].at(complex(own.centre)))
    return found


def draw_paths(sheet: DrawingSheet, found: Iterable[Vector]) -> None:
    """Paths (m) as dashed lines, once only where a point comes back on the way on which it went."""
    for path in found:
        sheet.line(drop_retraced(sheet.origin + path / sheet.mu), THIN_COLOUR, 0.7, "--", 1.5, faint=True)


def drop_retraced(path: Vector) -> list[complex]:
    """A path (mm) that is interrupted where it leads back over itself."""
    steps, middles = np.diff(path), (path[1:] + path[:-1]) / 2
    off = middles[:, None] - path[None, :-1]
    size = np.maximum(np.abs(steps), 1e-12)
    share = np.clip(dot(steps[None, :], off) / size**2, 0, 1)
    near = np.abs(off - share * steps[None, :]) < SAME_LINE
    back = near & (dot(steps[:, None], steps[None, :]) < 0) & np.tri(len(steps), k=-1, dtype=bool)
    return [path[0], *np.where(back.any(axis=1), np.nan, path[1:]).tolist()]


def detailed_drawings(results: Results) -> list[Position]:
    """The positions in detail that could be computed."""
    motion = results.motion
    assert motion is not None
    return [Position(results, motion, k) for k in detailed_positions(results)]


def draw_position(here: Position) -> Iterable[tuple[str, Drawing]]:
    """The position with weights, inertia forces and couples, loads, and what balances the crank."""
    results, motion, k = here.results, here.motion, here.k
    linkage, reactions = results.linkage, results.reactions
    scene = MechanismScene(linkage, results.structure, motion.poses, k)
    given = () if reactions is None else LoadedPosition.at(motion, reactions, k).given()
    places = [*frame_pivots(linkage), *(scene.point(p) for p in linkage.moving_points)]
    places += [scene.place(n, complex(linkage.links[n].centre)) for n in linkage.moving]
    figure, notes = FigureExtent(), [_("loads without scale")] if reactions is not None else []
    figure.spots(points_to_scale(scene, [*places, *(one.at for one in given)]), POSITION_MARGIN)
    for one in given:
        if not one.couple:
            figure.spots([one.at], POSITION_MARGIN / 2, LOAD_LENGTH * one.force / abs(one.force))
    found = choose_scale(figure, NoteBlock([*notes, scale_words("l", 0.0025, "m/mm")]))
    sheet = here.sheet("{caption}", room=found)
    draw_measured(sheet, scene)
    for one in given:
        if one.kind == "load" and not one.couple:
            join_to_link(sheet, scene, one.link, sheet.on(one.at))
    ForceArrows(sheet, whole=True).draw(given)
    for note in notes:
        sheet.note(note)
    sheet.note(scale_words("l", sheet.mu, "m/mm"))
    yield here.stem("position"), sheet.finish()
