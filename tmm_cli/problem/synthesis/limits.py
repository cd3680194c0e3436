"""Numbers of a refusal as they are printed: rounded so that a limit, typed in as it is printed, is allowed."""

from __future__ import annotations

from collections.abc import Mapping
from decimal import ROUND_HALF_EVEN, Decimal
from typing import Any, Final

from tmm_cli.problem.units import KINDS, UnitSystem
from tmm_cli.synthesis.record import Shown
from tmm_cli.words import say

DIGITS: Final = (6, 9, 12, 15)  # more only where a least and a most allowed value would cross
STRICT: Final = Decimal("1e-6")  # relative: how far inside a limit that is not allowed itself
TEXTS: Final = ("word", "said")  # text as it is, a key of words
LOW: Final = ("least", "above")


def shown(values: Mapping[str, Shown], units: UnitSystem) -> dict[str, str]:
    """Values of a refusal in the file's units, limits rounded to the allowed side."""
    for digits in DIGITS:
        found = {
            name: _rounded(value, kind, side, digits, units)
            for name, (value, kind, side) in _whole(values).items() if kind not in TEXTS
        }  # fmt: skip
        if not _crossed(_whole(values), found):
            break
    return {name: _text(row, found.get(name), digits, units) for name, row in _whole(values).items()}


def _whole(values: Mapping[str, Shown]) -> dict[str, tuple[Any, str, str]]:
    return {name: (row[0], row[1], row[2] if len(row) > 2 else "") for name, row in values.items()}


def _text(row: tuple[Any, str, str], number: Decimal | None, digits: int, units: UnitSystem) -> str:
    if number is None:
        return say(row[0]) if row[1] == "said" else str(row[0])
    digits = DIGITS[-1] if row[2] == "exact" else digits
    return f"{float(number):.{digits}g} {units.symbol(KINDS[row[1]].dimension)}".rstrip()


def _rounded(value: Any, kind: str, side: str, digits: int, units: UnitSystem) -> Decimal:
    """A value in the file's unit with so many digits, nothing beyond the limit that it is."""
    dimension = KINDS[kind].dimension
    exact = Decimal(float(units.from_si(float(value), dimension)))
    if not exact.is_finite() or exact == 0:
        return exact
    step = Decimal(1).scaleb(exact.adjusted() - digits + 1)
    number = exact.quantize(step, ROUND_HALF_EVEN)
    if side in ("", "exact"):
        return number if not side else exact
    sign = 1 if side in LOW else -1
    margin = STRICT * abs(exact) if side in ("above", "below") else Decimal(0)
    while sign * (units.si(float(number), dimension) - float(value)) < 0 or sign * (number - exact) < margin:
        number += sign * step
    return number


def _crossed(values: Mapping[str, tuple[Any, str, str]], found: Mapping[str, Decimal]) -> bool:
    """Whether a least allowed value would be printed above a most allowed one of its kind."""
    bounds = [(*values[name], number) for name, number in found.items() if values[name][2] not in ("", "exact")]
    return any(
        low[1] == high[1] and low[0] < high[0] and low[3] >= high[3]
        for low in bounds if low[2] in LOW for high in bounds if high[2] not in LOW
    )  # fmt: skip
