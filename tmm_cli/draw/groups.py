"""The Assur groups apart: each alone at its pose, its leads free, with its class, order and type; and the driver."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from matplotlib.figure import Figure

from tmm_cli.draw.labels import Ground
from tmm_cli.draw.scene import BEYOND, BOX, HINGE, Form, Scene, fitted, form
from tmm_cli.draw.sheet import DARK, THIN, Sheet
from tmm_cli.draw.structure import (
    Part,
    arrows,
    at_sketch,
    circles,
    grounds,
    higher_pairs,
    names,
    parts,
    sliding,
    spot,
    where,
)
from tmm_cli.draw.symbols import FREE, body, box, number, quiet, settle, symbol_size
from tmm_cli.linkage import FRAME
from tmm_cli.pipeline import Results
from tmm_cli.structure.assur import ROMAN, Pair
from tmm_cli.words import say

LEAST, A_LINK = 20.0, 38.0  # mm: a part is not drawn larger than this and so much more a link
A_SHEET, A_ROW = 6, 3  # parts of a mechanism on one sheet and in one row of it; with more, each has its own sheet
LINE, PAD, GAP = 4.6, (17.0, 12.5), 6.0  # mm: a line of a caption, room about a group (few, many), between two
STUB = 8.0  # mm of what a lead would be joined to


def groups(results: Results) -> Iterable[tuple[str, Figure]]:
    """All groups side by side, or on sheets of their own when there are many."""
    found = at_sketch(results)
    if found is None:
        return
    motion, k = found
    scene = Scene(results.linkage, results.structure, motion.poses, k)
    yield from sheets_apart(results.problem.title, where(results, motion, k), scene, results.roles)


def sheets_apart(
    title: str, place: str, scene: Scene, roles: Mapping[str, str] | None = None
) -> Iterable[tuple[str, Figure]]:
    """The sheets with the stems of their files."""
    every, taken = parts(scene.structure), set()
    if len(every) <= A_SHEET:
        yield "groups", side_by_side(title, place, scene, every, roles).finish()
        return
    for index, part in enumerate(every):
        stem = _stem(part)
        stem = f"{stem}-{index}" if stem in taken else stem
        taken.add(stem)
        yield stem, side_by_side(title, place, scene, [part], roles).finish()


def _stem(part: Part) -> str:
    """group-II-2-3."""
    name = "-".join(["group", part.title.split("(")[0], *([FRAME] if part.group is None else []), *part.links])
    return "".join(c if (c.isascii() and c.isalnum()) or c in "-_" else "_" for c in name)[:80]


def side_by_side(
    title: str, place: str, scene: Scene, every: Sequence[Part], roles: Mapping[str, str] | None = None
) -> Sheet:
    """A sheet of these parts, each in a cell with its caption below it."""
    sheet = Sheet(title, say("groups.sheet", place=place), [0j, 9 + 1j])
    whole = sheet.ground
    low, high = whole.low, whole.high
    rows = 1 if len(every) <= A_ROW else math.ceil(len(every) / A_ROW)
    columns = math.ceil(len(every) / rows)
    width = ((high - low).real - GAP * (columns - 1)) / columns
    height = ((high - low).imag - GAP * (rows - 1)) / rows
    boxes = []
    on_frame = {p.i if p.j == FRAME else p.j: p for p in scene.structure.pairs if FRAME in (p.i, p.j)}
    told = [caption(part, roles or {}, width, on_frame.get(part.links[0])) for part in every]
    for index, part in enumerate(every):
        row, column = divmod(index, columns)
        corner = complex(low.real + column * (width + GAP), high.imag - (row + 1) * height - row * GAP)
        words = told[index]
        lines = max(len(told[n]) for n in range(row * columns, min((row + 1) * columns, len(every))))
        if column:
            x = corner.real - GAP / 2
            sheet.axes.plot([x, x], [corner.imag, corner.imag + height], color=THIN, lw=0.4)
        sheet.ground = Ground(corner + 1j * (LINE * (lines + 0.5)), corner + complex(width, height))
        for line, text in enumerate(words):
            at = corner + 1j * LINE * (lines - line - 0.5)
            first = line == 0
            sheet.text(at, text, 11 if first else 8.5, colour=part.colour if first else DARK,
                       weight="bold" if first else "normal")  # fmt: skip
        _part(sheet, scene, part, PAD[rows > 1])
        boxes += sheet.ground.boxes
    whole.boxes += boxes
    sheet.ground = whole
    return sheet


def caption(part: Part, roles: Mapping[str, str], width: float, driving: Pair | None = None) -> list[str]:
    """What a part is, in lines that fit a width (mm)."""
    links = ", ".join(f"{n} {say(f'role.{roles[n]}')}" if n in roles else n for n in part.links)
    if part.group is None:
        words = [say("groups.primary"), say("groups.links", links=links)]
        if driving is not None:
            words.append(say("groups.driving_pair", pair=f"{driving.name} ({driving.i}-{driving.j})"))
    else:
        group = part.group
        words = [
            say("groups.kind", roman=ROMAN[min(group.grade, 10)], order=group.order, type=group.type),
            say("groups.links", links=links),
            *([say("groups.inner_pairs", pairs=_listed(group.inner))] if group.inner else []),
            say("groups.outer_pairs", pairs=_listed(group.outer)),
        ]
        if group.drivers:
            words.append(say("groups.drivers", drivers=", ".join(f"I({d.base},{d.link})" for d in group.drivers)))
    fitting = [textwrap.wrap(text, int(width / 1.66), subsequent_indent="    ", max_lines=4) for text in words]
    return [part.title[: int(width / 2.5)], *(line for lines in fitting for line in lines)]


def _listed(pairs: Iterable[Pair]) -> str:
    return ", ".join(f"{p.name} ({p.i}-{p.j})" for p in pairs)


def _part(sheet: Sheet, scene: Scene, part: Part, pad: float) -> None:
    """One part in the field that the ground of the sheet has."""
    structure = scene.structure
    outer = part.group.outer if part.group else ()
    own = tuple(p for p in structure.pairs if p.i in (*part.links, FRAME) and p.j in (*part.links, FRAME))
    inner = part.group.inner if part.group else own
    scene = fitted(sheet, scene, part.links, sheet.ground.low, sheet.ground.high, pad, LEAST + A_LINK * len(part.links))
    size = symbol_size(sheet, scene, part.links)
    forms = {link: form(sheet, scene, link) for link in part.links}
    hue = {FRAME: DARK} | dict.fromkeys(part.links, part.colour)
    higher_pairs(sheet, scene, inner, hue, bare=False)
    touching = [
        p for p in structure.pairs if p not in inner and {p.i, p.j} & set(part.links)
    ]  # also those of later groups
    higher_pairs(sheet, scene, touching, dict.fromkeys(part.links, part.colour), bare=True)
    for shape in forms.values():
        body(sheet, shape, part.colour)
    leads = [p for p in outer if p.slide is not None]
    for pair in leads:
        sliding_lead(sheet, scene, pair, part, size)
    for pair in inner:
        sliding(sheet, scene, pair, part.colour, size)
    circles(sheet, scene, (*inner, *outer), forms, hue, size)
    for pair in outer:
        if pair.kind == "R":
            _stub(sheet, scene, pair, forms, size)
    if part.group is None:
        grounds(sheet, scene, inner, size)
    arrows(sheet, scene, forms, hue, size)
    for link, shape in forms.items():
        number(sheet, link, shape, part.colour)
    names(sheet, ((spot(sheet, scene, p, size), p.name, part.colour if part.group else DARK) for p in inner))
    names(sheet, ((spot(sheet, scene, p, size), lead_name(p, part), DARK) for p in outer))
    _later(sheet, scene, part, (*inner, *outer), size)
    settle(sheet)


def lead_name(pair: Pair, part: Part) -> str:
    """A (to 1): a lead and the link that it is joined to."""
    return say("groups.lead", pair=pair.name, link=pair.i if pair.j in part.links else pair.j)


def sliding_lead(sheet: Sheet, scene: Scene, pair: Pair, part: Part, size: float) -> None:
    """A free sliding pair: the box with a piece of the guide, or the bar with the stone, that it would be joined to."""
    assert pair.slide is not None
    at, along = sheet.on(scene.at(pair)), scene.along(pair.slide)
    if pair.slide.runner not in part.links:
        box(sheet, at, along, FREE, size, style="--")
        return
    reach = BOX[0] * size / 2 + BEYOND + 2
    for side in (1, -1):
        shift = side * 1j * along * (BOX[1] * size / 2 + 0.7)
        sheet.line([at + shift - reach * along, at + shift + reach * along], FREE, 1.0, "--", 2.5)
    box(sheet, at, along, part.colour, size)


def _stub(sheet: Sheet, scene: Scene, pair: Pair, forms: Mapping[str, Form], size: float) -> None:
    """A short dashed piece of the link that a free hinge would be joined to, on its empty side."""
    at = sheet.on(scene.at(pair))
    own = forms.get(pair.j) or forms[pair.i]
    arm = own.middle - at
    wish = -arm / abs(arm) if abs(arm) > 0.5 else 1j
    way = quiet(sheet, at, wish, STUB + 2)
    radius = HINGE * size
    sheet.line([at + radius * way, at + (radius + STUB) * way], FREE, 1.3, "--", 4.4)
    for side in (0.8j, -0.8j):
        sheet.ground.line(at + radius * way + side * way, at + (radius + STUB) * way + side * way)


def _later(sheet: Sheet, scene: Scene, part: Part, drawn: Iterable[Pair], size: float) -> None:
    """Pairs in which later groups will be joined to the links: dots with grey names."""
    known = {p.name for p in drawn}
    circled = [sheet.on(scene.at(p)) for p in drawn if p.kind == "R"]
    later = [p for link in part.links for p in scene.of(link) if p.name not in known]
    fresh = [p for p in later if all(abs(sheet.on(scene.at(p)) - at) > 0.5 for at in circled)]
    for pair in fresh:
        at = sheet.on(scene.at(pair))
        if np.isfinite(at):
            sheet.circle(at, 0.55 * HINGE * size, part.colour, part.colour, 0.5, 6)
    names(sheet, [(sheet.on(scene.at(p)), p.name, FREE) for p in fresh])
