"""Numbers that vary from linkage to linkage, for code that builds one: they branch like numbers, and are written down.

Whatever is built of such numbers holds terms of a tape in their places; the checks and choices of the building code
are those of one linkage, the value.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from tmm_cli.tape.traced_array import DependsOnData, TracedArray


class TracedNumber(NDArrayOperatorsMixin):
    """A real or complex number: `value` for one linkage, `stand` for all.

    otherwise: where it is given, gets an array of truths for every choice of the building code: which stands would have
    chosen otherwise than the value did.
    """

    __hash__ = object.__hash__

    def __init__(self, value: Any, stand: Any, otherwise: list[Any] | None = None) -> None:
        self.value, self.stand, self.otherwise = value, stand, otherwise

    def __float__(self) -> float:
        if self.otherwise is not None:
            self.otherwise.append(self.stand != self.value)
        return float(self.value)

    def __bool__(self) -> bool:
        if self.otherwise is not None:
            self.otherwise.append((self.stand != 0) != bool(self.value))
        return bool(self.value)

    def __repr__(self) -> str:
        return repr(self.value)

    def __format__(self, how: str) -> str:
        return format(self.value, how)

    def __array__(self, *_: Any, **__: Any) -> Any:
        raise DependsOnData("an array is wanted that depends on the data")

    @property
    def real(self) -> TracedNumber:
        return TracedNumber(np.real(self.value), np.real(self.stand), self.otherwise)

    @property
    def imag(self) -> TracedNumber:
        return TracedNumber(np.imag(self.value), np.imag(self.stand), self.otherwise)

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **_: Any) -> Any:
        if method != "__call__" or ufunc is np.floor:  # what is whole for one linkage may not be so for another
            raise DependsOnData(f"{ufunc.__name__}, {method}, cannot be written on a tape")
        value = ufunc(*(_value(x) for x in inputs))
        otherwise = next((x.otherwise for x in inputs if isinstance(x, TracedNumber) and x.otherwise is not None), None)
        if isinstance(value, bool | np.bool_):
            if otherwise is not None:
                otherwise.append(ufunc(*(_stand(x) for x in inputs)) != bool(value))
            return bool(value)
        return TracedNumber(value, WRITTEN.get(ufunc, ufunc)(*(_stand(x) for x in inputs)), otherwise)

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        if function is not np.angle:
            raise DependsOnData(f"{function.__name__} cannot be written on a tape")
        return np.arctan2(self.imag, self.real)


def _value(x: Any) -> Any:
    return x.value if isinstance(x, TracedNumber) else x


def _stand(x: Any) -> Any:
    return x.stand if isinstance(x, TracedNumber) else x


def _power(base: Any, exponent: Any) -> Any:
    """Whole powers as products, halves by roots."""
    if isinstance(exponent, TracedArray) or 2 * exponent != int(2 * exponent):
        raise DependsOnData("such a power cannot be written on a tape")
    found, whole = 1.0, int(abs(exponent))
    for _ in range(whole):
        found = found * base
    if abs(exponent) != whole:
        found = found * np.sqrt(base)
    return 1 / found if exponent < 0 else found


WRITTEN = {
    np.power: _power,
    np.tan: lambda x: np.sin(x) / np.cos(x),
    np.arcsin: lambda x: np.arctan2(x, np.sqrt(1 - x * x)),
    np.arccos: lambda x: np.arctan2(np.sqrt(1 - x * x), x),
    np.arctan: lambda x: np.arctan2(x, 1.0),
    np.hypot: lambda x, y: np.sqrt(x * x + y * y),
}
