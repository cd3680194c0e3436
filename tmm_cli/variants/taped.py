"""Variants of a linkage by its tape: the fastest way, for groups in closed form and loads that ask for no strokes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import replace
from typing import Any, Self

from tmm_cli.assembly import assemble
from tmm_cli.batch import Asked
from tmm_cli.family import Iterated, family
from tmm_cli.linkage import Sketch
from tmm_cli.mobile import mobile
from tmm_cli.tape import Stand, record
from tmm_cli.tape.varied import Varied
from tmm_cli.variants.sketch import sketch_of
from tmm_cli.variants.start import start_of
from tmm_cli.variants.way import Make, Places, Way
from tmm_cli.vectors import Real

UNUSED = ("placed", "moving", "margin")


class Taped:
    """Called with numbers (variants, n) and places; gives what is asked, (variants, places), by name.

    Raises Iterated or DependsOnData where there is no tape, and what assembly raises.
    """

    def __init__(self, make: Make, first: Sequence[float], asked: Asked, *, forces: bool = False) -> None:
        self.make, self.first, self.variant = make, first, make(first)
        self.ordinary = self.variant.linkage
        by_stroke = any(x.working_stroke_only or x.table is not None for x in self.ordinary.loads)
        if self.ordinary.others or (forces and by_stroke):
            raise Iterated
        varied = make([Varied(x, x) for x in first])
        start = start_of(varied) if forces else None  # nothing else hangs on where its law begins
        if isinstance(start, Varied):
            raise Iterated
        self.start = start
        self.last: tuple[Places | None, Any] = (None, None)
        own = any(isinstance(end, Varied) for end in varied.ends or ())
        self.ends = record(self._ends, *[1] * len(first)) if own else None
        program = family(
            lambda numbers: make(numbers).linkage, first, asked, forces=forces, start=start, own_places=own
        )
        self.kernels = assemble(self.ordinary, mobile(self.ordinary))
        self.program = program.only(*(name for name in program.outputs if name not in UNUSED))

    def _ends(self, *columns: Stand) -> Mapping[str, Any]:
        """Where the driver's way begins and ends in each variant, as its numbers say."""
        ends = self.make([Varied(x, c) for x, c in zip(self.first, columns, strict=True)]).ends or ()
        return {
            name: end.stand if isinstance(end, Varied) else end for name, end in zip(("low", "high"), ends, strict=True)
        }

    @property
    def operations(self) -> int:
        """Operations on arrays, for all variants and places."""
        return self.program.operations

    def way(self, columns: Real) -> Way:
        """The crank's turn, or the way of the driver."""
        if self.ends is None:
            return Way.of(self.variant, len(columns), 1, self.start)
        found = self.ends(*(columns[:, k : k + 1] for k in range(columns.shape[1])))
        return Way.of(replace(self.variant, ends=(found["low"], found["high"])), len(columns), 1, self.start)

    def without(self, part: str) -> Taped:
        """Without results whose names have such a part."""
        new = copy(self)
        new.program = self.program.only(*(name for name in self.program.outputs if part not in name))
        return new

    def sketch(self, numbers: Real) -> Sketch:
        """How one variant looks at the place of the sketch."""
        linkage = self.make([float(number) for number in numbers]).linkage
        return sketch_of(linkage, [kernel.again(linkage) for kernel in self.kernels])

    def about(self, numbers: Real) -> Self:
        """For variants near one: no other than for all."""
        return self

    def __call__(self, columns: Real, places: Places) -> Mapping[str, Real]:
        if self.ends is None and places is self.last[0]:  # a search asks for the same places over and over
            q: Any = self.last[1]
        else:
            q = self.way(columns[:1]).at(places)[0] if self.ends is None else self.way(columns).at(places)
            self.last = (places, q)
        return self.program(*(columns[:, k : k + 1] for k in range(columns.shape[1])), q)
