"""What a refused synthesis names in the place of what cannot be: typed in, it is solved."""

from __future__ import annotations

import re
from itertools import pairwise

import pytest
from test_synthesis_limits import refused, solved

SLIDER = {"task": "crank-slider", "stroke": 50}
ROCKER = {"task": "four-bar-by-k", "l3": 200, "psi1": 50, "psi2": 105}
LEVER = {"task": "slotted-lever", "k": 1.5}
RAM = {"task": "shaper", "stroke": 400, "k": 1.5}
PAIRS = {"task": "four-bar-by-angles", "l4": 100}
GUIDED = {"task": "coupler-positions"}
TURNING = [[0, 0, 0], [100, 50, 40]]
STRAIGHT = [[0, 0, 0], [100, 0, 0], [200, 0, 0]]
NUMBER = r"([^ ,;\[\]]+(?: mm| deg)?)"
MORE, TO = rf"^{NUMBER} or more", rf"^{NUMBER} to "
PLACE = rf"\[{NUMBER}, {NUMBER}\]"

# what is asked; what is told, with the values in brackets; the keys of these values; the keys they take the place of
TOLD = {
    "an offset of none": (SLIDER | {"e": 0, "k": 1.5}, MORE, ["e"]),
    "an offset of none, the usual": (SLIDER | {"e": 0, "k": 1.2}, rf"; {NUMBER} for a largest pressure", ["e"]),
    "an offset of none, k too large": (SLIDER | {"e": 0, "k": 4}, rf"{MORE}, and k {NUMBER} or less", ["e", "k"]),
    "an offset of none with k of 1": (
        SLIDER | {"e": 0, "k": 1}, rf"(nu): (0) and ratio: {NUMBER} in", [None, "nu", "ratio"], ["e", "k"]),
    "an offset with k of 1": (SLIDER | {"e": 20, "k": 1}, TO, ["k"]),
    "an offset with k of 1, the usual": (SLIDER | {"e": 20, "k": 1}, rf"; {NUMBER} for a largest pressure", ["k"]),
    "an offset with k of none": (SLIDER | {"e": 20, "k": 0}, MORE, ["k"]),
    "rod and k": (SLIDER | {"ratio": 0.5, "k": 3.5}, rf"{MORE}: above.*; and k {NUMBER} or less", ["ratio", "k"]),
    "offset and rod": (SLIDER | {"ratio": 0.5, "nu": -1}, rf"^(0) or more.*; and ratio: {NUMBER} or", ["nu", "ratio"]),
    "k of none": (ROCKER | {"k": 0}, MORE, ["k"]),
    "k of none, crank": (ROCKER | {"k": 0, "l1": 70}, MORE, ["k"]),
    "k below 1, crank too long": (
        ROCKER | {"k": 0.9, "l1": 95}, rf"{TO}\S+ mm; and k: {NUMBER} for", ["l1", "k"]),
    "k of 1, best": (ROCKER | {"k": 1}, rf"k {NUMBER} or more", ["k"]),
    "k of 1, best, by the frame": (ROCKER | {"k": 1}, rf"or l4 {NUMBER}, with", ["l4"]),
    "k of 1, crank too long": (ROCKER | {"k": 1, "l1": 100}, rf"^l4 {NUMBER} in the place of l1", ["l4"], ["l1"]),
    "k of 1, crank short": (ROCKER | {"k": 1, "l1": 70}, rf"or l4 {NUMBER} in the place of l1", ["l4"], ["l1"]),
    "the other sense": (ROCKER | {"k": 2.6, "turns": "cw"}, r"^turns: (ccw),", ["turns"]),
    "sense or k": (ROCKER | {"k": 2.6, "turns": "cw"}, rf"or k {NUMBER} or less", ["k"]),
    "sense, frame": (ROCKER | {"k": 2.6, "turns": "cw", "l4": 700}, rf"^k {NUMBER} or less", ["k"]),
    "sense, wide swing": (ROCKER | {"k": 2.6, "turns": "cw", "psi2": 229.77}, r"^turns: (ccw)$", ["turns"]),
    "k too large for the crank": (
        ROCKER | {"k": 5, "l1": 300}, rf"^k {NUMBER} or less with choose: (best transmission)", ["k", "choose"],
        ["l1"]),
    "k too large for the crank, another": (
        ROCKER | {"k": 5, "l1": 300}, rf"or l1 {NUMBER} with k {NUMBER}$", ["l1", "k"]),
    "k too large for the coupler": (ROCKER | {"k": 5, "l2": 50}, rf"or l2 {NUMBER} with k {NUMBER}$", ["l2", "k"]),
    "k too large for the place": (ROCKER | {"k": 5, "near": [100, 50]}, rf"^k {NUMBER} or less", ["k"]),
    "no swing": (ROCKER | {"k": 1.2, "psi2": 50}, rf"from {NUMBER} to", ["psi2"]),
    "no swing, the other way": (ROCKER | {"k": 1.2, "psi2": 50}, rf"or {NUMBER} to", ["psi2"]),
    "no swing, large k": (ROCKER | {"k": 5, "psi2": 50}, rf"from {NUMBER} to", ["psi2"]),
    "no swing, frame": (ROCKER | {"k": 1.2, "psi2": 50, "l4": 250}, rf"^psi2 {NUMBER} or less", ["psi2"]),
    "swing too large, sense": (ROCKER | {"k": 1.2, "psi2": 250, "turns": "cw"}, rf"to {NUMBER}, or", ["psi2"]),
    "lever's k": (LEVER | {"k": 0, "CB": 500, "OC": 200}, MORE, ["k"]),
    "lever's swing": ({"task": "slotted-lever", "swing": 0, "CB": 500, "OC": 200}, TO, ["swing"]),
    "no lever": (LEVER | {"CB": 0, "within": [200, 300]}, MORE, ["CB"]),
    "no lever, frame": (LEVER | {"CB": 0, "OC": 200}, rf"from {NUMBER} on", ["CB"]),
    "one place": (LEVER | {"B1": [1, 2], "B2": [1, 2], "OC": 20}, rf"as {PLACE}", [("B2", 2)]),
    "no bounds": (LEVER | {"CB": 500, "within": [-450, -600]}, rf"^{PLACE}", [("within", 2)]),
    "shaper's k": (RAM | {"k": 0, "OC": 350, "DE": 200}, MORE, ["k"]),
    "shaper's k, frame too long": (RAM | {"k": 0.6, "OC": 600, "DE": 200}, rf" to {NUMBER}$", ["k"]),
    "no ram's stroke, rod too short": (
        RAM | {"stroke": -400, "OC": 350, "DE": 2}, rf"{MORE}, and DE {NUMBER} or more", ["stroke", "DE"]),
    "two links of none": (
        {"task": "grashof", "l1": -1, "l2": 10, "l3": 12, "l4": -30}, rf"{MORE}; and l4: {NUMBER} or more",
        ["l1", "l4"]),
    "no input link": (PAIRS | {"l1": -50, "pairs": [[10, 20], [40, 60]]}, MORE, ["l1"]),
    "no input link, the best": (
        PAIRS | {"l1": -50, "pairs": [[10, 20], [40, 60]]}, rf"; {NUMBER} for the best", ["l1"]),
    "no solution of this number": (
        PAIRS | {"pairs": [[21.33, 19.4], [31.22, 64.53], [98.81, 82.74]], "choose": 3},
        r"^1 to (1) with defects: (keep)",
        ["choose", "defects"]),
    "one pin": (GUIDED | {"positions": TURNING, "B": [0, 0], "C": [0, 0], "AB": 200, "DC": 200},
                rf"another C, as {PLACE}", [("C", 2)]),
    "both links too short": (
        GUIDED | {"positions": [[0, 0, 0], [100, 50, 30]], "B": [-34, 73], "C": [25, -22], "AB": 0, "DC": 0},
        rf"^AB {NUMBER} or more; and DC {NUMBER} or more", ["AB", "DC"]),
    "the other link as the driver": (
        GUIDED | {"positions": [[0, 0, 0], [60, 40, 75]], "B": [0, 0], "AB": 70, "C": [50, 0], "DC": 150,
                  "DC_side": "right"},
        r"or DC as the driver \((C) as (B) is now, (DC) as (AB) is now, (DC_side) as (AB_side) is now, "
        r"(B) as (C) is now, (AB) as (DC) is now, (AB_side) as (DC_side) is now\)", None),
    "turns of a coupler that does not turn": (
        GUIDED | {"positions": [[0, 0, 0], [100, 50, 0], [200, 50, 0], [300, 0, 0]], "AB_turn": -65, "DC_turn": -14},
        rf"^AB_turn and DC_turn {NUMBER}$", ["AB_turn"], ["DC_turn"]),
    "one pivot": (GUIDED | {"positions": [*TURNING, [150, 120, 70]], "A": [0, 0], "D": [0, 0]},
                  rf"another D, as {PLACE}", [("D", 2)]),
    "a pin in the pole": (
        GUIDED | {"positions": [[0, 0, 0], [0, 0, 40]], "B": [0, 0], "C": [100, 0], "AB": 20, "DC": 200},
        rf"another B, as {PLACE}", [("B", 2)]),
}  # fmt: skip


def typed(block, told, keys, dropped=()):
    """The block with the values that a message tells, or, without keys, its own under the other names."""
    if keys is None:
        whole = {"AB_side": "left", "DC_side": "left"} | block
        return block | {new: whole[old] for new, old in zip(told[::2], told[1::2], strict=True)}
    block = {key: value for key, value in block.items() if key not in dropped}
    values = list(told)
    for key in keys:
        if isinstance(key, tuple):
            block[key[0]], values = values[: key[1]], values[key[1] :]
        elif key is None:
            values.pop(0)
        else:
            block[key] = values.pop(0)
    return block


@pytest.mark.parametrize("case", TOLD)
def test_what_is_told_in_the_place_of_what_cannot_be_is_solved(case):
    block, pattern, keys, *dropped = TOLD[case]
    told = refused(block).allowed
    match = re.search(pattern, told)
    assert match, told
    solved(typed(block, match.groups(), keys, *dropped))


def test_places_of_a_coupler_that_does_not_turn_are_told_off_their_line():
    three = GUIDED | {"positions": STRAIGHT, "B": [0, 0], "C": [100, 0]}
    match = re.search(rf"^position (\d): y {NUMBER}$", refused(three).allowed)
    places = [list(place) for place in STRAIGHT]
    places[int(match[1]) - 1][1] = match[2]
    solved(three | {"positions": places})
    four = [*STRAIGHT, [300, 0, 0]]
    match = re.search(rf"^positions 2 and 3 at {PLACE} and {PLACE}", refused(GUIDED | {"positions": four}).allowed)
    solved(GUIDED | {"positions": [four[0], [match[1], match[2], 0], [match[3], match[4], 0], four[3]]})


def test_an_input_that_turns_back_is_put_right_with_the_output_that_it_needs():
    pairs = [[10, 20], [10, 60], [20, 10], [30, 55]]
    told = refused(PAIRS | {"pairs": pairs}).allowed
    match = re.search(rf"^input angle 2: {NUMBER}; and output angle 3: {NUMBER}", told)
    assert match, told
    solved(PAIRS | {"pairs": [pairs[0], [match[1], 60], [20, match[2]], pairs[3]]})


def test_where_no_input_can_stay_all_are_told():
    pairs = [[200, 20], [150, 60], [700, 10], [30, 55], [900, 80]]
    told = refused(PAIRS | {"pairs": pairs}).allowed
    match = re.search(rf"^input angles {NUMBER}, {NUMBER}, {NUMBER}, {NUMBER}, {NUMBER}; and output angle", told)
    assert match, told
    inputs = [float(angle.split()[0]) for angle in match.groups()]
    steps = [b - a for a, b in pairwise(inputs)]
    assert (min(steps) > 0 or max(steps) < 0) and abs(inputs[-1] - inputs[0]) < 360


def test_between_the_value_that_is_told_and_the_one_asked_there_is_nothing():
    for block, pattern, key, share in (
        (ROCKER | {"k": 5, "near": [100, 50]}, rf"^k {NUMBER} or less", "k", 1.0001),
        (ROCKER | {"k": 1.2, "psi2": 50, "l4": 250}, rf"^psi2 {NUMBER} or less", "psi2", 1.0001),
        (RAM | {"k": 0.6, "OC": 600, "DE": 200}, rf" to {NUMBER}$", "k", 1.0001),
        (LEVER | {"CB": 0, "within": [200, 300]}, MORE, "CB", 0.9999),
    ):
        value, _, unit = re.search(pattern, refused(block).allowed)[1].partition(" ")
        refused(block | {key: f"{float(value) * share!r} {unit}".rstrip()})
