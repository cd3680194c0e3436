"""Vector equations in letters, with what is known of each vector: two lines under one known whole, one line under one
whose line is known; and the lines that are known."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

from tmm_cli.language import _
from tmm_cli.linkage import FRAME, Slide
from tmm_cli.note.blocks import Block, Equation, said
from tmm_cli.note.breaking import LINE, width
from tmm_cli.note.kinematics.on_paper import Here, vector
from tmm_cli.note.kinematics.words import name_of
from tmm_cli.note.math import Letter, Node, Number, Words, row
from tmm_cli.plans.record import Symbol
from tmm_cli.plans.vector_equations import About, Along, OnGuide, Spot, Step, VectorEquation

WHOLE, DIRECTION, UNKNOWN = 2, 1, 0  # lines under a vector


def equations(
    here: Here, step: Step, chosen: Sequence[VectorEquation], letter: str, known: Collection[str]
) -> Iterable[Block]:
    """Those of a step, and a line with the directions in them.

    letter: v, or a, whose parts are told apart; known: names of points that are found.
    """
    lined = {
        e.point.name
        for e in step.equations
        if isinstance(e, OnGuide) or (isinstance(e, About) and e.base.fixed and letter == "v")
    }
    told: dict[Node, None] = {}
    for equation in chosen:
        if isinstance(equation, OnGuide):
            told[row(vector(Symbol(letter, equation.point.name)), "∥", guide(equation.slide))] = None
            continue
        terms = list(_parts(equation, letter, here.omega))
        base = Letter(Symbol(letter, equation.base.name), True, _lines(equation.base, known, lined))
        point = Letter(Symbol(letter, equation.point.name), True, _lines(equation.point, known, lined))
        yield Equation(row(point, "=", base, *(node for term, __ in terms for node in ("+", term))))
        for spot in (equation.base, equation.point):
            if spot.fixed:
                told[row(vector(Symbol(letter, spot.name)), "=", Number("0"))] = None
        told |= dict.fromkeys(direction for __, direction in terms)
    yield from _in_lines(list(told))


def of_known_link(here: Here, about: About, letter: str, known: Collection[str]) -> Iterable[Block]:
    """Where the method is explained: that a point belongs to a link whose rotation is known, and its equation."""
    if here.first:
        text = _("Point {point} belongs to link {link}, whose rotation is known:")
        yield said(text, point=name_of(about.point), link=about.link)
        if not about.base.fixed:
            yield from equations(here, Step((), ()), [about], letter, known)


def _in_lines(told: Sequence[Node]) -> Iterable[Block]:
    """Short statements one after another, as many in a line as there is room for."""
    shown: Node | None = None
    for one in told:
        longer = one if shown is None else row(shown, Words(",  "), one)
        if shown is not None and width(longer) > LINE:
            yield Equation(shown)
            longer = one
        shown = longer
    if shown is not None:
        yield Equation(shown)


def _lines(spot: Spot, known: Collection[str], lined: Collection[str]) -> int:
    if spot.fixed or spot.name in known:
        return WHOLE
    return DIRECTION if spot.name in lined else UNKNOWN


def _parts(equation: About | Along, letter: str, turning: Collection[str]) -> Iterable[tuple[Node, Node]]:
    """Relative vectors with their lines, and with what they are along or across."""
    index = equation.point.name + equation.base.name
    sought = WHOLE if equation.known else DIRECTION
    if isinstance(equation, Along):
        way = guide(equation.slide)
        if letter == "v":
            yield _part(Symbol("v", index), sought, "∥", way)
            return
        if equation.slide.carrier in turning:
            yield _part(Symbol("a", index, "k"), WHOLE, "⟂", way)
        yield _part(Symbol("a", index, "r"), sought, "∥", way)
        return
    if equation.idle:
        return
    way = Words(equation.base.at + equation.point.at)
    if letter == "a":
        yield _part(Symbol("a", index, "n"), WHOLE, "∥", way)
    yield _part(Symbol(letter, index, "τ" if letter == "a" else ""), sought, "⟂", way)


def _part(symbol: Symbol, lines: int, sign: str, way: Node) -> tuple[Node, Node]:
    return Letter(symbol, True, lines), row(vector(symbol), sign, way)


def guide(slide: Slide) -> Node:
    """What a guide is called: by its own name on the frame, by its points on a link."""
    if slide.ends is not None:
        return Words("".join(slide.ends))
    if slide.carrier == FRAME:
        return Words(slide.name.partition(".")[0])
    return Words(_("guide of link {link}").format(link=slide.carrier))
