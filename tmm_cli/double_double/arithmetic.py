"""Sums, products, quotients and roots, each off by less than EPS of itself.

Exact sums: D. E. Knuth, The Art of Computer Programming 2, 4.2.2; exact products: T. J. Dekker, A floating-point
technique for extending the available precision, Numer. Math. 18 (1971).
"""

from __future__ import annotations

from functools import reduce
from math import frexp
from typing import Any

import numpy as np

from tmm_cli.double_double.number import DoubleDouble, Pair, exactly, parts

SPLIT = 2.0**27 + 1  # tears a double into two halves of 26 bits
LARGEST_POWER = 8  # that is multiplied out


def two_sum(a: Any, b: Any) -> Pair:
    """a + b, and exactly what rounding took from it."""
    total = a + b
    other = total - a
    return total, (a - (total - other)) + (b - other)


def fast_two_sum(a: Any, b: Any) -> Pair:
    """The same where |a| is not less than |b|."""
    total = a + b
    return total, b - (total - a)


def two_product(a: Any, b: Any) -> Pair:
    """a b, one of them real, and exactly what rounding took from it."""
    product = a * b
    torn = SPLIT * a
    a1 = torn - (torn - a)
    torn = SPLIT * b
    b1 = torn - (torn - b)
    a2, b2 = a - a1, b - b1
    return product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2


def add(x: Any, y: Any) -> DoubleDouble:
    """x + y, one of them of 31 digits."""
    if not isinstance(y, DoubleDouble):
        x, y = y, x
    total, error = two_sum(y.hi, x.hi if isinstance(x, DoubleDouble) else x)
    if not isinstance(x, DoubleDouble):
        return DoubleDouble(*fast_two_sum(total, error + y.lo))
    lower, rest = two_sum(x.lo, y.lo)
    total, error = fast_two_sum(total, error + lower)
    return DoubleDouble(*fast_two_sum(total, error + rest))


def negative(x: DoubleDouble) -> DoubleDouble:
    """-x."""
    return DoubleDouble(-x.hi, -x.lo)


def subtract(x: Any, y: Any) -> DoubleDouble:
    """x - y, one of them of 31 digits."""
    return add(x, -y)


def multiply(x: Any, y: Any) -> DoubleDouble:
    """x y, one of them of 31 digits, real or complex."""
    if not isinstance(y, DoubleDouble):
        x, y = y, x
    if isinstance(x, DoubleDouble):
        one, rest = x.hi, x.hi * y.lo + x.lo * y.hi
    elif _only_scales(x):
        return DoubleDouble(x * y.hi, x * y.lo)
    else:
        one, rest = np.asarray(x), x * y.lo
    other = y.hi
    if one.dtype.kind == "c" and other.dtype.kind == "c":
        one, other = (one, other) if one.ndim >= other.ndim else (other, one)
        products, errors = two_product(_planes(one), other)
        product, error = two_sum(products[0], 1j * products[1])
        error = error + (errors[0] + 1j * errors[1])
    else:
        product, error = two_product(one, other)
    return DoubleDouble(*fast_two_sum(product, error + rest))


def _only_scales(x: Any) -> bool:
    """Whether products with it are exact: a power of two, or i."""
    if isinstance(x, complex):
        return x in (1j, -1j)
    return isinstance(x, int | float) and abs(frexp(x)[0]) == 0.5


def _planes(values: Any) -> Any:
    """Real and imaginary parts on a first axis."""
    planes = np.empty((2, *values.shape))
    planes[0], planes[1] = values.real, values.imag
    return planes


def divide(x: Any, y: Any) -> DoubleDouble:
    """x / y, real or complex."""
    x, y = DoubleDouble(*parts(x)), DoubleDouble(*parts(y))
    if y.dtype.kind == "c":
        return divide(multiply(x, y.conjugate()), square(y))
    first = x.hi / y.hi
    product, error = two_product(first, y.hi)
    rest = (x.hi - product) - error + (x.lo - first * y.lo)
    return _finite(DoubleDouble(*fast_two_sum(first, rest / y.hi)), first)


def _finite(found: DoubleDouble, plain: Any) -> DoubleDouble:
    """What was found, or the plain number where that is infinite or none."""
    sound = np.isfinite(plain)
    if sound.all():
        return found
    return DoubleDouble(np.where(sound, found.hi, plain), np.where(sound, found.lo, 0.0))


def square(z: DoubleDouble) -> DoubleDouble:
    """|z|^2 of complex numbers."""
    planes = _planes(z.hi)
    squares, errors = two_product(planes, planes)
    total, error = two_sum(squares[0], squares[1])
    rest = errors + 2 * planes * _planes(z.lo)
    return DoubleDouble(*fast_two_sum(total, error + (rest[0] + rest[1])))


def sqrt(x: DoubleDouble) -> DoubleDouble:
    """One step from the double's root."""
    root = np.sqrt(x.hi)
    square, error = two_product(root, root)
    rest = (x.hi - square) - error + x.lo
    return _finite(DoubleDouble(*fast_two_sum(root, rest / np.where(root == 0, 1.0, 2 * root))), root)


def absolute(x: DoubleDouble) -> DoubleDouble:
    """|x|, real or complex."""
    if x.dtype.kind == "c":
        return sqrt(square(x))
    sign = np.copysign(1.0, x.hi)
    return DoubleDouble(sign * x.hi, sign * x.lo)


def power(x: Any, n: Any) -> DoubleDouble:
    """To 31 digits for whole powers up to a few and for the root; else as good as a double's."""
    x, number = exactly(x), float(n)
    if number == 0.5:
        return sqrt(x)
    if not number.is_integer() or abs(number) > LARGEST_POWER:
        return DoubleDouble(np.power(x.hi, number))
    found = reduce(multiply, [x] * int(abs(number))) if number else DoubleDouble(np.ones(np.shape(x)))
    return found if number >= 0 else divide(1.0, found)


def floor(x: DoubleDouble) -> DoubleDouble:
    """The largest whole number that is not above x."""
    whole = np.floor(x.hi)
    return DoubleDouble(*fast_two_sum(whole, np.where(whole == x.hi, np.floor(x.lo), 0.0)))


def remainder(x: Any, y: Any) -> DoubleDouble:
    """What is left of x when y is taken from it as often as it goes."""
    return subtract(x, multiply(floor(divide(x, y)), y))
