"""The output of the mechanism over its driver's places: where it is, how fast it goes, how far it goes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from tmm_cli.groups.base import Kernel
from tmm_cli.groups.sequence import LinkStates, link_states, towards
from tmm_cli.kinematics.driver_range import SCAN
from tmm_cli.kinematics.motion import LargestRates, Motion, moving_parts
from tmm_cli.linkage import Linkage
from tmm_cli.roots import roots
from tmm_cli.vectors import Real, Vector

PARTS = 64  # of a stroke, through which an angle is followed


def output_run(motion: Motion, link: str) -> tuple[Real, Real, Real]:
    """Run of the output (m, or its angle in rad) and its first and second transfer functions."""
    slide = motion.linkage.output_guide(link)
    if slide is not None:
        sliding = motion.slide(slide)
        return sliding.run, sliding.first, sliding.second
    point = motion.linkage.output_point(link)
    if point is not None:
        moving = motion.named(point)
        return _along(link, moving.x), _along(link, moving.first), _along(link, moving.second)
    turning = motion.link(link)
    return turning.angle, turning.first, turning.second


def output_place(motion: LinkStates, link: str) -> Real:
    """Run of the output (m, or its angle in rad) alone."""
    point = motion.linkage.output_point(link)
    if point is not None:
        return _along(link, motion.spot(point))
    slide = motion.linkage.output_guide(link)
    return motion.angle(link) if slide is None else motion.run(slide)


def output_slope(motion: LinkStates, link: str) -> Real:
    """First transfer function of the output alone."""
    linkage = motion.linkage
    point = linkage.output_point(link)
    if point is not None:
        own = linkage.owner(point)
        return _along(link, motion.first[own].at(linkage.local(own, point) * motion.poses[own].z))
    slide = linkage.output_guide(link)
    return motion.first[link].w if slide is None else motion.slope(slide)


def moving_slope(motion: LinkStates, link: str) -> Real:
    """First transfer function of the output; zero in all positions of a variant where it moves in none of them.

    The speed of what stays at rest is rounding, and so is its sign.
    """
    slope, rates = output_slope(motion, link), LargestRates.of(motion)
    largest = rates.speed / rates.size if motion.linkage.output_swings(link) else rates.speed
    moves = np.any(moving_parts(slope, largest), axis=-1, keepdims=True)
    return np.where(moves, slope, 0.0)


def _along(output: str, vector: Vector) -> Real:
    """The coordinate of a vector that an output K.x or K.y is about."""
    return vector.real if output.endswith(".x") else vector.imag


class Curve(Protocol):
    """What tells the strokes of an output, see OutputCurve."""

    @property
    def link(self) -> str: ...
    @property
    def swings(self) -> bool: ...
    @property
    def kind(self) -> str: ...
    def place(self, q: Real) -> Real: ...


@dataclass(frozen=True)
class OutputCurve:
    """An output over the driver's places; kernels: the groups on the way to it."""

    linkage: Linkage
    kernels: tuple[Kernel, ...]
    link: str

    @property
    def swings(self) -> bool:
        """Whether it turns, else it slides."""
        return self.linkage.output_swings(self.link)

    @property
    def kind(self) -> str:
        return "swing" if self.swings else "slide"

    def place(self, q: Real) -> Real:
        """Run, m, or angle in -pi..pi, rad."""
        return output_place(link_states(self.linkage, self.kernels, q, 0), self.link)

    def slope(self, q: Real) -> Real:
        """First transfer function."""
        return output_slope(link_states(self.linkage, self.kernels, q, 1), self.link)

    def moving_slope(self, q: Real) -> Real:
        """First transfer function at many places of each variant; zero at all of them if the output stays at rest."""
        return moving_slope(link_states(self.linkage, self.kernels, q, 1), self.link)


def runs_of(curve: Curve, starts: Real, ways: Real) -> tuple[Real, Real]:
    """Where an output is at the start of each way of the driver (..., ways), and how far it goes in it.

    An angle is followed through, so that it may pass 180 degrees.
    """
    shares = np.linspace(0, 1, PARTS + 1 if curve.swings else 2)
    places = starts[..., None] + ways[..., None] * shares
    run = curve.place(places.reshape(*starts.shape[:-1], -1)).reshape(places.shape)
    run = np.unwrap(run, axis=-1) if curve.swings else run
    return run[..., 0], run[..., -1] - run[..., 0]


@dataclass(frozen=True)
class Travel:
    """How far an output goes between two ends of the driver that were asked for: run (m or rad) and driver's place."""

    link: str
    kind: str
    low: float
    high: float
    low_at: float
    high_at: float


def find_travel(linkage: Linkage, kernels: tuple[Kernel, ...], asked: Real, link: str) -> Travel | None:
    """Extremes of an output over the places asked for, found between them; for drivers that do not turn fully."""
    curve = OutputCurve(linkage, towards(kernels, [linkage.output_carrier(link)]), link)
    q = np.linspace(np.min(asked), np.max(asked), SCAN + 1)
    moved = link_states(linkage, kernels, q, 1)  # all groups: it goes only where the whole linkage can
    run, slope = output_place(moved, link), output_slope(moved, link)
    before, after = moved.placed[:-1], moved.placed[1:]
    turning = (before & after & (slope[:-1] * slope[1:] < 0))[before]  # not over a gap between two ways of the driver
    q, run = q[moved.placed], run[moved.placed]
    if len(q) < 2:
        return None
    run = np.unwrap(run) if curve.swings else run
    change = np.flatnonzero(turning)
    if change.size:
        ends = roots(curve.slope, q[change], q[change + 1])
        there = curve.place(ends)
        if curve.swings:
            there = there + 2 * np.pi * np.round((run[change] - there) / (2 * np.pi))
        q, run = np.concatenate([q, ends]), np.concatenate([run, there])
    low, high = int(np.argmin(run)), int(np.argmax(run))
    return Travel(link, curve.kind, float(run[low]), float(run[high]), float(q[low]), float(q[high]))
