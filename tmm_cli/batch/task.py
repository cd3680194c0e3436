"""Tasks for a group of students: a problem file with the blocks `variants` and `grading`.

`variants` contains the parameters that differ from student to student, `grading` the questions, marks and
tolerances.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import BeforeValidator, Field, model_validator
from pydantic_core import PydanticCustomError

from tmm_cli.batch.traced_arrays import DependsOnData, TracedNumber
from tmm_cli.batch.variant import Variant
from tmm_cli.language import _
from tmm_cli.mechanics.analysis import NamedQuantity, list_quantities
from tmm_cli.mechanics.assembly import analyse_mobile_structure
from tmm_cli.mechanics.numerics import Real
from tmm_cli.mechanics.quantities import NUMBER, Dimension
from tmm_cli.problem import (
    Name,
    Path,
    PhysicalValue,
    Problem,
    ProblemError,
    Strict,
    TaskProblem,
    Tree,
    UnitSystem,
    Value,
    ValueReader,
    VariedUnits,
    apply_settings,
    build_any_problem,
    build_from_shape,
    build_parameters,
    early_parameters,
    evaluate_quantity,
    locate_errors_in,
    plain_value,
    prefix_errors,
    quote,
    translate_errors,
    unknown_name_error,
    validate_planar,
    validate_shape,
)

MOST_VALUES = 10_000  # values per parameter
STEP_TOLERANCE = 1e-9  # of a step: rounding

Two = Annotated[list[Value], Field(min_length=2, max_length=2)]


class Chosen(Strict):
    """Parameter that is chosen from a finite set of values, such as numbers of teeth or a standard series of
    lengths.
    """

    from_: Value | None = Field(default=None, alias="from", description="lower bound of the range of values")
    to: Value | None = Field(default=None, description="upper bound of the range of values")
    step: Value | None = Field(default=None, description="step between neighbouring values")
    among: list[Value] | None = Field(
        default=None, min_length=1, max_length=MOST_VALUES, description="list of values, instead of a range with a step"
    )

    @model_validator(mode="after")
    def _steps_or_values(self) -> Self:
        missing = [value is None for value in (self.from_, self.to, self.step)]
        if any(missing) if self.among is None else not all(missing):
            raise _unreadable()
        return self


def _unreadable() -> PydanticCustomError:
    return PydanticCustomError("range", _("expected [low, high], {from, to, step} or {among: [...]}"))


def _bounds_or_choices(raw: Any) -> Any:
    if not isinstance(raw, list | dict):
        raise _unreadable()
    if isinstance(raw, list) and len(raw) > 2:
        raise PydanticCustomError("range", _("expected two bounds; for a list of values write {among: [...]}"))
    return raw


Range = Annotated[Two | Chosen, BeforeValidator(_bounds_or_choices)]


def bounds_text(low: Any, high: Any) -> str:
    """Write two bounds as text for an error message."""
    return _("{low} and {high}").format(low=low, high=high)


MOST_ANSWERS = 200


def _as_list(raw: object) -> object:
    return [raw] if isinstance(raw, int | str) else raw


class AnswerRule(Strict):
    """Quantity that students must determine, at one or more positions."""

    of: str = Field(
        max_length=40, description="name of the quantity, e.g. v of E, a of S3, omega of 3, R_34, M_b, W, class, H, k"
    )
    at: Annotated[list[int], BeforeValidator(_as_list)] = Field(
        default_factory=list,
        max_length=120,
        description="numbers of positions, as the students count them; omit for H, k, W, class",
    )
    points: Value = Field(default=1, description="marks for each position")
    tolerance: Value | None = Field(
        default=None, description="tolerance, as a fraction of the largest value in the cycle, e.g. 3 %"
    )
    drawn: bool | None = Field(
        default=None, description="true: the answer is measured on a drawing; false: it is computed"
    )


class Grading(Strict):
    """Questions to the students, and rules for marking their answers."""

    answers: list[AnswerRule] = Field(min_length=1, max_length=MOST_ANSWERS)
    count: int = Field(default=0, ge=0, le=1, description="number of the first position on the students' sheets")
    from_: Literal["task", "either"] = Field(
        default="task",
        alias="from",
        description=(
            "position from which the positions are numbered: the first position of the task, or either extreme "
            "position of the output link"
        ),
    )
    drawn: bool = Field(default=True, description="true: answers are measured on drawings; false: they are computed")
    reveal: bool = Field(default=False, description="true: the feedback shows the correct values")


class Blocks(Strict):
    """The blocks `variants` and `grading` of a file."""

    variants: dict[Name, Range] = Field(default_factory=dict, max_length=20)
    grading: Grading | None = None


# Task: a problem file in which some parameters differ from student to student, and the questions to them.


SI = UnitSystem({"length": "m", "angle": "rad", "inertia": "kg*m^2"})
DRAWN_KINEMATICS_TOLERANCE, DRAWN_FORCES_TOLERANCE, COMPUTED_TOLERANCE = (
    0.03,
    0.05,
    0.005,
)  # fractions of the largest value


@dataclass(frozen=True)
class Question:
    """One answer that a student must give: a quantity at a position.

    Attributes:
        quantity: the quantity.
        position: index of the position, from 0; None if the quantity describes the whole mechanism.
        number: number of the position as the students count it.
        points: marks for the answer.
        tolerance: allowed error, as a fraction of the largest value in the cycle.
        drawn: True if the answer is measured on a drawing.
    """

    quantity: NamedQuantity
    position: int | None
    number: int | None
    points: float
    tolerance: float
    drawn: bool

    @property
    def key(self) -> tuple[str, int | None]:
        return self.quantity.name, self.number

    @property
    def name(self) -> str:
        """Name in tables, e.g. `v of E at 7`."""
        name = self.quantity.name
        return (
            name if self.number is None else _("{quantity} at {position}").format(quantity=name, position=self.number)
        )


@dataclass(frozen=True)
class Task:
    """Problem file of a task. All methods may raise ProblemError."""

    tree: Tree

    @cached_property
    def blocks(self) -> Blocks:
        """The blocks `variants` and `grading` of the file."""
        blocks: dict[str, Any] = {key: self.tree.data[key] for key in ("variants", "grading") if key in self.tree.data}
        return validate_shape(Blocks, replace(self.tree, data=blocks))

    @property
    def rules(self) -> Grading:
        """The block `grading` of the file."""
        if self.blocks.grading is None:
            raise ProblemError(
                _("the file has no block `grading`, so there is nothing to grade"),
                path=("grading",),
                allowed="grading: {answers: [{of: H}]}",
            ).located(self.tree.file, self.tree)
        return self.blocks.grading

    def __reduce__(self) -> tuple[type[Task], tuple[Tree]]:
        """Pickle only the file; everything else is computed again in the other process."""
        return Task, (self.tree,)

    def reveal_values(self) -> Task:
        """Return the task with the option `reveal` on: the feedback to students shows the correct values."""
        rules = {**self.tree.data["grading"], "reveal": True}
        return Task(replace(self.tree, data={**self.tree.data, "grading": rules}))

    @cached_property
    def problem(self) -> Problem | TaskProblem:
        """Problem with the parameter values that the file contains, before they are replaced by those of a student."""
        return build_any_problem(self.tree)

    @cached_property
    def units(self) -> UnitSystem:
        return self.problem.units

    @cached_property
    def quantities(self) -> dict[str, NamedQuantity]:
        """All quantities that a question can ask for, by name."""
        whole = self.problem.whole
        with translate_errors(whole):
            return list_quantities(whole.linkage, analyse_mobile_structure(whole.linkage))

    @property
    def positions(self) -> int:
        """Number of positions in the cycle."""
        request = self.problem.whole.request
        return len(request.places) or request.count

    @cached_property
    def asked(self) -> tuple[Question, ...]:
        """Questions to the students, in the order of the file."""
        rules, count = self.rules, self.positions
        values = ValueReader(self._parameters({}), self.units)
        with locate_errors_in(self.tree):
            return tuple(
                question
                for n, rule in enumerate(rules.answers)
                for question in self._questions_of_rule(rule, rules, values, count, ("grading", "answers", n))
            )

    def _questions_of_rule(
        self, rule: AnswerRule, rules: Grading, values: ValueReader, count: int, path: Path
    ) -> list[Question]:
        quantity = self.quantities.get(rule.of)
        if quantity is None:
            one_of_each = {_quantity_kind(name): name for name in reversed(self.quantities)}.values()
            examples = _("e.g. {names}").format(names=", ".join(reversed(one_of_each)))
            raise unknown_name_error(
                rule.of, self.quantities, _("there is no quantity with this name"), examples, path=(*path, "of")
            )
        drawn = rules.drawn if rule.drawn is None else rule.drawn
        drawn = drawn and quantity.against != "exact"
        usual = DRAWN_FORCES_TOLERANCE if quantity.order >= 4 else DRAWN_KINEMATICS_TOLERANCE
        tolerance = usual if drawn else COMPUTED_TOLERANCE
        if rule.tolerance is not None:
            tolerance = values.fraction(rule.tolerance, (*path, "tolerance"))
        points = float(values.positive(rule.points, NUMBER, (*path, "points"), zero=True))
        if quantity.whole == bool(rule.at):
            why = (
                _("{quantity} describes the whole mechanism and has no position; omit `at`")
                if quantity.whole
                else _("{quantity} depends on the position; give its number in `at`")
            )
            raise ProblemError(
                why.format(quantity=rule.of),
                path=(*path, "at"),
                found=quote(rule.at) if rule.at else None,
                allowed=None if quantity.whole else f"at: {rules.count + 3}",
            )
        for k, number in enumerate(rule.at):
            if not rules.count <= number < count + rules.count:
                raise ProblemError(
                    _("there is no position with this number"),
                    path=(*path, "at", k),
                    found=str(number),
                    allowed=_("{first} to {last}").format(first=rules.count, last=count - 1 + rules.count),
                )
        if quantity.whole:
            return [Question(quantity, None, None, points, tolerance, drawn)]
        return [Question(quantity, number - rules.count, number, points, tolerance, drawn) for number in rule.at]

    def _parameters(
        self, replaced: Mapping[str, PhysicalValue], units: UnitSystem | None = None
    ) -> dict[str, PhysicalValue]:
        """Return all parameters; if the file has a synthesis, only those that do not depend on its results."""
        if "synthesis" in self.tree.data:
            return {**early_parameters(self.tree), **replaced}
        raw = self._shape.parameters
        remaining = {name: value for name, value in raw.items() if name not in replaced}
        return {**replaced, **build_parameters(remaining, units or self.units, replaced)}

    @cached_property
    def _shape(self) -> Any:
        return validate_planar(self.tree)

    def values_in_file(self, names: Sequence[str]) -> tuple[PhysicalValue, ...]:
        """Return the values that parameters have in the file."""
        parameters = self._parameters({})
        for name in names:
            if name not in parameters:
                none = None if parameters else _("none, since the file has no block `parameters`")
                raise unknown_name_error(name, parameters, _("no parameter has this name"), none)
        return tuple(parameters[name] for name in names)

    def dimensions(self, names: Sequence[str]) -> tuple[Dimension | None, ...]:
        """Return the dimension of each parameter; None for a plain number."""
        return tuple(value.dimension for value in self.values_in_file(names))

    def number(self, value: PhysicalValue, dimension: Dimension | None) -> float:
        """Convert a value to SI units. A value of a parameter without a dimension is returned unchanged."""
        return self.units.si(value.value, dimension) if dimension and not value.dimension else value.value

    def value(self, text: str) -> PhysicalValue:
        """Read a value from a cell of a table of variants."""
        return evaluate_quantity(text, {}, self.units)

    def make(self, names: Sequence[str], dimensions: Sequence[Dimension | None], numbers: Sequence[Any]) -> Variant:
        """Build the linkage of a variant from the values of its parameters.

        The values are in SI units, or plain numbers for parameters without a dimension; they may be TracedNumbers.
        """
        traced = any(isinstance(x, TracedNumber) for x in numbers)
        if "synthesis" in self.tree.data:
            if traced:
                raise DependsOnData("lengths that a synthesis finds")
            texts = (f"{float(x)!r} {SI.symbol(d) if d else ''}" for x, d in zip(numbers, dimensions, strict=True))
            whole = self.variant(dict(zip(names, texts, strict=True))).whole
            return Variant(whole.linkage, whole.request)
        replaced = {name: PhysicalValue(x, d) for name, d, x in zip(names, dimensions, numbers, strict=True)}
        units = VariedUnits(self.units) if traced else self.units
        with locate_errors_in(self.tree):
            built = build_from_shape(self._shape, self.tree, ValueReader(self._parameters(replaced, units), units))
        return Variant(built.linkage, built.request)

    def variant(self, values: Mapping[str, str]) -> Problem | TaskProblem:
        """Build the problem of one variant.

        values: values of the parameters as text, by name.
        """
        return build_any_problem(apply_settings(self.tree, [f"{name}={value}" for name, value in values.items()]))


def read_task(tree: Tree) -> Task:
    """Read the task of a file and check its blocks.

    Raises:
        ProblemError: a block contains an error.
    """
    task = Task(tree)
    task.blocks  # noqa: B018  refuses what is wrong in them
    return task


def _quantity_kind(name: str) -> tuple[str, bool]:
    """Return the kind of a quantity, e.g. `v` for `v of E`, and True if its name says on which link it acts."""
    kind, _of, thing = name.partition(" of ")
    return ("R" if kind.startswith("R_") else kind), " on " in thing


LEAST_STEPS = 50  # least number of steps between two bounds without a given step
VARY_OPTION = re.compile(r"\s*([^=\s]+)\s*=\s*(.+?)\s*\.\.\s*(.+?)\s*(?::\s*(.+?)\s*)?")
NUMBER_WITH_UNIT = re.compile(r"\s*([-+]?[\d.]+(?:[eE][-+]?\d+)?)\s*(.*?)\s*")


@dataclass(frozen=True)
class FreeParameter:
    """Parameter with its possible values as text. `dimension` is None for a parameter that is a plain number."""

    name: str
    texts: tuple[str, ...]
    dimension: Dimension | None


def with_vary(tree: Tree, vary: Sequence[str]) -> Tree:
    """Return the file with ranges from the option --vary, such as `OA=80..140:5`, in place of its own.

    Raises:
        ProblemError: a range cannot be read.
    """
    block = tree.data.get("variants")
    ranges: dict[str, Any] = dict(block) if isinstance(block, Mapping) else {}
    origins: dict[Path, str] = {}
    for text in vary:
        words = f"--vary {text}"
        match = VARY_OPTION.fullmatch(text)
        if match is None:
            raise ProblemError(
                _("expected a name, two bounds and optionally a step"), allowed="--vary OA=80..140:5", file=words
            )
        name, *ends = match.groups()
        origins["variants", name] = words
        with prefix_errors("variants", name):
            values = [plain_value(end) for end in ends if end is not None]
        ranges[name] = dict(zip(("from", "to", "step"), values, strict=True)) if len(values) == 3 else values
    return replace(tree, data={**tree.data, "variants": ranges}, given={**tree.given, **origins}) if origins else tree


def read_free_parameters(task: Task) -> tuple[FreeParameter, ...]:
    """Read the parameters in the block `variants` and their possible values.

    Raises:
        ProblemError: there are none, or a range is wrong.
    """
    try:
        return _free_parameters(task, task.blocks)
    except ProblemError as error:
        raise error.located(task.tree.file, task.tree) from None


def _free_parameters(task: Task, blocks: Blocks) -> tuple[FreeParameter, ...]:
    ranges = blocks.variants
    if not ranges:
        raise ProblemError(
            _("the task has no parameters that differ between variants"),
            path=("variants",),
            allowed=_("variants: {OA: {from: 80, to: 140, step: 5}}; or --vary OA=80..140:5"),
        )
    parameters = []
    for name, choice in ranges.items():
        with prefix_errors("variants", name):
            (dimension,) = task.dimensions((name,))
            values = (choice.among or [choice.from_, choice.to, choice.step]) if isinstance(choice, Chosen) else choice
            texts = _with_common_unit([str(value) for value in values])
            read = [task.value(text) for text in texts]
            common = next((v.dimension for v in read if v.dimension), dimension)
            if not (isinstance(choice, Chosen) and choice.among):
                texts = _step_texts(task, values, [task.number(value, common) for value in read], common, texts[0])
            parameters.append(FreeParameter(name, tuple(dict.fromkeys(texts)), common))
    return tuple(parameters)


def _with_common_unit(texts: Sequence[str]) -> list[str]:
    """Add the unit of the first number that has one to the numbers without a unit."""
    parts = [NUMBER_WITH_UNIT.fullmatch(text) for text in texts]
    unit = next((number[2] for number in parts if number and number[2]), "")
    return [
        f"{text} {unit}" if unit and number and not number[2] else text
        for text, number in zip(texts, parts, strict=True)
    ]


def _step_texts(
    task: Task, values: Sequence[Any], sizes: Sequence[float], dimension: Dimension | None, first: str
) -> list[str]:
    """Return the values from the lower to the upper bound as text, in the unit of the first bound."""
    low, high = sizes[:2]
    if not low < high:
        raise ProblemError(
            _("the first bound must be smaller than the second"),
            found=bounds_text(*values[:2]),
            allowed=_("[low, high]"),
        )
    written = NUMBER_WITH_UNIT.fullmatch(first)
    unit = written[2] if written else task.units.symbol(dimension) if dimension else ""
    scale = task.number(task.value(f"1 {unit}"), dimension)
    step = sizes[2] if len(sizes) > 2 else 10 ** math.floor(math.log10((high - low) / scale / LEAST_STEPS)) * scale
    count = (high - low) / step + STEP_TOLERANCE if step > 0 else math.inf
    if not 1 <= count < MOST_VALUES:
        raise ProblemError(
            _("the number of steps between the bounds must be from 1 to {most}").format(most=MOST_VALUES - 1),
            path=("step",),
            found=quote(values[2]),
            allowed=_("give another step, or bounds without a step: [low, high]"),
        )
    return [f"{(low + step * k) / scale:.12g} {unit}".strip() for k in range(int(count) + 1)]


def parameter_values(task: Task, choice: FreeParameter) -> Real:
    """Return the possible values of a parameter in SI, or as plain numbers if it has no dimension."""
    return np.array([task.number(task.value(text), choice.dimension) for text in choice.texts])
