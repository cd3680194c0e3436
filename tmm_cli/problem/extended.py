"""Numbers of a problem file in longdouble, from the decimals as they are written."""

from __future__ import annotations

import numpy as np

from tmm_cli.problem.units import UnitSystem
from tmm_cli.vectors import PI


class ExtendedUnits(UnitSystem):
    """Units whose numbers are longdoubles, and with them the functions of arithmetic."""

    functions = {  # noqa: RUF012  a table
        "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
        "atan2": np.arctan2, "hypot": np.hypot, "sqrt": np.sqrt, "min": min, "max": max,
        "pi": np.longdouble(PI),
    }  # fmt: skip

    def number(self, written: str | int | float) -> float:
        super().number(written)  # refuses what float64 has no place for
        value: float = np.longdouble(written if isinstance(written, str) else repr(written))  # type: ignore[assignment]
        return value
