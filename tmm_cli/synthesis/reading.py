"""The block `synthesis:` of a problem file.

It is read and checked when the file is loaded, and solved when its solution is needed. An error message for a task
without solution includes the nearest feasible value.
"""

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
from tmm_cli.synthesis.nearest_assembly import OTHER_SKETCH, find_nearest_assembly
from tmm_cli.synthesis.record import Infeasible, SynthesisOutcome, refuse_nonfinite
from tmm_cli.synthesis.tasks import block_module, solver_module

DIGITS: Final = 6
GROWING: Final = np.geomspace(1e-3, 1e4, 40)
STEPS: Final = np.concatenate([GROWING, -GROWING])  # relative changes to try
SHARES: Final = np.concatenate([np.geomspace(1e-6, 1, 24), -np.geomspace(1e-6, 1, 24)])
SPECIAL_VALUES: Final = {
    NUMBER: (0.0, 1.0),
    ANGLE: (0.0, np.pi / 2),
}  # values near which to try, by relative distance
HALVINGS: Final = 30
INWARDS: Final = 5e-5  # relative: at this distance from the limit the mechanism is reliably not in a dead position
ALONE: Final = 1e-3
NO_NEAREST: Final = N_("other input data; changing this value alone does not help")


def refusal_error(error: Infeasible, entry: Any, units: UnitSystem, searched: str | None = None) -> ProblemError:
    """Convert the error for a task without solution to the error that is printed.

    It contains the reason and the nearest feasible value.

    Args:
        error: error raised by the task.
        entry: block `synthesis:` of the file.
        units: units of the file.
        searched: nearest feasible value from a search, as text; used if `error` itself contains none.
    """
    nearest_text = error.nearest if isinstance(error.nearest, str) else searched
    if isinstance(error.nearest, tuple):
        value, kind, side = error.nearest
        dimension = DIMENSIONS[kind].dimension
        nearest_text = _format_nearest(error.path, round_to_side(units, value, dimension, side), dimension, units)
    for step in error.path:
        inside = isinstance(entry, list) or (isinstance(entry, dict) and step in entry)
        entry = entry[step] if inside else None
    quoted = quote(entry) if error.path and entry is not None else None
    return ProblemError(translated(error.reason), path=error.path, found=quoted, allowed=nearest_text)


def describe_nearest(
    given_numbers: Mapping[Path, tuple[float, Dimension]], solved: Callable[[Path, float], bool], units: UnitSystem
) -> str:
    """Describe the nearest feasible value of a number, in the units of the file.

    The numbers are tried in their order; the first one for which a feasible value exists is described.

    Args:
        given_numbers: value (SI) and dimension of each number, by path.
        solved: function that returns True if the task has a solution with another value at a path.
        units: units of the file.
    """
    for path, (value, want) in given_numbers.items():
        feasible = _find_nearest(value, want, partial(solved, path))
        if feasible is not None:
            number = round_to_side(units, feasible, want, 1 if feasible > value else -1)
            if not solved(path, units.si(number, want)):
                number = float(units.from_si(feasible, want))
            return _format_nearest(path, number, want, units)
    return NO_NEAREST


def _format_nearest(path: Path, number: float, want: Dimension, units: UnitSystem) -> str:
    value = f"{number:.15g} {units.symbol(want)}".rstrip()
    return _("nearest feasible value: {name}: {value}").format(name=format_path(path), value=value)


def _find_nearest(value: float, want: Dimension, solved: Callable[[float], bool]) -> float | None:
    """Find the feasible value nearest to an infeasible one; None if none is found.

    Increasingly distant values are tried, then the limit is found by bisection.
    """
    trials = [value + (abs(value) or 1.0) * STEPS]
    trials += [fixed + abs(value - fixed) * SHARES for fixed in SPECIAL_VALUES.get(want, (0.0,))]
    reach = 2 * np.pi if want == ANGLE else np.inf
    last = {-1.0: np.array(value), 1.0: np.array(value)}
    for trial in sorted(np.concatenate(trials).tolist(), key=lambda trial: abs(trial - value)):
        side = 1.0 if trial > value else -1.0
        if abs(trial - value) <= reach and solved(trial):
            edge = float(bisect(lambda x: np.asarray(solved(float(x))), np.array(trial), last[side], HALVINGS)[0])
            if abs(edge - value) < ALONE * abs(trial - value):  # only the given value itself is infeasible
                return float(trial)
            inside = edge + side * INWARDS * min(abs(edge), abs(edge - value))
            return inside if solved(inside) else edge
        last[side] = np.array(trial)
    return None


def round_to_side(units: UnitSystem, value: float, dimension: Dimension, side: int) -> float:
    """Round a limit to the number of printed digits, in the unit of the file.

    Args:
        units: units of the file.
        value: limit (SI).
        dimension: dimension of the value.
        side: 1 to round up, -1 to round down, 0 to leave the value unrounded.

    Returns:
        The rounded limit in the unit of the file.
    """
    exact = Decimal(float(units.from_si(value, dimension)))
    if side == 0 or not exact.is_finite() or exact == 0:
        return float(exact)
    step = Decimal(1).scaleb(exact.adjusted() - DIGITS + 1)
    number = exact.quantize(step, ROUND_CEILING if side > 0 else ROUND_FLOOR)
    while side * (units.si(float(number), dimension) - value) < 0:
        number += side * step
    return float(number)


# The block `synthesis:` of a problem file: checked when the file is loaded, solved when its solution is needed.


Parameters = dict[str, PhysicalValue]
GOLDEN_RATIO = (math.sqrt(5) - 1) / 2  # fractional parts of its multiples are in no simple ratio


def read(tree: Tree) -> TaskProblem:
    """Read a file with a synthesis task and a linkage. The block is checked but not solved. Raises ProblemError."""
    if "links" not in tree.data:
        raise ProblemError(
            _("the file has no linkage that could use the dimensions found by the synthesis"),
            path=("synthesis",),
            allowed=_("the command tmm synthesis; or links and driver in the file"),
            key=True,
        ).located(tree.file, tree)
    file = TaskFile(tree)
    with locate_errors_in(tree):
        if not file.searches:
            file.task  # noqa: B018  raises its errors
    shape, name = file.shape, tree.name
    return TaskProblem(
        name,
        shape.title or name,
        file.units,
        shape.description,
        partial(_build_solved_problem, file),
        partial(_build_draft_problem, file),
    )


def build_synthesised(tree: Tree) -> Problem:
    """Build the problem of a file. If it has a synthesis task, solve it and use its dimensions. Raises ProblemError."""
    return read(tree).whole if "synthesis" in tree.data else build_linkage(tree)


def solve_alone(tree: Tree) -> tuple[str, str, Synthesised, UnitSystem]:
    """Solve the synthesis task of a file without a linkage.

    Returns:
        Name and title of the problem, solution of the task, units of the file.

    Raises:
        ProblemError: the file is invalid, or the task has no solution.
    """
    file, name = TaskFile(tree), tree.name
    with locate_errors_in(tree):
        return name, file.shape.title or name, file.solve(), file.units


def read_task(tree: Tree) -> Any:
    """Return the synthesis task of a file, in SI and radians, without solving it. Raises ProblemError."""
    file = TaskFile(tree)
    with locate_errors_in(tree):
        return file.task


class TaskFile:
    """A problem file with a synthesis task.

    Attributes:
        tree: parsed file.
        shape: validated keys of the file.
        block: validated keys of the task.
        searches: True for an optimal synthesis, which builds the problem with many trial values.
        units: units of the file.
        kinds: kind of each parameter that the task determines, by its standard name.
        names: names of these parameters in the file, by their standard names.
        dependent: expressions of the parameters that depend on the solution, by name.
        independent: values of the other parameters, with placeholders for the solution, by name.

    Raises:
        ProblemError: the file is invalid; the error contains the location in the file.
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
            raw, placeholders = self.shape.parameters, self.placeholders()
            resting = self._dependent_parameters(set(placeholders))
            self.dependent = {name: raw[name] for name in raw if name in resting}
            self.independent = build_parameters(
                {name: raw[name] for name in raw if name not in resting}, self.units, placeholders
            )
            self._check_independence()

    def _find_kinds(self) -> dict[str, str]:
        """Return the kind of each parameter that the task determines, by its standard name."""
        own_parameters = getattr(block_module(self.block.task), "parameters", None)
        return dict(solver_module(self.block.task).PARAMETERS if own_parameters is None else own_parameters(self.block))

    def _find_names(self) -> dict[str, str]:
        """Return the names in the file of the parameters that the task determines, by their standard names.

        Raises ProblemError.
        """
        raw, aliases, task = self.shape.parameters, self.block.names, self.block.task
        for name, other in aliases.items():
            path = ("synthesis", "names", name)
            if name not in self.kinds:
                nothing = _("the synthesis {task} finds no parameter with this name").format(task=task)
                none = None if self.kinds else _("this synthesis finds no parameters")
                raise unknown_name_error(name, self.kinds, nothing, none, path=path, key=True)
            check_parameter(other, path, key=False)
        names = {name: aliases.get(name, name) for name in self.kinds}
        for name, other in names.items():
            first = next(candidate for candidate in names if names[candidate] == other)
            if first != name:
                raise ProblemError(
                    _(
                        "the parameters {first} and {second} that the synthesis finds have the same name in the file"
                    ).format(first=first, second=name),
                    path=("synthesis", "names"),
                    found=quote(other),
                    allowed=_("different names"),
                )
            if other in raw:
                raise ProblemError(
                    _(
                        "parameter {name} is given, although the synthesis {task} finds it (under the name {own})"
                    ).format(name=other, task=task, own=name),
                    path=("parameters", other),
                    found=quote(raw[other]),
                    key=True,
                    allowed=_("only one of the two; or another name: synthesis: {{names: {{{name}: ...}}}}").format(
                        name=name
                    ),
                )
        return names

    def placeholders(self) -> Parameters:
        """Return placeholder values for the parameters that the task determines.

        No two of them are in a simple ratio, so that no special case arises by chance. For an optimal synthesis they
        have no dimension, because the dimensions are not known before the ranges are read.
        """
        return {
            name: PhysicalValue(
                1 + k * GOLDEN_RATIO % 1, None if self.searches else DIMENSIONS[self.kinds[standard_name]].dimension
            )
            for k, (standard_name, name) in enumerate(self.names.items())
        }

    def _dependent_parameters(self, found_names: set[str]) -> set[str]:
        """Return the names of the given parameters that depend on the solution, directly or through others."""
        raw = self.shape.parameters
        dummies = dict.fromkeys([*raw, *found_names], PhysicalValue(0.0))
        needs = {
            name: set(Parser(plain_text(source[:200]), dummies, self.units).names())
            for name, source in raw.items()
            if isinstance(source, str)
        }
        late: set[str] = set()
        while more := {name for name, used in needs.items() if used & (found_names | late)} - late:
            late |= more
        return late

    def _check_independence(self) -> None:
        """Raise ProblemError if the task depends on its own solution. An optimal synthesis may use the parameters it
        varies.
        """
        dummies = dict.fromkeys([*self.dependent, *(() if self.searches else self.names.values())], PhysicalValue(0.0))
        for path, text in _iterate_texts(self.block):
            used = Parser(plain_text(text[:200]), dummies, self.units).names()
            if path[0] not in ("task", "names") and used:
                raise ProblemError(
                    _("the task depends on parameters that the synthesis itself finds"),
                    path=("synthesis", *path),
                    found=", ".join(map(quote, used)),
                    allowed=_("parameters that do not depend on the results of the synthesis"),
                )

    @cached_property
    def task(self) -> Any:
        """The task as a record in SI and radians."""
        read = block_module(self.block.task).read
        try:
            with prefix_errors("synthesis"):
                if not self.searches:
                    return read(self.block, BoundedReader(self.independent, self.units))
                if "links" not in self.tree.data:
                    raise ProblemError(
                        _("the file has no linkage whose parameters could be varied"), allowed=_("links and a driver")
                    )
                return read(self.block, ValueReader(self.independent, self.units), self.try_values)
        except Infeasible as error:
            raise self._refusal(error) from None
        except TriedFileError as error:
            raise error.error from None

    def try_values(self, trial_values: Parameters, units: UnitSystem) -> Problem:
        """Build the problem with trial values of the parameters of an optimal synthesis. Raises TriedFileError."""
        try:
            return self.with_values(trial_values, units)
        except ProblemError as error:
            raise TriedFileError(error) from None

    def with_values(self, found_values: Parameters, units: UnitSystem) -> Problem:
        """Build the problem with these values of the parameters that the task determines."""
        assert isinstance(self.shape, schema.File)
        known_values = self.independent | found_values
        everything = known_values | build_parameters(self.dependent, units, known_values)
        return build_from_shape(self.shape, self.tree, ValueReader(everything, units))

    def solve(self) -> Synthesised:
        """Solve the task. Raises ProblemError."""
        task = self.task
        try:
            with prefix_errors("synthesis"), np.errstate(all="ignore"):  # `refuse_nonfinite` handles undefined values
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
        """Describe the nearest feasible value of a number of the task, in the units of the file.

        at_fault: path of a key. The numbers under this key are tried from the last to the first.
        """
        read, refuse, reader = (
            block_module(self.block.task).read,
            solver_module(self.block.task).refuse,
            BoundedReader(self.independent, self.units),
        )
        read(self.block, reader)

        def solved(path: Path, value: float) -> bool:
            try:
                refuse(read(self.block, BoundedReader(self.independent, self.units, {path: value})))
            except (ProblemError, Infeasible):
                return False
            return True

        given_numbers = {
            path: reader.given[path] for path in reversed(reader.given) if path[: len(at_fault)] == at_fault
        }
        with np.errstate(all="ignore"):
            return describe_nearest(given_numbers, solved, self.units)

    def values(self, outcome: SynthesisOutcome) -> Parameters:
        """Return the values of the parameters that the task determines, by their names in the file."""
        return {
            self.names[name]: PhysicalValue(_to_plain_number(value.value), DIMENSIONS[value.kind].dimension)
            for name, value in outcome.parameters.items()
            if name in self.names
        }


def _build_solved_problem(file: TaskFile) -> Problem:
    with locate_errors_in(file.tree):
        synthesised = file.solve()
        problem = _insert_solution(file, synthesised)
        if synthesised.outcome.sketch is not None or (moved := find_nearest_assembly(problem.linkage)) is None:
            return problem
        outcome = synthesised.outcome
        outcome = replace(outcome, sketch=moved, notes=(*outcome.notes, OTHER_SKETCH))
        return _insert_solution(file, replace(synthesised, outcome=outcome))


def _insert_solution(file: TaskFile, synthesised: Synthesised) -> Problem:
    problem = file.with_values(file.values(synthesised.outcome), file.units)
    sketch = synthesised.outcome.sketch or problem.linkage.sketch
    return replace(
        problem,
        linkage=replace(problem.linkage, sketch=sketch),
        synthesis=synthesised,
        extended=partial(_build_extended_problem, file.tree, synthesised),
    )


def _build_extended_problem(tree: Tree, synthesised: Synthesised) -> Problem:
    """Build the problem with double-double numbers. The solution of the task is not recomputed."""
    file = TaskFile(tree, extended=True)
    with locate_errors_in(tree):
        return _insert_solution(file, synthesised)


def _build_draft_problem(file: TaskFile) -> Problem | None:
    """Build the problem with placeholders instead of the solution; None if the file is invalid with these values."""
    try:
        return file.with_values(file.placeholders(), file.units)
    except ProblemError:
        return None


def _iterate_texts(value: Any, path: Path = ()) -> Iterator[tuple[Path, str]]:
    """Yield every text of a block with its path."""
    if isinstance(value, str):
        yield path, value
    elif isinstance(value, list | tuple):
        for number, item in enumerate(value):
            yield from _iterate_texts(item, (*path, number))
    elif isinstance(value, dict | BaseModel):
        for key, item in value.items() if isinstance(value, dict) else value:
            yield from _iterate_texts(item, (*path, key))


def _to_plain_number(value: Any) -> Any:
    """Convert a value to a Python float; a number of higher precision is returned unchanged."""
    number = np.asarray(value)[()]
    return float(number) if number.dtype == np.float64 else number
