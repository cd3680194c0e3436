"""Bound of the rounding error of each value, and its sensitivity to the lengths.

Every value is computed again by the same stages in double-doubles, from the decimal numbers of the file. The difference
is the error of float64. Values near dead positions were already computed in double-doubles, so their error is that of
the final rounding:

    bound = |y - y_exact| + u |y| + w kappa,    u = 2^-53, w = 2^-102

Here kappa is the change of y per unit relative change of every length, so the last term is the rounding error of the
double-doubles themselves.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from tmm_cli.mechanics.accuracy.length_sensitivity import (
    as_double_doubles,
    change_lengths,
    largest_on_link,
    list_lengths,
)
from tmm_cli.mechanics.analysis import (
    Inputs,
    Mechanism,
    Results,
    driver_motion,
    is_near_dead,
    leading_values as leading_values,
    mass_centres,
    refine_near_dead,
    with_forces,
)
from tmm_cli.mechanics.groups import DriverMotion, GroupSolver, link_extent
from tmm_cli.mechanics.kinematics import DriverRange, Strokes, compute_motion, output_coordinate
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import EPS, KNOWN_LAW, LIMIT_AGREES, ROUNDOFF, Real, array, to_double_double, to_float
from tmm_cli.mechanics.quantities import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    FORCE,
    INERTIA,
    LENGTH,
    MOMENT,
    NUMBER,
    SPEED,
    Dimension,
)
from tmm_cli.mechanics.structure import Structure

LENGTH_CHANGE = 1e-3  # relative change of each length in the reported sensitivities
PAPER_CHANGE = 0.5  # mm on paper: change of each length in the reported sensitivities
STEP = 1e-7  # relative step of a length far from dead positions
STEP_PER_MARGIN = 2.0**-7  # relative step of a length per squared margin, near a dead position
DOUBLE_DOUBLE_ROUNDING = 2.0**-102  # rounding of double-doubles
LEAST_STEP = 2.0**-90  # of a length: smaller steps are rounding even in double-doubles
POSITIONS_PER_CHUNK = 1500  # positions computed together

Cells = Mapping[Hashable, Real]  # one value for each position


@dataclass
class Digits:
    """Accuracy of values. Keys, shapes and units are those of the values.

    To first order, the changes below are the worst case: the absolute changes that each length causes alone are added
    up.

    Attributes:
        bound: bound of the rounding error.
        lengths: change if all lengths change by 0.1 %.
        paper: change if all lengths change by 0.5 mm on the drawing.
        mu: scale of the drawing (m per mm); nan if nothing is drawn.
    """

    bound: dict[Hashable, Real] = field(default_factory=dict)
    lengths: dict[Hashable, Real] = field(default_factory=dict)
    paper: dict[Hashable, Real] = field(default_factory=dict)
    mu: float = float("nan")


def judge_values(
    results: Results,
    read: Callable[[Results], Cells],
    *,
    mu: float = float("nan"),
    blur: Real | float = 0.0,
) -> Digits:
    """Compute the accuracy of the values that `read` takes from results, at all their positions.

    Args:
        results: results with a motion.
        read: function that returns values from results, each (positions,), by key.
        mu: scale of the drawing, m per mm.
        blur: uncertainty of each driver coordinate, rad or m.
    """
    motion = results.motion
    assert motion is not None
    values = read(results)
    if not values:
        return Digits(mu=mu)
    judge = _ValueJudge(results, read, values, np.broadcast_to(blur, np.shape(motion.q)))
    accuracy = np.full((3, len(values), *np.shape(motion.q)), np.nan)
    chunk = max(POSITIONS_PER_CHUNK // (1 + len(list_lengths(results.linkage))), 1)
    near = is_near_dead(motion) if motion.where is None else motion.where
    for positions, is_near in ((~near & motion.placed, False), (near, True)):
        indices = np.flatnonzero(positions)
        for start in range(0, len(indices), chunk):
            chosen = indices[start : start + chunk]
            accuracy[:, :, chosen] = judge.at(chosen, is_near, mu)
    bound, share, paper = (dict(zip(values, rows, strict=True)) for rows in accuracy)
    return Digits(bound, share, paper, mu)


def is_angle(key: Hashable) -> bool:
    """Return True if a value is an angle, which is compared modulo 360 degrees.

    key: key of the value. For an angle its first element is True or "angle".
    """
    return isinstance(key, tuple) and key[0] in (True, "angle")


def solve_bare_linkage(linkage: Linkage, q: Real, structure: Structure, kernels: tuple[GroupSolver, ...]) -> Results:
    """Solve motion and reactions of a linkage that was not read from a file.

    Args:
        linkage: the linkage; its numbers are taken as exact.
        q: driver coordinates (rad or m), beginning with position 0.
        structure: structure of the linkage.
        kernels: solvers of its groups.
    """
    law = driver_motion(linkage, float(q[0]))
    motion = compute_motion(linkage, kernels, q, law)
    where = is_near_dead(motion)
    if bool(np.any(where)):
        motion = refine_near_dead(motion, as_double_doubles(linkage), to_double_double(q[where]), law, where)
    inputs = Inputs(linkage)
    mechanism = Mechanism(inputs, structure).with_known(
        kernels=kernels,
        driver_range=DriverRange(float(np.min(q)), float(np.max(q)), False),
        asked=q,
        dead=(),
        output=None,
        outputs=(),
        strokes=None,
        further=(),
        travels=(),
        pressure=(),
    )
    return with_forces(Results(inputs, structure, mechanism, tuple(range(len(q))), motion), cycle=False)


def bound_values(results: Results) -> tuple[Cells, Digits]:
    """Return the values of motion and reactions, and their accuracy.

    Without a file (`solve_bare_linkage`) the numbers of the linkage are taken as exact. Keys are (quantity,
    name, component): x, v, a of points ("A") and centres of mass ("S1"), angle, omega, epsilon of links, force
    and couple of pairs, balancing moment or force of drivers.
    """
    return list_values(results), judge_values(results, list_values)


def list_values(results: Results) -> Cells:
    """Return the values of motion and reactions, each (positions,), by quantity, name and component."""
    assert results.motion is not None
    cells: dict[Hashable, Real] = {}
    for quantity, name, value in leading_values(results.motion, results.reactions):
        for component, component_values in (
            (("x", value.real), ("y", value.imag)) if quantity.vector else (("", value),)
        ):
            cells[quantity.name, name, component] = component_values
    return cells


@dataclass(frozen=True)
class _ValueJudge:
    """Computes the accuracy of values at several positions at once; arrays have the shape (values, positions)."""

    results: Results
    of: Callable[[Results], Cells]
    values: Cells
    blur: Real

    def at(self, chosen: Real, near: bool, mu: float) -> Real:
        """Return the rounding bounds and the two sensitivities of all values at the chosen positions.

        The shape is (3, values, positions).

        near: True if all these positions are near dead positions, False if none is.
        """
        results, motion = self.results, self.results.motion
        assert motion is not None
        q, first, blur = to_double_double(motion.q[chosen]), results.start, self.blur[chosen]
        if results.inputs.extended is not None and results.inputs.request.places:
            coordinates = np.stack(results.inputs.extended().request.places)
            first, q, blur = coordinates[0], coordinates[list(results.numbers)][chosen], np.zeros(len(chosen))
        wide = results_with_linkage(results, exact_linkage(results), q, first, chosen)
        values, true = np.stack([value[..., chosen] for value in self.values.values()]), self.rows(self.of(wide))
        if near:
            share, paper, by_q = self.responses(wide.linkage, q, first, chosen, true, _length_step(wide))
        else:
            share, paper, by_q = self.responses(results.linkage, motion.q[chosen], results.start, chosen, values, STEP)
        bound = to_float(self.gap(values, true)) + ROUNDOFF * np.abs(values)
        if results.running is not None:
            bound = bound + KNOWN_LAW * np.nanmax(np.abs(values), axis=1, keepdims=True, initial=0.0)
        bound = bound + DOUBLE_DOUBLE_ROUNDING / LENGTH_CHANGE * share + np.where(blur > 0, by_q * blur, 0.0)
        return np.stack([np.where(np.isfinite(values), bound, np.nan), share, paper * mu])

    def responses(self, linkage: Linkage, q: Real, first: float, chosen: Real, rows: Real, step: float) -> Any:
        """Compute how the values change with the lengths and the driver coordinate.

        All changes are computed in one run, for which the positions are repeated once for each changed number.

        Args:
            linkage: the linkage.
            q: driver coordinates of the chosen positions.
            first: driver coordinate of position 0.
            chosen: indices of the positions.
            rows: values at these positions.
            step: relative change of a length.

        Returns:
            Change if all lengths change by 0.1 %, change if each of them changes by 0.5 m, derivative with respect
            to the driver coordinate.
        """
        count, data = len(q), list_lengths(self.results.linkage)
        sizes = largest_on_link(data)
        reach = 1.0 if self.results.linkage.driver.kind == "turn" else np.max(sizes, initial=0.0) or 1.0
        by = step * np.array([reach, *sizes])
        index, number = np.tile(np.arange(count), len(by)), np.repeat(np.arange(len(by)), count)
        changes = [(length, np.where(number == k, by[k], 0.0)) for k, length in enumerate(data, 1)]
        coordinates = q[index] + np.where(number == 0, by[0], 0.0)
        other = results_with_linkage(self.results, change_lengths(linkage, changes), coordinates, first, chosen[index])
        gaps = to_float(self.gap(self.rows(self.of(other)), rows[:, index])).reshape(len(rows), len(by), count)
        slopes = gaps / by[:, None]
        values = np.array([abs(length.value) for length in data])
        return (
            LENGTH_CHANGE * np.tensordot(slopes[:, 1:], values, (1, 0)),
            PAPER_CHANGE * slopes[:, 1:].sum(1),
            slopes[:, 0],
        )

    def rows(self, cells: Cells) -> Real:
        """Stack the values as rows of an array, in the order of `values`; missing ones are 0."""
        nothing = np.zeros(np.shape(next(iter(cells.values()))))
        stacked: Real = array([cells.get(key, nothing) for key in self.values])
        return stacked

    def gap(self, first: Real, second: Real) -> Real:
        """Return the absolute differences of two arrays of values; angles are compared modulo 360 degrees."""
        distance: Real = np.abs(first - second)
        turning = np.array([[is_angle(key)] for key in self.values])
        return np.where(turning, np.minimum(distance, np.abs(2 * np.pi - distance)), distance)


def _length_step(results: Results) -> float:
    """Choose the relative step of lengths with which derivatives near dead positions are computed.

    It is small compared with the margin to the dead positions.
    """
    motion = results.motion
    assert motion is not None
    least = min(float(np.nanmin(np.where(motion.moving, at.margin, 1.0))) for at in motion.placements)
    return min(STEP, max(STEP_PER_MARGIN * least**2, LEAST_STEP))


def exact_linkage(results: Results) -> Linkage:
    """Return the linkage in double-doubles, from the decimal numbers of its file or, without a file, from its own
    numbers.
    """
    extended = results.inputs.extended
    return as_double_doubles(results.linkage) if extended is None else extended().linkage


def results_with_linkage(
    results: Results, linkage: Linkage, q: Real, first: float, chosen: Real | None = None
) -> Results:
    """Recompute results at driver coordinates q with changed numbers of the linkage, in the same assembly.

    Args:
        results: results with a motion, possibly with forces.
        linkage: the linkage with changed numbers, possibly double-doubles.
        q: driver coordinates, rad or m.
        first: driver coordinate of position 0.
        chosen: indices of the positions; None for all.
    """
    assert results.motion is not None
    kernels = tuple(kernel.rebind(linkage) for kernel in results.motion.kernels)
    # the computed law of motion of a machine is not recomputed
    moved = compute_motion(linkage, kernels, q, results.running or driver_motion(linkage, first))
    numbers = results.numbers if chosen is None else tuple(results.numbers[k] for k in chosen)
    strokes = results.strokes
    if strokes is not None and any(load.table is not None and load.table.against == "stroke" for load in linkage.loads):
        strokes = _strokes_with_linkage(strokes, linkage, kernels, q)
    recomputed = replace(
        results,
        inputs=replace(results.inputs, linkage=linkage),
        structure=results.structure.rebind(linkage),
        mechanism=results.mechanism.with_changed(kernels=kernels, strokes=strokes),
        motion=moved,
        numbers=numbers,
    )
    if results.reactions is None:
        return recomputed
    recomputed = with_forces(recomputed, cycle=False)
    assert recomputed.lever is not None and results.lever is not None
    return replace(recomputed, lever=recomputed.lever.with_rows_of(results.lever, moved))


def _strokes_with_linkage(strokes: Strokes, linkage: Linkage, kernels: tuple[GroupSolver, ...], q: Real) -> Strokes:
    """Return strokes whose output coordinates at the ends are recomputed for a changed linkage.

    Load tables against the stroke begin at these coordinates.
    """
    still, law = np.zeros(np.shape(q)), DriverMotion(0.0, 1.0, 0.0, 1)
    lows: list[Any] = [
        output_coordinate(compute_motion(linkage, kernels, still + s.start, law, 0), strokes.link)
        for s in strokes.strokes
    ]
    swings = linkage.output_swings(strokes.link)
    moved_strokes = []
    for k, (stroke, low) in enumerate(zip(strokes.strokes, lows, strict=True)):
        change = lows[(k + 1) % len(lows)] - low - stroke.run
        run = stroke.run + (change - 2 * np.pi * np.round(to_float(change) / (2 * np.pi)) if swings else change)
        moved_strokes.append(replace(stroke, low=low, run=run))
    others = tuple(_strokes_with_linkage(other, linkage, kernels, q) for other in strokes.others)
    return replace(strokes, strokes=tuple(moved_strokes), others=others)


# Bounds of rounding errors from the margins of the groups, without extended precision. Near dead positions, where these
# bounds promise fewer digits than are printed, `judge_values` is used.


LOSS_FACTOR = (
    128.0  # measured: in 50 sample problems and 500 random linkages the largest error is a third of this bound
)
LOSS_MARGIN = (
    10.0  # times the margin below which a group counts as near a dead position: with a larger margin no digits are lost
)
DRIVER_ERROR_FACTOR = 4.0  # factor for an uncertain driver coordinate
SIX_FIGURES = 0.5e-6  # of the largest value: with a larger bound six figures are not certain


def relative_bound(results: Results, blur: float = 0.0) -> Real:
    """Return a bound of the error at each position, relative to the largest value of each kind, (positions,).

    A group with the margin m to its dead positions has positions accurate to u/m, and velocities, accelerations and
    forces accurate to u/m^2 (u: unit roundoff). Groups that depend on it take over its errors, so bound = LOSS_FACTOR u
    (1 + |q|) product(1/m)^2. This needs no extended precision and is pessimistic: it promises 10 to 13 digits where 15
    are correct.

    blur: uncertainty of driver coordinates, rad or m.
    """
    motion = results.motion
    assert motion is not None
    unit = np.full(np.shape(motion.q), ROUNDOFF)
    if motion.where is not None:  # computed in extended precision, and rounded
        unit[motion.where] = EPS
    uncertainty = blur if results.linkage.driver.kind == "turn" else blur / _mechanism_size(results)
    growth = error_growth(results)
    travel = np.max([np.abs(drive.value) for drive in motion.drives.values()], axis=0)
    if motion.limits is not None:
        growth = np.where(motion.limits, LIMIT_AGREES / (LOSS_FACTOR * ROUNDOFF), growth)
    bound: Real = (
        LOSS_FACTOR * (ROUNDOFF + unit * (1 + travel) * slenderness(results) * growth)
        + DRIVER_ERROR_FACTOR * uncertainty * growth
    )
    return bound if results.running is None else np.maximum(bound, KNOWN_LAW)


def error_growth(results: Results) -> Real:
    """Return the factor by which the groups together magnify errors, at each position, (positions,).

    Every group that is near a dead position contributes a factor.
    """
    motion = results.motion
    assert motion is not None
    growth = np.ones(np.shape(motion.q))
    for kernel, at in zip(motion.kernels, motion.placements, strict=True):
        with np.errstate(all="ignore"):
            growth = growth * np.maximum(LOSS_MARGIN * kernel.near / at.margin, 1.0) ** 2
    return growth


def slenderness(results: Results) -> float:
    """Return the size of the mechanism divided by the extent of its shortest link.

    Errors of positions rotate that link by angles that are greater by this factor.
    """
    short = [link_extent(results.linkage, link) for link in results.linkage.moving]
    return _mechanism_size(results) / min((extent for extent in short if extent > 0), default=1.0)


def largest_values(results: Results) -> Mapping[Dimension, float]:
    """Return the largest value of each dimension in the mechanism, SI.

    For dimensionless values it is the largest one among the transfer functions.
    """
    motion = results.motion
    assert motion is not None
    extent = _mechanism_size(results)
    w = _largest_magnitude(rate.w for rate in motion.first.values())
    v = _largest_magnitude(rate.v for rate in motion.first.values()) + w * extent
    e = _largest_magnitude(accel.e for accel in motion.second.values()) + w * w
    a = _largest_magnitude(accel.a for accel in motion.second.values()) + e * extent
    rate, gain = _largest_magnitude([motion.rate]), _largest_magnitude([motion.acceleration])
    largest = {
        LENGTH: max(extent, v),
        ANGLE: np.pi,
        SPEED: v * rate,
        ANGULAR_SPEED: w * rate,
        ACCELERATION: a * rate**2 + v * gain,
        ANGULAR_ACCELERATION: e * rate**2 + w * gain,
        NUMBER: max(v, w, a, e),
    }
    if results.reactions is not None:
        applied = results.reactions.applied
        links = results.linkage.links.values()
        mass, inertia = (
            _largest_magnitude(link.mass for link in links),
            _largest_magnitude(link.inertia for link in links),
        )
        # forces on a link at rest have errors too
        forces = max(
            largest[ACCELERATION] * mass, _largest_magnitude(reaction.force for reaction in results.reactions.all)
        )
        couples = max(largest[ANGULAR_ACCELERATION] * inertia, _largest_magnitude(load.moment for load in applied))
        largest[INERTIA] = mass * v**2 + inertia * w**2  # reduced to the driver
        largest[FORCE] = max(forces, _largest_magnitude(load.force for load in applied)) + couples / extent
        largest[MOMENT] = largest[FORCE] * largest[LENGTH]
    return largest


def _mechanism_size(results: Results) -> float:
    """Return an upper bound of the distances between points of the mechanism, and of their distances from the
    origin, m.
    """
    assert results.motion is not None
    linkage = results.linkage
    spreads = (link_extent(linkage, link) for link in linkage.links)
    acted_on = _largest_magnitude(
        [*(at for __, at in mass_centres(linkage).values()), *(load.at for load in linkage.loads)]
    )
    longest: float = max(*spreads, acted_on) + _largest_magnitude(pose.x for pose in results.motion.poses.values())
    return longest


def _largest_magnitude(values: object) -> float:
    """Return the largest absolute value in several arrays; values that are not finite are ignored."""
    magnitudes = [np.max(np.abs(v), where=np.isfinite(v), initial=0.0) for v in map(np.asarray, values)]  # type: ignore
    return float(max(magnitudes, default=0.0))
