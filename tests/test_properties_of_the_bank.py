"""Numbers that files of the bank show, computed from their dimensions by circles, lines and virtual work in 40 digits.

Nothing of the calculator is used to find them: points are met by circles, velocities and accelerations are differences
in 40 digits, moments follow from virtual work. Dimensions are written out here, in mm and degrees, as in the files.
"""

from __future__ import annotations

import re
from itertools import pairwise
from typing import get_args, get_origin

import mpmath as mp
import numpy as np
import pytest
import yaml
from models import PROBLEMS
from mpmath import arg, conj, cos, mpf, pi, sin, sqrt
from pydantic import BaseModel

from tmm_cli import load, solve
from tmm_cli.problem import File, SpatialFile, read_text
from tmm_cli.reports import shown_properties

mp.mp.dps = 40
STEP = mpf(10) ** -12  # of differences: what they miss is below 1e-20
DEG = pi / 180
G = mpf("9.81")
MM = mpf(1) / 1000
NUMBER = r"-?\d+\.\d{6,}.*"  # of many digits: one that no formula of parameters gives


def polar(length, angle):
    return mp.mpc(length * cos(angle), length * sin(angle))


def meet(a, ra, b, rb, near):
    """Where circles meet, on the side of the line a-b on which `near` lies for the sketch points a0, b0."""
    a0, b0, shown = near
    side = 1 if (conj(b0 - a0) * (shown - a0)).imag > 0 else -1
    span = b - a
    along = (abs(span) ** 2 + ra**2 - rb**2) / (2 * abs(span))
    return a + span / abs(span) * mp.mpc(along, side * sqrt(ra**2 - along**2))


def slope(function, q):
    return (function(q + STEP) - function(q - STEP)) / (2 * STEP)


def bend(function, q):
    step = mpf(10) ** -10
    return (function(q + step) - 2 * function(q) + function(q - step)) / step**2


def angle_of(function):
    """The rate of the angle of a vector."""
    return lambda q: (slope(function, q) / function(q)).imag


def extremes(function, low, high, count=360):
    """Places and values of the least and the greatest value, between the ends or there; a turn is closed."""
    step, closed = (high - low) / count, abs(abs(high - low) - 2 * pi) < STEP
    grid = [low + (high - low) * mpf(k) / count for k in range(count + 1)]
    values = [function(q) for q in grid]
    found = []
    for pick in (min, max):
        k = values.index(pick(values))
        q = grid[k]
        ends = (q - step, q + step) if closed else (grid[max(k - 1, 0)], grid[min(k + 1, count)])
        if slope(function, ends[0]) * slope(function, ends[1]) < 0:
            q = mp.findroot(lambda x: slope(function, x), ends, solver="anderson", tol=1e-22)
        found.append((q, function(q)))
    return found


def stretch(function, low, high):
    (__, least), (__, greatest) = extremes(function, low, high)
    return greatest - least


def turned(function, start):
    """The angle of a vector, counted from that at a start, so that it does not jump."""
    return lambda q: arg(function(q) / function(start))


def start_of(function, low, *, sense, highest):
    """Where a stroke begins: at the greatest or the least place of the output in a turn from `low` on."""
    (least, __), (greatest, __) = extremes(function, low, low + sense * 2 * pi)
    return greatest if highest else least


# -- clamps, presses and toggles: force ratios are ratios of speeds


def clamp(at):
    a0, b0 = mp.mpc(80, -220), mp.mpc(78, -20)

    def x_of_e(s):
        b = meet(mp.mpc(80, s), 200, mp.mpc(0), 80, (a0, mp.mpc(0), b0))
        c = b / 80 * polar(60, 150 * DEG)
        return c.real + sqrt(160**2 - c.imag**2)

    return 1 / abs(slope(x_of_e, mpf(at)))


def toggle(o, oa, ab, c, cb, sketch, crank0=90 * DEG):
    """The knee B of a toggle by the crank's angle."""
    a0 = o + polar(oa, crank0)
    return lambda phi: meet(o + polar(oa, phi), ab, c, cb, (a0, c, sketch))


def toggle_press():
    knee = toggle(mp.mpc(-330, 130), 40, 286, mp.mpc(0, 300), 180, mp.mpc(-45, 125))

    def y_of_d(phi):
        b = knee(phi)
        return b.imag - sqrt(200**2 - b.real**2)

    begin = start_of(y_of_d, mpf(0), sense=-1, highest=True)
    return 40 / abs(slope(y_of_d, begin - 11 * 15 * DEG))


def toggle_rocker():
    knee = toggle(mp.mpc(-280, 143), 36, 240, mp.mpc(0, 320), 180, mp.mpc(-42, 145))
    b0, d, e0 = mp.mpc(-42, 145), mp.mpc(160, -47), mp.mpc(0, -39)

    def arm(phi):
        return meet(knee(phi), 190, d, 160, (b0, d, e0)) - d

    psi = turned(arm, mpf(0))
    (low, least), (high, greatest) = extremes(psi, mpf(0), -2 * pi)
    # the working stroke is the longer one of the clockwise crank
    begin, end = (low, high) if mp.fmod(low - high + 4 * pi, 2 * pi) > pi else (high, low)
    assert mp.fmod(begin - end + 4 * pi, 2 * pi) > pi
    gains = [36 / abs(slope(arm, begin - n * 15 * DEG)) for n in (6, 11)]
    return greatest - least, *gains


def bench_press(s):
    c, g, d = mp.mpc(150, -320), mp.mpc(-150, -230), mp.mpc(0)
    k0, a0, b0 = mp.mpc(114, -216), mp.mpc(98, -169), mp.mpc(146, -19)

    def e(s):
        k = meet(g, s, c, 110, (g, c, k0))
        a = c + (k - c) * mpf(160) / 110
        return -meet(a, 160, d, 150, (a0, d, b0)) * 60 / 150

    return 1 / abs(slope(e, mpf(s)))


def clamp_levers(s):
    b0, g = mp.mpc(-90, 0), mp.mpc(-90, 260)
    f, c0, k0 = mp.mpc(200, -50), mp.mpc(0, 60), mp.mpc(200, 60)

    def x_of_u(s):
        b = meet(g, s, mp.mpc(0), 90, (g, mp.mpc(0), b0))
        c = c0 * b / b0
        k = meet(c, 200, f, 110, (c0, f, k0))
        return (2 * f - k).real

    return 1 / slope(x_of_u, mpf(s))


# -- strokes, swings and ways


def double_stroke_press():
    d, b0, a0 = mp.mpc(-200, 420), mp.mpc(-150, 3), mp.mpc(50, 0)

    def y_of_e(phi):
        a = polar(50, phi)
        c = 2 * a - meet(a, 200, d, 420, (a0, d, b0))
        return c.imag - sqrt(420**2 - (c.real - 200) ** 2)

    return stretch(y_of_e, mpf(0), 2 * pi) / 100


def double_crank():
    d, a0, b0 = mp.mpc(50), mp.mpc(0, 120), mp.mpc(105, 85)
    ratio = angle_of(lambda phi: meet(polar(120, phi), 110, d, 100, (a0, d, b0)) - d)
    (__, least), (__, greatest) = extremes(ratio, mpf(0), 2 * pi)
    return greatest, least


def double_rocker():
    d, a0, b0 = mp.mpc(180), polar(160, 60 * DEG), mp.mpc(160, 138)

    def arm(phi):
        return meet(polar(160, phi), 90, d, 140, (a0, d, b0)) - d

    return stretch(turned(arm, 34 * DEG), 34 * DEG, 76 * DEG)


def ratchet_step(radius):
    def angle(x):
        f = mp.mpc(x, 80)
        return arg(meet(mp.mpc(0), radius, f, 320, (mp.mpc(0), mp.mpc(-320, 80), mp.mpc(0, 100))))

    return abs(angle(mpf("-397.6138276043")) - angle(mpf("-241.4402949608")))


def ratchet_return():
    b1 = mpf("38.666435427") * DEG

    def x_of_f(reach, angle):
        e = polar(reach, angle)
        return e.real - sqrt(320**2 - (e.imag - 80) ** 2)

    # on the rocker of 60 mm the crank of 12.5 mm points to the shaft at first and away from it after half a turn
    return x_of_f(60 + 12.5 + 52.5, b1 + 90 * DEG) - x_of_f(60 - 12.5 + 52.5, b1)


def hanger():
    q, e0, f0 = mp.mpc(-60, 150), mp.mpc(240, -60), mp.mpc(180, 60)

    def shelf(phi):  # of the parallelogram: it translates with A
        e = polar(200, phi) + mp.mpc(40, -60)
        return q + (meet(e, 130, q, 250, (e0, q, f0)) - q) / 250 * mp.mpc(420, -60)

    return abs(slope(shelf, mpf(0))) / 200


def zone(function, middle, most):
    """How far one goes about a place until a function differs from its value there by more than so much."""

    def missed(q):
        return abs(function(q) - function(middle)) - most

    ends = []
    for sign in (-1, 1):
        q = middle
        while missed(q + sign * DEG) < 0:
            q += sign * DEG
        ends.append(mp.findroot(missed, (q, q + sign * DEG), solver="anderson", tol=1e-20))
    return ends[1] - ends[0]


def planetary_dwell():
    b = 18 * DEG
    x, h = 100 * sin(b) + 10 * sin(4 * b), (100 * cos(b) - 10 * cos(4 * b)) - 90
    rod = (x**2 + h**2) / (2 * h)

    def y_of_d(phi):
        p = polar(100, phi) + polar(10, pi / 2 - 4 * (phi - pi / 2))  # the planet rotates four times as fast, backwards
        return p.imag - sqrt(rod**2 - p.real**2)

    return zone(y_of_d, 270 * DEG, mpf("0.2"))


def positioner(sketch):
    f, c0 = mp.mpc(0, -200), mp.mpc(73, 34)

    def jaw(s):
        bell = pi - mp.acos((250**2 + 150**2 - s**2) / (2 * 250 * 150))  # of OB, from the line O-G
        return meet(polar(80, bell - pi / 2), 190, f, 100, (c0, f, sketch)) - f

    return turned(jaw, mpf(240))(mpf(270))


def claw():
    d, a0, b0 = mp.mpc(0, 29), mp.mpc(9), mp.mpc(22, 19)

    def k(phi):
        a = polar(9, phi)
        return a + (meet(a, 23, d, 24, (a0, d, b0)) - a) / 23 * mp.mpc(2.5, 19)

    def x_of_k(phi):
        return k(phi).real

    pulled = (k(4 * DEG) - k(101 * DEG)).imag
    return pulled * MM, zone(x_of_k, 28 * DEG, mpf("0.35")), stretch(x_of_k, mpf(0), 2 * pi) * MM


def spring_return_rod(load):
    """Moment of the lever on the rod by virtual work, with the crank held: what the load and the spring do."""
    d, a0, b0 = mp.mpc(-230, -140), mp.mpc(0, 40), mp.mpc(-205, 8)
    u0, v0, t0 = mp.mpc(-167, -337), mp.mpc(-123, -262), mp.mpc(-90, -296)

    def potential(phi, s):
        rocker = (meet(polar(40, phi), 220, d, 150, (a0, d, b0)) - d) / 150
        c, p = d + rocker * -90j, d + rocker * mp.mpc(30, -110)
        both = 200 + polar(90, s)  # from C to the slider, as the rod lies
        rod = polar(1, -mp.acos((-230 - c.real) / abs(both)) - arg(both))
        x, v = c + 200 * rod, c + mp.mpc(90, 60) * rod
        t = meet(x + 60j * rod * polar(1, s), 95, v, 60, (u0, v0, t0))
        q = v + (t - v) / 60j * mp.mpc(-50, 30)
        return 60 * (abs(q - p) - 190) ** 2 / 2 - load * (c + both * rod).imag

    def moment(phi):
        return slope(lambda s: potential(phi, s), 20 * DEG) * MM

    return [value for __, value in extremes(moment, mpf(0), 2 * pi, 90)]


def press_class_iii():
    g, f = mp.mpc(480, -85), mp.mpc(585, -240)

    def turn_of_lever(phi, near):
        a = polar(85, phi)

        def missed(theta):
            c = a + mp.mpc(200, 110) * polar(1, theta)
            e = c + 310 * (g - c) / abs(g - c)
            return abs(e - f) - 270

        return mp.findroot(missed, near)

    starts = {0: turn_of_lever(pi / 2, mpf(0))}  # by steps of 6 deg from the sketch
    for sign in (-1, 1):
        for k in range(1, 80):
            starts[sign * k] = turn_of_lever(pi / 2 + sign * k * 6 * DEG, starts[sign * (k - 1)])

    def y_of_d(phi):
        near = starts[int(mp.nint((phi - pi / 2) / (6 * DEG)))]
        b = polar(85, phi) + mp.mpc(100, -170) * polar(1, turn_of_lever(phi, near))
        return b.imag - sqrt(420**2 - (b.real + 40) ** 2)

    begin = start_of(y_of_d, mpf(0), sense=1, highest=True)
    return zone(lambda q: slope(y_of_d, q) * 40 * pi / 30, begin + 75 * DEG, mpf("0.04") * mpf("298.5"))


def adjustable_stroke(setting):
    c, place = mp.mpc(240, 230), (setting - 20) * DEG
    a0, b0 = polar(40, place), polar(300, place)

    def x_of_e(phi):
        b = meet(polar(40, phi), 260, c, abs(b0 - c), (a0, c, b0))
        d = c + 150j * (b - c) / (b0 - c)
        return d.real - sqrt(250**2 - (400 - d.imag) ** 2)

    return stretch(x_of_e, mpf(0), 2 * pi)


def breaking_rod():
    e, a0, x0 = mp.mpc(0, -340), mp.mpc(0, 60), mp.mpc(25, -130)
    first, second = abs(mp.mpc(190, 25)), abs(mp.mpc(210, 25))

    def elbow(phi):
        return meet(polar(60, phi), first, e, second, (a0, e, x0))

    def driving(phi):
        return elbow(phi) - polar(60, phi)

    swings = [turned(function, mpf(0)) for function in (driving, lambda phi: e - elbow(phi))]
    return [stretch(swing, mpf(0), 2 * pi) for swing in swings]


def initial_position(rod):
    c, a0, b0 = mp.mpc(160, 215), mp.mpc(20), mp.mpc(30, 215)

    def y_of_k(phi):
        b = meet(polar(20, phi), rod, c, 130, (a0, c, b0))
        return (c - (b - c) * 100 / 130).imag + 15

    (__, least), (__, greatest) = extremes(y_of_k, mpf(0), 2 * pi)
    return least, greatest - least


def safety_rod():
    d, a0, b0 = mp.mpc(-230, -140), mp.mpc(0, 40), mp.mpc(-205, 8)
    e, c0, x0 = mp.mpc(-230, -425), mp.mpc(-140, -155), mp.mpc(-237, -246)

    def pin(phi):
        b = meet(polar(40, phi), 220, d, 150, (a0, d, b0))
        return d + (b - d) / 150 * -90j

    def part(phi):
        c = pin(phi)
        return meet(c, 140, e, 180, (c0, e, x0)) - c

    return stretch(turned(part, mpf(0)), mpf(0), 2 * pi)


def coriolis():
    def reach(phi):
        return polar(100, phi) + 300j

    phi = -mp.asin(mpf(1) / 3) + 90 * DEG  # the slower stroke begins where the crank stands square to the slotted link
    turning = angle_of(reach)(phi) * 8
    running = slope(lambda q: abs(reach(q)), phi) * 8
    return abs(2 * turning * running)


def cam_coupler():
    """Swing of the rocker whose coupler a cam makes 150 to 168 mm long: Newton on a grid, then in 40 digits."""

    def length(turn):
        x = turn / DEG - 20 - 360 * mp.floor((turn / DEG - 20) / 360)
        if x < 100:
            x /= 100
            return 150 + 18 * (10 * x**3 - 15 * x**4 + 6 * x**5)
        x = (x - 180) / 100
        return mpf(168) if x < 0 else 168 - 18 * (x - mp.sin(2 * pi * x) / (2 * pi)) if x < 1 else mpf(150)

    near = {"theta": mpf(0.4)}

    def psi(phi):
        def b(theta):
            return polar(50, phi) + polar(length(phi - theta), theta) - mp.mpc(170, -20)

        theta = mp.findroot(lambda t: abs(b(t)) ** 2 - 120**2, near["theta"], tol=1e-30)
        near["theta"] = theta
        return mp.arg(b(theta))

    phi = np.linspace(0, 2 * np.pi, 241)
    angles = [psi(mpf(float(q))) for q in phi]
    found = []
    for pick in (np.argmax, np.argmin):
        k = int(pick(np.array(angles, dtype=float)))
        near["theta"] = mpf(0.4)
        psi(mpf(float(phi[k])))
        q = mp.findroot(
            lambda q: slope(psi, q),
            (mpf(float(phi[k - 1])), mpf(float(phi[(k + 1) % 240]))),
            solver="secant",
            tol=1e-18,
        )
        found.append(psi(q))
    return found[0] - found[1]


def summing_lever():
    """Extremes of the slider's run over three turns of crank 1: Newton on a grid, then in 40 digits."""

    def missed(phi, y, alpha):
        a, b = polar(25, phi), 100 + polar(30, pi - 2 * phi / 3)
        e, arm = mp.mpc(50, y), polar(50, alpha)
        return abs(e - arm - a) ** 2 - 250**2, abs(e + arm - b) ** 2 - 250**2

    near = {"y": mpf(250), "alpha": mpf(0)}

    def y_of_e(phi):
        y, alpha = mp.findroot(lambda y, alpha: missed(phi, y, alpha), (near["y"], near["alpha"]), tol=1e-30)
        near.update(y=y, alpha=alpha)
        return y

    phi = np.linspace(0, 6 * np.pi, 181)
    y = [y_of_e(mpf(float(q))) for q in phi]
    found = []
    for pick in (np.argmax, np.argmin):
        k = int(pick(np.array(y, dtype=float)))
        near.update(y=y[k], alpha=mpf(0))
        q = mp.findroot(
            lambda q: slope(y_of_e, q), (mpf(float(phi[k - 1])), mpf(float(phi[k + 1]))), solver="anderson", tol=1e-18
        )
        found.append(y_of_e(q))
    return found


# -- forces: virtual work, and the rod and the slider cut free


def shaping(lengths, position, masses, load, rpm, *, working_up):
    """Balancing moment and guide reaction of a slotted lever that drives a slider, at a position of 30 deg each.

    lengths: crank OA, pivot C of the slotted link, CD, rod DE (None: the slider goes with D along its guide), and a
    point of the guide with its unit vector. masses: (kg, share of OA), (kg, kg m2), (kg, kg m2, share of CD), (kg, kg
    m2, share of DE), kg. Where on the slider its load and weight act is nothing to the sizes of forces.
    """
    crank, c, lever, rod, (origin, along) = lengths

    def d(phi):
        a = polar(crank, phi)
        return c + lever * (a - c) / abs(a - c)

    def e(phi):
        tip = d(phi)
        if rod is None:
            return origin + along * ((tip - origin) * conj(along)).real
        off = ((tip - origin) * conj(along)).imag
        return origin + along * (((tip - origin) * conj(along)).real + sqrt(rod**2 - off**2))

    def run(phi):
        return ((e(phi) - origin) * conj(along)).real

    omega, sense = rpm * pi / 30, 1 if rpm > 0 else -1
    begin = start_of(run, mpf(0), sense=sense, highest=not working_up)
    phi = begin + sense * position * 30 * DEG

    def direction(phi):
        return (polar(crank, phi) - c) / abs(polar(crank, phi) - c)

    def rod_direction(phi):
        return (e(phi) - d(phi)) / rod

    (m1, s1), (m2, j2), (m3, j3, s3), (m4, j4, s4), m5 = masses
    centres = [
        (m1, lambda q: polar(crank * s1, q)),
        (m2, lambda q: polar(crank, q)),
        (m3, lambda q: c + s3 * (d(q) - c)),
        (m4, (lambda q: d(q) + s4 * (e(q) - d(q))) if rod is not None else d),
        (m5, e),
    ]
    moment = mpf(0)
    for mass, centre in centres:
        way, acceleration = slope(centre, phi) * MM, bend(centre, phi) * MM * omega**2
        moment += (mass * (acceleration + 1j * G) * conj(way)).real
    couples = [(j2 + j3, direction)] + ([(j4, rod_direction)] if rod is not None else [])
    for inertia, vector in couples:
        rate = angle_of(vector)
        moment += inertia * slope(rate, phi) * omega**2 * rate(phi)
    moment -= (load * conj(slope(e, phi) * MM)).real

    # the slider along the guide, the rod about D
    pull = m5 * (bend(e, phi) * MM * omega**2 + 1j * G) - load  # what the rod and the guide give together
    if rod is None:
        return moment, abs((pull * conj(along)).imag)
    middle = centres[3][1]
    inertia_force = m4 * (bend(middle, phi) * MM * omega**2 + 1j * G)
    arm, tip = (middle(phi) - d(phi)) * MM, (e(phi) - d(phi)) * MM
    couple = j4 * slope(angle_of(rod_direction), phi) * omega**2 + (conj(arm) * inertia_force).imag
    # about D: tip x R = couple, where R is the slider's force on the rod; its component along the guide is known
    drawn = -(pull * conj(along)).real
    normal = along * 1j
    across = (couple - (conj(tip) * along * drawn).imag) / (conj(tip) * normal).imag
    return moment, abs((pull * conj(along)).imag + across)


COURSE = {
    # lengths; position; masses; load along the guide, N; rpm, below zero clockwise
    1: ((100, -300j, 600, 250, (270j, 1)), 3, ((1, 0.5), (0.6, 0.0004), (8, 0.3, 0.5), (3, 0.02, 0.45), 40), 1200, 76),
    2: ((90, -280j, 560, None, (270j, 1)), 2, ((1.2, 0.4), (0.7, 5e-4), (9, 0.28, 0.5), (0.9, 0, 0), 35), 900, 90),
    3: (
        (110, -400, 680, 300, (260, 1j)),
        4,
        ((1.5, 0.4), (0.8, 6e-4), (10, 0.42, 0.5), (3.5, 0.03, 0.5), 28),
        -1500j,
        70,
    ),
    4: (
        (105, 330j, 620, 240, (-265j, 1)),
        3,
        ((1.4, 0.5), (0.6, 4e-4), (8.5, 0.31, 0.55), (2.8, 0.018, 0.5), 38),
        1300,
        -85,
    ),
}


def course(number):
    """The working stroke, against Q, begins at the right end of a level guide, below on a vertical one."""
    return shaping(*COURSE[number], working_up=number == 3)


def engine():
    """Pistons at 0.04 m on rods without mass: gas by a table against the crank's angle from the first dead centre."""
    rows = [(0, 0), (90, 0), (100, 9000), (120, 7000), (180, 2000), (250, 400), (270, 0), (360, 0)]

    def piston(q):
        return sin(q) * mpf("0.04") + sqrt(mpf("0.14") ** 2 - (mpf("0.04") * cos(q)) ** 2)

    def torque(q, low, high):
        moment = mpf(0)
        for shift in (0, pi, pi, 0):
            way = slope(piston, q + shift)
            moment += mpf("0.6") * (bend(piston, q + shift) * (100 * pi) ** 2 + G) * way
        (x0, f0), (x1, f1) = low, high
        return moment + (f0 + (f1 - f0) * (q / DEG - x0) / (x1 - x0)) * slope(piston, q)

    found = []
    for low, high in pairwise(rows):
        ends = extremes(lambda q, low=low, high=high: torque(q, low, high), low[0] * DEG, high[0] * DEG, 30)
        found += [value for __, value in ends]
    return max(found), min(found)


def v_compressor():
    """Forces of the crank pin on both rods at 345 deg, and on both together: rod and piston in equilibrium."""
    phi, r, rod, omega = 345 * DEG, mpf("0.045"), mpf("0.18"), 980 * pi / 30
    rows = [(mpf(0), mpf(0)), (mpf("0.04"), mpf("0.08")), (mpf("0.065"), mpf("0.5")), (mpf("0.09"), mpf("0.5"))]

    def pin(q):
        return polar(r, q)

    def force_on_rod(guide):
        along = polar(1, guide)

        def piston(q):
            across = (pin(q) / along).imag
            return along * ((pin(q) / along).real + sqrt(rod**2 - across**2))

        def centre(q):
            return pin(q) + mpf("0.33") * (piston(q) - pin(q))

        run = abs(piston(phi)) - (rod - r)
        (x0, p0), (x1, p1) = next((low, high) for low, high in pairwise(rows) if low[0] <= run <= high[0])
        gas = (p0 + (p1 - p0) * (run - x0) / (x1 - x0)) * 10**6 * pi * mpf("0.11") ** 2 / 4
        on_piston = (-gas * along - mpf("2.2") * (bend(piston, phi) * omega**2 + mp.mpc(0, G))) / along
        reach = piston(phi) - pin(phi)
        on_rod = -mpf("1.8") * (bend(centre, phi) * omega**2 + mp.mpc(0, G))
        couple = -mpf("0.008") * slope(angle_of(lambda q: piston(q) - pin(q)), phi) * omega**2
        moment = couple + (conj(centre(phi) - pin(phi)) * on_rod).imag
        lever = conj(reach) * along
        across = -(moment + on_piston.real * lever.imag) / lever.real
        return -(mp.mpc(on_piston.real, across) * along) - on_rod

    forces = force_on_rod(45 * DEG), force_on_rod(135 * DEG)
    return [abs(force) for force in (*forces, sum(forces))]


NUMBERS = {
    "cam-coupler": lambda: [cam_coupler()],
    "clamp": lambda: [clamp(-200), clamp(-185)],
    "course-1": lambda: course(1),
    "course-2": lambda: course(2),
    "course-3": lambda: course(3),
    "course-4": lambda: course(4),
    "cranks/double-stroke-press": lambda: [double_stroke_press()],
    "cranks/toggle-rocker": toggle_rocker,
    "double-crank": double_crank,
    "engine-four": engine,
    "four-bars/claw": claw,
    "four-bars/bench-press": lambda: [bench_press(246), bench_press(293)],
    "four-bars/clamp-levers": lambda: [clamp_levers(276), clamp_levers(244)],
    "four-bars/double-rocker": lambda: [double_rocker()],
    "gear-lever/ratchet-feed": lambda: [ratchet_step(100), ratchet_step(125)],
    "gear-lever/ratchet-return": lambda: [ratchet_return() * MM],
    "hanger": lambda: [hanger()],
    "planetary-dwell-press": lambda: [planetary_dwell()],
    "positioner": lambda: [positioner(mp.mpc(94, -165)), positioner(mp.mpc(-53, -115))],
    "press-class-iii": lambda: [press_class_iii()],
    "settings/adjustable-lever": lambda: [adjustable_stroke(mpf(a)) * MM for a in (0, 20, 40)],
    "settings/breaking-rod-open": breaking_rod,
    "settings/initial-position": lambda: [
        initial_position(rod)[k] * MM for k, rod in ((0, 206), (0, 210), (0, 214), (1, 206), (1, 214))
    ],
    "settings/safety-rod-broken": lambda: [safety_rod()],
    "settings/spring-return-rod": lambda: [spring_return_rod(2000)[0], spring_return_rod(4000)[1]],
    "slotted-lever": lambda: [coriolis() * MM],
    "summing-lever": lambda: [run * MM for run in summing_lever()],
    "toggle-press": lambda: [toggle_press()],
    "v-compressor": v_compressor,
}
"""By file, in the order of its block `shows`, those whose `expected` is a plain number; SI, radians."""


@pytest.mark.parametrize("name", NUMBERS)
def test_a_number_that_a_file_shows_is_that_of_its_dimensions(name):
    path = PROBLEMS / f"{name}.yaml"
    blocks = yaml.safe_load(path.read_text(encoding="utf-8"))["shows"]
    numbers = [key for key, block in blocks.items() if re.fullmatch(NUMBER, str(block["expected"]))]
    shown = {one.name: one for one in shown_properties(solve(load(path)))}
    right = [float(number) for number in NUMBERS[name]()]
    assert [shown[key].expected for key in numbers] == pytest.approx(right, rel=1e-11)
    assert [shown[key].value for key in numbers] == pytest.approx(right, rel=1e-10)


def test_every_property_of_the_bank_has_an_expected_value():
    texts = {path.name: path.read_text(encoding="utf-8") for path in PROBLEMS.rglob("*.yaml")}
    blocks = {name: yaml.safe_load(text)["shows"] for name, text in texts.items() if re.search(r"^shows:", text, re.M)}
    assert len(blocks) > 40
    assert not [f"{name}: {key}" for name, shows in blocks.items() for key in shows if "expected" not in shows[key]]


def models_in(kind):
    """The pydantic models that an annotation names."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        yield kind
    for inner in get_args(kind):
        yield from models_in(inner)


def blocks_used(data, kind):
    """Blocks (model and, at the top of a file, key) that a file or a part of it uses."""
    if isinstance(data, list):
        for value in data:
            yield from blocks_used(value, kind)
    if not isinstance(data, dict):
        return
    for model in models_in(kind):
        fields = {one.alias or name: one.annotation for name, one in model.model_fields.items()}
        if get_origin(kind) is not dict and data.keys() <= fields.keys():
            yield model.__name__
            for key, value in data.items():
                if model in TOP:
                    yield key
                yield from blocks_used(value, fields[key])
        elif get_origin(kind) is dict:
            for value in data.values():
                yield from blocks_used(value, model)


def all_blocks(model, seen):
    seen.add(model)
    for one in model.model_fields.values():
        for inner in models_in(one.annotation):
            if inner not in seen:
                all_blocks(inner, seen)
    return seen


TOP = (File, SpatialFile)


def test_every_block_of_the_format_is_in_the_bank():
    """So every command meets it on every file of the bank: friction, which none had, ended --digits."""
    used = set()
    for path in [*PROBLEMS.glob("*.yaml"), *PROBLEMS.glob("*/*.yaml"), *PROBLEMS.glob("grading/*/task.yaml")]:
        data = read_text(path.read_text(encoding="utf-8"), path.name).data
        used.update(blocks_used(data, SpatialFile if "structure" in data else File))
    there = {model.__name__ for top in TOP for model in all_blocks(top, set())}
    keys = {one.alias or name for top in TOP for name, one in top.model_fields.items()}
    assert sorted((there | keys) - used) == []
