"""Least squares by the Levenberg-Marquardt method from many starting points at once, within bounds and constraints.

Each step minimises the squares of the linearised residuals (K. Levenberg 1944, D. Marquardt 1963). A step with a
second-order correction is tried as well (M. Transtrum, J. Sethna 2012), because minima lie at the ends of long curved
valleys. Constraints and bounds that a step would violate become weighted residuals. Derivatives are difference
quotients: a starting point and its neighbours are evaluated together as variants.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tmm_cli.mechanics.numerics import Real, solve
from tmm_cli.synthesis.optimal.candidates import LOST, Candidates, quantity_reader
from tmm_cli.synthesis.optimal.quantities.deviation import Deviation, nearest_corners

STEP = 1e-6  # difference step, as a fraction of the ranges
WEIGHT = 1e3  # weight of violated constraints relative to residuals
PASSES = 6  # passes to find the violated constraints
DAMPINGS = (0.03, 1.0, 30.0)  # times the last damping, tried together
FIRST, LEAST, LARGEST = 1e-3, 1e-12, 1e8  # damping
AHEAD = 0.1  # of a step: point at which the second derivative is estimated
GAIN = 1e-14  # relative decrease of the sum of squares that a step must bring


@dataclass(frozen=True)
class ResidualRows:
    """Residuals and inequalities of variants, in the form that the Levenberg-Marquardt method uses.

    Attributes:
        off: residuals whose squares are minimised, shape (variants, residuals).
        least: quantities that must not be negative, shape (variants, inequalities).
    """

    off: Real
    least: Real

    def cost(self) -> Real:
        """Return the sum of the squares of the residuals and of the weighted violations of the inequalities, shape
        (variants,).

        It is infinite if the linkage of a variant cannot be assembled.
        """
        total = np.sum(self.off**2, axis=1) + WEIGHT**2 * np.sum(np.minimum(self.least, 0) ** 2, axis=1)
        return np.where(np.isfinite(total), total, np.inf)


Evaluate = Callable[[Real, int], ResidualRows]  # variants (v, n) in 0..1, and variants per set, led by the first


def minimize_squares(evaluate: Evaluate, x: Real, steps: int) -> tuple[Real, Real]:
    """Minimise sums of squares by Levenberg-Marquardt steps from many starting points.

    Args:
        evaluate: function that returns the residuals of variants; its second argument is the number of consecutive
            variants that form a set (a point and its neighbours).
        x: starting points in 0..1, shape (starts, n).
        steps: largest number of steps.

    Returns:
        End points, shape (starts, n), and their sums of squares, shape (starts,); inf if a starting point cannot be
        assembled.
    """
    n = x.shape[1]
    x, damping = x.copy(), np.full(len(x), FIRST)
    cost = evaluate(x, 1).cost()
    going = np.flatnonzero(np.isfinite(cost))
    for _ in range(steps):
        if not len(going):
            break
        at = x[going]
        rows, slopes = _estimate_derivatives(evaluate, at)
        tried = np.clip(damping[going, None] * np.array(DAMPINGS), LEAST, LARGEST)
        ends = _take_steps(evaluate, rows, slopes, at, tried)
        costs = evaluate(ends.reshape(-1, n), 1).cost().reshape(len(going), -1)
        each, best = np.arange(len(going)), np.argmin(costs, axis=1)
        better = costs[each, best] < cost[going] * (1 - GAIN)
        x[going[better]], cost[going[better]] = ends[each, best][better], costs[each, best][better]
        damping[going] = np.where(better, tried[each, best % len(DAMPINGS)], tried[:, -1])
        going = going[better | (damping[going] < LARGEST)]
    return x, cost


def _take_steps(evaluate: Evaluate, rows: ResidualRows, slopes: ResidualRows, x: Real, dampings: Real) -> Real:
    """Return the points that are reached by steps from each point, shape (starts, 2 dampings, n).

    For each damping there are two steps, without and with a second-order correction.

    Args:
        evaluate: function that returns the residuals of variants.
        rows, slopes: residuals at the points, and their derivatives.
        x: points, shape (starts, n).
        dampings: dampings to try, shape (starts, dampings).
    """
    rows, slopes = (ResidualRows(residuals.off[:, None], residuals.least[:, None]) for residuals in (rows, slopes))
    x = x[:, None]
    step = damped_step(rows, slopes, x, dampings)
    ahead = evaluate((x + AHEAD * step).reshape(-1, x.shape[-1]), 1).off.reshape(*dampings.shape, -1)
    bend = ((ahead - rows.off) / AHEAD - (slopes.off @ step[..., None])[..., 0]) / AHEAD
    is_finite = np.all(np.isfinite(bend), axis=-1, keepdims=True)
    bent = damped_step(ResidualRows(rows.off + np.where(is_finite, bend, 0.0), rows.least), slopes, x, dampings)
    ends: Real = np.clip(x + np.concatenate([step, bent], axis=1), 0, 1)
    return ends


def _estimate_derivatives(evaluate: Evaluate, x: Real) -> tuple[ResidualRows, ResidualRows]:
    """Return the residuals at points (starts, n), and their derivatives, shape (starts, residuals, n).

    Derivatives are difference quotients. One that cannot be computed is set to zero.
    """
    s, n = x.shape
    run = np.where(x > 0.5, -STEP, STEP)
    ends = np.repeat(x[:, None], n + 1, axis=1)
    ends[:, 1:] += run[:, None] * np.eye(n)
    residuals = evaluate(ends.reshape(-1, n), n + 1)
    values, slopes = [], []
    for y in (residuals.off, residuals.least):
        y = y.reshape(s, n + 1, -1)
        slope = (y[:, 1:] - y[:, :1]) / run[:, :, None]
        values.append(y[:, 0])
        slopes.append(np.where(np.isfinite(slope), slope, 0.0).transpose(0, 2, 1))
    return ResidualRows(*values), ResidualRows(*slopes)


def damped_step(rows: ResidualRows, slopes: ResidualRows, x: Real, damping: Any) -> Real:
    """Return the Levenberg-Marquardt step of each point, limited to the bounds 0..1.

    Args:
        rows: residuals and inequalities at the points.
        slopes: their derivatives, shape (..., rows, n).
        x: points, shape (..., n).
        damping: damping of each point, shape (...).

    Returns:
        Steps, shape (..., n).
    """
    n = x.shape[-1]
    square = slopes.off.mT @ slopes.off
    steep = np.einsum("...ii->...i", square)
    floor = steep + 1e-6 * np.sum(steep, axis=-1, keepdims=True)
    square = square + np.eye(n) * (np.asarray(damping)[..., None] * floor + 1e-30)[..., None]
    down = -slopes.off.mT @ rows.off[..., None]
    weight = WEIGHT**2 * np.maximum(1.0, np.max(steep, axis=-1))[..., None, None]
    broken, beyond = np.zeros((*rows.least.shape, 1), dtype=bool), np.zeros((*x.shape, 1), dtype=bool)
    edge = np.zeros(beyond.shape)
    for __ in range(PASSES):
        pulled, held = (slopes.least * (weight * broken)).mT, weight * beyond
        pull = down - pulled @ rows.least[..., None] + held * edge
        step = solve(square + pulled @ slopes.least + np.eye(n) * held, pull[..., 0])[..., None]
        step = np.where(np.isfinite(step), step, 0.0)  # parameters without influence take no step
        before, edge = (broken, beyond), np.clip(step, -x[..., None], 1 - x[..., None])
        broken, beyond = slopes.least @ step < -rows.least[..., None], edge != step
        if all(map(np.array_equal, before, (broken, beyond))):
            break
    return step[..., 0]


# Parameters on which the motion depends linearly, as the position of the frame or of a coupler point.
#
# With all others fixed they follow from linear least squares, with a unique solution (G. Golub, V. Pereyra, SIAM
# Journal on Numerical Analysis 10 (1973)). For a path without driver coordinates, nearest points and parameters are
# determined alternately (P. Besl, N. McKay, IEEE PAMI 14 (1992)).


LINEAR = 1e-9  # relative second difference of a linear motion
SHOWN, DRAWN = 3, 200  # candidates on which linearity is tested, of so many drawn
TURNS = 12  # iterations of the nearest points
DAMPING = 1e-9  # keeps undetermined parameters unchanged
SETTLED_AT_ONCE = 250  # candidates in a block


class LinearParameters:
    """Solver for those parameters on which the motion depends linearly, e.g. the coordinates of a fixed pivot.

    Called with candidates in 0..1, shape (variants, n), it returns them with improved values of these parameters.
    """

    def __init__(self, candidates: Candidates) -> None:
        self.candidates = candidates
        assert isinstance(candidates.task.objective, Deviation)
        self.objective = candidates.task.objective
        self.linear = self._find_linear()

    def __call__(self, x: Real) -> Real:
        if not self.linear or not len(x):
            return x
        with np.errstate(all="ignore"):
            return np.concatenate(
                [self._solve_block(x[at : at + SETTLED_AT_ONCE]) for at in range(0, len(x), SETTLED_AT_ONCE)]
            )

    def _solve_block(self, x: Real) -> Real:
        ends = np.repeat(x[None], 1 + len(self.linear), axis=0)
        ends[:, :, self.linear] = 0
        ends[np.arange(1, len(ends)), :, self.linear] = 1
        curves = self._curve(ends.reshape(-1, x.shape[1])).reshape(len(ends), len(x), -1)
        first, slopes = curves[0], np.moveaxis(curves[1:] - curves[0], 0, -1)
        required, parameters = np.array(self.objective.wanted), x[:, self.linear]
        for __ in range(1 if self.objective.places else TURNS):
            off, own_slopes = first + np.einsum("vpk,vk->vp", slopes, parameters), slopes
            if not self.objective.places:
                near = nearest_corners(off.real.copy(), off.imag.copy(), required).T
                off = np.take_along_axis(off, near, axis=1)
                own_slopes = np.take_along_axis(slopes, near[..., None], axis=1)
            rows = ResidualRows(_split_complex(off - required), np.zeros((len(x), 0)))
            derivatives = ResidualRows(_split_complex(own_slopes), np.zeros((len(x), 0, len(self.linear))))
            step = damped_step(rows, derivatives, parameters, DAMPING)
            parameters = np.clip(parameters + step, 0, 1)
        settled = x.copy()
        settled[:, self.linear] = parameters
        return settled

    def _curve(self, x: Real) -> Any:
        """Return the motion of candidates that the objective compares with required values, shape (variants,
        positions).
        """
        candidates = self.candidates
        outputs = candidates.coarse(candidates.numbers(x), candidates.places)
        return self.objective.curve(quantity_reader(outputs, 0, candidates.exact[0]))

    def _find_linear(self) -> list[int]:
        """Return the indices of the parameters on which the motion depends linearly.

        It depends linearly on each of them, and on all of them together.
        """
        x = np.random.default_rng(0).random((DRAWN, len(self.candidates.low)))
        x = x[self.candidates.evaluate(x)[1] < LOST][:SHOWN]

        def adds(k: int, m: int) -> bool:
            ends = np.repeat(x[None], 4, axis=0)
            ends[:, :, [k, m]] = 0.25
            ends[1::2, :, k] += 0.25
            ends[2:, :, m] += 0.25
            curves = [self._curve(end) for end in ends]
            off = np.max(np.abs(curves[3] - curves[2] - curves[1] + curves[0]))
            return bool(off <= LINEAR * np.max(np.abs(curves)))

        linear: list[int] = []
        with np.errstate(all="ignore"):
            for k in range(x.shape[1]):
                if len(x) and all(adds(k, m) for m in (*linear, k)):
                    linear.append(k)
        return linear


def _split_complex(rows: Any) -> Real:
    """Replace each complex residual by its real and imaginary part, shape (variants, residuals, ...)."""
    return np.concatenate([rows.real, rows.imag], axis=1) if np.iscomplexobj(rows) else rows


# Least squares from many starting points besides the evolution: rounds of random points, of which the best continue.
#
# Paths and laws have many local minima at the ends of long narrow valleys. A round is a tournament: many starts,
# with solved linear parameters, make few steps, and the best continue. The search ends if several of the last ones of
# two or more rounds reach the same minimum; else the best are perturbed, as minima often lie side by side.


SAMPLES = 20_000  # random points of a round; the best of them and evolved candidates start
TOURNAMENT = ((400, 6), (160, 15), (24, 40), (8, 60))  # number of points and their steps: early ranks mean little
ROUNDS, AGREED = 3, 6  # at most; starting points that must reach the same minimum
SHAKEN, DECADES = (
    ((160, 15), (24, 40), (8, 60)),
    (-2.5, -0.3),
)  # as TOURNAMENT; log10 of the perturbations, fractions of the ranges
SHAKES, SHAKE_GAIN = 4, 1e-4  # at most; relative gain for another round
SAME, NEAR = 1e-3, 1e-2  # relative: same minimum; equivalent for most uses
ZERO = 1e-7  # relative deviation that counts as zero
CLOSER, LAST = 360, 100  # positions and steps for the winners
WINNERS = 4
BLOCK = 400  # variants in a block


@dataclass(frozen=True)
class IndependentEnds:
    """Agreement of the results of searches (descents) from independent starting points.

    Attributes:
        count: number of descents.
        same: number of descents that reached the minimum.
        near: number of descents whose result exceeds the minimum by at most the fraction NEAR.
        met: True if the minimum is zero.
    """

    count: int
    same: int
    near: int
    met: bool

    @classmethod
    def of(cls, won: Sequence[tuple[float, Real]]) -> IndependentEnds:
        costs = np.array([cost for cost, __ in won])
        least = np.min(costs)
        same, near = (int(np.sum(costs <= least * (1 + share) ** 2)) for share in (SAME, NEAR))
        return cls(len(costs), same, near, bool(least < ZERO**2))

    @property
    def agree(self) -> bool:
        """True if enough descents reached the same minimum; another seed is then likely to give it as well."""
        return self.met or self.same >= AGREED


@dataclass(frozen=True)
class ManyStartsResult:
    """Result of the search from many starting points.

    Attributes:
        starts: best points found, best first, as starting points for the refinement.
        ends: agreement of the independent searches; None if no candidate can be assembled.
        stopped: True if the user stopped the search.
    """

    starts: list[Real]
    ends: IndependentEnds | None
    stopped: bool


def is_least_squares(candidates: Candidates) -> bool:
    """Return True if the search from many starting points can be used.

    The objective must be a sum of squares without a target, and all parameters must be continuous.
    """
    task = candidates.task
    squares = isinstance(task.objective, Deviation) and task.objective.norm == "least squares"
    return squares and task.target is None and candidates.traced and len(task.free) == len(task.parameters)


def search_from_many(candidates: Candidates, evolved: Sequence[Real]) -> ManyStartsResult:
    """Search for the minimum from many starting points.

    Args:
        candidates: evaluator of the candidates.
        evolved: candidates from the evolution, additional starting points of the first round.
    """
    chance = np.random.default_rng(candidates.task.seed)
    evaluate, settle = residual_function(candidates), LinearParameters(candidates)
    won: list[tuple[float, Real]] = []
    near: list[tuple[float, Real]] = []
    stopped, progress = False, candidates.task.progress
    try:
        for k in range(ROUNDS):
            progress(k, ROUNDS)
            x = _draw_random_starts(candidates, chance)
            x = np.vstack([*(evolved if k == 0 else ()), x[candidates.evaluate(x)[1] < LOST]])
            won += _run_tournament(candidates, evaluate, settle, x)
            ends = IndependentEnds.of(won)
            if ends.met or (k and ends.agree):
                break
        else:
            near = _shake_best(evaluate, won, chance)
    except KeyboardInterrupt:
        stopped = True
    finally:
        progress(ROUNDS, ROUNDS)
    if not won:
        return ManyStartsResult([], None, stopped)
    won.sort(key=lambda ranked: ranked[0])
    best = sorted([*won[:WINNERS], *near], key=lambda ranked: ranked[0])[:WINNERS]
    closer = residual_function(Candidates(replace(candidates.task, positions=max(CLOSER, candidates.task.positions))))
    last = _sort_by_cost(*minimize_squares(closer, np.array([x for __, x in best]), LAST))
    return ManyStartsResult([x for __, x in last], IndependentEnds.of([*last, *won[WINNERS:]]), stopped)


def _draw_random_starts(candidates: Candidates, chance: np.random.Generator) -> Real:
    """Return random starting points in 0..1, shape (starts, n).

    In every second point the logarithms of the parameters are evenly distributed, because with wide bounds the size of
    the mechanism is unknown.
    """
    x = chance.random((SAMPLES, len(candidates.low)))
    ratio = candidates.low > 0
    low, high = candidates.low[ratio], candidates.high[ratio]
    x[::2, ratio] = (low * (high / low) ** x[::2, ratio] - low) / (high - low)
    return x


def _run_tournament(
    candidates: Candidates, evaluate: Evaluate, settle: LinearParameters, x: Real
) -> list[tuple[float, Real]]:
    """Run a tournament of starting points: after each stage only the best ones are improved further.

    Returns:
        Sums of squares and end points of the last stage, best first.
    """

    def settled(x: Real) -> Real:
        """Return candidates with the best values of those parameters on which the motion depends linearly.

        A candidate is changed only if its sum of squares decreases, because constraints are ignored in this step.
        """
        ends = settle(x)
        return np.where((evaluate(ends, 1).cost() < evaluate(x, 1).cost())[:, None], ends, x)

    x = settled(x)
    f, violation = candidates.evaluate(x)
    x = x[np.lexsort((f, violation))]
    for count, steps in TOURNAMENT:
        last = _sort_by_cost(*minimize_squares(evaluate, settled(x[:count]), steps))
        x = np.array([point for __, point in last])
    return last


def _shake_best(
    evaluate: Evaluate, won: list[tuple[float, Real]], chance: np.random.Generator
) -> list[tuple[float, Real]]:
    """Perturb the best points by random amounts, small and large, and minimise again.

    This is repeated as long as it improves the best point.
    """
    (count, __), last = SHAKEN[0], SHAKEN[-1][0]
    best = sorted(won, key=lambda ranked: ranked[0])[:last]
    for __ in range(SHAKES):
        x = np.repeat([x for __, x in best], count // last, axis=0)
        x = np.clip(x + 10 ** chance.uniform(*DECADES, (len(x), 1)) * chance.standard_normal(x.shape), 0, 1)
        for some, steps in SHAKEN:
            new = _sort_by_cost(*minimize_squares(evaluate, x[:some], steps))
            x = np.array([point for __, point in new])
        before, best = best[0][0], sorted([*best, *new], key=lambda ranked: ranked[0])[:last]
        if best[0][0] > before * (1 - SHAKE_GAIN):
            break
    return best


def _sort_by_cost(x: Real, cost: Real) -> list[tuple[float, Real]]:
    """Pair each sum of squares with its point, best first."""
    return sorted(zip(cost.tolist(), x, strict=True), key=lambda ranked: ranked[0])


def residual_function(candidates: Candidates) -> Evaluate:
    """Return a function that computes the residuals of the objective for candidates.

    Equality constraints are added as weighted residuals.
    """
    objective, constraints = candidates.task.objective, candidates.constraints
    assert isinstance(objective, Deviation)
    unit = objective.spread * np.sqrt(len(objective.wanted))

    def block(x: Real, each: int) -> ResidualRows:
        (__, read, over), *others = candidates.evaluate_coarsely(x)[1]
        off, least = [objective.residuals(read, over, each) / unit], []
        for constraint, (quantity, read, over) in zip(constraints, others, strict=True):
            value = quantity.coarse(read, over)[:, None]
            above, even = constraint.rows(value, value)
            least += above
            off += [WEIGHT * row for row in even]
        return ResidualRows(np.hstack(off), np.hstack(least))

    def evaluate(x: Real, each: int) -> ResidualRows:
        size = max(1, BLOCK // each) * each
        with np.errstate(all="ignore"):
            rows = [block(x[at : at + size], each) for at in range(0, len(x), size)]
        return ResidualRows(np.concatenate([r.off for r in rows]), np.concatenate([r.least for r in rows]))

    return evaluate
