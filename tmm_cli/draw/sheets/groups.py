"""The Assur groups apart: each alone at its pose, its leads free, with its class, order and type; and the driver."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from tmm_cli.analysis.pipeline import Results
from tmm_cli.draw.paper.drawing import Drawing
from tmm_cli.draw.paper.ground import Ground
from tmm_cli.draw.paper.picture import on_large_sheet
from tmm_cli.draw.paper.room import snug
from tmm_cli.draw.paper.sheet import DARK, THIN, Sheet, cells, safe
from tmm_cli.draw.sheets.structure import Part, at_sketch, counted, parts
from tmm_cli.draw.symbols.forms import Form
from tmm_cli.draw.symbols.parts import FREE, STRUCTURAL, Look, box, numbers, quiet, rails, symbol_size
from tmm_cli.draw.symbols.render import arrows, names, render, spot
from tmm_cli.draw.symbols.scene import BEYOND, Scene, fitted
from tmm_cli.draw.symbols.wheel_symbols import draw
from tmm_cli.language import _, printed
from tmm_cli.linkage import FRAME
from tmm_cli.plans.record import LANDSCAPE
from tmm_cli.results.reports.structure import ROLES
from tmm_cli.structure.assur import Pair

LEAST, A_LINK = 20.0, 38.0  # mm: a part is not drawn larger than this and so much more a link
A_SHEET, A_ROW = 6, 3  # parts of a mechanism on one sheet and in one row of it
LINE, PAD, GAP = 4.6, (17.0, 12.5), 6.0  # mm: a line of a caption, room about a group (few, many), between two
WORDS = 110.0  # mm: width of a caption on a large sheet
STUB = 8.0  # mm of what a lead would be joined to


def all_groups(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Sheets of the groups at the sketch; none when the linkage cannot be assembled there."""
    found = at_sketch(results)
    return () if found is None else groups(results.problem.title, *found, results.roles)


def groups(
    title: str, place: str, scene: Scene, roles: Mapping[str, str] | None = None
) -> Iterable[tuple[str, Drawing]]:
    """All groups side by side, on more than one sheet when there are many; on large sheets each alone."""
    every = parts(scene.structure)
    if on_large_sheet():
        for part in every:
            yield safe(f"groups-{part.title}"), _alone(title, scene, part, roles or {}).finish()
        return
    for first in range(0, len(every), A_SHEET):
        stem = "groups" if first == 0 else f"groups-sheet-{first // A_SHEET + 1}"
        yield stem, side_by_side(title, place, scene, every[first : first + A_SHEET], roles or {}).finish()


def _alone(title: str, scene: Scene, part: Part, roles: Mapping[str, str]) -> Sheet:
    """One part on a large sheet, below its caption."""
    words = caption(part, scene.structure.pairs, roles, WORDS)
    sheet = Sheet(title, words[0], room=snug(scene.extent(part.links), PAD[0], 0.0))
    sheet.remarks = words[1:]
    _part(sheet, scene, part, PAD[0])
    return sheet


def side_by_side(title: str, place: str, scene: Scene, every: Sequence[Part], roles: Mapping[str, str]) -> Sheet:
    """A sheet of these parts, each in a cell with its caption below it."""
    subject = _("Assur groups apart, {place}; dashed: what the leads are joined to").format(place=place)
    sheet = Sheet(title, subject, paper=LANDSCAPE)
    rows = math.ceil(len(every) / A_ROW)
    columns = math.ceil(len(every) / rows)
    size, places = cells(sheet.ground.low, sheet.ground.high, columns, rows, GAP)
    told = [caption(part, scene.structure.pairs, roles, size.real) for part in every]
    for index, (part, words, (low, high)) in enumerate(zip(every, told, places, strict=False)):
        row, column = divmod(index, columns)
        lines = max(map(len, told[row * columns : (row + 1) * columns]))
        if column:
            x = low.real - GAP / 2
            sheet.line([complex(x, low.imag), complex(x, high.imag)], THIN, 0.4, blocks=False)
        sheet.ground = Ground(low + 1j * (LINE * (lines + 0.5)), high)
        top = low + 1j * LINE * (lines - 0.5)
        sheet.text(top, words[0], 11, colour=part.colour, weight="bold")
        for line, text in enumerate(words[1:], 1):
            sheet.text(top - 1j * LINE * line, text, 8.5)
        _part(sheet, scene, part, PAD[rows > 1])
    return sheet


def caption(part: Part, pairs: Iterable[Pair], roles: Mapping[str, str], width: float) -> list[str]:
    """What a part is, in lines that fit a width (mm)."""
    links = ", ".join(f"{n} {_(ROLES[roles[n]])}" if n in roles else n for n in part.links)
    if part.redundant is not None:
        q = _("redundant, adds q = {q}").format(q=part.redundant.constraints)
        words = [q, _("links: {links}").format(links=links)]
        words.append(_("pairs: {pairs}").format(pairs=_listed(pairs_outside(part, pairs))))
    elif part.group is None:
        words = [_("primary mechanism: driver and frame"), _("links: {links}").format(links=links)]
        driving = [pair for pair in pairs if FRAME in (pair.i, pair.j) and {pair.i, pair.j} <= {FRAME, *part.links}]
        if driving:
            words.append(_("driving pair: {pair}").format(pair=_listed(driving[-1:])))
    else:
        group = part.group
        words = [
            _("class {roman}, order {order}, type {type}").format(
                roman=group.roman, order=group.order, type=counted(group.type)
            ),
            _("links: {links}").format(links=links),
        ]
        if group.inner:
            words.append(_("inner pairs: {pairs}").format(pairs=_listed(group.inner)))
        words.append(_("outer pairs: {pairs}").format(pairs=_listed(group.outer)))
        if group.drivers:
            drivers = ", ".join(f"I({printed(d.base)},{d.link})" for d in group.drivers)
            words.append(_("with drivers: {drivers}").format(drivers=drivers))
    fitting = [textwrap.wrap(text, int(width / 1.66), subsequent_indent="    ", max_lines=4) for text in words]
    return [part.title[: int(width / 2.5)], *(line for lines in fitting for line in lines)]


def pairs_outside(part: Part, pairs: Iterable[Pair]) -> tuple[Pair, ...]:
    """The pairs that join a part to other links: those of a group, or all of a redundant link."""
    if part.group is not None:
        return part.group.outer
    links = {*part.links}
    return tuple(p for p in pairs if part.redundant and {p.i, p.j} & links and not {p.i, p.j} <= links)


def _listed(pairs: Iterable[Pair]) -> str:
    return ", ".join(f"{p.name} ({printed(p.i)}-{printed(p.j)})" for p in pairs)


def _part(sheet: Sheet, scene: Scene, part: Part, pad: float) -> None:
    """One part in the field that the ground of the sheet has."""
    pairs, links = scene.structure.pairs, part.links
    outer, frame = pairs_outside(part, pairs), () if part.group or part.redundant else (FRAME,)
    inner = tuple(p for p in pairs if {p.i, p.j} <= {*links, *frame})
    most = math.inf if on_large_sheet() else LEAST + A_LINK * len(links)
    scene = fitted(sheet, scene, links, pad, most)
    look = STRUCTURAL.sized(symbol_size(sheet, scene, links))
    own = dict.fromkeys(links, part.colour)
    for pair in pairs:  # of wheels and cams that this part shares with others, also later ones, its own side
        if not pair.lower and pair not in inner and {pair.i, pair.j} & set(links):
            draw(sheet, scene.higher(pair), own)
    for pair in outer:
        if pair.slide is not None:
            sliding_lead(sheet, scene, pair, part, look)
    drawn = render(sheet, scene, links, inner, look, {FRAME: DARK} | own, leads=outer)
    for pair in outer:
        if pair.kind == "R":
            _stub(sheet, scene, pair, drawn.forms, look)
    arrows(sheet, scene, drawn, look, own)
    numbers(sheet, drawn.forms, own)
    names(sheet, ((spot(sheet, scene, p, look), p.name, part.colour if part.group else DARK) for p in inner))
    names(sheet, ((spot(sheet, scene, p, look), lead_name(p, part), DARK) for p in outer))
    _later(sheet, scene, part, (*inner, *outer), look)
    sheet.settle()


def lead_name(pair: Pair, part: Part) -> str:
    """A (to 1): a lead and the link that it is joined to."""
    return _("{pair} (to {link})").format(pair=pair.name, link=printed(pair.i if pair.j in part.links else pair.j))


def sliding_lead(sheet: Sheet, scene: Scene, pair: Pair, part: Part, look: Look) -> None:
    """A free sliding pair: the box with a piece of the guide, or the bar with the stone, that it would be joined to."""
    assert pair.slide is not None
    at, along = sheet.on(scene.at(pair)), scene.along(pair.slide)
    if pair.slide.runner not in part.links:
        box(sheet, at, along, FREE, look.box, look, "--")
        return
    reach = (look.box[0] / 2 + BEYOND + 2) * along
    rails(sheet, at - reach, at + reach, look.box[1])
    box(sheet, at, along, part.colour, look.box, look)


def _stub(sheet: Sheet, scene: Scene, pair: Pair, forms: Mapping[str, Form], look: Look) -> None:
    """A short dashed piece of the link that a free hinge would be joined to, on its empty side."""
    at = sheet.on(scene.at(pair))
    arm = (forms.get(pair.j) or forms[pair.i]).middle - at
    out = quiet(sheet, at, -arm / abs(arm) if abs(arm) > 0.5 else 1j, STUB + 2)
    start, end = at + look.hinge * out, at + (look.hinge + STUB) * out
    sheet.line([start, end], FREE, 1.3, "--", 4.4)
    for side in look.sides:
        sheet.ground.line(start + side * out, end + side * out)


def _later(sheet: Sheet, scene: Scene, part: Part, drawn: Iterable[Pair], look: Look) -> None:
    """Pairs in which later groups will be joined to the links: dots with grey names."""
    known = {p.name for p in drawn}
    circled = [sheet.on(scene.at(p)) for p in drawn if p.kind == "R"]
    later = [p for link in part.links for p in scene.of(link) if p.name not in known]
    fresh = [p for p in later if all(abs(sheet.on(scene.at(p)) - at) > 0.5 for at in circled)]
    for pair in fresh:
        at = sheet.on(scene.at(pair))
        if np.isfinite(at):
            sheet.circle(at, 0.55 * look.hinge, part.colour, part.colour, 0.5, 6)
    names(sheet, [(sheet.on(scene.at(p)), p.name, FREE) for p in fresh])
