"""Every number has a bound of its error: against 60 and 120 digits, in all classes, near dead positions, of any size.

Width of a bound: how many times larger it is than the true error, or than a quarter of the last place of the number
where the error is less (an answer that is right by accident cannot be told from one that is right by that much).
Numbers that are exact are not counted.
"""

from __future__ import annotations

import cmath
import csv
import json
import re
from collections import defaultdict
from dataclasses import replace
from functools import cache

import blocks
import mpmath as mp
import multibody
import numpy as np
import pytest
from bank import moved, solved
from fuzz import beyond
from models import PROBLEMS
from random_linkages import any_linkage, linkage
from test_commands import ROOT, SHAPER, described, tmm

from tmm_cli import load, solve
from tmm_cli.mechanics.accuracy import (
    Digits,
    PreciseLinkage,
    bound_values,
    change_length,
    exact_linkage,
    judge_searched,
    largest_values,
    list_lengths,
    list_values,
    relative_bound,
    results_with_linkage,
    solve_bare_linkage,
)
from tmm_cli.mechanics.assembly import assemble
from tmm_cli.mechanics.forces import LeverItem, ZhukovskyLever
from tmm_cli.mechanics.groups import RISE_LAWS
from tmm_cli.mechanics.kinematics import find_range
from tmm_cli.mechanics.linkage import FRAME, Driver, Hinge, Link, Linkage, Load, Sketch
from tmm_cli.mechanics.numerics import ROUNDOFF, to_double_double
from tmm_cli.mechanics.quantities import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    FORCE,
    LENGTH,
    MOMENT,
    SPEED,
)
from tmm_cli.mechanics.structure import analyse_structure
from tmm_cli.problem import build_any_problem, build_problem, read_text
from tmm_cli.reports import (
    assess_accuracy,
    computed_tables,
    numbers_at_positions,
    tables_of,
    terminal_cells as shown,
    true_digits,
)

BARRED = """tmm: 1
units: {length: m, angle: rad}
points: {O: [0, 0], D: [1, 0]}
links:
  1: {points: [O, A], length: 0.8}
  2: {points: [A, B], length: 0.7}
  3: {points: [D, B], length: 0.6}
driver: {link: 1, speed: 10}
sketch: {at: 1, B: [1.05, 0.6]}
"""
NOTHING = 1e-22  # of a value: less is what 60 digits and their differences leave
CLASSES = [
    (3, ("RRR",)),
    (36, ("RRP",)),
    (41, ("RPR",)),
    (24, ("RPP", "PRP")),
    (53, ("RRP", "RPR", "RRR")),
    (0, ("III",)),
    (3, ("IV",)),
    (4, ("III", "RRR")),
]


@pytest.fixture
def many_digits(monkeypatch):
    """Differences in the reference so fine that they are right at 1e-14 from a dead position."""
    for name, value in (("digits", 120), ("step", mp.mpf(10) ** -45), ("bend", mp.mpf(10) ** -35), ("rounds", 9)):
        monkeypatch.setattr(multibody.Multibody, name, value)
    yield
    mp.mp.dps = 60


def made(seed, kinds):
    return any_linkage(seed, kinds) if any(kind in ("III", "IV") for kind in kinds) else linkage(seed, kinds)


def four_bar(size=1.0):
    """A four-bar whose crank cannot turn fully, of any size."""
    a, b, c, d = 0.9 * size, 1.1 * size, 0.7 * size, 1.3 * size
    A = a * cmath.exp(1j)
    base = abs(d - A)
    x = (base**2 + b**2 - c**2) / (2 * base)
    B = A + (d - A) / base * complex(x, (b**2 - x**2) ** 0.5)
    links = {
        FRAME: Link(FRAME, {"O": 0j, "D": complex(d)}),
        "1": Link("1", {"O": 0j, "A": complex(a)}, 1.0, 0.1 * size**2, complex(0.4 * a)),
        "2": Link("2", {"A": 0j, "B": complex(b), "K": complex(0.4 * b, 0.2 * size)}, 2.0, 0.2 * size**2, 0.5 * b + 0j),
        "3": Link("3", {"D": 0j, "B": complex(c)}, 1.5, 0.1 * size**2, complex(0.5 * c)),
    }
    hinges = (Hinge("O", (FRAME, "1")), Hinge("A", ("1", "2")), Hinge("B", ("2", "3")), Hinge("D", (FRAME, "3")))
    load = Load("F", "3", complex(0.8 * c), 30 + 10j)
    return Linkage(links, hinges, (), Driver("1", "turn", "O", 2.0, 0.3), Sketch(1.0, {"A": A, "B": B}), (load,))


def truth(body, it, structure, k):
    """Position k in many digits, by quantity, name and component; of pairs with the link the reaction is on."""
    X, V, A, multipliers = body.at(k)
    found = {}

    def put(quantity, name, value):
        if isinstance(value, mp.mpc):
            found[quantity, name, "x"], found[quantity, name, "y"] = value.real, value.imag
        else:
            found[quantity, name, ""] = value

    for name, i in body.at_row.items():
        z = body.pose(X, name)[1]
        for quantity, values in (("angle", X), ("omega", V), ("epsilon", A)):
            put(quantity, name, values[i + 2])
        points = {p: at for p, at in it.links[name].points.items() if p not in it.links[FRAME].points}
        for point, local in {**points, f"S{name}": it.links[name].centre}.items():
            arm = mp.mpc(local) * z
            put("x", point, mp.mpc(X[i], X[i + 1]) + arm)
            put("v", point, mp.mpc(V[i], V[i + 1]) + 1j * V[i + 2] * arm)
            put("a", point, mp.mpc(A[i], A[i + 1]) + (1j * A[i + 2] - V[i + 2] ** 2) * arm)
    for pair in structure.pairs:
        row = body.row_of(pair)
        if pair.kind == "R":
            put("force", (pair.name, pair.i), mp.mpc(multipliers[row], multipliers[row + 1]))
        else:
            across = 1j * body.pose(X, pair.i)[1] * mp.expj(mp.mpf(pair.slide.direction))
            put("force", (pair.name, pair.j), multipliers[row + 1] * across)
            put("couple", (pair.name, pair.j), multipliers[row])
    first = body.size - len(it.drivers)
    for row, driver in enumerate(it.drivers, first):
        put("balancing", driver.link, multipliers[row])
    return found


def judged(it, q, kernels, bounded=True):
    """(value, true error, bound) of every quantity at every place that is not refused."""
    structure = analyse_structure(it)
    results = solve_bare_linkage(it, q, structure, kernels)
    nothing = Digits(defaultdict(lambda: np.full(len(q), np.nan)))
    values, digits = bound_values(results) if bounded else (list_values(results), nothing)
    body = multibody.Multibody(it, structure, results.motion)
    rows = []
    for k in np.flatnonzero(results.motion.moving):
        X = np.zeros(body.size)
        for name, i in body.at_row.items():
            pose = results.motion.poses[name]
            X[i : i + 3] = pose.x[k].real, pose.x[k].imag, np.angle(pose.z[k])
        X[body.at_row[it.driver.link] + 2] = q[k]
        body.walked = lambda place, X=X: X
        for (quantity, name, component), true in truth(body, it, structure, k).items():
            sign = 1
            if isinstance(name, tuple):
                name, on = name
                sign = 1 if results.reactions.of(name).on == on else -1
            key = quantity, name, component
            error = abs(sign * mp.mpf(float(values[key][k])) - true)
            if quantity == "angle":
                error = abs(error - 2 * mp.pi * mp.nint(error / (2 * mp.pi)))
            error = float(error) if error > NOTHING * max(abs(true), 1e-3) else 0.0
            rows.append((key, float(abs(true)), error, float(digits.bound[key][k])))
    return rows, results


def assembled(it):
    """The groups of a linkage, and how far its driver can go."""
    kernels = assemble(it, analyse_structure(it))
    return kernels, find_range(it, kernels)


@cache
def near_the_ends(seed, kinds):
    """What is judged at two places near an end of the way of a random linkage; nothing where it has none."""
    it = any_linkage(seed, kinds)
    kernels, way = assembled(it)
    if way.full:
        return []
    return judged(it, np.array(way.end - 10.0 ** -np.random.default_rng(seed).uniform(2, 13, 2)), kernels)[0]


def widths(rows):
    return [bound / max(error, ROUNDOFF / 4 * size) for _, size, error, bound in rows if error > 0]


def test_no_error_is_beyond_its_bound_in_any_class_and_bounds_are_narrow():
    linkages = [made(seed, kinds) for seed, kinds in CLASSES]
    rows = [row for it in linkages for row in judged(it, it.sketch.at + np.array([0.0, 0.01]), assembled(it)[0])[0]]
    assert len(rows) > 1000
    assert [row for row in rows if not row[2] <= row[3]] == []
    assert np.mean(np.array(widths(rows)) <= 100) >= 0.95


@pytest.mark.parametrize("size", [1e-9, 1.0, 1e9])
def test_bounds_hold_on_the_way_to_a_dead_position_or_the_position_is_refused(size, many_digits):
    it = four_bar(size)
    kernels, way = assembled(it)
    q = np.append(way.end - 10.0 ** -np.arange(2, 15, 3), way.end)
    rows, results = judged(it, q, kernels)
    assert results.motion.moving.tolist() == [True] * 5 + [False]
    assert [row for row in rows if not row[2] <= row[3]] == []
    worst = max(bound / size for _, size, _, bound in rows if size > 0 and bound < size)
    assert worst < 1e-12, "however near, the numbers of double-doubles have all the digits that are printed"


@pytest.mark.parametrize("kinds", [("RRP",), ("RPR",), ("PRP",), ("III",), ("IV",), ("RPR", "RRP")])
def test_bounds_hold_near_the_ends_of_the_way_of_every_class(kinds, many_digits):
    rows = [row for seed in range(2) for row in near_the_ends(seed, kinds)]
    assert len(rows) > 50
    assert [row for row in rows if not row[2] <= row[3]] == []


def test_bounds_are_narrow_near_dead_positions(many_digits):
    some = [(seed, kinds) for kinds in (("RRR",), ("RRP",), ("RPR",), ("IV",)) for seed in range(2)]
    found = widths([row for seed, kinds in some for row in near_the_ends(seed, kinds)])
    assert np.mean(np.array(found) <= 100) >= 0.95


DIMENSIONS = {
    "x": LENGTH,
    "v": SPEED,
    "a": ACCELERATION,
    "angle": ANGLE,
    "omega": ANGULAR_SPEED,
    "epsilon": ANGULAR_ACCELERATION,
    "force": FORCE,
    "couple": MOMENT,
    "balancing": MOMENT,
}


@pytest.mark.parametrize("kinds", [kinds for _, kinds in CLASSES])
def test_margins_of_the_groups_bound_the_errors_on_the_way_and_near_its_ends(kinds):
    for seed in range(2):
        it = made(seed, kinds)
        kernels, way = assembled(it)
        near = [] if way.full else way.end - 10.0 ** -np.random.default_rng(seed).uniform(1, 12, 2)
        rows, results = judged(it, np.array([it.sketch.at, *near]), kernels, bounded=False)
        share, size = relative_bound(results), largest_values(results)
        places = np.repeat(np.flatnonzero(results.motion.moving), len(rows) // np.sum(results.motion.moving))
        for place, (key, _, error, _) in zip(places, rows, strict=True):
            assert error <= share[place] * size[DIMENSIONS[key[0]]], (seed, key)


@pytest.mark.parametrize("name", ["shaper", "excavator", "five-point-line", "clamp"])
def test_what_an_ordinary_run_says_of_its_digits_holds_in_double_doubles(name):
    results = solved(name)
    found = assess_accuracy(results)
    assert not found.chosen.size, "no position needs to be judged"
    assert beyond(results) is None


def test_a_heavy_link_that_does_not_turn_has_the_error_of_its_couple_all_the_same():
    text = (PROBLEMS / "shaking-screen.yaml").read_text().replace("inertia: 1.5,", "inertia: 1.5e+11,")
    assert "1.5e+11" in text and beyond(solve(build_any_problem(read_text(text, "screen.yaml")))) is None


def test_a_mass_at_rest_reduces_to_nothing_within_its_bound():
    text = (PROBLEMS / "crossed-slots.yaml").read_text(encoding="utf-8")
    text = text.replace("inertia: 0.1", "inertia: 0")
    assert "inertia: 0," in text and beyond(solve(build_any_problem(read_text(text, "slots.yaml")))) is None


def test_a_force_next_to_nothing_acts_far_away_and_that_is_known_no_better_than_the_force():
    text = (PROBLEMS / "planetary-dwell-press.yaml").read_text(encoding="utf-8")
    text = re.sub(r"positions:.*", "positions: {count: 24, from: 9.000000000000001e-08}", text)
    results = solve(build_any_problem(read_text(text, "press.yaml")))
    assert "9.0000" in text and beyond(results) is None


@pytest.mark.parametrize("law", RISE_LAWS)
def test_every_law_of_a_cam_is_known_to_its_bounds(law):
    text = (PROBLEMS / "cam-lever.yaml").read_text(encoding="utf-8").replace("law: sine", f"law: {law}")
    assert beyond(solve(build_any_problem(read_text(text, "cam.yaml")))) is None


def test_a_further_driver_many_turns_from_its_place_in_the_sketch_is_known_to_the_rounding_of_its_turns():
    text = (PROBLEMS / "five-bar.yaml").read_text(encoding="utf-8").replace("sketch: {at: 90,", "sketch: {at: 90000,")
    assert "90000" in text and beyond(solve(build_any_problem(read_text(text, "five-bar.yaml")))) is None


def test_digits_are_judged_when_they_are_asked_for_only(tmp_path):
    done = tmm("forces", SHAPER, "-o", tmp_path)
    result = json.loads((tmp_path / "shaper" / "result.json").read_text(encoding="utf-8"))
    assert "digits" not in result and not (tmp_path / "shaper" / "digits.csv").exists()
    assert "due to errors of drawing" not in done.stdout
    told = tmm("forces", SHAPER, "--digits").stdout
    shares = [float(share) for share in re.findall(r"(?:mm, by up to) (\S+) %", " ".join(told.split()))]
    assert shares and max(shares) < 100, "of the largest value of a column, or of the stroke"


@pytest.mark.parametrize("left", ["1e-4", "1e-8", "1e-11"])
def test_a_position_near_a_dead_one_blurs_no_extreme_and_a_largest_angle_at_an_end_is_where_the_end_is(left):
    end = mp.acos((mp.mpf("0.64") + 1 - mp.mpf("1.69")) / mp.mpf("1.6"))  # coupler and rocker in line
    text = BARRED.replace("angle: rad", "angle: deg").replace("at: 1,", "at: 1 rad,")
    places = f"output: 3\npositions: {{at: [0.2 rad, 0.5 rad, {mp.nstr(end - mp.mpf(left), 25)} rad]}}\n"
    results = solve(build_problem(read_text(text + places, "barred.yaml")), "kinematics")
    quality, pressure = assess_accuracy(results).with_bounds(tables_of(results, ("quality", "pressure")))
    units = results.problem.units
    told = dict(zip(quality.columns[0].values, shown(quality.columns[1], units, range(quality.rows)), strict=True))
    stretched = mp.degrees(mp.pi - mp.acos((1 + mp.mpf("0.36") - mp.mpf("2.25")) / mp.mpf("1.2")))  # crank and coupler
    assert told["largest driver coordinate"] == f"{float(mp.degrees(end)):.6g}"
    swing = float(told["swing angle ψ of link 3 over the requested positions"])
    assert float(told["extreme position of link 3"]) - swing == pytest.approx(float(stretched), abs=1e-3)
    place = next(column for column in pressure.columns if column.header == "driver position at the largest angle")
    assert shown(place, units, [0]) == [f"{float(mp.degrees(-end)):.6g}"]  # it is the same at both ends of the way


def test_a_pressure_angle_that_is_the_same_everywhere_has_no_place_of_its_largest():
    results = moved("gear-doubling")
    (pressure,) = assess_accuracy(results).with_bounds(tables_of(results, ("pressure",)))
    place = next(column for column in pressure.columns if column.header == "driver position at the largest angle")
    assert "-" in shown(place, results.problem.units, range(pressure.rows))


def test_half_a_unit_of_the_last_figure_is_not_below_the_bound():
    values, bound = np.array([3.14159, 3.14159, 3.14159, 9.99, 0.0, 5.0]), np.array([4e-6, 6e-6, 4.0, 1e-16, 0.0, 0.0])
    assert true_digits(values, bound).tolist() == [6, 5, 0, 15, 0, 16]


def test_decimals_that_arithmetic_left_behind_a_number_of_teeth_are_none_in_more_digits_either():
    text = blocks.PLANET.replace("teeth: [40, 20]", "teeth: [40.0000000004, 20]")
    results = solve(build_any_problem(read_text(text, "x.yaml")))
    assert beyond(results) is None
    assert results.motion.link("2").first == pytest.approx(3, abs=1e-15)


def test_strokes_of_a_central_crank_slider_are_known_to_their_bounds():
    results = moved("crank-slider")
    found = judge_searched(
        results,
        lambda r: {"H": np.array([r.strokes.travel]), "k": np.array([r.strokes.k])},
        PreciseLinkage(results),
        0.001,
    )
    for key, value, true in (("H", results.strokes.travel, mp.mpf("0.12")), ("k", results.strokes.k, mp.mpf(1))):
        assert abs(mp.mpf(value) - true) <= found.bound[key][0] < 1e-14
    assert found.lengths["H"][0] == pytest.approx(2 * 0.06e-3), "H = 2 r"


def test_a_largest_pressure_angle_goes_with_crank_and_rod_as_its_sine_their_ratio_says():
    results = moved("crank-slider")
    found = judge_searched(
        results, lambda r: {"largest": np.array([r.pressure[0].largest])}, PreciseLinkage(results), 0.001
    )
    by_both = 2 * 1e-3 * np.tan(results.pressure[0].largest)
    assert found.lengths["largest"][0] == pytest.approx(by_both, rel=1e-4)


def test_an_end_of_the_way_moves_with_the_lengths_as_the_stretched_rod_and_rocker_say():
    a, b, c, d = 0.8, 0.7, 0.6, 1.0
    results = solve(build_problem(read_text(BARRED, "barred.yaml")), "kinematics")
    found = judge_searched(results, lambda r: {"end": np.array([r.driver_range.end])}, PreciseLinkage(results), 0.001)
    cosine = (a**2 + d**2 - (b + c) ** 2) / (2 * a * d)
    slopes = [1 / d - cosine / a, (b + c) / (a * d), (b + c) / (a * d), 1 / a - cosine / d]
    by_lengths = sum(abs(slope) * x for slope, x in zip(slopes, (a, b, c, d), strict=True))
    assert found.lengths["end"][0] == pytest.approx(1e-3 * by_lengths / np.sqrt(1 - cosine**2), rel=1e-4)


def test_sensitivity_is_that_of_a_larger_change_of_the_data():
    problem = load(str(ROOT / "problems" / "crank-rocker.yaml"))
    places = replace(problem.request, places=tuple(0.3 + 0.7 * k for k in range(8)))
    problem = replace(problem, request=places, extended=None)
    found = assess_accuracy(solve(problem), full=True)
    base, total = numbers_at_positions(found.there), {}
    for length in list_lengths(problem.linkage):
        by = 1e-3 * abs(length.value)
        moved = [
            numbers_at_positions(solve(replace(problem, linkage=change_length(problem.linkage, length, sign * by))))
            for sign in (1, -1)
        ]
        for key in base:
            if key[1] == "link-motion" and not key[0]:
                total[key] = total.get(key, 0) + np.abs(moved[0][key] - moved[1][key]) / 2
    for key, change in total.items():
        assert found.digits.lengths[key] == pytest.approx(change, rel=0.05, abs=1e-3 * np.max(change) + 1e-9), key


def test_digits_stand_beside_the_values():
    done = tmm("kinematics", ROOT / "problems" / "crank-slider.yaml", "--digits", "--position", "3")
    lines = [" ".join(line.split()) for line in done.stdout.splitlines()]
    assert done.returncode == 0
    start = lines.index("item value ± rounding error ± due to length errors ± due to drawing errors unit")
    quality = [re.sub(r"\S+e-1[3-9]", "tiny", line) for line in lines[start + 2 : start + 12]]
    assert quality == [
        "stroke H of link 3 120 tiny 0.12 2 mm",
        "time ratio k 1 tiny 0 0",
        "1/k = T_return/T_working 1 tiny 0 0",
        "angle theta = 180 deg (k − 1)/(k + 1) 0 tiny 0 0 deg",
        "driver position at the start of the working stroke 180 tiny 0 0 deg",
        "position of link 3 at this driver position 160 tiny 0.28 2 mm",
        "driver travel during the working stroke 180 tiny 0 0 deg",
        "driver position at the start of the return stroke 0 tiny 0 0 deg",
        "position of link 3 at this driver position 280 tiny 0.28 2 mm",
        "driver travel during the return stroke 180 tiny 0 0 deg",
    ]
    assert any(line.startswith("cycle s of link 3 ") for line in lines)


def test_what_is_zero_within_its_bound_prints_as_zero_and_files_hold_true_digits_only(tmp_path):
    assert tmm("run", SHAPER, "-o", tmp_path, "--no-drawings", "--digits").returncode == 0
    folder = tmp_path / "shaper"
    cycle = list(csv.DictReader((folder / "cycle.csv").open(encoding="utf-8")))
    assert cycle[0]["v of 5, m/s"] == "0", "at the end of its stroke the output stands still"
    assert {row["difference, %"] for row in cycle} == {"0"}
    digits = list(csv.DictReader((folder / "digits.csv").open(encoding="utf-8")))
    assert {row["table"] for row in digits} >= {"quality", "cycle", "points", "reactions", "lever", "energy"}
    assert all(int(row["correct digits"]) >= 12 for row in digits if row["table"] in ("points", "reactions", "cycle"))


def test_result_json_has_a_bound_in_the_place_of_every_number():
    result = json.loads(tmm("forces", SHAPER, "--json", "--digits").stdout)
    described(result, json.loads(tmm("schema", "--result").stdout), "")
    digits = result["digits"]
    assert digits["scale"] > 0
    for part in ("bound", "lengths", "paper"):
        for group in ("kinematics", "forces", "lever", "energy", "positions", "output"):
            assert group in digits[part], (part, group)
        x = digits[part]["kinematics"]["points"]["E"]["x"]["x"]
        assert len(x) == len(result["positions"]["number"]) and all(v is None or v >= 0 for v in x)
    assert digits["bound"]["output"]["travel"] < 1e-15 < digits["lengths"]["output"]["travel"] < 0.01


def test_rows_of_the_lever_are_those_in_doubles_and_a_couple_that_is_zero_keeps_its_ratio():
    """With other numbers the couples of two links are zero and have no items; omega_link/omega_1 stays what it is."""
    results = solved("crank-rocker")
    lever, motion = results.lever, results.motion
    fewer = replace(lever, items=tuple(item for item in lever.items if item.end is not None))
    couples = [item for item in lever.items if item.end is None]
    assert couples and len(fewer.items) < len(lever.items)
    filled = fewer.with_rows_of(lever, motion)
    assert [item.key for item in filled.items] == [item.key for item in lever.items]
    for item, shown_item in zip(filled.items, lever.items, strict=True):
        assert np.array_equal(item.arm, shown_item.arm, equal_nan=True)
        assert np.all(item.moment == (0 if shown_item.end is None else shown_item.moment))


def test_of_a_long_cycle_some_positions_are_judged_and_the_bounds_between_them_hold():
    problem = load(str(SHAPER))
    results = solve(replace(problem, request=replace(problem.request, count=2900)), "kinematics")
    found = assess_accuracy(results, full=True)
    assert len(found.chosen) < 800
    (table,) = (t for t in computed_tables(results) if t.name == "slides")
    told = found.table(table)
    wide = numbers_at_positions(
        results_with_linkage(results, exact_linkage(results), to_double_double(results.motion.q), results.start)
    )
    for header in ("s", "v relative", "a relative"):
        k, column = next((k, c) for k, c in enumerate(told.columns) if c.header == header)
        expected = [wide[False, "slides", k, row] for row in range(2)]
        error = np.abs(column.values - np.stack(expected, axis=1).ravel())
        assert np.all(error <= column.bound), header


def test_a_load_by_the_stroke_is_judged_in_files_too(tmp_path):
    """Its strokes are computed anew with each length changed; then the largest of their travels is one of arrays."""
    assert tmm("forces", ROOT / "problems" / "toggle-press.yaml", "--digits", "-o", tmp_path).returncode == 0


def test_a_moment_by_the_swing_of_its_rocker_is_judged():
    """In float64 and in double-doubles the angle of the rocker is the same but for whole turns."""
    text = (ROOT / "problems" / "crank-rocker.yaml").read_text(encoding="utf-8")
    constant, table = "moment: -40 N*m", "{against: share of stroke, table: [[0, -10], [0.4, -30], [1, -5]]}"
    assert constant in text
    results = solve(build_problem(read_text(text.replace(constant, f"moment: {table}"), "x.yaml")))
    name = next(one for one in computed_tables(results) if one.name == "balance")
    moment = next(column for column in assess_accuracy(results).table(name).columns if column.header == "M_b")
    assert 0 < np.max(moment.bound) < 1e-10 * np.max(np.abs(moment.array))
    assert beyond(results) is None


def test_a_load_named_as_an_inertia_couple_keeps_its_own_row_of_the_lever():
    motion = solved("crank-rocker").motion
    zero = np.zeros(np.shape(motion.q))
    rows = tuple(LeverItem("M3", "3", zero + size, zero, zero + size) for size in (0.03, -20.0))
    shown = ZhukovskyLever(rows, zero, zero)
    assert [row.size[0] for row in shown.with_rows_of(shown, motion).items] == [0.03, -20.0]
    without = ZhukovskyLever(rows[:1], zero, zero)
    assert [row.size[0] for row in without.with_rows_of(shown, motion).items] == [0.03, 0.0]
