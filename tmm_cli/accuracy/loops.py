"""Newton's method on loop closure: joint coordinates along a tree of pairs, each pair beside it closes a loop.

R. L. Norton, Design of Machinery, ch. 4 and 7; J. Garcia de Jalon, E. Bayo, Kinematic and Dynamic Simulation of
Multibody Systems, ch. 2 (relative coordinates). There are two equations a loop. One matrix gives places, velocities,
accelerations and, transposed, the forces in the cut pairs; forces in the tree then follow from its leaves to its root.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np

from tmm_cli.accuracy.case import Answers, Case, answers
from tmm_cli.accuracy.following import Nodes, close, follow
from tmm_cli.groups.linear import solve
from tmm_cli.groups.state import Accel, Pose, Rate, Wrench
from tmm_cli.linkage import FRAME
from tmm_cli.structure.assur import Pair
from tmm_cli.vectors import Real, Vector, cross, dot, unit


@dataclass(frozen=True)
class Branch:
    """A pair of the tree: it joins link `own` to one that is nearer to the frame."""

    pair: Pair
    own: str

    @property
    def before(self) -> str:
        return self.pair.other(self.own)

    @property
    def runs(self) -> bool:
        """Whether the own link is the runner of a sliding pair (else it is the carrier)."""
        return self.pair.slide is not None and self.pair.slide.runner == self.own


@dataclass(frozen=True)
class Loops:
    """Coordinates: one a moving link, the angle or run in the pair that joins it to the tree; the driver's is given."""

    case: Case

    @cached_property
    def tree(self) -> tuple[Branch, ...]:
        """Branches from the frame outward, drivers first where there is a choice."""
        structure = self.case.structure
        driving = [structure.driving_pair(driver) for driver in structure.drivers]
        pairs = sorted(structure.pairs, key=lambda pair: pair not in driving)
        reached, found = {FRAME}, []
        while len(reached) <= len(self.case.linkage.moving):
            pair = next(p for p in pairs if len({p.i, p.j} & reached) == 1)
            own = pair.j if pair.i in reached else pair.i
            reached.add(own)
            found.append(Branch(pair, own))
        return tuple(found)

    @cached_property
    def cut(self) -> tuple[Pair, ...]:
        """Pairs beside the tree."""
        inside = [branch.pair for branch in self.tree]
        return tuple(pair for pair in self.case.structure.pairs if pair not in inside)

    @cached_property
    def given(self) -> int:
        """The driver's coordinate."""
        pair = self.case.structure.driving_pair(self.case.linkage.driver)
        return next(k for k, branch in enumerate(self.tree) if branch.pair == pair)

    @cached_property
    def free(self) -> list[int]:
        """The unknown ones."""
        return [k for k in range(len(self.tree)) if k != self.given]

    @cached_property
    def paths(self) -> Mapping[str, frozenset[int]]:
        """Which coordinates move each link."""
        found: dict[str, frozenset[int]] = {FRAME: frozenset()}
        for k, branch in enumerate(self.tree):
            found[branch.own] = found[branch.before] | {k}
        return found

    # places

    def all(self, X: Real, q: Real) -> list[Real]:
        """Unknowns and driver in the order of the tree."""
        columns = list(np.moveaxis(X, -1, 0))
        columns.insert(self.given, q)
        return columns

    def poses(self, X: Real, q: Real) -> dict[str, Pose]:
        local = self.case.linkage.local
        still = np.zeros(len(q))
        found = {FRAME: Pose(still + 0j, still + 1 + 0j, still)}
        for branch, s in zip(self.tree, self.all(X, q), strict=True):
            before, pair, slide = found[branch.before], branch.pair, branch.pair.slide
            if slide is None:
                turn = before.turned + s
                z = unit(turn)
                x = before.at(local(branch.before, pair.point)) - local(branch.own, pair.point) * z
            elif branch.runs:
                turn = before.turned + slide.turned
                z = unit(turn)
                x = before.at(slide.through + s * unit(slide.direction)) - slide.at * z
            else:
                turn = before.turned - slide.turned
                z = unit(turn)
                x = before.at(slide.at) - (slide.through + s * unit(slide.direction)) * z
            found[branch.own] = Pose(x, z, turn)
        return found

    def sketched(self, poses: dict[str, Pose], q: Real) -> Real:
        columns = []
        for k in self.free:
            branch = self.tree[k]
            slide = branch.pair.slide
            if slide is None:
                columns.append(poses[branch.own].turned - poses[branch.before].turned)
            else:
                u, off = _guide(branch.pair, poses)
                columns.append(dot(u, off))
        return np.stack(columns, axis=-1)

    def gaps(self, X: Real, q: Real) -> Real:
        return self._gaps(self.poses(X, q))

    def _gaps(self, poses: Mapping[str, Pose]) -> Real:
        rows: list[Real] = []
        for pair in self.cut:
            if pair.slide is None:
                gap = (self._place(pair, pair.j, poses) - self._place(pair, pair.i, poses)) / self.case.size
                rows += [gap.real, gap.imag]
            else:
                u, off = _guide(pair, poses)
                turned = poses[pair.slide.runner].z * np.conj(poses[pair.slide.carrier].z * unit(pair.slide.turned))
                rows += [np.arctan2(turned.imag, turned.real), cross(u, off) / self.case.size]
        return np.stack(rows, axis=-1)

    def _place(self, pair: Pair, link: str, poses: Mapping[str, Pose]) -> Vector:
        return poses[link].at(self.case.linkage.local(link, pair.point))

    # motion

    def matrix(self, X: Real, q: Real) -> Real:
        return self.jacobian(self.poses(X, q))[..., self.free]

    def jacobian(self, poses: Mapping[str, Pose]) -> Real:
        """Derivatives of the gaps by all coordinates, the driver's too, (positions, rows, links)."""
        J = np.zeros((len(poses[FRAME].x), 2 * len(self.cut), len(self.tree)))
        for k, branch in enumerate(self.tree):
            for number, pair in enumerate(self.cut):
                signs = {link: k in self.paths[link] for link in (pair.i, pair.j)}
                if signs[pair.i] == signs[pair.j]:
                    continue  # both links move as one
                row = 2 * number
                if pair.slide is None:
                    sense = 1 if signs[pair.j] else -1
                    moved = sense * self.moved(branch, poses, self._place(pair, pair.j, poses)) / self.case.size
                    J[:, row, k], J[:, row + 1, k] = moved.real, moved.imag
                else:
                    sense = 1 if signs[pair.slide.runner] else -1
                    u, _ = _guide(pair, poses)
                    here = poses[pair.slide.runner].at(pair.slide.at)
                    J[:, row, k] = sense if branch.pair.slide is None else 0.0
                    J[:, row + 1, k] = sense * cross(u, self.moved(branch, poses, here)) / self.case.size
        return J

    def moved(self, branch: Branch, poses: Mapping[str, Pose], place: Vector) -> Vector:
        """Motion of a point of a link that the branch carries, a unit of the branch's coordinate."""
        if branch.pair.slide is None:
            around: Vector = 1j * (place - self._place(branch.pair, branch.own, poses))
            return around
        u, _ = _guide(branch.pair, poses)
        return u if branch.runs else -u

    def states(
        self, poses: Mapping[str, Pose], speeds: list[Real], bends: list[Real]
    ) -> tuple[dict[str, Rate], dict[str, Accel]]:
        """Rates and accelerations of all links from those of the coordinates."""
        still = np.zeros(len(poses[FRAME].x))
        first, second = {FRAME: Rate(still + 0j, still)}, {FRAME: Accel(still + 0j, still)}
        for branch, s1, s2 in zip(self.tree, speeds, bends, strict=True):
            rate, accel, before = first[branch.before], second[branch.before], poses[branch.before]
            own, slide = poses[branch.own], branch.pair.slide
            if slide is None:
                place = self._place(branch.pair, branch.own, poses)
                w, e = rate.w + s1, accel.e + s2
            else:
                place = poses[slide.runner].at(slide.at)
                w, e = rate.w, accel.e
            arm, v, a = place - own.x, rate.at(place - before.x), accel.at(place - before.x, rate.w)
            if slide is not None:
                u, _ = _guide(branch.pair, poses)
                sense = 1 if branch.runs else -1
                v = v + sense * s1 * u
                # Coriolis; a carrier sees its runner's point run backward through its own points
                a = a + sense * (2j * w * s1 * u + s2 * u)
            first[branch.own] = Rate.through(v, w, arm)
            second[branch.own] = Accel.through(a, e, w, arm)
        return first, second

    def bends(self, poses: Mapping[str, Pose], first: Mapping[str, Rate], second: Mapping[str, Accel]) -> Real:
        """Second derivatives of the gaps in a given motion."""
        rows: list[Real] = []
        still = np.zeros(len(poses[FRAME].x))
        for pair in self.cut:
            if pair.slide is None:
                place = self._place(pair, pair.j, poses)
                on_i, on_j = (second[link].at(place - poses[link].x, first[link].w) for link in (pair.i, pair.j))
                gap = (on_j - on_i) / self.case.size
                rows += [gap.real, gap.imag]
                continue
            i, j = pair.slide.carrier, pair.slide.runner
            u, _ = _guide(pair, poses)
            place = poses[j].at(pair.slide.at)
            v = first[j].at(place - poses[j].x) - first[i].at(place - poses[i].x)
            a = second[j].at(place - poses[j].x, first[j].w) - second[i].at(place - poses[i].x, first[i].w)
            rows += [second[j].e - second[i].e + still, (cross(u, a) - 2 * first[i].w * dot(u, v)) / self.case.size]
        return np.stack(rows, axis=-1)

    # forces

    def forces(self, poses: Mapping[str, Pose], J: Real, on: Mapping[str, Wrench]) -> tuple[dict[str, Vector], Real]:
        """Reactions on the second link of each pair, and what balances the driver."""
        work = []
        for k, branch in enumerate(self.tree):
            total = np.zeros(len(J))
            for link, path in self.paths.items():
                if k in path:
                    total = total + dot(on[link].force, self.moved(branch, poses, poses[link].x))
                    if branch.pair.slide is None:
                        total = total + on[link].moment
            work.append(total)
        Q = np.stack(work, axis=-1)
        cut = solve(np.swapaxes(J[..., self.free], -1, -2), -Q[..., self.free])
        balancing = -(Q[:, self.given] + np.einsum("nr,nr->n", J[..., self.given], cut))
        borne = {link: wrench.force for link, wrench in on.items()}
        found: dict[str, Vector] = {}
        for number, pair in enumerate(self.cut):
            row = 2 * number
            if pair.slide is None:
                force = (cut[:, row] + 1j * cut[:, row + 1]) / self.case.size
            else:
                u, _ = _guide(pair, poses)
                force = 1j * u * cut[:, row + 1] / self.case.size * (1 if pair.j == pair.slide.runner else -1)
            found[pair.name] = force
            borne[pair.j] = borne[pair.j] + force
            borne[pair.i] = borne[pair.i] - force
        for branch in reversed(self.tree):
            all_of_it = borne[branch.own]
            found[branch.pair.name] = -all_of_it if branch.own == branch.pair.j else all_of_it
            borne[branch.before] = borne[branch.before] + all_of_it
        return found, balancing


def _guide(pair: Pair, poses: Mapping[str, Pose]) -> tuple[Vector, Vector]:
    """The direction of a guide, and the running point from the guide's."""
    slide = pair.slide
    assert slide is not None
    carrier = poses[slide.carrier]
    return carrier.z * unit(slide.direction), poses[slide.runner].at(slide.at) - carrier.at(slide.through)


@lru_cache(maxsize=8)
def _followed(case: Case) -> tuple[Loops, Nodes]:
    """The walk along the driver's way, once for all tolerances."""
    loops = Loops(case)
    return loops, follow(case, loops)


def prepare(tolerance: float) -> Callable[[Case], Callable[[Real], Answers]]:
    """The method that stops when every loop closes within the tolerance, a share of the linkage's size (or rad)."""

    def of(case: Case) -> Callable[[Real], Answers]:
        loops, nodes = _followed(case)

        def place(q: Real) -> Real:
            return close(loops, nodes.near(q), q, tolerance)

        def at(q: Real) -> Answers:
            poses = loops.poses(place(q), q)
            J = loops.jacobian(poses)
            free, given = J[..., loops.free], J[..., loops.given]
            still = np.zeros(len(q))
            speeds = loops.all(solve(free, -given), still + 1)
            first, bent = loops.states(poses, speeds, [still] * len(speeds))
            bends = loops.all(solve(free, -loops.bends(poses, first, bent)), still)
            first, second = loops.states(poses, speeds, bends)
            motion = case.motion(q, poses, first, second)
            forces, balancing = loops.forces(poses, J, case.wrenches(motion))
            return answers(case, motion, forces, balancing)

        return at

    return of
