"""Optimal synthesis within bounds that hold no mechanism: refused with the nearest bounds that hold one."""

from __future__ import annotations

import pytest
from test_synthesis_any_linkage import text_of

from tmm_cli.problem.build import build
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.reader import read_text

FOUR_BAR = """tmm: 1
units: {{length: mm, angle: deg}}
synthesis:
  task: optimal
  vary: {{l1: {l1}, l2: {l2}, l3: {l3}}}
  objective: length
  constraints: [{constraint}]
points: {{O: [0, 0], D: [80, 0]}}
links:
  1: {{points: [O, A], length: l1}}
  2: {{points: [A, B], length: l2}}
  3: {{points: [D, B], length: l3}}
driver: {{link: 1, speed: 60 rpm, turns: ccw}}
sketch: {{at: 90 deg, B: [80, l3]}}
output: 3
"""


def solved(constraint="", **bounds):
    return build(read_text(FOUR_BAR.format(constraint=constraint, **bounds), "x.yaml")).synthesis.outcome


def refused(constraint="", **bounds):
    with pytest.raises(ProblemError) as caught:
        solved(constraint, **bounds)
    return caught.value


def test_a_crank_that_cannot_turn_is_refused_with_the_nearest_bound():
    """Grashof: l1 + 80 mm <= l2 + l3. By shares of the ranges l3 has the shortest way: to 65 + 80 - 70 = 75 mm."""
    bounds = {"l1": "[65, 70]", "l2": "[60, 70]", "l3": "[50, 70]"}
    error = refused(**bounds)
    assert error.path == ("synthesis", "vary", "l3", 1)
    assert error.message == "no mechanism within these bounds can go the whole way of its driver"
    assert error.allowed == "wider bounds, the nearest: l3 to 75.0051 mm"
    found = solved(**(bounds | {"l3": "[50, 75.0051]"}))
    assert {v.name: round(float(v.value), 4) for v in found.found} == {"l1": 0.065, "l2": 0.07, "l3": 0.075}
    refused(**(bounds | {"l3": "[50, 74.99]"}))


def test_what_cannot_be_assembled_is_refused_with_the_nearest_bounds():
    """The frame is 80 mm, and l2 + l3 must reach from D to A everywhere: l2 from 80 + 20 - 21 = 79 mm on."""
    bounds = {"l1": "[20, 25]", "l2": "[30, 40]", "l3": "[20, 21]"}
    error = refused(**bounds)
    assert error.message == "no linkage within these bounds can be assembled as it is sketched"
    assert error.allowed == "wider bounds, the nearest: l2 to 79.0391 mm"
    solved(**(bounds | {"l2": "[30, 79.0391]"}))
    refused(**(bounds | {"l2": "[30, 78.9]"}))


def test_an_output_without_strokes_is_refused_with_bounds_that_give_it_some():
    """With the frame the shortest link all links turn fully: a double crank."""
    bounds = {"l1": "[90, 120]", "l2": "[60, 160]", "l3": "[85, 160]"}
    error = refused("{of: stroke, least: 45 deg}", **bounds)
    assert error.path == ("synthesis", "constraints", 0, "least")
    assert error.message == "no mechanism within the bounds was found that has this quantity"
    assert error.allowed == "wider bounds, the nearest: l1 from 79.9898 mm"
    solved("{of: stroke, least: 45 deg}", **(bounds | {"l1": "[79.9898, 120]"}))


def test_bounds_that_only_let_the_crank_turn_are_told_as_such():
    """The crank turns from 75 mm of l3 on; that l1 + l2 + l3 and the frame are 200 mm at most is another matter."""
    bounds = {"l1": "[65, 70]", "l2": "[60, 70]", "l3": "[50, 70]"}
    error = refused("{of: length, most: 200 mm}", **bounds)
    assert error.path == ("synthesis", "vary", "l3", 1)
    assert error.message == "no mechanism within these bounds can go the whole way of its driver"
    assert error.allowed == "wider bounds, the nearest: l3 to 75.0051 mm"


CRANK_SLIDER = """tmm: 1
units: {{length: mm, angle: deg}}
synthesis: {{task: optimal, vary: {{r: {r}, l: {l}}}, objective: length, positions: 24}}
points: {{O: [0, 0]}}
guides: {{x: {{through: [0, 30], angle: 0}}}}
links:
  1: {{points: [O, A], length: r}}
  2: {{points: [A, B], length: l}}
  3: {{points: [B], slides: {{on: x}}}}
driver: {{link: 1, speed: 5 rad/s, acceleration: 20 rad/s^2}}
sketch: {{at: 60 deg, B: {B}}}
positions: {{count: 12, from: working stroke}}
"""


def slid(sketch, **bounds):
    return build(read_text(CRANK_SLIDER.format(B=sketch, **bounds), "x.yaml")).synthesis.outcome


def test_a_crank_that_starts_with_its_working_stroke_has_nearest_bounds_too():
    """l >= r + 30 mm: from r = 50 and l = 70 mm on by 10 mm, which is half the range of l and the whole one of r."""
    bounds = {"r": "[50, 60]", "l": "[50, 70]"}
    with pytest.raises(ProblemError) as caught:
        slid("[r*cos(60 deg) + l, 30]", **bounds)
    assert caught.value.allowed == "wider bounds, the nearest: l to 80.0101 mm"
    slid("[r*cos(60 deg) + l, 30]", **(bounds | {"l": "[50, 80.0101]"}))


def test_bounds_that_the_sketch_does_not_fit_are_told_with_that():
    with pytest.raises(ProblemError) as caught:
        slid("[300, 30]", r="[50, 60]", l="[50, 70]")
    assert caught.value.message == "no linkage within these bounds can be assembled as it is sketched"
    assert caught.value.allowed.startswith("wider bounds, the nearest: l to 80.0101 mm; and a sketch")


def test_what_fails_between_the_positions_of_the_search_is_not_told_as_nearest():
    """The lever 3 goes nearly round when its crank is nearly as long as the frame: too quickly for 24 positions."""
    text = text_of(
        "shaper", (r"  OA: 110\n", ""), (r"  OC: 350\n", ""),
        (r"points: \{O", "synthesis:\n  task: optimal\n  vary: {OA: [200, 220], OC: [150, 180]}\n"
         "  objective: length\n  positions: 24\npoints: {O"),
    )  # fmt: skip
    with pytest.raises(ProblemError) as caught:
        build(read_text(text, "x.yaml"))
    assert caught.value.allowed == "wider bounds, the nearest: OC to 222.017 mm"
