"""Numbers of a problem file in longdouble, from the decimals as they are written."""

from __future__ import annotations

import numpy as np

from tmm_cli.problem.units import UnitSystem


class ExtendedUnits(UnitSystem):
    """Units whose numbers are longdoubles; functions of arithmetic (sin, sqrt, ...) stay in float64."""

    def number(self, written: str | int | float) -> float:
        super().number(written)  # refuses what float64 has no place for
        value: float = np.longdouble(written if isinstance(written, str) else repr(written))  # type: ignore[assignment]
        return value
