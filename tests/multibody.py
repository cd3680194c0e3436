"""The textbook multibody way in 60 digits: Newton on all constraints in absolute coordinates, Lagrange multipliers.

It knows no Assur groups, so nothing that is wrong in them can hide here. Angles are followed through full turns by
walking from the sketch in small steps of time; derivatives are differences, with steps far below what float64 can see.
Teeth and cams push where they touch, so that the hinges of their links bear what they do in truth.
"""

from __future__ import annotations

from itertools import pairwise

import mpmath as mp
import numpy as np

from tmm_cli.mechanics.elements.dampers import Damper
from tmm_cli.mechanics.groups import DriverMotion
from tmm_cli.mechanics.kinematics import compute_motion
from tmm_cli.mechanics.linkage import FRAME

DIGITS = 60
STEP, BEND = mp.mpf(10) ** -25, mp.mpf(10) ** -15  # of first and second differences
KEPT = 3  # rounds of Newton's method with one Jacobian: each gives the digits of a double more
STRIDE = 0.06  # rad or m/20 of the first driver, in one step of the walk


class Floats:
    """Arithmetic of the walk: many states at once."""

    exp = staticmethod(lambda angle: np.exp(1j * angle))
    real, pi = staticmethod(float), np.pi


class Digits:
    """Arithmetic of the answers: one state in 60 digits."""

    exp, real = staticmethod(mp.expj), staticmethod(mp.mpf)

    @property
    def pi(self):
        return +mp.pi


def _sine(angle, n):
    return n.exp(angle).imag


SHAPES = {
    "linear": lambda x, n: x,
    "parabolic": lambda x, n: 2 * x**2 if x < 0.5 else 1 - 2 * (1 - x) ** 2,
    "cosine": lambda x, n: (1 - _sine(n.pi * (x + n.real(0.5)), n)) / 2,
    "sine": lambda x, n: x - _sine(2 * n.pi * x, n) / (2 * n.pi),
    "3-4-5": lambda x, n: 10 * x**3 - 15 * x**4 + 6 * x**5,
    "4-5-6-7": lambda x, n: 35 * x**4 - 84 * x**5 + 70 * x**6 - 20 * x**7,
}


def run_of(law, angle, n):
    """A cam's law at an angle, from the formulas of the course: piece by piece, its polynomial or sine."""
    way = (angle - n.real(law.start)) % (2 * n.pi)
    low = n.real(0)
    for number, piece in enumerate(law.pieces):
        over, rise = n.real(piece.over), n.real(piece.rise)
        if way <= over or number == len(law.pieces) - 1:
            return low + rise * SHAPES[piece.shape](way / over, n)
        way, low = way - over, low + rise
    raise AssertionError


def solved(matrix, right):
    """Linear equations by elimination; zeros, which most of such a matrix is, are passed over."""
    n = len(right)
    rows = [[*(matrix[i, j] for j in range(n)), right[i]] for i in range(n)]
    for k in range(n):
        best = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[best] = rows[best], rows[k]
        known = [j for j in range(k, n + 1) if rows[k][j]]
        for row in rows[k + 1 :]:
            if row[k]:
                factor = row[k] / rows[k][k]
                for j in known:
                    row[j] -= factor * rows[k][j]
    found = mp.matrix(n, 1)
    for k in reversed(range(n)):
        rest = sum(rows[k][j] * found[j] for j in range(k + 1, n) if rows[k][j])
        found[k] = (rows[k][n] - rest) / rows[k][k]
    return found


class Multibody:
    """One linkage; `at(k)` solves position k of a motion.

    strokes: those of the run, for loads of the working stroke; they say only which way the output works.
    rounds: of Newton's method in so many digits; near dead positions more of both are wanted, and shorter steps.
    """

    rounds, digits, step, bend = 3, DIGITS, STEP, BEND

    def __init__(self, it, structure, motion, strokes=None):
        mp.mp.dps = self.digits
        self.it, self.pairs, self.motion, self.strokes = it, structure.pairs, motion, strokes
        self.at_row = {name: 3 * i for i, name in enumerate(it.moving)}
        self.size = 3 * len(it.moving)
        # with several drivers the clock starts in the sketch, with one in position 0
        self.began = it.sketch.at if it.others else float(motion.q[0] - self._way_before(motion))
        self.known = {}

    @staticmethod
    def _way_before(motion):
        """How far the driver has come since the clock started, by its own law."""
        driver = motion.linkage.driver
        time = float(motion.time[0])
        return driver.sense * time * (driver.rate + driver.acceleration * time / 2)

    # constraints

    def pose(self, X, name, n=Digits):
        if name == FRAME:
            return 0, 1
        i = self.at_row[name]
        return X[i] + 1j * X[i + 1], n.exp(X[i + 2])

    def angle(self, X, name):
        return 0 if name == FRAME else X[self.at_row[name] + 2]

    def slid(self, X, slide, n):
        """Run of a sliding pair along its guide, its distance from the guide and the guide's direction."""
        (xi, zi), (xj, zj) = self.pose(X, slide.carrier, n), self.pose(X, slide.runner, n)
        off = xj + slide.at * zj - xi - slide.through * zi
        u = zi * n.exp(n.real(slide.direction))
        along = u.conjugate() * off
        return along.real, along.imag, u

    def constraints(self, X, q, n):
        """Two rows a lower pair, one a higher pair and a driver; zero when closed."""
        rows = [row for pair in self.pairs for row in self.closing(X, pair, n)]
        return rows + [self.driven(X, driver, n) - value for driver, value in zip(self.it.drivers, q, strict=True)]

    def closing(self, X, pair, n):
        """The rows of a pair."""
        if pair.kind == "R":
            (xi, zi), (xj, zj) = self.pose(X, pair.i, n), self.pose(X, pair.j, n)
            gap = xi + self.it.local(pair.i, pair.point) * zi - xj - self.it.local(pair.j, pair.point) * zj
            return [gap.real, gap.imag]
        if pair.kind == "P":
            turned = (
                self.pose(X, pair.j, n)[1] * np.conj(self.pose(X, pair.i, n)[1]) * n.exp(-n.real(pair.slide.turned))
            )
            return [turned.imag, self.slid(X, pair.slide, n)[1]]
        return [self.mesh(X, pair.mesh, n)]

    def driven(self, X, driver, n):
        """Where a driver is."""
        if driver.kind == "turn":
            return self.angle(X, driver.link) - self.angle(X, driver.base)
        return self.slid(X, self.it.slide(driver.joint), n)[0]

    def mesh(self, X, mesh, n):
        a = self.angle(X, mesh.i) - self.angle(X, mesh.carrier)
        b = self.slid(X, self.it.slide(mesh.slide), n)[0] if mesh.slide else None
        if b is None:
            b = self.angle(X, mesh.j) - self.angle(X, mesh.carrier)
        if mesh.kind == "cam":
            want = np.vectorize(lambda angle: run_of(mesh.law, angle, n))(a) if n is Floats else run_of(mesh.law, a, n)
            gap = b - want - n.real(mesh.offset)
            return gap if mesh.slide else n.exp(gap).imag  # a swinging follower does not mind full turns
        return b - n.real(mesh.ratio) * a - n.real(mesh.offset)

    def drives(self, time, n):
        """Places, speeds and accelerations of all drivers."""
        q = []
        for number, d in enumerate(self.it.drivers):
            start = n.real(d.at if number else self.began)
            rate, acceleration = n.real(d.rate), n.real(d.acceleration)
            q.append(
                (
                    start + d.sense * time * (rate + acceleration * time / 2),
                    d.sense * (rate + acceleration * time),
                    d.sense * acceleration,
                )
            )
        return q

    def time(self, place, n):
        """When the first driver comes to a place."""
        d = self.it.driver
        rate, acceleration = n.real(d.rate), n.real(d.acceleration)
        way = d.sense * (n.real(place) - n.real(self.began))
        root = (rate**2 + 2 * acceleration * way) ** n.real(0.5)
        return 2 * way / (rate + root) if way else n.real(0)

    # the walk, in float64

    def walked(self, q):
        """All coordinates at a place of the first driver, from the sketch on in small steps."""
        nearest = min(self.known, key=lambda place: abs(place - q), default=None)
        if nearest is None:
            nearest = self.it.sketch.at
            self.known[nearest] = self._newton(self._sketched(), nearest)
        X, place, before = self.known[nearest], nearest, None
        stride = STRIDE if self.it.driver.kind == "turn" else STRIDE / 20
        steps = max(1, int(np.ceil(abs(q - place) / stride)))
        for step in range(1, steps + 1):
            here = place + (q - place) * step / steps
            guess = X if before is None else 2 * X - before
            before, X = X, self._newton(guess, here)
        self.known[q] = X
        return X

    def _sketched(self):
        """Where the sketch was understood to show the links, angles within half a turn but for drivers'."""
        law = DriverMotion(self.it.sketch.at, 1.0, 0.0, 1)
        motion = compute_motion(self.it, self.motion.kernels, np.array([self.it.sketch.at]), law)
        X = np.zeros(self.size)
        for name, i in self.at_row.items():
            x, z = motion.poses[name].x[0], motion.poses[name].z[0]
            X[i : i + 3] = x.real, x.imag, np.angle(z)
        places = dict(
            zip((d.link for d in self.it.drivers), (self.it.sketch.at, *(d.at for d in self.it.others)), strict=True)
        )
        for driver in self.it.cranks:  # a driver's own angle is not brought within half a turn
            if driver.kind == "turn":
                X[self.at_row[driver.link] + 2] = places[driver.link]
        return X

    def _newton(self, X, place):
        q = [drive[0] for drive in self.drives(self.time(place, Floats), Floats)]
        shift = 1e-7 * np.eye(self.size)
        for _ in range(20):
            both = np.concatenate([X[:, None] + shift, X[:, None] - shift, X[:, None]], axis=1)
            rows = [np.broadcast_to(row, both.shape[1]) for row in self.constraints(both, q, Floats)]
            gaps = np.array(rows)
            jacobian = (gaps[:, : self.size] - gaps[:, self.size : -1]) / 2e-7
            step = np.linalg.solve(jacobian, -gaps[:, -1])
            X = X + step
            if np.max(np.abs(step)) < 1e-13:
                break
        assert np.max(np.abs(step)) < 1e-9, "the walk has lost its way"
        return X

    # the answers, in 60 digits

    def residuals(self, X, q):
        return mp.matrix(self.constraints(X, q, Digits()))

    def jacobian(self, X):
        """Of the rows of each pair and driver by the coordinates of the links that it joins."""
        J, n, row = mp.matrix(self.size, self.size), Digits(), 0
        parts = [
            ({pair.i, pair.j, *((pair.mesh.carrier,) if pair.mesh else ())}, self.closing, pair) for pair in self.pairs
        ]
        parts += [({d.base, d.link}, lambda *given: [self.driven(*given)], d) for d in self.it.drivers]
        for links, rows_of, part in parts:
            for j in (self.at_row[name] + k for name in links - {FRAME} for k in range(3)):
                here = X[j]
                X[j] = here + self.step
                more = rows_of(X, part, n)
                X[j] = here - self.step
                less = rows_of(X, part, n)
                X[j] = here
                slopes = [(one - other) / (2 * self.step) for one, other in zip(more, less, strict=True)]
                for k, slope in enumerate(slopes, row):
                    J[k, j] = slope
            row += len(slopes)
        return J

    def begun(self, place):
        """Where Newton's method in many digits begins."""
        return mp.matrix([mp.mpf(float(x)) for x in self.walked(place)])

    def at(self, k):
        """Places, velocities, accelerations and multipliers at position k."""
        place = float(self.motion.q[k])
        n = Digits()
        drives = self.drives(self.time(place, n), n)
        q = [drive[0] for drive in drives]
        X = self.begun(place)
        for number in range(KEPT * self.rounds):
            missed = self.residuals(X, q)
            if mp.norm(missed, mp.inf) < mp.mpf(10) ** (8 - self.digits):
                break
            if number % KEPT == 0:
                J = self.jacobian(X)
            X = X - solved(J, missed)
        assert mp.norm(self.residuals(X, q), mp.inf) < mp.mpf(10) ** -40
        J = self.jacobian(X)
        asked = [mp.matrix(self.size, 1) for _ in range(2)]
        for order in (1, 2):
            for row, drive in enumerate(drives, self.size - len(drives)):
                asked[order - 1][row] = drive[order]
        V = solved(J, asked[0])
        bend = self.residuals(X + self.bend * V, q) - 2 * self.residuals(X, q) + self.residuals(X - self.bend * V, q)
        A = solved(J, asked[1] - bend / self.bend**2)
        pushing = self.pushing(J, X).T
        missing = self.missing(X, V, A)
        multipliers = solved(pushing, missing)
        radial = self.radial(X, multipliers)
        return X, V, A, multipliers if radial is None else solved(pushing, missing - radial)

    def row_of(self, pair):
        """The first row of a pair."""
        return sum(2 if other.lower else 1 for other in self.pairs[: self.pairs.index(pair)])

    def touching(self, X, mesh):
        """Where a higher pair touches, the direction in which it pushes link j, and the same for the line of axes.

        None for a swinging follower of a cam: its law does not say where it touches.
        """
        n = Digits()
        (xc, zc) = self.pose(X, mesh.carrier)
        axis = xc + zc * self.it.local(mesh.carrier, self.it.shared(mesh.carrier, mesh.i))
        if mesh.kind == "gear":
            other = xc + zc * self.it.local(mesh.carrier, self.it.shared(mesh.carrier, mesh.j))
            big = abs(mp.mpf(mesh.ratio))  # radius of i in radii of j
            line = (other - axis) / abs(other - axis)
            if mesh.ratio < 0:  # outer: between the axes
                return axis + (other - axis) * big / (big + 1), 1j * line, line
            # inner: beyond the smaller wheel's axis
            return axis + (other - axis) * big / (big - 1), 1j * line, -line
        if not mesh.slide:
            return None
        slide = self.it.slide(mesh.slide)
        _, _, u = self.slid(X, slide, n)
        forward = u if slide.runner == mesh.j else -u
        if mesh.kind == "rack":
            # the wheel's lowest point, seen with the rack running to the right under a positive ratio
            away = -1j * forward * (1 if mesh.ratio > 0 else -1)
            return axis + abs(mp.mpf(mesh.ratio)) * away, forward, away
        angle = self.angle(X, mesh.i)
        slope = (run_of(mesh.law, angle + self.step, n) - run_of(mesh.law, angle - self.step, n)) / (2 * self.step)
        return axis - 1j * slope * forward, forward, None

    def pushing(self, J, X):
        """The Jacobian with the rows of teeth and cams as forces at the place where they touch."""
        P = J.copy()
        for pair in self.pairs:
            touching = None if pair.lower else self.touching(X, pair.mesh)
            if touching is not None:
                point, along, _ = touching
                row = self.row_of(pair)
                P[row, :] = mp.matrix(1, self.size)
                for name, sense in ((pair.mesh.i, -1), (pair.mesh.j, 1)):
                    self.act(P, row, X, name, sense * along, point)
        return P

    def act(self, P, row, X, name, force, point):
        if name != FRAME:
            i = self.at_row[name]
            arm = point - self.pose(X, name)[0]
            for column, value in enumerate((force.real, force.imag, (mp.conj(arm) * force).imag), i):
                P[row, column] += value

    def radial(self, X, multipliers):
        """What teeth do along the line of the axes: |force| tan(pressure) on both wheels, away from one another."""
        total, any_at_all = mp.matrix(1, self.size), False
        for pair in self.pairs:
            if pair.kind in ("G", "K") and pair.mesh.pressure:
                any_at_all = True
                point, _, line = self.touching(X, pair.mesh)
                size = abs(multipliers[self.row_of(pair)]) * mp.tan(mp.mpf(pair.mesh.pressure))
                for name, sense in ((pair.mesh.i, -1), (pair.mesh.j, 1)):
                    self.act(total, 0, X, name, sense * size * line, point)
        return total.T if any_at_all else None

    def missing(self, X, V, A):
        """What the constraints must supply on every coordinate: inertia less weights, loads and springs."""
        Q = mp.matrix(self.size, 1)

        def add(name, force, arm, moment):
            i = self.at_row[name]
            Q[i] += force.real
            Q[i + 1] += force.imag
            Q[i + 2] += moment + (mp.conj(arm) * force).imag

        for name, i in self.at_row.items():
            link, z = self.it.links[name], self.pose(X, name)[1]
            arm = link.centre * z
            a = mp.mpc(A[i], A[i + 1]) + (1j * A[i + 2] - V[i + 2] ** 2) * arm
            add(name, link.mass * (a - self.it.gravity), arm, link.inertia * A[i + 2])
        for load in self.it.loads:
            if load.working_stroke_only and not self.working(X, V):
                continue
            z, size = self.pose(X, load.link)[1], self.tabled(load.table, X)
            add(load.link, -size * load.force * (z if load.follows else 1), load.at * z, -size * mp.mpf(load.moment))
        for element in self.it.elements:
            self.pull(element, X, V, add)
        return Q

    def tabled(self, table, X):
        """A load's size by its table against the crank's angle, between two of its rows."""
        if table is None:
            return mp.mpf(1)
        assert table.against == "crank angle"
        angle = self.angle(X, self.it.driver.link) % (2 * mp.pi)
        rows = list(zip(map(mp.mpf, table.arguments), map(mp.mpf, table.values), strict=True))
        for (a, low), (b, high) in pairwise(rows):
            if a <= angle <= b:
                return low + (high - low) * (angle - a) / (b - a)
        return rows[0][1] if angle < rows[0][0] else rows[-1][1]

    def working(self, X, V):
        """Whether the output goes the way of its working stroke."""
        n, link = Digits(), self.strokes.link
        for slide in self.it.slides:
            if {slide.carrier, slide.runner} == {FRAME, link}:
                speed = (self.slid(X + self.step * V, slide, n)[0] - self.slid(X - self.step * V, slide, n)[0]) / (
                    2 * self.step
                )
                break
        else:
            speed = V[self.at_row[link] + 2]
        return speed * self.strokes.working[0].run > 0

    def pull(self, element, X, V, add):
        """The loads of a spring or damper, from its length and the speed of its ends."""
        if element.turns:
            twist = self.angle(X, element.j) - self.angle(X, element.i)
            speed = self.angle(V, element.j) - self.angle(V, element.i)
            moment = self.law(element, twist, speed)
            for name, sense in ((element.i, -1), (element.j, 1)):
                if name != FRAME:
                    add(name, mp.mpc(0), mp.mpc(0), sense * moment)
            return
        ends = []
        for name, at in ((element.i, element.at_i), (element.j, element.at_j)):
            (x, z), (more, ahead), (less, behind) = (
                self.pose(Y, name) for Y in (X, X + self.step * V, X - self.step * V)
            )
            ends.append((x + at * z, (more + at * ahead - less - at * behind) / (2 * self.step), at * z))
        way = ends[1][0] - ends[0][0]
        length = abs(way)
        along = way / length
        longer = (mp.conj(along) * (ends[1][1] - ends[0][1])).real
        pull = self.law(element, length, longer)
        for name, sense, end in ((element.i, -1, ends[0]), (element.j, 1, ends[1])):
            if name != FRAME:
                add(name, sense * pull * along, end[2], mp.mpf(0))

    @staticmethod
    def law(element, size, speed):
        """The force or moment of a spring or damper by its length or angle, and by how fast it grows."""
        if isinstance(element, Damper):
            return element.linear * speed + element.quadratic * speed**2 * mp.sign(speed)
        size -= mp.mpf(element.free)
        if element.turns:
            size -= 2 * mp.pi * mp.nint(size / (2 * mp.pi))
        return element.preload + element.rate * size + element.damping * speed


def compared(it, structure, motion, reactions, numbers, strokes=None):
    """The largest deviation of every kind of quantity from 60 digits, against its largest value in the positions."""
    body = Multibody(it, structure, motion, strokes)
    found, expected = {}, {}

    def compare(kind, mine, reference):
        found.setdefault(kind, []).append(complex(mine))
        expected.setdefault(kind, []).append(reference)

    for k in numbers:
        X, V, A, multipliers = body.at(k)
        for name, i in body.at_row.items():
            turning, z = motion.link(name), body.pose(X, name)[1]
            for local in (it.links[name].centre, *it.links[name].points.values()):
                point, arm = motion.point(name, local), local * z
                compare("x", point.x[k], mp.mpc(X[i], X[i + 1]) + arm)
                compare("v", point.v[k], mp.mpc(V[i], V[i + 1]) + 1j * V[i + 2] * arm)
                compare("a", point.a[k], mp.mpc(A[i], A[i + 1]) + (1j * A[i + 2] - V[i + 2] ** 2) * arm)
            compare("direction", motion.poses[name].z[k], z)
            compare("omega", turning.omega[k], V[i + 2])
            compare("epsilon", turning.epsilon[k], A[i + 2])
        for pair in structure.pairs:
            row = body.row_of(pair)
            reaction = reactions.of(pair.name)
            if pair.kind == "R":
                compare("force", reaction.onto(pair.i)[k], mp.mpc(multipliers[row], multipliers[row + 1]))
            elif pair.kind == "P":
                across = 1j * body.pose(X, pair.i)[1] * mp.expj(pair.slide.direction)
                compare("force", reaction.onto(pair.j)[k], multipliers[row + 1] * across)
                compare("couple", (reaction.couple if reaction.on == pair.j else -reaction.couple)[k], multipliers[row])
            else:
                touching = body.touching(X, pair.mesh)
                if touching is None:
                    couple = reaction.couple if reaction.on == pair.mesh.j else reaction.back
                    compare("couple", couple[k], multipliers[row])
                    continue
                point, along, line = touching
                force = multipliers[row] * along
                if pair.mesh.pressure:
                    force += abs(multipliers[row]) * mp.tan(mp.mpf(pair.mesh.pressure)) * line
                compare("x", reaction.at[k], point)
                compare("force", reaction.onto(pair.mesh.j)[k], force)
        first = body.size - len(it.drivers)
        for row, balance in enumerate(reactions.balances, first):
            compare(f"balance, {balance.driver.kind}", balance.generalized[k], multipliers[row])
    worst = {}
    for kind, values in found.items():
        largest = max(abs(v) for v in expected[kind])
        error = max(abs(mp.mpc(a) - b) for a, b in zip(values, expected[kind], strict=True))
        worst[kind] = float(error / largest) if largest > mp.mpf(10) ** -30 else float(error)
    return worst
