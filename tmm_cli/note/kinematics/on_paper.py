"""Velocity and acceleration plans of one position, with values as a student would measure them on the drawings."""

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

SMALL = 0.2  # fraction of the largest known vector; a smaller vector does not set the scale


@dataclass(frozen=True)
class DrawnVector:
    """Vector of a velocity or acceleration plan.

    Attributes:
        symbol: symbol of the velocity or acceleration.
        size: magnitude, in SI.
        segment: letters at the ends of the segment; empty for a zero vector.
    """

    symbol: Symbol
    size: float
    segment: str

    @property
    def leaf(self) -> Leaf:
        """Magnitude of the vector, for use in a formula."""
        return Leaf(self.symbol, self.size)


@dataclass(frozen=True)
class DrawnPlan:
    """Velocity or acceleration plan of one position, drawn to scale."""

    subject: Subject
    motion: Motion
    k: int
    name: Literal["velocity", "acceleration"]

    @cached_property
    def kind(self) -> MotionPlanKind:
        """Kind of the plan (velocity or acceleration), with its letters and units."""
        return next(sort for sort in motion_plan_kinds() if sort.stem == self.name)

    @cached_property
    def plan(self) -> Plan:
        return self.kind.plan(self.motion, self.k)

    @cached_property
    def mu(self) -> float:
        """Scale of the plan (SI units per mm).

        For a note without drawings it is the scale that the drawing would have.
        """
        for drawing in self.subject.drawings(self.name, self.k).values():
            if isinstance(drawing, SheetPicture) and drawing.mu is not None:
                return drawing.mu
        longest = OF_POSITION[self.name][1]
        __, across, up, ___ = extent([0j, *(p for v in self.plan.vectors for p in (v.start, v.end))])
        return round_scale(across, up, longest, longest)

    @cached_property
    def ends(self) -> dict[str, NamedVector]:
        """Vectors drawn from the pole, by the name of the point or centre of mass to which they belong."""
        return {v.symbol.below: v for v in self.plan.vectors if v.kind == "absolute"}

    def vector_of(self, spot: PlanPoint | str) -> DrawnVector:
        """Return the velocity or acceleration of a point, or of a centre of mass given by its name."""
        name = spot if isinstance(spot, str) else spot.name
        return self._vector(Symbol(self.kind.letter, name), self._end(name), self.kind.pole + self._letter(name))

    def relative(self, point: PlanPoint, base: PlanPoint) -> DrawnVector:
        """Return the velocity of a point relative to another point. Relative to a fixed point it is absolute."""
        if base.fixed:
            return self.vector_of(point)
        symbol = Symbol(self.kind.letter, point.name + base.name)
        letters = [self._letter(spot.name) or self.kind.pole for spot in (base, point)]
        return self._vector(symbol, self._end(point.name) - self._end(base.name), "".join(letters))

    def component(self, point: PlanPoint, base: PlanPoint, above: str) -> DrawnVector:
        """Return a component of a relative acceleration.

        Args:
            point: point whose acceleration is considered.
            base: point relative to which it is considered.
            above: superscript of the component: n (normal), τ (tangential), k (Coriolis) or r (relative).
        """
        symbol = Symbol(self.kind.letter, point.name + base.name, above)
        vector = next(v for v in self.plan.vectors if v.symbol == symbol)
        return self._vector(symbol, vector.value, vector.name)

    def moves_alike(self, first: str, second: str) -> bool:
        """Return True if two points have the same velocity or acceleration."""
        return abs(self._end(first) - self._end(second)) <= NO_VECTOR * self.plan.size

    def measure(self, vector: DrawnVector) -> Block:
        """Return the line that computes the magnitude of a vector from its segment on the plan and the scale."""
        return self.write_magnitude(vector, Leaf(Symbol("μ", self.kind.letter), self.mu) * self._segment(vector))

    def write_magnitude(self, vector: DrawnVector, expression: Expression) -> Block:
        """Return the line that computes the magnitude of a vector from an expression."""
        if not vector.segment:
            return zero_equation(vector.symbol)
        return ComputedQuantity(vector.symbol, expression, vector.size, unit_of(self.kind.letter))

    def compute_scale(self, vector: DrawnVector) -> Block:
        """Return the line that computes the scale of the plan.

        The scale is the magnitude of the vector that is drawn first, divided by the length (mm) of the segment that
        represents it.
        """
        per_mm = {"v": _("(m/s)/mm"), "a": _("(m/s²)/mm")}[self.kind.letter]
        name, most = Symbol("μ", self.kind.letter), len(f"{self.mu:e}".partition("e")[0].rstrip("0").replace(".", ""))
        return ComputedQuantity(name, vector.leaf / self._segment(vector), self.mu, per_mm, most=most)

    def _segment(self, vector: DrawnVector) -> Leaf:
        return Leaf(segment_symbol(vector), vector.size / self.mu)

    def _end(self, name: str) -> complex:
        return self.ends[name].end if name in self.ends else 0j

    def _letter(self, name: str) -> str:
        """Return the letter at the end of the vector of a point.

        It is empty for a fixed point, whose vector is zero.
        """
        return self.ends[name].name[len(self.kind.pole) :] if name in self.ends else ""

    def _vector(self, symbol: Symbol, value: complex, segment: str) -> DrawnVector:
        nonzero = abs(value) > NO_VECTOR * self.plan.size
        return DrawnVector(symbol, abs(value) if nonzero else 0.0, segment if nonzero else "")


@dataclass(frozen=True)
class PositionPlans:
    """Position of a mechanism with its velocity and acceleration plans.

    Attributes:
        subject: results that the note describes.
        k: index of the position.
        first: True for the first detailed position, in which the note explains the method.
    """

    subject: Subject
    k: int
    first: bool

    @property
    def motion(self) -> Motion:
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
        """Angular velocities (rad/s) in this position, by link. Links that never rotate are left out."""
        return {turn.symbol.below: turn.value for turn in angular_values(self.motion, self.k, "omega")}

    @cached_property
    def epsilon(self) -> Mapping[str, float]:
        """Angular accelerations (rad/s²) in this position, by link. Links that always rotate uniformly are left out."""
        return {turn.symbol.below: turn.value for turn in angular_values(self.motion, self.k, "epsilon")}

    def rates(self, letter: str) -> Mapping[str, float]:
        """Return the angular velocities (letter ω) or accelerations (letter ε) by link."""
        return self.omega if letter == "ω" else self.epsilon

    def rate(self, letter: str, link: str) -> Leaf:
        """Return the magnitude of the angular velocity (letter ω) or acceleration (letter ε) of a link."""
        return Leaf(Symbol(letter, link), abs(self.rates(letter).get(link, 0.0)))

    def plan_of(self, letter: str) -> DrawnPlan:
        """Return the velocity plan for the letter ω, the acceleration plan for ε."""
        return self.v if letter == "ω" else self.a

    def length(self, point: PlanPoint, base: PlanPoint) -> Leaf:
        """Return the distance (m) between two points of a link in this position."""
        ends = [complex(self.motion.spot(spot.at)[self.k]) for spot in (base, point)]
        return Leaf(Symbol("l", base.at + point.at), abs(ends[1] - ends[0]))


def unit_of(letter: str) -> str:
    """Return the unit of v, a, ω or ε."""
    return {"v": _("m/s"), "a": _("m/s²"), "ω": _("rad/s"), "ε": _("rad/s²")}[letter]


def find_scale_vector(vectors: Sequence[DrawnVector]) -> DrawnVector | None:
    """Return the first vector large enough to set the scale of a plan; None if all are zero."""
    largest = max((vector.size for vector in vectors), default=0.0)
    return next((vector for vector in vectors if vector.segment and vector.size > SMALL * largest), None)


def vector_letter(symbol: Symbol) -> Letter:
    """Return a symbol with a bar above."""
    return Letter(symbol, True)


def segment_symbol(vector: DrawnVector) -> Symbol:
    """Return the symbol of the segment that represents a vector on the plan."""
    return Symbol(with_subscripts(vector.segment))


def zero_equation(symbol: Symbol) -> Block:
    """Return the equation symbol = 0."""
    return Equation(row(Letter(symbol), "=", Number("0")))
