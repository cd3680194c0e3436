"""How far each value may be from the truth by rounding, and how far the data carry it.

Every value is computed once more by the same stages in longdouble, from the decimals of the file. Against 60 digits the
difference between float64 and longdouble is the true error to about 1 %. What it leaves out is the error of the
longdouble value, which is a few units of its last place of all that the value responds to:

    bound = 2 |y - y_wide| + u |y| + 2 u_wide kappa,    u = 2^-53

with kappa, the response of y per unit relative change of the data, from changing every length alone. Values near dead
positions that were taken from longdouble already have the last two terms only, which is their true error again. Where
longdouble is no wider than double the data are shaken by a unit of their last place, all at once and at random, which
makes most roundings fall out anew; the bound is then 3 times the largest change of y in some such trials, + 4 u of the
largest value of its kind at the position (after J. Vignes, A stochastic arithmetic for reliable scientific computation,
Math. Comput. Simul. 35 (1993)). It holds as the other does, and is wider.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_cli.accuracy.data import Length, angles, changed, lengths, shaken, widened
from tmm_cli.extended import WIDER, near_dead, refined
from tmm_cli.groups.base import Kernel
from tmm_cli.linkage import FRAME, Linkage, Request
from tmm_cli.mechanism import Mechanism
from tmm_cli.motion import Law, Motion, move
from tmm_cli.pipeline import Results, given, with_forces
from tmm_cli.problem.record import Problem
from tmm_cli.problem.units import UnitSystem
from tmm_cli.strokes import Strokes, output_run
from tmm_cli.structure.assur import Structure
from tmm_cli.vectors import Real

if TYPE_CHECKING:
    from tmm_cli.pressure import Pressure

U = 2.0**-53
SHARE = 1e-3  # of each length: the change that sensitivities are told for
PAPER = 0.5  # mm of paper, likewise
ROUNDINGS = 2  # of longdouble, in units of u_wide kappa
TRIALS, SPREAD = 5, 3  # with shaken data; a bound in units of the largest change that they make
LOST = 0.1  # of the largest value of its kind: where a unit of the last place makes so much, trials tell no bound
STEP = 1e-7  # of a length, where the linkage is far from dead positions
CLOSE = 2.0**-7  # of the square of the margin, where it is near one
LEAST = 2.0**-56  # of a length: steps below that are rounding in longdouble too
CHUNK = 1500  # positions at once

Cells = Mapping[Hashable, Real]  # one value a position


@dataclass
class Digits:
    """For each value: its bound by rounding, its change when every length changes by 0.1 % and by 0.5 mm on paper.

    Changes are sums of the absolute changes by every single length: the worst case, to first order. Of the same keys
    and shapes as the values, in their units. mu: m a millimetre of paper, nan when nothing is drawn.
    """

    bound: dict[Hashable, Real] = field(default_factory=dict)
    lengths: dict[Hashable, Real] = field(default_factory=dict)
    paper: dict[Hashable, Real] = field(default_factory=dict)
    mu: float = float("nan")


def judged(
    results: Results,
    of: Callable[[Results], Cells],
    *,
    mu: float = float("nan"),
    blur: Real | float = 0.0,
    turning: Callable[[Hashable], bool] = lambda key: False,
    kind: Callable[[Hashable], Hashable] = lambda key: key,
    wider: bool = WIDER,
) -> Digits:
    """Digits of what `of` reads out of results with a motion, at all their positions.

    mu: scale of the drawing (m a mm). blur: how far each place of the driver may be from the one that was asked for
    (rad or m). turning: whether a value is an angle, a full turn from itself. kind: values of a kind are
    sums of parts of one size. wider: False is for machines whose longdouble is a double.
    """
    motion = results.motion
    assert motion is not None
    found, values = Digits(mu=mu), of(results)
    for part in (found.bound, found.lengths, found.paper):
        part.update({key: np.full(np.shape(value), np.nan) for key, value in values.items()})
    blur = np.broadcast_to(blur, np.shape(motion.q))
    for chosen, near in _chunks(results, wider):
        _judge(results, of, values, found, (chosen, near, wider), blur[chosen], (turning, kind))
    return found


def bare(linkage: Linkage, q: Real, structure: Structure, kernels: tuple[Kernel, ...]) -> Results:
    """Motion and reactions of a linkage without a file, at places q of its driver (position 0 first)."""
    problem = Problem("", "", linkage, Request(places=tuple(q.tolist())), UnitSystem())
    lead = linkage.driver
    law = Law(linkage.sketch.at if linkage.others else float(q[0]), lead.rate, lead.acceleration, lead.sense)
    motion = move(linkage, kernels, q, law)
    where = near_dead(motion)
    if WIDER and bool(np.any(where)):
        motion = refined(motion, widened(linkage), q[where].astype(np.longdouble), law, where)
    mechanism = Mechanism(linkage, structure)
    nothing: dict[str, Any] = {
        "way": None,
        "output": None,
        "outputs": (),
        "strokes": None,
        "further": (),
        "dead": (),
        "roles": {},
    }
    vars(mechanism).update(nothing, kernels=kernels)  # nothing but the positions themselves is looked for
    results = Results(problem, structure, mechanism, tuple(range(len(q))), motion)
    vars(results).update(travels=(), pressure=())
    return with_forces(results, cycle=False)


def bounds(results: Results, *, wider: bool = WIDER) -> tuple[Cells, Digits]:
    """Values and their digits, of a linkage whose numbers are exact as they stand when it has no file (see `bare`).

    Keys are (quantity, name, component): x, v, a of points ("A") and centres of mass ("S1"), angle, omega, epsilon of
    links, force and couple of pairs, balancing of drivers.
    """
    return quantities(results), judged(results, quantities, turning=_turns, kind=_quantity, wider=wider)


def _quantity(key: Hashable) -> Hashable:
    return key[0] if isinstance(key, tuple) else key


def _turns(key: Hashable) -> bool:
    return isinstance(key, tuple) and key[0] == "angle"


def quantities(results: Results) -> Cells:
    """The motion and reactions of results, by quantity, name and component."""
    motion = results.motion
    found: dict[Hashable, Real] = {}
    assert motion is not None

    def put(quantity: str, name: str, value: Real) -> None:
        for component, part in (("x", value.real), ("y", value.imag)) if np.iscomplexobj(value) else (("", value),):
            found[quantity, name, component] = part

    fixed = results.linkage.links[FRAME].points
    for name, link in results.linkage.links.items():
        if name == FRAME:
            continue
        turning = motion.link(name)
        for quantity in ("angle", "omega", "epsilon"):
            put(quantity, name, getattr(turning, quantity))
        moved = {point: motion.named(point) for point in link.points if point not in fixed}
        for point, motion_of in {**moved, f"S{name}": motion.centre(name)}.items():
            for quantity in "xva":
                put(quantity, point, getattr(motion_of, quantity))
    if results.reactions is not None:
        for reaction in results.reactions.all:
            put("force", reaction.pair.name, reaction.force)
            if reaction.couple is not None:
                put("couple", reaction.pair.name, reaction.couple)
        for balance in results.reactions.balances:
            put("balancing", balance.driver.link, balance.generalized)
    return found


def _chunks(results: Results, wider: bool) -> Iterator[tuple[Real, bool]]:
    """Positions to be judged together, and whether they are near a dead one."""
    motion = results.motion
    assert motion is not None
    near = near_dead(motion) if motion.where is None else motion.where
    for these, close in ((~near & motion.placed, False), (near, True)):
        places = np.flatnonzero(these)
        for start in range(0, len(places), CHUNK):
            yield places[start : start + CHUNK], close


def _judge(
    results: Results,
    of: Callable[[Results], Cells],
    values: Cells,
    found: Digits,
    where: tuple[Real, bool, bool],
    blur: Real,
    sorts: tuple[Callable[[Hashable], bool], Callable[[Hashable], Hashable]],
) -> None:
    """Fill in the digits of the chosen positions."""
    motion, (turning, kind) = results.motion, sorts
    assert motion is not None
    chosen, near, wider = where
    first = results.start if results.way is not None else float(motion.q[0])
    wide = plain = None
    if wider:
        linkage, asked = exact(results), motion.q.astype(np.longdouble)
        if results.problem.extended is not None and results.problem.request.places:
            places = np.array(results.problem.extended().request.places)
            asked, first, blur = places[list(results.numbers)], places[0], np.zeros(len(chosen))
        wide = at(results, linkage, asked[chosen], first, chosen)
    if wide is None or not near:
        plain = at(results, results.linkage, motion.q[chosen], results.start if results.way else motion.q[0], chosen)
    base = wide if near and wide is not None else plain
    assert base is not None
    assert base.motion is not None
    start = of(base)
    exactly = start if wide is base else {} if wide is None else of(wide)

    nothing = np.zeros(len(chosen))
    turns_round, there = (np.array([[told(key)] for key in values]) for told in (turning, start.__contains__))

    def stacked(cells: Cells) -> Real:
        return np.stack([cells.get(key, nothing) for key in values])

    rows = stacked(start)

    def slope(linkage: Linkage, q: Real, by: float) -> Real:
        """How fast every value changes, (values, chosen)."""
        moved = stacked(of(at(base, linkage, q, first)))
        with np.errstate(invalid="ignore"):
            away = np.where(turns_round, _gap(moved, rows, True), _gap(moved, rows, False))
            return np.where(there, away / by, 0.0).astype(float)

    step = _step(base, near)
    response, share, paper = np.zeros((3, len(values), len(chosen)))
    data = lengths(results.linkage)
    size = max((abs(length.value) for length in data), default=1.0)
    for length in (*data, *(angles(results.linkage) if near else ())):
        turns = not isinstance(length.along, complex)
        by = base.motion.q.dtype.type(step * (1.0 if turns else max(abs(length.value), _size(data, length.link))))
        slopes = slope(changed(base.linkage, length, by), base.motion.q, float(by))
        response += slopes * abs(length.value)
        if not turns:
            share += slopes * (SHARE * abs(length.value))
            paper += np.where(there, slopes * (PAPER * found.mu), 0.0)
    spread, largest = (dict.fromkeys(keys, nothing) for keys in (values, map(kind, values)))
    for key, value in start.items():
        largest[kind(key)] = np.fmax(largest[kind(key)], np.abs(value).astype(float))
    for trial in range(0 if wider else TRIALS):
        moved = of(at(base, *shaken(base.linkage, motion.q[chosen], trial), first))
        for key, value in start.items():
            spread[key] = np.maximum(spread[key], _gap(moved.get(key, nothing), value, turning(key)))
    reach = 1.0 if results.linkage.driver.kind == "turn" else size
    by_place = slope(base.linkage, base.motion.q + base.motion.q.dtype.type(step * reach), step * reach)
    for row, (key, value) in enumerate(values.items()):
        y = np.abs(np.asarray(value[..., chosen], float))
        by_q = by_place[row]
        kappa = response[row] + by_q * (np.abs(motion.q[chosen].astype(float)) + reach * near)
        if wider:
            fine = float(np.finfo(np.longdouble).eps) / 2
            away = _gap(np.asarray(value[chosen]), exactly.get(key, nothing), turning(key)).astype(float)
            bound = 2 * away + U * y + ROUNDINGS * fine * kappa
        else:
            bound = SPREAD * spread[key] + 4 * U * largest[kind(key)]
            bound = np.where(spread[key] > LOST * largest[kind(key)], np.nan, bound)
        with np.errstate(invalid="ignore"):
            bound = bound + np.where(blur > 0, by_q * blur, 0.0)
        found.bound[key][chosen] = np.where(np.isfinite(y), bound, np.nan)
        found.lengths[key][chosen] = share[row]
        found.paper[key][chosen] = paper[row]


def _gap(one: Real, other: Real, turns: bool) -> Real:
    away: Real = np.abs(one - other)
    return np.minimum(away, np.abs(2 * np.pi - away)) if turns else away


def _size(data: tuple[Length, ...], link: str) -> float:
    return max(abs(length.value) for length in data if length.link == link)


def _step(results: Results, near: bool) -> float:
    """The relative change of a length that derivatives are taken with: small against what is left to a dead one."""
    motion = results.motion
    assert motion is not None
    if not near:
        return STEP
    least = min(float(np.nanmin(np.where(motion.moving, at.margin, 1.0))) for at in motion.placements)
    return min(STEP, max(CLOSE * least**2, LEAST))


def exact(results: Results) -> Linkage:
    """The linkage with the decimals of its file in longdouble; without a file, with its numbers as they stand."""
    extended = results.problem.extended
    return widened(results.linkage) if extended is None else extended().linkage


def at(results: Results, linkage: Linkage, q: Real, first: float, chosen: Real | None = None) -> Results:
    """The same results at places q with the numbers of another linkage in the same assembly.

    first: the place of position 0. chosen: which of the positions these are; all of them when left out.
    """
    lead = linkage.driver
    law = Law(linkage.sketch.at if linkage.others else first, lead.rate, lead.acceleration, lead.sense)
    solved = results.kernels if results.motion is None else results.motion.kernels
    kernels = tuple(kernel.again(linkage) for kernel in solved)
    moved = move(linkage, kernels, q, law)
    numbers = results.numbers if chosen is None else tuple(results.numbers[k] for k in chosen)
    strokes = results.strokes
    if strokes is not None and any(load.table is not None and load.table.against == "stroke" for load in linkage.loads):
        strokes = _begun(strokes, linkage, kernels, q)
    found = given(
        results, problem=replace(results.problem, linkage=linkage), structure=results.structure.again(linkage),
        kernels=kernels, motion=moved, numbers=numbers, strokes=strokes, pressure=_pressed(results, moved),
    )  # fmt: skip
    return found if results.reactions is None else with_forces(found, cycle=False)


def _begun(strokes: Strokes, linkage: Linkage, kernels: tuple[Kernel, ...], q: Real) -> Strokes:
    """Strokes whose output begins where it really is there, which loads tabulated against it are counted from."""
    places = np.array([s.start for s in strokes.strokes], dtype=q.dtype)
    lows = output_run(move(linkage, kernels, places, Law(0.0, 1.0, 0.0, 1)), strokes.link)[0]
    return replace(strokes, strokes=tuple(replace(s, low=x) for s, x in zip(strokes.strokes, lows, strict=True)))


def _pressed(results: Results, motion: Motion) -> tuple[Pressure, ...]:
    """Pressure angles at the positions of the motion."""
    angles = {}
    if results.pressure:
        from tmm_cli.pressure import angle, followers

        with np.errstate(all="ignore"):
            for kernel, there in zip(motion.kernels, motion.placements, strict=True):
                for lead in followers(kernel.group):
                    angles[kernel.group.title, lead[0]] = angle(motion, kernel, there, lead)
    return tuple(replace(p, angles=angles[p.group, p.link]) for p in results.pressure)
