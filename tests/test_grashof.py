"""Which links turn fully: types of four-bars, change points, crank-sliders, slotted levers."""

from __future__ import annotations

import json

import numpy as np
import pytest
from hypothesis import given, settings, strategies as st
from test_commands import tmm

from tmm_cli import solve
from tmm_cli.mechanics.analysis import motion_at_positions
from tmm_cli.problem import ProblemError, read_text
from tmm_cli.synthesis import (
    CRANK_SLIDER_TYPES,
    FOUR_BAR_TYPES,
    SLOTTED_LEVER_TYPES,
    CrankSlider,
    FourBarLinks,
    SlottedLever,
    build_synthesised,
    classify_crank_slider,
    classify_four_bar,
    classify_slotted_lever,
)

FOUR_BAR = """
points: {O: [0, 0], C: [l4, 0]}
links:
  1: {points: [O, A], length: l1}
  2: {points: [A, B], length: l2}
  3: {points: [C, B], length: l3}
driver: {link: 1, speed: 1 rad/s}
"""
many = st.integers(0, 2**32 - 1).map(lambda seed: np.random.default_rng(seed).uniform(0.1, 1.0, (4, 2000)))


def test_the_margin_at_a_change_point_is_zero_and_no_rounding():
    assert 0.3 - (0.1 + 0.2) != 0  # in binary numbers
    assert classify_four_bar(FourBarLinks(0.1, 0.3, 0.2, 0.4)).excess == 0
    assert classify_crank_slider(CrankSlider(0.1, 0.3, 0.2)).margin == 0
    assert classify_slotted_lever(SlottedLever(0.1, 0.3, 0.2)).margin == 0


def named(*lengths):
    """The type of a four-bar with frame, input, coupler and output of these lengths."""
    g, a, b, c = lengths
    kind = int(classify_four_bar(FourBarLinks(a, b, c, g)).kind)
    return FOUR_BAR_TYPES[kind] if kind >= 0 else None


@pytest.mark.parametrize(
    ("lengths", "kind", "letters"),
    [
        ((1, 3, 4, 2.5), "GCCC", "ico"),
        ((3, 1, 4, 2.5), "GCRR", "i"),
        ((3, 4, 1, 2.5), "GRCR", "c"),
        ((3, 4, 2.5, 1), "GRRC", "o"),
        ((4, 2, 2.5, 2), "RRR1", ""),
        ((2, 4, 2.5, 2), "RRR2", ""),
        ((2, 2.5, 4, 2), "RRR3", ""),
        ((2, 2.5, 2, 4), "RRR4", ""),
        ((1, 2, 4, 3), "SCCC", "ico"),
        ((2, 1, 4, 3), "SCRR", "i"),
        ((2, 4, 1, 3), "SRCR", "c"),
        ((2, 4, 3, 1), "SRRC", "o"),
        ((2, 1, 2, 1), "S2X", None),
        ((1, 1, 2, 2), "S2X", None),
        ((1, 1, 1, 1), "S3X", None),
        ((6, 1, 2, 3), None, ""),
        ((7, 1, 2, 3), None, ""),
    ],
)
def test_every_type_has_its_name_and_its_turning_links(lengths, kind, letters):
    assert named(*lengths) == kind
    if letters is not None:
        g, a, b, c = lengths
        turns = classify_four_bar(FourBarLinks(a, b, c, g)).turns
        assert "".join(letter for letter, one in zip("ico", turns, strict=True) if one) == letters


def test_a_change_point_is_found_through_the_rounding_of_decimals():
    assert 0.1 + 0.4 != 0.2 + 0.3000000000000001
    assert named(0.3, 0.1, 0.4, 0.1 + 0.1) == "SCRR"
    assert named(0.3, 0.1, 0.4, 0.2001) == "GCRR" and named(0.3, 0.1, 0.4, 0.1999) == "RRR3"


def test_links_that_just_reach_do_not_close_in_whatever_unit_they_are_given():
    assert named(0.2, 0.3, 0.6, 0.1) is None  # 0.2 + 0.3 + 0.1 is more than 0.6 in doubles
    for unit in (1.0, 0.1, 0.001, 1 / 3):
        assert named(2 * unit, 3 * unit, 6 * unit, 1 * unit) is None
        assert named(2 * unit, 3 * unit, 5.9999 * unit, 1 * unit) == "RRR3"


@settings(max_examples=5)
@given(many)
def test_the_input_turns_fully_where_the_linkage_closes_at_every_angle(lengths):
    g, a, b, c = lengths
    found = classify_four_bar(FourBarLinks(a, b, c, g))
    angles = np.linspace(0, np.pi, 19)[:, None]
    for turns, (near, far) in ((found.turns[:, 0], (a, c)), (found.turns[:, 2], (c, a))):
        distance = np.abs(g - near * np.exp(1j * angles))
        closes = np.all((distance <= b + far) & (distance >= np.abs(b - far)), axis=0)
        assert np.array_equal(turns, closes)
    opened = 2 * np.max(lengths, axis=0) >= lengths.sum(axis=0)
    assert np.array_equal(found.kind < 0, opened)
    shortest, longest = np.min(lengths, axis=0), np.max(lengths, axis=0)
    grashof = 2 * (shortest + longest) < lengths.sum(axis=0)
    assert np.array_equal(np.any(found.turns, axis=1), grashof & ~opened)
    assert np.array_equal((found.kind >= 0) & (found.kind < 4), grashof & ~opened)


@settings(max_examples=5)
@given(many)
def test_coupler_and_frame_turn_against_each_other_whichever_is_fixed(lengths):
    l1, l2, l3, l4 = lengths
    one, other = (
        classify_four_bar(FourBarLinks(l1, l2, l3, l4, 4, 1)),
        classify_four_bar(FourBarLinks(l1, l2, l3, l4, 2, 3)),
    )
    assert np.array_equal(one.turns[:, 1], other.turns[:, 1])
    back = classify_four_bar(FourBarLinks(l1, l2, l3, l4, 4, 3))
    assert np.array_equal(one.turns[:, ::-1], back.turns)
    assert np.array_equal(one.excess, back.excess)


def built(block, linkage=FOUR_BAR, extra=""):
    return build_synthesised(read_text(f"tmm: 1\nsynthesis: {block}\n{extra}{linkage}", "x.yaml"))


@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1))
def test_the_ordinary_stages_find_the_same_links_turning(seed):
    rng = np.random.default_rng(seed)
    g, a, b, c = (float(x) for x in rng.uniform(0.1, 1.0, 4))
    found = classify_four_bar(FourBarLinks(a, b, c, g))
    if found.kind < 0 or abs(found.excess) < 1e-3:
        return
    # any closed position will do for a sketch
    angles = np.linspace(0, 2 * np.pi, 720, endpoint=False)
    distance = np.abs(g - a * np.exp(1j * angles))
    slack = np.minimum(b + c - distance, distance - abs(b - c))
    at = float(angles[np.argmax(slack)])
    crank = a * np.exp(1j * at)
    d = g - crank
    x = (abs(d) ** 2 + b * b - c * c) / (2 * abs(d))
    pin = complex(crank + d / abs(d) * complex(x, np.sqrt(max(b * b - x * x, 0))))
    values = f"parameters: {{l1: {a!r} m, l2: {b!r} m, l3: {c!r} m, l4: {g!r} m}}\n"
    sketch = f"sketch: {{at: {at!r} rad, B: [{pin.real!r} m, {pin.imag!r} m]}}\n"
    results = solve(built("{task: grashof, l1: l1, l2: l2, l3: l3, l4: l4}", FOUR_BAR + sketch, values), "kinematics")
    assert results.driver_range.full == bool(found.turns[0])
    assert [demand.measure(results) for demand in results.problem.synthesis.outcome.demands] == [float(found.turns[0])]
    if results.driver_range.full:
        closely = results.closely(721)
        motion = motion_at_positions(results, closely, 0)
        for link, turns in (("2", found.turns[1]), ("3", found.turns[2])):
            angle = np.unwrap(motion.angle(link))
            assert round(abs(angle[-1] - angle[0]) / (2 * np.pi)) == int(turns)


@settings(max_examples=5)
@given(many)
def test_the_crank_of_a_crank_slider_turns_where_the_rod_reaches_the_guide_at_every_angle(lengths):
    r, rod, e, _ = lengths
    found = classify_crank_slider(CrankSlider(r, rod, e))
    angles = np.linspace(-np.pi / 2, np.pi / 2, 19)[:, None]
    reaches = np.all(np.abs(r * np.sin(angles) + e) <= rod, axis=0)
    assert np.array_equal(found.kind == 0, reaches)
    assert found.margin == pytest.approx(rod - r - e)
    # the rod turns where the crank, held to the slider's hinge, turns about it
    rocks = np.all(np.abs(rod * np.sin(angles) + e) <= r, axis=0)
    assert np.array_equal(found.kind == 1, rocks)


@settings(max_examples=5)
@given(many)
def test_the_crank_of_a_slotted_lever_turns_where_the_stone_stays_beyond_the_slots_offset(lengths):
    crank, frame, e, _ = lengths
    found = classify_slotted_lever(SlottedLever(crank, frame, e))
    stone = np.abs(frame + crank * np.exp(1j * np.linspace(0, np.pi, 19)[:, None]))
    assert np.array_equal(found.kind < 2, np.all(stone >= e, axis=0))
    assert np.array_equal((found.kind == 1), np.all(stone >= e, axis=0) & (crank > frame))


def test_conditions_of_crank_slider_and_slotted_lever_by_name():
    def slider(*lengths):
        return list(CRANK_SLIDER_TYPES)[int(classify_crank_slider(CrankSlider(*lengths)).kind)]

    def lever(*lengths):
        return list(SLOTTED_LEVER_TYPES)[int(classify_slotted_lever(SlottedLever(*lengths)).kind)]

    assert [slider(50, 190, 40), slider(50, 10, 20), slider(50, 60, 40)] == ["crank", "rod", "none"]
    assert [slider(50, 90, 40), slider(0.1, 0.3, 0.2), slider(1, 1)] == ["change", "change", "change"]
    assert [lever(110, 350), lever(60, 40), lever(50, 60, 20)] == ["swings", "turns", "none"]
    assert [lever(50, 50), lever(0.1, 0.3, 0.2)] == ["change", "change"]


REFUSED = {
    "{task: grashof, l1: 10, l2: 2, l3: 3, l4: 4}": (
        "synthesis.l1: the links do not form a closed loop: l1 is as long as the other three together, or "
        "longer. Shorten l1\n"
        "  found:   10\n"
    ),
    "{task: grashof, l1: 10, l2: 0, l3: 3, l4: 4}": (
        "synthesis.l2: this value is too small for a mechanism\n  found:   0"
    ),
    "{task: grashof, l1: 1, l2: 2, l3: 3, l4: 3, frame: l1, driver: l3}": (
        "synthesis.driver: the driver must be hinged to the frame\n"
        "  found:   'l3', the link opposite the frame l1\n"
        "  allowed: l2, l4"
    ),
    "{task: grashof, l1: 1, l2: 2, l3: 3}": (
        "synthesis: these keys do not determine a mechanism\n"
        "  found:   l1, l2, l3\n"
        "  allowed: l1, l2, l3, l4 (+ frame, driver); r, l (+ e); OA, OC (+ e)"
    ),
    "{task: grashof, l1: 1, l2: 2, l3: 3, l4: 3, frame: l5}": (
        "synthesis.frame: this value is not allowed here\n  found:   'l5'\n  allowed: l1, l2, l3, l4"
    ),
    "{task: grashof, l1: 1, l2: 2, l3: 3, l4: 3, names: {r: OA}}": (
        "synthesis.names.r: the synthesis grashof finds no parameter with this name\n"
        "  found:   'r'\n"
        "  allowed: this synthesis finds no parameters"
    ),
}


@pytest.mark.parametrize("text", REFUSED)
def test_what_is_no_mechanism_is_refused(text):
    with pytest.raises(ProblemError) as caught:
        built(text, extra="parameters: {l1: 3, l2: 4, l3: 5, l4: 6}\n")
    assert str(caught.value).partition(": ")[2].startswith(REFUSED[text])


def test_the_command_names_the_type_and_measures_the_driver(tmp_path):
    file = tmp_path / "four-bar.yaml"
    head = "tmm: 1\nparameters: {l1: 30, l2: 80, l3: 70, l4: 90}\n"
    block = "synthesis: {task: grashof, l1: l1, l2: l2, l3: l3, l4: l4}\n"
    file.write_text(f"{head}{block}{FOUR_BAR}sketch: {{at: 60 deg, B: [80, 70]}}\n", encoding="utf-8")
    done = tmm("synthesis", file)
    assert done.returncode == 0, done.stderr
    assert "GCRR: crank-rocker-rocker (crank-rocker)" in done.stdout and "driver rotates fully" in done.stdout
    result = json.loads(tmm("synthesis", file, "--json").stdout)
    assert result["met"] and [m["measured"] for m in result["measured"]] == [1.0]
