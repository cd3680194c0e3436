"""Optimal synthesis within bounds that hold no mechanism is refused, and the place to look at is told."""

from __future__ import annotations

import pytest
from test_commands import ROOT

from tmm_cli.problem import ProblemError, read_text
from tmm_cli.synthesis import build_synthesised

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
    return build_synthesised(read_text(FOUR_BAR.format(constraint=constraint, **bounds), "x.yaml")).synthesis.outcome


def refused(constraint="", **bounds):
    with pytest.raises(ProblemError) as caught:
        solved(constraint, **bounds)
    return caught.value


NEVER = (
    "no mechanism within these bounds completes the range of its driver. Widen the bounds, or give "
    "another range with the key over"
)


def test_a_crank_that_cannot_turn_is_refused():
    """Grashof: l1 + 80 mm <= l2 + l3. With l1 = 65 and l2 = 70 mm from l3 = 75 mm on."""
    bounds = {"l1": "[65, 70]", "l2": "[60, 70]", "l3": "[50, 74.99]"}
    error = refused(**bounds)
    assert (error.path, error.message) == (("synthesis", "vary"), NEVER)
    found = solved(**(bounds | {"l3": "[50, 75.01]"}))
    assert {v.name: round(float(v.value), 4) for v in found.found} == {"l1": 0.065, "l2": 0.07, "l3": 0.075}


def test_what_cannot_be_assembled_is_refused():
    """The frame is 80 mm, and l2 + l3 must reach from D to A."""
    error = refused(l1="[20, 25]", l2="[30, 40]", l3="[20, 21]")
    assert error.message == "within these bounds no linkage can be assembled as the sketch shows"


def test_an_output_without_strokes_is_refused_at_its_constraint():
    """With the frame the shortest link all links turn fully: a double crank; with l1 below 80 mm it rocks."""
    bounds = {"l1": "[90, 120]", "l2": "[60, 160]", "l3": "[85, 160]"}
    error = refused("{of: stroke, least: 45 deg}", **bounds)
    assert error.path == ("synthesis", "constraints", 0, "least")
    assert error.message == "within the bounds no mechanism was found for which this quantity is defined"
    solved("{of: stroke, least: 45 deg}", **(bounds | {"l1": "[60, 120]"}))


def test_a_link_that_cannot_turn_fully_is_refused_with_another_way_whatever_else_is_asked():
    """Slotted link 1 of the tangent mechanism goes from -90 to 90 deg: its slider has no stroke in a cycle."""
    text = (ROOT / "problems" / "tangent.yaml").read_text(encoding="utf-8")
    task = (
        "synthesis: {task: optimal, vary: {a: [60, 200]}, objective: moment, constraints: [{of: stroke, least: 200}]}"
    )
    text = text.replace("a: 120, ", "").replace("points: {O", f"{task}\npoints: {{O", 1)
    with pytest.raises(ProblemError) as caught:
        build_synthesised(read_text(text, "x.yaml"))
    assert caught.value.message == NEVER
    (found,) = build_synthesised(
        read_text(text.replace("optimal,", "optimal, over: positions,"), "x.yaml")
    ).synthesis.outcome.found
    assert float(found.value) == pytest.approx(0.1)  # 2 a tan(45 deg) = 200 mm


def file_with(name, edit, vary, more=""):
    """A file of the bank with an optimal synthesis of the largest balancing moment."""
    text = (ROOT / "problems" / f"{name}.yaml").read_text(encoding="utf-8").replace(*edit)
    task = f"synthesis: {{task: optimal, vary: {vary}, objective: moment, population: 8, generations: 3{more}}}\n"
    return build_synthesised(read_text(text.replace("points: {", task + "points: {", 1), "x.yaml"))


@pytest.mark.parametrize("over", ["[-95, 45]", "[-100, 100]", "[100, 170]", "[-90, 45]"])
def test_guides_that_become_parallel_on_the_way_are_no_way(over):
    """At 90 deg of the tangent mechanism the stone is infinitely far: the run is a tan(phi)."""
    with pytest.raises(ProblemError) as caught:
        file_with("tangent", ("a: 120, ", ""), "{a: [60, 200]}", f", over: {over}")
    assert caught.value.message == NEVER
