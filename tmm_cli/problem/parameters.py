"""Parameters of a problem file: their names, and their evaluation in the order of their dependence."""

from __future__ import annotations

import re
from collections.abc import Mapping
from graphlib import CycleError, TopologicalSorter

from tmm_cli.language import _
from tmm_cli.problem.arithmetic import FUNCTIONS, MAX_LENGTH, Parser, evaluate_quantity, missing_unit_error
from tmm_cli.problem.errors import Path, ProblemError, prefix_errors, quote
from tmm_cli.problem.units import PhysicalValue, UnitSystem, plain_text


def check_parameter(name: str, path: Path, *, key: bool = True) -> None:
    """Check that a text can be the name of a parameter. Raises ProblemError if not."""
    if not re.fullmatch(r"[^\W\d]\w{0,39}", name):
        raise ProblemError(
            _("invalid name of a parameter"),
            path=path,
            found=quote(name),
            allowed=_("letters, digits and _, beginning with a letter"),
            key=key,
        )
    if name in FUNCTIONS or name == "pi":
        raise ProblemError(
            _("this is the name of a function or constant in expressions; choose another name"),
            path=path,
            found=quote(name),
            key=key,
        )


def resolve_parameters(
    raw: Mapping[str, object], units: UnitSystem, known: Mapping[str, PhysicalValue] | None = None
) -> dict[str, PhysicalValue]:
    """Evaluate the parameters of a file, in the order in which they depend on one another.

    Args:
        raw: numbers or expressions of the file, by parameter name.
        units: units of numbers that are written without a unit.
        known: values of further parameters that the expressions may use.

    Returns:
        Values of the parameters in `raw`, in SI and radians.

    Raises:
        ProblemError: an expression is wrong, or parameters refer to each other in a circle. The path of the error is
            the name of the parameter.
    """
    parameters: dict[str, PhysicalValue] = dict(known or {})
    for name in raw:
        check_parameter(name, (name,))
    placeholders = dict.fromkeys(raw, PhysicalValue(0.0))
    needs = {
        name: Parser(plain_text(source[:MAX_LENGTH]), placeholders, units).names() if isinstance(source, str) else []
        for name, source in raw.items()
    }
    try:
        order = list(TopologicalSorter(needs).static_order())
    except CycleError as error:
        cycle: list[str] = error.args[1][::-1]
        raise ProblemError(
            _("these parameters depend on each other in a circle"), path=(cycle[0],), found=" -> ".join(cycle)
        ) from None
    for name in order:
        with prefix_errors(name):
            parameters[name] = _evaluate_parameter(raw[name], parameters, units)
    return {name: parameters[name] for name in raw}


def _evaluate_parameter(source: object, parameters: Mapping[str, PhysicalValue], units: UnitSystem) -> PhysicalValue:
    """Evaluate a parameter, which may have any dimension."""
    try:
        return evaluate_quantity(source, parameters, units)
    except ProblemError as error:
        if not isinstance(source, str):
            raise
        first = error

    def fits(others: Mapping[str, PhysicalValue]) -> bool:
        return bool(evaluate_quantity(source, others, units))

    raise missing_unit_error(source, parameters, units, fits) or first from None
