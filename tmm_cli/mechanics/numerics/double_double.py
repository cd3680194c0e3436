"""NumPy functions for double-double numbers (31 digits).

A double-double number is the unevaluated sum of two float64 numbers; arrays of such numbers are accepted by NumPy
functions. The ordinary code of the calculation therefore runs on them unchanged, with the same results on every
machine; the difference from its results in float64 is the rounding error. The real and imaginary parts of a complex
number are separate double-doubles.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import reduce
from itertools import accumulate
from typing import Any

import numpy as np

from tmm_cli.mechanics.numerics.double_double_number import (
    EPS,
    FUNCTIONS,
    PI,
    UFUNCS,
    DoubleDouble,
    absolute,
    add,
    angle,
    arctan2,
    array,
    divide,
    exp_i,
    floor,
    high_and_low,
    multiply,
    negative,
    power,
    remainder,
    sqrt,
    subtract,
    to_double_double,
    to_float,
)


def _where(truth: Any, true_values: Any, false_values: Any) -> DoubleDouble:
    (a, b), (c, d) = high_and_low(true_values), high_and_low(false_values)
    return DoubleDouble(np.where(truth, a, c), np.where(truth, b, d))


def _comparison(ufunc: Any) -> Callable[[Any, Any], Any]:
    """Make a NumPy comparison (less, equal, ...) for double-doubles: high parts are compared first, then low parts."""

    def compare(x: Any, y: Any) -> Any:
        (a, b), (c, d) = high_and_low(x), high_and_low(y)
        return np.where(a == c, ufunc(b, d), ufunc(a, c))

    return compare


def _high_part_only(ufunc: Any) -> Callable[[DoubleDouble], Any]:
    return lambda x: ufunc(x.hi)


def _sum(x: DoubleDouble, axis: int | None = None) -> DoubleDouble:
    x = array(x)
    return reduce(add, x.ravel() if axis is None else np.moveaxis(x, axis, 0))  # type: ignore[type-var]


def _cumsum(x: DoubleDouble, axis: int) -> DoubleDouble:
    sums: Any = np.stack(list(accumulate(np.moveaxis(x, axis, 0), add)))  # type: ignore[type-var]
    return np.moveaxis(sums, 0, axis)  # type: ignore[no-any-return]


def _interp(x: Any, at: Any, values: Any) -> DoubleDouble:
    """Interpolate linearly in a table, as np.interp does. Two rows with the same argument are a jump."""
    at, values = (DoubleDouble(*high_and_low(array(column))) for column in (at, values))
    left = np.clip(np.searchsorted(at.hi, high_and_low(x)[0], side="right") - 1, 0, max(len(at) - 2, 0))
    right = np.minimum(left + 1, len(at) - 1)
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.clip(divide(subtract(x, at[left]), at[right] - at[left]), 0.0, 1.0)
        between = values[left] + share * (values[right] - values[left])
    return _where(np.isnan(between), values[right], between)


UFUNCS |= {
    "add": add,
    "subtract": subtract,
    "multiply": multiply,
    "divide": divide,
    "negative": negative,
    "positive": lambda x: x,
    "absolute": absolute,
    "sqrt": sqrt,
    "power": power,
    "floor": floor,
    "ceil": lambda x: negative(floor(negative(x))),
    "remainder": remainder,
    "conjugate": DoubleDouble.conjugate,
    "cos": lambda x: exp_i(x).real,
    "sin": lambda x: exp_i(x).imag,
    "arctan2": arctan2,
    "tan": lambda x: divide(exp_i(x).imag, exp_i(x).real),
    "arctan": lambda x: arctan2(x, 1.0),
    "arcsin": lambda x: arctan2(x, sqrt(multiply(subtract(1.0, x), add(1.0, x)))),
    "arccos": lambda x: arctan2(sqrt(multiply(subtract(1.0, x), add(1.0, x))), x),
    "hypot": lambda x, y: sqrt(add(multiply(x, x), multiply(y, y))),
    "maximum": lambda x, y: _where(np.greater_equal(x, y) | np.isnan(x), x, y),
    "minimum": lambda x, y: _where(np.less_equal(x, y) | np.isnan(x), x, y),
}
COMPARING: tuple[Any, ...] = (np.less, np.less_equal, np.greater, np.greater_equal, np.equal, np.not_equal)
CLASSIFYING: tuple[Any, ...] = (np.sign, np.isfinite, np.isnan)
UFUNCS |= {ufunc.__name__: _comparison(ufunc) for ufunc in COMPARING}
UFUNCS |= {ufunc.__name__: _high_part_only(ufunc) for ufunc in CLASSIFYING}

FUNCTIONS |= {
    np.where: _where,
    np.sum: _sum,
    np.cumsum: _cumsum,
    np.interp: _interp,
    np.real: lambda x: x.real,
    np.imag: lambda x: x.imag,
    np.angle: angle,
    np.iscomplexobj: lambda x: x.dtype.kind == "c",
    np.clip: lambda x, low, high: np.minimum(np.maximum(x, low), high),
    np.searchsorted: lambda a, v, **how: np.searchsorted(high_and_low(a)[0], high_and_low(v)[0], **how),
}


__all__ = ["EPS", "PI", "DoubleDouble", "array", "to_double_double", "to_float"]
