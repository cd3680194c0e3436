"""Which links and pairs of a linkage with redundant constraints the structural report leaves out.

Decided by the rank of the equations at one position: without what is left out the mobility is the same. Links that are
rigid to one another count as one. Links between moving links are left out first, then pairs, then links connected to
the frame; the later in the file before the earlier, loaded links last. Drivers, outputs and links to which the file
attaches others stay. Where nothing more can be left out as a whole, pairs lose single conditions.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import combinations_with_replacement, islice

import numpy as np

from tmm_cli.groups.newton import Newton
from tmm_cli.groups.state import Pose
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.structure.assur import Group, Structure, pairs_within, reduced, ties_of
from tmm_cli.structure.reduction import Reduction, RedundantLink, RigidSet
from tmm_cli.tolerances import REDUNDANT, SHARED
from tmm_cli.vectors import Real, Vector

MOST_TRIES = 3000


@dataclass(frozen=True)
class Remainder:
    """A linkage without some links and ties, at known poses of all links."""

    linkage: Linkage
    poses: Mapping[str, Pose]
    links: tuple[str, ...]
    ties: frozenset[int] = frozenset()

    @cached_property
    def _kernel(self) -> Newton | None:
        """What is left as one group; None if nothing is joined."""
        left, dropped = {*self.links}, {tie for k, tie in enumerate(ties_of(self.linkage)) if k in self.ties}
        names = {tie.name for tie in dropped}
        hinges = []
        for hinge in self.linkage.hinges:
            loose = {tie.b for tie in dropped if tie.name == hinge.point}
            kept = tuple(link for link in hinge.links if link in left and link not in loose)
            if len(kept) > 1:
                attached_to = hinge.attached_to if hinge.attached_to in kept else ""
                hinges.append(replace(hinge, links=kept, attached_to=attached_to))
        remaining = replace(
            self.linkage, hinges=tuple(hinges),
            links={name: link for name, link in self.linkage.links.items() if name in left or name == FRAME},
            slides=tuple(s for s in self.linkage.slides if {s.carrier, s.runner} <= left and s.name not in names),
            meshes=tuple(m for m in self.linkage.meshes if {m.i, m.j, m.carrier} <= left and m.name not in names),
        )  # fmt: skip
        pairs = pairs_within(remaining)
        inner = tuple(pair for pair in pairs if FRAME not in (pair.i, pair.j))
        outer = tuple(pair for pair in pairs if FRAME in (pair.i, pair.j))
        drivers = tuple(d for d in self.linkage.drivers if {d.base, d.link} <= left)
        return Newton.of(Group(self.moving, inner, outer, 0, "", drivers), remaining) if pairs else None

    @property
    def moving(self) -> tuple[str, ...]:
        """The moving links that are left."""
        return tuple(link for link in self.links if link != FRAME)

    @cached_property
    def equations(self) -> Real:
        """The Jacobian without dimension, (rows, unknowns), with the rows of the drivers last."""
        if self._kernel is None:
            return np.zeros((0, 3 * len(self.moving)))
        matrix: Real = self._kernel.matrix(self.poses)[0]
        return matrix

    @cached_property
    def undriven(self) -> Real:
        """The Jacobian without the rows of the drivers."""
        drivers = 0 if self._kernel is None else len(self._kernel.group.drivers)
        return self.equations[: len(self.equations) - drivers]

    @cached_property
    def rank(self) -> int:
        """The rank of the pairs."""
        return rank_of(self.undriven)

    @property
    def redundant(self) -> int:
        """The number of redundant constraints."""
        return len(self.undriven) - self.rank

    @property
    def moves(self) -> bool:
        """True if the drivers move all of it, and nothing moves without them."""
        columns, drivers = self.undriven.shape[1], len(self.linkage.drivers)
        return bool(columns - self.rank == drivers and rank_of(self.equations) == columns)

    def without(self, links: Iterable[str] = (), ties: Iterable[int] = ()) -> Remainder:
        """The same without further links and ties."""
        gone = {*links}
        return replace(self, links=tuple(n for n in self.links if n not in gone), ties=self.ties | {*ties})

    def rigid_sets(self) -> list[tuple[str, ...]]:
        """Sets of links that are rigid to one another by their pairs with one another alone."""
        free = np.linalg.svd(self.undriven)[2][self.rank :]
        fields = {link: np.zeros(2 * len(free), complex) for link in self.links}
        size = 1.0 if self._kernel is None else float(np.ravel(self._kernel.size)[0])
        for k, link in enumerate(self.moving):
            x, y, turn = (free[:, 3 * k + part] for part in range(3))
            origin = complex(np.ravel(self.poses[link].x)[0]) / size
            fields[link] = np.concatenate([x + 1j * y - 1j * turn * origin, turn])
        sets = _alike(fields)
        if sets == [self.links]:  # others may only have the same velocities at this one position
            return sets
        return [rigid for links in sets for rigid in replace(self, links=links).rigid_sets()]


def rank_of(matrix: Real) -> int:
    """The rank of equations without dimension."""
    return int(np.linalg.matrix_rank(matrix, rtol=REDUNDANT)) if matrix.size else 0


def _alike(fields: Mapping[str, Vector]) -> list[tuple[str, ...]]:
    """Links that have the same velocities in all motions, two or more together."""
    sets: list[list[str]] = []
    for link, field in fields.items():
        like = next((s for s in sets if np.max(np.abs(fields[s[0]] - field), initial=0.0) < SHARED), None)
        if like is None:
            sets.append([link])
        else:
            like.append(link)
    return [tuple(links) for links in sets if len(links) > 1]


class _Selection:
    """What is left of a linkage while redundant links and pairs are left out, one after another."""

    def __init__(self, linkage: Linkage, poses: Mapping[str, Pose]) -> None:
        self.left = Remainder(linkage, poses, tuple(linkage.links))
        self.among_rigid = {links: replace(self.left, links=links).redundant for links in self.left.rigid_sets()}
        self.reduction = Reduction(tuple(RigidSet(links, number) for links, number in self.among_rigid.items()))
        self.every = list(ties_of(linkage))
        self.links: list[RedundantLink] = []

    def excess(self, left: Remainder) -> int:
        """The redundant constraints that do not lie within rigid sets."""
        there = {*left.links}
        return left.redundant - sum(number for links, number in self.among_rigid.items() if there.issuperset(links))

    @property
    def ties(self) -> list[int]:
        """The ties between the bodies that are left, the last of the file first."""
        gone = replace(self.reduction, links=tuple(self.links)).touched(self.every) | self.left.ties
        return [k for k in reversed(range(len(self.every))) if k not in gone]

    def leave_links(self, bodies: Iterable[str]) -> None:
        """Leave out each of these bodies that is redundant."""
        for body in bodies:
            members = self.reduction.members(body)
            trial = self.left.without(members)
            excess = self.excess(self.left)
            if excess and self.excess(trial) < excess and trial.moves:
                self.links.append(RedundantLink(members, excess - self.excess(trial)))
                self.left = trial

    def leave_pairs(self) -> None:
        """Leave out each pair all constraints of which are redundant."""
        stay = _driven_and_axles(self.left.linkage)
        for k in self.ties:
            constraints = self.every[k].constraints
            if constraints > self.excess(self.left) or self.every[k].name in stay:
                continue
            trial = self.left.without(ties=[k])
            if self.left.redundant - trial.redundant == constraints and trial.moves:
                self.left = trial


def leave_out(linkage: Linkage, poses: Mapping[str, Pose], structure: Structure) -> Reduction | None:
    """Rigid sets, redundant links and conditions such that what is left are Assur groups; None if there are none."""
    selection = _Selection(linkage, poses)
    between, on_frame = _candidates(linkage, selection.reduction)
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
        if possible and reduced(linkage, structure, reduction) is not None:
            return reduction
    return None


def _driven_and_axles(linkage: Linkage) -> set[str]:
    """Names of the pairs in which drivers work, and of those of gears, cams and followers with their carrier."""
    on_carrier = {linkage.shared(link, mesh.carrier) for mesh in linkage.meshes for link in (mesh.i, mesh.j)}
    slides = {mesh.slide for mesh in linkage.meshes}
    return {driver.joint for driver in linkage.drivers} | {name for name in on_carrier | slides if name}


def _candidates(linkage: Linkage, reduction: Reduction) -> tuple[Sequence[str], Sequence[str]]:
    """Bodies that may be left out in this order: those between moving links, and those connected to the frame."""
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
