"""Assemblies of groups of class III and higher: from the sketch where it shows them, else all there are.

For given angles the places of the links follow from linear equations; so starts for Newton's method are made from
angles, those of the sketch or many others, the same ones in every run. A triad of turning pairs has up to six
assemblies: C. Innocenti, Direct kinematics in analytical form of the planar (Assur) structure, ASME J. Mech. Design
(1992-1995).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from tmm_cli.assembly import nearest_to_sketch, sketch_distance, source
from tmm_cli.cycle import turns_of_cycle
from tmm_cli.groups.base import Kernel, reach
from tmm_cli.groups.continuation import Upstream, Walker
from tmm_cli.groups.linear import least_over_largest, solve
from tmm_cli.groups.newton import CONVERGED, Newton
from tmm_cli.groups.state import Drives, Placement, Pose
from tmm_cli.groups.track import State
from tmm_cli.linkage import Linkage
from tmm_cli.motion import Motion, towards
from tmm_cli.refused import NoAssembly, TooLarge, Undecided
from tmm_cli.structure.assur import Group
from tmm_cli.vectors import Real, unit

STARTS = 400  # in one round of looking for all assemblies
MOST_LINKS = 16  # of one group: its equations are solved some ten thousand times
QUIET = 3  # rounds without a new assembly that end the search
MOST = 64  # assemblies that are looked for: with more the group moves by itself there, and they have no end
ROUNDS = 60  # of damped steps from a start that may be anywhere
STRIDE = 0.5  # rad, or of the group's size: the longest step then
SAME = 1e-6
DEAD = 1e-7  # least singular value over the largest: here the sketch is in a dead position
DEAD_OF_MANY = 1e-5  # the same, of places found with half the digits
CLOSE = 0.25  # an assembly this near to a full sketch (group's sizes, rad) is the one that is meant


def assembled(
    group: Group, linkage: Linkage, poses: dict[str, Pose], drives: Drives, before: tuple[Kernel, ...]
) -> tuple[Newton, Placement]:
    """The group in the assembly that the sketch shows, followed along the driver's way.

    Raises TooLarge, NoAssembly, Undecided.
    """
    if len(group.links) > MOST_LINKS:
        raise TooLarge(group, MOST_LINKS)
    kernel = Newton.of(group, linkage)
    q = np.array([linkage.sketch.at])
    state = _sketched(kernel, linkage, poses, drives) or _searched(kernel, linkage, poses, drives)
    here = {**poses, **kernel.poses_of(state)}
    if float(least_over_largest(kernel.matrix(here))[0]) < DEAD:
        raise Undecided(group, {})
    kernel = replace(kernel, start=state)
    if not kernel.by_angle:
        kernel = replace(kernel, track=_track(kernel, linkage, before, state))
    return kernel, kernel.place(poses, q, drives)


def _track(kernel: Newton, linkage: Linkage, before: tuple[Kernel, ...], state: State):  # type: ignore[no-untyped-def]
    before = towards(before, {pair.other(link) for pair in kernel.group.outer for link in kernel.group.links
                              if link in (pair.i, pair.j)} | {d.base for d in kernel.group.drivers})  # fmt: skip

    def upstream(q: Real, order: int) -> Upstream:
        motion: Motion = source(linkage, before, q, order)
        return Upstream(motion.poses, motion.first, motion.second, motion.drives, bool(motion.placed[0]))

    turns = linkage.driver.kind == "turn"
    half = np.pi * (turns_of_cycle(linkage) or 1) if turns else reach(linkage)
    track = Walker(kernel, upstream, half / np.pi).follow(linkage.sketch.at, state, half, turns)
    return track if track is None or turns else replace(track, unit=kernel.size)


def placed_by_angles(kernel: Newton, poses: Mapping[str, Pose], drives: Drives, turn: Real) -> State:
    """Origins for given angles (..., links), as near to closing as they can come."""
    shape, links = turn.shape[:-1], len(kernel.group.links)
    still = State(np.zeros((*shape, links), complex), turn)
    known = {name: _spread(pose, shape) for name, pose in poses.items()}
    everything = {**known, **kernel.poses_of(still)}
    places = [3 * k + part for k in range(links) for part in (0, 1)]
    matrix = kernel.matrix(everything)[..., places]
    found = solve(matrix, -kernel.gaps(everything, drives))
    return State(kernel.size * (found[..., 0::2] + 1j * found[..., 1::2]), turn)


def _spread(pose: Pose, shape: tuple[int, ...]) -> Pose:
    turn = None if pose.turn is None else np.broadcast_to(pose.turn, shape)
    return Pose(np.broadcast_to(pose.x, shape), np.broadcast_to(pose.z, shape), turn)


def close_from_afar(
    kernel: Newton, poses: Mapping[str, Pose], drives: Drives, state: State
) -> tuple[State, Real]:  # fmt: skip
    """Damped steps, then Newton's method; the states and whether each has closed."""
    known = {name: _spread(pose, state.x.shape[:-1]) for name, pose in poses.items()}
    with np.errstate(all="ignore"):
        for _ in range(ROUNDS):
            everything = {**known, **kernel.poses_of(state)}
            step = solve(kernel.matrix(everything), -kernel.gaps(everything, drives))
            size = np.max(np.abs(step), axis=-1, keepdims=True)
            step = step * np.minimum(1.0, STRIDE / size)
            parts = step.reshape(*step.shape[:-1], -1, 3)
            state = State(state.x + kernel.size * (parts[..., 0] + 1j * parts[..., 1]), state.turn + parts[..., 2])
            if bool(np.all((size < 1e-12) | ~np.isfinite(size))):
                break
        state, last = kernel.close(state, known, drives)
        everything = {**known, **kernel.poses_of(state)}
        gap = np.max(np.abs(kernel.gaps(everything, drives)), axis=-1)
    return state, (last < CONVERGED) & (gap < CONVERGED)


def all_assemblies(
    kernel: Newton, poses: Mapping[str, Pose], drives: Drives, seed: int = 1, starts: int = STARTS
) -> list[State]:
    """Every real assembly of a group at one place of the driver, by many starts; those in a dead position once.

    Of a group that moves by itself at this place, some of them.
    """
    random = np.random.default_rng(seed)
    found: list[State] = []
    quiet = 0
    links = len(kernel.group.links)
    while quiet < QUIET and len(found) < MOST:
        turn = random.uniform(-np.pi, np.pi, (starts, links))
        start = placed_by_angles(kernel, poses, drives, turn)
        states, closed = close_from_afar(kernel, poses, drives, start)
        new = False
        for k in np.flatnonzero(closed):
            if len(found) == MOST:
                break
            state = State(states.x[k : k + 1], np.angle(unit(states.turn[k : k + 1])))
            if not any(_alike(kernel, state, other) for other in found):
                found.append(state)
                new = True
        quiet = 0 if new else quiet + 1
        if kernel.by_angle and found:
            break
    return sorted(found, key=lambda s: tuple(np.round(s.turn[0], 9)))


def _alike(kernel: Newton, one: State, other: State) -> bool:
    turned = np.abs(unit(one.turn) - unit(other.turn))
    return bool(np.max(turned) < SAME and np.max(np.abs(one.x - other.x)) < SAME * kernel.size)


def _sketched(kernel: Newton, linkage: Linkage, poses: Mapping[str, Pose], drives: Drives) -> State | None:
    """The assembly that a full sketch leads to, when it stays near to it."""
    turn = sketched_angles(kernel, linkage, poses, drives)
    if turn is None:
        return None
    start = placed_by_angles(kernel, poses, drives, turn[None, :])
    state, closed = close_from_afar(kernel, poses, drives, start)
    if not closed[0] or np.max(np.abs(state.turn - start.turn)) > CLOSE:
        return None
    sketched = {**linkage.sketch.points, **linkage.sketch.angles}
    own = kernel.poses_of(state)
    hints: dict[str, complex | float] = {}
    for link in kernel.group.links:
        hints |= {p: complex(own[link].at(local)[0]) for p, local in linkage.links[link].points.items()}
        hints[link] = float(np.angle(own[link].z)[0])
    given = {n: v for n, v in sketched.items() if n in hints}
    return state if sketch_distance(given, hints, kernel) < CLOSE else None


def sketched_angles(kernel: Newton, linkage: Linkage, poses: Mapping[str, Pose], drives: Drives) -> Real | None:
    """Angles of the group's links read off the sketch; None when it does not show all of them."""
    angles = {name: float(np.angle(pose.z)[0]) for name, pose in poses.items()}
    angles |= {name: angle for name, angle in linkage.sketch.angles.items() if name in kernel.order}
    for driver in kernel.group.drivers:  # a crank's angle and a point of it are known before its group is
        if driver.kind == "turn" and driver.base in angles:
            angles[driver.link] = angles[driver.base] + float(drives[driver.link].value[0])
    points = {p: complex(pose.at(at)[0]) for n, pose in poses.items() for p, at in linkage.links[n].points.items()}
    points = {**linkage.sketch.points, **points}
    for link in kernel.group.links:
        shown = [(local, points[p]) for p, local in linkage.links[link].points.items() if p in points]
        if link in angles or len(shown) < 2:
            continue
        middle = sum(local for local, _ in shown) / len(shown)
        centre = sum(place for _, place in shown) / len(shown)
        turned = sum((place - centre) * (local - middle).conjugate() for local, place in shown)
        if abs(turned) > 0:
            angles[link] = float(np.angle(turned))
    for _ in kernel.group.links:
        for slide in linkage.slides:
            if slide.carrier in angles and slide.runner not in angles:
                angles[slide.runner] = angles[slide.carrier] + slide.turned
            elif slide.runner in angles and slide.carrier not in angles:
                angles[slide.carrier] = angles[slide.runner] - slide.turned
    if kernel.by_angle:
        angles = dict.fromkeys(kernel.group.links, 0.0) | angles
    if any(link not in angles for link in kernel.group.links):
        return None
    return np.array([angles[link] for link in kernel.group.links])


def _searched(kernel: Newton, linkage: Linkage, poses: Mapping[str, Pose], drives: Drives) -> State:
    states = all_assemblies(kernel, poses, drives)
    if not states:
        raise NoAssembly(kernel.group, _shortfall(kernel, poses, drives))
    if len(states) == MOST and _moves_by_itself(kernel, poses, states):
        raise Undecided(kernel.group, {})
    ways = [tuple(kernel.poses_of(state)[link] for link in kernel.group.links) for state in states]
    return states[nearest_to_sketch(kernel, linkage, ways)]


def _moves_by_itself(kernel: Newton, poses: Mapping[str, Pose], states: list[State]) -> bool:
    """Whether its many assemblies are places of one motion: nearly all of them are dead positions then."""
    together = State(np.concatenate([s.x for s in states]), np.concatenate([s.turn for s in states]))
    known = {name: _spread(pose, together.x.shape[:-1]) for name, pose in poses.items()}
    return float(np.median(least_over_largest(kernel.matrix({**known, **kernel.poses_of(together)})))) < DEAD_OF_MANY


def _shortfall(kernel: Newton, poses: Mapping[str, Pose], drives: Drives) -> float:
    """How far from closing the group stays at best (m), by the least squares of many starts."""
    random = np.random.default_rng(1)
    state = placed_by_angles(kernel, poses, drives, random.uniform(-np.pi, np.pi, (STARTS, len(kernel.group.links))))
    known = {name: _spread(pose, state.x.shape[:-1]) for name, pose in poses.items()}
    best = np.inf
    damping = 1e-3
    for _ in range(ROUNDS):
        everything = {**known, **kernel.poses_of(state)}
        matrix, gaps = kernel.matrix(everything), kernel.gaps(everything, drives)
        best = min(best, float(np.min(np.max(np.abs(gaps), axis=-1))))
        square = np.einsum("...ki,...kj->...ij", matrix, matrix) + damping * np.eye(matrix.shape[-1])
        parts = solve(square, -np.einsum("...ki,...k->...i", matrix, gaps)).reshape(*state.x.shape, 3)
        state = State(state.x + kernel.size * (parts[..., 0] + 1j * parts[..., 1]), state.turn + parts[..., 2])
    return best * kernel.size
