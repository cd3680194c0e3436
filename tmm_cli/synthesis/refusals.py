"""Refusals of a task as they are printed: the reason, and the nearest feasible value of one number that was given."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal
from functools import partial
from typing import Any, Final

import numpy as np

from tmm_cli.language import N_, _, translated
from tmm_cli.problem.errors import ProblemError, path_text, quote
from tmm_cli.problem.tree import Path
from tmm_cli.problem.units import UnitSystem
from tmm_cli.quantities import ANGLE, KINDS, NUMBER, Dimension
from tmm_cli.roots import bisect
from tmm_cli.synthesis.record import Infeasible

DIGITS: Final = 6
GROWING: Final = np.geomspace(1e-3, 1e4, 40)
STEPS: Final = np.concatenate([GROWING, -GROWING])  # changes that are tried, over the given value
SHARES: Final = np.concatenate([np.geomspace(1e-6, 1, 24), -np.geomspace(1e-6, 1, 24)])
BESIDE: Final = {NUMBER: (0.0, 1.0), ANGLE: (0.0, np.pi / 2)}  # and places near these, over the distance from them
HALVINGS: Final = 30
INWARDS: Final = 5e-5  # relative: so far from the limit a mechanism is not dead but for rounding
ALONE: Final = 1e-3
NONE: Final = N_("another task: no other value of it was found to help")


def refusal(error: Infeasible, given: Any, units: UnitSystem, searched: str | None = None) -> ProblemError:
    """The reason, and what could be met: what the task knows of it, else what was searched. given: the file's block."""
    told = error.nearest if isinstance(error.nearest, str) else searched
    if isinstance(error.nearest, tuple):
        value, kind, side = error.nearest
        dimension = KINDS[kind].dimension
        told = _told(error.path, rounded(units, value, dimension, side), dimension, units)
    for step in error.path:
        inside = isinstance(given, list) or (isinstance(given, dict) and step in given)
        given = given[step] if inside else None
    found = quote(given) if error.path and given is not None else None
    return ProblemError(translated(error.reason), path=error.path, found=found, allowed=told)


def nearest(
    given: Mapping[Path, tuple[float, Dimension]], solved: Callable[[Path, float], bool], units: UnitSystem
) -> str:
    """The nearest feasible value of the first of these numbers (SI) that has one, as it is typed in.

    solved: whether the task is, with another value at a path.
    """
    for path, (value, want) in given.items():
        found = _nearest(value, want, partial(solved, path))
        if found is not None:
            number = rounded(units, found, want, 1 if found > value else -1)
            if not solved(path, units.si(number, want)):
                number = float(units.from_si(found, want))
            return _told(path, number, want, units)
    return NONE


def _told(path: Path, number: float, want: Dimension, units: UnitSystem) -> str:
    value = f"{number:.15g} {units.symbol(want)}".rstrip()
    return _("the nearest is {name}: {value}").format(name=path_text(path), value=value)


def _nearest(value: float, want: Dimension, solved: Callable[[float], bool]) -> float | None:
    """The feasible value that is nearest to one that is not: changes are tried, the least first, and halved."""
    places = [value + (abs(value) or 1.0) * STEPS]
    places += [fixed + abs(value - fixed) * SHARES for fixed in BESIDE.get(want, (0.0,))]
    reach = 2 * np.pi if want == ANGLE else np.inf
    last = {-1.0: np.array(value), 1.0: np.array(value)}
    for place in sorted(np.concatenate(places).tolist(), key=lambda place: abs(place - value)):
        side = 1.0 if place > value else -1.0
        if abs(place - value) <= reach and solved(place):
            edge = float(bisect(lambda x: np.asarray(solved(float(x))), np.array(place), last[side], HALVINGS)[0])
            if abs(edge - value) < ALONE * abs(place - value):  # all but the given value itself is good
                return float(place)
            inside = edge + side * INWARDS * min(abs(edge), abs(edge - value))
            return inside if solved(inside) else edge
        last[side] = np.array(place)
    return None


def rounded(units: UnitSystem, value: float, dimension: Dimension, side: int) -> float:
    """A limit (SI) in the file's unit with as many digits as are printed, to its larger (1) or smaller (-1) side."""
    exact = Decimal(float(units.from_si(value, dimension)))
    if side == 0 or not exact.is_finite() or exact == 0:
        return float(exact)
    step = Decimal(1).scaleb(exact.adjusted() - DIGITS + 1)
    number = exact.quantize(step, ROUND_CEILING if side > 0 else ROUND_FLOOR)
    while side * (units.si(float(number), dimension) - value) < 0:
        number += side * step
    return float(number)
