"""Force plans: closed polygons to scale, with a table of their vectors; what would lie in one line is spread apart."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    NOTE_SIZE,
    POINT,
    THIN_COLOUR,
    VECTOR_COLOURS,
    Drawing,
    DrawingSheet,
    FigureExtent,
    NoteBlock,
    TableRow,
    Words,
    choose_scale,
    file_safe_name,
    gather_coincident,
    scale_words,
    wrap_symbols,
    writes_equations,
)
from tmm_cli.drawing.sheets.group_loads import format_figures
from tmm_cli.drawing.sheets.mechanism import Position
from tmm_cli.language import _, numeral, spelt
from tmm_cli.mechanics.numerics import NO_FORCE, cross, dot
from tmm_cli.mechanics.plans import ForcePlan, NamedVector, extent, force_plans

PLAN_MARGIN, LANE_WIDTH = (
    9.0,
    5.0,
)  # mm about the lines of a plan, for letters; between vectors that would lie on one another
LEAST_NAMED = 4.0  # mm: a shorter vector has no name beside it, only in the table
EQUATION_WIDTH = 120.0  # mm: lines of the equation are no longer
OVERLAP_WITHIN = 0.01  # of a plan: lines nearer than this lie on one another
LEAST_DIFFERENCE = 0.03  # of a plan: a vector that differs from another one by less is not drawn beside it


def draw_force_plans(here: Position) -> Iterable[tuple[str, Drawing]]:
    """A sheet for the polygon of each group and of the driving link."""
    if here.results.reactions is None:
        return
    for plan in force_plans(here.results.reactions, here.k, here.motion):
        title = _("Force plan of link {links}. {caption}")
        if plan.driving:
            title = _("Force plan of the driving link {links}. {caption}")
        elif len(plan.links) > 1:
            title = _("Force plan of links {links}. {caption}")
        kind = "links" if len(plan.links) > 1 else "link"
        yield (
            file_safe_name("-".join([here.stem("forces"), kind, *plan.links])),
            _force_plan_sheet(here, plan, title).finish(),
        )


def _force_plan_sheet(here: Position, plan: ForcePlan, title: str) -> DrawingSheet:
    drawn = [*plan.plan.drawn(), *distinct_reactions(plan)]
    aside = lane_offsets(drawn, plan.plan.size)
    ground = FigureExtent()
    ground.spots([0j], PLAN_MARGIN)
    for vector, off in zip(drawn, aside, strict=True):
        ground.line(vector.start, vector.end, PLAN_MARGIN, off)
    equation = list(wrap_symbols(_force_sum(plan), NOTE_SIZE * POINT, EQUATION_WIDTH)) if writes_equations() else []
    # how wide the table is hardly hangs on the scale
    notes = [*equation, "μ = 0.0000 N/mm"]
    found = choose_scale(ground, NoteBlock(notes, force_plan_rows(plan, plan.plan.size / 100 or 1.0), 3))
    sheet = here.sheet(title, room=found, links=", ".join(plan.links))
    _join_corners(sheet, drawn, aside)
    for vector, off in zip(drawn, aside, strict=True):
        _draw_force(sheet, vector, off, full=vector in plan.full)
    for line in equation:
        sheet.note(line)
    sheet.note(scale_words("F", sheet.mu, "N/mm"))
    sheet.table(force_plan_rows(plan, sheet.mu), 3)
    return sheet


def _force_sum(plan: ForcePlan) -> Words:
    """The sum of all vectors, which is nothing."""
    symbols = [v.symbol for v in plan.plan.vectors if v.kind != "inner"]
    return (*(part for symbol in symbols[:-1] for part in (symbol, " + ")), *symbols[-1:], " = 0")


def distinct_reactions(plan: ForcePlan) -> list[NamedVector]:
    """Reactions that are seen beside their parts."""
    least = LEAST_DIFFERENCE * plan.plan.size
    return [
        full
        for full in plan.full
        if abs(full.value) > least and all(abs(full.value - v.value) > least for v in plan.plan.vectors)
    ]


def force_plan_rows(plan: ForcePlan, mu: float) -> list[TableRow]:
    """Every vector with its size, its length on paper and its direction; then reactions of which it has the parts."""
    rows = [TableRow((_("vector"), spelt("N"), spelt("mm"), _("from x")), head=True)]
    least = NO_FORCE * plan.plan.size
    for vector in (*plan.plan.vectors, *plan.full):
        size = abs(vector.value) if abs(vector.value) > least else 0.0
        angle = f"{numeral(round(float(np.degrees(np.angle(vector.value))), 1) % 360, '.1f')}°" if size else ""
        rows.append(TableRow((vector.symbol, format_figures(size), numeral(size / mu, ".1f"), angle)))
    return rows


def lane_offsets(vectors: Sequence[NamedVector], size: float) -> list[complex]:
    """How far each vector is drawn off its place (mm, across it) so that none lies on another.

    Long ones of the polygon stay where they are; the others go outward.
    """
    middle = extent([p for v in vectors for p in (v.start, v.end)] or [0j])[3]
    taken: dict[int, int] = {}
    found = [0j] * len(vectors)
    for number in sorted(range(len(vectors)), key=lambda n: (vectors[n].kind == "inner", -abs(vectors[n].value))):
        vector = vectors[number]
        used = {lane for other, lane in taken.items() if _overlaps(vector, vectors[other], size)}
        taken[number] = next(n for n in range(len(vectors) + 1) if n not in used)
        along = vector.value / abs(vector.value)
        upward = along if (round(along.imag, 6), along.real) > (0, 0) else -along
        inward = dot(-1j * upward, (vector.start + vector.end) / 2 - middle) < -OVERLAP_WITHIN * size
        found[number] = (1j if inward else -1j) * upward * LANE_WIDTH * taken[number]
    return found


def _overlaps(one: NamedVector, other: NamedVector, size: float) -> bool:
    """Whether two vectors would be seen as one line."""
    short, long = sorted((one, other), key=lambda vector: abs(vector.value))
    along = long.value / abs(long.value)
    if max(abs(cross(along, p - long.start)) for p in (short.start, short.end)) > OVERLAP_WITHIN * size:
        return False
    low, high = sorted(float(dot(along, p - long.start)) for p in (short.start, short.end))
    return min(high, abs(long.value)) - max(low, 0.0) > OVERLAP_WITHIN * size


def _join_corners(sheet: DrawingSheet, vectors: Sequence[NamedVector], aside: Sequence[complex]) -> None:
    """Thin lines that join what belongs to one corner of the polygon where its vectors are spread apart."""
    ends = [(sheet.on(p), sheet.on(p) + off) for v, off in zip(vectors, aside, strict=True) for p in (v.start, v.end)]
    for _at, places in gather_coincident(ends):
        apart = [place for place in places if abs(place - places[0]) > 0.1 * LANE_WIDTH]
        for place in apart:
            sheet.line([places[0], place], THIN_COLOUR, 0.5, z=2.0)


def _draw_force(sheet: DrawingSheet, vector: NamedVector, off: complex, *, full: bool) -> None:
    start, end = sheet.on(vector.start) + off, sheet.on(vector.end) + off
    colour, length = VECTOR_COLOURS[vector.kind], abs(end - start)
    if vector.kind == "inner" or full:
        sheet.line([start, end], colour, 0.9, "-." if full else "--", 4)
        sheet.arrow(end - min(6.0, length) * (end - start) / length, end, colour, 0.9)
    else:
        sheet.arrow(start, end, colour, 1.6)
        sheet.circle(end, 0.45, DARK_COLOUR, DARK_COLOUR, 0.3, 6)
    if length > LEAST_NAMED:
        sheet.label(vector.symbol, (start + end) / 2, 10, colour)
