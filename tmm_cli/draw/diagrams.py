"""Diagrams over the cycle: motion of outputs, what balances the drivers, reactions, energy, pressure angles."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from tmm_cli.analysis.pipeline import Results, at_places
from tmm_cli.draw.chart_axes import chart
from tmm_cli.draw.sheet import DARK, THIN, safe, with_unit
from tmm_cli.errors import _
from tmm_cli.kinematics.motion import Motion
from tmm_cli.kinematics.pressure import angle, followers, named
from tmm_cli.linkage import FRAME
from tmm_cli.plans.record import LANDSCAPE, PORTRAIT, balance_name, reaction_name
from tmm_cli.quantities import ANGLE, FORCE, INERTIA, LENGTH, MASS, MOMENT, NUMBER, Dimension
from tmm_cli.results.reports.cycle import output_motion
from tmm_cli.structure.cycle import DENSE

MOST_POINTS = 1440  # of a curve over a cycle
MARKS = 360  # computed positions that are marked on a curve; more of them would hide it
LINES = (DARK, "#b3261e", "#1f4e9c", "#1d7a3a", "#7a3d99", "#c77700", "#00757d", "#8a8a8a")
STYLES = ("-", "--", "-.", ":")


Line = tuple[str, Any, Any]  # label; values close together, and at the computed positions
Panel = tuple[str, Dimension, list[Line]]


def diagrams(results: Results) -> Iterable[tuple[str, Figure]]:
    """Run, speed and acceleration of the outputs, and the balancing moments; reactions, energy and pressure angles."""
    whole = at_places(results, results.closely(_points(results)))
    motion = whole.motion
    assert motion is not None and results.motion is not None
    q, marks = _turned(results, motion), _turned(results, results.motion)
    outputs = results.mechanism.outputs
    stems = [f"diagrams-link-{x}" if x in results.linkage.links else f"diagrams-{x}" for x in outputs]
    panels = {stem: _output(results, motion, output) for stem, output in zip(stems, outputs, strict=True)}
    first = panels.pop(stems[0]) if stems else []
    cycle = _("Diagrams over the cycle; dots: computed positions")
    reactions = _("Reactions over the cycle; dots: computed positions")
    energy = _("The mechanism reduced to its driver, and its powers; dots: computed positions")
    pressure = _("Pressure angles over the cycle; dots: computed positions, dashed: allowed")
    for title, stem, every in (
        (cycle, "diagrams", [*first, *_balances(whole, results)]),
        *((cycle, stem, every) for stem, every in panels.items()),
        (reactions, "reactions", _reactions(whole, results)),
        (energy, "energy", _energy(whole, results)),
        (pressure, "pressure", _pressure(results, motion)),
    ):
        if every:
            yield safe(stem), _figure(results, title, q, marks, every)


def _points(results: Results) -> int:
    """More points where the cycle has several turns."""
    turns = results.driver_range.turns if results.driver_range is not None and results.driver_range.full else 1
    return min((DENSE - 1) * turns, MOST_POINTS) + 1


def _reactions(whole: Results, results: Results) -> list[Panel]:
    """Sizes of all reactions, six in a panel."""
    panels: list[Panel] = []
    if whole.reactions is None or results.reactions is None:
        return panels
    here = {r.pair.name: r for r in results.reactions.all}
    for words, on_frame in ((_("reactions of the frame"), True), (_("between moving links"), False)):
        lines = [
            (f"{reaction_name(r.by, r.on)} ({r.pair.name})", np.abs(r.force), np.abs(here[r.pair.name].force))
            for r in whole.reactions.all
            if (FRAME in (r.on, r.by)) == on_frame
        ]
        panels += [(words, FORCE, lines[i : i + 6]) for i in range(0, len(lines), 6)]
    return panels


def _balances(whole: Results, results: Results) -> list[Panel]:
    """What balances the drivers: moments in one panel, forces in another."""
    if whole.reactions is None or results.reactions is None:
        return []
    several = len(whole.reactions.balances) > 1
    lines: dict[bool, list[Line]] = {True: [], False: []}
    for curve, points in zip(whole.reactions.balances, results.reactions.balances, strict=True):
        turns = curve.moment is not None if several else curve.kind == "moment"
        name = balance_name(curve.driver.link, several, turns=turns) if several else ""
        values, dots = (b.generalized if several or turns else b.force for b in (curve, points))
        lines[turns].append((name, values, dots))
    moments = _("balancing moments Mb") if several else _("balancing moment Mb")
    forces = _("balancing forces Fb") if several else _("balancing force Fb")
    panels = ((moments, MOMENT, lines[True]), (forces, FORCE, lines[False]))
    return [panel for panel in panels if panel[-1]]


def _output(results: Results, motion: Motion, link: str) -> list[Panel]:
    """Motion of an output; an angle is followed through full turns."""
    assert results.motion is not None
    panels: list[Panel] = []
    q = _turned(results, motion)
    near = [int(np.argmin(np.abs(q - x))) for x in _turned(results, results.motion)]
    curves, given = output_motion(results, motion, link), output_motion(results, results.motion, link)
    for (name, values, dimension), (__, points, ___) in zip(curves, given, strict=True):
        if dimension == ANGLE:
            values = np.unwrap(values)
            points = points + 2 * np.pi * np.round((values[near] - points) / (2 * np.pi))
        panels.append((name, dimension, [("", values, points)]))
    return panels


def _energy(whole: Results, results: Results) -> list[Panel]:
    """Reduced inertia and moment, kinetic energy, powers; nothing where nothing weighs and nothing acts."""
    curve, given = whole.energy, results.energy
    if curve is None or given is None:
        return []
    crank = results.linkage.driver.kind == "turn"
    powers = {
        _("drivers"): "drivers", _("weights"): "weights", _("loads"): "loads", _("friction"): "friction",
        _("rate of T"): "rate",
    }  # fmt: skip
    panels: list[Panel] = []
    for words, dimension, parts in (
        (_("reduced inertia J") if crank else _("reduced mass m"), INERTIA if crank else MASS, {"": "inertia"}),
        (_("reduced moment M") if crank else _("reduced force F"), MOMENT if crank else FORCE, {"": "moment"}),
        (_("kinetic energy T, J"), NUMBER, {"": "kinetic"}),
        (_("power, W"), NUMBER, powers),
    ):
        lines = [(label, getattr(curve, name), getattr(given, name)) for label, name in parts.items()]
        lines = [line for line in lines if np.any(np.nan_to_num(line[1]) != 0)]
        if lines:
            panels.append((words, dimension, lines))
    return panels


def _pressure(results: Results, motion: Motion) -> list[Panel]:
    """Pressure angles of all driven links, those that slide and those that turn apart: different ones are allowed."""
    panels: list[Panel] = []
    with np.errstate(all="ignore"):
        curves = {
            (kernel.group.title, lead[0], named(lead)): angle(motion, kernel, at, lead)
            for kernel, at in zip(motion.kernels, motion.placements, strict=True)
            for lead in followers(kernel.group)
        }
    for slides in (True, False):
        found = [p for p in results.pressure if p.slides == slides]
        text = _("link {link} in pair {pair}")
        lines = [
            (text.format(link=p.link, pair=p.pair), curves[p.group, p.link, p.pair], p.angles) for p in found
        ]  # fmt: skip
        if lines:
            limit = ("", np.full(np.shape(motion.q), found[0].allowed), np.full(np.shape(found[0].angles), np.nan))
            words = _("pressure angle where links slide") if slides else _("pressure angle where links turn")
            panels.append((words, ANGLE, [*lines, limit]))
    return panels


def _turned(results: Results, motion: Motion) -> Any:
    """The driver's turn from position 0, deg; a slider's run in the file's unit."""
    if results.linkage.driver.kind == "slide":
        return np.array([results.problem.units.from_si(float(v), LENGTH) for v in motion.q])
    return np.degrees(results.linkage.driver.sense * (motion.q - results.start))


def _figure(results: Results, title: str, q: Any, marks: Any, panels: Sequence[Panel]) -> Figure:
    units = results.problem.units
    figure = chart(PORTRAIT if len(panels) > 2 else LANDSCAPE, results.problem.title, title)
    for number, (name, dimension, lines) in enumerate(panels, 1):
        axes = figure.add_subplot(len(panels), 1, number)
        for k, (label, in_si, given_in_si) in enumerate(lines):
            values, given = (np.asarray(v) / units.factor(dimension) for v in (in_si, given_in_si))
            if len(lines) > 1 and not label:  # a limit
                axes.plot(q, values, color=THIN, lw=1.0, ls="--")
                continue
            colour, dashes = LINES[k % len(LINES)], STYLES[(k // len(LINES) + k) % len(STYLES)]
            axes.plot(q, values, label=label or None, color=colour, ls=dashes, lw=1.4)
            dots = np.broadcast_to(given, np.shape(marks))
            axes.plot(marks, dots, "o", ms=3, color=colour, markevery=math.ceil(len(marks) / MARKS))
        axes.set_ylabel(with_unit(name, dimension, units), parse_math=False, fontsize=9)
        axes.axhline(0, color=DARK, lw=0.6)
        axes.grid(True, color="#d8d8d8", lw=0.5)
        axes.margins(x=0)
        axes.tick_params(labelsize=8)
        if results.linkage.driver.kind == "turn" and results.driver_range is not None and results.driver_range.full:
            end = 360 * results.driver_range.turns
            axes.set_xticks(np.arange(0, end + 1, 30 * math.ceil(results.driver_range.turns**0.8)))
            axes.set_xlim(0, end)
        if any(label for label, __, __ in lines):
            _legend(axes, ncol=3, loc="best", framealpha=0.9)
        if number == len(panels):
            turns = results.linkage.driver.kind == "turn"
            label = _("turn of the crank from position 0, deg") if turns else f"{_('driver')}, {units.symbol(LENGTH)}"
            axes.set_xlabel(label, fontsize=9)
    figure.subplots_adjust(left=0.12, right=0.96, top=0.92, bottom=0.07, hspace=0.22)
    for axes in figure.axes:
        if axes.get_legend() is not None and _covers(axes):
            _legend(axes, ncol=6, loc="lower right", bbox_to_anchor=(1, 1), borderaxespad=0.2, frameon=False)
    return figure


def _legend(axes: Axes, **how: Any) -> None:
    for text in axes.legend(fontsize=8, **how).get_texts():
        text.set_parse_math(False)


def _covers(axes: Axes) -> bool:
    """Whether its legend lies on a curve, even where it lies best."""
    legend = axes.get_legend()
    assert legend is not None
    box = legend.get_window_extent()
    curves = [axes.transData.transform(line.get_xydata()) for line in axes.lines[:-1]]  # the last one is the zero
    return any(bool(np.any(np.all((p > box.min) & (p < box.max), axis=1))) for p in curves)
