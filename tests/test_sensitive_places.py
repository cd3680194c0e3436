"""Places of the driver that were searched for move with the lengths as their sensitivities say, or solved anew."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from tmm_cli import load, redrive, solve
from tmm_cli.accuracy.data import changed, lengths
from tmm_cli.accuracy.places import Changed
from tmm_cli.groups.sequence import DriverMotion
from tmm_cli.kinematics.motion import move
from tmm_cli.problem.build import build
from tmm_cli.problem.reader import read_text

BARRED = """tmm: 1
units: {length: m, angle: rad}
points: {O: [0, 0], D: [1, 0]}
links:
  1: {points: [O, A], length: 0.8}
  2: {points: [A, B], length: 0.7}
  3: {points: [D, B], length: 0.6}
driver: {link: 1, speed: 10}
sketch: {at: 1, B: [1.05, 0.6]}
"""
BY = 1e-6  # m


def told_and_found(results, place):
    """For each length: how far a place moves by the sensitivity, and by solving the changed linkage anew."""
    kernels = results.kernels
    for length in lengths(results.linkage):
        other = changed(results.linkage, length, BY)
        both = (kernels, tuple(kernel.rebind(other) for kernel in kernels))

        def motions(q, both=both, other=other):
            q, law = np.atleast_1d(np.asarray(q, float)), DriverMotion(0.0, 1.0, 0.0, 1)
            return move(results.linkage, both[0], q, law), move(other, both[1], q, law)

        anew = solve(replace(results.problem, linkage=other, extended=None), "kinematics")
        yield place(results, Changed(motions, both, 1.0)), place(anew, None) - place(results, None)


def agree(results, place):
    pairs = np.array(list(told_and_found(results, place)))
    assert np.max(np.abs(pairs[:, 0])) > BY / 10
    assert np.allclose(pairs[:, 0], pairs[:, 1], rtol=0, atol=2e-4 * np.max(np.abs(pairs)))


def test_a_limit_of_two_links():
    def end(results, after):
        limit = results.driver_range.limits[-1]
        return limit.place if after is None else after.limit(limit.place, limit.group)

    agree(solve(build(read_text(BARRED, "barred.yaml")), "kinematics"), end)


def test_a_limit_of_a_class_iii_group():
    def end(results, after):
        limit = results.driver_range.limits[-1]
        return limit.place if after is None else after.limit(limit.place, limit.group)

    results = solve(redrive(load("problems/class-iv.yaml"), "4"), "kinematics")
    assert results.driver_range.limits and re.match("III", results.driver_range.limits[-1].group)
    agree(results, end)


@pytest.mark.parametrize("name", ["crank-rocker", "crank-slider-offset"])
def test_the_place_of_a_largest_pressure_angle(name):
    def top(results, after):
        p = results.pressure[0]
        place = p.place if after is None else after.pressure(p.place, p.group, p.link)
        return float(np.remainder(place + 1, 2 * np.pi)) if after is None else place

    results = solve(load(f"problems/{name}.yaml"), "kinematics")
    pairs = np.array(list(told_and_found(results, top)))
    assert np.allclose(pairs[:, 0], pairs[:, 1], rtol=0, atol=1e-3 * max(BY, np.max(np.abs(pairs))))
