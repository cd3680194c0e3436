"""What varies in an optimal synthesis: between two bounds, in steps, or among given values."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Annotated, Any, Self

from pydantic import BeforeValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.expressions import evaluate_quantity
from tmm_cli.problem.record import Problem
from tmm_cli.problem.schema_parts import Strict, Value
from tmm_cli.problem.tree import Path
from tmm_cli.problem.units import PhysicalValue, UnitError, UnitSystem
from tmm_cli.problem.values import ValueReader
from tmm_cli.quantities import KINDS
from tmm_cli.synthesis.blocks import OfTheFile
from tmm_cli.synthesis.optimal.task import Parameter

MOST = 10_000  # values of a parameter
SAME = 1e-9  # of a step: what is left over by rounding

Two = Annotated[list[Value], Field(min_length=2, max_length=2)]
FileWith = Callable[[dict[str, PhysicalValue], UnitSystem], Problem]


class Chosen(Strict):
    """A parameter that has some values only, as numbers of teeth or lengths from a series have."""

    from_: Value | None = Field(default=None, alias="from", description="the first of equal steps")
    to: Value | None = Field(default=None, description="which they do not go beyond")
    step: Value | None = Field(default=None, description="from one value to the next")
    among: list[Value] | None = Field(
        default=None, min_length=1, max_length=MOST, description="the values themselves, in the place of steps"
    )

    @model_validator(mode="after")
    def _steps_or_values(self) -> Self:
        missing = [value is None for value in (self.from_, self.to, self.step)]
        if any(missing) if self.among is None else not all(missing):
            raise _unreadable()
        return self


def _unreadable() -> PydanticCustomError:
    return PydanticCustomError("range", _("[low, high], {from, to, step} or {among: [...]} is wanted"))


def _listed(found: Any) -> Any:
    if not isinstance(found, list | dict):
        raise _unreadable()
    if isinstance(found, list) and len(found) > 2:
        raise PydanticCustomError("range", _("these are not two bounds; values to choose from: {among: [...]}"))
    return found


Range = Annotated[Two | Chosen, BeforeValidator(_listed)]


def read_ranges(
    vary: Mapping[str, Range], sense: ValueReader, names: Mapping[str, str], file_with: FileWith
) -> tuple[Parameter, ...]:
    """names: those of the file for names of the task. Raises ProblemError."""
    kinds = _kinds({name: _values(own) for name, own in vary.items()}, sense, names, file_with)
    return tuple(_parameter(name, own, kinds[name], sense) for name, own in vary.items())


def _values(own: Range) -> list[Any]:
    """Every value of a range as the file has it."""
    return (own.among or [own.from_, own.to, own.step]) if isinstance(own, Chosen) else own


def _parameter(name: str, own: Range, kind: str, sense: ValueReader) -> Parameter:
    at: Path = ("vary", name)
    dimension = KINDS[kind].dimension

    def si(value: Any, *inside: str | int) -> float:
        return float(sense.number(value, dimension, (*at, *inside)))

    if isinstance(own, Chosen) and own.among:
        values = sorted({si(value, "among", n) for n, value in enumerate(own.among)})
        if len(values) < 2:
            raise ProblemError(
                _("with one value nothing varies"), path=(*at, "among"), found=quote(own.among[0]),
                allowed=_("two and more"),
            )  # fmt: skip
        return Parameter(name, values[0], values[-1], kind, tuple(values))
    ends = {"from": own.from_, "to": own.to} if isinstance(own, Chosen) else dict(enumerate(own))
    low, high = (si(value, key) for key, value in ends.items())
    if not low < high:
        raise ProblemError(
            _("the lower bound comes first"), path=at, found=two(*ends.values()), allowed=_("[low, high]")
        )
    if not isinstance(own, Chosen):
        return Parameter(name, low, high, kind)
    step = float(sense.positive(own.step, dimension, (*at, "step")))
    count = (high - low) / step + SAME
    if not 1 <= count < MOST:
        raise ProblemError(
            _("1 to {most} steps must lie between the bounds").format(most=MOST - 1), path=(*at, "step"),
            found=quote(own.step), allowed=_("another step; or bounds without steps, [low, high]"),
        )  # fmt: skip
    values = [float(f"{low + step * k:.15g}") for k in range(int(count) + 1)]  # without what adding up leaves
    return Parameter(name, values[0], values[-1], kind, tuple(values))


def two(low: Any, high: Any) -> str:
    """Two bounds as they are told in a refusal."""
    return _("{low} and {high}").format(low=low, high=high)


def _kinds(
    given: Mapping[str, list[Any]], sense: ValueReader, names: Mapping[str, str], file_with: FileWith
) -> dict[str, str]:
    """The dimension of each: of its values, else the first that the file takes them for, lengths before others.

    A bare number is a number where the file takes it for a length too (a share of the way between two points). Of what
    the file refuses whatever it is, the first whose dimension it does not mind.
    """
    found = {name: next((k for v in own if (k := _kind_of(v, sense))), "") for name, own in given.items()}

    def value(name: str, kind: str) -> PhysicalValue:
        if not kind:  # as a bare number
            return evaluate_quantity(given[name][0], sense.parameters, sense.units)
        dimension = KINDS[kind].dimension
        return PhysicalValue(float(sense.number(given[name][0], dimension, ())), dimension)

    def minded(kinds: Mapping[str, str]) -> int:
        """2: the file minds the dimension of a first value; 1: it refuses them for another reason; 0: for none."""
        try:
            file_with({names.get(name, name): value(name, kind) for name, kind in kinds.items()}, sense.units)
        except OfTheFile as error:
            return 2 if isinstance(error.error, UnitError) else 1
        except ProblemError:
            return 2  # said when its bounds are read
        return 0

    def is_share(name: str, kinds: Mapping[str, str]) -> bool:
        """True if the file takes a number for it, and not whatever it is, as of what it uses nowhere."""
        return not minded({**kinds, name: "number"}) and bool(minded({**kinds, name: "angle"}))

    lengths = {name: kind or "length" for name, kind in found.items()}
    if lengths == found:
        return lengths
    if not minded(lengths):
        return lengths | {name: "number" for name, kind in found.items() if not kind and is_share(name, lengths)}
    plain = dict(found)
    for name in (name for name, kind in plain.items() if not kind):
        found[name] = min(("length", *KINDS), key=lambda kind: minded(plain | {name: kind}))
    return found


def _kind_of(source: Any, sense: ValueReader) -> str | None:
    try:
        found = evaluate_quantity(source, sense.parameters, sense.units).dimension
    except ProblemError:
        return None  # said when it is evaluated
    return None if found is None else found.name
