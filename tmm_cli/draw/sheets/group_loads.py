"""Each group apart, and each driving link: its links to scale under loads and reactions, arms, equations of moments."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from tmm_cli.draw.paper.drawing import Drawing
from tmm_cli.draw.paper.picture import written_here
from tmm_cli.draw.paper.sheet import REACTION, Sheet, safe, scale_words
from tmm_cli.draw.sheets.acting import Forces, arms, extent
from tmm_cli.draw.sheets.beneath import Beneath, above
from tmm_cli.draw.sheets.equations import along_guide, table_of_arms, table_of_forces, written
from tmm_cli.draw.sheets.mechanism import Position, measured
from tmm_cli.draw.symbols.scene import Scene
from tmm_cli.language import _
from tmm_cli.plans.moments import LoadedPart, MomentEquation, loaded_parts
from tmm_cli.plans.projections import ForceSum
from tmm_cli.plans.record import extent as extent_of
from tmm_cli.tolerances import SAME_PLACES

MOST = 12  # arms on one sheet


def group_loads(here: Position) -> Iterable[tuple[str, Drawing]]:
    """A sheet for each group and each driving link; another one for equations whose arms would crowd the first."""
    if here.results.reactions is None:
        return
    for part in loaded_parts(here.motion, here.results.reactions, here.k):
        kind = "links" if len(part.links) > 1 else "link"
        stem = safe("-".join([here.stem("group-loads"), kind, *part.links]))
        few, *others = sheetfuls(part.equations)
        sheets = [*_sheets(here, part, few, part.sums), *(s for more in others for s in _sheets(here, part, more, ()))]
        for number, sheet in enumerate(sheets if part.acting else ()):
            yield stem + (f"-sheet-{number + 1}" if number else ""), sheet.finish()


def sheetfuls(equations: Sequence[MomentEquation]) -> list[list[MomentEquation]]:
    """Equations in their order, on as many sheets as their arms need."""
    found: list[list[MomentEquation]] = [[]]
    for equation in equations:
        number = sum(len(_letters(e)) for e in found[-1])
        crowded = number + len(_letters(equation)) > MOST
        if found[-1] and (crowded or equation.special or found[-1][-1].special):
            found.append([])
        found[-1].append(equation)
    return found


def _letters(equation: MomentEquation) -> set[int]:
    return {t.number for t in equation.terms if t.number}


def _sheets(
    here: Position, part: LoadedPart, equations: Sequence[MomentEquation], sums: Sequence[ForceSum]
) -> Iterable[Sheet]:
    linkage = here.results.linkage
    linkage = replace(linkage, springs=())  # they are loads here
    scene = Scene(linkage, here.results.structure, here.motion.poses, here.k)
    terms = [t for e in equations for t in e.terms]
    shown = [*(t.acting for t in terms), *(s.found.acting for s in sums)]
    further = [a for a in dict.fromkeys(shown) if a.kind == "reaction" and a not in part.acting]
    places = [*scene.extent(part.links), *(scene.point(p) for n in part.links for p in linkage.links[n].points)]
    places += [p for e in equations for p in (e.centre, *(t.foot for t in e.terms if t.number))]
    title = _("Links {links} under their loads. {caption}")
    if part.driving:
        title = _("Driving link {links} under its loads. {caption}")
    elif len(part.links) == 1:
        title = _("Link {links} under its loads. {caption}")
    lines = [line for e in equations for line in written(e)] if written_here() else []
    lines += [line for one in sums for line in along_guide(one)] if written_here() else []
    units, shown = here.results.problem.units, [*part.acting, *further]

    def beneath(mu: float) -> Beneath:
        return Beneath(lines, (table_of_forces(shown), table_of_arms(equations, units, mu)))

    sized = [*((place, 0j) for place in places), *extent(shown)]
    if extent_of([place for place, __ in sized])[0] <= SAME_PLACES * here.motion.largest.size:  # but for rounding one
        places, sized = places[:1], [(places[0], along) for __, along in sized]
    sheet, text = above(here, title, sized, beneath, links=", ".join(part.links))
    measured(sheet, scene, links=part.links)
    bars = sheet.ground.crowd
    forces = Forces(sheet)
    forces.draw(part.acting)
    forces.draw(replace(a, kind="inner") for a in further)
    for equation in (e for e in equations if e.special):
        _special(sheet, part, equation)
    arms(sheet, equations, bars)
    if extent_of(places)[0] > 0:
        sheet.note(scale_words("l", sheet.mu, "m/mm"))
    sheet.note(_("forces without scale"))
    sheet.note(_("moments positive counterclockwise"))
    if any(e.sought is None for e in equations):
        sheet.note(_("all reactions of the group are found at once"))
    return (sheet,) if text is None else (sheet, text)


def _special(sheet: Sheet, part: LoadedPart, equation: MomentEquation) -> None:
    """The point of Assur, and the lines of the reactions that meet there."""
    at, with_moments = sheet.on(equation.centre), {t.acting.symbol for t in equation.terms}
    for one in part.acting:
        if one.pair and not one.couple and one.symbol not in with_moments:
            sheet.line([sheet.on(one.at), at], REACTION, 0.5, "-.", 1.7)
    sheet.circle(at, 0.6, REACTION, REACTION, 0.5)
    sheet.label(equation.about, at, 10)
