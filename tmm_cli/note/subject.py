"""Results of a problem in the form that the chapters of a note use: numbers as texts, drawings, tables."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np

from tmm_cli.drawing.formats import NamedDrawings
from tmm_cli.drawing.paper import Drawing, PictureSpace, drawing_within
from tmm_cli.drawing.sheets import (
    Position,
    draw_all_groups,
    draw_all_positions,
    draw_centres,
    draw_diagrams,
    draw_energy_mass,
    draw_force_plans,
    draw_group_loads,
    draw_law_curves,
    draw_lever,
    draw_motion_plans,
    draw_position,
    draw_problem_synthesis,
    draw_scheme,
    draw_shaking_hodograph,
    draw_single_run,
    driver_caption,
)
from tmm_cli.language import _, language, numeral, signed, spelt, typeset
from tmm_cli.mechanics.analysis import Results, detailed_positions
from tmm_cli.mechanics.forces import Reactions, ZhukovskyLever, subscript
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.plans import extent, round_scale
from tmm_cli.mechanics.quantities import Dimension
from tmm_cli.note.blocks import Block, Figure, Line, Ref, Rows, cells, write_sentence
from tmm_cli.note.expression import FIGURES, format_fixed, format_plain, round_figures
from tmm_cli.problem import UnitSystem, typeset_unit
from tmm_cli.reports import Column, Table, printed_figures, terminal_cells as cells_of

EDGE = 0.4  # margin around a drawing (mm)
WIDTH, HEIGHT = 175.0, 225.0  # of the text on an A4 page, and of a drawing with its caption (mm)


# by the name that chapters use: drawing function, and longest side (mm) of a drawing to scale
OF_MECHANISM: Mapping[str, tuple[Callable[[Results], NamedDrawings], float]] = {
    "structure": (draw_scheme, 100),
    "groups": (draw_all_groups, 45),
    "synthesis": (draw_problem_synthesis, 110),
    "positions": (draw_all_positions, 130),
    "diagrams": (draw_diagrams, 170),
    "law": (draw_law_curves, 225),
    "energy-mass": (draw_energy_mass, 190),
    "run": (draw_single_run, 225),
    "centres": (draw_centres, 130),
    "shaking": (draw_shaking_hodograph, 110),
}
OF_POSITION: Mapping[str, tuple[Callable[[Position], NamedDrawings], float]] = {
    "position": (draw_position, 120),
    "velocity": (draw_motion_plans, 120),
    "acceleration": (draw_motion_plans, 120),
    "group-loads": (draw_group_loads, 90),
    "forces": (draw_force_plans, 100),
    "lever": (draw_lever, 110),
}


@dataclass(frozen=True, eq=False)
class Subject:
    """Results of a problem that the note describes, and drawings of them.

    Attributes:
        results: results of the problem.
        drawn: False for a note without drawings, which is much faster.
    """

    results: Results
    drawn: bool = True
    _drawings: dict[Any, dict[str, Drawing]] = field(default_factory=dict, repr=False)

    @cached_property
    def detail(self) -> tuple[int, ...]:
        """Indices of the detailed positions, for which plans are drawn; empty if the mechanism cannot move."""
        return detailed_positions(self.results) if self.results.motion is not None else ()

    @property
    def motion(self) -> Motion:
        """Motion of the mechanism. It may be used only if the mechanism moves."""
        assert self.results.motion is not None
        return self.results.motion

    @property
    def reactions(self) -> Reactions:
        """Reactions. They may be used only if loads act on the links."""
        assert self.results.reactions is not None
        return self.results.reactions

    @property
    def lever(self) -> ZhukovskyLever:
        """Zhukovsky lever. It may be used only if loads act on the links."""
        assert self.results.lever is not None
        return self.results.lever

    def position(self, k: int) -> Position:
        """Return position k as the drawing functions expect it."""
        return Position(self.results, self.motion, k)

    def position_number(self, k: int) -> str:
        """Return the number of position k in tables and drawings."""
        return str(self.results.numbers[k])

    def describe_position(self, k: int) -> str:
        """Return the number of position k with its driver coordinate, as text."""
        place = with_degrees(driver_caption(self.results, float(self.motion.q[k]), 4))
        return _("position {number}, {place}").format(number=self.position_number(k), place=place)

    def rate(self, k: int) -> float:
        """Return the velocity of the first driver in position k (rad/s or m/s)."""
        return float(np.broadcast_to(self.motion.rate, self.motion.q.shape)[k])

    @property
    def has_loads(self) -> bool:
        """True if any load acts on the links."""
        return self.results.reactions is not None and bool(self.results.reactions.applied)

    def number(self, si: float, dimension: Dimension, digits: int = 6) -> str:
        """Convert a value from SI to the unit of the problem file and return it as text, without the unit."""
        return self.text(float(self.results.problem.units.from_si(si, dimension)), digits)

    def value(self, si: float, dimension: Dimension, digits: int = 6) -> str:
        """Convert a value from SI to the unit of the problem file and return it as text with the unit."""
        return with_degrees(f"{self.number(si, dimension, digits)} {self.unit(dimension)}".rstrip())

    def unit(self, dimension: Dimension) -> str:
        """Return the printed unit that the problem file uses for a dimension."""
        return typeset_unit(self.results.problem.units.spelt(dimension))

    def text(self, value: float, digits: int = 4) -> str:
        """Return a number as text in the current language, without trailing zeros."""
        return self.localise(format_plain(round_figures(value, digits), digits))

    def format_result(self, value: float) -> str:
        """Return a result as text in the current language with all its significant figures, also zeros at the end."""
        return self.localise(format_fixed(value, FIGURES))

    def angle(self, radians: float) -> str:
        """Return an angle (rad) as text in degrees, from 0 to 360, without the degree sign."""
        return numeral(round(float(np.degrees(radians)), 1) % 360, ".1f")

    def direction(self, vector: complex) -> str:
        """Return the angle of a vector to the x axis as text, e.g. 135.0°."""
        return f"{self.angle(float(np.angle(vector)))}°"

    def localise(self, text: str) -> str:
        """Return a formatted number in the style of the current language."""
        return localise_figures(text, language())

    def drawings(self, name: str, k: int | None = None) -> dict[str, Drawing]:
        """Return drawings by name. They are drawn when first requested.

        Args:
            name: kind of drawing, a key of OF_MECHANISM or, if k is given, of OF_POSITION.
            k: index of a position; None for drawings of the whole mechanism.

        Returns:
            The drawings, or none for a note without drawings.
        """
        if not self.drawn:
            return {}
        draw, longest = OF_MECHANISM[name] if k is None else OF_POSITION[name]
        if (draw, k) not in self._drawings:
            with drawing_within(PictureSpace(longest, (WIDTH, HEIGHT), written=False)):
                subject: Any = self.results if k is None else self.position(k)
                self._drawings[draw, k] = {stem: add_margin(drawing) for stem, drawing in draw(subject)}
        several = draw is draw_motion_plans
        return {stem: d for stem, d in self._drawings[draw, k].items() if not several or stem.startswith(name)}

    def scale(self, name: str, k: int, stem: str) -> float:
        """Return the scale (m/mm) of a drawing, or that which it would have if the note has no drawings."""
        picture = self.drawings(name, k).get(stem)
        mu = getattr(picture, "mu", None)
        if mu is not None:
            return float(mu)
        points = {point for link in self.results.linkage.links.values() for point in link.points}
        __, across, up, ___ = extent(complex(self.motion.named(point).x[k]) for point in points)
        return round_scale(across, up, OF_POSITION[name][1], OF_POSITION[name][1])

    def figures(
        self, name: str, sentence: str, caption: str = "", k: int | None = None, only: str = "", further: str = ""
    ) -> Iterable[Block]:
        """Yield drawings, each after a sentence that refers to it by the field {figure}.

        Args:
            name: kind of drawing, a key of OF_MECHANISM or, if k is given, of OF_POSITION.
            sentence: sentence before the first drawing.
            caption: caption; by default the heading of the drawing.
            k: index of a position; None for drawings of the whole mechanism.
            only: name of the only drawing to be included, with its continuation sheets; all drawings if empty.
            further: sentence before each further drawing; by default the same sentence.
        """
        for stem, drawing in self.drawings(name, k).items():
            if only and not re.fullmatch(rf"{re.escape(only)}(-sheet)?(-\d+)?", stem):
                continue
            yield write_sentence(sentence, figure=Ref(stem))
            yield Figure(caption or typeset_formulas(getattr(drawing, "title", "")), drawing, stem)
            sentence = further or sentence


def add_margin(drawing: Drawing) -> Drawing:
    """Return a drawing with a narrow margin, so that its outer lines are not cut off."""
    width, height = drawing.paper
    marks = tuple(mark.moved(EDGE * (1 + 1j)) for mark in drawing.marks)
    return replace(drawing, paper=(width + 2 * EDGE, height + 2 * EDGE), marks=marks)


def localise_figures(text: str, spoken: str) -> str:
    """Return a number with the decimal mark, minus sign and power of ten of a language.

    Args:
        text: number as Python formats it, e.g. -1.2e-5.
        spoken: code of the language, e.g. en.
    """
    text = re.sub(r"(?<=\d)e([+-]?\d+)\b", lambda power: f"·10{str(int(power[1])).translate(RAISED)}", text)
    return text.replace("-", "−") if spoken == "en" else text.replace(".", ",").replace("-", "−")


def with_degrees(text: str) -> str:
    """Replace the unit deg by ° and prevent line breaks before percent signs."""
    return re.sub(r"(?<=\d) (?:deg\b|град\b|°)", "°", text).replace(" %", "\N{NO-BREAK SPACE}%")


RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
GREEK = {
    "alpha": "α",
    "beta": "β",
    "delta": "δ",
    "epsilon": "ε",
    "theta": "θ",
    "lambda": "λ",
    "nu": "ν",
    "pi": "π",
    "phi": "φ",
    "psi": "ψ",
    "omega": "ω",
}


def typeset_formulas(text: str) -> str:
    """Return a text with the formulas in it typeset: psi1 = pi - phi_2 becomes ψ1 = π − φ₂."""
    text = re.sub(rf"\b({'|'.join(GREEK)})(?=[\W\d_]|$)", lambda match: GREEK[match[0]], text)
    return re.sub(r"_(\d+)\b", lambda index: subscript(index[1]), signed(typeset(text))).replace(" - ", " − ")


DIGITS = 4
NONE = "—"


def note_table(
    subject: Subject, table: Table, caption: str = "", key: str = "", digits: int = DIGITS, *, zeros: bool = False
) -> Rows:
    """Convert a table of results to a table of the note, in the units of the file.

    Args:
        subject: results that the note describes.
        table: table of results. Empty cells get a dash, empty columns are left out.
        caption: caption; by default the title of the table.
        key: key for references; empty if there are none.
        digits: significant figures.
        zeros: True to keep trailing zeros, so that all numbers of a column have the same number of figures.
    """
    units = subject.results.problem.units
    columns = [
        (
            typeset_formulas(typeset_unit(c.heading(units))),
            _format_cells(replace(_typeset_units(c), digits=digits), units, zeros),
            c.dimension,
        )
        for c in table.columns
    ]
    kept = [(head, texts, dimension) for head, texts, dimension in columns if any(texts)]
    texts_by_column = [
        [
            _fill_empty_cell(typeset_formulas(with_degrees(t)) if dimension is None else subject.localise(t))
            for t in texts
        ]
        for __, texts, dimension in kept
    ]
    _move_units(table, texts_by_column)
    rows = tuple(cells(*row) for row in zip(*texts_by_column, strict=True))
    return Rows(caption or table.title, cells(*(head for head, *__ in kept)), rows, key)


def table_over_positions(
    subject: Subject, caption: str, columns: Sequence[tuple[Line, Sequence[str]]], key: str
) -> Rows:
    """Return a table with a row for each position.

    columns: heading of each column, with the texts of its cells.
    """
    rows = zip(map(str, subject.results.numbers), *(texts for __, texts in columns), strict=True)
    head = cells(_("position"), *(head for head, __ in columns))
    return Rows(caption, head, tuple(cells(*row) for row in rows), key)


def join_with_no_break_spaces(text: str) -> str:
    """Replace spaces by no-break spaces."""
    return text.replace(" ", "\N{NO-BREAK SPACE}")


def _move_units(table: Table, texts_by_column: list[list[str]]) -> None:
    """Move units that are written after the names of quantities to the column of units.

    "time, s" becomes "time" in the first column and "s" in the column of units.
    """
    headers = [column.header for column in table.columns]
    if headers != ["what", "value", "unit"] or len(texts_by_column) != len(headers):
        return
    names, units = texts_by_column[0], texts_by_column[2]
    for k, name in enumerate(names):
        quantity, __, unit = name.rpartition(", ")
        if units[k] == NONE and unit in (spelt("J"), spelt("s"), "%"):
            names[k], units[k] = quantity, unit


def _format_cells(column: Column, units: UnitSystem, zeros: bool) -> list[str]:
    """Return the cells of a column as texts. Only very large and very small numbers get a power of ten."""
    if column.dimension is None:
        return cells_of(column, units, range(len(column.values)))
    write = format_fixed if zeros else format_plain
    numbers_and_figures = zip(column.numbers(units).tolist(), printed_figures(column, units).tolist(), strict=True)
    return [
        write(round_figures(value, count), count) if count > 0 else "0" if count == 0 else NONE
        for value, count in numbers_and_figures
    ]


def _fill_empty_cell(text: str) -> str:
    return NONE if text in ("", "-", "−") else text


def _typeset_units(column: Column) -> Column:
    """Return a column with its units typeset. A column that contains no units is returned unchanged."""
    return replace(column, values=[typeset_unit(unit) for unit in column.values]) if column.header == "unit" else column
