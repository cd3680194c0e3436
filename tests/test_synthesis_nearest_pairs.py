"""What is told where no four-bar passes pairs of angles in order can be typed in, and is the nearest of its kind."""

from __future__ import annotations

import re
from functools import cache

import numpy as np
import pytest
from test_synthesis_limits import FARTHER, refused, solved

from tmm_cli.problem.errors import ProblemError
from tmm_cli.synthesis import pairs
from tmm_cli.synthesis.pair_changes import LINKS

FUNCTIONS = (("x^2", [0, 1]), ("log10(x)", [1, 2]), ("sin(x)", [0, 90]), ("exp(x)", [0, 1]), ("1/x", [1, 3]))
NUMBER = (
    r"^(the last output angle|the first output angle|the last input angle|the first input angle|\w+ angle \d:|\w+) "
)
COUNT = 3
KINDS = ("2", "3", "3 wide", "4", "4 wide", "5", "3f", "4f", "5f")
USABLE = r"\((\S+ (?:deg|mm)) for a least transmission angle of (\d+) deg\)"


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
    which = len(block["pairs"]) - 1 if "last" in what else int(what[-2]) - 1
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


def transmission(outcome):
    return np.degrees(next(float(v.value) for v in outcome.found if v.words.endswith(".transmission")))


def links(outcome):
    lengths = [float(outcome.parameters[f"l{k}"].value) for k in range(1, 5)]
    return max(lengths) / min(lengths)


@pytest.mark.parametrize("kind", KINDS)
def test_the_number_that_is_told_is_good_and_one_that_is_nearer_is_not(kind):
    for block, told in refusals(kind):
        if told.startswith(("points", "output angles")):
            continue
        path = place(block, told)
        printed = re.search(r" ([^ ,;]+ (?:deg|mm))", told)[1]
        number, _, unit = printed.partition(" ")
        outcome = solved(put(block, path, printed))
        if "no link" in told:
            assert links(outcome) <= LINKS
        way = np.sign(at(block, path) - float(number)) * FARTHER * max(abs(float(number)), 10)
        try:
            nearer = solved(put(block, path, f"{float(number) + way!r} {unit}"))
        except ProblemError:
            continue
        assert "no link" in told and links(nearer) > LINKS


@pytest.mark.parametrize("kind", KINDS)
def test_the_number_beside_the_limit_gives_the_transmission_angle_that_is_told(kind):
    for block, told in refusals(kind):
        if match := re.search(USABLE, told):
            outcome = solved(put(block, place(block, told), match[1]))
            assert transmission(outcome) >= float(match[2]) - 1e-6
            limit = solved(put(block, place(block, told), re.search(r" ([^ ,;]+ (?:deg|mm))", told)[1]))
            assert transmission(limit) < min(30, float(match[2]))


@pytest.mark.parametrize("kind", KINDS)
def test_a_number_is_told_for_random_pairs(kind):
    assert not any(told.startswith("other angles") for _, told in refusals(kind))


def test_all_output_angles_together_are_told_where_none_alone_helps():
    phi = [-110.063, -90.7797, -65.2674, -30.3925, -18.7759]
    psi = [79.0291, 128.82, 110.017, 86.8745, 133.306]
    block = of_pairs(phi, psi, l4=100)
    told = refused(block).allowed
    match = re.match(r"output angles (.+), each changed by (\S+) deg or less", told)
    angles = match[1].split(", ")
    moves = [abs(float(angle.split()[0]) - given) for angle, given in zip(angles, psi, strict=True)]
    assert max(moves) == pytest.approx(float(match[2]), abs=1e-3)
    solved(block | {"pairs": [[a, b] for a, b in zip(phi, angles, strict=True)]})


def test_fewer_precision_points_are_told_where_no_end_of_the_ranges_helps():
    block = {"task": "four-bar-by-angles", "function": "x^3", "x": [0, 1], "points": 3, "l4": 100,
             "input": [6.00399, 86.7661], "output": [58.4081, -41.1569]}  # fmt: skip
    count = re.match(r"points: (\d)", refused(block).allowed)[1]
    solved(block | {"points": int(count)})


def test_fewer_points_and_one_end_of_the_ranges_are_told_where_neither_helps_alone():
    block = {"task": "four-bar-by-angles", "function": "log10(x)", "x": [1, 10], "points": 4, "l4": 100,
             "input": [13.7, 227.1], "output": [42.16, -30.01]}  # fmt: skip
    told = refused(block).allowed
    count, limit, usable = re.match(r"points: (\d) with the first output angle (\S+) deg \((\S+) deg", told).groups()
    for angle in (limit, usable):
        solved(block | {"points": int(count), "output": [float(angle), -30.01]})


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


def test_a_pair_on_the_line_of_the_frame_is_a_dead_position_whatever_rounding_says():
    for last in (10, 30, 170):
        block = of_pairs([0, 90], [0, last], l1=40, l4=100)
        error = refused(block)
        assert "defect" in error.message or "locks" in error.message
        usable, least = re.search(USABLE, error.allowed).groups()
        assert transmission(solved(put(block, place(block, error.allowed), usable))) >= float(least) - 1e-6


def test_the_number_of_a_sound_solution_is_told_for_one_that_is_not():
    block = of_pairs([0, 20, 40, 60], [0, 15, 33, 55], l4=100, choose=2)
    told = refused(block).allowed
    assert told.startswith("1; or")
    solved(block | {"choose": 1})
    alone = of_pairs([30, 80, 120], [60, 60, 100], l4=100, choose=1)
    assert refused(alone).allowed.startswith("defects: keep")
    solved(alone | {"defects": "keep"})


@pytest.mark.parametrize("count", [2, 3, 4, 5])
def test_many_tasks_at_once_have_the_four_bars_of_each(count):
    r = np.random.default_rng(count)
    zeros = {name: None if count > least else 0.1 for name, least in (("phi0", 3), ("psi0", 4))}
    tasks = [
        pairs.Asked(tuple(np.cumsum(r.uniform(0.2, 0.6, count))), tuple(np.cumsum(r.uniform(0.2, 0.6, count))),
                    {"l1": 1.0, "l4": float(r.uniform(0.5, 3))} if count == 2 else {"l4": 1.0}, **zeros)
        for _ in range(20)
    ]  # fmt: skip
    every = pairs.many(tasks)
    found = pairs.solutions(every, pairs.RATIOS)
    for k, task in enumerate(tasks):
        own, here = pairs.through(task), [found[k, j] for j in range(found.l1.shape[1]) if pairs.real(found[k, j])]
        assert len(own) == len(here)
        for one, other in zip(own, here, strict=True):
            assert [float(x) for x in vars(one).values()] == pytest.approx([float(x) for x in vars(other).values()])
            assert pairs.quality(one, task) == pairs.quality(other, task)


@pytest.mark.parametrize("seed", range(4))
def test_both_extreme_positions_are_told_turned_where_no_k_makes_the_supports_level(seed):
    r = np.random.default_rng(seed)
    while True:
        first = r.uniform(-180, 180)
        block = {"task": "four-bar-by-k", "l3": 250, "psi1": first, "k": r.uniform(1, 3),
                 "psi2": first + r.choice([-1, 1]) * r.uniform(20, 140), "choose": "supports level"}  # fmt: skip
        try:
            solved(block)
        except ProblemError as error:
            if match := re.match(r"psi1 (\S+ deg) and psi2 (\S+ deg), both turned by (\S+) deg", error.allowed):
                break
    solved(block | {"psi1": match[1], "psi2": match[2]})
    back = np.sign(first - float(match[1].split()[0])) * 0.02
    psi1, psi2 = (float(match[k].split()[0]) + back for k in (1, 2))
    refused(block | {"psi1": psi1, "psi2": psi2})


def test_positions_that_are_told_turned_are_level_as_they_are_rounded_on_a_short_arc_too():
    """The arc ends where k is 3.44197 with the swing of both as they are printed with six digits."""
    block = {"task": "four-bar-by-k", "l3": 286.6, "psi1": 103.8, "psi2": 202.7548, "k": 3.442,
             "choose": "supports level", "turns": "ccw"}  # fmt: skip
    match = re.search(r"psi1 (\S+) deg and psi2 (\S+) deg, both turned", refused(block).allowed)
    for more in (0.0, 4e-4):
        for other in (0.0, 4e-4):
            solved(block | {"psi1": float(match[1]) - more, "psi2": float(match[2]) - other})


def test_four_bars_between_two_steps_of_the_first_scan_are_not_missed():
    """They are there from 78.08 deg on; between 78.18 and 78.22 deg a link of theirs is too long."""
    block = of_pairs([40.5, 75.9, 111.8, 157.5], [12.7, 24.5, 49.3, 74.2], l4=100)
    assert refused(block).allowed.startswith("the last output angle 78.0793 deg")
    refused(put(block, ("pairs", 3, 1), 78.079))
    long = [links(solved(put(block, ("pairs", 3, 1), last))) > LINKS for last in (78.0793, 78.15, 78.2, 78.23)]
    assert long == [False, False, True, False]
