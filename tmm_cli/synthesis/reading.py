"""Refusals of a task as they are printed: the reason, and the nearest feasible value of one number that was given."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from decimal import ROUND_CEILING, ROUND_FLOOR, Decimal
from functools import cached_property, partial
from typing import Any, Final

import numpy as np
from pydantic import BaseModel

from tmm_cli.language import N_, _, translated
from tmm_cli.mechanics.numerics import bisect
from tmm_cli.mechanics.quantities import ANGLE, DIMENSIONS, NUMBER, Dimension
from tmm_cli.problem import (
    Parser,
    Path,
    PhysicalValue,
    Problem,
    ProblemError,
    Synthesised,
    TaskProblem,
    Tree,
    UnitSystem,
    ValueReader,
    build_from_shape,
    build_parameters,
    build_problem as build_linkage,
    build_unit_system,
    check_parameter,
    format_path,
    locate_errors_in,
    plain_text,
    prefix_errors,
    quote,
    schema,
    unknown_name_error,
    validate_planar,
    validate_shape,
)
from tmm_cli.synthesis.blocks import BoundedReader, SynthesisFile, TriedFileError, check_block
from tmm_cli.synthesis.record import Infeasible, SynthesisOutcome, refuse_nonfinite
from tmm_cli.synthesis.tasks import block_module, solver_module

DIGITS: Final = 6
GROWING: Final = np.geomspace(1e-3, 1e4, 40)
STEPS: Final = np.concatenate([GROWING, -GROWING])  # changes that are tried, over the given value
SHARES: Final = np.concatenate([np.geomspace(1e-6, 1, 24), -np.geomspace(1e-6, 1, 24)])
SPECIAL_VALUES: Final = {
    NUMBER: (0.0, 1.0),
    ANGLE: (0.0, np.pi / 2),
}  # and places near these, over the distance from them
HALVINGS: Final = 30
INWARDS: Final = 5e-5  # relative: so far from the limit a mechanism is not dead but for rounding
ALONE: Final = 1e-3
NO_NEAREST: Final = N_("another task: no other value of it was found to help")


def refusal_error(error: Infeasible, given: Any, units: UnitSystem, searched: str | None = None) -> ProblemError:
    """The reason, and what could be met: what the task knows of it, else what was searched. given: the file's block."""
    told = error.nearest if isinstance(error.nearest, str) else searched
    if isinstance(error.nearest, tuple):
        value, kind, side = error.nearest
        dimension = DIMENSIONS[kind].dimension
        told = _nearest_message(error.path, round_to_side(units, value, dimension, side), dimension, units)
    for step in error.path:
        inside = isinstance(given, list) or (isinstance(given, dict) and step in given)
        given = given[step] if inside else None
    found = quote(given) if error.path and given is not None else None
    return ProblemError(translated(error.reason), path=error.path, found=found, allowed=told)


def describe_nearest(
    given: Mapping[Path, tuple[float, Dimension]], solved: Callable[[Path, float], bool], units: UnitSystem
) -> str:
    """The nearest feasible value of the first of these numbers (SI) that has one, as it is typed in.

    solved: whether the task is, with another value at a path.
    """
    for path, (value, want) in given.items():
        found = _find_nearest(value, want, partial(solved, path))
        if found is not None:
            number = round_to_side(units, found, want, 1 if found > value else -1)
            if not solved(path, units.si(number, want)):
                number = float(units.from_si(found, want))
            return _nearest_message(path, number, want, units)
    return NO_NEAREST


def _nearest_message(path: Path, number: float, want: Dimension, units: UnitSystem) -> str:
    value = f"{number:.15g} {units.symbol(want)}".rstrip()
    return _("the nearest is {name}: {value}").format(name=format_path(path), value=value)


def _find_nearest(value: float, want: Dimension, solved: Callable[[float], bool]) -> float | None:
    """The feasible value that is nearest to one that is not: changes are tried, the least first, and halved."""
    places = [value + (abs(value) or 1.0) * STEPS]
    places += [fixed + abs(value - fixed) * SHARES for fixed in SPECIAL_VALUES.get(want, (0.0,))]
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


def round_to_side(units: UnitSystem, value: float, dimension: Dimension, side: int) -> float:
    """A limit (SI) in the file's unit with as many digits as are printed, to its larger (1) or smaller (-1) side."""
    exact = Decimal(float(units.from_si(value, dimension)))
    if side == 0 or not exact.is_finite() or exact == 0:
        return float(exact)
    step = Decimal(1).scaleb(exact.adjusted() - DIGITS + 1)
    number = exact.quantize(step, ROUND_CEILING if side > 0 else ROUND_FLOOR)
    while side * (units.si(float(number), dimension) - value) < 0:
        number += side * step
    return float(number)


# The block `synthesis:` of a problem file: checked when the file is loaded, solved when something needs its answer.


Parameters = dict[str, PhysicalValue]
GOLDEN_RATIO = (math.sqrt(5) - 1) / 2  # its multiples are in no simple ratio


def read(tree: Tree) -> TaskProblem:
    """A file with a task and a linkage: all of the block is checked, nothing is solved. Raises ProblemError."""
    if "links" not in tree.data:
        raise ProblemError(
            _("there is no linkage that could use what is found"),
            path=("synthesis",),
            allowed=_("tmm synthesis, or links and a driver"),
            key=True,
        ).located(tree.file, tree)
    file = TaskFile(tree)
    with locate_errors_in(tree):
        if not file.searches:
            file.task  # noqa: B018  refuses what is wrong in it
    shape, name = file.shape, tree.name
    return TaskProblem(
        name,
        shape.title or name,
        file.units,
        shape.description,
        partial(_solved_problem, file),
        partial(_draft_problem, file),
    )


def build_synthesised(tree: Tree) -> Problem:
    """A problem with all its numbers: those that its task finds too, if it has one. Raises ProblemError."""
    return read(tree).whole if "synthesis" in tree.data else build_linkage(tree)


def solve_alone(tree: Tree) -> tuple[str, str, Synthesised, UnitSystem]:
    """Of a file with a task and no linkage: name, title, what was found, units. Raises ProblemError."""
    file, name = TaskFile(tree), tree.name
    with locate_errors_in(tree):
        return name, file.shape.title or name, file.solved(), file.units


def read_task(tree: Tree) -> Any:
    """What the task of a file asks, in SI, without its answer. Raises ProblemError."""
    file = TaskFile(tree)
    with locate_errors_in(tree):
        return file.task


class TaskFile:
    """A file with a task: which of its parameters the task finds, which rest on these, and which it rests on.

    Raises ProblemError, located in the file.
    """

    def __init__(self, tree: Tree, *, extended: bool = False) -> None:
        self.tree = tree
        self.shape = validate_planar(tree) if "links" in tree.data else validate_shape(SynthesisFile, tree)
        self.block = check_block(tree)
        self.searches: bool = getattr(block_module(self.block.task), "SEARCH", False)
        with locate_errors_in(tree):
            self.units = build_unit_system(self.shape.units, extended=extended)
            self.kinds = self._find_kinds()
            self.names = self._find_names()
            raw, found = self.shape.parameters, self.placeholders()
            resting = self._dependent_parameters(set(found))
            self.dependent = {name: raw[name] for name in raw if name in resting}
            self.independent = build_parameters({name: raw[name] for name in raw if name not in resting}, self.units, found)
            self._check_independence()

    def _find_kinds(self) -> dict[str, str]:
        """Names and kinds of what the task finds; they may depend on what is asked."""
        own = getattr(block_module(self.block.task), "parameters", None)
        return dict(solver_module(self.block.task).PARAMETERS if own is None else own(self.block))

    def _find_names(self) -> dict[str, str]:
        """Standard names of what is found, and those that the file gives them."""
        raw, own, task = self.shape.parameters, self.block.names, self.block.task
        for name, other in own.items():
            path = ("synthesis", "names", name)
            if name not in self.kinds:
                nothing = _("the synthesis {task} finds nothing of that name").format(task=task)
                none = None if self.kinds else _("it finds no parameters")
                raise unknown_name_error(name, self.kinds, nothing, none, path=path, key=True)
            check_parameter(other, path, key=False)
        names = {name: own.get(name, name) for name in self.kinds}
        for name, other in names.items():
            first = next(one for one in names if names[one] == other)
            if first != name:
                raise ProblemError(
                    _("{first} and {second} of the synthesis have the same name").format(first=first, second=name),
                    path=("synthesis", "names"),
                    found=quote(other),
                    allowed=_("different names"),
                )
            if other in raw:
                raise ProblemError(
                    _("the parameter {name} is given by hand, and the synthesis {task} finds it (its {own})").format(
                        name=other, task=task, own=name
                    ),
                    path=("parameters", other),
                    found=quote(raw[other]),
                    key=True,
                    allowed=_("one of the two; another name: synthesis: {{names: {{{name}: ...}}}}").format(name=name),
                )
        return names

    def placeholders(self) -> Parameters:
        """Values in place of those to be found, no two in a simple ratio. A search does not tell its kinds before."""
        return {
            name: PhysicalValue(
                1 + k * GOLDEN_RATIO % 1, None if self.searches else DIMENSIONS[self.kinds[own]].dimension
            )
            for k, (own, name) in enumerate(self.names.items())
        }

    def _dependent_parameters(self, found: set[str]) -> set[str]:
        """Parameters given by hand that rest on what is found, at first hand or through others."""
        raw = self.shape.parameters
        known = dict.fromkeys([*raw, *found], PhysicalValue(0.0))
        needs = {
            name: set(Parser(plain_text(source[:200]), known, self.units).names())
            for name, source in raw.items()
            if isinstance(source, str)
        }
        late: set[str] = set()
        while more := {name for name, used in needs.items() if used & (found | late)} - late:
            late |= more
        return late

    def _check_independence(self) -> None:
        """What is asked cannot rest on what is found; a search may ask for something of the linkage with it."""
        known = dict.fromkeys([*self.dependent, *(() if self.searches else self.names.values())], PhysicalValue(0.0))
        for path, text in _iterate_texts(self.block):
            used = Parser(plain_text(text[:200]), known, self.units).names()
            if path[0] not in ("task", "names") and used:
                raise ProblemError(
                    _("this rests on what the synthesis finds"),
                    path=("synthesis", *path),
                    found=", ".join(map(quote, used)),
                    allowed=_("parameters that do not"),
                )

    @cached_property
    def task(self) -> Any:
        """What is asked, in the record of the task."""
        read = block_module(self.block.task).read
        try:
            with prefix_errors("synthesis"):
                if not self.searches:
                    return read(self.block, BoundedReader(self.independent, self.units))
                if "links" not in self.tree.data:
                    raise ProblemError(
                        _("there is no linkage whose parameters could vary"), allowed=_("links and a driver")
                    )
                return read(self.block, ValueReader(self.independent, self.units), self.try_values)
        except Infeasible as error:
            raise self._refusal(error) from None
        except TriedFileError as error:
            raise error.error from None

    def try_values(self, found: Parameters, units: UnitSystem) -> Problem:
        """The linkage with other values of what is to be found, for a search. Raises OfTheFile."""
        try:
            return self.with_values(found, units)
        except ProblemError as error:
            raise TriedFileError(error) from None

    def with_values(self, found: Parameters, units: UnitSystem) -> Problem:
        """The linkage with these values of what is to be found."""
        assert isinstance(self.shape, schema.File)
        known = self.independent | found
        everything = known | build_parameters(self.dependent, units, known)
        return build_from_shape(self.shape, self.tree, ValueReader(everything, units))

    def solved(self) -> Synthesised:
        """What the task finds. Raises ProblemError."""
        task = self.task
        try:
            with prefix_errors("synthesis"), np.errstate(all="ignore"):  # what has no value is refused by `sound`
                outcome = refuse_nonfinite(solver_module(self.block.task).solve(task))
        except Infeasible as error:
            searched = error.nearest is None and error.search and not self.searches
            raise self._refusal(error, self.find_nearest(error.path) if searched else None) from None
        except TriedFileError as error:
            raise error.error from None
        return Synthesised(self.block.task, outcome, self.names)

    def _refusal(self, error: Infeasible, searched: str | None = None) -> ProblemError:
        return refusal_error(error, self.tree.data["synthesis"], self.units, searched).at("synthesis")

    def find_nearest(self, at_fault: Path) -> str:
        """The nearest feasible value of one of the numbers at this path, the last of them first, in words."""
        read, refuse, own = (
            block_module(self.block.task).read,
            solver_module(self.block.task).refuse,
            BoundedReader(self.independent, self.units),
        )
        read(self.block, own)

        def solved(path: Path, value: float) -> bool:
            try:
                refuse(read(self.block, BoundedReader(self.independent, self.units, {path: value})))
            except (ProblemError, Infeasible):
                return False
            return True

        given = {path: own.given[path] for path in reversed(own.given) if path[: len(at_fault)] == at_fault}
        with np.errstate(all="ignore"):
            return describe_nearest(given, solved, self.units)

    def values(self, outcome: SynthesisOutcome) -> Parameters:
        """The parameters that were found, under the names that the file gives them."""
        return {
            self.names[name]: PhysicalValue(_plain_number(value.value), DIMENSIONS[value.kind].dimension)
            for name, value in outcome.parameters.items()
            if name in self.names
        }


def _solved_problem(file: TaskFile) -> Problem:
    """The problem with what its task finds."""
    with locate_errors_in(file.tree):
        return _with_solution(file, file.solved())


def _with_solution(file: TaskFile, synthesised: Synthesised) -> Problem:
    problem = file.with_values(file.values(synthesised.outcome), file.units)
    sketch = synthesised.outcome.sketch or problem.linkage.sketch
    return replace(
        problem,
        linkage=replace(problem.linkage, sketch=sketch),
        synthesis=synthesised,
        extended=partial(_extended_problem, file.tree, synthesised),
    )


def _extended_problem(tree: Tree, synthesised: Synthesised) -> Problem:
    """The same with the decimals of the file as double-doubles; what the task found stays as it is."""
    file = TaskFile(tree, extended=True)
    with locate_errors_in(tree):
        return _with_solution(file, synthesised)


def _draft_problem(file: TaskFile) -> Problem | None:
    """Links and pairs with other numbers for what is to be found; None where the file refuses these."""
    try:
        return file.with_values(file.placeholders(), file.units)
    except ProblemError:
        return None


def _iterate_texts(value: Any, path: Path = ()) -> Iterator[tuple[Path, str]]:
    """Every text of a block with its place in it."""
    if isinstance(value, str):
        yield path, value
    elif isinstance(value, list | tuple):
        for number, item in enumerate(value):
            yield from _iterate_texts(item, (*path, number))
    elif isinstance(value, dict | BaseModel):
        for key, item in value.items() if isinstance(value, dict) else value:
            yield from _iterate_texts(item, (*path, key))


def _plain_number(value: Any) -> Any:
    """A Python float, or a number of more digits as it is."""
    number = np.asarray(value)[()]
    return float(number) if number.dtype == np.float64 else number
