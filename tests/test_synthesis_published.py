"""Syntheses with answers that the literature prints, to the digits that it prints.

R. S. Khurmi, J. K. Gupta, Theory of Machines, 14th ed., Eurasia 2009: examples 5.1 to 5.3, pp. 110-112.
B. K. Sarkar, Theory of Machines, Tata McGraw-Hill 2002: illustrations 1 and 2, pp. 15-16. Both as printed by the public
textbook companions of FOSSEE (Python-Textbook-Companions, Theory_Of_Machines/ch5.ipynb; Scilab-TBC-Uploads).
A. P. Morgan, C. W. Wampler: Solving a planar four-bar design problem using continuation, J. Mech. Design 112 (1990),
pp. 544-550, problem 7: solutions 1, 11 and 12, as printed by the documentation of PHCpack (phcpy, a 4-bar mechanism).
P. L. Chebyshev's straight-line linkage: proportions and input angles, as printed by Wikipedia, Chebyshev linkage.
Course Webkinematik, October 2020, exercise 2.5, as printed in the repository gislain1993/Webkinematik, Uebungen.md; two
more crank-rockers, of S. Goessner, are in test_synthesis_four_bar_by_k.py.
A course of machine design, exercise 2-8, as printed by howoman.com/ptwg71tf/482.html.
Optimal synthesis of four-bar mechanisms using evolutionary centers algorithm: bestEver(1), six points of a line, as
printed in the repository jmejia8/eca-four-bar-mechanisms, tools.jl.
"""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from test_synthesis_coupler_positions import problem as guided
from test_synthesis_four_bar_by_angles import problem as by_angles
from test_synthesis_four_bar_by_k import problem as by_k
from test_synthesis_slotted_lever import lever, shaping

from tmm_cli import solve
from tmm_cli.batch import prepare_batch
from tmm_cli.problem import read_text
from tmm_cli.synthesis import build_synthesised, measure_demands


def found(problem):
    return {name: float(value.value) for name, value in problem.synthesis.outcome.parameters.items()}


def prints(value, text):
    """Whether a value rounds to what is printed."""
    return f"{value:.{len(text.partition('.')[2])}f}" == text


SHAPERS = {
    "Khurmi 5.2": ("stroke: 450, k: 2, OC: 240, DE: 300", {"OA": "120", "CD": "450"}),
    "Khurmi 5.3": ("stroke: 120, k: 1.7, OA: 30, DE: 100", {"OC": "75.7", "CD": "151.48"}),
    "Khurmi 5.3, from OC": ("stroke: 120, k: 1.7, OC: 75.742319, DE: 100", {"OA": "30", "CD": "151.48"}),
}


@pytest.mark.parametrize("name", SHAPERS)
def test_crank_shapers_of_khurmi_and_gupta(name):
    keys, printed = SHAPERS[name]
    problem = shaping(keys)
    lengths = found(problem)
    assert all(prints(lengths[key] * 1000, text) for key, text in printed.items()), lengths
    for m in measure_demands(problem.synthesis.outcome, solve(problem, "kinematics")):
        assert m.difference <= 1e-12, m


LEVERS = {
    "Khurmi 5.1": ("swing: 2*asin(120/300), OC: 300, CB: 500", "120", "1.7"),
    "Sarkar 1": ("swing: 2*30 deg, OC: 200, CB: 400", "100", "2"),
    "Sarkar 2": ("k: 2, OC: 300, CB: 500", "150", "2.0"),
    "course 2-8": ("k: 1.4, OC: 100, CB: 200", "26", "1.4"),
}


@pytest.mark.parametrize("name", LEVERS)
def test_slotted_levers_of_textbooks(name):
    keys, crank, k = LEVERS[name]
    problem = lever(keys)
    assert prints(found(problem)["OA"] * 1000, crank)
    assert prints(solve(problem, "kinematics").strokes.k, k)


def test_the_crank_rocker_of_webkinematik():
    # a = 100, c = 220, swing 60 deg (printed as 600), k = 8/7 give alpha = 12.00 deg, b = 449.66, d = 408.88, inner
    # transmission angle 38.34 deg; the rocker of `by_k` is 200 long, so lengths are to be taken 1.1 times
    problem = by_k(", l1: 100/1.1", "60 deg", "120 deg", "8/7")
    lengths = {name: 1100 * value for name, value in found(problem).items()}
    assert prints(lengths["l1"], "100") and prints(lengths["l2"], "449.66") and prints(lengths["l4"], "408.88")
    shown = {v.text: v.value for v in problem.synthesis.outcome.found}
    assert prints(math.degrees(shown["angle theta = C1AC2"]), "12.00")
    assert prints(90 - math.degrees(shown["largest pressure angle"]), "38.34")


POINTS = (0.50 + 1.06j, -0.83 - 0.27j, -0.34 + 0.22j, -0.13 + 0.43j, 0.22 + 0.78j)
# pins of both links in the plane of the coupler, and how far that has turned at points 1 to 4; links turn about 0 and 1
SOLUTIONS = {
    1: (
        -0.0877960434509403 - 0.85138690751564j,
        0.235837391307301 - 1.41899202703639j,
        (0.0, 1.4473421375642717, 0.9284137081314461, 0.75169921110931, 0.3871162822082786),
    ),
    11: (
        -0.0801573081756841 - 0.855275240173407j,
        -0.297321862562434 - 2.18414388671793j,
        (0.0, 2.524711332238134, 0.9038272905536054, 0.7498546795650226, 0.38277375732994035),
    ),
    12: (
        0.676178657404253 - 0.613650952963839j,
        0.356055523659319 + 0.310794500797803j,
        (0.0, 5.771983513802544, 3.9629563185486125, 3.442223836627024, 0.5242754656511442),
    ),
}


def poses(solution, which):
    turned = SOLUTIONS[solution][2]
    return "[" + ", ".join(f"[{POINTS[n].real} m, {POINTS[n].imag} m, {turned[n]!r} rad]" for n in which) + "]"


def turns(solution, which):
    """Angles of both links at these points."""
    first, second, turned = SOLUTIONS[solution]
    arms = [
        [POINTS[n] + pin * cmath.exp(1j * turned[n]) - pivot for n in which] for pin, pivot in ((first, 0), (second, 1))
    ]
    return [[cmath.phase(x) for x in arm] for arm in arms]


def pins(values, angle):
    """Pins in the plane of the coupler, from the places of B and C at the first position."""
    b = values["Ax"] + 1j * values["Ay"] + values["l1"] * cmath.exp(1j * values["phi1"])
    bar = values["Cx"] + 1j * values["Cy"] - b
    point = b + (values["Px"] + 1j * values["Py"]) * bar / abs(bar)
    return [(x - point) * cmath.exp(-1j * angle) for x in (b, b + bar)]


@pytest.mark.parametrize("solution", SOLUTIONS)
@pytest.mark.parametrize("which", [(1, 2, 4), (2, 3, 4), (1, 3, 0), (3, 4, 0)])
def test_morgan_and_wampler_three_positions_give_the_printed_pins(solution, which):
    problem = guided(f"positions: {poses(solution, which)}, A: [0, 0], D: [1 m, 0], defects: keep")
    *printed, turned = SOLUTIONS[solution]
    for pin, wanted in zip(pins(found(problem), turned[which[0]]), printed, strict=True):
        assert abs(pin - wanted) < 3e-12  # the digits are printed to 1e-15; near positions lose three of them


def test_morgan_and_wampler_four_positions_on_burmesters_curves_give_the_pivots():
    which = (1, 2, 3, 0)
    ways = [x[1] - x[0] for x in turns(1, which)]
    tried = []
    for first in (1, 2):
        for second in (1, 2):
            problem = guided(
                f"positions: {poses(1, which)}, AB_turn: {ways[0]!r} rad, DC_turn: {ways[1]!r} rad, "
                f"AB_branch: {first}, DC_branch: {second}, defects: keep"
            )
            values = found(problem)
            tried.append(max(abs(values["Ax"] + 1j * values["Ay"]), abs(values["Dx"] - 1 + 1j * values["Dy"])))
    assert min(tried) < 1e-10


def test_morgan_and_wampler_five_pairs_of_angles_give_the_printed_four_bar():
    which = (1, 2, 3, 4, 0)
    pairs = [[float(x - arm[0]) for x in arm] for arm in map(np.unwrap, turns(1, which))]
    text = ", ".join(f"[{a!r} rad, {b!r} rad]" for a, b in zip(*pairs, strict=True))
    # two four-bars pass these pairs; a third root of the cubic has an input and an output of no length
    ways = [found(by_angles(f"pairs: [{text}], l4: 1 m, choose: {number}, defects: keep")) for number in (1, 2)]
    first, second, _ = SOLUTIONS[1]
    values = min(ways, key=lambda way: abs(way["l1"] - abs(POINTS[0] + first)))
    wanted = abs(POINTS[0] + first), abs(second - first), abs(POINTS[0] + second - 1)
    assert [values[name] for name in ("l1", "l2", "l3")] == pytest.approx(wanted, rel=1e-9)
    assert [values["phi1"], values["psi1"]] == pytest.approx([x[0] for x in turns(1, which)], rel=1e-9)


def test_morgan_and_wampler_all_five_points_are_passed_by_the_linkage_of_three():
    problem = guided(f"positions: {poses(1, (1, 2, 3))}, A: [0, 0], D: [1 m, 0]")
    places = prepare_batch(problem.linkage, forces=False)(np.array(turns(1, range(5))[0]))["P.x"]
    assert np.max(np.abs(places - POINTS)) < 1e-12


def test_chebyshevs_linkage_from_three_positions_on_its_line():
    # at the ends of the line the coupler is upright, in its middle level: L1 : L2 : L3 = 4 : 5 : 2, L4 = L2, least and
    # largest angle of a link arccos(4/5) = 36.8699 deg, arccos(-1/5) = 101.537 deg; an end is a dead position
    positions = "[0, 4 m, 270 deg], [2 m, 4 m, 180 deg], [4 m, 4 m, 90 deg]"
    problem = guided(f"positions: [{positions}], B: [-1 m, 0], C: [1 m, 0], defects: keep")
    values = found(problem)
    assert [values[name] for name in ("l4", "l1", "l2", "l3")] == pytest.approx([4, 5, 2, 5], rel=1e-14)
    limits = sorted(math.degrees(limit.place) for limit in solve(problem, "kinematics").driver_range.limits)
    assert prints(limits[0], "36.8699") and prints(limits[1], "101.537")


def test_chebyshevs_linkage_from_three_pairs_of_angles():
    pairs = "[acos(4/5), 90 deg], [acos(3/5), acos(-3/5)], [90 deg, acos(-4/5)]"
    values = found(by_angles(f"pairs: [{pairs}], l4: 4 m, defects: keep"))
    assert [values[name] for name in ("l4", "l1", "l2", "l3")] == pytest.approx([4, 5, 2, 5], rel=1e-14)


@pytest.mark.parametrize("held", ["l1", "l3"])
def test_chebyshevs_linkage_from_three_pairs_of_angles_and_one_of_its_levers(held):
    pairs = "[acos(4/5), 90 deg], [acos(3/5), acos(-3/5)], [90 deg, acos(-4/5)]"
    values = found(by_angles(f"pairs: [{pairs}], l4: 4 m, {held}: 5 m, defects: keep"))
    assert [values[name] for name in ("l4", "l1", "l2", "l3")] == pytest.approx([4, 5, 2, 5], rel=1e-14)
    assert [values["phi0"], values["psi0"]] == pytest.approx([0, 0], abs=1e-14)


BEST = {
    "r1": 39.35432733966176,
    "r2": 8.738597335076454,
    "r3": 27.91020567579063,
    "r4": 38.41653206619049,
    "xK": 36.576759454887835,
    "yK": 18.058222622003274,
    "t0": 3.922197401424182,
    "x0": -9.015069651004032,
    "y0": 59.8594568458345,
}
CRANK = (
    1.6275724377055465,
    2.42129538238649,
    2.93021895068062,
    3.4158306289051543,
    3.9401612344766854,
    5.428565504554411,
)
LINE = """
tmm: 1
units: {length: mm, angle: rad}
parameters: {PARAMETERS}
SYNTHESIS
points: {A: [x0, y0], D: [x0 + r1*cos(t0), y0 + r1*sin(t0)]}
links:
  1: {points: [A, B], length: r2}
  2: {points: {B: [0, 0], C: [r3, 0], K: [xK, yK]}}
  3: {points: [D, C], length: r4}
driver: {link: 1, speed: 1}
sketch: {at: t0, C: [x0 + r1*cos(t0) - r4*sin(t0), y0 + r1*sin(t0) + r4*cos(t0)]}
output: 3
"""


def line(vary=(), synthesis=""):
    fixed = ", ".join(f"{name}: {value!r}" for name, value in BEST.items() if name not in vary)
    return build_synthesised(read_text(LINE.replace("PARAMETERS", fixed).replace("SYNTHESIS", synthesis), "x.yaml"))


def test_the_best_four_bar_of_eca_passes_the_six_points():
    places = prepare_batch(line().linkage, forces=False)(np.array(CRANK) + BEST["t0"])["K.x"]
    assert np.max(np.abs(places * 1000 - (20 + 1j * np.arange(20, 50, 5)))) < 1e-10


def test_optimal_synthesis_finds_the_lengths_of_the_best_four_bar_of_eca():
    vary = ("r2", "r3", "r4", "xK", "yK")
    bounds = ", ".join(f"{name}: [{0.9 * BEST[name]}, {1.1 * BEST[name]}]" for name in vary)
    through = ", ".join(f"[20, {y}]" for y in range(20, 50, 5))
    problem = line(
        vary,
        (
            f"synthesis: {{task: optimal, vary: {{{bounds}}}, "
            f"objective: {{of: path, point: K, norm: least squares, through: [{through}]}}}}"
        ),
    )
    values = found(problem)
    assert [values[name] * 1000 for name in vary] == pytest.approx([BEST[name] for name in vary], rel=3e-7)
    best = problem.synthesis.outcome.listings[0].rows[0][4]
    assert best < 1e-10
