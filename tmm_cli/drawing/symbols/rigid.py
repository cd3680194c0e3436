"""Marks of what is one body: a wheel with the bar through its axis, a cam's follower with its lever."""

from __future__ import annotations

import numpy as np

from tmm_cli.drawing.paper import Sheet
from tmm_cli.drawing.symbols.forms import Form
from tmm_cli.drawing.symbols.parts import WELD, weld
from tmm_cli.drawing.symbols.scene import ON_LINE
from tmm_cli.drawing.symbols.wheels import CamShape, Disc, Outline
from tmm_cli.mechanics.numerics import cross, dot

SAME, STEEP = 0.02, 0.7  # rad: of one direction; from a straight line, there is hardly a corner to fill
SPOKE, THROUGH = 1.2, 2.0  # points wide


def rigid(sheet: Sheet, found: Outline, form: Form, link: str, colour: str, hinge: float) -> None:
    """The marks of one link that is a part of a higher pair."""
    if not isinstance(found, CamShape):
        for disc in found.discs:
            if disc.link == link:
                _spoke(sheet, disc, form, colour)
    elif found.mesh.j == link:
        start, end = (sheet.on(place) for place in found.stem)
        _corner(sheet, start, end - start, form, colour, hinge)


def _arms(form: Form, at: complex) -> list[complex]:
    """Where straight parts lead from a place on them."""
    arms = []
    for start, end in form.edges:
        along = (end - start) / (abs(end - start) or 1.0)
        if abs(cross(along, at - start)) < ON_LINE and -ON_LINE < dot(along, at - start) < abs(end - start) + ON_LINE:
            arms += [arm for arm in (start - at, end - at) if abs(arm) > ON_LINE]
    return arms


def _spoke(sheet: Sheet, disc: Disc, form: Form, colour: str) -> None:
    """The longest bar from the axis goes on to the rim, and is welded to it."""
    centre, radius = sheet.on(disc.centre), disc.radius / sheet.mu
    arm = max(_arms(form, centre), key=abs, default=0j)
    if abs(arm) < ON_LINE or radius < 2 * WELD:
        return
    out = arm / abs(arm)
    rim = centre + radius * out
    if abs(arm) < radius:
        sheet.line([centre + arm, rim], colour, SPOKE, z=2.9)
    weld(sheet, rim, -WELD * out, WELD * 1j * out, colour)


def _corner(sheet: Sheet, at: complex, arm: complex, form: Form, colour: str, hinge: float) -> None:
    """A follower's arm and the bar that is next to it at the same hinge."""
    others = [other for other in _arms(form, at) if abs(arm) > ON_LINE and abs(np.angle(other / arm)) > SAME]
    if not others:
        return
    nearest = min(others, key=lambda other: abs(float(np.angle(other / arm))))
    if abs(float(np.angle(nearest / arm))) < np.pi - STEEP:
        weld(sheet, at, arm, nearest, colour, hinge)
    else:  # a bar that goes on beyond the hinge
        sheet.line([at + hinge * arm / abs(arm), at, at + hinge * nearest / abs(nearest)], colour, THROUGH, z=6.2)
