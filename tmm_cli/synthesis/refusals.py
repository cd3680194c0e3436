"""Refusals of a task as they are printed: a limit is rounded so that, typed in as it is printed, it is allowed."""

from __future__ import annotations

from collections.abc import Mapping
from decimal import ROUND_HALF_EVEN, Decimal
from typing import Any, Final

from pydantic import BaseModel

from tmm_cli.errors import _
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.units import UnitSystem
from tmm_cli.quantities import KINDS
from tmm_cli.synthesis.blocks import Block
from tmm_cli.synthesis.record import Infeasible, Shown

STRICT: Final = Decimal("1e-6")  # relative: how far inside a limit that is not allowed itself
DIGITS: Final = 6
LOW, HIGH = ("least", "above"), ("most", "below")


def refusal(error: Infeasible, block: Block, units: UnitSystem, *, alone: bool = True) -> ProblemError:
    """The reason, and what could be met. alone: the suggestion helps without another change."""
    allowed, side = suggested(error, units), error.suggestion[-1] if isinstance(error.suggestion, tuple) else ""
    if side in LOW:
        allowed = _("{value} or more").format(value=allowed)
    elif side in HIGH:
        allowed = _("{value} or less").format(value=allowed)
    if not alone:
        allowed = _("{values}; but then another number is refused").format(values=allowed)
    return ProblemError(
        error.reason.format(**shown(error.values, units)), path=error.path, found=_found(block, error.path),
        allowed=allowed,
    )  # fmt: skip


def suggested(error: Infeasible, units: UnitSystem) -> str:
    """The value that could be met, as it is typed in, or what is said in its place."""
    if error.suggestion is None:
        return _("another task: no other value of this one helps")
    if isinstance(error.suggestion, str):
        return error.suggestion.format(**shown(error.values, units))
    return shown({"": error.suggestion}, units)[""]


def _found(block: Block, path: tuple[str | int, ...]) -> str | None:
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


def _at(block: Any, path: tuple[str | int, ...]) -> Any:
    for step in path:
        own = isinstance(step, int) or isinstance(block, dict)
        block = block[step] if own else getattr(block, str(step), getattr(block, f"{step}_", None))
    return getattr(block, "of", block)  # of a quantity its name


def shown(values: Mapping[str, Shown], units: UnitSystem) -> dict[str, str]:
    """Values of a refusal in the file's units, limits rounded to the allowed side."""
    return {name: _text(units, *row) for name, row in values.items()}


def _text(units: UnitSystem, value: Any, kind: str, side: str = "") -> str:
    if kind == "word":
        return str(value)
    dimension = KINDS[kind].dimension
    number = float(units.from_si(float(value), dimension))
    if side in (*LOW, *HIGH):
        number = _rounded(units, float(value), kind, side)
    return f"{number:.{15 if side == 'exact' else DIGITS}g} {units.symbol(dimension)}".rstrip()


def _rounded(units: UnitSystem, value: float, kind: str, side: str) -> float:
    """A limit in the file's unit with so many digits as are printed, nothing beyond it."""
    dimension = KINDS[kind].dimension
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
