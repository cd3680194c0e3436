"""Interface of the presentation of load elements, which every kind of element implements."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.elements.element import LoadElement
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.problem import Problem
from tmm_cli.reports.table import Table

if TYPE_CHECKING:
    from tmm_cli.drawing.paper import DrawingSheet

ELEMENT_COLOUR = "#5f3b8a"

Element = TypeVar("Element", bound=LoadElement)
MakeLeaf = Callable[[Symbol, float], Any]


@dataclass(frozen=True)
class ElementLaw:
    """Formula for the force or moment of a load element in one position, for the note.

    Attributes:
        sentence: explanation; {name} is the symbol of the force or moment, the other fields are in `symbols`.
        symbols: symbols that the sentence names.
        pull: force or moment with its sign, as an expression of symbols with the operations + - * and abs().
    """

    sentence: str
    symbols: Mapping[str, Symbol]
    pull: Any


class ElementView(ABC, Generic[Element]):
    """Presentation of one kind of load element in tables, warnings, notes and drawings."""

    @abstractmethod
    def table(self, problem: Problem, elements: Sequence[Element]) -> Table:
        """Return the table of the elements of a file."""

    def warnings(self, results: Results, elements: Sequence[Element]) -> Iterable[str]:
        """Yield the warnings about results of a file with these elements."""
        return ()

    @abstractmethod
    def law(self, element: Element, size: float, rate: float, leaf: MakeLeaf) -> ElementLaw:
        """Return the formula for the force or moment of an element in one position.

        Args:
            element: the element.
            size: its length (m) or angle (rad) in the position; see `Stretch`.
            rate: time derivative of `size`.
            leaf: function that makes an operand of the formula from a symbol and its value.
        """

    @abstractmethod
    def draw_linear(self, sheet: DrawingSheet, element: Element, start: complex, end: complex) -> None:
        """Draw the symbol of a linear element between two points, mm."""

    @abstractmethod
    def draw_torsional(self, sheet: DrawingSheet, element: Element, centre: complex, angle: float) -> complex:
        """Draw the symbol of a torsional element about a point (mm); return the position of its name, mm.

        angle: angle of the second link (rad).
        """


@cache
def element_view(block: str) -> ElementView[Any]:
    """Return the presentation of the elements in a block of the file; its module is imported when it is first used."""
    view: ElementView[Any] = import_module(f"tmm_cli.reports.elements.{block}").VIEW
    return view


def element_warnings(results: Results) -> Iterable[str]:
    """Yield the warnings about the load elements of all kinds."""
    for block, elements in results.linkage.elements_by_block.items():
        yield from element_view(block).warnings(results, elements)
