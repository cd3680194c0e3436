"""The Zhukovsky lever of a position: the velocity plan rotated through 90 degrees and loaded with all
forces.
"""

from __future__ import annotations

import math
from collections.abc import Container, Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from tmm_cli.mechanics.forces import (
    DRIVE,
    AppliedLoad,
    Balance,
    EquationUnknown,
    ForceOrCouple,
    FreeBody,
    MomentEquation,
    MomentTerm,
    Reactions,
    Symbol,
    ZhukovskyLever,
    balance_symbol,
    distinct_letter,
    drop_negligible,
    list_free_bodies,
    load_symbols,
    moment_terms,
    number_arms,
    vector_kind,
)
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.plans.force_polygons import ForcePlan, force_plans
from tmm_cli.mechanics.plans.motion_plans import absolute_vectors, links_with_mass, plan_ends, relative_vectors
from tmm_cli.mechanics.plans.named_vectors import NamedVector, sheet_scale

LEVER_POLE = "p"
ROTATED = -1j  # clockwise: velocities of the crank lie along the crank, and couples keep their sense
MOST_FORCES = 22  # largest number of forces on a lever; with more, couples are not replaced by forces


@dataclass(frozen=True)
class CoupleAsForces:
    """Couple M (N m) on a link, replaced by two forces P and P′ at two of its points, each M / distance (m)."""

    symbol: Symbol
    couple: Symbol
    moment: float
    points: tuple[str, str]
    distance: float

    @property
    def force(self) -> float:
        """Magnitude of each force, N."""
        return abs(self.moment) / self.distance


@dataclass(frozen=True)
class LeverPlan:
    """Lever of one position. ends: lettered points of the rotated plan (m per unit of the driver's motion);
    bars: its lines.

    acting: all forces at these points, and couples: balancing couples, and M′ = M ω/ω₁ where M is not
    replaced by two forces (links of one point, levers with many forces). pairs: couples replaced by forces.
    couples: these M′ with their loads. equation: moments about the pole.
    """

    ends: dict[str, complex]
    bars: tuple[NamedVector, ...]
    acting: tuple[ForceOrCouple, ...]
    pairs: tuple[CoupleAsForces, ...]
    couples: tuple[tuple[AppliedLoad, ForceOrCouple], ...]
    equation: MomentEquation


def lever_plan(motion: Motion, reactions: Reactions, lever: ZhukovskyLever, k: int) -> LeverPlan:
    """Build the lever at position k: velocities per unit of the driver's motion, rotated clockwise; forces keep
    their directions.

    The balancing moment of a single driver follows from the moments of the loads; with several drivers it is
    taken from the force plan.
    """
    linkage = motion.linkage
    ends = plan_ends(linkage, LEVER_POLE, lambda point: ROTATED * complex(motion.named(point).first[k]))
    bars = (*absolute_vectors(ends, LEVER_POLE), *relative_vectors(motion, ends))
    for link in links_with_mass(linkage):
        ends[distinct_letter(ends, f"s{link}")] = ROTATED * complex(motion.centre(link).first[k])
    acting: list[ForceOrCouple] = []
    pairs: list[CoupleAsForces] = []
    couples: list[tuple[AppliedLoad, ForceOrCouple]] = []
    taken = {load_symbols(load)[0] for load in reactions.applied if load.has_force}
    crowded = sum(1 + 2 * (load.moment[k] != 0) for load in reactions.applied) > MOST_FORCES
    for load in reactions.applied:
        acting += _lever_force(motion, load, k)
        pair = None if crowded else _couple_as_forces(motion, load, k, taken)
        if pair is None:
            couples.append((load, _lever_couple(motion, load, k)))
            acting.append(couples[-1][1])
        else:
            pairs.append(pair)
            taken.add(pair.symbol)
            acting += _forces_of_couple(motion, load, pair, k)
    several = len(reactions.balances) > 1
    for balance in reactions.balances:
        acting += _balancing_forces(motion, balance, k, None if several else float(lever.balancing[k]), several=several)
    first = reactions.balance
    turns = first.kind == "moment"
    sought = None if several else EquationUnknown(balance_symbol(first.driver.link, False, turns=turns), DRIVE)
    extent = max((abs(end) for end in ends.values()), default=0.0)
    forces = drop_negligible(acting, extent or 1.0)
    symbols = {a.symbol for a in forces}
    kept = tuple((load, couple) for load, couple in couples if any(couple is a for a in forces))
    (equation,) = number_arms([MomentEquation((), LEVER_POLE, 0j, moment_terms(forces, 0j, extent), sought)])
    return LeverPlan(ends, bars, forces, tuple(pair for pair in pairs if pair.symbol in symbols), kept, equation)


def _lever_force(motion: Motion, load: AppliedLoad, k: int) -> Iterable[ForceOrCouple]:
    end = ROTATED * complex(motion.point(load.link, load.at).first[k])
    yield ForceOrCouple(load_symbols(load)[0], vector_kind(load), load.link, end, complex(load.force[k]))


def _lever_couple(motion: Motion, load: AppliedLoad, k: int) -> ForceOrCouple:
    """Couple M′ = M times the speed ratio of the link to the driver."""
    ratio, at = float(motion.link(load.link).first[k]), ROTATED * complex(motion.point(load.link, load.at).first[k])
    symbol = load_symbols(load)[1].primed
    return ForceOrCouple(symbol, vector_kind(load), load.link, at, 0j, float(load.moment[k]) * ratio)


def _couple_as_forces(motion: Motion, load: AppliedLoad, k: int, taken: Container[Symbol]) -> CoupleAsForces | None:
    """Replace the couple on a link by two forces at its first two points; None if the link has only one point.

    taken: symbols of other forces. P₃ replaces M₃; if that is taken, P with the whole symbol of the couple as
    index.
    """
    points = list(motion.linkage.links[load.link].points.items())
    if load.moment[k] == 0 or len(points) < 2 or points[0][1] == points[1][1]:
        return None
    couple = load_symbols(load)[1]
    symbol = Symbol("P", couple.below or couple.letter)
    if symbol in taken:
        symbol = Symbol("P", couple.plain)
    distance = abs(complex(points[1][1] - points[0][1]))
    return CoupleAsForces(symbol, couple, float(load.moment[k]), (points[0][0], points[1][0]), distance)


def _forces_of_couple(motion: Motion, load: AppliedLoad, pair: CoupleAsForces, k: int) -> Iterable[ForceOrCouple]:
    """Yield the two forces, perpendicular to the line of the two points, at the ends of the velocities of these
    points.
    """
    first, second = (complex(motion.linkage.local(load.link, point)) for point in pair.points)
    arm = (second - first) * complex(motion.poses[load.link].z[k])
    force = 1j * arm * (pair.moment / abs(arm) ** 2)
    for local, symbol, sense in ((first, pair.symbol.primed, -1), (second, pair.symbol, 1)):
        end = ROTATED * complex(motion.point(load.link, local).first[k])
        yield ForceOrCouple(symbol, vector_kind(load), load.link, end, sense * force)


def _balancing_forces(
    motion: Motion, balance: Balance, k: int, moment: float | None, *, several: bool
) -> Iterable[ForceOrCouple]:
    """Yield the balancing force or couple of a driver.

    moment: result of the lever for a single driver (N m or N); None: the value of the force plan.
    """
    driver, turns = balance.driver, balance.kind == "moment"
    symbol = balance_symbol(driver.link, several, turns=turns)
    ratio = float(np.broadcast_to(motion.drives[driver.link].first, motion.q.shape)[k])
    total = float(balance.generalized[k]) * ratio if moment is None else moment
    if turns:
        yield ForceOrCouple(symbol, "reaction", driver.link, 0j, 0j, total, DRIVE)
        return
    driven, base = (
        _point_transfer_function(motion, link, complex(balance.at[k]), k) for link in (driver.link, driver.base)
    )
    if driven == base:  # of several drivers one may be at rest: what holds it acts in the pole
        return
    force = (driven - base) * (total / abs(driven - base) ** 2)
    yield ForceOrCouple(symbol, "reaction", driver.link, ROTATED * driven, force, pair=DRIVE)
    if driver.base != FRAME:
        yield ForceOrCouple(symbol.primed, "reaction", driver.base, ROTATED * base, -force)


def _point_transfer_function(motion: Motion, link: str, place: complex, k: int) -> complex:
    """Velocity of a point of a link per unit of the driver's motion."""
    if link == FRAME:
        return 0j
    pose = motion.poses[link]
    return complex(motion.point(link, complex((place - pose.x[k]) / pose.z[k])).first[k])


# Graphical determination of the balancing moment: by the force plan and by the Zhukovsky lever.
#
# Arms and segments are measured on the drawings to half a millimetre; loads are calculated. The difference of the two
# results is then a drawing error of about 0.1 to 2 %, while that of `forces.lever` is exact.


READING_STEP = 0.5  # mm: resolution of a reading from paper


@dataclass(frozen=True)
class DrawingScales:
    """Scales (SI units per mm) of the drawings of the input link, its force plan and the Zhukovsky lever."""

    link: float
    forces: float
    lever: float


@dataclass(frozen=True)
class DrawnCheck:
    """Balancing moment (N m) or force (N) measured on the force plan and on the lever.

    difference: relative to the largest balancing value of all positions.
    """

    plan: float
    lever: float
    difference: float


@dataclass(frozen=True)
class BalanceDrawings:
    """The three drawings of a position from which the balancing moment is measured."""

    link: FreeBody
    forces: ForcePlan
    lever: LeverPlan

    def scales(self) -> DrawingScales:
        """Return the scales at which each drawing fills a sheet A4."""
        terms = [term for equation in self.link.equations for term in equation.terms]
        positions = [*(e.centre for e in self.link.equations), *(p for t in terms for p in (t.acting.at, t.foot))]
        polygon = [p for vector in self.forces.plan.vectors for p in (vector.start, vector.end)]
        ends = [*self.lever.ends.values(), *(term.foot for term in self.lever.equation.terms)]
        return DrawingScales(*(sheet_scale(points)[1] for points in (positions, polygon, ends)))


def balance_drawings(motion: Motion, reactions: Reactions, lever: ZhukovskyLever, k: int) -> BalanceDrawings | None:
    """Return the drawings of position k; None with several drivers, or if the driving link is not on the frame."""
    bodies = [body for body in list_free_bodies(motion, reactions, k) if body.links == (reactions.balance.driver.link,)]
    plans = [plan for plan in force_plans(reactions, k, motion) if plan.driving]
    if len(reactions.balances) > 1 or not bodies or not bodies[-1].driving or not plans:
        return None
    return BalanceDrawings(bodies[-1], plans[0], lever_plan(motion, reactions, lever, k))


def drawn_check(motion: Motion, reactions: Reactions, drawn: BalanceDrawings, scales: DrawingScales) -> DrawnCheck:
    """Measure the balancing moment on drawings of these scales, by the force plan and by the lever."""
    balance = reactions.balance
    symbol = balance_symbol(balance.driver.link, False, turns=balance.kind == "moment")
    segments = {v.symbol: _read_off(abs(v.value), scales.forces) for v in drawn.forces.plan.vectors}
    equation = next((e for e in drawn.link.equations if e.found is not None and e.found.acting.pair == DRIVE), None)
    plan = segments.get(symbol, 0.0) if equation is None else _measured_unknown(equation, scales.link, segments)
    lever = _measured_unknown(drawn.lever.equation, scales.lever, {})
    arm = 1.0 if balance.kind == "moment" or balance.moment is None else balance.arm
    largest = float(np.nanmax(np.abs(np.where(motion.moving, balance.generalized, 0.0)))) / arm
    return DrawnCheck(plan, lever, abs(abs(plan) - abs(lever)) / largest if largest else math.nan)


def _read_off(length: float, mu: float) -> float:
    """Round a length (SI) to what can be read off a drawing of scale `mu` (SI units per mm)."""
    return round(length / mu / READING_STEP) * READING_STEP * mu


def _measured_unknown(equation: MomentEquation, mu: float, segments: Mapping[Symbol, float]) -> float:
    """Value of the unknown of a moment equation with measured arms. segments: forces that are measured too, N."""
    unknown = equation.found
    if unknown is None:
        return 0.0

    def moment(term: MomentTerm) -> float:
        if not term.number:
            return term.moment
        magnitude = segments.get(term.acting.symbol, term.acting.size) if term.acting.pair else term.acting.size
        return math.copysign(magnitude * _read_off(term.arm, mu), term.moment)

    value = -math.copysign(1.0, unknown.moment) * math.fsum(moment(t) for t in equation.terms if t is not unknown)
    arm = 1.0 if unknown.acting.couple else _read_off(unknown.arm, mu)
    return value / arm if arm else math.nan
