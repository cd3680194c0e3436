"""Dead positions inside the way of followed groups: their places in 50 digits, and the smooth motion through them.

A plate BCD stands on two equal and parallel rods CK and DL and is driven by crank OA and rod AB: it goes round without
turning, and B runs on a circle about the frame's point M = K + CB. When the rods come into line with KL, the group is
dead: the plate could begin to turn there. E. J. Haug, Computer Aided Kinematics and Dynamics, ch. 3.7.
"""

from __future__ import annotations

from functools import cache

import mpmath as mp
import numpy as np
import pytest
from models import SI, results_of

from tmm_cli.mechanics.analysis import motion_at_positions
from tmm_cli.reports import collect_warnings

DIGITS = 1e-12  # rad


pytestmark = pytest.mark.usefixtures("fifty_digits")


class Plate:
    """Data as they are written: crank, rod AB, rods CK and DL, pivot K, vectors KL and CB."""

    def __init__(self, crank, rod, leg, K, KL, CB, at):
        self.crank, self.rod, self.leg = mp.mpf(crank), mp.mpf(rod), mp.mpf(leg)
        self.K, self.KL, self.CB = (mp.mpc(*v) for v in (K, KL, CB))
        self.M, self.at = self.K + self.CB, at

    def swing(self, q):
        """Angle of the parallel rods, from the triangle AMB with B on the left of AM."""
        A = self.crank * mp.expj(q)
        d = self.M - A
        along = (self.rod**2 - self.leg**2 + abs(d) ** 2) / (2 * abs(d))
        B = A + d / abs(d) * mp.mpc(along, mp.sqrt(self.rod**2 - along**2))
        return mp.arg(B - self.M)

    def dead(self):
        """Places of the crank where the rods lie along KL, in growing order within a turn."""
        found = []
        for sense in (1, -1):
            B = self.M + sense * self.leg * self.KL / abs(self.KL)
            share = (self.crank**2 + abs(B) ** 2 - self.rod**2) / (2 * self.crank * abs(B))
            if abs(share) < 1:
                places = [mp.arg(B) + turn * mp.acos(share) for turn in (1, -1)]
                found += [q for q in places if abs(mp.expj(self.swing(q)) - sense * self.KL / abs(self.KL)) < 1e-20]
        return sorted(q - 2 * mp.pi * mp.floor(q / (2 * mp.pi)) for q in found)

    def problem(self, longer=0.0, **more):
        """The problem file; `longer` is what rod DL is longer than CK."""

        def written(z):
            return [float(z.real), float(z.imag)]

        leg = self.leg * mp.expj(self.swing(mp.mpf(self.at)))
        C = self.K + leg
        links = {
            "1": {"points": ["O", "A"], "length": float(self.crank)},
            "2": {"points": ["A", "B"], "length": float(self.rod)},
            "3": {"points": {"C": [0, 0], "D": written(self.KL), "B": written(self.CB)}},
            "4": {"points": ["C", "K"], "length": float(self.leg)},
            "5": {"points": ["D", "L"], "length": float(self.leg) + longer},
        }
        return {
            "tmm": 1,
            "units": SI,
            "links": links,
            "driver": {"link": "1", "speed": 1},
            "points": {"O": [0, 0], "K": written(self.K), "L": written(self.K + self.KL)},
            "sketch": {"at": self.at, "B": written(C + self.CB), "C": written(C), "D": written(C + self.KL)},
            **more,
        }


DRAG_LINK = (("0.4", "0.35", "0.3"), ("0.05", "-0.1"), ("0.6", "0.15"), ("0.05", "0.15"))
ROCKER = (("0.1", "0.45", "0.25"), ("0.3", "-0.2"), ("0.05", "-0.4"), ("0.2", "0.2"))


def plate(kind, at=0.7):
    lengths, *vectors = kind
    return Plate(*lengths, *vectors, at)


@cache
def moved(kind):
    return results_of(plate(kind).problem(), "kinematics")


def near(found, expected, digits=DIGITS):
    """The same places of the crank but for full turns, in any order."""
    assert len(found) == len(expected)
    for one in found:
        off = min((mp.mpf(float(one)) - q for q in expected), key=lambda d: abs(mp.sin(d / 2)))
        assert 2 * abs(mp.sin(off / 2)) < digits, (one, expected)


@pytest.mark.parametrize("kind", [DRAG_LINK, ROCKER])
def test_the_plate_is_dead_where_its_rods_come_into_line(kind):
    results = moved(kind)
    assert results.driver_range.full
    near([d.place for d in results.dead], plate(kind).dead())
    assert {d.group for d in results.dead} == {results.kernels[-1].group.title}


@pytest.mark.parametrize("off", [3.141592653589793, -1e-5])
def test_it_does_not_matter_where_the_sketch_is_drawn(off):
    """Also right opposite to a dead position, where a turn of the crank would begin in it, or close to one."""
    dead = plate(DRAG_LINK).dead()
    it = plate(DRAG_LINK, float(dead[0]) + off)
    results = results_of(it.problem(), "kinematics")
    assert results.driver_range.full
    near([d.place for d in results.dead], dead)


@pytest.mark.parametrize("kind", [DRAG_LINK, ROCKER])
def test_the_plate_goes_on_without_turning(kind):
    it, results = plate(kind), moved(kind)
    q = np.linspace(results.driver_range.start, results.driver_range.end, 400)
    motion = motion_at_positions(results, q)
    assert np.all(motion.moving)
    assert np.max(np.abs(motion.poses["3"].z - 1)) < 1e-11
    swung = [complex(mp.expj(it.swing(mp.mpf(float(x))) - it.swing(mp.mpf(it.at)))) for x in q]
    turned = motion.poses["4"].z / motion_at_positions(results, np.array([it.at])).poses["4"].z
    assert np.max(np.abs(turned - swung)) < 1e-11


def test_beside_a_dead_position_velocities_are_as_good_as_the_numbers_are():
    """At a distance h the last bit u of the numbers moves a place by u/h and a velocity by u/h^2.

    Nearer than some hundredths it is the last bit of extended precision, where the machine has it.
    """
    it = plate(DRAG_LINK)
    at = [float(q) + off for q in it.dead() for h in (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 2e-7) for off in (-h, h)]
    motion = results_of(it.problem(positions={"at": at}), "kinematics").motion
    assert np.all(motion.moving)
    for k, q in enumerate(at):
        exact = mp.diff(it.swing, mp.mpf(q))
        off = float(min(abs(q - dead) for dead in it.dead()))
        lost = 50 * float(np.finfo(np.longdouble).eps) / off if off < 5e-3 else float(np.finfo(float).eps) / off
        assert abs(motion.poses["3"].z[k] - 1) < 1e-15 + lost
        assert abs(motion.first["4"].w[k] - exact) < (1e-14 + lost / off) * abs(exact)


def test_a_position_in_a_dead_place_is_placed_and_dead():
    it = plate(DRAG_LINK)
    at = [float(q) for q in it.dead()]
    motion = results_of(it.problem(positions={"at": [*at, 0.3]}), "kinematics").motion
    assert np.all(motion.placed)
    assert list(motion.moving) == [False, False, True]
    assert np.max(np.abs(motion.poses["3"].z - 1)) < 1e-14
    for k, q in enumerate(at):
        C = complex(it.K + it.leg * mp.expj(it.swing(mp.mpf(q))))
        assert abs(motion.named("C").x[k] - C) < 1e-14


def test_a_plate_on_three_equal_rods_is_dead_where_all_come_into_line():
    """There its determinant only touches zero: crank and both rods are in line with the pivots at once."""
    it = Plate("0.2", "0.5", "0.2", ("0.3", "-0.2"), ("0.5", "0"), ("0.2", "0.2"), 0.7)
    results = results_of(it.problem(), "kinematics")
    assert results.driver_range.full
    near([d.place for d in results.dead], [mp.mpf(0), mp.pi])
    motion = motion_at_positions(results, np.linspace(-0.3, 3.4, 300))
    assert np.all(motion.moving)
    assert np.max(np.abs(motion.poses["3"].z - 1)) < 1e-9


def test_a_symmetric_linkage_stays_symmetric_where_it_could_tilt():
    """Two cranks that turn against each other lift a plate by two rods; a point of it slides on the axis of symmetry.

    It is dead where the rods meet at the height of that point.
    """
    a, r, rod, half, drop, at = (mp.mpf(x) for x in ("0.3", "0.15", "0.5", "0.1", "0.6", "1"))

    def height(q):
        return r * mp.sin(q) + mp.sqrt(rod**2 - (r * mp.cos(q) - a + half) ** 2)

    def meets_above(q):
        """Height of the point of the plate over that where the rods' lines meet."""
        A, C = mp.mpc(r * mp.cos(q) - a, r * mp.sin(q)), mp.mpc(-half, height(q))
        return C.imag + drop - (C.imag + half * (C.imag - A.imag) / (C.real - A.real))

    A, y = (float(r * mp.cos(at) - a), float(r * mp.sin(at))), float(height(at))
    problem = {
        "tmm": 1,
        "units": SI,
        "points": {"O": [-0.3, 0], "Q": [0.3, 0]},
        "guides": {"y": {"through": [0, 0], "angle": float(mp.pi / 2)}},
        "links": {
            "1": {"points": ["O", "A"], "length": 0.15},
            "2": {"points": ["Q", "E"], "length": 0.15},
            "3": {"points": ["A", "C"], "length": 0.5},
            "4": {"points": ["E", "D"], "length": 0.5},
            "5": {"points": {"C": [-0.1, 0], "D": [0.1, 0], "B": [0, 0.6]}},
            "6": {"points": ["B"], "slides": {"on": "y"}},
        },
        "driver": [{"link": "1", "speed": 1}, {"link": "2", "speed": 1, "turns": "cw", "at": float(mp.pi - at)}],
        "sketch": {"at": 1, "A": A, "E": [-A[0], A[1]], "C": [-0.1, y], "D": [0.1, y], "B": [0, y + 0.6]},
    }
    results = results_of(problem, "kinematics")
    assert results.driver_range.full
    exact = mp.findroot(meets_above, mp.mpf("0.66"))
    near([d.place for d in results.dead], [exact, -exact])
    motion = motion_at_positions(results, np.linspace(-0.9, 0.9, 100))
    assert np.max(np.abs(motion.poses["5"].z - 1)) < 1e-11


def folds(it, longer):
    """Equations of the plate, at x + iy and turned by t, on rods from A, K, L: their lengths, and that they meet."""

    def turned(v, t):
        return v.real * mp.cos(t) - v.imag * mp.sin(t), v.real * mp.sin(t) + v.imag * mp.cos(t)

    def equations(x, y, t, q):
        A = (it.crank * mp.cos(q), it.crank * mp.sin(q))
        L = it.K + it.KL
        rods = ((it.CB, A, it.rod), (mp.mpc(0), (it.K.real, it.K.imag), it.leg))
        rods = (*rods, (it.KL, (L.real, L.imag), it.leg + mp.mpf(longer)))
        lengths, rows = [], []
        for point, pivot, length in rods:
            ax, ay = turned(point, t)
            dx, dy = x + ax - pivot[0], y + ay - pivot[1]
            lengths.append(dx**2 + dy**2 - length**2)
            rows.append([dx, dy, ax * dy - ay * dx])
        return (*lengths, mp.det(mp.matrix(rows)))

    return equations


@pytest.mark.parametrize("longer", [1e-6, -1e-4])
def test_with_a_rod_that_is_longer_the_driver_turns_back(longer):
    """However little it is: what was a dead position to pass is a gap then, as wide as the root of the difference."""
    it = plate(DRAG_LINK)
    results = results_of(it.problem(longer), "kinematics")
    assert not results.driver_range.full
    assert results.dead == ()
    for limit, inside in zip(sorted(x.place for x in results.driver_range.limits), (1, -1), strict=True):
        pose = motion_at_positions(results, np.array([limit + 1e-7 * inside])).poses["3"]
        start = (pose.x[0].real, pose.x[0].imag, np.angle(pose.z[0]), limit)
        root = mp.findroot(folds(it, longer), tuple(mp.mpf(float(v)) for v in start))
        near([limit], [root[3]])


def test_the_reader_is_told_that_the_motion_goes_on_smoothly():
    results = moved(DRAG_LINK)
    said = [line for line in collect_warnings(results) if "dead position" in line]
    assert len(said) == 2
    assert all(results.dead[0].group in line and "smooth" in line for line in said)
