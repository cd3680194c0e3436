"""Optimal synthesis within bounds that hold no mechanism: refused with the nearest bounds that hold one."""

from __future__ import annotations

import re

import pytest
from test_commands import ROOT
from test_synthesis_any_linkage import text_of

from tmm_cli import solve
from tmm_cli.problem.build import build
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.reader import read_text
from tmm_cli.synthesis import wider
from tmm_cli.synthesis.check import measured

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


def told(error, *names):
    """The bounds of an error, mm."""
    match = re.fullmatch(
        "wider bounds, the nearest: " + ", ".join(rf"{name} (\S+) mm" for name in names), error.allowed
    )
    assert match, error.allowed
    return [float(number) for number in match.groups()]


def test_a_crank_that_cannot_turn_is_refused_with_the_nearest_bound():
    """Grashof: l1 + 80 mm <= l2 + l3. By shares of the ranges l3 has the shortest way: to 65 + 80 - 70 = 75 mm."""
    bounds = {"l1": "[65, 70]", "l2": "[60, 70]", "l3": "[50, 70]"}
    error = refused(**bounds)
    assert error.path == ("synthesis", "vary", "l3", 1)
    assert error.message == "no mechanism within these bounds can go the whole way of its driver"
    (end,) = told(error, "l3 to")
    assert end == pytest.approx(75.0051, abs=2e-4)
    found = solved(**(bounds | {"l3": f"[50, {end}]"}))
    assert {v.name: round(float(v.value), 4) for v in found.found} == {"l1": 0.065, "l2": 0.07, "l3": 0.075}
    refused(**(bounds | {"l3": "[50, 74.99]"}))


def test_what_cannot_be_assembled_is_refused_with_the_nearest_bounds():
    """The frame is 80 mm, and l2 + l3 must reach from D to A everywhere: l2 from 80 + 20 - 21 = 79 mm on."""
    bounds = {"l1": "[20, 25]", "l2": "[30, 40]", "l3": "[20, 21]"}
    error = refused(**bounds)
    assert error.message == "no linkage within these bounds can be assembled as it is sketched"
    (end,) = told(error, "l2 to")
    assert end == pytest.approx(79.0391, abs=2e-4)
    solved(**(bounds | {"l2": f"[30, {end}]"}))
    refused(**(bounds | {"l2": "[30, 78.9]"}))


def test_an_output_without_strokes_is_refused_with_bounds_that_give_it_some():
    """With the frame the shortest link all links turn fully: a double crank."""
    bounds = {"l1": "[90, 120]", "l2": "[60, 160]", "l3": "[85, 160]"}
    error = refused("{of: stroke, least: 45 deg}", **bounds)
    assert error.path == ("synthesis", "constraints", 0, "least")
    assert error.message == "no mechanism within the bounds was found that has this quantity"
    (end,) = told(error, "l1 from")
    assert end == pytest.approx(79.9898, abs=1e-3)
    solved("{of: stroke, least: 45 deg}", **(bounds | {"l1": f"[{end}, 120]"}))


def test_a_link_that_cannot_turn_fully_is_refused_with_another_way_whatever_else_is_asked():
    """Slotted link 1 of the tangent mechanism goes from -90 to 90 deg: its slider has no stroke in a cycle."""
    text = (ROOT / "problems" / "tangent.yaml").read_text(encoding="utf-8")
    task = (
        "synthesis: {task: optimal, vary: {a: [60, 200]}, objective: moment, constraints: [{of: stroke, least: 200}]}"
    )
    text = text.replace("a: 120, ", "").replace("points: {O", f"{task}\npoints: {{O", 1)
    with pytest.raises(ProblemError) as caught:
        build(read_text(text, "x.yaml"))
    assert caught.value.message == "no mechanism within these bounds can go the whole way of its driver"
    assert "over: [from, to] or over: positions" in caught.value.allowed
    (found,) = build(read_text(text.replace("optimal,", "optimal, over: positions,"), "x.yaml")).synthesis.outcome.found
    assert float(found.value) == pytest.approx(0.1)  # 2 a tan(45 deg) = 200 mm


def file_with(name, edit, vary, more=""):
    """A file of the bank with an optimal synthesis of the largest balancing moment."""
    text = (ROOT / "problems" / f"{name}.yaml").read_text(encoding="utf-8").replace(*edit)
    task = f"synthesis: {{task: optimal, vary: {vary}, objective: moment, population: 8, generations: 3{more}}}\n"
    return build(read_text(text.replace("points: {", task + "points: {", 1), "x.yaml"))


def test_the_sketch_may_show_a_linkage_beyond_bounds_that_hold_another_of_the_same_assembly():
    """The cylinder's pivot lies so far from that of the lever that DB > 300 mm; the sketch shows AB = 250, DB = 160."""
    edit = ("AB: 250, DB: 160, ", "")
    with pytest.raises(ProblemError) as caught:
        file_with("cylinder", edit, "{AB: [20, 60], DB: [80, 200]}")
    (end,) = told(caught.value, "DB to")
    problem = file_with("cylinder", edit, f"{{AB: [20, 60], DB: [80, {end}]}}")
    assert all(m.met for m in measured(problem.synthesis.outcome, solve(problem, "kinematics")))


@pytest.mark.parametrize("over", ["[-95, 45]", "[-100, 100]", "[100, 170]", "[-90, 45]"])
def test_guides_that_become_parallel_on_the_way_are_no_way(over):
    """At 90 deg of the tangent mechanism the stone is infinitely far: the run is a tan(phi)."""
    with pytest.raises(ProblemError) as caught:
        file_with("tangent", ("a: 120, ", ""), "{a: [60, 200]}", f", over: {over}")
    assert caught.value.message == "no mechanism within these bounds can go the whole way of its driver"


def test_bounds_that_only_let_the_crank_turn_are_told_as_such():
    """The crank turns from 75 mm of l3 on; that all links are 170 mm at most is another matter."""
    bounds = {"l1": "[65, 70]", "l2": "[60, 70]", "l3": "[50, 70]"}
    error = refused("{of: length, most: 170 mm}", **bounds)
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


def test_bounds_are_told_though_the_sketch_shows_a_linkage_far_beyond_them():
    """B of the sketch lies 300 mm from O, which links of 60 and 80 mm do not reach: its assembly is theirs as well."""
    with pytest.raises(ProblemError) as caught:
        slid("[300, 30]", r="[50, 60]", l="[50, 70]")
    assert caught.value.message == "no linkage within these bounds can be assembled as it is sketched"
    assert told(caught.value, "l to") == [80.0101]
    found = slid("[300, 30]", r="[50, 60]", l="[50, 80.0101]")
    assert "synthesis_optimal.not_as_sketched" in found.notes
    assert found.sketch.points["B"].real > 0


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


def six_bar(bounds):
    """The six-bar of the structure example, whose slider lies just as far from D as B comes on the other side."""
    text = text_of(
        "six-bar", (r"OA: 100, AB: 350, ", ""),
        (r"points: \{O", f"synthesis: {{task: optimal, vary: {bounds}, objective: length}}\npoints: {{O"),
    )  # fmt: skip
    return build(read_text(text, "x.yaml"))


def test_a_search_that_is_stuck_where_a_rod_just_touches_is_begun_elsewhere():
    """With OA = 200 mm the rocker turns fully, and its rod lacks no more than the room there. Where the rocker swings,
    OA + OD <= AB + BD: AB from 200 + 400 - 250 = 350 mm on.
    """
    with pytest.raises(ProblemError) as caught:
        six_bar("{OA: [200, 220], AB: [250, 280]}")
    (end,) = told(caught.value, "AB to")
    assert end == pytest.approx(350.07, abs=0.002)
    assert six_bar(f"{{OA: [200, 220], AB: [250, {end}]}}").synthesis.outcome.found


def test_a_search_whose_work_is_at_an_end_says_so_and_tells_bounds_that_do(monkeypatch):
    work = wider.Work
    monkeypatch.setattr(wider, "Work", lambda: work(0.0))
    bounds = {"l1": "[65, 70]", "l2": "[60, 70]", "l3": "[50, 70]"}
    told = refused(**bounds).allowed
    assert told.startswith("wider bounds, the nearest found: ")
    assert told.endswith("; the search for nearer ones was cut short")
    for name, side, value in re.findall(r"(l\d) (from|to) (\S+) mm", told):
        low, high = bounds[name].strip("[]").split(", ")
        bounds[name] = f"[{value}, {high}]" if side == "from" else f"[{low}, {value}]"
    solved(**bounds)


def test_work_is_counted_in_places_times_candidates():
    work = wider.Work(1000.0)
    assert work.generations(40, 20.0) == 40
    assert (work.left, work.early) == (200.0, False)
    assert work.generations(400, 1.0) == 200
    assert work.early
    assert work.generations(400, 1.0) == wider.FEWEST
