"""Roots, minima and maxima of functions that are evaluated at many arguments at once."""

from __future__ import annotations

from collections.abc import Callable
from math import perm
from typing import Any

import numpy as np

from tmm_cli.mechanics.numerics.tolerances import SMOOTH
from tmm_cli.mechanics.numerics.vectors import Real

SPARE = 8  # bisections beyond the bits of a mantissa: from a step of a scan to the last bit
DEGREE = 8  # of the polynomial that locates an extreme
THIRDS = 18  # trisections of a step of a scan, to an interval of 1e-12 rad
REFINEMENTS, PARTS = 16, 4  # number of ever finer grids about a peak, and steps of each in one step of the grid before
FLAT = 1e-12  # fraction of the largest value: a smaller rise above the neighbours is rounding


def find_roots(function: Callable[[Real], Real], low: Real, high: Real) -> Real:
    """Find one root in each of many intervals, to the last bit.

    Inverse quadratic interpolation where it is safe, otherwise bisection: T. R. Chandrupatla, A new hybrid
    quadratic/bisection algorithm for finding the zero of a nonlinear function, Advances in Engineering Software 28
    (1997).

    Args:
        function: takes and returns arrays of the shape of `low`; it has different signs at `low` and `high`.
        low, high: ends of the intervals. The roots have their precision, but at least float64.
    """
    kind = np.result_type(np.asarray(low), np.asarray(high), float)
    b, a = np.asarray(low, kind), np.asarray(high, kind)
    fb, fa = function(b), function(a)
    if bool(np.any((fa == 0) | (fb == 0))):
        return _bisect_sign_changes(function, b, a, fb)
    c, fc, share = b, fb, np.full(np.shape(a), 0.5)
    with np.errstate(all="ignore"):
        for _ in range(count_halvings(a)):
            place = a + share * (b - a)
            value = function(place)
            same = np.sign(value) == np.sign(fa)
            c, fc = np.where(same, a, b), np.where(same, fa, fb)
            b, fb = np.where(same, b, a), np.where(same, fb, fa)
            a, fa = place, value
            best = np.where(np.abs(fa) < np.abs(fb), a, b)
            least_step = 2 * np.spacing(np.abs(best)) / np.abs(b - a)
            if bool(np.all((least_step > 0.5) | (np.minimum(np.abs(fa), np.abs(fb)) == 0) | (a == b))):
                break
            xi, phi = (a - b) / (c - b), (fa - fb) / (fc - fb)
            safe = (phi**2 < xi) & ((1 - phi) ** 2 < 1 - xi)
            inner = fa / (fb - fa) * fc / (fb - fc) + (c - a) / (b - a) * fa / (fc - fa) * fb / (fc - fb)
            share = np.where(safe & np.isfinite(inner), inner, 0.5)
            share = np.clip(share, np.minimum(least_step, 0.5), 1 - np.minimum(least_step, 0.5))
    return np.where(np.abs(fa) <= np.abs(fb), a, b)


def bisect(
    holds: Callable[[Real], Real], inside: Real, outside: Real, halvings: int | None = None
) -> tuple[Real, Real]:
    """Bisect each interval for the point where a condition ceases to hold.

    Args:
        holds: the condition; True at `inside`, False at `outside`.
        inside, outside: ends of the intervals, in any order.
        halvings: number of bisections; by default until the interval is two neighbouring floating-point numbers.

    Returns:
        The last argument at which the condition holds and the first at which it does not.
    """
    for _ in range(count_halvings(inside) if halvings is None else halvings):
        middle = (inside + outside) / 2
        good = holds(middle)
        inside, outside = np.where(good, middle, inside)[()], np.where(good, outside, middle)[()]
    return inside, outside


def count_halvings(ends: Real) -> int:
    """Return the number of bisections that shrink an interval to the precision of its ends."""
    return int(np.finfo(np.result_type(ends, float)).nmant) + SPARE


def _bisect_sign_changes(function: Callable[[Real], Real], low: Real, high: Real, at_low: Real) -> Real:
    """Find by bisection the arguments at which the function no longer has the sign that it has at `low`.

    If the function is zero over an interval (a dwell), the edge of that interval nearest to `low` is returned.
    """
    same, other = bisect(lambda place: np.sign(function(place)) == np.sign(at_low), low, high)
    return (same + other) / 2


def find_minima(function: Callable[[Real], Real], low: Real | float, high: Real | float) -> tuple[Any, Any]:
    """Find the minimum of a function in each of many intervals, by sampling ever smaller intervals.

    Each interval must contain only one minimum.

    Returns:
        Argument and value of the minimum in each interval.
    """
    ends = np.array([low, high])
    if not ends.size:
        return ends[0], ends[1]
    for _ in range(THIRDS):
        samples = np.linspace(ends[0], ends[1], 9)
        best = np.argmin(function(samples.ravel()).reshape(samples.shape), axis=0)
        ends = np.take_along_axis(samples, np.clip([best - 1, best + 1], 0, 8), 0)
    middle = np.mean(ends, axis=0)
    return middle, function(np.ravel(middle)).reshape(np.shape(middle))[()]


def greatest_values(curves: Callable[[Real, Real], Real], q: Real, values: Real, *, turns: bool = False) -> Real:
    """Return the largest value of each curve, shape (curves,); nan for a curve without values.

    The curves are sampled already. Around each peak that may exceed the largest sample, ever finer grids are evaluated.
    Between two samples a curve is assumed to rise by at most twice the difference of the samples. Curves may have jumps
    and kinks.

    Args:
        curves: function of the curve numbers (k,) and arguments (k, n); returns values (k, n).
        q: arguments at equal steps from one end of the range or cycle to the other, shape (points,).
        values: values of all curves at q, shape (curves, points), nan where a curve is undefined.
        turns: True if the values are angles (rad), unwrapped.
    """
    y = np.where(np.isfinite(values), values, -np.inf)
    best = np.max(y, axis=1)
    before, after = np.column_stack([y[:, 0], y[:, :-1]]), np.column_stack([y[:, 1:], y[:, -1]])
    with np.errstate(invalid="ignore"):
        rise = np.maximum(y - before, y - after)
        flat = FLAT * np.max(np.abs(y), axis=1, where=np.isfinite(y), initial=0.0)
        near_top = (y >= before) & (y >= after) & (y + 2 * rise >= best[:, None]) & (rise > flat[:, None])
    rows, place = np.nonzero(near_top & np.isfinite(y))
    at, top_value, start = q[place], y[rows, place], y[rows, place][:, None]
    step = abs(float(q[1] - q[0])) if len(q) > 1 else 0.0
    for _ in range(REFINEMENTS if rows.size else 0):
        grid = at[:, None] + step * np.linspace(-1, 1, 2 * PARTS + 1)
        grid = np.clip(grid, np.min(q), np.max(q))
        fine = curves(rows, grid)
        if turns:
            fine = start + np.remainder(fine - start + np.pi, 2 * np.pi) - np.pi
        fine = np.where(np.isfinite(fine), fine, -np.inf)
        highest = np.argmax(fine, axis=1)[:, None]
        value = np.take_along_axis(fine, highest, 1)[:, 0]
        at = np.where(value > top_value, np.take_along_axis(grid, highest, 1)[:, 0], at)
        top_value = np.maximum(value, top_value)
        step /= PARTS
    np.maximum.at(best, rows, top_value)
    return np.where(np.isfinite(best), best, np.nan)


def locate_extreme(function: Callable[[Real], Real], place: float, half: float) -> float:
    """Find the argument of a smooth extreme near `place`, to nearly all digits, from the slope of a fitted polynomial.

    A comparison of values would give only half the digits. If the function is not smooth within `half` of `place`,
    `place` is returned unchanged.
    """
    nodes = np.cos(np.pi * np.arange(DEGREE + 5) / (DEGREE + 4))
    values = function(place + half * nodes)
    if not bool(np.all(np.isfinite(values))):
        return place
    fit = np.polynomial.Chebyshev.fit(nodes, values, DEGREE, domain=[-1, 1])
    rough = float(np.max(np.abs(fit(nodes) - values)))
    slope, bend = fit.deriv(), fit.deriv(2)
    t = 0.0
    for _ in range(8):
        curved = float(bend(t))
        if curved == 0 or abs(t) > 1:
            return place
        t -= float(slope(t)) / curved
    smooth = rough < SMOOTH * float(np.max(np.abs(values))) and float(np.ptp(values)) > 1e3 * rough
    return place + half * t if smooth and abs(t) < 1 else place


# Peaks and zeros between the samples of a quantity, for many variants at once.
#
# Seven neighbouring samples at equal steps h determine a polynomial of degree 6, whose error is at most h^7 times the
# seventh derivative over 7!. Arrays are (variants, samples).


WINDOW = 33  # samples about a peak
WINDOW_SIDE = 3  # samples on either side
WINDOW_FIT = np.linalg.inv(
    np.vander(np.arange(-WINDOW_SIDE, WINDOW_SIDE + 1.0), increasing=True)
).T  # values @ WINDOW_FIT: coefficients
NEWTON_STEPS = 6
MOST_PEAKS = 8  # of a curve that may jump
LOWEST_PEAK = 0.3  # fraction of the range: peaks farther below the highest one are ignored
FACTORS = [
    [float(perm(power, order)) for power in range(2 * WINDOW_SIDE + 1)] for order in range(3)
]  # factors of the coefficients in derivatives


def _fit_windows(y: Real, k: Real) -> tuple[Real, Real]:
    middle = np.clip(k, WINDOW_SIDE, y.shape[1] - WINDOW_SIDE - 1)
    near = np.take_along_axis(y, middle[:, None] + np.arange(-WINDOW_SIDE, WINDOW_SIDE + 1), axis=1)
    return near @ WINDOW_FIT, middle


def polynomial_value(c: Real, u: Real, order: int = 0) -> Real:
    """Return a derivative of fitted polynomials.

    Args:
        c: coefficients of the polynomials, shape (..., 7).
        u: distance from the centre of each polynomial, in sampling steps.
        order: order of the derivative, 0 to 2.
    """
    return _horner(_derivative_coefficients(c, order), u)


def _derivative_coefficients(c: Real, order: int) -> list[Real]:
    """Return the coefficients of a derivative of the fitted polynomials, highest power first."""
    return [FACTORS[order][power] * c[..., power] for power in range(2 * WINDOW_SIDE, order - 1, -1)]


def _horner(coefficients: list[Real], u: Real) -> Real:
    total, *rest = coefficients
    for coefficient in rest:
        total = total * u + coefficient
    return total


def window_peak(y: Real) -> Real:
    """Return the maximum of a quantity, interpolated between its samples (variants, samples); shape (variants,)."""
    top, most = np.argmax(y, axis=1), np.max(y, axis=1)
    c, middle = _fit_windows(y, top)
    slopes, bends = _derivative_coefficients(c, 1), _derivative_coefficients(c, 2)
    u = np.zeros(len(y))
    with np.errstate(all="ignore"):
        for _ in range(NEWTON_STEPS):
            bend, last = _horner(bends, u), u
            u = np.minimum(
                np.maximum(u - np.where(bend < 0, _horner(slopes, u) / bend, 0.0), -WINDOW_SIDE), WINDOW_SIDE
            )
            if np.array_equal(u, last):
                break
    peaks: Real = np.maximum(polynomial_value(c, u), most)
    return np.where((middle == top) & (np.abs(u) < WINDOW_SIDE), peaks, most)


def locate_zero(y: Real) -> Real:
    """Return where a sampled quantity changes sign, as the number of steps from the first sample, shape (variants,).

    Args:
        y: samples at equal steps about the change of sign, shape (variants, samples).
    """
    c, middle = _fit_windows(y, np.argmin(np.abs(y), axis=1))
    u = np.zeros(len(y))
    with np.errstate(all="ignore"):
        for _ in range(NEWTON_STEPS):
            step = polynomial_value(c, u) / polynomial_value(c, u, 1)
            u = np.clip(u - np.where(np.isfinite(step), step, 0.0), -WINDOW_SIDE, WINDOW_SIDE)
    return middle + u


def highest_value(curve: Callable[[Real], Real], scan: Real, *, closed: bool) -> float:
    """Return the largest value of a curve that may have jumps or kinks, by refinement around its highest peaks.

    Args:
        curve: function of arguments, fractions of the range.
        scan: arguments of the first samples, 0 to 1 at equal steps.
        closed: True if the curve is periodic.
    """
    y = curve(scan)
    best, step = float(np.nanmax(y)), scan[1] - scan[0]
    middle = scan[highest_peaks(y, MOST_PEAKS, closed)]
    ends = (middle - step, middle + step) if closed else (np.maximum(middle - step, 0), np.minimum(middle + step, 1))
    __, lowest = find_minima(lambda shares: np.nan_to_num(-curve(shares), nan=np.inf), *ends)
    return max(best, -float(np.min(lowest)))


def highest_peaks(y: Real, most: int, closed: bool) -> list[int]:
    """Return the indices of the highest peaks of a sampled curve, at most `most` of them.

    closed: True if the curve is periodic; otherwise its ends may be peaks too.
    """
    before, after = np.roll(y, 1), np.roll(y, -1)
    if not closed:
        before[0] = after[-1] = -np.inf
    peaks = np.flatnonzero((y >= before) & (y > after))
    if not peaks.size:
        return [int(np.argmax(y))]
    peaks = peaks[np.argsort(-y[peaks], kind="stable")][:most]
    return [
        int(k) for k in peaks if not y[k] < np.max(y) - LOWEST_PEAK * np.ptp(y)
    ]  # `not <` keeps peaks where values are nan
