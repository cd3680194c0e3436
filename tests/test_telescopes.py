"""Groups with a cylinder in them, in closed form: the same as by Newton's method, limits and dead positions by hand."""

from __future__ import annotations

import copy
from dataclasses import replace

import numpy as np
import pytest
from models import solved_text as solved
from random_linkages import Anything, any_linkage, loaded
from test_commands import ROOT
from test_cylinders import SWINGING

from tmm_cli import load, solve
from tmm_cli.batch import (
    DriverSamples,
    SequentialVariants,
    TracedVariants,
    prepare_batch,
    read_all,
    solve_stages as stages,
)
from tmm_cli.mechanics.accuracy import as_double_doubles
from tmm_cli.mechanics.assembly import analyse_mobile_structure, assemble, find_assemblies
from tmm_cli.mechanics.forces import collect_loads, solve_reactions
from tmm_cli.mechanics.groups import DriverMotion, GroupState, NewtonSolver, Telescope, TelescopeParts
from tmm_cli.mechanics.kinematics import compute_motion
from tmm_cli.mechanics.numerics import EPS, to_double_double
from tmm_cli.problem import read_text
from tmm_cli.synthesis import Candidates, build_synthesised, measure_demands, read_task

# pairs of the arm with what it hangs on, of the arm with the cylinder's far end, and of its near end
CHAINS = ("RRR", "RRP", "PRR", "RPR", "PRP", "RPP", "PPR")


LAW = DriverMotion(0.0, 2.0, 0.0, 1)


def swinging(seed, chain):
    """A crank, and on it or on the frame a cylinder that moves an arm; either part carries the guide, as it falls."""
    maker = Anything(seed)
    while True:
        first = copy.deepcopy(maker)
        first.driver("crank")
        known = list(first.poses)
        near, far, arm = first.new(3)
        first.pair(chain[2], first.choose(known), near)
        first.slide("s", near, far)
        first.drive(*first.choose(((near, far), (far, near))), "slide", "s")
        first.pair(chain[1], far, arm)
        first.pair(chain[0], first.choose(known), arm)
        for name in (near, far, arm):
            first.points[name][f"W{name}"] = first.place()
        if first.sound():
            return loaded(first.linkage(), first.random)
        maker.random = first.random


def both(linkage):
    """Its groups in closed form and by Newton's method from the sketch."""
    structure = analyse_mobile_structure(linkage)
    (closed,) = assemble(linkage, structure)
    places = compute_motion(linkage, [closed], np.array([linkage.sketch.at]), LAW, 0).placements[0].poses
    start = GroupState(np.stack([pose.x for pose in places], -1), np.stack([pose.turned for pose in places], -1))
    return structure, closed, replace(NewtonSolver.of(closed.group, linkage), start=start)


def near(one, other, size=None):
    one, other = np.broadcast_arrays(one, other)
    return np.max(np.abs(one - other)) < 1e-12 * max(1.0, np.max(np.abs(other)), size or 0.0)


@pytest.mark.parametrize("chain", CHAINS)
@pytest.mark.parametrize("seed", range(6))
def test_it_moves_and_holds_as_newtons_method_says(chain, seed):
    linkage = swinging(seed, chain)
    structure, closed, iterated = both(linkage)
    assert isinstance(closed, Telescope)
    q = linkage.sketch.at + np.linspace(-0.01, 0.01, 7)
    one, other = (compute_motion(linkage, [kernel], q, LAW) for kernel in (closed, iterated))
    assert np.all(one.moving) and np.all(other.moving)
    for link in linkage.moving:
        assert near(one.poses[link].x, other.poses[link].x) and near(one.poses[link].z, other.poses[link].z)
        assert near(one.first[link].v, other.first[link].v) and near(one.first[link].w, other.first[link].w)
        assert near(one.second[link].a, other.second[link].a, 10.0), link
        assert near(one.second[link].e, other.second[link].e, 10.0), link
    one, other = (solve_reactions(m, structure, collect_loads(m, None)) for m in (one, other))
    size = max(np.max(np.abs(r.force)) for r in other.all)
    for mine, theirs in zip(one.all, other.all, strict=True):
        assert (mine.pair.name, mine.on, mine.by) == (theirs.pair.name, theirs.on, theirs.by)
        assert near(mine.force, theirs.force, size) and near(mine.at, theirs.at)
        assert (mine.couple is None) == (theirs.couple is None)
        assert mine.couple is None or near(mine.couple, theirs.couple, size)
        assert mine.tangential is None and theirs.tangential is None
    for mine, theirs in zip(one.balances, other.balances, strict=True):
        assert near(mine.generalized, theirs.generalized, size) and near(mine.vector, theirs.vector, size)


@pytest.mark.parametrize("chain", CHAINS)
def test_on_a_tape_it_is_what_the_stages_say(chain):
    linkage = swinging(1, chain)
    links = linkage.links
    heavier = replace(linkage, links={name: replace(link, mass=1.25 * link.mass) for name, link in links.items()})
    slide = replace(linkage.slides[-1], through=1.01 * linkage.slides[-1].through)
    longer = replace(linkage, slides=(*linkage.slides[:-1], slide))
    batch = prepare_batch([linkage, heavier, longer], read_all)
    assert batch.program is not None
    q = linkage.sketch.at + np.linspace(-0.01, 0.01, 5)
    found = batch(q)
    for k, one in enumerate(batch.linkages):
        structure = analyse_mobile_structure(one)
        expected = stages(one, structure, assemble(one, structure), q, read_all, True, None)
        for name in found:
            assert near(found[name][k] if np.ndim(found[name]) > 1 else found[name], expected[name]), name


@pytest.mark.parametrize("chain", CHAINS)
def test_in_double_doubles_it_has_all_of_its_digits(chain):
    linkage = swinging(2, chain)
    wide = as_double_doubles(linkage)
    _, closed, iterated = both(linkage)
    q = to_double_double(linkage.sketch.at + np.linspace(-0.01, 0.01, 5))
    one, other = (compute_motion(wide, [kernel.rebind(wide)], q, LAW) for kernel in (closed, iterated))
    for link in linkage.moving:
        assert np.max(np.abs(one.poses[link].x - other.poses[link].x)) < 200 * EPS
        size = np.max(np.abs(other.second[link].a))
        assert np.max(np.abs(one.second[link].a - other.second[link].a)) < 1e4 * EPS * max(1.0, size)


@pytest.mark.parametrize("chain", CHAINS)
@pytest.mark.parametrize("seed", range(4))
def test_its_gap_grows_as_fast_as_it_says(chain, seed):
    """From five places of the driver about the sketch, wherever the arm lies."""
    linkage = swinging(seed, chain)
    _, kernel, _ = both(linkage)
    step = 1e-3
    motion = compute_motion(linkage, [kernel], linkage.sketch.at + step * np.arange(-2, 3), LAW, 1)
    at = kernel.closed(motion.poses, motion.drives)
    rate = kernel.residual_rate(at, motion.poses, motion.first, motion.drives)
    b2, b1, _, a1, a2 = at.residual
    assert rate[2] == pytest.approx((8 * (a1 - b1) - (a2 - b2)) / (12 * step), rel=1e-8, abs=1e-9)


def test_its_driver_turns_back_where_the_triangle_is_flat():
    """Lever of 200 mm, hinges hypot(350, 300) apart: the cylinder is the difference or the sum of them long."""
    results = solved(SWINGING.replace(", stroke: [400, 600]", "").replace("{count: 5}", "{at: [550]}"))
    base = np.hypot(0.35, 0.3)
    assert np.allclose(
        [results.driver_range.start, results.driver_range.end], [base - 0.2, base + 0.2], rtol=0, atol=1e-15
    )
    assert [limit.group for limit in results.driver_range.limits] == ["II(1,2,3)"] * 2
    assert not results.dead


FLAT = """tmm: 1
points: {{O: [0, 0], D: [500, 0]}}
links:
  1: {{points: [O, A], length: 100}}
  2: {{points: {{A: [0, 0], P: {pin}}}}}
  3: {{points: {{B: [0, 0]}}, slides: {{on: 2, through: P, angle: {angle}}}}}
  4: {{points: [D, B], length: 200}}
driver:
  - {{link: 1, speed: 1 rad/s}}
  - {{link: 3, on: 2, speed: {speed} mm/s, at: {at}}}
sketch: {{at: 1.5 rad, B: [350, 150]}}
positions: {{at: [1.4 rad, 1.5 rad]}}
output: 4
"""


@pytest.mark.parametrize("pin, angle, offset", [("[0, 0]", "0", 0.0), ("[30, 20]", "0", 20.0)])
def test_a_dead_position_that_two_drivers_touch_is_found_where_the_triangle_is_flat(pin, angle, offset):
    """The cylinder grows as the distance AD does at q0 = 2 rad, and there it is AD - DB long: flat, and gone through.

    With its axis 20 mm off A, 30 mm behind the pin: AB^2 = (30 + s)^2 + 20^2.
    """
    d = np.hypot(100 * np.cos(2.0) - 500, 100 * np.sin(2.0))
    length = d - 200
    run = np.sqrt(length**2 - offset**2)
    speed = 100 * 500 * np.sin(2.0) / d * length / run
    at = run - (30.0 if offset else 0.0) - 0.5 * speed
    text = FLAT.format(pin=pin, angle=angle, speed=repr(float(speed)), at=repr(float(at)))
    results = solve(build_synthesised(read_text(text, "flat.yaml")))
    (dead,) = [dead for dead in results.dead if abs(dead.place - 2.0) < 0.1]
    assert dead.group == "II(2,3,4)" and dead.place == pytest.approx(2.0, abs=1e-13) and dead.passed


def test_all_its_assemblies_are_two_in_closed_form():
    results = solved(SWINGING)
    here = find_assemblies(results.linkage, results.structure, results.kernels, 0.55)
    (found,) = here.groups
    assert (found.method, found.most, len(found.assemblies)) == ("closed form", 2, 2)
    one, other = (complex(a.points["B"] + 0.3j) / complex(0.35 + 0.3j) for a in found.assemblies)
    assert one == pytest.approx(np.conj(other), abs=1e-15)  # one on either side of the line of hinges


def test_links_that_are_not_such_a_chain_stay_with_newtons_method():
    """A drive in a hinge, or a cylinder between links of a larger group."""
    loader = load(str(ROOT / "problems" / "loader.yaml")).linkage
    for linkage in (loader, any_linkage(1, ("arm",)), any_linkage(1, ("III",))):
        assert all(TelescopeParts.of(group) is None for group in analyse_mobile_structure(linkage).groups)


LIFT = """tmm: 1
parameters:
  first: hypot(b*cos(10 deg) - xC, b*sin(10 deg) - yC)
  last: hypot(b*cos(60 deg) - xC, b*sin(60 deg) - yC)
synthesis:
  task: optimal
  vary: {b: [400, 800], xC: [200, 700], yC: [-700, -300]}
  objective: moment
  constraints: [{of: reaction, pair: O, most: 9 kN}]
  positions: 24
  population: 8
  generations: 3
units: {length: mm, angle: deg}
points: {O: [0, 0], C: [xC, yC]}
links:
  1: {points: {O: [0, 0], B: [b, 0], P: [2000, 0]}}
  2: {points: {C: [0, 0], U: [300, 0]}}
  3: {points: {B: [0, 0], V: [-250, 0]}, slides: {on: 2, along: C-U}}
driver: {link: 3, on: 2, speed: 40 mm/s}
sketch: {at: (first + last)/2, B: [b*cos(35 deg), b*sin(35 deg)]}
masses: {1: {mass: 60 kg, inertia: 20, centre: [800, 0]}, 2: {mass: 14 kg, inertia: 0.2, centre: U}}
loads: {F: {on: 1, at: P, force: [0, -2 kN]}}
output: 1
positions: {at: [first, (first + last)/2, last]}
"""


def test_candidates_whose_strokes_vary_are_on_one_tape():
    """The boom goes from 10 to 60 deg in each of them, so that the cylinder goes another way in each."""
    search = Candidates(read_task(read_text(LIFT, "x.yaml")))
    assert isinstance(search.program, TracedVariants)
    variants = search.numbers(np.random.default_rng(3).random((5, 3)))
    places = DriverSamples(np.linspace(0, 1, 7), np.zeros(0))
    found = search.program(variants, places)
    expected = SequentialVariants(search.task.make, search.first, search.outputs, forces=True)(variants, places)
    for name in found:
        assert near(found[name], expected[name]), name


def test_what_is_found_for_a_lift_is_measured_on_it():
    problem = build_synthesised(read_text(LIFT, "x.yaml"))
    for m in measure_demands(problem.synthesis.outcome, solve(problem, "kinematics")):
        assert m.met, (m.demand.text, m.demand.value, m.value)


def digger():
    """A search over where the boom's cylinder stands: the three pass through another sketch in each candidate."""
    text = (ROOT / "problems" / "excavator.yaml").read_text(encoding="utf-8")
    asked = (
        "synthesis: {task: optimal, vary: {HX: [550, 650]}, objective: moment, positions: 24}\noutput: 7\npoints: {O"
    )
    for old, new in (("s1: sqrt(600^2", "s1: sqrt(HX^2"), ("H: [600, 0]", "H: [HX, 0]"), ("points: {O", asked)):
        assert old in text
        text = text.replace(old, new, 1)
    return Candidates(read_task(read_text(text, "x.yaml")))


def test_drivers_of_each_candidate_pass_through_its_own_sketch():
    search = digger()
    variants = np.array([[0.56], [0.6], [0.64]])
    found = search.program(variants, DriverSamples(np.linspace(0, 1, 7), np.zeros(0)))
    for k, numbers in enumerate(variants):
        own = search.task.make(numbers.tolist())
        structure, q = analyse_mobile_structure(own.linkage), np.linspace(*own.ends, 7)
        kernels = assemble(own.linkage, structure)
        expected = stages(own.linkage, structure, kernels, q, search.outputs, True, None)
        assert near(found["0.y"][k], 1.0 * expected["0.y"])
    at = [search.program.sketch(numbers).at for numbers in variants]
    assert np.allclose(at, np.hypot(variants[:, 0], 0.9), rtol=1e-15)


def test_a_batch_of_linkages_with_sketches_of_their_own_moves_each_from_its_own():
    make = digger().task.make
    linkages = [make([x]).linkage for x in (0.58, 0.62)]
    q = 1.1 + np.linspace(0, 0.02, 5)
    found = prepare_batch(linkages, read_all)(q)
    for k, one in enumerate(linkages):
        structure = analyse_mobile_structure(one)
        expected = stages(one, structure, assemble(one, structure), q, read_all, True, None)
        assert all(near(1.0 * found[name][k], 1.0 * expected[name]) for name in found)
