"""Variants of a linkage one after another, each as a file of its own: for whatever no tape can be written of.

Groups that are found by iteration are followed beside those of the variant nearest to it, or else anew: that takes a
hundred or a thousand times as long as by a tape.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tmm_cli.analysis.mechanism import Inputs, Mechanism
from tmm_cli.assembly.choose import assemble
from tmm_cli.assembly.rank import mobile
from tmm_cli.errors import LinkageError
from tmm_cli.groups.base import Kernel
from tmm_cli.kinematics.driver_range import cycle_of
from tmm_cli.kinematics.strokes import places as places_of
from tmm_cli.linkage import Sketch
from tmm_cli.tape import DependsOnData
from tmm_cli.variants.batch import Wanted, solved
from tmm_cli.variants.taped import Taped
from tmm_cli.variants.variant import WANTED, DriverRanges, Make, NoTapeError, Places, Variant, sketch_of
from tmm_cli.vectors import Real

KEPT = 30  # variants


class OneByOne:
    """Called with numbers (variants, n) and places; gives the outputs, (variants, places), by name.

    All come round again after as many turns of the crank as the first one. A variant that cannot be assembled as it is
    sketched, or not be moved, has nothing but nan. Raises what assembly raises, for the first linkage.
    """

    def __init__(self, make: Make, first: Sequence[float], wanted: Wanted, *, forces: bool = False) -> None:
        self.make, self.wanted, self.forces = make, wanted, forces
        self.variant = make(first)
        self.linkage = self.variant.linkage
        self.structure = mobile(self.linkage)
        self.kernels = assemble(self.linkage, self.structure)
        self.turns = cycle_of(self.linkage, self.kernels) or 1
        self.by_strokes = forces and self.linkage.by_strokes
        self.known: dict[tuple[float, ...], tuple[Variant, Mechanism]] = {}
        self.names = tuple(self._one(tuple(first), Places(np.zeros(1), np.zeros(0))))

    def driver_range(self, columns: Real) -> DriverRanges:
        """That of the first linkage, for each."""
        return DriverRanges.of(self.variant, len(columns), self.turns)

    def without(self, part: str) -> OneByOne:
        """The same: what is not wanted costs little here."""
        return self

    def sketch(self, numbers: Real) -> Sketch:
        """How one variant looks at the place of the sketch. Raises what assembly raises."""
        linkage = self.make([float(number) for number in numbers]).linkage
        return sketch_of(linkage, assemble(linkage, self.structure.rebind(linkage)))

    def __call__(self, columns: Real, places: Places) -> dict[str, Real]:
        rows = []
        for row in columns:
            try:
                rows.append(self._one(tuple(row.tolist()), places))
            except LinkageError:
                rows.append({})
        lost = np.full(self.driver_range(columns[:1]).at(places).shape[1], np.nan)
        return {name: np.stack([row.get(name, lost) for row in rows]) for name in self.names}

    def _moved(self, numbers: tuple[float, ...]) -> tuple[Variant, Mechanism]:
        """A variant, which is moved once though it is looked at at several places in turn."""
        if numbers not in self.known:
            if len(self.known) > KEPT:
                self.known.clear()
            variant = self.make(list(numbers))
            structure = self.structure.rebind(variant.linkage)
            kernels = assemble(variant.linkage, structure, like=self._nearest(numbers))
            mechanism = Mechanism(Inputs(variant.linkage), structure).known(kernels=kernels)
            self.known[numbers] = variant, mechanism
        return self.known[numbers]

    def _nearest(self, numbers: tuple[float, ...]) -> tuple[Kernel, ...]:
        """The groups of that known variant whose numbers differ least, as shares of their sizes."""
        if not self.known:
            return self.kernels
        here, known = np.array(numbers), np.array(list(self.known))
        apart = np.sum(np.abs(known - here) / (np.abs(known) + np.abs(here) + 1e-300), axis=1)
        return list(self.known.values())[int(np.argmin(apart))][1].kernels

    def _one(self, numbers: tuple[float, ...], places: Places) -> dict[str, Real]:
        variant, mechanism = self._moved(numbers)
        linkage = variant.linkage
        strokes = mechanism.strokes if self.by_strokes and mechanism.driver_range.full else None
        start = None
        if variant.accelerated:
            begins = mechanism.strokes if isinstance(variant.request.start, str) else None
            start = float(places_of(variant.request, mechanism.driver_range, begins, linkage.driver.sense)[0])
        ranges = DriverRanges.of(variant, 1, self.turns, start)
        q = ranges.at(places)[0]
        with np.errstate(all="ignore"):
            found = solved(
                linkage, mechanism.structure, mechanism.kernels, q, self.wanted, self.forces, strokes, blank=True,
                start=start,
            )  # fmt: skip
        if variant.wanted:
            found = {**found, WANTED: ranges.wanted_at(places)[0]}
        return {name: np.broadcast_to(value, q.shape) for name, value in found.items()}


def variants_of(
    make: Make, first: Sequence[float], wanted: Wanted, *, forces: bool, one_sense: bool
) -> Taped | OneByOne:
    """By the tape, else one after another.

    one_sense: all drivers go the same way round, which a tape cannot tell. Raises what assembly raises, for the first
    linkage.
    """
    if one_sense:
        try:
            return Taped(make, first, wanted, forces=forces)
        except (NoTapeError, DependsOnData):
            pass
    return OneByOne(make, first, wanted, forces=forces)
