"""Groups that are found by iteration, on a tape: Newton's steps from tables, and the ordinary stages for the rest."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from models import CLASS_III, linkage_of
from test_tape import agree, kind, largest_of_kinds, plainly

from tmm_cli.batch import prepare_batch
from tmm_cli.bench import load_reference, relative_errors
from tmm_cli.bench.methods import product as taped
from tmm_cli.mechanics.numerics import EliminatedSystem, EliminationOrder
from tmm_cli.problem import build_problem, read_text

ROUND = np.linspace(0.123, 6.28, 90)
ROCKED = CLASS_III + "sketch: {at: 250 deg, 1: 1, 2: 38, 3: 124, 4: 29}"


@pytest.mark.parametrize("name", ["press-class-iii", "class-iv", "summing-lever", "triad-six-assemblies"])
def test_groups_of_higher_class_close_all_round_in_one_step(name):
    batch = prepare_batch(linkage_of(name))
    assert np.all(batch.closed(ROUND))
    found, plain = batch(ROUND), plainly(batch, ROUND)
    plain = {n: value for n, value in plain.items() if np.max(np.abs(value)) > 1e-12}  # of guides without a couple
    agree({n: found[n] for n in plain}, plain, 1e-14)


@pytest.mark.parametrize(
    "name", ["sector-and-wheel", "planet-on-rocker", "rack-doubling", "three-lobes", "cardan-gear"]
)
def test_wheels_and_racks_are_written_down_with_the_turns_of_their_links(name):
    batch = prepare_batch(linkage_of(name))
    q = batch.linkages[0].sketch.at + 3 * ROUND - 8  # their angles go on beyond a turn
    assert batch.program is not None and np.all(batch.closed(q))
    found = batch(q)
    agree({n: found[n] for n in found}, plainly(batch, q), 1e-13)


def test_a_press_of_class_iii_is_right_to_the_last_digits():
    """Against 50 digits, relative to the largest value of the same point or pair; the stages have 1.3e-15."""
    press = load_reference("press-class-iii")
    found = relative_errors(taped.prepare_traced(press.case)(press.q), press.exact)
    assert all(error < 4e-15 for error in found.values()), found


def test_margins_are_those_of_the_whole_jacobian():
    batch = prepare_batch(linkage_of("press-class-iii"))
    assert np.allclose(batch.sound(ROUND)["margin"], replace(batch, checks=None).sound(ROUND)["margin"], rtol=1e-12)


def test_the_rest_beside_and_beyond_the_ends_of_the_way_is_what_the_stages_say():
    batch = prepare_batch(build_problem(read_text(ROCKED, "iii.yaml")).linkage)
    low, high = batch.kernels[-1].trace.q[[0, -1]]
    q = np.sort([*np.linspace(low - 0.1, high + 0.1, 40), *(low + np.logspace(-12, -3, 10))])
    taped, alone = batch.closed(q), replace(batch, program=None, checks=None)
    assert np.any(taped) and not np.all(taped[(q > low) & (q < high)]) and not np.any(taped[(q < low) | (q > high)])
    sound, plain = batch.sound(q), alone.sound(q)
    for name in ("placed", "moving"):
        assert np.array_equal(sound[name], plain[name])
    found, expected, rest = batch(q), plainly(batch, q), alone(q[~taped])
    largest = largest_of_kinds({name: rest[name] for name in found})
    for name in found:
        there = np.isfinite(rest[name])
        # the tape hands these positions to the stages, with numbers that other instructions may have rounded otherwise
        assert np.allclose(found[name][~taped][there], rest[name][there], rtol=1e-13, atol=1e-13 * largest[kind(name)])
    agree({n: found[n][taped] for n in found}, {n: expected[n][taped] for n in found}, 1e-12)


def varied(it, size, seed=3):
    """The same with links up to so much longer, one by one."""
    random, found = np.random.default_rng(seed), [it]
    for _ in range(3):
        links = dict(it.links)
        for name in it.moving:
            by = 1 + size * float(random.random())
            points = {point: place * by for point, place in it.links[name].points.items()}
            links[name] = replace(it.links[name], points=points)
        found.append(replace(it, links=links, gravity=it.gravity * by))
    return found


@pytest.mark.parametrize(
    "name, size, tolerance",
    [("press-class-iii", 0.05, 1e-13), ("class-iv", 0.05, 1e-13), ("planet-on-rocker", 0.1, 1e-12)],
)
def test_variants_are_followed_from_the_first_one_and_along_their_ways(name, size, tolerance):
    batch = prepare_batch(varied(linkage_of(name), size))
    q = ROUND[::9]
    assert np.all(batch.closed(q))
    found = batch(q)
    agree({n: found[n] for n in found}, plainly(batch, q), tolerance)


def test_a_variant_that_does_not_go_so_far_is_solved_by_the_stages_where_it_ends():
    it = linkage_of("press-class-iii")
    rod = it.links["7"]
    short = replace(it, links={**it.links, "7": replace(rod, points={n: 0.75 * p for n, p in rod.points.items()})})
    batch, q = prepare_batch([it, short]), ROUND[::9]
    closed, sound, alone = batch.closed(q), batch.sound(q), prepare_batch(short)
    assert np.all(closed[0]) and not np.all(closed[1])
    assert np.array_equal(sound["placed"][1], alone.sound(q)["placed"]) and np.all(sound["placed"][0])
    agree({"S2.v": batch(q)["S2.v"][1]}, {"S2.v": alone(q)["S2.v"]}, 1e-13)


def test_a_group_that_no_tape_holds_is_solved_by_the_stages():
    for name in ("cam-lever", "crossed-slots"):  # the law of a cam; passive constraints
        batch = prepare_batch(linkage_of(name))
        assert batch.program is None and batch(ROUND[:3])["T.1"].shape == (3,)


@given(st.integers(0, 2**32 - 1), st.integers(0, 5), st.integers(1, 4))
@settings(max_examples=30)
def test_elimination_solves_both_ways(seed, explicit, free):
    """Explicit unknowns follow from those before them and the free ones; scales change nothing."""
    random, n = np.random.default_rng(seed), explicit + free
    matrix = random.normal(size=(n, n)) * (random.random((n, n)) < 0.7) + 3 * np.eye(n)
    for row in range(explicit):
        matrix[row, row + 1 : explicit] = 0
    order = EliminationOrder(
        tuple((k, k) for k in range(explicit)), tuple(range(explicit, n)), tuple(range(explicit, n))
    )
    rows = [{k: np.array([value]) for k, value in enumerate(line) if value} for line in matrix]
    right = random.normal(size=n)
    for scales in (None, (random.uniform(0.1, 10, n), random.uniform(0.1, 10, n))):
        by = EliminatedSystem(rows, order, scales)
        if np.linalg.cond(matrix) < 1e4:
            assert np.allclose(np.ravel(by.solve(right)), np.linalg.solve(matrix, right), atol=1e-9)
            assert np.allclose(np.ravel(by.transposed(right)), np.linalg.solve(matrix.T, right), atol=1e-9)
