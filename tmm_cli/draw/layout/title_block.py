"""The frame of a sheet and its title block: GOST 2.104, form 1 (185 x 55 mm), or a plain one."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from tmm_cli.draw.paper.drawing import Line, Mark
from tmm_cli.draw.paper.writing import DARK, written
from tmm_cli.language import _
from tmm_cli.problem.schema_sheet import SheetTexts

LEFT, EDGE = 20.0, 5.0  # mm: the frame from the left edge of the paper, and from the others
BOLD, FINE = 0.6, 0.25  # mm: main and thin lines
SIZES = {"gost": (185.0, 55.0), "plain": (140.0, 32.0)}
SMALL, USUAL, LARGE = 2.8, 3.5, 5.0  # mm: sizes of letters' bodies


@dataclass(frozen=True)
class Titles:
    """What is written into the block of one sheet; number: which of `count` it is."""

    texts: SheetTexts
    title: str
    subject: str
    number: int
    count: int


def frame(paper: tuple[float, float]) -> Line:
    """The frame of the field."""
    low, high = inner(paper)
    return _rectangle(low, high)


def inner(paper: tuple[float, float]) -> tuple[complex, complex]:
    """Corners of the field within the frame."""
    return complex(LEFT, EDGE), complex(paper[0] - EDGE, paper[1] - EDGE)


def title_block(titles: Titles, corner: complex) -> Iterable[Mark]:
    """The block, its lower right corner here."""
    kind = titles.texts.block
    low = corner - SIZES[kind][0]
    marks = _gost(titles) if kind == "gost" else _plain(titles)
    return [mark.moved(low) for mark in marks]


def _gost(titles: Titles) -> list[Mark]:
    texts = titles.texts
    marks: list[Mark] = [_rectangle(0j, 185 + 55j)]
    marks += _lines("x", ((17, 0, 55), (40, 0, 55), (55, 0, 55), (65, 0, 55), (7, 30, 55), (135, 0, 40)), BOLD)
    marks += _lines("x", ((150, 20, 40), (167, 20, 40), (155, 15, 20)), BOLD)
    marks += _lines("x", ((140, 20, 35), (145, 20, 35)), FINE)
    marks += _lines("y", ((30, 0, 65), (35, 0, 65), (40, 65, 185), (15, 65, 185), (35, 135, 185), (20, 135, 185)), BOLD)
    marks += _lines("y", [(y, 0, 65) for y in (5, 10, 15, 20, 25, 40, 45, 50)], FINE)
    heads = ((0, 7, _("Rev.")), (7, 17, _("Sheet")), (17, 40, _("Doc. No.")), (40, 55, _("Sign.")), (55, 65, _("Date")))
    for start, end, word in heads:
        marks += written(word, complex(start, 30), complex(end, 35), SMALL)
    roles = ((25, _("Drawn"), texts.student), (20, _("Checked"), texts.teacher), (15, _("Techn."), ""),
             (5, _("Norms"), ""), (0, _("Approved"), ""))  # fmt: skip
    for low, role, name in roles:
        marks += written(role, complex(0, low), complex(17, low + 5), SMALL, "left")
        marks += written(name, complex(17, low), complex(40, low + 5), SMALL, "left")
    marks += written(texts.code, 65 + 40j, 185 + 55j, 1.4 * LARGE)
    marks += written(titles.title, 65 + 26j, 135 + 40j, LARGE, lines=2)
    marks += written(titles.subject, 65 + 15j, 135 + 26j, USUAL, lines=2)
    for start, end, word in ((135, 150, _("Stage")), (150, 167, _("Mass")), (167, 185, _("Scale"))):
        marks += written(word, complex(start, 35), complex(end, 40), SMALL)
    marks += written(_("Sheet {number}").format(number=titles.number), 135 + 15j, 155 + 20j, SMALL)
    marks += written(_("Sheets {count}").format(count=titles.count), 155 + 15j, 185 + 20j, SMALL)
    institution = " ".join(part for part in (texts.department, texts.group) if part)
    return [*marks, *written(institution, 135 + 0j, 185 + 15j, USUAL, lines=3)]


def _plain(titles: Titles) -> list[Mark]:
    texts = titles.texts
    marks: list[Mark] = [_rectangle(0j, 140 + 32j)]
    marks += _lines("y", ((8, 0, 140), (16, 0, 140), (24, 0, 140)), FINE)
    marks += _lines("x", ((105, 16, 32), (85, 0, 16), (20, 0, 16), (105, 0, 16)), FINE)
    cells = (
        (0, 24, 105, titles.title), (105, 24, 140, texts.code), (0, 16, 105, titles.subject),
        (105, 16, 140, _("sheet {number} of {count}").format(number=titles.number, count=titles.count)),
        (0, 8, 20, _("Student")), (20, 8, 85, texts.student), (85, 8, 105, _("Group")), (105, 8, 140, texts.group),
        (0, 0, 20, _("Teacher")), (20, 0, 85, texts.teacher), (85, 0, 105, _("Department")),
        (105, 0, 140, texts.department),
    )  # fmt: skip
    for left, low, right, text in cells:
        marks += written(text, complex(left, low), complex(right, low + 8), USUAL, "left", lines=2)
    return marks


def _rectangle(low: complex, high: complex) -> Line:
    across = (high - low).real
    return Line((low, low + across, high, high - across, low), DARK, BOLD, layer="frame", z=8.0)


def _lines(axis: str, every: Sequence[tuple[float, float, float]], width: float) -> list[Line]:
    """Lines at a distance along one axis, from and to along the other."""
    ends = [(complex(at, a), complex(at, b)) if axis == "x" else (complex(a, at), complex(b, at)) for at, a, b in every]
    return [Line(pair, DARK, width, layer="frame", z=8.0) for pair in ends]
