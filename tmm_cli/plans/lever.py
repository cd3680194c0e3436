"""The Zhukovsky lever of a position: the velocity plan turned through 90 degrees, loaded with all forces."""

from __future__ import annotations

from collections.abc import Container, Iterable
from dataclasses import dataclass

import numpy as np

from tmm_cli.forces.applied import Applied
from tmm_cli.forces.lever import Lever
from tmm_cli.forces.plan import Balance, Reactions
from tmm_cli.kinematics.motion import Motion
from tmm_cli.linkage import FRAME
from tmm_cli.plans.bodies import DRIVE, Acting, kind_of, load_symbols, there
from tmm_cli.plans.moments import MomentEquation, Sought, numbered, terms
from tmm_cli.plans.record import NamedVector, Symbol, balance_symbol
from tmm_cli.plans.velocity import absolute, ends_of, massive, other_than, relative

POLE = "p"
TURNED = -1j  # clockwise: the line of the crank comes to lie along the crank, and couples keep their sense
MOST = 22  # forces on a lever, those of couples among them; with more of them couples stay couples


@dataclass(frozen=True)
class Pair:
    """A couple M (N m) on a link as two forces, P and P′, M over the distance (m) of two of its points, each."""

    symbol: Symbol
    couple: Symbol
    moment: float
    points: tuple[str, str]
    distance: float

    @property
    def force(self) -> float:
        """The magnitude of each force, N."""
        return abs(self.moment) / self.distance


@dataclass(frozen=True)
class LeverPlan:
    """ends: lettered points of the turned plan (m per unit of the driver's motion). bars: its lines.

    acting: all forces, at these places, and couples: those that balance, and M′ = M ω/ω₁ where M is not a pair of
    forces (on links of one point, and on levers with many forces). couples: these M′ with the loads that they are of.
    equation: their moments about the pole.
    """

    ends: dict[str, complex]
    bars: tuple[NamedVector, ...]
    acting: tuple[Acting, ...]
    pairs: tuple[Pair, ...]
    couples: tuple[tuple[Applied, Acting], ...]
    equation: MomentEquation


def lever_plan(motion: Motion, reactions: Reactions, lever: Lever, k: int) -> LeverPlan:
    """Velocities per unit of the driver's motion, turned clockwise; forces keep their directions.

    One driver is found from the moments of the loads; of several the force plan says what they do.
    """
    linkage = motion.linkage
    ends = ends_of(linkage, POLE, lambda point: TURNED * complex(motion.named(point).first[k]))
    bars = (*absolute(ends, POLE), *relative(motion, ends))
    for link in massive(linkage):
        ends[other_than(ends, f"s{link}")] = TURNED * complex(motion.centre(link).first[k])
    acting: list[Acting] = []
    pairs: list[Pair] = []
    couples: list[tuple[Applied, Acting]] = []
    taken = {load_symbols(load)[0] for load in reactions.applied if load.has_force}
    crowded = sum(1 + 2 * (load.moment[k] != 0) for load in reactions.applied) > MOST
    for load in reactions.applied:
        acting += _force(motion, load, k)
        pair = None if crowded else _pair(motion, load, k, taken)
        if pair is None:
            couples.append((load, _couple(motion, load, k)))
            acting.append(couples[-1][1])
        else:
            pairs.append(pair)
            taken.add(pair.symbol)
            acting += _forces_of(motion, load, pair, k)
    several = len(reactions.balances) > 1
    for balance in reactions.balances:
        acting += _balance(motion, balance, k, None if several else float(lever.balancing[k]), several=several)
    first = reactions.balance
    turns = first.kind == "moment"
    sought = None if several else Sought(balance_symbol(first.driver.link, False, turns=turns), DRIVE)
    size = max((abs(end) for end in ends.values()), default=0.0)
    found = there(acting, size or 1.0)
    symbols = {a.symbol for a in found}
    kept = tuple((load, couple) for load, couple in couples if any(couple is a for a in found))
    (equation,) = numbered([MomentEquation((), POLE, 0j, terms(found, 0j, size), sought)])
    return LeverPlan(ends, bars, found, tuple(pair for pair in pairs if pair.symbol in symbols), kept, equation)


def _force(motion: Motion, load: Applied, k: int) -> Iterable[Acting]:
    end = TURNED * complex(motion.point(load.link, load.at).first[k])
    yield Acting(load_symbols(load)[0], kind_of(load), load.link, end, complex(load.force[k]))


def _couple(motion: Motion, load: Applied, k: int) -> Acting:
    """M′, with the ratio of the link's speed to the driver's in it."""
    ratio, at = float(motion.link(load.link).first[k]), TURNED * complex(motion.point(load.link, load.at).first[k])
    symbol = load_symbols(load)[1].primed
    return Acting(symbol, kind_of(load), load.link, at, 0j, float(load.moment[k]) * ratio)


def _pair(motion: Motion, load: Applied, k: int, taken: Container[Symbol]) -> Pair | None:
    """The two forces that replace the couple on a link, at its first two points; None if the link has one point.

    taken: symbols of other forces. P₃ replaces M₃; if that is taken, P with the whole symbol of the couple.
    """
    points = list(motion.linkage.links[load.link].points.items())
    if load.moment[k] == 0 or len(points) < 2 or points[0][1] == points[1][1]:
        return None
    couple = load_symbols(load)[1]
    symbol = Symbol("P", couple.below or couple.letter)
    if symbol in taken:
        symbol = Symbol("P", couple.plain)
    distance = abs(complex(points[1][1] - points[0][1]))
    return Pair(symbol, couple, float(load.moment[k]), (points[0][0], points[1][0]), distance)


def _forces_of(motion: Motion, load: Applied, pair: Pair, k: int) -> Iterable[Acting]:
    """Across the line of the two points, at the ends of their velocities."""
    one, other = (complex(motion.linkage.local(load.link, point)) for point in pair.points)
    arm = (other - one) * complex(motion.poses[load.link].z[k])
    force = 1j * arm * (pair.moment / abs(arm) ** 2)
    for local, symbol, sense in ((one, pair.symbol.primed, -1), (other, pair.symbol, 1)):
        end = TURNED * complex(motion.point(load.link, local).first[k])
        yield Acting(symbol, kind_of(load), load.link, end, sense * force)


def _balance(motion: Motion, balance: Balance, k: int, moment: float | None, *, several: bool) -> Iterable[Acting]:
    """What balances a driver; moment: what the lever gives for a single one (N m, or N), else the force plan's."""
    driver, turns = balance.driver, balance.kind == "moment"
    symbol = balance_symbol(driver.link, several, turns=turns)
    ratio = float(np.broadcast_to(motion.drives[driver.link].first, motion.q.shape)[k])
    total = float(balance.generalized[k]) * ratio if moment is None else moment
    if turns:
        yield Acting(symbol, "reaction", driver.link, 0j, 0j, total, DRIVE)
        return
    own, base = (_first(motion, link, complex(balance.at[k]), k) for link in (driver.link, driver.base))
    if own == base:  # of several drivers one may be at rest: what holds it acts in the pole
        return
    force = (own - base) * (total / abs(own - base) ** 2)
    yield Acting(symbol, "reaction", driver.link, TURNED * own, force, pair=DRIVE)
    if driver.base != FRAME:
        yield Acting(symbol.primed, "reaction", driver.base, TURNED * base, -force)


def _first(motion: Motion, link: str, place: complex, k: int) -> complex:
    """Velocity of a point of a link per unit of the driver's motion."""
    if link == FRAME:
        return 0j
    pose = motion.poses[link]
    return complex(motion.point(link, complex((place - pose.x[k]) / pose.z[k])).first[k])
