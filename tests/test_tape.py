"""The stages written on a tape give what the stages themselves give, for many positions and many linkages at once."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from bank import NAMES, problem
from hypothesis import given, settings, strategies as st
from models import linkage_of
from random_linkages import linkage
from test_properties import CHAINS

import tmm_cli
from tmm_cli import load, solve
from tmm_cli.batch import (
    CHECKS,
    CHUNK,
    DependsOnData,
    IncompatibleLinkagesError,
    prepare_batch,
    read_all,
    trace_function,
    varying_numbers,
)
from tmm_cli.mechanics.structure import analyse_structure

Q = np.linspace(0.1, 6.3, 24)


def kind(name):
    return name[:2] if name[1] == "." and name[0] in "RMT" else name.rsplit(".", 1)[1]


def largest_of_kinds(results):
    """The largest size of each kind of values."""
    largest = {}
    for name, values in results.items():
        here = np.max(np.abs(values[np.isfinite(values)]), initial=1e-9)
        largest[kind(name)] = max(largest.get(kind(name), 0.0), here)
    return largest


def agree(one, other, tolerance=1e-12):
    """Within a share of the largest value of the same kind."""
    assert set(one) == set(other)
    largest = largest_of_kinds(other)
    for name in one:
        a, b = one[name], other[name]
        assert np.shape(a) == np.shape(b), name
        there = np.isfinite(b)
        assert np.all(np.abs(a[there] - b[there]) <= tolerance * largest[kind(name)]), name


def plainly(batch, q):
    """The same by the ordinary stages, one linkage after another."""
    found = dict(replace(batch, program=None, checks=None)(q))
    return {name: value for name, value in found.items() if name not in CHECKS}


@given(st.integers(0, 2**32 - 1), CHAINS)
@settings(max_examples=12)
def test_a_tape_plays_what_the_stages_do(seed, kinds):
    it = linkage(seed, kinds)
    batch = prepare_batch(it)
    assert batch.program is not None
    q = it.sketch.at + np.linspace(-0.01, 0.01, 7)
    sound, alone = batch.sound(q), dict(replace(batch, program=None, checks=None)(q))
    assert np.array_equal(sound["placed"], alone["placed"])
    assert np.array_equal(sound["moving"], alone["moving"])
    there = alone["placed"]
    assert np.allclose(sound["margin"][there], alone["margin"][there], rtol=1e-9)
    if np.all(alone["moving"]):
        agree({n: batch(q)[n] for n in batch(q)}, plainly(batch, q), 1e-9)


@given(st.integers(0, 2**32 - 1), CHAINS)
@settings(max_examples=6)
def test_variants_at_once_are_the_variants_one_by_one(seed, kinds):
    random = np.random.default_rng(seed)
    it = linkage(seed, kinds)

    def other():
        links = {
            name: replace(
                x,
                points={n: p * (1 + 1e-3 * random.uniform(-1, 1)) for n, p in x.points.items()},
                mass=x.mass * random.uniform(1, 2),
                centre=x.centre * random.uniform(1, 2),
            )
            for name, x in it.links.items()
        }
        return replace(it, links=links)

    batch = prepare_batch([it, other(), other()])
    q = it.sketch.at + np.linspace(-0.002, 0.002, 4)
    found = batch(q)
    if np.all(batch.sound(q)["moving"]):
        agree({n: found[n] for n in found}, plainly(batch, q), 1e-8)


@pytest.mark.parametrize("name", ["crank-slider", "six-bar", "shaper", "crank-rocker", "engine-four", "sine"])
@pytest.mark.parametrize("count", [1, 12, CHUNK, 2 * CHUNK + 5])
def test_any_number_of_positions(name, count):
    batch = prepare_batch(linkage_of(name))
    q = np.linspace(1, 6, count)
    found = batch(q)
    agree({n: found[n] for n in found}, plainly(batch, q))


def test_more_variants_than_positions_and_the_other_way_round():
    it = linkage_of("six-bar")

    def longer(by):
        rod = it.links["2"]
        return replace(it, links=it.links | {"2": replace(rod, points={n: p * by for n, p in rod.points.items()})})

    many = prepare_batch([longer(1 + k / 1e5) for k in range(1500)])
    few = prepare_batch([longer(1 + k / 1e5) for k in range(3)])
    for batch in (many, few):
        found = batch(Q)
        assert found["B.x"].shape == (len(batch.linkages), len(Q))
        alone = prepare_batch(batch.linkages[2])(Q)
        for name in alone:
            assert np.allclose(
                found[name][2], alone[name], rtol=1e-12, atol=1e-12 * np.max(np.abs(alone[name])) + 1e-30
            )


def test_places_of_their_own():
    it = linkage_of("shaper")
    other = replace(it, gravity=-1j)
    q = np.stack([Q, Q + 0.5])
    found = prepare_batch([it, other], own_places=True)(q)
    for k, one in enumerate((it, other)):
        alone = prepare_batch(one)(q[k])
        assert np.allclose(found["R.A"][k], alone["R.A"], rtol=1e-12)


def test_what_is_not_asked_is_not_computed():
    it = linkage_of("shaper")
    one = prepare_batch(it, lambda motion, _: {"x": motion.named_on("5", "E").x}, forces=False)
    assert one.program.operations < prepare_batch(it).program.operations / 8
    assert np.allclose(one(Q)["x"], prepare_batch(it)(Q)["E.x"])


def test_class_ii_problems_of_the_bank():
    taped = 0
    for name in NAMES[1::2]:
        it = problem(name).linkage
        if any(
            not isinstance(group.type, str) or group.drivers or len(group.links) > 2
            for group in analyse_structure(it).groups
        ):
            continue
        batch = prepare_batch(replace(it, loads=tuple(load for load in it.loads if load.table is None)))
        if batch.program is None:
            continue
        taped += 1
        q = it.sketch.at + np.linspace(-0.01, 0.01, 5) * (1 if it.driver.kind == "turn" else 0.1)
        assert bool(np.all(batch.sound(q)["moving"])), name
        found = batch(q)
        agree({n: found[n] for n in found}, plainly(batch, q))
    assert taped >= 8


def test_linkages_of_different_kinds_are_not_put_together():
    with pytest.raises(IncompatibleLinkagesError):
        varying_numbers([linkage_of("shaper"), linkage_of("six-bar")])


def test_numbers_are_worked_out_before_the_data_come():
    program = trace_function(lambda x: {"y": (x * 2.0) * 0.5 + 0.0 * x, "z": x - x, "w": (x * (1 + 2j)).imag}, 2)
    assert program.operations == 1  # x 2; y is x itself, z is nothing
    found = program(np.array([1.0, 3.0]))
    assert list(found["y"]) == [1, 3] and list(found["z"]) == [0, 0] and list(found["w"]) == [2, 6]


def test_branches_by_data_are_refused():
    with pytest.raises(DependsOnData):
        trace_function(lambda x: {"y": 1.0 if x > 0 else 2.0}, 2)
    with pytest.raises(DependsOnData):
        trace_function(lambda x: {"y": np.asarray(x)}, 2)


def test_a_table_is_read_on_tape():
    program = trace_function(lambda x: {"y": np.interp(np.mod(x, 2.0), [0.0, 1.0, 2.0], [0.0, 5.0, 0.0])}, 2)
    assert np.allclose(program(np.array([0.5, 1.5, 2.2]))["y"], [2.5, 2.5, 1.0])


def test_the_library_prepares_problem_files():
    shaper = load("problems/shaper.yaml")
    results = solve(shaper)
    found = tmm_cli.prepare(shaper)(results.motion.q)
    assert np.allclose(found["T.1"], results.reactions.balance.moment, rtol=1e-12, atol=1e-12 * 400)
    several = tmm_cli.prepare([shaper, shaper])(results.motion.q)
    assert several["T.1"].shape == (2, 12)


def test_keys_name_what_they_are():
    it = linkage_of("crank-slider")
    names = set(prepare_batch(it)(Q))
    assert {"A.x", "B.v", "S2.a", "2.omega", "R.A", "M.x", "T.1"} <= names
    assert read_all.__doc__ and "R.A" in read_all.__doc__
