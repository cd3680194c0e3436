"""What a refused synthesis names in the place of what cannot be: typed in, it is solved."""

from __future__ import annotations

import re

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
    "an offset with k of 1": (SLIDER | {"e": 20, "k": 1}, MORE, ["k"]),
    "an offset with k of none": (SLIDER | {"e": 20, "k": 0}, MORE, ["k"]),
    "k of none": (ROCKER | {"k": 0}, MORE, ["k"]),
    "k of none, crank": (ROCKER | {"k": 0, "l2": 250}, MORE, ["k"]),
    "k of 1, best": (ROCKER | {"k": 1}, MORE, ["k"]),
    "the other sense": (ROCKER | {"k": 2.6, "turns": "cw"}, r"^(ccw)$", ["turns"]),
    "k too large for the sense": (ROCKER | {"k": 26, "turns": "cw"}, rf"^{NUMBER} or less", ["k"]),
    "no swing": (ROCKER | {"k": 1.2, "psi2": 50}, MORE, ["psi2"]),
    "no swing, large k": (ROCKER | {"k": 5, "psi2": 50}, MORE, ["psi2"]),
    "swing too large, sense": (ROCKER | {"k": 1.2, "psi2": 250, "turns": "cw"}, rf"^{NUMBER} or less", ["psi2"]),
    "no level supports": (ROCKER | {"k": 1.2, "psi1": 80, "psi2": 85, "choose": "supports level"},
                          r"^(best transmission)$", ["choose"]),
    "a place at a dead rocker": (ROCKER | {"k": 1.2, "near": [-300, -40]}, rf"^{PLACE}", [("near", 2)]),
    "lever's k": (LEVER | {"k": 0, "CB": 500, "OC": 200}, MORE, ["k"]),
    "lever's swing": ({"task": "slotted-lever", "swing": 0, "CB": 500, "OC": 200}, MORE, ["swing"]),
    "no lever": (LEVER | {"CB": 0, "within": [200, 300]}, MORE, ["CB"]),
    "no lever, frame": (LEVER | {"CB": 0, "OC": 200}, MORE, ["CB"]),
    "shaper's k": (RAM | {"k": 0, "OC": 350, "DE": 200}, MORE, ["k"]),
    "shaper's k, frame too long": (RAM | {"k": 0.6, "OC": 600, "DE": 200}, MORE, ["k"]),
    "no input link": (PAIRS | {"l1": -50, "pairs": [[10, 20], [40, 60]]}, rf"^{NUMBER}$", ["l1"]),
    "no solution of this number": (
        PAIRS | {"pairs": [[21.33, 19.4], [31.22, 64.53], [98.81, 82.74]], "choose": 3},
        r"^1 to (1) with defects: (keep)",
        ["choose", "defects"]),
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


@pytest.mark.parametrize("block", [
    SLIDER | {"e": 0, "k": 4}, SLIDER | {"e": 0, "k": 1}, SLIDER | {"ratio": 0.5, "k": 3.5},
    SLIDER | {"ratio": 0.5, "nu": -1}, RAM | {"stroke": -400, "OC": 350, "DE": 2},
    ROCKER | {"k": 0.9, "l1": 95}, ROCKER | {"k": 5, "l1": 300},
])  # fmt: skip
def test_where_no_single_number_helps_that_is_said(block):
    assert refused(block).allowed.endswith("but then another number is refused")


@pytest.mark.parametrize(("block", "allowed"), [
    (PAIRS | {"pairs": [[10, 20], [10, 60], [20, 10], [30, 55]]},
     "input angles that only grow, or only fall, by less than a turn in all"),
    (GUIDED | {"positions": [[0, 0, 0], [100, 50, 30]], "B": [-34, 73], "C": [25, -22], "AB": 0, "DC": 0},
     "other positions or links; no single number, changed alone, helps"),
    (GUIDED | {"positions": [*STRAIGHT, [300, 0, 0]]}, "places on a circle, or a slider"),
])  # fmt: skip
def test_where_no_single_number_helps_the_task_says_so(block, allowed):
    assert refused(block).allowed == allowed


def test_turns_of_a_coupler_that_does_not_turn_are_told_one_after_the_other():
    places = [[0, 0, 0], [100, 50, 0], [200, 50, 0], [300, 0, 0]]
    block = GUIDED | {"positions": places, "AB_turn": -65, "DC_turn": -14}
    turn, _, rest = refused(block).allowed.partition(";")
    assert rest == " but then another number is refused"
    assert refused(block | {"AB_turn": turn}).allowed == turn
    solved(block | {"AB_turn": turn, "DC_turn": turn})


def test_a_place_of_a_coupler_that_does_not_turn_is_told_off_the_line_of_the_others():
    block = GUIDED | {"positions": STRAIGHT, "B": [0, 0], "C": [100, 0]}
    match = re.search(rf"^position (\d): y {NUMBER}$", refused(block).allowed)
    places = [list(place) for place in STRAIGHT]
    places[int(match[1]) - 1][1] = match[2]
    solved(block | {"positions": places})


def test_between_the_value_that_is_told_and_the_one_asked_there_is_nothing():
    for block, pattern, key, share in (
        (ROCKER | {"k": 5}, rf"^{NUMBER} or less", "k", 1.0001),
        (LEVER | {"CB": 0, "within": [200, 300]}, MORE, "CB", 0.9999),
    ):
        value, _, unit = re.search(pattern, refused(block).allowed)[1].partition(" ")
        refused(block | {key: f"{float(value) * share!r} {unit}".rstrip()})
