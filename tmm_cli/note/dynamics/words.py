"""Letters of the law of motion, and what every part of its chapter is about."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

from tmm_cli.analysis.running import Running
from tmm_cli.dynamics.curves import Curve
from tmm_cli.dynamics.flywheel import Tangent
from tmm_cli.dynamics.steady import Steady
from tmm_cli.kinematics.motion import Motion
from tmm_cli.note.context import Subject
from tmm_cli.note.expression import Leaf
from tmm_cli.plans.record import Lettered, Symbol

INERTIA, SLOPE, MOMENT, DRIVING, WORK = Symbol("J"), Symbol("J′"), Symbol("M"), Lettered("M_d"), Symbol("A")
FLYWHEEL, START, MEAN, DELTA = Lettered("J_f"), Symbol("T", "0"), Lettered("ω_m"), Symbol("δ")
LARGEST, LEAST = Symbol("ω", "max"), Symbol("ω", "min")


@dataclass(frozen=True)
class Here:
    """The running machine, and a position of it; letters are those of what it is reduced to, along its sense."""

    subject: Subject
    k: int

    @property
    def running(self) -> Running:
        assert self.subject.results.steady is not None
        return self.subject.results.steady

    @property
    def steady(self) -> Steady:
        return self.running.steady

    @property
    def motion(self) -> Motion:
        return self.subject.motion

    @property
    def number(self) -> str:
        return self.subject.called(self.k)

    @property
    def speed(self) -> Leaf:
        """Of the driving link, as a size."""
        return Leaf(Symbol("ω", self.motion.linkage.driver.link), abs(self.subject.rate(self.k)))

    @cached_property
    def tangents(self) -> tuple[Tangent, Tangent]:
        return self.steady.tangents

    @cached_property
    def start(self) -> float:
        """Kinetic energy in position 0, J."""
        upper, __ = self.tangents
        return upper.slope * self.steady.law.flywheel - upper.offset

    def of(self, curve: Curve) -> float:
        """A function of the way, here."""
        return float(curve(self.running.way(self.motion.q))[self.k])
