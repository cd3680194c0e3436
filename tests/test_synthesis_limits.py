"""A refused synthesis tells one value of one given number: it is solved as it is printed, and is the nearest."""

from __future__ import annotations

import re
import warnings

import numpy as np
import pytest

from tmm_cli import solve
from tmm_cli.mechanics.quantities import LENGTH, NUMBER
from tmm_cli.problem import ProblemError, UnitSystem, read_text
from tmm_cli.synthesis import (
    Infeasible,
    NamedValue,
    SynthesisOutcome,
    build_synthesised,
    measure_demands,
    refuse_nonfinite,
    round_to_side,
    solve_alone,
)

SEEDS = range(2)
FARTHER = 2e-4  # relative: beyond the limit
TOLD = r"^nearest feasible value: (\w+)((?:\[\d\])*): (\S+(?: mm| deg)?)$"


def flow(value):
    return "[" + ", ".join(map(flow, value)) + "]" if isinstance(value, list) else str(value)


def solved(block):
    """What the synthesis of a file gives, without a warning; numbers of its parameters are finite."""
    keys = ", ".join(f"{key}: {flow(value)}" for key, value in block.items())
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        _, _, found, _ = solve_alone(read_text(f"tmm: 1\nsynthesis: {{{keys}}}\n", "x.yaml"))
    assert all(np.isfinite(float(v.value)) for v in found.outcome.found if v.kind != "word")
    return found.outcome


def refused(block):
    with pytest.raises(ProblemError) as caught:
        solved(block)
    assert caught.value.allowed is not None
    return caught.value


def told(block):
    """The way to the number that is told for a refused block, and its value as it is printed."""
    match = re.match(TOLD, refused(block).allowed)
    assert match, refused(block).allowed
    return (match[1], *map(int, re.findall(r"\d", match[2]))), match[3]


def put(block, path, value):
    """The block with a value at a place."""
    if not path:
        return value
    inner = block.copy()
    inner[path[0]] = put(block[path[0]], path[1:], value)
    return inner


def nearer(block, path, printed):
    """A printed value a little nearer to what is given."""
    for step in path:
        block = block[step]
    number, _, unit = printed.partition(" ")
    value, given = float(number), float(str(block).partition(" ")[0])
    step = min(FARTHER * max(abs(value), abs(value - given)), abs(value - given))
    return f"{float(value - np.sign(value - given) * step)!r} {unit}".rstrip()


def slider(**more):
    return lambda r: {"task": "crank-slider", "stroke": r.uniform(10, 500), **{k: f(r) for k, f in more.items()}}


def rocker(**more):
    return lambda r: {
        "task": "four-bar-by-k",
        "l3": r.uniform(10, 900),
        "psi1": r.uniform(20, 40),
        "psi2": r.uniform(60, 150),
        **{k: f(r) for k, f in more.items()},
    }


def down(make):
    """The rocker swings clockwise."""
    return lambda r: (b := make(r)) | {"psi1": b["psi2"], "psi2": b["psi1"]}


def lever(**more):
    return lambda r: {
        "task": "slotted-lever",
        "k": r.uniform(1.05, 4),
        "CB": r.uniform(50, 900),
        **{k: f(r) for k, f in more.items()},
    }


def ram(**more):
    return lambda r: {"task": "shaper", "stroke": r.uniform(50, 900), **{k: f(r) for k, f in more.items()}}


def between(low, high):
    return lambda r: r.uniform(low, high)


CASES = {  # a task that cannot be, and the key whose nearest value is told
    "k too large for L": (slider(k=between(2, 2.9), ratio=between(4, 60)), "k"),
    "k of 3 or more": (slider(k=between(3, 9), ratio=between(1.1, 9)), "k"),
    "pressure angle too small": (slider(k=between(1.2, 2.5), pressure=between(3, 20)), "pressure"),
    "k of 3 or more, pressure": (slider(k=between(3, 9), pressure=between(20, 80)), "k"),
    "offset too large": (slider(k=between(1.8, 2.8), e=between(400, 900)), "k"),
    "k of 3 or more, offset": (slider(k=between(3, 9), e=between(4, 900)), "k"),
    "nu too large": (slider(ratio=between(1.1, 4), nu=between(3.2, 9)), "nu"),
    "rod too short": (slider(ratio=between(0.1, 1), nu=between(0, 3)), "ratio"),
    "rod too short, k": (slider(ratio=between(0.1, 1), k=between(1, 2.5)), "ratio"),
    "k too large for the swing": (rocker(k=between(7, 40)), "k"),
    "k too large for the swing, clockwise": (down(rocker(k=between(7, 40))), "k"),
    "swing too large": (rocker(k=between(1.1, 2), psi2=between(230, 300)), "psi2"),
    "frame too long": (rocker(k=between(1.1, 2), l4=between(2e4, 9e4)), "l4"),
    "frame too short": (rocker(k=between(1.1, 1.3), l4=between(0.1, 1)), "l4"),
    "crank too long": (rocker(k=between(1.1, 2), l1=between(2e3, 9e3)), "l1"),
    "coupler too long": (rocker(k=between(1.1, 2), l2=between(2e5, 9e5)), "l2"),
    "coupler too short": (rocker(k=between(1.1, 2), l2=between(0.1, 1)), "l2"),
    "frame too short, k = 1": (rocker(k=lambda r: 1, l4=between(0.1, 9)), "l4"),
    "stone passes": (lever(within=lambda r: [r.uniform(1000, 1100), 2000]), "within[0]"),
    "slot too short": (ram(k=between(1.1, 4), OC=between(5000, 9000), DE=between(5e3, 9e3)), "OC"),
    "slot too short, crank": (ram(k=between(1.1, 4), OA=between(5000, 9000), DE=between(5e3, 9e3)), "OA"),
    "slot too short, ratio": (ram(k=between(1.1, 4), frame_ratio=between(1, 3), DE=between(5e3, 9e3)), "frame_ratio"),
    "ram turns back": (ram(k=between(2, 4), frame_ratio=between(0.1, 0.3), DE=between(0.1, 1)), "DE"),
    "ram turns back, ratio": (
        ram(k=between(2, 4), frame_ratio=between(0.1, 0.3), rod_ratio=between(0.01, 0.03)),
        "rod_ratio",
    ),
    "pressure angle of no k": (slider(k=between(1.1, 1.5), pressure=between(95, 150)), "pressure"),
    "pressure angle of a right angle": (slider(nu=between(0, 1), pressure=between(95, 150)), "pressure"),
    "sense, k too large": (rocker(k=between(30, 40), turns=lambda r: "cw"), "k"),
    "swing of half a turn": (
        lambda r: {"task": "slotted-lever", "CB": 500, "OC": 90, "swing": r.uniform(181, 300)},
        "swing",
    ),
    "pressure angle of a ram": (
        ram(k=between(1.1, 4), frame_ratio=between(0.1, 0.3), pressure=between(95, 150)),
        "pressure",
    ),
    "links do not close": (
        lambda r: {"task": "grashof", "l1": r.uniform(31, 90), **{f"l{k}": r.uniform(1, 10) for k in (2, 3, 4)}},
        "l1",
    ),
    "link does not reach": (
        lambda r: {
            "task": "coupler-positions",
            "positions": [[0, 0, 0], [r.uniform(50, 90), 80, r.uniform(20, 60)]],
            "B": [0, 0],
            "C": [100, 0],
            "AB": r.uniform(1, 40),
            "DC": 400,
            "defects": "keep",
        },
        "AB",
    ),
}


@pytest.mark.parametrize("case", CASES)
@pytest.mark.parametrize("seed", SEEDS)
def test_what_is_told_is_solved_as_it_is_printed_and_a_little_nearer_to_what_was_given_is_not(case, seed):
    make, key = CASES[case]
    block = make(np.random.default_rng([seed, *map(ord, case)]))
    path, printed = told(block)
    assert path[0] == key.partition("[")[0]
    solved(put(block, path, printed))
    refused(put(block, path, nearer(block, path, printed)))


def pairs(*rows, **more):
    return {"task": "four-bar-by-angles", "pairs": [list(row) for row in rows], "l4": 100, **more}


def guided(*positions, **more):
    return {"task": "coupler-positions", "positions": [list(place) for place in positions], **more}


@pytest.mark.parametrize(
    ("block", "path"),
    [
        (pairs((30, 60), (80, 90), (70, 100)), ("pairs", 2, 0)),
        (pairs((5, 10), (200, 30), (400, 60)), ("pairs", 2, 0)),
        (pairs((0, 0), (40, 30), (80, 120), (120, 100)), ("pairs", 3, 1)),
        (pairs((30, 60), (60, 60), (90, 150), (150, 80)), ("pairs", 3, 1)),
        (guided((0, 0, 0), (60, 40, 75), B=[0, 0], AB=70, C=[50, 0], DC=150, DC_side="right"), ("positions", 1, 2)),
        (guided((0, 0, 0), (50, 20, 10), (100, 10, 30), A=[0, 60], D=[0, 60]), ("D", 1)),
        (
            guided((0, 0, 0), (60, 40, 15), (110, 100, 35), (130, 170, 60), AB_turn=15, DC_turn=5, defects="keep"),
            ("AB_turn",),
        ),
    ],
)
def test_of_angles_and_places_one_is_told_that_is_solved(block, path):
    where, printed = told(block)
    assert where == path
    solved(put(block, path, printed))


@pytest.mark.parametrize(
    "block",
    [
        slider(e=lambda r: 0, k=lambda r: 4),
        slider(ratio=lambda r: 0.5, k=lambda r: 3.5),
        rocker(k=lambda r: 5, psi2=lambda r: 60, l1=lambda r: 3000),
        lambda r: pairs((200, 20), (150, 60), (700, 10), (30, 55)),
    ],
)
def test_where_no_value_of_the_number_helps_that_is_said(block):
    assert (
        refused(block(np.random.default_rng(0))).allowed == "other input data; changing this value alone does not help"
    )


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


@pytest.mark.parametrize(
    "case",
    [
        "k too large for the swing",
        "k too large for the swing, clockwise",
        "sense, k too large",
        "frame too long",
        "frame too short",
        "crank too long",
        "coupler too long",
        "coupler too short",
    ],
)
def test_at_a_printed_limit_the_four_bar_still_moves_as_it_was_asked(case):
    make, key = CASES[case]
    for seed in range(3):
        block = make(np.random.default_rng([seed, *map(ord, case)]))
        block[key] = told(block)[1]
        keys = ", ".join(f"{name}: {flow(value)}" for name, value in block.items())
        linkage = ROCKER.format(l3=block["l3"], psi2=float(block["psi2"]))
        found = build_synthesised(read_text(f"tmm: 1\nsynthesis: {{{keys}}}\n{linkage}", "x.yaml"))
        assert all(m.met for m in measure_demands(found.synthesis.outcome, solve(found, "kinematics")))


def test_limits_are_rounded_to_their_side():
    units = UnitSystem({"length": "mm"})
    for number, side, told in (
        (0.1234567654, -1, 123.456),
        (0.1234561196, 1, 123.457),
        (0.25, 1, 250),
        (0.1234567654, 0, 123.4567654),
    ):
        assert round_to_side(units, number, LENGTH, side) == pytest.approx(told, rel=1e-15)
    assert round_to_side(units, 3.0, NUMBER, -1) == 3 and round_to_side(units, 0.0, NUMBER, 1) == 0


def test_what_is_no_number_is_never_an_answer():
    good = NamedValue("l1", 0.1, "length", "word.value")
    assert refuse_nonfinite(SynthesisOutcome((), (good,), "word.value")).found == (good,)
    for bad in (np.nan, np.inf, np.longdouble("nan")):
        with pytest.raises(Infeasible):
            refuse_nonfinite(SynthesisOutcome((), (good, NamedValue("l2", bad, "length", "word.value")), "word.value"))


def test_near_the_largest_k_the_four_bar_is_still_found_and_beyond_it_the_reason_is_told():
    block = {"task": "four-bar-by-k", "l3": 250, "psi1": 60, "psi2": 110, "support": [400, 0]}
    assert solved(block | {"k": 4.5287}).parameters["l1"].value > 0
    error = refused(block | {"k": 4.53846})
    assert error.path == ("synthesis", "k") and "k is too large" in error.message
