"""Values of a file with their units, and words that a file may say, as people read them."""

from __future__ import annotations

from typing import Final

import numpy as np

from tmm_cli.language import N_
from tmm_cli.problem.record import Problem
from tmm_cli.quantities import LENGTH, Dimension
from tmm_cli.results.table import with_unit

FILE_WORDS: Final = {  # that a file may say, where they are shown
    "always": N_("always"), "working stroke": N_("working stroke"),
    "stroke": N_("stroke"), "share of stroke": N_("share of the stroke"),
    "crank angle": N_("crank angle"), "crank turn": N_("crank turn"),
}  # fmt: skip


def show(problem: Problem, value: float, dimension: Dimension) -> str:
    """A value with its unit, of the file where it has one for this dimension."""
    return with_unit(problem.units, float(np.ravel(value)[0]), dimension)


def show_vector(problem: Problem, value: complex, dimension: Dimension = LENGTH) -> str:
    """Both components in the unit of the file: `[120, 0]`."""
    value = complex(np.ravel(value)[0])
    return f"[{', '.join(f'{problem.units.from_si(v, dimension) + 0.0:.6g}' for v in (value.real, value.imag))}]"
