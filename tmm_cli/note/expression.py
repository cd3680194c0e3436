"""Expressions made of quantities that have both a symbol and a value.

One expression gives the formula in symbols, the formula with numbers and the result. The substitution therefore cannot
differ from the symbols before it, and its rounded numbers are checked against the result before they are printed.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from itertools import chain

from tmm_cli.language import half_up
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.note import formula_tree as paper
from tmm_cli.note.formula_tree import chain_of_equalities

FIGURES = 4  # of a result, and of the substituted numbers if that suffices
MOST_FIGURES = 8  # of the substituted numbers, where terms nearly cancel
EXACT = 15  # for values that are compared and not printed
WHOLE = 7  # digits before the point, with more a number is in scientific notation
NOTHING = 1e-9  # fraction of the largest term below which a sum is zero
CANCELLED = 1e-6  # same for a sum whose digits the substituted numbers do not give


class ExpressionOperators:
    """Arithmetic operators that build expressions, e.g. 2 * a - b / c. Nested sums and products are flattened."""

    def __add__(self, other: Expression | float) -> Sum:
        return Sum((*_terms(self), *_terms(other)))

    def __radd__(self, number: float) -> Sum:
        return _as_expression(number) + _as_expression(self)

    def __sub__(self, other: Expression | float) -> Sum:
        return Sum((*_terms(self), *_terms(-_as_expression(other))))

    def __rsub__(self, number: float) -> Sum:
        return _as_expression(number) - _as_expression(self)

    def __neg__(self) -> Sum:
        return Sum(tuple((-sign, term) for sign, term in _terms(self)))

    def __mul__(self, other: Expression | float) -> Product:
        factors = self.factors if isinstance(self, Product) else (_as_expression(self),)
        return Product((*factors, _as_expression(other)))

    def __rmul__(self, number: float) -> Product:
        return _as_expression(number) * _as_expression(self)

    def __truediv__(self, other: Expression | float) -> Quotient:
        return Quotient(_as_expression(self), _as_expression(other))

    def __rtruediv__(self, number: float) -> Quotient:
        return _as_expression(number) / _as_expression(self)

    def __abs__(self) -> Function:
        return Function("abs", _as_expression(self))

    def __pow__(self, over: int) -> PowerOf:
        return PowerOf(_as_expression(self), over)


@dataclass(frozen=True)
class Leaf(ExpressionOperators):
    """Quantity in an expression, with its symbol and its value.

    Attributes:
        symbol: symbol of the quantity.
        value: value in SI, or in rad for angles; nan if the expression is only printed in symbols.
        angle: True if the value is printed in degrees.
        of: expression that is printed instead of the value, e.g. 2·π; None to print the value.
    """

    symbol: Symbol
    value: float = math.nan
    angle: bool = False
    of: Expression | None = None


@dataclass(frozen=True)
class Constant(ExpressionOperators):
    """Number in a formula. If `text` is given, it is printed instead of the number (π)."""

    value: float
    text: str = ""


@dataclass(frozen=True)
class Sum(ExpressionOperators):
    """Sum of terms, each with its sign, +1 or -1."""

    terms: tuple[tuple[int, Expression], ...]


@dataclass(frozen=True)
class Product(ExpressionOperators):
    """Product of factors."""

    factors: tuple[Expression, ...]


@dataclass(frozen=True)
class Quotient(ExpressionOperators):
    """Fraction with the numerator `over` and the denominator `under`."""

    over: Expression
    under: Expression


@dataclass(frozen=True)
class PowerOf(ExpressionOperators):
    """Power of an expression with the exponent over/under, e.g. 1/5 for a fifth root."""

    of: Expression
    over: int
    under: int = 1


@dataclass(frozen=True)
class Function(ExpressionOperators):
    """Function of an expression: cos, sin, sqrt or abs."""

    name: str
    of: Expression


Expression = Leaf | Constant | Sum | Product | Quotient | PowerOf | Function
FUNCTIONS: dict[str, Callable[[float], float]] = {
    "cos": math.cos,
    "sin": math.sin,
    "abs": abs,
    "sqrt": lambda value: math.sqrt(max(value, 0.0)),
}


@dataclass(frozen=True)
class ComputedQuantity:
    """Line of a calculation: name = formula in symbols = formula with numbers = result.

    Attributes:
        name: symbol of the computed quantity.
        expression: formula by which the note explains the quantity.
        result: computed value in SI. It does not come from the expression, so that a wrong formula is detected.
        unit: printed unit; ° for an angle.
        angle: True if the result is an angle (rad), which is printed in degrees.
        whole: True if the result is an integer.
        most: greatest number of significant figures of the result.
    """

    name: Symbol
    expression: Expression
    result: float
    unit: str = ""
    angle: bool = False
    whole: bool = False
    most: int = FIGURES

    def value(self, figures: int) -> float:
        """Evaluate the expression with its numbers rounded to `figures` significant figures. Angles are in degrees."""
        number = evaluate(self.expression, figures)
        return math.degrees(number) if self.angle else number

    def printed(self) -> tuple[int, str]:
        """Choose the rounding of the substituted numbers and of the result so that the printed line is correct.

        Returns:
            The number of significant figures of the substituted numbers, and the result as text. With these numbers the
                formula
            gives this result to within one unit of its last digit.

        Raises:
            ValueError: The expression does not give the result, however many figures are printed.
        """
        result = math.degrees(self.result) if self.angle else self.result
        terms = largest_term(self.expression)
        terms = math.degrees(terms) if self.angle else terms
        significant = 0.0 if abs(result) <= NOTHING * terms else result
        cancelled = max(abs(result), abs(self.value(EXACT))) <= CANCELLED * terms
        if self.whole and self.value(MOST_FIGURES) == result:
            return MOST_FIGURES, str(round(result))
        for value in (significant, 0.0) if cancelled else (significant,):
            for digits in range(self.most, 0, -1):
                text = format_fixed(value, digits, terms)
                unit = last_digit_unit(text)
                for figures in range(FIGURES, MOST_FIGURES + 1):
                    if abs(self.value(figures) - float(text)) <= unit:
                        return figures, text
        raise ValueError(f"{self.name.name}: {self.value(MOST_FIGURES)} is not {result}")


def state_value(name: Symbol, value: float, unit: str) -> ComputedQuantity:
    """Return a quantity that is printed with its value but without a formula, e.g. because it is measured on a plan."""
    return ComputedQuantity(name, Leaf(name, value), value, unit)


def sum_terms(terms: Iterable[Expression]) -> Sum:
    """Return the sum of the terms. Nested sums are flattened."""
    return Sum(tuple(chain.from_iterable(map(_terms, terms))))


def apply_sign(sense: float, expression: Expression) -> Expression:
    """Return the expression if `sense` is positive, otherwise its negative."""
    return expression if sense > 0 else -expression


def _as_expression(operand: object) -> Expression:
    if isinstance(operand, Expression):
        return operand
    assert isinstance(operand, int | float)
    return Constant(operand)


def _terms(operand: object) -> tuple[tuple[int, Expression], ...]:
    expression = _as_expression(operand)
    return expression.terms if isinstance(expression, Sum) else ((1, expression),)


def evaluate(expression: Expression, figures: int) -> float:
    """Evaluate an expression with the value of each quantity rounded to `figures` significant figures."""
    evaluate_part = partial(evaluate, figures=figures)
    match expression:
        case Leaf(_, value, angle, instead):
            if instead is not None:
                return evaluate_part(instead)
            return math.radians(round_figures(math.degrees(value), figures)) if angle else round_figures(value, figures)
        case Constant(value):
            return value
        case Sum(terms):
            return math.fsum(sign * evaluate_part(term) for sign, term in terms)
        case Product(factors):
            return math.prod(evaluate_part(factor) for factor in factors)
        case Quotient(over, under):
            return evaluate_part(over) / evaluate_part(under)
        case PowerOf(base, over, under):
            return float(evaluate_part(base) ** (over / under))
        case Function(name, argument):
            return FUNCTIONS[name](evaluate_part(argument))


def largest_term(expression: Expression) -> float:
    """Return the magnitude that an expression would have without cancellation.

    For a sum this is the magnitude of its largest term, for a sine or cosine 1. Rounding of the substituted numbers
    changes the value of the expression in proportion to this magnitude.
    """
    match expression:
        case Sum(terms):
            return max((largest_term(term) for _, term in terms), default=0.0)
        case Product(factors):
            return math.prod(largest_term(factor) for factor in factors)
        case Quotient(over, under):
            divisor = abs(evaluate(under, EXACT))
            return largest_term(over) / divisor if divisor else 0.0
        case PowerOf(base, over, under):
            return float(largest_term(base) ** (over / under)) if over > 0 else abs(evaluate(expression, EXACT))
        case Function("cos" | "sin"):
            return 1.0
        case Function(name, argument):
            return FUNCTIONS[name](largest_term(argument))
        case _:
            return abs(evaluate(expression, EXACT))


def symbolic_formula(expression: Expression) -> paper.Node:
    """Return an expression as a formula in symbols."""
    return _build_formula(expression, lambda leaf: paper.Letter(leaf.symbol))


def numeric_formula(expression: Expression, figures: int, text: Callable[[str], str]) -> paper.Node:
    """Return an expression as a formula with numbers substituted.

    Args:
        expression: expression to print.
        figures: significant figures of each number.
        text: function that writes a number in the style of the language.
    """

    def number(leaf: Leaf) -> paper.Node:
        if leaf.of is not None:
            return numeric_formula(leaf.of, figures, text)
        value = math.degrees(leaf.value) if leaf.angle else leaf.value
        digits = format_plain(round_figures(value, figures), figures)
        node = _number_formula(digits, text)
        if digits.startswith("-"):
            return paper.Brackets(node)
        return paper.row(node, paper.Words("°")) if leaf.angle else node

    return _build_formula(expression, number)


def _number_formula(digits: str, text: Callable[[str], str]) -> paper.Node:
    """Return a number as a formula; scientific notation becomes a power of ten: -1.2e-5 gives −1.2·10^−5."""
    if digits.startswith("-"):
        return paper.row("−", _number_formula(digits[1:], text))
    mantissa, _, power = digits.partition("e")
    node = paper.Number(text(mantissa))
    return paper.row(node, "·", paper.Power(paper.Number("10"), _number_formula(power, text))) if power else node


def _build_formula(expression: Expression, leaf: Callable[[Leaf], paper.Node]) -> paper.Node:
    build = partial(_build_formula, leaf=leaf)
    match expression:
        case Leaf():
            return leaf(expression)
        case Constant(value, text):
            return paper.Number(text or f"{value:g}")
        case Sum(terms):
            parts: list[paper.Node | str] = []
            for sign, term in terms:
                node = build(term)
                if not parts and sign > 0 and isinstance(term, Leaf) and isinstance(node, paper.Brackets):
                    node = node.inside  # a negative first number needs no brackets
                parts += ["−"] if sign < 0 else ["+"] if parts else []
                parts.append(node)
            return paper.row(*parts) if parts else paper.Number("0")
        case Product(factors):
            nodes: list[paper.Node | str] = []
            for factor in factors:
                nodes += ["·"] if nodes else []
                several = isinstance(factor, Sum) and len(factor.terms) > 1
                nodes.append(paper.Brackets(build(factor)) if several else build(factor))
            return paper.row(*nodes)
        case Quotient(over, under):
            return paper.Fraction(build(over), build(under))
        case PowerOf(base, over, under):
            node, power = build(base), paper.Number(str(over))
            if not isinstance(node, paper.Number | paper.Letter | paper.Brackets):
                node = paper.Brackets(node)
            return paper.Power(node, power if under == 1 else paper.Fraction(power, paper.Number(str(under))))
        case Function(name, argument):
            node = build(argument)
            if name == "sqrt":
                return paper.Root(node)
            if name == "abs":
                if isinstance(argument, Leaf) and isinstance(node, paper.Brackets):
                    node = node.inside  # a negative number needs no brackets between the bars
                return paper.Brackets(node, bars=True)
            return paper.row(name, node if isinstance(argument, Leaf) else paper.Brackets(node))


def round_figures(value: float, figures: int) -> float:
    """Round to `figures` significant figures. In numbers below 10^7 no digit before the decimal point is lost."""
    text = f"{half_up(value):.{figures - 1}e}"
    return float(f"{half_up(value):.0f}") if figures <= int(text.partition("e")[2]) < WHOLE else float(text)


def format_fixed(value: float, figures: int, terms: float = 0.0) -> str:
    """Format a value with a fixed number of significant figures, trailing zeros included.

    Args:
        value: value to format.
        figures: number of significant figures.
        terms: used only if the value is zero: magnitude of the terms whose sum is zero. It sets the number of decimals.
    """
    if value == 0:
        return "0" if not terms else f"{0.0:.{max(figures - 1 - math.floor(math.log10(terms)), 0)}f}"
    power = math.floor(math.log10(abs(round_figures(value, figures))))
    if -4 <= power < WHOLE:
        return f"{half_up(value):.{max(figures - 1 - power, 0)}f}"
    mantissa, _, exponent = f"{half_up(value):.{figures - 1}e}".partition("e")
    return f"{mantissa}e{int(exponent)}"


def format_plain(value: float, figures: int) -> str:
    """Format a value without trailing zeros: 1234.5, 0.00123, 1.2e-5."""
    mantissa, *power = format_fixed(value, figures).split("e")
    return "e".join((mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa, *power))


def last_digit_unit(text: str) -> float:
    """Return one unit in the last digit of a printed number: 0.01 for 3.14."""
    mantissa, _, power = text.partition("e")
    return 10.0 ** (int(power or 0) - len(mantissa.partition(".")[2]))


def result_formula(text: str, unit: str, say: Callable[[str], str]) -> paper.Node:
    """Return a printed result with its unit as a formula."""
    node = _number_formula(text, say)
    return paper.row(node, paper.Words(unit if unit == "°" else f" {unit}")) if unit else node


def formula(quantity: ComputedQuantity, say: Callable[[str], str]) -> paper.Node:
    """Return the printed line of a computed quantity: name = symbols = numbers = result.

    Args:
        quantity: computed quantity.
        say: function that writes a number in the style of the language.

    Raises:
        ValueError: The expression does not give the result.
    """
    figures, text = quantity.printed()
    expression = quantity.expression
    stated = isinstance(expression, Leaf)  # stated without a formula: a substitution would only repeat the result
    put_in = () if stated else (symbolic_formula(expression), numeric_formula(expression, figures, say))
    return chain_of_equalities((paper.Letter(quantity.name), *put_in, result_formula(text, quantity.unit, say)))
