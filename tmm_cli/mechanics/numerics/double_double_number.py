"""Double-double arrays and their arithmetic. The NumPy functions for them are in the module `double_double`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from decimal import Context, Decimal, localcontext
from functools import cache, reduce
from math import frexp
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from tmm_cli.mechanics.numerics.dual import Dual

EPS = 2.0**-103  # bound of the relative error of a sum, product, quotient or root
EXACT = Context(prec=60)

Pair = tuple[Any, Any]

UFUNCS: dict[str, Callable[..., Any]] = {}  # ufuncs of NumPy, by name
FUNCTIONS: dict[Any, Callable[..., Any]] = {}  # other functions of NumPy that compute
ROUNDED = {
    np.shape,
    np.max,
    np.min,
    np.nanmax,
    np.nanmin,
    np.any,
    np.all,
    np.round,
    np.argmax,
}  # evaluated for the high part
ARRANGING = {
    np.stack,
    np.concatenate,
    np.broadcast_to,
    np.broadcast_arrays,
    np.reshape,
    np.ravel,
    np.moveaxis,
    np.swapaxes,
    np.take_along_axis,
    np.atleast_1d,
    np.zeros_like,
    np.copy,
    np.nan_to_num,
    np.repeat,
}


class DoubleDouble(NDArrayOperatorsMixin):
    """Array of double-double numbers hi + lo, real or complex.

    Attributes:
        hi: high parts, the numbers rounded to float64 (or complex128).
        lo: low parts, the remainders; |lo| is at most half a unit in the last place of hi.
        turn: cached e^(i x), or None.
        angle: cached angle of a complex number, or None.
    """

    __slots__ = ("angle", "hi", "lo", "turn")

    def __init__(self, hi: Any, lo: Any = None) -> None:
        self.hi = np.asarray(hi)
        self.lo = np.zeros_like(self.hi) if lo is None else np.asarray(lo)
        self.turn: DoubleDouble | None = None  # cache of e^(i x)
        self.angle: DoubleDouble | None = None  # cache of the angle of a complex number

    @classmethod
    def decimal(cls, written: str) -> DoubleDouble:
        """Convert a decimal string, e.g. "0.1", to the nearest double-double.

        Raises:
            decimal.InvalidOperation: the string is not a number.
        """
        return from_decimals([EXACT.create_decimal(written)])[0]

    @property
    def shape(self) -> tuple[int, ...]:
        return self.hi.shape

    @property
    def ndim(self) -> int:
        return self.hi.ndim

    @property
    def size(self) -> int:
        return self.hi.size

    @property
    def dtype(self) -> Any:
        return self.hi.dtype

    @property
    def real(self) -> DoubleDouble:
        return DoubleDouble(self.hi.real, self.lo.real)

    @property
    def imag(self) -> DoubleDouble:
        return DoubleDouble(self.hi.imag, self.lo.imag)

    @property
    def T(self) -> DoubleDouble:  # noqa: N802  as of an array
        return DoubleDouble(self.hi.T, self.lo.T)

    def conjugate(self) -> DoubleDouble:
        return DoubleDouble(self.hi.conjugate(), self.lo.conjugate())

    def reshape(self, *shape: Any) -> DoubleDouble:
        return DoubleDouble(self.hi.reshape(*shape), self.lo.reshape(*shape))

    def ravel(self) -> DoubleDouble:
        return DoubleDouble(self.hi.ravel(), self.lo.ravel())

    def copy(self) -> DoubleDouble:
        return DoubleDouble(self.hi.copy(), self.lo.copy())

    def astype(self, kind: Any) -> Any:
        """Return an ordinary NumPy array of this type, rounded from the double-doubles."""
        return self.hi.astype(kind)

    def __getitem__(self, key: Any) -> DoubleDouble:
        return DoubleDouble(self.hi[key], self.lo[key])

    def __setitem__(self, key: Any, value: Any) -> None:
        self.hi[key], self.lo[key] = high_and_low(value)
        self.turn = self.angle = None

    def __len__(self) -> int:
        return len(self.hi)

    def __iter__(self) -> Iterator[DoubleDouble]:
        return (self[k] for k in range(len(self)))

    def __float__(self) -> float:
        return float(self.hi)

    def __int__(self) -> int:
        return int(self.hi)

    def __complex__(self) -> complex:
        return complex(self.hi)

    def __bool__(self) -> bool:
        return bool(self.hi)

    def __hash__(self) -> int:
        return hash(self.hi[()])

    def __format__(self, how: str) -> str:
        return format(self.hi[()], how)

    def __repr__(self) -> str:
        return f"DoubleDouble({self.hi!r}, {self.lo!r})"

    def __array__(self, *_: Any, **__: Any) -> Any:
        raise TypeError("as a plain array it would lose half of its digits; astype(float) rounds")

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **more: Any) -> Any:
        if any(isinstance(x, Dual) for x in inputs):
            return NotImplemented  # a dual number contains double-doubles, not the reverse
        implementation = UFUNCS.get(ufunc.__name__)
        if implementation is None or method != "__call__" or any(value is not None for value in more.values()):
            return NotImplemented
        return implementation(*inputs)

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        if Dual in types:
            return NotImplemented
        if function in FUNCTIONS:
            return FUNCTIONS[function](*args, **kwargs)
        if function in ROUNDED:
            return function(args[0].hi, *args[1:], **kwargs)
        if function not in ARRANGING:
            return NotImplemented
        hi, lo = (function(*_arguments_of_part(args, low), **kwargs) for low in (0, 1))
        if isinstance(hi, list | tuple):
            return type(hi)(DoubleDouble(*both) for both in zip(hi, lo, strict=True))
        return DoubleDouble(hi, lo)


def high_and_low(value: Any) -> Pair:
    """Return the high and low parts of an array. The low parts of an ordinary array are zero."""
    if isinstance(value, DoubleDouble):
        return value.hi, value.lo
    array = np.asarray(value)
    return array, np.zeros_like(array)


def _arguments_of_part(args: Any, part: int) -> Any:
    """Replace double-doubles among the arguments of a NumPy function by one of their parts.

    Args:
        args: arguments of a function that only rearranges numbers (stack, reshape, ...).
        part: 0 for the high parts, 1 for the low parts.
    """
    converted = []
    mixed = any(isinstance(arg, DoubleDouble) for arg in args)
    for arg in args:
        if isinstance(arg, tuple | list):
            converted.append(_arguments_of_part(arg, part))
        elif isinstance(arg, DoubleDouble):
            converted.append((arg.hi, arg.lo)[part])
        else:  # integers and booleans are indices or masks; other ordinary numbers have a zero low part
            number = mixed and part and np.asarray(arg).dtype.kind in "fc"
            converted.append(np.zeros_like(arg) if number else arg)
    return type(args)(converted)


def to_double_double(values: Any) -> Any:
    """Convert an ordinary array to double-doubles, without rounding. Double-doubles are returned unchanged."""
    return values if isinstance(values, DoubleDouble) else DoubleDouble(values)


def array(values: Any) -> Any:
    """Convert values to an array, as np.array does; the result is a DoubleDouble if any value is one."""
    if isinstance(values, DoubleDouble):
        return values
    if not isinstance(values, list | tuple):
        return np.asarray(values)
    elements = [array(value) if isinstance(value, list | tuple) else value for value in values]
    if any(isinstance(value, DoubleDouble) for value in elements):
        higher, lower = zip(*map(high_and_low, elements), strict=True)
        return DoubleDouble(np.array(higher), np.array(lower))
    return np.asarray(elements)


def to_float(values: Any) -> Any:
    """Round double-doubles to an ordinary NumPy array. Other values are returned unchanged."""
    return values.hi if isinstance(values, DoubleDouble) else values


def from_decimals(numbers: Sequence[Decimal]) -> DoubleDouble:
    """Convert decimal.Decimal numbers to the nearest double-doubles."""
    hi = [float(number) for number in numbers]
    lo = [EXACT.subtract(number, Decimal(h)) for number, h in zip(numbers, hi, strict=True)]
    return DoubleDouble(np.array(hi), np.array(lo, float))


# Sums, products, quotients and roots, each with a relative error below EPS.
#
# Exact sums: D. E. Knuth, The Art of Computer Programming 2, 4.2.2; exact products: T. J. Dekker, A floating-point
# technique for extending the available precision, Numer. Math. 18 (1971).


SPLIT = 2.0**27 + 1  # splits a double into two halves of 26 bits
LARGEST_POWER = 8  # largest exponent computed by multiplication


def two_sum(a: Any, b: Any) -> Pair:
    """Return the rounded sum a + b and its exact rounding error."""
    total = a + b
    other = total - a
    return total, (a - (total - other)) + (b - other)


def fast_two_sum(a: Any, b: Any) -> Pair:
    """Return the rounded sum a + b and its exact rounding error. Requires |a| >= |b|."""
    total = a + b
    return total, b - (total - a)


def two_product(a: Any, b: Any) -> Pair:
    """Return the rounded product of a and b and its exact rounding error. At most one of them may be complex."""
    product = a * b
    torn = SPLIT * a
    a1 = torn - (torn - a)
    torn = SPLIT * b
    b1 = torn - (torn - b)
    a2, b2 = a - a1, b - b1
    return product, ((a1 * b1 - product) + a1 * b2 + a2 * b1) + a2 * b2


def add(x: Any, y: Any) -> DoubleDouble:
    """Return x + y, where at least one of x and y is a double-double."""
    if not isinstance(y, DoubleDouble):
        x, y = y, x
    total, error = two_sum(y.hi, x.hi if isinstance(x, DoubleDouble) else x)
    if not isinstance(x, DoubleDouble):
        return DoubleDouble(*fast_two_sum(total, error + y.lo))
    lower, rest = two_sum(x.lo, y.lo)
    total, error = fast_two_sum(total, error + lower)
    return DoubleDouble(*fast_two_sum(total, error + rest))


def negative(x: DoubleDouble) -> DoubleDouble:
    """Return -x."""
    return DoubleDouble(-x.hi, -x.lo)


def subtract(x: Any, y: Any) -> DoubleDouble:
    """Return x - y, where at least one of x and y is a double-double."""
    return add(x, -y)


def multiply(x: Any, y: Any) -> DoubleDouble:
    """Return the product of x and y, real or complex, where at least one of them is a double-double."""
    if not isinstance(y, DoubleDouble):
        x, y = y, x
    if isinstance(x, DoubleDouble):
        first, rest = x.hi, x.hi * y.lo + x.lo * y.hi
    elif _is_exact_factor(x):
        return DoubleDouble(x * y.hi, x * y.lo)
    else:
        first, rest = np.asarray(x), x * y.lo
    second = y.hi
    if first.dtype.kind == "c" and second.dtype.kind == "c":
        first, second = (first, second) if first.ndim >= second.ndim else (second, first)
        products, errors = two_product(_real_and_imaginary(first), second)
        product, error = two_sum(products[0], 1j * products[1])
        error = error + (errors[0] + 1j * errors[1])
    else:
        product, error = two_product(first, second)
    return DoubleDouble(*fast_two_sum(product, error + rest))


def _is_exact_factor(x: Any) -> bool:
    """Return True if multiplication by x causes no rounding: x is a power of two, i or -i."""
    if isinstance(x, complex):
        return x in (1j, -1j)
    return isinstance(x, int | float) and abs(frexp(x)[0]) == 0.5


def _real_and_imaginary(values: Any) -> Any:
    """Stack the real and imaginary parts of complex numbers along a new first axis."""
    planes = np.empty((2, *values.shape))
    planes[0], planes[1] = values.real, values.imag
    return planes


def divide(x: Any, y: Any) -> DoubleDouble:
    """Return the quotient x / y, real or complex."""
    x, y = DoubleDouble(*high_and_low(x)), DoubleDouble(*high_and_low(y))
    if y.dtype.kind == "c":
        return divide(multiply(x, y.conjugate()), square(y))
    first = x.hi / y.hi
    product, error = two_product(first, y.hi)
    rest = (x.hi - product) - error + (x.lo - first * y.lo)
    return _keep_nonfinite(DoubleDouble(*fast_two_sum(first, rest / y.hi)), first)


def _keep_nonfinite(refined: DoubleDouble, plain: Any) -> DoubleDouble:
    """Return the double-double quotient or root `refined`, but the float64 one where that is infinite or nan."""
    sound = np.isfinite(plain)
    if sound.all():
        return refined
    return DoubleDouble(np.where(sound, refined.hi, plain), np.where(sound, refined.lo, 0.0))


def square(z: DoubleDouble) -> DoubleDouble:
    """Return the squared magnitude |z|^2 of complex numbers."""
    planes = _real_and_imaginary(z.hi)
    squares, errors = two_product(planes, planes)
    total, error = two_sum(squares[0], squares[1])
    rest = errors + 2 * planes * _real_and_imaginary(z.lo)
    return DoubleDouble(*fast_two_sum(total, error + (rest[0] + rest[1])))


def sqrt(x: DoubleDouble) -> DoubleDouble:
    """Return the square root, computed by one Newton step from the float64 root."""
    root = np.sqrt(x.hi)
    square, error = two_product(root, root)
    rest = (x.hi - square) - error + x.lo
    return _keep_nonfinite(DoubleDouble(*fast_two_sum(root, rest / np.where(root == 0, 1.0, 2 * root))), root)


def absolute(x: DoubleDouble) -> DoubleDouble:
    """Return the absolute value |x|, real or complex."""
    if x.dtype.kind == "c":
        return sqrt(square(x))
    sign = np.copysign(1.0, x.hi)
    return DoubleDouble(sign * x.hi, sign * x.lo)


def power(x: Any, n: Any) -> DoubleDouble:
    """Return x**n.

    The result has 31 digits if n is an integer with |n| <= LARGEST_POWER or n = 0.5, otherwise float64 accuracy.
    """
    x, number = to_double_double(x), float(n)
    if number == 0.5:
        return sqrt(x)
    if not number.is_integer() or abs(number) > LARGEST_POWER:
        return DoubleDouble(np.power(x.hi, number))
    product = reduce(multiply, [x] * int(abs(number))) if number else DoubleDouble(np.ones(np.shape(x)))
    return product if number >= 0 else divide(1.0, product)


def floor(x: DoubleDouble) -> DoubleDouble:
    """Return the largest integer not above x."""
    whole = np.floor(x.hi)
    return DoubleDouble(*fast_two_sum(whole, np.where(whole == x.hi, np.floor(x.lo), 0.0)))


def remainder(x: Any, y: Any) -> DoubleDouble:
    """Return the remainder x - y floor(x / y), as np.remainder does."""
    return subtract(x, multiply(floor(divide(x, y)), y))


# Directions and angles: sines, cosines and their inverses.


PI = "3.14159265358979323846264338327950288419716939937510582097494"
PARTS = 64  # of a full turn: tabulated directions for sines and cosines
POWERS, PRECISE = 9, 5  # number of terms of the series; those from PRECISE on are small enough for float64


def exp_i(x: DoubleDouble) -> DoubleDouble:
    """Return e^(i x): the nearest of PARTS tabulated directions, rotated by a power series of the remaining angle."""
    if x.turn is None:
        steps, directions, series = _trigonometric_tables()
        number = np.round(x.hi * (PARTS / (2 * np.pi)))
        product, error = two_product(number, steps[0])
        rest = DoubleDouble(*two_sum(x.hi - product, x.lo - error)) - number * steps[1]
        square = multiply(rest, rest)
        column = (slice(None), *(None,) * x.ndim)
        small: Any = 0.0
        for k in range(POWERS - 1, PRECISE - 1, -1):
            small = series[k].hi[column] + square.hi * small
        terms = DoubleDouble(small)
        for k in range(PRECISE - 1, -1, -1):
            power, less = series[k], multiply(square, terms)
            total, error = fast_two_sum(power.hi[column], less.hi)
            terms = DoubleDouble(*fast_two_sum(total, error + (power.lo[column] + less.lo)))
        sine = multiply(terms[1], rest)
        near = DoubleDouble(terms.hi[0] + 1j * sine.hi, terms.lo[0] + 1j * sine.lo)
        x.turn = multiply(directions[np.nan_to_num(number).astype(int) % PARTS], near)
    return x.turn


def arctan2(y: Any, x: Any) -> DoubleDouble:
    """Return the angle of the vector (x, y), rad.

    The float64 angle is corrected once: the correction is so small that it equals its sine.
    """
    y, x = DoubleDouble(*high_and_low(y)), DoubleDouble(*high_and_low(x))
    near = DoubleDouble(np.arctan2(y.hi, x.hi))
    direction, length = exp_i(near), np.hypot(y.hi, x.hi)
    left = subtract(multiply(y, direction.real), multiply(x, direction.imag)).hi
    return add(near, left / np.where(length == 0, 1.0, length))


def angle(z: DoubleDouble) -> DoubleDouble:
    """Return the angles of complex numbers, rad."""
    if z.angle is None:
        z.angle = arctan2(z.imag, z.real)
    return z.angle


@cache
def _trigonometric_tables() -> tuple[list[float], DoubleDouble, DoubleDouble]:
    """Compute the tables of `exp_i`.

    Returns:
        2 pi / PARTS as two doubles, the tabulated directions, and the series coefficients of cosine and sine.
    """
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
            series.append(from_decimals((even, odd)))
            even = -odd / (2 * k + 2)
    re, im = (from_decimals(column) for column in zip(*directions, strict=True))
    coefficients: Any = np.stack(series)
    return steps, DoubleDouble(re.hi + 1j * im.hi, re.lo + 1j * im.lo), coefficients
