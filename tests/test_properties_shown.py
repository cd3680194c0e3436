"""Properties that a file shows: each number by another route, and what is said when it is not what was expected."""

from __future__ import annotations

import json
import math
import re

import numpy as np
import pytest
from models import PROBLEMS
from test_commands import tmm

from tmm_cli import load, solve
from tmm_cli.problem import ProblemError
from tmm_cli.reports import shown_properties, to_json

SLIDER = (PROBLEMS / "crank-slider-offset.yaml").read_text(encoding="utf-8")


def file_with(tmp_path, block, text=SLIDER):
    path = tmp_path / "shows.yaml"
    own = text.split("reference:")[0]  # what the file itself shows stands last
    path.write_text(f"{own}shows:\n  it: {block}\n", encoding="utf-8")
    return path


def value(tmp_path, block, name="crank-slider-offset", stage="forces"):
    text = (PROBLEMS / f"{name}.yaml").read_text(encoding="utf-8")
    (one,) = shown_properties(solve(load(str(file_with(tmp_path, block, text))), stage))
    return one.value


def test_in_a_position_and_over_the_way(tmp_path):
    at = value(tmp_path, "{of: phi of 1, at: 3}", "sine")
    assert math.cos(at) == pytest.approx(0, abs=1e-14)
    r, w = 0.09, 11.0
    assert value(tmp_path, "{of: v of 3 on 0, over: largest}", "sine") == pytest.approx(r * w, rel=1e-13)
    assert value(tmp_path, "{of: v of 3 on 0, over: least}", "sine") == pytest.approx(-r * w, rel=1e-13)
    assert value(tmp_path, "{of: a of 3 on 0, over: range}", "sine") == pytest.approx(2 * r * w * w, rel=1e-13)
    assert value(tmp_path, "{of: H, per: 2*r}", "sine") == pytest.approx(1, rel=1e-14)
    assert value(tmp_path, "{of: H, set: {r: 60}}", "sine") == pytest.approx(0.12, rel=1e-13)
    assert value(tmp_path, "{of: v of A, at: 2, per: v of 3 on 0}", "sine") == pytest.approx(1 / math.sin(math.pi / 3))


@pytest.mark.parametrize("name", ["gear-straight-line", "hanger", "settings/guide-setting", "tilter"])
def test_a_length_or_an_angle_that_is_rounding_is_told_as_none(name):
    values = {one.name: (one.value, one.expected) for one in shown_properties(solve(load(f"{PROBLEMS}/{name}.yaml")))}
    nothing = [value for value, expected in values.values() if expected == 0]
    assert nothing and not any(nothing)
    assert all(value == 0 or abs(value) > 1e-9 for value, __ in values.values())


def test_the_output_that_is_found_has_a_stroke_too(tmp_path):
    text = SLIDER.replace("output: 3\n", "")
    assert "output:" not in text
    (one,) = shown_properties(solve(load(str(file_with(tmp_path, "{of: H}", text)))))
    assert one.value == value(tmp_path, "{of: H}")


def test_an_angle_is_followed_past_half_a_turn(tmp_path):
    assert value(tmp_path, "{of: phi of 1, between: [1, 11]}", "sine") == pytest.approx(math.radians(300))
    assert value(tmp_path, "{of: phi of 1, over: range}", "crossed-slots") == pytest.approx(4 * math.pi)
    assert value(tmp_path, "{of: phi of 3, over: range}", "crossed-slots") == pytest.approx(2 * math.pi)


def test_the_way_on_which_a_quantity_changes_little(tmp_path):
    """s = r cos(phi) stays within h of an end while the crank is within acos(1 - h/r) of it."""
    way = value(tmp_path, "{of: x of E, at: 0, within: 9 mm}", "sine")
    assert way == pytest.approx(2 * math.acos(0.9), abs=1e-12)


def test_a_ratio_is_formed_before_its_extreme(tmp_path):
    """Sine mechanism: v of E over v of A is |sin(phi)|, from 0 to 1."""
    assert value(tmp_path, "{of: v of A, over: least, per: v of E}", "sine") == pytest.approx(1, rel=1e-13)
    assert value(tmp_path, "{of: v of E, over: largest, per: v of A}", "sine") == pytest.approx(1, rel=1e-13)
    assert value(tmp_path, "{of: v of E, over: least, per: v of A}", "sine") == pytest.approx(0, abs=1e-10)


def test_a_link_rotates_relative_to_another_one_by_the_difference_of_their_angles(tmp_path):
    """Crank and rod of a crank-slider: in half a turn from dead centre to dead centre the rod comes back."""
    for block in ("{of: phi of 2 on 1, between: [0, 6]}", "{of: phi of 1 on 2, between: [6, 0]}"):
        assert value(tmp_path, block, "crank-slider") == pytest.approx(-math.pi, rel=1e-12)


def test_a_number_that_holds_for_the_file_s_own_parameters_is_not_compared_with_others():
    """M_b of course-1 in position 3 is 186.4 N m with OA = 100 mm only; H of sine.yaml is 2 r with any r."""
    done = tmm("forces", PROBLEMS / "course-1.yaml", "--set", "OA=90")
    assert done.returncode == 0, done.stderr
    assert tmm("forces", PROBLEMS / "course-1.yaml").returncode == 0
    done = tmm("kinematics", PROBLEMS / "sine.yaml", "--set", "r=60")
    assert done.returncode == 0 and re.search(r"stroke +120 +120 ", done.stdout)


def test_a_hinge_that_breaks_gives_its_two_freedoms_back(tmp_path):
    assert value(tmp_path, "{of: W, without: B}", stage="structure") == 3


def test_an_expectation_that_is_not_met_ends_with_exit_code_1(tmp_path):
    done = tmm("kinematics", file_with(tmp_path, "{of: W, expected: 1}"))
    assert done.returncode == 0, done.stderr
    assert "Properties" in done.stdout
    done = tmm("kinematics", file_with(tmp_path, "{of: k, expected: 1.2}"))
    assert done.returncode == 1


@pytest.mark.parametrize(
    "command", [("forces",), ("forces", "--extremes"), ("kinematics", "--position", "2"), ("dynamics",)]
)
def test_what_ends_with_exit_code_1_is_shown_whatever_else_is(tmp_path, command):
    text = (PROBLEMS / "balanced-crank-slider.yaml").read_text(encoding="utf-8")
    done = tmm(*command, file_with(tmp_path, "{of: H, expected: 5}", text))
    assert done.returncode == 1, done.stderr
    assert "Properties" in done.stdout


def test_they_stand_in_result_json_as_far_as_stages_have_run(tmp_path):
    path = file_with(tmp_path, "{of: M_b, at: 0}")
    problem = load(str(path))
    assert to_json(solve(problem))["properties"][0]["value"] == pytest.approx(
        solve(problem).reactions.balance.moment[0]
    )
    assert to_json(solve(problem, "kinematics"))["properties"] == []
    json.dumps(to_json(solve(problem, "structure")))


def test_a_chain_without_dimensions_shows_its_counts(tmp_path):
    text = (PROBLEMS / "manipulator-open.yaml").read_text(encoding="utf-8")
    done = tmm("structure", file_with(tmp_path, "{of: m, expected: 1}", text))
    assert done.returncode == 0, done.stderr
    done = tmm("structure", file_with(tmp_path, "{of: W, expected: 6}", text))
    assert done.returncode == 1


@pytest.mark.parametrize(
    "block, message",
    [
        ("{of: v of Q, at: 1}", ("shows.it.of: unknown quantity\n  found:   'v of Q'\n")),
        ("{of: v of A, at: 99}", "shows.it.at: there is no position with this number\n  found:   99\n  allowed: 0 to "),
        (
            "{of: v of A}",
            (
                "shows.it.of: specify one position, two positions, or the whole travel of the driver\n"
                "  found:   'v of A'"
            ),
        ),
        ("{of: H, per: k}", ("shows.it.per: expected a quantity of the same dimension\n  found:   'k'")),
        (
            "{of: v of A, between: [0, 99]}",
            "shows.it.between[1]: there is no position with this number\n  found:   99\n",
        ),
        (
            "{of: H, over: range}",
            ("shows.it.over: this is a property of the whole mechanism, not of a position\n  found:   'H'"),
        ),
        (
            "{of: H, within: 2}",
            ("shows.it.within: this is a property of the whole mechanism, not of a position\n  found:   'H'"),
        ),
        (
            "{of: H, without: A}",
            (
                "shows.it.of: only properties of the structure can be computed with a hinge removed (`without`)\n"
                "  found:   'H'"
            ),
        ),
        ("{of: W, without: Q}", "shows.it.without: there is no hinge of that name\n  found:   'Q'"),
        ("{of: H, set: {Q: 3}}", "no parameter has this name\n  found:   'Q'"),
        ("{of: H, set: {l: 3}}", "shows.it.set: the file is not valid with these parameters: sketch.at: group "),
    ],
)
def test_slips_are_refused_at_their_place(tmp_path, block, message):
    with pytest.raises(ProblemError) as refused:
        shown_properties(solve(load(str(file_with(tmp_path, block)))))
    assert message in str(refused.value)
    assert np.isfinite(refused.value.mark.line if refused.value.mark else 0)
