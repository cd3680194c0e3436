"""Presentation of springs in tables, warnings, notes and drawings."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Results, motion_at_positions
from tmm_cli.mechanics.elements.springs import Spring
from tmm_cli.mechanics.forces import Symbol
from tmm_cli.mechanics.numerics import SAME_DRIVER_POSITION, dot, unit
from tmm_cli.mechanics.quantities import ANGLE, DAMPING, FORCE, LENGTH, MOMENT, STIFFNESS, TORSION, TORSION_DAMPING
from tmm_cli.problem import Problem
from tmm_cli.reports.elements.view import ELEMENT_COLOUR, ElementLaw, ElementView, MakeLeaf
from tmm_cli.reports.motion_warnings import format_driver_coordinate
from tmm_cli.reports.table import Table, format_value, format_vector, link_name, text_table

if TYPE_CHECKING:
    from tmm_cli.drawing.paper import DrawingSheet

SPRING_POSITIONS = 720  # places a turn at which a torsion spring's angle, or the length of a spring, is followed
COINCIDENT_ENDS = 1e-3  # of the largest length of a spring: its ends, followed by chords, meet
COIL_PITCH = 3.0  # mm between coils of a spring
COIL_HALF_WIDTH = 2.2  # mm
SPRING_END = 4.0  # mm: straight end of a spring
TORSION_SPIRAL = (1.9, 5.8, 2.25)  # mm: inner and outer radius of a torsion spring, its turns


class SpringView(ElementView[Spring]):
    """Presentation of springs: table, warnings, force law and drawing symbols; see ElementView."""

    def table(self, problem: Problem, elements: Sequence[Spring]) -> Table:
        """Return the table of springs; see ElementView."""
        return text_table(
            "springs",
            _("Springs"),
            (
                _("name"),
                _("connected links"),
                _("points of attachment"),
                _("stiffness"),
                _("free length or angle"),
                _("preload"),
                _("damping"),
            ),
            [_row(problem, spring) for spring in elements],
        )

    def warnings(self, results: Results, elements: Sequence[Spring]) -> Iterable[str]:
        """Warn of springs whose force or moment jumps; see ElementView."""
        yield from _warn_of_twist(results, elements)
        yield from _warn_of_zero_length(results, elements)

    def law(self, element: Spring, size: float, rate: float, leaf: MakeLeaf) -> ElementLaw:
        """Return the force of a spring as a function of its length, or its moment as a function of its angle; see
        ElementView.
        """
        letter, now, free, faster = "F", Symbol("l"), leaf(Symbol("l", "0"), element.free), Symbol("v")
        if element.turns:
            letter, now, free, faster = "M", Symbol("θ"), leaf(Symbol("θ", "0"), 0.0), Symbol("ω")
        length, c, b = leaf(now, size), leaf(Symbol("c"), element.rate), leaf(Symbol("b"), element.damping)
        preload = leaf(Symbol(letter, "0"), element.preload)
        terms = [preload] if element.preload or not (element.rate or element.damping) else []
        if element.rate:
            terms.append(c * (length - free if free.value else length))
        if element.damping:
            terms.append(b * leaf(faster, rate))
        symbols = {"now": now, "rate": faster, "c": c.symbol, "free": free.symbol}
        symbols.update({"preload": preload.symbol, "b": b.symbol})
        return ElementLaw(_sentence(element), symbols, sum(terms[1:], terms[0]))

    def draw_linear(self, sheet: DrawingSheet, element: Spring, start: complex, end: complex) -> None:
        """Draw a coil spring, or a cylinder for a gas spring or a constant force; see ElementView."""
        (_draw_coil_spring if element.rate > 0 else _draw_gas_spring)(sheet, start, end)

    def draw_torsional(self, sheet: DrawingSheet, element: Spring, centre: complex, angle: float) -> complex:
        """Draw a torsion spring as a spiral; see ElementView."""
        inner, outer, turns = TORSION_SPIRAL
        share = np.linspace(0, 1, 120)
        arc = centre + (inner + (outer - inner) * share) * unit(angle + 2 * np.pi * turns * share)
        sheet.line([complex(p) for p in arc], ELEMENT_COLOUR, 1.1, z=5.5)
        last = complex(arc[-1])
        sheet.line([last, last + 2.4 * (last - centre) / abs(last - centre)], ELEMENT_COLOUR, 1.1, z=5.5)
        return last


VIEW = SpringView()


def _row(problem: Problem, spring: Spring) -> tuple[str, ...]:
    between = f"{link_name(spring.i)}, {link_name(spring.j)}"
    if spring.turns:
        ends, measures = "", (TORSION, ANGLE, MOMENT, TORSION_DAMPING)
    else:
        ends = f"{format_vector(problem, spring.at_i)}, {format_vector(problem, spring.at_j)}"
        measures = (STIFFNESS, LENGTH, FORCE, DAMPING)
    values = (spring.rate, spring.free, spring.preload, spring.damping)
    rate, free, preload, damping = (
        format_value(problem, v, measure) for v, measure in zip(values, measures, strict=True)
    )
    if not spring.rate:
        rate, free = _("constant force"), ""
    return spring.name, between, ends, rate, free, preload if spring.preload else "", damping if spring.damping else ""


def _sentence(spring: Spring) -> str:
    """Return the sentence that explains the force or moment of a spring, with those coefficients that the spring
    has.
    """
    if not spring.rate and not spring.damping:
        if spring.turns:
            return _("The moment of the spring {name} is constant, equal to its preload {preload}:")
        return _("The force of the spring {name} is constant, equal to its preload {preload}:")
    if not spring.rate:
        if spring.turns:
            return _(
                "The moment of the spring {name}, which has no stiffness, depends on the relative angular velocity "
                "{rate} of its links; {b} is its damping coefficient:"
            )
        return _(
            "The force of the spring {name}, which has no stiffness, depends on the rate {rate} at which its length "
            "changes; {b} is its damping coefficient:"
        )
    if spring.damping:
        if spring.turns:
            return _(
                "The moment of the spring {name} depends on its angle {now} from the free position and on the "
                "relative angular velocity {rate} of its links; {c} is its stiffness, {b} its damping coefficient:"
            )
        return _(
            "The force of the spring {name} depends on its length {now} and on the rate {rate} at which it changes; "
            "{c} is its stiffness, {free} its free length, {b} its damping coefficient:"
        )
    if spring.turns:
        return _(
            "The moment of the spring {name} depends on its angle {now} from the free position; {c} is its stiffness:"
        )
    return _(
        "The force of the spring {name} depends on its length {now}; {c} is its stiffness, {free} its free length:"
    )


def _warn_of_twist(results: Results, elements: Sequence[Spring]) -> Iterable[str]:
    """Warn of torsion springs that are twisted by more than half a turn from their free angle."""
    springs = [s for s in elements if s.turns]
    if not springs or results.reactions is None:
        return
    turns = results.driver_range.turns if results.driver_range else 1
    motion = motion_at_positions(results, results.closely(SPRING_POSITIONS * turns + 1), 0)
    for spring in springs:
        with np.errstate(invalid="ignore"):
            jumps = np.flatnonzero(np.abs(np.diff(spring.twist(motion))) > np.pi)
        if jumps.size:
            yield _(
                "torsion spring {spring} is twisted by more than half a turn from its free angle when the driver "
                "is at {place}: its moment jumps there, because its angle is measured from -180 to 180 deg"
            ).format(spring=spring.name, place=_coordinate_in_cycle(results, float(motion.q[jumps[0]])))


def _warn_of_zero_length(results: Results, elements: Sequence[Spring]) -> Iterable[str]:
    """Warn of linear springs whose ends meet within the cycle, where the direction of their force reverses."""
    springs = [s for s in elements if not s.turns and s.preload != s.rate * s.free]
    if not springs or results.reactions is None:
        return
    turns = results.driver_range.turns if results.driver_range else 1
    motion = motion_at_positions(results, results.closely(SPRING_POSITIONS * turns + 1))
    for spring in springs:
        apart = motion.point(spring.j, spring.at_j).x - motion.point(spring.i, spring.at_i).x
        step = np.diff(apart)
        with np.errstate(invalid="ignore", divide="ignore"):
            share = np.clip(np.nan_to_num(-dot(apart[:-1], step) / np.abs(step) ** 2), 0, 1)
        nearest = np.abs(apart[:-1] + share * step)  # to the chord between two positions
        if not np.any(np.isfinite(nearest)):
            continue
        k = int(np.nanargmin(nearest))
        if nearest[k] <= COINCIDENT_ENDS * np.nanmax(np.abs(apart)):
            q = float(motion.q[k] + share[k] * (motion.q[k + 1] - motion.q[k]))
            yield _(
                "the ends of spring {spring} meet when the driver is at {place}: the direction of its force "
                "reverses there. Give other points in `between`, or use a torsion spring"
            ).format(spring=spring.name, place=_coordinate_in_cycle(results, q))


def _coordinate_in_cycle(results: Results, q: float) -> str:
    """Return a driver coordinate as text; the angle of a fully rotating driver is reduced to its cycle."""
    cycle = 2 * np.pi * results.turns
    return format_driver_coordinate(
        results, float(np.mod(q + SAME_DRIVER_POSITION, cycle) - SAME_DRIVER_POSITION) if cycle else q
    )


def _draw_coil_spring(sheet: DrawingSheet, start: complex, end: complex) -> None:
    """Draw a coil spring as a zigzag line between two points, mm."""
    length = abs(end - start)
    along = (end - start) / length
    stub = min(SPRING_END, 0.15 * length)
    number = int(np.clip((length - 2 * stub) / COIL_PITCH, 4, 14))
    step = (length - 2 * stub) / number
    side = 1j * along * min(COIL_HALF_WIDTH, length / 5)
    coils = [start + along * (stub + (k + 0.5) * step) + (-1) ** k * side for k in range(number)]
    sheet.line([start, start + stub * along, *coils, end - stub * along, end], ELEMENT_COLOUR, 1.1, z=3.8)


def _draw_gas_spring(sheet: DrawingSheet, start: complex, end: complex) -> None:
    """Draw a gas spring or a constant force as a cylinder between two points, mm."""
    along = (end - start) / abs(end - start)
    neck, side = start + 0.6 * (end - start), 1j * along * 1.6
    sheet.line([start, end], ELEMENT_COLOUR, 1.1, z=3.7)
    sheet.area([start + side, neck + side, neck - side, start - side], "white", ELEMENT_COLOUR, 1.1, 3.8)
