"""Units of a file whose numbers are no plain floats: longdoubles, or numbers that vary from linkage to linkage."""

from __future__ import annotations

from functools import partial, reduce

import numpy as np

from tmm_cli.problem.units import UnitSystem
from tmm_cli.vectors import PI

FUNCTIONS = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
    "atan2": np.arctan2, "hypot": np.hypot, "sqrt": np.sqrt, "min": partial(reduce, np.minimum),
    "max": partial(reduce, np.maximum), "abs": abs,
}  # fmt: skip


class ExtendedUnits(UnitSystem):
    """Units whose numbers are longdoubles, from the decimals as they are written."""

    functions = {**FUNCTIONS, "pi": np.longdouble(PI)}  # noqa: RUF012  a table

    def number(self, written: str | int | float) -> float:
        super().number(written)  # refuses what float64 has no place for
        value: float = np.longdouble(written if isinstance(written, str) else repr(written))  # type: ignore[assignment]
        return value


class VariedUnits(UnitSystem):
    """Units whose functions of arithmetic take numbers that vary (see tmm_cli.tape.varied)."""

    functions = {**FUNCTIONS, "pi": float(PI)}  # noqa: RUF012  a table

    def __init__(self, own: UnitSystem) -> None:
        vars(self).update(vars(own))
