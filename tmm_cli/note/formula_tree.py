"""Formulas as trees of nodes, and the breaking of wide formulas into lines.

Each format of the note writes these trees in its own way. No format breaks wide formulas well by itself, so they are
broken before they are written.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from tmm_cli.mechanics.forces import Symbol


@dataclass(frozen=True)
class Number:
    """Number as it is printed in the language of the note."""

    text: str


@dataclass(frozen=True)
class Letter:
    """Symbol of a quantity.

    Attributes:
        symbol: letter with its indices.
        vector: True for a vector, which is printed with a bar above.
        lines: number of underlines of a vector: 2 if its magnitude and direction are known, 1 if only its line of
            action is known.
    """

    symbol: Symbol
    vector: bool = False
    lines: int = 0


@dataclass(frozen=True)
class Sign:
    """Operator or relation (+ − · = ∥ ⊥), or the name of a function."""

    text: str


@dataclass(frozen=True)
class Words:
    """Upright text in a formula: a unit, or the name of a group."""

    text: str


@dataclass(frozen=True)
class Row:
    """Nodes printed one after another."""

    nodes: tuple[Node, ...]


@dataclass(frozen=True)
class Fraction:
    """Fraction with the numerator `over` and the denominator `under`."""

    over: Node
    under: Node


@dataclass(frozen=True)
class Power:
    """Base with an exponent."""

    base: Node
    exponent: Node


@dataclass(frozen=True)
class Root:
    """Square root."""

    of: Node


@dataclass(frozen=True)
class Brackets:
    """Expression in round brackets.

    Attributes:
        inside: expression between the brackets.
        opens: False if the opening bracket stands on an earlier line of a broken formula.
        closes: False if the closing bracket stands on a later line.
        bars: True for the bars of an absolute value instead of round brackets.
    """

    inside: Node
    opens: bool = True
    closes: bool = True
    bars: bool = False


@dataclass(frozen=True)
class Lines:
    """Formula broken into lines. Each line but the first begins with an operator or an equals sign."""

    lines: tuple[Node, ...]


Node = Number | Letter | Sign | Words | Row | Fraction | Power | Root | Brackets | Lines


def row(*items: Node | str) -> Node:
    """Return nodes and operators as one row. A single node is returned unchanged."""
    nodes: list[Node] = []
    for node_or_sign in items:
        node = Sign(node_or_sign) if isinstance(node_or_sign, str) else node_or_sign
        nodes += node.nodes if isinstance(node, Row) else (node,)
    return nodes[0] if len(nodes) == 1 else Row(tuple(nodes))


LINE = 64.0  # width of the text of an A4 page, in widths of a digit of the widest usual font
SMALL = 0.75  # size of indices and exponents
SHORT = 9.0  # a narrower side of an equation, e.g. a symbol, has no line of its own
TERMS = (Sign("+"), Sign("−"))
BREAKS = (Sign("="), *TERMS)
OPEN, CLOSE = Sign("("), Sign(")")
OPENING = (Sign("="), OPEN, Sign("·"))  # a sign after these belongs to the number


def chain_of_equalities(sides: Sequence[Node], most: float = LINE) -> Node:
    """Join equal expressions by equals signs.

    Args:
        sides: equal expressions.
        most: greatest width of a line, in widths of a digit. A wider formula is broken before an equals sign or before
            the
            sign of a term.
    """
    lines: list[Node] = []
    for side in sides:
        joined = row(lines[-1], "=", side) if lines else side
        if not lines or width(joined) <= most:
            lines[-1:] = [joined]
        elif width(lines[-1]) < SHORT:
            lines[-1:] = _break_at_terms(joined, most)
        else:
            lines += _break_at_terms(row("=", side), most)
    lines = _fill_last_line(lines, most)
    return lines[0] if len(lines) == 1 else Lines(tuple(lines))


def width(node: Node) -> float:
    """Estimate the width of a formula, in widths of a digit."""
    match node:
        case Number(text) | Words(text):
            return float(len(text))
        case Letter(symbol):
            return 1.4 + SMALL * max(len(symbol.below), len(symbol.above))
        case Sign(text):
            return len(text) + 1.0 if text[0].isalpha() else 1.3 if text == "·" else 0.6 if text in "|()" else 2.2
        case Row(nodes):
            return sum(width(n) for n in nodes)
        case Fraction(over, under):
            return max(width(over), width(under)) + 0.5
        case Power(base, exponent):
            return width(base) + SMALL * width(exponent)
        case Root(radicand):
            return width(radicand) + 1.5
        case Brackets(inside):
            return width(inside) + 1.4
        case Lines(lines):
            return max(width(n) for n in lines)


def _fill_last_line(lines: list[Node], most: float) -> list[Node]:
    """Move a term or side of the equation to the last line of a formula if that line contains only a short result."""
    if len(lines) < 2 or width(lines[-1]) > 1.5 * SHORT or not isinstance(lines[-2], Row):
        return lines
    nodes = lines[-2].nodes
    breaks = [k for k, node in enumerate(nodes) if k > 1 and node in BREAKS and nodes[k - 1] not in OPENING]
    if not breaks or width(end := row(*nodes[breaks[-1] :], lines[-1])) > most:
        return lines
    return [*lines[:-2], row(*nodes[: breaks[-1]]), end]


def _break_at_terms(node: Node, most: float) -> list[Node]:
    """Break a row into lines. Each line but the first begins with the sign of a term."""
    if width(node) <= most or not isinstance(node, Row):
        return [node]
    lines: list[list[Node]] = [[]]
    for term in _split_terms(_unfold_wide_fractions(node.nodes, most)):
        if lines[-1] and width(Row((*lines[-1], *term))) > most:
            lines.append([])
        lines[-1] += term
    return [_group_brackets(line) for line in lines]


def _group_brackets(line: Sequence[Node]) -> Node:
    """Replace brackets and the nodes between them by one node.

    This is also done if only one of the two brackets is on this line of the formula.
    """
    first = line.index(OPEN) + 1 if OPEN in line else None
    last = line.index(CLOSE) if CLOSE in line else None
    if first is None and last is None:
        return row(*line)
    before, after = line[: first - 1] if first else (), line[last + 1 :] if last is not None else ()
    return row(*before, Brackets(row(*line[first:last]), first is not None, last is not None), *after)


def _split_terms(nodes: Sequence[Node]) -> list[list[Node]]:
    """Split a row of nodes into the terms of a sum, each with its sign."""
    terms: list[list[Node]] = [[]]
    for node in nodes:
        if node in TERMS and terms[-1] and terms[-1][-1] not in OPENING:
            terms.append([])
        terms[-1].append(node)
    return terms


def _unfold_wide_fractions(nodes: Sequence[Node], most: float) -> list[Node]:
    """Replace each fraction a/b that is too wide by (1/b)·(a)."""
    unfolded: list[Node] = []
    for node in nodes:
        if isinstance(node, Fraction) and isinstance(node.over, Row) and width(node) > most - 4:
            unfolded += [Fraction(Number("1"), node.under), Sign("·"), OPEN, *node.over.nodes, CLOSE]
        else:
            unfolded.append(node)
    return unfolded
