"""Presentation of dampers in tables, warnings, notes and drawings."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.elements.dampers import Damper
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.numerics import unit
from tmm_cli.mechanics.quantities import DAMPING, QUADRATIC_DAMPING, TORSION_DAMPING, TORSION_QUADRATIC_DAMPING
from tmm_cli.problem import Problem
from tmm_cli.reports.elements.view import ELEMENT_COLOUR, ElementLaw, ElementView, MakeLeaf
from tmm_cli.reports.table import Table, format_value, format_vector, link_name, text_table

if TYPE_CHECKING:
    from tmm_cli.drawing.paper import DrawingSheet

CYLINDER = (0.3, 0.7, 2.2)  # ends of the cylinder, of the length of the damper; its largest half width, mm
PISTON = 0.75  # half width of the piston, of that of the cylinder
HOUSING = (4.0, 1.4)  # mm: radius of the housing of a torsional damper and of its shaft
OPENING = 0.7  # rad: half the angle at which the housing is open


class DamperView(ElementView[Damper]):
    """Presentation of dampers: table, force law and drawing symbols; see ElementView."""

    def table(self, problem: Problem, elements: Sequence[Damper]) -> Table:
        """Return the table of dampers; see ElementView."""
        return text_table(
            "dampers",
            _("Dampers"),
            (
                _("name"),
                _("connected links"),
                _("points of attachment"),
                _("damping coefficient"),
                _("coefficient of the squared speed"),
            ),
            [_row(problem, damper) for damper in elements],
        )

    def law(self, element: Damper, size: float, rate: float, leaf: MakeLeaf) -> ElementLaw:
        """Return the force of a damper as a function of the rate of change of its length, or its moment as a
        function of the rate of change of its angle; see ElementView.
        """
        speed = leaf(Symbol("ω" if element.turns else "v"), rate)
        linear, quadratic = leaf(Symbol("b"), element.linear), leaf(Symbol("b", "2"), element.quadratic)
        symbols = {"rate": speed.symbol, "b": linear.symbol, "b2": quadratic.symbol}
        if not element.quadratic:
            return ElementLaw(_sentence(element), symbols, linear * speed)
        square = quadratic * speed * abs(speed)
        return ElementLaw(_sentence(element), symbols, linear * speed + square if element.linear else square)

    def draw_linear(self, sheet: DrawingSheet, element: Damper, start: complex, end: complex) -> None:
        """Draw a damper as a piston in an open cylinder; see ElementView."""
        along = end - start
        base, mouth, piston = (start + share * along for share in (*CYLINDER[:2], sum(CYLINDER[:2]) / 2))
        side = 1j * along / abs(along) * min(CYLINDER[2], abs(along) / 5)
        sheet.line([start, base], ELEMENT_COLOUR, 1.1, z=3.8)
        sheet.line([mouth + side, base + side, base - side, mouth - side], ELEMENT_COLOUR, 1.1, z=3.8)
        sheet.line([piston + PISTON * side, piston - PISTON * side], ELEMENT_COLOUR, 1.8, z=3.8)
        sheet.line([piston, end], ELEMENT_COLOUR, 1.1, z=3.8)

    def draw_torsional(self, sheet: DrawingSheet, element: Damper, centre: complex, angle: float) -> complex:
        """Draw a rotary damper as a blade in an open housing about the axis; see ElementView."""
        outer, inner = HOUSING
        arc = centre + outer * unit(angle + np.linspace(OPENING, 2 * np.pi - OPENING, 90))
        sheet.line([complex(p) for p in arc], ELEMENT_COLOUR, 1.1, z=5.5)
        sheet.line([centre - inner * unit(angle), centre - PISTON * outer * unit(angle)], ELEMENT_COLOUR, 1.8, z=5.5)
        return complex(arc[0])


VIEW = DamperView()


def _row(problem: Problem, damper: Damper) -> tuple[str, ...]:
    ends, dimensions = "", (TORSION_DAMPING, TORSION_QUADRATIC_DAMPING)
    if not damper.turns:
        ends = f"{format_vector(problem, damper.at_i)}, {format_vector(problem, damper.at_j)}"
        dimensions = (DAMPING, QUADRATIC_DAMPING)
    coefficients = zip((damper.linear, damper.quadratic), dimensions, strict=True)
    return (
        damper.name,
        f"{link_name(damper.i)}, {link_name(damper.j)}",
        ends,
        *(format_value(problem, value, dimension) if value else "" for value, dimension in coefficients),
    )


def _sentence(damper: Damper) -> str:
    """Return the sentence that explains the force or moment of a damper, with those coefficients that the damper
    has.
    """
    if damper.turns:
        if not damper.quadratic:
            return _(
                "The moment of the damper {name} opposes the relative rotation of its links with the angular velocity "
                "{rate}; {b} is its damping coefficient:"
            )
        if not damper.linear:
            return _(
                "The moment of the damper {name} opposes the relative rotation of its links with the angular velocity "
                "{rate}; {b2} is its coefficient of the squared speed:"
            )
        return _(
            "The moment of the damper {name} opposes the relative rotation of its links with the angular velocity "
            "{rate}; {b} is its damping coefficient, {b2} its coefficient of the squared speed:"
        )
    if not damper.quadratic:
        return _(
            "The force of the damper {name} opposes the rate {rate} at which its length changes; {b} is its damping "
            "coefficient:"
        )
    if not damper.linear:
        return _(
            "The force of the damper {name} opposes the rate {rate} at which its length changes; {b2} is its "
            "coefficient of the squared speed:"
        )
    return _(
        "The force of the damper {name} opposes the rate {rate} at which its length changes; {b} is its damping "
        "coefficient, {b2} its coefficient of the squared speed:"
    )
