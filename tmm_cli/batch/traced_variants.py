"""Variants solved by a trace whose numbers are given anew at every call; or one after another.

All variants have the assembly of the first linkage. Loads must not depend on strokes for a trace. Solved
one after another, each variant takes a hundred to a thousand times as long as by a trace.
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
    NoTapeError,
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
    """Variants by a trace: called with numbers (variants, n) and samples of the driver; outputs are (variants,
    samples).

    Raises NoTapeError or DependsOnData if there is no trace, and the errors of assembly.
    """

    def __init__(self, make: Make, first: Sequence[float], read: OutputReader, *, forces: bool = False) -> None:
        """Trace the variants. make: builds a variant from numbers; first: numbers of the linkage whose assembly all
        have.
        """
        self.make, self.first, self.variant = make, first, make(first)
        self.linkage = self.variant.linkage
        self.structure = analyse_mobile_structure(self.linkage)
        self.kernels = assemble(self.linkage, self.structure)
        if self.linkage.friction or (forces and self.linkage.by_strokes):
            raise NoTapeError
        self.lines = _traceable_groups(self.linkage, self.kernels)
        self.turns = cycle_turns(self.linkage, self.kernels) or 1
        varied = make([TracedNumber(x, x) for x in first])
        self.start = varied.start if forces else None  # only forces depend on where its law begins
        # several drivers pass through the sketched coordinates together: a trace holds those of the first linkage
        apart = bool(self.linkage.others) and isinstance(varied.linkage.sketch.at, TracedNumber)
        if apart or isinstance(self.start, TracedNumber):
            raise NoTapeError
        by_variant = any(isinstance(number, TracedNumber) for number in _extra_numbers(varied))
        self.ends = trace_function(self._ends, *[1] * len(first)) if by_variant else None
        self.program = self._program(read, forces, by_variant)
        self.continuation = (
            Continuation(self._varied, first, self.linkage, self.lines) if count_initial_guesses(self.lines) else None
        )
        self._last: tuple[bytes, ContinuedPaths] | None = None

    def _varied(self, data: Sequence[Any]) -> Linkage:
        return placeholder_linkage(self.make, self.first, data, self.linkage.sketch)

    def _program(self, read: OutputReader, forces: bool, by_variant: bool) -> TraceProgram:
        """Trace the stages. by_variant: each variant has its own driver coordinates."""

        many = len(self.first)

        def stages(*data: TracedArray) -> Mapping[str, Any]:
            linkage, q, placeholders = self._varied(data[:many]), data[many], data[many + 1 :]
            kernels = tuple(kernel.rebind(linkage) for kernel in self.lines)
            kernels = with_initial_guesses(kernels, placeholders, VARIANT_NEWTON_STEPS)
            structure = self.structure.rebind(linkage)
            return solve_stages(linkage, structure, kernels, q, read, forces, None, blank=False, start=self.start)

        whole = trace_function(stages, *[1] * many, 3 if by_variant else 2, *[3] * count_initial_guesses(self.lines))
        return whole.only(*(name for name in whole.outputs if name not in CHECK_OUTPUTS), ANGLES_AGREE)

    def _ends(self, *columns: TracedArray) -> Mapping[str, Any]:
        """Ends of the driver's range, queried coordinates and values requested there, for each variant."""
        varied = self.make([TracedNumber(x, c) for x, c in zip(self.first, columns, strict=True)])
        return {
            str(k): place.stand if isinstance(place, TracedNumber) else place
            for k, place in enumerate(_extra_numbers(varied))
        }

    def driver_range(self, columns: Real) -> DriverRanges:
        """Return the driver ranges of variants: a revolution of the crank, or the range of the driver."""
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
        """Return the variants without results whose names contain `fragment`."""
        new = copy(self)
        new.program = self.program.only(*(name for name in self.program.outputs if fragment not in name))
        return new

    def sketch(self, numbers: Real) -> Sketch:
        """Return the sketch of one variant at the sketched position."""
        linkage = self.make([float(number) for number in numbers]).linkage
        kernels: Sequence[GroupSolver] = [kernel.rebind(linkage) for kernel in self.lines]
        if self.continuation is not None:
            kernels = with_initial_guesses(
                kernels, list(self.continuation.sketched(np.array([numbers]))[0]), VARIANT_NEWTON_STEPS
            )
        return compute_sketch(linkage, kernels)

    def __call__(self, columns: Real, samples: DriverSamples) -> Mapping[str, Real]:
        ranges = self.driver_range(columns[:1] if self.ends is None else columns)
        q = ranges.at(samples)[0] if self.ends is None else ranges.at(samples)
        replayed = self.program(
            *split_columns(columns), q, *(self._ways(columns, ranges)(q) if self.continuation else ())
        )
        outputs: Mapping[str, Real] = replayed.without(ANGLES_AGREE)
        if not np.all(replayed[ANGLES_AGREE]):  # accumulated angles of gears differ from those of the first linkage
            outputs = {name: np.where(replayed[ANGLES_AGREE], value, np.nan) for name, value in outputs.items()}
        return {**outputs, WANTED: ranges.wanted_at(samples)} if self.variant.wanted else outputs

    def _ways(self, columns: Real, ranges: DriverRanges) -> ContinuedPaths:
        """Paths of variants over their ranges; those of the last call are kept."""
        assert self.continuation is not None
        key = columns.tobytes()
        if self._last is None or self._last[0] != key:
            low = ranges.low + np.zeros((len(columns), 1))
            turns = float(np.max(ranges.span)) / (2 * np.pi) if self.linkage.driver.kind == "turn" else 1.0
            count = int(np.ceil(STEPS_PER_TURN * max(turns, LEAST_TURNS)))
            self._last = key, self.continuation(columns, low, low + ranges.span, count, closed=ranges.closed)
        return self._last[1]


def _traceable_groups(linkage: Linkage, kernels: tuple[GroupSolver, ...]) -> tuple[GroupSolver, ...]:
    """Groups in a form that a trace of variants can hold. Raises NoTapeError."""
    lines = traceable_groups(linkage, kernels)
    if lines is None:
        raise NoTapeError
    for kernel in lines:
        trace = kernel.followed
        if trace is not None and trace.dead.size:  # on the other side of it the determinant has another sign
            raise NoTapeError
    return lines


def _extra_numbers(variant: Variant) -> tuple[Any, ...]:
    """Numbers of a variant besides its linkage."""
    return (*(variant.ends or ()), *variant.asked, *variant.wanted)


# Variants of a linkage one after another, each as a separate file: for linkages that cannot be traced.
#
# Groups solved by iteration are continued from the nearest known variant, or else solved anew: this takes a hundred or
# a thousand times as long as a trace.


MOST_KEPT = 30  # variants kept as initial guesses


class SequentialVariants:
    """Variants solved one after another: called with numbers (variants, n) and samples of the driver.

    The motion of all repeats after as many revolutions as that of the first one. Groups solved by iteration
    start from the nearest known variant. A variant that cannot be assembled as sketched, or cannot move, has
    nan outputs. Raises the errors of assembly of the first linkage.
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
        self.names = tuple(self._one(tuple(first), DriverSamples(np.zeros(1), np.zeros(0))))

    def driver_range(self, columns: Real) -> DriverRanges:
        """Return the driver range of the first linkage for each variant."""
        return DriverRanges.of(self.variant, len(columns), self.turns)

    def without(self, fragment: str) -> SequentialVariants:
        """Return self, because results that are not used cost little here."""
        return self

    def sketch(self, numbers: Real) -> Sketch:
        """Return the sketch of one variant at the sketched position. Raises the errors of assembly."""
        linkage = self.make([float(number) for number in numbers]).linkage
        return compute_sketch(linkage, assemble(linkage, self.structure.rebind(linkage)))

    def __call__(self, columns: Real, samples: DriverSamples) -> dict[str, Real]:
        rows = []
        for row in columns:
            try:
                rows.append(self._one(tuple(row.tolist()), samples))
            except LinkageError:
                rows.append({})
        lost = np.full(self.driver_range(columns[:1]).at(samples).shape[1], np.nan)
        return {name: np.stack([row.get(name, lost) for row in rows]) for name in self.names}

    def _moved(self, numbers: tuple[float, ...]) -> tuple[Variant, Mechanism]:
        """Build a variant, or return it from the cache."""
        if numbers not in self.known:
            if len(self.known) > MOST_KEPT:
                self.known.clear()
            variant = self.make(list(numbers))
            structure = self.structure.rebind(variant.linkage)
            kernels = assemble(variant.linkage, structure, like=self._nearest(numbers))
            mechanism = Mechanism(Inputs(variant.linkage), structure).known(kernels=kernels)
            self.known[numbers] = variant, mechanism
        return self.known[numbers]

    def _nearest(self, numbers: tuple[float, ...]) -> tuple[GroupSolver, ...]:
        """Groups of the known variant whose numbers have the least relative differences."""
        if not self.known:
            return self.kernels
        point, solved = np.array(numbers), np.array(list(self.known))
        apart = np.sum(np.abs(solved - point) / (np.abs(solved) + np.abs(point) + 1e-300), axis=1)
        return list(self.known.values())[int(np.argmin(apart))][1].kernels

    def _one(self, numbers: tuple[float, ...], samples: DriverSamples) -> dict[str, Real]:
        variant, mechanism = self._moved(numbers)
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
    """Return variants solved by a trace if possible, else one after another.

    Args:
        make: builds a variant from numbers.
        first: numbers of the first variant.
        read: reads the requested results.
        forces: the results need reactions.
        one_sense: all drivers rotate in the same sense, without which there is no trace.

    Raises the errors of assembly of the first linkage.
    """
    if one_sense:
        try:
            return TracedVariants(make, first, read, forces=forces)
        except (NoTapeError, DependsOnData):
            pass
    return SequentialVariants(make, first, read, forces=forces)
