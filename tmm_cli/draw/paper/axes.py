"""Axes of charts: from values to millimetres of paper at a round scale, and the round numbers that stand on them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tmm_cli.language import numeral

ROUND = (1.0, 2.0, 2.5, 4.0, 5.0, 10.0)  # scale factors, times a power of ten
OF_DEGREES = (1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
TICKS = (1.0, 2.0, 5.0, 10.0)  # between numbers on an axis, times a power of ten
ANGLES = (1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0, 60.0, 90.0, 180.0, 360.0)  # the same in degrees, from a degree on
FLAT = 1e-9  # of the values: what differs by less does not change
DECADES = 12  # most of them on a logarithmic axis; what is smaller stands at its end


@dataclass(frozen=True)
class Axis:
    """Values from `low` on, `mu` of them a millimetre, `length` mm from `start` on; of a logarithmic one powers of ten.

    degrees: its round numbers are those of angles.
    """

    low: float
    mu: float
    start: float
    length: float
    logarithmic: bool = False
    degrees: bool = False

    @property
    def high(self) -> float:
        return self.low + self.mu * self.length

    @property
    def end(self) -> float:
        """Where it ends, mm."""
        return self.start + self.length

    def on(self, values: Any) -> NDArray[Any]:
        """Where values stand, mm; values of a logarithmic axis below its end stand at its end."""
        found = np.asarray(values, dtype=float)
        if self.logarithmic:
            with np.errstate(divide="ignore", invalid="ignore"):
                found = np.maximum(np.log10(found), self.low)
        return self.start + (found - self.low) / self.mu

    def ticks(self, apart: float) -> list[tuple[float, str]]:
        """Round values on the axis that stand at least so far apart (mm), and how they are written."""
        step = max(1.0, math.ceil(apart * self.mu)) if self.logarithmic else self._step(apart * self.mu)
        first, last = math.ceil(self.low / step - FLAT), math.floor(self.high / step + FLAT)
        values = [k * step for k in range(first, last + 1)]
        if self.logarithmic:
            return [(10.0**value, f"1e{value:.0f}" if value else "1") for value in values]
        return [(value, numeral(value, ".10g")) for value in values]

    def _step(self, least: float) -> float:
        if self.degrees and 1 <= least <= ANGLES[-1]:
            return next(step for step in ANGLES if step >= least * (1 - FLAT))
        return round_up(least, TICKS)


def round_up(least: float, steps: Sequence[float] = ROUND) -> float:
    """The smallest round number that is no smaller."""
    power = 10.0 ** math.floor(math.log10(least))
    return next(step for step in steps if step * power >= least * (1 - FLAT)) * power


def limits(values: Sequence[Any]) -> tuple[float, float]:
    """The least and the largest of all values that are finite; 0 and 1 where there are none."""
    every = np.concatenate([np.zeros(0), *(np.ravel(np.asarray(v, dtype=float)) for v in values)])
    every = every[np.isfinite(every)]
    return (float(every.min()), float(every.max())) if every.size else (0.0, 1.0)


def filling(low: float, high: float, start: float, length: float) -> Axis:
    """An axis from a value to another, whatever its scale."""
    return Axis(low, (high - low) / length, start, length)


def across(low: float, high: float, start: float, most: float, *, degrees: bool = False) -> Axis:
    """An axis that ends where the values end, at the largest round scale at which it is no longer than `most` mm."""
    low, high = _apart(low, high)
    mu = round_up((high - low) / most, OF_DEGREES if degrees else ROUND)
    return Axis(low, mu, start, (high - low) / mu, degrees=degrees)


def upwards(low: float, high: float, start: float, length: float, *, degrees: bool = False, air: float = 2.0) -> Axis:
    """An axis of this length at a round scale, with the values in it and `air` mm above and below them.

    Zero is on it unless the values lie far from it; where all of them lie on one side it begins, or ends, there.
    """
    low, high = _apart(low, high)
    if max(abs(low), abs(high)) < 2 * (high - low):
        low, high = min(low, 0.0), max(high, 0.0)
    mu = round_up((high - low) / (length - 2 * air), ROUND)
    spare = mu * length - (high - low)
    below = 0.0 if low == 0 else spare if high == 0 else spare / 2
    return Axis(low - below, mu, start, length, degrees=degrees)


def decades(low: float, high: float, start: float, length: float) -> Axis:
    """A logarithmic axis of whole powers of ten."""
    most = math.ceil(math.log10(high)) if high > 0 else 0
    least = math.floor(math.log10(low)) if low > 0 else most - DECADES
    least = max(min(least, most - 1), most - DECADES)
    return Axis(least, (most - least) / length, start, length, logarithmic=True)


def equal(axes: tuple[Axis, Axis], ends: Sequence[tuple[float, float]]) -> tuple[Axis, Axis]:
    """The two at one round scale at which what lies between these ends stands in the middle of both."""
    spans = [_apart(*own) for own in ends]
    mu = round_up(max((high - low) / axis.length for axis, (low, high) in zip(axes, spans, strict=True)))
    one, other = (
        replace(axis, low=(low + high - mu * axis.length) / 2, mu=mu)
        for axis, (low, high) in zip(axes, spans, strict=True)
    )
    return one, other


def _apart(low: float, high: float) -> tuple[float, float]:
    """The same, or round about it where both are one."""
    if high - low > FLAT * max(abs(low), abs(high)):
        return low, high
    half = abs(low) / 2 or 0.5
    return low - half, high + half
