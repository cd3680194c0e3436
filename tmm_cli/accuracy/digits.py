"""How far each value may be from the truth by rounding, and how far the data carry it.

Every value is computed once more by the same stages in double-doubles, from the decimals of the file. The difference is
the error of float64 itself; values near dead positions were taken from double-doubles already, and are off by their
last rounding alone:

    bound = |y - y_exact| + u |y| + w kappa,    u = 2^-53, w = 2^-102

with kappa, the response of y per unit relative change of every length: the rounding of double-doubles themselves.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from tmm_cli.accuracy.data import all_changed, largest_beside, lengths, widened
from tmm_cli.analysis.extended import near_dead, refined
from tmm_cli.analysis.mechanism import Inputs, Mechanism
from tmm_cli.analysis.on_request import driver_motion
from tmm_cli.analysis.pipeline import Results, with_forces
from tmm_cli.analysis.selection import values as leading_values
from tmm_cli.double_double import array, exactly, rounded
from tmm_cli.groups.base import Kernel
from tmm_cli.groups.sequence import DriverMotion
from tmm_cli.kinematics.driver_range import DriverRange
from tmm_cli.kinematics.motion import move
from tmm_cli.kinematics.output import output_place
from tmm_cli.kinematics.strokes import Strokes
from tmm_cli.linkage import Linkage
from tmm_cli.structure.assur import Structure
from tmm_cli.tolerances import KNOWN_LAW, ROUNDOFF
from tmm_cli.vectors import Real

SHARE = 1e-3  # of each length: the change that sensitivities are told for
PAPER = 0.5  # mm of paper, likewise
STEP = 1e-7  # of a length, where the linkage is far from dead positions
CLOSE = 2.0**-7  # of the square of the margin, where it is near one
WIDE = 2.0**-102  # rounding of double-doubles
LEAST = 2.0**-90  # of a length: steps below that are rounding in double-doubles too
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
) -> Digits:
    """Digits of what `of` reads out of results with a motion, at all their positions.

    mu: scale of the drawing (m a mm). blur: how far each place of the driver may be from the one that was asked for
    (rad or m).
    """
    motion = results.motion
    assert motion is not None
    values = of(results)
    if not values:
        return Digits(mu=mu)
    judge = _Judge(results, of, values, np.broadcast_to(blur, np.shape(motion.q)))
    found = np.full((3, len(values), *np.shape(motion.q)), np.nan)
    chunk = max(CHUNK // (1 + len(lengths(results.linkage))), 1)
    near = near_dead(motion) if motion.where is None else motion.where
    for these, close in ((~near & motion.placed, False), (near, True)):
        places = np.flatnonzero(these)
        for start in range(0, len(places), chunk):
            chosen = places[start : start + chunk]
            found[:, :, chosen] = judge.at(chosen, close, mu)
    bound, share, paper = (dict(zip(values, part, strict=True)) for part in found)
    return Digits(bound, share, paper, mu)


def is_angle(key: Hashable) -> bool:
    """Whether a value is an angle, a full turn from itself: its key begins with True or with its name."""
    return isinstance(key, tuple) and key[0] in (True, "angle")


def bare(linkage: Linkage, q: Real, structure: Structure, kernels: tuple[Kernel, ...]) -> Results:
    """Motion and reactions of a linkage without a file, at places q of its driver (position 0 first)."""
    law = driver_motion(linkage, float(q[0]))
    motion = move(linkage, kernels, q, law)
    where = near_dead(motion)
    if bool(np.any(where)):
        motion = refined(motion, widened(linkage), exactly(q[where]), law, where)
    inputs = Inputs(linkage)
    mechanism = Mechanism(inputs, structure).known(
        kernels=kernels, driver_range=DriverRange(float(np.min(q)), float(np.max(q)), False), asked=q, dead=(),
        output=None, outputs=(), strokes=None, further=(), travels=(), pressure=(),
    )  # fmt: skip
    return with_forces(Results(inputs, structure, mechanism, tuple(range(len(q))), motion), cycle=False)


def bounds(results: Results) -> tuple[Cells, Digits]:
    """Values and their digits, of a linkage whose numbers are exact as they stand when it has no file (see `bare`).

    Keys are (quantity, name, component): x, v, a of points ("A") and centres of mass ("S1"), angle, omega, epsilon of
    links, force and couple of pairs, balancing of drivers.
    """
    return quantities(results), judged(results, quantities)


def quantities(results: Results) -> Cells:
    """The motion and reactions of results, by quantity, name and component."""
    assert results.motion is not None
    found: dict[Hashable, Real] = {}
    for quantity, name, value in leading_values(results.motion, results.reactions):
        for component, part in (("x", value.real), ("y", value.imag)) if quantity.vector else (("", value),):
            found[quantity.name, name, component] = part
    return found


@dataclass(frozen=True)
class _Judge:
    """Judges values read out of results, at some positions together; arrays are (values, positions)."""

    results: Results
    of: Callable[[Results], Cells]
    values: Cells
    blur: Real

    def at(self, chosen: Real, near: bool, mu: float) -> Real:
        """Bounds and both sensitivities at the chosen positions, all of which are near a dead one or none is."""
        results, motion = self.results, self.results.motion
        assert motion is not None
        q, first, blur = exactly(motion.q[chosen]), results.start, self.blur[chosen]
        if results.inputs.extended is not None and results.inputs.request.places:
            places = np.stack(results.inputs.extended().request.places)
            first, q, blur = places[0], places[list(results.numbers)][chosen], np.zeros(len(chosen))
        wide = at(results, exact(results), q, first, chosen)
        values, true = np.stack([value[..., chosen] for value in self.values.values()]), self.rows(self.of(wide))
        if near:
            share, paper, by_q = self.responses(wide.linkage, q, first, chosen, true, _step(wide))
        else:
            share, paper, by_q = self.responses(results.linkage, motion.q[chosen], results.start, chosen, values, STEP)
        bound = rounded(self.gap(values, true)) + ROUNDOFF * np.abs(values)
        if results.running is not None:
            bound = bound + KNOWN_LAW * np.nanmax(np.abs(values), axis=1, keepdims=True, initial=0.0)
        bound = bound + WIDE / SHARE * share + np.where(blur > 0, by_q * blur, 0.0)
        return np.stack([np.where(np.isfinite(values), bound, np.nan), share, paper * mu])

    def responses(self, linkage: Linkage, q: Real, first: float, chosen: Real, rows: Real, step: float) -> Any:
        """How much values change by 0.1 % of all lengths, by 0.5 m of each, and by the driver's place.

        All in one run: its positions are those at q once for each number that is changed there, the place first. rows:
        the values at q; step: the relative change of a length.
        """
        count, data = len(q), lengths(self.results.linkage)
        sizes = largest_beside(data)
        reach = 1.0 if self.results.linkage.driver.kind == "turn" else np.max(sizes, initial=0.0) or 1.0
        by = step * np.array([reach, *sizes])
        there, number = np.tile(np.arange(count), len(by)), np.repeat(np.arange(len(by)), count)
        changes = [(length, np.where(number == k, by[k], 0.0)) for k, length in enumerate(data, 1)]
        places = q[there] + np.where(number == 0, by[0], 0.0)
        other = at(self.results, all_changed(linkage, changes), places, first, chosen[there])
        gaps = rounded(self.gap(self.rows(self.of(other)), rows[:, there])).reshape(len(rows), len(by), count)
        slopes = gaps / by[:, None]
        values = np.array([abs(length.value) for length in data])
        return SHARE * np.tensordot(slopes[:, 1:], values, (1, 0)), PAPER * slopes[:, 1:].sum(1), slopes[:, 0]

    def rows(self, cells: Cells) -> Real:
        """The values one below the other; those that are not there are 0."""
        nothing = np.zeros(np.shape(next(iter(cells.values()))))
        found: Real = array([cells.get(key, nothing) for key in self.values])
        return found

    def gap(self, one: Real, other: Real) -> Real:
        """How far values are from others; of angles the way round."""
        away: Real = np.abs(one - other)
        turning = np.array([[is_angle(key)] for key in self.values])
        return np.where(turning, np.minimum(away, np.abs(2 * np.pi - away)), away)


def _step(results: Results) -> float:
    """The relative change of a length for derivatives near dead positions: small against what is left to them."""
    motion = results.motion
    assert motion is not None
    least = min(float(np.nanmin(np.where(motion.moving, at.margin, 1.0))) for at in motion.placements)
    return min(STEP, max(CLOSE * least**2, LEAST))


def exact(results: Results) -> Linkage:
    """The linkage with the decimals of its file; without a file, with its numbers as they stand."""
    extended = results.inputs.extended
    return widened(results.linkage) if extended is None else extended().linkage


def at(results: Results, linkage: Linkage, q: Real, first: float, chosen: Real | None = None) -> Results:
    """The same results at places q with the numbers of another linkage in the same assembly.

    first: the place of position 0. chosen: which of the positions these are; all of them when left out.
    """
    assert results.motion is not None
    kernels = tuple(kernel.rebind(linkage) for kernel in results.motion.kernels)
    # a law of motion that was found for the machine is taken as it is
    moved = move(linkage, kernels, q, results.running or driver_motion(linkage, first))
    numbers = results.numbers if chosen is None else tuple(results.numbers[k] for k in chosen)
    strokes = results.strokes
    if strokes is not None and any(load.table is not None and load.table.against == "stroke" for load in linkage.loads):
        strokes = _begun(strokes, linkage, kernels, q)
    found = replace(
        results, inputs=replace(results.inputs, linkage=linkage), structure=results.structure.rebind(linkage),
        mechanism=results.mechanism.changed(kernels=kernels, strokes=strokes), motion=moved,
        numbers=numbers,
    )  # fmt: skip
    if results.reactions is None:
        return found
    found = with_forces(found, cycle=False)
    assert found.lever is not None and results.lever is not None
    return replace(found, lever=found.lever.with_rows_of(results.lever))


def _begun(strokes: Strokes, linkage: Linkage, kernels: tuple[Kernel, ...], q: Real) -> Strokes:
    """Strokes whose output begins and ends where it really is there: tables against the stroke are counted from there,
    and in shares of its run."""
    still, law = np.zeros(np.shape(q)), DriverMotion(0.0, 1.0, 0.0, 1)
    lows: list[Any] = [
        output_place(move(linkage, kernels, still + s.start, law, 0), strokes.link) for s in strokes.strokes
    ]
    swings = linkage.output_swings(strokes.link)
    begun = []
    for k, (stroke, low) in enumerate(zip(strokes.strokes, lows, strict=True)):
        more = lows[(k + 1) % len(lows)] - low - stroke.run
        run = stroke.run + (more - 2 * np.pi * np.round(rounded(more) / (2 * np.pi)) if swings else more)
        begun.append(replace(stroke, low=low, run=run))
    others = tuple(_begun(other, linkage, kernels, q) for other in strokes.others)
    return replace(strokes, strokes=tuple(begun), others=others)
