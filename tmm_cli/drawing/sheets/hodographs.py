"""Hodographs: the ends of a force drawn from one pole over the cycle, with the numbers of positions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from tmm_cli.drawing.paper import DARK, LOAD, REACTION, THIN, Drawing, Sheet, Style, Words, safe, scale_words
from tmm_cli.drawing.sheets.diagrams import closely, over_turn
from tmm_cli.drawing.sheets.over_cycle import Course, Quantities
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Results, at_places
from tmm_cli.mechanics.forces import Reaction, reaction_symbol
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import NO_FORCE, SAME_PLACE, Vector
from tmm_cli.mechanics.quantities import FORCE

BEYOND = 8.0  # mm of the axes beyond the curves
HEAD = 1.0  # mm: half the width of their heads
AIR = 30.0  # mm about the figure
LEAP = 0.5  # mm from a place to the next at the end of a stroke
NUMBERED = 24  # positions with numbers, at most


@dataclass(frozen=True)
class Hodograph:
    """A force (N) over the whole cycle, and at the positions; leaps: after which places it may leap."""

    name: Words
    cycle: Vector
    positions: Vector
    colour: str
    style: Style = "-"
    leaps: Sequence[int] = ()


def balancing(results: Results) -> Iterable[tuple[str, Drawing]]:
    """The shaking force before and after balancing."""
    found = results.balancing
    if found is None or not found.cycle.shakes:
        return
    drawn = [Hodograph(_("dashed: without counterweights"), found.cycle.before.force, found.before.force, LOAD, "--")]
    if found.cycle.counterweights:
        name = _("in full: with counterweights") if found.cycle.left > NO_FORCE else _("dot: with counterweights")
        drawn.append(Hodograph(name, found.cycle.after.force, found.after.force, REACTION))
    yield "shaking-force", hodograph(results, _("Hodograph of the shaking force on the frame"), drawn, "F")


def reactions(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Of every pair: the ends of its reaction from one pole, then its parts and its size over the turn of the crank."""
    assert results.reactions is not None
    places, borders = closely(results)
    whole = at_places(results, places)
    assert whole.reactions is not None
    for here, cycle in zip(results.reactions.all, whole.reactions.all, strict=True):
        pair, symbol = here.pair.name, reaction_symbol(here.by, here.on)
        title = _("Hodograph of the reaction {name} in pair {pair}").format(name=symbol.name, pair=pair)
        one = Hodograph("", cycle.force, here.force, REACTION, leaps=borders)
        if np.nanmax(np.abs(cycle.force)) > 0:
            yield safe(f"hodograph-{pair}"), hodograph(results, title, [one], "R")
            yield from _turned(results, whole, here, cycle, borders)
            over = _("Reaction {name} in pair {pair} over the cycle").format(name=symbol.name, pair=pair)
            parts = _parts(cycle.force, here.force)
            yield from over_turn(results, safe(f"reaction-{pair}"), over, places, borders, parts)


def _turned(
    results: Results, whole: Results, here: Reaction, cycle: Reaction, leaps: Sequence[int]
) -> Iterable[tuple[str, Drawing]]:
    """The same in the axes of each link of the pair that turns, and its size in polar axes, by the crank's angle."""
    assert results.motion is not None and whole.motion is not None
    pair, symbol = here.pair.name, reaction_symbol(here.by, here.on)
    for link in (here.by, here.on):
        if link != FRAME and np.ptp(angles := whole.motion.angle(link)) > SAME_PLACE:
            title = _("Hodograph of the reaction {name} in pair {pair}, in axes that turn with link {link}")
            own = np.exp(-1j * angles), np.exp(-1j * results.motion.angle(link))
            one = Hodograph("", cycle.force * own[0], here.force * own[1], REACTION, leaps=leaps)
            named = title.format(name=symbol.name, pair=pair, link=link)
            yield safe(f"hodograph-{pair}-link-{link}"), hodograph(results, named, [one], "R")
    if results.turns:
        title = _("Size of the reaction {name} in pair {pair} in polar axes, against the crank angle")
        size = np.abs(cycle.force) * np.exp(1j * whole.motion.q)
        one = Hodograph("", size, np.abs(here.force) * np.exp(1j * results.motion.q), REACTION, leaps=leaps)
        yield safe(f"polar-{pair}"), hodograph(results, title.format(name=symbol.name, pair=pair), [one], "R")


def _parts(cycle: Vector, here: Vector) -> list[Quantities]:
    """The size of a force, and its parts along the axes of the drawing."""
    parts = [("x", cycle.real, here.real), ("y", cycle.imag, here.imag)]
    size = Course("", np.abs(cycle), np.abs(here))
    return [
        Quantities(_("its size"), FORCE, [size], "R"),
        Quantities(_("its parts along x and y"), FORCE, [Course(*part) for part in parts], "R"),
    ]


def hodograph(results: Results, caption: str, drawn: Sequence[Hodograph], letter: str) -> Drawing:
    """A sheet of hodographs from one pole at one scale; of a force that is nothing beside the others a dot."""
    largest = max(float(np.nanmax(np.abs(one.cycle))) for one in drawn)
    places = [0j, *(complex(p) for one in drawn for p in one.cycle)]
    sheet = Sheet(results.problem.title, caption, places, pad=AIR)
    _axes(sheet, places)
    for one in drawn:
        if one.name:
            sheet.note(one.name)
        if not np.nanmax(np.abs(one.cycle)) > NO_FORCE * largest:
            sheet.circle(sheet.on(0j), 1.0, one.colour, one.colour, 0.3, 6)
            continue
        _curve(sheet, results, one)
        _numbers(sheet, results, one)
    sheet.note(scale_words(letter, sheet.mu, "N/mm"))
    return sheet.finish()


def _curve(sheet: Sheet, results: Results, one: Hodograph) -> None:
    """Its line, which comes back to its beginning; thin and dotted where it leaps."""
    closed = np.append(one.cycle, one.cycle[:1]) if results.turns else one.cycle
    places = sheet.origin + closed / sheet.mu
    leaps = [k for k in one.leaps if abs(places[k + 1] - places[k]) > LEAP]
    sheet.line(np.insert(places, np.array(leaps, int) + 1, np.nan).tolist(), one.colour, 1.4, one.style)
    for k in leaps:
        sheet.line(places[k : k + 2].tolist(), one.colour, 0.7, ":")


def _axes(sheet: Sheet, places: Sequence[complex]) -> None:
    """Through the pole, along the axes of the drawing."""
    on = np.array([sheet.on(place) for place in places if np.isfinite(place)])
    pole = sheet.on(0j)
    for along, low, high, name in (
        (1 + 0j, on.real.min() - pole.real, on.real.max() - pole.real, "x"),
        (1j, on.imag.min() - pole.imag, on.imag.max() - pole.imag, "y"),
    ):
        start, end = pole + along * (low - BEYOND), pole + along * (high + BEYOND)
        sheet.line([start, end], THIN, 0.7, z=1.0, faint=True)
        sheet.area([end, end - (3 + HEAD * 1j) * along, end - (3 - HEAD * 1j) * along], THIN, "none", z=1.0)
        sheet.label(name, end, 9)
    sheet.circle(pole, 0.7, "white", DARK, 0.8)


def _numbers(sheet: Sheet, results: Results, one: Hodograph) -> None:
    """Numbers of positions along it."""
    step = -(-len(results.numbers) // NUMBERED)
    for number, value in list(zip(results.numbers, one.positions.tolist(), strict=True))[::step]:
        if np.isfinite(value):
            sheet.circle(sheet.on(value), 0.6, one.colour, one.colour, 0.3)
            sheet.label(str(number), sheet.on(value), 8, one.colour)
