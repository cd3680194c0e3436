"""The structural scheme and the groups apart: every link, pair, lead and group is there, legible, inside the sheet."""

from __future__ import annotations

import cmath
import math
from itertools import islice

import numpy as np
import pytest
from bank import NAMES, moved, solved
from test_commands import ROOT, SHAPER, imported, tmm

from tmm_cli import load, solve
from tmm_cli.drawing.paper import CircleMark, DrawingSheet, LineMark, TextMark, text_corners
from tmm_cli.drawing.run import all_sheets
from tmm_cli.drawing.sheets import (
    Legend,
    draw_groups,
    draw_scheme,
    groups_sheet,
    mechanism_parts,
    scheme_sheet,
    sketch_scene,
)
from tmm_cli.drawing.symbols import STRUCTURAL, MechanismScene, form_by_pairs, higher_pair_outline, replacement_link
from tmm_cli.mechanics.groups import Pose
from tmm_cli.mechanics.linkage import FRAME, Driver, Hinge, Link, Linkage, Sketch, Slide
from tmm_cli.mechanics.structure import analyse_structure
from tmm_cli.problem import build_problem, read_text


def scene(points, links, slides=(), driver="O", turn=0.4):
    """A linkage drawn at the given places (mm): every link's axes are turned by some angle and start somewhere.

    slides: name, carrier, runner, place of the running point, angle of the guide (deg).
    """
    poses = {name: (1e-3 * (7 * n - 3j * n), cmath.exp(1j * turn * n)) for n, name in enumerate(links)}

    def local(name, place):
        origin, z = poses[name]
        return (place * 1e-3 - origin) / z

    bodies = {name: Link(name, {p: local(name, points[p]) for p in own.split()}) for name, own in links.items()}
    hinges = [Hinge(p, tuple(n for n, body in bodies.items() if p in body.points)) for p in points]
    guided = [
        Slide(
            name,
            one,
            other,
            local(one, at),
            math.radians(angle) - cmath.phase(poses[one][1]),
            local(other, at),
            cmath.phase(poses[other][1] / poses[one][1]),
        )
        for name, one, other, at, angle in slides
    ]
    linkage = Linkage(
        bodies,
        tuple(h for h in hinges if len(h.links) > 1),
        tuple(guided),
        Driver("1", "turn", driver, 1.0),
        Sketch(0.0),
    )
    moved = {name: Pose(np.array([origin]), np.array([z])) for name, (origin, z) in poses.items()}
    return MechanismScene(linkage, analyse_structure(linkage), moved)


TRIAD = scene(
    {"O": 0j, "A": 40 + 30j, "B": 120 + 60j, "C": 190 + 40j, "D": 160 + 120j, "E": 210 - 40j, "F": 250 + 140j},
    {FRAME: "O E F", "1": "O A", "2": "A B", "3": "B C D", "4": "C E", "5": "D F"},
)
SLIDING_TRIAD = scene(
    {"O": 0j, "A": 40 + 30j, "B": 120 + 60j, "C": 190 + 40j, "D": 160 + 120j, "E": 210 - 40j},
    {FRAME: "O E", "1": "O A", "2": "A B", "3": "B C D", "4": "C E", "5": "D"},
    [("x", FRAME, "5", 160 + 120j, 20)],
)
CONTOUR = scene(
    {"O": 0j, "A": 40 + 30j, "B": 120 + 20j, "C": 120 + 100j, "D": 220 + 100j, "E": 220 + 20j, "F": 270 + 70j},
    {FRAME: "O F", "1": "O A", "2": "A B C", "3": "C D", "4": "D E F", "5": "B E"},
)
OFFSET = scene(
    {"O": 0j, "A": 40 + 30j, "C": -20 - 100j, "D": 60 + 60j, "E": 140 + 70j},
    {FRAME: "O C", "1": "O A", "2": "A", "3": "C D", "4": "D E", "5": "E"},
    [("a", "3", "2", 40 + 30j, 75), ("x", FRAME, "5", 140 + 70j, 0)],
)
GUIDE_ON_THE_LINK = scene(
    {"O": 0j, "A": 40 + 30j, "B": 150 + 60j},
    {FRAME: "O", "1": "O A", "2": "A B", "3": "B"},
    [("x", "3", FRAME, 200 + 60j, 0)],
)
CROSS = scene(
    {"O": 0j, "C": 80 + 10j},
    {FRAME: "O C", "1": "O", "2": "", "3": "C"},
    [("a", "2", "1", -20 + 40j, 80), ("b", "2", "3", 90 + 20j, -10)],
)
HAND_MADE = {
    "triad": TRIAD,
    "sliding triad": SLIDING_TRIAD,
    "class IV": CONTOUR,
    "offset guide": OFFSET,
    "guide on the link": GUIDE_ON_THE_LINK,
    "two guides on one link": CROSS,
}


def chain(number):
    """A crank and a row of dyads, each on the compound hinge of the one before."""
    points, links = {"O": 0j, "A": 20 + 30j}, {FRAME: "O", "1": "O A"}
    before = "A"
    for n in range(number):
        points |= {f"B{n}": 60 + 60 * n + 1j * (50 + 10 * (n % 2)), f"D{n}": 70 + 60 * n - 30j}
        links[FRAME] += f" D{n}"
        links |= {f"{2 * n + 2}": f"{before} B{n}", f"{2 * n + 3}": f"B{n} D{n}"}
        before = f"B{n}"
    return scene(points, links)


def written(figure):
    """Texts with their true boxes, mm."""
    for text in (mark for mark in figure.marks if isinstance(mark, TextMark)):
        low, __, high, __ = text_corners(text)  # none is turned
        yield text.text, (low.real, high.real, low.imag, high.imag)


def texts(figure):
    return figure.texts()


def inside(figure):
    """Every line inside the sheet."""
    width, height = figure.paper
    for line in (mark for mark in figure.marks if isinstance(mark, LineMark)):
        assert all(8 < place.real < width - 8 and 8 < place.imag < height - 8 for place in line.places)


def legible(figure):
    """Every text inside the sheet and none on another one."""
    width, height = figure.paper
    found = list(written(figure))
    for n, (text, (left, right, low, high)) in enumerate(found):
        assert left > 8 and low > 8 and right < width - 8 and high < height - 8, text
        for other, (a, b, c, d) in found[:n]:
            across, up = min(right, b) - max(left, a), min(high, d) - max(low, c)
            assert across < 0.3 or up < 0.6, (text, other)


@pytest.mark.parametrize("name", [*NAMES[1::2], *HAND_MADE])
def test_sheets_are_legible_with_every_line_inside_and_show_every_link_pair_and_group(name):
    here = HAND_MADE[name] if name in HAND_MADE else sketch_scene(solved(name))[1]
    every = mechanism_parts(here.structure)
    whole = scheme_sheet("title", "crank at 30 deg", here).finish()
    apart = groups_sheet("title", "crank at 30 deg", here, every, {}).finish()
    for figure in (whole, apart):
        legible(figure)
        inside(figure)
        assert set(here.structure.links) <= set(texts(figure))
    names = {name for text in texts(whole) for name in text.split(", ")}
    assert {p.name for p in here.structure.pairs} <= names
    one_line = " ".join(" ".join(text.split()) for text in texts(whole))  # a long formula is broken between lines
    assert here.structure.formula.replace("->", "→") in one_line
    assert {part.title for part in every} <= set(texts(apart))
    leads = {name for text in texts(apart) for name in text.split(", ")}
    for group in here.structure.groups:
        for pair in group.outer:
            assert f"{pair.name} (to {pair.i if pair.j in group.links else pair.j})" in leads


def test_the_legend_counts_mobility_after_chebyshev():
    facts = Legend(analyse_structure(load(str(ROOT / "problems" / "six-bar.yaml")).linkage)).facts
    assert "moving links: n = 5; lower pairs: p₁ = 7 (revolute: 6, prismatic: 1); higher pairs: p₂ = 0" in facts
    assert "W = 3n − 2p₁ − p₂ = 3·5 − 2·7 − 0 = 1" in facts
    assert "Mechanism of class II" in facts
    assert "Compound hinge B: one circle for each pair" in facts


def test_a_compound_hinge_has_a_circle_for_every_pair():
    figure = scheme_sheet("title", "", sketch_scene(moved("six-bar"))[1]).finish()
    circles = [mark for mark in figure.marks if isinstance(mark, CircleMark)]
    assert len(circles) == 6  # turning pairs
    assert len({(round(c.centre.real, 3), round(c.centre.imag, 3)) for c in circles}) == 5


def test_the_driver_and_every_group_have_colours_of_their_own():
    colours = [part.colour for part in mechanism_parts(chain(6).structure)]
    assert len(set(colours)) == 7


@pytest.mark.parametrize(
    "name, redundant_links, mark",
    [
        ("parallel-couplers", [("4",)], "link 4 is redundant; redundant constraints q = 1"),
        ("settings/breaking-rod", [], "links 2, 3 are rigidly connected and count as one; redundant constraints q = 1"),
    ],
)
def test_what_the_formula_leaves_out_is_drawn_and_marked(name, redundant_links, mark):
    here = sketch_scene(moved(name))[1]
    every = mechanism_parts(here.structure)
    whole = scheme_sheet("title", "", here).finish()
    in_one_line = " ".join(" ".join(text.split()) for text in texts(whole))
    assert f"{mark} W from the structural formula: 3·3 − 2·4 = 1" in in_one_line
    redundant = [part for part in every if part.redundant is not None]
    assert [part.links for part in redundant] == redundant_links
    assert not {part.colour for part in redundant} & {part.colour for part in every if part not in redundant}
    apart = set(texts(groups_sheet("title", "", here, every, {}).finish()))
    assert {p.name for p in here.structure.pairs if {p.i, p.j} == {"2", "3"}} <= apart


def test_a_ternary_link_is_a_plate_and_a_binary_one_a_bar():
    sheet = DrawingSheet("", "", [0j, 0.25 + 0.15j])
    assert len(form_by_pairs(sheet, TRIAD, "3").hull) == 3
    assert len(form_by_pairs(sheet, TRIAD, "2").hull) == 2
    ends = form_by_pairs(sheet, TRIAD, "2").hull
    assert abs(ends[0] - ends[1]) * sheet.mu == pytest.approx(abs(80 + 30j) / 1000)


def test_a_hinge_beside_a_guide_is_joined_to_it_square():
    sheet = DrawingSheet("", "", [0j, 0.25 + 0.15j])
    shape = form_by_pairs(sheet, OFFSET, "3")
    ((start, end),) = shape.struts
    assert ((end - start) * np.conj(shape.bars[0].along)).real == pytest.approx(0, abs=1e-9)
    assert len(shape.welds) == 2  # at the guide, and at the hinge: one link, not two


def test_a_link_goes_on_beyond_a_hinge_in_its_middle():
    here = sketch_scene(moved("whitworth"))[1]
    sheet = DrawingSheet("", "", here.extent(here.structure.links))
    pivot = next(p for p in here.structure.pairs if p.name == "C")
    assert form_by_pairs(sheet, here, "3").through(sheet.on(here.at(pivot))) is not None
    assert form_by_pairs(sheet, here, "1").through(sheet.on(here.at(pivot))) is None


def test_symbols_shrink_where_pairs_are_near_one_another():
    near = scene(
        {"O": 0j, "A": 6 + 4j, "B": 230 + 30j, "C": 260 - 60j},
        {FRAME: "O C", "1": "O A", "2": "A B", "3": "B C"},
    )
    figure = scheme_sheet("title", "", near).finish()
    circles = [mark for mark in figure.marks if isinstance(mark, CircleMark)]
    o, a = sorted(circles, key=lambda c: c.centre.real)[:2]
    assert o.radius < STRUCTURAL.hinge
    assert abs(o.centre - a.centre) > o.radius + a.radius
    legible(figure)


def test_many_groups_are_on_more_than_one_sheet():
    here = chain(8)
    found = dict(draw_groups("title", "", here))
    assert list(found) == ["groups", "groups-sheet-2"]
    told = [text for figure in found.values() for text in texts(figure)]
    assert all(told.count(part.title) == 1 for part in mechanism_parts(here.structure))
    for figure in found.values():
        legible(figure)


def test_links_may_have_any_names():
    odd = scene(
        {"O": 0j, "A": 40 + 30j, "B": 120 + 60j, "D": 160 + 0j},
        {FRAME: "O D", "1": "O A", "../шатун $x_1$": "A B", "a/b": "D B"},
    )
    legible(scheme_sheet("title", "", odd).finish())


def test_where_the_sketch_hides_a_pair_another_place_of_the_driver_is_drawn():
    def drawn_at(at):
        text = (ROOT / "problems" / "sine.yaml").read_text(encoding="utf-8")
        text = text.replace("output: 3", f"sketch: {{at: {at} deg}}\noutput: 3")
        words, _ = sketch_scene(solve(build_problem(read_text(text, "x.yaml")), "structure"))
        return float(words.removeprefix("crank at ").removesuffix(" deg"))

    assert drawn_at(40) == pytest.approx(40)
    assert abs(math.cos(math.radians(drawn_at(90)))) > 0.2  # at 90 deg the slotted slider would cover the crank


def test_what_cannot_be_assembled_is_not_drawn(tmp_path):
    text = SHAPER.read_text(encoding="utf-8").replace("DE: 210", "DE: 1")
    problem = tmp_path / "apart.yaml"
    problem.write_text(text, encoding="utf-8")
    results = solve(load(str(problem)), "structure")
    assert sketch_scene(results) is None
    assert list(all_sheets(results)) == []
    done = tmm("structure", problem, "--drawings", cwd=tmp_path)
    assert done.returncode == 0
    assert (
        "the scheme is not drawn: the groups of apart cannot be assembled in the position of the sketch" in done.stderr
    )
    assert not (tmp_path / "outputs").exists()


def test_tmm_structure_draws_only_when_asked(tmp_path):
    done = tmm("structure", SHAPER, "--drawings", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    folder = tmp_path / "outputs" / "shaper"
    assert {p.name for p in folder.iterdir()} == {"structure.png", "structure.svg", "groups.png", "groups.svg"}
    assert (folder / "groups.png").read_bytes().startswith(b"\x89PNG")
    done = tmm("structure", SHAPER, "--drawings", "-o", tmp_path / "mine")
    names = {p.name for p in (tmp_path / "mine" / "shaper").iterdir()}
    assert {"structure.png", "structure.svg", "groups.png", "groups.svg", "pairs.csv", "result.json"} <= names
    assert "matplotlib" not in imported("structure", str(SHAPER))


def test_drawings_of_the_structure_leave_what_a_run_has_written(tmp_path):
    problem = ROOT / "problems" / "sine.yaml"
    assert tmm("run", problem, "--no-drawings", cwd=tmp_path).returncode == 0
    before = {p.name for p in (tmp_path / "outputs" / "sine").iterdir()}
    assert tmm("structure", problem, "--drawings", cwd=tmp_path).returncode == 0
    assert before < {p.name for p in (tmp_path / "outputs" / "sine").iterdir()}


def test_a_run_draws_them_too_and_the_same_each_time():
    results = moved("shaper")
    assert [stem for stem, _ in islice(all_sheets(results), 2)] == ["structure", "groups"]
    here = sketch_scene(results)
    assert texts(scheme_sheet("", *here).finish()) == texts(scheme_sheet("", *here).finish())


@pytest.mark.parametrize(
    "name",
    [
        "gear-doubling",
        "gear-lever/ratchet-feed",
        "planetary-dwell-press",
        "cam-lever",
        "cam-coupler",
        "rack-doubling",
        "summing-lever",
    ],
)
def test_the_link_in_place_of_a_higher_pair_leaves_the_velocities_as_they_are(name):
    """Its ends, on both links, have one velocity along it, as the ends of any rigid link."""
    results = solved(name)
    motion, linkage = results.motion, results.linkage
    for k in (1, 4):
        scene = MechanismScene(linkage, results.structure, motion.poses, k)
        for mesh in linkage.meshes:
            link = replacement_link(higher_pair_outline(scene, mesh))
            along = (link.end - link.start) / abs(link.end - link.start)
            speeds = []
            for body, place in ((mesh.i, link.start), (mesh.j, link.end)):
                if body == FRAME:
                    speeds.append(0j)
                    continue
                origin, start = complex(motion.poses[body].x[k]), complex(motion.point(body, 0j).v[k])
                speeds.append(start + 1j * float(motion.link(body).omega[k]) * (place - origin))
            run = [(np.conj(along) * speed).real for speed in speeds]
            assert run[0] == pytest.approx(run[1], abs=2e-3 * max(map(abs, speeds)) + 1e-12)  # a cam has corners


def test_the_scheme_shows_the_links_that_replace_higher_pairs():
    with_gears, without = (dict(draw_scheme(solved(name)))["structure"].texts() for name in ("gear-doubling", "shaper"))
    assert "Dashed lines: links that replace higher pairs" in with_gears
    assert "Dashed lines: links that replace higher pairs" not in without
