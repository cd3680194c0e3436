"""Local refinement of a candidate by sequential quadratic programming (SLSQP of D. Kraft, in scipy).

The objective is the largest of several peaks. It is replaced by an upper bound t of all peaks, which is minimised: this
makes the minimax problem differentiable. Derivatives are central differences. Coordinates are measured from the
starting point and scaled such that a unit step would reduce the steepest peak to zero if it were linear. The method
assumes an initial curvature of 1; without this scaling its first steps would leave the valley.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from tmm_cli.batch import DriverSamples
from tmm_cli.mechanics.numerics import WINDOW, Real
from tmm_cli.synthesis.optimal.candidates import Candidates, quantity_reader
from tmm_cli.synthesis.optimal.evolution import EvolutionResult
from tmm_cli.synthesis.optimal.many_starts import IndependentEnds
from tmm_cli.synthesis.optimal.quantities.base import PeakQuantity

STEP = 2e-6  # difference step, as a fraction of the ranges
OBJECTIVE_TOLERANCE = 1e-11  # relative gain below which the refinement stops
MOST = 60  # steps
IDLE = 3  # steps without gain, as at a kink
TOO_FAR = 1e6  # value for linkages that cannot be assembled; about 1 at the start
WEIGHT = 10.0  # weight of violations relative to the objective


@dataclass(frozen=True)
class LocalValues:
    """Values of an optimisation problem for several variants, each of shape (variants, n).

    Attributes:
        pieces: peaks of the objective; the largest is minimised.
        least: inequalities, satisfied if >= 0.
        equal: equalities, satisfied if 0.
    """

    pieces: Real
    least: Real
    equal: Real


class _End(Exception):  # noqa: N818  where the steps end
    """Raised to end the refinement: the starting point cannot be assembled, or further steps bring no improvement."""


class _Differences:
    """Values and derivatives of an optimisation problem at a point.

    Derivatives are central differences. The results for the last point are kept, because scipy requests values and
    derivatives in separate calls.
    """

    def __init__(self, evaluate: Callable[[Real], LocalValues], size: int) -> None:
        self.evaluate, self.size = evaluate, size
        self.at: Real = np.full(size, np.nan)
        self.found: tuple[tuple[Real, Real], ...] = ()

    def __call__(self, x: Real) -> tuple[tuple[Real, Real], ...]:
        """Return values and derivatives of peaks, inequalities and equalities at a point.

        If the linkage cannot be assembled there, the peaks are huge.

        Raises:
            _End: the starting point cannot be assembled.
        """
        n = self.size
        if not np.array_equal(x, self.at):
            ends = np.clip(x + np.vstack([np.zeros(n), STEP * np.eye(n), -STEP * np.eye(n)]), 0, 1)
            local = self.evaluate(ends)
            run = np.diag(ends[1 : n + 1] - ends[n + 1 :])[:, None]
            parts = (local.pieces, local.least, local.equal)
            parts_found = tuple((y[0], ((y[1 : n + 1] - y[n + 1 :]) / run).T) for y in parts)
            if not all(np.all(np.isfinite(values)) for both in parts_found for values in both):
                if not self.found:
                    raise _End
                (pieces, slopes), *others = self.found
                return (np.full_like(pieces, TOO_FAR), slopes), *others
            self.at, self.found = x.copy(), parts_found
        return self.found


def minimize_locally(evaluate: Callable[[Real], LocalValues], x: Real) -> Real:
    """Find the nearest local minimum of the largest peak of an objective, under constraints.

    Args:
        evaluate: function that returns the values of the problem for variants in 0..1, shape (variants, n).
        x: starting point in 0..1, shape (n,).

    Returns:
        The best point reached, shape (n,); x itself if the linkage cannot be assembled there.
    """
    from scipy.optimize import minimize

    n, differences = len(x), _Differences(evaluate, len(x))
    steps: list[tuple[float, Real]] = []  # merit and point of each step
    idle = 0
    scale = 1.0

    def place(z: Real) -> Real:
        return np.clip(x + scale * z[:n], 0, 1)

    def near(z: Real) -> tuple[tuple[Real, Real], ...]:
        return tuple((values, scale * slopes) for values, slopes in differences(place(z)))

    def take(z: Real) -> None:
        """Record the point of a step. Raises _End after several steps without improvement."""
        nonlocal idle
        f, c, e = (values for values, slopes in near(z))
        bad = float(np.max(f) + WEIGHT * (np.sum(np.maximum(-c, 0)) + np.sum(np.abs(e))))
        idle = idle + 1 if steps and not bad < min(step[0] for step in steps) - OBJECTIVE_TOLERANCE else 0
        steps.append((bad, place(z)))
        if idle > IDLE:
            raise _End

    def above(z: Real) -> Real:
        """Return the inequalities, all of which must be >= 0.

        They are t - peak for every peak of the objective, where t is the upper bound of the peaks, and then the
        inequality constraints.
        """
        pieces, least, __ = near(z)
        return np.append(z[n] - pieces[0], least[0])

    def above_slope(z: Real) -> Real:
        f, c = (slopes for values, slopes in near(z)[:2])
        return np.vstack([np.hstack([-f, np.ones((len(f), 1))]), np.hstack([c, np.zeros((len(c), 1))])])

    def even_slope(z: Real) -> Real:
        e = near(z)[2][1]
        return np.hstack([e, np.zeros((len(e), 1))])

    try:
        start = np.zeros(n)
        take(start)
        f, e = near(start)[0][0], near(start)[2][0]
        size, steepest = float(np.max(np.abs(f))), float(np.max(np.abs(near(start)[0][1])))
        scale = size / steepest if 0 < size < steepest else 1.0
        constraints = [{"type": "ineq", "fun": above, "jac": above_slope}]
        if len(e):
            constraints.append({"type": "eq", "fun": lambda z: near(z)[2][0], "jac": even_slope})
        bounds = [(-share / scale, (1 - share) / scale) for share in x]
        minimum = minimize(
            lambda z: z[n],
            np.append(start, np.max(f)),
            jac=lambda z: np.eye(n + 1)[n],
            method="SLSQP",
            bounds=[*bounds, (None, None)],
            constraints=constraints,
            callback=take,
            options={"ftol": OBJECTIVE_TOLERANCE, "maxiter": MOST},
        )
        take(minimum.x)
    except _End:
        pass
    return min(steps, key=lambda step: step[0])[1] if steps else x


# One candidate of an optimal synthesis, closely: quantities from windows about their peaks, and their refinement.


NARROWER = (1.0, 0.3, 0.0, 0.0, 0.0)  # relative widths of the windows: peaks move less and less
FEWER = (1.0, 0.0)  # if candidates are evaluated one by one
ABOUT = 2.0  # half width of a window in scan steps, at least
SETTLED = 1e-9  # fraction of the ranges: a smaller change ends the refinement


@dataclass(frozen=True)
class BestCandidate:
    """The best candidate of a search.

    Attributes:
        x: fractions of the ranges of its parameters.
        numbers: parameter values (SI).
        values: values of the objective and of the constrained quantities (SI).
        missed: constraint violation.
        evolved: result of the evolution.
        ends: agreement of independent descents; None if there were none.
    """

    x: Real
    numbers: Real
    values: list[float]
    missed: float
    evolved: EvolutionResult
    ends: IndependentEnds | None = None

    @property
    def agree(self) -> bool:
        """True if enough independent descents reached this candidate, or if there were none."""
        return self.ends is None or self.ends.agree


def evaluate_exactly(candidates: Candidates, x: Real) -> list[float]:
    """Return the objective and the constrained quantities of a candidate.

    They are as accurate as the values that are measured later on the finished mechanism.

    Args:
        candidates: evaluator of the candidates.
        x: fractions of the ranges of the parameters, shape (n,).

    Returns:
        Values (SI); nan where a quantity is undefined.
    """
    with np.errstate(all="ignore"):
        peaks, coarse = _make_peak_function(candidates, x)(x), candidates.values(x[None])
        values = [float(_reduce_peaks(candidates, n, pieces)[0]) for n, pieces in enumerate(peaks)]
        scan, two = candidates.sample_range(candidates.scan), candidates.numbers(x[None])
        for n, (quantity, over) in enumerate(zip(candidates.quantities, candidates.overs, strict=True)):

            def curve(name: str, shares: Real, n: int = n) -> Real:
                return candidates.program(two, DriverSamples(shares, np.zeros(0)))[f"{n}.{name}"][0, : len(shares)]

            if quantity.forces and np.isnan(coarse[n][0]):  # the driver stops or locks somewhere
                values[n] = np.nan
            else:
                values[n] = quantity.refine_value(
                    values[n], curve, scan[candidates.slice_samples(n, candidates.scan)], over
                )
        if candidates.single:
            scanned = candidates.run(x[None], DriverSamples(scan, candidates.append_sketch(np.zeros(0))))
            values[1] = -1.0 if candidates.passes_dead_position(scanned, candidates.scan)[0] else values[1]
    return values


def refine_candidate(candidates: Candidates, x: Real) -> Real:
    """Return the local optimum near a candidate; parameters with discrete values stay unchanged."""
    whole, free = x, candidates.task.free

    def all_of(some: Real) -> Real:
        """Return candidates with all their parameters, from values of the continuous parameters."""
        points = np.repeat(whole[None], len(some), axis=0)
        points[:, free] = some
        return points

    for narrow in NARROWER if candidates.traced else FEWER:
        before, pieces = x, _make_peak_function(candidates, x, narrow)
        top = float(np.max(np.abs(_find_objective_pieces(candidates, pieces(x)[0])))) or 1.0
        with np.errstate(all="ignore"):
            best = minimize_locally(lambda some: _make_local_values(candidates, pieces(all_of(some)), top), x[free])  # noqa: B023
        x = all_of(best[None])[0]
        if not narrow and float(np.max(np.abs(x - before))) < SETTLED:
            break
    return x


def _make_peak_function(candidates: Candidates, x: Real, narrow: float = 0.0) -> Callable[[Real], list[Real]]:
    """Return a function that computes the peaks of every quantity accurately for candidates near x.

    It evaluates them only in windows, i.e. at a few closely spaced positions around each peak of x.

    Args:
        candidates: evaluator of the candidates.
        x: candidate near which the function is used.
        narrow: width of the windows as a fraction of the position spacing in the search. They are wider if the
            positions at which the peaks of x are located are too far apart for this width.
    """
    scan = candidates.sample_range(candidates.scan)
    outputs = candidates.run(x[None], DriverSamples(scan, np.zeros(0)))
    half = max(narrow / candidates.count, ABOUT / candidates.scan)
    step = 2 * half / (WINDOW - 1)
    blocks, parts = [], []
    at = 0
    for n, (quantity, over) in enumerate(zip(candidates.quantities, candidates.overs, strict=True)):
        windows = []
        read = quantity_reader(outputs, n, candidates.slice_samples(n, candidates.scan))
        for subject, k in quantity.windows(read, over):
            first = scan[k] - half
            if not over.closed:
                first = min(max(first, 0.0), 1 - 2 * half)
            blocks.append(first + step * np.arange(WINDOW))
            windows.append((subject, float(first), slice(at, at + WINDOW)))
            at += WINDOW
        parts.append(windows)
    positions = replace(candidates.places, shares=np.concatenate([*blocks, np.zeros(1)]))
    exact = [windows or slice(at, at + 1) for windows in candidates.slice_own_coordinates(at + 1)]

    def pieces(some: Real) -> list[Real]:
        out = candidates.program(candidates.numbers(np.atleast_2d(some)), positions)
        return [
            quantity.fine(
                [(subject, first, quantity_reader(out, n, where)) for subject, first, where in parts[n]],
                quantity_reader(out, n, exact[n]),
                candidates.overs[n],
                step,
            )
            for n, quantity in enumerate(candidates.quantities)
        ]

    return pieces


def _reduce_peaks(candidates: Candidates, n: int, pieces: Real) -> Real:
    """Return the value of quantity `n` from its peaks, shape (variants,)."""
    extreme: Real = (np.min if candidates.quantities[n].lowest else np.max)(pieces, axis=1)
    return extreme


def _find_objective_pieces(candidates: Candidates, pieces: Real) -> Real:
    """Return the values whose largest one is minimised, in a form that is differentiable where the objective is
    zero.
    """
    target, objective = candidates.task.target, candidates.task.objective
    if target is not None:
        off = (_reduce_peaks(candidates, 0, pieces)[:, None] - target) / (abs(target) or 1.0)
        return np.hstack([off, -off])
    return -pieces if objective.lowest else objective.smooth(pieces)


def _make_local_values(candidates: Candidates, peaks: list[Real], top: float) -> LocalValues:
    """Return the objective and the constraints of candidates in the form of `minimize_locally`.

    peaks: peaks of each quantity, shape (variants, peaks). top: scale of the objective.
    """
    least, equal = [], []
    for n, (constraint, pieces) in enumerate(zip(candidates.constraints, peaks[1:], strict=True), 1):
        low = high = _reduce_peaks(candidates, n, pieces)[:, None]
        if (
            isinstance(constraint.quantity, PeakQuantity) and not constraint.equal
        ):  # then every peak must satisfy the bound
            low, high = (pieces, high) if constraint.quantity.lowest else (low, pieces)
        above, even = constraint.rows(low, high)
        least += above
        equal += even
    none = np.zeros((len(peaks[0]), 0))
    return LocalValues(
        _find_objective_pieces(candidates, peaks[0]) / top, np.hstack([none, *least]), np.hstack([none, *equal])
    )
