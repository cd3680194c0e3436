"""A function that a linkage is to generate: turned into angles, and its precision points."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from tmm_cli.double_double import PI

FUNCTIONS: Final[Mapping[str, Callable[[Any], Any]]] = {
    "log10(x)": np.log10, "ln(x)": np.log, "exp(x)": np.exp, "sqrt(x)": np.sqrt, "1/x": np.reciprocal,
    "x^2": np.square, "x^3": lambda x: x * x * x, "x^1.5": lambda x: x * np.sqrt(x),
    "sin(x)": np.sin, "cos(x)": np.cos, "tan(x)": np.tan,
}  # fmt: skip
ANGLES: Final = ("sin(x)", "cos(x)", "tan(x)")  # their x is an angle


@dataclass(frozen=True)
class Function:
    """y(x), straight between the rows of its table, from x[0] to x[1]; input, output: angles (rad) at these ends."""

    x: tuple[float, float]
    phi: tuple[float, float]
    psi: tuple[float, float]
    name: str = ""
    table: tuple[tuple[float, float], ...] = ()

    def value(self, x: Any) -> Any:
        if self.name:
            return FUNCTIONS[self.name](x)
        rows = np.asarray(self.table, dtype=float)
        return np.interp(np.asarray(x, dtype=float), rows[:, 0], rows[:, 1])

    def wanted(self, phi: Any) -> Any:
        """The output angle for an input angle."""
        start, end = self.value(np.asarray(self.x[0])), self.value(np.asarray(self.x[1]))
        x = self.x[0] + (phi - self.phi[0]) / (self.phi[1] - self.phi[0]) * (self.x[1] - self.x[0])
        return self.psi[0] + (self.value(x) - start) / (end - start) * (self.psi[1] - self.psi[0])

    def corners(self) -> Any:
        """Input angles of the rows of the table within the range; there it may have corners."""
        x = np.asarray([row[0] for row in self.table], dtype=float)
        share = (x - float(self.x[0])) / (float(self.x[1]) - float(self.x[0]))
        share = share[(share > 0) & (share < 1)]
        return float(self.phi[0]) + share * (float(self.phi[1]) - float(self.phi[0]))

    def precision(self, count: int) -> tuple[Any, Any]:
        """Angles at the precision points: Chebyshev's spacing, x = middle - half range cos((2j - 1) pi/(2 n))."""
        turns = np.arange(1, 2 * count, 2) / np.longdouble(2 * count)
        share = ((1 - np.cos(turns * np.longdouble(PI))) / 2).astype(float)
        phi = self.phi[0] + share * (self.phi[1] - self.phi[0])
        return phi, self.wanted(phi)
