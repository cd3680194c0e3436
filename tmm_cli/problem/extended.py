"""Units of a file whose numbers are no plain floats: of 31 digits, or numbers that vary from linkage to linkage."""

from __future__ import annotations

from functools import partial, reduce
from typing import Any

import numpy as np

from tmm_cli.double_double import PI, DoubleDouble
from tmm_cli.problem.units import UnitSystem

FUNCTIONS = {
    "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
    "atan2": np.arctan2, "hypot": np.hypot, "sqrt": np.sqrt, "min": partial(reduce, np.minimum),
    "max": partial(reduce, np.maximum), "abs": abs,
}  # fmt: skip


class ExtendedUnits(UnitSystem):
    """Units whose numbers have 31 digits, from the decimals as they are written."""

    functions = {**FUNCTIONS, "pi": DoubleDouble.decimal(PI)}  # noqa: RUF012  a table

    def number(self, written: str | int | float) -> float:
        super().number(written)  # refuses what float64 has no place for
        found: Any = DoubleDouble.decimal(written if isinstance(written, str) else repr(written))
        return found  # type: ignore[no-any-return]


class VariedUnits(UnitSystem):
    """Units whose functions of arithmetic take numbers that vary (see tmm_cli.tape.varied)."""

    functions = {**FUNCTIONS, "pi": float(PI)}  # noqa: RUF012  a table

    def __init__(self, own: UnitSystem) -> None:
        vars(self).update(vars(own))
