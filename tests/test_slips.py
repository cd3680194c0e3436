"""Slips of the pen in a problem file, and the one sentence that says what to write instead; or it is simply taken."""

from __future__ import annotations

import time
import warnings

import numpy as np
import pytest
from models import solved_text
from test_bad_input import changed, refusal

from tmm_cli.mechanics.quantities import ANGLE
from tmm_cli.problem import ExtendedUnits, ProblemError, build_problem, evaluate, read_text
from tmm_cli.synthesis import read_task, solve_alone

FOUR_BAR = """tmm: 1
points: {O: [0, 0], D: [300, 0]}
links:
  1: {points: [O, A], length: 100}
  2: {points: [A, B], length: 250}
  3: {points: [B, D], length: 200}
driver: {link: 1, speed: 1 rad/s}
sketch: {at: 60, B: [250, 190]}
"""
TWINS = "this name looks like another one but is written with different letters"
ARITHMETIC = "\n  allowed: numbers, units, parameters and the signs + - * / ^ ( )"
TOP = (
    "tmm, lang, title, description, reference, shows, units, parameters, synthesis, variants, grading, points, guides, "
    "links, hinges, driver, gears, racks, cams, springs, dampers, friction, sketch, change points, masses, loads, "
    "gravity, output, cycle, intermittent, positions, checks, dynamics, balancing, sheet, frame, note"
)


def told(old: str, new: str) -> str:
    assert old in FOUR_BAR
    return refusal(FOUR_BAR.replace(old, new))


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [  # here А, В, С, Е and О are Cyrillic
        (
            "1: {name: crank, points: [O, A]",
            "1: {name: crank, points: [O, А]",
            f"x.yaml:20:32: links.1.points[1]: {TWINS}\n  found:   'А'\n  did you mean 'A' in Latin letters?",
        ),
        (
            "points: [A], slides",
            "points: [А], slides",
            f"x.yaml:21:29: links.2.points[0]: {TWINS}\n  found:   'А'\n  did you mean 'A' in Latin letters?",
        ),
        (
            "points: [E], slides",
            "points: [Е], slides",
            f"x.yaml:24:27: links.5.points[0]: {TWINS}\n  found:   'Е'\n  did you mean 'E' in Latin letters?",
        ),
        (
            "along: CD",
            "along: СD",
            (
                "x.yaml:21:56: links.2.slides.along: expected two points of the same link\n"
                "  found:   'СD'\n"
                "  allowed: two of these points: C, D\n"
                "  did you mean 'CD' in Latin letters?"
            ),
        ),
    ],
)
def test_cyrillic_letters_in_the_names_of_points(old: str, new: str, message: str) -> None:
    assert refusal(changed(old, new)) == message


@pytest.mark.parametrize(
    ("key", "word", "place", "allowed"),
    [
        ("links", "звенья", "3:1: звенья", TOP),
        ("links", "članovi", "3:1: članovi", TOP),
        ("driver", "Привод", "7:1: Привод", TOP),
        ("length", "длина", "4:23: links.1.длина", "name, points, length, also, slides"),
    ],
)
def test_keys_in_another_language(key: str, word: str, place: str, allowed: str) -> None:
    message = f"x.yaml:{place}: unknown key\n  found:   '{word}'\n  allowed: {allowed}\n  did you mean '{key}'?"
    assert told(key, word) == message


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "tmm: 1\n",
            "",
            ("x.yaml:1:1: tmm: the key `tmm` is missing\n  allowed: version of the file format: write tmm: 1"),
        ),
        (
            "1 rad/s",
            "70 об.мин",
            "x.yaml:7:26: driver.speed: a unit is written without dots\n  found:   'об.мин'\n  allowed: об/мин",
        ),
        (
            "1 rad/s",
            "70 об./мин.",
            "x.yaml:7:26: driver.speed: a unit is written without dots\n  found:   'об./мин.'\n  allowed: об/мин",
        ),
        (
            "1 rad/s",
            "70 r.p.m.",
            "x.yaml:7:26: driver.speed: a unit is written without dots\n  found:   'r.p.m.'\n  allowed: rpm",
        ),
        (
            "at: 60",
            "at: pi/3 rad",
            (
                "x.yaml:8:14: sketch.at: expected here: an angle\n"
                "  found:   'pi/3 rad', a number (1.0472)\n"
                "  allowed: an angle, e.g. 30 deg or 0.5 rad; pi is already in radians"
            ),
        ),
        (
            "length: 100",
            "length: (40 + 60) mm",
            (
                "x.yaml:4:31: links.1.length: a unit must follow a number; write * 1 mm here\n"
                "  found:   '(40 + 60) mm', the error is at 'mm'"
            )
            + ARITHMETIC,
        ),
        (
            "at: 60",
            "at: atan2(1, 2)",
            (
                "x.yaml:8:14: sketch.at: an expression with a comma needs quotation marks here\n"
                "  found:   'atan2(1, 2)'\n"
                '  allowed: "atan2(1, 2)"'
            ),
        ),
        (
            "[300, 0]",
            "(300, 0)",
            ("x.yaml:2:24: points.D: expected two coordinates [x, y]\n  found:   '(300, 0)'\n  allowed: [300, 0]"),
        ),
        (
            "[300, 0]",
            "[hypot(300, 0), 0]",
            (
                "x.yaml:2:25: points.D[0]: an expression with a comma needs quotation marks here\n"
                "  found:   'hypot(300, 0)'\n"
                '  allowed: "hypot(300, 0)"'
            ),
        ),
    ],
)
def test_what_to_write_instead(old: str, new: str, message: str) -> None:
    assert told(old, new) == message


@pytest.mark.parametrize(
    ("lever", "found", "allowed"),
    [("5", "5", "5 %"), ("7.5", "7.5", "7.5 %"), ("120 %", "'120 %'", "0 to 1, or 0 to 100 %")],
)
def test_a_bare_per_cent_is_no_allowed_difference(lever: str, found: str, allowed: str) -> None:
    """`lever: 5` would allow the lever to differ from the force plan by 500 %."""
    assert told("tmm: 1\n", f"tmm: 1\nchecks: {{lever: {lever}}}\n") == (
        f"x.yaml:2:17: checks.lever: a fraction cannot be greater than 1\n  found:   {found}\n  allowed: {allowed}"
    )


def test_brackets_on_both_sides_of_a_comma_are_two_values() -> None:
    assert read_text("a: [2*cos(30), f(1)]\nb: {c: (1), d: (2)}", "f").data == {
        "a": ["2*cos(30)", "f(1)"],
        "b": {"c": "(1)", "d": "(2)"},
    }


@pytest.mark.parametrize("item", ["1", "(1"])
def test_long_lists_in_one_line_are_read_at_once(item: str) -> None:
    start = time.process_time()
    read_text(f"a: [{', '.join([item] * 20_000)}]", "f")
    assert time.process_time() - start < 5


@pytest.mark.parametrize(
    ("old", "new", "same"),
    [("at: 60", "at: pi rad", "at: 180"), ("1 rad/s", "2*pi rad/s", "60 rpm")],
)
def test_pi_may_have_a_unit(old: str, new: str, same: str) -> None:
    one, other = (build_problem(read_text(FOUR_BAR.replace(old, text), "x.yaml")).linkage for text in (new, same))
    assert np.isclose(one.sketch.at, other.sketch.at) and np.isclose(one.driver.rate, other.driver.rate)


def test_one_guide_one_position_and_one_place_need_no_list() -> None:
    short = changed("slides: {on: x}", "slides: x").replace("detail: [3]", "detail: 3")
    whole, problem = (build_problem(read_text(text, "x.yaml")) for text in (changed("OA: 110", "OA: 110"), short))
    assert (problem.linkage.slides, problem.request) == (whole.linkage.slides, whole.request)
    assert build_problem(read_text(FOUR_BAR + "positions: {at: 90}\n", "x.yaml")).request.places == (np.pi / 2,)


def test_a_place_that_a_search_varies_is_an_angle() -> None:
    task = "synthesis: {task: optimal, vary: {l: [80, 120], a0: [0, 90]}, objective: {of: path, point: B, at: [a0], "
    text = FOUR_BAR.replace("length: 100", "length: l") + task + "through: [[250, 190]]}}\n"
    with pytest.raises(ProblemError) as caught:
        read_task(read_text(text, "x.yaml"))
    assert str(caught.value) == (
        "x.yaml:9:100: synthesis.objective.at[0]: expected here: an angle\n  found:   'a0', a length (45 mm)\n"
        "  allowed: an angle, e.g. 30 deg or 0.5 rad"
    )


@pytest.mark.parametrize(
    ("task", "message"),
    [
        (
            "{task: crank-slider, stroke: 120, k: 0.11, pressure: 400}",
            (
                "x.yaml:2:49: synthesis.k: k must be 1 or more: it is the duration of the working stroke divided "
                "by that of the shorter return stroke\n"
                "  found:   0.11\n"
                "  allowed: other input data; changing this value alone does not help"
            ),
        ),
        (
            "{task: four-bar-by-k, l3: 120, k: 1.1, psi1: 1e-14, psi2: 0}",
            (
                "x.yaml:2:70: synthesis.psi2: the swing angle of the rocker must be greater than 0 and less than "
                "180 deg\n"
                "  found:   0\n"
                "  allowed: nearest feasible value: psi2: 5.72987e-05 deg"
            ),
        ),
    ],
)
def test_tasks_that_no_mechanism_meets_end_at_once(task: str, message: str) -> None:
    with pytest.raises(ProblemError) as caught:
        solve_alone(read_text(f"tmm: 1\nsynthesis: {task}\n", "x.yaml"))
    assert str(caught.value) == message


def test_the_group_that_was_sketched_wrong_is_blamed_and_not_a_later_one() -> None:
    assert refusal(changed("D: [0.23*CD, 0.97*CD - OC]", "D: [140, -680]")) == (
        "x.yaml:26:25: sketch.D: the sketch does not match any assembly of the mechanism\n"
        "  found:   [140, -680]\n"
        "  allowed: about [-148.829, -982.732] when the driver coordinate is 30 deg"
    )


@pytest.mark.parametrize(
    "call",
    [
        "sin(1e200*1e200)",
        "cos(1e200*1e200)",
        "tan(1e200*1e200)",
        "(1 mm)^(1e200*1e200 - 1e200*1e200)",
        "min(1, 1e200*1e200)",
        "1/(1e200*1e200)",
    ],
)
def test_no_step_of_arithmetic_leaves_the_numbers(call: str) -> None:
    message = f"x.yaml:4:31: links.1.length: this number is too large\n  found:   '{call}'"
    assert told("length: 100", f'length: "{call}"') == message


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        (
            "length: 100",
            "length: 1e306 km",
            "x.yaml:4:31: links.1.length: this number is too large\n  found:   '1e306 km'",
        ),
        (
            "length: 100",
            "length: 1e200",
            (
                "x.yaml:4:31: links.1.length: this value is too large for a mechanism\n"
                "  found:   1e200\n"
                "  allowed: 1e+15 mm or less"
            ),
        ),
        (
            "length: 100",
            "length: 1e-200",
            (
                "x.yaml:4:31: links.1.length: this value is too small for a mechanism\n"
                "  found:   1e-200\n"
                "  allowed: 1e-17 mm or more"
            ),
        ),
        (
            "1 rad/s",
            "1e160 rpm",
            (
                "x.yaml:7:26: driver.speed: this value is too large for a mechanism\n"
                "  found:   '1e160 rpm'\n"
                "  allowed: 1e+12 rad/s or less"
            ),
        ),
        (
            "at: 60",
            "at: 6e19",
            (
                "x.yaml:8:14: sketch.at: this value is too large for a mechanism\n"
                "  found:   6e19\n"
                "  allowed: 5.72958e+07 deg or less"
            ),
        ),
    ],
)
def test_sizes_that_no_mechanism_has(old: str, new: str, message: str) -> None:
    assert told(old, new) == message


@pytest.mark.parametrize("factor", ["1e9", "1e-15"])
def test_what_is_accepted_gives_no_warning(factor: str) -> None:
    text = FOUR_BAR.replace("1 rad/s", f"1 rad/s*{factor}")
    for number in ("300, 0", "100", "250", "200", "250, 190"):
        text = text.replace(number, ", ".join(f"{one}*{factor}" for one in number.split(", ")), 1)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert np.isfinite(solved_text(text).motion.poses["3"].z).all()


def test_a_bare_number_and_one_with_a_unit_have_the_same_decimals() -> None:
    written = "38.925549624985472123456789"
    bare = read_text(f"a: {written}", "f").data["a"]
    units = ExtendedUnits()
    assert evaluate(bare, {}, units, ANGLE) == evaluate(f"{written} deg", {}, units, ANGLE)


def test_a_guide_may_run_through_a_share_of_the_way_between_two_points() -> None:
    text = changed("along: CD", "through: {on: CD, at: 0.3}")
    assert build_problem(read_text(text, "x.yaml")).linkage.slides[0].through == pytest.approx(0.195)
    assert np.isfinite(solved_text(text).motion.poses["5"].x).all()


LOADED = (
    FOUR_BAR
    + """masses: {2: {mass: 2, inertia: 0.01, centre: {on: AB, at: 0.4}}}
loads: {F: {on: 3, at: {on: BD, at: 0.25}, force: [10, -20]}}
springs: {s: {between: [0, 3], at: [O, {on: DB, at: 0.5}], rate: 100, free: 50}}
"""
)


@pytest.mark.parametrize(
    ("old", "number", "at", "points"),
    [
        ("{on: AB, at: 0.4}", "110", "9:59: masses.2.centre", "AB"),
        ("{on: BD, at: 0.25}", "50", "10:37: loads.F.at", "BD"),
        ("{on: DB, at: 0.5}", "-40", "11:53: springs.s.at[1]", "DB"),
    ],
)
def test_a_bare_length_or_per_cent_is_no_share(old: str, number: str, at: str, points: str) -> None:
    place, _, where = at.partition(": ")
    new = old[: old.index("at: ")] + f"at: {number}}}"
    assert refusal(LOADED.replace(old, new)) == (
        f"x.yaml:{place}: {where}.at: expected a fraction of the distance from {points[0]} to {points[1]}\n"
        f"  found:   {number}\n"
        f"  allowed: e.g. 0.5, or {number} % if a percentage is meant; "
        f"for a distance from {points[0]} write {number} mm"
    )


def test_a_share_may_be_written_as_a_distance_from_the_first_point() -> None:
    lengths = LOADED.replace("tmm: 1", "tmm: 1\nparameters: {l3: 200 mm}")
    for share, length in (("on: AB, at: 0.4", "100 mm"), ("on: BD, at: 0.25", "5 cm"), ("on: DB, at: 0.5", "l3/2")):
        lengths = lengths.replace(share, f"{share[: share.index('at: ')]}at: {length}")
    one, other = (build_problem(read_text(text, "x.yaml")).linkage for text in (LOADED, lengths))
    assert other.links["2"].centre == pytest.approx(one.links["2"].centre, abs=1e-17)
    assert other.loads[0].at == pytest.approx(one.loads[0].at, abs=1e-17)
    assert other.elements[0].at_j == pytest.approx(one.elements[0].at_j, abs=1e-17)
