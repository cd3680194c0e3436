"""Roots and extremes in longdouble: how far from where they were found their functions are sure."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from tmm_cli.accuracy.digits import U, exact
from tmm_cli.extended import WIDER
from tmm_cli.groups.base import Closed
from tmm_cli.motion import Law, Motion, move
from tmm_cli.pipeline import Results
from tmm_cli.pressure import NOTHING, angle, followers
from tmm_cli.strokes import Strokes, Travel, output_run
from tmm_cli.vectors import Real

FARTHEST = 46  # doublings of a bound that are tried: from the last bit to far beyond any use
SMOOTH = 1e-9  # of the step with which a top is looked at: what the slope's five places leave of its fifth derivative
NOISE = 64  # roundings of a function's largest value: its sign is sure beyond
LEAST = 1e-12  # of the way: ends of groups that were followed there
GUESS = 1e-9  # of the way: dead positions where a margin is least


class Wide:
    """The linkage in longdouble, where the machine has it, moved to any places."""

    def __init__(self, results: Results) -> None:
        self.results = results
        self.linkage = exact(results) if WIDER else results.linkage
        self.kernels = tuple(kernel.again(self.linkage) for kernel in results.kernels)
        self.kind: Any = np.longdouble if WIDER else np.float64
        self.unit = float(np.finfo(self.kind).eps) / 2

    def at(self, q: Real) -> Motion:
        """Kinematics there, per unit of the driver's motion."""
        return move(self.linkage, self.kernels, np.asarray(q, self.kind), Law(0.0, 1.0, 0.0, 1))

    def steps(self, place: float) -> Real:
        """Growing distances from a place, the last bit first."""
        steps: Real = 2.0 ** np.arange(FARTHEST) * np.spacing(max(abs(place), 1e-3)) / 2
        return steps

    def bracket(self, place: float, of: Callable[[Motion], Real], size: float) -> float:
        """The least distance at which a function has different signs on both sides for sure; inf if there is none."""
        steps = self.steps(place).astype(self.kind)
        with np.errstate(all="ignore"):
            value = of(self.at(np.concatenate([self.kind(place) - steps, self.kind(place) + steps])))
        value = np.where(np.abs(value) > NOISE * self.unit * size, np.sign(value), 0)
        below, above = value[: len(steps)], value[len(steps) :]
        sure = np.flatnonzero((below != above) & (np.abs(below) + np.abs(above) > 0))
        return float(steps[sure[0]]) if sure.size else float("inf")

    def turns(self, places: Real, link: str) -> Real:
        """Of the ends of strokes."""
        q = np.linspace(0, 2 * np.pi, 65)
        size = float(np.nanmax(np.abs(output_run(self.at(q), link)[1])))
        return np.array([self.bracket(float(p), lambda m: output_run(m, link)[1], size) for p in places])

    def lows(self, places: Real, bounds: Real, strokes: Strokes) -> Real:
        """Of where the output turns back, given the bounds of the driver's places there."""
        runs = [output_run(self.at(p), strokes.link)[0] for p in (places, places - bounds, places + bounds)]
        told = np.array([s.low for s in strokes.strokes])
        gaps = [np.abs(np.asarray(run - told, float)) for run in runs]
        if strokes.kind == "swing":
            gaps = [np.minimum(gap, np.abs(gap - 2 * np.pi)) for gap in gaps]
        found: Real = 2 * np.max(gaps, axis=0) + U * np.abs(told)
        return found

    def travel(self, travel: Travel) -> dict[str, float]:
        """Of the extremes of an output and the driver's places there."""
        found = {}
        asked = self.results.asked
        for name in ("low", "high"):
            place = getattr(travel, f"{name}_at")
            inner = np.min(asked) < place < np.max(asked)
            bound = self.bracket(place, lambda m: output_run(m, travel.link)[1], 0.0) if inner else 2 * U * abs(place)
            runs = output_run(self.at(place + bound * np.array([0.0, -1.0, 1.0])), travel.link)[0]
            told = getattr(travel, name)
            gaps = np.abs(np.asarray(runs - told, float))
            if travel.kind == "swing":
                gaps = np.abs(np.remainder(gaps + np.pi, 2 * np.pi) - np.pi)
            found[f"{name}_at"] = bound
            found[name] = 2 * float(np.max(gaps[np.isfinite(gaps)], initial=0.0)) + 4 * U * abs(told)
        return found

    def end(self, place: float, towards: int, group: str, span: float) -> float:
        """Of an end of the driver's way: inside of it the group can be placed, outside it cannot."""
        kernel = next((k for k in self.kernels if k.group.title == group), None)
        if not isinstance(kernel, Closed):
            return LEAST * span + 4 * U * abs(place)
        steps = self.steps(place).astype(self.kind)
        inside = self.at(self.kind(place) - towards * steps).placed
        outside = self.at(self.kind(place) + towards * steps).placed
        sure = np.flatnonzero(inside & ~outside)
        return float(steps[sure[0]]) if sure.size else LEAST * span

    def dead(self, place: float, group: str, span: float) -> float:
        """Of a dead position inside the way: there the gap of the group stops growing."""
        number = next(k for k, kernel in enumerate(self.kernels) if kernel.group.title == group)
        kernel = self.kernels[number]
        if not isinstance(kernel, Closed):
            return GUESS * span

        def closing(motion: Motion) -> Real:
            return kernel.closing(kernel.closed(motion.poses, motion.drives), motion.poses, motion.first, motion.drives)

        return min(self.bracket(place, closing, kernel.size), GUESS * span)

    def pressure(self, group: str, link: str, place: float, largest: float, span: float) -> tuple[float, float]:
        """Of a largest pressure angle, and of the driver's place there: where it is flat, half the digits only."""
        if largest < NOTHING:
            return largest + 4 * U, span
        step = 1e-3 * (span if self.results.linkage.driver.kind == "slide" else 1.0)
        motion = self.at(self.kind(place) + step * np.arange(-2, 3).astype(self.kind))
        for kernel, there in zip(motion.kernels, motion.placements, strict=True):
            for lead in followers(kernel.group):
                if (kernel.group.title, lead[0]) == (group, link):
                    with np.errstate(all="ignore"):
                        b2, b1, here, a1, a2 = angle(motion, kernel, there, lead)
                        error = 2 * abs(float(here) - largest) + 32 * U
                        bend = float(2 * here - b1 - a1) / step**2
                        slope = float(8 * (a1 - b1) - (a2 - b2)) / (12 * step)
                        off = abs(slope / bend) if bend > 0 else span  # where the slope of a smooth top is nothing
                        flat = 4 * float(np.sqrt(error / bend)) + 1e-7 * step if bend > 0 else span
                    smooth = off < 1e-3 * step
                    return error, min(4 * off + SMOOTH * step + 4 * U * abs(place) if smooth else flat, span)
        return largest, span
