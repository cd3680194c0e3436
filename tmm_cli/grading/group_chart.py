"""Chart of a group: distribution of points, hardest quantities, most frequent mistakes."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Iterator, Sequence

import numpy as np

from tmm_cli.batch import Task
from tmm_cli.drawing.formats import drawing_files as pictures
from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    GRID_COLOUR,
    POINT,
    Drawing,
    DrawingSheet,
    Panel,
    filling_axis,
    text_width,
)
from tmm_cli.grading.exports.book import Gradebook
from tmm_cli.grading.record import State, StudentMarks
from tmm_cli.grading.statistics import (
    STEP,
    Difficulty,
    count_by_points,
    percents_of_points,
    rank_difficulties,
    rank_mistakes,
    select_handed_in,
)
from tmm_cli.language import N_, _
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.plans import LANDSCAPE

MOST, FEWEST = 10, 6  # bars that a panel has room for
LONGEST = 32  # characters of a line beside a bar
SMALL, LINE = 8.0, 3.3  # points, mm: texts beside bars
NAMES = 58.0  # mm beside bars for them
LEFT = 16.0  # mm for the numbers of students
UPPER, LOWER, GAP = 55.0, 75.0, 12.0  # mm: heights of the panels, and between them
BLUE, ORANGE, PALE, BAD = "#4a6fa5", "#c77700", "#f9ecd6", "#c4574b"
STATES: dict[State, tuple[str, str]] = {
    "right": (N_("right"), "#4c9a68"),
    "follows": (N_("error carried forward"), "#a9d6b8"),
    "repeated": (N_("same mistake again"), "#d8d08f"),
    "wrong": (N_("wrong"), BAD),
    "missing": (N_("answer missing"), "#d0d0d0"),
}


def draw_group_chart(task: Task, marks: Sequence[StudentMarks]) -> Drawing:
    """Draw the chart of a group on a landscape A4 sheet."""
    own = percents_of_points(marks)
    told = _("students: {students}; answers handed in: {there}; points: median {median:.0f} %, mean {mean:.0f} %")
    caption = told.format(
        students=len(marks),
        there=len(select_handed_in(marks)),
        median=np.median(own) if own.size else 0,
        mean=own.mean() if own.size else 0,
    )
    sheet = DrawingSheet(task.problem.title, caption, paper=LANDSCAPE)
    difficulties, mistakes = rank_difficulties(task, marks)[:MOST], rank_mistakes(marks)[:MOST]
    rows = max(len(difficulties), len(mistakes), FEWEST)
    low, high = sheet.canvas.low, sheet.canvas.high
    half = ((high - low).real - GAP) / 2
    counts = count_by_points(marks)
    upper = filling_axis(0, 1.12 * max(1, counts.max(initial=0)), high.imag - 8 - UPPER, UPPER)
    _draw_histogram(
        Panel(sheet, filling_axis(0, 100, low.real + LEFT, (high - low).real - LEFT - 2), upper), counts, own
    )
    down = filling_axis(rows, 0, low.imag + GAP, LOWER)
    _draw_difficulties(Panel(sheet, filling_axis(0, 100, low.real + NAMES, half - NAMES), down), difficulties)
    most = 1.12 * mistakes[0][1] if mistakes else 1.0
    _draw_mistakes(Panel(sheet, filling_axis(0, most, low.real + half + GAP + NAMES, half - NAMES), down), mistakes)
    return sheet.finish()


def _draw_histogram(panel: Panel, counts: Real, own: Real) -> None:
    _write_title(panel, _("Points"))
    if len(own):
        first, last = (float(panel.x.on(share)) for share in np.quantile(own, (0.25, 0.75)))
        _draw_rectangle(panel, first, last, panel.y.start, panel.y.end, PALE, 0.2)
        median = float(panel.x.on(np.median(own)))
        panel.upright(median, ORANGE, 2, z=4)
        at = panel.x.start + 1j * (panel.y.end + 3)
        entries = [(_("median"), ORANGE), (_("middle 50 % of students"), PALE)]
        _draw_legend(panel, entries, at + panel.x.length - _legend_width(entries))
    _draw_count_lines(panel)
    panel.text(complex(panel.x.start - 1.5, panel.y.end + 3), _("students"), "right")
    for k, count in enumerate(counts):
        if count:
            first, last = (float(panel.x.on(STEP * (k + side))) for side in (0.04, 0.96))
            top = float(panel.y.on(count))
            _draw_rectangle(panel, first, last, panel.y.start, top, BLUE)
            panel.text(complex((first + last) / 2, top + 2), f"{count}", "center")
    panel.level(panel.y.start, DARK_COLOUR, 0.7, 3)
    for share in range(0, 101, STEP):
        panel.text(complex(float(panel.x.on(share)), panel.y.start - 3), f"{share} %", "center")


def _draw_count_lines(panel: Panel) -> None:
    """Draw horizontal grid lines at whole numbers of students."""
    for value, text in panel.y.ticks(6):
        if value == round(value):
            height = float(panel.y.on(value))
            panel.level(height, GRID_COLOUR, 0.5, 0.5)
            panel.text(complex(panel.x.start - 1.5, height), text, "right")


def _draw_difficulties(panel: Panel, found: Sequence[Difficulty]) -> None:
    _write_title(panel, _("Hardest quantities"))
    _draw_vertical_lines(panel, [(float(share), f"{share} %") for share in range(0, 101, 25)])
    for row, own in enumerate(found):
        left = 0.0
        for state, (__, colour) in STATES.items():
            share = 100 * own.answers[state] / max(1, own.answers.total())
            _draw_bar(panel, row, left, left + share, colour)
            left += share
        _write_name(panel, row, own.name)
    entries = [(_(name), colour) for name, colour in STATES.values()]
    middle = complex((panel.sheet.canvas.low.real + panel.x.end - _legend_width(entries)) / 2, panel.y.start - 8)
    _draw_legend(panel, entries, middle)


def _draw_mistakes(panel: Panel, found: Sequence[tuple[str, int, int]]) -> None:
    _write_title(panel, _("Most frequent mistakes"))
    if not found:
        panel.text(complex(panel.x.start, panel.y.end - 4), _("no typical mistake was recognised"))
        return
    _draw_vertical_lines(panel, [(value, text) for value, text in panel.x.ticks(8) if value == round(value)])
    for row, (name, students, __) in enumerate(found):
        _draw_bar(panel, row, 0, students, BAD)
        panel.text(complex(float(panel.x.on(students)) + 1, float(panel.y.on(row + 0.5))), f"{students}")
        _write_name(panel, row, name)
    panel.text(complex((panel.x.start + panel.x.end) / 2, panel.y.start - 8), _("students"), "center")


def _write_title(panel: Panel, text: str) -> None:
    panel.text(complex(panel.x.start, panel.y.end + 3), text, size=10)


def _draw_vertical_lines(panel: Panel, ticks: Iterable[tuple[float, str]]) -> None:
    """Draw vertical grid lines with their values below the panel."""
    for value, text in ticks:
        place = float(panel.x.on(value))
        panel.upright(place, GRID_COLOUR, 0.5, z=0.5)
        panel.text(complex(place, panel.y.start - 3), text, "center")


def _draw_bar(panel: Panel, row: int, first: float, last: float, colour: str) -> None:
    if last > first:
        start, end = (float(panel.x.on(value)) for value in (first, last))
        top, bottom = (float(panel.y.on(row + side)) for side in (0.15, 0.85))
        _draw_rectangle(panel, start, end, bottom, top, colour)


def _write_name(panel: Panel, row: int, name: str) -> None:
    """Write the name of a bar to the left of it, on two lines if it is long."""
    lines = textwrap.wrap(name, LONGEST, max_lines=2, placeholder="…")
    middle = complex(panel.x.start - 1.5, float(panel.y.on(row + 0.5)))
    for k, line in enumerate(lines):
        panel.text(middle - 1j * LINE * (k - (len(lines) - 1) / 2), line, "right")


def _draw_legend(panel: Panel, entries: Iterable[tuple[str, str]], at: complex) -> None:
    """Draw a legend: coloured rectangles, each followed by its text."""
    for text, colour in entries:
        _draw_rectangle(panel, at.real, at.real + 5, at.imag - 1.2, at.imag + 1.2, colour)
        panel.text(at + 6, text)
        at += _legend_width([(text, colour)])


def _legend_width(entries: Iterable[tuple[str, str]]) -> float:
    """Return the width (mm) of a legend."""
    return sum(11 + text_width(text, SMALL * POINT) for text, __ in entries)


def _draw_rectangle(
    panel: Panel, left: float, right: float, low: float, high: float, colour: str, z: float = 2.0
) -> None:
    """Draw a filled rectangle on the paper; coordinates in mm."""
    corners = [complex(left, low), complex(right, low), complex(right, high), complex(left, high)]
    panel.sheet.area(corners, colour, "none", z=z, blocks=False)


# group.png and group.svg: the drawing of the group. Imported when it is drawn: matplotlib is slow to load.


def files(book: Gradebook) -> Iterator[tuple[str, Iterable[bytes]]]:
    """Yield the chart in every drawing format: group.png, group.svg and others, with their contents."""
    for name, picture in pictures([("group", draw_group_chart(book.task, book.marks))]):
        yield name, (picture,)
