"""The law of motion over the cycle: reduced moments, works, energies, reduced inertia, speed, acceleration, time.

All of it goes by the way of the driver in its sense: moments that drive it are positive, however it turns.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_cli.drawing.paper import Drawing
from tmm_cli.drawing.sheets.diagrams import BORDER_OFFSET, plot_over_driver
from tmm_cli.drawing.sheets.energy_mass import energy_mass_sheet
from tmm_cli.drawing.sheets.over_cycle import QuantityPlot, SampledCurve
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import Results, motion_at_positions
from tmm_cli.mechanics.forces import collect_loads, reduced_inertias, reduced_moment
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.quantities import ANGULAR_ACCELERATION, ANGULAR_SPEED, INERTIA, MOMENT, NUMBER

if TYPE_CHECKING:
    from tmm_cli.mechanics.dynamics import SteadyRunning


LEAST_STRETCH = 1 / 2000  # of a cycle: 0.1 mm of a diagram as wide as a page
MOST_CURVES = 6  # loads, or links, that have a curve each; the smallest of more are summed up


def draw_law_of_motion(results: Results) -> Iterable[tuple[str, Drawing]]:
    """Of a file that asks for it: what acts, what comes of it, and the energy-mass diagram."""
    yield from draw_law_curves(results)
    yield from draw_energy_mass(results)


def draw_law_curves(results: Results) -> Iterable[tuple[str, Drawing]]:
    """What acts, and what comes of it, over the cycle."""
    running = results.steady
    if running is None or results.motion is None:
        return
    way, borders = _dense_travel(running)
    q, here = running.start + running.sense * way, running.way(results.motion.q)
    moments = _("Reduced moments, works and energies; what drives is positive; dots: computed positions")
    yield from plot_over_driver(results, "law-moments", moments, q, borders, _load_plots(results, running, way, here))
    motion = _("Reduced inertia and the law of motion of the driver; dots: computed positions")
    yield from plot_over_driver(results, "law-motion", motion, q, borders, _motion_plots(results, running, way, here))


def draw_energy_mass(results: Results) -> Iterable[tuple[str, Drawing]]:
    """The energy-mass diagram."""
    if results.steady is not None and results.motion is not None:
        yield "energy-mass", energy_mass_sheet(results, results.steady, _dense_travel(results.steady)[0])


def _dense_travel(running: SteadyRunning) -> tuple[Real, list[int]]:
    """Ways close together, and after which of them a panel of the functions ends: there they may jump."""
    lows, highs = visible_stretches(running.steady.law.energy.edges)
    inner = np.linspace(0, 1, max(4, 720 // len(lows)))
    low, high = lows[:, None] + BORDER_OFFSET, highs[:, None] - BORDER_OFFSET
    places = low + (high - low) * inner
    return places.ravel(), (len(inner) * np.arange(1, len(lows)) - 1).tolist()


def visible_stretches(edges: Real) -> tuple[Real, Real]:
    """The starts and the ends of the panels between these edges that are wide enough to be seen on paper.

    Narrow panels side by side are one stretch; together narrower than a line is wide, they are left out: a jump.
    """
    least = LEAST_STRETCH * (edges[-1] - edges[0])
    wide = np.diff(edges) >= least
    kept = edges[np.append(True, wide) | np.append(wide, True)]
    seen = np.diff(kept) >= least
    return kept[:-1][seen], kept[1:][seen]


def _load_plots(results: Results, running: SteadyRunning, way: Real, here: Real) -> list[QuantityPlot]:
    """Moments of the loads and their sum; that of what drives; works; energies."""
    steady = running.steady
    law, machine = steady.law, steady.machine
    loads = _curves_with_sum(
        _reduced_load_moments(results, running, way), _reduced_load_moments(results, running, here), _("sum")
    )

    def works(x: Real) -> tuple[Real, Real, Real]:
        return machine.work(x), steady.work(x) - machine.work(x), steady.work(x)

    def energies(x: Real) -> tuple[Real, Real]:
        square = law.speed(x) ** 2 / 2
        return machine.inertia(x) * square, law.flywheel * (square - law.speed(0 * x) ** 2 / 2)

    driver = _("constant moment") if steady.task.motor is None else _("motor")
    driving = [_sample_curve(_("loads"), machine.moment, way, here), _sample_curve(driver, law.driving, way, here)]
    return [
        QuantityPlot(_("reduced moments of the loads"), MOMENT, loads),
        QuantityPlot(_("moments"), MOMENT, driving),
        QuantityPlot(_("works, J"), NUMBER, _sample_curves((_("loads"), driver, _("sum")), works, way, here), "A"),
        QuantityPlot(
            _("kinetic energy, J"),
            NUMBER,
            _sample_curves((_("links"), _("gain of the flywheel")), energies, way, here)[: 2 if law.flywheel else 1],
            "T",
        ),
    ]


def _motion_plots(results: Results, running: SteadyRunning, way: Real, here: Real) -> list[QuantityPlot]:
    """Inertia of each link and the sum, and its slope; speed, acceleration, time."""
    steady = running.steady
    law = steady.law
    parts = _curves_with_sum(
        _reduced_link_inertias(results, running, way), _reduced_link_inertias(results, running, here), _("sum")
    )
    mean = SampledCurve(
        _("mean of the largest and the least"),
        np.full(np.shape(way), np.mean(steady.speeds)),
        np.full(np.shape(here), np.nan),
        limit=True,
    )
    return [
        QuantityPlot(_("reduced inertia of the links"), INERTIA, parts),
        QuantityPlot("dJ/dφ", INERTIA, [_sample_curve("", steady.machine.slope, way, here)], "J′"),
        QuantityPlot(_("angular velocity ω"), ANGULAR_SPEED, [_sample_curve(_("ω"), law.speed, way, here), mean]),
        QuantityPlot(
            _("angular acceleration ε"), ANGULAR_ACCELERATION, [_sample_curve("", law.acceleration, way, here)]
        ),
        QuantityPlot(_("time t, s"), NUMBER, [_sample_curve("", law.time, way, here)], "t"),
    ]


def _sample_curve(name: str, of: Any, way: Real, here: Real) -> SampledCurve:
    return SampledCurve(name, of(way), of(here))


def _sample_curves(names: Sequence[str], of: Any, way: Real, here: Real) -> list[SampledCurve]:
    return [SampledCurve(name, *both) for name, *both in zip(names, of(way), of(here), strict=True)]


def _reduced_load_moments(results: Results, running: SteadyRunning, way: Real) -> dict[str, Real]:
    """Reduced moments by names of loads, along the sense of the driver."""
    motion = motion_at_positions(results, running.start + running.sense * way)
    found: dict[str, Real] = {}
    for load in collect_loads(motion, results.strokes):
        if load.kind != "inertia":
            text = _("weight of link {link}") if load.kind == "weight" else _("load {name}")
            name = text.format(link=load.link, name=load.name.rstrip("'"))
            found[name] = found.get(name, 0.0) + running.sense * reduced_moment(motion, load)
    return found


def _reduced_link_inertias(results: Results, running: SteadyRunning, way: Real) -> dict[str, Real]:
    motion = motion_at_positions(results, running.start + running.sense * way)
    text = _("link {link}")
    return {text.format(link=link): own + 0.0 * way for link, (own, __) in reduced_inertias(motion).items()}


def _curves_with_sum(curves: dict[str, Real], points: dict[str, Real], total: str) -> list[SampledCurve]:
    """A course of each part that is not nothing, the small ones of many as one, after the sum of all."""
    sizes = {name: float(np.max(np.abs(values))) for name, values in curves.items()}
    largest = max(sizes.values(), default=0.0)
    courses = [SampledCurve(name, curves[name], points[name]) for name, size in sizes.items() if size > 1e-9 * largest]
    every = _total_curve(courses, total)
    if len(courses) > MOST_CURVES:
        kept = sorted(courses, key=lambda one: -sizes[one.name])[: MOST_CURVES - 1]
        rest = [one for one in courses if one not in kept]
        courses = [*(one for one in courses if one in kept), _total_curve(rest, _("others"))]
    return [every, *courses] if len(courses) > 1 else [replace(every, name=one.name) for one in courses] or [every]


def _total_curve(courses: Sequence[SampledCurve], name: str) -> SampledCurve:
    still = SampledCurve(name, np.zeros(1), np.zeros(1))
    return SampledCurve(
        name, sum((c.values for c in courses), still.values), sum((c.points for c in courses), still.points)
    )
