"""Dual numbers: arrays together with their derivatives with respect to one parameter, without finite differences.

A dual number is x + x' eps with eps^2 = 0. NumPy functions accept arrays of dual numbers, so that the ordinary code of
the calculation gives the derivative of each result beside the result. Both parts may be ordinary arrays, double-doubles
or traced arrays. A. Griewank, A. Walther, Evaluating Derivatives (SIAM, 2008), ch. 2: forward mode.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin


class Dual(NDArrayOperatorsMixin):
    """Array of dual numbers, real or complex.

    Attributes:
        value: the values.
        slope: their derivatives, an array of the same shape.
    """

    __slots__ = ("slope", "value")
    __hash__ = object.__hash__

    def __init__(self, value: Any, slope: Any) -> None:
        self.value, self.slope = value, slope

    @property
    def shape(self) -> tuple[int, ...]:
        return np.shape(self.value)

    @property
    def ndim(self) -> int:
        return np.ndim(self.value)

    @property
    def dtype(self) -> Any:
        return self.value.dtype

    @property
    def real(self) -> Dual:
        return Dual(self.value.real, self.slope.real)

    @property
    def imag(self) -> Dual:
        return Dual(self.value.imag, self.slope.imag)

    def __getitem__(self, key: Any) -> Dual:
        return Dual(self.value[key], self.slope[key])

    def __setitem__(self, key: Any, entry: Any) -> None:
        self.value[key], self.slope[key] = split_dual(entry)

    def __array__(self, *_: Any, **__: Any) -> Any:
        raise TypeError("as a plain array it would lose its derivative")

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **more: Any) -> Any:
        if method != "__call__" or any(value is not None for value in more.values()):
            return NotImplemented
        if ufunc in OF_VALUE:
            return ufunc(*(split_dual(x)[0] for x in inputs))
        rule = UFUNCS.get(ufunc)
        return NotImplemented if rule is None else Dual(*rule(*(split_dual(x) for x in inputs)))

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        if function in FUNCTIONS:
            return FUNCTIONS[function](*args, **kwargs)
        if function in ROUNDED:
            return function(*(_part_of(arg, 0) for arg in args), **kwargs)
        if function not in LINEAR:
            return NotImplemented
        parts = [function(*(_part_of(arg, k) for arg in args), **kwargs) for k in (0, 1)]
        if isinstance(parts[0], list | tuple):
            return type(parts[0])(Dual(*both) for both in zip(*parts, strict=True))
        return Dual(*parts)


Parts = tuple[Any, Any]


def with_slope(value: Any, slope: Any) -> Any:
    """Make an array of dual numbers from values and their derivatives."""
    return Dual(value, slope)


def split_dual(number: Any) -> Parts:
    """Return the values and the derivatives of dual numbers. The derivative of an ordinary number is zero."""
    return (number.value, number.slope) if isinstance(number, Dual) else (number, 0.0)


def _part_of(argument: Any, part: int) -> Any:
    """Replace dual numbers in an argument by their values (part 0) or derivatives (part 1).

    The derivative of an ordinary array is zero.
    """
    if isinstance(argument, Dual):
        return (argument.value, argument.slope)[part]
    if isinstance(argument, list | tuple) and any(isinstance(x, Dual | np.ndarray) for x in argument):
        return type(argument)(_part_of(x, part) for x in argument)
    return np.zeros_like(argument) if part and isinstance(argument, np.ndarray) else argument


def _product(a: Parts, b: Parts) -> Parts:
    return a[0] * b[0], a[1] * b[0] + a[0] * b[1]


def _quotient(a: Parts, b: Parts) -> Parts:
    ratio = a[0] / b[0]
    return ratio, (a[1] - ratio * b[1]) / b[0]


def _power(a: Parts, exponent: Parts) -> Parts:
    n = exponent[0]
    if n in (1, 2):  # as products, which a trace can record
        return a if n == 1 else _product(a, a)
    return a[0] ** n, n * a[0] ** (n - 1) * a[1]


def _absolute(a: Parts) -> Parts:
    size = np.abs(a[0])
    if np.iscomplexobj(a[0]):
        return size, (a[0].real * a[1].real + a[0].imag * a[1].imag) / size
    return size, np.sign(a[0]) * a[1]


def _root(a: Parts) -> Parts:
    root = np.sqrt(a[0])
    return root, a[1] / (2 * root)


def _arctan2(y: Parts, x: Parts) -> Parts:
    return np.arctan2(y[0], x[0]), (x[0] * y[1] - y[0] * x[1]) / (x[0] * x[0] + y[0] * y[0])


def _remainder(a: Parts, b: Parts) -> Parts:
    return np.remainder(a[0], b[0]), a[1] + np.zeros(np.shape(a[0]))


UFUNCS: dict[Any, Callable[..., Parts]] = {
    np.add: lambda a, b: (a[0] + b[0], a[1] + b[1]),
    np.subtract: lambda a, b: (a[0] - b[0], a[1] - b[1]),
    np.multiply: _product,
    np.divide: _quotient,
    np.power: _power,
    np.square: lambda a: _product(a, a),
    np.negative: lambda a: (-a[0], -a[1]),
    np.positive: lambda a: a,
    np.conjugate: lambda a: (np.conjugate(a[0]), np.conjugate(a[1])),
    np.absolute: _absolute,
    np.sqrt: _root,
    np.sin: lambda a: (np.sin(a[0]), np.cos(a[0]) * a[1]),
    np.cos: lambda a: (np.cos(a[0]), -np.sin(a[0]) * a[1]),
    np.arctan2: _arctan2,
    np.remainder: _remainder,
    np.maximum: lambda a, b: (np.maximum(a[0], b[0]), np.where(a[0] >= b[0], a[1], b[1])),
    np.minimum: lambda a, b: (np.minimum(a[0], b[0]), np.where(a[0] <= b[0], a[1], b[1])),
}
OF_VALUE: set[Any] = {np.sign, np.isfinite, np.isnan, np.floor, np.rint}  # these have no derivative
OF_VALUE |= {np.less, np.less_equal, np.greater, np.greater_equal, np.equal, np.not_equal}

LINEAR = {np.stack, np.concatenate, np.broadcast_arrays, np.reshape, np.moveaxis, np.zeros_like, np.copy, np.sum}
ROUNDED = {np.shape, np.any, np.all, np.max, np.min, np.searchsorted, np.round}


def _where(truth: Any, chosen: Any, other: Any) -> Dual:
    (a, da), (b, db) = split_dual(chosen), split_dual(other)
    return Dual(np.where(truth, a, b), np.where(truth, da, db))


FUNCTIONS: dict[Any, Callable[..., Any]] = {
    np.where: _where,
    np.real: lambda x: x.real,
    np.imag: lambda x: x.imag,
    np.angle: lambda x: np.arctan2(x.imag, x.real),
    np.iscomplexobj: lambda x: np.iscomplexobj(x.value),
    np.clip: lambda x, low, high: np.minimum(np.maximum(x, low), high),
    np.broadcast_to: lambda x, shape: Dual(np.broadcast_to(x.value, shape), np.broadcast_to(x.slope, shape)),
    np.atleast_1d: lambda x: Dual(np.atleast_1d(x.value), np.atleast_1d(x.slope)),
}
