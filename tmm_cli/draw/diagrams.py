"""Diagrams over the cycle: motion of outputs, what balances the drivers, reactions, energy, pressure angles."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from tmm_cli.cycle import DENSE
from tmm_cli.draw.sheet import DARK, MM, THIN
from tmm_cli.forces.plan import Reactions
from tmm_cli.linkage import FRAME
from tmm_cli.motion import Motion
from tmm_cli.pipeline import Results, at_places
from tmm_cli.plans.record import LANDSCAPE, PORTRAIT, balance_name, reaction_name
from tmm_cli.pressure import angle, followers, named
from tmm_cli.problem.dimensions import ANGLE, FORCE, INERTIA, LENGTH, MASS, MOMENT, NUMBER, Dimension
from tmm_cli.results.reports.cycle import output_links, output_motion
from tmm_cli.words import say

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
    outputs = output_links(results)
    sheets = {link: _output(results, motion, link) for link in outputs}
    first = sheets.pop(outputs[0]) if outputs else []
    if whole.reactions is not None and results.reactions is not None:
        first = [*first, *_balances(whole.reactions, results.reactions)]
    if first:
        yield "diagrams", _figure(results, say("draw.diagrams"), q, marks, first)
    for link, panels in sheets.items():
        yield _stem(f"diagrams-link-{link}"), _figure(results, say("draw.diagrams"), q, marks, panels)
    if whole.reactions is not None and results.reactions is not None:
        here = {r.pair.name: r for r in results.reactions.all}
        parts: list[Panel] = []
        for word, on_frame in (("draw.outer", True), ("draw.inner", False)):
            lines = [
                (f"{reaction_name(r.by, r.on)} ({r.pair.name})", np.abs(r.force), np.abs(here[r.pair.name].force))
                for r in whole.reactions.all
                if (FRAME in (r.on, r.by)) == on_frame
            ]
            parts += [(say(word), FORCE, lines[i : i + 6]) for i in range(0, len(lines), 6)]
        yield "reactions", _figure(results, say("draw.reactions"), q, marks, parts)
    energy = _energy(whole, results)
    if energy:
        yield "energy", _figure(results, say("draw.energy"), q, marks, energy)
    pressure = _pressure(results, motion)
    if pressure:
        yield "pressure", _figure(results, say("draw.pressure"), q, marks, pressure)


def _points(results: Results) -> int:
    """More points where the cycle has several turns."""
    turns = results.way.turns if results.way is not None and results.way.full else 1
    return min((DENSE - 1) * turns, MOST_POINTS) + 1


def _stem(name: str) -> str:
    return "".join(c if c.isalnum() or c in "-_" else "_" for c in name)


def _balances(whole: Reactions, given: Reactions) -> list[Panel]:
    """What balances the drivers: moments in one panel, forces in another."""
    several = len(whole.balances) > 1
    panels: list[Panel] = []
    for moment in (True, False):
        lines: list[Line] = []
        for curve, points in zip(whole.balances, given.balances, strict=True):
            turns = curve.moment is not None if several else curve.kind == "moment"
            if turns != moment:
                continue
            name = balance_name(curve.driver.link, several) if several else ""
            values, dots = (b.generalized if several or turns else b.force for b in (curve, points))
            lines.append((name.replace("F", "M", 1) if turns else name, values, dots))
        key = (
            ("draw.balances" if moment else "draw.balance_forces")
            if several
            else "draw.moment"
            if moment
            else "draw.force"
        )
        if lines:
            panels.append((say(key), MOMENT if moment else FORCE, lines))
    return panels


def _output(results: Results, motion: Motion, link: str) -> list[Panel]:
    """Motion of an output; an angle is followed through full turns."""
    assert results.motion is not None
    panels: list[Panel] = []
    q = _turned(results, motion)
    near = [int(np.argmin(np.abs(q - x))) for x in _marked(_turned(results, results.motion))]
    curves, given = output_motion(results, motion, link), output_motion(results, results.motion, link)
    for (key, values, dimension), (_, points, _) in zip(curves, given, strict=True):
        if key == "psi":
            values = np.unwrap(values)
            marked = _marked(points)
            points = np.full(np.shape(points), np.nan)
            points[:: _every(points)] = marked + 2 * np.pi * np.round((values[near] - marked) / (2 * np.pi))
        panels.append((say(f"cycle.{key}", link=link), dimension, [("", values, points)]))
    return panels


def _energy(whole: Results, results: Results) -> list[Panel]:
    """Reduced inertia and moment, kinetic energy, powers; nothing where nothing weighs and nothing acts."""
    curve, given = whole.energy, results.energy
    if curve is None or given is None:
        return []
    crank = results.linkage.driver.kind == "turn"
    panels: list[Panel] = []

    def panel(key: str, dimension: Dimension, *parts: tuple[str, str]) -> None:
        lines = [
            (say(word) if word else "", getattr(curve, name), getattr(given, name))
            for word, name in parts
            if len(parts) == 1 or bool(np.any(np.nan_to_num(getattr(curve, name)) != 0))
        ]
        if any(bool(np.any(np.nan_to_num(values) != 0)) for _, values, _ in lines):
            panels.append((say(key), dimension, lines))

    panel("draw.J" if crank else "draw.m", INERTIA if crank else MASS, ("", "inertia"))
    panel("draw.M" if crank else "draw.F", MOMENT if crank else FORCE, ("", "moment"))
    panel("draw.T", NUMBER, ("", "kinetic"))
    panel(
        "draw.powers", NUMBER, ("draw.drivers", "drivers"), ("draw.weights", "weights"), ("draw.other_loads", "loads"),
        ("draw.rubbing", "friction"), ("draw.inertial", "rate"),
    )  # fmt: skip
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
        lines = [
            (say("draw.pressure_of", link=p.link, pair=p.pair), curves[p.group, p.link, p.pair], p.angles)
            for p in found
        ]
        if lines:
            allowed = found[0].allowed
            limit = ("", np.full(np.shape(motion.q), allowed), np.full(np.shape(found[0].angles), np.nan))
            panels.append((say("draw.sliding_links" if slides else "draw.turning_links"), ANGLE, [*lines, limit]))
    return panels


def _every(values: Any) -> int:
    """Of so many positions one is marked on a curve."""
    return -(-len(values) // MARKS)


def _marked(values: Any) -> Any:
    """Values at the positions that are marked on curves."""
    return values[:: _every(values)]


def _turned(results: Results, motion: Motion) -> Any:
    """The driver's turn from position 0, deg; a slider's run in the file's unit."""
    if results.linkage.driver.kind == "slide":
        return np.array([results.problem.units.from_si(float(v), LENGTH) for v in motion.q])
    return np.degrees(results.linkage.driver.sense * (motion.q - results.start))


def _figure(
    results: Results,
    title: str,
    q: Any,
    marks: Any,
    panels: Sequence[Panel],
) -> Figure:
    units = results.problem.units
    size = PORTRAIT if len(panels) > 2 else LANDSCAPE
    figure = Figure(figsize=(size[0] * MM, size[1] * MM))
    FigureCanvasAgg(figure)
    figure.text(0.06, 0.965, results.problem.title[:90], fontsize=12, weight="bold", parse_math=False)
    figure.text(0.06, 0.945, title, fontsize=9, color="#404040", parse_math=False)
    for number, (name, dimension, lines) in enumerate(panels, 1):
        axes = figure.add_subplot(len(panels), 1, number)
        for k, (label, values, given) in enumerate(lines):
            if len(lines) > 1 and not label:  # a limit
                axes.plot(q, _in_units(values, dimension, units), color=THIN, lw=1.0, ls="--")
                continue
            style: dict[str, Any] = {
                "color": LINES[k % len(LINES)],
                "ls": STYLES[(k // len(LINES) + k) % len(STYLES)],
                "lw": 1.4,
            }
            axes.plot(q, _in_units(values, dimension, units), label=label or None, **style)
            dots = _marked(np.broadcast_to(_in_units(given, dimension, units), np.shape(marks)))
            axes.plot(_marked(marks), dots, "o", ms=3, color=style["color"])
        measured = "" if dimension == NUMBER else f", {units.symbol(dimension)}"
        axes.set_ylabel(name + measured, parse_math=False, fontsize=9)
        axes.axhline(0, color=DARK, lw=0.6)
        axes.grid(True, color="#d8d8d8", lw=0.5)
        axes.margins(x=0)
        axes.tick_params(labelsize=8)
        if results.linkage.driver.kind == "turn" and results.way is not None and results.way.full:
            end = 360 * results.way.turns
            axes.set_xticks(np.arange(0, end + 1, 30 * math.ceil(results.way.turns**0.8)))
            axes.set_xlim(0, end)
        if any(label for label, _, _ in lines):
            _legend(axes, ncol=3, loc="best", framealpha=0.9)
        if number == len(panels):
            unit = units.symbol(LENGTH) if results.linkage.driver.kind == "slide" else "deg"
            axes.set_xlabel(f"{say('draw.turn' if unit == 'deg' else 'cycle.drive')}, {unit}", fontsize=9)
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


def _in_units(values: Any, dimension: Dimension, units: Any) -> Any:
    return np.asarray(values) if dimension == NUMBER else np.asarray(values) / units.factor(dimension)
