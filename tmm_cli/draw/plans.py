"""Sheets of the lever."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from tmm_cli.draw.drawing import Drawing
from tmm_cli.draw.labels import gathered
from tmm_cli.draw.mechanism import Position, unscaled
from tmm_cli.draw.sheet import COLOURS, DARK, THIN, Sheet, scale_text
from tmm_cli.errors import _
from tmm_cli.plans.lever import lever_plan
from tmm_cli.plans.record import balance_name


def letter_points(sheet: Sheet, ends: Mapping[str, complex], pole: str) -> None:
    """The lettered points; those that coincide share a place and a label."""
    for at, names in gathered((sheet.on(end), name) for name, end in ends.items()):
        sheet.circle(at, 0.9 if pole in names else 0.55, "white" if pole in names else DARK, DARK, 1.0)
        sheet.label(", ".join(names), at, 11 if pole in names else 10)


def lever(here: Position) -> Iterable[tuple[str, Drawing]]:
    """The turned velocity plan with its forces; arms are thin lines from the pole."""
    results = here.results
    if results.lever is None:
        return
    crank = results.linkage.driver.kind == "turn"
    plan = lever_plan(here.motion, results.lever, here.k)
    places = [*plan.ends.values(), *(f.at for f in plan.forces), *(f.foot for f in plan.forces)]
    title = (
        _("Zhukovsky lever: velocity plan for 1 rad/s, turned by 90°. {caption}")
        if crank
        else _("Zhukovsky lever: velocity plan for 1 m/s of the driver, turned by 90°. {caption}")
    )
    sheet = here.sheet(title, places, pad=36)
    for bar in plan.bars:
        sheet.line([sheet.on(bar.start), sheet.on(bar.end)], DARK if bar.kind == "absolute" else THIN, 1.5, z=3)
    size = max((abs(e) for e in plan.ends.values()), default=0.0)
    taken: list[tuple[complex, complex]] = []
    inertial = {n for load in results.loads if load.kind == "inertia" for n in (load.name, load.couple_name)}
    for force in plan.forces:
        at, foot = sheet.on(force.at), sheet.on(force.foot)
        if abs(force.foot) > 1e-9 * size:
            sheet.line([sheet.on(0j), foot], THIN, 0.6, ":", 2)
            sheet.line([foot, at], THIN, 0.5, "--", 2)
        unscaled(sheet, taken, at, force.force, force.name, COLOURS["inertia" if force.name in inertial else "load"])
    letter_points(sheet, plan.ends, "p")
    sheet.note(scale_text("l", sheet.mu, "m/mm") if crank else scale_text("i", sheet.mu, "1/mm"))
    for name, moment in plan.couples:
        if moment != 0:
            sheet.note(f"{name}: {moment:.4g} N*m")
    for line in _balancing(here, plan.balancing):
        sheet.note(line)
    yield here.stem("lever"), sheet.finish()


def _balancing(here: Position, value: float) -> Iterable[str]:
    """What the lever gives; with several drivers it is the sum of what they do at their speeds."""
    motion, reactions, k = here.motion, here.results.reactions, here.k
    assert reactions is not None
    crank = here.results.linkage.driver.kind == "turn"
    if len(reactions.balances) == 1:
        yield (_("Mb = {value} N*m") if crank else _("Fb = {value} N")).format(value=f"{value:.6g}")
        return
    names = []
    for balance in reactions.balances:
        ratio = float(np.broadcast_to(motion.drives[balance.driver.link].first, motion.q.shape)[k])
        turns = balance.moment is not None
        name = balance_name(balance.driver.link, True, turns=turns)
        names.append(name if ratio == 1 else f"{ratio:+.4g}·{name}")
        yield _("{name} = {value} {unit} (force plan)").format(
            name=name, value=f"{float(balance.generalized[k]):.6g}", unit="N*m" if turns else "N"
        )
    yield _("lever: {names} = {value} {unit}").format(
        names=" ".join(names), value=f"{value:.6g}", unit="N*m" if crank else "N"
    )
