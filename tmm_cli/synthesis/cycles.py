"""After how many turns of the crank candidates of an optimal synthesis come round again, each after its own.

Toothed wheels and further drivers come round together only where their ratios are those of whole numbers: parameters on
which that hangs have some values only.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from tmm_cli.groups.base import Kernel
from tmm_cli.linkage import Linkage
from tmm_cli.quality import cycle_of
from tmm_cli.synthesis.optimal_asked import Asked
from tmm_cli.synthesis.record import Infeasible
from tmm_cli.vectors import Real

W = "synthesis_optimal"
SAME = 1e-12  # relative: ratios that differ by less
SHARES = (0.0, 0.137, 0.382, 0.618, 0.871, 1.0)  # of the range: where a parameter is looked at
MOST = 2000  # choices that are looked through for one that comes round again


class Cycles:
    """first: numbers of a linkage that can be assembled; kernels: its groups. Raises Infeasible.

    varies: whether candidates differ in it.
    """

    def __init__(self, asked: Asked, first: Sequence[float], kernels: tuple[Kernel, ...]) -> None:
        self.asked, self.first, self.kernels = asked, list(first), kernels
        self.known: dict[tuple[float, ...], int] = {}
        self.tells = [k for k in range(len(self.first)) if self._tells(k)]
        self.varies = bool(self.tells)
        choices = [asked.values[name] for k, name in enumerate(asked.low) if k in self.tells]
        few = self.varies and np.prod([float(len(own)) for own in choices]) <= MOST
        if few and not any(self._turns(chosen) for chosen in product(*choices)):
            raise Infeasible(("vary", list(asked.low)[self.tells[0]]), f"{W}.no_return", f"{W}.other_ratios")

    def _tells(self, k: int) -> bool:
        """Whether it hangs on a parameter. Raises Infeasible where that may be any number."""
        name = list(self.asked.low)[k]
        low, high = self.asked.low[name], self.asked.high[name]
        some: list[list[float]] = []
        for share in SHARES:
            numbers = list(self.first)
            numbers[k] = low + share * (high - low)
            some.append(self.asked.near(numbers).tolist())
        linkages = [self.asked.make(numbers).linkage for numbers in some if self.asked.accepts(numbers)]
        ratios = [_ratios(linkage) for linkage in linkages]
        if all(np.allclose(own, ratios[0], rtol=SAME, atol=0.0) for own in ratios):
            return False
        turns = {cycle_of(linkage, self.kernels) for linkage in linkages}
        if name in self.asked.values:
            return True
        if len(turns) > 1 or None in turns:
            raise Infeasible(("vary", name), f"{W}.cycle_varies", f"{W}.in_steps")
        return False

    def of(self, numbers: Real) -> list[int]:
        """Turns of each candidate (variants, n); 0 where there are more than anyone counts."""
        return [self._turns(tuple(row)) for row in numbers[:, self.tells].tolist()]

    def _turns(self, chosen: tuple[float, ...]) -> int:
        if chosen not in self.known:
            numbers = list(self.first)
            for k, number in zip(self.tells, chosen, strict=True):
                numbers[k] = number
            sound = self.asked.accepts(numbers)
            self.known[chosen] = (cycle_of(self.asked.make(numbers).linkage, self.kernels) or 0) if sound else 0
        return self.known[chosen]


def _ratios(linkage: Linkage) -> list[float]:
    """Numbers on which it hangs after how many turns of the driver all comes round again."""
    wheels = [float(mesh.ratio) for mesh in linkage.meshes if mesh.kind == "gear"]
    return wheels + [float(other.rate / linkage.driver.rate) for other in linkage.others]
