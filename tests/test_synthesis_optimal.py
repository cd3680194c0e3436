"""Optimal synthesis: known optima, margins, the same answer of the same seed, refusals."""

from __future__ import annotations

import json
import re
from functools import cache

import numpy as np
import pytest
from test_commands import ROOT, tmm

from tmm_cli import solve
from tmm_cli.mechanics.numerics import locate_zero, window_peak
from tmm_cli.problem import ProblemError, read_text
from tmm_cli.synthesis import (
    OBJECTIVE_TOLERANCE,
    CrankSliderTask,
    LocalValues,
    build_synthesised,
    evolve,
    find_crank_slider,
    measure_demands,
    minimize_locally,
)

SLIDER = """
tmm: 1
parameters: {n1: 90 rpm}
synthesis:
  task: optimal
  vary: {OA: [30, 90], AB: [80, 400], e: [1, 80]}
OPTIONS
points: {O: [0, 0]}
guides: {x: {through: [0, -e], angle: 0}}
links:
  1: {points: [O, A], length: OA}
  2: {points: [A, B], length: AB}
  3: {points: [B], slides: {on: x}}
driver: {link: 1, speed: n1, turns: ccw}
sketch: {at: 60 deg, B: [OA/2 + AB, -e]}
masses:
  2: {mass: 2 kg, inertia: 0.01, centre: [0.4*AB, 0]}
  3: {mass: 5 kg, inertia: 0.02, centre: [0, 0]}
loads:
  F: {on: 3, at: B, force: [-2 kN, 0]}
output: 3
"""
ROD = """
  objective: {of: length, links: [2]}
  constraints: [{of: stroke, equal: 120}, {of: k, equal: 1.08}, {of: pressure, most: 32 deg}]
"""


@cache
def slider(options):
    return build_synthesised(read_text(SLIDER.replace("OPTIONS", options.strip("\n")), "x.yaml"))


def parameters(problem):
    return {name: value.value for name, value in problem.synthesis.outcome.parameters.items()}


@pytest.mark.parametrize("seed", ["", "  seed: 2\n"])
def test_the_shortest_rod_that_keeps_a_pressure_angle_is_that_of_the_closed_formula(seed):
    problem = slider(ROD + seed)
    known = find_crank_slider(CrankSliderTask(stroke=0.12, k=1.08, pressure=np.radians(32)))
    found = parameters(problem)
    assert [found["OA"], found["AB"], found["e"]] == pytest.approx([known.r, known.l, known.e], rel=1e-9)


def test_everything_that_was_asked_is_met_on_the_mechanism_and_margins_are_told():
    problem = slider(ROD)
    assert all(m.met for m in measure_demands(problem.synthesis.outcome, solve(problem, "kinematics")))
    (table,) = problem.synthesis.outcome.listings
    rows = {row[0]: row for row in table.rows}
    *__, bound, value, margin, unit, state = rows["largest pressure angle"]
    assert state == "active" and margin == 0 and value == pytest.approx(bound, abs=1e-9) and unit == "angle"
    assert rows["k: duration of the longer stroke divided by that of the shorter one"][-1] == "equality, satisfied"
    assert rows["sum of link lengths"][-1] == "objective"


def test_the_same_seed_gives_the_same_answer_to_the_last_bit():
    assert parameters(slider.__wrapped__(ROD)) == parameters(slider(ROD))


def test_least_pressure_angle_of_a_crank_slider_is_the_least_that_its_k_allows():
    from tmm_cli.synthesis import smallest_pressure, theta_of

    problem = slider("""
  objective: pressure
  constraints: [{of: stroke, equal: 120}, {of: k, equal: 1.3}]
""")
    best = problem.synthesis.outcome.demands[1].value
    assert best == pytest.approx(float(smallest_pressure(theta_of(1.3))), rel=1e-9)


FORCES = {
    "moment": ("{of: moment}", "N m"),
    "reaction": ("{of: reaction, pair: A}", "N"),
    "mass": ("mass", "kg"),
    "box": ("box", "m"),
    "margin": ("margin", ""),
    "speed": ("{of: speed, target: 0.4 m/s}", "m/s"),
    "law": ("{of: law, link: 3, at: [0, 60, 120], values: [300, 240, 180]}", "m"),
    "law, minimax": ("{of: law, link: 3, norm: largest, at: [0, 50, 100, 150], values: [300, 270, 210, 150]}", "m"),
    "path": ("{of: path, point: A, at: [0, 90], through: [[50, 0], [0, 60]]}", "m"),
}


@pytest.mark.parametrize("name", FORCES)
def test_every_objective_is_what_is_measured_on_the_analysed_mechanism(name):
    problem = slider(f"""
  objective: {FORCES[name][0]}
  constraints: [{{of: stroke, least: 100}}, {{of: pressure, most: 40 deg}}]
  generations: 60
""")
    for m in measure_demands(problem.synthesis.outcome, solve(problem, "kinematics")):
        assert m.met, (m.demand.text, m.demand.value, m.value)


def test_a_law_whose_first_angle_is_free_gives_back_the_linkage_that_it_was_read_off():
    q = np.radians([20, 80, 140, 200])
    runs = 40 * np.cos(q) + np.sqrt(150**2 - (40 * np.sin(q) + 20) ** 2)
    text = SLIDER.replace("e: [1, 80]}", "a0: [0 deg, 90 deg]}").replace("n1: 90 rpm", "n1: 90 rpm, e: 20")
    problem = build_synthesised(
        read_text(
            text.replace(
                "OPTIONS",
                f"""
  objective: {{of: law, link: 3, at: [a0, a0 + 60, a0 + 120, a0 + 180], values: {runs.tolist()}}}
  generations: 20
""",
            ),
            "x.yaml",
        )
    )
    assert list(parameters(problem).values()) == pytest.approx([0.04, 0.15, np.radians(20)], rel=1e-8)
    law = problem.synthesis.outcome.listings[1]
    assert [row[0] for row in law.rows] == pytest.approx(q, rel=1e-8)
    assert all(m.met for m in measure_demands(problem.synthesis.outcome, solve(problem, "kinematics")))


def test_a_law_may_leave_open_where_the_run_is_counted_from():
    q = np.radians([20, 60, 100, 140, 200, 290])
    runs = 40 * np.cos(q) + np.sqrt(150**2 - (40 * np.sin(q) + 20) ** 2)
    text = SLIDER.replace("e: [1, 80]}", "s0: [50, 300]}").replace("n1: 90 rpm", "n1: 90 rpm, e: 20")
    values = ", ".join(f"s0 + {run!r}" for run in (runs - runs[0]).tolist())
    problem = build_synthesised(
        read_text(
            text.replace(
                "OPTIONS",
                f"""
  objective: {{of: law, link: 3, at: [20, 60, 100, 140, 200, 290], values: [{values}]}}
  generations: 20
""",
            ),
            "x.yaml",
        )
    )
    assert list(parameters(problem).values()) == pytest.approx([0.04, 0.15, runs[0] / 1000], rel=1e-8)
    law = problem.synthesis.outcome.listings[1]
    assert [row[1] for row in law.rows] == pytest.approx(runs / 1000, rel=1e-8)
    assert all(m.met for m in measure_demands(problem.synthesis.outcome, solve(problem, "kinematics")))


def test_a_coupler_point_on_a_straight_line_comes_out_the_same_from_another_seed():
    text = (ROOT / "problems" / "crank-rocker-optimal.yaml").read_text(encoding="utf-8")
    found = build_synthesised(
        read_text(text.replace("objective:", "seed: 3\n  objective:"), "x.yaml")
    ).synthesis.outcome
    assert found.demands[1].value == pytest.approx(0.39599372e-3, rel=1e-7)


def test_what_is_found_is_assembled_though_the_sketch_is_far_from_it():
    # at its bound, the shortest rod lies far from where the file sketches B for rods of 240 mm
    text = SLIDER.replace("[OA/2 + AB, -e]", "[270, -20]").replace("OPTIONS", "  objective: box\n  generations: 40")
    problem = build_synthesised(read_text(text, "x.yaml"))
    (note,) = problem.synthesis.outcome.notes
    assert note.startswith("the sketch in the file does not match the mechanism found")
    assert all(m.met for m in measure_demands(problem.synthesis.outcome, solve(problem, "kinematics")))


def test_the_nearest_value_that_is_told_can_be_met():
    """The sine of the largest pressure angle is (r + e)/l: at least (85 + 1)/400 with a stroke of about 170 mm."""
    task = "  objective: box\n  constraints: [{of: pressure, most: VALUE}, {of: stroke, equal: 170}]\n"
    with pytest.raises(ProblemError) as caught:
        slider(task.replace("VALUE", "10 deg"))
    nearest = str(caught.value).partition("nearest feasible value: constraints[0].most: ")[2]
    assert float(nearest.split()[0]) == pytest.approx(np.degrees(np.arcsin(86 / 400)), rel=1e-5)
    problem = slider(task.replace("VALUE", nearest))
    assert all(m.met for m in measure_demands(problem.synthesis.outcome, solve(problem, "kinematics")))
    with pytest.raises(ProblemError):
        slider(task.replace("VALUE", f"{float(nearest.split()[0]) * 0.9999} deg"))


def with_constraints(name, edit, vary, constraints):
    """A file of the bank whose numbers vary, with the least sum of lengths under constraints."""
    text = (ROOT / "problems" / f"{name}.yaml").read_text(encoding="utf-8").replace(*edit)
    task = f"task: optimal, generations: 60, vary: {vary}, objective: length, constraints: [{constraints}]"
    task = f"synthesis: {{{task}}}\npoints: {{O"
    return build_synthesised(read_text(text.replace("points: {O", task, 1), "x.yaml")).synthesis.outcome


def test_constraints_that_contradict_one_another_are_refused_with_the_nearest_value_of_one():
    """Without offset the sine of the largest pressure angle is r/l, and the links are r + l long: 50/250, 300 mm."""
    task = "{{of: pressure, most: {}}}, {{of: length, least: {}}}"
    file = ("crank-slider", ("r: 60, l: 220, ", ""), "{r: [50, 60], l: [200, 250]}")
    with pytest.raises(ProblemError) as caught:
        with_constraints(*file, task.format("5 deg", "300 mm"))
    assert caught.value.path == ("synthesis", "constraints", 0, "most")
    told = re.fullmatch(r"nearest feasible value: constraints\[0\].most: (\S+ deg)", caught.value.allowed)[1]
    assert float(told.split()[0]) == pytest.approx(11.537, rel=1e-5)
    assert with_constraints(*file, task.format(told, "300 mm")).found
    with pytest.raises(ProblemError) as caught:
        with_constraints(*file, task.format("5 deg", "500 mm"))
    assert caught.value.allowed is None


def test_a_quantity_that_is_the_same_for_all_is_told_exactly():
    """The stroke of the Whitworth mechanism is 2 CD, wherever C lies."""
    file = ("whitworth", ("OC: 60, ", ""), "{OC: [43, 77]}")
    with pytest.raises(ProblemError) as caught:
        with_constraints(*file, "{of: stroke, equal: 239.7}")
    assert caught.value.allowed == "nearest feasible value: constraints[0].equal: 240 mm"
    assert with_constraints(*file, "{of: stroke, equal: 240}").found


REFUSED = {
    "  objective: pressure\n  constraints: [{of: stroke, equal: 10}]\n  generations: 20": (
        "within the bounds no mechanism was found that satisfies this"
    ),
    "  objective: presure": "there is no quantity with this name",
    "  objective: {of: reaction, pair: X}": "there is no pair of that name",
    "  objective: {of: path, point: A}": "the key `through` is missing",
    "  objective: {of: law, link: 3, at: [1, 2], values: [3]}": "must have the same number of values",
    "  objective: {of: mass, pair: A}": "the quantity mass has no key pair",
    "  objective: mass\n  constraints: [{of: k}]": "a constraint must have a bound",
    "  objective: mass\n  constraints: [{of: k, least: 2, most: 1}]": "the lower bound exceeds the upper bound",
    "  objective: mass\n  constraints: [{of: k, least: 2 mm}]": "expected here: a number",
}


@pytest.mark.parametrize("options", REFUSED)
def test_what_cannot_be_asked_is_refused(options):
    with pytest.raises(ProblemError) as caught:
        slider(options)
    assert REFUSED[options] in str(caught.value)


@pytest.mark.parametrize(
    ("vary", "words"),
    [
        ("{OA: [90, 30]}", "the first bound must be smaller than the second"),
        ("{OA: [-90, 30]}", "a length cannot be negative"),
        ("{OA: [30]}", "at least 2 are required here"),
        ("{n1: [30, 40]}", "is given, although"),
    ],
)
def test_bounds_that_cannot_be_are_refused(vary, words):
    text = SLIDER.replace("{OA: [30, 90], AB: [80, 400], e: [1, 80]}", vary).replace("OPTIONS", "  objective: mass")
    with pytest.raises(ProblemError) as caught:
        build_synthesised(read_text(text, "x.yaml"))
    assert words in str(caught.value)


def test_stopped_by_hand_it_gives_the_best_so_far():
    def stop(at, of):
        if at == 5:
            raise KeyboardInterrupt

    found = evolve(
        lambda x: (np.sum((x - 0.3) ** 2, axis=1), np.zeros(len(x))),
        3,
        population=30,
        generations=100,
        seed=1,
        progress=stop,
    )
    assert found.stopped and len(found.history) == 5 and found.objective[0] == min(found.objective)


def test_populations_that_have_gathered_in_a_wide_valley_make_room_for_one_that_finds_the_deep_one():
    def valleys(x):
        wide, deep = np.sum((x - 0.6) ** 2, axis=1), np.sum((x - 0.15) ** 2, axis=1)
        return np.minimum(1 + wide, 0.9 + 100 * deep), np.zeros(len(x))

    def found(generations):
        return [evolve(valleys, 2, population=60, generations=generations, seed=seed).objective[0] for seed in range(2)]

    assert max(found(60)) == pytest.approx(1.0, abs=1e-3)  # from the first populations alone
    assert found(1000) == pytest.approx([0.9] * 2, abs=1e-3)


def test_the_smallest_box_comes_out_the_same_from_two_seeds_although_points_take_turns_at_its_sides():
    boxes = [
        slider(f"""
  objective: box
  constraints: [{{of: stroke, least: 100}}, {{of: pressure, most: 40 deg}}]
  seed: {seed}
""")
        .synthesis.outcome.demands[1]
        .value
        for seed in (1, 2)
    ]
    assert boxes[0] == pytest.approx(boxes[1], rel=1e-9)


def test_a_start_that_cannot_be_assembled_all_round_is_left_as_it_is():
    def edge(x):
        return LocalValues(np.where(x[:, :1] > 0.5, np.nan, x[:, :1]), np.zeros((len(x), 0)), np.zeros((len(x), 0)))

    assert minimize_locally(edge, np.array([0.5])) == pytest.approx([0.5])


def test_polish_solves_a_problem_of_textbooks():
    # J. Nocedal, S. J. Wright, Numerical Optimization, 2nd ed., example 16.4: the answer is (1.4, 1.7); here in halves
    rows, bounds = np.array([[1, -2], [-1, -2], [-1, 2]]), np.array([-2, -6, -2])

    def square(x):
        apart = 2 * x - np.array([1, 2.5])
        return LocalValues(np.sum(apart**2, axis=1, keepdims=True), 2 * x @ rows.T - bounds, np.zeros((len(x), 0)))

    best = 2 * minimize_locally(square, np.array([0.5, 0.2]))
    assert np.sum((best - [1, 2.5]) ** 2) == pytest.approx(0.8, abs=OBJECTIVE_TOLERANCE)
    assert np.all(rows @ best - bounds >= -OBJECTIVE_TOLERANCE)
    # along the limit the objective grows by the square of the distance: the place is known to the root of it
    assert best == pytest.approx([1.4, 1.7], abs=np.sqrt(OBJECTIVE_TOLERANCE))
    # the largest of two parabolas is least where they are equal

    def both(x):
        return LocalValues(np.hstack([x**2, (x - 1) ** 2 + 0.5]), np.zeros((len(x), 0)), np.zeros((len(x), 0)))

    assert minimize_locally(both, np.array([0.2])) == pytest.approx([0.75], abs=1e-10)


def test_peaks_and_zeros_are_found_between_the_places():
    q = 0.37 + 0.0055 * np.arange(-16, 17) + np.array([[0.0], [0.002]])
    assert window_peak(np.cos(q - 0.371)) == pytest.approx([1, 1], abs=1e-14)
    assert q[:, 0] + 0.0055 * locate_zero(np.sin(q - 0.371)) == pytest.approx([0.371] * 2, abs=1e-13)


def test_the_history_of_the_search_is_drawn(tmp_path):
    file = tmp_path / "rod.yaml"
    file.write_text(SLIDER.replace("OPTIONS", ROD.strip("\n") + "\n  generations: 30"), encoding="utf-8")
    done = tmm("synthesis", file, "-o", tmp_path)
    assert done.returncode == 0, done.stderr
    folder = tmp_path / "rod"
    assert (folder / "synthesis-history.svg").exists()
    assert json.loads((folder / "synthesis.json").read_text(encoding="utf-8"))["met"] is True


CENTRIC = """tmm: 1
parameters: {n1: 60 rpm}
synthesis:
  task: optimal
  vary: {OA: [30, 90], AB: [80, 400]}
OPTIONS
points: {O: [0, 0]}
guides: {x: {through: O, angle: 0}}
links:
  1: {points: [O, A], length: OA}
  2: {points: [A, B], length: AB}
  3: {points: [B], slides: {on: x}}
driver: {link: 1, speed: n1, turns: ccw}
sketch: {at: 60 deg, B: [OA/2 + AB, 0]}
masses: {3: {mass: 5 kg, inertia: 0}}
loads: {F: {on: 3, at: B, force: [-2 kN, 0]}}
output: 3
"""


def centric(options):
    return parameters(build_synthesised(read_text(CENTRIC.replace("OPTIONS", options.strip("\n")), "x.yaml")))


def test_any_named_quantity_may_be_limited_by_its_largest_value_or_its_range():
    """The largest acceleration of a centric slider is r omega^2 (1 + r/l), its stroke 2 r."""
    limit, radius, omega = 3.0, 0.06, 2 * np.pi
    found = centric(
        "  objective: {of: length, links: [2]}\n"
        "  constraints: [{of: x of B, over: range, equal: 120}, {of: a of B, most: 3 m/s^2}]\n"
    )
    rod = radius / (limit / (radius * omega**2) - 1)
    assert [found["OA"], found["AB"]] == pytest.approx([radius, rod], rel=1e-8)


def test_a_named_reaction_as_objective_is_the_reaction_of_its_pair():
    rest = "\n  constraints: [{of: stroke, equal: 120}, {of: pressure, most: 20 deg}]\n"
    both = [centric(f"  objective: {quantity}{rest}") for quantity in ("{of: reaction, pair: B}", "R_23")]
    assert both[1] == pytest.approx(both[0], rel=1e-6)


@pytest.mark.parametrize(
    ("objective", "message"),
    [
        (
            "a of Q",
            "x.yaml:6:3: synthesis.objective.of: there is no quantity with this name\n"
            "  found:   'a of Q'\n"
            "  allowed: length, mass, box, pressure, moment, reaction, margin, stroke, k, speed, path, law; or a "
            "quantity of the mechanism in every position, e.g. v of E\n"
            "  did you mean 'a of B'?",
        ),
        (
            "{of: a of B, pair: A}",
            "x.yaml:6:27: synthesis.objective.pair: the quantity a of B has no key pair\n  allowed: over",
        ),
        (
            "{of: stroke, over: range}",
            "x.yaml:6:27: synthesis.objective.over: the quantity stroke has no key over\n  allowed: of",
        ),
    ],
)
def test_a_quantity_that_cannot_be_an_objective_is_refused(objective, message):
    with pytest.raises(ProblemError) as refusal:
        centric(f"  objective: {objective}\n")
    assert str(refusal.value) == message
