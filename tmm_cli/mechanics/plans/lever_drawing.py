"""The Zhukovsky lever at one position: the rotated velocity plan with all forces on it."""

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
    """Couple on a link, replaced by two equal and opposite forces P and P′ at two points of the link.

    Attributes:
        symbol: symbol of the force P.
        couple: symbol of the couple.
        moment: the couple, N m.
        points: names of the two points.
        distance: distance of the points, m.
    """

    symbol: Symbol
    couple: Symbol
    moment: float
    points: tuple[str, str]
    distance: float

    @property
    def force(self) -> float:
        """Magnitude of each of the two forces, N."""
        return abs(self.moment) / self.distance


@dataclass(frozen=True)
class LeverPlan:
    """Zhukovsky lever at one position, with all forces and couples on it.

    A couple M that cannot be replaced by two forces (link with one point, or too many forces for a drawing)
    acts on the lever as M′ = M ω/ω₁.

    Attributes:
        ends: letters and coordinates of the points of the rotated velocity plan, m per unit of the driver
            coordinate.
        bars: lines of the rotated plan.
        acting: forces at these points, couples M′ and balancing couples.
        pairs: couples replaced by two forces.
        couples: the loads whose couple is not replaced, each with its M′.
        equation: moments about the pole.
    """

    ends: dict[str, complex]
    bars: tuple[NamedVector, ...]
    acting: tuple[ForceOrCouple, ...]
    pairs: tuple[CoupleAsForces, ...]
    couples: tuple[tuple[AppliedLoad, ForceOrCouple], ...]
    equation: MomentEquation


def lever_plan(motion: Motion, reactions: Reactions, lever: ZhukovskyLever, k: int) -> LeverPlan:
    """Build the Zhukovsky lever at position k.

    Velocities, per unit velocity of the driver, are rotated clockwise through 90 degrees; forces keep their directions.
    With a single driver the balancing moment follows from the moments of the loads; with several drivers it is taken
    from the force plan.
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
    """Return the couple M′ on the lever: M times the speed ratio of its link to the driver."""
    ratio, at = float(motion.link(load.link).first[k]), ROTATED * complex(motion.point(load.link, load.at).first[k])
    symbol = load_symbols(load)[1].primed
    return ForceOrCouple(symbol, vector_kind(load), load.link, at, 0j, float(load.moment[k]) * ratio)


def _couple_as_forces(motion: Motion, load: AppliedLoad, k: int, taken: Container[Symbol]) -> CoupleAsForces | None:
    """Replace the couple on a link by two forces at the first two points of the link; None if it has only one
    point.

    taken: symbols of other forces. P₃ replaces M₃; if P₃ is taken, the whole symbol of the couple becomes the
    index of P.
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
    """Yield the two forces that replace a couple on a link, as they act on the lever.

    They are perpendicular to the line of the two points of the link, and act at the ends of the velocities of these
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
    """Yield the balancing force or couple of a driver on the lever.

    moment: balancing moment (N m) or force (N) from the lever, for a single driver; None to take it from the
    force plan.
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
    if driven == base:  # one of several drivers may be at rest: its force acts at the pole
        return
    force = (driven - base) * (total / abs(driven - base) ** 2)
    yield ForceOrCouple(symbol, "reaction", driver.link, ROTATED * driven, force, pair=DRIVE)
    if driver.base != FRAME:
        yield ForceOrCouple(symbol.primed, "reaction", driver.base, ROTATED * base, -force)


def _point_transfer_function(motion: Motion, link: str, place: complex, k: int) -> complex:
    """Return the velocity of a point of a link per unit velocity of the driver."""
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
    """Scales (SI units per mm) of three drawings: the input link, its force plan and the Zhukovsky lever."""

    link: float
    forces: float
    lever: float


@dataclass(frozen=True)
class DrawnCheck:
    """Balancing moment (N m) or force (N), measured on the drawing of the force plan and on that of the lever.

    difference: difference of the two, relative to the largest balancing value of all positions.
    """

    plan: float
    lever: float
    difference: float


@dataclass(frozen=True)
class BalanceDrawings:
    """The three drawings of one position on which the balancing moment is measured.

    They are the free body of the input link, its force plan, and the Zhukovsky lever.
    """

    link: FreeBody
    forces: ForcePlan
    lever: LeverPlan

    def scales(self) -> DrawingScales:
        """Return the scales at which each of the three drawings fills an A4 sheet."""
        terms = [term for equation in self.link.equations for term in equation.terms]
        positions = [*(e.centre for e in self.link.equations), *(p for t in terms for p in (t.acting.at, t.foot))]
        polygon = [p for vector in self.forces.plan.vectors for p in (vector.start, vector.end)]
        ends = [*self.lever.ends.values(), *(term.foot for term in self.lever.equation.terms)]
        return DrawingScales(*(sheet_scale(points)[1] for points in (positions, polygon, ends)))


def balance_drawings(motion: Motion, reactions: Reactions, lever: ZhukovskyLever, k: int) -> BalanceDrawings | None:
    """Return the three drawings on which the balancing moment is measured at position k.

    They are the free body of the input link, its force plan, and the Zhukovsky lever.

    Returns:
        The drawings; None if there are several drivers, or if the input link is not paired with the frame.
    """
    bodies = [body for body in list_free_bodies(motion, reactions, k) if body.links == (reactions.balance.driver.link,)]
    plans = [plan for plan in force_plans(reactions, k, motion) if plan.driving]
    if len(reactions.balances) > 1 or not bodies or not bodies[-1].driving or not plans:
        return None
    return BalanceDrawings(bodies[-1], plans[0], lever_plan(motion, reactions, lever, k))


def drawn_check(motion: Motion, reactions: Reactions, drawn: BalanceDrawings, scales: DrawingScales) -> DrawnCheck:
    """Measure the balancing moment on the drawings of the force plan and of the lever, made at these scales."""
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
    """Round a length (SI) to the resolution of a reading from a drawing whose scale is `mu` (SI units per mm)."""
    return round(length / mu / READING_STEP) * READING_STEP * mu


def _measured_unknown(equation: MomentEquation, mu: float, segments: Mapping[Symbol, float]) -> float:
    """Solve a moment equation for its unknown, with moment arms measured on a drawing.

    Args:
        equation: the moment equation.
        mu: scale of the drawing, SI units per mm.
        segments: magnitudes (N) of forces that are measured as well, by symbol.
    """
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
