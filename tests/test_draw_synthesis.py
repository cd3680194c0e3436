"""Constructions on their sheets: all lettered points are there, labels are in the field and beside one another."""

import math
from itertools import combinations, product
from pathlib import Path

import numpy as np
import pytest
from bank import moved

from tmm_cli.drawing.paper import LOAD_COLOUR, THIN_COLOUR, AreaMark, LineMark, TextMark, leave_field, text_corners
from tmm_cli.drawing.sheets import (
    CONSTRUCTION_PAD,
    MOST_REDUCTION,
    draw_construction,
    draw_synthesis,
    pieces_inside,
    points_on_sheet,
    use_problem_names,
)
from tmm_cli.mechanics.plans import sheet_scale
from tmm_cli.problem import UnitSystem
from tmm_cli.synthesis import (
    AnglePairsTask,
    CouplerPositionsTask,
    CrankSliderTask,
    DyadData,
    EvolutionResult,
    FourBarByKTask,
    ShaperTask,
    SlottedLeverTask,
    crank_slider,
    draw_history,
    shaper,
    sheet_extent,
    slotted_lever,
)
from tmm_cli.synthesis.coupler_positions import task as coupler_positions
from tmm_cli.synthesis.four_bar_by_angles import solver as four_bar_by_angles
from tmm_cli.synthesis.four_bar_by_k import task as four_bar_by_k

ROOT = Path(__file__).parents[1]


TASKS = {
    coupler_positions: CouplerPositionsTask,
    crank_slider: CrankSliderTask,
    four_bar_by_angles: AnglePairsTask,
    four_bar_by_k: FourBarByKTask,
    shaper: ShaperTask,
    slotted_lever: SlottedLeverTask,
}


def drawn(solver, **asked):
    return [d for d in solver.solve(TASKS[solver](**asked)).drawings if hasattr(d, "spots")]


def rocker(k, low, high, **more):
    return drawn(
        four_bar_by_k, l3=0.25, psi1=math.radians(low), psi2=math.radians(high), k=k, support=0.3 + 0.1j, **more
    )


def slider(k, ratio):
    return drawn(crank_slider, stroke=0.12, k=k, ratio=ratio)


CASES = {
    **{
        f"rocker {k} {low} {high}": (rocker, (k, low, high))
        for k, (low, high) in product((1.02, 1.2, 2.0), ((80, 100), (130, 40)))
    },
    **{f"slider {k} {ratio}": (slider, (k, ratio)) for k, ratio in ((1.0, 3.0), (1.02, 4.0), (1.2, 3.0), (1.8, 1.5))},
    **{
        f"shaper {k}": (lambda k: drawn(shaper, stroke=0.4, k=k, frame_ratio=0.5, rod_ratio=0.4), (k,))
        for k in (1.1, 1.5, 2.0)
    },
    **{
        f"lever {k}": (lambda k: drawn(slotted_lever, b1=-0.2 + 0.1j, b2=0.2 + 0.2j, k=k, OC=0.2), (k,))
        for k in (1.1, 1.5, 2.0)
    },
    "pivots": (
        lambda: drawn(
            coupler_positions,
            places=(0j, 0.06 + 0.06j, 0.09 + 0.14j),
            angles=tuple(np.radians([0.0, 20, 60])),
            sides={"AB": DyadData(pivot=-0.06j), "DC": DyadData(pivot=0.12 - 0.04j)},
        ),
        (),
    ),
    "four positions": (
        lambda: drawn(
            coupler_positions,
            places=(0j, 0.05 + 0.01j, 0.1 + 0.05j, 0.12 + 0.12j),
            angles=tuple(np.radians([0.0, 20, 50, 90])),
        ),
        (),
    ),
    "angles": (
        lambda: drawn(
            four_bar_by_angles,
            phi=tuple(np.radians([30.0, 60, 90])),
            psi=tuple(np.radians([60.0, 72, 90])),
            lengths={"l4": 0.1},
        ),
        (),
    ),
}


def boxes(drawing):
    """Boxes of all texts, mm, by text."""
    found = []
    for text in (mark for mark in drawing.marks if isinstance(mark, TextMark)):
        xs, ys = zip(*((corner.real, corner.imag) for corner in text_corners(text)), strict=True)
        found.append((text.text, min(xs), max(xs), min(ys), max(ys)))
    return found


@pytest.mark.parametrize("case", CASES)
def test_points_and_labels_are_on_the_sheet_and_no_two_labels_overlap(case):
    make, values = CASES[case]
    for one in make(*values):
        sheet = draw_construction("A task", one, UnitSystem())
        low, high = sheet.canvas.low, sheet.canvas.high
        for spot in one.spots:
            at = sheet.on(spot.at)
            assert low.real < at.real < high.real and low.imag < at.imag < high.imag, spot.name
        texts = boxes(sheet.finish())
        assert {spot.name for spot in one.spots} <= {text[0] for text in texts}
        for name, left, right, bottom, top in texts[2:]:  # below the title strip
            assert low.real <= left and right <= high.real and low.imag <= bottom and top <= high.imag, name
        overlaps = [
            (p[0], q[0])
            for p, q in combinations(texts, 2)
            if min(p[2], q[2]) - max(p[1], q[1]) > 0.3 and min(p[4], q[4]) - max(p[3], q[3]) > 0.6
        ]
        assert not overlaps


@pytest.mark.parametrize("k", [1.02, 1.1, 1.3, 2.0])
def test_the_mechanism_is_large_however_large_the_circle_is(k):
    (one,) = rocker(k, 60, 110)
    assert sheet_scale(points_on_sheet(one), CONSTRUCTION_PAD)[1] <= MOST_REDUCTION * sheet_scale(
        one.places(), CONSTRUCTION_PAD
    )[1] * (1 + 1e-9)


def test_the_centre_of_a_circle_that_is_too_large_is_told_by_an_arrow_and_the_radius():
    (far,), (near,) = slider(1.02, 4.0), slider(1.35, 2.2)
    texts = [text[0] for text in boxes(draw_construction("", far, UnitSystem()).finish())]
    radius = 120 / 2 / math.sin(math.pi * 0.02 / 2.02)
    assert f"to M, R = {radius:.4g} mm" in texts and "M" not in texts
    texts = [text[0] for text in boxes(draw_construction("", near, UnitSystem()).finish())]
    assert "M" in texts and "R" in texts


@pytest.mark.parametrize("k", [1.05, 1.2, 1.6])
def test_on_the_admissible_arc_of_a_crank_slider_every_pivot_has_a_crank_that_turns(k):
    (one,) = slider(k, 2.0 if k > 1.3 else 3.0)
    b1, b2 = (next(s.at for s in one.spots if s.name == name) for name in ("B1", "B2"))
    arc = next(a for a in one.arcs if a.style == "bold")
    angles = np.linspace(arc.start, arc.end, 41)[1:-1]
    for o in arc.centre + arc.radius * np.exp(1j * angles):
        far, near, e = abs(o - b1), abs(o - b2), abs((o - b1).imag)
        r, rod = (far - near) / 2, (far + near) / 2
        assert rod - r > e and abs(np.angle((b2 - o) / (b1 - o))) == pytest.approx(math.pi * (k - 1) / (k + 1))
    past = arc.centre + arc.radius * np.exp(1j * (arc.start - 0.01))  # beyond its end the crank does not turn
    assert abs(past - b2) < abs((past - b2).imag) * (1 + 1e-3) and past.real > b2.real


def test_given_pivots_are_turned_back_with_the_coupler_to_its_first_position():
    (one,) = CASES["pivots"][0]()
    at = {spot.name: spot.at for spot in one.spots}
    for pivot, pin in (("A", "B1"), ("D", "C1")):
        radius = abs(at[pivot] - at[pin])
        assert [abs(at[f"{pivot}{k}′"] - at[pin]) for k in (2, 3)] == pytest.approx([radius] * 2, rel=1e-12)


def test_joints_are_called_as_in_the_file_and_the_centre_otherwise():
    results = moved("press-synthesis")
    (one,) = slider(1.08, 3.5)
    named, letters = use_problem_names(one, results.linkage, {"r": "OA", "l": "AB", "e": "e"})
    assert letters == {"O": "O", "A": "A", "B": "B", "M": "M"}
    assert {s.name for s in named.segments if s.name} == {"OA", "AB", "AB − OA"}
    (other,) = slider(1.3, 2.2)  # not the mechanism of the file
    assert use_problem_names(other, results.linkage, {})[1] == {"O": "O", "A": "A", "B": "B", "M": "M"}


def test_both_extreme_positions_have_letters():
    results = moved("press-synthesis")
    found = results.problem.synthesis
    figure = dict(draw_synthesis("", found.outcome, results, results.problem.units, found.names))["synthesis-extremes"]
    assert {"Aᴵ", "Bᴵ", "Aᴵᴵ", "Bᴵᴵ", "O"} <= {text[0] for text in boxes(figure)}


def test_a_curve_is_cut_where_it_leaves_the_field():
    square = (0j, 10 + 10j)
    assert leave_field(5 + 5j, 25 + 5j, *square) == 10 + 5j
    pieces = pieces_inside([-5 + 5j, 5 + 5j, 5 + 15j, 9 + 15j, 9 + 5j], *square)
    assert pieces == [[0 + 5j, 5 + 5j, 5 + 10j], [9 + 10j, 9 + 5j]]


def test_the_history_is_never_empty():
    rows = np.array([[3.0, 0.4], [2.0, 0.1], [2.5, 1e-3], [2.6, 1e-5]])  # as with equalities: never quite kept

    def drawn(polished, *, each=False):
        evolved = EvolutionResult(np.zeros((1, 1)), rows[-1:, 0], rows[-1:, 1], rows, False, every=each)
        return draw_history(evolved, lambda f: f, polished, "length", "length")

    shown = drawn(2.7)
    assert [line.text for line in shown.lines] == [
        "leading candidate (rises where a new population starts)",
        "solution after local refinement",
    ]
    assert list(shown.lower[0].y) == [0.4, 0.1, 1e-3, 1e-5]
    rows[2:, 1] = 0
    shown = drawn(2.4)
    assert list(shown.lines[1].y[2:]) == [2.5, 2.5] and np.all(np.isnan(shown.lines[1].y[:2]))
    shown = drawn(2.4, each=True)  # of all that were tried only those are drawn that keep the constraints
    assert list(shown.lines[0].y[2:]) == [2.5, 2.6] and np.all(np.isnan(shown.lines[0].y[:2])) and not shown.lower


@pytest.mark.parametrize("k", [1.1, 2.0])
def test_neither_label_nor_rod_stands_on_the_hatching_of_a_guide(k):
    for (one,) in (drawn(shaper, stroke=0.4, k=k, frame_ratio=0.5, rod_ratio=r) for r in (0.3, 0.6)):
        sheet = draw_construction("", one, UnitSystem())
        strokes = [
            m.places
            for m in sheet.marks
            if isinstance(m, LineMark) and m.layer == "supports" and m.colour == THIN_COLOUR
        ]
        middles = [(stroke[0] + stroke[-1]) / 2 for stroke in strokes]
        stones = [sheet.on(spot.at) for spot in one.spots if spot.mark == "slider"]
        middles = [at for at in middles if min(abs(at - stone) for stone in stones) < 13]
        assert len(middles) > 20
        for name, left, right, low, high in boxes(sheet.finish())[2:]:
            if name not in {s.name for s in one.spots}:  # a point may be on the rail
                assert not any(left < at.real < right and low < at.imag < high for at in middles), name
        for rod in (s for s in one.segments if s.style.startswith("link")):
            start, end = sheet.on(rod.start), sheet.on(rod.end)
            shares = [((at - start) / (end - start)).real for at in middles]
            aside = [abs(((at - start) / (end - start)).imag) * abs(end - start) for at in middles]
            assert not any(0 < share < 1 and off < 0.5 for share, off in zip(shares, aside, strict=True)), rod


@pytest.mark.parametrize(
    "rows",
    [
        ((0, 0, 0), (50, 10, 20), (100, 50, 50), (120, 120, 90)),
        (
            (-7, -21, 29),
            (45, -11, 31),
            (100, 20, 34),
            (169, -27, 63),
        ),  # all round the curve within few degrees of a turn
    ],
)
def test_curves_of_four_positions_have_neither_gaps_nor_corners_and_pass_through_the_joints(rows):
    places, angles = tuple((x + 1j * y) / 1000 for x, y, _ in rows), tuple(np.radians([r[2] for r in rows]))
    for one in drawn(coupler_positions, places=places, angles=angles):
        at = {spot.name: spot.at for spot in one.spots}
        size = max(np.ptp(np.real(list(at.values()))), np.ptp(np.imag(list(at.values()))))
        for name, joints in (("m", "AD"), ("k1", ("B1", "C1"))):
            pieces = [np.array(curve.places) for curve in one.curves if curve.name == name]
            for z in pieces:
                near = np.abs(z - at["A"]) < 2 * size
                steps = np.diff(z)
                assert np.max(np.abs(steps)[near[1:]], initial=0) < 0.03 * size
                bends = np.abs(np.angle(steps[1:] / steps[:-1]))[near[1:-1] & (np.abs(steps[1:]) > 1e-3 * size)]
                assert np.max(bends, initial=0) < 0.1
                ends = [z[0], z[-1]]  # a loop is closed, all else is followed beyond the sheet
                assert abs(ends[0] - ends[1]) < 0.02 * size or min(abs(e - at["A"]) for e in ends) > 2 * size
            for joint in joints:
                assert min(np.min(np.abs(z - at[joint])) for z in pieces) < 0.01 * size


def test_a_curve_that_comes_back_is_on_the_sheet_as_a_whole():
    turn = np.exp(1j * np.linspace(0, 2 * np.pi, 400))
    low, high = sheet_extent([0j, 1 + 1j], [tuple(-0.4 + 0.8 * turn), tuple(np.linspace(0, 1.2, 50) * (3 + 0j))])
    assert (low, high) == pytest.approx((-1.2 - 0.8j, 1.3 + 1j), abs=0.1)


def test_a_size_too_short_for_its_text_has_it_beside_or_beyond_the_arrows():
    (one,) = slider(1.02, 4.0)
    sheet = draw_construction("", one, UnitSystem())
    size = next(s for s in one.sizes if s.name == "e")
    first, last = sorted((sheet.on(size.start).imag, sheet.on(size.end).imag))
    _, left, right, low, high = next(text for text in boxes(sheet.finish()) if text[0].startswith("e = "))
    beside = right - left > high - low and low < (first + last) / 2 < high
    assert last - first < max(right - left, high - low) and (beside or low > last or high < first)


@pytest.mark.parametrize("k, ratio, cut", [(1.08, 3.5, 1), (1.2, 3.0, 1), (1.8, 1.5, 0)])
def test_an_arc_ends_in_an_arrow_where_the_edge_cuts_it(k, ratio, cut):
    (one,) = slider(k, ratio)
    sheet = draw_construction("", one, UnitSystem())
    low, high = sheet.field
    bold = [a for a in one.arcs if a.style == "bold"]
    ends = [sheet.on(a.centre + a.radius * np.exp(1j * t)) for a in bold for t in (a.start, a.end)]
    assert sum(not (low.real < z.real < high.real and low.imag < z.imag < high.imag) for z in ends) == cut
    tips = [mark.corners[0] for mark in sheet.marks if isinstance(mark, AreaMark) and mark.face == LOAD_COLOUR]
    assert len(tips) == cut
    assert all(min((z - low).real, (high - z).real, (z - low).imag, (high - z).imag) < 1e-6 for z in tips)
