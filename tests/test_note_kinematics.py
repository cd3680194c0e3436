"""The chapter on kinematics: what is found, from which equations, in which order."""

from __future__ import annotations

from functools import cache

import pytest
from models import PROBLEMS, solved_text
from test_jams import planets

from tmm_cli import load, solve
from tmm_cli.drawing.paper import SheetPicture
from tmm_cli.note import ComputedQuantity, Equation, Heading, Letter, Paragraph, PositionPlans, Row, Subject
from tmm_cli.note.kinematics import chapter as kinematics


@cache
def subject(name, *, drawn=False):
    return Subject(solve(load(str(PROBLEMS / f"{name}.yaml")), "kinematics"), drawn=drawn)


@cache
def chapter(name):
    return tuple(kinematics.write_kinematics(subject(name)))


def found(name):
    return [block for block in chapter(name) if isinstance(block, ComputedQuantity)]


def sentences(name):
    return ["".join(str(part) for part in block.line) for block in chapter(name) if isinstance(block, Paragraph)]


def vectors(name):
    """Of each vector equation its vectors with the lines under them."""
    rows = [block.node.nodes for block in chapter(name) if isinstance(block, Equation) and isinstance(block.node, Row)]
    letters = [[(n.symbol.name, n.lines) for n in row if isinstance(n, Letter) and n.vector] for row in rows]
    return [row for row in letters if any(lines for __, lines in row)]


def test_velocities_of_a_shaper_are_found_in_the_order_in_which_their_plan_is_drawn():
    names = [one.name.name for one in found("shaper")]
    assert names[2:14] == ["vA", "μv", "vA₃", "vAA₃", "ω₃", "vD", "vE", "vED", "ω₄", "vS₁", "vS₃", "vS₄"]  # after ω₁, k


def test_two_lines_stand_under_what_is_known_whole_and_one_under_a_known_direction():
    equations = vectors("shaper")
    assert equations[0] == [("vA₃", 1), ("vC", 2), ("vA₃C", 1)]
    assert equations[1] == [("vA", 2), ("vA₃", 1), ("vAA₃", 1)]
    assert equations[2] == [("vE", 1), ("vD", 2), ("vED", 1)]
    assert equations[4] == [("aA", 2), ("aA₃", 0), ("aAA₃k", 2), ("aAA₃r", 1)]


@pytest.mark.parametrize(
    ("name", "systems"), [("shaper", 0), ("excavator", 0), ("press-class-iii", 2), ("loader", 2), ("class-iv", 2)]
)
def test_a_group_that_no_polygon_solves_is_said_to_be_one(name, systems):
    assert (
        sum(text.startswith("These equations contain more unknown magnitudes") for text in sentences(name)) == systems
    )


def test_each_position_in_detail_has_its_numbers_and_the_method_is_told_once():
    headings = [block.text for block in chapter("five-point-line") if isinstance(block, Heading)]
    assert [text for text in headings if text.startswith("Vel")] == [f"Velocities, position {k}" for k in range(5)]
    assert (
        sum(text.startswith("Velocities are found from velocity plans") for text in sentences("five-point-line")) == 1
    )
    assert len(vectors("five-point-line")) == 4  # v and a of C, from B and from D
    assert [one.name.name for one in found("five-point-line")].count("ω₃") == 5


def test_wheels_racks_and_followers_are_found_from_their_pairs():
    planet = next(one for one in found("planetary-dwell-press") if one.name.name == "ω₂")
    assert planet.result == pytest.approx(-4 * subject("planetary-dwell-press").results.linkage.driver.rate)
    assert {"ω₄", "vRR₃"} <= {one.name.name for one in found("rack-doubling")}
    assert "vB" in [one.name.name for one in found("valve-drive")]


@pytest.mark.parametrize("name", ["shaper", "excavator"])
def test_scales_are_those_of_the_drawings(name):
    k = subject(name).detail[0]
    for stem in ("velocity", "acceleration"):
        (drawing,) = subject(name, drawn=True).drawings(stem, k).values()
        assert isinstance(drawing, SheetPicture)
        here = PositionPlans(subject(name), k, first=True)
        assert (here.v if stem == "velocity" else here.a).mu == drawing.mu


def test_wheels_that_turn_evenly_have_no_accelerations_made_of_rounding():
    """Three planets hold one another twice: least squares leave 1e-31 rad/s2 where nothing accelerates."""
    results = solved_text(planets(3, "h"))
    told = [
        block
        for block in kinematics.write_kinematics(Subject(results, drawn=False))
        if isinstance(block, ComputedQuantity)
    ]
    rates = {block.name.name: block.result for block in told if block.name.name.startswith(("ω", "ε"))}
    assert rates["ωs"] == pytest.approx(3.0)  # Willis: 1 + 80/40
    assert all(value == 0 for name, value in rates.items() if name.startswith("ε"))
