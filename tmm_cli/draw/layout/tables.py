"""Tables as drawings: words and numbers in ruled cells, folded into parts beside one another where they are long."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from tmm_cli.draw.paper.drawing import Line, Mark, Text
from tmm_cli.draw.paper.picture import Picture, longest_for, picture
from tmm_cli.draw.paper.script import Words, pieces, width
from tmm_cli.draw.paper.writing import DARK, cut

SIZE = 3.2  # mm: letters of a table as it comes
BOLD, FINE = 0.5, 0.2  # mm: lines
AIR, ROW = 1.4, 1.7  # of the size: room beside a text, height of a row
FOLDED = 28  # rows, beyond which a table goes on beside itself
APART = 3.0  # of the size, between two parts
WIDEST = 24.0  # of the size: a longer text is cut


def table(title: str, heads: Sequence[Words], rows: Sequence[Sequence[Words]], notes: Sequence[str] = ()) -> Picture:
    """A table, its letters as large as the room lets them be."""
    cells = [[cut(one, 1.0, WIDEST) if isinstance(one, str) else one for one in row] for row in (heads, *rows)]
    columns = [max(width(row[k], 1.0) for row in cells) + AIR for k in range(len(heads))]
    parts = max(math.ceil(len(rows) / FOLDED), 1)
    most = math.ceil(len(rows) / parts)
    step = sum(columns) + APART
    across, up = parts * step - APART, ROW * (most + 1)
    longest = longest_for(SIZE * max(across, up))
    size = longest / max(across, up)
    marks: list[Mark] = []
    for part in range(parts):
        here = [cells[0], *cells[1 + part * most : 1 + (part + 1) * most]]
        marks += [mark.moved(part * size * step + 0j) for mark in _part(here, [size * wide for wide in columns], size)]
    return picture(marks, title, longest, notes=notes)


def _part(cells: Sequence[Sequence[Words]], columns: Sequence[float], size: float) -> list[Mark]:
    """Rows below one another, the heads first; words begin at the left, numbers end at the right."""
    row, wide = ROW * size, sum(columns)
    edges = [sum(columns[:k]) for k in range(len(columns) + 1)]
    high = [-row * k for k in range(len(cells) + 1)]
    marks: list[Mark] = [
        Line((1j * y, wide + 1j * y), DARK, BOLD if k in (0, 1, len(cells)) else FINE, layer="text")
        for k, y in enumerate(high)
    ]
    marks += [
        Line((complex(x, high[-1]), complex(x, 0)), DARK, BOLD if x in (0.0, edges[-1]) else FINE, layer="text")
        for x in edges
    ]
    for k, (start, end) in enumerate(pairwise(edges)):
        numbers = all(_number(line[k]) for line in cells[1:])
        for line, y in zip(cells, high, strict=False):
            at = complex(start + AIR / 2 * size, y - row / 2)
            if numbers:
                at = complex(end - AIR / 2 * size - width(line[k], size), y - row / 2)
            for off, letters, own in pieces(line[k], size):
                if letters:
                    marks.append(Text(at + off, letters, own, DARK))
    return marks


def _number(text: Words) -> bool:
    return isinstance(text, str) and (not text or text == "-" or text.lstrip("+-−")[:1].isdigit())
