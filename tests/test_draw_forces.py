"""Sheets of forces: groups under their loads with arms and equations of moments; force plans with their tables."""

from __future__ import annotations

from itertools import combinations, pairwise

import numpy as np
import pytest
from bank import solved
from test_draw import plain

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    INERTIA_COLOUR,
    LOAD_COLOUR,
    REACTION_COLOUR,
    AreaMark,
    DrawingSheet,
    LineMark,
    plain_text as line,
    wrap_symbols,
)
from tmm_cli.drawing.sheets import (
    ARM_COLOUR,
    CaptionTable,
    DrawingCaption,
    ForceArrows,
    detailed_drawings,
    draw_force_plans,
    draw_group_loads,
    equation_lines,
    force_plan_rows,
    forces_table,
    format_figures,
    lane_offsets,
)
from tmm_cli.mechanics.forces import ForceOrCouple, Symbol, list_free_bodies
from tmm_cli.mechanics.plans import NamedVector, force_plans
from tmm_cli.note import format_fixed, round_figures


def sheets_of(name, kind):
    """Sheets of one kind of the first position in detail, by their stems."""
    return dict(kind(detailed_drawings(solved(name))[0]))


@pytest.fixture(scope="module")
def loaded():
    return sheets_of("shaper", draw_group_loads)


@pytest.fixture(scope="module")
def equations():
    """Of the shaper's parts by their links, as they are written."""
    (here,) = detailed_drawings(solved("shaper"))
    parts = list_free_bodies(here.motion, here.results.reactions, here.k)
    return {part.links: [line(words) for e in part.equations for words in equation_lines(e)] for part in parts}


def test_each_group_and_the_crank_have_a_sheet_under_their_loads(loaded):
    assert list(loaded) == ["group-loads-03-links-4-5", "group-loads-03-links-2-3", "group-loads-03-link-1"]


def test_loads_and_parts_of_reactions_are_drawn_as_many_as_act(loaded):
    arrows = [mark for mark in loaded["group-loads-03-links-4-5"].marks if isinstance(mark, AreaMark) and is_head(mark)]
    assert len(arrows) >= len(["G4", "U4", "M4", "G5", "U5", "F", "R34n", "R34t", "R05"])
    assert {"R", "34", "05", "τ", "n", "F"} <= plain(loaded["group-loads-03-links-4-5"])
    assert {"R", "01", "21", "M", "b", "G", "1"} <= plain(loaded["group-loads-03-link-1"])


def is_head(area):
    """Of an arrow of a force."""
    return len(area.corners) == 3 and area.face in {LOAD_COLOUR, INERTIA_COLOUR, REACTION_COLOUR}


def test_equations_of_moments_stand_beneath_in_letters_then_with_numbers(loaded, equations):
    first, solved, guide, place = equations["4", "5"]
    assert first == "ΣM_E, link 4: −R^τ_34·h_3 + G_4·h_1 − U_4·h_2 − M_4 = 0"
    assert solved.endswith("(58.86·0.1041 − 11.89·0.07677 − 0.3608) / 0.21 = 23.1 N")
    assert guide == "ΣM_E, link 5: R_05·h_7 − G_5·h_4 + U_5·h_5 − F·h_6 = 0"
    assert place.endswith("/ 324.4 = 0.2286 m")  # where the guide's reaction acts, from E
    assert equations["1",][1].strip() == "M_b = G_1·h_1 + R_21·h_2 = 58.86·0.01037 + 2308·0.1068 = 247 N·m"
    texts = plain(loaded["group-loads-03-links-4-5"])
    assert any(text.endswith("/ 0.21 = 23.1 N") for text in texts)


def test_arms_are_listed_with_their_length_and_as_they_measure_on_paper(loaded):
    texts = plain(loaded["group-loads-03-links-4-5"])
    (scale,) = [float(t.split()[1]) for t in texts if t.startswith(" = ") and t.endswith(" m/mm")]
    assert {"104.1", f"{0.1041 / scale:.1f} mm", "228.6", f"{0.2286 / scale:.1f} mm"} <= texts
    lengths = [
        abs(mark.places[0] - mark.places[-1])
        for mark in loaded["group-loads-03-links-4-5"].marks
        if isinstance(mark, LineMark) and mark.colour == ARM_COLOUR and len(mark.places) == 2
    ]
    assert min(abs(length - 0.228613 / scale) for length in lengths) < 0.01  # drawn as long as the scale says


@pytest.mark.parametrize("name", ["press-class-iii", "class-iv", "lifting-boom", "cam-lever", "planetary-dwell-press"])
def test_groups_of_every_class_are_drawn(name):
    for stem, sheet in sheets_of(name, draw_group_loads).items():
        assert stem.startswith("group-loads-") and "Σ" in plain(sheet)


def test_tables_flow_side_by_side_and_long_equations_are_wrapped():
    table = CaptionTable(("name", "N"), [(f"R{n}", "100") for n in range(30)])
    one, wide, narrow = (left(DrawingCaption((), (table,)), across) for across in (20.0, 270.0, 60.0))
    assert one < narrow < wide
    assert left(DrawingCaption(("x " * 200,)), 100.0) < left(DrawingCaption(("x ",)), 100.0) - 4


def test_tables_aside_leave_all_of_the_height():
    table = CaptionTable(("name", "N"), [(f"R{n}", "100") for n in range(10)])
    below, aside = (DrawingCaption((), (table,), aside=aside).space_left(0j, 100 + 100j) for aside in (False, True))
    assert aside.imag > below.imag and aside.real < below.real == 100


def left(written, across):
    """The height that a text leaves of 500 mm, mm."""
    return written.space_left(0j, complex(across, 500)).imag


@pytest.mark.parametrize("name", ["shaper", "engine-four", "press-class-iii"])
def test_tables_of_force_plans_list_every_vector_to_the_digits_they_show(name):
    here = detailed_drawings(solved(name))[0]
    for plan in force_plans(here.results.reactions, here.k, here.motion):
        rows = [row.cells for row in force_plan_rows(plan, 7.5) if not row.head]
        vectors = [*plan.plan.vectors, *plan.full]
        assert [line(cells[0]) for cells in rows] == [line(vector.symbol) for vector in vectors]
        for (__, size, length, angle), vector in zip(rows, vectors, strict=True):
            value = abs(vector.value)
            assert float(size) == pytest.approx(value, rel=6e-4, abs=1e-9)
            assert float(length) == pytest.approx(value / 7.5, abs=0.051)
            if angle:
                off = vector.value / value * np.exp(-1j * np.radians(float(angle.rstrip("°"))))
                assert abs(off - 1) < np.radians(0.051)


def test_reactions_are_the_sums_of_their_parts_and_equal_what_was_computed():
    here = detailed_drawings(solved("shaper"))[0]
    reactions = here.results.reactions
    found = {v.name: v.value for plan in force_plans(reactions, here.k) for v in plan.full}
    wanted = {f"R{r.by}{r.on}": complex(r.force[here.k]) for r in reactions.all if r.tangential is not None}
    assert set(found) == {"R₃₄", "R₁₂", "R₀₃"} and len(wanted) == 3
    for pair, value in {"34": found["R₃₄"], "12": found["R₁₂"], "03": found["R₀₃"]}.items():
        assert value == pytest.approx(wanted[f"R{pair}"], rel=1e-12)


def test_leads_of_a_group_of_class_iii_are_parted_as_those_of_dyads_are():
    here = detailed_drawings(solved("press-class-iii"))[0]
    reactions = here.results.reactions
    plan = next(p for p in force_plans(reactions, here.k, here.motion) if len(p.links) == 4)
    assert {"R₁₂ⁿ", "R₁₂ᵗ", "R₀₆ⁿ", "R₀₆ᵗ", "R₀₇ⁿ", "R₀₇ᵗ"} <= {v.name for v in plan.plan.vectors}
    assert abs(sum(v.value for v in plan.plan.vectors)) < 1e-9 * plan.plan.size
    parts = {v.name: v.value for v in plan.plan.vectors}
    arm = complex(here.motion.named("C").x[here.k] - here.motion.named("A").x[here.k])
    assert abs((parts["R₁₂ᵗ"] * arm.conjugate()).real) < 1e-9 * abs(parts["R₁₂ᵗ"] * arm)  # across AC
    for full in plan.full:
        (one,) = [r for r in reactions.all if f"R{r.by}{r.on}" == full.symbol.letter + full.symbol.below]
        assert full.value == pytest.approx(complex(one.force[here.k]), rel=1e-9)


def test_vectors_of_a_polygon_that_is_a_line_are_drawn_side_by_side():
    """Forces along one line: 300 N up, 100 N down twice, 100 N down; all but the first would lie on it."""
    up, down = (
        [NamedVector("", 0j, 300j, "load")],
        [NamedVector("", 300j - 100j * n, 200j - 100j * n, "load") for n in range(3)],
    )
    aside = lane_offsets([*up, *down], 300.0)
    assert aside[0] == 0 and len({abs(off) for off in aside[1:]}) == 1 and abs(aside[1]) > 3
    square = [0j, 1 + 0j, 1 + 1j, 1j, 0j]
    assert lane_offsets([NamedVector("", a, b, "load") for a, b in pairwise(square)], 1.0) == [0, 0, 0, 0]


def test_engine_s_forces_on_one_line_are_spread_apart():
    for stem, sheet in sheets_of("engine-four", draw_force_plans).items():
        shafts = [m.places for m in sheet.marks if isinstance(m, LineMark) and m.layer == "vectors" and m.style == "-"]
        for n, one in enumerate(shafts):
            for other in shafts[:n]:
                assert not lie_together(one, other), stem


def lie_together(one, other):
    """Whether two lines on paper (mm) share more than two millimetres, one on the other."""
    along = (one[-1] - one[0]) / abs(one[-1] - one[0])
    across = [abs((p - one[0]).imag * along.real - (p - one[0]).real * along.imag) for p in (other[0], other[-1])]
    runs = sorted(((p - one[0]) * along.conjugate()).real for p in (other[0], other[-1]))
    return max(across) < 0.5 and min(runs[1], abs(one[-1] - one[0])) - max(runs[0], 0) > 2


def test_couples_are_listed_by_size_and_sense_as_the_equations_take_them():
    forward, backward, force = (
        ForceOrCouple(Symbol("M", "1"), "inertia", "1", 0j, 0j, 0.5),
        ForceOrCouple(Symbol("M", "2"), "inertia", "2", 0j, 0j, -0.25),
        ForceOrCouple(Symbol("G", "3"), "load", "3", 0j, -10j),
    )
    cells = [row[1:] for row in forces_table([forward, backward, force]).rows]
    assert cells == [("0.5 N·m", "ccw"), ("0.25 N·m", "cw"), ("10 N", "270.0°")]


@pytest.mark.parametrize("ways", [(1, -1, 1), (-1, 1, -1), (1, 1, -1), (1, 1, 1)])
def test_forces_on_one_line_do_not_hide_one_another(ways):
    sheet = DrawingSheet("T", "S", [0j, 1 + 0j])
    sheet.line([sheet.on(0j), sheet.on(0j) - 40j], DARK_COLOUR)  # a link: what goes down begins there at some cost
    forces = ForceArrows(sheet)
    forces.draw(ForceOrCouple(Symbol("F", str(k)), "load", "1", 0j, 1j * way) for k, way in enumerate(ways))
    tips = [sum(mark.corners) / 3 for mark in sheet.marks if isinstance(mark, AreaMark) and is_head(mark)]
    assert len(tips) == 3 and all(abs(one - other) > 5 for one, other in combinations(tips, 2))


def test_a_unit_is_not_left_alone_on_a_line():
    text = "M = 11.77·0.02707 + 6.867·0.06766 = 125.8 N·m"
    for most in range(20, 100):
        *__, last = wrap_symbols(text, 3.0, float(most))
        assert len(line(last).split()) > 1


def test_a_half_is_rounded_up_on_whichever_side_of_it_binary_numbers_are():
    assert format_figures(1.5 * 9.81) == format_figures(14.715000000000002) == "14.72"
    assert (
        format_fixed(35 * 9.81, 4) == format_fixed(343.35000000000002, 4) == "343.4"
        and round_figures(31384.6, 4) == 31385
    )


def test_small_numbers_are_written_out():
    assert (
        format_figures(9.447e-05) == "0.00009447"
        and format_figures(12345.6) == "12346"
        and format_figures(4e-9) == "4e-09"
    )
