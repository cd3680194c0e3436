"""What a refused synthesis prints as allowed is allowed as it is printed, and is the limit."""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest

from tmm_cli import solve
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.reader import read_text
from tmm_cli.problem.units import UnitSystem
from tmm_cli.synthesis.check import measured
from tmm_cli.synthesis.reading import alone, build
from tmm_cli.synthesis.record import Infeasible, Outcome, Value, sound
from tmm_cli.synthesis.refusals import shown

SEEDS = range(4)
FARTHER = 1e-4  # relative: beyond the limit


def flow(value):
    return "[" + ", ".join(map(flow, value)) + "]" if isinstance(value, list) else str(value)


def solved(block):
    """What the synthesis of a file gives, without a warning; numbers of its parameters are finite."""
    keys = ", ".join(f"{key}: {flow(value)}" for key, value in block.items())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        _, _, found, _ = alone(read_text(f"tmm: 1\nsynthesis: {{{keys}}}\n", "x.yaml"))
    assert all(np.isfinite(float(v.value)) for v in found.outcome.found if v.kind != "word")
    return found.outcome


def refused(block):
    with pytest.raises(ProblemError) as caught:
        solved(block)
    assert caught.value.allowed is not None
    return caught.value


def slider(**more):
    return lambda r: {"task": "crank-slider", "stroke": r.uniform(10, 500), **{k: f(r) for k, f in more.items()}}


def rocker(**more):
    return lambda r: {
        "task": "four-bar-by-k", "l3": r.uniform(10, 900), "psi1": r.uniform(20, 40), "psi2": r.uniform(60, 150),
        **{k: f(r) for k, f in more.items()},
    }  # fmt: skip


def down(make):
    """The rocker swings clockwise."""
    return lambda r: (b := make(r)) | {"psi1": b["psi2"], "psi2": b["psi1"]}


def lever(**more):
    return lambda r: {"task": "slotted-lever", "k": r.uniform(1.05, 4), "CB": r.uniform(50, 900),
                      **{k: f(r) for k, f in more.items()}}  # fmt: skip


def ram(**more):
    return lambda r: {"task": "shaper", "stroke": r.uniform(50, 900), **{k: f(r) for k, f in more.items()}}


def between(low, high):
    return lambda r: r.uniform(low, high)


LESS, MORE = r"{} ([^ ,]+(?: mm| deg)?) or less", r"{} ([^ ,]+(?: mm| deg)?) or more"
ALONE, ALONE_MORE = r"^([^ ,]+(?: mm| deg)?) or less", r"^([^ ,]+(?: mm| deg)?) or more"
LOW, HIGH = r"(?:^|psi2 from )([^ ,]+(?: mm| deg)?) to ", r" to ([^ ,]+(?: mm| deg)?)"
K, RATIO = LESS.format("k"), LESS.format("ratio")
CASES = {  # a task that cannot be, and where the limit of each key stands in the message
    "k too large for L": (slider(k=between(2, 2.9), ratio=between(4, 60)), {"k": ALONE}),
    "k of 3 or more": (slider(k=between(3, 9), ratio=between(1.1, 9)), {"k": ALONE}),
    "pressure angle too small": (
        slider(k=between(1.2, 2.5), pressure=between(3, 20)), {"pressure": ALONE_MORE}),
    "k of 3 or more, pressure": (slider(k=between(3, 9), pressure=between(20, 80)), {"k": ALONE}),
    "offset too large": (slider(k=between(1.8, 2.8), e=between(400, 900)), {"k": ALONE}),
    "k of 3 or more, offset": (slider(k=between(3, 9), e=between(4, 900)), {"k": ALONE}),
    "nu too large": (slider(ratio=between(1.1, 4), nu=between(3.2, 9)),
                     {"nu": ALONE}),
    "rod too short": (slider(ratio=between(0.1, 1), nu=between(0, 3)), {"ratio": ALONE_MORE}),
    "rod too short, k": (slider(ratio=between(0.1, 1), k=between(1, 2.5)), {"ratio": ALONE_MORE}),
    "k too large for the swing": (rocker(k=between(7, 40)), {"k": ALONE}),
    "k too large for the swing, clockwise": (down(rocker(k=between(7, 40))), {"k": ALONE}),
    "swing too large": (rocker(k=between(1.1, 2), psi2=between(230, 300)), {"psi2": ALONE}),
    "frame too long": (rocker(k=between(1.1, 2), l4=between(2e4, 9e4)), {"l4": ALONE}),
    "frame too short": (rocker(k=between(1.1, 1.3), l4=between(0.1, 1)), {"l4": ALONE_MORE}),
    "crank too long": (rocker(k=between(1.1, 2), l1=between(2e3, 9e3)), {"l1": ALONE}),
    "coupler too long": (rocker(k=between(1.1, 2), l2=between(2e5, 9e5)), {"l2": ALONE}),
    "coupler too short": (rocker(k=between(1.1, 2), l2=between(0.1, 1)), {"l2": ALONE_MORE}),
    "frame too short, k = 1": (rocker(k=lambda r: 1, l4=between(0.1, 9)), {"l4": ALONE_MORE}),
    "stone passes": (lever(within=lambda r: [r.uniform(1000, 1100), 2000]), {"within": ALONE}),
    "slot too short": (ram(k=between(1.1, 4), OC=between(5000, 9000), DE=between(5e3, 9e3)), {"OC": ALONE}),
    "slot too short, crank": (ram(k=between(1.1, 4), OA=between(5000, 9000), DE=between(5e3, 9e3)), {"OA": ALONE}),
    "slot too short, ratio": (
        ram(k=between(1.1, 4), frame_ratio=between(1, 3), DE=between(5e3, 9e3)), {"frame_ratio": ALONE}),
    "ram turns back": (ram(k=between(2, 4), frame_ratio=between(0.1, 0.3), DE=between(0.1, 1)), {"DE": ALONE_MORE}),
    "ram turns back, ratio": (
        ram(k=between(2, 4), frame_ratio=between(0.1, 0.3), rod_ratio=between(0.01, 0.03)), {"rod_ratio": ALONE_MORE}),
    "ram turns back, pressure": (
        ram(k=between(2, 4), frame_ratio=between(0.1, 0.3), pressure=between(80, 89)), {"pressure": ALONE}),
    "pressure angle of no k": (slider(k=between(1.1, 1.5), pressure=between(95, 150)), {"pressure": ALONE}),
    "pressure angle of a right angle": (slider(nu=between(0, 1), pressure=between(95, 150)), {"pressure": ALONE}),
    "no stroke": (lambda r: {"task": "crank-slider", "stroke": -r.uniform(0, 9), "ratio": 4, "nu": 0.5},
                  {"stroke": ALONE_MORE}),
    "no stroke, speed": (
        lambda r: {"task": "crank-slider", "speed": -r.uniform(0, 9), "crank_speed": 9, "ratio": 4, "nu": 0.5},
        {"speed": r"^([^ ,]+ m/s) or more"}),
    "no rocker": (lambda r: rocker(k=between(1.1, 2))(r) | {"l3": -r.uniform(0, 9)}, {"l3": ALONE_MORE}),
    "no crank": (rocker(k=between(1.1, 2), l1=between(-9, 0)), {"l1": ALONE_MORE}),
    "sense, k too large": (rocker(k=between(30, 40), turns=lambda r: "cw"), {"k": ALONE}),
    "no lever": (lever(OC=between(1, 9), CB=between(-9, 0)), {"CB": ALONE_MORE}),
    "swing of half a turn": (
        lambda r: {"task": "slotted-lever", "CB": 500, "OC": 90, "swing": r.uniform(181, 300)},
        {"swing": ALONE}),
    "no frame": (ram(k=between(1.1, 4), OC=between(-9, 0), DE=between(5e3, 9e3)), {"OC": ALONE_MORE}),
    "no rod": (ram(k=between(1.1, 4), frame_ratio=between(0.1, 0.3), DE=between(-9, 0)), {"DE": ALONE_MORE}),
    "no rod, ratio": (
        ram(k=between(1.1, 4), frame_ratio=between(0.1, 0.3), rod_ratio=between(-9, 0)), {"rod_ratio": ALONE_MORE}),
    "no ram's stroke": (
        lambda r: ram(k=between(1.1, 4), OC=between(20, 90), DE=between(5e3, 9e3))(r) | {"stroke": -r.uniform(0, 9)},
        {"stroke": ALONE_MORE}),
    "no ram's stroke, crank": (
        lambda r: ram(k=between(1.1, 4), OA=between(20, 90), DE=between(5e3, 9e3))(r) | {"stroke": -r.uniform(0, 9)},
        {"stroke": ALONE_MORE}),
    "pressure angle of a ram": (
        ram(k=between(1.1, 4), frame_ratio=between(0.1, 0.3), pressure=between(95, 150)), {"pressure": ALONE}),
    "no link": (
        lambda r: {"task": "grashof", "l1": -r.uniform(0, 9), "l2": 10, "l3": 12, "l4": r.uniform(30, 40)},
        {"l1": ALONE_MORE}),
    "no link's size": (
        lambda r: {"task": "grashof", "l1": -r.uniform(0, 9), "l2": 20, "l3": 22, "l4": r.uniform(30, 40)},
        {"l1": ALONE_MORE}),
    "links do not close": (
        lambda r: {"task": "grashof", "l1": r.uniform(31, 90), **{f"l{k}": r.uniform(1, 10) for k in (2, 3, 4)}},
        {"l1": ALONE}),
    "link does not reach": (
        lambda r: {"task": "coupler-positions", "positions": [[0, 0, 0], [r.uniform(50, 90), 80, r.uniform(20, 60)]],
                   "B": [0, 0], "C": [100, 0], "AB": r.uniform(1, 40), "DC": 400, "defects": "keep"},
        {"AB": r"^AB (\S+ mm)$"}),
}  # fmt: skip


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("seed", SEEDS)
def test_a_printed_limit_typed_in_is_allowed_and_a_little_farther_is_not(case, seed):
    make, limits = CASES[case]
    block = make(np.random.default_rng([seed, *map(ord, case)]))
    told = refused(block).allowed
    for key, pattern in limits.items():
        match = re.search(pattern, told)
        assert match, told
        printed = match[1]
        number, _, unit = printed.partition(" ")
        least = pattern in (ALONE_MORE, LOW) or "more" in pattern or key == "AB"
        beyond = f"{float(number) * (1 - FARTHER if least else 1 + FARTHER)!r} {unit}".rstrip()
        wrap = (lambda text, k=key: [text, 2000]) if key == "within" else (lambda text: text)
        solved(block | {key: wrap(printed)})
        refused(block | {key: wrap(beyond)})


@pytest.mark.parametrize("seed", range(14))
def test_the_output_angle_that_is_told_makes_a_four_bar_without_defects(seed):
    r = np.random.default_rng(seed)
    for _ in range(40):
        count = int(r.integers(2, 5))
        phi, psi = np.cumsum(r.uniform(10, 50, count)), np.cumsum(r.uniform(5, 50, count))
        pairs = [[float(a), float(b)] for a, b in zip(phi, psi, strict=True)]
        block = {"task": "four-bar-by-angles", "l4": 100, "pairs": pairs}
        if count == 2:
            block |= {"l1": r.uniform(20, 900)}
        try:
            solved(block)
        except ProblemError as error:
            told = error.allowed
            break
    else:
        return
    if match := re.search(r"^(l\d) ([^ ]+ mm)", told):
        solved(block | {match[1]: match[2]})
        return
    match = re.search(r"output angle (?:(\d): )?([^ ,;]+ deg)", told)
    assert match, told
    which = int(match[1] or count) - 1
    pairs[which] = [pairs[which][0], match[2]]
    solved(block)


def test_equal_ranges_of_input_and_output_with_four_points_want_endless_links_and_that_is_said():
    block = {
        "task": "four-bar-by-angles", "function": "x^2", "x": [0, 1], "input": [30, 120], "points": 4, "l4": 100,
        "output": [60, 150],
    }  # fmt: skip
    error = refused(block)
    assert "infinitely long" in error.message and error.found == "[60, 150]"
    psi = re.search(r"angle ([^ ,]+ deg)", error.allowed)[1]
    assert psi != "150 deg"
    links = [float(solved(block | {"output": [60, psi]}).parameters[f"l{k}"].value) for k in range(1, 5)]
    assert max(links) <= 50 * min(links)


ROCKER = """
parameters: {{L3: {l3}, P2: {psi2!r} deg}}
points: {{A: [xA, yA], D: [0, 0]}}
links:
  1: {{points: [A, B], length: l1}}
  2: {{points: [B, C], length: l2}}
  3: {{points: [D, C], length: L3}}
driver: {{link: 1, speed: 1 rad/s}}
sketch: {{at: phi2, C: [L3*cos(P2), L3*sin(P2)]}}
output: 3
"""


@pytest.mark.parametrize("case", [
    "k too large for the swing", "k too large for the swing, clockwise", "sense, k too large", "frame too long",
    "frame too short",
    "crank too long", "coupler too long", "coupler too short",
])  # fmt: skip
def test_at_a_printed_limit_the_four_bar_still_moves_as_it_was_asked(case):
    make, limits = CASES[case]
    for seed in range(3):
        block = make(np.random.default_rng([seed, *map(ord, case)]))
        key, pattern = next(iter(limits.items()))
        block[key] = re.search(pattern, refused(block).allowed)[1]
        keys = ", ".join(f"{name}: {flow(value)}" for name, value in block.items())
        linkage = ROCKER.format(l3=block["l3"], psi2=float(block["psi2"]))
        found = build(read_text(f"tmm: 1\nsynthesis: {{{keys}}}\n{linkage}", "x.yaml"))
        assert all(m.met for m in measured(found.synthesis.outcome, solve(found, "kinematics")))


def test_limits_are_rounded_to_their_side_and_never_onto_a_limit_that_is_not_allowed():
    units = UnitSystem({"length": "mm"})
    rows = {
        "most": (0.1234567654, "length", "most"), "least": (0.1234561196, "length", "least"),
        "below": (3.0, "number", "below"), "above": (2.0, "number", "above"), "plain": (0.1234567654, "length"),
        "whole": (0.25, "length", "most"), "exact": (0.1234567654, "length", "exact"), "name": ("AB", "word"),
    }  # fmt: skip
    assert shown(rows, units) == {
        "most": "123.456 mm", "least": "123.457 mm", "below": "2.99999", "above": "2.00001", "plain": "123.457 mm",
        "whole": "250 mm", "exact": "123.4567654 mm", "name": "AB",
    }  # fmt: skip


def test_what_is_no_number_is_never_an_answer():
    good = Value("l1", 0.1, "length", "word.value")
    assert sound(Outcome((), (good,), "word.value")).found == (good,)
    for bad in (np.nan, np.inf, np.longdouble("nan")):
        with pytest.raises(Infeasible):
            sound(Outcome((), (good, Value("l2", bad, "length", "word.value")), "word.value"))


def test_near_the_largest_k_the_four_bar_is_still_found_and_beyond_it_the_reason_is_told():
    block = {"task": "four-bar-by-k", "l3": 250, "psi1": 60, "psi2": 110, "support": [400, 0]}
    assert solved(block | {"k": 4.5287}).parameters["l1"].value > 0
    error = refused(block | {"k": 4.53846})
    assert error.path == ("synthesis", "k") and "k is too large" in error.message


def guided(r, count):
    """A random task of a coupler's positions, free of choices that only luck makes sound."""
    turns = np.cumsum([0, *r.uniform(8, 30, count - 1)])
    way = np.cumsum([0, *r.uniform(30, 70, count - 1) * np.exp(1j * np.radians(r.uniform(-20, 70, count - 1)))])
    block = {
        "task": "coupler-positions",
        "positions": [[float(p.real), float(p.imag), float(a)] for p, a in zip(way, turns, strict=True)],
    }
    if count == 4:
        return block | {"AB_turn": r.uniform(-60, 60)} | ({"DC_turn": r.uniform(-60, 60)} if r.uniform() < 0.5 else {})
    b, c = r.uniform(-50, 50, (2, 2)).tolist()
    lengths = {"AB": r.uniform(60, 200), "DC": r.uniform(60, 200)} if count == 2 else {}
    return block | {"B": b, "C": c} | lengths
