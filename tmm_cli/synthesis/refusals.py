"""Refusals of a task as they are printed: the reason, and the nearest feasible value of one number that was given."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from decimal import ROUND_HALF_EVEN, Decimal
from functools import partial
from typing import Any, Final

import numpy as np
from pydantic import BaseModel

from tmm_cli.language import N_, _, translated
from tmm_cli.problem.errors import ProblemError, path_text, quote
from tmm_cli.problem.tree import Path
from tmm_cli.problem.units import UnitSystem
from tmm_cli.quantities import ANGLE, KINDS, NUMBER, Dimension
from tmm_cli.roots import bisect
from tmm_cli.synthesis.blocks import Block
from tmm_cli.synthesis.record import Infeasible, Shown

STRICT: Final = Decimal("1e-6")  # relative: how far inside a limit that is not allowed itself
DIGITS: Final = 6
LOW, HIGH = ("least", "above"), ("most", "below")
GROWING: Final = np.geomspace(1e-3, 1e4, 40)
STEPS: Final = np.concatenate([GROWING, -GROWING])  # changes that are tried, over the given value
SHARES: Final = np.concatenate([np.geomspace(1e-6, 1, 24), -np.geomspace(1e-6, 1, 24)])
BESIDE: Final = {NUMBER: (0.0, 1.0), ANGLE: (0.0, np.pi / 2)}  # and places near these, over the distance from them
HALVINGS: Final = 30
INWARDS: Final = 5e-5  # relative: so far from the limit a mechanism is not dead but for rounding
ALONE: Final = 1e-3
NONE: Final = N_("another task: no other value of it was found to help")


def refusal(error: Infeasible, block: Block, units: UnitSystem, told: str = NONE) -> ProblemError:
    """The reason, and what could be met: what the room says, else what is told."""
    if error.suggestion is not None:
        told = _(error.suggestion).format(**shown(error.values, units))
    return ProblemError(
        _(error.reason).format(**shown(error.values, units)), path=error.path, found=_found(block, error.path),
        allowed=_(told),
    )  # fmt: skip


def nearest(
    given: Mapping[Path, tuple[float, Dimension]], solved: Callable[[Path, float], bool], units: UnitSystem
) -> str:
    """The nearest feasible value of the first of these numbers (SI) that has one, as it is typed in.

    solved: whether the task is, with another value at a path.
    """
    for path, (value, want) in given.items():
        found = _nearest(value, want, partial(solved, path))
        if found is not None:
            number = _rounded(units, found, want, "least" if found > value else "most")
            if not solved(path, units.si(number, want)):
                number = float(units.from_si(found, want))
            told = f"{number:.15g} {units.symbol(want)}".rstrip()
            return _("the nearest is {name}: {value}").format(name=path_text(path), value=told)
    return NONE


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


def _found(block: Block, path: Path) -> str | None:
    """What stands there; of bounds all of them."""
    given = _at(block, path)
    if path == ("vary",):
        return quote(", ".join(f"{name}: {_told(own)}" for name, own in given.items()))
    if isinstance(given, BaseModel):  # steps or values of one parameter
        return quote(_told(given))
    return quote(given) if path else None


def _told(own: Any) -> str:
    """Bounds, or steps, as they are written."""
    if isinstance(own, list):
        return f"[{', '.join(map(str, own))}]"
    given = own.model_dump(by_alias=True, exclude_defaults=True)
    return f"{{{', '.join(f'{key}: {_told(v) if isinstance(v, list) else v}' for key, v in given.items())}}}"


def _at(block: Any, path: Path) -> Any:
    for step in path:
        own = isinstance(step, int) or isinstance(block, dict)
        block = block[step] if own else getattr(block, str(step), getattr(block, f"{step}_", None))
    return getattr(block, "of", block)  # of a quantity its name


def shown(values: Mapping[str, Shown], units: UnitSystem) -> dict[str, str]:
    """Values of a refusal in the file's units, limits rounded to the allowed side."""
    return {name: _text(units, *row) for name, row in values.items()}


def _text(units: UnitSystem, value: Any, kind: str, side: str = "") -> str:
    if kind == "word":
        return translated(value) if isinstance(value, str) else str(value)
    dimension = KINDS[kind].dimension
    number = float(units.from_si(float(value), dimension))
    if side in (*LOW, *HIGH):
        number = _rounded(units, float(value), dimension, side)
    return f"{number:.{15 if side == 'exact' else DIGITS}g} {units.symbol(dimension)}".rstrip()


def _rounded(units: UnitSystem, value: float, dimension: Dimension, side: str) -> float:
    """A limit in the file's unit with so many digits as are printed, nothing beyond it."""
    exact = Decimal(float(units.from_si(value, dimension)))
    if not exact.is_finite() or exact == 0:
        return float(exact)
    step = Decimal(1).scaleb(exact.adjusted() - DIGITS + 1)
    number, sign = exact.quantize(step, ROUND_HALF_EVEN), 1 if side in LOW else -1
    strict = side in ("above", "below")
    while sign * (units.si(float(number), dimension) - value) < 0 or (
        strict and sign * (number - exact) < STRICT * abs(exact)
    ):
        number += sign * step
    return float(number)
