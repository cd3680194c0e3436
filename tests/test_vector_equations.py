"""Which vector equations a student writes for a linkage, and in what order."""

from __future__ import annotations

import pytest
from models import PROBLEMS

from tmm_cli import load, solve
from tmm_cli.mechanics.plans import FixedGuideEquation, MovingGuideEquation, SameLinkEquation, solution_steps


def of(name):
    results = solve(load(PROBLEMS / f"{name}.yaml"), "structure")
    return solution_steps(results.linkage, results.structure.groups)


def written(equation):
    base = "" if isinstance(equation, FixedGuideEquation) else equation.base.name
    return type(equation), equation.point.name, base, equation.known


def test_the_stone_of_a_shaper_leads_to_its_slotted_link_and_that_to_its_end():
    crank, slotted, ram = of("shaper")
    assert [written(e) for e in crank.after] == [(SameLinkEquation, "A", "O", True)]
    assert [written(e) for e in slotted.equations] == [
        (SameLinkEquation, "A3", "C", False),
        (MovingGuideEquation, "A", "A3", False),
    ]
    assert [written(e) for e in slotted.after] == [(SameLinkEquation, "D", "C", True)] and slotted.same == (("2", "3"),)
    assert [written(e) for e in ram.equations] == [
        (SameLinkEquation, "E", "D", False),
        (FixedGuideEquation, "E", "", False),
    ]


def test_a_cylinder_s_own_speed_is_known_and_leaves_two_magnitudes():
    for step in of("excavator"):
        assert step.on_paper and [e.known for e in step.equations] == [False, False, True]


@pytest.mark.parametrize("name", ["press-class-iii", "shaking-screen", "class-iv", "summing-lever", "loader"])
def test_no_polygon_gives_more_than_two_magnitudes(name):
    assert [step.on_paper for step in of(name)].count(False) == 1


def test_wheels_racks_and_followers_are_known_from_their_pairs():
    assert [(r.mesh.name, r.link) for r in of("planetary-dwell-press")[1].ratios] == [("ring", "2")]
    __, __, wheel, rack = of("rack-doubling")
    assert [r.link for r in wheel.ratios] == ["4"] and [r.slide.name for r in rack.ratios] == ["R'"]
    valve = of("valve-drive")[1]
    assert [r.slide.name for r in valve.ratios] == ["y"] and [written(e) for e in valve.equations] == [
        (FixedGuideEquation, "B", "", True)
    ]
