"""Groups of all classes followed over the driver's whole way: everywhere placed, nowhere jumping, rightly stopped."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from random_linkages import any_linkage

from tmm_cli.mechanics.assembly import assemble
from tmm_cli.mechanics.groups import DriverMotion
from tmm_cli.mechanics.kinematics import compute_motion, find_range
from tmm_cli.mechanics.structure import analyse_structure

# the last ones: barred only after more than a turn; the second group stops the driver; a rack that goes on and on;
# a cylinder that is looked at as far as it is for the largest group
CASES = [
    *((seed, kinds, "crank") for seed in range(1, 2) for kinds in (("III",), ("IV",), ("VI",), ("III", "IV"))),
    (54, ("III",), "crank"),
    (1092, ("III", "III"), "crank"),
    (3184, ("rack", "RRP"), "crank"),
    (3139, ("pinion", "rack"), "cylinder"),
    (7, ("gear", "geared five-bar"), "crank"),
    (5, ("III",), "swinging cylinder"),
]


@cache
def followed(seed, kinds, driver):
    it = any_linkage(seed, kinds, driver)
    kernels = assemble(it, analyse_structure(it))
    return it, kernels, find_range(it, kernels)


@pytest.mark.parametrize("case", CASES)
def test_a_linkage_goes_its_whole_way_without_a_jump(case):
    it, kernels, way = followed(*case)
    ends = 1e-5 * (way.end - way.start) * (not way.full)
    q = np.linspace(way.start + ends, way.end - ends, 400 * way.turns + 1)
    motion = compute_motion(it, kernels, q, DriverMotion(it.sketch.at, 1.0, 0.0, 1))
    assert np.all(motion.placed)
    step = q[1] - q[0]
    for kernel in kernels:
        for link in kernel.group.links:
            pose, rate = motion.poses[link], motion.first[link]
            for way_gone, speed in ((pose.x / kernel.size, np.abs(rate.v) / kernel.size), (pose.z, np.abs(rate.w))):
                fastest = np.maximum(speed[1:], speed[:-1])
                assert np.all(np.abs(np.diff(way_gone)) < 4 * step * fastest + 0.01), link


@pytest.mark.parametrize("case", CASES)
def test_the_group_that_stops_the_driver_is_dead_there(case):
    it, kernels, way = followed(*case)
    for limit in way.limits:
        inside = limit.place + np.sign(it.sketch.at - limit.place) * 1e-8
        motion = compute_motion(it, kernels, np.array([inside]), DriverMotion(it.sketch.at, 1.0, 0.0, 1))
        margins = {k.group.title: float(at.margin[0]) for k, at in zip(kernels, motion.placements, strict=True)}
        assert margins[limit.group] < 1e-3


@pytest.mark.parametrize("case", CASES)
def test_what_repeats_is_back_after_its_cycle(case):
    it, kernels, way = followed(*case)
    if way.full:
        ends = compute_motion(it, kernels, np.array([way.start, way.end]), DriverMotion(it.sketch.at, 1.0, 0.0, 1))
        back = all(abs(p.z[1] - p.z[0]) + abs(p.x[1] - p.x[0]) < 1e-9 for p in ends.poses.values())
        assert back == way.repeats


def test_a_limit_at_infinity_is_found_to_all_digits():
    """Two guides of the group become parallel there; places near it are extrapolated from farther off."""
    it, kernels, way = followed(95, ("IV",), "crank")
    place = way.start
    offsets = 1e-3 * 0.6 ** np.arange(8)
    motion = compute_motion(it, kernels, place + offsets, DriverMotion(it.sketch.at, 1.0, 0.0, 1))
    far = max(kernels[-1].group.links, key=lambda link: abs(motion.poses[link].x[-1]))
    near = 1 / np.abs(motion.poses[far].x)  # falls to nothing at the limit, smoothly
    exact = place + np.polyval(np.polyfit(near, offsets, 5), 0.0)
    assert abs(exact - place) < 1e-10
