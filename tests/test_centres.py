"""Instantaneous centres against velocities, against Kennedy's theorem and against textbooks; mechanical advantage."""

from functools import cache
from itertools import combinations
from pathlib import Path

import numpy as np
import pytest
from test_commands import tmm

from tmm_cli import load, solve
from tmm_cli.mechanics.analysis import with_centres
from tmm_cli.mechanics.kinematics import find_centres
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import cross
from tmm_cli.problem import build_problem, read_text
from tmm_cli.reports import walk

PROBLEMS = Path(__file__).parents[1] / "problems"
LINKAGES = ("crank-rocker", "crank-slider", "six-bar", "shaper", "whitworth", "press-class-iii", "gear-doubling")
SIZE = 0.5  # m, of them all


@cache
def solved(name):
    return solve(load(PROBLEMS / f"{name}.yaml"), "kinematics")


@cache
def found(name, k):
    results = solved(name)
    return {centre.links: centre for centre in find_centres(results.motion, results.structure, k)}


@pytest.mark.parametrize("name", LINKAGES)
@pytest.mark.parametrize("k", [1, 4, 7])
def test_a_point_moves_about_the_centre_of_its_link_with_the_frame(name, k):
    motion, told = solved(name).motion, found(name, k)
    assert len(told) == len(motion.linkage.links) * (len(motion.linkage.links) - 1) / 2
    for link in motion.linkage.moving:
        centre, turning = told[FRAME, link], motion.link(link)
        for local in motion.linkage.links[link].points.values():
            point = motion.point(link, local)
            if centre.place is not None:
                about = 1j * turning.omega[k] * (point.x[k] - centre.place)
                assert point.v[k] == pytest.approx(about, abs=1e-9 * (abs(centre.place) + 1))
            elif centre.direction is not None:
                assert abs(turning.omega[k]) < 1e-9 and abs(cross(point.v[k], 1j * centre.direction)) < 1e-9


@pytest.mark.parametrize("name", LINKAGES)
@pytest.mark.parametrize("k", [1, 4, 7])
def test_the_centres_of_three_links_lie_on_a_line(name, k):
    told, names = found(name, k), tuple(solved(name).linkage.links)
    for three in combinations(names, 3):
        here = [told[links] for links in combinations(three, 2)]
        places = [c.place for c in here if c.place is not None]
        away = [c.direction for c in here if c.place is None]
        if len(places) == 3:
            p, q, r = places
            longest = max(abs(q - p), abs(r - p))
            assert abs(cross(q - p, r - p)) <= 1e-9 * longest * (longest + SIZE)
        elif len(places) == 2 and away[0] is not None:
            assert abs(cross(places[1] - places[0], away[0])) <= 1e-9 * (abs(places[1] - places[0]) + SIZE)


@pytest.mark.parametrize("name", LINKAGES)
def test_the_lines_that_are_told_cross_in_the_centre(name):
    told = found(name, 4)
    for centre in told.values():
        for one, other in centre.lines:
            p, q = told[one], told[other]
            if None not in (p.place, q.place, centre.place):
                size = abs(centre.place - p.place) * abs(q.place - p.place)
                assert abs(cross(centre.place - p.place, q.place - p.place)) < 1e-8 * (size + SIZE**2)


@pytest.mark.parametrize("name", ["crank-rocker", "crank-slider", "six-bar", "shaper"])
def test_kennedys_lines_find_every_centre_of_linkages_of_class_ii(name):
    assert all(centre.pair or centre.lines for centre in found(name, 1).values())


FOUR_BAR = """
tmm: 1
points: {A: [0, 0], D: [600, 0]}
links:
  2: {points: [A, B], length: 300}
  3: {points: [B, C], length: 360}
  4: {points: [D, C], length: 360}
driver: {link: 2, speed: 100 rpm}
sketch: {at: 60, C: [500, 350]}
positions: {at: [60]}
"""
CRANK_SLIDER = """
tmm: 1
points: {O: [0, 0]}
guides: {x: {through: O, angle: 0}}
links:
  2: {points: [O, B], length: 100}
  3: {points: [B, A], length: 400}
  4: {points: [A], slides: x}
driver: {link: 2, speed: 10 rad/s}
sketch: {at: 45, A: [460, 0]}
positions: {at: [45]}
"""


def of_text(text):
    results = solve(build_problem(read_text(text, "textbook.yaml")), "kinematics")
    return results.motion, {c.links: c for c in find_centres(results.motion, results.structure, 0)}


def test_a_four_bar_as_a_textbook_measures_it():
    """R. S. Khurmi, J. K. Gupta, Theory of Machines (2005), example 6.1, p. 126: 500 mm, 6.283 rad/s by drawing."""
    motion, told = of_text(FOUR_BAR)
    distance = abs(told[FRAME, "3"].place - motion.named("B").x[0])
    assert distance == pytest.approx(0.5, rel=0.02)
    assert abs(motion.link("3").omega[0]) == pytest.approx(6.283, rel=0.02)


def test_a_crank_slider_as_a_textbook_measures_it():
    """The same book, example 6.2, p. 128: 460 and 560 mm from the centre, 0.82 m/s, 1.78 rad/s by drawing."""
    motion, told = of_text(CRANK_SLIDER)
    centre = told[FRAME, "3"].place
    assert abs(centre - motion.named("A").x[0]) == pytest.approx(0.46, rel=0.01)
    assert abs(centre - motion.named("B").x[0]) == pytest.approx(0.56, rel=0.01)
    assert abs(motion.named("A").v[0]) == pytest.approx(0.82, rel=0.02)
    assert abs(motion.link("3").omega[0]) == pytest.approx(1.78, rel=0.02)


def test_the_mechanical_advantage_is_the_load_over_what_balances_it():
    text = CRANK_SLIDER.replace("at: [45]", "count: 12, from: 15").replace("tmm: 1", "tmm: 1\noutput: 4\ngravity: 0")
    results = solve(build_problem(read_text(f"{text}loads: {{Q: {{on: 4, force: [-250, 0]}}}}\n", "press.yaml")))
    (table,) = walk(with_centres(results), ["advantage"])
    assert 250 / np.abs(results.reactions.balance.moment) == pytest.approx(table.columns[-1].array, rel=1e-12)


def test_centres_are_listed_and_drawn_beside_a_whole_run(tmp_path):
    shown = tmm("kinematics", PROBLEMS / "six-bar.yaml", "--centres", "-o", tmp_path)
    assert shown.returncode == 0 and "P01 P03 and P12 P23" in shown.stdout
    assert {"centres.csv", "centres-03.svg"} <= {path.name for path in tmp_path.glob("*/*")}
