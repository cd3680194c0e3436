"""A single run of a machine that is given by its reduced inertia and moment, against what is known in closed form."""

from pathlib import Path

import numpy as np
import pytest

from tmm_cli import load, solve
from tmm_cli.mechanics.dynamics import (
    DriveProfile,
    KlossMotor,
    LinearMotor,
    RunTask,
    driver_acceleration,
    integrate_run,
    reduce_machine,
)
from tmm_cli.mechanics.errors import LongRunError, StandstillError
from tmm_cli.problem import ProblemError, build_any_problem, read_text
from tmm_cli.reports import collect_warnings, walk

PROBLEMS = Path(__file__).parents[1] / "problems"
TURN = 2 * np.pi


def machine(inertia=2.0, load=0.0, until=np.pi, ripple=0.0):
    def sample(x):
        own, slope = inertia + ripple * np.cos(2 * x), -2 * ripple * np.sin(2 * x)
        return own, slope, np.where(x < until, load, 0.0)

    return reduce_machine(sample, [0, until, TURN])


def test_a_constant_moment_speeds_a_rotor_up_evenly():
    found = integrate_run(machine(), RunTask(drive=lambda t, x: 6.0 + 0 * t))
    assert found.ending == "way"
    assert found.time[-1] == pytest.approx(np.sqrt(2 * TURN / 3), rel=1e-10)
    assert found.speed[-1] == pytest.approx(np.sqrt(2 * 3 * TURN), rel=1e-10)
    assert found.acceleration == pytest.approx(3.0 + 0 * found.time)


def test_a_brake_stops_a_rotor_where_its_energy_is_used_up():
    found = integrate_run(machine(), RunTask(speed=3.0, brake=4.0))
    assert found.ending == "standstill"
    assert found.way[-1] == pytest.approx(9 / 4, rel=1e-10)  # J w^2 / 2 over the moment
    assert found.time[-1] == pytest.approx(3 / 2, rel=1e-10)


def test_a_motor_of_direct_current_comes_to_its_speed_exponentially():
    found = integrate_run(machine(), RunTask(motor=LinearMotor(50.0, 10.0), longest=0.7))
    assert found.ending == "time"
    assert found.speed == pytest.approx(10 * (1 - np.exp(-50 / (2 * 10) * found.time)), rel=1e-9, abs=1e-12)


def test_a_trial_step_may_be_so_quick_that_its_square_is_infinite():
    found = driver_acceleration(machine(ripple=0.6), RunTask(), np.zeros(1), np.ones(1), np.array([1e200]))
    assert found == np.inf  # the step is not taken; a file with a drive of 1e9 over ten turns came to this


@pytest.mark.parametrize("times", [10, 1e3, 1e5])
def test_a_motor_too_strong_brings_its_machine_to_its_speed_without_load(times):
    found = integrate_run(machine(load=-80.0, ripple=0.6), RunTask(motor=LinearMotor(500.0 * times, 12.0)))
    assert found.ending == "way" and found.balance < 1e-10
    assert found.speed[-1] == pytest.approx(12.0, rel=0.1 / times)
    assert found.time[-1] == pytest.approx(TURN / 12.0, rel=1 / times)


@pytest.mark.parametrize(
    "task",
    [
        RunTask(motor=LinearMotor(500.0, 12.0)),
        RunTask(motor=KlossMotor(12.0, 300.0, 0.3), flywheel=3.0),
        RunTask(speed=10.0, brake=200.0),
        RunTask(drive=lambda t, x: 150 * np.exp(-t) + 5 * x),
        RunTask(drive=DriveProfile("time", (0.0, 0.4, 0.41, 9.0), (250.0, 250.0, 20.0, 20.0))),
    ],
)
def test_works_are_the_change_of_kinetic_energy(task):
    found = integrate_run(machine(load=-80.0, ripple=0.6), task)
    assert found.balance < 1e-10
    assert found.ending in ("way", "standstill")


@pytest.mark.parametrize("against", ["time", "way"])
def test_a_drive_that_jumps_is_constant_before_and_after(against):
    """J = 2: 6 N m give 3 rad/s2; from the jump on 50 N m give 25 rad/s2."""
    at = 0.8 if against == "time" else 3 * 0.8**2 / 2
    found = integrate_run(machine(), RunTask(drive=DriveProfile(against, (0.0, at, at, 99.0), (6.0, 6.0, 50.0, 50.0))))
    way, speed = 3 * 0.8**2 / 2, 3 * 0.8
    last = np.sqrt(speed**2 + 2 * 25 * (TURN - way))
    assert found.speed[-1] == pytest.approx(last, rel=1e-10)
    assert found.time[-1] == pytest.approx(0.8 + (last - speed) / 25, rel=1e-10)
    assert found.driven[-1] == pytest.approx(6 * way + 50 * (TURN - way), rel=1e-10)
    assert len(found.time) < 40  # the jump costs no small steps


def test_what_drives_less_than_the_load_does_not_start():
    with pytest.raises(StandstillError) as stands:
        integrate_run(machine(load=-80.0), RunTask(drive=lambda t, x: 79.0 + 0 * t))
    assert stands.value.place == 0


def test_a_place_of_the_way_is_passed_once_at_its_time_and_speed():
    own, task = machine(load=-80.0, ripple=0.6), RunTask(motor=LinearMotor(500.0, 12.0))
    found = integrate_run(own, task)
    time, speed = found.at(found.way[1:-1])
    assert time == pytest.approx(found.time[1:-1], rel=1e-9)
    assert speed == pytest.approx(found.speed[1:-1], rel=1e-9)
    assert np.isnan(found.at(np.array([7.0]))[0]).all()
    changes = driver_acceleration(own, task, time, found.way[1:-1], speed)
    assert changes == pytest.approx(found.acceleration[1:-1], rel=1e-7, abs=1e-6)


def test_a_lifted_boom_stores_the_work_of_the_oil_and_forces_follow_the_run():
    results = solve(load(PROBLEMS / "boom-lift.yaml"))
    run = results.running.run
    assert run.ending == "way" and run.balance < 1e-10
    pressed = 1963e-6 * np.trapezoid([4.6e6, 4.0e6, 3.2e6, 2.45e6], [0, 0.1, 0.24, 0.34])
    assert run.driven[-1] == pytest.approx(pressed, rel=1e-9)
    q = results.motion.q
    assert abs(results.motion.rate[0]) < 1e-12 and results.motion.acceleration[0] > 0  # kinetostatics at rest
    table = np.interp(q - 0.64, [0, 0.1, 0.24, 0.34], 1963e-6 * np.array([4.6e6, 4.0e6, 3.2e6, 2.45e6]))
    assert results.reactions.balance.force == pytest.approx(table, rel=1e-8)


def test_a_press_takes_its_blow_from_the_flywheel_and_the_motor():
    results = solve(load(PROBLEMS / "press-single-run.yaml"))
    found = results.running
    assert found.run.balance < 1e-10
    motor = found.task.motor.moment(np.abs(results.motion.rate))
    speeding = found.task.flywheel * results.motion.acceleration
    assert results.reactions.balance.moment == pytest.approx(motor - speeding, rel=1e-7, abs=1e-4)


def test_a_run_that_wants_very_many_steps_ends_with_what_it_came_to(monkeypatch):
    monkeypatch.setattr("tmm_cli.mechanics.dynamics.single_run.MOST_EVALUATIONS", 500)
    with pytest.raises(LongRunError) as stopped:
        integrate_run(machine(load=-2.0, ripple=1.5), RunTask(motor=LinearMotor(50.0, 10.0)))
    assert 0 < stopped.value.way < TURN and stopped.value.count == 500


def test_a_run_of_very_many_turns_is_refused():
    text = (PROBLEMS / "press-single-run.yaml").read_text().replace("from: -90, to: 270, s", "from: -90000, to: 270, s")
    with pytest.raises(ProblemError) as refused:
        build_any_problem(read_text(text, "press.yaml"))
    assert str(refused.value).split("\n", 1)[1] == (
        "  found:   -90000\n  allowed: an angle from the x axis of at most 20 turns"
    )


def test_a_run_too_slow_for_its_time_says_so_and_has_its_last_place():
    slow = "{run: {from: 90, to: 100, speed: 1e-9, drive: 1e-12}, flywheel: {inertia: 1e6}}"
    text = (PROBLEMS / "crank-slider.yaml").read_text() + f"\ndynamics: {slow}\n"
    results = solve(build_any_problem(read_text(text, "slow.yaml")))
    summary, law = walk(results, ("dynamics", "law-of-motion"))
    assert (
        summary.notes[0]
        == "reason for the end of the run: the given time of 3600 s ended before the travel was completed"
    )
    assert np.all(np.isfinite(law.columns[2].values))
    assert "3" not in {load.link for load in results.loads if load.has_moment}  # a slider, with nan where it is not
    assert any("the run of driver 1 ends before positions" in said for said in collect_warnings(results))


BOOM = (PROBLEMS / "boom-lift.yaml").read_text().split("dynamics:")[0]
DOWN = "from: 980, to: 640, drive: {against: way, area: 1963, table: [[0, 2 MPa], [340, 4.5 MPa]]}"


def lowered(run, *, speed="-40 mm/s"):
    text = f"{BOOM.replace('40 mm/s', speed)}dynamics: {{run: {{{run}}}}}\npositions: {{at: [640, 820, 980]}}\n"
    return solve(build_any_problem(read_text(text, "boom.yaml")))


def test_oil_that_carries_a_boom_on_its_way_down_resists_the_run():
    """Pressure is positive along the guide: what the weights do less what the oil takes is left as motion."""
    run = lowered(DOWN).running.run
    taken = 1963e-6 * (2e6 + 4.5e6) / 2 * 0.34
    assert run.driven[-1] == pytest.approx(-taken, rel=1e-9)
    lifting = solve(load(PROBLEMS / "boom-lift.yaml")).running.run.loaded[-1]
    assert run.loaded[-1] == pytest.approx(-lifting, rel=1e-9)
    assert run.kinetic[-1] == pytest.approx(-lifting - taken, rel=1e-7)
    assert run.speed[-1] == pytest.approx(1.305, abs=5e-4)  # 6 m/s where the oil pulled the boom down


def test_a_run_of_links_without_masses_is_refused():
    text = (PROBLEMS / "press-single-run.yaml").read_text().split("masses:")[0]
    tail = "gravity: 0\noutput: 3\ndynamics: {run: {from: 0, to: 30, drive: 40}}\npositions: {count: 4}\n"
    with pytest.raises(ProblemError) as refused:
        solve(build_any_problem(read_text(text + tail, "press.yaml")))
    assert str(refused.value).partition(": ")[2] == (
        "dynamics.run: the law of motion cannot be computed: no link that moves in this position "
        "has mass or moment of inertia\n"
        "  found:   driver coordinate: 0 deg\n"
        "  allowed: masses of the links, or flywheel: {inertia: 0.5}"
    )


def test_a_moment_of_a_crank_is_positive_counterclockwise_in_a_clockwise_run_too():
    text = (PROBLEMS / "press-single-run.yaml").read_text().split("loads:")[0]
    for sense, turns in ((1, "ccw"), (-1, "cw")):
        run = f"run: {{from: 90, to: {90 + sense * 30}, drive: {sense * 40}}}"
        tail = f"gravity: 0\noutput: 3\ndynamics: {{{run}}}\npositions: {{count: 4}}\n"
        results = solve(
            build_any_problem(read_text(text.replace("turns: ccw", f"turns: {turns}") + tail, "press.yaml"))
        )
        assert results.running.run.driven[-1] == pytest.approx(40 * np.radians(30), rel=1e-9)
        assert not [text for text in collect_warnings(results) if "the run goes" in text]
    with pytest.raises(ProblemError, match="the machine does not start") as refused:
        solve(build_any_problem(read_text(text + tail.replace("-40", "40"), "press.yaml")))
    assert "a larger `drive` (positive along the guide or counterclockwise)" in str(refused.value)


def of_the_run(results):
    return [text for text in collect_warnings(results) if "run " in text or "table of the driving moment" in text]


def test_a_run_against_the_driver_s_sense_is_warned_of():
    assert of_the_run(lowered(DOWN)) == []
    assert of_the_run(lowered(DOWN, speed="40 mm/s")) == [
        (
            "the run goes from 980 mm to 640 mm, opposite to the speed of driver 3: write `speed: "
            "-0.04 m/s` for this driver, or exchange `from` and `to`"
        )
    ]
    text = (PROBLEMS / "press-single-run.yaml").read_text().replace("turns: ccw", "turns: cw")
    assert of_the_run(solve(build_any_problem(read_text(text, "press.yaml")))) == [
        (
            "the run goes from -90 deg to 270 deg, counterclockwise, which is not the direction of "
            "driver 1: write `turns: ccw` for this driver, or exchange `from` and `to`"
        )
    ]


@pytest.mark.parametrize(
    ("table", "told"),
    [
        ("[[0, 2 MPa], [340, 4.5 MPa]]", []),
        ("[[0, 2 MPa], [500, 4.5 MPa]]", []),
        (
            "[[40, 2 MPa], [340, 4.5 MPa]]",
            [
                (
                    "the table of the driving moment or force begins at 40 mm: before that, its first value is used; "
                    "add a row at 0"
                )
            ],
        ),
        (
            "[[0, 2 MPa], [300, 4.5 MPa]]",
            [
                (
                    "the table of the driving moment or force ends at 300 mm: its last value is used up to 340 mm, the "
                    "end of the run; add a row there"
                )
            ],
        ),
        ("[[40, 0 MPa], [200, 2 MPa], [300, 0 MPa]]", []),  # nothing drives before and after
    ],
)
def test_a_drive_whose_table_is_too_short_for_the_run_is_warned_of(table, told):
    results = lowered(f"from: 980, to: 640, drive: {{against: way, area: 1963, table: {table}}}")
    assert of_the_run(results) == told


def test_a_table_by_time_that_ends_before_the_run_is_warned_of():
    results = lowered("from: 980, to: 640, drive: {against: time, table: [[0, 2 kN], [0.1, 4 kN]]}")
    lasts = f"{results.running.run.time[-1]:.6g}"
    assert of_the_run(results) == [
        "the table of the driving moment or force ends at 0.1 s: its last value is used up to "
        f"{lasts} s, the end of the run; add a row there"
    ]
