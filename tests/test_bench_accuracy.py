"""Methods side by side: each agrees with 50 digits to what it promises, and the product meets its targets."""

from __future__ import annotations

import csv
import json
from functools import partial
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from test_commands import tmm
from write_bench_references import BANK, DATA, answers, solved

from tmm_cli.bench import (
    CLOSED_FORM,
    FEWER,
    METHODS,
    QUANTITIES,
    REFERENCE_NAMES,
    TARGETS,
    Accuracy,
    AccuracyRow,
    Case,
    LoopEquations,
    Method,
    MethodAnswers,
    convert_precision,
    draw_accuracy,
    load_reference,
    measure_accuracy,
    relative_errors,
    rivals,
    sample_coordinates,
)
from tmm_cli.bench.methods import board
from tmm_cli.mechanics.plans import sheet_scale
from tmm_cli.problem import build_any_problem, read_text
from tmm_cli.synthesis import load

BY_NAME = {method.name: method for method in METHODS}
UNIT = np.finfo(float).eps


def error_of(method, name):
    true = load_reference(name)
    return relative_errors(BY_NAME[method].solve(true.case, true.q), true.exact)


@pytest.fixture(params=REFERENCE_NAMES)
def name(request):
    return request.param


# the references


@pytest.mark.parametrize("name, k", [("crank-slider", 5), ("shaper", 17), ("press-class-iii", 11)])
def test_references_are_what_sixty_digits_say(name, k):
    content = json.loads((DATA / f"{name}.json").read_text(encoding="utf-8"))
    results, motion, __ = solved(name, np.array(content["q"]))
    expected = answers(results, motion, k)
    for quantity in ("positions", "velocities", "accelerations", "reactions"):
        assert content[quantity].keys() == expected[quantity].keys()
        for key, value in expected[quantity].items():
            written = mp.mpc(*(mp.mpf(part) for part in content[quantity][key][k]))
            assert abs(written - value) <= mp.mpf(10) ** -48 * abs(value) + mp.mpf(10) ** -45
    assert abs(mp.mpf(content["balancing"][k]) - expected["balancing"]) <= mp.mpf(10) ** -48 * abs(
        expected["balancing"]
    )


def test_references_are_of_the_linkages_of_the_bank(name):
    content = json.loads((DATA / f"{name}.json").read_text(encoding="utf-8"))
    assert build_any_problem(read_text(content["problem"], name)).linkage == load(str(BANK / f"{name}.yaml")).linkage


def test_references_have_forces_in_every_pair_and_points_on_every_moving_link(name):
    true = load_reference(name)
    assert set(true.exact.reactions) == {pair.name for pair in true.case.structure.pairs}
    assert set(true.exact.positions) == set(true.case.linkage.moving_points)
    assert len(true.q) == 24
    for forces in true.exact.reactions.values():
        assert np.max(np.abs(forces)) > 1


# methods in full precision


def test_closed_form_groups_are_within_their_targets(name):
    found = error_of("closed", name)
    assert all(found[quantity] <= TARGETS[quantity] for quantity in QUANTITIES), found


@pytest.mark.parametrize("method", ["newton-15", "multibody"])
def test_newton_and_multipliers_are_as_good_when_they_go_on_to_the_end(name, method):
    assert max(error_of(method, name).values()) < 1e-13


def test_newton_is_off_by_what_its_tolerance_leaves_open_and_no_tolerance_helps_less_than_a_wider_one(name):
    found = [error_of(f"newton-{k}", name) for k in range(2, 16)]
    for k, error in enumerate(found, 2):
        # gaps are shares of the longest link; the least well-shaped of these linkages make 20 times as much of them
        assert error["positions"] <= 20 * 10.0**-k + 20 * UNIT
    worst = [max(error.values()) for error in found]
    assert all(later <= 1.01 * earlier + 100 * UNIT for earlier, later in pairwise(worst))


def test_extended_precision_is_better_than_double_and_double_than_single(name):
    single, double, extended = (error_of(method, name) for method in ("single", "closed", "extended"))
    for quantity in QUANTITIES:
        assert single[quantity] < 1e-5
        assert double[quantity] < 1e-7 * single[quantity]
        assert extended[quantity] < (0.2 * double[quantity] if np.finfo(np.longdouble).eps < UNIT else 1e-13)


def test_numbers_are_recast_and_names_are_not():
    linkage = load_reference("shaper").case.linkage
    wide = convert_precision(linkage, np.longdouble)
    assert wide.links.keys() == linkage.links.keys()
    assert isinstance(wide.links["3"].mass, np.longdouble)
    assert wide.links["3"].points["D"].dtype == np.clongdouble
    assert all(complex(wide.links["3"].points[p]) == at for p, at in linkage.links["3"].points.items())


# methods that lose digits


def test_the_error_of_differences_falls_with_the_square_of_the_step_until_rounding_over_its_square_is_more(name):
    found = {k: error_of(f"differences-{k}", name) for k in range(1, 9)}
    for quantity in ("velocities", "accelerations"):
        assert found[2][quantity] == pytest.approx(found[1][quantity] / 100, rel=0.1)
        assert found[3][quantity] == pytest.approx(found[2][quantity] / 100, rel=0.1)
    for k in (6, 7, 8):
        assert 0.1 * UNIT * 10.0 ** (2 * k) < found[k]["accelerations"] < 100 * UNIT * 10.0 ** (2 * k)
        assert 0.01 * UNIT * 10.0**k < found[k]["velocities"] < 100 * UNIT * 10.0**k
    best = min(found, key=lambda k: found[k]["accelerations"])
    assert best in (3, 4)  # the fourth root of rounding
    assert found[4]["positions"] == error_of("closed", name)["positions"]


@pytest.mark.parametrize("millimetres", [0.25, 0.5])
def test_points_on_the_drawing_board_are_off_by_less_than_two_grids(name, millimetres):
    """A point by half a grid both ways, which is 0.7 of it; the rest is what a link's direction makes of that."""
    true = load_reference(name)
    found = BY_NAME[f"board-{millimetres:.2f}"].solve(true.case, true.q)
    frame = true.case.linkage.links["0"].points.values()
    for k in range(len(true.q)):
        points = [complex(x[k]) for x in true.exact.positions.values()]
        grid = millimetres * sheet_scale([*frame, *points], pad=30.0)[1]
        off = [abs(complex(found.positions[p][k] - true.exact.positions[p][k])) / grid for p in found.positions]
        assert max(off) < 2


def test_what_is_drawn_to_half_a_millimetre_comes_within_the_five_percent_rule_on_linkages_of_class_ii():
    for name in REFERENCE_NAMES[:4]:
        found = error_of("board-0.50", name)
        assert 1e-3 < found["balancing"] < 0.05
        assert 1e-3 < max(found.values()) < 0.05


def test_a_finer_grid_makes_a_truer_drawing(name):
    fine, coarse = (error_of(f"board-{mm}", name) for mm in ("0.25", "0.50"))
    assert np.prod([coarse[q] / fine[q] for q in QUANTITIES]) > 1
    finest = Method("", "", partial(board.prepare_board, 1e-6))
    true = load_reference(name)
    assert max(relative_errors(finest.solve(true.case, true.q), true.exact).values()) < 1e-6


# the form


def test_loops_have_two_equations_each_and_one_coordinate_a_moving_link(name):
    case = load_reference(name).case
    loops = LoopEquations(case)
    contours = len(case.structure.pairs) - len(case.linkage.moving)
    assert len(loops.cut) == contours
    assert len(loops.unknowns) == 2 * contours == len(case.linkage.moving) - 1


def test_a_case_is_made_of_a_linkage_alone():
    true = load_reference("crank-rocker").case
    case = Case.of(true.linkage, "alone", true.start, true.strokes)
    q = sample_coordinates(case, 5)
    one, other = CLOSED_FORM.solve(case, q), CLOSED_FORM.solve(true, q)
    assert np.array_equal(one.balancing, other.balancing)


def test_what_a_method_does_not_give_is_nan_and_where_it_fails_its_error_is_infinite():
    exact = MethodAnswers(positions={"A": np.array([1.0 + 0j, 2.0])}, balancing=np.array([1.0, -4.0]))
    found = MethodAnswers(positions={"A": np.array([np.nan + 0j, 2.0])})
    got = relative_errors(found, exact)
    assert got["positions"] == np.inf
    assert np.isnan(got["balancing"])
    assert relative_errors(MethodAnswers(balancing=np.array([1.0, -3.0])), exact)["balancing"] == 0.25


def test_a_missed_target_is_a_failure_and_reduced_ones_are_twice_as_wide():
    row = AccuracyRow(
        "shaper", "closed", "closed", None, 1.0, dict.fromkeys(QUANTITIES, 1.5e-13) | {"positions": 1e-15}
    )
    assert len(Accuracy((row,), 360, 1, reduced=False).failures) == 4
    assert Accuracy((row,), 360, 1, reduced=True).failures == ()
    lost = AccuracyRow("shaper", "closed", "closed", None, 1.0, dict.fromkeys(QUANTITIES, float("nan")))
    assert len(Accuracy((lost,), 360, 1, reduced=True).failures) == 5


def test_the_chart_has_a_panel_for_every_quantity_and_every_family_in_its_legend():
    measured = measure_accuracy(
        ["crank-slider"], reduced=True, methods=(CLOSED_FORM, BY_NAME["newton-4"], BY_NAME["board-0.50"])
    )
    figure = draw_accuracy(measured, "crank-slider")
    panels = [axes for axes in figure.axes if axes.get_title(loc="left")]
    assert len(panels) == 5
    assert all(axes.get_xscale() == axes.get_yscale() == "log" for axes in panels)
    labels = [text.get_text() for axes in figure.axes if axes.get_legend() for text in axes.get_legend().get_texts()]
    assert {"groups (tmm), class II in closed form", "drawing board, read to 0.5 mm", "the 5 % rule"} <= set(labels)


def test_rivals_are_measured_only_where_they_are_installed(monkeypatch):
    monkeypatch.setattr(rivals, "RIVALS", ("no_such_program",))
    assert rivals.list_installed() == ((), ("no_such_program",))


# the command


def test_bench_accuracy_prints_json_and_writes_a_table_and_a_chart(tmp_path):
    done = tmm("bench", "accuracy", "--reduced", "--json", "--linkage", "crank-slider", "-o", str(tmp_path))
    assert done.returncode == 0, done.stderr
    content = json.loads(done.stdout)
    assert content["reduced"]
    assert content["failures"] == []
    rows = {row["method"]: row for row in content["rows"]}
    assert set(rows) >= {method.name for method in FEWER}
    assert rows["closed"]["errors"]["positions"] <= 1e-14
    assert rows["board-0.50"]["microseconds"] is None
    assert all(rows[m]["microseconds"] > 0 for m in ("closed", "newton-2", "multibody"))
    with (tmp_path / "accuracy.csv").open(encoding="utf-8", newline="") as file:
        written = list(csv.DictReader(file))
    assert [row["method"] for row in written] == [row["method"] for row in content["rows"]]
    assert (tmp_path / "accuracy-crank-slider.png").read_bytes().startswith(b"\x89PNG")
    assert json.loads((tmp_path / "accuracy.json").read_text(encoding="utf-8"))["positions"] == 360


def test_an_unknown_linkage_is_one_error_that_names_those_there_are():
    done = tmm("bench", "accuracy", "--linkage", "toggle")
    assert done.returncode == 2
    assert done.stderr.startswith("error: there is no reference linkage toggle; there are crank-slider,")
    assert "Traceback" not in done.stderr
