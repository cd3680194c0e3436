"""Optimal synthesis of linkages of every kind, by the tape or one by one."""

from __future__ import annotations

import re

import pytest
from models import file_of

from tmm_cli import solve
from tmm_cli.problem import ProblemError, read_text
from tmm_cli.synthesis import Candidates, build_synthesised, measure_demands, read_task


def text_of(name, *edits):
    text = file_of(name).read_text(encoding="utf-8")
    for pattern, new in edits:
        text, count = re.subn(pattern, new, text, count=1)
        assert count == 1, pattern
    return text


SHORT = "positions: 24\n  population: 8\n  generations: 3\n"
OPTIMAL = {
    "class III": ("press-class-iii", (("CE: 310, ", ""),), "{CE: [300, 325]}", "pressure", ""),
    "wheels": ("planet-on-rocker", (("DB: 200, ", ""),), "{DB: [150, 250]}", "moment", "{of: pressure, most: 50 deg}"),
    "stroke loads": (
        "shaper",
        ((r"  CD: 650\n", ""),),
        "{CD: [600, 700]}",
        "moment",
        "{of: stroke, most: 430}",
    ),
    "friction": (
        "crank-slider-offset",
        (
            ("output:", "friction: {coefficient: 0.12, radius: 10}\noutput:"),
            ("l: 190", "Q: 1"),
            (", acceleration: 20 rad/s.2", ""),
        ),
        "{l: [180, 260]}",
        "{of: reaction, pair: A}",
        "",
    ),
    "cylinder": (
        "cylinder",
        (("speed: v1}", "speed: v1, stroke: [0, 120]}"), ("AB: 250, ", "")),
        "{AB: [240, 270]}",
        "moment",
        "{of: stroke, least: 30 deg}",
    ),
    "cam": (
        "cam-lever",
        (("rise: 20", "rise: h"), ("rise: -20", "rise: -h")),
        "{h: [10 deg, 20 deg]}",
        "{of: stroke, target: 30}",
        "{of: k, most: 2}",
    ),  # it rests between its strokes
    "speed": (
        "crank-slider-offset",
        (("w0: 5 rad/s", "Q: 1"), (", acceleration: 20 rad/s.2", "")),
        "{w0: [30 rpm, 90 rpm]}",
        "{of: speed, target: 0.2 m/s}",
        "",
    ),
    "speed of an accelerated crank": (
        "crank-slider-offset",
        (("w0: 5 rad/s", "Q: 1"),),
        "{w0: [30 rpm, 90 rpm]}",
        "{of: speed, target: 0.4 m/s}",
        "",
    ),
    "accelerated from the working stroke on": (
        "crank-slider-offset",
        (("l: 190", "Q: 1"),),
        "{l: [180, 260]}",
        "moment",
        "",
    ),
    "accelerated clockwise": (
        "crank-slider-offset",
        (
            ("l: 190", "Q: 1"),
            ("turns: ccw", "turns: cw"),
            (", when: working stroke", ""),
            ("from: working stroke", "from: 40 deg"),
        ),
        "{l: [180, 260]}",
        "moment",
        "",
    ),
    "accelerated from a place that varies": (
        "crank-slider-offset",
        (("l: 190", "Q: 1"), (", when: working stroke", ""), ("from: working stroke", "from: a0")),
        "{l: [180, 260], a0: [10 deg, 80 deg]}",
        "moment",
        "",
    ),
    "accelerated through positions a turn farther on": (
        "crank-slider-offset",
        (
            ("l: 190", "Q: 1"),
            (", when: working stroke", ""),
            ("count: 12, from: working stroke, detail: .3.", "at: [380, 410, 460]"),
        ),
        "{l: [180, 260]}",
        "moment\n  over: positions",
        "",
    ),
    "acceleration": (
        "crank-slider-offset",
        (("20 rad/s.2", "eps"),),
        "{eps: [1 rad/s^2, 20 rad/s^2]}",
        "{of: speed, target: 0.3 m/s}",
        "",
    ),
    "output that turns on": (
        "whitworth",
        (
            ("OA: 150, ", ""),
            ("output: .link: 5", "output: {link: 3"),
            (", when: working stroke", ""),
            ("from: working stroke", "from: 0"),
        ),
        "{OA: [130, 170]}",
        "{of: stroke, target: 230}\n  over: [0, 250]",
        "",
    ),
    "slider through its positions": ("clamp", (("AB: 200, ", ""),), "{AB: [195, 205]}", "moment", ""),
}


def block(vary, objective, constraint):
    return (
        f"synthesis:\n  task: optimal\n  vary: {vary}\n  objective: {objective}\n  constraints: [{constraint}]\n"
        f"  {SHORT}points: {{"
    )


@pytest.mark.parametrize("kind", OPTIMAL)
def test_what_is_found_for_any_linkage_is_measured_on_it(kind):
    name, edits, *task = OPTIMAL[kind]
    problem = build_synthesised(read_text(text_of(name, *edits, (r"points: \{", block(*task))), "x.yaml"))
    for m in measure_demands(problem.synthesis.outcome, solve(problem, "kinematics")):
        assert m.met, (m.demand.text, m.demand.value, m.value)


def test_a_stroke_has_no_k():
    edits = (("speed: v1}", "speed: v1, stroke: [0, 120]}"), ("AB: 250, ", ""))
    with pytest.raises(ProblemError) as caught:
        build_synthesised(
            read_text(text_of("cylinder", *edits, (r"points: \{", block("{AB: [240, 270]}", "k", ""))), "x.yaml")
        )
    assert "this quantity is defined only for a continuously rotating driver" in str(caught.value)
    law = "{of: law, link: 3, at: [0, 130], values: [10, 50]}"
    with pytest.raises(ProblemError) as caught:
        build_synthesised(
            read_text(text_of("cylinder", *edits, (r"points: \{", block("{AB: [240, 270]}", law, ""))), "x.yaml")
        )
    assert "the driver does not reach this position" in str(caught.value) and "0 to 120 mm" in str(caught.value)
    for over, said, allowed in (
        ("cycle", "the range cycle is not defined for this driver", "stroke, positions, [from, to]"),
        ("[10, 130]", "the driver does not reach this position", "positions from 0 to 120 mm"),
        (
            "[30, 20]",
            "the first value must be smaller than the second, and the difference at most one revolution",
            "[from, to]",
        ),
    ):
        with pytest.raises(ProblemError) as caught:
            text = text_of(
                "cylinder", *edits, (r"points: \{", block("{AB: [240, 270]}", f"moment\n  over: {over}", ""))
            )
            build_synthesised(read_text(text, "x.yaml"))
        assert caught.value.message == said and caught.value.allowed == allowed
    with pytest.raises(ProblemError) as caught:
        text = text_of(
            "cylinder",
            edits[1],
            ("at: .0, 20.*120., detail: .3.", "count: 12"),
            (r"points: \{", block("{AB: [240, 270]}", "mass", "")),
        )
        build_synthesised(read_text(text, "x.yaml"))
    assert "the range of the driver is missing" in str(caught.value)


def test_a_ratio_of_wheels_that_is_written_with_what_varies_may_stay_the_same():
    """The radii 3 OA/2 and OA/2 roll alike for every OA: the cycle is the same for all."""
    text = text_of("three-lobes", ("OA: 100, ", ""), (r"points: \{", block("{OA: [90, 110]}", "box", "")))
    assert Candidates(read_task(read_text(text, "x.yaml"))).closed
    with pytest.raises(ProblemError) as caught:
        build_synthesised(read_text(text.replace("3*OA/2, OA/2", "OA + 50 mm, 50 mm"), "x.yaml"))
    assert caught.value.message == (
        "the number of revolutions in a cycle depends on this parameter; it must be the same for all candidates"
    )


def refused(name, edits, *task):
    with pytest.raises(ProblemError) as caught:
        build_synthesised(read_text(text_of(name, *edits, (r"points: \{", block(*task))), "x.yaml"))
    return caught.value


@pytest.mark.parametrize("objective", ["moment", "length"])
def test_forces_of_a_driver_that_stops_on_its_way_are_refused(objective):
    """w^2 = 5^2 - 2*20*angle is zero after 0.625 rad: the crank does not come round."""
    edits = (
        ("l: 190", "Q: 1"),
        ("20 rad/s.2", "-20 rad/s^2"),
        (", when: working stroke", ""),
        ("from: working stroke", "from: 40 deg"),
    )
    limit = "{of: reaction, pair: A, most: 5 kN}"
    error = refused("crank-slider-offset", edits, "{l: [180, 260]}", objective, limit)
    assert error.path == (
        ("synthesis", "objective") if objective == "moment" else ("synthesis", "constraints", 0, "most")
    )
    assert error.message.startswith("with this acceleration the driver does not reach all positions")
    assert error.found == ("'moment'" if objective == "moment" else "'5 kN'")


def test_a_cycle_that_rests_on_what_varies_is_none_to_search_over():
    """Drivers of 50 and 120 rpm come round after 5 turns, of 51 and 120 rpm after 17."""
    edits = (("link: 1, speed: 60 rpm", "link: 1, speed: n"),)
    error = refused("five-bar", edits, "{n: [50 rpm, 70 rpm]}", "moment", "")
    assert error.path == ("synthesis", "vary", "n")
    assert error.message == (
        "the number of revolutions in a cycle depends on this parameter; it must be the same for all candidates"
    )
    both = (*edits, ("speed: 120 rpm", "speed: 2*n"))
    text = text_of("five-bar", *both, (r"points: \{", block("{n: [50 rpm, 70 rpm]}", "moment", "")))
    assert Candidates(read_task(read_text(text, "x.yaml"))).closed
