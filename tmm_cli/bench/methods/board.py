"""The drawing board: a student with ruler and compasses reads each constructed point to a grid on the paper.

The scales are those of the sheets that tmm draws, chosen at each position. The Assur groups are drawn in order: points
of the mechanism, ends of the vectors of the velocity plan, then of the acceleration plan; then the force polygons, from
the last group to the first. Each construction starts from what was drawn before, so errors propagate as on paper:
directions come from drawn links, normal accelerations from measured velocities, moment arms from the drawing. Pivots on
the frame and lengths of links are exact. I. I. Artobolevsky, Theory of Mechanisms and Machines, ch. 4, 5 and 13.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.bench.methods.case import Case, MethodAnswers, build_answers_from_forces
from tmm_cli.mechanics.forces import Reactions, solve_reactions
from tmm_cli.mechanics.groups import (
    Accel,
    Accels,
    GroupReactions,
    PairReaction,
    Placement,
    Pose,
    Poses,
    Rate,
    Rates,
    WrappedSolver,
    Wrench,
    driven_state,
    drives_at,
    frame_state,
)
from tmm_cli.mechanics.kinematics import Motion, compute_motion
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import Real, Vector, cross, unit
from tmm_cli.mechanics.plans import Plan, acceleration_plan, force_plans, sheet_scale, velocity_plan


def snap_to_grid(value: Vector, grid: Real) -> Vector:
    """Round both components of vectors to multiples of the grid spacing."""
    return grid * (np.round(value.real / grid) + 1j * np.round(value.imag / grid))


@dataclass(frozen=True)
class BoardScales:
    """Scales of the drawings at each position, SI units per mm, (positions,).

    Attributes:
        x: scale of the mechanism, m/mm.
        v, a: scales of the velocity plan and the acceleration plan.
        forces: scales of the force polygons, N/mm, by the links of the polygon.
    """

    x: Real
    v: Real
    a: Real
    forces: Mapping[tuple[str, ...], Real]  # by the links of the polygon

    @classmethod
    def of(cls, case: Case, motion: Motion, reactions: Reactions) -> BoardScales:
        """Return the scales that tmm chooses for its own sheets."""
        count = range(len(motion.q))
        fixed = [case.linkage.local(FRAME, h.point) for h in case.linkage.hinges if FRAME in h.links]
        moving = [motion.named(point).x for point in case.linkage.moving_points]
        x = [sheet_scale([*fixed, *(complex(at[k]) for at in moving)], pad=30.0)[1] for k in count]
        v = [_scale(velocity_plan(motion, k)) for k in count]
        a = [_scale(acceleration_plan(motion, k)) for k in count]
        forces: dict[tuple[str, ...], list[float]] = {}
        for k in count:
            for polygon in force_plans(reactions, k):
                forces.setdefault(polygon.links, []).append(_scale(polygon.plan))
        return cls(np.array(x), np.array(v), np.array(a), {links: np.array(mu) for links, mu in forces.items()})


def _scale(plan: Plan) -> float:
    points = [*plan.ends.values(), *(end for vector in plan.vectors for end in (vector.start, vector.end))]
    return sheet_scale(points)[1]


@dataclass(frozen=True)
class PolygonSolver(WrappedSolver):
    """Solver of an Assur group whose reactions are read from its force polygon; grid: accuracy of reading, N."""

    grid: Real

    def reactions(self, at: Placement, poses: Poses, on: tuple[Wrench, ...]) -> GroupReactions:
        laid_off = tuple(Wrench(snap_to_grid(wrench.force, self.grid), wrench.moment) for wrench in on)
        reactions = self.inner.reactions(at, poses, laid_off)
        return replace(
            reactions,
            outer=tuple(map(self._read_force, reactions.outer)),
            inner=tuple(map(self._read_force, reactions.inner)),
        )

    def _read_force(self, reaction: PairReaction) -> PairReaction:
        return replace(reaction, force=snap_to_grid(reaction.force, self.grid))


@dataclass(frozen=True)
class Board:
    """A drawing of the mechanism and its motion plans at all positions, made point by point on a grid.

    Attributes:
        case: the linkage.
        x: grid spacing of positions, m.
        v: grid spacing of velocities, per unit of the driver speed.
        a: grid spacing of accelerations, per unit of the square of the driver speed.
    """

    case: Case
    x: Real
    v: Real
    a: Real

    def _direction_points(self, link: str) -> tuple[str, str] | None:
        """Return the two points of a link that show its direction: the farthest apart. None if it has only one."""
        points = self.case.linkage.links[link].points
        fixed = self.case.linkage.links[FRAME].points
        pairs = [
            (point, other_point)
            for point in points
            for other_point in points
            if point != other_point and points[point] != points[other_point]
        ]
        # from a pivot on the frame where there is one
        return max(pairs, key=lambda p: (p[0] in fixed, abs(points[p[0]] - points[p[1]])), default=None)

    def _find_sliding_partner(self, link: str, drawn: Mapping[str, object]) -> tuple[str, float] | None:
        """Return a link, already drawn, that forms a prismatic pair with this one, and the angle (rad) between them.

        Return None if there is no such link.
        """
        for slide in self.case.linkage.slides:
            if slide.runner == link and slide.carrier in drawn:
                return slide.carrier, slide.turned
            if slide.carrier == link and slide.runner in drawn:
                return slide.runner, -slide.turned
        return None

    def _sort_links(self, links: tuple[str, ...]) -> list[str]:
        """Sort the links so that those with two points come first. Their direction is that of the line through these
        points.
        """
        return sorted(links, key=lambda link: self._direction_points(link) is None)

    def _is_fixed(self, point: str) -> bool:
        return point in self.case.linkage.links[FRAME].points

    def _first_point(self, link: str) -> complex:
        """Return the first point of a link in its own axes; the origin if it has none."""
        return next(iter(self.case.linkage.links[link].points.values()), 0j)

    def draw_poses(self, links: tuple[str, ...], exact_poses: Poses, known: Poses) -> dict[str, Pose]:
        """Draw links on the plan of positions.

        Args:
            links: Names of the links.
            exact_poses: Poses at which they should be drawn.
            known: Poses of the links drawn before.

        Returns:
            Poses of all links drawn so far, as read from the drawing.
        """
        drawn = dict(known)
        for link in self._sort_links(links):
            pose, ends = exact_poses[link], self._direction_points(link)
            if ends is None:
                partner = self._find_sliding_partner(link, drawn)
                z = pose.z if partner is None else drawn[partner[0]].z * unit(partner[1])
                at = self._first_point(link)
                drawn[link] = Pose(snap_to_grid(pose.at(at), self.x) - at * z, z)
                continue
            first_point, second_point = (self.case.linkage.local(link, point) for point in ends)
            start = pose.at(first_point) if self._is_fixed(ends[0]) else snap_to_grid(pose.at(first_point), self.x)
            along = (snap_to_grid(pose.at(second_point), self.x) - start) / (second_point - first_point)
            z = along / np.abs(along)
            drawn[link] = Pose(start - first_point * z, z)
        return drawn

    def draw_velocities(self, links: tuple[str, ...], rates: Rates, poses: Poses, known: Rates) -> dict[str, Rate]:
        """Draw the velocities of links on the velocity plan; return those of all links drawn so far, as read from
        the plan.
        """
        drawn = dict(known)
        for link in self._sort_links(links):
            rate, pose, ends = rates[link], poses[link], self._direction_points(link)
            if ends is None:
                partner = self._find_sliding_partner(link, drawn)
                w = rate.w if partner is None else drawn[partner[0]].w
                arm = self._first_point(link) * pose.z
                drawn[link] = Rate.through(snap_to_grid(rate.at(arm), self.v), w, arm)
                continue
            first_arm, second_arm = (self.case.linkage.local(link, point) * pose.z for point in ends)
            v, u = snap_to_grid(rate.at(first_arm), self.v), snap_to_grid(rate.at(second_arm), self.v)
            drawn[link] = Rate.through(
                v, cross(second_arm - first_arm, u - v) / np.abs(second_arm - first_arm) ** 2, first_arm
            )
        return drawn

    def round_normals(self, links: tuple[str, ...], poses: Poses, rates: Rates) -> dict[str, Rate]:
        """Return the velocities of links, changed so that normal accelerations are read from the grid.

        The normal acceleration of a link of length l is ω² l. The angular velocity ω is changed so that this is a
        multiple of the grid spacing `a`.
        """
        laid = dict(rates)
        for link in links:
            ends = self._direction_points(link)
            if ends is not None:
                first_arm, second_arm = (self.case.linkage.local(link, point) * poses[link].z for point in ends)
                length, rate = np.abs(second_arm - first_arm), rates[link]
                normal = self.a * np.round(rate.w**2 * length / self.a)
                laid[link] = Rate.through(rate.at(first_arm), np.sign(rate.w) * np.sqrt(normal / length), first_arm)
        return laid

    def draw_accelerations(
        self, links: tuple[str, ...], accels: Accels, poses: Poses, rates: Rates, known: Accels
    ) -> dict[str, Accel]:
        """Draw accelerations of links on the acceleration plan; return those of all links drawn so far, as read from
        the plan.
        """
        drawn = dict(known)
        for link in self._sort_links(links):
            accel, pose, w, ends = accels[link], poses[link], rates[link].w, self._direction_points(link)
            if ends is None:
                partner = self._find_sliding_partner(link, drawn)
                e = accel.e if partner is None else drawn[partner[0]].e
                arm = self._first_point(link) * pose.z
                drawn[link] = Accel.through(snap_to_grid(accel.at(arm, w), self.a), e, w, arm)
                continue
            first_arm, second_arm = (self.case.linkage.local(link, point) * pose.z for point in ends)
            b, c = snap_to_grid(accel.at(first_arm, w), self.a), snap_to_grid(accel.at(second_arm, w), self.a)
            e = cross(second_arm - first_arm, c - b) / np.abs(second_arm - first_arm) ** 2
            drawn[link] = Accel.through(b, e, w, first_arm)
        return drawn

    def draw_all(self, q: Real) -> tuple[Motion, tuple[Placement, ...]]:
        """Draw all links and their motion plans, one Assur group after another.

        Returns:
            Motion as read from the drawings, and the positions of each group for its solver.
        """
        linkage = self.case.linkage
        drives = drives_at(linkage, q)
        frame = frame_state(q)
        poses, first, second = {FRAME: frame[0]}, {FRAME: frame[1]}, {FRAME: frame[2]}
        for driver in linkage.cranks:
            pose, rate, accel = driven_state(linkage, driver, drives[driver.link])
            one = (driver.link,)
            poses = self.draw_poses(one, {driver.link: pose}, poses)
            first = self.draw_velocities(one, {driver.link: rate}, poses, first)
            second = self.draw_accelerations(one, {driver.link: accel}, poses, first, second)
        placements = []
        for kernel in self.case.kernels:
            links = kernel.group.links
            at = kernel.place(poses, q, drives)
            poses = self.draw_poses(links, dict(zip(links, at.poses, strict=True)), poses)
            at = replace(at, poses=tuple(poses[link] for link in links))
            rates = kernel.rates(at, poses, first, drives)
            first = self.draw_velocities(links, dict(zip(links, rates, strict=True)), poses, first)
            normal = self.round_normals(links, poses, first)
            accels = kernel.accelerations(at, poses, normal, second, drives)
            second = self.draw_accelerations(links, dict(zip(links, accels, strict=True)), poses, first, second)
            placements.append(at)
        return self.case.motion(q, poses, first, second), tuple(placements)


def prepare_board(millimetres: float, case: Case) -> Callable[[Real], MethodAnswers]:
    """Prepare a solution on the drawing board for a linkage, with points read to `millimetres`."""

    def at(q: Real) -> MethodAnswers:
        exact = compute_motion(case.linkage, case.kernels, q, case.law)
        scales = BoardScales.of(case, exact, solve_reactions(exact, case.structure, case.loads(exact)))
        x, v, a = (millimetres * scale for scale in (scales.x, scales.v, scales.a))
        speed = np.abs(exact.rate)
        motion, placements = Board(case, x, v / speed, a / speed**2).draw_all(q)
        forces = {links: millimetres * scale for links, scale in scales.forces.items()}
        polygons = tuple(PolygonSolver.around(k, forces[k.group.links]) for k in case.kernels)
        motion = replace(motion, kernels=polygons, placements=placements)
        plan = solve_reactions(motion, case.structure, case.loads(motion))
        frames = tuple(replace(f, force=snap_to_grid(f.force, forces[(f.on,)])) for f in plan.frames)
        found = build_answers_from_forces(case, motion, replace(plan, frames=frames))
        assert found.positions and found.velocities and found.accelerations
        return replace(
            found,
            positions={name: snap_to_grid(value, x) for name, value in found.positions.items()},
            velocities={name: snap_to_grid(value, v) for name, value in found.velocities.items()},
            accelerations={name: snap_to_grid(value, a) for name, value in found.accelerations.items()},
        )

    return at
