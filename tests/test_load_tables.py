"""A table of a load goes no farther than what it is against: rows beyond the cycle are refused, not cut."""

import math

import blocks
import numpy as np
import pytest
from bank import EVERY, PROBLEMS, solved
from fuzz import beyond
from scipy.interpolate import CubicSpline
from test_commands import ROOT, tmm

from tmm_cli import load, prepare, solve
from tmm_cli.batch import Task, prepare_batch as prepare_all
from tmm_cli.drawing.sheets import dense_coordinates
from tmm_cli.mechanics.accuracy import bound_values, judge_values
from tmm_cli.mechanics.analysis import results_at
from tmm_cli.mechanics.dynamics import reduce_mechanism
from tmm_cli.mechanics.numerics import DoubleDouble, InterpolationTable, to_float
from tmm_cli.problem import build_any_problem, read_text, template_text
from tmm_cli.reports import collect_warnings, input_data_tables
from tmm_cli.sweep import SweptMechanisms, read_axes, run_sweep

CRANK_SLIDER = """tmm: 1
units: {{length: mm, angle: deg}}
points: {{O: [0, 0]}}
guides: {{x: {{through: [0, 0]}}}}
links:
  1: {{points: [O, A], length: 50}}
  2: {{points: [A, B], length: 150}}
  3: {{points: [B], slides: {{on: x}}}}
driver: {{link: 1, speed: 60 rpm, turns: cw}}
sketch: {{at: 90, B: [140, 0]}}
loads:
  gas: {{on: 3, force: {{angle: 180, against: {against}, table: {table}}}}}
output: 3
"""


def forces(tmp_path, **given):
    (tmp_path / "x.yaml").write_text(CRANK_SLIDER.format(**given))
    return tmm("forces", "x.yaml", "--json", cwd=tmp_path)


def test_rows_of_a_second_turn_are_refused_with_what_to_do(tmp_path):
    ended = forces(tmp_path, against="crank turn", table="[[0, 0], [180, 5 kN], [540, 2 kN], [720, 0]]")
    assert ended.returncode == 2
    assert ended.stderr.endswith(
        "\n"
        "error: x.yaml:12:87: loads.gas.force.table[2][0]: this row is never used: the motion repeats "
        "after one turn of the driver\n"
        "  found:   540 deg\n"
        "  allowed: 0 to 360 deg; if the loads repeat after a longer cycle, write cycle: 2 turns\n"
    )


@pytest.mark.parametrize(
    ("against", "crank", "table", "place", "found"),
    [
        ("crank turn", 50, "[[0, 5], [360, 0], [720, 5]]", "13:97: loads.gas.pressure.table[2][0]", "720 deg"),
        (
            "share of stroke",
            250,
            "[[0, 5], [1, 0]]",
            "13:36: loads.gas.pressure",
            "the driver moves from 36.8699 deg to 143.13 deg",
        ),
    ],
)
def test_a_table_of_pressures_is_refused_under_its_own_key(tmp_path, against, crank, table, place, found):
    """A gas force by pressures has no key `force`: the refusal names the key and the row of the file."""
    (tmp_path / "x.yaml").write_text(f"""tmm: 1
units: {{length: mm, angle: deg}}
points: {{O: [0, 0]}}
guides: {{y: {{through: O, angle: 90}}}}
links:
  1: {{points: [O, A], length: {crank}}}
  2: {{points: [A, B], length: 200}}
  3: {{points: [B], slides: y}}
driver: {{link: 1, speed: 60 rpm}}
sketch: {{at: 90 deg, B: [0, {crank + 200}]}}
output: 3
loads:
  gas: {{on: 3, bore: 80, pressure: {{angle: -90, against: {against}, table: {table}}}}}
""")
    ended = tmm("forces", "x.yaml", cwd=tmp_path)
    assert ended.returncode == 2
    assert f"error: x.yaml:{place}: " in ended.stderr
    assert f"\n  found:   {found}\n" in ended.stderr


@pytest.mark.parametrize("against", ["crank turn", "crank angle"])
def test_rows_below_zero_are_refused(tmp_path, against):
    ended = forces(tmp_path, against=against, table="[[-90, 0], [0, 5 kN]]")
    assert ended.returncode == 2
    assert "loads.gas.force.table[0][0]: this row is never used" in ended.stderr
    assert "found:   -90" in ended.stderr


@pytest.mark.parametrize("against", ["crank turn", "crank angle"])
def test_a_table_up_to_the_end_of_the_cycle_is_taken(tmp_path, against):
    assert forces(tmp_path, against=against, table="[[0, 0], [90, 5 kN], [360, 0]]").returncode == 0


@pytest.mark.parametrize("last", [500, 1000])
def test_a_table_against_the_stroke_that_goes_on_beyond_it_is_warned_of(tmp_path, last):
    ended = forces(tmp_path, against="stroke", table=f"[[0, 0], [{last}, 5 kN]]")
    assert ended.returncode == 0
    assert ended.stderr.endswith(
        f"warning: the table of load gas extends to {last} mm, but the stroke is 100 mm: its last rows are never "
        "reached. Is the unit correct? Rows in fractions of the stroke (against: share of stroke) fit any stroke\n"
    )


@pytest.mark.parametrize(("last", "short", "long"), [(99, 1, 0), (100, 0, 0), (101, 0, 0), (103, 0, 1)])
def test_a_table_that_ends_with_the_stroke_has_no_warning(last, short, long):
    results = slider("stroke", [("0", 0), (last, 900)])
    said = list(collect_warnings(results))
    assert sum("the value of that row is used; rows in fractions" in one for one in said) == short
    assert sum(f"extends to {last} mm, but the stroke is 100 mm" in one for one in said) == long


MANY = (
    "warning: x: the table of load gas does not end with the stroke in 2 of 3 mechanisms: its last row "
    "is for 100 mm, the strokes are from 80 mm to 120 mm. Rows in fractions of the stroke (against: "
    "share of stroke) fit any stroke\n"
)


@pytest.mark.parametrize(
    ("against", "table", "told"),
    [
        ("stroke", "[[0, 0], [100, 900]]", MANY),
        ("stroke", "[[0, 0], [2*OA, 900]]", ""),
        ("share of stroke", "[[0, 0], [1, 900]]", ""),
    ],
)
def test_a_sweep_tells_of_tables_that_do_not_fit_all_its_strokes(tmp_path, against, table, told):
    text = CRANK_SLIDER.format(against=against, table=table).replace("length: 50", "length: OA")
    (tmp_path / "x.yaml").write_text(text.replace("tmm: 1", "tmm: 1\nparameters: {OA: 50}"))
    ended = tmm("sweep", "x.yaml", "--over", "OA=40..60:3", "--show", "H", cwd=tmp_path)
    assert ended.returncode == 0
    assert told in ended.stderr and ("does not end with the stroke" in ended.stderr) == bool(told)


def test_a_setting_that_makes_a_table_too_short_or_too_long_is_warned_of(tmp_path):
    text = CRANK_SLIDER.format(against="stroke", table="[[0, 0], [100, 900]]").replace("length: 50", "length: OA")
    (tmp_path / "x.yaml").write_text(text.replace("tmm: 1", "tmm: 1\nparameters: {OA: 50}"))
    short, long = (tmm("forces", "x.yaml", "--set", f"OA={crank}", cwd=tmp_path).stderr for crank in (60, 40))
    assert (
        "the table of load gas does not cover the whole range of its argument (stroke): beyond its first "
        "and last row, the value of that row is used; rows"
    ) in short
    assert "the table of load gas extends to 100 mm, but the stroke is 80 mm: its last rows are never" in long


def test_variants_tell_of_tables_that_do_not_fit_all_their_strokes(tmp_path):
    text = CRANK_SLIDER.format(against="stroke", table="[[0, 0], [100, 900]]").replace("length: 50", "length: OA")
    text = text.replace("tmm: 1", "tmm: 1\nparameters: {OA: 50}\nvariants: {OA: {from: 40, to: 60, step: 10}}")
    (tmp_path / "x.yaml").write_text(text)
    ended = tmm("variants", "x.yaml", "--count", 3, "-o", "out", cwd=tmp_path)
    assert ended.returncode == 0
    assert MANY in ended.stderr
    (tmp_path / "x.yaml").write_text(f"{text}grading: {{answers: [{{of: H}}]}}\n")
    (tmp_path / "answers").mkdir()
    graded = tmm("grade", "x.yaml", "--variants", "out/variants.csv", "--submissions", "answers", cwd=tmp_path)
    assert graded.returncode == 0 and MANY in graded.stderr


def test_a_driver_that_slides_has_no_crank_to_tabulate_against(tmp_path):
    table = "force: {angle: 0 deg, against: crank turn, table: [[0, 0], [1, 5]]}"
    (tmp_path / "x.yaml").write_text(blocks.CYLINDER.replace("force: [0, -100]", table))
    ended = tmm("forces", "x.yaml", cwd=tmp_path)
    assert ended.returncode == 2
    assert ended.stderr == (
        "error: x.yaml:12:58: loads.F.force.against: a load can be given by a table only if the driver is "
        "a crank, but this driver is a slider\n"
        "  found:   crank turn\n"
        "  allowed: size: a single value\n"
    )


def test_a_table_is_told_in_full_as_it_is_on_a_task_sheet():
    *_, told = input_data_tables(load(str(ROOT / "problems/toggle-press.yaml")))
    rows = list(zip(*(column.values for column in told.columns), strict=True))
    assert rows == [("0 mm", "0 N"), ("30 mm", "0 N"), ("36 mm", "5000 N"), ("39.5 mm", "40000 N")]
    assert told.title == "Load press; argument: stroke" and told.notes == ("Direction angle of the force: 90 deg.",)


@pytest.mark.parametrize("against", ["crank angle", "crank turn"])
@pytest.mark.parametrize("turns", ["ccw", "cw"])
@pytest.mark.parametrize(
    "positions", ["{count: 12, from: 30}", "{count: 7, from: 360/7}", "{at: [360, -720, 1e5*360]}"]
)
def test_where_a_table_jumps_from_its_end_to_its_beginning_rounding_does_not_choose_the_side(against, turns, positions):
    table = "[[0, 260 N], [180, 100 N], [360, 0]]"
    text = CRANK_SLIDER.format(against=against, table=table).replace("turns: cw", f"turns: {turns}")
    results = solve(build_any_problem(read_text(f"{text}positions: {positions}\n", "x.yaml")))
    assert beyond(results) is None
    if against == "crank angle":
        at_zero = np.abs(np.sin(results.motion.q / 2)) < 1e-6
        assert results.reactions.of("B").force[at_zero].real == pytest.approx(260)


@pytest.mark.parametrize(("last", "told"), [(100, 1), (500, 0)])
def test_a_law_of_motion_tells_of_a_table_that_does_not_close(last, told):
    text = CRANK_SLIDER.format(against="crank angle", table=f"[[0, 500], [90, 800], [360, {last}]]")
    text += "masses: {3: {mass: 1}}\ndynamics: {flywheel: {inertia: 9}}\n"
    results = solve(build_any_problem(read_text(text, "x.yaml")))
    said = [one for one in collect_warnings(results) if "at the beginning (500 N) and at the end (100 N)" in one]
    assert len(said) == told


GAS = [("0", 0), ("0.05", 0), ("0.06", 900), ("0.6", 400), ("0.95", 100), ("1", 0)]  # N against shares of the stroke


def slider(against, rows, *, more="", turns="cw", between="linear"):
    """The crank-slider under a table of rows [argument, N], solved."""
    table = "[" + ", ".join(f"[{argument}, {size}]" for argument, size in rows) + f"], between: {between}"
    text = CRANK_SLIDER.format(against=against, table=table).replace("turns: cw", f"turns: {turns}")
    if more:  # a load that does work in a cycle
        text = text.replace("gas: {on: 3,", "gas: {on: 3, when: working stroke,")
    return solve(build_any_problem(read_text(f"{text}positions: {{count: 37, from: 3}}\n{more}", "x.yaml")))


@pytest.mark.parametrize("between", ["linear", "step", "smooth"])
@pytest.mark.parametrize("turns", ["ccw", "cw"])
@pytest.mark.parametrize("more", ["", "dynamics: {flywheel: {inertia: 20}}\nmasses: {3: {mass: 1}}\n"])
def test_a_table_in_shares_of_the_stroke_is_the_table_in_its_lengths(between, turns, more):
    lengths = [(f"{share} * 2 * 50", size) for share, size in GAS]  # the stroke is 2 OA = 100 mm
    shares = slider("share of stroke", GAS, more=more, turns=turns, between=between)
    other = slider("stroke", lengths, more=more, turns=turns, between=between)
    wanted = other.reactions.balance.moment
    assert shares.reactions.balance.moment == pytest.approx(wanted, abs=1e-10 * np.max(np.abs(wanted)))
    assert shares.motion.rate == pytest.approx(other.motion.rate, rel=1e-11)


def test_a_load_in_shares_of_the_stroke_is_that_of_the_run_of_the_slider():
    results = slider("share of stroke", GAS, turns="ccw")
    phi = np.radians(3 + 360 / 37 * np.arange(37))
    place = 50 * np.cos(phi) + np.sqrt(150**2 - (50 * np.sin(phi)) ** 2)
    forward = results.strokes.strokes[0].run > 0
    share = (place - 100) / 100 if forward else (200 - place) / 100
    force = np.interp(share, *np.array(GAS, float).T)
    (load,) = [one for one in results.loads if one.name == "gas"]
    assert -load.force.real == pytest.approx(force, abs=1e-9)


def test_shares_may_be_in_per_cent_and_of_a_swing():
    text = (ROOT / "problems/crank-rocker.yaml").read_text("utf-8")
    rocker = "loads: {M: {on: 3, when: working stroke, moment: {against: AGAINST, table: TABLE}}}\n"
    text = text[: text.index("loads:")] + rocker + "output: 3\npositions: {count: 24}\n"
    psi = solve(
        build_any_problem(read_text(text.replace("AGAINST", "stroke").replace("TABLE", "[[0, 1], [1, 1]]"), "x"))
    )
    swing = np.degrees(float(psi.strokes.travel))
    found = []
    for against, table in (
        ("stroke", f"[[0, -20], [{0.25 * float(swing)!r}, -80], [{float(swing)!r}, -50]]"),
        ("share of stroke", "[[0, -20], [25 %, -80], [100 %, -50]]"),
    ):
        own = build_any_problem(read_text(text.replace("AGAINST", against).replace("TABLE", table), "x"))
        found.append(solve(own).reactions.balance.moment)
    assert np.ptp(found[0]) > 10
    assert found[1] == pytest.approx(found[0], rel=1e-9)


@pytest.mark.parametrize(("row", "shown"), [("[5, 900]", "5"), ("[-1 %, 0]", "'-1 %'")])
def test_what_is_no_share_of_a_stroke_is_refused(tmp_path, row, shown):
    first, second = sorted(["[0, 0]", row], key=lambda text: "-" not in text)
    ended = forces(tmp_path, against="share of stroke", table=f"[{first}, {second}]")
    number, column = (0, 71) if "-" in row else (1, 79)
    assert ended.stderr.endswith(
        f"error: x.yaml:12:{column}: loads.gas.force.table[{number}][0]: this is not a fraction of the stroke\n"
        f"  found:   {shown}\n"
        "  allowed: 0 to 1, or 0 to 100 %; to give lengths or angles instead, write against: stroke\n"
    )
    assert ended.returncode == 2


def test_a_longer_crank_shifts_rows_of_shares_with_the_stroke_in_digits():
    results = slider("share of stroke", [("0", 0), ("1", 1000)], turns="ccw")
    of_load = judge_values(results, lambda own: {"F": np.abs(own.loads[0].force)}).lengths["F"]

    def force(phi, crank, rod):
        place = crank * np.cos(phi) + np.sqrt(rod**2 - (crank * np.sin(phi)) ** 2)
        share = (place - rod + crank) / (2 * crank)
        return 1000 * (share if results.strokes.strokes[0].run > 0 else 1 - share)

    phi = results.motion.q
    by_crank = force(phi, 50.0005, 150) - force(phi, 49.9995, 150)  # of 0.001 mm
    by_rod = force(phi, 50, 150.0005) - force(phi, 50, 149.9995)
    wanted = np.abs(by_crank) * 50 + np.abs(by_rod) * 150  # lengths 0.1 % off
    assert of_load == pytest.approx(wanted, rel=1e-3, abs=1e-3)


def test_a_sweep_takes_the_stroke_of_each_mechanism_for_its_shares():
    def peaks(against, table):
        text = CRANK_SLIDER.format(against=against, table=table).replace("length: 50", "length: OA")
        tree = read_text(text.replace("tmm: 1", "tmm: 1\nparameters: {OA: 50}"), "x.yaml")
        return run_sweep(SweptMechanisms(tree, read_axes(Task(tree), ["OA=40..60:3"]), ["M_b"]))

    shares = peaks("share of stroke", "[[0, 0], [0.3, 900], [1, 100]]")
    lengths = peaks("stroke", "[[0, 0], [0.6 * OA, 900], [2 * OA, 100]]")
    assert shares.taped and not lengths.taped
    assert np.ptp(lengths.values) > 5
    assert shares.values == pytest.approx(lengths.values, rel=1e-9)


def test_shares_are_told_as_they_are_written():
    text = CRANK_SLIDER.format(against="share of stroke", table="[[0, 0], [5 %, 5 kN], [1, 2 kN]]")
    *_, told = input_data_tables(build_any_problem(read_text(text, "x.yaml")))
    rows = list(zip(*(column.values for column in told.columns), strict=True))
    assert rows == [("0", "0 N"), ("0.05", "5000 N"), ("1", "2000 N")]
    assert told.title == "Load gas; argument: fraction of the stroke"


SAW = [("0", 0), ("20", 0), ("20", 1500), ("80", 900), ("80", 300), ("100", 300)]  # N against mm of a stroke of 100 mm
JUMPS = [("0.2", (0, 1500)), ("0.8", (900, 300))]


def by_hand(x, rows):
    """Values of a linear table with jumps: from the right in a row."""
    at, sizes = np.array(rows, float).T
    k = np.clip(np.searchsorted(at, x, side="right") - 1, 0, len(at) - 2)
    return sizes[k] + (x - at[k]) * (sizes[k + 1] - sizes[k]) / (at[k + 1] - at[k])


def test_two_equal_arguments_are_a_jump_with_the_value_from_the_left_before_and_from_the_right_after():
    table = InterpolationTable((0.0, 20.0, 20.0, 80.0, 80.0, 100.0), (0.0, 0.0, 1500.0, 900.0, 300.0, 300.0))
    at = np.array([-1, 10, np.nextafter(20, 0) - 1e-9, 20, 50, 80 - 1e-9, 80, 90, 100, 200])
    assert table(at) == pytest.approx([0, 0, 0, 1500, 1200, 900, 300, 300, 300, 300], abs=1e-7)
    exact = InterpolationTable(
        *(tuple(DoubleDouble.decimal(str(x)) for x in row) for row in (table.arguments, table.values))
    )
    assert to_float(exact(at)) == pytest.approx(table(at), abs=1e-7)
    each = InterpolationTable(table.arguments, (0.0, 0.0, np.array([[1500.0], [15.0]]), 900.0, 300.0, 300.0))
    assert each(at)[0] == pytest.approx(table(at), abs=1e-7) and each(at)[1][4] == pytest.approx((15 + 900) / 2)
    assert table.slope(np.array([10, 20, 50, 80, 90])) == pytest.approx([0, -10, -10, 0, 0])


def test_a_table_may_jump_in_its_first_and_in_its_last_row():
    table = InterpolationTable((30.0, 30.0, 90.0, 90.0), (1.0, 5.0, 8.0, 2.0))
    assert table(np.array([0, 29, 30, 60, 90, 100])) == pytest.approx([1, 1, 5, 6.5, 2, 2])


def test_between_two_jumps_a_smooth_table_is_a_spline_of_its_own_rows():
    table = InterpolationTable((0.0, 1.0, 2.0, 3.0, 3.0, 4.0, 6.0), (0.0, 2.0, 1.0, 4.0, 7.0, 5.0, 6.0), "smooth")
    left, right = np.linspace(0, 2.99, 21), np.linspace(3, 6, 21)
    first = CubicSpline([0, 1, 2, 3], [0, 2, 1, 4], bc_type="natural")
    second = CubicSpline([3, 4, 6], [7, 5, 6], bc_type="natural")
    assert table(left) == pytest.approx(first(left)) and table(right) == pytest.approx(second(right))


@pytest.mark.parametrize("turns", ["ccw", "cw"])
@pytest.mark.parametrize("against", ["stroke", "share of stroke"])
def test_work_of_a_load_that_jumps_is_the_area_under_its_table(turns, against):
    rows = SAW if against == "stroke" else [(f"{argument} %", size) for argument, size in SAW]
    more = "dynamics: {flywheel: {inertia: 20}}\nmasses: {3: {mass: 1}}\n"
    results = slider(against, rows, more=more, turns=turns)
    area = 0.06 * (1500 + 900) / 2 + 0.02 * 300  # J
    work = reduce_mechanism(results.mechanism, results.start).work_of_cycle
    assert abs(work) == pytest.approx(area, rel=1e-12)
    (load,) = [one for one in results.loads if one.name == "gas"]
    first = results.strokes.strokes[0]
    place = 50 * np.cos(results.motion.q) + np.sqrt(150**2 - (50 * np.sin(results.motion.q)) ** 2)
    run = place - 100 if first.run > 0 else 200 - place
    working = results.strokes.share(results.motion.q, results.linkage.driver.sense)
    assert -load.force.real == pytest.approx(np.where(working, by_hand(run, SAW), 0), abs=1e-8)


def test_energy_of_a_moment_that_jumps_is_exact_over_the_cycle():
    """M = 10 N m over 120 deg, 40 N m over the rest; the drive is its mean, 30: the work swings by 20 N m * 120 deg."""
    text = CRANK_SLIDER.split("loads:")[0].format()
    text += (
        "loads: {m: {on: 1, moment: {against: crank angle, table: [[0, 40], [60, 40], [60, 10], [180, 10], [180, 40], "
        "[360, 40]]}}}\nmasses: {1: {mass: 0, inertia: 5}}\ndynamics: {flywheel: {inertia: 20}}\n"
    )
    for turns in ("ccw", "cw"):
        own = text.replace("turns: cw", f"turns: {turns}")
        results = solve(
            build_any_problem(read_text(f"{own}positions: {{at: [59, 60, 61, 179, 180, 181]}}\n", "x.yaml"))
        )
        mean = (10 * 120 + 40 * 240) / 360
        work = np.radians(120) * (mean - 10)
        largest = results.running.steady.law.energy
        at = largest(largest.sample_points())
        assert np.ptp(at) == pytest.approx(work, rel=1e-12)
        (load,) = [one for one in results.loads if one.name == "m"]
        assert load.moment == pytest.approx([40, 10, 10, 10, 40, 40], rel=1e-12)


def test_many_positions_at_once_and_digits_know_a_table_that_jumps():
    text = CRANK_SLIDER.format(
        against="crank angle", table="[[0, 0], [90, 0], [90, 5 kN], [200, 2 kN], [200, 0], [360, 0]]"
    )
    problem = build_any_problem(read_text(f"{text}positions: {{at: [10, 90, 120, 200, 300]}}\n", "x.yaml"))
    results = solve(problem)
    assert prepare(problem)(results.motion.q)["T.1"] == pytest.approx(results.reactions.balance.moment, abs=1e-9)
    forces = np.radians([0, 5000, 5000 - 3000 * 30 / 110, 0, 0])
    (load,) = [one for one in results.loads if one.name == "gas"]
    assert np.radians(np.abs(load.force)) == pytest.approx(forces, abs=1e-9)
    values, digits = bound_values(results)
    finite = [np.nanmax(bound / np.maximum(np.abs(values[key]), 1)) for key, bound in digits.bound.items()]
    assert max(finite) < 1e-9


def test_a_diagram_draws_the_jump_at_its_place_with_both_values():
    results = slider("stroke", SAW, more=" ", turns="ccw")
    q, borders = dense_coordinates(results)
    moments = results_at(results, q).reactions.balance.moment
    first = results.strokes.strokes[0]
    for argument, (before, after) in JUMPS:
        place = 100 + 100 * float(argument) if first.run > 0 else 200 - 100 * float(argument)
        cosine = (place**2 + 50**2 - 150**2) / (2 * place * 50)  # angle of the crank with the slider there
        angle = np.arccos(cosine) if first.run < 0 else -np.arccos(cosine)
        (k,) = [k for k in borders if abs((q[k] - angle + np.pi) % (2 * np.pi) - np.pi) < 1e-5]
        arm = abs(results.motion.linkage.links["1"].points["A"])  # the moment is proportional to the force
        assert arm == 0.05 and moments[k + 1] * before == pytest.approx(moments[k] * after, rel=1e-4, abs=1e-9)
        assert abs(moments[k + 1] - moments[k]) > 1


@pytest.mark.parametrize(
    ("table", "told"),
    [
        (
            "[[0, 0], [20, 0], [20, 5], [20, 9], [90, 0]]",
            (
                "table[3][0]: the values in the first column must increase\n"
                "  found:   20\n"
                "  allowed: for a jump, two rows: the value before it and the value after it\n"
            ),
        ),
        ("[[0, 0], [20, 0], [10, 5]]", ("table[2][0]: the values in the first column must increase\n  found:   10\n")),
        (
            "[[0, 0], [20, 0], [20, 5]], between: step",
            (
                "table[2][0]: the values in the first column must increase\n  found:   20\n  allowed: each "
                "value only once\n"
            ),
        ),
    ],
)
def test_what_is_no_jump_is_refused(tmp_path, table, told):
    ended = forces(tmp_path, against="stroke", table=table)
    assert ended.returncode == 2
    assert ended.stderr.endswith(f"loads.gas.force.{told}")


def test_a_table_against_the_stroke_of_a_driver_that_does_not_turn_fully_is_refused_with_the_reason(tmp_path):
    (tmp_path / "x.yaml").write_text("""tmm: 1
points: {O: [0, 0], C: [300, 0]}
links:
  1: {points: [O, A], length: 250}
  2: {points: [A, B], length: 200}
  3: {points: [C, B], length: 100}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 20 deg, B: [380, 60]}
loads: {M: {on: 3, moment: {against: stroke, table: [[0, 0], [20, 10]]}}}
output: 3
""")
    ended = tmm("forces", "x.yaml", cwd=tmp_path)
    least, most = (math.degrees(math.acos((250**2 + 300**2 - rod**2) / (2 * 250 * 300))) for rod in (100, 300))
    first, last = f"{least:.6g}", f"{most:.6g}"
    assert ended.stderr.endswith(
        "error: x.yaml:9:28: loads.M.moment: a load table with `against: stroke` requires a driver that "
        "rotates fully, so that the output makes full strokes\n"
        f"  found:   the driver moves from {first} deg to {last} deg\n"
        "  allowed: against: crank angle\n"
    )
    assert ended.returncode == 2


def test_the_template_of_a_shaper_shows_a_table_in_shares_that_runs():
    text = template_text("shaper")
    lines = text.splitlines()
    (first,) = (k for k, line in enumerate(lines) if "share of stroke, table" in line)
    table = "\n".join(line.replace("  #", "  ", 1) for line in lines[first : first + 2])
    whole = text.replace("  F: {on: 5, at: [100, 30], force: [1500, 0], when: working stroke}", table)
    results = solve(build_any_problem(read_text(whole, "shaper.yaml")))
    assert not [one for one in collect_warnings(results) if "table" in one]
    (load,) = [one for one in results.loads if one.name == "F"]
    share = (results.motion.named("E").x.real - results.strokes.strokes[0].low) / results.strokes.strokes[0].run
    works = results.strokes.share(results.motion.q, 1)
    assert load.force.real == pytest.approx(np.where(works & (share > 0.05) & (share < 0.95), 1500, 0))


def test_tables_of_the_bank_against_the_stroke_end_with_it():
    names = [name for name in EVERY if "against: stroke" in (PROBLEMS / f"{name}.yaml").read_text("utf-8")]
    assert len(names) >= 2
    for name in names:
        assert not [one for one in collect_warnings(solved(name)) if "table of load" in one], name


def test_variants_of_one_mechanism_may_jump_at_different_angles():
    def linkage(angle):
        table = f"[[0, 0], [{angle}, 0], [{angle}, 5 kN], [200, 2 kN], [200, 0], [360, 0]]"
        return build_any_problem(read_text(CRANK_SLIDER.format(against="crank angle", table=table), "x.yaml")).linkage

    q, each = np.radians([50.0, 85, 95, 120, 300]), [linkage(angle) for angle in (80, 90, 100)]
    together = prepare_all(each)(q)["T.1"]
    for k, own in enumerate(each):
        assert together[k] == pytest.approx(prepare_all([own])(q)["T.1"], abs=1e-9)
    assert np.count_nonzero(np.abs(together) > 1, axis=1).tolist() == [3, 2, 1]


def test_a_sweep_finds_the_peak_of_a_load_that_jumps():
    """The rows of the table stand at shares of each stroke; the peak is that of 20 000 positions, from both sides."""
    text = CRANK_SLIDER.format(against="share of stroke", table="[[0, 0], [0.3, 0], [0.3, 900], [1, 100]]")
    text = text.replace("length: 50", "length: OA").replace("tmm: 1", "tmm: 1\nparameters: {OA: 50}")
    tree = read_text(text, "x.yaml")
    found = run_sweep(SweptMechanisms(tree, read_axes(Task(tree), ["OA=40..60:2"]), ["M_b"]))
    assert found.taped
    for (crank,), (peak,) in zip(found.points, found.values, strict=True):
        own = solve(build_any_problem(read_text(text.replace("OA: 50", f"OA: {crank}"), "x.yaml")))
        moment = results_at(own, np.linspace(0, 2 * np.pi, 20_001)).reactions.balance.moment
        assert peak == pytest.approx(np.max(np.abs(moment)), rel=1e-6)
