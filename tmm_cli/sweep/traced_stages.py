"""Traced calculation of variants with a fully rotating crank, and exact peaks of their curves.

Unlike `batch.TracedVariants`, it also handles loads that act in one stroke only: the start and the length of each
stroke are inputs of the trace.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tmm_cli.batch import (
    CHECKS,
    CONVERGED,
    Make,
    NotTraceableError,
    TracedNumber,
    TraceProgram,
    Variant,
    placeholder_linkage,
    resolve_traced,
    solve_stages,
    split_columns,
    trace_function,
)
from tmm_cli.mechanics.assembly import analyse_mobile_structure, assemble
from tmm_cli.mechanics.forces import Reactions
from tmm_cli.mechanics.groups import ClosedFormSolver, link_states
from tmm_cli.mechanics.kinematics import (
    Motion,
    Stroke,
    Strokes,
    driven_links,
    output_coordinate,
    output_slope,
    pressure_angle,
)
from tmm_cli.mechanics.numerics import END_OF_SLOT, WINDOW_SIDE, Real, window_peak
from tmm_cli.mechanics.structure import output_link, turns_of_cycle

WINDOW_PLACES, WINDOW_STEPS = 17, 30  # samples around a peak, and their number per scan step
SHIFTS = 12  # largest number of shifts of a window whose peak lies at its edge


def candidate_peaks(curve: Real, level: Real, where: Real) -> tuple[Real, Real]:
    """Find samples of closed curves near which a peak may reach a given level.

    Between two samples a curve is assumed to rise by at most twice the difference of the samples.

    Args:
        curve: samples of the curves, (variants, positions).
        level: level for each curve, (variants,).
        where: mask of the samples to be examined, (variants, positions) or (variants, 1).

    Returns:
        Variant number and position number of each such sample.
    """
    before, after = np.roll(curve, 1, axis=1), np.roll(curve, -1, axis=1)
    with np.errstate(invalid="ignore"):
        rise = np.maximum(curve - before, curve - after)
        candidates = (curve >= before) & (curve > after) & (curve + 2 * rise >= level[:, None]) & where
    row, place = np.nonzero(candidates)
    return row, place


def refine_peaks(curve: Callable[[Real], Real], q: Real, step: float, values: tuple[Real, Real, Real]) -> Real:
    """Compute the exact value of one peak of each curve, (peaks,).

    Args:
        curve: function that evaluates the curves at driver coordinates (peaks, n).
        q: driver coordinate of the highest sample, (peaks,).
        step: distance between samples.
        values: samples of the curves before, at and after q.
    """
    before, centre, after = values
    bend = 2 * centre - before - after
    with np.errstate(invalid="ignore", divide="ignore"):
        off = np.where(bend > 0, (after - before) / (2 * bend), 0.0)
    middle = q + step * np.clip(off, -1, 1)
    window = step / WINDOW_STEPS * np.arange(-(WINDOW_PLACES // 2), WINDOW_PLACES // 2 + 1)
    for _ in range(SHIFTS):
        samples = curve(middle[:, None] + window)
        top = np.argmax(samples, axis=1)
        edge = (top < WINDOW_SIDE) | (top >= WINDOW_PLACES - WINDOW_SIDE)
        if not np.any(edge):
            break
        middle = np.where(edge, middle + window[top], middle)
    return np.maximum(centre, window_peak(samples))


# Traced stages for variants of a linkage with a fully rotating crank, each at its own positions.
#
# Unlike `traced_variants`, loads may act in strokes: the beginning and length of strokes are inputs of the trace.


CYCLE = 180  # steps per revolution in the search for peaks of quantities at positions
FINE_SCAN = 1440  # positions per revolution, as in the ordinary stages


@dataclass(frozen=True)
class LimitedCurve:
    """A quantity over one revolution that has a limit.

    It is the pressure angle of a link (rad), or the distance of a block beyond an end of its slot, as a fraction of the
    length of the slot.

    Attributes:
        name: name of the curve in the trace.
        kind: "pressure" or "slot".
        link: driven link, or name of the prismatic pair.
        sliding: True if the driven link slides.
    """

    name: str
    kind: str
    link: str
    sliding: bool = False


class CrankVariants:
    """Variants of a linkage with a fully rotating crank, computed from a trace; each has its own driver positions.

    Args:
        make: builds the linkage from its numbers.
        first: numbers of the first variant, SI units.
        read: reads the requested quantities from the motion and the reactions.
        forces: True if these quantities need reactions.

    Raises:
        NotTraceableError, DependsOnData: The calculation cannot be traced.
        LinkageError: The first variant cannot be assembled.
    """

    def __init__(
        self,
        make: Make,
        first: Sequence[float],
        read: Callable[[Motion, Reactions | None], Mapping[str, Any]],
        *,
        forces: bool,
    ) -> None:
        self.make, self.first, self.variant = make, tuple(first), make(first)
        linkage = self.linkage = self.variant.linkage
        driver = linkage.driver
        turns = driver.kind == "turn" and driver.stroke is None and turns_of_cycle(linkage) == linkage.turns == 1
        if not turns or driver.law is not None or linkage.others or linkage.meshes or linkage.friction:
            raise NotTraceableError
        self.structure = analyse_mobile_structure(linkage)
        self.kernels = assemble(linkage, self.structure)
        if not all(isinstance(kernel, ClosedFormSolver) and kernel.plain for kernel in self.kernels):
            raise NotTraceableError
        self.single = [k for k, kernel in enumerate(self.kernels) if getattr(kernel, "assemblies", 0) == 1]
        leads = [lead for kernel in self.kernels for lead in driven_links(kernel.group)]
        self.slots = [slide for slide in linkage.slides if slide.ends is not None]
        self.limited = (
            *(LimitedCurve(f"angle{n}", "pressure", lead[0], lead[1].kind == "P") for n, lead in enumerate(leads)),
            *(LimitedCurve(f"slot{n}.{end}", "slot", slide.name) for n, slide in enumerate(self.slots) for end in "01"),
        )
        link = output_link(linkage, tuple(kernel.group for kernel in self.kernels))
        whole = link is not None and (linkage.slides_on_frame(link) or linkage.hinged_to_frame(link))
        self.output = link if whole else None
        if linkage.stroke_links and self.output is None:
            raise NotTraceableError
        self.stroke_links = (*([self.output] if self.output else []), *linkage.stroke_links)
        self.scan, self.close = (trace_function(self._states, *[1] * len(first), axis) for axis in (2, 3))
        self.forces = trace_function(
            lambda *data: self._positions(data, read, forces), *[1] * (len(first) + 4 * len(self.stroke_links) + 1), 3
        )
        self.forces = self.forces.only(*(name for name in self.forces.outputs if name not in (*CHECKS, CONVERGED)))
        self._parts: dict[tuple[str, ...], TraceProgram] = {}
        self._some: dict[tuple[str, ...], TraceProgram] = {}

    def curve_program(self, *names: str) -> TraceProgram:
        """Return the traced program that computes only these curves. It is cached.

        Each variant has its own driver coordinates.
        """
        if names not in self._parts:
            self._parts[names] = self.close.only(*names)
        return self._parts[names]

    @cached_property
    def strokes(self) -> tuple[int, ...]:
        """Number of strokes of each link in `stroke_links` in the first variant: two or none.

        Raises:
            NotTraceableError: The main output has more than two strokes, or another link does not have exactly two.
        """
        coordinates = self.linkage.sketch.at + 2 * np.pi * np.arange(FINE_SCAN) / FINE_SCAN
        names = [f"slope{k}" for k in range(len(self.stroke_links))]
        slopes = self.scan.only(*names)(*(np.array([[x]]) for x in self.first), coordinates)
        counts = tuple(int(np.sum(sign_changes(slopes[name]))) for name in names)
        if any(count > 2 for count in counts) or any(count != 2 for count in counts[1:]):
            raise NotTraceableError
        return counts

    def _linkage(self, data: Sequence[Any]) -> Any:
        """Return the linkage and its group solvers for the inputs of a trace."""
        linkage = placeholder_linkage(self.make, self.first, data, self.linkage.sketch)
        return linkage, tuple(kernel.rebind(linkage) for kernel in self.kernels)

    def _states(self, *data: Any) -> Mapping[str, Any]:
        linkage, kernels = self._linkage(data[:-1])
        states = link_states(linkage, kernels, data[-1], 1, blank=False)
        curves: dict[str, Any] = {}
        for k, at in enumerate(states.placements):
            curves |= {f"gap{k}": at.residual - at.slack, f"slack{k}": at.slack, f"det{k}": at.det}
        for k, link in enumerate(self.stroke_links):
            curves |= {f"slope{k}": output_slope(states, link), f"place{k}": output_coordinate(states, link)}
        leads = [(k, lead) for k, kernel in enumerate(kernels) for lead in driven_links(kernel.group)]
        for n, (k, lead) in enumerate(leads):
            curves[f"angle{n}"] = pressure_angle(states, kernels[k], states.placements[k], lead)
        for n, slide in enumerate(self.slots):
            guide = linkage.slide(slide.name)
            first, last = (linkage.local(guide.carrier, name) for name in guide.ends)
            run, length = states.run(guide), np.abs(last - first)
            curves |= {f"slot{n}.0": -run / length, f"slot{n}.1": run / length - 1}
        return curves

    def _positions(
        self, data: Sequence[Any], read: Callable[[Motion, Reactions | None], Mapping[str, Any]], forces: bool
    ) -> Mapping[str, Any]:
        *columns, begin, q = data
        columns, ends = columns[: len(self.first)], columns[len(self.first) :]
        linkage, kernels = self._linkage(columns)
        outputs = []
        for k, link in enumerate(self.stroke_links):
            start, length, low, run = ends[4 * k : 4 * k + 4]
            pair: tuple[Any, ...] = ()
            if self.strokes[k]:
                pair = (Stroke(start, length, low, run, True), Stroke(start + length, length, low + run, -run, False))
            outputs.append(Strokes(link, "swing" if linkage.output_swings(link) else "slide", pair, ""))
        strokes = replace(outputs[0], others=tuple(outputs[1:])) if outputs else None
        structure = self.structure.rebind(linkage)
        return solve_stages(linkage, structure, kernels, q, read, forces, strokes, blank=False, start=begin)

    def varied(self, columns: Real) -> tuple[Variant, Real]:
        """Combine variants into one variant whose numbers are arrays, (variants, 1).

        Returns:
            The combined variant, and True for each variant whose linkage has a structure different from the first,
                (variants,).
        """
        otherwise: list[Any] = []
        both = zip(self.first, split_columns(columns), strict=True)
        variant = self.make([TracedNumber(x, column, otherwise) for x, column in both])
        apart = np.zeros(len(columns), dtype=bool)
        for truth in otherwise:
            apart |= np.broadcast_to(np.asarray(truth), (len(columns), 1))[:, 0]
        return replace(variant, linkage=resolve_traced(variant.linkage), request=resolve_traced(variant.request)), apart

    def over_cycle(
        self, columns: Real, strokes: Strokes | None
    ) -> tuple[Real, Callable[[Real, Real, Sequence[str]], Mapping[str, Real]]]:
        """Prepare the evaluation of the requested quantities over a cycle.

        Args:
            columns: parameter values of the variants in SI units, (variants, parameters).
            strokes: strokes of the variants; None if no link has strokes.

        Returns:
            Driver coordinates over a cycle, (positions,), and a function that evaluates quantities. The function takes
                the
            numbers of k variants, (k,), driver coordinates for each of them, (k, n), and names of quantities.
        """
        outputs = () if strokes is None else (strokes, *strokes.others)
        firsts = [next(iter(x.strokes), Stroke(0.0, 0.0, 0.0, 0.0, True)) for x in outputs]
        ends = (x for stroke in firsts for x in (stroke.start, stroke.length, stroke.low, stroke.run))
        numbers = [x + np.zeros((len(columns), 1)) for x in ends]
        start, sense = self.linkage.sketch.at, self.linkage.driver.sense

        def at(rows: Real, q: Real, names: Sequence[str]) -> Mapping[str, Real]:
            program = self._quantity_program(*names)
            return program(*split_columns(columns[rows]), *(x[rows] for x in numbers), q[:, :1], q)

        return start + sense * np.linspace(0, 2 * np.pi, CYCLE + 1), at

    def _quantity_program(self, *names: str) -> TraceProgram:
        """Return the traced program that computes only these requested quantities. It is cached."""
        if names not in self._some:
            self._some[names] = self.forces.only(*names)
        return self._some[names]


@dataclass(frozen=True)
class VariantCurves:
    """Traced curves of a group of variants, as a function of their driver coordinates.

    When called with driver coordinates, it returns the values of each curve by name, in the same shape. The coordinates
    have the shape (variants, n), or (m * variants,) for m coordinates per variant.
    """

    program: TraceProgram
    columns: Real

    def __call__(self, q: Real) -> Mapping[str, Real]:
        shaped = q.reshape(len(self.columns), -1) if q.ndim > 1 else q.reshape(-1, len(self.columns)).T
        curves = self.program(*split_columns(self.columns), shaped)
        return {name: value if q.ndim > 1 else value.T.reshape(-1) for name, value in curves.items()}


def sign_changes(slope: Real) -> Real:
    """Return True for each position after which the slope changes its sign.

    The positions form a closed revolution: the last one is followed by the first.
    """
    forward = slope >= 0
    changes: Real = forward != np.roll(forward, -1, axis=1)
    return changes


def curve_limit(curve: LimitedCurve, allowed: tuple[float, float]) -> float:
    """Return the limit of a curve.

    Args:
        curve: the curve.
        allowed: allowed pressure angles of sliding and of rotating driven links (rad).
    """
    return END_OF_SLOT if curve.kind == "slot" else allowed[0 if curve.sliding else 1]
