"""A table of a load goes no farther than what it is against: rows beyond the cycle are refused, not cut."""

import blocks
import numpy as np
import pytest
from fuzz import beyond
from test_commands import ROOT, tmm

from tmm_cli import load, solve
from tmm_cli.accuracy.digits import judged
from tmm_cli.grading.task import Task
from tmm_cli.library import problem_of
from tmm_cli.problem.reader import read_text
from tmm_cli.results.given import given
from tmm_cli.results.warnings import warnings
from tmm_cli.sweep.grid import read_axes
from tmm_cli.sweep.mechanisms import Mechanisms
from tmm_cli.sweep.run import swept

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
        "\nerror: x.yaml:12:87: loads.gas.force.table[2][0]: this row is never reached: all repeats after 1 turn of "
        "the driver\n"
        "  found:   540 deg\n"
        "  allowed: 0 to 360 deg; a longer cycle of loads is told by cycle: 2 turns\n"
    )


@pytest.mark.parametrize("against", ["crank turn", "crank angle"])
def test_rows_below_zero_are_refused(tmp_path, against):
    ended = forces(tmp_path, against=against, table="[[-90, 0], [0, 5 kN]]")
    assert ended.returncode == 2
    assert "loads.gas.force.table[0][0]: this row is never reached" in ended.stderr
    assert "found:   -90" in ended.stderr


@pytest.mark.parametrize("against", ["crank turn", "crank angle"])
def test_a_table_up_to_the_end_of_the_cycle_is_taken(tmp_path, against):
    assert forces(tmp_path, against=against, table="[[0, 0], [90, 5 kN], [360, 0]]").returncode == 0


def test_a_table_against_the_stroke_may_reach_beyond_it(tmp_path):
    assert forces(tmp_path, against="stroke", table="[[0, 0], [500, 5 kN]]").returncode == 0


def test_a_driver_that_slides_has_no_crank_to_tabulate_against(tmp_path):
    table = "force: {angle: 0 deg, against: crank turn, table: [[0, 0], [1, 5]]}"
    (tmp_path / "x.yaml").write_text(blocks.CYLINDER.replace("force: [0, -100]", table))
    ended = tmm("forces", "x.yaml", cwd=tmp_path)
    assert ended.returncode == 2
    assert ended.stderr == (
        "error: x.yaml:12:58: loads.F.force.against: a table is against a crank, or the strokes that it gives: this "
        "driver slides\n"
        "  found:   crank turn\n"
        "  allowed: size: one value\n"
    )


def test_a_table_is_told_in_full_as_it_is_on_a_task_sheet():
    *_, told = given(load(str(ROOT / "problems/toggle-press.yaml")))
    rows = list(zip(*(column.values for column in told.columns), strict=True))
    assert rows == [("0 mm", "0 N"), ("30 mm", "0 N"), ("36 mm", "5000 N"), ("39.5 mm", "40000 N")]
    assert told.title == "press against the stroke" and told.notes == ("Its direction is 90 deg.",)


@pytest.mark.parametrize("against", ["crank angle", "crank turn"])
@pytest.mark.parametrize("turns", ["ccw", "cw"])
@pytest.mark.parametrize(
    "positions", ["{count: 12, from: 30}", "{count: 7, from: 360/7}", "{at: [360, -720, 1e5*360]}"]
)
def test_where_a_table_jumps_from_its_end_to_its_beginning_rounding_does_not_choose_the_side(against, turns, positions):
    table = "[[0, 260 N], [180, 100 N], [360, 0]]"
    text = CRANK_SLIDER.format(against=against, table=table).replace("turns: cw", f"turns: {turns}")
    results = solve(problem_of(read_text(f"{text}positions: {positions}\n", "x.yaml")))
    assert beyond(results) is None
    if against == "crank angle":
        at_zero = np.abs(np.sin(results.motion.q / 2)) < 1e-6
        assert results.reactions.of("B").force[at_zero].real == pytest.approx(260)


@pytest.mark.parametrize(("last", "told"), [(100, 1), (500, 0)])
def test_a_law_of_motion_tells_of_a_table_that_does_not_close(last, told):
    text = CRANK_SLIDER.format(against="crank angle", table=f"[[0, 500], [90, 800], [360, {last}]]")
    text += "masses: {3: {mass: 1}}\ndynamics: {flywheel: {inertia: 9}}\n"
    results = solve(problem_of(read_text(text, "x.yaml")))
    said = [one for one in warnings(results) if "begins with 500 N and ends with 100 N" in one]
    assert len(said) == told


GAS = [("0", 0), ("0.05", 0), ("0.06", 900), ("0.6", 400), ("0.95", 100), ("1", 0)]  # N against shares of the stroke


def slider(against, rows, *, more="", turns="cw", between="linear"):
    """The crank-slider under a table of rows [argument, N], solved."""
    table = "[" + ", ".join(f"[{argument}, {size}]" for argument, size in rows) + f"], between: {between}"
    text = CRANK_SLIDER.format(against=against, table=table).replace("turns: cw", f"turns: {turns}")
    if more:  # a load that does work in a cycle
        text = text.replace("gas: {on: 3,", "gas: {on: 3, when: working stroke,")
    return solve(problem_of(read_text(f"{text}positions: {{count: 37, from: 3}}\n{more}", "x.yaml")))


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
    psi = solve(problem_of(read_text(text.replace("AGAINST", "stroke").replace("TABLE", "[[0, 1], [1, 1]]"), "x")))
    swing = np.degrees(float(psi.strokes.travel))
    found = []
    for against, table in (
        ("stroke", f"[[0, -20], [{0.25 * float(swing)!r}, -80], [{float(swing)!r}, -50]]"),
        ("share of stroke", "[[0, -20], [25 %, -80], [100 %, -50]]"),
    ):
        own = problem_of(read_text(text.replace("AGAINST", against).replace("TABLE", table), "x"))
        found.append(solve(own).reactions.balance.moment)
    assert np.ptp(found[0]) > 10
    assert found[1] == pytest.approx(found[0], rel=1e-9)


@pytest.mark.parametrize(("row", "shown"), [("[5, 900]", "5"), ("[-1 %, 0]", "'-1 %'")])
def test_what_is_no_share_of_a_stroke_is_refused(tmp_path, row, shown):
    first, second = sorted(["[0, 0]", row], key=lambda text: "-" not in text)
    ended = forces(tmp_path, against="share of stroke", table=f"[{first}, {second}]")
    number, column = (0, 71) if "-" in row else (1, 79)
    assert ended.stderr.endswith(
        f"error: x.yaml:12:{column}: loads.gas.force.table[{number}][0]: this is no share of the stroke\n"
        f"  found:   {shown}\n"
        "  allowed: 0 to 1, or 0 to 100 %; for lengths or angles of the stroke write against: stroke\n"
    )
    assert ended.returncode == 2


def test_a_longer_crank_shifts_rows_of_shares_with_the_stroke_in_digits():
    results = slider("share of stroke", [("0", 0), ("1", 1000)], turns="ccw")
    of_load = judged(results, lambda own: {"F": np.abs(own.loads[0].force)}).lengths["F"]

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
    table = "[[0, 0], [0.3, 900], [1, 100]]"
    text = CRANK_SLIDER.format(against="share of stroke", table=table)
    text = text.replace("length: 50", "length: OA").replace("tmm: 1", "tmm: 1\nparameters: {OA: 50}")
    tree = read_text(text, "x.yaml")
    mechanisms = Mechanisms(tree, read_axes(Task(tree), ["OA=40..60:3"]), ["M_b"])
    found = swept(mechanisms)
    assert found.taped
    for (crank,), (peak,) in zip(found.points, found.values, strict=True):
        lengths = f"[[0, 0], [{0.6 * crank}, 900], [{2 * crank}, 100]]"
        own = CRANK_SLIDER.format(against="stroke", table=lengths).replace("length: 50", f"length: {crank}")
        moment = solve(problem_of(read_text(own, "x.yaml"))).reactions.balance.moment
        assert peak == pytest.approx(np.max(np.abs(moment)), rel=1e-12)


def test_shares_are_told_as_they_are_written():
    text = CRANK_SLIDER.format(against="share of stroke", table="[[0, 0], [5 %, 5 kN], [1, 2 kN]]")
    *_, told = given(problem_of(read_text(text, "x.yaml")))
    rows = list(zip(*(column.values for column in told.columns), strict=True))
    assert rows == [("0", "0 N"), ("0.05", "5000 N"), ("1", "2000 N")]
    assert told.title == "gas against the share of the stroke"
