"""The Zhukovsky lever as a sheet: the turned velocity plan with all forces, their arms and the equation of moments."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from tmm_cli.drawing.paper import (
    DARK_COLOUR,
    THIN_COLOUR,
    Drawing,
    DrawingSheet,
    Words,
    gather_coincident,
    scale_words,
    writes_equations,
)
from tmm_cli.drawing.sheets.acting import ForceArrows, arrow_extent, draw_arms
from tmm_cli.drawing.sheets.beneath import DrawingCaption, captioned_sheets
from tmm_cli.drawing.sheets.group_loads import arms_table, equation_lines, forces_table, format_figures
from tmm_cli.drawing.sheets.mechanism import Position
from tmm_cli.language import _, filled, numeral, spelt
from tmm_cli.mechanics.forces import ForceOrCouple, Symbol, balance_symbol
from tmm_cli.mechanics.numerics import NO_DIFFERENCE
from tmm_cli.mechanics.plans import LEVER_POLE, CoupleAsForces, LeverPlan, lever_plan, with_subscripts

MOST_FORCES, SLIGHT_SHARE = (
    20,
    1e-3,
)  # forces and couples beyond which one sees no more; of the largest: a load that hardly counts


def draw_plan_points(sheet: DrawingSheet, ends: Mapping[str, complex], pole: str) -> None:
    """The lettered points; those that coincide share a place and a label."""
    for at, names in gather_coincident((sheet.on(end), name) for name, end in ends.items()):
        sheet.circle(at, 0.9 if pole in names else 0.55, "white" if pole in names else DARK_COLOUR, DARK_COLOUR, 1.0)
        sheet.label(", ".join(map(with_subscripts, names)), at, 11 if pole in names else 10)


def significant_forces(plan: LeverPlan) -> Sequence[ForceOrCouple]:
    """Of many forces and couples those that count: no load below a thousandth of the largest force or moment."""
    if len(plan.acting) <= MOST_FORCES:
        return plan.acting
    force, moment = max(abs(a.force) for a in plan.acting), max(abs(term.moment) for term in plan.equation.terms)
    return [
        a for a in plan.acting if a.pair or abs(a.force) > SLIGHT_SHARE * force or abs(a.moment) > SLIGHT_SHARE * moment
    ]


def draw_lever(here: Position) -> Iterable[tuple[str, Drawing]]:
    """Arms are lines from the pole to the feet on the lines of forces."""
    results = here.results
    if results.lever is None or results.reactions is None:
        return
    crank = results.linkage.driver.kind == "turn"
    plan = lever_plan(here.motion, results.reactions, results.lever, here.k)
    places = [*plan.ends.values(), *(term.foot for term in plan.equation.terms)]
    title = (
        _("Zhukovsky lever: velocity plan for 1 rad/s, turned by 90° clockwise. {caption}")
        if crank
        else _("Zhukovsky lever: velocity plan for 1 m/s of the driver, turned by 90° clockwise. {caption}")
    )
    unit = "N·m" if crank else "N"
    pairs = [word for pair in plan.pairs for word in _couple_equation(pair)]
    lines = (
        [*equation_lines(plan.equation, unit), *([tuple(pairs)] if pairs else []), *_force_plan_check(here)]
        if writes_equations()
        else []
    )
    units = results.problem.units if crank else None

    def beneath(mu: float) -> DrawingCaption:
        return DrawingCaption(lines, (forces_table(plan.acting, unit), arms_table([plan.equation], units, mu)))

    sheet, text = captioned_sheets(
        here, title, [*((place, 0j) for place in places), *arrow_extent(plan.acting)], beneath
    )
    for bar in plan.bars:
        sheet.line(
            [sheet.on(bar.start), sheet.on(bar.end)], DARK_COLOUR if bar.kind == "absolute" else THIN_COLOUR, 1.5, z=3
        )
    bars = sheet.ground.crowd
    shown = significant_forces(plan)
    ForceArrows(sheet).draw(shown)
    draw_arms(sheet, [replace(plan.equation, terms=tuple(t for t in plan.equation.terms if t.acting in shown))], bars)
    draw_plan_points(sheet, plan.ends, LEVER_POLE)
    sheet.note(scale_words("l", sheet.mu, "m/mm") if crank else scale_words("i", sheet.mu, "1/mm"))
    few = len(shown) < len(plan.acting)
    sheet.note(_("forces without scale, below 0.1 % only in the table") if few else _("forces without scale"))
    sheet.note(_("moments positive counterclockwise"))
    if any(a.couple and not a.pair for a in plan.acting):
        sheet.note(_("M′: M times the ratio of the link's speed to the driver's"))
    for line in _several_driver_notes(here):
        sheet.note(line)
    yield here.stem("lever"), sheet.finish()
    if text is not None:
        yield here.stem("lever") + "-sheet-2", text.finish()


def _couple_equation(pair: CoupleAsForces) -> tuple[str | Symbol, ...]:
    """P = M / AB: the forces that stand for a couple."""
    moment, distance, force = map(format_figures, (abs(pair.moment), pair.distance, pair.force))
    numbers = f"{moment} / {distance} = {force} {spelt('N')}"
    return (pair.symbol, " = ", pair.couple, f" / {''.join(pair.points)} = {numbers}      ")


def _force_plan_check(here: Position) -> Iterable[Words]:
    """What the force plan has found for the one driver, and the difference."""
    results, reactions = here.results, here.results.reactions
    assert reactions is not None and results.lever is not None
    if len(reactions.balances) > 1:
        return
    balance, difference = reactions.balance, 100 * float(results.lever.difference[here.k])
    turns = balance.kind == "moment"
    value = float((balance.generalized if turns else balance.force)[here.k])
    yield filled(
        _("force plan: {name} = {value} {unit}, difference {percent} %"),
        name=balance_symbol(balance.driver.link, several=False, turns=turns),
        value=format_figures(abs(value)),
        unit=spelt("N·m" if turns else "N"),
        percent=format_figures(difference if difference > NO_DIFFERENCE else 0.0),
    )


def _several_driver_notes(here: Position) -> Iterable[str]:
    """What the lever gives with several drivers: the sum of what they do at their speeds."""
    motion, results, k = here.motion, here.results, here.k
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
    yield _("lever: {names} = {value} {unit}").format(
        names=" ".join(names),
        value=numeral(float(results.lever.balancing[k]), ".6g"),
        unit=spelt("N·m" if crank else "N"),
    )
