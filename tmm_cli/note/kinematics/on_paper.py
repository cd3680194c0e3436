"""Readings of one position: segments of its plans (mm), rates of rotation, lengths."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

from tmm_cli.drawing.paper import SheetPicture
from tmm_cli.drawing.sheets import MotionPlanKind, motion_plan_kinds
from tmm_cli.language import _
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.numerics import NO_VECTOR
from tmm_cli.mechanics.plans import NamedVector, Plan, PlanPoint, angular_values, extent, round_scale, with_subscripts
from tmm_cli.note.blocks import Block, Equation
from tmm_cli.note.expression import ComputedQuantity, Expression, Leaf
from tmm_cli.note.formula_tree import Letter, Number, row
from tmm_cli.note.subject import OF_POSITION, Subject

SMALL = 0.2  # of the largest known vector: a smaller one is not the one by which a scale is told


@dataclass(frozen=True)
class DrawnVector:
    """Vector of a plan: its symbol, magnitude (SI) and segment; a zero vector has no segment."""

    symbol: Symbol
    size: float
    segment: str

    @property
    def leaf(self) -> Leaf:
        """Magnitude as a leaf of a formula."""
        return Leaf(self.symbol, self.size)


@dataclass(frozen=True)
class DrawnPlan:
    """Velocity or acceleration plan at its scale."""

    subject: Subject
    motion: Motion
    k: int
    name: Literal["velocity", "acceleration"]

    @cached_property
    def kind(self) -> MotionPlanKind:
        """Letters and units of the plan."""
        return next(sort for sort in motion_plan_kinds() if sort.stem == self.name)

    @cached_property
    def plan(self) -> Plan:
        """Vectors of the plan."""
        return self.kind.plan(self.motion, self.k)

    @cached_property
    def mu(self) -> float:
        """Scale in SI units per mm: that of the drawing, or the one it would have."""
        for drawing in self.subject.drawings(self.name, self.k).values():
            if isinstance(drawing, SheetPicture) and drawing.mu is not None:
                return drawing.mu
        longest = OF_POSITION[self.name][1]
        __, across, up, ___ = extent([0j, *(p for v in self.plan.vectors for p in (v.start, v.end))])
        return round_scale(across, up, longest, longest)

    @cached_property
    def ends(self) -> dict[str, NamedVector]:
        """Vectors of points and centres of mass by name."""
        return {v.symbol.below: v for v in self.plan.vectors if v.kind == "absolute"}

    def vector_of(self, spot: PlanPoint | str) -> DrawnVector:
        """Return the vector of a point, or of a centre of mass by name."""
        name = spot if isinstance(spot, str) else spot.name
        return self._vector(Symbol(self.kind.letter, name), self._end(name), self.kind.pole + self._letter(name))

    def relative(self, point: PlanPoint, base: PlanPoint) -> DrawnVector:
        """Return the velocity of a point relative to another; relative to a fixed point, its absolute velocity."""
        if base.fixed:
            return self.vector_of(point)
        symbol = Symbol(self.kind.letter, point.name + base.name)
        letters = [self._letter(spot.name) or self.kind.pole for spot in (base, point)]
        return self._vector(symbol, self._end(point.name) - self._end(base.name), "".join(letters))

    def component(self, point: PlanPoint, base: PlanPoint, above: str) -> DrawnVector:
        """Return a component of a relative acceleration: n, τ, k or r."""
        symbol = Symbol(self.kind.letter, point.name + base.name, above)
        found = next(v for v in self.plan.vectors if v.symbol == symbol)
        return self._vector(symbol, found.value, found.name)

    def moves_alike(self, one: str, other: str) -> bool:
        """Return True if two points have the same velocity or acceleration."""
        return abs(self._end(one) - self._end(other)) <= NO_VECTOR * self.plan.size

    def measure(self, vector: DrawnVector) -> Block:
        """Return the value of a vector measured on the plan."""
        return self.write_magnitude(vector, Leaf(Symbol("μ", self.kind.letter), self.mu) * self._segment(vector))

    def write_magnitude(self, vector: DrawnVector, expression: Expression) -> Block:
        """Return a vector whose magnitude an expression gives."""
        if not vector.segment:
            return zero_equation(vector.symbol)
        return ComputedQuantity(vector.symbol, expression, vector.size, unit_of(self.kind.letter))

    def compute_scale(self, vector: DrawnVector) -> Block:
        """Return the scale of the plan from the vector drawn first."""
        per_mm = {"v": _("(m/s)/mm"), "a": _("(m/s²)/mm")}[self.kind.letter]
        name, most = Symbol("μ", self.kind.letter), len(f"{self.mu:e}".partition("e")[0].rstrip("0").replace(".", ""))
        return ComputedQuantity(name, vector.leaf / self._segment(vector), self.mu, per_mm, most=most)

    def _segment(self, vector: DrawnVector) -> Leaf:
        return Leaf(segment_symbol(vector), vector.size / self.mu)

    def _end(self, name: str) -> complex:
        return self.ends[name].end if name in self.ends else 0j

    def _letter(self, name: str) -> str:
        """Return the letter at the end of a point's vector; none for a fixed point, which is at the pole."""
        return self.ends[name].name[len(self.kind.pole) :] if name in self.ends else ""

    def _vector(self, symbol: Symbol, value: complex, segment: str) -> DrawnVector:
        there = abs(value) > NO_VECTOR * self.plan.size
        return DrawnVector(symbol, abs(value) if there else 0.0, segment if there else "")


@dataclass(frozen=True)
class PositionPlans:
    """Position with its velocity and acceleration plans.

    first: the first detailed position, in which the method is explained.
    """

    subject: Subject
    k: int
    first: bool

    @property
    def motion(self) -> Motion:
        """Motion of the mechanism."""
        return self.subject.motion

    @cached_property
    def v(self) -> DrawnPlan:
        """Velocity plan."""
        return DrawnPlan(self.subject, self.motion, self.k, "velocity")

    @cached_property
    def a(self) -> DrawnPlan:
        """Acceleration plan."""
        return DrawnPlan(self.subject, self.motion, self.k, "acceleration")

    @cached_property
    def omega(self) -> Mapping[str, float]:
        """Angular velocities (rad/s) of the links that rotate in some position."""
        return {turn.symbol.below: turn.value for turn in angular_values(self.motion, self.k, "omega")}

    @cached_property
    def epsilon(self) -> Mapping[str, float]:
        """Angular accelerations (rad/s²) of the links that do not rotate uniformly."""
        return {turn.symbol.below: turn.value for turn in angular_values(self.motion, self.k, "epsilon")}

    def rates(self, letter: str) -> Mapping[str, float]:
        """Return the angular velocities (ω) or accelerations (ε) by link."""
        return self.omega if letter == "ω" else self.epsilon

    def rate(self, letter: str, link: str) -> Leaf:
        """Return the magnitude of a link's angular velocity or acceleration."""
        return Leaf(Symbol(letter, link), abs(self.rates(letter).get(link, 0.0)))

    def plan_of(self, letter: str) -> DrawnPlan:
        """Return the velocity plan for ω, the acceleration plan for ε."""
        return self.v if letter == "ω" else self.a

    def length(self, point: PlanPoint, base: PlanPoint) -> Leaf:
        """Return the distance (m) between two points of a link."""
        places = [complex(self.motion.spot(spot.at)[self.k]) for spot in (base, point)]
        return Leaf(Symbol("l", base.at + point.at), abs(places[1] - places[0]))


def unit_of(letter: str) -> str:
    """Return the unit of v, a, ω or ε."""
    return {"v": _("m/s"), "a": _("m/s²"), "ω": _("rad/s"), "ε": _("rad/s²")}[letter]


def find_scale_vector(vectors: Sequence[DrawnVector]) -> DrawnVector | None:
    """Return the first vector large enough to set a scale; None if all are zero."""
    largest = max((vector.size for vector in vectors), default=0.0)
    return next((vector for vector in vectors if vector.segment and vector.size > SMALL * largest), None)


def vector_letter(symbol: Symbol) -> Letter:
    """Return a symbol with a bar above."""
    return Letter(symbol, True)


def segment_symbol(vector: DrawnVector) -> Symbol:
    """Return the symbol of a vector's segment."""
    return Symbol(with_subscripts(vector.segment))


def zero_equation(symbol: Symbol) -> Block:
    """Return the equation symbol = 0."""
    return Equation(row(Letter(symbol), "=", Number("0")))
