"""Structural scheme with its legend, and the Assur groups drawn separately with class, order and type."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    THIN_COLOUR,
    Drawing,
    DrawingSheet,
    OccupiedArea,
    divide_into_cells,
    file_safe_name,
    on_large_sheet,
    scaleless_layout,
    text_extent,
)
from tmm_cli.drawing.sheets.mechanism import sketch_scene
from tmm_cli.drawing.symbols import (
    FREE_COLOUR,
    GUIDE_EXTENSION,
    PART_COLOURS,
    STRUCTURAL,
    LinkForm,
    MechanismScene,
    SymbolStyle,
    draw_box,
    draw_driver_arrows,
    draw_higher_pair,
    draw_link_numbers,
    draw_names,
    draw_rails,
    fit_links,
    higher_pair_outline,
    name_anchor,
    quiet_direction,
    render_scene,
    replacement_link,
    scale_to_fit,
    symbol_scale,
)
from tmm_cli.language import _, printed, typeset
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.plans import LANDSCAPE, MARGIN, PORTRAIT, drawing_area
from tmm_cli.mechanics.structure import Group, Pair, RedundantLink, Structure
from tmm_cli.reports import ROLES, mobility_equation, reduction_sentences

SCHEME_PAD = 20.0  # mm kept free about the pairs for guides, supports and names
SCHEME_BASE_SIZE = 45.0  # mm: the scheme is drawn no larger than this ...
SCHEME_SIZE_PER_LINK = 25.0  # mm ... and this for each moving link
LEGEND_WIDTH = 190.0  # mm: the legend on a large sheet, unless the scheme is wider
LEGEND_ROW = 5.4  # mm of a line of the legend
JOINT_RADIUS = 0.9  # mm: joints of a link that replaces a higher pair


@dataclass(frozen=True)
class MechanismPart:
    """A part of the structure that is drawn separately: a primary mechanism, an Assur group, or a redundant link.

    Attributes:
        title: its name.
        links: its links.
        colour: colour in which it is drawn.
        group: the Assur group, or None.
        redundant: the redundant link, or None.
    """

    title: str
    links: tuple[str, ...]
    colour: str
    group: Group | None = None
    redundant: RedundantLink | None = None


def mechanism_parts(structure: Structure) -> tuple[MechanismPart, ...]:
    """Return the parts of a mechanism: primary mechanisms, groups in the order of solution, redundant links."""
    cranks = [driver for driver in structure.drivers if driver.base == FRAME]
    entries: list[tuple[str, tuple[str, ...], Group | None]] = [
        *((structure.driver_title(d), structure.rigid_with(d.link), None) for d in cranks),
        *((group.title, group.links, group) for group in structure.groups),
    ]
    coloured = [
        MechanismPart(title, links, PART_COLOURS[n % len(PART_COLOURS)], g)
        for n, (title, links, g) in enumerate(entries)
    ]
    redundant = [
        MechanismPart(", ".join(r.links), r.links, FREE_COLOUR, redundant=r) for r in structure.reduction.links
    ]
    return tuple(coloured + redundant)


def link_colours(structure: Structure) -> dict[str, str]:
    """Return the colour of each link. The frame and the links rigidly connected to it are black."""
    of_frame = dict.fromkeys((FRAME, *structure.rigid_with(FRAME)), DARK_COLOUR)
    return of_frame | {link: part.colour for part in mechanism_parts(structure) for link in part.links}


def draw_scheme(results: Results) -> Iterator[tuple[str, Drawing]]:
    """Yield the structural scheme, as (stem of the file name, drawing).

    Nothing if the linkage cannot be assembled in the sketched position.
    """
    sketch = sketch_scene(results)
    if sketch is not None:
        yield "structure", scheme_sheet(results.problem.title, *sketch).finish()


def scheme_sheet(title: str, place: str, scene: MechanismScene) -> DrawingSheet:
    """Draw the structural scheme with its legend below.

    Args:
        title: title of the project.
        place: driver coordinate as text.
        scene: the mechanism in the position to be drawn.
    """
    legend = Legend(scene.structure)
    links, pairs, hue = scene.structure.links, scene.structure.pairs, link_colours(scene.structure)
    points, most = scene.extent(links), SCHEME_BASE_SIZE + SCHEME_SIZE_PER_LINK * len(links)

    def scale(paper: tuple[float, float]) -> float:
        low, high = drawing_area(paper)
        return scale_to_fit(points, high - low - 2 * SCHEME_PAD * (1 + 1j) - 1j * legend.height(paper[0]), most)

    subject = _("Structural scheme, {place} (not to scale)").format(place=place)
    if on_large_sheet():
        most = math.inf
        sheet = DrawingSheet(title, subject, room=scaleless_layout(points, SCHEME_PAD, LEGEND_WIDTH, legend.height))
    else:
        # portrait only if the mechanism becomes much larger
        paper = LANDSCAPE if scale(LANDSCAPE) < 1.4 * scale(PORTRAIT) else PORTRAIT
        sheet = DrawingSheet(title, subject, paper=paper)
    sheet.canvas.low += 1j * legend.height(sheet.paper[0])
    scene = fit_links(sheet, scene, links, SCHEME_PAD, most)
    look = STRUCTURAL.scaled(symbol_scale(sheet, scene, links))
    drawn = render_scene(sheet, scene, links, pairs, look, hue)
    draw_driver_arrows(sheet, scene, drawn, look, hue)
    _draw_replacements(sheet, scene)
    draw_link_numbers(sheet, drawn.forms, hue)
    draw_names(sheet, [(name_anchor(sheet, scene, p, look), p.name, DARK_COLOUR) for p in pairs])
    sheet.place_requested_labels()
    legend.draw(sheet)
    return sheet


def _draw_replacements(sheet: DrawingSheet, scene: MechanismScene) -> None:
    """Draw the links that replace higher pairs as dashed lines.

    Such a link has a hinge at each end, or a sliding block at the end where the replaced profile is straight.
    """
    with sheet.on_layer("links"):
        for mesh in scene.linkage.meshes:
            link = replacement_link(higher_pair_outline(scene, mesh))
            start, end = sheet.on(link.start), sheet.on(link.end)
            sheet.line([start, end], DARK_COLOUR, 0.9, "--", 6)
            sheet.circle(start, JOINT_RADIUS, "white", DARK_COLOUR, 0.7)
            if link.slides:
                along = (end - start) / (abs(end - start) or 1.0)
                corners = [
                    end + JOINT_RADIUS * along * corner_offset for corner_offset in (1 + 2j, -1 + 2j, -1 - 2j, 1 - 2j)
                ]
                sheet.area(corners, "white", DARK_COLOUR, 0.7, 7)
            else:
                sheet.circle(end, JOINT_RADIUS, "white", DARK_COLOUR, 0.7)


class Legend:
    """Legend below the structural scheme: colours of the parts, structural formula, mobility and class."""

    def __init__(self, structure: Structure) -> None:
        self.structure, self.parts = structure, mechanism_parts(structure)
        lower = sum(p.lower for p in structure.pairs)
        n, higher = len(structure.links), len(structure.pairs) - lower
        self.facts = [
            _("Structural formula: {formula}").format(formula=structure.formula.replace("->", "→")),
            _(
                "moving links: n = {n}; lower pairs: p₁ = {p1} (revolute: {r}, prismatic: {p}); higher pairs: p₂ = {p2}"
            ).format(
                n=n,
                p1=lower,
                r=sum(p.kind == "R" for p in structure.pairs),
                p=sum(p.kind == "P" for p in structure.pairs),
                p2=higher,
            ),
            _("W = 3n − 2p₁ − p₂ = 3·{n} − 2·{p1} − {p2} = {w}").format(n=n, p1=lower, p2=higher, w=structure.mobility),
            _("Mechanism of class {roman}").format(roman=structure.roman),
        ]
        if structure.reduction:
            formula = _("W from the structural formula: {count}").format(
                count=typeset(mobility_equation(structure.count))
            )
            self.facts[1:1] = [*reduction_sentences(structure), formula]
        points = [p.point for p in structure.pairs if p.kind == "R"]
        inner = [d for d in structure.drivers if d.base != FRAME]
        if inner:
            drivers = ", ".join(f"I({printed(d.base)},{d.link})" for d in inner)
            self.facts.append(_("Drivers between two moving links: {drivers}").format(drivers=drivers))
        if higher:
            self.facts.append(_("Dashed lines: links that replace higher pairs"))
        compound = [point for point in dict.fromkeys(points) if points.count(point) > 1]
        if compound:
            self.facts.append(_("Compound hinge {points}: one circle for each pair").format(points=", ".join(compound)))

    def columns(self, paper: float) -> tuple[float, list[str]]:
        """Lay out the text in the right-hand column of the legend.

        Args:
            paper: width of the paper, mm.

        Returns:
            Left edge of the column (mm), and its lines.
        """
        width = paper - 2 * MARGIN
        left = min(0.5 * width, 14 + max(text_extent(self.entry(part), 9)[0] for part in self.parts))
        chars = int((width - left - 6) / 1.75)
        wrapped = (textwrap.wrap(fact, chars, subsequent_indent="   ", max_lines=4) for fact in self.facts)
        return left, [line for lines in wrapped for line in lines]

    def entry(self, part: MechanismPart) -> str:
        """Return the legend entry of a primary mechanism, a group or a redundant link."""
        if part.redundant is not None:
            return _("{title}: redundant link; redundant constraints: q = {q}").format(
                title=part.title, q=part.redundant.constraints
            )
        if part.group is None:
            return _("{title}: primary mechanism (driver and frame)").format(title=part.title)
        group = part.group
        return _("{title}: class {roman}, order {order}, {type}").format(
            title=part.title, roman=group.roman, order=group.order, type=count_pair_letters(group.type)
        )

    def height(self, paper: float) -> float:
        __, lines = self.columns(paper)
        return LEGEND_ROW * min(max(len(self.parts), len(lines)), 14) + 4

    def draw(self, sheet: DrawingSheet) -> None:
        """Draw the legend at the bottom of the sheet."""
        rows, (left, lines) = len(self.parts), self.columns(sheet.paper[0])
        top = MARGIN + self.height(sheet.paper[0])
        sheet.line([complex(MARGIN, top), complex(sheet.paper[0] - MARGIN, top)], DARK_COLOUR, 0.6, blocks=False)
        most = int((top - MARGIN - 4) / LEGEND_ROW + 0.5)
        for row, part in enumerate(self.parts[:most]):
            at = complex(MARGIN, top - 4 - LEGEND_ROW * row)
            sheet.line([at, at + 9], part.colour, 3.2, blocks=False)
            hidden = row == most - 1 and rows > most
            text = _("... other parts: {count}").format(count=rows - most + 1) if hidden else self.entry(part)
            sheet.text(at + 12, text, 9, colour=part.colour)
        for row, line in enumerate(lines[:most]):
            sheet.text(complex(MARGIN + left + 4, top - 4 - LEGEND_ROW * row), line, 9)


def count_pair_letters(kind: str) -> str:
    """Abbreviate the type of a group with more than five pairs, e.g. RRRRRR to 6R."""
    if len(kind) <= 5:
        return kind
    return "".join(f"{kind.count(letter)}{letter}" for letter in dict.fromkeys(kind))


GROUP_BASE_SIZE = 20.0  # mm: a part is drawn no larger than this ...
GROUP_SIZE_PER_LINK = 38.0  # mm ... and this for each link
GROUPS_PER_SHEET, GROUPS_PER_ROW = 6, 3
GROUP_CAPTION_LINE = 4.6  # mm
GROUP_PAD = (17.0, 12.5)  # mm about a group, in one row of groups and in more
GROUP_GAP = 6.0  # mm between groups
GROUP_CAPTION_WIDTH = 110.0  # mm: width of a caption on a large sheet
STUB_LENGTH = 8.0  # mm: piece of the link to which an external pair would be joined


def draw_all_groups(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Yield the drawings of the Assur groups; nothing if the linkage cannot be assembled in the sketched position."""
    sketch = sketch_scene(results)
    return () if sketch is None else draw_groups(results.problem.title, *sketch, results.roles)


def draw_groups(
    title: str, place: str, scene: MechanismScene, roles: Mapping[str, str] | None = None
) -> Iterable[tuple[str, Drawing]]:
    """Yield sheets with the Assur groups side by side. For a large sheet, each group is a drawing of its own.

    Args:
        title: title of the project.
        place: driver coordinate as text.
        scene: the mechanism in the position to be drawn.
        roles: roles of links (crank, rocker, ...) by link.
    """
    all_parts = mechanism_parts(scene.structure)
    if on_large_sheet():
        for part in all_parts:
            yield file_safe_name(f"groups-{part.title}"), _group_picture(title, scene, part, roles or {}).finish()
        return
    for first in range(0, len(all_parts), GROUPS_PER_SHEET):
        stem = "groups" if first == 0 else f"groups-sheet-{first // GROUPS_PER_SHEET + 1}"
        yield stem, groups_sheet(title, place, scene, all_parts[first : first + GROUPS_PER_SHEET], roles or {}).finish()


def _group_picture(title: str, scene: MechanismScene, part: MechanismPart, roles: Mapping[str, str]) -> DrawingSheet:
    """Draw one group, primary mechanism or redundant link with its caption, for a large sheet."""
    words = part_caption(part, scene.structure.pairs, roles, GROUP_CAPTION_WIDTH)
    sheet = DrawingSheet(title, words[0], room=scaleless_layout(scene.extent(part.links), GROUP_PAD[0], 0.0))
    sheet.remarks = words[1:]
    _draw_part(sheet, scene, part, GROUP_PAD[0])
    return sheet


def groups_sheet(
    title: str, place: str, scene: MechanismScene, sheet_parts: Sequence[MechanismPart], roles: Mapping[str, str]
) -> DrawingSheet:
    """Draw a sheet with several groups or other parts of the mechanism, each in a cell with its caption below."""
    subject = _("Assur groups drawn separately, {place}; dashed: links to which external pairs are joined").format(
        place=place
    )
    sheet = DrawingSheet(title, subject, paper=LANDSCAPE)
    rows = math.ceil(len(sheet_parts) / GROUPS_PER_ROW)
    columns = math.ceil(len(sheet_parts) / rows)
    size, corners = divide_into_cells(sheet.canvas.low, sheet.canvas.high, columns, rows, GROUP_GAP)
    captions = [part_caption(part, scene.structure.pairs, roles, size.real) for part in sheet_parts]
    for index, (part, words, (low, high)) in enumerate(zip(sheet_parts, captions, corners, strict=False)):
        row, column = divmod(index, columns)
        lines = max(map(len, captions[row * columns : (row + 1) * columns]))
        if column:
            x = low.real - GROUP_GAP / 2
            sheet.line([complex(x, low.imag), complex(x, high.imag)], THIN_COLOUR, 0.4, blocks=False)
        sheet.canvas = OccupiedArea(low + 1j * (GROUP_CAPTION_LINE * (lines + 0.5)), high)
        top = low + 1j * GROUP_CAPTION_LINE * (lines - 0.5)
        sheet.text(top, words[0], 11, colour=part.colour, weight="bold")
        for line, text in enumerate(words[1:], 1):
            sheet.text(top - 1j * GROUP_CAPTION_LINE * line, text, 8.5)
        _draw_part(sheet, scene, part, GROUP_PAD[rows > 1])
    return sheet


def part_caption(part: MechanismPart, pairs: Iterable[Pair], roles: Mapping[str, str], width: float) -> list[str]:
    """Return the caption of a group or another part of the mechanism, in lines no wider than `width` mm."""
    links = ", ".join(f"{n} {_(ROLES[roles[n]])}" if n in roles else n for n in part.links)
    if part.redundant is not None:
        q = _("redundant link; redundant constraints: q = {q}").format(q=part.redundant.constraints)
        words = [q, _("links: {links}").format(links=links)]
        words.append(_("pairs: {pairs}").format(pairs=_list_pairs(external_pairs(part, pairs))))
    elif part.group is None:
        words = [_("primary mechanism: driver and frame"), _("links: {links}").format(links=links)]
        driving = [pair for pair in pairs if FRAME in (pair.i, pair.j) and {pair.i, pair.j} <= {FRAME, *part.links}]
        if driving:
            words.append(_("driving pair: {pair}").format(pair=_list_pairs(driving[-1:])))
    else:
        group = part.group
        words = [
            _("class {roman}, order {order}, type {type}").format(
                roman=group.roman, order=group.order, type=count_pair_letters(group.type)
            ),
            _("links: {links}").format(links=links),
        ]
        if group.inner:
            words.append(_("internal pairs: {pairs}").format(pairs=_list_pairs(group.inner)))
        words.append(_("external pairs: {pairs}").format(pairs=_list_pairs(group.outer)))
        if group.drivers:
            drivers = ", ".join(f"I({printed(d.base)},{d.link})" for d in group.drivers)
            words.append(_("drivers: {drivers}").format(drivers=drivers))
    fitting = [textwrap.wrap(text, int(width / 1.66), subsequent_indent="    ", max_lines=4) for text in words]
    return [part.title[: int(width / 2.5)], *(line for lines in fitting for line in lines)]


def external_pairs(part: MechanismPart, pairs: Iterable[Pair]) -> tuple[Pair, ...]:
    """Return the external pairs of a group, or the pairs that connect a redundant link to other links."""
    if part.group is not None:
        return part.group.outer
    links = {*part.links}
    return tuple(p for p in pairs if part.redundant and {p.i, p.j} & links and not {p.i, p.j} <= links)


def _list_pairs(pairs: Iterable[Pair]) -> str:
    return ", ".join(f"{p.name} ({printed(p.i)}-{printed(p.j)})" for p in pairs)


def _draw_part(sheet: DrawingSheet, scene: MechanismScene, part: MechanismPart, pad: float) -> None:
    """Draw one group or another part of the mechanism in the current cell of the sheet."""
    pairs, links = scene.structure.pairs, part.links
    outer, frame = external_pairs(part, pairs), () if part.group or part.redundant else (FRAME,)
    inner = tuple(p for p in pairs if {p.i, p.j} <= {*links, *frame})
    most = math.inf if on_large_sheet() else GROUP_BASE_SIZE + GROUP_SIZE_PER_LINK * len(links)
    scene = fit_links(sheet, scene, links, pad, most)
    look = STRUCTURAL.scaled(symbol_scale(sheet, scene, links))
    part_colours = dict.fromkeys(links, part.colour)
    for pair in pairs:  # higher pairs shared with other parts: draw only the side of this part
        if not pair.lower and pair not in inner and {pair.i, pair.j} & set(links):
            draw_higher_pair(sheet, scene.higher(pair), part_colours)
    for pair in outer:
        if pair.slide is not None:
            draw_free_prismatic(sheet, scene, pair, part, look)
    drawn = render_scene(sheet, scene, links, inner, look, {FRAME: DARK_COLOUR} | part_colours, external=outer)
    for pair in outer:
        if pair.kind == "R":
            _draw_stub(sheet, scene, pair, drawn.forms, look)
    draw_driver_arrows(sheet, scene, drawn, look, part_colours)
    draw_link_numbers(sheet, drawn.forms, part_colours)
    draw_names(
        sheet, ((name_anchor(sheet, scene, p, look), p.name, part.colour if part.group else DARK_COLOUR) for p in inner)
    )
    draw_names(sheet, ((name_anchor(sheet, scene, p, look), external_pair_name(p, part), DARK_COLOUR) for p in outer))
    _mark_later_pairs(sheet, scene, part, (*inner, *outer), look)
    sheet.place_requested_labels()


def external_pair_name(pair: Pair, part: MechanismPart) -> str:
    """Name an external pair together with the link to which it connects the group, e.g. "A (to 1)"."""
    return _("{pair} (to {link})").format(pair=pair.name, link=printed(pair.i if pair.j in part.links else pair.j))


def draw_free_prismatic(
    sheet: DrawingSheet, scene: MechanismScene, pair: Pair, part: MechanismPart, look: SymbolStyle
) -> None:
    """Draw a prismatic external pair of a group.

    If the sliding block belongs to the group, it is drawn with a piece of its guide. If the guide belongs to the group,
    the block of the other link is drawn as a dashed box on it.
    """
    assert pair.slide is not None
    at, along = sheet.on(scene.at(pair)), scene.along(pair.slide)
    if pair.slide.runner not in part.links:
        draw_box(sheet, at, along, FREE_COLOUR, look.box, look, "--")
        return
    reach = (look.box[0] / 2 + GUIDE_EXTENSION + 2) * along
    draw_rails(sheet, at - reach, at + reach, look.box[1])
    draw_box(sheet, at, along, part.colour, look.box, look)


def _draw_stub(
    sheet: DrawingSheet, scene: MechanismScene, pair: Pair, forms: Mapping[str, LinkForm], look: SymbolStyle
) -> None:
    """Draw a short dashed piece of the link to which an external hinge connects the group."""
    at = sheet.on(scene.at(pair))
    arm = (forms.get(pair.j) or forms[pair.i]).middle - at
    out = quiet_direction(sheet, at, -arm / abs(arm) if abs(arm) > 0.5 else 1j, STUB_LENGTH + 2)
    start, end = at + look.hinge * out, at + (look.hinge + STUB_LENGTH) * out
    sheet.line([start, end], FREE_COLOUR, 1.3, "--", 4.4)
    for side in look.sides:
        sheet.canvas.line(start + side * out, end + side * out)


def _mark_later_pairs(
    sheet: DrawingSheet, scene: MechanismScene, part: MechanismPart, drawn: Iterable[Pair], look: SymbolStyle
) -> None:
    """Mark the pairs by which later groups are connected to this one with dots and grey names."""
    drawn_names = {p.name for p in drawn}
    circled = [sheet.on(scene.at(p)) for p in drawn if p.kind == "R"]
    later = [p for link in part.links for p in scene.lower_pairs(link) if p.name not in drawn_names]
    fresh = [p for p in later if all(abs(sheet.on(scene.at(p)) - at) > 0.5 for at in circled)]
    for pair in fresh:
        at = sheet.on(scene.at(pair))
        if np.isfinite(at):
            sheet.circle(at, 0.55 * look.hinge, part.colour, part.colour, 0.5, 6)
    draw_names(sheet, [(sheet.on(scene.at(p)), p.name, FREE_COLOUR) for p in fresh])
