"""Names of points and numbers of links, which go with the bodies that carry them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tmm_cli.animate.bodies import Picture
from tmm_cli.draw.symbols.actuators import cylinders
from tmm_cli.draw.symbols.scene import ON_LINE
from tmm_cli.linkage import FRAME

OUT, BOX_SIDE = 4.0, 6.5  # mm from a hinge to its name; from the middle of a box to the number of its link


def labels(picture: Picture, names: Sequence[str]) -> list[dict[str, Any]]:
    """Names of points beyond the ends of links, numbers beside links: in the axes of the bodies that carry them."""
    linkage, found = picture.scene.linkage, dict[tuple[str, complex], list[str]]()
    for name in {point: None for link in (FRAME, *linkage.moving) for point in linkage.links[link].points}:
        there = [link for link in (FRAME, *linkage.moving) if name in linkage.links[link].points]
        # on a link with more points there is a way out
        carrier = FRAME if FRAME in there else max(there, key=lambda link: len(linkage.links[link].points) > 1)
        local = complex(linkage.local(carrier, name))
        found.setdefault((carrier, complex(round(local.real, 9), round(local.imag, 9))), []).append(name)
    points = [
        {"body": names.index(link), "at": pair(_beyond(picture, link, local)), "text": ", ".join(text), "kind": "point"}
        for (link, local), text in found.items()
    ]
    numbers = [
        {"body": names.index(link), "at": pair(_beside(picture, link)), "text": link, "kind": "link"}
        for link in linkage.moving
        if np.isfinite(picture.forms[link].middle)
    ]
    return [*points, *numbers]


def _beyond(picture: Picture, link: str, local: complex) -> complex:
    """Where the name of a point is, in its link's axes: away from the middle of the link, outside a slider's box."""
    sheet, scene = picture.sheet, picture.scene
    at, driven = sheet.on(scene.place(link, local)), cylinders(scene.linkage)
    slides = [slide for slide in scene.linkage.slides if slide.name not in driven]
    boxed = any(abs(sheet.on(scene.place(slide.runner, slide.at)) - at) < ON_LINE for slide in slides)
    own = picture.bodies[link].own(at)
    if link == FRAME:
        return own + OUT * (-1 if at.real < sheet.origin.real else 1)
    places = [sheet.on(scene.place(link, complex(z))) for z in scene.linkage.links[link].points.values()]
    out = own - picture.bodies[link].own(sum(places) / len(places))
    return own + (2 * OUT if boxed else OUT) * (out / abs(out) if abs(out) > 1 else complex(0.8, 0.6))


def _beside(picture: Picture, link: str) -> complex:
    """Where the number of a link is, in its axes: on its plate, beside its longest line, or beside its box."""
    form, own = picture.forms[link], picture.bodies[link].own
    if len(form.hull) > 2:
        return own(form.middle)
    start, end = max(form.lines, key=lambda line: abs(line[1] - line[0]), default=(0j, 0j))
    if abs(end - start) > 1:
        return own(form.middle + 3j * (end - start) / abs(end - start))
    slide = next((slide for slide in picture.scene.linkage.slides if slide.runner == link), None)
    return own(form.middle + (1 - 1j if slide is None else -1j * picture.scene.along(slide)) * BOX_SIDE)


def pair(z: complex) -> list[float]:
    """x and y with y down."""
    return [round(z.real, 2) + 0.0, round(-z.imag, 2) + 0.0]
