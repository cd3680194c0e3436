"""Drawing of a mechanism in one position with the symbols of its parts, to scale or as a structural scheme.

Parts that cover others are drawn later. The order is: guides, gears and cams, links, sliders, load elements, hinges,
supports.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from tmm_cli.drawing.paper import DARK_COLOUR, THIN_COLOUR, DrawingSheet, gather_coincident, leave_field
from tmm_cli.drawing.symbols.actuators import Cylinder, cylinder_drivers, draw_elements, driver_symbol
from tmm_cli.drawing.symbols.higher_pair_symbols import CHAIN_STYLE, draw_higher_pair as draw_wheels, draw_rigid_marks
from tmm_cli.drawing.symbols.higher_pairs import CamOutline, contact_point
from tmm_cli.drawing.symbols.link_forms import LinkForm, Segment, form_by_pairs, form_by_points
from tmm_cli.drawing.symbols.link_symbols import (
    STRUCTURAL,
    SymbolStyle,
    draw_body,
    draw_box,
    draw_guide,
    draw_hatched_line,
    draw_rotation_arrow,
    draw_sliding_arrow,
    draw_support,
    support_side,
)
from tmm_cli.drawing.symbols.scene import GUIDE_EXTENSION, ON_LINE, MechanismScene, spread_boxes
from tmm_cli.language import _, printed
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.structure import Pair

BOX_BODY = "{}|box"  # name of the body of a slider's box
AXIS_OVERHANG = 10.0  # mm by which the axis of a guide extends beyond the travel of its block
MESH_COLOUR = "#404040"


@dataclass
class RenderedLinks:
    """Description of the links that were drawn.

    Attributes:
        forms: shapes of the links.
        scene: position that was drawn; some boxes may have been moved along their guides.
        cylinders: middles of the cylinders (mm), by prismatic pair.
    """

    forms: Mapping[str, LinkForm]
    scene: MechanismScene
    cylinders: dict[str, complex] = field(default_factory=dict)


def render_scene(
    sheet: DrawingSheet,
    scene: MechanismScene,
    links: Sequence[str],
    pairs: Sequence[Pair],
    look: SymbolStyle,
    hue: Mapping[str, str],
    external: Sequence[Pair] = (),
) -> RenderedLinks:
    """Draw links of a mechanism with their pairs.

    Args:
        sheet: sheet to draw on.
        scene: the mechanism in the position to be drawn.
        links: links to draw.
        pairs: pairs to draw.
        look: style of the symbols.
        hue: colours of links.
        external: pairs with links that are not drawn; of these pairs only hinges are drawn.
    """
    with sheet.on_layer("links"):
        return _render_links(sheet, scene, links, pairs, look, hue, external)


def _render_links(
    sheet: DrawingSheet,
    scene: MechanismScene,
    links: Sequence[str],
    pairs: Sequence[Pair],
    look: SymbolStyle,
    hue: Mapping[str, str],
    external: Sequence[Pair],
) -> RenderedLinks:
    if look.measured and not look.moves:
        scene = spread_boxes(sheet, scene, links)
    forms = {link: (form_by_points if look.measured else form_by_pairs)(sheet, scene, link) for link in links}
    drawn = RenderedLinks(forms, scene)
    driven = cylinder_drivers(scene.linkage)
    rods = [] if look.moves else [edge for form in forms.values() for edge in form.edges]
    for pair in pairs:
        if pair.slide is not None and pair.slide.carrier == FRAME:
            _draw_frame_guide(sheet, scene, pair, look, rods)
    for pair in pairs:
        if not pair.lower:
            _draw_higher_pair(sheet, scene, pair, look, hue, rods)
    for link, form in forms.items():
        with sheet.part(link):
            draw_body(sheet, form, hue[link], look)
            for pair in scene.structure.pairs:  # includes pairs of which only one link is drawn
                if not pair.lower and link in (pair.i, pair.j):
                    draw_rigid_marks(sheet, scene.higher(pair), form, link, hue[link], look.hinge)
    for pair in pairs:
        if pair.slide is None:
            continue
        if pair.name in driven:
            cylinder = Cylinder.of(sheet, scene, pair.slide)
            cylinder.draw(sheet, hue)
            drawn.cylinders[pair.name] = (cylinder.back + cylinder.front) / 2
        else:
            draw_slider(sheet, scene, pair, look, hue[pair.slide.runner], rods)
    if look.measured:
        draw_elements(sheet, scene)
    hinges = gather_coincident((sheet.on(scene.at(p)), p) for p in (*pairs, *external) if p.kind == "R")
    for at, pairs_there in hinges:
        _draw_hinge(sheet, at, pairs_there, forms, look, hue)
    for at, pairs_there in hinges:
        joined = {link for pair in pairs_there if pair in pairs for link in (pair.i, pair.j)}
        if FRAME not in joined:
            continue
        blocks = [place for link in joined if link in forms for place in forms[link].boxes]
        here_look = look.with_raised_support() if any(abs(at - place) < ON_LINE for place in blocks) else look
        with sheet.part(FRAME):
            end = draw_support(sheet, at, support_side(sheet, at, rods, here_look), here_look, rods)
        if not look.measured:
            sheet.label(printed(FRAME), end, 9, DARK_COLOUR, "italic")
    return drawn


def _draw_frame_guide(
    sheet: DrawingSheet, scene: MechanismScene, pair: Pair, look: SymbolStyle, rods: Sequence[Segment]
) -> None:
    """Draw a guide on the frame as hatched rails beside its box. In a drawing to scale, its axis is drawn too.

    In an animation the rails are as long as the travel of the slider.
    """
    slide = pair.slide
    assert slide is not None
    at, along = sheet.on(scene.at(pair)), scene.along(slide)
    (low, high), displacement = scene.travel(slide), scene.run(slide)
    if look.moves:
        middle, travel = at + ((low + high) / 2 - displacement) / sheet.mu * along, (high - low) / sheet.mu
        with sheet.part(FRAME):
            draw_guide(sheet, middle, along, look, (travel + look.box[0] + GUIDE_EXTENSION) / 2)
        return
    draw_guide(sheet, at, along, look, look.box[0] / 2 + GUIDE_EXTENSION, rods)
    if look.measured:
        start, end = (
            at + ((low - displacement) / sheet.mu - AXIS_OVERHANG) * along,
            at + ((high - displacement) / sheet.mu + AXIS_OVERHANG) * along,
        )
        axis = [leave_field(at, start, *sheet.field), leave_field(at, end, *sheet.field)]
        with sheet.on_layer("construction"):
            sheet.line(axis, THIN_COLOUR, 0.6, CHAIN_STYLE, 1.2, faint=True)
        return
    low_side = -1j * along if (1j * along).imag > 0 else 1j * along
    reach = (look.box[0] / 2 + GUIDE_EXTENSION) * along
    sheet.label(printed(FRAME), at + low_side * (look.box[1] / 2 + 2) + reach, 9, DARK_COLOUR, "italic")


def _draw_higher_pair(
    sheet: DrawingSheet,
    scene: MechanismScene,
    pair: Pair,
    look: SymbolStyle,
    hue: Mapping[str, str],
    rods: Sequence[Segment],
) -> None:
    """Draw gears, a rack, or a cam with its follower.

    In a drawing to scale, a rack is as long as the part of it that comes into mesh.
    """
    outline, span = scene.higher(pair), None
    if look.measured and outline.mesh.slide:
        slide = scene.linkage.slide(outline.mesh.slide)
        (low, high), displacement = scene.travel(slide), scene.run(slide)
        span = displacement - high, displacement - low
    draw_wheels(sheet, outline, hue, span, rods)
    if look.measured:
        sheet.label(outline.mesh.name, sheet.on(contact_point(outline)), 9, MESH_COLOUR)
        if isinstance(outline, CamOutline) and not outline.true:
            text = _("disk of cam {link} is not to scale: only the law of motion of its follower is given")
            sheet.note(text.format(link=outline.mesh.i))


def draw_slider(
    sheet: DrawingSheet, scene: MechanismScene, pair: Pair, look: SymbolStyle, colour: str, rods: Sequence[Segment] = ()
) -> None:
    """Draw the box of a prismatic pair; hatched if it belongs to the frame."""
    slide = pair.slide
    assert slide is not None
    at, along = sheet.on(scene.at(pair)), scene.along(slide)
    if not np.isfinite(at):
        return
    size = look.box if FRAME in (slide.carrier, slide.runner) else look.block
    with sheet.part(BOX_BODY.format(pair.name)):
        draw_box(sheet, at, along, colour, size, look)
        for side in (1j * along, -1j * along) if slide.runner == FRAME else ():
            draw_hatched_line(sheet, at + side * size[1] / 2, along, side, size[0] / 2, rods)
    if slide.runner == FRAME and not look.measured:
        sheet.label(printed(FRAME), at + along * size[0] / 2, 9, DARK_COLOUR, "italic")


def _draw_hinge(
    sheet: DrawingSheet,
    at: complex,
    pairs_there: Sequence[Pair],
    forms: Mapping[str, LinkForm],
    look: SymbolStyle,
    hue: Mapping[str, str],
) -> None:
    """Draw the revolute pairs at one point, each as a circle.

    A bar that continues on both sides is drawn across them.
    """
    order = {link: number for number, link in enumerate((FRAME, *hue))}
    step = 0.95 * look.hinge / STRUCTURAL.hinge
    links = list(dict.fromkeys(link for pair in pairs_there for link in (pair.i, pair.j)))
    with sheet.part(FRAME if FRAME in links else links[0]):
        for number, pair in reversed(list(enumerate(pairs_there))):
            later = max((pair.i, pair.j), key=lambda link: order.get(link, 0))
            sheet.circle(at, look.hinge + step * number, "white", hue[later], 1.2, 6 - 0.01 * number)
    for link in links:
        along = forms[link].through(at) if link in forms else None
        if along is not None:
            with sheet.part(link):
                sheet.line([at - look.hinge * along, at + look.hinge * along], hue[link], 0.8 * look.bar, z=6.2)


def draw_names(sheet: DrawingSheet, named: Iterable[tuple[complex, str, str]]) -> None:
    """Write names beside their points. If several points coincide, their names share a label.

    named: point (mm), name and colour of each name.
    """
    for at, names_there in gather_coincident((at, (name, colour)) for at, name, colour in named):
        sheet.label(", ".join(dict.fromkeys(name for name, __ in names_there)), at, 10, names_there[0][1])


def name_anchor(sheet: DrawingSheet, scene: MechanismScene, pair: Pair, look: SymbolStyle) -> complex:
    """Return the point (mm) at which the name of a pair is written: a hinge, or the end of a box, guide or cylinder."""
    at = sheet.on(scene.at(pair))
    if pair.slide is None:
        return at
    if pair.name in cylinder_drivers(scene.linkage):
        return Cylinder.of(sheet, scene, pair.slide).front
    beyond = GUIDE_EXTENSION if pair.slide.carrier == FRAME else 0.0
    return at - scene.along(pair.slide) * (look.box[0] / 2 + beyond)


def draw_driver_arrows(
    sheet: DrawingSheet, scene: MechanismScene, drawn: RenderedLinks, look: SymbolStyle, hue: Mapping[str, str]
) -> None:
    """Draw arrows for the sense of rotation or the direction of motion of the drivers."""
    for driver in scene.linkage.drivers:
        if driver.link not in drawn.forms:
            continue
        pair = scene.structure.driving_pair(driver)
        at = sheet.on(drawn.scene.at(pair))
        if pair.slide is not None:
            along = scene.along(pair.slide) * driver.sense * (1 if pair.slide.runner == driver.link else -1)
            middle, name = drawn.cylinders.get(pair.name, at), driver_symbol(driver, "v")
            draw_sliding_arrow(sheet, middle, along, look.box[1], name, hue[driver.link])
        else:
            ends = [end - at for edge in drawn.forms[driver.link].edges for end in edge]
            arm = max(ends, key=abs, default=1 + 0j)
            draw_rotation_arrow(
                sheet, at, float(np.angle(arm)), driver.sense, driver_symbol(driver, "ω"), hue[driver.link]
            )
