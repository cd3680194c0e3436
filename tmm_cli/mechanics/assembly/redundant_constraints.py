"""Redundant links and pairs, which the structural report leaves out, and mobility by numerical rank.

A link or pair is redundant if the mobility is the same without it, by the rank of the equations at one position. Links
that are rigid to one another count as one body. A tie is a connection of two bodies with a number of conditions, such
as a pair. Redundant links and pairs are left out in this order: links between moving links, then pairs, then links
connected to the frame; later ones of the file before earlier ones, loaded links last. Drivers, output links and links
to which the file attaches others are kept. When no whole link or pair can be left out any more, single conditions of
pairs are left out.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations_with_replacement, islice

import numpy as np

from tmm_cli.mechanics.assembly.sketch_matching import close_from_afar, placed_by_angles, sketched_angles
from tmm_cli.mechanics.errors import MobilityError
from tmm_cli.mechanics.groups import GroupState, NewtonSolver, Pose, drives_at, frame_state
from tmm_cli.mechanics.linkage import FRAME, Linkage
from tmm_cli.mechanics.numerics import CONVERGED, REDUNDANT, SHARED, Real, Vector
from tmm_cli.mechanics.structure import (
    Group,
    PairRedundancy,
    Reduction,
    RedundantLink,
    RigidSet,
    Structure,
    Tie,
    analyse_structure,
    list_pairs,
    list_ties,
    reduce_structure,
)

MOST_TRIES = 3000


@dataclass(frozen=True)
class RemainingLinkage:
    """A linkage in one position, without some of its links and ties (connections of two links).

    Attributes:
        linkage: the complete linkage.
        poses: poses of all links, by name.
        links: names of the remaining links.
        ties: indices of the ties that are left out, as in `list_ties`.
    """

    linkage: Linkage
    poses: Mapping[str, Pose]
    links: tuple[str, ...]
    ties: frozenset[int] = frozenset()

    @cached_property
    def _kernel(self) -> NewtonSolver | None:
        """Solver of the remaining linkage as one group; None if no pairs remain."""
        left, dropped = {*self.links}, {tie for k, tie in enumerate(list_ties(self.linkage)) if k in self.ties}
        names = {tie.name for tie in dropped}
        hinges = []
        for hinge in self.linkage.hinges:
            loose = {tie.b for tie in dropped if tie.name == hinge.point}
            kept = tuple(link for link in hinge.links if link in left and link not in loose)
            if len(kept) > 1:
                attached_to = hinge.attached_to if hinge.attached_to in kept else ""
                hinges.append(replace(hinge, links=kept, attached_to=attached_to))
        remaining = replace(
            self.linkage,
            hinges=tuple(hinges),
            links={name: link for name, link in self.linkage.links.items() if name in left or name == FRAME},
            slides=tuple(s for s in self.linkage.slides if {s.carrier, s.runner} <= left and s.name not in names),
            meshes=tuple(m for m in self.linkage.meshes if {m.i, m.j, m.carrier} <= left and m.name not in names),
        )
        pairs = list_pairs(remaining)
        inner = tuple(pair for pair in pairs if FRAME not in (pair.i, pair.j))
        outer = tuple(pair for pair in pairs if FRAME in (pair.i, pair.j))
        drivers = tuple(d for d in self.linkage.drivers if {d.base, d.link} <= left)
        return NewtonSolver.of(Group(self.moving, inner, outer, 0, "", drivers), remaining) if pairs else None

    @property
    def moving(self) -> tuple[str, ...]:
        """Names of the remaining moving links."""
        return tuple(link for link in self.links if link != FRAME)

    @cached_property
    def equations(self) -> Real:
        """Dimensionless Jacobian of the constraint equations of pairs and drivers, shape (rows, unknowns).

        The rows of the drivers are last.
        """
        if self._kernel is None:
            return np.zeros((0, 3 * len(self.moving)))
        matrix: Real = self._kernel.matrix(self.poses)[0]
        return matrix

    @cached_property
    def undriven(self) -> Real:
        """Jacobian of the pairs, without the rows of the drivers."""
        drivers = 0 if self._kernel is None else len(self._kernel.group.drivers)
        return self.equations[: len(self.equations) - drivers]

    @cached_property
    def rank(self) -> int:
        """Rank of the equations of the pairs."""
        return equation_rank(self.undriven)

    @property
    def redundant(self) -> int:
        """Number of redundant constraints of the pairs."""
        return len(self.undriven) - self.rank

    @property
    def moves(self) -> bool:
        """True if the drivers determine the motion of all remaining links."""
        columns, drivers = self.undriven.shape[1], len(self.linkage.drivers)
        return bool(columns - self.rank == drivers and equation_rank(self.equations) == columns)

    def without(self, links: Iterable[str] = (), ties: Iterable[int] = ()) -> RemainingLinkage:
        """Leave out further links (by name) and ties (by index)."""
        gone = {*links}
        return replace(self, links=tuple(n for n in self.links if n not in gone), ties=self.ties | {*ties})

    def rigid_sets(self) -> list[tuple[str, ...]]:
        """Find the sets of links that are rigid to one another because of the pairs between them alone."""
        free = np.linalg.svd(self.undriven)[2][self.rank :]
        fields = {link: np.zeros(2 * len(free), complex) for link in self.links}
        size = 1.0 if self._kernel is None else float(np.ravel(self._kernel.size)[0])
        for k, link in enumerate(self.moving):
            x, y, turn = (free[:, 3 * k + coordinate] for coordinate in range(3))
            origin = complex(np.ravel(self.poses[link].x)[0]) / size
            fields[link] = np.concatenate([x + 1j * y - 1j * turn * origin, turn])
        sets = _group_by_velocity(fields)
        if sets == [self.links]:  # smaller sets may have the same velocities in this one position only
            return sets
        return [rigid for links in sets for rigid in replace(self, links=links).rigid_sets()]


def equation_rank(matrix: Real) -> int:
    """Return the rank of the Jacobian of constraint equations, whose rows are dimensionless."""
    return int(np.linalg.matrix_rank(matrix, rtol=REDUNDANT)) if matrix.size else 0


def _group_by_velocity(fields: Mapping[str, Vector]) -> list[tuple[str, ...]]:
    """Find sets of two or more links that have the same velocities in all possible motions.

    fields: for each link, by name, its velocities in these motions: that of its point at the origin of the drawing, and
    the angular velocity.
    """
    sets: list[list[str]] = []
    for link, field in fields.items():
        like = next((s for s in sets if np.max(np.abs(fields[s[0]] - field), initial=0.0) < SHARED), None)
        if like is None:
            sets.append([link])
        else:
            like.append(link)
    return [tuple(links) for links in sets if len(links) > 1]


class _Selection:
    """Leaves redundant links and pairs out of a linkage, one by one."""

    def __init__(self, linkage: Linkage, poses: Mapping[str, Pose]) -> None:
        self.left = RemainingLinkage(linkage, poses, tuple(linkage.links))
        self.among_rigid = {links: replace(self.left, links=links).redundant for links in self.left.rigid_sets()}
        self.reduction = Reduction(tuple(RigidSet(links, number) for links, number in self.among_rigid.items()))
        self.every = list(list_ties(linkage))
        self.links: list[RedundantLink] = []

    def excess(self, left: RemainingLinkage) -> int:
        """Return the number of redundant constraints of a remaining linkage.

        Those within sets of links that are rigid to one another are not counted, because each set counts as one link.
        """
        remaining_links = {*left.links}
        return left.redundant - sum(
            number for links, number in self.among_rigid.items() if remaining_links.issuperset(links)
        )

    @property
    def ties(self) -> list[int]:
        """Indices of the ties (connections) that remain between the bodies, the last one of the file first."""
        gone = replace(self.reduction, links=tuple(self.links)).touched(self.every) | self.left.ties
        return [k for k in reversed(range(len(self.every))) if k not in gone]

    def leave_links(self, bodies: Iterable[str]) -> None:
        """Leave redundant links out. bodies: names of the links, or sets of rigid links, that are tried one after
        another.
        """
        for body in bodies:
            members = self.reduction.members(body)
            trial = self.left.without(members)
            excess = self.excess(self.left)
            if excess and self.excess(trial) < excess and trial.moves:
                self.links.append(RedundantLink(members, excess - self.excess(trial)))
                self.left = trial

    def leave_pairs(self) -> None:
        """Leave out every pair whose constraints are all redundant, except the pairs named by `_pairs_to_keep`."""
        stay = _pairs_to_keep(self.left.linkage)
        for k in self.ties:
            constraints = self.every[k].constraints
            if constraints > self.excess(self.left) or self.every[k].name in stay:
                continue
            trial = self.left.without(ties=[k])
            if self.left.redundant - trial.redundant == constraints and trial.moves:
                self.left = trial


def find_reduction(linkage: Linkage, poses: Mapping[str, Pose], structure: Structure) -> Reduction | None:
    """Find redundant links and pairs without which all groups of the linkage are Assur groups.

    Returns:
        The links, pairs and conditions that the structural report leaves out; None if no such choice was found.
    """
    selection = _Selection(linkage, poses)
    between, on_frame = _removable_bodies(linkage, selection.reduction)
    selection.leave_links(between)
    selection.leave_pairs()
    selection.leave_links(on_frame)
    links = sorted(selection.links, key=lambda redundant: linkage.moving.index(redundant.links[0]))
    whole_pairs = {k: selection.every[k].constraints for k in selection.left.ties}
    single = combinations_with_replacement(selection.ties, selection.excess(selection.left))
    for drop in islice(single, MOST_TRIES):
        conditions = whole_pairs | {k: drop.count(k) for k in drop}
        reduction = replace(selection.reduction, links=tuple(links), conditions=conditions)
        possible = all(number <= selection.every[k].constraints for k, number in conditions.items())
        if possible and reduce_structure(linkage, structure, reduction) is not None:
            return reduction
    return None


def _pairs_to_keep(linkage: Linkage) -> set[str]:
    """Return the names of pairs that must stay in the structural report even if they are redundant.

    They are the pairs of drivers, and the pairs that join gears, cams and followers to their carriers.
    """
    on_carrier = {linkage.shared(link, mesh.carrier) for mesh in linkage.meshes for link in (mesh.i, mesh.j)}
    slides = {mesh.slide for mesh in linkage.meshes}
    return {driver.joint for driver in linkage.drivers} | {name for name in on_carrier | slides if name}


def _removable_bodies(linkage: Linkage, reduction: Reduction) -> tuple[Sequence[str], Sequence[str]]:
    """Return the links, or sets of rigid links, that may be left out of the structural report.

    They are returned in two lists, in the order in which they are tried: those between moving links, and those
    connected to the frame.
    """
    on_frame = [n for n in linkage.moving if linkage.hinged_to_frame(n) or linkage.slides_on_frame(n)]
    driving = {link for driver in linkage.drivers for link in (driver.base, driver.link)}
    outputs = [linkage.output_carrier(output.link) for output in linkage.outputs]
    outputs = outputs or [link for link in on_frame if link not in driving][-1:]
    carrying = [hinge.attached_to for hinge in linkage.hinges if hinge.attached_to]
    stay = {reduction.body(link) for link in (FRAME, *driving, *outputs, *carrying)}
    loaded = {reduction.body(link) for load in linkage.loads for link in (load.link, load.base)}
    bodies = [body for body in reversed(reduction.bodies(linkage.moving)) if body not in stay]
    bodies.sort(key=lambda body: body in loaded)
    held = {reduction.body(link) for link in on_frame}
    return [body for body in bodies if body not in held], [body for body in bodies if body in held]


# Mobility by numerical rank, for a linkage that is locked by the count but movable because of its dimensions.
#
# All pairs of the linkage are closed at the sketch by least squares; the rank of their equations gives the true
# mobility, and the surplus equations are redundant constraints (the coupler that a parallelogram does not need, a
# second parallel guide). They are left out of the count, which then gives groups as usual; in these groups the
# equations are consistent, and are solved by least squares. J. Garcia de Jalon, E. Bayo, Kinematic and Dynamic
# Simulation of Multibody Systems, ch. 2.


STEP = 0.05  # rad, or sizes of the linkage: step by which it must be movable
STARTS = 200  # initial guesses if the sketch is incomplete


def analyse_mobile_structure(linkage: Linkage) -> Structure:
    """Analyse the structure of a linkage that its drivers can move, by counting or by rank.

    Raises:
        MobilityError: the drivers do not move the linkage, or do not move all of it.
    """
    structure = analyse_structure(linkage)
    moving = structure if structure.sound else analyse_by_rank(linkage, structure)
    if moving is None:
        raise MobilityError(structure)
    return moving


def analyse_by_rank(linkage: Linkage, structure: Structure) -> Structure | None:
    """Analyse the structure of a linkage without its redundant constraints.

    None if the rank of the equations also shows that the linkage cannot move.
    """
    drivers = len(linkage.drivers)
    if structure.under_constrained or structure.mobility >= drivers:
        return None
    kernel = _whole_linkage_solver(linkage, structure)
    closed = _close_at_sketch(kernel, linkage)
    if closed is None:
        return None
    state, poses = closed
    matrix = kernel.matrix({**poses, **kernel.poses_of(state)})[0]
    undriven = matrix[: len(matrix) - drivers]
    rank, whole = (int(np.linalg.matrix_rank(rows, rtol=REDUNDANT)) for rows in (undriven, matrix))
    if matrix.shape[1] - rank != drivers or whole != matrix.shape[1] or not _can_move(kernel, linkage, state):
        return None
    everything = {**poses, **kernel.poses_of(state)}
    return _leave_out_redundant(linkage, structure, kernel, undriven, everything, len(undriven) - rank)


def _whole_linkage_solver(linkage: Linkage, structure: Structure) -> NewtonSolver:
    """Make a solver of the whole linkage as one group on the frame."""
    inner = tuple(p for p in structure.pairs if FRAME not in (p.i, p.j))
    outer = tuple(p for p in structure.pairs if FRAME in (p.i, p.j))
    return NewtonSolver.of(Group(linkage.moving, inner, outer, 0, "", linkage.drivers), linkage)


def _close_at_sketch(kernel: NewtonSolver, linkage: Linkage) -> tuple[GroupState, Mapping[str, Pose]] | None:
    q = np.array([linkage.sketch.at])
    poses = {FRAME: frame_state(q)[0]}
    drives = drives_at(linkage, q)
    unwrapped = sketched_angles(kernel, linkage, poses, drives)
    links = len(linkage.moving)
    starts = np.random.default_rng(1).uniform(-np.pi, np.pi, (STARTS, links)) if unwrapped is None else unwrapped
    state, closed = close_from_afar(kernel, poses, drives, placed_by_angles(kernel, poses, drives, starts))
    if not bool(np.any(closed)):
        return None
    k = int(np.argmax(closed))
    return state.part(slice(k, k + 1)), poses


def _can_move(kernel: NewtonSolver, linkage: Linkage, state: GroupState) -> bool:
    """Return True if the linkage can also be assembled at driver coordinates beside the sketch.

    Even a truss may have a mobility by rank in a single position.
    """
    step = STEP if linkage.driver.kind == "turn" else STEP * kernel.size
    ways = []
    for sense in (1, -1):
        q = np.array([linkage.sketch.at + sense * step])
        poses, drives = {FRAME: frame_state(q)[0]}, drives_at(linkage, q)
        with np.errstate(all="ignore"):
            moved_state, last = kernel.close(state, poses, drives)
            residual = np.max(np.abs(kernel.residuals({**poses, **kernel.poses_of(moved_state)}, drives)))
        ways.append(bool(last[0] < CONVERGED and residual < CONVERGED))
    return any(ways)


def _leave_out_redundant(
    linkage: Linkage, structure: Structure, kernel: NewtonSolver, undriven: Real, poses: Mapping[str, Pose], number: int
) -> Structure | None:
    """Leave out `number` redundant conditions of pairs, so that the counted mobility agrees with the rank.

    Conditions of pairs that the structural report leaves out are tried first, then those of other pairs, the last ones
    of the file before earlier ones. The result is None if no choice is possible.
    """
    left = np.linalg.svd(undriven.T)[2][len(undriven) - number :]  # null space: combinations of rows that are redundant
    rows = [c for c in kernel.constraints for _ in c.lengths][: len(undriven)]
    heavy = np.max(np.abs(left), axis=0) > SHARED
    names = dict.fromkeys(row.name for row, is_heavy in zip(rows, heavy, strict=True) if is_heavy)
    pairs = {p.name: p for p in structure.pairs}
    among = tuple(n for n in linkage.links if any(n in (pairs[name].i, pairs[name].j) for name in names))
    keys = {pairs[name].point or name if pairs[name].kind == "R" else name for name in names}
    all_ties = tuple(list_ties(linkage))
    ties = {k: tie for k, tie in enumerate(all_ties) if tie.name in keys}
    reduction = find_reduction(linkage, poses, structure)
    for report in (reduction, None) if reduction else (None,):
        first = dict(report.conditions) if report else {}
        from_ties = [k for k in ties if report is None or k in report.touched(all_ties)]
        choices = combinations_with_replacement(from_ties[::-1], number - sum(first.values()))
        for drop in islice(choices, MOST_TRIES):
            dropped = first | {k: drop.count(k) for k in drop}
            if any(count > ties[k].constraints for k, count in dropped.items()):
                continue
            trial = analyse_structure(linkage, dropped)
            if trial.freedom == len(linkage.drivers) and not trial.redundant_pairs and not trial.under_constrained:
                whole = replace(trial, passive=tuple(_list_redundancies(trial, dropped, ties, among)))
                return reduce_structure(linkage, whole, report or Reduction(conditions=dropped))
    return None


def _list_redundancies(
    structure: Structure, dropped: Mapping[int, int], ties: Mapping[int, Tie], among: tuple[str, ...]
) -> Iterable[PairRedundancy]:
    placed = {link: k for k, group in enumerate(structure.all_groups) for link in group.links}
    for k, count in dropped.items():
        name = ties[k].name
        joined = [p for p in structure.pairs if name in (p.name, p.point)]
        joined = [
            p for p in joined if ties[k].b in (p.i, p.j)
        ] or joined  # in a compound hinge, the pair of the link of the tie
        pair = max(joined, key=lambda p: max(placed.get(p.i, -1), placed.get(p.j, -1)))
        links = sorted((pair.i, pair.j), key=lambda n: placed.get(n, -1))
        yield PairRedundancy(pair.name, count, (links[0], links[1]), among)
