"""Sheets of forces: groups under their loads with arms and equations of moments."""

from __future__ import annotations

import pytest
from models import PROBLEMS
from test_draw import plain

from tmm_cli import load, solve
from tmm_cli.draw.beneath import Beneath, Table
from tmm_cli.draw.group_loads import group_loads
from tmm_cli.draw.mechanism import detailed


def sheets_of(name, kind):
    """Sheets of one kind of the first position in detail, by their stems."""
    return dict(kind(detailed(solve(load(PROBLEMS / f"{name}.yaml"), "forces"))[0]))


@pytest.fixture(scope="module")
def loaded():
    return {stem: plain(sheet) for stem, sheet in sheets_of("shaper", group_loads).items()}


def test_each_group_and_the_crank_have_a_sheet_under_their_loads(loaded):
    assert list(loaded) == ["group-loads-03-links-4-5", "group-loads-03-links-2-3", "group-loads-03-link-1"]


def test_loads_and_parts_of_reactions_are_drawn_where_they_act(loaded):
    assert {"G4", "U4", "M4", "G5", "U5", "F", "R₃₄ⁿ", "R₃₄ᵗ", "R₀₅"} <= loaded["group-loads-03-links-4-5"]
    assert {"R₀₁", "R₂₁", "Mb", "G1"} <= loaded["group-loads-03-link-1"]


def test_equations_of_moments_stand_beneath_in_letters_then_with_numbers(loaded):
    texts = loaded["group-loads-03-links-4-5"]
    assert "ΣM(E), link 4: −R₃₄ᵗ·h₃ + G4·h₁ − U4·h₂ − M4 = 0" in texts
    assert any(t.endswith("(58.86·0.1041 − 11.89·0.07677 − 0.3608) / 0.21 = 23.1 N") for t in texts)
    assert any(t.endswith("/ 324.4 = 0.2286 m") for t in texts)  # where the guide's reaction acts, from E
    assert "Mb = G1·h₁ + R₂₁·h₂ = 58.86·0.01037 + 2308·0.1068 = 247 N*m" in {
        t.strip() for t in loaded["group-loads-03-link-1"]
    }


def test_arms_are_listed_with_their_length_and_as_they_measure_on_paper(loaded):
    texts = loaded["group-loads-03-links-4-5"]
    (scale,) = [float(t.split()[2]) for t in texts if t.startswith("μ_l")]
    assert {f"h{n}" for n in "₁₂₃₄₅₆₇"} <= texts
    assert {"104.1", f"{0.1041 / scale:.1f} mm", "228.6", f"{0.2286 / scale:.1f} mm"} <= texts


@pytest.mark.parametrize("name", ["press-class-iii", "class-iv", "lifting-boom", "cam-lever", "planetary-dwell-press"])
def test_groups_of_every_class_are_drawn(name):
    for stem, sheet in sheets_of(name, group_loads).items():
        assert stem.startswith("group-loads-") and any("ΣM(" in text for text in plain(sheet))


def test_tables_flow_side_by_side_and_long_equations_are_wrapped():
    table = Table(("name", "N"), [(f"R{n}", "100") for n in range(30)])
    one, wide, narrow = (Beneath((), (table,)).height(width) for width in (20.0, 270.0, 60.0))
    assert wide < narrow < one
    assert Beneath(("x " * 200,)).height(100.0) > 4 * Beneath(("x ",)).height(100.0) / 2
