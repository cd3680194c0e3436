"""A crank whose speed is given by a table of its angle: squares of speeds are interpolated, their slope accelerates."""

import numpy as np
import pytest
from scipy.integrate import quad
from test_loads import MACHINE

from tmm_cli import prepare, solve
from tmm_cli.mechanics.accuracy import bound_values
from tmm_cli.problem import ProblemError, build_any_problem, read_text
from tmm_cli.reports import input_data_tables

BODIES = """masses: {2: {mass: 3 kg, inertia: 0.01, centre: {on: AB}}, 3: {mass: 2 kg}}
loads: {f: {on: 3, force: {resists: 100 N}}}
output: 3
"""


def solved(driver, tail=BODIES):
    text = MACHINE.replace("driver: {link: 1, speed: 60 rpm, turns: ccw}", f"driver: {{link: 1, {driver}}}") + tail
    return solve(build_any_problem(read_text(text, "x.yaml")))


def table(speed, step=15, between="smooth", end=360):
    rows = ", ".join(f"[{angle}, {speed(np.radians(angle)):.15g}]" for angle in range(0, end + 1, step))
    return f"speed: {{against: crank angle, between: {between}, table: [{rows}]}}"


def swaying(q):
    """A speed that a flywheel leaves: 10 rad/s with 1 rad/s of a second harmonic."""
    return 10 + np.cos(2 * q) + 0.3 * np.sin(q)


def refused(driver, tail=BODIES):
    with pytest.raises(ProblemError) as refusal:
        solved(driver, tail)
    return str(refusal.value)


@pytest.mark.parametrize("between", ["linear", "smooth"])
@pytest.mark.parametrize("sense", ["ccw", "cw"])
def test_speeds_of_a_constant_acceleration_give_what_that_acceleration_gives(between, sense):
    """Squares are linear in the angle: positions, reactions, times, over half a turn that begins at rest or not."""
    at = "positions: {at: [10, 45, 90, 135, 170]}" if sense == "ccw" else "positions: {at: [170, 135, 90, 45, 10]}"
    begins, way = (0.0, 1) if sense == "ccw" else (np.pi, -1)
    rows = table(lambda q: np.sqrt(16 + 2 * 5 * way * (q - begins)), between=between, end=180)
    first = float(np.sqrt(16 + 10 * np.radians(10)))
    by_table = solved(f"turns: {sense}, {rows}", BODIES + at)
    even = solved(f"turns: {sense}, speed: {first!r}, acceleration: 5", BODIES + at)
    assert by_table.motion.rate == pytest.approx(even.motion.rate, rel=1e-13)
    assert by_table.motion.acceleration == pytest.approx(even.motion.acceleration, rel=1e-11)
    assert by_table.motion.time == pytest.approx(even.motion.time, rel=1e-12, abs=1e-14)
    for pair in ("O", "A", "B", "x"):
        assert by_table.reactions.of(pair).force == pytest.approx(even.reactions.of(pair).force, rel=1e-11)
    assert by_table.reactions.balance.moment == pytest.approx(even.reactions.balance.moment, rel=1e-11)


@pytest.mark.parametrize("sense", ["ccw", "cw"])
def test_accelerations_are_half_the_slope_of_the_square_of_the_speed(sense):
    results = solved(f"turns: {sense}, {table(swaying)}", f"{BODIES}positions: {{count: 36, from: 5}}")
    q = results.motion.q
    assert np.abs(results.motion.rate) == pytest.approx(swaying(q), rel=3e-5)
    exact = swaying(q) * (-2 * np.sin(2 * q) + 0.3 * np.cos(q))
    assert results.motion.acceleration == pytest.approx(exact, abs=0.02 * np.max(np.abs(exact)))
    assert np.max(np.abs(results.energy.balance)) < 1e-10


def test_the_table_closes_over_the_cycle():
    """Speed and acceleration a turn later are the same, and the time is that of a turn more."""
    results = solved(table(swaying), f"{BODIES}positions: {{at: [0, 100, 359.999999999, 360, 460, 820]}}")
    rate, gain, time = results.motion.rate, results.motion.acceleration, results.motion.time
    assert rate[[3, 4, 5]] == pytest.approx(rate[[0, 1, 1]], rel=1e-12)
    assert gain[[2, 3, 4]] == pytest.approx(gain[[0, 0, 1]], rel=1e-8)
    turn = quad(lambda q: 1 / results.law.speed(np.array([q]))[0], 0, 2 * np.pi, epsabs=1e-13, limit=200)[0]
    assert time[[3, 4, 5]] - time[[0, 1, 1]] == pytest.approx([turn, turn, 2 * turn], rel=1e-10)


def test_time_passes_as_the_way_over_the_speed():
    results = solved(f"turns: cw, {table(swaying)}", f"{BODIES}positions: {{count: 8, from: 40}}")
    start = np.radians(40)
    passed = [quad(lambda x: 1 / swaying(start - x), 0, np.pi / 4 * k)[0] for k in range(8)]
    assert results.motion.time == pytest.approx(passed, rel=1e-4)


def test_accelerations_may_have_a_table_of_their_own():
    gains = "acceleration: {against: crank angle, between: linear, table: [[0, 5], [180, -5], [360, 5]]}"
    results = solved(f"{table(swaying)}, {gains}", f"{BODIES}positions: {{count: 4}}")
    assert results.motion.acceleration == pytest.approx([5, 0, -5, 0], abs=1e-12)
    backwards = solved(f"turns: cw, {table(swaying)}, {gains}", f"{BODIES}positions: {{count: 4}}")
    assert backwards.motion.acceleration == pytest.approx([-5, 0, 5, 0], abs=1e-12)


def test_a_driver_may_stand_in_a_position():
    """At rest links have no velocities, and accelerations by that of the driver alone."""
    rows = "speed: {against: crank angle, between: linear, table: [[0, 0], [180, 8], [360, 0]]}"
    results = solved(rows, f"{BODIES}positions: {{count: 4, from: 0}}")
    gain = 8**2 / np.pi / 2
    assert results.motion.rate == pytest.approx([0, 8 / np.sqrt(2), 8, 8 / np.sqrt(2)])
    assert results.motion.acceleration == pytest.approx([gain, gain, -gain, -gain])
    still = results.motion.named("B")
    assert np.all(results.motion.moving) and still.v[0] == 0
    assert still.a[0] == pytest.approx(still.first[0] * gain)
    assert np.all(np.isnan(results.motion.time))


@pytest.mark.parametrize("between", ["linear", "smooth"])
def test_digits_of_a_law_by_table_are_judged(between):
    values, digits = bound_values(solved(table(swaying, between=between)))
    worst = max(np.nanmax(bound / max(np.nanmax(np.abs(values[key])), 1)) for key, bound in digits.bound.items())
    assert worst < 1e-11


@pytest.mark.parametrize("between", ["linear", "smooth"])
def test_near_a_dead_position_the_speed_is_that_of_the_table(between):
    """A crank-slider whose crank is as long as its rod: its group is dead at 90 deg."""
    text = MACHINE.replace("length: 150", "length: 50").replace("B: [140, 0]", "B: [60, 0]").replace("at: 90", "at: 53")
    rows = "[[0, 4], [90, 6], [180, 8]]"
    law = f"driver: {{link: 1, speed: {{against: crank angle, between: {between}, table: {rows}}}}}"
    text = text.replace("driver: {link: 1, speed: 60 rpm, turns: ccw}", law)
    results = solve(build_any_problem(read_text(f"{text}{BODIES}positions: {{at: [45, 89.99999]}}\n", "x.yaml")))
    assert results.motion.where is not None and results.motion.where.tolist() == [False, True]
    if between == "linear":
        assert results.motion.rate[1] == pytest.approx(np.sqrt(16 + 20 * 89.99999 / 90), rel=1e-14)
    phi, omega = np.radians(89.99999), results.motion.rate[1]
    assert results.motion.named("B").v[1].real == pytest.approx(-0.1 * np.sin(phi) * omega, rel=1e-9)


def test_accelerations_may_jump_but_speeds_may_not():
    told = refused("speed: {against: crank angle, table: [[0, 4], [90, 4], [90, 6], [360, 4]]}")
    assert told == (
        "x.yaml:9:75: driver.speed.table[2][0]: the values in the first column must increase\n"
        "  found:   90\n"
        "  allowed: each value only once"
    )
    results = solved(
        "speed: {against: crank angle, table: [[0, 4], [360, 4]]}, "
        "acceleration: {against: crank angle, between: linear, table: [[0, 3], [90, 3], [90, -1], [360, 3]]}",
        BODIES + "positions: {at: [45, 90, 225]}",
    )
    assert results.motion.acceleration == pytest.approx([3, -1, 1])


def test_what_was_understood_of_it_is_told():
    driver = "speed: {against: crank angle, between: linear, table: [[0, 4], [180, 8], [360, 4]]}"
    told = next(one for one in input_data_tables(solved(driver).problem) if one.name == "speeds")
    assert told.notes == ("Between rows: constant acceleration between rows.",)
    assert [column.values[0] for column in told.columns] == ["0 deg", "4 rad/s", "7.63944 rad/s^2"]


@pytest.mark.parametrize(
    ("driver", "told"),
    [
        (
            "speed: {against: crank angle, table: [[0, 4], [180, -8], [360, 4]]}",
            (
                "x.yaml:9:71: driver.speed.table[1][1]: speeds in a table must not be negative, as the driver "
                "always rotates in one direction\n"
                "  found:   -8\n"
                "  allowed: zero or more; for clockwise rotation write turns: cw"
            ),
        ),
        (
            "speed: {against: crank angle, table: [[0, 4], [180, 8], [360, 5]]}",
            (
                "x.yaml:9:81: driver.speed.table[2][1]: the table covers the whole cycle, but its last value "
                "differs from the first\n"
                "  found:   5\n"
                "  allowed: 4, as in the first row"
            ),
        ),
        (
            "speed: {against: crank angle, table: [[0, 4], [180, 8], [400, 4]]}",
            (
                "x.yaml:9:76: driver.speed.table[2][0]: this row is never used: it lies more than one "
                "cycle after the first row\n"
                "  found:   400\n"
                "  allowed: at most 360 deg; for a longer cycle write cycle: 2 turns"
            ),
        ),
        (
            "speed: {against: crank angle, table: [[0, 4], [180, 8], [330, 5]]}",
            (
                "x.yaml:9:49: driver.speed.table: the table of speeds does not cover all positions\n"
                "  found:   the table covers 0 deg to 330 deg\n"
                "  allowed: a last row at 360 deg with the speed of the first row, or positions: {at: [...]} "
                "within the range of the table"
            ),
        ),
        (
            "speed: {against: crank angle, table: [[0, 4], [90, 0.1], [100, 9], [360, 4]]}",
            (
                "x.yaml:9:58: driver.speed.table[0][0]: the smooth curve through the squared speeds falls below "
                "zero between this row and the next\n"
                "  found:   0\n"
                "  allowed: write between: linear, or add rows between these two"
            ),
        ),
        (
            "speed: {against: crank angle, table: [[0, 4], [360, 4]]}, acceleration: 3",
            (
                "x.yaml:9:77: driver.acceleration: give speed and acceleration in the same way: as two values at "
                "position 0, or as two tables"
            ),
        ),
        (
            "speed: {against: crank angle, table: [[0, 0], [360, 0]]}",
            "x.yaml:9:49: driver.speed.table: the speed of the driver is zero in all rows",
        ),
    ],
)
def test_what_cannot_be_is_refused_with_its_place(driver, told):
    assert refused(driver) == told


@pytest.mark.parametrize(
    ("tail", "told"),
    [
        (
            "dynamics: {delta: 1/30}",
            (
                "x.yaml:9:19: driver.speed: a table of speeds and the block `dynamics` exclude each other: "
                "the law of motion is either given or computed\n"
                "  allowed: a single speed together with `dynamics`"
            ),
        ),
        (
            "grading: {answers: [{of: H}]}",
            (
                "x.yaml:9:19: driver.speed: for variants and optimization, give the motion of the driver by one "
                "speed and one acceleration, without tables and without `dynamics`\n"
                "  allowed: speed: 82 rpm"
            ),
        ),
    ],
)
def test_what_knows_one_speed_only_refuses_a_table(tail, told):
    assert refused("speed: {against: crank angle, table: [[0, 4], [180, 6], [360, 4]]}", tail) == told


def test_many_at_once_refuse_what_they_do_not_know():
    results = solved("speed: {against: crank angle, table: [[0, 4], [180, 6], [360, 4]]}")
    with pytest.raises(ProblemError, match="one speed and one acceleration"):
        prepare(results.problem)
