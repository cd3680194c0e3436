"""Expressions whose leaves carry a symbol and a value, so that symbols, substituted numbers and result are one object.

A substitution therefore cannot show another formula than the symbols before it, and its rounded numbers can be checked
before they are printed.
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

FIGURES = 4  # of a result, and of what is put in if that does
MOST_FIGURES = 8  # of what is put in, where terms nearly cancel
EXACT = 15  # of what is compared, not printed
WHOLE = 7  # figures before the point that are written out
NOTHING = 1e-9  # of the largest term: a sum that is less is zero
CANCELLED = 1e-6  # of the largest term: a sum that is less, and has no digit in common with its numbers, is zero


class ExpressionOperators:
    """Operators that build expressions as on paper: 2 * a - b / c; nested sums and products are flattened."""

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
        own = self.factors if isinstance(self, Product) else (_as_expression(self),)
        return Product((*own, _as_expression(other)))

    def __rmul__(self, number: float) -> Product:
        return _as_expression(number) * _as_expression(self)

    def __truediv__(self, other: Expression | float) -> Quotient:
        return Quotient(_as_expression(self), _as_expression(other))

    def __rtruediv__(self, number: float) -> Quotient:
        return _as_expression(number) / _as_expression(self)

    def __pow__(self, over: int) -> PowerOf:
        return PowerOf(_as_expression(self), over)


@dataclass(frozen=True)
class Leaf(ExpressionOperators):
    """Quantity with its value in SI (radians for angles); no value is needed for symbols only.

    angle: print the value in degrees. of: expression substituted instead of the value, e.g. 2·π.
    """

    symbol: Symbol
    value: float = math.nan
    angle: bool = False
    of: Expression | None = None


@dataclass(frozen=True)
class Constant(ExpressionOperators):
    """Number written as it is, or as `text` (π)."""

    value: float
    text: str = ""


@dataclass(frozen=True)
class Sum(ExpressionOperators):
    """Sum of terms with their signs, +1 or -1."""

    terms: tuple[tuple[int, Expression], ...]


@dataclass(frozen=True)
class Product(ExpressionOperators):
    """Product of factors."""

    factors: tuple[Expression, ...]


@dataclass(frozen=True)
class Quotient(ExpressionOperators):
    """Fraction of two expressions."""

    over: Expression
    under: Expression


@dataclass(frozen=True)
class PowerOf(ExpressionOperators):
    """Power with an integer exponent `over`, or with `under` a root written as the exponent over/under."""

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
    """Computed quantity on a line of its own: name = symbols = numbers = result with its unit.

    result: computed value in SI, independent of the expression, so that a wrong formula is detected. unit: printed
    unit, degrees for angles. whole: an integer. most: significant figures of the result.
    """

    name: Symbol
    expression: Expression
    result: float
    unit: str = ""
    angle: bool = False
    whole: bool = False
    most: int = FIGURES

    def value(self, figures: int) -> float:
        """Return the expression with numbers of this many figures substituted, in the unit of the result."""
        found = evaluate(self.expression, figures)
        return math.degrees(found) if self.angle else found

    def printed(self) -> tuple[int, str]:
        """Return the figures of the substituted numbers and the result as text, consistent within its last digit.

        Raises:
            ValueError: The expression does not give the result with any number of figures.
        """
        result = math.degrees(self.result) if self.angle else self.result
        terms = largest_term(self.expression)
        terms = math.degrees(terms) if self.angle else terms
        shown = 0.0 if abs(result) <= NOTHING * terms else result
        cancelled = max(abs(result), abs(self.value(EXACT))) <= CANCELLED * terms
        if self.whole and self.value(MOST_FIGURES) == result:
            return MOST_FIGURES, str(round(result))
        for value in (shown, 0.0) if cancelled else (shown,):
            for own in range(self.most, 0, -1):
                text = format_fixed(value, own, terms)
                unit = last_digit_unit(text)
                for figures in range(FIGURES, MOST_FIGURES + 1):
                    if abs(self.value(figures) - float(text)) <= unit:
                        return figures, text
        raise ValueError(f"{self.name.name}: {self.value(MOST_FIGURES)} is not {result}")


def state_value(name: Symbol, value: float, unit: str) -> ComputedQuantity:
    """Return a quantity that is read off a plan: its symbol and its value."""
    return ComputedQuantity(name, Leaf(name, value), value, unit)


def sum_terms(terms: Iterable[Expression]) -> Sum:
    """Return the sum of the terms; nested sums are flattened."""
    return Sum(tuple(chain.from_iterable(map(_terms, terms))))


def apply_sign(sense: float, expression: Expression) -> Expression:
    """Return the expression, negated if `sense` is not positive."""
    return expression if sense > 0 else -expression


def _as_expression(part: object) -> Expression:
    if isinstance(part, Expression):
        return part
    assert isinstance(part, int | float)
    return Constant(part)


def _terms(part: object) -> tuple[tuple[int, Expression], ...]:
    own = _as_expression(part)
    return own.terms if isinstance(own, Sum) else ((1, own),)


def evaluate(expression: Expression, figures: int) -> float:
    """Evaluate an expression with each leaf rounded to this many significant figures."""
    of = partial(evaluate, figures=figures)
    match expression:
        case Leaf(_, value, angle, instead):
            if instead is not None:
                return of(instead)
            return math.radians(round_figures(math.degrees(value), figures)) if angle else round_figures(value, figures)
        case Constant(value):
            return value
        case Sum(terms):
            return math.fsum(sign * of(term) for sign, term in terms)
        case Product(factors):
            return math.prod(of(factor) for factor in factors)
        case Quotient(over, under):
            return of(over) / of(under)
        case PowerOf(base, over, under):
            return float(of(base) ** (over / under))
        case Function(name, argument):
            return FUNCTIONS[name](of(argument))


def largest_term(expression: Expression) -> float:
    """Return the magnitude of an expression without cancellation: largest term of a sum, 1 for sine and cosine.

    Rounding of the substituted numbers changes the value of the expression in proportion to this magnitude.
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
    """Return the formula of an expression in symbols."""
    return _build_formula(expression, lambda leaf: paper.Letter(leaf.symbol))


def numeric_formula(expression: Expression, figures: int, text: Callable[[str], str]) -> paper.Node:
    """Return the formula of an expression with numbers substituted; `text` writes figures in the language."""

    def number(leaf: Leaf) -> paper.Node:
        if leaf.of is not None:
            return numeric_formula(leaf.of, figures, text)
        value = math.degrees(leaf.value) if leaf.angle else leaf.value
        digits = format_plain(round_figures(value, figures), figures)
        shown = _number_formula(digits, text)
        if digits.startswith("-"):
            return paper.Brackets(shown)
        return paper.row(shown, paper.Words("°")) if leaf.angle else shown

    return _build_formula(expression, number)


def _number_formula(digits: str, text: Callable[[str], str]) -> paper.Node:
    """Return a number in scientific notation as a formula: -1.2e-5 gives −1.2·10^−5."""
    if digits.startswith("-"):
        return paper.row("−", _number_formula(digits[1:], text))
    mantissa, _, power = digits.partition("e")
    shown = paper.Number(text(mantissa))
    return paper.row(shown, "·", paper.Power(paper.Number("10"), _number_formula(power, text))) if power else shown


def _build_formula(expression: Expression, leaf: Callable[[Leaf], paper.Node]) -> paper.Node:
    of = partial(_build_formula, leaf=leaf)
    match expression:
        case Leaf():
            return leaf(expression)
        case Constant(value, text):
            return paper.Number(text or f"{value:g}")
        case Sum(terms):
            parts: list[paper.Node | str] = []
            for sign, term in terms:
                node = of(term)
                if not parts and sign > 0 and isinstance(term, Leaf) and isinstance(node, paper.Brackets):
                    node = node.inside  # a minus at the beginning
                parts += ["−"] if sign < 0 else ["+"] if parts else []
                parts.append(node)
            return paper.row(*parts) if parts else paper.Number("0")
        case Product(factors):
            shown: list[paper.Node | str] = []
            for factor in factors:
                shown += ["·"] if shown else []
                several = isinstance(factor, Sum) and len(factor.terms) > 1
                shown.append(paper.Brackets(of(factor)) if several else of(factor))
            return paper.row(*shown)
        case Quotient(over, under):
            return paper.Fraction(of(over), of(under))
        case PowerOf(base, over, under):
            node, power = of(base), paper.Number(str(over))
            if not isinstance(node, paper.Number | paper.Letter | paper.Brackets):
                node = paper.Brackets(node)
            return paper.Power(node, power if under == 1 else paper.Fraction(power, paper.Number(str(under))))
        case Function(name, argument):
            node = of(argument)
            if name == "sqrt":
                return paper.Root(node)
            if name == "abs":
                return paper.Brackets(node, bars=True)
            return paper.row(name, node if isinstance(argument, Leaf) else paper.Brackets(node))


def round_figures(value: float, figures: int) -> float:
    """Round to this many significant figures, but keep all digits before the point of numbers below 10^7."""
    text = f"{half_up(value):.{figures - 1}e}"
    return float(f"{half_up(value):.0f}") if figures <= int(text.partition("e")[2]) < WHOLE else float(text)


def format_fixed(value: float, figures: int, terms: float = 0.0) -> str:
    """Format a value with this many significant figures, keeping trailing zeros.

    terms: for a zero, magnitude of the terms that cancel; it sets the number of decimals.
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
    """Return the value of one unit in the last digit of a printed number."""
    mantissa, _, power = text.partition("e")
    return 10.0 ** (int(power or 0) - len(mantissa.partition(".")[2]))


def result_formula(text: str, unit: str, say: Callable[[str], str]) -> paper.Node:
    """Return the formula of a result with its unit."""
    shown = _number_formula(text, say)
    return paper.row(shown, paper.Words(unit if unit == "°" else f" {unit}")) if unit else shown


def formula(found: ComputedQuantity, say: Callable[[str], str]) -> paper.Node:
    """Return the line symbols = numbers = result of a computed quantity; `say` writes figures in the language.

    Raises:
        ValueError: The formula does not give the result.
    """
    figures, text = found.printed()
    own = found.expression
    plain = isinstance(own, Leaf)  # read off: what would be put in is the result
    put_in = () if plain else (symbolic_formula(own), numeric_formula(own, figures, say))
    return chain_of_equalities((paper.Letter(found.name), *put_in, result_formula(text, found.unit, say)))
