"""Variants of a linkage one after another, each as a file of its own: for whatever else may vary."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Self

import numpy as np

from tmm_cli.assembly import assemble
from tmm_cli.batch import Asked, solved
from tmm_cli.linkage import Sketch
from tmm_cli.mechanism import Mechanism
from tmm_cli.mobile import mobile
from tmm_cli.refused import Refused
from tmm_cli.strokes import places as places_of
from tmm_cli.variants.sketch import sketch_of
from tmm_cli.variants.way import Make, Places, Way
from tmm_cli.vectors import Real


class Apart:
    """Called with numbers (variants, n) and places; gives what is asked, (variants, places), by name.

    A variant that cannot be assembled as it is sketched, or not be moved, has nothing but nan. Raises what assembly
    raises, for the first linkage.
    """

    def __init__(
        self, make: Make, first: Sequence[float], asked: Asked, *, forces: bool = False, turns: int = 0
    ) -> None:  # fmt: skip
        """turns: after which all that are ever asked for come round again; 0: after as many as the first one."""
        self.turns = turns
        self.make, self.first, self.asked, self.forces = make, np.array(first), asked, forces
        self.variant = make(first)
        self.ordinary = self.variant.linkage
        self.structure = mobile(self.ordinary)
        self.kernels = assemble(self.ordinary, self.structure)
        self.names = tuple(self._one(self.first, Places(np.zeros(1), np.zeros(0))))

    def way(self, columns: Real) -> Way:
        """The drivers' ways, as far as they can go round."""
        turns = self.turns or Mechanism(self.ordinary, self.structure).way.turns
        return Way.of(self.variant, len(columns), turns)

    def without(self, part: str) -> Self:
        """The same: what is not wanted costs little here."""
        return self

    def sketch(self, numbers: Real) -> Sketch:
        """How one variant looks at the place of the sketch. Raises what assembly raises."""
        linkage = self.make([float(number) for number in numbers]).linkage
        return sketch_of(linkage, assemble(linkage, self.structure.again(linkage)))

    def about(self, numbers: Real) -> Self:
        """For variants near one: no other than for all."""
        return self

    def __call__(self, columns: Real, places: Places) -> dict[str, Real]:
        rows = []
        for row in columns:
            try:
                rows.append(self._one(row, places))
            except Refused:
                rows.append({})
        lost = np.full(places.count, np.nan)
        return {name: np.stack([row.get(name, lost) for row in rows]) for name in self.names}

    def _one(self, numbers: Real, places: Places) -> dict[str, Real]:
        variant = self.make([float(x) for x in numbers])
        linkage = variant.linkage
        mechanism = Mechanism(linkage, self.structure.again(linkage))
        kernels, way = mechanism.kernels, mechanism.way
        strokes, start = mechanism.strokes if way.full and self.forces else None, None
        if variant.accelerated:
            begins = mechanism.strokes if variant.begins else None
            start = float(places_of(variant.request, way, begins, linkage.driver.sense)[0])
        q = Way.of(variant, 1, way.turns, start).at(places)[0]
        with np.errstate(all="ignore"):
            found = solved(
                linkage, mechanism.structure, kernels, q, self.asked, self.forces, strokes, blank=True,
                start=start,
            )  # fmt: skip
        return {name: np.broadcast_to(value, q.shape) for name, value in found.items()}
