"""Near what kills a method: the answers in 50 digits, the classic failures, bounds that hold where all else lies."""

from __future__ import annotations

import csv
import json
from dataclasses import replace
from decimal import Decimal
from itertools import pairwise

import mpmath as mp
import numpy as np
import pytest
from test_commands import tmm
from write_stability_references import Closely, circles, closed, starts, written

from tmm_cli.bench import (
    FAMILIES,
    FAMILIES_BY_NAME,
    KEYS,
    PRODUCT,
    QUANTITIES,
    RIVALS,
    WRONG,
    Case,
    Method,
    MethodAnswers,
    UnsupportedLinkageError,
    close_positions,
    error_limit,
    judge_product,
    load_family_members,
    load_known_scenes,
    measure_stability,
    stability,
    stability_charts,
)
from tmm_cli.mechanics.linkage import FRAME

METHODS = {method.name: method for method in RIVALS}


@pytest.fixture(autouse=True)
def many_digits():
    with mp.workdps(Closely.digits):
        yield


def near(family, distance, seed=0):
    """The scene of a family at a distance."""
    return next(at for at in load_known_scenes(family) if at.seed == seed and at.distance == Decimal(distance))


def rows(family, *names, reduced=True):
    return measure_stability([family], reduced=reduced, methods=[METHODS[name] for name in names], own=False)


# the answers in 50 digits


def same(stated, value):
    """Whether a number or a vector of the file is the value."""
    number = mp.mpc(*map(mp.mpf, stated)) if isinstance(value, mp.mpc) else mp.mpf(stated)
    return abs(number - value) <= mp.mpf(10) ** -48 * abs(value)


@pytest.mark.parametrize(
    "family, seed, k",
    [
        ("dead-position", 1, 14),
        ("change-point", 2, 8),
        ("outer-tangent", 3, 13),
        ("stone-over-pivot", 4, 11),
        ("short-rod", 0, 10),
        ("size", 1, 9),
        ("three-in-line", 2, 6),
    ],
)
def test_answers_are_what_the_textbook_says_in_a_hundred_digits(family, seed, k):
    stored = load_family_members(family)[seed]
    scene = FAMILIES_BY_NAME[family].scene(stored.numbers, FAMILIES_BY_NAME[family].distances[k])
    assert Decimal(stored.scenes[k]["distance"]) == FAMILIES_BY_NAME[family].distances[k]
    for key, value in Closely(scene).answers().items():
        assert same(stored.scenes[k][key], value)


def test_the_triads_of_the_fold_lose_two_assemblies_there():
    family, stored = FAMILIES_BY_NAME["two-assemblies-lost"], load_family_members("two-assemblies-lost")[0]
    n = {key: value for key, value in stored.numbers.items() if key != "critical"}
    n["end"] = Decimal(float(stored.numbers["critical"]))  # near it: the fold is found to fifty digits
    begin = starts(replace(family, distances=(Decimal("1e-9"),)), n)
    assert n == stored.numbers
    distances = [float(distance) for distance in family.distances[4:]]
    apart = []
    for distance, scene in zip(family.distances[4:], stored.scenes[4:], strict=True):
        here, there = (mp.mpc(*map(mp.mpf, scene[key])) for key in ("position", "other"))
        apart.append(float(abs(here - there)))
        if distance == Decimal("1e-9"):
            found = Closely(family.scene(n, distance), begin[distance]).answers()
            assert all(same(scene[key], value) for key, value in found.items())
    # two roots that meet are apart as the square root of the distance
    assert np.polyfit(np.log(distances), np.log(apart), 1)[0] == pytest.approx(0.5, abs=0.005)


def test_a_rocker_runs_off_its_velocity_as_the_root_of_the_distance_from_a_dead_position():
    stored = load_family_members("dead-position")[0].scenes
    speeds = [abs(complex(*map(float, scene["velocity"]))) for scene in stored]
    assert [b / a for a, b in pairwise(speeds[5:14])] == pytest.approx([10**0.5] * 8, rel=0.01)


def test_the_doubles_of_a_scene_are_its_data():
    """So the distance is not quite what it is called, and the answers are for what it is."""
    at = near("outer-tangent", "1e-15", 2)
    linkage = at.scene.linkage
    it = {key: mp.mpc(linkage.local(FRAME, key)) for key in "OD"}
    A = it["O"] + mp.mpf(linkage.local("1", "A").real) * mp.expj(mp.mpf(at.scene.q))
    b, c = (mp.mpf(linkage.local(link, "B").real) for link in "23")
    share = 1 - abs(it["D"] - A) / (b + c)
    assert 1e-16 < share < 3e-15 and abs(share - mp.mpf("1e-15")) > 1e-18
    places = [circles(A, b, it["D"], c, side) for side in (1, -1)]
    assert min(abs(place - closed(at.scene)[1]) for place in places) < mp.mpf(10) ** -100
    assert written(max(places, key=lambda place: abs(place - closed(at.scene)[1]))) == json_of(at, "position")


def json_of(at, key):
    scenes = load_family_members(at.family.name)[at.seed].scenes
    return next(scene[key] for scene in scenes if Decimal(scene["distance"]) == at.distance)


# the classic failures


def test_the_law_of_cosines_loses_as_many_digits_as_the_distance_has():
    found = rows("dead-position", "cosines", reduced=False)
    errors = [row.error for row in found.select_rows("dead-position", "cosines")]
    assert errors[0] < 1e-13
    assert np.polyfit(range(1, 14), np.log10(errors[1:14]), 1)[0] == pytest.approx(1.0, abs=0.15)
    assert 1e-12 <= found.first_wrong_distance("dead-position", "cosines") <= 1e-8


def test_at_a_change_point_the_law_of_cosines_knows_nothing_from_a_hundred_millionth_on():
    found = rows("change-point", "cosines", "freudenstein", "closed", reduced=False)
    for method in ("cosines", "freudenstein"):
        assert found.first_wrong_distance("change-point", method) >= 1e-6
        assert all(row.right == 0 for row in found.select_rows("change-point", method) if row.distance <= 1e-7)
    assert all(
        row.wrong == 0 for row in found.select_rows("change-point", "closed") if row.distance <= 1e-8
    )  # it says so


@pytest.mark.parametrize("family", ["dead-position", "stone-over-pivot"])
def test_newton_at_a_loose_tolerance_lies(family):
    assert rows(family, "newton-2").first_wrong_distance(family, "newton-2") >= 1e-5


def test_newton_at_a_tight_tolerance_says_that_it_does_not_converge():
    found = rows("dead-position", "newton-15").select_rows("dead-position", "newton-15")
    assert all(row.wrong == 0 for row in found) and found[-1].said == found[-1].scenes


def test_a_plan_has_letters_at_all_ends_where_rounding_parts_them():
    at = near("dead-position", "1e-15")
    with np.errstate(all="ignore"):
        answers = METHODS["board-0.25"].prepare(Case.of(at.scene.linkage))(np.array([at.scene.q]))
    assert isinstance(answers, MethodAnswers)


@pytest.mark.parametrize("family", ["dead-position", "short-rod", "inner-tangent"])
def test_differencing_lies_as_soon_as_its_step_is_no_longer_short(family):
    found = rows(family, "differences-4", reduced=False)
    assert found.first_wrong_distance(family, "differences-4") >= 1e-4


def test_a_long_rod_takes_all_digits_from_differences():
    found = rows("long-rod", "differences-4", "cosines")
    assert found.select_rows("long-rod", "differences-4")[-1].error > 0.1
    assert found.first_wrong_distance("long-rod", "cosines") is None


def test_size_and_three_points_in_line_harm_no_formula():
    for family in ("size", "three-in-line"):
        found = rows(family, "closed", "cosines", "freudenstein")
        assert all(row.error < 1e-9 and row.right == row.scenes for row in found.rows if row.method != PRODUCT)


# ours


@pytest.fixture(scope="module")
def own():
    """The product alone, in few scenes of all families."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(stability, "SEEDS_WHEN_REDUCED", 1)
        return measure_stability(methods=(), reduced=True)


@pytest.mark.parametrize("family", [family.name for family in FAMILIES if family.name != "two-assemblies-lost"])
def test_no_value_of_ours_is_outside_its_bound(family):
    for at in load_known_scenes(family, 2, 7):
        if at.seed == 0:
            continue  # among those of `own`
        shot = judge_product(Case.of(at.scene.linkage), at)
        assert shot.verdict in ("right", "said"), (at.seed, at.distance, shot)
        assert shot.verdict == "said" or max(shot.errors.values()) <= WRONG


def test_no_value_of_a_class_iii_group_is_outside_its_bound_where_it_loses_two_assemblies(own):
    found = own.select_rows("two-assemblies-lost", PRODUCT)
    assert [row.distance for row in found] == [0.1, 1e-5, 1e-9, 1e-13, 1e-15]
    assert all(row.wrong == 0 for row in found) and all(row.right == 1 for row in found[:3])


def test_nine_of_ten_bounds_are_within_a_hundred_times_the_error(own):
    assert len(own.widths) > 300 and len(own.families) == 10
    assert own.sharp >= 0.9 and not own.failures
    assert min(own.widths) >= 1


def test_bounds_that_are_too_narrow_are_found_out(monkeypatch):
    honest = stability.bound_values

    def boasting(results):
        values, found = honest(results)
        found.bound = {key: bound / 1000 for key, bound in found.bound.items()}
        found.bound["balancing", "1", ""] = np.array([np.nan])  # what is not told excuses nothing
        return values, found

    monkeypatch.setattr(stability, "bound_values", boasting)
    found = measure_stability(["stone-over-pivot"], methods=(), reduced=True)
    assert found.first_wrong_distance("stone-over-pivot", PRODUCT) == 0.1
    assert "stone-over-pivot: 2 of 2 outside their error bounds at 0.1" in found.failures


def test_bounds_that_are_too_wide_are_found_out(monkeypatch):
    honest = stability.bound_values

    def timid(results):
        values, found = honest(results)
        found.bound = {key: bound * 1e4 for key, bound in found.bound.items()}
        return values, found

    monkeypatch.setattr(stability, "bound_values", timid)
    found = measure_stability(["size"], methods=(), reduced=True)
    assert found.first_wrong_distance("size", PRODUCT) is None
    assert len(found.failures) == 1 and "of the bounds are within 100 times the true error" in found.failures[0]


# what is thought of an answer


def answering(place, name="x", family="x", setting=None):
    """A method that answers one place and nothing else."""
    return Method(name, family, lambda case: lambda q: MethodAnswers({"B": np.array([place])}), setting)


def test_an_answer_is_right_wrong_or_not_given():
    at = near("three-in-line", "0.1")
    true, size = complex(at.exact["positions"]), at.largest["positions"]

    def verdict(method):
        return stability.judge_method(method, method.prepare(None), at).verdict

    assert verdict(answering(true)) == "right"
    assert verdict(answering(true + 2 * WRONG * size)) == "wrong"
    assert verdict(answering(-true)) == "wrong"
    assert verdict(answering(complex("nan"))) == "said"
    assert verdict(answering(true + 0.05 * size, "newton-2", "newton", 1e-2)) == "right"
    assert verdict(answering(true + 0.2 * size, "newton-2", "newton", 1e-2)) == "wrong"
    assert verdict(answering(true + 0.04 * size, "board-0.50", "board", 0.5)) == "right"


def test_methods_are_held_to_what_they_state():
    assert error_limit(METHODS["newton-2"]) == pytest.approx(0.1)
    assert (
        error_limit(METHODS["newton-15"])
        == error_limit(METHODS["closed"])
        == error_limit(METHODS["differences-4"])
        == WRONG
    )
    assert error_limit(METHODS["board-0.25"]) == 0.05


def test_a_method_that_raises_says_so():
    def raising(case):
        raise np.linalg.LinAlgError("singular")

    found = measure_stability(["long-rod"], reduced=True, methods=[Method("x", "x", raising)], own=False).select_rows(
        "long-rod", "x"
    )
    assert all(row.said == row.scenes and row.why == ("LinAlgError",) for row in found)


def test_newtons_method_gives_nothing_where_it_does_not_converge():
    class Parabola:
        """x^2 = q: no root on the negative side."""

        def residuals(self, X, q):
            return X**2 - q[:, None]

        def matrix(self, X, q):
            return 2 * X[..., None]

    found = close_positions(Parabola(), np.array([[1.5], [1.5]]), np.array([2.0, -1.0]), 1e-12)
    assert found[0, 0] == pytest.approx(2**0.5) and np.isnan(found[1, 0])


def test_the_textbook_has_no_formula_for_other_linkages():
    at = near("stone-over-pivot", "0.1")
    with pytest.raises(UnsupportedLinkageError):
        METHODS["cosines"].prepare(Case.of(at.scene.linkage))


# the command


def test_the_command_meets_its_targets_and_writes_what_it_found(tmp_path):
    done = tmm("bench", "stability", "--family", "dead-position", "--reduced", "--json", "-o", tmp_path)
    assert done.returncode == 0, done.stderr
    assert "all targets met" in done.stderr
    assert {path.name for path in tmp_path.iterdir()} == {"stability.csv", "stability.json", "stability-1.png"}
    content = json.loads(done.stdout)
    assert json.loads((tmp_path / "stability.json").read_text(encoding="utf-8")) == content
    assert set(content["first_lie"]) == {"dead-position"}
    assert content["first_lie"]["dead-position"]["tmm"] is None
    assert content["first_lie"]["dead-position"]["newton-2"] >= 1e-9
    assert content["sharp"] >= 0.9 and content["failures"] == []
    assert all(row["right"] + row["said"] + row["wrong"] == row["scenes"] for row in content["rows"])
    with (tmp_path / "stability.csv").open(encoding="utf-8") as stream:
        (product,) = [line for line in csv.DictReader(stream) if line["method"] == PRODUCT]
    assert product["dead-position"] == "never"


def test_the_table_says_where_each_method_lies_first(own):
    (table,) = own.tables
    method, *families = ([column.header, *column.values] for column in table.columns)
    assert method == ["method", PRODUCT] and all(told[1] == "never" for told in families)


def test_an_unknown_family_is_one_clear_error():
    done = tmm("bench", "stability", "--family", "nothing")
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr.startswith("error: there is no family nothing; there are dead-position,")


def test_a_sheet_has_a_panel_a_family_and_a_row_a_method():
    some = [METHODS[name] for name in ("closed", "cosines")]
    found = measure_stability(["long-rod", "size"], reduced=True, methods=some)
    (figure,) = stability_charts(found).values()
    assert len(figure.axes) == 4
    rows_of = [label.get_text() for label in figure.axes[1].get_yticklabels()]
    assert rows_of[0] == PRODUCT and set(rows_of) <= set(found.methods)
    assert all(set(row.errors) == set(QUANTITIES) and set(KEYS) == set(QUANTITIES) for row in found.rows)
