"""Sheets with moment equations: each group under its loads, and the Zhukovsky lever (rotated velocity plan)."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    REACTION_COLOUR,
    THIN_COLOUR,
    Drawing,
    DrawingSheet,
    Words,
    file_safe_name,
    gather_coincident,
    scale_words,
    writes_equations,
)
from tmm_cli.drawing.sheets.captions import CaptionTable, DrawingCaption, captioned_sheets
from tmm_cli.drawing.sheets.force_arrows import ForceArrows, arrow_extent, draw_arms
from tmm_cli.drawing.sheets.mechanism import Position, draw_measured
from tmm_cli.drawing.symbols import MechanismScene
from tmm_cli.language import _, filled, half_up, numeral, spelt
from tmm_cli.mechanics.forces import (
    ForceOrCouple,
    ForceSum,
    FreeBody,
    GuideComponent,
    MomentEquation,
    MomentTerm,
    Symbol,
    balance_symbol,
    list_free_bodies,
)
from tmm_cli.mechanics.numerics import NO_DIFFERENCE, NO_MOMENT, SAME_POINTS
from tmm_cli.mechanics.plans import (
    LEVER_POLE,
    CoupleAsForces,
    LeverPlan,
    extent as extent_of,
    lever_plan,
    with_subscripts,
)
from tmm_cli.mechanics.quantities import LENGTH
from tmm_cli.problem import UnitSystem

EQUATION_INDENT = "    "
PLAIN_DOWN_TO = 1e-6  # a smaller number is written with a power of ten
EquationPart = str | Symbol


def equation_lines(equation: MomentEquation, unit: str = "N·m") -> Iterable[Words]:
    """Yield the lines of a moment equation: the equation in symbols, then its solution in symbols and numbers.

    Args:
        equation: the equation in N and m.
        unit: unit of the moments.
    """
    solved, sought = equation.found, equation.sought
    links = (_("link {links}") if len(equation.links) == 1 else _("links {links}")).format(
        links=", ".join(equation.links)
    )
    moments: tuple[EquationPart, ...] = ("Σ", Symbol("M", equation.about), f", {links}: " if equation.links else ": ")
    if solved is None and sought is not None:
        text = (
            _("{moments}no force has a moment, so {name} passes through {point}")
            if sought.arm
            else _("{moments}no force has a moment, so {name} = 0")
        )
        yield filled(text, moments=moments, name=sought.symbol, point=equation.about)
        return
    if not equation.terms:
        return
    others = [t for t in equation.terms if t is not solved]
    terms = [*([solved] if solved else []), *others]
    yield (*moments, *_sum_text((_term_letters(t), t.moment) for t in terms), " = 0")
    if solved is None or sought is None:
        rest, largest = abs(sum(t.moment for t in terms)), max(abs(t.moment) for t in terms)
        value = format_figures(rest if rest > NO_MOMENT * largest else 0.0)
        yield (EQUATION_INDENT, *_sum_text((_term_numbers(t), t.moment) for t in terms), f" = {value} {spelt(unit)}")
        return
    sense = -float(np.sign(solved.moment))
    letters = _sum_text((_term_letters(t), sense * t.moment) for t in others)
    numbers = _sum_text((_term_numbers(t), sense * t.moment) for t in others)
    if solved.acting.couple:
        value = format_figures(equation.value)
        summed = () if numbers == [value] else (*numbers, " = ")
        yield (EQUATION_INDENT, solved.acting.symbol, " = ", *letters, " = ", *summed, f"{value} {spelt(unit)}")
        return
    name, over, by, unit_name = solved.acting.symbol, solved.letter, solved.arm, "N"
    if sought.arm:
        name, over, by, unit_name = solved.letter, solved.acting.symbol, solved.acting.size, "m"
    divided = ("(", *letters, ") / ", over, " = (", *numbers, f") / {format_figures(by)}")
    yield (EQUATION_INDENT, name, " = ", *divided, f" = {format_figures(equation.value)} {spelt(unit_name)}")


def guide_force_lines(forces: ForceSum) -> Iterable[Words]:
    """Yield the lines of an equilibrium equation of forces along a guide: in symbols, then solved in numbers."""
    title = _("ΣF along guide {guide}, link {link}: ").format(guide=forces.guide, link=forces.link)
    others = [component for component in forces.parts if component is not forces.found]
    sense = -float(np.sign(forces.found.along))
    yield (title, *_sum_text((_cosine_text(p), p.along) for p in (forces.found, *others)), " = 0")
    numbers = _sum_text(
        ((f"{format_figures(p.acting.size)}·{format_figures(p.cosine)}",), sense * p.along) for p in others
    )
    yield (
        EQUATION_INDENT,
        forces.found.acting.symbol,
        " = ",
        *numbers,
        f" = {format_figures(forces.value)} {spelt('N')}",
    )


def _cosine_text(component: GuideComponent) -> tuple[EquationPart, ...]:
    angle = float(np.degrees(np.arccos(component.cosine)))
    return (component.acting.symbol, f"·cos {numeral(angle, '.1f')}°") if angle >= 0.05 else (component.acting.symbol,)


def _term_letters(term: MomentTerm) -> tuple[EquationPart, ...]:
    return (term.acting.symbol, "·", term.letter) if term.number else (term.acting.symbol,)


def _term_numbers(term: MomentTerm) -> tuple[EquationPart, ...]:
    return (
        f"{format_figures(term.acting.size)}·{format_figures(term.arm)}"
        if term.number
        else format_figures(term.acting.size),
    )


def _sum_text(terms: Iterable[tuple[tuple[EquationPart, ...], float]]) -> list[EquationPart]:
    """Join the terms of a sum with their signs, e.g. a − b + c.

    terms: text of each term, with a number whose sign is that of the term.
    """
    words_joined: list[EquationPart] = []
    for words, sign in terms:
        plus = " + " if words_joined else ""
        words_joined += [plus if sign > 0 else " − " if words_joined else "−", *words]
    return [word for word in words_joined if word]


def forces_table(acting: Iterable[ForceOrCouple], unit: str = "N·m") -> CaptionTable:
    """Return a table of forces with magnitudes and directions, and of couples with magnitudes and senses.

    unit: unit in which the couples are written.
    """
    rows: list[tuple[Words, ...]] = []
    for load in acting:
        direction = f"{numeral(round(float(np.degrees(np.angle(load.force))), 1) % 360, '.1f')}°"
        if load.couple:  # in the equations its sense is the sign
            direction = _("ccw") if load.moment > 0 else _("cw") if load.moment < 0 else ""
        rows.append((load.symbol, f"{format_figures(load.size)} {spelt(unit if load.couple else 'N')}", direction))
    return CaptionTable((_("force"), _("magnitude"), _("angle")), rows)


def arms_table(equations: Sequence[MomentEquation], units: UnitSystem | None, mu: float) -> CaptionTable:
    """Return a table of moment arms: symbol, forces with this arm, length, and length on paper.

    Args:
        equations: moment equations.
        units: units of the file; None if the arms are ratios without a unit.
        mu: scale, SI units per mm.
    """
    by_number: dict[int, list[MomentTerm]] = {}
    for term in (t for e in equations for t in e.terms if t.number):
        by_number.setdefault(term.number, []).append(term)
    rows: list[tuple[Words, ...]] = []
    for first, *others in by_number.values():
        symbols = (first.acting.symbol, *(word for term in others for word in (", ", term.acting.symbol)))
        arm_text = format_figures(units.from_si(first.arm, LENGTH) if units else first.arm)
        rows.append((first.letter, symbols, arm_text, f"{numeral(first.arm / mu, '.1f')} {spelt('mm')}"))
    return CaptionTable((_("arm"), _("force"), units.spelt(LENGTH) if units else "", _("on the drawing")), rows)


def format_figures(value: float) -> str:
    """Format a number with four significant figures. Very small and very large numbers get a power of ten."""
    rounded = float(f"{half_up(value):.4g}")
    if 1e4 <= abs(rounded) < 1e7:
        return numeral(value, ".0f")
    if not 0 < abs(rounded) < 1e-4:  # no power of ten
        return numeral(rounded, ".10g")
    decimals = len(np.format_float_positional(rounded).partition(".")[2])
    return numeral(rounded, f".{decimals}f" if abs(value) > PLAIN_DOWN_TO else ".4g")


# Each group and each driving link separately: links to scale with loads and reactions, arms, equations of moments.


MOST_ARMS = 12  # on one sheet


def draw_group_loads(position: Position) -> Iterable[tuple[str, Drawing]]:
    """Yield a sheet for each Assur group and each driving link, with its loads and moment equations.

    If there are so many arms that the sheet would be crowded, further sheets are drawn.
    """
    if position.results.reactions is None:
        return
    for loaded in list_free_bodies(position.motion, position.results.reactions, position.k):
        kind = "links" if len(loaded.links) > 1 else "link"
        stem = file_safe_name("-".join([position.stem("group-loads"), kind, *loaded.links]))
        few, *others = split_equations(loaded.equations)
        sheets = [
            *_group_sheets(position, loaded, few, loaded.sums),
            *(s for more in others for s in _group_sheets(position, loaded, more, ())),
        ]
        for number, sheet in enumerate(sheets if loaded.acting else ()):
            yield stem + (f"-sheet-{number + 1}" if number else ""), sheet.finish()


def split_equations(equations: Sequence[MomentEquation]) -> list[list[MomentEquation]]:
    """Distribute moment equations, in their order, over sheets with at most MOST_ARMS arms each."""
    sheets: list[list[MomentEquation]] = [[]]
    for equation in equations:
        number = sum(len(_arm_numbers(e)) for e in sheets[-1])
        crowded = number + len(_arm_numbers(equation)) > MOST_ARMS
        if sheets[-1] and (crowded or equation.special or sheets[-1][-1].special):
            sheets.append([])
        sheets[-1].append(equation)
    return sheets


def _arm_numbers(equation: MomentEquation) -> set[int]:
    return {t.number for t in equation.terms if t.number}


def _group_sheets(
    position: Position, loaded: FreeBody, equations: Sequence[MomentEquation], sums: Sequence[ForceSum]
) -> Iterable[DrawingSheet]:
    linkage = position.results.linkage
    linkage = replace(linkage, elements=())  # they act as loads here
    scene = MechanismScene(linkage, position.results.structure, position.motion.poses, position.k)
    terms = [t for e in equations for t in e.terms]
    listed = [*(t.acting for t in terms), *(s.found.acting for s in sums)]
    further = [a for a in dict.fromkeys(listed) if a.kind == "reaction" and a not in loaded.acting]
    points = [*scene.extent(loaded.links), *(scene.point(p) for n in loaded.links for p in linkage.links[n].points)]
    points += [p for e in equations for p in (e.centre, *(t.foot for t in e.terms if t.number))]
    title = _("Free-body diagram of links {links}. {caption}")
    if loaded.driving:
        title = _("Free-body diagram of the input link {links}. {caption}")
    elif len(loaded.links) == 1:
        title = _("Free-body diagram of link {links}. {caption}")
    lines = [line for e in equations for line in equation_lines(e)] if writes_equations() else []
    lines += [line for force_sum in sums for line in guide_force_lines(force_sum)] if writes_equations() else []
    units, listed = position.results.problem.units, [*loaded.acting, *further]

    def beneath(mu: float) -> DrawingCaption:
        return DrawingCaption(lines, (forces_table(listed), arms_table(equations, units, mu)))

    sized = [*((place, 0j) for place in points), *arrow_extent(listed)]
    if (
        extent_of([place for place, __ in sized])[0] <= SAME_POINTS * position.motion.largest.size
    ):  # one point, apart from rounding
        points, sized = points[:1], [(points[0], along) for __, along in sized]
    sheet, text = captioned_sheets(position, title, sized, beneath, links=", ".join(loaded.links))
    draw_measured(sheet, scene, links=loaded.links)
    bars = sheet.canvas.line_points
    forces = ForceArrows(sheet)
    forces.draw(loaded.acting)
    forces.draw(replace(a, kind="inner") for a in further)
    for equation in (e for e in equations if e.special):
        _draw_assur_point(sheet, loaded, equation)
    draw_arms(sheet, equations, bars)
    if extent_of(points)[0] > 0:
        sheet.note(scale_words("l", sheet.mu, "m/mm"))
    sheet.note(_("forces not to scale"))
    sheet.note(_("positive moments: counterclockwise"))
    if any(e.sought is None for e in equations):
        sheet.note(_("all reactions of the group are found from simultaneous equations"))
    return (sheet,) if text is None else (sheet, text)


def _draw_assur_point(sheet: DrawingSheet, loaded: FreeBody, equation: MomentEquation) -> None:
    """Mark the Assur point, and draw the lines of action of the reactions that intersect there."""
    at, with_moments = sheet.on(equation.centre), {t.acting.symbol for t in equation.terms}
    for load in loaded.acting:
        if load.pair and not load.couple and load.symbol not in with_moments:
            sheet.line([sheet.on(load.at), at], REACTION_COLOUR, 0.5, "-.", 1.7)
    sheet.circle(at, 0.6, REACTION_COLOUR, REACTION_COLOUR, 0.5)
    sheet.label(equation.about, at, 10)


MOST_FORCES = 20  # forces and couples: with more only the significant ones are drawn
SLIGHT_SHARE = 1e-3  # of the largest force or moment: a smaller load is not significant


def draw_plan_points(sheet: DrawingSheet, ends: Mapping[str, complex], pole: str) -> None:
    """Draw the lettered points of a velocity plan. Points that coincide on paper share a circle and a label."""
    for at, names in gather_coincident((sheet.on(end), name) for name, end in ends.items()):
        sheet.circle(at, 0.9 if pole in names else 0.55, "white" if pole in names else DARK_COLOUR, DARK_COLOUR, 1.0)
        sheet.label(", ".join(map(with_subscripts, names)), at, 11 if pole in names else 10)


def significant_forces(plan: LeverPlan) -> Sequence[ForceOrCouple]:
    """Return the forces and couples to be drawn on the Zhukovsky lever.

    If there are more than MOST_FORCES, loads are omitted whose force and moment are both below 0.1 % of the largest.
    """
    if len(plan.acting) <= MOST_FORCES:
        return plan.acting
    force, moment = max(abs(a.force) for a in plan.acting), max(abs(term.moment) for term in plan.equation.terms)
    return [
        a for a in plan.acting if a.pair or abs(a.force) > SLIGHT_SHARE * force or abs(a.moment) > SLIGHT_SHARE * moment
    ]


def draw_lever(position: Position) -> Iterable[tuple[str, Drawing]]:
    """Yield the Zhukovsky lever (rotated velocity plan), as (stem of the file name, drawing).

    The drawing contains all forces, their arms and the moment equation.
    """
    results = position.results
    if results.lever is None or results.reactions is None:
        return
    crank = results.linkage.driver.kind == "turn"
    plan = lever_plan(position.motion, results.reactions, results.lever, position.k)
    points = [*plan.ends.values(), *(term.foot for term in plan.equation.terms)]
    title = (
        _("Zhukovsky lever: velocity plan for 1 rad/s of the driver, rotated by 90° clockwise. {caption}")
        if crank
        else _("Zhukovsky lever: velocity plan for 1 m/s of the driver, rotated by 90° clockwise. {caption}")
    )
    unit = "N·m" if crank else "N"
    pairs = [word for pair in plan.pairs for word in _couple_equation(pair)]
    lines = (
        [*equation_lines(plan.equation, unit), *([tuple(pairs)] if pairs else []), *_force_plan_check(position)]
        if writes_equations()
        else []
    )
    units = results.problem.units if crank else None

    def beneath(mu: float) -> DrawingCaption:
        return DrawingCaption(lines, (forces_table(plan.acting, unit), arms_table([plan.equation], units, mu)))

    sheet, text = captioned_sheets(
        position, title, [*((place, 0j) for place in points), *arrow_extent(plan.acting)], beneath
    )
    for bar in plan.bars:
        sheet.line(
            [sheet.on(bar.start), sheet.on(bar.end)], DARK_COLOUR if bar.kind == "absolute" else THIN_COLOUR, 1.5, z=3
        )
    bars = sheet.canvas.line_points
    drawn_loads = significant_forces(plan)
    ForceArrows(sheet).draw(drawn_loads)
    draw_arms(
        sheet, [replace(plan.equation, terms=tuple(t for t in plan.equation.terms if t.acting in drawn_loads))], bars
    )
    draw_plan_points(sheet, plan.ends, LEVER_POLE)
    sheet.note(scale_words("l", sheet.mu, "m/mm") if crank else scale_words("i", sheet.mu, "1/mm"))
    few = len(drawn_loads) < len(plan.acting)
    sheet.note(
        _("forces not to scale; forces below 0.1 % of the largest are listed only in the table")
        if few
        else _("forces not to scale")
    )
    sheet.note(_("positive moments: counterclockwise"))
    if any(a.couple and not a.pair for a in plan.acting):
        sheet.note(_("M′: moment M multiplied by the ratio of the speed of its link to that of the driver"))
    for line in _several_driver_notes(position):
        sheet.note(line)
    yield position.stem("lever"), sheet.finish()
    if text is not None:
        yield position.stem("lever") + "-sheet-2", text.finish()


def _couple_equation(pair: CoupleAsForces) -> tuple[str | Symbol, ...]:
    """Return the text of the equation P = M / AB for the pair of forces that replaces a couple."""
    moment, distance, force = map(format_figures, (abs(pair.moment), pair.distance, pair.force))
    numbers = f"{moment} / {distance} = {force} {spelt('N')}"
    return (pair.symbol, " = ", pair.couple, f" / {''.join(pair.points)} = {numbers}      ")


def _force_plan_check(position: Position) -> Iterable[Words]:
    """Yield a line with the balancing load found from the force plans, and its difference from that of the lever.

    There is no such line for a mechanism with several drivers.
    """
    results, reactions = position.results, position.results.reactions
    assert reactions is not None and results.lever is not None
    if len(reactions.balances) > 1:
        return
    balance, difference = reactions.balance, 100 * float(results.lever.difference[position.k])
    turns = balance.kind == "moment"
    value = float((balance.generalized if turns else balance.force)[position.k])
    yield filled(
        _("force plan: {name} = {value} {unit}; the difference is {percent} %"),
        name=balance_symbol(balance.driver.link, several=False, turns=turns),
        value=format_figures(abs(value)),
        unit=spelt("N·m" if turns else "N"),
        percent=format_figures(difference if difference > NO_DIFFERENCE else 0.0),
    )


def _several_driver_notes(position: Position) -> Iterable[str]:
    """Yield notes on the balancing loads of a mechanism with several drivers; nothing for one driver.

    The Zhukovsky lever gives only their sum, each multiplied by its velocity ratio to the first driver.
    """
    motion, results, k = position.motion, position.results, position.k
    reactions = results.reactions
    assert reactions is not None and results.lever is not None
    if len(reactions.balances) == 1:
        return
    crank, names = results.linkage.driver.kind == "turn", []
    for balance in reactions.balances:
        ratio = float(np.broadcast_to(motion.drives[balance.driver.link].first, motion.q.shape)[k])
        turns = balance.moment is not None
        name = balance_symbol(balance.driver.link, True, turns=turns).name
        names.append(name if ratio == 1 else f"{numeral(ratio, '+.4g')}·{name}")
        yield _("{name} = {value} {unit} (force plan)").format(
            name=name, value=numeral(float(balance.generalized[k]), ".6g"), unit=spelt("N·m" if turns else "N")
        )
    yield _("Zhukovsky lever: {names} = {value} {unit}").format(
        names=" ".join(names),
        value=numeral(float(results.lever.balancing[k]), ".6g"),
        unit=spelt("N·m" if crank else "N"),
    )
