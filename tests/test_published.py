"""Published problems with printed answers.

Joints, samples and values are those of the public test data of PMKS (slider_crank_tracer, teaching_four_bar,
stephenson_iii_example_2: kinematics and Newton-Euler forces with and without gravity), of gabemorris12/mechanism,
tests/mechanism/non-grashof_test.py (an 8-link of three kernels, checked homework), of the Jansen leg (PMKS-Web,
library-fixtures), and of coleas33/linkage_sim (fourbar_statics).
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from models import SI, published, published_problem, results_of

PMKS = ("slider_crank_tracer", "teaching_four_bar", "stephenson_iii_example_2")


def by_sense(case):
    for sense in (1, -1):
        samples = [s for s in case["samples"] if s["sense"] == sense]
        if samples:
            yield samples


@pytest.mark.parametrize("name", PMKS)
def test_pmks_points_and_links_move_as_printed(name):
    case = published(name)
    for samples in by_sense(case):
        results = results_of(published_problem(case, samples), "kinematics")
        for point in samples[0]["points"]:
            printed = np.array([s["points"][point] for s in samples])
            found = results.motion.named(point)
            for k, values in enumerate((found.x, found.v, found.a)):
                expected = printed[:, 2 * k] + 1j * printed[:, 2 * k + 1]
                assert np.max(np.abs(values - expected)) < 1e-12 * np.max(np.abs(expected)), (point, k)
        for link in samples[0]["links"]:
            printed = np.array([s["links"][link] for s in samples])
            found = results.motion.link(link)
            scale = np.max(np.abs(printed), axis=0) + 1e-300
            assert np.max(np.abs(found.omega - printed[:, 0])) < 1e-12 * scale[0], link
            if scale[1] > 1e-290:
                assert np.max(np.abs(found.epsilon - printed[:, 1])) < 1e-12 * scale[1], link


@pytest.mark.parametrize("gravity, key", [(0.0, "newton_no_gravity"), (9.81, "newton_gravity")])
def test_stephenson_iii_torque_and_joint_forces_are_the_printed_ones(gravity, key):
    case = published("stephenson_iii_example_2")
    largest_torque = max(abs(s[key]["torque"]) for s in case["samples"])
    largest_force = max(math.hypot(*f) for s in case["samples"] for f in s[key]["reactions"].values())
    for samples in by_sense(case):
        results = results_of(published_problem(case, samples, gravity))
        torque = np.array([s[key]["torque"] for s in samples])
        assert np.max(np.abs(results.reactions.balance.moment - torque)) < 1e-12 * largest_torque
        for joint in samples[0][key]["reactions"]:
            printed = np.array([complex(*s[key]["reactions"][joint]) for s in samples])
            found = results.reactions.of(joint)
            on = min((found.on, found.by), key=lambda link: np.max(np.abs(found.onto(link) - printed)))
            assert np.max(np.abs(found.onto(on) - printed)) < 1e-12 * largest_force, joint


def test_homework_eight_link_of_three_dyads():
    sin, cos, deg = math.sin, math.cos, math.pi / 180
    o2, o4, o6, g, crank, tilt = 12.5 + 0j, 0j, 12.5 + 10.5j, 12.5 + 11.7j, 52.92024014972946 * deg, 150 * deg
    o2a, ba, ce, _, df, k = (
        2.1799804307105649,
        0.25342828166292991,
        1.2982110114925343,
        2.6287023468511764,
        1.946962812654658,
        6.8670173910301826,
    )
    b = o4 + 2.5 * complex(cos(crank), sin(crank))
    a = b + 8.4 * complex(cos(ba), sin(ba))
    assert abs(a - (o2 + 5 * complex(cos(o2a), sin(o2a)))) < 1e-12  # the printed positions close
    c = b + 6.0 * complex(cos(ba), sin(ba))
    e = c + 8.9 * complex(cos(ce), sin(ce))
    d = e - 3 * complex(cos(ce), sin(ce))
    f = g + k * complex(cos(tilt), sin(tilt))
    assert abs(f - (d + 6.4 * complex(cos(df), sin(df)))) < 1e-12

    def xy(z):
        return [z.real, z.imag]

    problem = {
        "tmm": 1,
        "units": SI,
        "points": {"O2": xy(o2), "O4": xy(o4), "O6": xy(o6)},
        "guides": {"g": {"through": xy(g), "angle": tilt}},
        "links": {
            "1": {"points": ["O4", "B"], "length": 2.5},
            "2": {"points": {"B": [0, 0], "A": [8.4, 0], "C": [6, 0]}},
            "3": {"points": ["O2", "A"], "length": 5},
            "4": {"points": {"C": [0, 0], "E": [8.9, 0], "D": [5.9, 0]}},
            "5": {"points": ["O6", "E"], "length": 3.2},
            "6": {"points": ["D", "F"], "length": 6.4},
            "7": {"points": ["F"], "slides": {"on": "g"}},
        },
        "driver": {"link": "1", "speed": 30, "turns": "cw"},
        "sketch": {"at": crank, "A": xy(a), "C": xy(c), "E": xy(e), "F": xy(f)},
        "positions": {"at": [crank]},
    }
    results = results_of(problem, "kinematics")
    assert [group.type for group in results.structure.groups] == ["RRR", "RRR", "RRP"]
    motion = results.motion
    omega = [motion.link(n).omega[0] for n in "32456"]
    epsilon = [motion.link(n).epsilon[0] for n in "32456"]
    slide = motion.slide(results.linkage.slides[0])
    printed_omega = [
        -9.9395709690725889,
        9.0579555719578372,
        4.2381214248760856,
        -6.2932505326853357,
        4.6475757321967748,
    ]
    printed_epsilon = [
        559.97479285660867,
        -4.840364192043732,
        -83.804691566345929,
        803.06630000648725,
        -531.58923495020701,
    ]
    assert omega == pytest.approx(printed_omega, rel=1e-12)
    assert epsilon == pytest.approx(printed_epsilon, rel=1e-12)
    assert abs(slide.v[0]) == pytest.approx(6.39467, abs=5e-6)  # as asserted by the source
    assert abs(slide.a[0]) == pytest.approx(2121.04337, abs=5e-6)
    assert slide.v[0] == pytest.approx(6.3946730962873156, rel=1e-12)
    assert slide.a[0] == pytest.approx(-2121.0433712721321, rel=1e-12)


def jansen():
    """The Jansen leg with its holy numbers; every triangle as a link with coordinates from its three sides."""

    def triangle(base, left, right):
        """The apex of a triangle on a base of the given length, on its left side."""
        x = (base * base + left * left - right * right) / (2 * base)
        return [x, math.sqrt(left * left - x * x)]

    return {
        "tmm": 1,
        "units": SI,
        "points": {"O": [0, 0], "G": [-38, -7.8]},
        "links": {
            "1": {"points": ["O", "A"], "length": 15},
            "2": {"points": ["A", "B"], "length": 50},
            "3": {"points": {"G": [0, 0], "B": [41.5, 0], "C": triangle(41.5, 40.1, 55.8)}},
            "4": {"points": ["A", "D"], "length": 61.9},
            "5": {"points": ["G", "D"], "length": 39.3},
            "6": {"points": ["C", "E"], "length": 39.4},
            "7": {"points": {"D": [0, 0], "E": [36.7, 0], "F": triangle(36.7, 49, 65.7)}},
        },
        "driver": {"link": "1", "speed": 1},
        "sketch": {"at": 0, "B": [-24, 31], "C": [-75, 8], "D": [-27, -46], "E": [-59, -28], "F": [-43, -92]},
        "positions": {"at": [math.radians(t) for t in (0, 45, 90, 135, 180, 270)]},
    }


def test_jansen_leg_walks_through_the_printed_points():
    printed = published("jansen")
    results = results_of(jansen(), "kinematics")
    assert results.structure.formula == "I(0,1) -> II(2,3), I(0,1) -> II(4,5), II(2,3) + II(4,5) -> II(6,7)"
    for point in "BCDEF":
        expected = np.array([complex(*row[point]) for row in printed.values()])
        assert np.max(np.abs(results.motion.named(point).x - expected)) < 1e-12 * np.max(np.abs(expected)), point


def test_change_point_four_bar_statics_at_90_degrees():
    problem = {
        "tmm": 1,
        "units": SI,
        "points": {"O": [0, 0], "D": [4, 0]},
        "links": {
            "1": {"points": ["O", "A"], "length": 1},
            "2": {"points": ["A", "B"], "length": 3, "also": {"P": [1.5, 0.5]}},
            "3": {"points": ["D", "B"], "length": 2},
        },
        "masses": {
            "1": {"mass": 2, "centre": {"on": "OA"}},
            "2": {"mass": 3, "centre": {"on": "AB"}},
            "3": {"mass": 2, "centre": {"on": "DB"}},
        },
        "driver": {"link": "1", "speed": 1},
        "sketch": {"at": math.pi / 2, "B": [2.9, 1.7]},
        "positions": {"at": [math.pi / 2]},
    }
    motion = results_of(problem, "kinematics").motion
    assert motion.link("2").angle[0] == pytest.approx(0.23001134379000288, rel=1e-10)
    assert motion.link("3").angle[0] == pytest.approx(2.1406445800390212, rel=1e-10)
    assert motion.link("2").omega[0] == pytest.approx(-0.19074356983054613, rel=1e-9)
    assert motion.link("3").omega[0] == pytest.approx(0.516363211356001, rel=1e-9)
    assert motion.link("2").epsilon[0] == pytest.approx(0.09628595659519751, rel=1e-8)
    assert motion.link("3").epsilon[0] == pytest.approx(0.2730626518918343, rel=1e-8)
    assert motion.named("P").x[0] == pytest.approx(1.3465014289265458 + 1.8288147572882445j, rel=1e-10)
    assert motion.named("P").v[0] == pytest.approx(-0.8419089144666019 - 0.25683648933538056j, rel=1e-9)
    assert motion.named("P").a[0] == pytest.approx(-0.1287931305842911 - 0.9005056798720328j, rel=1e-8)
    still = {**problem, "driver": {"link": "1", "speed": 0}}  # their statics: weights without inertia
    reactions = results_of(still).reactions
    assert abs(reactions.balance.moment[0]) == pytest.approx(13.664357145334336, rel=2e-8)
    for joint, printed in {
        "O": 39.94445523955355,
        "A": 22.531020960348382,
        "B": 17.869513345698586,
        "D": 34.0018956580814,
    }.items():
        assert abs(reactions.of(joint).force[0]) == pytest.approx(printed, rel=2e-8), joint


def test_jansen_leg_of_pyslvs_from_its_coordinates():
    """test/test_core.py of KmolYuan/pyslvs gives joints in one pose; links are as long as they are there."""
    o, a, g, b, c, d, e, f = (
        0j,
        9.61 + 11.52j,
        -38 - 7.8j,
        -35.24 + 33.61j,
        -77.75 - 2.54j,
        -20.1 - 42.79j,
        -56.05 - 35.42j,
        -22.22 - 91.74j,
    )

    def plate(**points):
        return {"points": {name: [z.real, z.imag] for name, z in points.items()}}

    problem = {
        "tmm": 1,
        "units": SI,
        "points": {"O": [o.real, o.imag], "G": [g.real, g.imag]},
        "links": {
            "1": {"points": ["O", "A"], "length": abs(a - o)},
            "2": plate(A=a, B=b),
            "3": plate(G=g, B=b, C=c),
            "4": plate(A=a, D=d),
            "5": plate(G=g, D=d),
            "6": plate(C=c, E=e),
            "7": plate(D=d, E=e, F=f),
        },
        "driver": {"link": "1", "speed": 1},
        "sketch": {"at": math.atan2(a.imag, a.real), **plate(B=b, C=c, D=d, E=e, F=f)["points"]},
        "positions": {"at": [0, math.pi / 4]},
    }
    foot = results_of(problem, "kinematics").motion.named("F").x
    assert foot[0] == pytest.approx(-43.1700551554 - 91.7532259054j, abs=1e-9)
    assert foot[1] == pytest.approx(-24.4063935925 - 91.7895961426j, abs=1e-9)


def test_pyslvs_primitives_of_dyads():
    """PLLP: two circles meet; PLPP: a circle and a line meet."""
    two = {
        "tmm": 1,
        "units": SI,
        "points": {"O": [-100, 0], "D": [30, 0]},
        "links": {
            "1": {"points": ["O", "A"], "length": 70},
            "2": {"points": ["A", "B"], "length": 90},
            "3": {"points": ["D", "B"], "length": 30},
        },
        "driver": {"link": "1", "speed": 1},
        "sketch": {"at": 0.2, "B": [40, 28]},
        "positions": {"at": [0.0]},
    }
    dead = results_of(two, "kinematics").motion  # the circles touch: 90 = 60 + 30, a dead position
    assert dead.named("B").x[0] == pytest.approx(60 + 0j, abs=1e-9)
    assert not dead.moving[0]
    line = {
        "tmm": 1,
        "units": SI,
        "points": {"O": [-3, 0]},
        "guides": {"g": {"through": [0, -3], "angle": math.atan2(3, 1.5)}},
        "links": {
            "1": {"points": ["O", "A"], "length": 3},
            "2": {"points": ["A", "B"], "length": math.sqrt(5)},
            "3": {"points": ["B"], "slides": {"on": "g"}},
        },
        "driver": {"link": "1", "speed": 1},
        "sketch": {"at": 0.0, "B": [2, 1]},
        "positions": {"at": [0.0]},
    }
    assert results_of(line, "kinematics").motion.named("B").x[0] == pytest.approx(2 + 1j, abs=1e-12)
