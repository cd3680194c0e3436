"""The number itself: a sum of two doubles in the place of an array; what it can do is in `functions`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from decimal import Context, Decimal
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

EPS = 2.0**-103  # a sum, product, quotient or root is off by less, in units of itself
EXACT = Context(prec=60)

Pair = tuple[Any, Any]

UFUNCS: dict[str, Callable[..., Any]] = {}  # NumPy's, by their names
FUNCTIONS: dict[Any, Callable[..., Any]] = {}  # others of NumPy that compute
ROUNDED = {np.shape, np.max, np.min, np.nanmax, np.nanmin, np.any, np.all, np.round, np.argmax}  # by the higher part
ARRANGING = {
    np.stack, np.concatenate, np.broadcast_to, np.broadcast_arrays, np.reshape, np.ravel, np.moveaxis, np.swapaxes,
    np.take_along_axis, np.atleast_1d, np.zeros_like, np.copy, np.nan_to_num, np.repeat,
}  # fmt: skip


class DoubleDouble(NDArrayOperatorsMixin):
    """hi + lo, arrays of one shape, real or complex; lo is at most half a unit of the last place of hi."""

    __slots__ = ("angle", "hi", "lo", "turn")

    def __init__(self, hi: Any, lo: Any = None) -> None:
        self.hi = np.asarray(hi)
        self.lo = np.zeros_like(self.hi) if lo is None else np.asarray(lo)
        self.turn: DoubleDouble | None = None  # e^(i x), once it was asked for
        self.angle: DoubleDouble | None = None  # of a complex number, likewise

    @classmethod
    def decimal(cls, written: str) -> DoubleDouble:
        """The number that decimals write. Raises decimal.InvalidOperation where they write none."""
        return of_decimals([EXACT.create_decimal(written)])[0]

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
        """Rounded to an array of plain numbers."""
        return self.hi.astype(kind)

    def __getitem__(self, key: Any) -> DoubleDouble:
        return DoubleDouble(self.hi[key], self.lo[key])

    def __setitem__(self, key: Any, value: Any) -> None:
        self.hi[key], self.lo[key] = parts(value)
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
        known = UFUNCS.get(ufunc.__name__)
        if known is None or method != "__call__" or any(value is not None for value in more.values()):
            return NotImplemented
        return known(*inputs)

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        if function in FUNCTIONS:
            return FUNCTIONS[function](*args, **kwargs)
        if function in ROUNDED:
            return function(args[0].hi, *args[1:], **kwargs)
        if function not in ARRANGING:
            return NotImplemented
        hi, lo = (function(*_each(args, part), **kwargs) for part in (0, 1))
        if isinstance(hi, list | tuple):
            return type(hi)(DoubleDouble(*both) for both in zip(hi, lo, strict=True))
        return DoubleDouble(hi, lo)


def parts(value: Any) -> Pair:
    """Higher and lower parts of an array of either kind."""
    if isinstance(value, DoubleDouble):
        return value.hi, value.lo
    array = np.asarray(value)
    return array, np.zeros_like(array)


def _each(args: Any, part: int) -> Any:
    """Arguments of a function that arranges numbers, with the higher (0) or the lower parts (1) of these."""
    found = []
    mixed = any(isinstance(arg, DoubleDouble) for arg in args)
    for arg in args:
        if isinstance(arg, tuple | list):
            found.append(_each(arg, part))
        elif isinstance(arg, DoubleDouble):
            found.append((arg.hi, arg.lo)[part])
        else:  # integers and truths say where, other plain numbers have no lower part
            number = mixed and part and np.asarray(arg).dtype.kind in "fc"
            found.append(np.zeros_like(arg) if number else arg)
    return type(args)(found)


def exactly(values: Any) -> Any:
    """Plain numbers as double-doubles, in the place of an array."""
    return values if isinstance(values, DoubleDouble) else DoubleDouble(values)


def array(values: Any) -> Any:
    """An array of numbers, of double-doubles where one of them is such."""
    if isinstance(values, DoubleDouble):
        return values
    if not isinstance(values, list | tuple):
        return np.asarray(values)
    found = [array(value) if isinstance(value, list | tuple) else value for value in values]
    if any(isinstance(value, DoubleDouble) for value in found):
        higher, lower = zip(*map(parts, found), strict=True)
        return DoubleDouble(np.array(higher), np.array(lower))
    return np.asarray(found)


def rounded(values: Any) -> Any:
    """Plain numbers of an array of either kind."""
    return values.hi if isinstance(values, DoubleDouble) else values


def of_decimals(numbers: Sequence[Decimal]) -> DoubleDouble:
    """The nearest numbers."""
    hi = [float(number) for number in numbers]
    lo = [EXACT.subtract(number, Decimal(h)) for number, h in zip(numbers, hi, strict=True)]
    return DoubleDouble(np.array(hi), np.array(lo, float))
