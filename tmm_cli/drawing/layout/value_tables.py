"""Tables of computed values as drawings with ruled cells. A long table is broken into parts side by side."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    Drawing,
    LineMark,
    Mark,
    SheetPicture,
    TextMark,
    Words,
    cut_text,
    longest_for,
    placed_pieces,
    render_picture,
    script_width,
)
from tmm_cli.drawing.sheets import Position, driver_caption
from tmm_cli.language import _, numeral, translated
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.forces import CourseSymbol, LoadedPosition, Symbol, balance_symbol, reaction_symbol
from tmm_cli.mechanics.numerics import NO_FORCE
from tmm_cli.mechanics.quantities import (
    ACCELERATION,
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    FORCE,
    INERTIA,
    LENGTH,
    MOMENT,
    NUMBER,
    SPEED,
    Dimension,
)
from tmm_cli.problem import UnitSystem, typeset_unit
from tmm_cli.reports import terminal_cells, walk

LETTER_SIZE = 3.2  # mm: letters of a table at its usual size
OUTER_LINE, INNER_LINE = 0.5, 0.2  # mm: widths
TEXT_AIR = 1.4  # of the letter size: free width of a cell
ROW_HEIGHT = 1.7  # of the letter size
MOST_ROWS = 28  # longer tables are split into parts side by side
PART_GAP = 3.0  # of the letter size
WIDEST_TEXT = 24.0  # of the letter size: a longer text is cut


def draw_table(
    title: str, heads: Sequence[Words], rows: Sequence[Sequence[Words]], notes: Sequence[str] = ()
) -> SheetPicture:
    """Draw a table. Its letters are as large as the available space permits.

    Args:
        title: heading of the table.
        heads: headings of the columns.
        rows: cells, row by row.
        notes: lines below the heading.
    """
    cells = [
        [cut_text(cell, 1.0, WIDEST_TEXT) if isinstance(cell, str) else cell for cell in row] for row in (heads, *rows)
    ]
    columns = [max(script_width(row[k], 1.0) for row in cells) + TEXT_AIR for k in range(len(heads))]
    parts = max(math.ceil(len(rows) / MOST_ROWS), 1)
    most = math.ceil(len(rows) / parts)
    step = sum(columns) + PART_GAP
    across, up = parts * step - PART_GAP, ROW_HEIGHT * (most + 1)
    longest = longest_for(LETTER_SIZE * max(across, up))
    size = longest / max(across, up)
    marks: list[Mark] = []
    for number in range(parts):
        part_cells = [cells[0], *cells[1 + number * most : 1 + (number + 1) * most]]
        marks += [
            mark.moved(number * size * step + 0j)
            for mark in _draw_table_part(part_cells, [size * wide for wide in columns], size)
        ]
    return render_picture(marks, title, longest, notes=notes)


def _draw_table_part(cells: Sequence[Sequence[Words]], columns: Sequence[float], size: float) -> list[Mark]:
    """Draw some rows of a table below its column headings. Words are aligned left, numbers right."""
    row, wide = ROW_HEIGHT * size, sum(columns)
    edges = [sum(columns[:k]) for k in range(len(columns) + 1)]
    high = [-row * k for k in range(len(cells) + 1)]
    marks: list[Mark] = [
        LineMark(
            (1j * y, wide + 1j * y), DARK_COLOUR, OUTER_LINE if k in (0, 1, len(cells)) else INNER_LINE, layer="text"
        )
        for k, y in enumerate(high)
    ]
    marks += [
        LineMark(
            (complex(x, high[-1]), complex(x, 0)),
            DARK_COLOUR,
            OUTER_LINE if x in (0.0, edges[-1]) else INNER_LINE,
            layer="text",
        )
        for x in edges
    ]
    for k, (start, end) in enumerate(pairwise(edges)):
        numbers = all(_is_number(line[k]) for line in cells[1:])
        for line, y in zip(cells, high, strict=False):
            at = complex(start + TEXT_AIR / 2 * size, y - row / 2)
            if numbers:
                at = complex(end - TEXT_AIR / 2 * size - script_width(line[k], size), y - row / 2)
            for off, letters, letter_size in placed_pieces(line[k], size):
                if letters:
                    marks.append(TextMark(at + off, letters, letter_size, DARK_COLOUR))
    return marks


def _is_number(text: Words) -> bool:
    return isinstance(text, str) and (not text or text == "-" or text.lstrip("+-−")[:1].isdigit())


# Tables of values on large sheets: structure, motion in all positions, forces of a position.


SIGNIFICANT_FIGURES = 4  # in each number
ZERO_BELOW = 1e-9  # of the largest number of a column: smaller ones are written as zero
MOST_DECIMALS = 6  # numbers that need more are written with a power of ten
MOST_COLUMNS = 8  # in a table
MOST_POSITIONS = 36  # in a table; of more positions only some are listed

QuantityColumn = tuple[str | Symbol, Any, Dimension]


def draw_structure_tables(results: Results) -> Iterator[tuple[str, Drawing]]:
    """Yield the tables of links and of kinematic pairs."""
    for report in walk(results, ("links", "pairs")):
        rows = [[str(column.values[k]) for column in report.columns] for k in range(report.rows)]
        yield (
            f"table-{report.name}",
            draw_table(report.title, [translated(column.header) for column in report.columns], rows),
        )


def draw_motion_tables(results: Results) -> Iterator[tuple[str, Drawing]]:
    """Yield the tables of the velocities and of the accelerations of all points and links in all positions."""
    motion, linkage = results.motion, results.linkage
    assert motion is not None
    points = {name: motion.named(name) for name in linkage.moving_points}
    links = {name: motion.link(name) for name in linkage.moving}
    speeds = [(Symbol("v", name), np.abs(point.v), SPEED) for name, point in points.items()]
    speeds += [(Symbol("ω", name), link.omega, ANGULAR_SPEED) for name, link in links.items()]
    more = [(Symbol("a", name), np.abs(point.a), ACCELERATION) for name, point in points.items()]
    more += [(Symbol("ε", name), link.epsilon, ANGULAR_ACCELERATION) for name, link in links.items()]
    for stem, title, quantities in (
        ("speeds", _("Speeds of the points, angular speeds of the links"), speeds),
        ("accelerations", _("Accelerations of the points, angular accelerations of the links"), more),
    ):
        moving = [column for column in quantities if np.any(np.nan_to_num(column[1]) != 0)]
        each = math.ceil(len(moving) / math.ceil(len(moving) / MOST_COLUMNS)) if moving else 1
        for start in range(0, len(moving), each):
            yield f"table-{stem}", table_over_positions(results, title, moving[start : start + each])


def draw_balance_table(results: Results) -> Iterator[tuple[str, Drawing]]:
    """Yield the table of balancing moments or forces in all positions.

    They are found by force plans and by the Zhukovsky lever.
    """
    reactions, lever = results.reactions, results.lever
    if reactions is None or lever is None:
        return
    several = len(reactions.balances) > 1
    columns: list[QuantityColumn] = []
    for balance in reactions.balances:
        turns = balance.moment is not None if several else balance.kind == "moment"
        name = balance_symbol(balance.driver.link, several, turns=turns)
        values = balance.generalized if several or turns else balance.force
        columns.append((name, values, MOMENT if turns else FORCE))
    if not several:
        __, ___, dimension = columns[0]
        checked = lever.balancing if reactions.balance.kind == "moment" else lever.balancing / reactions.balance.arm
        columns.append((_("by the Zhukovsky lever"), checked, dimension))
    yield "table-balance", table_over_positions(results, _("Balancing load of the driver"), columns)


def table_over_positions(results: Results, title: str, columns: Sequence[QuantityColumn]) -> Drawing:
    """Draw a table with a row for each position. The first column is the driver coordinate."""
    units, motion = results.problem.units, results.motion
    assert motion is not None
    crank = results.linkage.driver.kind == "turn"
    cycle = 2 * np.pi * motion.linkage.turns
    place: QuantityColumn = ("φ", np.mod(motion.q, cycle), ANGLE) if crank else ("s", motion.q, LENGTH)
    quantities = [place, *columns]
    heads: list[Words] = [_("No.")]
    heads += [
        (name, f", {typeset_unit(units.spelt(kind))}" if units.spelt(kind) else "") for name, __, kind in quantities
    ]
    chosen = range(0, len(results.numbers), math.ceil(len(results.numbers) / MOST_POSITIONS))
    cells = [format_column(values, dimension, units, chosen) for __, values, dimension in quantities]
    rows = [[str(results.numbers[k]), *(column[n] for column in cells)] for n, k in enumerate(chosen)]
    return draw_table(title, heads, rows)


def draw_forces_table(position: Position) -> Iterator[tuple[str, Drawing]]:
    """Yield the table of all forces and moments in a position.

    Forces are given by magnitude and angle from the x axis.
    """
    results, k = position.results, position.k
    reactions, units = results.reactions, results.problem.units
    if reactions is None:
        return
    loads = LoadedPosition.at(position.motion, reactions, k).loads_and_drives()
    forces = [(load.symbol, load.force) for load in loads if not load.couple]
    forces += [(reaction_symbol(r.by, r.on), complex(r.force[k])) for r in reactions.all]
    moments = [(load.symbol, load.moment) for load in loads if load.couple]
    largest = max((abs(force) for __, force in forces), default=0.0)
    rows: list[list[Words]] = [[name, *_polar_cells(force, largest, units), ""] for name, force in forces]
    rows += [
        [name, "", "", numeral(units.from_si(moment, MOMENT), f".{SIGNIFICANT_FIGURES}g")] for name, moment in moments
    ]
    heads = [
        _("force or moment"),
        _("magnitude, {unit}").format(unit=typeset_unit(units.spelt(FORCE))),
        _("angle from the x axis, °"),
        _("moment, {unit}").format(unit=typeset_unit(units.spelt(MOMENT))),
    ]
    place = driver_caption(results, float(position.motion.q[k]))
    title = _("Forces in position {number}, {place}").format(number=results.numbers[k], place=place)
    notes = [_("R with the numbers of two links: force of the first link on the second")]
    yield position.stem("table-forces"), draw_table(title, heads, rows, notes)


def _polar_cells(force: complex, largest: float, units: UnitSystem) -> tuple[str, str]:
    """Format the magnitude of a force and its angle (0 to 360°) as two cells of a table.

    A force below the rounding error is written as "0", without angle.
    """
    if not abs(force) > NO_FORCE * largest:
        return "0", "-"
    angle = round(math.degrees(math.atan2(force.imag, force.real)), 1) % 360
    return numeral(units.from_si(abs(force), FORCE), f".{SIGNIFICANT_FIGURES}g"), numeral(angle, ".1f")


def format_column(values: Any, dimension: Dimension, units: UnitSystem, rows: Iterable[int]) -> list[str]:
    """Format a column of values with the same number of decimals.

    Args:
        values: values in SI units.
        dimension: their dimension.
        units: units of the problem file, in which they are written.
        rows: indices of the values to be written.

    Returns:
        Texts of the cells; "-" for an undefined value.
    """
    in_units = np.broadcast_to(np.asarray(values, float), (max(np.size(values), 1),)) / units.factor(dimension)
    picked = np.array([in_units[k if len(in_units) > 1 else 0] for k in rows])
    finite = in_units[np.isfinite(in_units)]
    largest = float(np.max(np.abs(finite), initial=0.0))
    decimals = SIGNIFICANT_FIGURES - 1 - math.floor(math.log10(largest)) if largest else 0
    form = f".{SIGNIFICANT_FIGURES}g"
    if -MOST_DECIMALS < decimals <= MOST_DECIMALS:
        needed = (
            n for n in range(decimals) if np.allclose(np.round(finite, n), finite, rtol=0, atol=10.0**-decimals / 2)
        )
        decimals = next(needed, max(decimals, 0))
        form, picked = f".{decimals}f", np.round(picked, decimals) + 0.0  # no negative zero
    least = ZERO_BELOW * largest
    return ["-" if not math.isfinite(v) else numeral(v, form) if abs(v) > least else "0" for v in picked.tolist()]


# Tables of values on the large sheet of the law of motion.


def draw_law_tables(results: Results) -> Iterator[tuple[str, Drawing]]:
    """Yield the table of the results of dynamics, then the table of the law of motion in all positions."""
    running = results.steady
    if running is None or results.motion is None:
        return
    units = results.problem.units
    for report in walk(results, ("dynamics",)):
        columns = [
            terminal_cells(replace(column, digits=SIGNIFICANT_FIGURES), units, range(report.rows))
            for column in report.columns
        ]
        heads = [translated(column.header) for column in report.columns]
        rows = [[*texts, typeset_unit(unit)] for *texts, unit in zip(*columns, strict=True)]
        yield "table-dynamics", draw_table(report.title, heads, rows)
    yield "table-law", table_over_positions(results, _("Law of motion of the driver"), _law_columns(results))


def _law_columns(results: Results) -> list[QuantityColumn]:
    running, motion = results.steady, results.motion
    assert running is not None and motion is not None
    law, travel = running.steady.law, running.travel(motion.q)
    machine, sense = running.steady.machine, running.sense
    return [
        (Symbol("J"), machine.inertia(travel), INERTIA),
        (Symbol("M"), sense * machine.moment(travel), MOMENT),
        (CourseSymbol("M_d"), sense * law.driving(travel), MOMENT),
        (_("A, J"), running.steady.work(travel), NUMBER),
        (Symbol("ω"), motion.rate, ANGULAR_SPEED),
        (Symbol("ε"), motion.acceleration, ANGULAR_ACCELERATION),
        (_("t, s"), motion.time, NUMBER),
    ]
