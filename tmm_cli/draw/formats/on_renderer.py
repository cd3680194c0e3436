"""A drawing on one of matplotlib's renderers: they take paths and texts, no figure or axes stands between."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from itertools import groupby

import numpy as np
from matplotlib.backend_bases import GraphicsContextBase, RendererBase
from matplotlib.colors import to_rgb
from matplotlib.path import Path
from matplotlib.transforms import Affine2D

from tmm_cli.draw.paper.drawing import POINT, Area, Circle, Drawing, Line, Mark, Text
from tmm_cli.draw.paper.fonts import HALF, start

Write = Callable[[RendererBase, GraphicsContextBase, Sequence[Text], Affine2D], None]


def draw(drawing: Drawing, renderer: RendererBase, dpi: float, write: Write) -> None:
    """All marks, those that cover others last.

    write: puts texts of one colour there, from millimetres to the renderer's points.
    """
    to_pixels = Affine2D().scale(dpi / 25.4)
    for colour, marks in groupby(drawing.marks, lambda mark: mark.colour if isinstance(mark, Text) else None):
        if colour is None:
            for mark in marks:
                _shape(mark, renderer, to_pixels)
        else:
            context = renderer.new_gc()
            context.set_foreground(colour)
            write(renderer, context, [mark for mark in marks if isinstance(mark, Text)], to_pixels)
            context.restore()


def _shape(mark: Mark, renderer: RendererBase, to_pixels: Affine2D) -> None:
    context = renderer.new_gc()
    match mark:
        case Line():
            _pen(context, mark.colour, mark.width)
            context.set_capstyle("round")
            context.set_joinstyle("round")
            if mark.dashes:
                context.set_dashes(0, [length / POINT for length in mark.dashes])
            renderer.draw_path(context, _path(mark.places), to_pixels)
        case Area():
            _pen(context, mark.edge or mark.face, mark.width if mark.edge else 0.0)
            renderer.draw_path(context, _path(mark.corners, closed=True), to_pixels, to_rgb(mark.face))
        case Circle():
            _pen(context, mark.edge, mark.width)
            shape = Path.circle((mark.centre.real, mark.centre.imag), mark.radius)
            renderer.draw_path(context, shape, to_pixels, to_rgb(mark.face))
    context.restore()


def _pen(context: GraphicsContextBase, colour: str, wide: float) -> None:
    context.set_foreground(colour)
    context.set_linewidth(wide / POINT)


def foot(mark: Text) -> tuple[complex, complex]:
    """The left end of the base line of a text, mm, and the way along it."""
    along = cmath.rect(1, math.radians(mark.turn))
    return start(mark) - 1j * HALF * mark.size * along, along


def _path(places: Sequence[complex], *, closed: bool = False) -> Path:
    array = np.array([*places, places[0]] if closed else places)
    return Path(np.column_stack([array.real, array.imag]), closed=closed)
