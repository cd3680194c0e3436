"""Marks of what is one body: a wheel with the bar through its axis, a cam's follower with its lever."""

from __future__ import annotations

import numpy as np

from tmm_cli.drawing.paper import DrawingSheet
from tmm_cli.drawing.symbols.forms import LinkForm
from tmm_cli.drawing.symbols.parts import WELD_LEG, draw_weld
from tmm_cli.drawing.symbols.scene import ON_LINE
from tmm_cli.drawing.symbols.wheels import CamOutline, GearDisc, HigherPairOutline
from tmm_cli.mechanics.numerics import cross, dot

SAME_ANGLE, STRAIGHT_ANGLE = 0.02, 0.7  # rad: of one direction; from a straight line, there is hardly a corner to fill
SPOKE_WIDTH, THROUGH_WIDTH = 1.2, 2.0  # points wide


def draw_rigid_marks(
    sheet: DrawingSheet, found: HigherPairOutline, form: LinkForm, link: str, colour: str, hinge: float
) -> None:
    """The marks of one link that is a part of a higher pair."""
    if not isinstance(found, CamOutline):
        for disc in found.discs:
            if disc.link == link:
                _draw_spoke(sheet, disc, form, colour)
    elif found.mesh.j == link:
        start, end = (sheet.on(place) for place in found.stem)
        _draw_corner(sheet, start, end - start, form, colour, hinge)


def _arms_at(form: LinkForm, at: complex) -> list[complex]:
    """Where straight parts lead from a place on them."""
    arms = []
    for start, end in form.edges:
        along = (end - start) / (abs(end - start) or 1.0)
        if abs(cross(along, at - start)) < ON_LINE and -ON_LINE < dot(along, at - start) < abs(end - start) + ON_LINE:
            arms += [arm for arm in (start - at, end - at) if abs(arm) > ON_LINE]
    return arms


def _draw_spoke(sheet: DrawingSheet, disc: GearDisc, form: LinkForm, colour: str) -> None:
    """The longest bar from the axis goes on to the rim, and is welded to it."""
    centre, radius = sheet.on(disc.centre), disc.radius / sheet.mu
    arm = max(_arms_at(form, centre), key=abs, default=0j)
    if abs(arm) < ON_LINE or radius < 2 * WELD_LEG:
        return
    out = arm / abs(arm)
    rim = centre + radius * out
    if abs(arm) < radius:
        sheet.line([centre + arm, rim], colour, SPOKE_WIDTH, z=2.9)
    draw_weld(sheet, rim, -WELD_LEG * out, WELD_LEG * 1j * out, colour)


def _draw_corner(sheet: DrawingSheet, at: complex, arm: complex, form: LinkForm, colour: str, hinge: float) -> None:
    """A follower's arm and the bar that is next to it at the same hinge."""
    others = [other for other in _arms_at(form, at) if abs(arm) > ON_LINE and abs(np.angle(other / arm)) > SAME_ANGLE]
    if not others:
        return
    nearest = min(others, key=lambda other: abs(float(np.angle(other / arm))))
    if abs(float(np.angle(nearest / arm))) < np.pi - STRAIGHT_ANGLE:
        draw_weld(sheet, at, arm, nearest, colour, hinge)
    else:  # a bar that goes on beyond the hinge
        sheet.line([at + hinge * arm / abs(arm), at, at + hinge * nearest / abs(nearest)], colour, THROUGH_WIDTH, z=6.2)
