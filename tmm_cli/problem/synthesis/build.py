"""Parameters of a file with a synthesis: those that it rests on, those that it finds, those that rest on them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
from pydantic import BaseModel

from tmm_cli.problem.arithmetic import Parser
from tmm_cli.problem.errors import ProblemError, UnknownParameterError, nearest, quote
from tmm_cli.problem.expressions import check_parameter, resolve_parameters
from tmm_cli.problem.record import Problem, Synthesised
from tmm_cli.problem.sense import Sense
from tmm_cli.problem.synthesis import Block, reader
from tmm_cli.problem.synthesis.bounded import Bounded
from tmm_cli.problem.units import KINDS, Quantity, UnitSystem, plain_text
from tmm_cli.synthesis import task
from tmm_cli.synthesis.record import Infeasible, sound
from tmm_cli.words import say

Parameters = dict[str, Quantity]
SLOW = ("coupler-positions",)  # tasks whose refusals are told once: another costs too much
TOLD = ("least", "low", "most", "high", "lever", "one", "turn", "near0")  # values that may stand in a key's place
Variant = Callable[[Parameters, UnitSystem], Problem]


class OfTheFile(Exception):  # noqa: N818  it says whose the error is
    """What the file around the block is refused for, with numbers that the synthesis tries."""

    def __init__(self, error: ProblemError) -> None:
        super().__init__(str(error))
        self.error = error


def asked(block: Block, raw: Mapping[str, object], units: UnitSystem, variant: Variant | None = None) -> Any:
    """What the task is asked, in its own record. Raises ProblemError."""
    _, late, early, with_found = _parts(block, raw, units)

    def file_with(found: Parameters, own: UnitSystem) -> Problem:
        assert variant is not None
        try:
            return variant(with_found(found, own), own)
        except ProblemError as error:
            raise OfTheFile(error) from None

    try:
        _not_on(block, late, units)
        search = getattr(reader(block.task), "SEARCH", False)
        if search and variant is None:
            raise ProblemError("there is no linkage whose parameters could vary", allowed="links and a driver")
        sense = Sense(early, units) if search else Bounded(early, units)
        return reader(block.task).asked(block, sense, *((file_with,) if search else ()))
    except Infeasible as error:
        raise _refused(error, block, units).at("synthesis") from None
    except OfTheFile as error:
        raise error.error from None
    except ProblemError as error:
        raise error.at("synthesis") from None


def _parts(
    block: Block, raw: Mapping[str, object], units: UnitSystem
) -> tuple[dict[str, str], set[str], Parameters, Callable[[Parameters, UnitSystem], Parameters]]:
    """Names of what is found, parameters that rest on it, the others, and all of them once it is found."""
    names = _names(block, raw)
    late = _resting(raw, set(names.values()), units)
    early = _early(block, {name: raw[name] for name in raw if name not in late}, units, names)

    def with_found(found: Parameters, own: UnitSystem) -> Parameters:
        known = early | found
        return known | _parameters({name: raw[name] for name in late}, own, known)

    return names, late, early, with_found


def with_synthesis(
    block: Block, raw: Mapping[str, object], units: UnitSystem, variant: Variant | None = None,
    known: Synthesised | None = None,
) -> tuple[Parameters, Synthesised]:  # fmt: skip
    """All parameters of the file, and what was found. Raises ProblemError.

    variant: the file with other parameters, if it has a linkage; known: what a search found already.
    """
    names, _, _, with_found = _parts(block, raw, units)
    if known is not None and getattr(reader(block.task), "SEARCH", False):
        outcome = known.outcome
    else:
        record = asked(block, raw, units, variant)
        try:
            with np.errstate(all="ignore"):  # what has no value is refused by `sound`
                outcome = sound(task(block.task).solve(record))
        except Infeasible as error:
            told = _refused(error, block, units)
            if not getattr(reader(block.task), "SEARCH", False) and block.task not in SLOW:
                told.allowed = (told.allowed or "") + _beside(error, block, raw, units)
            raise told.at("synthesis") from None
        except OfTheFile as error:
            raise error.error from None
        except ProblemError as error:
            raise error.at("synthesis") from None
    found = {
        names[name]: Quantity(_plain(value.value), KINDS[value.kind].dimension)
        for name, value in outcome.parameters.items() if name in names
    }  # fmt: skip
    return with_found(found, units), Synthesised(block.task, outcome, names)


def _parameters(
    raw: Mapping[str, object], units: UnitSystem, given: Mapping[str, Quantity] | None = None
) -> Parameters:
    try:
        return resolve_parameters(raw, units, given)
    except ProblemError as error:
        raise error.at("parameters") from None


def _early(block: Block, raw: Mapping[str, object], units: UnitSystem, names: Mapping[str, str]) -> Parameters:
    """Parameters that do not rest on what is found; what is found is among the names that are allowed."""
    try:
        return _parameters(raw, units)
    except UnknownParameterError as error:
        told = ", ".join(names.values())
        given = f"{error.allowed}, and " if raw and error.allowed != "none is given" else ""
        error.allowed = f"{given}what the synthesis {block.task} finds: {told}" if told else error.allowed
        error.near = nearest(error.unknown, [*raw, *names.values()])
        raise


def _standard(block: Block) -> Mapping[str, str]:
    """Names and kinds of what the task finds; they may depend on what is asked."""
    told = getattr(reader(block.task), "parameters", None)
    found: Mapping[str, str] = task(block.task).PARAMETERS if told is None else told(block)
    return found


def _names(block: Block, raw: Mapping[str, object]) -> dict[str, str]:
    """Standard names of what is found, and those that the file gives them."""
    standard = _standard(block)
    for name, other in block.names.items():
        path = ("synthesis", "names", name)
        if name not in standard:
            raise ProblemError(
                f"the synthesis {block.task} finds nothing of that name", path=path, found=quote(name),
                allowed=", ".join(standard) or "it finds no parameters", near=nearest(name, standard), key=True,
            )  # fmt: skip
        check_parameter(other, path, key=False)
    names = {name: block.names.get(name, name) for name in standard}
    taken: dict[str, str] = {}
    for name, other in names.items():
        if other in taken:
            raise ProblemError(
                f"{taken[other]} and {name} of the synthesis have the same name", path=("synthesis", "names"),
                found=quote(other), allowed="different names",
            )  # fmt: skip
        taken[other] = name
        if other in raw:
            raise ProblemError(
                f"the parameter {other} is given by hand, and the synthesis {block.task} finds it (its {name})",
                path=("parameters", other), found=quote(raw[other]),
                allowed=f"one of the two; another name: synthesis: {{names: {{{name}: ...}}}}", key=True,
            )  # fmt: skip
    return names


def _resting(raw: Mapping[str, object], found: set[str], units: UnitSystem) -> set[str]:
    """Parameters given by hand that rest on what is found, at first hand or through others."""
    known = dict.fromkeys([*raw, *found], Quantity(0.0))
    needs = {name: set(Parser(plain_text(source[:200]), known, units).names())
             for name, source in raw.items() if isinstance(source, str)}  # fmt: skip
    late: set[str] = set()
    while more := {name for name, used in needs.items() if used & (found | late)} - late:
        late |= more
    return late


def _not_on(block: Block, late: set[str], units: UnitSystem) -> None:
    """What is asked cannot rest on what is found."""
    known = dict.fromkeys(late, Quantity(0.0))
    for path, text in _texts(block):
        if path[0] not in ("task", "names") and (used := Parser(plain_text(text[:200]), known, units).names()):
            raise ProblemError(
                "this rests on what the synthesis finds", path=path, found=", ".join(map(quote, used)),
                allowed="parameters that do not",
            )  # fmt: skip


def _refused(error: Infeasible, block: Block, units: UnitSystem) -> ProblemError:
    from tmm_cli.problem.synthesis.limits import shown

    values = shown(error.values, units)
    allowed, then = say(error.nearest, **values), error.then
    while then is not None:
        allowed += f"; and {say(then.nearest, **shown(then.values, units))}"
        then = then.then
    return ProblemError(
        say(error.reason, **values), path=error.path, found=_found(block, error.path), allowed=allowed,
    )  # fmt: skip


def _beside(
    error: Infeasible, block: Block, raw: Mapping[str, object], units: UnitSystem, done: tuple[str, ...] = ()
) -> str:
    """What must change beside a value that is refused: why the task is refused with the value that is told."""
    from tmm_cli.problem.synthesis.limits import shown

    values, key = shown(error.values, units), str(error.path[0]) if len(error.path) == 1 else ""
    listed = isinstance(getattr(block, key, None), list | tuple)
    tries: list[Any] = [values[name] for name in (key, *TOLD) if name in values and not listed]
    if listed and {"x", "y"} <= set(values):
        tries = [[values["x"], values["y"]]]
    both: tuple[str, ...] = ("psi1", "psi2")
    several: dict[str, Any] = {name: values[name] for name in both if "turn" in values and name in values}
    then: list[tuple[Infeasible, Block]] = []
    for text in tries if key not in done and not error.whole and error.then is None else ():
        changed = block.model_copy(update=several or {key: text})
        try:
            with np.errstate(all="ignore"):
                task(block.task).solve(reader(block.task).asked(changed, Bounded(_parts(block, raw, units)[2], units)))
        except ProblemError:
            return ""
        except Infeasible as refusal:
            then.append((refusal, changed))
        else:
            return ""
    if not then or then[0][0].path == error.path:
        return ""
    other, changed = then[0]
    told, name = say(other.nearest, **shown(other.values, units)), str(other.path[0]) if other.path else ""
    named = told.split()[0].rstrip(":") in type(block).model_fields or len(other.path) != 1
    return f"; and {told if named else f'{name}: {told}'}" + _beside(other, changed, raw, units, (*done, key))


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


def _texts(value: Any, path: tuple[str | int, ...] = ()) -> Iterator[tuple[tuple[str | int, ...], str]]:
    """Every text of a block with its place in it."""
    if isinstance(value, str):
        yield path, value
    elif isinstance(value, list | tuple):
        for number, item in enumerate(value):
            yield from _texts(item, (*path, number))
    elif isinstance(value, dict | BaseModel):
        for key, item in value.items() if isinstance(value, dict) else value:
            yield from _texts(item, (*path, key))


def _plain(value: Any) -> Any:
    """A Python float, or a number of more digits as it is."""
    number = np.asarray(value)[()]
    return float(number) if number.dtype == np.float64 else number
