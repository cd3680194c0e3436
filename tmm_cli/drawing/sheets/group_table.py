"""Sheet with a table of the Assur groups of classes II to VI, by class and order.

Links are drawn as bars, or as plates if they have three pairs; pairs as hinges or sliding blocks; external pairs with
dotted stubs.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

from tmm_cli.drawing.paper import DARK_COLOUR, GREY_TEXT, Drawing, DrawingSheet, divide_into_cells
from tmm_cli.language import _
from tmm_cli.mechanics.numerics import unit
from tmm_cli.mechanics.plans import LANDSCAPE
from tmm_cli.mechanics.structure import ROMAN

COLUMNS, ROWS = 4, 3  # of the sheet
CELL_GAP = 4.0  # mm
CAPTION_HEIGHT = 11.0  # mm of the caption below a group
PAIR_STUB = 6.5  # mm: dotted stub at an external pair
HINGE_RADIUS = 1.1  # mm
BLOCK_SIZE = (5.6, 3.0)  # mm: length and height of a sliding block
PLATE_COLOUR = "#e8edf2"


@dataclass(frozen=True)
class GroupExample:
    """An Assur group in the table of groups.

    Attributes:
        group_class: class of the group.
        order: order of the group.
        name: type of a dyad, e.g. "RRP"; empty for other groups.
        points: positions of its pairs in a square with side 1, by letter.
        links: links, each given by the letters of its pairs.
        external: directions (deg) in which external pairs are connected to other links, by letter.
        prismatic: directions (deg) of the guides of prismatic pairs, by letter.
    """

    group_class: int
    order: int
    name: str
    points: Mapping[str, complex]
    links: tuple[str, ...]
    external: Mapping[str, float]
    prismatic: Mapping[str, float] = field(default_factory=dict)

    @property
    def pairs(self) -> list[tuple[str, tuple[str, ...]]]:
        """Pairs by letter, each with the links that it connects; only one link for an external pair."""
        return [(point, tuple(link for link in self.links if point in link)) for point in self.points]


def _dyad(name: str, prismatic: Mapping[str, float]) -> GroupExample:
    points = {"A": 0.12 + 0.25j, "B": 0.5 + 0.8j, "C": 0.88 + 0.25j}
    return GroupExample(2, 2, name, points, ("AB", "BC"), {"A": 250, "C": 290}, prismatic)


GROUP_EXAMPLES: tuple[GroupExample, ...] = (
    _dyad("RRR", {}),
    _dyad("RRP", {"C": 0}),
    _dyad("RPR", {"B": 55}),
    _dyad("PRP", {"A": 0, "C": 0}),
    _dyad("RPP", {"B": 55, "C": 0}),
    GroupExample(
        3,
        3,
        "",
        {"P": 0.35 + 0.45j, "Q": 0.65 + 0.45j, "R": 0.5 + 0.7j, "A": 0.1 + 0.15j, "B": 0.9 + 0.15j, "C": 0.5 + 1.0j},
        ("PQR", "PA", "QB", "RC"),
        {"A": 225, "B": 315, "C": 90},
    ),
    GroupExample(
        3,
        4,
        "",
        {
            "M": 0.5 + 0.55j,
            "P": 0.3 + 0.75j,
            "Q": 0.3 + 0.4j,
            "R": 0.7 + 0.75j,
            "S": 0.7 + 0.4j,
            "A": 0.05 + 0.95j,
            "B": 0.05 + 0.15j,
            "C": 0.95 + 0.95j,
            "D": 0.95 + 0.15j,
        },
        ("MPQ", "MRS", "PA", "QB", "RC", "SD"),
        {"A": 135, "B": 225, "C": 45, "D": 315},
    ),
    GroupExample(
        4,
        2,
        "",
        {"P": 0.3 + 0.75j, "Q": 0.3 + 0.3j, "R": 0.7 + 0.75j, "S": 0.7 + 0.3j, "A": 0.05 + 0.5j, "B": 0.95 + 0.5j},
        ("PQA", "RSB", "PR", "QS"),
        {"A": 200, "B": 340},
    ),
    GroupExample(
        4,
        3,
        "",
        {
            "P": 0.3 + 0.75j,
            "Q": 0.3 + 0.35j,
            "R": 0.7 + 0.75j,
            "S": 0.7 + 0.35j,
            "T": 0.5 + 0.12j,
            "A": 0.03 + 0.55j,
            "B": 0.97 + 0.55j,
            "U": 0.1 + 0.95j,
            "V": 0.9 + 0.95j,
        },
        ("PQA", "RSB", "PR", "QST", "AU", "BV"),
        {"U": 120, "V": 60, "T": 270},
    ),
    GroupExample(
        5,
        3,
        "",
        {
            "P": 0.5 + 0.9j,
            "Q": 0.2 + 0.65j,
            "R": 0.32 + 0.3j,
            "S": 0.68 + 0.3j,
            "T": 0.8 + 0.65j,
            "A": 0.12 + 0.95j,
            "B": 0.5 + 0.08j,
            "C": 0.98 + 0.4j,
            "D": 0.98 + 0.05j,
        },
        ("PQA", "QR", "RSB", "STC", "TP", "CD"),
        {"A": 110, "B": 270, "D": 300},
    ),
    GroupExample(
        6,
        3,
        "",
        {
            "P": 0.35 + 0.9j,
            "Q": 0.15 + 0.55j,
            "R": 0.35 + 0.2j,
            "S": 0.65 + 0.2j,
            "T": 0.85 + 0.55j,
            "U": 0.65 + 0.9j,
            "A": 0.05 + 0.9j,
            "B": 0.5 + 0.02j,
            "C": 0.95 + 0.9j,
        },
        ("PQA", "QR", "RSB", "ST", "TUC", "UP"),
        {"A": 120, "B": 270, "C": 60},
    ),
)


def draw_group_table() -> Iterator[tuple[str, Drawing]]:
    """Yield the table, as (stem of the file name, drawing)."""
    sheet = DrawingSheet(
        _("Assur groups of classes II to VI"), _("By class and order; dotted lines: external pairs"), paper=LANDSCAPE
    )
    size, corners = divide_into_cells(sheet.canvas.low, sheet.canvas.high, COLUMNS, ROWS, CELL_GAP)
    for example, (low, high) in zip(GROUP_EXAMPLES, corners, strict=False):
        side = min(size.real, size.imag - CAPTION_HEIGHT) - 2 * PAIR_STUB
        middle = (low + high + 1j * CAPTION_HEIGHT) / 2
        _draw_example(sheet, example, middle - side * (0.5 + 0.5j), side)
        words = _("class {number}, order {order}").format(number=ROMAN[example.group_class], order=example.order)
        at = complex((low + high).real / 2, low.imag + 2)
        sheet.text(at, f"{words}: {example.name}" if example.name else words, 9, colour=GREY_TEXT, ha="center")
    yield "assur-groups", sheet.finish()


def _draw_example(sheet: DrawingSheet, example: GroupExample, corner: complex, side: float) -> None:
    at = {name: corner + side * point for name, point in example.points.items()}
    for name, turn in example.external.items():
        direction = _direction(turn)
        sheet.line([at[name], at[name] + PAIR_STUB * direction], DARK_COLOUR, 0.8, ":")
    with sheet.on_layer("links"):
        for link in example.links:
            corners = [at[point] for point in link]
            if len(link) > 2:
                sheet.area(corners, PLATE_COLOUR, DARK_COLOUR, 1.0, 2)
            else:
                sheet.line(corners, DARK_COLOUR, 1.6)
        for name, place in at.items():
            if name in example.prismatic:
                along = _direction(example.prismatic[name])
                length, height = (
                    side_length / 2 * direction
                    for side_length, direction in zip(BLOCK_SIZE, (along, 1j * along), strict=True)
                )
                sheet.area(
                    [
                        place + length + height,
                        place - length + height,
                        place - length - height,
                        place + length - height,
                    ],
                    "white",
                    DARK_COLOUR,
                    1.0,
                    5,
                )
                sheet.line([place - 2 * length, place + 2 * length], DARK_COLOUR, 0.6, "-.")
            else:
                sheet.circle(place, HINGE_RADIUS, "white", DARK_COLOUR, 1.0)


def _direction(degrees: float) -> complex:
    return complex(unit(math.radians(degrees)))
