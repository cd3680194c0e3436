"""The large sheets of a project: drawings made as large as fits, put beside one another, framed."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain

from tmm_cli.draw.drawing import Drawing
from tmm_cli.draw.layout.contents import CONTENTS, SUBJECTS, Choice, Source
from tmm_cli.draw.layout.packing import Field, pack, spread
from tmm_cli.draw.layout.pieces import GAP, Page, Piece, arranged, spaced
from tmm_cli.draw.layout.room import Block, Room, within
from tmm_cli.draw.layout.title_block import SIZES, Titles, frame, inner, title_block
from tmm_cli.errors import _

PAPERS = {"A1": (841.0, 594.0), "A2": (594.0, 420.0), "A3": (420.0, 297.0)}
EDGE = 5.0  # mm between the frame and what is drawn
LEGIBLE = 0.8  # of its letters as they come: a table is not made smaller
MANY = 1.5  # drawings of a source, beyond which each is smaller
TRIES = 8  # of drawing everything as large as it was thought to become

Sized = tuple[list[Block], list[Page]]


def large_sheets(choice: Choice, paper: str) -> Iterator[tuple[str, Drawing]]:
    """Every sheet with its file's stem; what does not fit on one goes on as 1a, 1b."""
    field = field_of(paper, choice)
    found = [(number, *_sheet(number, choice, paper, field)) for number in range(len(SUBJECTS))]
    count = sum(len(pages) for __, ___, pages in found)
    for number, blocks, pages in found:
        for letter, page in zip(chain([""], "abcdefghijklmnopqrstuvwxyz"), pages, strict=False):
            name = f"{number}{letter}"
            problem = choice.results.problem
            titles = Titles(problem.title_texts, problem.title, SUBJECTS[number], name, count)
            yield f"sheet-{name}", framed([blocks[k] for k in page], field, PAPERS[paper], titles)
