"""Equations of moments of groups and driving links: they hold, and give what the force plan has found."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from bank import NAMES, solved
from hypothesis import given, settings
from models import PROBLEMS
from random_linkages import linkage
from test_properties import CHAINS, SEEDS, generic

from tmm_cli.mechanics.forces import list_free_bodies
from tmm_cli.mechanics.numerics import cross, dot

IN_DETAIL = [name for name in NAMES if "detail: [" in (PROBLEMS / f"{name}.yaml").read_text(encoding="utf-8")]


@cache
def detailed(name):
    """The results of a problem of the bank, and its positions in detail that can be computed."""
    results = solved(name)
    wanted = [k for k, n in enumerate(results.numbers) if n in results.problem.request.detail]
    return results, [k for k in wanted if results.motion.moving[k] and not results.locked[k]]


def equations(name):
    """Of the first position in detail, by what they give."""
    results, (k, *_) = detailed(name)
    parts = list_free_bodies(results.motion, results.reactions, k)
    return {equation.sought.symbol.name: equation for part in parts for equation in part.equations if equation.sought}


def moments(equation):
    return {term.acting.symbol.name: term.moment for term in equation.terms}


def exactness(term, centre):
    """What rounding of a moment goes by: a large force that nearly passes through the centre has a small moment."""
    return abs(term.moment) if term.acting.couple else abs(term.acting.force) * abs(term.acting.at - centre)


def held(motion, reactions, k):
    """All equations of a position, each checked: moments come to nothing, arms stand across the lines of forces."""
    found = [equation for part in list_free_bodies(motion, reactions, k) for equation in part.equations]
    for equation in found:
        largest = max((exactness(term, equation.centre) for term in equation.terms), default=0.0)
        assert abs(sum(t.moment for t in equation.terms)) <= 1e-13 * largest * len(equation.terms)
        for term in equation.terms:
            force, off = term.acting.force, term.acting.at - equation.centre
            if not term.acting.couple:
                assert abs(term.moment) == pytest.approx(term.arm * abs(force), rel=1e-9)
                assert term.arm == pytest.approx(abs(term.foot - equation.centre))
                assert abs(dot(term.foot - equation.centre, force)) < 1e-12 * abs(force) * abs(off)
                assert abs(cross(term.foot - term.acting.at, force)) < 1e-12 * abs(force) * abs(off)
        if equation.found is not None:
            term = equation.found
            wanted = term.arm if equation.sought.arm and not term.acting.couple else term.acting.size
            assert equation.value == pytest.approx(wanted, rel=1e-12 * max(1.0, largest / abs(term.moment)))
    return found


@pytest.mark.parametrize("name", IN_DETAIL)
def test_moments_come_to_nothing_and_give_what_the_force_plan_gives(name):
    results, positions = detailed(name)
    for k in positions:
        assert held(results.motion, results.reactions, k)


@given(SEEDS, CHAINS)
@settings(max_examples=25)
def test_each_tangential_part_of_the_force_plan_follows_from_one_equation_of_moments(seed, kinds):
    _, motion, _, reactions = generic(linkage(seed, kinds))
    largest = max(float(np.max(np.abs(r.force))) for r in reactions.all)
    for k in range(len(motion.q)):
        found = {e.sought.symbol.name: e for e in held(motion, reactions, k) if e.sought}
        for reaction in (r for group in reactions.groups for r in group.outer if r.tangential is not None):
            equation = found[f"R{reaction.by}{reaction.on}ᵗ".translate(str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉"))]
            size = equation.value if equation.found else 0.0
            assert size == pytest.approx(abs(reaction.tangential[k]), abs=1e-11 * largest)


def test_the_slider_s_moments_say_where_its_guide_pushes():
    """Course mechanism 1: 30 Q + 60 G5 - 20 U5 about E, over R05 (mm, N; see the head of its file)."""
    results, (k,) = detailed("course-1")
    equation = equations("course-1")["R₀₅"]
    inertia = 40 * abs(results.motion.centre("5").a[k])
    by_hand = 0.030 * 1200 + 0.060 * 40 * 9.81 - 0.020 * inertia
    assert equation.about == "E" and equation.links == ("5",)
    assert equation.value == pytest.approx(by_hand / abs(results.reactions.of("x").force[k]), rel=1e-12)
    assert equation.value == pytest.approx(0.221, abs=1e-3)


def test_the_rod_s_moments_give_the_tangential_reaction():
    """Shaper, position 3: weight and inertia of rod 4 about E, over DE; its centre of mass is in the middle."""
    results, (k,) = detailed("shaper")
    motion = results.motion
    d, e = (complex(motion.named(point).x[k]) for point in "DE")
    half, a, eps = (d - e) / 2, complex(motion.centre("4").a[k]), float(motion.link("4").epsilon[k])
    by_hand = cross(half, -6 * 9.81j) + cross(half, -6 * a) - 0.03 * eps
    equation = equations("shaper")["R₃₄ᵗ"]
    assert set(moments(equation)) == {"G₄", "U₄", "M₄", "R₃₄ᵗ"}
    assert moments(equation)["G₄"] == pytest.approx(6 * 9.81 * abs(half.real))
    assert equation.value == pytest.approx(abs(by_hand) / 0.21, rel=1e-12)
    assert [term.number for term in equation.terms] == [1, 2, 0, 3]


@pytest.mark.parametrize("name", ["shaper", "course-3", "press-class-iii", "lifting-boom", "excavator", "cylinder"])
def test_forces_along_a_guide_come_to_nothing_and_give_what_no_moments_give(name):
    results, (k, *_) = detailed(name)
    sums = [s for part in list_free_bodies(results.motion, results.reactions, k) for s in part.sums]
    assert sums
    for one in sums:
        size = sum(part.acting.size for part in one.parts)
        assert abs(sum(part.along for part in one.parts)) < 1e-12 * size
        assert one.found.cosine == pytest.approx(1.0, abs=1e-12)  # what is sought lies along the guide
        assert abs(one.value - one.found.acting.size) < 1e-12 * size


def test_the_stone_s_forces_along_the_slot_give_the_normal_reaction():
    """Shaper, position 3: weight and inertia of stone 2 along CD; the link at the slot pushes across it."""
    results, (k,) = detailed("shaper")
    motion = results.motion
    along = complex(motion.named("D").x[k] - motion.named("C").x[k]) / 0.65
    by_hand = dot(along, 1.5 * (-9.81j - complex(motion.centre("2").a[k])))
    group = next(part for part in list_free_bodies(motion, results.reactions, k) if part.links == ("2", "3"))
    stone = next(one for one in group.sums if one.link == "2")
    assert stone.found.acting.symbol.name == "R₁₂ⁿ" and stone.value == pytest.approx(abs(by_hand), rel=1e-10)


def test_moments_of_a_crank_about_its_pivot_balance_it():
    results, (k,) = detailed("shaper")
    equation = equations("shaper")["Mb"]
    assert set(moments(equation)) == {"G₁", "R₂₁", "Mb"}  # the crank's inertia goes through O
    assert equation.value == pytest.approx(abs(results.reactions.balance.moment[k]), rel=1e-12)


def test_three_leads_are_solved_about_the_point_where_two_of_them_meet():
    """Press of class III: what is left of R12 and R07 meets in W, so moments of all four links give R06."""
    found = equations("press-class-iii")
    assert {"R₁₂ᵗ", "R₀₇ᵗ", "R₀₆ᵗ"} <= set(found)
    equation = found["R₀₆ᵗ"]
    assert (equation.about, equation.links) == ("W", ("2", "5", "6", "7"))
    assert not {"R₁₂ⁿ", "R₀₇ⁿ"} & set(moments(equation))


def test_a_swinging_cylinder_is_one_lead():
    """Cylinder and piston of the boom's own weight turn about B, where they push: across them only R02 is left."""
    equation = equations("lifting-boom")["R₀₂ᵗ"]
    assert (equation.about, equation.links) == ("B", ("2", "3"))
    assert "Fb" not in moments(equation)


def test_teeth_are_found_from_moments_about_the_axis_of_their_wheel():
    equation = equations("planetary-dwell-press")["R₀₂"]
    assert set(moments(equation)) == {"R₀₂", "R₃₂"} and equation.about == "A"
