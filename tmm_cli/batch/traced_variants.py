"""Variants whose numbers are given at each call, solved by traced operations or one after another.

All variants have the assembly of the first linkage. Operations can be traced only if no load depends on strokes. If
they cannot be traced, the variants are solved one after another, which takes a hundred to a thousand times as long.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import replace
from typing import Any

import numpy as np

from tmm_cli.batch.continuation import (
    LEAST_TURNS,
    STEPS_PER_TURN,
    VARIANT_NEWTON_STEPS,
    Continuation,
    ContinuedPaths,
    count_initial_guesses,
    with_initial_guesses,
)
from tmm_cli.batch.prepare import ANGLES_AGREE, CHECK_OUTPUTS, OutputReader, solve_stages, traceable_groups
from tmm_cli.batch.trace_program import TraceProgram
from tmm_cli.batch.traced_arrays import DependsOnData, TracedArray, TracedNumber, trace_function
from tmm_cli.batch.variant import (
    WANTED,
    DriverRanges,
    DriverSamples,
    Make,
    NotTraceableError,
    Variant,
    compute_sketch,
    placeholder_linkage,
    split_columns,
)
from tmm_cli.mechanics.analysis import Inputs, Mechanism
from tmm_cli.mechanics.assembly import analyse_mobile_structure, assemble
from tmm_cli.mechanics.errors import LinkageError
from tmm_cli.mechanics.groups import GroupSolver
from tmm_cli.mechanics.kinematics import cycle_turns, driver_positions as places_of
from tmm_cli.mechanics.linkage import Linkage, Sketch
from tmm_cli.mechanics.numerics import Real


class TracedVariants:
    """Variants solved by traced operations.

    Called with numbers (variants, n) and samples of the driver range, it returns the requested results by name,
    (variants, samples).
    """

    def __init__(self, make: Make, first: Sequence[float], read: OutputReader, *, forces: bool = False) -> None:
        """Trace the operations for the variants.

        Args:
            make: function that builds a variant from its numbers.
            first: numbers of the first linkage, whose assembly all variants have.
            read: function that reads the requested results.
            forces: True if the results need reactions.

        Raises:
            NotTraceableError, DependsOnData: the operations cannot be traced.
            LinkageError: the first linkage cannot be assembled.
        """
        self.make, self.first, self.variant = make, first, make(first)
        self.linkage = self.variant.linkage
        self.structure = analyse_mobile_structure(self.linkage)
        self.kernels = assemble(self.linkage, self.structure)
        if self.linkage.friction or (forces and self.linkage.by_strokes):
            raise NotTraceableError
        self.lines = _traceable_groups(self.linkage, self.kernels)
        self.turns = cycle_turns(self.linkage, self.kernels) or 1
        varied = make([TracedNumber(x, x) for x in first])
        self.start = varied.start if forces else None  # only forces depend on the beginning of the law of motion
        # with several drivers a trace contains the sketched coordinates of the first linkage
        apart = bool(self.linkage.others) and isinstance(varied.linkage.sketch.at, TracedNumber)
        if apart or isinstance(self.start, TracedNumber):
            raise NotTraceableError
        by_variant = any(isinstance(number, TracedNumber) for number in _extra_numbers(varied))
        self.ends = trace_function(self._ends, *[1] * len(first)) if by_variant else None
        self.program = self._trace_stages(read, forces, by_variant)
        self.continuation = (
            Continuation(self._placeholder_linkage, first, self.linkage, self.lines)
            if count_initial_guesses(self.lines)
            else None
        )
        self._last: tuple[bytes, ContinuedPaths] | None = None

    def _placeholder_linkage(self, data: Sequence[Any]) -> Linkage:
        return placeholder_linkage(self.make, self.first, data, self.linkage.sketch)

    def _trace_stages(self, read: OutputReader, forces: bool, by_variant: bool) -> TraceProgram:
        """Trace the stages of the analysis.

        by_variant: True if each variant has its own driver coordinates.
        """

        count = len(self.first)

        def stages(*data: TracedArray) -> Mapping[str, Any]:
            linkage, q, placeholders = self._placeholder_linkage(data[:count]), data[count], data[count + 1 :]
            kernels = tuple(kernel.rebind(linkage) for kernel in self.lines)
            kernels = with_initial_guesses(kernels, placeholders, VARIANT_NEWTON_STEPS)
            structure = self.structure.rebind(linkage)
            return solve_stages(linkage, structure, kernels, q, read, forces, None, blank=False, start=self.start)

        whole = trace_function(stages, *[1] * count, 3 if by_variant else 2, *[3] * count_initial_guesses(self.lines))
        return whole.only(*(name for name in whole.outputs if name not in CHECK_OUTPUTS), ANGLES_AGREE)

    def _ends(self, *columns: TracedArray) -> Mapping[str, Any]:
        """Compute the data of each variant that are not part of its linkage.

        They are the ends of the driver range, the driver coordinates at which a synthesis requires certain values, and
        these values.
        """
        varied = self.make([TracedNumber(x, c) for x, c in zip(self.first, columns, strict=True)])
        return {
            str(k): place.placeholder if isinstance(place, TracedNumber) else place
            for k, place in enumerate(_extra_numbers(varied))
        }

    def driver_range(self, columns: Real) -> DriverRanges:
        """Return the driver ranges of variants: one cycle of a rotating driver, or the range in which the driver
        moves.
        """
        if self.ends is None:
            return DriverRanges.of(self.variant, len(columns), self.turns, self.start)
        computed = self.ends(*split_columns(columns))
        first = 0 if self.variant.ends is None else 2
        last = first + len(self.variant.asked)
        numbers = [computed[str(k)] for k in range(last + len(self.variant.wanted))]
        variant = replace(self.variant, asked=tuple(numbers[first:last]), wanted=tuple(numbers[last:]))
        variant = replace(variant, ends=(numbers[0], numbers[1])) if first else variant
        return DriverRanges.of(variant, len(columns), self.turns, self.start)

    def without(self, fragment: str) -> TracedVariants:
        """Return the variants without the results whose names contain `fragment`."""
        new = copy(self)
        new.program = self.program.only(*(name for name in self.program.outputs if fragment not in name))
        return new

    def sketch(self, numbers: Real) -> Sketch:
        """Compute the points and angles of one variant at the position of the sketch."""
        linkage = self.make([float(number) for number in numbers]).linkage
        kernels: Sequence[GroupSolver] = [kernel.rebind(linkage) for kernel in self.lines]
        if self.continuation is not None:
            kernels = with_initial_guesses(
                kernels, list(self.continuation.continue_at_sketch(np.array([numbers]))[0]), VARIANT_NEWTON_STEPS
            )
        return compute_sketch(linkage, kernels)

    def __call__(self, columns: Real, samples: DriverSamples) -> Mapping[str, Real]:
        ranges = self.driver_range(columns[:1] if self.ends is None else columns)
        q = ranges.at(samples)[0] if self.ends is None else ranges.at(samples)
        replayed = self.program(
            *split_columns(columns), q, *(self._continued_paths(columns, ranges)(q) if self.continuation else ())
        )
        outputs: Mapping[str, Real] = replayed.without(ANGLES_AGREE)
        if not np.all(replayed[ANGLES_AGREE]):  # accumulated angles of gears differ from those of the first linkage
            outputs = {name: np.where(replayed[ANGLES_AGREE], value, np.nan) for name, value in outputs.items()}
        return {**outputs, WANTED: ranges.wanted_at(samples)} if self.variant.wanted else outputs

    def _continued_paths(self, columns: Real, ranges: DriverRanges) -> ContinuedPaths:
        """Continue the variants over their driver ranges; the paths of the last call are cached."""
        assert self.continuation is not None
        key = columns.tobytes()
        if self._last is None or self._last[0] != key:
            low = ranges.low + np.zeros((len(columns), 1))
            turns = float(np.max(ranges.span)) / (2 * np.pi) if self.linkage.driver.kind == "turn" else 1.0
            count = int(np.ceil(STEPS_PER_TURN * max(turns, LEAST_TURNS)))
            self._last = key, self.continuation(columns, low, low + ranges.span, count, closed=ranges.closed)
        return self._last[1]


def _traceable_groups(linkage: Linkage, kernels: tuple[GroupSolver, ...]) -> tuple[GroupSolver, ...]:
    """Return the group solvers in a form that can be traced for many variants.

    Raises:
        NotTraceableError: there is no such form.
    """
    lines = traceable_groups(linkage, kernels)
    if lines is None:
        raise NotTraceableError
    for kernel in lines:
        trace = kernel.followed
        if trace is not None and trace.dead.size:  # beyond a dead position the determinant has the other sign
            raise NotTraceableError
    return lines


def _extra_numbers(variant: Variant) -> tuple[Any, ...]:
    """Return the numbers of a variant that are not part of its linkage.

    They are the ends of the driver range, the driver coordinates at which a synthesis requires certain values, and
    these values.
    """
    return (*(variant.ends or ()), *variant.asked, *variant.wanted)


# Variants one after another, for linkages that cannot be traced.


MOST_KEPT = 30  # variants kept as initial guesses


class SequentialVariants:
    """Variants solved one after another, with the same interface as TracedVariants.

    The motion of all variants is assumed to repeat after the same number of revolutions as that of the first.
    Groups solved by iteration start from the most similar variant solved before. Results are nan for a variant
    that cannot be assembled as in the sketch, or cannot move.

    Raises:
        LinkageError: the first linkage cannot be assembled.
    """

    def __init__(self, make: Make, first: Sequence[float], read: OutputReader, *, forces: bool = False) -> None:
        self.make, self.wanted, self.forces = make, read, forces
        self.variant = make(first)
        self.linkage = self.variant.linkage
        self.structure = analyse_mobile_structure(self.linkage)
        self.kernels = assemble(self.linkage, self.structure)
        self.turns = cycle_turns(self.linkage, self.kernels) or 1
        self.by_strokes = forces and self.linkage.by_strokes
        self.known: dict[tuple[float, ...], tuple[Variant, Mechanism]] = {}
        self.names = tuple(self._solve_one(tuple(first), DriverSamples(np.zeros(1), np.zeros(0))))

    def driver_range(self, columns: Real) -> DriverRanges:
        """Return the driver range of the first linkage, once for each variant."""
        return DriverRanges.of(self.variant, len(columns), self.turns)

    def without(self, fragment: str) -> SequentialVariants:
        """Return self: leaving out results saves little time if variants are solved one after another."""
        return self

    def sketch(self, numbers: Real) -> Sketch:
        """Compute the points and angles of one variant at the position of the sketch.

        Raises:
            LinkageError: the variant cannot be assembled.
        """
        linkage = self.make([float(number) for number in numbers]).linkage
        return compute_sketch(linkage, assemble(linkage, self.structure.rebind(linkage)))

    def __call__(self, columns: Real, samples: DriverSamples) -> dict[str, Real]:
        rows = []
        for row in columns:
            try:
                rows.append(self._solve_one(tuple(row.tolist()), samples))
            except LinkageError:
                rows.append({})
        missing = np.full(self.driver_range(columns[:1]).at(samples).shape[1], np.nan)
        return {name: np.stack([row.get(name, missing) for row in rows]) for name in self.names}

    def _cached_variant(self, numbers: tuple[float, ...]) -> tuple[Variant, Mechanism]:
        """Build a variant, or take it from the cache."""
        if numbers not in self.known:
            if len(self.known) > MOST_KEPT:
                self.known.clear()
            variant = self.make(list(numbers))
            structure = self.structure.rebind(variant.linkage)
            kernels = assemble(variant.linkage, structure, like=self._nearest_kernels(numbers))
            mechanism = Mechanism(Inputs(variant.linkage), structure).with_known(kernels=kernels)
            self.known[numbers] = variant, mechanism
        return self.known[numbers]

    def _nearest_kernels(self, numbers: tuple[float, ...]) -> tuple[GroupSolver, ...]:
        """Return the group solvers of the cached variant with the smallest relative differences in its numbers."""
        if not self.known:
            return self.kernels
        point, solved = np.array(numbers), np.array(list(self.known))
        apart = np.sum(np.abs(solved - point) / (np.abs(solved) + np.abs(point) + 1e-300), axis=1)
        return list(self.known.values())[int(np.argmin(apart))][1].kernels

    def _solve_one(self, numbers: tuple[float, ...], samples: DriverSamples) -> dict[str, Real]:
        variant, mechanism = self._cached_variant(numbers)
        linkage = variant.linkage
        strokes = mechanism.strokes if self.by_strokes and mechanism.driver_range.full else None
        start = None
        if variant.accelerated:
            begins = mechanism.strokes if isinstance(variant.request.start, str) else None
            start = float(places_of(variant.request, mechanism.driver_range, begins, linkage.driver.sense)[0])
        ranges = DriverRanges.of(variant, 1, self.turns, start)
        q = ranges.at(samples)[0]
        with np.errstate(all="ignore"):
            outputs = solve_stages(
                linkage,
                mechanism.structure,
                mechanism.kernels,
                q,
                self.wanted,
                self.forces,
                strokes,
                blank=True,
                start=start,
            )
        if variant.wanted:
            outputs = {**outputs, WANTED: ranges.wanted_at(samples)[0]}
        return {name: np.broadcast_to(value, q.shape) for name, value in outputs.items()}


def make_variants(
    make: Make, first: Sequence[float], read: OutputReader, *, forces: bool, one_sense: bool
) -> TracedVariants | SequentialVariants:
    """Return variants that are solved by traced operations if possible, else one after another.

    Args:
        make: function that builds a variant from its numbers.
        first: numbers of the first variant.
        read: function that reads the requested results.
        forces: True if the results need reactions.
        one_sense: True if the drivers of all variants rotate in the same sense. Otherwise operations cannot be traced.

    Raises:
        LinkageError: the first linkage cannot be assembled.
    """
    if one_sense:
        try:
            return TracedVariants(make, first, read, forces=forces)
        except (NotTraceableError, DependsOnData):
            pass
    return SequentialVariants(make, first, read, forces=forces)
