"""Three mechanisms programmed by hand: the NumPy code of an engineer who needs only this one mechanism.

Each function computes the kinematics of all joints and centres of mass, all reactions with inertia forces and weights,
and the balancing moment, at crank angles q (rad) for a constant crank speed w (rad/s). Dimensions are numbers or arrays
(variants, 1). The times of tmm are compared with those of this code. The formulas are those of any textbook, and each
value is computed only once.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tmm_cli.batch import Batch, prepare_batch, read_all
from tmm_cli.bench.references import load_reference
from tmm_cli.mechanics.forces import Reactions
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import Real

G = 9.81


def cross(a: Any, b: Any) -> Any:
    """Return the z component of the cross product of two vectors given as complex numbers."""
    return a.real * b.imag - a.imag * b.real


def crank_slider(
    q: Any,
    *,
    r: Any,
    l: Any,  # noqa: E741
    s: float,
    m1: float,
    m2: float,
    J2: float,
    m3: float,
    w: float,
    F: float,
) -> dict[str, Any]:
    """Compute a crank-slider: crank OA = r, connecting rod AB = l, slider B on the x axis.

    The centre of mass of the crank is at O, that of the rod at the fraction `s` of AB.

    Args:
        q: Crank angles, rad.
        m1, m2, m3: Masses, kg.
        J2: Moment of inertia of the rod, kg m2.
        w: Crank speed, rad/s.
        F: Force on the slider along x, N.

    Returns:
        Values at the angles q by name, e.g. "B.v", "2.omega", "R.A" (reaction in A), "T.1" (balancing moment).
    """
    c, sn = np.cos(q), np.sin(q)
    w2 = w * w
    yA = r * sn
    A = r * c + 1j * yA
    h = np.sqrt((l - yA) * (l + yA))
    AB = h - 1j * yA
    B = A.real + h
    vA = 1j * w * A
    aA = -w2 * A
    omega = -w * A.real / h
    vB = vA.real + omega * yA
    epsilon = (-aA.imag + omega * omega * -yA) / h
    aB = aA.real + epsilon * yA - omega * omega * h
    AS = s * AB
    turn = 1j * epsilon - omega * omega
    S, vS, aS = A + AS, vA + 1j * omega * AS, aA + turn * AS
    P2 = -m2 * aS - 1j * (m2 * G)
    P3 = -m3 * aB + F
    # rod about A: N at B; slider: the rest of the rod's force at B
    M2 = -J2 * epsilon + cross(AS, P2)
    N = -(M2 + yA * P3) / h + m3 * G
    RB = P3 + 1j * (N - m3 * G)  # on the rod from the slider
    RA = -(P2 + RB)  # on the rod from the crank
    T = -cross(A, -RA)
    RO = RA + 1j * (m1 * G)
    return {
        "A.x": A,
        "A.v": vA,
        "A.a": aA,
        "B.x": B,
        "B.v": vB,
        "B.a": aB,
        "S2.x": S,
        "S2.v": vS,
        "S2.a": aS,
        "2.omega": omega,
        "2.epsilon": epsilon,
        "R.A": RA,
        "R.B": RB,
        "R.x": N,
        "R.O": RO,
        "T.1": T,
    }


def six_bar(
    q: Any, *, a: Any, b: Any, c: Any, d: Any, e: Any, y: float, S2: complex, w: float, m: Any, J: Any, F: float
) -> dict[str, Any]:
    """Compute a six-bar: crank OA = a, coupler AB = b, rocker DB = c, OD = d, rod BF = e, slider F at the height y.

    The centres of mass are: of the crank at its middle, of the coupler at S2 (in its axes, as a fraction of b), of the
    rocker at 0.4 of DB, of the rod at its middle, of the slider at F. m and J are the masses and moments of inertia of
    links 1 to 5.

    Returns:
        Values at the crank angles q (rad) by name, as in `crank_slider`.
    """
    w2 = w * w
    A = a * (np.cos(q) + 1j * np.sin(q))
    vA, aA = 1j * w * A, -w2 * A
    D = d - A
    square = D.real * D.real + D.imag * D.imag
    x = (square + b * b - c * c) / 2
    h = np.sqrt(b * b * square - x * x)
    AB = D * (x + 1j * h) / square
    DB = AB - D
    B = A + AB
    det = cross(AB, DB)
    omega2 = -(vA.real * DB.real + vA.imag * DB.imag) / det
    omega3 = -(vA.real * AB.real + vA.imag * AB.imag) / det
    vB = 1j * omega3 * DB
    n2, n3 = omega2 * omega2, omega3 * omega3
    n = n2 * AB - n3 * DB - aA
    epsilon2 = (n.real * DB.real + n.imag * DB.imag) / det
    epsilon3 = (n.real * AB.real + n.imag * AB.imag) / det
    aB = (1j * epsilon3 - n3) * DB
    # rod and slider
    k = y - B.imag
    g = np.sqrt((e - k) * (e + k))
    BF = g + 1j * k
    F5 = B + BF
    omega4 = -vB.imag / g
    vF = vB.real - omega4 * k
    n4 = omega4 * omega4
    epsilon4 = (n4 * k - aB.imag) / g
    aF = aB.real - epsilon4 * k - n4 * g
    AS2, DS3, BS4, OS1 = S2 * AB, 0.4 * DB, 0.5 * BF, 0.5 * A
    S = (OS1, A + AS2, d + DS3, B + BS4)
    v = (0.5 * vA, vA + 1j * omega2 * AS2, 0.4 * vB, vB + 1j * omega4 * BS4)
    acc = (0.5 * aA, aA + (1j * epsilon2 - n2) * AS2, 0.4 * aB, aB + (1j * epsilon4 - n4) * BS4)
    gi = 1j * G
    P1, P2, P3, P4 = (-m[i] * (acc[i] + gi) for i in range(4))
    P5 = -m[4] * (aF + gi) + F
    M2, M3, M4 = -J[1] * epsilon2, -J[2] * epsilon3, -J[3] * epsilon4
    N = -(M4 + cross(BS4, P4) + cross(BF, P5)) / g
    RF = P5 + 1j * N  # on the rod from the slider
    R4 = -(P4 + RF)  # on the rod in B
    # coupler and rocker
    t2 = -(M2 + cross(AS2, P2))
    t3 = M3 + cross(DS3, P3) - cross(DB, R4)
    # X in B on the coupler, so -X - R4 on the rocker: AB x X = t2, DB x X = t3
    X = (t2 * DB - t3 * AB) / det
    RA = -(P2 + X)
    RD = X + R4 - P3
    T = -cross(OS1, P1) + cross(A, RA)
    RO = RA - P1
    return {
        "A.x": A,
        "A.v": vA,
        "A.a": aA,
        "B.x": B,
        "B.v": vB,
        "B.a": aB,
        "F.x": F5,
        "F.v": vF,
        "F.a": aF,
        **{f"S{i + 1}.{t}": component[i] for t, component in (("x", S), ("v", v), ("a", acc)) for i in range(4)},
        "2.omega": omega2,
        "3.omega": omega3,
        "4.omega": omega4,
        "2.epsilon": epsilon2,
        "3.epsilon": epsilon3,
        "4.epsilon": epsilon4,
        "R.A": RA,
        "R.B": X,
        "R.B''": R4,
        "R.D": RD,
        "R.F": RF,
        "R.x": N,
        "R.O": RO,
        "T.1": T,
    }


def shaper(
    q: Any, *, a: Any, f: Any, c: Any, e: Any, y: float, S5: complex, at: complex, w: float, m: Any, J: Any, F: float
) -> dict[str, Any]:
    """Compute a shaper: crank OA = a, sliding block at A, slotted link CD = c, rod DE = e, ram E at the height y.

    The pivot C is the distance f below O. The centres of mass are: of the crank at 0.3 of OA, of the sliding block at
    A, of the slotted link and the rod at their middles, of the ram at S5 from E. The force F acts on the ram at `at`
    from E. m and J are the masses and moments of inertia of links 1 to 5.

    Returns:
        Values at the crank angles q (rad) by name, as in `crank_slider`.
    """
    w2 = w * w
    A = a * (np.cos(q) + 1j * np.sin(q))
    vA, aA = 1j * w * A, -w2 * A
    CA = A + 1j * f
    rho = np.abs(CA)
    u = CA / rho
    omega3 = (u.real * vA.imag - u.imag * vA.real) / rho
    slide = u.real * vA.real + u.imag * vA.imag
    n3 = omega3 * omega3
    epsilon3 = (u.real * aA.imag - u.imag * aA.real - 2 * omega3 * slide) / rho
    CD = c * u
    D = CD - 1j * f
    vD = 1j * omega3 * CD
    turn3 = 1j * epsilon3 - n3
    aD = turn3 * CD
    k = y - D.imag
    g = np.sqrt((e - k) * (e + k))
    DE = g + 1j * k
    E = D + DE
    omega4 = -vD.imag / g
    vE = vD.real - omega4 * k
    n4 = omega4 * omega4
    epsilon4 = (n4 * k - aD.imag) / g
    aE = aD.real - epsilon4 * k - n4 * g
    OS1, CS3, DS4 = 0.3 * A, 0.5 * CD, 0.5 * DE
    S = (OS1, A, CS3 - 1j * f, D + DS4, E + S5)
    v = (0.3 * vA, vA, 0.5 * vD, vD + 1j * omega4 * DS4, vE)
    acc = (0.3 * aA, aA, 0.5 * aD, aD + (1j * epsilon4 - n4) * DS4, aE)
    gi = 1j * G
    P1, P2, P3, P4, P5 = (-m[i] * (acc[i] + gi) for i in range(5))
    M2, M3, M4 = -J[1] * epsilon3, -J[2] * epsilon3, -J[3] * epsilon4
    N = -(M4 + cross(DS4, P4) + cross(DE, P5 + F)) / g
    RE = P5 + F + 1j * N  # on the rod from the ram
    couple5 = -(cross(S5, P5) + cross(at, F + 0j * N))  # of the guide on the ram, about E
    RD = -(P4 + RE)  # on the rod from the slotted link
    # slotted link and sliding block: the block rotates with it, so its couple is transmitted by the slot
    R32 = -(M3 + M2 + cross(CS3, P3) + cross(CD, -RD)) / rho  # on the link from the sliding block, across the slot
    Q = 1j * u * R32
    couple2 = M2  # likewise
    RC = -(P3 - RD + Q)
    RA = Q - P2  # on the sliding block from the crank
    T = -cross(OS1, P1) + cross(A, RA)
    RO = RA - P1
    return {
        "A.x": A,
        "A.v": vA,
        "A.a": aA,
        "D.x": D,
        "D.v": vD,
        "D.a": aD,
        "E.x": E,
        "E.v": vE,
        "E.a": aE,
        **{f"S{i + 1}.{t}": component[i] for t, component in (("x", S), ("v", v), ("a", acc)) for i in range(5)},
        "3.omega": omega3,
        "4.omega": omega4,
        "3.epsilon": epsilon3,
        "4.epsilon": epsilon4,
        "R.A": RA,
        "R.A'": Q,
        "M.A'": couple2,
        "R.C": RC,
        "R.D": RD,
        "R.E": RE,
        "R.x": N,
        "M.x": couple5,
        "R.O": RO,
        "T.1": T,
    }


Arguments = Callable[[Linkage], dict[str, Any]]


@dataclass(frozen=True)
class HandCodedMechanism:
    """A mechanism that is computed both by tmm and by code written by hand for it.

    Attributes:
        name: name of the reference linkage.
        code: the function written by hand.
        arguments: function that returns the arguments of `code` for a linkage.
        longer: links that are made longer in the variants.
    """

    name: str
    code: Callable[..., dict[str, Any]]
    arguments: Arguments
    longer: tuple[str, ...]

    def load_linkage(self) -> Linkage:
        """Return the reference linkage with constant loads.

        The code written by hand has no load tables and no strokes.
        """
        linkage = load_reference(self.name).case.linkage
        (load,) = linkage.loads
        force = load.force * (1 if load.table is None else load.table.values[0])
        return replace(linkage, loads=(replace(load, force=force, table=None, when="always"),))

    def make_variants(self, count: int, seed: int = 1) -> list[Linkage]:
        """Return `count` variants of the linkage: the reference itself, then linkages with links up to 3 % longer."""
        first, random = self.load_linkage(), np.random.default_rng(seed)
        linkages = [first]
        for _ in range(count - 1):
            links = dict(first.links)
            for name in self.longer:
                by, link = float(1 + 0.03 * random.random()), first.links[name]
                points = {point: place * by for point, place in link.points.items()}
                links[name] = replace(link, points=points, centre=link.centre * by)
            linkages.append(replace(first, links=links))
        return linkages

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Names of the values that the code written by hand computes."""
        first = self.load_linkage()
        return tuple(self.prepare_by_hand([first])(np.array([first.sketch.at])))

    def prepare_ours(self, linkages: Sequence[Linkage]) -> Batch:
        """Prepare tmm to compute the values in `names`; return a function of the driver coordinates."""

        def asked(motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
            results = read_all(motion, reactions)
            return {name: results[name] for name in self.names}

        return prepare_batch(linkages, asked)

    def prepare_by_hand(self, linkages: Sequence[Linkage]) -> Callable[[Real], dict[str, Any]]:
        """Return a function of the crank angles q (rad) that runs the hand-written code for all these linkages at once.

        It returns the values in `names`. Dimensions that differ between the linkages are passed to the code as arrays
        (variants, 1).
        """
        each = [self.arguments(linkage) for linkage in linkages]
        first = each[0]
        arguments = {
            name: np.array([one[name] for one in each])[:, None]
            if np.ndim(first[name]) == 0 and any(one[name] != first[name] for one in each)
            else first[name]
            for name in first
        }
        return lambda q: self.code(q, **arguments)


def _mass_arguments(linkage: Linkage) -> dict[str, Any]:
    links = [linkage.links[name] for name in sorted(linkage.moving)]
    driver = linkage.driver
    return {
        "m": [link.mass for link in links],
        "J": [link.inertia for link in links],
        "w": driver.sense * driver.rate,
        "F": linkage.loads[0].force,
    }


def _length(linkage: Linkage, link: str, point: str) -> float:
    return abs(linkage.local(link, point))


def _crank_slider_arguments(linkage: Linkage) -> dict[str, Any]:
    all_of = _mass_arguments(linkage)
    (m1, m2, m3), rod = all_of["m"], linkage.links["2"]
    return {
        "r": _length(linkage, "1", "A"),
        "l": _length(linkage, "2", "B"),
        "s": 0.35,
        "m1": m1,
        "m2": m2,
        "J2": rod.inertia,
        "m3": m3,
        "w": all_of["w"],
        "F": all_of["F"],
    }


def _six_bar_arguments(linkage: Linkage) -> dict[str, Any]:
    return {
        "a": _length(linkage, "1", "A"),
        "b": _length(linkage, "2", "B"),
        "c": _length(linkage, "3", "B"),
        "d": linkage.local("0", "D").real,
        "e": _length(linkage, "4", "F"),
        "y": 0.2,
        "S2": complex(157.5, 30) / 350,
        **_mass_arguments(linkage),
    }


def _shaper_arguments(linkage: Linkage) -> dict[str, Any]:
    return {
        "a": _length(linkage, "1", "A"),
        "f": -linkage.local("0", "C").imag,
        "c": _length(linkage, "3", "D"),
        "e": _length(linkage, "4", "E"),
        "y": 0.27,
        "S5": linkage.links["5"].centre,
        "at": linkage.loads[0].at,
        **_mass_arguments(linkage),
    }


MECHANISMS = (
    HandCodedMechanism("crank-slider", crank_slider, _crank_slider_arguments, ("1", "2")),
    HandCodedMechanism("six-bar", six_bar, _six_bar_arguments, ("1", "2", "3", "4")),
    HandCodedMechanism("shaper", shaper, _shaper_arguments, ("1", "3", "4")),
)
