"""Slotted levers and crank shapers by k and their extreme positions: what was asked comes back, the rest is refused."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from test_synthesis_crank_slider import MET

from tmm_cli import solve
from tmm_cli.batch import prepare_batch
from tmm_cli.mechanics.linkage import FRAME, Sketch
from tmm_cli.mechanics.numerics import find_roots
from tmm_cli.problem import ProblemError, read_text
from tmm_cli.synthesis import build_synthesised, k_of, measure_demands, shaper, slotted_lever

LEVER = """
points: {O: [xO, yO], C: [xC, yC]}
links:
  1: {points: [O, A], length: OA}
  2: {points: [A], slides: {on: 3, along: CB}}
  3: {points: [C, B], length: CB}
driver: {link: 1, speed: 2 rad/s, turns: SENSE}
sketch: {at: phi, B: [xC + CB*cos(phi), yC + CB*sin(phi)]}
output: 3
"""
SHAPER = """
points: {O: [0, 0], C: [0, -OC]}
guides: {x: {through: [0, y], angle: 0}}
links:
  1: {points: [O, A], length: OA}
  2: {points: [A], slides: {on: 3, along: CD}}
  3: {points: [C, D], length: CD}
  4: {points: [D, E], length: DE}
  5: {points: [E], slides: {on: x}}
driver: {link: 1, speed: 2 rad/s}
sketch: {at: 90 deg, D: [0, CD - OC], E: [DE, y]}
output: 5
"""
SIZE = 1000


def lever(keys, sense="ccw"):
    text = f"tmm: 1\nsynthesis: {{task: slotted-lever, {keys}}}\n{LEVER.replace('SENSE', sense)}"
    return build_synthesised(read_text(text, "x.yaml"))


def shaping(keys):
    return build_synthesised(read_text(f"tmm: 1\nsynthesis: {{task: shaper, {keys}}}\n{SHAPER}", "x.yaml"))


def random(seed, rows):
    return np.random.default_rng(seed).random((rows, SIZE))


def ends_of(motion, value, speed):
    """Driver's places (SIZE,) where a quantity is largest and least: there its speed vanishes."""
    scan = np.tile(np.linspace(0, 2 * np.pi, 361)[:-1], (SIZE, 1))
    here = value(motion(scan))
    for pick in (np.argmax, np.argmin):
        q = np.take_along_axis(scan, pick(here, axis=1)[:, None], axis=1)
        yield find_roots(lambda x: speed(motion(x)), q - scan[0, 1], q + scan[0, 1])


def lever_comes_back(found, k, side):
    """Swing, k, both places of B, and the sense of the crank, on the motion of many slotted levers."""
    first = lever("CB: 300, swing: 40 deg, OC: 100").linkage
    variants = []
    for crank, length, o, c in zip(found.crank, found.lever, found.o, found.c, strict=True):
        links = {
            FRAME: replace(first.links[FRAME], points={"O": complex(o), "C": complex(c)}),
            "1": replace(first.links["1"], points={"O": 0j, "A": complex(crank)}),
            "3": replace(first.links["3"], points={"C": 0j, "B": complex(length)}),
        }
        turn = o - c
        sketch = Sketch(float(np.angle(turn)), {"B": complex(c + length * turn / abs(turn))})
        variants.append(replace(first, links=first.links | links, sketch=sketch))
    motion = prepare_batch(variants, forces=False, own_places=True)
    c, axis = found.c[:, None], np.conj(found.o - found.c)[:, None]

    def angle(m):
        return np.angle((m["B.x"] - c) * axis)

    left, right = ends_of(motion, angle, lambda m: m["3.omega"])
    places = [motion(q)["B.x"][:, 0] for q in (left, right)]
    for place, psi in zip(places[:: -1 if side > 0 else 1], (found.psi1, found.psi2), strict=True):
        wanted = found.c + found.lever * np.exp(1j * psi)
        assert np.max(np.abs(place - wanted) / (found.lever + np.abs(found.c))) < MET
    swing = np.angle((places[0] - found.c) / (places[1] - found.c))
    assert swing == pytest.approx(found.theta, rel=MET, abs=0)
    way = np.mod(right - left, 2 * np.pi)[:, 0]  # counterclockwise, from the left end to the right one
    slow = np.maximum(way, 2 * np.pi - way)
    assert slow / (2 * np.pi - slow) == pytest.approx(k, rel=MET, abs=0)
    assert np.all(way < np.pi)  # the slow stroke is that in which crank and lever turn alike
    return places


@pytest.mark.parametrize("side", [1, -1])
def test_k_and_two_places_of_the_end_come_back(side):
    a = random(1, 7)
    k = k_of(0.05 + 2.5 * a[0])
    b1, b2 = a[1] - 0.5 + 1j * a[2], a[3] + 1 + 1j * a[4]
    task = slotted_lever.SlottedLeverTask(b1=b1, b2=b2, k=k, side=side, OC=1.0)
    longest = slotted_lever.find_slotted_lever(task).longest
    found = slotted_lever.find_slotted_lever(replace(task, OC=longest * (0.05 + 0.94 * a[5])))
    places = lever_comes_back(found, k, side)
    for place, wanted in zip(places[:: -1 if side > 0 else 1], (b1, b2), strict=True):
        assert np.max(np.abs(place - wanted) / (found.lever + np.abs(found.c))) < MET


def test_swing_and_length_come_back_with_the_frame_within_bounds():
    a = random(2, 6)
    swing, length = 0.05 + 2.5 * a[0], 0.02 * 100 ** a[1]
    within = (length * 0.1, length * (0.2 + a[2]))
    task = slotted_lever.SlottedLeverTask(
        CB=length, c=a[3] - 0.5 + 1j * a[4], axis=7 * a[5] - 3.5, swing=swing, within=within
    )
    found = slotted_lever.find_slotted_lever(task)
    assert np.all((found.frame >= within[0]) & (found.frame <= within[1]))
    assert np.all(found.frame + found.crank <= length * (1 + 1e-15))
    longer = np.minimum(within[1], found.frame * (1 + 1e-9))
    assert np.all((longer == found.frame) | (longer * (1 + np.sin(swing / 2)) > length))  # none longer would do
    lever_comes_back(found, k_of(swing), -1)
    assert np.all(slotted_lever.find_slotted_lever(replace(task, choose="shortest")).frame == within[0])


def test_stroke_k_and_pressure_angle_of_the_shaper_come_back():
    a = random(3, 4)
    theta, stroke = 0.2 + 1.9 * a[0], 0.01 * 200 ** a[3]
    most, steepest = 1 / (1 + np.sin(theta / 2)), np.pi / 2 - theta / 2
    task = shaper.ShaperTask(
        stroke=stroke, k=k_of(theta), frame_ratio=most * (0.05 + 0.9 * a[1]), pressure=steepest * (0.02 + 0.83 * a[2])
    )
    found = shaper.find_shaper(task)
    first = shaping("stroke: 200, k: 1.4, frame_ratio: 0.5, rod_ratio: 0.4").linkage
    variants = []
    columns = (found.crank, found.frame, found.lever, found.rod, found.level)
    for crank, frame, length, rod, level in zip(*columns, strict=True):
        links = {
            FRAME: replace(first.links[FRAME], points={"O": 0j, "C": complex(0, -frame)}),
            "1": replace(first.links["1"], points={"O": 0j, "A": complex(crank)}),
            "3": replace(first.links["3"], points={"C": 0j, "D": complex(length)}),
            "4": replace(first.links["4"], points={"D": 0j, "E": complex(rod)}),
        }
        slides = tuple(replace(s, through=complex(0, level)) if s.carrier == FRAME else s for s in first.slides)
        sketch = Sketch(math.pi / 2, {"D": complex(0, length - frame), "E": complex(rod, level)})
        variants.append(replace(first, links=first.links | links, slides=slides, sketch=sketch))
    motion = prepare_batch(variants, forces=False, own_places=True)
    far, near = ends_of(motion, lambda m: m["E.x"].real, lambda m: m["E.v"].real)
    run = motion(far)["E.x"].real - motion(near)["E.x"].real
    assert run[:, 0] == pytest.approx(stroke, rel=MET, abs=0)
    way = np.mod(near - far, 2 * np.pi)[:, 0]
    slow = np.maximum(way, 2 * np.pi - way)
    assert slow / (2 * np.pi - slow) == pytest.approx(task.k, rel=MET, abs=0)
    turned = np.linspace(0, 2 * np.pi, 361)
    for q in (far, near, np.full((SIZE, 1), np.pi / 2)):  # the rod is as steep at the ends as in the middle
        rod = motion(q)["E.x"] - motion(q)["D.x"]
        assert np.abs(np.angle(rod))[:, 0] == pytest.approx(task.pressure, rel=MET, abs=0)
    m = motion(np.tile(turned, (SIZE, 1)))
    steep = np.max(np.abs(np.angle(m["E.x"] - m["D.x"])), axis=1)
    assert np.all(steep <= task.pressure * (1 + 1e-9))


def test_no_other_level_of_the_guide_has_a_smaller_pressure_angle():
    f = shaper.find_shaper(shaper.ShaperTask(stroke=0.4, k=1.5, frame_ratio=0.5, rod_ratio=0.3))
    heights = f.lever * np.cos(np.linspace(-1, 1, 2001) * f.theta / 2) - f.frame
    levels = f.level + np.linspace(-0.1, 0.1, 401) * f.lever
    largest = np.max(np.abs(np.arcsin((heights[:, None] - levels) / f.rod)), axis=0)
    assert float(np.min(largest)) == pytest.approx(float(f.pressure), rel=1e-6)
    assert float(levels[np.argmin(largest)]) == pytest.approx(float(f.level), abs=1e-3 * f.lever)


def test_the_shaper_of_the_bank_comes_out_of_its_own_stroke_and_k():
    # OA = 110, OC = 350, CD = 650 mm: sin(theta/2) = OA/OC, H = 2 CD OA/OC
    theta = 2 * math.asin(110 / 350)
    f = shaper.find_shaper(shaper.ShaperTask(stroke=1.3 * 110 / 350, k=float(k_of(theta)), OC=0.35, DE=0.21))
    assert (f.crank, f.lever) == (pytest.approx(0.11, rel=1e-14), pytest.approx(0.65, rel=1e-14))


@pytest.mark.parametrize(
    "keys",
    [
        "B1: [-150, 400], B2: [250, 450], k: 1.6, OC: 300",
        "B1: [-150, 400], B2: [250, 450], k: 1.6, C: left, OC: 300",
        "CB: 500, k: 1.4, within: [100, 300]",
        "CB: 500, swing: 60 deg, support: [20, -300], axis: 120 deg, OC: 200",
        "CB: 500, k: 1.4, within: [100, 300], choose: shortest",
        "B1: [-150, 400], B2: [250, 450], k: 1.6, OA: 60",
    ],
)
@pytest.mark.parametrize("sense", ["cw", "ccw"])
def test_the_ordinary_stages_measure_what_was_asked_of_a_lever(keys, sense):
    found = lever(keys, sense)
    results = solve(found, "kinematics")
    for m in measure_demands(found.synthesis.outcome, results):
        assert m.difference <= MET, m
    asks_left = "left" in keys
    (slow,) = results.strokes.working
    ends = {v.demand.text: v.value for v in measure_demands(found.synthesis.outcome, results)}
    run = math.remainder(
        ends["angle of the lever in position CB2"] - ends["angle of the lever in position CB1"], math.tau
    )
    told = (sense == "ccw") == asks_left  # the crank turns as told for a slow stroke from B1 to B2
    assert slow.run == pytest.approx(run if told else -run, rel=1e-12)


@pytest.mark.parametrize(
    "keys",
    [
        "stroke: 400, k: 1.5, OC: 350, DE: 200",
        "stroke: 400, k: 1.8, frame_ratio: 0.6, rod_ratio: 0.3",
        "stroke: 90, k: 1.3, frame_ratio: 0.6, pressure: 4 deg",
        "stroke: 400, k: 1.5, OA: 100, DE: 200",
    ],
)
def test_the_ordinary_stages_measure_what_was_asked_of_a_shaper(keys):
    found = shaping(keys)
    for m in measure_demands(found.synthesis.outcome, solve(found, "kinematics")):
        assert m.difference <= MET, m


def test_a_stone_that_passes_the_end_is_told():
    outcome = lever("CB: 300, k: 1.5, OC: 280").synthesis.outcome
    assert outcome.notes == ("the sliding block passes beyond the lever's end B: the slot must extend beyond B",)
    assert lever("CB: 300, k: 1.5, OC: 180").synthesis.outcome.notes == ()


REFUSED_LEVERS = {
    "CB: 500, k: 1e11, OC: 200": (
        ".k: with a fully rotating crank the swing angle of the lever must be less than 180 deg\n  found:   1e11"
    ),
    "CB: 500, k: 1, OC: 200": (
        ".k: k must be greater than 1: a swinging lever returns faster, and k is the duration of the slow "
        "stroke divided by that of the fast one\n"
        "  found:   1"
    ),
    "CB: 500, k: 0.8, OC: 200": (
        ".k: k must be greater than 1: a swinging lever returns faster, and k is the duration of the slow "
        "stroke divided by that of the fast one\n"
        "  found:   0.8"
    ),
    "CB: 500, swing: 190 deg, OC: 200": (
        ".swing: with a fully rotating crank the swing angle of the lever must be less than 180 deg\n"
        "  found:   '190 deg'"
    ),
    "CB: 500, k: 1.3, OC: -2": (".OC: this value is too small for a mechanism\n  found:   -2"),
    "CB: 500, k: 1.3, OA: -2": (".OA: this value is too small for a mechanism\n  found:   -2"),
    "CB: 500, k: 1.3, OC: 200, OA: 20": (
        ": these keys do not determine a mechanism; remove: OA or OC\n  found:   OC, OA\n"
        "  allowed: OC; or OA; or within"
    ),
    "B1: [1, 2], B2: [1, 2], k: 1.3, OC: 20": (".B2: B1 and B2 are the same point\n  found:   [1, 2]"),
    "CB: 500, k: 1.5, within: [450, 600]": (
        ".within[0]: for every OC within these limits the sliding block passes beyond the lever's end B. "
        "Reduce the lower limit\n"
        "  found:   450"
    ),
    "CB: 500, k: 1.5, within: [300, 200]": (
        ".within: expected two positive limits of OC, the smaller one first\n"
        "  found:   [300, 200]\n"
        "  allowed: nearest feasible value: within[1]: 300.0"
    ),
    "CB: 500, B1: [1, 2], k: 1.5, OC: 200": (
        ": these keys do not determine a mechanism; remove: B1\n  found:   B1, CB\n  allowed: B1 and B2; or CB"
    ),
    "CB: 500, k: 1.5, swing: 30, OC: 200": (
        ": these keys do not determine a mechanism; remove: swing or k\n  found:   k, swing\n  allowed: k; or swing"
    ),
    "CB: 500, k: 1.5, C: left, OC: 200": (
        ".C: C may only be given together with B1 and B2\n  found:   C without B1 and "
        "B2\n  allowed: add B1 and B2, or remove C"
    ),
    "CB: 500, k: 1.5, OC: 200, choose: shortest": (
        ".choose: choose may only be given together with within\n  found:   choose without "
        "within\n  allowed: add within, or remove choose"
    ),
}
REFUSED_SHAPERS = {
    "stroke: 400, k: 1, OC: 350, DE: 200": (
        ".k: k must be greater than 1: a swinging lever returns faster, and k is the duration of the slow "
        "stroke divided by that of the fast one\n"
        "  found:   1"
    ),
    "stroke: -400, k: 1.5, OC: 350, DE: 200": (".stroke: this value is too small for a mechanism\n  found:   -400"),
    "stroke: 400, k: 1.5, OC: 500, DE: 200": (
        ".OC: the sliding block would pass beyond the hinge D of the connecting rod\n  found:   500"
    ),
    "stroke: 400, k: 1.5, OA: 155, DE: 200": (
        ".OA: the sliding block would pass beyond the hinge D of the connecting rod\n  found:   155"
    ),
    "stroke: 400, k: 1.5, OA: 0, DE: 200": (".OA: this value is too small for a mechanism\n  found:   0"),
    "stroke: 400, k: 1.5, frame_ratio: 0.8, DE: 200": (
        ".frame_ratio: the sliding block would pass beyond the hinge D of the connecting rod\n  found:   0.8"
    ),
    "stroke: 400, k: 3, frame_ratio: 0.3, DE: 40": (
        ".DE: the ram would reverse before the lever: the connecting rod is too steep\n  found:   40"
    ),
    "stroke: 400, k: 3, frame_ratio: 0.3, rod_ratio: 0.1": (
        ".rod_ratio: the ram would reverse before the lever: the connecting rod is too steep\n  found:   0.1"
    ),
    "stroke: 400, k: 3, frame_ratio: 0.3, pressure: 100 deg": (
        ".pressure: the largest pressure angle must be less than 90 deg\n  found:   '100 deg'"
    ),
    "stroke: 400, k: 3, frame_ratio: 0.3": (
        ": these keys do not determine a mechanism\n"
        "  found:   none of these keys\n"
        "  allowed: DE; or rod_ratio; or pressure"
    ),
}


def refusal(make, keys):
    with pytest.raises(ProblemError) as caught:
        make(keys)
    return str(caught.value).partition(": synthesis")[2]


@pytest.mark.parametrize("keys", REFUSED_LEVERS)
def test_a_lever_that_cannot_be_is_refused_with_the_reason_and_what_could(keys):
    assert refusal(lever, keys).startswith(REFUSED_LEVERS[keys])


@pytest.mark.parametrize("keys", REFUSED_SHAPERS)
def test_a_shaper_that_cannot_be_is_refused_with_the_reason_and_what_could(keys):
    assert refusal(shaping, keys).startswith(REFUSED_SHAPERS[keys])


def test_a_hinge_straight_above_the_other_has_just_its_coordinate():
    for axis, place in (("90 deg", (0, 250)), ("180 deg", (-250, 0)), ("-90 deg", (0, -250))):
        found = lever(f"CB: 500, k: 1.8, OC: 250, axis: {axis}").synthesis.outcome.parameters
        assert (found["xO"].value == 0) == (place[0] == 0) and (found["yO"].value == 0) == (place[1] == 0)
        assert 1000 * complex(found["xO"].value, found["yO"].value) == pytest.approx(complex(*place), rel=1e-15)
