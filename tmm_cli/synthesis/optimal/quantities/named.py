"""Largest value, smallest value and range of any quantity that has a name (e.g. `v of E`, `R_34`), over the driver
range.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import product
from typing import Any, Final

import numpy as np

from tmm_cli.language import _
from tmm_cli.mechanics.analysis import NamedQuantity, SolvedVariants
from tmm_cli.mechanics.forces import Reactions
from tmm_cli.mechanics.kinematics import Motion
from tmm_cli.mechanics.linkage import Linkage
from tmm_cli.mechanics.numerics import Real, highest_peaks, window_peak
from tmm_cli.synthesis.optimal.quantities.base import MOST_PEAKS, PeakQuantity, QuantityRange, Read, Windows


@dataclass(frozen=True)
class LargestNamed(PeakQuantity):
    """Largest value of a named quantity over the driver range; for a vector, the largest magnitude.

    Attributes:
        quantity: the quantity; None only while the keys of a problem file are described, without any file.
    """

    quantity: NamedQuantity | None = None

    of = "largest"
    sign = 1.0

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        assert self.quantity is not None
        values = self.quantity.read(SolvedVariants(motion.linkage, motion, reactions))
        return {"y": self.sign * (np.abs(values) if self.quantity.vector else values)}

    def kind(self, linkage: Linkage, groups: Any) -> str:
        assert self.quantity is not None
        return self.quantity.dimension.name or "number"

    def title(self, linkage: Linkage) -> str:
        return _("largest {quantity} over the cycle").format(quantity=self.name)


class LeastNamed(LargestNamed):
    """Smallest value of a named quantity over the driver range; for a vector, the smallest magnitude."""

    of, lowest, sign = "least", True, -1.0

    def title(self, linkage: Linkage) -> str:
        return _("smallest {quantity} over the cycle").format(quantity=self.name)


class RangeNamed(LargestNamed):
    """Range (largest minus smallest value) of a named quantity over the driver range."""

    of = "range"
    curves = ("y", "low")

    def outputs(self, motion: Motion, reactions: Reactions | None) -> Mapping[str, Any]:
        values = super().outputs(motion, reactions)["y"]
        return {"y": values, "low": -values}

    def windows(self, read: Read, over: QuantityRange) -> list[tuple[Any, int]]:
        return [(name, k) for name in self.curves for k in highest_peaks(read(name)[0], MOST_PEAKS, over.closed)]

    def fine(self, parts: Windows, exact: Read, over: QuantityRange, step: float) -> Real:
        """Return the differences of every maximum and every minimum of the quantity; the largest one is the range."""
        rough = over.rough and self.forces
        tops: dict[str, list[Real]] = {name: [] for name in self.curves}
        for name, __, read in parts:
            y = read(name)
            tops[name].append(np.max(y, axis=1) if rough else window_peak(y))
        return np.stack([np.sum(peaks, axis=0) for peaks in product(*tops.values())], axis=1)

    def title(self, linkage: Linkage) -> str:
        return _("range of {quantity} over the cycle").format(quantity=self.name)


class LargestNamedForce(LargestNamed):
    """Largest value of a named quantity that is computed from the forces, e.g. a reaction."""

    forces = True


class LeastNamedForce(LeastNamed):
    """Smallest value of a named quantity that is computed from the forces, e.g. a reaction."""

    forces = True


class RangeNamedForce(RangeNamed):
    """Range of a named quantity that is computed from the forces, e.g. a reaction."""

    forces = True


NAMED: Final[Mapping[tuple[str, bool], type[LargestNamed]]] = {
    (kind.of, kind.forces): kind
    for kind in (LargestNamed, LeastNamed, RangeNamed, LargestNamedForce, LeastNamedForce, RangeNamedForce)
}
"""Classes by what is taken of the quantity (largest, least, range), and True if it requires the force plan."""
