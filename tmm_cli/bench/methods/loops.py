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

from tmm_cli.bench.methods.case import Answers, Case, answers
from tmm_cli.bench.methods.following import Nodes, close, follow
from tmm_cli.bench.methods.rows import Rows, by_links
from tmm_cli.groups.linear import solve
from tmm_cli.groups.sequence import frame_state
from tmm_cli.groups.state import Accel, Pose, Poses, Rate, Wrench
from tmm_cli.linkage import FRAME
from tmm_cli.pairs.sliding import Guided
from tmm_cli.structure.assur import Pair
from tmm_cli.vectors import Real, Vector, dot, unit


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
    def rows(self) -> Rows:
        """Their equations."""
        return Rows(self.case.linkage, self.cut, size=self.case.size)

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
        found = {FRAME: frame_state(q)[0]}
        for branch, s in zip(self.tree, self.all(X, q), strict=True):
            before, pair, slide = found[branch.before], branch.pair, branch.pair.slide
            if slide is None:
                unwrapped = before.turned + s
                z = unit(unwrapped)
                x = before.at(local(branch.before, pair.point)) - local(branch.own, pair.point) * z
            elif branch.runs:
                unwrapped = before.turned + slide.turned
                z = unit(unwrapped)
                x = before.at(slide.through + s * unit(slide.direction)) - slide.at * z
            else:
                unwrapped = before.turned - slide.turned
                z = unit(unwrapped)
                x = before.at(slide.at) - (slide.through + s * unit(slide.direction)) * z
            found[branch.own] = Pose(x, z, unwrapped)
        return found

    def sketched(self, poses: dict[str, Pose], q: Real) -> Real:
        columns = []
        for k in self.free:
            branch = self.tree[k]
            slide = branch.pair.slide
            if slide is None:
                columns.append(poses[branch.own].turned - poses[branch.before].turned)
            else:
                here = Guided.at(slide, poses)
                columns.append(dot(here.u, here.off))
        return np.stack(columns, axis=-1)

    def residuals(self, X: Real, q: Real) -> Real:
        return self.rows.residuals(self.poses(X, q), {})

    # motion

    def matrix(self, X: Real, q: Real) -> Real:
        poses = self.poses(X, q)
        return (self.rows.matrix(poses) @ self.transformation(poses))[..., self.free]

    def transformation(self, poses: Poses) -> Real:
        """What a unit of each coordinate, the driver's too, does to x, y and angle of the links that it moves.

        (positions, 3 links, coordinates): matrix R of Garcia de Jalon and Bayo.
        """
        R = np.zeros((len(poses[FRAME].x), 3 * len(self.tree), len(self.tree)))
        for k, branch in enumerate(self.tree):
            slide = branch.pair.slide
            for n, link in enumerate(self.case.linkage.moving):
                if k not in self.paths[link]:
                    continue
                if slide is None:
                    moved = 1j * (poses[link].x - self._place(branch.pair, branch.own, poses))
                    R[:, 3 * n + 2, k] = 1.0
                else:
                    moved = Guided.at(slide, poses).u * (1 if branch.runs else -1)
                R[:, 3 * n, k], R[:, 3 * n + 1, k] = moved.real, moved.imag
        return R

    def _place(self, pair: Pair, link: str, poses: Poses) -> Vector:
        return poses[link].at(self.case.linkage.local(link, pair.point))

    def states(self, poses: Poses, speeds: list[Real], bends: list[Real]) -> tuple[dict[str, Rate], dict[str, Accel]]:
        """Rates and accelerations of all links from those of the coordinates."""
        _, rest, still = frame_state(poses[FRAME].x)
        first, second = {FRAME: rest}, {FRAME: still}
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
                u = Guided.at(slide, poses).u
                sense = 1 if branch.runs else -1
                v = v + sense * s1 * u
                # Coriolis; a carrier sees its runner's point run backward through its own points
                a = a + sense * (2j * w * s1 * u + s2 * u)
            first[branch.own] = Rate.through(v, w, arm)
            second[branch.own] = Accel.through(a, e, w, arm)
        return first, second

    # forces

    def forces(self, poses: Poses, J: Real, Q: Real, on: Mapping[str, Wrench]) -> tuple[dict[str, Vector], Real]:
        """Reactions on the second link of each pair, and what balances the driver."""
        cut = solve(np.swapaxes(J[..., self.free], -1, -2), -Q[..., self.free])
        balancing = -(Q[:, self.given] + np.einsum("nr,nr->n", J[..., self.given], cut))
        borne = {link: wrench.force for link, wrench in on.items()}
        found = self.rows.reactions(poses, cut)
        for pair in self.cut:
            borne[pair.j] = borne[pair.j] + found[pair.name]
            borne[pair.i] = borne[pair.i] - found[pair.name]
        for branch in reversed(self.tree):
            all_of_it = borne[branch.own]
            found[branch.pair.name] = -all_of_it if branch.own == branch.pair.j else all_of_it
            borne[branch.before] = borne[branch.before] + all_of_it
        return found, balancing


@lru_cache(maxsize=8)
def _followed(case: Case) -> tuple[Loops, Nodes]:
    """The walk along the driver's way, once for all tolerances."""
    loops = Loops(case)
    return loops, follow(case, loops)


def prepare(tolerance: float, case: Case) -> Callable[[Real], Answers]:
    """The method that stops when every loop closes within the tolerance, a share of the linkage's size (or rad)."""
    loops, nodes = _followed(case)

    def at(q: Real) -> Answers:
        poses = loops.poses(close(loops, nodes.near(q), q, tolerance), q)
        links, R = loops.rows.matrix(poses), loops.transformation(poses)
        J = links @ R
        free, given = J[..., loops.free], J[..., loops.given]
        still = np.zeros(len(q))
        speeds = loops.all(solve(free, -given), still + 1)
        first, bent = loops.states(poses, speeds, [still] * len(speeds))
        accels = by_links(case.linkage, {name: (accel.a, accel.e) for name, accel in bent.items()})
        bends = np.einsum("nrc,nc->nr", links, accels) + loops.rows.velocity_terms(poses, first)
        first, second = loops.states(poses, speeds, loops.all(solve(free, -bends), still))
        motion = case.motion(q, poses, first, second)
        on = case.wrenches(motion)
        loads = by_links(case.linkage, {name: (wrench.force, wrench.moment) for name, wrench in on.items()})
        forces, balancing = loops.forces(poses, J, np.einsum("nck,nc->nk", R, loads), on)
        return answers(case, motion, forces, balancing)

    return at
