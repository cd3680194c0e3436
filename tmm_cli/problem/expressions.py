"""Values of a problem file that may be arithmetic on parameters: parsed (arithmetic), never run as Python.

A bare number is flexible: beside a quantity with a dimension it is taken in the file's unit of that dimension, and so
is a bare result where a dimension is wanted.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from graphlib import CycleError, TopologicalSorter
from typing import Final

from tmm_cli.language import _
from tmm_cli.problem.arithmetic import FUNCTIONS, Parser, taken
from tmm_cli.problem.errors import ProblemError, quote, under
from tmm_cli.problem.tree import Path, WrittenNumber
from tmm_cli.problem.units import PhysicalValue, UnitError, UnitSystem, plain_text
from tmm_cli.quantities import ACCELERATION, ANGLE, ANGULAR_SPEED, KINDS, NUMBER, Dimension

MAX_LENGTH: Final = 200


def evaluate(source: object, parameters: Mapping[str, PhysicalValue], units: UnitSystem, want: Dimension) -> float:
    """A value in SI and radians. Raises ProblemError (without a path) for what is not arithmetic or does not fit."""
    try:
        return _fitting(source, evaluate_quantity(source, parameters, units), units, want)
    except ProblemError as error:
        if not isinstance(source, str):
            raise
        first = error
    try:
        if "pi" in source:  # perhaps a ratio, as in pi * OA
            return _fitting(source, evaluate_quantity(source, parameters, units, pi=None), units, want)
    except ProblemError:
        pass

    def fits(others: Mapping[str, PhysicalValue]) -> bool:
        return taken(evaluate_quantity(source, others, units), want, units) is not None

    raise _missing_unit(source, parameters, units, fits) or first from None


def _missing_unit(
    source: str, parameters: Mapping[str, PhysicalValue], units: UnitSystem,
    fits: Callable[[Mapping[str, PhysicalValue]], bool],
) -> ProblemError | None:  # fmt: skip
    """The refusal of a value whose dimensions do not fit because a parameter in it has no unit, unlike others.

    Each kind of unit is tried on each parameter without one. None if no unit mends the value.
    """
    used = dict.fromkeys(Parser(plain_text(source[:MAX_LENGTH]), parameters, units).names())
    bare = [name for name in used if parameters[name].dimension is None]
    if len(bare) == len(used):
        return None
    for kind in KINDS.values():
        for name in bare if kind.dimension != NUMBER else ():
            value = PhysicalValue(units.si(parameters[name].value, kind.dimension), kind.dimension)
            try:
                if not fits({**parameters, name: value}):
                    continue
            except ProblemError:
                continue
            number = f"{parameters[name].value:.6g}"
            written = f"{number} {units.symbol(kind.dimension)}"
            if kind.dimension == ANGULAR_SPEED:  # bare, it counts revolutions as often as radians
                written = _("{a} or {b}").format(a=f"{number} rpm", b=f"{number} rad/s")
            message = _("parameter {name} has no unit: write {name}: {value}").format(name=name, value=written)
            return UnitError(message, found=quote(source))
    return None


def _fitting(source: object, found: PhysicalValue, units: UnitSystem, want: Dimension) -> float:
    value = taken(found, want, units)
    if value is None:
        given = f"{quote(source)}, {units.show(found)}"
        allowed = want.example
        if want == ANGLE and "pi" in str(source):
            allowed = _("{allowed}; pi is in radians already").format(allowed=allowed)
        if found.dimension is not None and found.dimension.times(ACCELERATION).fits(want):
            allowed = _("{allowed}; a kilogram of force is written kgf").format(allowed=allowed)
        raise UnitError(_("{want} is wanted here").format(want=want), found=given, allowed=allowed)
    return value


def evaluate_quantity(
    source: object, parameters: Mapping[str, PhysicalValue], units: UnitSystem, pi: Dimension | None = ANGLE
) -> PhysicalValue:
    """The value with its dimension; None for a bare number.

    pi is one of radians, so that pi/2 is a right angle whatever the file's unit of angles, unless told otherwise.
    """
    if isinstance(source, bool) or not isinstance(source, int | float | str):
        raise ProblemError(_("a number is wanted here"), found=quote(source), allowed=_("a number, a unit, arithmetic"))
    if isinstance(source, int | float):
        if not -1e300 < source < 1e300:
            raise ProblemError(_("not a number from -1e300 to 1e300"), found=quote(source))
        return PhysicalValue(units.number(source.written if isinstance(source, WrittenNumber) else source), None)
    if len(source) > MAX_LENGTH:
        raise ProblemError(
            _("this is too long"), found=quote(source),
            allowed=_("at most {max_length} characters").format(max_length=MAX_LENGTH),
        )  # fmt: skip
    return Parser(plain_text(source), parameters, units, pi).whole()


def check_parameter(name: str, path: Path, *, key: bool = True) -> None:
    """Refuse what cannot be the name of a parameter."""
    if not re.fullmatch(r"[^\W\d]\w{0,39}", name):
        raise ProblemError(
            _("this cannot be the name of a parameter"), path=path, found=quote(name),
            allowed=_("letters, figures and _, a letter first"), key=key,
        )  # fmt: skip
    if name in FUNCTIONS or name == "pi":
        raise ProblemError(_("this name is taken by arithmetic"), path=path, found=quote(name), key=key)


def resolve_parameters(
    raw: Mapping[str, object], units: UnitSystem, given: Mapping[str, PhysicalValue] | None = None
) -> dict[str, PhysicalValue]:
    """Parameters, each of which may be arithmetic on others, in any order, and on those that are given already."""
    found: dict[str, PhysicalValue] = dict(given or {})
    for name in raw:
        check_parameter(name, (name,))
    known = dict.fromkeys(raw, PhysicalValue(0.0))
    needs = {
        name: Parser(plain_text(source[:MAX_LENGTH]), known, units).names() if isinstance(source, str) else []
        for name, source in raw.items()
    }
    try:
        order = list(TopologicalSorter(needs).static_order())
    except CycleError as error:
        cycle: list[str] = error.args[1][::-1]
        raise ProblemError(_("parameters go round in a circle"), path=(cycle[0],), found=" -> ".join(cycle)) from None
    for name in order:
        with under(name):
            found[name] = _parameter(raw[name], found, units)
    return {name: found[name] for name in raw}


def _parameter(source: object, parameters: Mapping[str, PhysicalValue], units: UnitSystem) -> PhysicalValue:
    """The value of a parameter, whatever it measures."""
    try:
        return evaluate_quantity(source, parameters, units)
    except ProblemError as error:
        if not isinstance(source, str):
            raise
        first = error

    def fits(others: Mapping[str, PhysicalValue]) -> bool:
        return bool(evaluate_quantity(source, others, units))

    raise _missing_unit(source, parameters, units, fits) or first from None
