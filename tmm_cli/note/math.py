"""Formulas as they stand on paper: a tree of few kinds of nodes, which each format of the note writes."""

from __future__ import annotations

from dataclasses import dataclass

from tmm_cli.mechanics.forces import Symbol


@dataclass(frozen=True)
class Number:
    """Figures as they are printed, in the language of the note."""

    text: str


@dataclass(frozen=True)
class Letter:
    """A quantity, by its letter with indices. lines: under a vector, two of one known whole, one of a known line."""

    symbol: Symbol
    vector: bool = False
    lines: int = 0


@dataclass(frozen=True)
class Sign:
    """What stands between: + − · = ∥ ⊥, or a name of a function."""

    text: str


@dataclass(frozen=True)
class Words:
    """Upright text in a formula: a unit, a name of a group."""

    text: str


@dataclass(frozen=True)
class Row:
    """Nodes one after another."""

    nodes: tuple[Node, ...]


@dataclass(frozen=True)
class Fraction:
    """One over another."""

    over: Node
    under: Node


@dataclass(frozen=True)
class Power:
    """A base with an exponent."""

    base: Node
    exponent: Node


@dataclass(frozen=True)
class Root:
    """A square root."""

    of: Node


@dataclass(frozen=True)
class Brackets:
    """Round brackets as high as what is in them; in a broken formula the other one may stand on another line.

    bars: straight ones, of a size.
    """

    inside: Node
    opens: bool = True
    closes: bool = True
    bars: bool = False


@dataclass(frozen=True)
class Lines:
    """A formula that is too wide for one line, broken before a sign."""

    lines: tuple[Node, ...]


Node = Number | Letter | Sign | Words | Row | Fraction | Power | Root | Brackets | Lines


def row(*parts: Node | str) -> Node:
    """Nodes and signs in a row; a single one is itself."""
    nodes: list[Node] = []
    for part in parts:
        node = Sign(part) if isinstance(part, str) else part
        nodes += node.nodes if isinstance(node, Row) else (node,)
    return nodes[0] if len(nodes) == 1 else Row(tuple(nodes))
