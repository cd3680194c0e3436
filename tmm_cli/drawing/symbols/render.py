"""A mechanism on a sheet: its guides, wheels and cams, links, sliders, springs, hinges and supports, in that order.

Measured drawings and structural schemes are drawn alike, in two looks.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from tmm_cli.drawing.paper import DARK, THIN, Sheet, border, gather_labels
from tmm_cli.drawing.symbols.actuators import Cylinder, cylinders, driver_name, springs
from tmm_cli.drawing.symbols.forms import Form, Line, by_pairs, by_points
from tmm_cli.drawing.symbols.parts import (
    STRUCTURAL,
    Look,
    body,
    box,
    guide,
    sliding_arrow,
    support,
    support_side,
    turning_arrow,
    wall,
)
from tmm_cli.drawing.symbols.rigid import rigid
from tmm_cli.drawing.symbols.scene import BEYOND, ON_LINE, Scene, spread
from tmm_cli.drawing.symbols.wheel_symbols import CHAIN, draw as draw_wheels
from tmm_cli.drawing.symbols.wheels import CamShape, contact
from tmm_cli.language import _, printed
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.structure import Pair

BOX = "{}|box"  # the body that the box of a sliding pair is
OVER = 10.0  # mm: how far the axis of a guide goes on beyond the way of its stone
GREY = "#404040"


@dataclass
class Rendered:
    """What was drawn of the links, in which scene; the middles of the cylinders (mm) by their sliding pair."""

    forms: Mapping[str, Form]
    scene: Scene
    cylinders: dict[str, complex] = field(default_factory=dict)


def render_scene(
    sheet: Sheet,
    scene: Scene,
    links: Sequence[str],
    pairs: Sequence[Pair],
    look: Look,
    hue: Mapping[str, str],
    leads: Sequence[Pair] = (),
) -> Rendered:
    """These links with their pairs. hue: colours of links; leads: pairs with links that are not drawn."""
    with sheet.on_layer("links"):
        return _render(sheet, scene, links, pairs, look, hue, leads)


def _render(
    sheet: Sheet,
    scene: Scene,
    links: Sequence[str],
    pairs: Sequence[Pair],
    look: Look,
    hue: Mapping[str, str],
    leads: Sequence[Pair],
) -> Rendered:
    if look.measured and not look.moves:
        scene = spread(sheet, scene, links)
    forms = {link: (by_points if look.measured else by_pairs)(sheet, scene, link) for link in links}
    drawn = Rendered(forms, scene)
    driven = cylinders(scene.linkage)
    rods = [] if look.moves else [edge for form in forms.values() for edge in form.edges]
    for pair in pairs:
        if pair.slide is not None and pair.slide.carrier == FRAME:
            _guide(sheet, scene, pair, look, rods)
    for pair in pairs:
        if not pair.lower:
            _higher(sheet, scene, pair, look, hue, rods)
    for link, form in forms.items():
        with sheet.part(link):
            body(sheet, form, hue[link], look)
            for pair in scene.structure.pairs:  # also of those that are drawn from one side only
                if not pair.lower and link in (pair.i, pair.j):
                    rigid(sheet, scene.higher(pair), form, link, hue[link], look.hinge)
    for pair in pairs:
        if pair.slide is None:
            continue
        if pair.name in driven:
            found = Cylinder.of(sheet, scene, pair.slide)
            found.draw(sheet, hue)
            drawn.cylinders[pair.name] = (found.back + found.front) / 2
        else:
            slider(sheet, scene, pair, look, hue[pair.slide.runner], rods)
    if look.measured:
        springs(sheet, scene)
    hinges = gather_labels((sheet.on(scene.at(p)), p) for p in (*pairs, *leads) if p.kind == "R")
    for at, here in hinges:
        _hinge(sheet, at, here, forms, look, hue)
    for at, here in hinges:
        joined = {link for pair in here if pair in pairs for link in (pair.i, pair.j)}
        if FRAME not in joined:
            continue
        stones = [place for link in joined if link in forms for place in forms[link].boxes]
        here_look = look.raised() if any(abs(at - place) < ON_LINE for place in stones) else look
        with sheet.part(FRAME):
            end = support(sheet, at, support_side(sheet, at, rods, here_look), here_look, rods)
        if not look.measured:
            sheet.label(printed(FRAME), end, 9, DARK, "italic")
    return drawn


def _guide(sheet: Sheet, scene: Scene, pair: Pair, look: Look, rods: Sequence[Line]) -> None:
    """A guide on the frame: hatched rails about its box; to scale also its axis, as long as the way on it.

    Where the box moves the rails are as long as its way.
    """
    slide = pair.slide
    assert slide is not None
    at, along = sheet.on(scene.at(pair)), scene.along(slide)
    (low, high), here = scene.way(slide), scene.run(slide)
    if look.moves:
        middle, way = at + ((low + high) / 2 - here) / sheet.mu * along, (high - low) / sheet.mu
        with sheet.part(FRAME):
            guide(sheet, middle, along, look, (way + look.box[0] + BEYOND) / 2)
        return
    guide(sheet, at, along, look, look.box[0] / 2 + BEYOND, rods)
    if look.measured:
        start, end = at + ((low - here) / sheet.mu - OVER) * along, at + ((high - here) / sheet.mu + OVER) * along
        axis = [border(at, start, *sheet.field), border(at, end, *sheet.field)]
        with sheet.on_layer("construction"):
            sheet.line(axis, THIN, 0.6, CHAIN, 1.2, faint=True)
        return
    low_side = -1j * along if (1j * along).imag > 0 else 1j * along
    reach = (look.box[0] / 2 + BEYOND) * along
    sheet.label(printed(FRAME), at + low_side * (look.box[1] / 2 + 2) + reach, 9, DARK, "italic")


def _higher(sheet: Sheet, scene: Scene, pair: Pair, look: Look, hue: Mapping[str, str], rods: Sequence[Line]) -> None:
    """Toothed wheels, or a cam with its follower; of a measured rack all that ever comes into mesh."""
    found, span = scene.higher(pair), None
    if look.measured and found.mesh.slide:
        slide = scene.linkage.slide(found.mesh.slide)
        (low, high), here = scene.way(slide), scene.run(slide)
        span = here - high, here - low
    draw_wheels(sheet, found, hue, span, rods)
    if look.measured:
        sheet.label(found.mesh.name, sheet.on(contact(found)), 9, GREY)
        if isinstance(found, CamShape) and not found.true:
            sheet.note(_("disk of cam {link}: not to scale, its law alone is given").format(link=found.mesh.i))


def slider(sheet: Sheet, scene: Scene, pair: Pair, look: Look, colour: str, rods: Sequence[Line] = ()) -> None:
    """The box of a sliding pair, hatched where it is the frame."""
    slide = pair.slide
    assert slide is not None
    at, along = sheet.on(scene.at(pair)), scene.along(slide)
    if not np.isfinite(at):
        return
    size = look.box if FRAME in (slide.carrier, slide.runner) else look.stone
    with sheet.part(BOX.format(pair.name)):
        box(sheet, at, along, colour, size, look)
        for side in (1j * along, -1j * along) if slide.runner == FRAME else ():
            wall(sheet, at + side * size[1] / 2, along, side, size[0] / 2, rods)
    if slide.runner == FRAME and not look.measured:
        sheet.label(printed(FRAME), at + along * size[0] / 2, 9, DARK, "italic")


def _hinge(
    sheet: Sheet, at: complex, here: Sequence[Pair], forms: Mapping[str, Form], look: Look, hue: Mapping[str, str]
) -> None:
    """The turning pairs of one place, a circle each; bars that go on beyond it cross it there."""
    order = {link: number for number, link in enumerate((FRAME, *hue))}
    step = 0.95 * look.hinge / STRUCTURAL.hinge
    links = list(dict.fromkeys(link for pair in here for link in (pair.i, pair.j)))
    with sheet.part(FRAME if FRAME in links else links[0]):
        for number, pair in reversed(list(enumerate(here))):
            later = max((pair.i, pair.j), key=lambda link: order.get(link, 0))
            sheet.circle(at, look.hinge + step * number, "white", hue[later], 1.2, 6 - 0.01 * number)
    for link in links:
        along = forms[link].through(at) if link in forms else None
        if along is not None:
            with sheet.part(link):
                sheet.line([at - look.hinge * along, at + look.hinge * along], hue[link], 0.8 * look.bar, z=6.2)


def names(sheet: Sheet, named: Iterable[tuple[complex, str, str]]) -> None:
    """Names beside their places with colours; those of one place share a label."""
    for at, here in gather_labels((at, (name, colour)) for at, name, colour in named):
        sheet.label(", ".join(dict.fromkeys(name for name, __ in here)), at, 10, here[0][1])


def spot(sheet: Sheet, scene: Scene, pair: Pair, look: Look) -> complex:
    """Where the name of a pair belongs: its hinge, the end of its box, guide on the frame or cylinder."""
    at = sheet.on(scene.at(pair))
    if pair.slide is None:
        return at
    if pair.name in cylinders(scene.linkage):
        return Cylinder.of(sheet, scene, pair.slide).front
    beyond = BEYOND if pair.slide.carrier == FRAME else 0.0
    return at - scene.along(pair.slide) * (look.box[0] / 2 + beyond)


def arrows(sheet: Sheet, scene: Scene, drawn: Rendered, look: Look, hue: Mapping[str, str]) -> None:
    """How the drivers of these links go."""
    for driver in scene.linkage.drivers:
        if driver.link not in drawn.forms:
            continue
        pair = scene.structure.driving_pair(driver)
        at = sheet.on(drawn.scene.at(pair))
        if pair.slide is not None:
            along = scene.along(pair.slide) * driver.sense * (1 if pair.slide.runner == driver.link else -1)
            middle, name = drawn.cylinders.get(pair.name, at), driver_name(driver, "v")
            sliding_arrow(sheet, middle, along, look.box[1], name, hue[driver.link])
        else:
            ends = [end - at for edge in drawn.forms[driver.link].edges for end in edge]
            arm = max(ends, key=abs, default=1 + 0j)
            turning_arrow(sheet, at, float(np.angle(arm)), driver.sense, driver_name(driver, "ω"), hue[driver.link])
