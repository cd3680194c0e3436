"""Writes the 50-digit answers of `tmm bench stability`: python tests/write_stability_references.py [NAME...].

Places are written down in closed form (circles, a right triangle; for the triad its fold, by Newton's method along the
curve), all else comes from the textbook multibody way (multibody.py) in 120 digits with the numbers that float64 has.
"""

from __future__ import annotations

import json
import random
import sys
from decimal import Decimal
from pathlib import Path
from types import SimpleNamespace

import mpmath as mp
import numpy as np
from multibody import Multibody

from tmm_cli.bench import FAMILIES, FAMILIES_BY_NAME, transmission_sine, triad_linkage
from tmm_cli.mechanics.assembly import assemble
from tmm_cli.mechanics.errors import LinkageError
from tmm_cli.mechanics.kinematics import find_range
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.structure import analyse_structure

DATA = Path(__file__).parent.parent / "tmm_cli" / "bench" / "data" / "stability"
DIGITS, SEEDS = 50, 5
UPRIGHT = ((1, 0, 1), (3, 4, 5), (7, 24, 25), (44, 117, 125))  # sides of right triangles: decimals give their angles


class Closely(Multibody):
    """The same in 120 digits, from places that are known to as many."""

    digits, step, bend = 120, mp.mpf(10) ** -40, mp.mpf(10) ** -32

    def __init__(self, scene, begin=None):
        self.scene, self.begin, self.rounds = scene, begin, 2 if begin is None else 10
        it, q = scene.linkage, np.array([scene.q])
        structure = analyse_structure(it)
        self.structure = structure
        super().__init__(it, structure, SimpleNamespace(q=q, time=np.zeros(1), linkage=it, kernels=None))

    def begun(self, place):
        return (self.begin or closed(self.scene))[0].copy()

    def watched(self, X):
        """The place of the watched point."""
        link = self.it.owner(self.scene.point)
        x, z = self.pose(X, link)
        return x + self.it.local(link, self.scene.point) * z

    def answers(self):
        """What is watched: place, velocity, acceleration of the point, force in the pair, balancing moment."""
        X, V, A, multipliers = self.at(0)
        link = self.it.owner(self.scene.point)
        i, arm = self.at_row[link], self.it.local(link, self.scene.point) * self.pose(X, link)[1]
        row = self.row_of(next(pair for pair in self.pairs if pair.name == self.scene.pair))
        return {
            "position": mp.mpc(X[i], X[i + 1]) + arm,
            "velocity": mp.mpc(V[i], V[i + 1]) + 1j * V[i + 2] * arm,
            "acceleration": mp.mpc(A[i], A[i + 1]) + (1j * A[i + 2] - V[i + 2] ** 2) * arm,
            "reaction": -mp.mpc(multipliers[row], multipliers[row + 1]),
            "balancing": multipliers[self.size - 1],
        }


def circles(A, b, D, c, side):
    """Where they meet, on the left of AD for side 1."""
    base = D - A
    x = (abs(base) ** 2 + b * b - c * c) / (2 * abs(base))
    return A + base / abs(base) * mp.mpc(x, side * mp.sqrt(b * b - x * x))


def closed(scene):
    """Coordinates of all links in the assembly of the sketch and the watched point of the other one."""
    it, q = scene.linkage, mp.mpf(scene.q)
    fixed = {name: mp.mpc(p) for name, p in it.links[FRAME].points.items()}
    pivot = fixed["O"]
    A = pivot + mp.mpf(it.local("1", "A").real) * mp.expj(q)
    at = {name: mp.mpc(p) for name, p in it.sketch.points.items()}
    crank = [pivot.real, pivot.imag, q]
    if "C" in fixed:  # a stone at A on the link through C
        C, k = fixed["C"], mp.mpf(it.local("3", "K").real)
        u = (A - C) / abs(A - C)
        turn = mp.arg(u)
        return mp.matrix([*crank, A.real, A.imag, turn, C.real, C.imag, turn]), C - k * u
    b = mp.mpf(it.local("2", "B").real)
    if "D" in fixed:
        D, c = fixed["D"], mp.mpf(it.local("3", "B").real)
        side = mp.sign((mp.conj(D - at["A"]) * (at["B"] - at["A"])).imag)
        B, other = circles(A, b, D, c, side), circles(A, b, D, c, -side)
        return mp.matrix([*crank, A.real, A.imag, mp.arg(B - A), D.real, D.imag, mp.arg(B - D)]), other
    y = pivot.imag - A.imag
    x = mp.sqrt((b - y) * (b + y))
    B = A + mp.mpc(x, y)
    return mp.matrix([*crank, A.real, A.imag, mp.arg(B - A), B.real, B.imag, 0]), A + mp.mpc(-x, y)


# the triad's fold


class Fold(Closely):
    """Where a group of class III loses two assemblies: along the curve of its places, by one of its coordinates."""

    def on_curve(self, X, q, k, value):
        """Places and driver where coordinate k has a value; derivatives of the driver and of the places by it."""
        X = X.copy()
        for _ in range(60):
            gaps = [*self.residuals(X, [q]), X[k] - value]
            M = mp.matrix(self.size + 1, self.size + 1)
            M[: self.size, : self.size] = self.jacobian(X)
            M[self.size - 1, self.size], M[self.size, k] = -1, 1
            step = mp.lu_solve(M, -mp.matrix(gaps))
            X, q = X + step[: self.size], q + step[self.size]
            if mp.norm(step, mp.inf) < mp.mpf(10) ** -60:
                break
        last = mp.matrix(self.size + 1, 1)
        last[self.size] = 1
        along = mp.lu_solve(M, last)
        return X, q, along[self.size], along[: self.size]

    def found(self, q):
        """The fold that the way ends in near q: its places, driver, tangent, how the driver bends, the coordinate."""
        X = mp.matrix([mp.mpf(float(x)) for x in self.walked(q)])
        J, driven = self.jacobian(X), mp.matrix(self.size, 1)
        driven[self.size - 1] = 1
        V = mp.lu_solve(J, driven)
        k = max((i + 2 for name, i in self.at_row.items() if name != "1"), key=lambda i: abs(V[i]))
        X, place, slope, _ = self.on_curve(X, mp.mpf(q), k, X[k])
        before, by = (X[k], slope), mp.sign(V[k]) * mp.sign(mp.mpf(q) - self.scene.q) * mp.mpf("1e-4")
        value = X[k] + by
        for _ in range(40):
            X, place, slope, along = self.on_curve(X, place, k, value)
            bend = (slope - before[1]) / (value - before[0])
            before = value, slope
            if abs(slope) < mp.mpf(10) ** -65:
                break
            value -= slope / bend
        return X, place, along, bend, k


# numbers of the families


def decimals(r, low, high):
    """A decimal of three places."""
    return Decimal(r.randint(round(low * 1000), round(high * 1000))) / 1000


def text(value, digits=DIGITS):
    return Decimal(mp.nstr(value, digits))


def pivots(r, d):
    """O and D on an inclined line, all decimals."""
    p, s, h = r.choice(UPRIGHT)
    x, y = decimals(r, -0.3, 0.3), decimals(r, -0.3, 0.3)
    length = decimals(r, d, d)
    return {"Ox": x, "Oy": y, "Dx": x + length * p / h, "Dy": y + length * s / h}


def exact(n, *keys):
    """Numbers as float64 has them."""
    return [mp.mpf(float(n[key])) for key in keys]


def dead(r, seed):
    """A driven link that stops where coupler and rocker come into line, stretched or folded."""
    while True:
        n = {key: decimals(r, 0.2, 0.9) for key in "abc"} | pivots(r, r.uniform(0.4, 0.9))
        a, b, c, ox, oy, dx, dy = exact(n, "a", "b", "c", "Ox", "Oy", "Dx", "Dy")
        base = mp.mpc(dx - ox, dy - oy)
        limit = b + c if seed % 2 == 0 else abs(b - c)
        cosine = (a * a + abs(base) ** 2 - limit**2) / (2 * a * abs(base))
        if abs(cosine) > 0.9 or abs(b - c) < 0.1:
            continue
        turn, inward = r.choice((1, -1)), -1 if seed % 2 == 0 else 1
        n |= {
            "critical": text(mp.arg(base) + turn * mp.acos(cosine)),
            "sense": Decimal(turn * inward),
            "side": Decimal(r.choice((1, -1))),
            "back": Decimal("0.3"),
        }
        if sound(n, (Decimal("0.1"), Decimal("0.3"))):
            return n


def sound(n, distances):
    """Whether the circles meet well at some distances."""
    for distance in distances:
        q = float(n["critical"] + n["sense"] * distance)
        A = complex(float(n["Ox"]), float(n["Oy"])) + float(n["a"]) * np.exp(1j * q)
        if transmission_sine(A, float(n["b"]), complex(float(n["Dx"]), float(n["Dy"])), float(n["c"])) < 0.15:
            return False
    return True


def parallelogram(r, seed):
    """Sides and pivots that binary fractions give: the links come into line all at once."""
    p, s, length = (5, 0, 5) if seed % 2 == 0 else (3, 4, 5)
    m, a = r.choice((5, 7, 9)), r.choice((13, 17, 53, 61))
    x, y = Decimal(r.randint(-16, 16)) / 64, Decimal(r.randint(-16, 16)) / 64
    unit = Decimal(m) / 64
    n = {
        "a": Decimal(a) / 64,
        "b": unit * length,
        "c": Decimal(a) / 64,
        "Ox": x,
        "Oy": y,
        "Dx": x + unit * p,
        "Dy": y + unit * s,
    }
    turn = r.choice((1, -1))
    critical = mp.atan2(s, p) + (mp.pi if seed == 4 else 0)
    # the parallelogram has B beyond D: on the left of AD where the crank is on the left of OD
    A = mp.mpc(exact(n, "Ox")[0], exact(n, "Oy")[0]) + exact(n, "a")[0] * mp.expj(critical + turn * mp.mpf("0.3"))
    D = mp.mpc(*exact(n, "Dx", "Dy"))
    B = A + D - mp.mpc(*exact(n, "Ox", "Oy"))
    side = mp.sign((mp.conj(D - A) * (B - A)).imag)
    return n | {"critical": text(critical), "sense": Decimal(turn), "side": Decimal(int(side)), "back": Decimal("0.5")}


def tangent(outer):
    """Lengths with which the crank comes well away from the tangent, and meets no dead position on the way."""

    def numbers(r, seed):
        while True:
            n = {key: decimals(r, 0.2, 0.9) for key in "abc"} | {"side": Decimal(r.choice((1, -1)))} | inclined(r)
            n |= pin(n)
            if abs(n["b"] - n["c"]) < Decimal("0.15"):
                continue
            it = FAMILIES_BY_NAME["outer-tangent" if outer else "inner-tangent"].scene(n, Decimal("1e-15")).linkage
            way = it.sketch.at - float(n["q"])
            if (
                all(shaped(it, float(n["q"]) + way * k / 40) > 0.02 for k in range(1, 41))
                and shaped(it, it.sketch.at) > 0.2
            ):
                return n

    return numbers


def shaped(it, q):
    """Sine of a four-bar's transmission angle."""
    A = it.local(FRAME, "O") + it.local("1", "A") * np.exp(1j * q)
    return transmission_sine(A, it.local("2", "B").real, it.local(FRAME, "D"), it.local("3", "B").real)


def inclined(r):
    """A direction, a pivot, a place of the crank."""
    p, s, h = r.choice(UPRIGHT)
    return {
        "Ox": decimals(r, -0.3, 0.3),
        "Oy": decimals(r, -0.3, 0.3),
        "ux": r.choice((1, -1)) * Decimal(p) / h,
        "uy": r.choice((1, -1)) * Decimal(s) / h,
        "q": decimals(r, 0.2, 2.9),
    }


def pin(n):
    """The crank's pin A, in as many digits as the distances need."""
    a, ox, oy, q = exact(n, "a", "Ox", "Oy", "q")
    A = mp.mpc(ox, oy) + a * mp.expj(q)
    return {"Ax": text(A.real), "Ay": text(A.imag)}


def stone(r, seed):
    n = {"a": decimals(r, 0.1, 0.5), "far": decimals(r, 0.5, 0.9)} | inclined(r)
    return n | pin(n)


def rod(r, seed):
    n = {"r": decimals(r, 0.05, 0.4), "Ox": decimals(r, -0.3, 0.3), "Oy": decimals(r, -0.3, 0.3)}
    return n | {"critical": text(mp.pi / 2), "lean": decimals(r, 0.3, 0.9), "q": decimals(r, 0.3, 2.8)}


def crank_rocker(r):
    while True:
        n = (
            {key: decimals(r, 0.3, 0.9) for key in "bc"}
            | {"a": decimals(r, 0.1, 0.25)}
            | pivots(r, r.uniform(0.4, 0.9))
        )
        a, b, c, ox, oy, dx, dy = (float(v) for v in exact(n, "a", "b", "c", "Ox", "Oy", "Dx", "Dy"))
        d = abs(complex(dx - ox, dy - oy))
        if d + a < 0.97 * (b + c) and d - a > 1.1 * abs(b - c):
            return n


def sized(r, seed):
    if seed % 2:
        return {
            "r": decimals(r, 0.1, 0.3),
            "l": decimals(r, 0.5, 0.9),
            "Ox": decimals(r, -0.3, 0.3),
            "Oy": decimals(r, -0.3, 0.3),
            "q": decimals(r, 0.3, 2.8),
        }
    return crank_rocker(r) | {"side": Decimal(r.choice((1, -1))), "q": decimals(r, 0.3, 2.8)}


def in_line(r, seed):
    """Crank and coupler stretched or folded, or the crank on the line of the pivots."""
    n = crank_rocker(r)
    a, b, c, ox, oy, dx, dy = exact(n, "a", "b", "c", "Ox", "Oy", "Dx", "Dy")
    base, side = mp.mpc(dx - ox, dy - oy), r.choice((1, -1))
    way = {0: b + a, 1: b - a, 2: b + a, 3: b - a}.get(seed)
    if way is None:
        critical = mp.arg(base)
    else:
        critical = mp.arg(base) + side * mp.acos((abs(base) ** 2 + way**2 - c * c) / (2 * abs(base) * way))
        critical += mp.pi if seed % 2 else 0
    return n | {"side": Decimal(side), "critical": text(critical), "sense": Decimal(r.choice((1, -1)))}


def folding(r, seed):
    """A triad like that of the bank whose crank is too long to go round."""
    while True:
        n = {"a": decimals(r, 0.06, 0.12), "leg": decimals(r, 0.1, 0.12), "at": Decimal("1.5")}
        near = {
            "O": (0, 0),
            "C": (160, 0),
            "D": (130, 180),
            "Q": (230, 0),
            "R": (140, 150),
            "P": (43, 141),
            "q": (256, 54),
            "r": (230, 227),
        }
        for key, (x, y) in near.items():
            shake = r.randint(-9, 9), r.randint(-9, 9)
            n |= {key + "x": Decimal(x + shake[0]) / 1000, key + "y": Decimal(y + shake[1]) / 1000}
        it = triad_linkage(n)
        try:
            way = find_range(it, assemble(it, analyse_structure(it)))
        except LinkageError:
            continue
        if not way.full and min(abs(end - 1.5) for end in (way.start, way.end)) > 0.4:
            return n | {"end": Decimal(way.end), "sense": Decimal(-1)}


NUMBERS = {
    "dead-position": dead,
    "change-point": parallelogram,
    "outer-tangent": tangent(True),
    "inner-tangent": tangent(False),
    "stone-over-pivot": stone,
    "short-rod": rod,
    "long-rod": rod,
    "size": sized,
    "three-in-line": in_line,
    "two-assemblies-lost": folding,
}


def starts(family, n):
    """What begins Newton's method at each distance, or None where places are closed; completes the numbers."""
    if family.name != "two-assemblies-lost":
        return {}
    end = n.pop("end")
    fold = Fold(family.scene(n | {"critical": end}, Decimal("0.3")))
    fold.motion.kernels = assemble(fold.it, fold.structure)
    X, q, along, bend, k = fold.found(float(end) - 1e-3)
    n["critical"] = text(q)
    found = {}
    near = fold.walked(float(q) - 1e-3)
    side = mp.sign(mp.mpf(float(near[k])) - X[k])
    for distance in family.distances:
        scene = family.scene(n, distance)
        way = mp.sqrt(2 * (mp.mpf(scene.q) - q) / bend)
        if distance >= Decimal("0.001"):
            fold.known.clear()  # from the sketch, not from near the fold
            found[distance] = mp.matrix([mp.mpf(float(x)) for x in fold.walked(scene.q)]), None
        else:
            found[distance] = X + side * way * along, fold.watched(X - side * way * along)
    return found


def written(value, digits=DIGITS):
    if isinstance(value, mp.mpc):
        return [mp.nstr(part, digits) for part in (value.real, value.imag)]
    return value if value is None else mp.nstr(value, digits)


def write(name):
    family, seeds = FAMILIES_BY_NAME[name], []
    for seed in range(SEEDS):
        mp.mp.dps = Closely.digits
        n = NUMBERS[name](random.Random(f"{name} {seed}"), seed)
        begin = starts(family, n)
        scenes = []
        for distance in family.distances:
            scene = family.scene(n, distance)
            start = begin.get(distance)
            body = Closely(scene, start)
            found = {key: written(value) for key, value in body.answers().items()}
            scenes.append({"distance": str(distance), **found, "other": written((start or closed(scene))[1], 25)})
        seeds.append({"numbers": {key: str(value) for key, value in n.items()}, "scenes": scenes})
        print(name, seed, flush=True)
    DATA.mkdir(parents=True, exist_ok=True)
    (DATA / f"{name}.json").write_text(lines(seeds), encoding="utf-8")


def lines(seeds):
    """The file: a line a scene."""
    parts = []
    for seed in seeds:
        scenes = ",\n".join(json.dumps(scene) for scene in seed["scenes"])
        parts.append(f'{{"numbers": {json.dumps(seed["numbers"])},\n"scenes": [\n{scenes}\n]}}')
    return '{"seeds": [\n' + ",\n".join(parts) + "\n]}\n"


if __name__ == "__main__":
    for chosen in sys.argv[1:] or [family.name for family in FAMILIES]:
        write(chosen)
