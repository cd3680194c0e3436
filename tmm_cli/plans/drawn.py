"""What a student finds on paper for what balances the driver: by the force plan and by the Zhukovsky lever.

Arms and segments are measured on the drawings, to half a millimetre; loads are calculated. The difference of both ways
is then one of drawing, some 0.1 to 2 %, while the one of `forces.lever` is exact.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tmm_cli.forces.lever import Lever
from tmm_cli.forces.plan import Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.plans.bodies import DRIVE
from tmm_cli.plans.forces import ForcePlan, force_plans
from tmm_cli.plans.lever import LeverPlan, lever_plan
from tmm_cli.plans.moments import LoadedPart, MomentEquation, Term, loaded_parts
from tmm_cli.plans.record import Symbol, balance_symbol, sheet_scale

FINEST = 0.5  # mm: what can be read off paper


@dataclass(frozen=True)
class Scales:
    """SI a millimetre: of the driving link's drawing, of its force plan, of the lever."""

    link: float
    forces: float
    lever: float


@dataclass(frozen=True)
class DrawnCheck:
    """What balances the driver (N m or N), by both ways; difference: a share of the largest of all positions."""

    plan: float
    lever: float
    difference: float


@dataclass(frozen=True)
class Sheets:
    """The three drawings of a position from which the driver's balance is read."""

    link: LoadedPart
    forces: ForcePlan
    lever: LeverPlan

    def scales(self) -> Scales:
        """Those at which each fills a sheet A4."""
        terms = [term for equation in self.link.equations for term in equation.terms]
        places = [*(e.centre for e in self.link.equations), *(p for t in terms for p in (t.acting.at, t.foot))]
        polygon = [p for vector in self.forces.plan.vectors for p in (vector.start, vector.end)]
        ends = [*self.lever.ends.values(), *(term.foot for term in self.lever.equation.terms)]
        return Scales(*(sheet_scale(points)[1] for points in (places, polygon, ends)))


def sheets(motion: Motion, reactions: Reactions, lever: Lever, k: int) -> Sheets | None:
    """The drawings of position k; None where several drivers share the balance, or the driver is not on the frame."""
    own = [part for part in loaded_parts(motion, reactions, k) if part.links == (reactions.balance.driver.link,)]
    plans = [plan for plan in force_plans(reactions, k, motion) if plan.driving]
    if len(reactions.balances) > 1 or not own or not own[-1].driving or not plans:
        return None
    return Sheets(own[-1], plans[0], lever_plan(motion, reactions, lever, k))


def drawn_check(motion: Motion, reactions: Reactions, drawn: Sheets, scales: Scales) -> DrawnCheck:
    """Both ways on drawings of these scales."""
    balance = reactions.balance
    symbol = balance_symbol(balance.driver.link, False, turns=balance.kind == "moment")
    segments = {v.symbol: _read(abs(v.value), scales.forces) for v in drawn.forces.plan.vectors}
    equation = next((e for e in drawn.link.equations if e.found is not None and e.found.acting.pair == DRIVE), None)
    plan = segments.get(symbol, 0.0) if equation is None else _measured(equation, scales.link, segments)
    lever = _measured(drawn.lever.equation, scales.lever, {})
    arm = 1.0 if balance.kind == "moment" or balance.moment is None else balance.arm
    largest = float(np.nanmax(np.abs(np.where(motion.moving, balance.generalized, 0.0)))) / arm
    return DrawnCheck(plan, lever, abs(abs(plan) - abs(lever)) / largest if largest else math.nan)


def _read(length: float, mu: float) -> float:
    """A length (SI) as it is read off a drawing of this scale."""
    return round(length / mu / FINEST) * FINEST * mu


def _measured(equation: MomentEquation, mu: float, segments: Mapping[Symbol, float]) -> float:
    """What an equation of moments gives with arms that are measured; segments: forces that are measured too, N."""
    found = equation.found
    if found is None:
        return 0.0

    def moment(term: Term) -> float:
        if not term.number:
            return term.moment
        size = segments.get(term.acting.symbol, term.acting.size) if term.acting.pair else term.acting.size
        return math.copysign(size * _read(term.arm, mu), term.moment)

    value = -math.copysign(1.0, found.moment) * math.fsum(moment(t) for t in equation.terms if t is not found)
    arm = 1.0 if found.acting.couple else _read(found.arm, mu)
    return value / arm if arm else math.nan
