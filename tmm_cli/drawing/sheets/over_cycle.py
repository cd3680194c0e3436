"""What the diagrams over the cycle show: motion of outputs, what balances the drivers, reactions, energy, pressure."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_cli.language import _, translated
from tmm_cli.mechanics.analysis import Results
from tmm_cli.mechanics.forces import balance_symbol, reaction_symbol
from tmm_cli.mechanics.kinematics import Motion, driven_links, driving_pair_names, pressure_angle
from tmm_cli.mechanics.linkage import FRAME
from tmm_cli.mechanics.numerics import NO_FORCE
from tmm_cli.mechanics.quantities import (
    ANGLE,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    FORCE,
    INERTIA,
    MASS,
    MOMENT,
    NUMBER,
    Dimension,
)
from tmm_cli.reports import output_motion

MOST_CURVES = 6  # courses in a panel of reactions, of pressure angles, of what balances the drivers


@dataclass(frozen=True)
class SampledCurve:
    """How a quantity goes (SI): at places close together, and at the computed positions. limit: what is allowed."""

    name: str
    values: Any
    points: Any
    limit: bool = False


@dataclass(frozen=True)
class QuantityPlot:
    """Courses of one kind, which share a panel. symbol: of its scale, where their dimension does not say it."""

    words: str
    dimension: Dimension
    courses: Sequence[SampledCurve]
    symbol: str = ""


def output_plots(results: Results, motion: Motion, link: str) -> list[QuantityPlot]:
    """Motion of an output; an angle is followed through full turns."""
    assert results.motion is not None
    near = [int(np.argmin(np.abs(motion.q - q))) for q in results.motion.q]
    found = []
    turning = {ANGULAR_SPEED: _("ω of {link}"), ANGULAR_ACCELERATION: _("ε of {link}")}
    curves, given = output_motion(results, motion, link), output_motion(results, results.motion, link)
    for (name, values, dimension), (__, points, ___) in zip(curves, given, strict=True):
        if dimension in turning:
            name = turning[dimension].format(link=link)
        if dimension == ANGLE:
            values = np.unwrap(values)
            points = points + 2 * np.pi * np.round((values[near] - points) / (2 * np.pi))
        found.append(QuantityPlot(translated(name), dimension, [SampledCurve("", values, points)]))
    return found


def balancing_plots(whole: Results, results: Results) -> list[QuantityPlot]:
    """What balances the drivers: moments in one panel, forces in another."""
    if whole.reactions is None or results.reactions is None:
        return []
    several = len(whole.reactions.balances) > 1
    found: dict[bool, list[SampledCurve]] = {True: [], False: []}
    for curve, points in zip(whole.reactions.balances, results.reactions.balances, strict=True):
        turns = curve.moment is not None if several else curve.kind == "moment"
        name = balance_symbol(curve.driver.link, several, turns=turns).name if several else ""
        values, dots = (b.generalized if several or turns else b.force for b in (curve, points))
        found[turns].append(SampledCurve(name, values, dots))
    moments = _("balancing moments") if several else _("balancing moment")
    forces = _("balancing forces") if several else _("balancing force")
    return [
        QuantityPlot(words, dimension, courses[first : first + MOST_CURVES])
        for words, dimension, courses in ((moments, MOMENT, found[True]), (forces, FORCE, found[False]))
        for first in range(0, len(courses), MOST_CURVES)
    ]


def reaction_plots(whole: Results, results: Results) -> list[QuantityPlot]:
    """Sizes of all reactions, a few in a panel."""
    if whole.reactions is None or results.reactions is None:
        return []
    here = {r.pair.name: r for r in results.reactions.all}
    found = []
    for words, on_frame in ((_("reactions of the frame"), True), (_("between moving links"), False)):
        courses = [
            SampledCurve(f"{symbol.name} ({r.pair.name})", np.abs(r.force), np.abs(here[r.pair.name].force))
            for r, symbol in ((r, reaction_symbol(r.by, r.on)) for r in whole.reactions.all)
            if (FRAME in (r.on, r.by)) == on_frame
        ]
        found += [
            QuantityPlot(words, FORCE, courses[i : i + MOST_CURVES], "R") for i in range(0, len(courses), MOST_CURVES)
        ]
    return found


def energy_plots(whole: Results, results: Results) -> list[QuantityPlot]:
    """Reduced inertia and moment, kinetic energy, powers; nothing where nothing weighs and nothing acts."""
    curve, given = whole.energy, results.energy
    if curve is None or given is None:
        return []
    crank = results.linkage.driver.kind == "turn"
    powers = {
        _("drivers"): "drivers",
        _("weights"): "weights",
        _("loads"): "loads",
        _("friction"): "friction",
        _("rate of T"): "rate",
    }
    found = []
    for words, dimension, parts, symbol in (
        (_("reduced inertia J") if crank else _("reduced mass m"), INERTIA if crank else MASS, {"": "inertia"}, ""),
        (_("reduced moment M") if crank else _("reduced force F"), MOMENT if crank else FORCE, {"": "moment"}, ""),
        (_("kinetic energy T, J"), NUMBER, {"": "kinetic"}, "T"),
        (_("power, W"), NUMBER, powers, "P"),
    ):
        courses = [SampledCurve(label, getattr(curve, name), getattr(given, name)) for label, name in parts.items()]
        courses = [course for course in courses if np.any(np.nan_to_num(course.values) != 0)]
        if courses:
            found.append(QuantityPlot(words, dimension, courses, symbol))
    return found


def shaking_plots(results: Results, q: Any) -> list[QuantityPlot]:
    """Force and moment on the frame before and after balancing."""
    found = results.balancing
    if found is None or not np.any(np.nan_to_num(found.cycle.before.force) != 0):
        return []
    ways = [(_("without counterweights"), found.before), (_("with counterweights"), found.after)]
    told = [(*way, curve) for way, curve in zip(ways, found.at(results.mechanism, q), strict=True)]
    told = told[::-1] if found.cycle.counterweights else told[:1]  # dashed is without, as in the hodograph
    nothing = NO_FORCE * float(np.nanmax(np.abs(found.cycle.before.force)))

    def size(force: Any) -> Any:
        return np.where(np.abs(force) > nothing, np.abs(force), 0 * np.abs(force))

    forces = [SampledCurve(name, size(curve.force), size(here.force)) for name, here, curve in told]
    moments = [SampledCurve(name, curve.moment, here.moment) for name, here, curve in told]
    about = _("shaking moment about {pivot}").format(pivot=found.pivot or _("the origin"))
    return [QuantityPlot(_("shaking force"), FORCE, forces), QuantityPlot(about, MOMENT, moments)]


def pressure_plots(results: Results, motion: Motion) -> list[QuantityPlot]:
    """Pressure angles of all driven links, those that slide and those that turn apart: different ones are allowed."""
    with np.errstate(all="ignore"):
        curves = {
            (kernel.group.title, lead[0], driving_pair_names(lead)): pressure_angle(motion, kernel, at, lead)
            for kernel, at in zip(motion.kernels, motion.placements, strict=True)
            for lead in driven_links(kernel.group)
        }
    found = []
    for slides in (True, False):
        here = [p for p in results.pressure if p.slides == slides]
        text = _("link {link} in pair {pair}")
        courses = [
            SampledCurve(text.format(link=p.link, pair=p.pair), curves[p.group, p.link, p.pair], p.angles) for p in here
        ]
        words = _("pressure angle where links slide") if slides else _("pressure angle where links turn")
        for first in range(0, len(courses), MOST_CURVES):
            allowed = np.full(np.shape(motion.q), here[0].allowed)
            limit = SampledCurve(_("allowed"), allowed, np.full(np.shape(here[0].angles), np.nan), limit=True)
            found.append(QuantityPlot(words, ANGLE, [*courses[first : first + MOST_CURVES], limit], "θ"))
    return found
