"""A cycle of several turns: loads come again after them, and all that is summed up goes over all of them."""

import numpy as np
import pytest
from test_loads import MACHINE, load, refused, solved, work_of_cycle

from tmm_cli import prepare
from tmm_cli.reports import find_slips

AREA = 1e-3  # m2
FOUR_STROKES = """cycle: 2 turns
loads:
  power: {on: 3, area: 1000, when: [180, 360],
          pressure: {angle: 0, against: stroke, table: [[0, 30 bar], [100, 4 bar]]}}
  exhaust: {on: 3, area: 1000, when: [360, 540], pressure: {angle: 0, size: 1.2 bar}}
  intake: {on: 3, area: 1000, when: [540, 720], pressure: {angle: 0, size: 0.9 bar}}
  compression: {on: 3, area: 1000, when: [0, 180],
                pressure: {angle: 0, against: stroke, table: [[0, 9 bar], [100, 1 bar]]}}
positions: {count: 24, from: 180}
"""


def test_work_over_two_turns_is_the_work_that_the_diagram_indicates():
    results = solved(FOUR_STROKES)
    power, compression = (30 + 4) / 2, (9 + 1) / 2
    indicated = AREA * 1e5 * 0.1 * (power - 1.2 + 0.9 - compression)
    assert work_of_cycle(results) == pytest.approx(indicated, rel=1e-12)


def test_positions_and_strokes_go_over_both_turns():
    results = solved(FOUR_STROKES)
    assert results.turns == 2 and len(results.strokes.strokes) == 4
    assert np.degrees(results.motion.q) == pytest.approx(180 + 30 * np.arange(24))
    assert np.all(load(results, "power").force[6:] == 0) and np.all(load(results, "power").force[:6] != 0)
    place, speed = results.motion.named("B").x, results.motion.named("B").v
    assert place[:12] == pytest.approx(place[12:]) and speed[:12] == pytest.approx(speed[12:])


@pytest.mark.parametrize("turns", ["ccw", "cw"])
def test_a_table_by_the_crank_goes_over_both_turns(turns):
    results = solved(
        "cycle: 720 deg\nloads: {m: {on: 1, moment: {against: crank angle, table: [[0, 1], [360, 5], [720, 1]]}}}\n"
        "positions: {count: 8, from: 90}",
        turns,
    )
    angles = np.degrees(results.motion.q) % 720
    assert load(results, "m").moment == pytest.approx(1 + 4 * (1 - np.abs(angles - 360) / 360))
    assert abs(work_of_cycle(results)) == pytest.approx(3 * 4 * np.pi, rel=1e-12)


def test_a_flywheel_evens_out_both_turns():
    results = solved(f"{FOUR_STROKES}dynamics: {{delta: 1/50}}")
    steady = results.running.steady
    assert steady.machine.length == pytest.approx(4 * np.pi)
    assert steady.delta == pytest.approx(1 / 50, rel=1e-10)
    assert steady.moment == pytest.approx(-steady.machine.work_of_cycle / (4 * np.pi), rel=1e-12)


def test_many_at_once_are_as_one_alone():
    results = solved(FOUR_STROKES)
    batch = prepare(results.problem)
    assert batch(results.motion.q)["T.1"] == pytest.approx(results.reactions.balance.moment, rel=1e-9, abs=1e-9)


def test_a_load_of_the_working_stroke_is_told_to_act_in_each_of_them():
    results = solved("cycle: 2 turns\nloads: {f: {on: 3, force: [-9, 0], when: working stroke}}")
    assert list(find_slips(results.problem)) == [
        ("load f acts in every working stroke of the cycle (turns: 2): select one of them with `when: [from, to]`")
    ]


@pytest.mark.parametrize(
    ("tail", "told"),
    [
        (
            "cycle: 1.5 turns",
            (
                "x.yaml:12:8: cycle: a cycle must be a whole number of turns\n"
                "  found:   '1.5 turns'\n"
                "  allowed: e.g. 2 turns or 720 deg; largest number of turns: 60"
            ),
        ),
        (
            "cycle: 2",
            (
                "x.yaml:12:8: cycle: a cycle must be a whole number of turns\n"
                "  found:   2\n"
                "  allowed: e.g. 2 turns or 720 deg; largest number of turns: 60"
            ),
        ),
        (
            "cycle: 2 turns\nloads: {m: {on: 1, moment: {against: crank angle, table: [[0, 1], [800, 5]]}}}",
            (
                "x.yaml:13:68: loads.m.moment.table[1][0]: this row is never used: the motion repeats after "
                "several turns of the driver, number of turns: 2\n"
                "  found:   800 deg\n"
                "  allowed: 0 to 720 deg; if the loads repeat after a longer cycle, write cycle: 3 turns"
            ),
        ),
    ],
)
def test_what_cannot_be_is_refused_with_its_place(tail, told):
    assert refused(tail) == told


def test_a_crank_that_does_not_turn_fully_has_no_cycle_of_turns(monkeypatch):
    monkeypatch.setattr(
        "test_loads.MACHINE",
        MACHINE.replace("length: 150", "length: 40").replace("{at: 90, B: [140, 0]}", "{at: 10, B: [88, 0]}"),
    )
    assert (
        refused("cycle: 2 turns") == "x.yaml:12:1: cycle: for a cycle of several turns (2) the crank must rotate fully"
    )


def test_the_law_of_motion_goes_on_from_the_end_of_the_cycle_as_it_began():
    """Rows of a diagram stand at the ends of strokes, where the piston rests: no piece of the law is a mere crack."""
    loads = FOUR_STROKES.replace("loads:", "loads:\n  rings: {on: 3, force: {resists: 60 N}}")
    results = solved(f"{loads}dynamics: {{delta: 1/50}}")
    law, cycle = results.running.steady.law, 4 * np.pi
    assert np.min(np.diff(law.energy.edges)) > 1e-4
    ends = law.speed(np.array([0, cycle - 1e-9, cycle, cycle + 1e-9]))
    assert ends == pytest.approx(ends[0], rel=1e-8)
