"""Four-bars by more pairs of angles than they can pass: least squares of the errors of the output angle.

Freudenstein's equation is linear in p, q, s, and its least squares start the search, from zero angles all round where
they are to be found. Its residual is not the error of the angle (functions by 15 points were left with up to three
times as large a one), so damped Gauss-Newton steps go on to the least squares of the angles themselves.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.four_bar_by_angles.freudenstein import Bars, bars, of_zeros, outputs, slopes

GRID: Final = 324  # zero angles of half a turn that are tried
STARTS: Final = 12  # the best of them, from which steps go on
STEPS: Final = 100
ENDLESS: Final = 1e-3  # l4 over a link that only grows: errors get less and less
FIRST, LARGEST = 1e-3, 1e12  # damping
EXACT: Final = 1e-28  # rad^2: rounding
GAIN: Final = 1e-15  # of the sum of squares: what a step must bring


def minima(phi: Any, psi: Any, phi0: Any, psi0: Any) -> tuple[Bars, Any]:
    """Four-bars (n,), the best first, and their root mean square errors (rad); a zero angle of None is to be found."""
    phi, psi = np.asarray(phi, dtype=float), np.asarray(psi, dtype=float)
    count = round(GRID ** (0.5 if phi0 is None and psi0 is None else 1))
    half = np.pi * np.arange(count) / count
    zeros = np.stack(np.meshgrid(*(half if z is None else [float(z)] for z in (phi0, psi0))), -1).reshape(-1, 2)
    linear = of_zeros(phi + zeros[:, :1], psi + zeros[:, 1:])
    starts = np.concatenate([np.asarray(linear, dtype=float), zeros], axis=-1)
    free = [0, 1, 2, *(3 + k for k, z in enumerate((phi0, psi0)) if z is None)]
    squares = np.array([min(_off(x, phi, psi, side)[1] for side in (1.0, -1.0)) for x in starts])
    best = [k for k in np.argsort(squares)[:STARTS] if np.isfinite(squares[k])]
    ends = [end for k in best if (end := _descend(starts[k], phi, psi, free)) and np.abs(end[0][:2]).min() > ENDLESS]
    ends.sort(key=lambda end: end[1])
    values = np.array([end[0] for end in ends]).reshape(-1, 5)
    return signed_bars(values), np.sqrt([end[1] / len(phi) for end in ends])


def signed_bars(values: Any) -> Bars:
    """Positive lengths from p, q, s, phi0, psi0 (..., 5), the coupler from s, as no pair is passed exactly."""
    found, (p, q, s) = bars(values, np.zeros(1), np.zeros(1)), (values[..., k] for k in range(3))
    with np.errstate(all="ignore"):
        return found._replace(l2=np.sqrt(1 + 1 / p**2 + 1 / q**2 - 2 * s / (p * q)))


def _off(x: Any, phi: Any, psi: Any, side: float) -> tuple[Any, float]:
    """Errors of the output angle, and their sum of squares: inf where the four-bar does not close."""
    p, q, s, phi0, psi0 = x
    with np.errstate(all="ignore"):  # outputs take a link drawn the other way as one of negative length
        l2 = np.sqrt(1 + 1 / p**2 + 1 / q**2 - 2 * s / (p * q))
        off = outputs(Bars(1 / p, l2, 1 / q, phi0, psi0), phi, psi, side, np.nan) - psi
    total = float(off @ off)
    return off, total if np.isfinite(total) else np.inf


def _descend(x: Any, phi: Any, psi: Any, free: list[int]) -> tuple[Any, float] | None:
    """Where damped steps lead on the better one of both assemblies, and the sum of squares there; None: to no end."""
    side = min((1.0, -1.0), key=lambda side: _off(x, phi, psi, side)[1])
    (off, least), damping = _off(x, phi, psi, side), FIRST
    for _ in range(STEPS):
        rows = slopes(x[0], x[1], phi + x[3], psi + off + x[4])
        with np.errstate(all="ignore"):
            rows = (-rows / rows[:, 4:])[:, free]  # of the error: as the equation holds at the angle that is reached
        sizes = np.linalg.norm(rows, axis=0)
        if not np.all(np.isfinite(sizes) & (sizes > 0)):  # a pair stands in a dead position
            return None
        damped = np.concatenate([rows / sizes, np.sqrt(damping) * np.eye(len(free))])
        step = np.linalg.lstsq(damped, np.concatenate([-off, np.zeros(len(free))]), rcond=None)[0] / sizes
        tried = x.copy()
        tried[free] += step
        there, total = _off(tried, phi, psi, side)
        if total < least * (1 - GAIN):
            x, off, least, damping = tried, there, total, damping / 9
        elif damping > LARGEST or total <= least * (1 + GAIN):
            return x, least
        else:
            damping *= 5
        if least <= EXACT * len(phi):
            return x, least
    return None
