"""What acts on a mechanism beside constant forces: windows, pressures, friction that resists, pairs, point masses."""

import math

import numpy as np
import pytest
from models import PARALLELOGRAM, solved_text
from scipy.interpolate import CubicSpline

from tmm_cli import prepare, solve
from tmm_cli.mechanics.analysis import motion_at_positions
from tmm_cli.mechanics.dynamics import reduce_mechanism
from tmm_cli.mechanics.numerics import InterpolationTable
from tmm_cli.problem import ProblemError, build_any_problem, read_text
from tmm_cli.reports import collect_warnings, find_slips, input_data_tables

MACHINE = """tmm: 1
units: {length: mm, angle: deg}
points: {O: [0, 0]}
guides: {x: {through: [0, 0]}}
links:
  1: {points: [O, A], length: 50}
  2: {points: [A, B], length: 150}
  3: {points: [B], slides: {on: x}}
driver: {link: 1, speed: 60 rpm, turns: ccw}
sketch: {at: 90, B: [140, 0]}
"""
STROKE = 0.1  # m


def solved(tail, turns="ccw"):
    return solve(
        build_any_problem(read_text(f"{MACHINE.replace('turns: ccw', f'turns: {turns}')}output: 3\n{tail}", "x.yaml"))
    )


def work_of_cycle(results):
    """Of all loads, J."""
    return reduce_mechanism(results.mechanism, results.start).work_of_cycle


def load(results, name):
    return next(load for load in results.loads if load.name == name)


def refused(tail):
    with pytest.raises(ProblemError) as refusal:
        solved(tail)
    return str(refusal.value)


@pytest.mark.parametrize("turns", ["ccw", "cw"])
def test_friction_that_resists_a_slider_takes_force_times_twice_the_stroke_in_a_turn(turns):
    results = solved("loads: {f: {on: 3, force: {resists: 200 N}}}", turns)
    assert work_of_cycle(results) == pytest.approx(-200 * 2 * STROKE, rel=1e-12)
    power = (load(results, "f").force * results.motion.named("B").v).real
    assert np.all(power <= 1e-12) and np.abs(load(results, "f").force) == pytest.approx(200)


@pytest.mark.parametrize("turns", ["ccw", "cw"])
def test_friction_in_a_hinge_takes_moment_times_the_whole_swing_of_one_link_on_the_other(turns):
    """The rod swings by asin(r/l) to both sides, while the crank goes round: between both it is 2 pi in a turn."""
    on_slider = solved("loads: {m: {on: 2, from: 3, moment: {resists: 2 N*m}}}", turns)
    assert work_of_cycle(on_slider) == pytest.approx(-2 * 4 * np.arcsin(50 / 150), rel=1e-12)
    on_crank = solved("loads: {m: {on: 2, from: 1, moment: {resists: 2 N*m}}}", turns)
    assert work_of_cycle(on_crank) == pytest.approx(-2 * 2 * np.pi, rel=1e-12)


@pytest.mark.parametrize("turns", ["ccw", "cw"])
def test_friction_changes_its_sense_where_the_slider_turns_back(turns):
    """In an end of the stroke it is that of the stroke which begins there."""
    results = solved("loads: {f: {on: 3, force: {resists: 200 N}}}", turns)
    force = load(results, "f").force.real
    assert force[0] == pytest.approx(200) and force[6] == pytest.approx(-200)
    assert force[1:6] == pytest.approx(200) and force[7:] == pytest.approx(-200)


@pytest.mark.parametrize("drawn_at", [0, 40, 77, 131])
def test_what_stays_at_rest_is_not_resisted_however_the_drawing_lies(drawn_at):
    """The coupler of a parallelogram only translates, and the hinges on the frame do not move."""
    problem = build_any_problem(
        read_text(
            f"""tmm: 1
parameters: {{b: {drawn_at} deg, c: {60 + drawn_at} deg}}
points: {{O: [0, 0], C: [400*cos(b), 400*sin(b)]}}
links:
  1: {{points: [O, A], length: 100}}
  2: {{points: [A, B], length: 400}}
  3: {{points: [C, B], length: 100}}
driver: {{link: 1, speed: 10 rad/s}}
sketch: {{at: c, B: [400*cos(b) + 100*cos(c), 400*sin(b) + 100*sin(c)]}}
loads:
  M: {{on: 2, moment: {{resists: 10}}}}
  F: {{on: 1, at: O, force: {{resists: 10}}}}
  P: {{on: 3, at: C, force: {{resists: 10}}}}
positions: {{count: 11, from: b + 7 deg}}
""",
            "x.yaml",
        )
    )
    results = solve(problem)
    assert all(np.all(load.force == 0) and np.all(load.moment == 0) for load in results.loads)
    assert all(np.all(pair.force == 0) for pair in results.reactions.all)
    assert np.all(results.reactions.balance.moment == 0)
    recorded = prepare(problem)(results.motion.q)
    assert all(np.all(recorded[name] == 0) for name in ("T.1", "R.O", "R.A", "R.B", "R.C"))


def test_an_output_that_only_translates_has_no_working_stroke():
    """Its angle rises and falls by rounding, which makes no strokes."""
    text = PARALLELOGRAM + "output: 2\nloads: {M: {on: 2, moment: 10, when: working stroke}}\n"
    with pytest.raises(ProblemError) as refusal:
        solved_text(text)
    assert str(refusal.value) == (
        "x.yaml:12:38: loads.M.when: this mechanism has no working stroke\n"
        "  found:   link 2 has no extreme positions\n"
        "  allowed: an output link that has a stroke (see the key `output`)"
    )
    assert solved_text(PARALLELOGRAM + "output: 2\n").strokes.strokes == ()


def test_a_pair_of_forces_between_two_links_works_by_what_they_move_on_one_another():
    """A force along the guide between slider and rod, each the opposite of the other, leaves the frame nothing."""
    pair = solved("loads: {p: {on: 3, from: 2, at: [20, 0], force: [100, 30]}}")
    one, other = load(pair, "p"), load(pair, "p'")
    assert one.force + other.force == pytest.approx(0)
    spot = pair.motion.point("3", one.at).x
    moment = (np.conj(spot) * one.force).imag + (np.conj(pair.motion.poses["2"].x) * other.force).imag + other.moment
    assert moment == pytest.approx(0, abs=1e-12)
    total = pair.reactions.of("O").force + pair.reactions.of("x").force
    assert np.abs(total) == pytest.approx(0, abs=1e-10)
    assert np.max(pair.lever.difference) < 1e-12


def test_a_force_that_two_links_have_of_one_another_in_their_hinge_moves_nothing():
    results = solved("loads: {p: {on: 3, from: 2, at: B, force: [100, 30]}}")
    assert results.reactions.balance.moment == pytest.approx(0, abs=1e-12)
    assert load(results, "p'").moment == pytest.approx(0)


@pytest.mark.parametrize("turns", ["ccw", "cw"])
def test_a_load_of_a_window_works_there_alone(turns):
    """A constant force in one quarter of the turn works its size times the way of the slider in it."""
    results = solved("loads: {f: {on: 3, force: [-300, 0], when: [0, 90]}}", turns)
    at = motion_at_positions(results, np.radians([0, 90])).named("B").x.real
    way = (at[1] - at[0]) * (1 if turns == "ccw" else -1)
    assert work_of_cycle(results) == pytest.approx(-300 * way, rel=1e-12)
    acts = load(results, "f").force != 0
    angles = np.round(np.degrees(results.motion.q)) % 360
    assert set(angles[acts]) == ({0, 30, 60} if turns == "ccw" else {90, 60, 30})


def test_a_window_may_go_over_the_end_of_the_turn():
    results = solved("loads: {f: {on: 3, force: [-300, 0], when: [300, 60]}}")
    angles = np.round(np.degrees(results.motion.q)) % 360
    assert set(angles[load(results, "f").force != 0]) == {300, 330, 0, 30}


def test_a_pressure_on_a_bore_is_a_force_by_its_area():
    table = "angle: 180, against: stroke, table: [[0, 6 bar], [60, 1 bar], [100, 0]]"
    given_pressure = solved(f"loads: {{gas: {{on: 3, pressure: {{{table}}}, bore: 80}}}}")
    area = np.pi * 80**2 / 4
    forces = table.replace("6 bar", str(0.6 * area)).replace("1 bar", str(0.1 * area))
    expected = solved(f"loads: {{gas: {{on: 3, force: {{{forces}}}}}}}")
    assert load(given_pressure, "gas").force == pytest.approx(load(expected, "gas").force, rel=1e-12)
    by_area = solved("loads: {gas: {on: 3, pressure: {angle: 180, size: 6 bar}, area: 50 cm^2}}")
    assert load(by_area, "gas").force == pytest.approx(-3000)


def test_work_of_an_indicator_diagram_is_its_area():
    """Pressure by the stroke on the way out, another one in steps on the way back."""
    results = solved("""loads:
  out: {on: 3, when: [180, 360], area: 1000, pressure: {angle: 0, against: stroke,
        table: [[0, 2 bar], [40, 5 bar], [100, 1 bar]]}}
  back: {on: 3, when: [0, 180], area: 1000, pressure: {angle: 0, against: stroke, between: step,
         table: [[0, 1 bar], [30, 3 bar]]}}
""")
    out = 1e-3 * np.trapezoid([2e5, 5e5, 1e5], [0, 0.04, 0.1])
    back = 1e-3 * (1e5 * 0.03 + 3e5 * 0.07)
    assert work_of_cycle(results) == pytest.approx(out - back, rel=1e-12)


def test_a_step_table_holds_each_row_up_to_the_next():
    table = InterpolationTable((0.0, 1.0, 3.0), (5.0, 7.0, 2.0), "step")
    assert table(np.array([-1, 0, 0.99, 1, 2.9, 3, 4])).tolist() == [5, 5, 5, 7, 7, 2, 2]


def test_a_smooth_table_is_a_cubic_spline_that_closes_where_the_turn_does():
    rows, sizes = np.radians([0, 70, 150, 260, 360]), np.array([1.0, 4.0, 2.0, -3.0, 1.0])
    results = solved(
        "loads: {m: {on: 1, moment: {against: crank angle, between: smooth, table: "
        "[[0, 1], [70, 4], [150, 2], [260, -3], [360, 1]]}}}"
    )
    spline = CubicSpline(rows, sizes, bc_type="periodic")
    assert load(results, "m").moment == pytest.approx(spline(results.motion.q % (2 * np.pi)), rel=1e-12, abs=1e-12)
    assert work_of_cycle(results) == pytest.approx(spline.integrate(0, 2 * np.pi), rel=1e-11)


def test_slopes_of_tables_are_their_derivatives():
    x, step = np.linspace(0.05, 4.9, 61), 1e-6
    for between in ("linear", "smooth"):
        table = InterpolationTable((0.0, 1.0, 2.5, 5.0), (1.0, -1.0, 4.0, 0.0), between)
        assert table.slope(x) == pytest.approx((table(x + step) - table(x - step)) / (2 * step), abs=1e-6)


def test_a_curve_that_swings_beyond_its_rows_is_told_of():
    results = solved(
        "loads: {f: {on: 3, force: {angle: 180, against: stroke, between: smooth, table: "
        "[[0, 5 kN], [5, 5 kN], [10, 0], [100, 0]]}}}"
    )
    assert any(
        text.startswith(
            "load f: between rows 3 and 4 of its table the smooth curve goes beyond the values of all rows by "
        )
        for text in find_slips(results.problem)
    )


def test_point_masses_make_one_body():
    """Two masses at the ends of a rod: centre between them, inertia by Steiner."""
    folded = solved("masses: {2: {points: [{mass: 2 kg, at: A}, {mass: 1 kg, at: B}]}}")
    body = solved("masses: {2: {mass: 3 kg, inertia: 0.015, centre: {on: AB, at: 1/3}}}")
    assert folded.reactions.balance.moment == pytest.approx(body.reactions.balance.moment, rel=1e-12)
    assert folded.linkage.links["2"].inertia == pytest.approx(2 * 0.05**2 + 0.1**2)
    single = solved("masses: {2: {points: [{mass: 0.7 kg, at: B}]}}").linkage.links["2"]
    assert (single.mass, single.centre, single.inertia) == (0.7, single.points["B"], 0)
    with_body = solved("masses: {2: {mass: 2 kg, inertia: 0, centre: A, points: [{mass: 1 kg, at: B}]}}")
    assert with_body.linkage.links["2"] == folded.linkage.links["2"]


def test_what_was_understood_of_loads_is_told():
    results = solved("loads: {f: {on: 2, from: 3, moment: {resists: 2}, when: [0, 90]}}")
    table = next(table for table in input_data_tables(results.problem) if table.name == "loads")
    assert [column.values[0] for column in table.columns] == [
        "f",
        "2 (relative to link 3)",
        "",
        "2 N*m, opposite to the motion",
        "crank angle from 0 deg to 90 deg",
    ]


@pytest.mark.parametrize(
    ("tail", "told"),
    [
        (
            "loads: {f: {on: 3, force: [1, 0], when: [540, 720]}}",
            (
                "x.yaml:12:42: loads.f.when[0]: the crank does not reach this angle within a cycle\n"
                "  found:   540\n"
                "  allowed: at most 360 deg; if the loads repeat after a longer cycle, write cycle: 2 turns"
            ),
        ),
        (
            "loads: {f: {on: 3, force: [1, 0], when: [0, 360]}}",
            (
                "x.yaml:12:41: loads.f.when: the two angles are equal or differ by a whole cycle, so the load "
                "would act either never or always\n"
                "  found:   [0, 360]\n"
                "  allowed: two different angles that differ by less than 360 deg, or when: always"
            ),
        ),
        (
            "loads: {f: {on: 3, from: 3, force: [1, 0]}}",
            ("x.yaml:12:26: loads.f.from: the links must be different\n  found:   3, 3"),
        ),
        (
            "loads: {f: {on: 3, force: {resists: 5, angle: 20}}}",
            (
                "x.yaml:12:20: loads.f.force: expected exactly one of these keys\n"
                "  found:   angle, resists\n"
                "  allowed: size, table, angle, resists"
            ),
        ),
        (
            "loads: {f: {on: 3, force: {resists: -5}}}",
            "x.yaml:12:37: loads.f.force.resists: a force cannot be negative\n  found:   -5\n  allowed: more than zero",
        ),
        (
            "loads: {f: {on: 3, pressure: {size: 5 bar, angle: 0}}}",
            ("x.yaml:12:9: loads.f: expected exactly one of these keys\n  allowed: area, bore"),
        ),
        (
            "loads: {f: {on: 3, force: {resists: 5}, moment: 3}}",
            (
                "x.yaml:12:9: loads.f: either both the force and the moment of a load have `resists`, or neither "
                "does\n"
                "  found:   both\n"
                "  allowed: two separate loads"
            ),
        ),
        (
            "loads: {f: {on: 3, force: [-9, 0]}}\nfriction: {coefficient: 0.1}\ndynamics: {delta: 1/30}",
            (
                "x.yaml:13:1: friction: the law of motion is not computed if forces depend on reactions or "
                "on speeds\n"
                "  allowed: loads that depend neither on reactions nor on speeds; for a constant friction "
                "force write force: "
                "{resists: 200 N}"
            ),
        ),
        (
            "springs: {s: {between: [0, 3], rate: 1, free: 9, damping: 3}}\ndynamics: {delta: 1/30}",
            (
                "x.yaml:12:50: springs.s.damping: the law of motion is not computed if forces depend on "
                "reactions or on speeds\n"
                "  allowed: loads that depend neither on reactions nor on speeds; for a constant friction "
                "force write force: "
                "{resists: 200 N}"
            ),
        ),
        (
            "masses: {2: {inertia: 1, points: []}}",
            ("x.yaml:12:10: masses.2: expected exactly one of these keys\n  allowed: mass, weight"),
        ),
    ],
)
def test_what_cannot_be_is_refused_with_its_place(tail, told):
    assert refused(tail) == told


def test_a_point_that_is_called_as_a_centre_of_mass_is_there():
    own = "  2: {points: [A, B], length: 150, also: {S2: [75, 10]}}"
    machine = MACHINE.replace("  2: {points: [A, B], length: 150}", own)
    mass = "masses: {{2: {{mass: 1 kg, inertia: 0.01, centre: {}}}}}\n"
    point = complex(
        solve(build_any_problem(read_text(machine + mass.format("S2"), "x.yaml"))).linkage.links["2"].centre
    )
    assert point == pytest.approx(0.075 + 0.01j)
    with pytest.raises(ProblemError) as refusal:
        build_any_problem(read_text(machine + mass.format("[75, 0]"), "x.yaml"))
    assert (
        "the centre of mass of this link is called S2 in tables and drawings, but another point has this name"
    ) in str(refusal.value)


def work_warnings(tail, output="3"):
    text = f"{MACHINE}output: {output}\n{tail}"
    return [w for w in collect_warnings(solve(build_any_problem(read_text(text, "x.yaml")))) if w.startswith("load F ")]


@pytest.mark.parametrize(("turns", "window"), [("ccw", (84.401, 259.985)), ("cw", (-100.016, 84.402))])
def test_gas_that_drives_a_piston_is_told_its_window(turns, window):
    """An engine works between the dead positions of its offset crank-slider: r = 45, l = 160, e = 20.

    With the window instead of the working stroke the load is the same in every position, and nothing is warned of.
    """
    text = """tmm: 1
points: {{O: [0, 0]}}
guides: {{y: {{through: [20, 0], angle: 90}}}}
links:
  1: {{points: [O, A], length: 45}}
  2: {{points: [A, B], length: 160}}
  3: {{points: [B], slides: y}}
driver: {{link: 1, speed: 3000 rpm, turns: {turns}}}
sketch: {{at: 60 deg, B: [20, 190]}}
loads:
  gas: {{on: 3, bore: 80, when: {when}, pressure: {{angle: -90, against: share of stroke, table: [[0, 4], [1, 1]]}}}}
output: {{link: 3, working: backward}}
positions: {{from: working stroke}}
"""
    top = math.degrees(math.acos(20 / (160 + 45)))
    bottom = 180 + math.degrees(math.acos(20 / (160 - 45)))  # the crank points away from B
    expected = (top, bottom) if turns == "ccw" else (bottom - 360, top)
    assert window == pytest.approx(expected, abs=1e-3) and window[0] <= expected[0] and window[1] >= expected[1]
    driving = solve(build_any_problem(read_text(text.format(turns=turns, when="working stroke"), "x.yaml")))
    when = f"when: [{window[0]:.10g} deg, {window[1]:.10g} deg]"
    assert [w for w in collect_warnings(driving) if w.startswith("load gas")] == [
        "load gas acts in the direction of motion during the whole working stroke. Reverse its sign, or choose the "
        "other stroke: output: {link: 3, working: forward}. For an engine, in which the gas drives the piston, write "
        f"{when}"
    ]
    windowed = solve(build_any_problem(read_text(text.format(turns=turns, when=when.removeprefix("when: ")), "x.yaml")))
    assert not [w for w in collect_warnings(windowed) if w.startswith("load gas")]
    rod, same_rod = (solved.reactions.of("A").force for solved in (driving, windowed))
    assert np.all(np.abs(same_rod - rod) <= 1e-9 * np.max(np.abs(rod))) and np.max(np.abs(rod)) > 20_000


def test_a_load_along_the_motion_in_its_working_stroke_is_told_both_ways_out():
    assert work_warnings(
        "loads: {F: {on: 3, force: [100, 0], when: working stroke}}", "{link: 3, working: forward}"
    ) == [
        "load F acts in the direction of motion during the whole working stroke. Reverse its sign, or choose the other "
        "stroke: output: {link: 3, working: backward}"
    ]
    assert work_warnings(
        "loads: {F: {on: 3, force: [-100, 0], when: working stroke}}", "{link: 3, working: backward}"
    ) == [
        "load F acts in the direction of motion during the whole working stroke. Reverse its sign, or choose the other "
        "stroke: output: {link: 3, working: forward}"
    ]
    for force, working in (("[-100, 0]", "forward"), ("[100, 0]", "backward"), ("[100, 0]", "auto")):
        tail = f"loads: {{F: {{on: 3, force: {force}, when: working stroke}}}}"
        assert not work_warnings(tail, f"{{link: 3, working: {working}}}")


@pytest.mark.parametrize(
    ("load", "told"),
    [
        (
            "on: 3, force: [0, -100]",
            (
                "its force is perpendicular to the motion of its point. Direct it against the motion: force: "
                "{size: 100 N, angle: 180 deg}"
            ),
        ),
        (
            "on: 3, axes: link, force: [0, 100]",
            (
                "its force is perpendicular to the motion of its point. Direct it against the motion: force: "
                "{size: 100 N, angle: 180 deg}"
            ),
        ),
        (
            "on: 3, force: {angle: 90, against: stroke, table: [[0, 50], [100, 100]]}",
            ("its force is perpendicular to the motion of its point. Direct it against the motion: angle: 180 deg"),
        ),
        ("on: 3, moment: 5", "link 3 does not rotate. Give a force instead of a moment"),
        ("on: 1, force: [100, 0]", "its point is at rest. Give a link or a point that moves"),
    ],
)
def test_a_load_that_does_no_work_in_its_working_stroke_is_told_what_to_write(load, told):
    found = work_warnings(f"loads: {{F: {{{load}, when: working stroke}}}}", "{link: 3, working: forward}")
    assert found == [f"load F does no work in the working stroke: {told}"]


def test_a_load_that_works_now_with_and_now_against_the_motion_is_none_of_both():
    assert not work_warnings("loads: {F: {on: 2, force: [0, 100], when: working stroke}}")
    assert not work_warnings("loads: {F: {on: 3, from: 1, at: B, force: {resists: 10}, when: working stroke}}")
