"""After how many turns of the driver a train of wheels stands as it did: exact, from the ratios of its teeth."""

from __future__ import annotations

import pytest

from tmm_cli import solve
from tmm_cli.problem import build_problem, read_text

TRAIN = """tmm: 1
title: Planetary train driven by its sun
units: {length: mm, angle: deg}
parameters: {zs: %d, zp: %d, zr: %d, m: 2, OA: m*(zs + zp)/2}
points: {O: [0, 0]}
links:
  1: {name: sun, points: {O: [0, 0], S: [10, 0]}}
  2: {name: planet, points: {A: [0, 0], P: [10, 0]}}
  3: {name: carrier, points: [O, A], length: OA}
gears:
  outer: {between: [1, 2], carrier: 3, teeth: [zs, zp], module: m}
  ring: {between: [0, 2], carrier: 3, teeth: [zr, zp], module: m, inner: true}
driver: {link: 1, speed: 60 rpm}
sketch: {at: 0, A: [OA, 0], P: [OA + 10, 0]}
"""


@pytest.mark.parametrize(
    ("teeth", "turns"),
    [((20, 40, 100), 12), ((20, 20, 60), 4), ((24, 12, 48), 3), ((20, 30, 80), 15), ((18, 36, 90), 12)],
)
def test_a_planetary_train_driven_by_its_sun_repeats_after_turns_that_its_teeth_tell(teeth, turns):
    """Its carrier makes zs/(zs + zr) turns in one of the sun, its planet 1 - zr/zp times as many."""
    driver_range = solve(build_problem(read_text(TRAIN % teeth, "train.yaml"))).driver_range
    assert (driver_range.turns, driver_range.repeats) == (turns, True)
