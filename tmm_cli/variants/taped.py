"""Variants of a linkage by its tape: for groups in closed form and loads that ask for no strokes.

Unlike a Batch, whose program is for the linkages that it was made of, this one takes numbers anew at every call; which
assembly the groups have is that of the first linkage.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import replace
from typing import Any

from tmm_cli.assembly.choose import assemble
from tmm_cli.assembly.solvable import mobile
from tmm_cli.groups.base import Closed
from tmm_cli.linkage import Sketch
from tmm_cli.tape import Program, TracedArray, record
from tmm_cli.tape.traced_number import TracedNumber
from tmm_cli.variants.batch import CHECKS, SURE, Wanted, solved
from tmm_cli.variants.stack import changed, numbers
from tmm_cli.variants.variant import WANTED, DriverRanges, Make, NoTapeError, Places, Variant, sketch_of
from tmm_cli.vectors import Real


class Taped:
    """Called with numbers (variants, n) and places; gives the outputs, (variants, places), by name.

    Raises NoTapeError or DependsOnData where there is no tape, and what assembly raises.
    """

    def __init__(self, make: Make, first: Sequence[float], wanted: Wanted, *, forces: bool = False) -> None:
        """make: a variant for given numbers; first: those of the linkage whose assembly all have."""
        self.make, self.first, self.variant = make, first, make(first)
        self.linkage = self.variant.linkage
        self.structure = mobile(self.linkage)
        self.kernels = assemble(self.linkage, self.structure)
        by_stroke = any(x.working_stroke_only or x.table is not None for x in self.linkage.loads)
        if self.linkage.others or self.linkage.friction or (forces and by_stroke):
            raise NoTapeError
        if not all(isinstance(kernel, Closed) and kernel.plain for kernel in self.kernels):
            raise NoTapeError
        varied = make([TracedNumber(x, x) for x in first])
        self.start = varied.start if forces else None  # nothing else hangs on where its law begins
        if isinstance(self.start, TracedNumber):
            raise NoTapeError
        own = any(isinstance(number, TracedNumber) for number in _ends(varied))
        self.ends = record(self._ends, *[1] * len(first)) if own else None
        self.program = self._program(wanted, forces, own)

    def _program(self, wanted: Wanted, forces: bool, own: bool) -> Program:
        """Of the varying numbers, each (variants, 1), and the driver's places; own: each variant has its own."""

        def stages(*data: TracedArray) -> Mapping[str, Any]:
            varied = self.make([TracedNumber(x, stand) for x, stand in zip(self.first, data[:-1], strict=True)]).linkage
            stands = {path: number.stand for path, number in numbers(varied) if isinstance(number, TracedNumber)}
            linkage = replace(changed(varied, stands), sketch=self.linkage.sketch)
            kernels = tuple(kernel.rebind(linkage) for kernel in self.kernels)
            structure = self.structure.rebind(linkage)
            return solved(linkage, structure, kernels, data[-1], wanted, forces, None, blank=False, start=self.start)

        whole = record(stages, *[1] * len(self.first), 3 if own else 2)
        return whole.only(*(name for name in whole.outputs if name not in (*CHECKS, SURE)))

    def _ends(self, *columns: TracedArray) -> Mapping[str, Any]:
        """Ends of the driver's range, the places asked about and what is wanted there, of each variant."""
        varied = self.make([TracedNumber(x, c) for x, c in zip(self.first, columns, strict=True)])
        return {
            str(k): place.stand if isinstance(place, TracedNumber) else place for k, place in enumerate(_ends(varied))
        }

    def driver_range(self, columns: Real) -> DriverRanges:
        """The crank's turn, or the range of the driver."""
        if self.ends is None:
            return DriverRanges.of(self.variant, len(columns), self.linkage.turns, self.start)
        found = self.ends(*(columns[:, k : k + 1] for k in range(columns.shape[1])))
        first = 0 if self.variant.ends is None else 2
        last = first + len(self.variant.asked)
        numbers = [found[str(k)] for k in range(last + len(self.variant.wanted))]
        variant = replace(self.variant, asked=tuple(numbers[first:last]), wanted=tuple(numbers[last:]))
        variant = replace(variant, ends=(numbers[0], numbers[1])) if first else variant
        return DriverRanges.of(variant, len(columns), self.linkage.turns, self.start)

    def without(self, part: str) -> Taped:
        """Without results whose names have such a part."""
        new = copy(self)
        new.program = self.program.only(*(name for name in self.program.outputs if part not in name))
        return new

    def sketch(self, numbers: Real) -> Sketch:
        """How one variant looks at the place of the sketch."""
        linkage = self.make([float(number) for number in numbers]).linkage
        return sketch_of(linkage, [kernel.rebind(linkage) for kernel in self.kernels])

    def __call__(self, columns: Real, places: Places) -> Mapping[str, Real]:
        ranges = self.driver_range(columns[:1] if self.ends is None else columns)
        q = ranges.at(places)[0] if self.ends is None else ranges.at(places)
        found = self.program(*(columns[:, k : k + 1] for k in range(columns.shape[1])), q)
        return {**found, WANTED: ranges.wanted_at(places)} if self.variant.wanted else found


def _ends(variant: Variant) -> tuple[Any, ...]:
    """Numbers of a variant beside its linkage."""
    return (*(variant.ends or ()), *variant.asked, *variant.wanted)
