"""What is told where no four-bar passes pairs of angles in order can be typed in, and is the nearest of its kind."""

from __future__ import annotations

import re
from functools import cache

import numpy as np
import pytest
from test_synthesis_limits import FARTHER, refused, solved

from tmm_cli.problem.errors import ProblemError
from tmm_cli.synthesis.four_bar_by_angles.suggestion import LINKS

FUNCTIONS = (("x^2", [0, 1]), ("log10(x)", [1, 2]), ("sin(x)", [0, 90]), ("exp(x)", [0, 1]), ("1/x", [1, 3]))
NUMBER = (
    r"^(the last output angle|the first output angle|the last input angle|the first input angle|\w+ angle \d:|\w+) "
)
COUNT = 3
KINDS = ("2", "3", "3 wide", "4", "4 wide", "5", "3f", "4f", "5f")


def of_pairs(phi, psi, **more):
    rows = [[float(a), float(b)] for a, b in zip(phi, psi, strict=True)]
    return {"task": "four-bar-by-angles", "pairs": rows} | more


def drawn(r, kind):
    """A random task of so many pairs, or (f) precision points; wide: anywhere, the output perhaps turning back."""
    count = int(kind[0])
    if "f" in kind:
        name, x = FUNCTIONS[r.integers(len(FUNCTIONS))]
        first, start = r.uniform(-60, 60, 2)
        ends = {"input": [first, first + r.uniform(30, 140)], "output": [start, start + r.uniform(20, 120)]}
        return {"task": "four-bar-by-angles", "function": name, "x": x, "points": count, "l4": 100,
                **{key: [float(v) for v in row] for key, row in ends.items()}}  # fmt: skip
    wide = "wide" in kind
    steps = r.uniform(-30 if wide else 5, 50, count)
    phi, psi = np.cumsum(r.uniform(10, 50, count)), np.cumsum(steps) + (r.uniform(-180, 180) if wide else 0)
    lengths = {"l1": 100, "l3": float(r.uniform(20, 900))} if count == 2 else {"l4": 100}
    return of_pairs(phi, psi, **lengths)


@cache
def refusals(kind):
    """Tasks that are refused, with what is told."""
    r = np.random.default_rng([*map(ord, kind)])
    found = []
    while len(found) < COUNT:
        block = drawn(r, kind)
        try:
            solved(block)
        except ProblemError as error:
            found.append((block, error.allowed))
    return found


def place(block, told):
    """Which number of a block is named."""
    what = re.match(NUMBER, told)[1]
    if " angle" not in what:
        return (what,)
    row = "input" if "input" in what else "output"
    if "function" in block:
        return row, int("last" in what)
    which = 0 if "first" in what else len(block["pairs"]) - 1 if "last" in what else int(what[-2]) - 1
    return "pairs", which, int(row == "output")


def put(block, path, value):
    """The block with a value at a place."""
    if not path:
        return value
    inner = block.copy()
    inner[path[0]] = put(block.get(path[0], 0) if isinstance(block, dict) else block[path[0]], path[1:], value)
    return inner


def at(block, path):
    for step in path:
        block = block.get(step, 0) if isinstance(block, dict) else block[step]
    return float(block)


def links(outcome):
    lengths = [float(outcome.parameters[f"l{k}"].value) for k in range(1, 5)]
    return max(lengths) / min(lengths)


@pytest.mark.parametrize("kind", KINDS)
def test_the_number_that_is_told_is_good_and_one_that_is_nearer_is_not(kind):
    for block, told in refusals(kind):
        if told.startswith("other angles"):
            continue
        path = place(block, told)
        printed = re.search(r" ([^ ,;]+ (?:deg|mm))", told)[1]
        number, _, unit = printed.partition(" ")
        outcome = solved(put(block, path, printed))
        assert links(outcome) <= LINKS * (1 + 1e-3)
        way = np.sign(at(block, path) - float(number)) * FARTHER * max(abs(float(number)), 10)
        try:
            nearer = solved(put(block, path, f"{float(number) + way!r} {unit}"))
        except ProblemError:
            continue
        assert links(nearer) > LINKS


def test_a_number_is_told_for_nearly_all_random_pairs():
    every = [told for kind in KINDS for _, told in refusals(kind)]
    assert sum(told.startswith("other angles") for told in every) <= len(every) // 10


def test_where_no_single_number_helps_that_is_said():
    block = {"task": "four-bar-by-angles", "function": "x^3", "x": [0, 1], "points": 3, "l4": 100,
             "input": [6.00399, 86.7661], "output": [58.4081, -41.1569]}  # fmt: skip
    assert refused(block).allowed == "other angles, or defects: keep; no single number, changed alone, helps"
    block = of_pairs([200, 150, 700, 30, 900], [20, 60, 10, 55, 80], l4=100)
    assert refused(block).allowed == "input angles that only grow, or only fall, by less than a turn in all"


@pytest.mark.parametrize(("phi", "psi"), [
    ([30, 80, 70], [60, 90, 100]), ([30, 20, 70], [60, 90, 100]), ([30, 30, 70], [60, 90, 100]),
    ([0, 20, 40, 30], [0, 15, 33, 55]), ([0, 20, 20, 60, 80], [0, 15, 33, 55, 83]), ([5, 200, 400], [10, 30, 60]),
])  # fmt: skip
@pytest.mark.parametrize("more", [{}, {"defects": "keep"}])
def test_an_input_that_turns_back_or_round_is_refused_with_the_input_angle_that_does_not(phi, psi, more):
    block = of_pairs(phi, psi, l4=100, **more)
    error = refused(block)
    assert "turns back" in error.message or "come round" in error.message
    path = place(block, error.allowed)
    assert path[2] == 0
    solved(put(block, path, re.search(r" ([^ ,;]+ deg)", error.allowed)[1]))


@pytest.mark.parametrize("last", [10, 30, 170])
def test_a_pair_on_the_line_of_the_frame_is_a_dead_position_whatever_rounding_says(last):
    block = of_pairs([0, 90], [0, last], l1=40, l4=100)
    error = refused(block)
    assert "defect" in error.message or "locks" in error.message
    solved(put(block, place(block, error.allowed), re.search(r" ([^ ,;]+ (?:deg|mm))", error.allowed)[1]))


def test_the_number_of_a_sound_solution_is_told_for_one_that_is_not():
    block = of_pairs([0, 20, 40, 60], [0, 15, 33, 55], l4=100, choose=2)
    assert refused(block).allowed == "1; or choose: transmission"
    solved(block | {"choose": 1})
    alone = of_pairs([30, 80, 120], [60, 60, 100], l4=100, choose=1)
    assert refused(alone).allowed == "1 to 1 with defects: keep; every solution has a defect"
    solved(alone | {"defects": "keep"})
