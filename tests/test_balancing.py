"""Counterweights found by least squares against what textbooks prove of them."""

import csv
import json
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, strategies as st
from test_commands import tmm

from tmm_cli import load, solve
from tmm_cli.mechanics.analysis import motion_at_positions
from tmm_cli.mechanics.dynamics import (
    BalancingTask,
    CorrectionPlane,
    CounterweightPlace,
    UnbalancedShaft,
    balance_cycle,
    compute_shaking,
)
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.problem import ProblemError, build_problem, read_text

PROBLEMS = Path(__file__).parents[1] / "problems"


@cache
def turn_of(name, count=720):
    results = solve(load(PROBLEMS / f"{name}.yaml"))
    return motion_at_positions(results, results.start + np.arange(count) * 2 * np.pi / count), results


def task(*links, **more):
    return BalancingTask(tuple(CounterweightPlace(link, 0j) for link in links), **more)


def written(name, block):
    """A problem of the bank with a block `balancing`, solved."""
    text = (PROBLEMS / f"{name}.yaml").read_text(encoding="utf-8")
    return solve(build_problem(read_text(f"{text}\nbalancing: {block}\n", f"{name}.yaml")))


def test_two_counterweights_balance_the_forces_of_a_four_bar():
    motion, __ = turn_of("crank-rocker")
    assert balance_cycle(motion, task("1", "3")).left < 1e-12


def test_a_counterweight_on_the_crank_alone_leaves_a_part_of_a_crank_slider():
    motion, __ = turn_of("crank-slider")
    one, both = balance_cycle(motion, task("1")), balance_cycle(motion, task("1", "2"))
    assert 0.1 < one.left < 1 and both.left < 1e-12
    assert np.mean(np.abs(one.after.force) ** 2) < np.mean(np.abs(one.before.force) ** 2)


def test_an_engine_of_four_cylinders_in_line_leaves_its_second_harmonic():
    motion, __ = turn_of("engine-four")
    harmonics = np.abs(np.fft.fft(compute_shaking(motion).force)) / len(motion.q)
    assert harmonics[1] < 1e-9 * harmonics[2]


@pytest.mark.parametrize("name", ["crank-rocker", "crank-slider", "six-bar", "shaper"])
def test_what_shakes_is_the_rate_of_all_momentum(name):
    motion, results = turn_of(name)
    step = 1e-5
    ends = [motion_at_positions(results, motion.q + sign * step) for sign in (-1, 1)]
    momentum = [sum(m.linkage.links[n].mass * m.centre(n).v for n in m.linkage.moving) for m in ends]
    rate = (momentum[1] - momentum[0]) / (2 * step) * motion.rate
    force = compute_shaking(motion).force
    assert force == pytest.approx(-rate, abs=1e-5 * np.max(np.abs(force)))


def heavier(linkage, weights):
    """The linkage with counterweights of told masses as parts of its links."""
    links = dict(linkage.links)
    for weight in weights:
        link, place = links[weight.place.link], weight.place
        at = place.about + place.radius * np.exp(1j * weight.angle)
        mass = link.mass + weight.mass
        centre = (link.mass * link.centre + weight.mass * at) / mass
        inertia = link.inertia + link.mass * abs(link.centre - centre) ** 2 + weight.mass * abs(at - centre) ** 2
        links[place.link] = replace(link, mass=mass, centre=centre, inertia=inertia)
    return replace(linkage, links=links)


def test_counterweights_are_masses_like_others_also_on_a_pivot_that_moves():
    motion, __ = turn_of("crank-slider")
    found = balance_cycle(motion, BalancingTask((CounterweightPlace("1", 0j, 0.05), CounterweightPlace("2", 0j, 0.1))))
    again = compute_shaking(replace(motion, linkage=heavier(motion.linkage, found.counterweights)))
    assert np.max(np.abs(again.force)) < 1e-12 * np.max(np.abs(found.before.force))
    assert again.moment == pytest.approx(found.after.moment, abs=1e-12 * np.max(np.abs(again.moment)))


def test_a_balanced_four_bar_does_not_move_its_common_centre_of_mass():
    results = written("crank-rocker", "{counterweights: {1: {radius: 60}, 3: {radius: 120}}}")
    motion, found = results.motion, results.balancing
    linkage = heavier(motion.linkage, found.cycle.counterweights)
    moved = replace(motion, linkage=linkage)
    masses = [linkage.links[name].mass for name in linkage.moving]
    centre = sum(m * moved.centre(name).x for m, name in zip(masses, linkage.moving, strict=True)) / sum(masses)
    assert np.ptp(centre.real) + np.ptp(centre.imag) < 1e-15 and found.cycle.left < 1e-12


def test_what_shakes_is_what_the_reactions_of_the_frame_leave_without_loads():
    text = (PROBLEMS / "crank-rocker.yaml").read_text(encoding="utf-8")
    text = text[: text.index("loads:")] + "gravity: 0\nsketch: {at: 30 deg, B: [370, 245]}\nbalancing: {}\n"
    results = solve(build_problem(read_text(text.replace("sketch: {at: 30 deg, B: [370, 245]}\n", "", 1), "free.yaml")))
    frame = -sum(
        r.onto(r.on) if r.by == FRAME else r.onto(r.by) for r in results.reactions.all if FRAME in (r.on, r.by)
    )
    force = results.balancing.before.force
    assert force == pytest.approx(frame, abs=1e-12 * np.max(np.abs(force)))


@pytest.mark.parametrize("share", [0, 0.3, 1 / 2, 2 / 3, 1])
def test_a_share_is_that_of_the_reciprocating_masses(share):
    """B b = (m_rot + c m_rec) r: the connecting rod counts as two masses, its centre divides AB."""
    results = written("crank-slider", f"{{counterweights: {{1: {{}}}}, share: {share}}}")
    links, r, part = results.linkage.links, 0.06, 0.35
    turning = links["2"].mass * (1 - part)
    sliding = links["3"].mass + links["2"].mass * part
    (weight,) = results.balancing.cycle.counterweights
    assert weight.size == pytest.approx((turning + share * sliding) * r, rel=1e-9)
    assert abs(weight.angle) == pytest.approx(np.pi)


def test_an_engine_with_two_thirds_of_its_reciprocating_parts_balanced():
    """R. S. Khurmi, J. K. Gupta, Theory of Machines (2005), example 22.1: 240 rpm, stroke 300 mm, 50 kg go to and fro,
    37 kg turn with the crank pin, balanced at 400 mm; 60 deg after dead centre. Its rod is endless: here 10 km long."""
    text = """
tmm: 1
points: {O: [0, 0]}
guides: {x: {through: O, angle: 0}}
links:
  1: {points: [O, A], length: 150}
  2: {points: [A, B], length: 10 km}
  3: {points: [B], slides: x}
driver: {link: 1, speed: 240 rpm}
sketch: {at: 60, B: [10000000, 0]}
masses: {1: {mass: 37, centre: A}, 3: {mass: 50}}
positions: {at: [60]}
output: 3
balancing: {counterweights: {1: {radius: 400}}, share: 2/3}
"""
    results = solve(build_problem(read_text(text, "engine.yaml")))
    (weight,) = results.balancing.cycle.counterweights
    assert weight.mass == pytest.approx(26.38, abs=0.005)
    assert abs(results.balancing.after.force[0]) == pytest.approx(2849, rel=2e-3)


def test_masses_in_one_plane_to_the_digits_of_a_textbook():
    """B. K. Sarkar, Theory of Machines (2004), chapter 8, illustration 1, p. 221."""
    masses = ((12, 40, 0), (10, 50, 60), (18, 60, 130), (15, 30, 270))  # kg, mm, deg
    sizes = np.array([m * r * np.exp(1j * np.radians(angle)) for m, r, angle in masses])
    (found,) = UnbalancedShaft(sizes, np.zeros(4), (CorrectionPlane(0.0),)).corrections()
    assert abs(found) / 100 == pytest.approx(8.1, abs=0.05)
    assert np.degrees(np.angle(found)) % 360 == pytest.approx(267.5, abs=0.05)


def test_masses_in_two_planes_as_a_textbook_measures_them():
    """R. S. Khurmi, J. K. Gupta, Theory of Machines (2005), example 21.2; drawn there, and in B. K. Sarkar, p. 223:
    X 350 to 355 kg at 145 to 146 deg clockwise from A, Y 182.5 kg, both at 100 mm."""
    masses = ((200, 80, 0, 0), (300, 70, 45, 300), (400, 60, 115, 400), (200, 80, 235, 700))  # kg, mm, deg, mm
    sizes = np.array([m * r * np.exp(1j * np.radians(angle)) for m, r, angle, __ in masses])
    rotor = UnbalancedShaft(
        sizes, np.array([at for *__, at in masses]), (CorrectionPlane(100.0), CorrectionPlane(500.0))
    )
    x, y = rotor.corrections()
    assert 350 < abs(x) / 100 < 355 and abs(y) / 100 == pytest.approx(182.5, rel=0.01)
    assert -np.degrees(np.angle(x)) % 360 == pytest.approx(146, abs=1)


MASSES = st.lists(
    st.tuples(st.floats(0.1, 50), st.floats(0, 6.2), st.floats(-1, 1)).map(lambda m: (m[0] * np.exp(1j * m[1]), m[2])),
    min_size=1,
    max_size=6,
)


@given(MASSES, st.floats(-1, -0.2), st.floats(0.2, 1))
def test_masses_in_two_planes_leave_neither_force_nor_couple(masses, one, other):
    rotor = UnbalancedShaft(*map(np.array, zip(*masses, strict=True)), (CorrectionPlane(one), CorrectionPlane(other)))
    before, after = rotor.unbalance(), rotor.unbalance(rotor.corrections())
    size = sum(abs(size) for size, __ in masses)
    assert max(map(abs, after)) < 1e-14 * size * 20
    static = replace(rotor, planes=(CorrectionPlane(one),))
    force, couple = static.unbalance(static.corrections())
    assert abs(force) < 1e-14 * size and couple == pytest.approx(before[1])


@pytest.mark.parametrize(
    ("name", "block", "said"),
    [
        ("crank-slider", "{counterweights: {2: {}}}", "so the mass must be known"),
        ("crank-slider", "{counterweights: {3: {}}}", "a link that does not rotate"),
        ("crank-slider", "{counterweights: {9: {}}}", "there is no link of that name"),
        ("crank-slider", "{counterweights: {1: {}}, share: 2}", "a fraction cannot be greater than 1"),
        ("crank-rocker", "{counterweights: {1: {}}, share: 1/2}", "this mechanism has no such guide"),
        ("crank-rocker", "{rotor: {masses: [{mass: 1, radius: 9}], planes: [5, 5]}}", "planes must be different"),
        ("boom-lift", "{counterweights: {}}", "a single crank that rotates fully"),
        ("crank-slider", "{counterweights: {1: {}, 2: {about: B, radius: 50}}}", "with these radii cannot balance"),
    ],
)
def test_what_cannot_be_balanced_is_refused(tmp_path, name, block, said):
    file = tmp_path / "bad.yaml"
    text = (PROBLEMS / f"{name}.yaml").read_text(encoding="utf-8")
    file.write_text(f"{text}\nbalancing: {block}\n", encoding="utf-8")
    with pytest.raises(ProblemError, match=said):
        solve(load(file))


def test_without_the_block_nothing_of_it_is_imported():
    code = (
        "import sys; from tmm_cli import load, solve; from tmm_cli.reports.result_json import to_json;"
        "to_json(solve(load('problems/crank-rocker.yaml')));"
        "print([name for name in sys.modules if 'balancing' in name and name.startswith('tmm_cli.')])"
    )
    found = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=PROBLEMS.parent
    )
    assert json.loads(found.stdout.replace("'", '"')) == []


def test_balancing_is_told_and_written(tmp_path):
    file = tmp_path / "four.yaml"
    text = (PROBLEMS / "crank-rocker.yaml").read_text(encoding="utf-8")
    file.write_text(f"{text}\nbalancing: {{counterweights: {{1: {{}}, 3: {{radius: 80}}}}}}\n", encoding="utf-8")
    shown = tmm("dynamics", file, "-o", tmp_path)
    assert shown.returncode == 0 and "largest shaking force with counterweights" in shown.stdout
    folder = next(tmp_path.glob("four*/"))
    whole = json.loads((folder / "result.json").read_text(encoding="utf-8"))["balancing"]
    assert whole["left"] < 1e-12 and [w["link"] for w in whole["counterweights"]] == ["1", "3"]
    with (folder / "shaking.csv").open(encoding="utf-8") as stream:
        assert len(list(csv.reader(stream))) == 13


def test_a_shaft_that_turns_backwards_takes_what_one_counterweight_leaves_of_the_first_harmonic():
    """Two counterweights that turn against one another (F. W. Lanchester): of a crank-slider the second one is left."""
    text = """
tmm: 1
points: {O: [0, 0], Q: [0, -80]}
guides: {x: {through: O, angle: 0}}
links:
  1: {points: [O, A], length: 60}
  2: {points: [A, B], length: 220}
  3: {points: [B], slides: x}
  4: {points: {Q: [0, 0]}}
gears: {g: {between: [1, 4], radii: [40, 40]}}
driver: {link: 1, speed: 600 rpm}
sketch: {at: 60, B: [245, 0]}
masses: {1: {mass: 1, centre: O}, 2: {mass: 1, centre: {on: AB, at: 0.3}}, 3: {mass: 1}}
balancing: {counterweights: {1: {}, 4: {}}}
"""
    found = solve(build_problem(read_text(text, "lanchester.yaml"))).balancing.cycle
    before, after = (np.abs(np.fft.fft(shaking.force)) / 720 for shaking in (found.before, found.after))
    assert max(after[1], after[-1]) < 1e-12 * before[1] and after[2] == pytest.approx(before[2], rel=1e-9)


def test_a_counterweight_on_a_link_that_only_translates_does_nothing():
    """The coupler of a parallelogram: no mass on it changes where its own centre of mass goes but by its weight."""
    text = (PROBLEMS / "parallel-couplers.yaml").read_text(encoding="utf-8").partition("shows:")[0]
    with np.errstate(over="raise", invalid="raise"):
        results = solve(build_problem(read_text(text + "balancing: {counterweights: {2: {radius: 20}}}\n", "x")))
    (weight,) = results.balancing.cycle.counterweights
    assert weight.size == 0
    assert results.balancing.cycle.left == pytest.approx(1.0)
