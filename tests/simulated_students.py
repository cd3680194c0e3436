"""Simulated students: a crank shaper and a six-bar solved by loop equations and Newton-Euler, with typical mistakes.

It shares no code with the product, so a mistake here is what a student does in the work, not what a model of the
product says. Vectors are complex numbers, all values are SI, each array has one entry per position.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

G = 9.81
SIGMA, CUT, DIGITS = 0.01, 2.5, 4  # of the largest value in the cycle; standard deviations; significant figures
TURN = np.radians(30) * np.arange(12)


def cross(a, b):
    return np.imag(np.conj(a) * b)


def dot(a, b):
    return np.real(np.conj(a) * b)


@dataclass(frozen=True)
class Work:
    """How a student works.

    Attributes:
        mistake: identifier of a typical mistake, with the link after a colon; "" for none.
        factor: factor of a mistake by a factor (crank speed, scale of a plan).
        slips: wrong intermediate results: factors by name.
    """

    mistake: str = ""
    factor: float = 1.0
    slips: dict[str, float] = field(default_factory=dict)

    def has(self, *names):
        return self.mistake in names

    def slip(self, name, value):
        return value * self.slips.get(name, 1.0)

    def scale(self, plan):
        """Factor of all values that are read from a plan."""
        return self.factor if self.mistake == f"scale-inverted:{plan}" else 1.0

    def speed(self, rpm):
        omega = self.slip("omega_1", rpm * 2 * np.pi / 60)
        omega = omega * self.factor if self.has("crank-speed") else omega
        return -omega if self.has("sense", "sense-own-zero", "sense-counted") else omega

    def angles(self, start, slow):
        """Crank angles of the 12 positions; the working stroke begins at `start` and lasts for `slow`, rad."""
        starts = {"other-extreme": start + slow, "sense-own-zero": start + slow, "x-axis-zero": 0.0}
        way = -TURN if self.has("sense-own-zero", "sense-counted") else TURN
        q = starts.get(self.mistake, start) + way
        return np.degrees(np.remainder(q[0], 2 * np.pi) + TURN) if self.has("degrees-in-sine") else q

    def load(self, force, q, start, slow):
        working = np.remainder(q - start, 2 * np.pi) < slow
        if self.has("load-wrong-stroke"):
            working = ~working
        working = working | self.has("load-both-strokes")
        factor = {"load-left-out": 0.0, "load-reversed": -1.0}.get(self.mistake, 1.0)
        return force * working * factor

    def inertia(self, link, mass, a, moment, epsilon, arm=0.0):
        """Force (inertia and weight) and inertia couple of a link; arm: from its hinge to the centre of mass."""
        force, couple, weight = -mass * a, -moment * epsilon, -1j * mass * G
        if self.has("inertia-left-out", f"inertia-left-out:{link}"):
            force = force * 0
        if self.has("couple-left-out", f"couple-left-out:{link}"):
            couple = couple * 0
        if self.has("inertia-reversed"):
            force, couple = -force, -couple
        if self.has("hinge-inertia", f"hinge-inertia:{link}"):
            couple = couple - mass * abs(arm) ** 2 * epsilon
        if self.has("weight-for-mass"):
            force = force * G
        if self.has("weight-left-out", f"weight-left-out:{link}"):
            weight = 0.0
        if self.has("mass-for-weight"):
            weight = -1j * mass
        return force + weight + 0 * a, couple


SHAPER_ASKED = """
variants: {OA: {from: 95, to: 120, step: 1}, n1: {from: 70 rpm, to: 95 rpm, step: 1 rpm}}
grading:
  answers:
    - {of: H}
    - {of: k}
    - {of: omega of 3, at: [3, 8]}
    - {of: v of E, at: [3, 8]}
    - {of: epsilon of 3, at: [3, 8]}
    - {of: a of E, at: [3, 8]}
    - {of: R_34, at: [3, 8]}
    - {of: R_03, at: [3, 8]}
    - {of: M_b, at: [3, 8]}
"""


def shaper(OA, n1, work=Work()):
    """Answers of problems/shaper.yaml over the cycle: crank OA, slotted link CD, rod DE, ram E."""
    OC, CD, DE, height = 0.35, 0.65, 0.21, 0.27
    OC, CD = OC * work.slips.get("length OC", 1), CD * work.slips.get("length CD", 1)
    height = -height if work.has("guide on the other side") else height
    start, slow = -np.arcsin(OA / OC), np.pi + 2 * np.arcsin(OA / OC)
    q, w = work.angles(start, slow), work.speed(n1)
    # positions
    A = OA * np.exp(1j * q)
    rho, u = np.abs(A + 1j * OC), (A + 1j * OC) / np.abs(A + 1j * OC)
    CDv = CD * u
    D = CDv - 1j * OC
    rise = height - D.imag
    run = np.sqrt(DE**2 - rise**2) * (-1 if work.has("mirror:4, 5") else 1)
    DEv = run + 1j * rise
    # velocities
    K = work.scale("velocities")
    vA = work.slip("v_A", 1j * w * A)
    omega3 = work.slip("omega_3", K * dot(1j * u, vA) / rho)
    sliding = work.slip("v_A3A2", K * dot(u, vA))
    vD = work.slip("v_D", 1j * omega3 * CDv)
    omega4 = -vD.imag / run
    vE = work.slip("v_E", vD.real - omega4 * rise)
    vE = np.abs(vD) if work.has("projection left out") else vE
    # accelerations
    K = work.scale("accelerations")
    aA = work.slip("a_A", -(w**2) * A * (0 if work.has("normal-left-out:1") else 1))
    coriolis = work.slip("coriolis", 2 * omega3 * sliding)
    coriolis = coriolis * {"coriolis-left-out": 0, "coriolis-reversed": -1}.get(work.mistake, 1)
    epsilon3 = work.slip("epsilon_3", (dot(1j * u, aA) - coriolis) / rho)
    epsilon3 = epsilon3 * {"tangential-left-out:3": 0, "epsilon reversed": -1}.get(work.mistake, 1)
    normal3 = work.slip("a_D^n", -(omega3**2) * CDv * (0 if work.has("normal-left-out:3") else 1))
    normal4 = work.slip("a_ED^n", -(omega4**2) * DEv * (0 if work.has("normal-left-out:4") else 1))
    aD = 1j * epsilon3 * CDv + normal3
    epsilon4 = -(aD + normal4).imag / run * (0 if work.has("tangential-left-out:4") else 1)
    aE = work.slip("a_E", (aD + normal4).real - epsilon4 * rise)
    aE = aD.real if work.has("rod left out") else aE
    aE = aE * K
    aS3 = 0.5 * K * aD * (2 if work.has("centre-at-hinge:3") else 1)
    aS4 = K * (aD + 0.5 * (1j * epsilon4 * DEv + normal4))
    epsilon3, epsilon4 = K * epsilon3, K * epsilon4
    # forces
    CS3 = CDv * (1 if work.has("centre-at-hinge:3") else 0.5)
    DS4 = 0.5 * DEv
    if work.has("centre-at-hinge:4"):
        DS4, aS4 = 0 * DEv, aD * K
    m5 = 52 * work.slips.get("mass of 5", 1)
    P1, _ = work.inertia("1", 6, 0.3 * aA, 0.012, 0 * q)
    P2, M2 = work.inertia("2", 1.5, aA, 0.001, epsilon3)
    P3, M3 = work.inertia("3", 22, aS3, 1.1, epsilon3, 0.5 * CD)
    P4, M4 = work.inertia("4", 6, aS4, 0.03, epsilon4, 0.5 * DE)
    P5, _ = work.inertia("5", m5, aE + 0j, 0.9, 0 * q)
    P5 = P5 + work.load(1500, q, start, slow)
    K = work.scale("forces")
    N5 = -(M4 + cross(DS4, P4) + cross(DEv, P5)) / run
    R34 = work.slip("R_34", -(P4 + P5 + 1j * N5)) * K
    onto3 = R34 if work.has("reaction-unreversed:34") else -R34
    S23 = -(M3 + M2 + cross(CS3, P3) + cross(CDv, onto3)) / rho
    Q23 = work.slip("R_23", 1j * u * S23)
    R03 = -(P3 + onto3 + Q23) * K
    back = -Q23 if work.has("reaction-unreversed:23") else Q23
    R12 = work.slip("R_12", (back - P2) * K)
    onto1 = R12 if work.has("reaction-unreversed:12") else -R12
    M = -cross(0.3 * A, P1) - cross(A, onto1)
    M = np.abs(R12) * OA if work.has("arm left out") else M
    ends = np.abs(2 * CD * OA / OC)
    R34 = -R34 if work.has("opposite-reaction") else R34
    R03 = -R03 if work.has("opposite-reaction") else R03
    return {
        "H": np.full(12, ends),
        "k": np.full(12, slow / (2 * np.pi - slow)),
        "omega of 3": omega3,
        "v of E": vE + 0j,
        "epsilon of 3": epsilon3,
        "a of E": aE + 0j,
        "R_34": R34,
        "R_03": R03,
        "M_b": M,
    }


SIX_BAR_ASKED = """
variants: {OA: {from: 90, to: 110, step: 1}, n1: {from: 80 rpm, to: 110 rpm, step: 1 rpm}}
grading:
  answers:
    - {of: k}
    - {of: omega of 3, at: [4, 8]}
    - {of: v of F, at: [4, 8]}
    - {of: epsilon of 3, at: [4, 8]}
    - {of: a of F, at: [4, 8]}
    - {of: R_45, at: [4, 8]}
    - {of: R_03, at: [4, 8]}
    - {of: M_b, at: [4, 8]}
"""


def six_bar(OA, n1, work=Work()):
    """Answers of problems/six-bar.yaml over the cycle: crank OA, coupler AB, rocker DB, rod BF, slider F."""
    AB, BD, BF, OD, height = 0.35, 0.25, 0.45, 0.4, 0.2
    AB, BD = AB * work.slips.get("length AB", 1), BD * work.slips.get("length BD", 1)
    height = -height if work.has("guide on the other side") else height
    dead = [np.arccos((c**2 + OD**2 - BD**2) / (2 * c * OD)) for c in (AB - OA, AB + OA)]
    start, end = dead[1], dead[0] + np.pi
    slow = np.remainder(end - start, 2 * np.pi)
    if slow < np.pi:
        start, slow = end, 2 * np.pi - slow
    q, w = work.angles(start, slow), work.speed(n1)
    # positions
    A = OA * np.exp(1j * q)
    AD = OD - A
    along = (np.abs(AD) ** 2 + AB**2 - BD**2) / (2 * np.abs(AD))
    across = np.sqrt(AB**2 - along**2) * (-1 if work.has("mirror:2, 3") else 1)
    ABv = (along + 1j * across) * AD / np.abs(AD)
    DBv = ABv - AD
    rise = height - (A + ABv).imag
    run = np.sqrt(BF**2 - rise**2) * (-1 if work.has("mirror:4, 5") else 1)
    BFv = run + 1j * rise
    # velocities
    K = work.scale("velocities")
    vA = work.slip("v_A", 1j * w * A)
    det = cross(ABv, DBv)
    omega2 = -K * dot(vA, DBv) / det
    omega3 = work.slip("omega_3", -K * dot(vA, ABv) / det)
    vB = work.slip("v_B", 1j * omega3 * DBv)
    omega4 = -vB.imag / run
    vF = work.slip("v_F", vB.real - omega4 * rise)
    vF = np.abs(vB) if work.has("projection left out") else vF
    # accelerations: a_A + n_BA + t_BA = n_BD + t_BD
    K = work.scale("accelerations")
    aA = work.slip("a_A", -(w**2) * A * (0 if work.has("normal-left-out:1") else 1))
    n2 = work.slip("a_BA^n", -(omega2**2) * ABv * (0 if work.has("normal-left-out:2") else 1))
    n3 = work.slip("a_BD^n", -(omega3**2) * DBv * (0 if work.has("normal-left-out:3") else 1))
    rest = n3 - n2 - aA
    epsilon2 = dot(rest, DBv) / det
    epsilon3 = work.slip("epsilon_3", dot(rest, ABv) / det)
    epsilon3 = -epsilon3 if work.has("epsilon reversed") else epsilon3
    aB = 1j * epsilon3 * DBv + n3
    if work.has("tangential-left-out:2"):  # projected on the tangent of the rocker
        epsilon2 = 0 * q
        epsilon3 = dot(1j * DBv, aA + n2) / BD**2
        aB = 1j * epsilon3 * DBv + n3
    if work.has("tangential-left-out:3"):
        epsilon3 = 0 * q
        aB = n3
    n4 = work.slip("a_FB^n", -(omega4**2) * BFv * (0 if work.has("normal-left-out:4") else 1))
    epsilon4 = -(aB + n4).imag / run * (0 if work.has("tangential-left-out:4") else 1)
    aF = work.slip("a_F", (aB + n4).real - epsilon4 * rise)
    aF = aB.real if work.has("rod left out") else aF
    aF = aF * K
    # forces
    AS2 = (0.1575 + 0.03j) * ABv / AB if not work.has("centre-at-hinge:2") else 0 * ABv
    DS3 = (1 if work.has("centre-at-hinge:3") else 0.4) * DBv
    BS4 = (0 if work.has("centre-at-hinge:4") else 0.5) * BFv
    m = [weight / G for weight in (10, 25, 18, 20, 50 * work.slips.get("mass of 5", 1))]
    aS2 = K * (aA + (1j * epsilon2 - omega2**2) * AS2)
    aS3 = K * aB * (1 if work.has("centre-at-hinge:3") else 0.4)
    aS4 = aB + 0.5 * (1j * epsilon4 * BFv + n4) * (0 if work.has("centre-at-hinge:4") else 1)
    epsilon2, epsilon3, epsilon4 = K * epsilon2, K * epsilon3, K * epsilon4
    P1, _ = work.inertia("1", m[0], 0.5 * aA, 0.001, 0 * q)
    P2, M2 = work.inertia("2", m[1], aS2, 0.02, epsilon2, 0.16033)
    P3, M3 = work.inertia("3", m[2], aS3, 0.015, epsilon3, 0.4 * BD)
    P4, M4 = work.inertia("4", m[3], aS4 * K, 0.03, epsilon4, 0.5 * BF)
    P5, _ = work.inertia("5", m[4], aF + 0j, 0.0, 0 * q)
    P5 = P5 + work.load(500, q, start, slow)
    K = work.scale("forces")
    N5 = -(M4 + cross(BS4, P4) + cross(BFv, P5)) / run
    R34 = work.slip("R_34", -(P4 + P5 + 1j * N5)) * K
    R45 = P4 + R34  # from the equilibrium of link 4
    onto3 = R34 if work.has("reaction-unreversed:34") else -R34
    t2 = -(M2 + cross(AS2, P2))
    t3 = M3 + cross(DS3, P3) + cross(DBv, onto3)
    X = (t2 * DBv - t3 * ABv) / det  # in B on link 2
    R12 = work.slip("R_12", -(P2 + X) * K)
    R03 = (X - onto3 - P3) * K
    onto1 = R12 if work.has("reaction-unreversed:12") else -R12
    M = -cross(0.5 * A, P1) - cross(A, onto1)
    M = np.abs(R12) * OA if work.has("arm left out") else M
    R45 = -R45 if work.has("opposite-reaction") else R45
    R03 = -R03 if work.has("opposite-reaction") else R03
    return {
        "k": np.full(12, slow / (2 * np.pi - slow)),
        "omega of 3": omega3,
        "v of F": vF + 0j,
        "epsilon of 3": epsilon3,
        "a of F": aF + 0j,
        "R_45": R45,
        "R_03": R03,
        "M_b": M,
    }


PLANS = [f"scale-inverted:{plan}" for plan in ("velocities", "accelerations", "forces")]
EVERYWHERE = [
    *("other-extreme", "x-axis-zero", "sense", "sense-own-zero", "sense-counted", "degrees-in-sine"),
    *("crank-speed", *PLANS, "mm-for-m", "degrees-for-radians", "neighbour"),
    *("mirror:4, 5", "normal-left-out:1", "normal-left-out:3", "normal-left-out:4", "tangential-left-out:3"),
    *("tangential-left-out:4", "inertia-left-out", "inertia-left-out:3", "inertia-left-out:4", "inertia-left-out:5"),
    *("couple-left-out", "couple-left-out:3", "inertia-reversed", "hinge-inertia", "hinge-inertia:3"),
    *("weight-for-mass", "weight-left-out", "weight-left-out:3", "mass-for-weight"),
    *("load-left-out", "load-reversed", "load-wrong-stroke", "load-both-strokes", "centre-at-hinge:3"),
    *("centre-at-hinge:4", "reaction-unreversed:34", "reaction-unreversed:12", "opposite-reaction"),
]
SHAPER_MISTAKES = [*EVERYWHERE, "coriolis-left-out", "coriolis-reversed", "reaction-unreversed:23"]
SIX_BAR_MISTAKES = [
    *EVERYWHERE,
    *("mirror:2, 3", "normal-left-out:2", "tangential-left-out:2", "centre-at-hinge:2"),
]
UNKNOWN = ["guide on the other side", "projection left out", "rod left out", "epsilon reversed", "arm left out"]
MISCOPIED = {"shaper": ["length OC", "length CD", "mass of 5"], "six-bar": ["length AB", "length BD", "mass of 5"]}
SLIPS = {
    "shaper": ["omega_1", "v_A", "omega_3", "v_D", "v_E", "a_A", "coriolis", "epsilon_3", "a_D^n", "a_ED^n", "R_34"],
    "six-bar": ["omega_1", "v_A", "omega_3", "v_B", "v_F", "a_BA^n", "a_BD^n", "epsilon_3", "a_FB^n", "R_34"],
}
FACTORS = {
    "crank-speed": [30 / np.pi, 1 / (2 * np.pi), 60.0, 2 * np.pi],
    **{plan: [0.02**2, 0.05**2, 0.1**2, 0.2**2, 0.5**2, 4.0, 25.0, 100.0, 400.0] for plan in PLANS},
}


def written(right, answers, keys, random):
    """Answers with drawing errors, to 4 figures; keys: quantity and position number of each question.

    Each number is off by a Gaussian error of 1 % of the largest value in the cycle, cut at 2.5 standard deviations.
    """
    found = {}
    for name, number in keys:
        value = answers[name, number]
        largest = max(np.max(np.abs(right[name])), abs(value))
        sigma = SIGMA * (abs(value) if name in ("H", "k") else largest)
        off = np.clip(random.normal(size=2), -CUT, CUT) * sigma
        if np.iscomplexobj(right[name]):
            guided = np.max(np.abs(right[name].imag)) == 0  # a point that moves along the x axis
            value = complex(value.real + off[0], 0.0 if guided else value.imag + off[1])
            found[name, number] = complex(figures(value.real), figures(value.imag))
        else:
            found[name, number] = figures(value + off[0])
    return found


def figures(value):
    return float(f"{value:.{DIGITS}g}")


def answers_of(solve, numbers, keys, work, random):
    """Right values over the cycle and the student's values without drawing errors, by quantity and position."""
    right = solve(*numbers)
    with np.errstate(all="ignore"):
        made = solve(*numbers, work)
    step = random.choice([-1, 1]) if work.has("neighbour") else 0
    found = {}
    for name, number in keys:
        value = made[name][(number or 0) + (step if number is not None else 0)]
        if work.has("mm-for-m") and name[:2] in ("v ", "a "):
            value = value * 1000
        if work.has("degrees-for-radians") and name.startswith(("omega", "epsilon")):
            value = np.degrees(value)
        found[name, number] = value
    return right, found
