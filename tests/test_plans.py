"""Velocity, acceleration and force plans close, and their scales are round, on random linkages and the shaper."""

from __future__ import annotations

import numpy as np
import pytest
from bank import solved
from hypothesis import given, settings, strategies as st
from random_linkages import linkage
from test_properties import CHAINS, SEEDS, generic, solved as solved_for

from tmm_cli.mechanics.forces import Symbol, compute_lever, reaction_symbol, symbol_of_name
from tmm_cli.mechanics.numerics import cross, dot
from tmm_cli.mechanics.plans import (
    ROUND_SCALES,
    PlanReading,
    acceleration_plan,
    angular_values,
    force_plans,
    lever_plan,
    plan_readings,
    round_scale,
    velocity_plan,
)


@given(SEEDS, CHAINS)
@settings(max_examples=30)
def test_every_force_polygon_closes_and_the_inner_reaction_joins_its_corners(seed, kinds):
    _, motion, _, reactions = generic(linkage(seed, kinds))
    for k in range(len(motion.q)):
        for plan in force_plans(reactions, k):
            polygon = [v for v in plan.plan.vectors if v.kind != "inner"]
            longest = max(abs(v.value) for v in polygon)
            for one, after in zip(polygon, [*polygon[1:], polygon[0]], strict=True):
                assert abs(one.end - after.start) < 1e-11 * longest / 0.02
            for inner in (v for v in plan.plan.vectors if v.kind == "inner"):
                # it runs from a corner to a corner: from the start of the first vector to where link b's forces begin
                assert abs(inner.start - polygon[0].start) < 1e-11 * longest / 0.02


@given(SEEDS, CHAINS)
@settings(max_examples=30)
def test_parts_of_accelerations_lead_from_one_end_to_the_next(seed, kinds):
    _, motion, *_ = generic(linkage(seed, kinds))
    plan = acceleration_plan(motion, 0)
    size = plan.size
    parts = [v for v in plan.vectors if v.kind != "absolute"]
    ends = list(plan.ends.values())
    for first, second in zip(parts[::2], parts[1::2], strict=True):
        assert first.end == second.start
        assert min(abs(first.start - e) for e in ends) < 1e-10 * size
        assert min(abs(second.end - e) for e in ends) < 1e-10 * size / 0.02**2


def test_the_shaper_s_plans_have_the_vectors_a_student_draws():
    results = solved("shaper")
    velocity = velocity_plan(results.motion, 3)
    assert {"pa", "pd", "pe", "de", "pa3", "a3a"} <= {v.name for v in velocity.vectors}
    acceleration = acceleration_plan(results.motion, 3)
    parts = {(v.symbol.above, v.symbol.below): v for v in acceleration.vectors if v.kind != "absolute"}
    assert set(parts) >= {("n", "AO"), ("n", "DC"), ("τ", "DC"), ("n", "ED"), ("τ", "ED"), ("k", "AA3"), ("r", "AA3")}
    assert parts["k", "AA3"].name == "a3k" and parts["r", "AA3"].name == "ka"
    assert parts["n", "AO"].name == "πa" and parts["τ", "AO"].name == ""  # the crank turns evenly
    assert parts["n", "A3C"].name == "πn₁" and parts["τ", "A3C"].name == "n₁a3"  # as they are found: A3 before D
    assert parts["n", "DC"].name == "πn₂" and parts["τ", "DC"].name == "n₂d"
    coriolis = parts["k", "AA3"]
    omega = results.motion.link("3").omega[3]
    sliding = results.motion.slide(results.linkage.slides[0]).v[3]
    assert abs(coriolis.value) == pytest.approx(abs(2 * omega * sliding), rel=1e-14)
    last, middle, driving = force_plans(results.reactions, 3)
    assert (last.links, middle.links, driving.links) == (("4", "5"), ("2", "3"), ("1",))
    names = [v.name for v in last.plan.vectors if v.kind != "inner"]
    assert names == ["R₃₄ⁿ", "R₃₄ᵗ", "G₄", "U₄", "G₅", "U₅", "F", "R₀₅"]


@pytest.mark.parametrize("name", ["shaper", "lifting-boom", "cylinder", "five-bar", "excavator", "engine-four"])
def test_moments_about_the_pole_of_the_drawn_lever_come_to_nothing_with_what_balances_them(name):
    results = solved(name)
    for k in np.flatnonzero(results.motion.moving):
        plan = lever_plan(results.motion, results.reactions, results.lever, k)
        moments = [a.moment if a.couple else cross(a.at, a.force) for a in plan.acting]
        reach = max(map(abs, plan.ends.values()))
        assert abs(sum(moments)) <= 1e-12 * sum(abs(a.moment) + abs(a.force) * reach for a in plan.acting)
        for term in (t for t in plan.equation.terms if t.number):
            # the foot of an arm lies on the force's line, across the arm
            force = term.acting.force
            assert abs(cross(term.foot - term.acting.at, force)) < 1e-9 * abs(force)
            assert abs(dot(term.foot, force)) < 1e-9 * abs(force)
        if len(results.reactions.balances) == 1 and plan.equation.found:
            balance = results.reactions.balance
            wanted = abs(balance.generalized[k] if balance.kind == "moment" else balance.force[k])
            assert plan.equation.value == pytest.approx(wanted, rel=1e-9)


def test_the_crank_of_the_lever_lies_along_the_crank_and_couples_are_pairs_of_forces():
    results = solved("shaper")
    plan = lever_plan(results.motion, results.reactions, results.lever, 3)
    assert plan.ends["a"] == pytest.approx(results.motion.named("A").x[3])  # O is the origin
    assert {"s1", "s3", "s5"} <= set(plan.ends)
    fourth = plan.pairs[1]
    assert (fourth.points, fourth.distance) == (("D", "E"), pytest.approx(0.21))
    forces = {a.symbol.name: a.force for a in plan.acting}
    assert abs(forces["P₄"]) == pytest.approx(abs(fourth.moment) / 0.21) and forces["P′₄"] == -forces["P₄"]


@given(st.floats(1e-9, 1e9), st.floats(1e-9, 1e9))
def test_scale_factors_are_round_and_the_figure_fits(width, height):
    mu = round_scale(width, height, 200, 150)
    assert max(width / mu - 200, height / mu - 150) < 1e-6 * 200
    assert any(mu / 10 ** np.floor(np.log10(mu * 1.0000001)) == pytest.approx(f) for f in (*ROUND_SCALES, 1.0))


def test_reactions_are_named_from_link_to_link():
    assert reaction_symbol("3", "4", "τ").name == "R₃₄ᵗ"
    assert reaction_symbol("arm", "12").name == "R(arm,12)"


def test_nothing_is_left_of_the_lever_when_nothing_acts():
    _, motion, *_ = solved_for(linkage(3, ("RRR",)))
    assert compute_lever(motion, (), np.zeros(3)).items == ()


def test_each_vector_is_read_off_once_and_equal_ones_together():
    results = solved("shaper")
    motion, k = results.motion, 3
    found = {s: r for r in plan_readings(velocity_plan(motion, k)) for s in r.symbols}
    both = found[Symbol("v", "A")]
    assert both.symbols == (Symbol("v", "A"), Symbol("v", "S2")) and both.segment == "pa"
    assert found[Symbol("v", "E")].size == abs(motion.named("E").v[k])
    assert found[Symbol("v", "ED")].size == pytest.approx(
        abs(motion.named("E").v[k] - motion.named("D").v[k]), rel=1e-12
    )
    found = {s: r for r in plan_readings(acceleration_plan(motion, k)) for s in r.symbols}
    omega, epsilon = motion.link("3").omega[k], motion.link("3").epsilon[k]
    assert found[Symbol("a", "DC", "n")].size == pytest.approx(0.65 * omega**2, rel=1e-12)
    assert found[Symbol("a", "DC", "τ")].size == pytest.approx(0.65 * abs(epsilon), rel=1e-12)
    assert found[Symbol("a", "AO", "τ")] == PlanReading((Symbol("a", "AO", "τ"),), "", 0.0)


def test_links_that_only_slide_turn_with_nothing_and_signs_are_senses():
    motion = solved("shaper").motion
    found = {t.symbol.below: t.value for t in angular_values(motion, 3, "omega")}
    assert set(found) == {"1", "2", "3", "4"}
    assert found["1"] == pytest.approx(82 * np.pi / 30) and found["2"] == found["3"] == motion.link("3").omega[3]


def test_a_guide_that_only_slides_has_no_parts_of_acceleration_about_its_points():
    results = solved("course-2")
    found = [s for r in plan_readings(acceleration_plan(results.motion, 2)) for s in r.symbols]
    assert Symbol("a", "D5E", "n") not in found and Symbol("a", "DC", "n") in found
    assert Symbol("a", "DD5", "k") in found  # zero, as the guide does not turn: worth a line


@pytest.mark.parametrize(
    ("name", "letter", "below"),
    [
        ("F", "F", ""),
        ("F5", "F", "5"),
        ("Fc", "F", "c"),
        ("F_cut", "F", "cut"),
        ("Q'", "Q′", ""),
        ("press", "P", "press"),
        ("gas1", "P", "gas1"),
        ("press'", "P′", "press"),
    ],
)
def test_a_load_has_a_letter_with_its_word_below_the_line(name, letter, below):
    assert symbol_of_name(name, "P") == Symbol(letter, below)
