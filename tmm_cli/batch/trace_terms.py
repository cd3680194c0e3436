"""Traced operations on real numbers whose values are given later.

A term contains an operation and its operands, which are terms or plain numbers. The same operation on the
same operands is recorded once. Operations on plain numbers are evaluated immediately, so everything that
does not depend on the data (a link at rest, a zero coordinate) disappears. Negations are moved to the
result of products, where most of them cancel in the next sum.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np

Number = Any  # float, bool, or a NumPy scalar of any precision

UFUNCS: dict[str, Any] = {
    "sqrt": np.sqrt,
    "cos": np.cos,
    "sin": np.sin,
    "arctan2": np.arctan2,
    "minimum": np.minimum,
    "maximum": np.maximum,
    "add": np.add,
    "subtract": np.subtract,
    "multiply": np.multiply,
    "divide": np.true_divide,
    "negative": np.negative,
    "absolute": np.absolute,
    "sign": np.sign,
    "isfinite": np.isfinite,
    "floor": np.floor,
    "less": np.less,
    "less_equal": np.less_equal,
    "greater": np.greater,
    "greater_equal": np.greater_equal,
    "equal": np.equal,
    "not_equal": np.not_equal,
    "bitwise_and": np.logical_and,
    "bitwise_or": np.logical_or,
    "invert": np.logical_not,
    "logical_and": np.logical_and,
    "logical_or": np.logical_or,
    "logical_not": np.logical_not,
    "remainder": np.remainder,
    "rint": np.rint,
}
COMMUTATIVE = {
    "add",
    "multiply",
    "minimum",
    "maximum",
    "bitwise_and",
    "bitwise_or",
    "logical_and",
    "logical_or",
    "equal",
}
BOOLEAN_OPERATIONS = {
    "isfinite",
    "less",
    "less_equal",
    "greater",
    "greater_equal",
    "equal",
    "not_equal",
    "bitwise_and",
    "bitwise_or",
    "invert",
    "logical_and",
    "logical_or",
    "logical_not",
}


@dataclass(eq=False)
class Term:
    """Traced number, with one value for each variant and position.

    Attributes:
        number: index of the term in the trace.
        op: `input` (args: index of the input), `where`, `table` (args: argument, then the table), `call` (args:
            a function of whole arrays in a tuple, then its operands), or the name of a NumPy function.
        args: operands.
        axes: axes on which it depends (bit 1: variants, bit 2: positions).
        truth: True for a boolean.
    """

    number: int
    op: str
    args: tuple[Any, ...]
    axes: int
    truth: bool

    def __repr__(self) -> str:
        return f"<{self.op} {self.number}>"  # the default would print all operands recursively


@dataclass(repr=False)
class Trace:
    """Record of operations on numbers whose values are given later. Each operation is a term.

    Attributes:
        data: values of inputs that are already known. A condition that is true for all of them, or false for all of
            them, is evaluated while recording.
        terms: the terms, in the order in which they were recorded.
        written: terms by operation and operands.
        known: values of terms that depend on known inputs only; None for all others.
    """

    data: dict[int, Any] = field(default_factory=dict)
    terms: list[Term] = field(default_factory=list)
    written: dict[tuple[Any, ...], Term] = field(default_factory=dict)
    known: dict[int, Any] = field(default_factory=dict)

    def term(self, op: str, *args: Any, axes: int = 0, truth: bool = False) -> Term:
        """Return the term of an operation, and record it if it is new."""
        key = (op, *(("term", a.number) if isinstance(a, Term) else (type(a).__name__, a) for a in args))
        term = self.written.get(key)
        if term is None:
            for arg in args:
                axes |= arg.axes if isinstance(arg, Term) else 0
            term = Term(len(self.terms), op, args, axes, truth or op in BOOLEAN_OPERATIONS)
            self.terms.append(term)
            self.written[key] = term
        return term

    def apply(self, op: str, *args: Any) -> Any:
        """Apply an operation to terms and numbers.

        Returns:
            A number if the operation can be evaluated, else a term.
        """
        if not any(isinstance(a, Term) for a in args):
            return UFUNCS[op](*args)[()]
        simple: Any = SIMPLIFICATIONS.get(op)
        if simple is not None:
            simplified = simple(self, *args)
            if simplified is not None:
                return simplified
        if op in COMMUTATIVE:
            args = tuple(sorted(args, key=lambda a: (0, a.number) if isinstance(a, Term) else (1, 0)))
        return self.term(op, *args)

    def value(self, term: Term) -> Any:
        """Return the value of a term; None if it depends on an unknown input."""
        if term.number not in self.known:
            args = [self.value(a) if isinstance(a, Term) else a for a in term.args]
            if term.op == "input":
                known_value = self.data.get(term.args[0])
            elif any(a is None for a in args) or term.op in ("table", "call"):
                known_value = None
            else:
                with np.errstate(all="ignore"):
                    known_value = np.where(*args) if term.op == "where" else UFUNCS[term.op](*args)
            self.known[term.number] = known_value
        return self.known[term.number]

    def settle_condition(self, truth: Any) -> Any:
        """Return a condition as a bool if it has the same value for all known data, else the condition itself."""
        known_value = self.value(truth) if isinstance(truth, Term) else None
        return truth if known_value is None or np.any(known_value != known_value.flat[0]) else bool(known_value.flat[0])

    def where(self, truth: Any, chosen: Any, other: Any) -> Any:
        """Select one of two numbers by a condition, as np.where does."""
        truth = self.settle_condition(truth)
        if not isinstance(truth, Term):
            return chosen if truth else other
        if chosen is other or (not isinstance(chosen, Term) and not isinstance(other, Term) and chosen == other):
            return chosen
        both = [x.truth if isinstance(x, Term) else isinstance(x, (bool, np.bool_)) for x in (chosen, other)]
        return self.term("where", truth, chosen, other, truth=all(both))


def axes_of(value: Any) -> int:
    """Return the axes (bit 1: variants, bit 2: positions) on which an operand depends."""
    return value.axes if isinstance(value, Term) else 0


def is_number(value: Any, number: float) -> bool:
    """Return True if an operand is a plain number equal to `number`."""
    return not isinstance(value, Term) and bool(value == number)


def negated_operand(value: Any) -> Any:
    """Return the operand of a negation; None for any other operation."""
    return value.args[0] if isinstance(value, Term) and value.op == "negative" else None


def _add(trace: Trace, a: Any, b: Any) -> Any:
    if is_number(a, 0):
        return b
    if is_number(b, 0):
        return a
    if negated_operand(b) is not None:
        return trace.apply("subtract", a, negated_operand(b))
    if negated_operand(a) is not None:
        return trace.apply("subtract", b, negated_operand(a))
    return None


def _subtract(trace: Trace, a: Any, b: Any) -> Any:
    if is_number(b, 0):
        return a
    if is_number(a, 0):
        return trace.apply("negative", b)
    if a is b:
        return 0.0
    if negated_operand(b) is not None:
        return trace.apply("add", a, negated_operand(b))
    if negated_operand(a) is not None:
        return trace.apply("negative", trace.apply("add", negated_operand(a), b))
    return None


def _multiply(trace: Trace, a: Any, b: Any) -> Any:
    for factor, other in ((a, b), (b, a)):
        if is_number(factor, 0):
            return 0.0
        if is_number(factor, 1):
            return other
        if is_number(factor, -1):
            return trace.apply("negative", other)
        if negated_operand(factor) is not None:
            return trace.apply("negative", trace.apply("multiply", negated_operand(factor), other))
        if not isinstance(factor, Term) and factor < 0:
            return trace.apply("negative", trace.apply("multiply", -factor, other))
    return _group_factors(trace, a, b)


def _group_factors(trace: Trace, a: Any, b: Any) -> Any:
    """Simplify a product, or reorder it so that factors that depend on fewer axes are multiplied first.

    An axis is that of the variants or that of the positions.
    """
    for product, other in ((a, b), (b, a)):
        if (
            isinstance(product, Term)
            and isinstance(other, Term)
            and product.op == "divide"
            and product.args[1] is other
        ):
            return product.args[0]  # (x / y) y
    if isinstance(a, Term) and a is b and a.op == "absolute":
        return trace.apply("multiply", a.args[0], a.args[0])
    for product, other in ((a, b), (b, a)):
        if isinstance(product, Term) and product.op == "multiply" and axes_of(other) < product.axes:
            for x, factor in (product.args, product.args[::-1]):
                if (
                    axes_of(factor) < product.axes
                    and axes_of(x) == product.axes
                    and axes_of(factor) | axes_of(other) != x.axes
                ):
                    return trace.apply("multiply", x, trace.apply("multiply", factor, other))
    return None


def _sqrt(trace: Trace, a: Any) -> Any:
    return trace.apply("absolute", a.args[0]) if a.op == "multiply" and a.args[0] is a.args[1] else None


def _divide(trace: Trace, a: Any, b: Any) -> Any:
    if is_number(a, 0):
        return 0.0
    if is_number(b, 1):
        return a
    if isinstance(b, Term) and b.op == "multiply" and a in b.args:  # x / (x y)
        return trace.apply("divide", 1.0, b.args[1] if b.args[0] is a else b.args[0])
    for k, operand in enumerate((a, b)):
        if negated_operand(operand) is not None:
            return trace.apply(
                "negative", trace.apply("divide", *((operand.args[0], b) if k == 0 else (a, operand.args[0])))
            )
    return None


def _negative(trace: Trace, a: Any) -> Any:
    if a.op == "negative":
        return a.args[0]
    if a.op == "subtract":
        return trace.apply("subtract", a.args[1], a.args[0])
    return None


def _simplify_logic(settles: bool) -> Callable[[Trace, Any, Any], Any]:
    """Return a function that simplifies a logical operation with a known operand.

    settles: value of an operand that decides the result: False for `and`, True for `or`.
    """

    def joined(trace: Trace, a: Any, b: Any) -> Any:
        for operand, other in ((a, b), (b, a)):
            if not isinstance(operand, Term):
                return settles if bool(operand) == settles else other
        return a if a is b else None

    return joined


def _absolute(trace: Trace, a: Any) -> Any:
    return trace.apply("absolute", a.args[0]) if a.op == "negative" else a if a.op in ("absolute", "sqrt") else None


SIMPLIFICATIONS = {
    "add": _add,
    "subtract": _subtract,
    "multiply": _multiply,
    "divide": _divide,
    "negative": _negative,
    "absolute": _absolute,
    "sqrt": _sqrt,
    "bitwise_and": _simplify_logic(False),
    "logical_and": _simplify_logic(False),
    "bitwise_or": _simplify_logic(True),
    "logical_or": _simplify_logic(True),
}
