"""One symbol for one thing, on the scheme and to scale, whatever the problem of the bank."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from bank import NAMES, solved

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    THIN_COLOUR,
    AreaMark,
    CircleMark,
    DrawingSheet,
    LineMark,
    gather_coincident,
)
from tmm_cli.drawing.sheets import sketch_scene
from tmm_cli.drawing.symbols import (
    MEASURED,
    PLATE_COLOUR,
    STRUCTURAL,
    WELD_LEG,
    draw_mass_centre,
    fit_links,
    free_runs,
    points_to_scale,
    render_scene,
    support_side,
    tint_colour,
)
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import cross, dot

LOOKS = (STRUCTURAL, MEASURED)  # the scheme, to scale
NEAR = 0.35  # mm


@cache
def drawn(name, look):
    """A mechanism at its sketch, with its sheet."""
    scene, links = sketch_scene(solved(name))[1], solved(name).structure.links
    if look.measured:
        linkage = scene.linkage
        places = [scene.point(name) for link in linkage.links.values() for name in link.points]
        sheet = DrawingSheet("", "", points_to_scale(scene, places))
    else:
        sheet = DrawingSheet("", "")
        scene = fit_links(sheet, scene, links, 20, 150)
    found = render_scene(sheet, scene, links, scene.structure.pairs, look, dict.fromkeys((FRAME, *links), DARK_COLOUR))
    return sheet, found


def every(test):
    """Of each problem, on the scheme and to scale."""

    def both(name):
        for look in LOOKS:
            test(name, look)

    both.__name__ = test.__name__
    return pytest.mark.parametrize("name", NAMES)(both)


def distance(place, line):
    """Of a place from a piece of a line."""
    start, end = line
    span = end - start
    share = np.clip(dot(span, place - start) / np.maximum(abs(span) ** 2, 1e-30), 0, 1)
    return abs(place - start - share * span)


def meet(ones, others):
    """Which of these pieces of lines cross or touch which of those: a row of flags for each of these."""
    one, other = (np.array(pieces, complex).reshape(-1, 2).T for pieces in (ones, others))
    pairs = [(one[:, :, None], other[:, None]), (other[:, None], one[:, :, None])]
    turns = [cross(b - a, z - a) for (a, b), ends in pairs for z in ends]
    crossing = (turns[0] * turns[1] < 0) & (turns[2] * turns[3] < 0)
    return crossing | (np.min([distance(z, line) for line, ends in pairs for z in ends], axis=0) < NEAR)


@every
def test_no_rod_runs_through_hatching(name, look):
    sheet, found = drawn(name, look)
    strokes = [
        m.places for m in sheet.marks if isinstance(m, LineMark) and m.layer == "supports" and m.colour == THIN_COLOUR
    ]
    for pair in found.scene.structure.pairs:
        if pair.lower and FRAME in (pair.i, pair.j):
            at = sheet.on(found.scene.at(pair))
            assert sum(abs((stroke[0] + stroke[-1]) / 2 - at) < 14 for stroke in strokes) > 2, pair.name
    for link, form in found.forms.items():
        assert not meet(form.edges, [(stroke[0], stroke[-1]) for stroke in strokes]).any(), link


@every
def test_all_parts_of_a_link_touch_one_another(name, look):
    _sheet, found = drawn(name, look)
    for link, form in found.forms.items():
        touching, reached = meet(form.edges, form.edges), np.arange(len(form.edges)) == 0
        for __ in form.edges:
            reached |= touching[reached].any(0)
        assert reached.all(), link
        for joint in form.joints:
            near = [distance(joint, part) < NEAR for part in form.edges]
            assert not near or any(near) or len(form.hull) > 2, link


@every
def test_a_stone_runs_on_a_bar_of_its_guide_and_is_no_corner_of_a_plate(name, look):
    sheet, found = drawn(name, look)
    lines = [m.places for m in sheet.marks if isinstance(m, LineMark) and m.layer == "links"]
    plates = [
        m.corners for m in sheet.marks if isinstance(m, AreaMark) and m.face in (PLATE_COLOUR, tint_colour(DARK_COLOUR))
    ]
    linkage = found.scene.linkage
    for slide in linkage.slides:
        if slide.carrier == FRAME or slide.name in {d.joint for d in linkage.drivers}:
            continue
        stone, along = sheet.on(found.scene.place(slide.runner, slide.at)), found.scene.along(slide)
        before, after = stone - look.block[0] / 2 * along, stone + look.block[0] / 2 * along
        bars = [p for p in lines if max(distance(end, (p[0], p[-1])) for end in (before, stone, after)) < NEAR]
        assert bars, slide.name
        named = [sheet.on(found.scene.place(slide.carrier, p)) for p in linkage.links[slide.carrier].points.values()]
        if min((abs(stone - place) for place in named), default=1.0) > NEAR:
            assert all(abs(corner - stone) > NEAR for corners in plates for corner in corners), slide.name


@every
def test_a_lever_goes_through_its_hinge_in_one_line_over_the_circle(name, look):
    sheet, found = drawn(name, look)
    circles = [m for m in sheet.marks if isinstance(m, CircleMark) and m.layer == "links"]
    lines = [m for m in sheet.marks if isinstance(m, LineMark) and m.layer == "links"]
    for pair in found.scene.structure.pairs:
        at = sheet.on(found.scene.at(pair))
        circle = max((m for m in circles if abs(m.centre - at) < NEAR), key=lambda m: m.z, default=None)
        for link in (pair.i, pair.j):
            if pair.kind != "R" or link == FRAME:
                continue
            arms = [end - at for line in found.forms[link].lines for end in line if distance(at, line) < 0.1]
            arms = [arm / abs(arm) for arm in arms if abs(arm) > 2.5]
            if any(dot(one, other) < -1 + 1e-6 for one in arms for other in arms):
                ends = at + look.hinge * 0.5 * arms[0], at - look.hinge * 0.5 * arms[0]
                over = [m.places for m in lines if m.z > circle.z]
                assert any(max(distance(end, (p[0], p[-1])) for end in ends) < 0.1 for p in over), (pair.name, link)


@every
def test_a_hinge_has_a_circle_for_every_pair_in_it(name, look):
    sheet, found = drawn(name, look)
    circles = [m for m in sheet.marks if isinstance(m, CircleMark) and m.layer == "links" and m.face == "white"]
    hinges = gather_coincident((sheet.on(found.scene.at(p)), p) for p in found.scene.structure.pairs if p.kind == "R")
    for at, pairs in hinges:
        radii = {round(m.radius, 3) for m in circles if abs(m.centre - at) < NEAR}
        assert len(radii) >= len(pairs), pairs


def test_a_centre_of_mass_is_a_circle_with_two_dark_quarters():
    sheet = DrawingSheet("", "")
    draw_mass_centre(sheet, 100 + 100j)
    quarters = [m for m in sheet.marks if isinstance(m, AreaMark)]
    (circle,) = (m for m in sheet.marks if isinstance(m, CircleMark))
    assert circle.face == "white" and len(quarters) == 2
    middles = [np.mean(m.corners) - circle.centre for m in quarters]
    assert middles[0] == pytest.approx(-middles[1])
    assert all(abs(corner - circle.centre) <= circle.radius + 1e-9 for m in quarters for corner in m.corners)


def test_a_rail_is_open_where_rods_go_through_it():
    assert free_runs(-10, 10, []) == [(-10, 10)]
    assert free_runs(-10, 10, [(-2, 3)]) == [(-10, -2), (3, 10)]
    assert free_runs(-10, 10, [(1, 5), (-2, 3)]) == [(-10, -2), (5, 10)]
    assert free_runs(-10, 10, [(-30, 3), (9, 40)]) == [(3, 9)]
    assert free_runs(-10, 10, [(-9, 9)]) == []  # nothing is hatched that is shorter than its strokes


@pytest.mark.parametrize(
    ("ends", "side"),
    [
        ([30 + 30j], -1j),  # a crank upwards: the support is below
        ([-5 - 40j], 1j),  # a pendulum hangs from above
        ([2 + 40j, -2 - 40j], 1),  # a lever through the hinge: a wall beside it
    ],
)
def test_a_support_is_where_no_rod_runs_through_it(ends, side):
    sheet = DrawingSheet("", "")
    assert support_side(sheet, 100 + 100j, [(100 + 100j, 100 + 100j + end) for end in ends]) == pytest.approx(side)


@every
def test_a_cylinder_is_a_barrel_with_a_piston_and_its_rod(name, look):
    sheet, found = drawn(name, look)
    lines = [m.places for m in sheet.marks if isinstance(m, LineMark) and m.layer == "links"]
    barrels = [m.corners for m in sheet.marks if isinstance(m, AreaMark) and len(m.corners) == 4 and m.z > 4.5]
    driven = [d for d in found.scene.linkage.drivers if d.kind == "slide" and d.base != FRAME]
    assert len(barrels) == len(driven)
    for driver, corners in zip(driven, barrels, strict=True):
        slide = found.scene.linkage.slide(driver.joint)
        end, along = sheet.on(found.scene.place(slide.runner, slide.at)), found.scene.along(slide)
        rods = [p for p in lines if distance(end, (p[0], p[-1])) < NEAR and abs(cross(along, p[0] - end)) < NEAR]
        low, high = min(dot(along, c) for c in corners), max(dot(along, c) for c in corners)
        inside = [min(dot(along, z) for z in rod) for rod in rods]
        assert any(low < run < high for run in inside) and dot(along, end) > high  # the rod comes out of its barrel


@every
def test_a_wheel_is_welded_to_the_bar_of_its_link(name, look):
    sheet, found = drawn(name, look)
    marks = [
        m.corners for m in sheet.marks if isinstance(m, AreaMark) and len(m.corners) == 3 and m.face == DARK_COLOUR
    ]
    for pair in found.scene.structure.pairs:
        for disc in getattr(found.scene.higher(pair), "discs", ()) if not pair.lower else ():
            centre, radius = sheet.on(disc.centre), disc.radius / sheet.mu
            if disc.link in found.forms and radius > 2 * WELD_LEG:
                barred = any(distance(centre, line) < 0.1 for line in found.forms[disc.link].edges)
                rims = [corners for corners in marks if abs(abs(corners[0] - centre) - radius) < 0.1]
                assert not barred or rims, disc.link
