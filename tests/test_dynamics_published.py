"""Flywheels of a textbook, to its printed digits: R. S. Khurmi, J. K. Gupta, Theory of Machines (2005), ch. 16.

Moments are given over the crank's angle; the links have no inertia, so the flywheel keeps all of the energy.
"""

import numpy as np
import pytest

from tmm_cli.dynamics.reduced import reduced
from tmm_cli.dynamics.steady import steady
from tmm_cli.dynamics.task import SteadyTask

TURN = 2 * np.pi
RPM = np.pi / 30


def machine(moment, edges):
    """From a moment (N m) by the crank's angle (rad), that of a load negative; edges: where it bends or jumps."""
    return reduced(lambda x: (0 * x, 0 * x, moment(x)), edges)


def polygon(*corners):
    """Through corners (angle in rad, moment)."""
    angles, moments = zip(*corners, strict=True)
    return machine(lambda x: np.interp(x, angles, moments), angles)


def test_example_16_6_a_machine_with_a_cycle_of_three_turns():
    load = polygon((0, -750), (np.pi, -3000), (3 * np.pi, -3000), (4 * np.pi, -750), (6 * np.pi, -750))
    found = steady(load, SteadyTask(250 * RPM, flywheel=500 * 0.6**2))
    assert found.moment * 250 * RPM == pytest.approx(49_087, abs=1)  # W
    assert found.delta == pytest.approx(0.072, abs=5e-4)


def test_example_16_7_page_578_a_steam_engine():
    peak = 4 * np.pi / 9
    engine = polygon((0, 0), (peak, 2000), (np.pi, 0), (np.pi + peak, 1500), (TURN, 0))
    found = steady(engine, SteadyTask(100 * RPM, 0.015))
    assert -found.moment == pytest.approx(875)
    assert found.law.flywheel / 1.75**2 == pytest.approx(197.3, abs=0.05)  # kg
    assert np.degrees([found.found.lower.x, found.found.upper.x]) == pytest.approx([35, 136.25], abs=0.01)


def test_example_16_8_page_580_three_cylinders():
    def moment(x):
        turns = [np.mod(x - k * TURN / 3, TURN) for k in range(3)]
        return sum(np.interp(turn, [0, np.pi / 3, np.pi, TURN], [0, 90, 0, 0]) for turn in turns)

    found = steady(machine(moment, np.arange(7) * np.pi / 3), SteadyTask(600 * RPM, flywheel=12 * 0.08**2))
    assert -found.moment * 600 * RPM == pytest.approx(4240, abs=5)  # W
    assert found.delta == pytest.approx(0.04, abs=5e-3)
    x = np.linspace(0, TURN, 721)[:-1]
    assert found.law.acceleration(x).max() == pytest.approx(292, abs=1.5)  # the book rounds 22.5 / 0.0768 = 292.97 down


def test_example_16_9_page_582_an_engine_of_four_strokes():
    work = 20_000 * 60 / 150  # J in a cycle
    half = np.pi / 2
    compression, expansion = -0.5 * work / half, 1.5 * work / half  # heights of triangles with these areas
    corners = [(0, 0), (np.pi, 0), (np.pi + half, compression), (TURN, 0), (TURN + half, expansion), (3 * np.pi, 0),
               (2 * TURN, 0)]  # fmt: skip
    found = steady(polygon(*corners), SteadyTask(300 * RPM, 0.04))
    assert found.law.flywheel == pytest.approx(255.4, rel=2e-3)


def test_example_16_11_page_585_an_engine_by_a_formula():
    engine = machine(lambda x: 20_000 + 9500 * np.sin(2 * x) - 5700 * np.cos(2 * x), [0, TURN])
    found = steady(engine, SteadyTask(180 * RPM, 0.01))
    assert -found.moment * 180 * RPM == pytest.approx(377_000, rel=1e-3)
    assert found.law.flywheel == pytest.approx(3121, rel=1e-3)
    assert found.law.acceleration(np.array([np.pi / 4]))[0] == pytest.approx(3.044, rel=2e-3)


def test_example_16_12_page_587_a_load_that_changes_too():
    both = machine(lambda x: 600 * np.sin(2 * x) - 500 * np.sin(x), [0, TURN])
    found = steady(both, SteadyTask(150 * RPM, flywheel=500 * 0.4**2))
    places = found.work.places()
    assert np.ptp(found.work(places)) == pytest.approx(1204, abs=1)
    assert found.delta == pytest.approx(0.061, abs=5e-4)
    x = np.radians(np.arange(0, 180, 0.1))
    pace = found.law.acceleration(x)
    assert [pace.max(), pace.min()] == pytest.approx([3.46, -12.2], abs=0.05)
    assert np.degrees(x[[pace.argmax(), pace.argmin()]]) == pytest.approx([35, 127.6], abs=0.3)


def test_example_16_13_page_589_three_cranks():
    engine = machine(lambda x: 5000 + 1500 * np.sin(3 * x), [0, TURN])
    found = steady(engine, SteadyTask(300 * RPM, flywheel=1000.0))
    assert -found.moment * 300 * RPM == pytest.approx(157_100, rel=1e-3)
    assert found.delta == pytest.approx(0.001, abs=5e-5)
