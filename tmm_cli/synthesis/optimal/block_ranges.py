"""What varies in an optimal synthesis: between two bounds, in steps, or among given values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np
from pydantic import BeforeValidator, Field
from pydantic_core import PydanticCustomError

from tmm_cli.errors import _
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.expressions import evaluate_quantity
from tmm_cli.problem.record import Problem
from tmm_cli.problem.schema_parts import Strict, Value
from tmm_cli.problem.tree import Path
from tmm_cli.problem.units import PhysicalValue, UnitError, UnitSystem
from tmm_cli.problem.values import ValueReader
from tmm_cli.quantities import KINDS
from tmm_cli.synthesis.blocks import OfTheFile

MOST = 10_000  # values of a parameter
SAME = 1e-9  # of a step: what is left over by rounding

Two = Annotated[list[Value], Field(min_length=2, max_length=2)]
End = tuple[str | int, Any]  # the key of a bound, and what stands there
FileWith = Callable[[dict[str, PhysicalValue], UnitSystem], Problem]


class Chosen(Strict):
    """A parameter that has some values only, as numbers of teeth or lengths from a series have."""

    from_: Value | None = Field(default=None, alias="from", description="the first of equal steps")
    to: Value | None = Field(default=None, description="which they do not go beyond")
    step: Value | None = Field(default=None, description="from one value to the next")
    among: list[Value] | None = Field(
        default=None, min_length=1, max_length=MOST, description="the values themselves, in the place of steps"
    )


def _listed(found: Any) -> Any:
    if not isinstance(found, list | dict):
        raise PydanticCustomError("range", _("[low, high], {from, to, step} or {among: [...]} is wanted"))
    if isinstance(found, list) and len(found) > 2:
        raise PydanticCustomError("range", _("these are not two bounds; values to choose from: {among: [...]}"))
    return found


Range = Annotated[Two | Chosen, BeforeValidator(_listed)]


@dataclass(frozen=True)
class Ranges:
    """low, high: bounds (SI) by name; kinds: their dimensions; values: of those that have some only, rising.

    at, told: the keys of the lower and the upper bound in the file, and what stands there.
    """

    low: dict[str, float] = field(default_factory=dict)
    high: dict[str, float] = field(default_factory=dict)
    kinds: dict[str, str] = field(default_factory=dict)
    values: dict[str, tuple[float, ...]] = field(default_factory=dict)
    at: dict[str, tuple[Path, Path]] = field(default_factory=dict)
    told: dict[str, tuple[str, str]] = field(default_factory=dict)


def read_ranges(vary: Mapping[str, Range], sense: ValueReader, names: Mapping[str, str], file_with: FileWith) -> Ranges:
    """Ranges by the names of the task; names: those of the file for them. Raises ProblemError."""
    ends: tuple[End, End]
    given = {name: _given(name, own) for name, own in vary.items()}
    kinds = _kinds(given, sense, names, file_with)
    found = Ranges(kinds=kinds)
    for name, own in vary.items():
        if isinstance(own, Chosen):
            values, ends = (_among if own.among else _steps)(name, own, sense, kinds[name])
            found.values[name] = values
            found.low[name], found.high[name] = values[0], values[-1]
        else:
            found.low[name], found.high[name] = _bounds(name, own, sense, kinds[name])
            ends = ((0, own[0]), (1, own[1]))
        (first, low), (last, high) = ends
        found.at[name] = (_path(name, own, first), _path(name, own, last))
        found.told[name] = quote(low), quote(high)
    return found


def _given(name: str, own: Range) -> list[Any]:
    """Every value of a range as the file has it. Raises ProblemError."""
    if not isinstance(own, Chosen):
        return own
    steps = {"from": own.from_, "to": own.to, "step": own.step}
    missing = [key for key, value in steps.items() if value is None]
    if own.among and len(missing) < len(steps):
        raise ProblemError(
            _("steps or values, not both"), path=("vary", name, "among"), allowed=_("from, to and step; or among"),
            key=True,
        )  # fmt: skip
    if not own.among and missing:
        raise ProblemError(
            _("the key `{key}` is missing").format(key=missing[0]), path=("vary", name),
            allowed=_("from, to and step; or among"), key=True,
        )  # fmt: skip
    return own.among or list(steps.values())


def _bounds(name: str, own: list[Any], sense: ValueReader, kind: str) -> tuple[float, float]:
    low, high = (float(sense.number(v, KINDS[kind].dimension, ("vary", name, n))) for n, v in enumerate(own))
    if not low < high:
        raise ProblemError(
            _("between equal bounds nothing varies") if low == high else _("the lower bound comes first"),
            path=("vary", name), found=two(*own),
            allowed=_("[low, high]; or a parameter") if low == high else "[low, high]",
        )  # fmt: skip
    return low, high


def _steps(name: str, own: Chosen, sense: ValueReader, kind: str) -> tuple[tuple[float, ...], tuple[End, End]]:
    at: Path = ("vary", name)
    low, high = (float(sense.number(v, KINDS[kind].dimension, (*at, key)))
                 for key, v in (("from", own.from_), ("to", own.to)))  # fmt: skip
    if not low < high:
        raise ProblemError(
            _("the lower bound comes first"), path=at, found=two(own.from_, own.to), allowed=_("from: low, to: high")
        )
    step = float(sense.positive(own.step, KINDS[kind].dimension, (*at, "step")))
    steps = (high - low) / step + SAME
    if steps < 1:
        raise ProblemError(
            _("not one step lies between these bounds"), path=(*at, "step"), found=quote(own.step),
            allowed=_("a step that leads from {low} towards {high}").format(low=own.from_, high=own.to),
        )  # fmt: skip
    if steps >= MOST:
        raise ProblemError(
            _("these are too many steps"), path=(*at, "step"), found=quote(own.step),
            allowed=_("{most} and less; or bounds without steps, [low, high]").format(most=MOST),
        )  # fmt: skip
    values = tuple(_round(low + step * k) for k in range(int(steps) + 1))
    return values, (("from", own.from_), ("to", own.to))


def _among(name: str, own: Chosen, sense: ValueReader, kind: str) -> tuple[tuple[float, ...], tuple[End, End]]:
    at: Path = ("vary", name, "among")
    given = own.among or []
    values = [float(sense.number(v, KINDS[kind].dimension, (*at, n))) for n, v in enumerate(given)]
    if len(set(values)) < 2:
        raise ProblemError(
            _("with one value nothing varies"), path=at, found=quote(given[0]), allowed=_("two and more")
        )  # fmt: skip
    first, last = int(np.argmin(values)), int(np.argmax(values))
    return tuple(sorted(set(values))), ((first, given[first]), (last, given[last]))


def two(low: Any, high: Any) -> str:
    """Two bounds as they are told in a refusal."""
    return _("{low} and {high}").format(low=low, high=high)


def _path(name: str, own: Range, key: str | int) -> Path:
    """Where a bound stands."""
    among = isinstance(own, Chosen) and isinstance(key, int)
    return ("vary", name, *(("among",) if among else ()), key)


def _round(value: float) -> float:
    """Without what adding up steps leaves beyond the fifteenth digit."""
    return float(f"{value:.15g}")


def _kinds(
    given: Mapping[str, list[Any]], sense: ValueReader, names: Mapping[str, str], file_with: FileWith
) -> dict[str, str]:
    """The dimension of each: of its values, else the first that the file takes them for, lengths before others.

    Of what the file refuses whatever it is, the first whose dimension it does not mind.
    """
    found = {name: next((k for v in own if (k := _kind_of(v, sense))), "") for name, own in given.items()}
    bare = [name for name, kind in found.items() if not kind]

    def refusal(numbers: Mapping[str, PhysicalValue]) -> ProblemError | None:
        try:
            file_with({names.get(name, name): number for name, number in numbers.items()}, sense.units)
        except OfTheFile as error:
            return error.error
        return None

    def quantity(name: str, kind: str | None) -> PhysicalValue:
        """A value of it; None: as a bare number."""
        if kind is None:
            return evaluate_quantity(given[name][0], sense.parameters, sense.units)
        dimension = KINDS[kind].dimension
        return PhysicalValue(float(sense.number(given[name][0], dimension, ("vary", name))), dimension)

    usual = {name: kind or "length" for name, kind in found.items()}
    try:
        first = {name: quantity(name, kind) for name, kind in usual.items()}
        plain = first | {name: quantity(name, None) for name in bare}
    except ProblemError:
        return usual  # said when its bounds are read
    if not bare or refusal(first) is None:
        return usual
    for name in bare:
        kinds = ("length", *(kind for kind in KINDS if kind != "length"))
        said = {kind: refusal(plain | {name: quantity(name, kind)}) for kind in kinds}
        fitting = [kind for kind in kinds if not isinstance(said[kind], UnitError)]
        found[name] = next((kind for kind in kinds if said[kind] is None), fitting[0] if fitting else "length")
    return found


def _kind_of(source: Any, sense: ValueReader) -> str | None:
    try:
        found = evaluate_quantity(source, sense.parameters, sense.units).dimension
    except ProblemError:
        return None  # said when it is evaluated
    return next((name for name, kind in KINDS.items() if kind.dimension == found), None)
