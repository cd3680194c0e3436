"""Directions and angles: sines, cosines and their inverses."""

from __future__ import annotations

from decimal import Decimal, localcontext
from functools import cache
from typing import Any

import numpy as np

from tmm_cli.double_double.arithmetic import add, fast_two_sum, multiply, subtract, two_product, two_sum
from tmm_cli.double_double.number import EXACT, DoubleDouble, of_decimals, parts

PI = "3.14159265358979323846264338327950288419716939937510582097494"
PARTS = 64  # of a turn: directions that sines and cosines start from
POWERS, PRECISE = 9, 5  # of the square in the series from there on; those from PRECISE on are small enough for doubles


def turn(x: DoubleDouble) -> DoubleDouble:
    """e^(i x): the nearest of some directions, and the power series from there."""
    if x.turn is None:
        steps, directions, series = _tables()
        number = np.round(x.hi * (PARTS / (2 * np.pi)))
        product, error = two_product(number, steps[0])
        rest = DoubleDouble(*two_sum(x.hi - product, x.lo - error)) - number * steps[1]
        square = multiply(rest, rest)
        column = (slice(None), *(None,) * x.ndim)
        small: Any = 0.0
        for k in range(POWERS - 1, PRECISE - 1, -1):
            small = series[k].hi[column] + square.hi * small
        found = DoubleDouble(small)
        for k in range(PRECISE - 1, -1, -1):
            power, less = series[k], multiply(square, found)
            total, error = fast_two_sum(power.hi[column], less.hi)
            found = DoubleDouble(*fast_two_sum(total, error + (power.lo[column] + less.lo)))
        sine = multiply(found[1], rest)
        near = DoubleDouble(found.hi[0] + 1j * sine.hi, found.lo[0] + 1j * sine.lo)
        x.turn = multiply(directions[np.nan_to_num(number).astype(int) % PARTS], near)
    return x.turn


def arctan2(y: Any, x: Any) -> DoubleDouble:
    """One step from the double's: the sine of the angle that is left is that angle."""
    y, x = DoubleDouble(*parts(y)), DoubleDouble(*parts(x))
    near = DoubleDouble(np.arctan2(y.hi, x.hi))
    there, size = turn(near), np.hypot(y.hi, x.hi)
    left = subtract(multiply(y, there.real), multiply(x, there.imag)).hi
    return add(near, left / np.where(size == 0, 1.0, size))


def angle(z: DoubleDouble) -> DoubleDouble:
    """Of complex numbers."""
    if z.angle is None:
        z.angle = arctan2(z.imag, z.real)
    return z.angle


@cache
def _tables() -> tuple[list[float], DoubleDouble, DoubleDouble]:
    """A part of a turn in two doubles; the directions it leads to; coefficients of cosine and sine by powers."""
    with localcontext(EXACT):
        step = 2 * Decimal(PI) / PARTS
        steps, rest = [], step
        for _ in range(2):
            steps.append(float(rest))
            rest -= Decimal(steps[-1])
        cosine, sine, term = Decimal(0), Decimal(0), Decimal(1)
        for k in range(0, 40, 2):
            cosine, term = cosine + term, term * step / (k + 1)
            sine, term = sine + term, -term * step / (k + 2)
        directions = [(Decimal(1), Decimal(0))]
        for _ in range(PARTS - 1):
            c, s = directions[-1]
            directions.append((c * cosine - s * sine, c * sine + s * cosine))
        series, even = [], Decimal(1)
        for k in range(POWERS):
            odd = even / (2 * k + 1)
            series.append(of_decimals((even, odd)))
            even = -odd / (2 * k + 2)
    re, im = (of_decimals(column) for column in zip(*directions, strict=True))
    coefficients: Any = np.stack(series)
    return steps, DoubleDouble(re.hi + 1j * im.hi, re.lo + 1j * im.lo), coefficients
