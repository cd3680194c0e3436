"""Optimal synthesis over parameters that have some values only: lengths from a series, numbers of teeth, speeds."""

import itertools
import re

import numpy as np
import pytest
from models import file_of

from tmm_cli import solve
from tmm_cli.problem import ProblemError, read_text
from tmm_cli.synthesis import QUANTITIES, build_synthesised, longest_stroke, measure_problem, read_task


def measure(of, results, name=""):
    return QUANTITIES[of](name).measure(results, None)


def text_of(name, edits, task):
    text = file_of(name).read_text(encoding="utf-8")
    for old, new in edits:
        assert old in text, old
        text = text.replace(old, new, 1)
    return text.replace("points: {", f"synthesis:\n  task: optimal\n  {task}\npoints: {{", 1)


def best_of(text):
    """What is found, and what is measured on it."""
    results = solve(build_synthesised(read_text(text, "x.yaml")))
    assert measure_problem(results) and all(m.met for m in measure_problem(results))
    return {name: value.value for name, value in results.problem.synthesis.outcome.parameters.items()}, results


def with_numbers(text, **numbers):
    """The same file without its synthesis, with these parameters."""
    text = re.sub(r"synthesis:\n(  .*\n)+", "", text)
    given = ", ".join(f"{name}: {value}" for name, value in numbers.items())
    return solve(build_synthesised(read_text(text.replace("parameters: {", f"parameters: {{{given}, ", 1), "x.yaml")))


def test_of_lengths_from_a_series_the_best_pair_of_all_is_found():
    text = text_of(
        "crank-slider",
        (("r: 60, ", ""), ("l: 220, ", "")),
        "vary: {r: {from: 55, to: 75, step: 5}, l: {among: [180, 200, 220, 250]}}\n"
        "  objective: moment\n  constraints: [{of: pressure, most: 17 deg}, {of: stroke, least: 119}]",
    )
    found, results = best_of(text)
    values = {}
    for r, length in itertools.product((55, 60, 65, 70, 75), (180, 200, 220, 250)):
        one = with_numbers(text, r=r, l=length)
        if measure("pressure", one) <= np.radians(17) and measure("stroke", one) >= 0.119:
            values[r, length] = measure("moment", one)
    assert len(values) > 2
    best = min(values, key=values.get)
    assert (1000 * found["r"], 1000 * found["l"]) == pytest.approx(best, rel=1e-15)
    assert measure("moment", results) == pytest.approx(values[best], rel=1e-12)


def test_what_may_have_all_values_is_polished_beside_what_may_not():
    text = text_of(
        "crank-slider",
        (("r: 60, ", ""), ("l: 220, ", "")),
        "vary: {r: [50, 80], l: {from: 150, to: 300, step: 25}}\n  objective: length\n"
        "  constraints: [{of: stroke, least: 130}, {of: pressure, most: 20 deg}]\n  population: 30\n  generations: 40",
    )
    found, _ = best_of(text)
    assert (found["r"], found["l"]) == pytest.approx((0.065, 0.2), rel=1e-12)  # r/sin 20 is 190 mm: 200 is the next


FIVE_BAR = (("speed: 120 rpm", "speed: n2"), ("l: 180, ", ""))


def test_a_ratio_that_may_be_any_number_leaves_a_rocking_wheel_its_cycle():
    """Its partner swings, so all is back after a turn; bare bounds of a ratio are no lengths."""
    text = text_of(
        "sector-and-wheel",
        (("teeth: [120, 40], module: 2", "ratio: i"),),
        "vary: {i: [2, 4]}\n  objective: {of: stroke, target: 80}\n  population: 8\n  generations: 4",
    )
    found, results = best_of(text)
    assert 2 <= found["i"] <= 4 and results.strokes.travel == pytest.approx(0.08, rel=1e-9)


def test_bare_bounds_are_what_the_file_takes_them_for():
    text = text_of(
        "crank-slider",
        (("{on: AB, at: 0.35}", "{on: AB, at: share}"), ("r: 60, ", "")),
        "vary: {r: [50, 70], share: [0.2, 0.8]}\n  objective: moment",
    )
    assert {p.name: p.kind for p in read_task(read_text(text, "x.yaml")).parameters} == {
        "r": "length",
        "share": "number",
    }


def test_the_longest_of_many_strokes_may_lie_between_neither_of_the_extremes():
    ends = np.array([[0.0, 3.0, 1.0, 2.0, -1.0, 1.5]])
    run = np.concatenate([np.linspace(a, b, 9)[:-1] for a, b in itertools.pairwise([*ends[0], ends[0, 0]])])[None]
    assert np.ptp(run) == 4.0
    for shift in range(0, run.shape[1], 5):
        assert longest_stroke(np.roll(run, shift, axis=1), np.array([4.0]), turns=False)[0] == pytest.approx(
            3.0, abs=1e-15
        )


FREE = "n2: [60 rpm, 180 rpm]"
MESSAGES = {
    "any ratio": (
        FREE,
        ("the number of revolutions in a cycle depends on this parameter; it must be the same for all candidates"),
    ),
    "some ratios": (  # over two turns, three and one
        "n2: {among: [90 rpm, 80 rpm, 120 rpm]}",
        "the number of revolutions in a cycle depends on this",
    ),
    "no step": ("n2: {from: 60 rpm, to: 80 rpm}", "vary.n2: expected [low, high], {from, to, step} or {among: [...]}"),
    "both": ("n2: {from: 60 rpm, among: [2 rpm, 3 rpm]}", "expected [low, high], {from, to, step} or {among: [...]}"),
    "one value": ("n2: {among: [60 rpm]}", "with a single value the parameter does not vary", "found:   '60 rpm'"),
    "no value": (
        "n2: {among: []}",
        "vary.n2.among: a value is required here, but nothing is given",
        "list of values, instead of a range with a step",
    ),
    "misspelt": ("n2: {amogn: [60 rpm]}", "unknown key", "did you mean 'among'?"),
    "three bounds": ("n2: [1, 2, 3]", "expected two bounds", "for a list of values write {among: [...]}"),
    "a number": ("n2: 3", "expected [low, high], {from, to, step} or {among: [...]}", "found:   3"),
    "too many": (
        "l: {from: 1, to: 3e9, step: 1}",
        "the number of steps between the bounds must be from 1 to 9999",
        "found:   1",
    ),
    "endless": ("l: {from: 1, to: 1e15, step: 1e-9}", "between the bounds must be from 1 to 9999", "found:   1e-9"),
    "too large a step": (
        "l: {from: 1, to: 3, step: 5}",
        "the number of steps between the bounds must be from 1 to 9999",
        "found:   5",
    ),
    "the wrong way": (
        "l: {from: 9, to: 3, step: 5}",
        "the first bound must be smaller than the second",
        "found:   9 and 3",
    ),
    "refused by the file": ("l: {among: [0, 180, 200]}", "with l = 0 mm, n2 = "),
}


def test_a_driver_that_turns_one_way_or_the_other_is_judged_in_its_own_sense():
    """As fast forth as back, it meets the other crank at other places: the moments differ."""
    text = text_of(
        "five-bar",
        (("speed: 120 rpm, turns: cw", "speed: n2"), ("l: 180, ", "")),
        "vary: {n2: {among: [-120 rpm, 120 rpm]}, l: {among: [180, 200]}}\n  objective: moment",
    )
    values = {n2: measure("moment", with_numbers(text, n2=f"{n2} rpm", l=180)) for n2 in (-120, 120)}
    assert values[120] < 0.9 * values[-120]
    found, results = best_of(text)
    assert (found["n2"], found["l"]) == pytest.approx((4 * np.pi, 0.18), rel=1e-12)
    assert measure("moment", results) == pytest.approx(values[120], rel=1e-12)


FEW = "vary: {l1: {from: 61, to: 97, step: 6}, l2: {from: 300, to: 384, step: 28}}\n  "
WITH = "\n  constraints: [{of: stroke, least: 40 deg}, {of: pressure, most: 45 deg}]"


@pytest.mark.parametrize(
    "task, goal, better",
    [
        ("objective: {of: reaction, pair: B}" + WITH, lambda r: measure("reaction", r, "B"), (85, 300)),
        ("objective: box" + WITH, lambda r: measure("box", r), (85, 300)),
        ("objective: {of: stroke, target: 44 deg}", lambda r: abs(measure("stroke", r) - np.radians(44)), (91, 384)),
    ],
)
def test_of_few_values_none_is_better_though_peaks_lie_between_the_places_of_the_search(task, goal, better):
    text = text_of("crank-rocker", (("l1: 100, ", ""), ("l2: 350, ", "")), FEW + task)
    other = with_numbers(text, l1=better[0], l2=better[1])
    if WITH in task:  # its swing is just over 40 deg, which places 5 deg apart do not show
        assert measure("stroke", other) > np.radians(40) and measure("pressure", other) < np.radians(45)
    _, results = best_of(text)
    assert goal(results) <= goal(other) * (1 + 1e-12)
    outcome = results.problem.synthesis.outcome
    assert outcome.source == "evaluation of all candidates"
    assert {line.text for line in outcome.drawings[-1].lines} == {
        "candidates, evaluated at the positions of the search",
        "best candidate so far that satisfies the constraints",
        "best candidate after exact evaluation",
    }


def refusal_of(text):
    with pytest.raises(ProblemError) as caught:
        build_synthesised(read_text(text, "x.yaml"))
    return str(caught.value)


@pytest.mark.parametrize(
    "limit, key, value",
    [
        ("equal: 131", "equal", "132 mm"),
        ("least: 103, most: 107", "most", "108.001 mm"),
        ("least: 101, most: 107", "least", "100 mm"),
    ],
)
def test_where_few_values_do_the_nearest_stroke_that_is_told_does_it(limit, key, value):
    """Twice the crank, which is 50, 54, 58, 62, 66 or 70 mm long."""
    text = text_of(
        "crank-slider",
        (("r: 60, ", ""),),
        f"vary: {{r: {{from: 50, to: 70, step: 4}}}}\n  objective: length\n  constraints: [{{of: stroke, {limit}}}]",
    )
    said = refusal_of(text)
    assert f"nearest feasible value: constraints[0].{key}: {value}" in said
    old = limit if key == "equal" else next(part for part in limit.split(", ") if key in part)
    found, _ = best_of(text.replace(old, f"{key}: {value}"))
    assert 2 * found["r"] == pytest.approx(float(value.split()[0]) / 1000, abs=3e-6)


@pytest.mark.parametrize(
    "varies, said",
    [
        ("z: {among: [25, 25.5, 26]}", "a number of teeth must be a whole number"),
        ("z: {from: -25, to: 25, step: 1}", "a number cannot be zero"),
        (
            "z: {among: [25, 25.5, 26, 27]}",
            "with z = 25.5 the problem file is invalid: a number of teeth must be a whole number",
        ),
    ],
)
def test_numbers_that_the_file_refuses_are_told(varies, said):
    text = text_of(
        "gear-straight-line",
        (("teeth: [25, 25], module: 4", "teeth: [z, 20]"),),
        f"vary: {{{varies}}}\n  objective: length",
    )
    assert said in refusal_of(text)


@pytest.mark.parametrize("case", MESSAGES)
def test_what_varies_is_refused_at_its_place(case):
    varies, *said = MESSAGES[case]
    other = "l: [180, 200]" if varies.startswith("n2") else "n2: {among: [60 rpm, 120 rpm]}"
    text = text_of("five-bar", FIVE_BAR, f"vary: {{{varies}, {other}}}\n  objective: moment")
    told = refusal_of(text)
    assert all(words in told for words in said), told


def test_a_parameter_that_spoils_the_dimensions_of_a_passive_link_is_refused():
    """Only with DE = OC = 300 mm the second coupler holds nothing; one that both couplers rest on may vary."""
    task = "vary: {DE: [250, 320]}\n  objective: mass"
    with pytest.raises(ProblemError) as caught:
        build_synthesised(
            read_text(text_of("parallel-couplers", (("parameters: {DE: 300}", "parameters: {}"),), task), "x.yaml")
        )
    assert str(caught.value) == (
        "x.yaml:12:9: synthesis.vary: with every parameter in the middle of its bounds, link 1 "
        "cannot be a driver: pairs or other drivers already determine its motion\n"
        "  found:   W = 3*4 - 2*6 = 0; links with redundant constraints: 0, 1, 2, 3, 4\n"
        "  allowed: W = 1"
    )


def test_bounds_of_a_number_of_teeth_are_refused():
    text = text_of(
        "sector-and-wheel",
        (("teeth: [120, 40], module: 2", "teeth: [z1, 40]"),),
        "vary: {z1: [99.5, 140.2]}\n  objective: stroke",
    )
    assert "a number of teeth must be a whole number" in refusal_of(text)


def test_the_choice_is_not_settled_before_what_is_free_is_polished():
    """With k = 1.05 two cranks suit most couplers, and the smaller one of the longer coupler makes the least box."""
    varies = "vary: {{l2: {{among: [{}]}}, l1: [60, 110]}}\n  objective: box\n  constraints: [{{of: k, equal: 1.05}}]\n"
    edits = (("l1: 100, ", ""), ("l2: 350, ", ""))
    boxes = {}
    for values in ("340, 360, 370", "360, 370", "360, 360.5"):
        found, results = best_of(text_of("crank-rocker", edits, varies.format(values) + "  generations: 20"))
        boxes[values] = measure("box", results)
        assert "370" not in values or found["l2"] == pytest.approx(0.37)
    assert boxes["340, 360, 370"] == pytest.approx(boxes["360, 370"], rel=1e-9)
    assert boxes["360, 370"] < boxes["360, 360.5"]


def test_where_steps_hold_no_mechanism_that_is_said():
    edits, task = (("r: 60, ", ""), ("l: 220, ", "")), "vary: {{r: {}, l: {}}}\n  objective: moment"
    told = refusal_of(text_of("crank-slider", edits, task.format("{from: 80, to: 90, step: 5}", "{among: [40, 50]}")))
    assert "completes the range of its driver" in told or "can be assembled as the sketch shows" in told
