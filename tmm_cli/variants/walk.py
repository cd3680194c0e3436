"""Groups of many variants followed along the driver's way, all variants at once, node after node.

Groups that are found by iteration begin where the first linkage has them and are led to each variant by changing all
its numbers little by little; then every node starts from the nodes before it. E. L. Allgower, K. Georg, Introduction to
Numerical Continuation Methods, ch. 2. What a variant does not reach in these steps is lost for it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tmm_cli.groups.base import Closed, Kernel
from tmm_cli.groups.newton import CONVERGED, Newton
from tmm_cli.groups.state import Pose
from tmm_cli.groups.track import State
from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.motion import driven_state, drives_at, frame_state
from tmm_cli.vectors import Real, Vector, unit

NODES = 72  # in a turn, or in a stroke
CHANGES = 8  # steps from the first linkage to a variant
ROUNDS = 7  # of Newton's method from node to node
NEAR_END = 1e-9  # of the way: the sketch is at an end of it
LEAP = 0.2  # a state so far from the expected one (sizes of the group, rad) is another
FINER = 6  # parts of a step in which some variant has leapt
CLOSED = 1e-6  # of a cycle: what is no farther off has come back

Make = Callable[[Real], Linkage]  # numbers (variants, n) -> a linkage of arrays (variants,)


def kernels_of(linkage: Linkage, kernels: Sequence[Kernel]) -> tuple[Kernel, ...]:
    """The groups with the numbers of another linkage, which may be arrays, not yet assembled."""
    found: list[Kernel] = []
    for kernel in kernels:
        if isinstance(kernel, Newton):
            found.append(Newton.of(kernel.group.again(linkage), linkage))
        else:
            again = kernel.again(linkage)
            assert isinstance(again, Closed)
            found.append(replace(again, winding=None))
    return tuple(found)


@dataclass(frozen=True)
class Step:
    """All groups at one place of each variant: states of links with their angles followed, origins x and angles turn.

    Both by link, (variants,).
    """

    q: Real
    x: dict[str, Vector]
    turn: dict[str, Real]

    def state(self, links: Sequence[str]) -> State:
        return State(np.stack([self.x[n] for n in links], -1), np.stack([self.turn[n] for n in links], -1))


@dataclass(frozen=True)
class Walked:
    """Nodes q (variants, nodes), states by link; home: the node of the sketch. lost: (variants, nodes)."""

    q: Real
    x: dict[str, Vector]
    turn: dict[str, Real]
    home: int
    closed: bool
    lost: Real

    def repeated(self, variants: int) -> Walked:
        """The nodes of one variant for as many that are near to it."""

        def all_of(values: Real) -> Real:
            return np.repeat(values, variants, axis=0)

        x, turn = ({n: all_of(v) for n, v in part.items()} for part in (self.x, self.turn))
        return Walked(all_of(self.q), x, turn, self.home, self.closed, all_of(self.lost))

    def near(self, q: Real) -> tuple[dict[str, Vector], dict[str, Real], Real]:
        """States of all links near places q (variants, places), between two nodes, and whether they are lost there."""
        rows = np.arange(len(q))[:, None]
        first, last = self.q[:, :1], self.q[:, -1:]
        cycle = last - first
        whole = np.floor((q - first) / cycle) if self.closed else np.zeros(q.shape)
        within = q - whole * cycle
        low, at, high = (self.q[:, k][:, None] for k in (0, self.home, -1))
        after = len(self.q[0]) - 1 - self.home
        with np.errstate(all="ignore"):
            above = np.where(high > at, (within - at) / (high - at), 0.0) * after
            below = np.where(at > low, (within - low) / (at - low), 0.0) * self.home
            place = np.where(within >= at, self.home + above, below)
        place = np.clip(np.nan_to_num(place), 0, len(self.q[0]) - 1)
        node = np.minimum(place.astype(int), len(self.q[0]) - 2)
        share = place - node

        def between(values: Real) -> Real:
            found: Real = (1 - share) * values[rows, node] + share * values[rows, node + 1]
            return found

        turn = {n: between(v) + whole * (v[:, -1:] - v[:, :1]) * self.closed for n, v in self.turn.items()}
        return {n: between(v) for n, v in self.x.items()}, turn, self.lost[rows, node] | self.lost[rows, node + 1]


def walk(make: Make, first: Real, numbers: Real, kernels: Sequence[Kernel], home: Step, way: Any) -> Walked:
    """Nodes of all variants (numbers: (variants, n)) from the first linkage's sketch on (its numbers: (n,)).

    home: its groups in the sketch; way: of each variant.
    """
    steps: list[Step] = []
    at = np.full(len(numbers), home.q)
    alive = np.ones(len(numbers), dtype=bool)
    for k in range(CHANGES + 1):
        share = k / CHANGES
        linkage = make(first + share * (numbers - first))
        own = kernels_of(linkage, kernels)
        clock = np.full(len(numbers), share)
        guess = _expected(steps, clock) if steps else _spread(home, len(numbers))
        there, sound = _step(linkage, own, at, guess)
        alive &= sound
        steps.append(replace(there, q=clock))
    start = replace(steps[-1], q=at)
    turns = max(1, round(float(np.max(way.span)) / (2 * np.pi))) if way.closed else 1
    count = NODES * turns
    share = 0.0 if way.closed else float(np.mean((at[:, None] - way.low) / way.span))
    down = (
        round(count * share)
        if share < NEAR_END or share > 1 - NEAR_END
        else min(max(round(count * share), 1), count - 1)
    )
    low, high = way.low, way.low + way.span
    q = np.concatenate(
        [low + (at[:, None] - low) * np.arange(down) / max(down, 1),
         at[:, None] + (high - at[:, None]) * np.arange(count - down + 1) / max(count - down, 1)], axis=1,
    )  # fmt: skip
    nodes: dict[int, Step] = {down: start}
    reached = np.zeros(q.shape, dtype=bool)
    reached[:, down] = alive
    for order in (range(down + 1, q.shape[1]), range(down - 1, -1, -1)):
        past, going = [start], alive.copy()
        for m in order:
            past, sound = _advance(linkage, own, past, q[:, m], going)
            going &= sound
            reached[:, m] = going
            nodes[m] = past[-1]
    x = {n: np.stack([nodes[m].x[n] for m in range(q.shape[1])], axis=1) for n in start.x}
    turn = {n: np.stack([nodes[m].turn[n] for m in range(q.shape[1])], axis=1) for n in start.turn}
    lost = ~reached | _turned_over(make, numbers, kernels, q, x, turn, down)
    if way.closed:
        apart = [np.abs(unit(turn[n][:, -1]) - unit(turn[n][:, 0])) for n in turn]
        lost |= ~(np.max(apart, axis=0, initial=0.0) < CLOSED)[:, None]
    return Walked(q, x, turn, down, way.closed, lost)


def _spread(home: Step, variants: int) -> Step:
    return Step(
        np.full(variants, home.q), {n: np.full(variants, v) for n, v in home.x.items()},
        {n: np.full(variants, v) for n, v in home.turn.items()},
    )  # fmt: skip


def _expected(past: Sequence[Step], q: Real) -> Step:
    """What the last three steps lead to at q; the last one itself where they are at one place."""
    past = list(past)[-3:]

    def on(values: Sequence[Any]) -> Any:
        total: Any = 0.0
        with np.errstate(all="ignore"):
            for k, value in enumerate(values):
                weight: Any = 1.0
                for other in past[:k] + past[k + 1 :]:
                    weight = weight * (q - other.q) / (past[k].q - other.q)
                total = total + weight * value
        return np.where(np.isfinite(total), total, values[-1])

    return Step(
        q, {n: on([s.x[n] for s in past]) for n in past[0].x}, {n: on([s.turn[n] for s in past]) for n in past[0].turn}
    )


def _advance(
    linkage: Linkage, kernels: Sequence[Kernel], past: list[Step], q: Real, going: Real
) -> tuple[list[Step], Real]:
    """The last steps with the next one; in finer steps where a variant that still goes on leaps."""
    step, sound = _step(linkage, kernels, q, _expected(past, q))
    if bool(np.all(sound | ~going)):
        return [*past[-2:], step], sound
    finer, fine = past, np.ones(len(q), dtype=bool)
    before = past[-1].q
    for k in range(1, FINER + 1):
        between = before + (q - before) * (k / FINER)
        here, good = _step(linkage, kernels, between, _expected(finer, between))
        fine &= good
        finer = [*finer[-2:], here]
    last = finer[-1]
    return [
        *past[-2:], Step(q, {n: np.where(sound, step.x[n], last.x[n]) for n in step.x},
                         {n: np.where(sound, step.turn[n], last.turn[n]) for n in step.turn}),
    ], sound | fine  # fmt: skip


def _step(linkage: Linkage, kernels: Sequence[Kernel], q: Real, guess: Step) -> tuple[Step, Real]:
    """All groups at places q (variants,), and which variants are found near to where they are expected."""
    drives = drives_at(linkage, q)
    poses: dict[str, Pose] = {FRAME: frame_state(q)[0]}
    for driver in linkage.cranks:
        poses[driver.link] = driven_state(linkage, driver, drives[driver.link])[0]
    x, turn = dict(guess.x), dict(guess.turn)
    sound = np.ones(len(q), dtype=bool)
    with np.errstate(all="ignore"):
        for kernel in kernels:
            links = kernel.group.links
            if isinstance(kernel, Newton):
                begun = guess.state(links)
                state, size = kernel.close(begun, poses, drives, ROUNDS)
                leapt = np.max(np.abs(state.x - begun.x), axis=-1) / kernel.size
                if not kernel.by_angle:
                    leapt = np.maximum(leapt, np.max(np.abs(state.turn - begun.turn), axis=-1))
                    sound &= leapt < LEAP
                sound &= size < CONVERGED
                if kernel.passive:
                    gaps = kernel.gaps({**poses, **kernel.poses_of(state)}, drives)
                    sound &= np.max(np.abs(gaps), axis=-1) < CONVERGED
                own: Any = kernel.poses_of(state)
            else:
                assert isinstance(kernel, Closed)
                own = dict(zip(links, kernel.closed(poses, drives).poses, strict=True))
                for n in links:
                    angle = np.angle(own[n].z)
                    followed = angle + 2 * np.pi * np.round((guess.turn[n] - angle) / (2 * np.pi))
                    own[n] = replace(own[n], turn=followed)
            poses.update(own)
            for n in links:
                x[n], turn[n] = own[n].x, own[n].turn
    return Step(q, x, turn), sound


def _turned_over(
    make: Make, numbers: Real, kernels: Sequence[Kernel], q: Real, x: dict[str, Vector], turn: dict[str, Real],
    home: int,
) -> Real:  # fmt: skip
    """Nodes at and beyond which a group has passed a dead position, (variants, nodes)."""
    over = np.zeros(q.shape, dtype=bool)
    followed = [k for k in kernels if isinstance(k, Newton) and not k.by_angle and not k.passive]
    if not followed:
        return over
    flat = make(np.repeat(numbers, q.shape[1], axis=0))
    drives = drives_at(flat, q.ravel())
    poses = {FRAME: frame_state(q.ravel())[0]}
    for driver in flat.cranks:
        poses[driver.link] = driven_state(flat, driver, drives[driver.link])[0]
    poses |= {n: Pose(x[n].ravel(), unit(turn[n].ravel()), turn[n].ravel()) for n in x}
    with np.errstate(all="ignore"):
        for kernel in kernels_of(flat, followed):
            assert isinstance(kernel, Newton)
            matrix = kernel.matrix(poses)
            clean = np.where(np.all(np.isfinite(matrix), axis=(-1, -2))[:, None, None], matrix, 0.0)
            side = np.linalg.slogdet(clean)[0].reshape(q.shape)
            other = side != side[:, home : home + 1]
            over[:, home:] |= np.logical_or.accumulate(other[:, home:], axis=1)
            over[:, : home + 1] |= np.logical_or.accumulate(other[:, home::-1], axis=1)[:, ::-1]
    return over
