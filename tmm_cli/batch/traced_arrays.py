"""Placeholders for arrays and numbers. Operations on them are recorded in a trace.

The ordinary code of the stages runs once on placeholders, which yields the sequence of real operations for
this linkage. A complex number is recorded as two real ones; components known to be zero are not computed.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

from tmm_cli.batch.trace_program import TraceProgram
from tmm_cli.batch.trace_terms import UFUNCS, Term, Trace
from tmm_cli.mechanics.numerics import Dual


class DependsOnData(TypeError):  # noqa: N818 - what it says, not an error of somebody's
    """Raised while operations are traced, if the code needs a value that is not known yet.

    Such a value is a condition or a length that depends on the data of the variants.
    """


@dataclass(eq=False)
class TracedArray(NDArrayOperatorsMixin):
    """Placeholder for an array: a traced number with one value for each variant and position.

    Attributes:
        trace: the trace.
        re: real part, a term or a number.
        im: imaginary part; None for real numbers and conditions.
    """

    trace: Trace
    re: Any
    im: Any = None

    __hash__ = object.__hash__

    @property
    def shape(self) -> tuple[int, ...]:
        return (1,)

    @property
    def ndim(self) -> int:
        return 1

    @property
    def dtype(self) -> Any:
        return np.dtype(complex if self.im is not None else bool if _is_truth(self.re) else float)

    @property
    def real(self) -> TracedArray:
        return TracedArray(self.trace, self.re)

    @property
    def imag(self) -> TracedArray:
        return TracedArray(self.trace, 0.0 if self.im is None else self.im)

    def astype(self, _: Any) -> TracedArray:
        """Return self, since a trace has only one number type."""
        return self

    def conjugate(self) -> TracedArray:
        return self if self.im is None else TracedArray(self.trace, self.re, self.trace.apply("negative", self.im))

    def __bool__(self) -> bool:
        truth = self.trace.settle_condition(self.re)
        if self.im is None and not isinstance(truth, Term):
            return bool(truth)
        raise DependsOnData("a branch of the code depends on the data")

    def __float__(self) -> float:
        if self.im is None and not isinstance(self.re, Term):
            return float(self.re)
        raise DependsOnData("a number is needed that depends on the data")

    def __array__(self, *_: Any, **__: Any) -> Any:
        raise DependsOnData("an array is needed that depends on the data")

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **more: Any) -> Any:
        if any(isinstance(x, Dual) for x in inputs):
            return NotImplemented  # a dual number contains traced arrays, not the reverse
        if method != "__call__" or any(v is not None for v in more.values()):
            raise DependsOnData(f"{ufunc.__name__}.{method} cannot be traced")
        if ufunc is np.power and isinstance(inputs[1], int) and inputs[1] == 2:
            ufunc, inputs = np.multiply, (inputs[0], inputs[0])
        parts = [self._of(value) for value in inputs]
        operation = COMPLEX.get(ufunc.__name__)
        if operation is not None and any(im is not None for _, im in parts):
            return TracedArray(self.trace, *operation(self.trace, *parts))
        if ufunc.__name__ == "conjugate":
            return inputs[0]
        if ufunc.__name__ not in UFUNCS or any(im is not None for _, im in parts):
            raise DependsOnData(f"{ufunc.__name__} cannot be traced")
        return TracedArray(self.trace, self.trace.apply(ufunc.__name__, *(re for re, _ in parts)))

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        if Dual in types:
            return NotImplemented
        traced = FUNCTIONS.get(function)
        if traced is None or kwargs:
            raise DependsOnData(f"{function.__name__} cannot be traced")
        return traced(self, *args)

    def _of(self, value: Any) -> tuple[Any, Any]:
        """Return the real and the imaginary part of an operand.

        An ordinary array whose elements are all equal is treated as a single number.
        """
        if isinstance(value, TracedArray):
            return value.re, value.im
        array = np.asarray(value)
        number = array.ravel()[0] if array.size else 0.0
        if array.size > 1 and not np.all((array == number) | ((array != array) & (number != number))):
            raise DependsOnData("an array of different numbers cannot be traced")
        if array.dtype.kind == "c":
            return number.real, number.imag
        return (number if array.dtype.kind in "bf" else float(number)), None

    def where(self, truth: Any, chosen: Any, other: Any) -> TracedArray:
        truth, chosen, other = (self._of(v) for v in (truth, chosen, other))
        re = self.trace.where(truth[0], chosen[0], other[0])
        if chosen[1] is None and other[1] is None:
            return TracedArray(self.trace, re)
        return TracedArray(self.trace, re, self.trace.where(truth[0], _im(chosen), _im(other)))

    def called(self, function: Any, *operands: Any) -> TracedArray:
        """Record a function of whole real arrays as a single operation."""
        return TracedArray(self.trace, self.trace.term("call", (function,), *(self._of(x)[0] for x in operands)))

    def interp(self, x: Any, at: Any, values: Any) -> TracedArray:
        """Record linear interpolation in a table, as np.interp does."""
        table = (tuple(float(v) for v in at), tuple(float(v) for v in values))
        return TracedArray(self.trace, self.trace.term("table", self._of(x)[0], table))


def _is_truth(re: Any) -> bool:
    return re.truth if isinstance(re, Term) else isinstance(re, (bool, np.bool_))


def _im(operand: tuple[Any, Any]) -> Any:
    return 0.0 if operand[1] is None else operand[1]


ComplexParts = tuple[Any, Any]


def _componentwise(op: str) -> Callable[[Trace, ComplexParts, ComplexParts], ComplexParts]:
    return lambda trace, a, b: (trace.apply(op, a[0], b[0]), trace.apply(op, _im(a), _im(b)))


def _product(trace: Trace, a: ComplexParts, b: ComplexParts) -> ComplexParts:
    def times(x: Any, y: Any) -> Any:
        return trace.apply("multiply", x, y)

    if a[1] is None or b[1] is None:
        (x, _), (re, im) = (a, b) if a[1] is None else (b, a)
        return times(x, re), times(x, im)
    return (
        trace.apply("subtract", times(a[0], b[0]), times(a[1], b[1])),
        trace.apply("add", times(a[0], b[1]), times(a[1], b[0])),
    )


def _quotient(trace: Trace, a: ComplexParts, b: ComplexParts) -> ComplexParts:
    if b[1] is None:
        return trace.apply("divide", a[0], b[0]), trace.apply("divide", a[1], b[0])
    square = _square(trace, b)
    re, im = _product(trace, a if a[1] is not None else (a[0], 0.0), (b[0], trace.apply("negative", b[1])))
    return trace.apply("divide", re, square), trace.apply("divide", im, square)


def _square(trace: Trace, a: ComplexParts) -> Any:
    return trace.apply("add", *(trace.apply("multiply", x, x) for x in a))


def _compare_parts(trace: Trace, op: str, joined: str, a: ComplexParts, b: ComplexParts) -> Any:
    return trace.apply(joined, trace.apply(op, a[0], b[0]), trace.apply(op, _im(a), _im(b)))


COMPLEX: dict[str, Callable[..., ComplexParts]] = {
    "add": _componentwise("add"),
    "subtract": _componentwise("subtract"),
    "multiply": _product,
    "divide": _quotient,
    "negative": lambda trace, a: (trace.apply("negative", a[0]), trace.apply("negative", a[1])),
    "positive": lambda trace, a: a,
    "conjugate": lambda trace, a: (a[0], trace.apply("negative", a[1])),
    "absolute": lambda trace, a: (trace.apply("sqrt", _square(trace, a)), None),
    "equal": lambda trace, a, b: (_compare_parts(trace, "equal", "bitwise_and", a, b), None),
    "not_equal": lambda trace, a, b: (_compare_parts(trace, "not_equal", "bitwise_or", a, b), None),
    "isfinite": lambda trace, a: (
        trace.apply("bitwise_and", trace.apply("isfinite", a[0]), trace.apply("isfinite", a[1])),
        None,
    ),
}

FUNCTIONS: dict[Any, Callable[..., Any]] = {
    np.where: TracedArray.where,
    np.shape: lambda placeholder, value: value.shape,
    np.atleast_1d: lambda placeholder, value: value,
    np.iscomplexobj: lambda placeholder, value: value.im is not None,
    np.real: lambda placeholder, value: value.real,
    np.imag: lambda placeholder, value: value.imag,
    np.angle: lambda placeholder, value: np.arctan2(value.imag, value.real),
    np.interp: TracedArray.interp,
    np.round: lambda placeholder, value: np.rint(value),
    np.any: lambda placeholder, value: isinstance(value.re, Term) or bool(value.re),  # it may be true for some variant
}


def trace_function(
    function: Callable[..., Mapping[str, Any]], *axes: int, data: Mapping[int, Any] | None = None
) -> TraceProgram:
    """Run a function on placeholders for real arrays and return its operations as a program.

    Args:
        function: function that returns outputs by name.
        axes: for each argument, 1 if it depends on the variant, 2 on the position, 3 on both.
        data: values of some arguments by index, if the program is needed for these values only.

    Raises:
        DependsOnData: the code branches on numbers that differ.
    """
    trace = Trace(dict(data or {}))
    placeholders = [TracedArray(trace, trace.term("input", k, axes=axis)) for k, axis in enumerate(axes)]
    outputs = {}
    for name, value in function(*placeholders).items():
        if isinstance(value, TracedArray):
            outputs[name] = (value.re, value.im)
        else:
            number = np.ravel(value)[0]
            outputs[name] = (number.real, number.imag) if np.iscomplexobj(number) else (number, None)
    return TraceProgram(tuple(trace.terms), axes, outputs)


# Numbers that vary between linkages, for code that builds a linkage.


class TracedNumber(NDArrayOperatorsMixin):
    """Real or complex number that differs between linkages.

    Code that builds a linkage branches by the number of one linkage, while all its operations are recorded.

    Attributes:
        value: number of one linkage.
        placeholder: placeholder for the numbers of all linkages.
        otherwise: list to which each branch appends a mask of the variants that would have branched
            differently; None if this is not needed.
    """

    __hash__ = object.__hash__

    def __init__(self, value: Any, placeholder: Any, otherwise: list[Any] | None = None) -> None:
        self.value, self.placeholder, self.otherwise = value, placeholder, otherwise

    def __float__(self) -> float:
        if self.otherwise is not None:
            self.otherwise.append(self.placeholder != self.value)
        return float(self.value)

    def __bool__(self) -> bool:
        if self.otherwise is not None:
            self.otherwise.append((self.placeholder != 0) != bool(self.value))
        return bool(self.value)

    def __repr__(self) -> str:
        return repr(self.value)

    def __format__(self, how: str) -> str:
        return format(self.value, how)

    def __array__(self, *_: Any, **__: Any) -> Any:
        raise DependsOnData("an array is needed that depends on the data")

    @property
    def real(self) -> TracedNumber:
        return TracedNumber(np.real(self.value), np.real(self.placeholder), self.otherwise)

    @property
    def imag(self) -> TracedNumber:
        return TracedNumber(np.imag(self.value), np.imag(self.placeholder), self.otherwise)

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **_: Any) -> Any:
        if method != "__call__" or ufunc is np.floor:  # an integer for one linkage may not be one for another
            raise DependsOnData(f"{ufunc.__name__}, {method}, cannot be traced")
        value = ufunc(*(_value(x) for x in inputs))
        otherwise = next((x.otherwise for x in inputs if isinstance(x, TracedNumber) and x.otherwise is not None), None)
        if isinstance(value, bool | np.bool_):
            if otherwise is not None:
                otherwise.append(ufunc(*(_placeholder(x) for x in inputs)) != bool(value))
            return bool(value)
        return TracedNumber(value, TRACEABLE_FORMS.get(ufunc, ufunc)(*(_placeholder(x) for x in inputs)), otherwise)

    def __array_function__(self, function: Any, types: Any, args: Any, kwargs: Any) -> Any:
        if function is not np.angle:
            raise DependsOnData(f"{function.__name__} cannot be traced")
        return np.arctan2(self.imag, self.real)


def _value(x: Any) -> Any:
    return x.value if isinstance(x, TracedNumber) else x


def _placeholder(x: Any) -> Any:
    return x.placeholder if isinstance(x, TracedNumber) else x


def _power(base: Any, exponent: Any) -> Any:
    """Compute a power by products and, for half powers, a square root."""
    if isinstance(exponent, TracedArray) or 2 * exponent != int(2 * exponent):
        raise DependsOnData("a power other than an integer or half-integer one cannot be traced")
    product, whole = 1.0, int(abs(exponent))
    for _ in range(whole):
        product = product * base
    if abs(exponent) != whole:
        product = product * np.sqrt(base)
    return 1 / product if exponent < 0 else product


TRACEABLE_FORMS = {
    np.power: _power,
    np.tan: lambda x: np.sin(x) / np.cos(x),
    np.arcsin: lambda x: np.arctan2(x, np.sqrt(1 - x * x)),
    np.arccos: lambda x: np.arctan2(np.sqrt(1 - x * x), x),
    np.arctan: lambda x: np.arctan2(x, 1.0),
    np.hypot: lambda x, y: np.sqrt(x * x + y * y),
}
