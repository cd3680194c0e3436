"""Where counting says that a linkage is locked and its dimensions let it move: the numerical rank decides.

All pairs of the linkage are closed at the sketch by least squares; the rank of their equations gives the true mobility,
and what is left over are passive constraints (the coupler that a parallelogram does not need, a second parallel guide).
They are left out of the count, which then gives groups as usual; in these groups the equations agree, and are solved by
least squares. J. Garcia de Jalon, E. Bayo, Kinematic and Dynamic Simulation of Multibody Systems, ch. 2.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from itertools import combinations_with_replacement, islice

import numpy as np

from tmm_cli.assembly.left_out import MOST_TRIES, leave_out
from tmm_cli.assembly.search import close_from_afar, placed_by_angles, sketched_angles
from tmm_cli.errors import MobilityError
from tmm_cli.groups.newton import Newton
from tmm_cli.groups.sequence import drives_at, frame_state
from tmm_cli.groups.state import Pose, State
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.structure.assur import Group, Passive, Structure, analyse, reduced, ties_of
from tmm_cli.structure.graph import Tie
from tmm_cli.structure.reduction import Reduction
from tmm_cli.tolerances import CONVERGED, REDUNDANT, SHARED
from tmm_cli.vectors import Real

STEP = 0.05  # rad, or of the linkage's size: how far it must really move, both ways
STARTS = 200


def mobile(linkage: Linkage) -> Structure:
    """The groups of a linkage whose drivers move all of it, by the count or the rank. Raises MobilityError."""
    structure = analyse(linkage)
    moving = structure if structure.sound else by_rank(linkage, structure)
    if moving is None:
        raise MobilityError(structure)
    return moving


def by_rank(linkage: Linkage, structure: Structure) -> Structure | None:
    """The structure with its passive constraints left out; None when the linkage is locked in truth as well."""
    wanted = len(linkage.drivers)
    if structure.under_constrained or structure.mobility >= wanted:
        return None
    kernel = _whole(linkage, structure)
    found = _closed(kernel, linkage)
    if found is None:
        return None
    state, poses = found
    matrix = kernel.matrix({**poses, **kernel.poses_of(state)})[0]
    undriven = matrix[: len(matrix) - wanted]
    rank, whole = (int(np.linalg.matrix_rank(rows, rtol=REDUNDANT)) for rows in (undriven, matrix))
    if matrix.shape[1] - rank != wanted or whole != matrix.shape[1] or not _moves(kernel, linkage, state):
        return None
    everything = {**poses, **kernel.poses_of(state)}
    return _without_passive(linkage, structure, kernel, undriven, everything, len(undriven) - rank)


def _whole(linkage: Linkage, structure: Structure) -> Newton:
    """The linkage as one group on the frame."""
    inner = tuple(p for p in structure.pairs if FRAME not in (p.i, p.j))
    outer = tuple(p for p in structure.pairs if FRAME in (p.i, p.j))
    return Newton.of(Group(linkage.moving, inner, outer, 0, "", linkage.drivers), linkage)


def _closed(kernel: Newton, linkage: Linkage) -> tuple[State, Mapping[str, Pose]] | None:
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


def _moves(kernel: Newton, linkage: Linkage, state: State) -> bool:
    """Whether it can be closed beside the sketch too: a truss may have a mobility at one place only."""
    step = STEP if linkage.driver.kind == "turn" else STEP * kernel.size
    ways = []
    for sense in (1, -1):
        q = np.array([linkage.sketch.at + sense * step])
        poses, drives = {FRAME: frame_state(q)[0]}, drives_at(linkage, q)
        with np.errstate(all="ignore"):
            there, last = kernel.close(state, poses, drives)
            residual = np.max(np.abs(kernel.residuals({**poses, **kernel.poses_of(there)}, drives)))
        ways.append(bool(last[0] < CONVERGED and residual < CONVERGED))
    return any(ways)


def _without_passive(
    linkage: Linkage, structure: Structure, kernel: Newton, undriven: Real, poses: Mapping[str, Pose], number: int
) -> Structure | None:
    """Leave out so many conditions that the count is right; of what the report leaves out first, then the last ones."""
    left = np.linalg.svd(undriven.T)[2][len(undriven) - number :]  # combinations of rows that say nothing new
    rows = [c for c in kernel.constraints for _ in c.lengths][: len(undriven)]
    heavy = np.max(np.abs(left), axis=0) > SHARED
    names = dict.fromkeys(row.name for row, there in zip(rows, heavy, strict=True) if there)
    pairs = {p.name: p for p in structure.pairs}
    among = tuple(n for n in linkage.links if any(n in (pairs[name].i, pairs[name].j) for name in names))
    keys = {pairs[name].point or name if pairs[name].kind == "R" else name for name in names}
    every = tuple(ties_of(linkage))
    ties = {k: tie for k, tie in enumerate(every) if tie.name in keys}
    reduction = leave_out(linkage, poses, structure)
    for report in (reduction, None) if reduction else (None,):
        first = dict(report.conditions) if report else {}
        from_ties = [k for k in ties if report is None or k in report.touched(every)]
        choices = combinations_with_replacement(from_ties[::-1], number - sum(first.values()))
        for drop in islice(choices, MOST_TRIES):
            dropped = first | {k: drop.count(k) for k in drop}
            if any(count > ties[k].constraints for k, count in dropped.items()):
                continue
            found = analyse(linkage, dropped)
            if found.freedom == len(linkage.drivers) and not found.redundant_pairs and not found.under_constrained:
                whole = replace(found, passive=tuple(_passives(found, dropped, ties, among)))
                return reduced(linkage, whole, report or Reduction(conditions=dropped))
    return None


def _passives(
    found: Structure, dropped: Mapping[int, int], ties: Mapping[int, Tie], among: tuple[str, ...]
) -> Iterable[Passive]:
    placed = {link: k for k, group in enumerate(found.all_groups) for link in group.links}
    for k, count in dropped.items():
        name = ties[k].name
        joined = [p for p in found.pairs if name in (p.name, p.point)]
        joined = [p for p in joined if ties[k].b in (p.i, p.j)] or joined  # in a compound hinge: that of the tie's link
        pair = max(joined, key=lambda p: max(placed.get(p.i, -1), placed.get(p.j, -1)))
        links = sorted((pair.i, pair.j), key=lambda n: placed.get(n, -1))
        yield Passive(pair.name, count, (links[0], links[1]), among)
