"""Units for parameters that vary from linkage to linkage (see tmm_cli.tape.varied)."""

from __future__ import annotations

from functools import partial, reduce

import numpy as np

from tmm_cli.problem.units import UnitSystem
from tmm_cli.vectors import PI


class VariedUnits(UnitSystem):
    """Units whose functions of arithmetic take such numbers too."""

    functions = {  # noqa: RUF012  a table
        "sin": np.sin, "cos": np.cos, "tan": np.tan, "asin": np.arcsin, "acos": np.arccos, "atan": np.arctan,
        "atan2": np.arctan2, "hypot": np.hypot, "sqrt": np.sqrt, "pi": float(PI), "min": partial(reduce, np.minimum),
        "max": partial(reduce, np.maximum),
    }  # fmt: skip

    def __init__(self, own: UnitSystem) -> None:
        vars(self).update(vars(own))
