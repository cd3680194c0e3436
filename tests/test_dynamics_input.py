"""Mistakes in the blocks that ask for the law of motion, and what a run does not come to: one line says it."""

from __future__ import annotations

import numpy as np
import pytest

from tmm_cli import solve
from tmm_cli.problem import ProblemError, build_problem, read_text
from tmm_cli.reports import collect_warnings, find_slips

MACHINE = """tmm: 1
points: {O: [0, 0]}
guides: {x: {through: [0, 0]}}
links:
  1: {points: [O, A], length: 50}
  2: {points: [A, B], length: 200}
  3: {points: [B], slides: x}
masses: {1: {mass: 4, inertia: 0.02, centre: O}, 3: {mass: 2}}
loads: {f: {on: 3, force: {resists: 300 N}}}
"""
CRANK = "driver: {link: 1, speed: 600 rpm}\n"
INDUCTION = "kind: asynchronous, synchronous: 1500 rpm, moment: 20"


def refused(dynamics):
    with pytest.raises(ProblemError) as caught:
        solve(build_problem(read_text(f"{MACHINE}{CRANK}dynamics: {dynamics}\n", "x.yaml")))
    return str(caught.value)


@pytest.mark.parametrize(
    ("dynamics", "told"),
    [
        (
            "{mean speed: -60 rpm}",
            "x.yaml:11:24: dynamics.mean speed: an angular speed cannot be negative\n"
            "  found:   '-60 rpm'\n  allowed: more than zero",
        ),
        (
            "yes",
            (
                "x.yaml:11:11: dynamics: expected keys with values\n"
                "  found:   'yes'\n"
                "  allowed: mean speed, delta, motor, flywheel, run"
            ),
        ),
        (
            "{motor: {stall: 6}}",
            "x.yaml:11:12: dynamics.motor.kind: the key `kind` is missing\n  allowed: linear, asynchronous",
        ),
        (
            f"{{motor: {{{INDUCTION}, speed: 1430}}}}",
            (
                "x.yaml:11:82: dynamics.motor.speed: the rated speed must be less than the synchronous "
                "speed\n"
                "  found:   1430 = 1430 rad/s = 13655.5 rpm\n"
                "  allowed: less than 157.08 rad/s = 1500 rpm"
            ),
        ),
        (
            f"{{motor: {{{INDUCTION}, speed: 1430 rpm, overload: 0.5}}}}",
            (
                "x.yaml:11:102: dynamics.motor.overload: the breakdown torque cannot be less than the "
                "rated torque\n"
                "  found:   0.5\n"
                "  allowed: 1 or more"
            ),
        ),
        (
            "{motor: {kind: linear, stall: 60, free: 1500 rpm, moment: 20}}",
            (
                "x.yaml:11:61: dynamics.motor.moment: a motor of this kind requires other keys\n"
                "  found:   'moment'\n"
                "  allowed: stall, free"
            ),
        ),
        (
            "{flywheel: {shape: rim, height: 1.2}}",
            (
                "x.yaml:11:43: dynamics.flywheel.height: a rim of this height leaves no hole in the middle\n"
                "  found:   1.2\n"
                "  allowed: less than 1 (ratio to the mean diameter)"
            ),
        ),
        (
            "{run: {to: 90, drive: {against: time, table: [[0, 5], [1, 6]], area: 5 cm^2}}}",
            (
                "x.yaml:11:74: dynamics.run.drive.area: a pressure can drive only a piston, but this driver is a "
                "crank\n"
                "  found:   '5 cm^2'\n"
                "  allowed: a table of moments without `area`, or a slider as the driver"
            ),
        ),
    ],
)
def test_a_mistake_is_told_with_what_to_write_instead(dynamics, told):
    assert refused(dynamics) == told


def test_a_density_may_have_its_unit():
    bare, said = (
        build_problem(
            read_text(f"{MACHINE}{CRANK}dynamics: {{flywheel: {{density: {density}}}}}\n", "x.yaml")
        ).dynamics.size
        for density in (7200, "7.2 g/cm^3")
    )
    assert said.density == pytest.approx(bare.density) == 7200


def test_rest_in_a_table_of_speeds_needs_no_unit_and_other_bare_rows_are_told_by_their_largest():
    table = (
        "driver: {{link: 1, speed: {{against: crank angle, between: linear, table: [[0, 0], [90, {}], [180, 0]]}}}}\n"
    )
    at = "positions: {at: [0, 90, 180]}\n"
    named, bare = (
        list(find_slips(build_problem(read_text(MACHINE + table.format(speed) + at, "x.yaml"))))
        for speed in ("90 rpm", "90")
    )
    assert not any("no unit" in text for text in named)
    assert any("write `90 rad/s`, or `90 rpm` for revolutions per minute" in text for text in bare)


def test_positions_that_a_run_does_not_come_to_are_named():
    run = "dynamics: {run: {from: 90, to: 450, speed: 400 rpm}}\npositions: {count: 6}\nsketch: {at: 60, B: [220, 0]}\n"
    results = solve(build_problem(read_text(MACHINE + CRANK + run, "x.yaml")))
    stops = [text for text in collect_warnings(results) if "stops" in text]
    assert stops == [
        (
            "driver 1 slows down and stops: it does not reach positions 0, 1, 5, so there are no velocities "
            "and forces in them"
        )
    ]
    assert np.isfinite(results.motion.rate).tolist() == [False, False, True, True, True, False]


def test_a_driver_that_stands_has_no_fluctuation():
    text = f"{MACHINE}{CRANK}dynamics: {{delta: 0.02}}\n".replace("600 rpm", "0 rpm")
    with pytest.raises(ProblemError) as caught:
        build_problem(read_text(text, "x.yaml"))
    assert str(caught.value) == (
        "x.yaml:11:1: dynamics: the speed of the driver is zero, so the law of motion cannot be "
        "computed\n"
        "  allowed: mean speed"
    )
