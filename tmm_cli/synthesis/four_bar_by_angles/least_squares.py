"""Four-bars for more pairs of angles than one can reach exactly: least squares of the errors of the output angle.

Freudenstein's equation is linear in p, q, s; its least squares give starting points on a grid of zero angles. Its
residual is not the error of the angle (functions with 15 points were left with up to three times the error), so damped
Gauss-Newton steps then minimise the squared errors of the angles.

The errors often keep decreasing while a link grows without limit, or while the four-bar approaches locking. Therefore
sequential quadratic programming (SLSQP of D. Kraft, in scipy) also minimises them within bounds: the ratio of the
longest to the shortest link, and the smallest transmission angle over the range. It starts from points spread evenly
over all four-bars within these bounds (I. M. Sobol).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.four_bar import cosine_bcd
from tmm_cli.synthesis.four_bar_by_angles.freudenstein import (
    FourBarRatios,
    equation_slopes,
    lengths_from_pqs,
    output_angles,
    solve_pqs,
)

GRID: Final = 324  # grid of zero angles over half a revolution
STARTS: Final = 12  # best grid points, from which the descent starts
STEPS: Final = 100
FIRST, LARGEST = 1e-3, 1e12  # damping
ROUNDING: Final = 1e-28  # rad^2: rounding
GAIN: Final = 1e-15  # relative decrease of the sum of squares that a step must bring
SLOPE: Final = 1e-6  # slope of the sum of squares in a minimum, relative to the product of errors and derivatives
SAMPLES: Final = 1 << 14  # four-bars compared for the starts within bounds
COMPARED: Final = 24  # pairs of angles by which they are compared
BOUNDED_STARTS: Final = 24
APART: Final = 0.35  # least distance between starts: logarithms of lengths, and angles (rad)
ROUGHLY: Final = (60, 1e-8)  # iterations, and tolerance of the mean square error relative to its value at the start
EXACTLY: Final = (300, 1e-14)
REFINED: Final = 12  # best rough minima that are refined
ROUGH_SLACK: Final = 0.1  # by which a rough minimum may exceed its bounds
REACHED: Final = 1e-6  # relative distance at which a bound counts as reached
SAME_FOUR_BAR: Final = 0.05  # logarithms of lengths, and angles (rad), of one minimum found from several starts
ROUGHLY_SAME: Final = 1e-3


@dataclass(frozen=True)
class FitBounds:
    """Bounds of four-bars that are fitted to pairs of angles.

    Attributes:
        ratio: largest ratio of the longest to the shortest link.
        transmission: smallest transmission angle over the range (rad).
        span: first and last input angle of the range (rad), measured from the zero angle.
    """

    ratio: float
    transmission: float
    span: tuple[float, float]


def fit_least_squares(phi: Any, psi: Any, phi0: Any, psi0: Any, bounds: FitBounds) -> tuple[FourBarRatios, Any]:
    """Find the four-bars whose output angles have the least sum of squared errors.

    Args:
        phi, psi: input and required output angles (rad), shape (pairs,).
        phi0, psi0: zero angles (rad); None if unknown.
        bounds: bounds of the four-bars.

    Returns:
        Local minima within the bounds, shape (minima,), the least first, and their root mean square errors (rad). A
        minimum that lies at none of the bounds is accurate to rounding. Its transmission angle may be less than the
        bound.
    """
    phi, psi = np.asarray(phi, dtype=float), np.asarray(psi, dtype=float)
    free = [0, 1, 2, *(3 + k for k, z in enumerate((phi0, psi0)) if z is None)]
    starts = _linear_starts(phi, psi, phi0, psi0)
    bounded = _BoundedFit(phi, psi, free, bounds)
    rough = [bounded.minimise(*start, ROUGHLY) for start in bounded.starts(phi0, psi0, starts)]
    rough = [end for end in rough if np.isfinite(end[0])]
    exact = [bounded.minimise(x, side, EXACTLY) for __, x, side in _distinct(rough)[:REFINED]]
    found = [x for square, x, __ in exact if np.isfinite(square)]
    inside = [_to_pqs(x) for x in [*(end[1] for end in _distinct(rough, ROUGHLY_SAME)), *found]]
    refined = [_minimise_errors(x, phi, psi, free) for x in [*starts[:STARTS], *inside]]
    inner = [_to_logarithms(end[0]) for end in refined if end]
    ends = [(bounded.least(x), x) for x in inner if bounded.is_within_ratio(x)]
    ends += [(bounded.least(x), x) for x in found if bounded.is_at_bound(x)]
    minima = _distinct([end for end in ends if np.isfinite(end[0])])
    four_bars = fitted_lengths(np.array([_to_pqs(end[1]) for end in minima]).reshape(-1, 5))
    return four_bars, np.sqrt([end[0] / len(phi) for end in minima])


def fitted_lengths(values: Any) -> FourBarRatios:
    """Convert approximate solutions p, q, s, phi0, psi0, shape (..., 5), to four-bars with positive lengths.

    The length of the coupler follows from s, because a fitted four-bar does not pass through any pair of angles
    exactly.
    """
    ratios, (p, q, s) = lengths_from_pqs(values, np.zeros(1), np.zeros(1)), (values[..., k] for k in range(3))
    with np.errstate(all="ignore"):
        return ratios._replace(l2=np.sqrt(1 + 1 / p**2 + 1 / q**2 - 2 * s / (p * q)))


def _linear_starts(phi: Any, psi: Any, phi0: Any, psi0: Any) -> Any:
    """Return the least-squares solutions p, q, s of Freudenstein's equation on a grid of zero angles.

    They serve as starting points, with the smallest errors first. phi0 and psi0 are appended to p, q, s.
    """
    count = round(GRID ** (0.5 if phi0 is None and psi0 is None else 1))
    half = np.pi * np.arange(count) / count
    zeros = np.stack(np.meshgrid(*(half if z is None else [float(z)] for z in (phi0, psi0))), -1).reshape(-1, 2)
    linear = solve_pqs(phi + zeros[:, :1], psi + zeros[:, 1:])
    starts = np.concatenate([np.asarray(linear, dtype=float), zeros], axis=-1)
    squares = np.array([min(_compute_errors(x, phi, psi, side)[1] for side in (1.0, -1.0)) for x in starts])
    return starts[[k for k in np.argsort(squares) if np.isfinite(squares[k])]]


def _compute_errors(x: Any, phi: Any, psi: Any, side: float) -> tuple[Any, float]:
    """Return the errors of the output angle (rad) and the sum of their squares; inf if the four-bar cannot be
    assembled.
    """
    p, q, s, phi0, psi0 = x
    with np.errstate(all="ignore"):  # a link in the opposite direction has a negative length here
        l2 = np.sqrt(1 + 1 / p**2 + 1 / q**2 - 2 * s / (p * q))
        off = output_angles(FourBarRatios(1 / p, l2, 1 / q, phi0, psi0), phi, psi, side, np.nan) - psi
    total = float(off @ off)
    return off, total if np.isfinite(total) else np.inf


def _minimise_errors(x: Any, phi: Any, psi: Any, free: list[int]) -> tuple[Any, float] | None:
    """Minimise the sum of squared errors of the output angle by damped Gauss-Newton steps.

    Of the two assemblies the one with the smaller initial error is used.

    Returns:
        End point and sum of squares; None if the steps do not converge to a minimum or reach a dead position.
    """
    side = min((1.0, -1.0), key=lambda side: _compute_errors(x, phi, psi, side)[1])
    (off, least), damping = _compute_errors(x, phi, psi, side), FIRST
    for _ in range(STEPS):
        rows = equation_slopes(x[0], x[1], phi + x[3], psi + off + x[4])
        with np.errstate(all="ignore"):
            rows = (-rows / rows[:, 4:])[
                :, free
            ]  # derivatives of the error, as the equation holds at the angle reached
        sizes = np.linalg.norm(rows, axis=0)
        if not np.all(np.isfinite(sizes) & (sizes > 0)):  # a pair lies in a dead position
            return None
        damped = np.concatenate([rows / sizes, np.sqrt(damping) * np.eye(len(free))])
        step = np.linalg.lstsq(damped, np.concatenate([-off, np.zeros(len(free))]), rcond=None)[0] / sizes
        tried = x.copy()
        tried[free] += step
        errors, total = _compute_errors(tried, phi, psi, side)
        if total < least * (1 - GAIN):
            x, off, least, damping = tried, errors, total, damping / 9
        elif damping > LARGEST or total <= least * (1 + GAIN):
            slope = np.abs(off @ rows) / (sizes * np.sqrt(least))
            return (x, least) if slope.max() < SLOPE else None
        else:
            damping *= 5
        if least <= ROUNDING * len(phi):
            return x, least
    return None


# The same within bounds, over the logarithms of l1/l4, l2/l4, l3/l4 and both zero angles.


def _to_pqs(x: Any) -> Any:
    """Convert four-bars given by the logarithms of their lengths to p, q, s, phi0, psi0."""
    l1, l2, l3 = np.exp(x[:3])
    return np.array([1 / l1, 1 / l3, (l1 * l1 + l3 * l3 + 1 - l2 * l2) / (2 * l1 * l3), x[3], x[4]])


def _to_logarithms(values: Any) -> Any:
    """Convert four-bars given by p, q, s, phi0, psi0 to the logarithms of their lengths, and their zero angles."""
    four_bar = fitted_lengths(np.asarray(values))
    return np.array([*(np.log(float(x)) for x in four_bar[:3]), float(four_bar.phi0), float(four_bar.psi0)])


def _distinct(ends: list[Any], within: float = SAME_FOUR_BAR) -> list[Any]:
    """Sort results of minimisations by their sums of squares, and keep only the best one of nearly equal four-bars.

    Each result is a tuple (sum of squares, four-bar, ...).
    """
    kept: list[Any] = []
    for end in sorted(ends, key=lambda end: float(end[0])):
        off = np.array([end[1] - other[1] for other in kept]).reshape(-1, 5)
        off[:, 3:] -= 2 * np.pi * np.round(off[:, 3:] / (2 * np.pi))
        if not (np.abs(off).max(-1) < within).any():
            kept.append(end)
    return kept


class _BoundedFit:
    """Problem of minimising the squared errors of the output angle of four-bars within bounds, with its derivatives."""

    def __init__(self, phi: Any, psi: Any, free: list[int], bounds: FitBounds) -> None:
        self.phi, self.psi, self.free, self.bounds = phi, psi, free, bounds
        # differences of the logarithms of l1, l2, l3 and l4, each in both directions
        units = np.vstack([np.eye(3, 5), np.zeros(5)])
        self.differences = np.array([units[i] - units[j] for i in range(4) for j in range(4) if i != j])

    def starts(self, phi0: Any, psi0: Any, linear: Any) -> list[tuple[Any, float]]:
        """Return starting points and their assemblies.

        Of many four-bars within the bounds, those with small errors are chosen that differ most from one another.

        Args:
            phi0, psi0: zero angles (rad); None if unknown.
            linear: four-bars p, q, s, phi0, psi0 from Freudenstein's equation, shape (n, 5).
        """
        from scipy.stats import qmc

        unit_points = qmc.Sobol(6, scramble=False).random(SAMPLES)
        points = np.zeros((SAMPLES, 5))
        reach = np.log(self.bounds.ratio)
        logarithms = reach * unit_points[:, :4]
        points[:, :3] = logarithms[:, :3] - logarithms[:, 3:]
        sides = np.where(np.arange(SAMPLES) % 2, 1.0, -1.0)
        for column, zero, share in ((3, phi0, unit_points[:, 4]), (4, psi0, unit_points[:, 5])):
            opposite = np.pi * (share > 0.5)  # a link may point opposite to its given zero direction
            points[:, column] = 2 * np.pi * share if zero is None else float(zero) + opposite
        few = np.unique(np.linspace(0, len(self.phi) - 1, min(COMPARED, len(self.phi))).round().astype(int))
        with np.errstate(all="ignore"):
            inside = self._transmission(points).min(-1) >= 0
            errors = self._errors(points, sides, few)
            if psi0 is None:  # the best psi0 removes the mean error
                mean = np.angle(np.exp(1j * errors).sum(-1))
                points[:, 4] += mean
                errors = errors - mean[:, None]
                errors = errors - 2 * np.pi * np.round(errors / (2 * np.pi))
            squares = np.where(inside, (errors**2).mean(-1), np.inf)
        chosen: list[tuple[Any, float]] = []
        order = [k for k in np.argsort(squares) if np.isfinite(squares[k])]
        for k in order:
            if len(chosen) == BOUNDED_STARTS:
                break
            if all(np.abs(points[k] - x).max() > APART or side != sides[k] for x, side in chosen):
                chosen.append((points[k], sides[k]))
        for values in linear[: BOUNDED_STARTS // 2]:
            x = _to_logarithms(values)
            if np.isfinite(x).all():
                x[:3] = np.clip(x[:3], -reach, reach)
                chosen += [(x, 1.0), (x, -1.0)]
        return chosen

    def minimise(self, x: Any, side: float, stop: tuple[int, float]) -> tuple[float, Any, float]:
        """Minimise the squared errors within the bounds from a starting point, on one assembly.

        Returns:
            Sum of squared errors (rad^2), the four-bar that is reached, shape (5,), and its assembly. The sum is
            infinite if this four-bar lies outside the bounds.
        """
        from scipy.optimize import minimize

        def full(y: Any) -> Any:
            values = x.copy()
            values[self.free] = y
            return values

        scale = max(float(np.mean(self._errors(x, side) ** 2)), ROUNDING)

        def value(y: Any) -> tuple[float, Any]:
            errors = self._errors(full(y), side)
            slopes = np.nan_to_num(self._slopes(full(y), errors))[:, self.free]
            return float(np.mean(errors**2)) / scale, 2 * (errors @ slopes) / len(errors) / scale

        reach, differences = np.log(self.bounds.ratio), self.differences[:, self.free]
        with np.errstate(all="ignore"):
            end = minimize(
                value,
                x[self.free],
                jac=True,
                method="SLSQP",
                constraints={
                    "type": "ineq",
                    "fun": lambda y: np.append(reach - self.differences @ full(y), self._transmission(full(y))),
                    "jac": lambda y: np.vstack([-differences, self._transmission_slopes(full(y))[:, self.free]]),
                },
                options={"maxiter": stop[0], "ftol": stop[1]},
            )
            point = full(end.x)
            slack = REACHED if stop == EXACTLY else ROUGH_SLACK
            inside = self.is_within_ratio(point, slack) and bool(self._transmission(point).min() >= -slack)
            return self.least(point) if inside else np.inf, point, side

    def is_within_ratio(self, x: Any, slack: float = REACHED) -> bool:
        return bool((self.differences @ x <= np.log(self.bounds.ratio) + slack).all())

    def is_at_bound(self, x: Any) -> bool:
        ratio = float((self.differences @ x).max()) > np.log(self.bounds.ratio) - REACHED
        return ratio or float(self._transmission(x).min()) < REACHED

    def least(self, x: Any) -> float:
        """Return the sum of squared errors (rad^2) of the four-bar, for that assembly in which it is smaller.

        It is infinite if a pair of angles cannot be reached.
        """
        return min(_compute_errors(_to_pqs(x), self.phi, self.psi, side)[1] for side in (1.0, -1.0))

    def _errors(self, x: Any, side: Any, pairs: Any = slice(None)) -> Any:
        """Return the errors of the output angle (rad), shape (..., pairs), also where a pair cannot be reached.

        Args:
            x: four-bars, shape (..., 5).
            side: assemblies, as signs of the cross product BC x DC, shape (...).
            pairs: pairs of angles.
        """
        l1, l2, l3 = (np.exp(x[..., k, None]) for k in range(3))
        diagonal = l1 * np.exp(1j * (x[..., 3, None] + self.phi[pairs])) - 1
        cosine = (l3 * l3 + np.abs(diagonal) ** 2 - l2 * l2) / (2 * l3 * np.abs(diagonal))
        angle = np.angle(diagonal) + np.asarray(side)[..., None] * np.arccos(np.clip(cosine, -1, 1))
        off = angle - x[..., 4, None] - self.psi[pairs]
        return off - 2 * np.pi * np.round(off / (2 * np.pi))

    def _slopes(self, x: Any, errors: Any) -> Any:
        """Return the derivatives of the errors of one four-bar with respect to its five parameters, shape (pairs, 5).

        They follow from the condition |BC| = l2.
        """
        l1, l2, l3 = np.exp(x[:3])
        phi, psi = self.phi + x[3], self.psi + errors + x[4]
        turn_cos, turn_sin = np.cos(phi - psi), np.sin(phi - psi)
        by_psi = -l3 * np.sin(psi) - l1 * l3 * turn_sin
        columns = (
            l1 * (l1 - np.cos(phi) - l3 * turn_cos),
            np.full_like(phi, -l2 * l2),
            l3 * (l3 + np.cos(psi) - l1 * turn_cos),
            l1 * np.sin(phi) + l1 * l3 * turn_sin,
        )
        with np.errstate(all="ignore"):
            return np.stack([*(-column / by_psi for column in columns), -np.ones_like(phi)], -1)

    def _transmission(self, x: Any) -> Any:
        """Return the inequalities for the transmission angle, shape (..., 8); all values must be >= 0.

        They are cos(limit) - cos BCD and cos(limit) + cos BCD at the input angles at which cos BCD may have an extreme:
        the ends of the range, and the angles at which B lies on AD.
        """
        l1, l2, l3 = (np.exp(x[..., k, None]) for k in range(3))
        cosines = cosine_bcd(l2, l3, l1 * l1 + 1 - 2 * l1 * np.cos(self._extreme_angles(x)))
        return np.cos(self.bounds.transmission) - np.concatenate([cosines, -cosines], axis=-1)

    def _transmission_slopes(self, x: Any) -> Any:
        """Return the derivatives of the inequalities for the transmission angle of one four-bar, shape (8, 5)."""
        l1, l2, l3 = np.exp(x[:3])
        angles = self._extreme_angles(x)
        cosines = cosine_bcd(l2, l3, l1 * l1 + 1 - 2 * l1 * np.cos(angles))
        by_l1, by_phi0 = -l1 * (l1 - np.cos(angles)) / (l2 * l3), -l1 * np.sin(angles) / (l2 * l3)
        slopes = np.stack([by_l1, l2 / l3 - cosines, l3 / l2 - cosines, by_phi0, np.zeros(4)], -1)
        return np.concatenate([-slopes, slopes])

    def _extreme_angles(self, x: Any) -> Any:
        """Return the angles of AB (rad) at which cos BCD may have an extreme in the range, shape (..., 4).

        These are the ends of the range, and the angles at which B lies on AD; between them cos BCD is monotonic.
        """
        low, high = (x[..., 3, None] + end for end in sorted(self.bounds.span))
        on_frame = np.pi * (np.ceil(low / np.pi) + np.arange(2))
        return np.concatenate([low, high, np.minimum(on_frame, high)], axis=-1)
