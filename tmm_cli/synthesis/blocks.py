"""Keys and value limits that the `synthesis:` blocks of all tasks share. The tasks are listed in tasks.py."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Final, Literal

from pydantic import BaseModel, BeforeValidator, Field, ValidationError, WithJsonSchema
from pydantic_core import PydanticCustomError

from tmm_cli.language import N_, _, translated
from tmm_cli.mechanics.quantities import ANGLE, ANGULAR_SPEED, DIMENSIONS, LENGTH, NUMBER, SPEED, Dimension
from tmm_cli.problem import (
    VALUE,
    FileHead,
    Name,
    Path,
    PhysicalValue,
    ProblemError,
    Strict,
    Tree,
    UnitSystem,
    Value,
    ValueReader,
    checked_value,
    shape_error,
)
from tmm_cli.synthesis.record import SMALLEST, Kind
from tmm_cli.synthesis.tasks import TASKS, block_module


def _check_range(bounds: Any) -> Any:
    if not isinstance(bounds, list) or len(bounds) != 2:
        raise PydanticCustomError("range", "expected two numbers [from, to]")
    return [checked_value(item) for item in bounds]


Range = Annotated[
    Any, BeforeValidator(_check_range), WithJsonSchema({"type": "array", "items": VALUE, "minItems": 2, "maxItems": 2})
]


class TaskBlock(Strict):
    """Keys that every task has.

    Attributes:
        task: name of the task.
        names: names in the file for the parameters that the task determines, by their standard names.
    """

    task: str = Field(description="one of: " + ", ".join(TASKS))
    names: dict[Name, Name] = Field(
        default_factory=dict,
        max_length=50,
        description="names in the file for the parameters that the synthesis finds, e.g. {r: OA, l: AB}",
    )


UNDETERMINED: Final = N_("these keys do not determine a mechanism")


def choose_key_set(
    block: TaskBlock, sets: Sequence[tuple[str, ...]], others: Sequence[str] = (), refusal: str = UNDETERMINED
) -> tuple[str, ...]:
    """Return that one of several sets of keys which a block contains.

    Args:
        block: block of a problem file.
        sets: allowed sets of keys.
        others: keys that may not be given.
        refusal: message if no set fits.

    Raises:
        ProblemError: the given keys match none of the sets; the message lists missing or surplus keys.
    """
    keys = dict.fromkeys([*(key for key_set in sets for key in key_set), *others])
    present = tuple(key for key in keys if getattr(block, key) is not None)
    for key_set in sets:
        if set(key_set) == set(present):
            return key_set
    missing = [
        tuple(key for key in key_set if key not in present)
        for key_set in sets
        if present and set(present) < set(key_set)
    ]
    surplus = [
        tuple(key for key in present if key not in key_set)
        for key_set in sets
        if key_set and set(key_set) < set(present)
    ]
    remedy = ""
    if missing:
        remedy = _("; missing: {keys}").format(keys=_join_alternatives(missing))
    elif surplus:
        remedy = _("; remove: {keys}").format(keys=_join_alternatives(surplus))
    raise ProblemError(
        translated(refusal) + remedy,
        found=", ".join(present) or _("none of these keys"),
        allowed=_("; or ").join(_(" and ").join(key_set) or _("nothing") for key_set in sets),
        key=True,
    )


def _join_alternatives(sets: Sequence[tuple[str, ...]]) -> str:
    return _(" or ").join(dict.fromkeys(_(" and ").join(keys) for keys in sets))


def read_numbers(block: TaskBlock, values: ValueReader, quantities: Mapping[str, tuple[Kind, str]]) -> dict[str, Any]:
    """Return those of the listed quantities that a block gives, in SI, by key. Raises ProblemError.

    Args:
        block: block of a problem file.
        values: reader of numbers with units.
        quantities: kind and description of each quantity, by key.
    """
    raw_values = {key: value for key in quantities if (value := getattr(block, key)) is not None}
    return {
        key: values.number(value, DIMENSIONS[quantities[key][0]].dimension, (key,)) for key, value in raw_values.items()
    }


class TriedFileError(Exception):
    """Raised if the rest of the problem file is invalid with the parameter values that the synthesis tries."""

    def __init__(self, error: ProblemError) -> None:
        super().__init__(str(error))
        self.error = error


class SynthesisFile(FileHead):
    """A problem file without a linkage, for the command `tmm synthesis`."""

    units: dict[str, str] = Field(default_factory=dict)
    parameters: dict[Name, Value] = Field(default_factory=dict, max_length=500)
    synthesis: dict[str, Any]


class TaskName(BaseModel):
    """Model with the key `task` alone, by which an unknown task is reported before other keys are checked."""

    task: Literal[tuple(TASKS)]  # type: ignore[valid-type]


def check_block(tree: Tree) -> TaskBlock:
    """Validate the block `synthesis:` of a file against the keys of its task. Raises ProblemError.

    Only the module of this task is imported.
    """
    block_data, block_class = tree.data["synthesis"], TaskBlock
    try:
        if (
            not isinstance(block_data, dict)
            or not isinstance(block_data.get("task"), str)
            or block_data["task"] not in TASKS
        ):
            TaskName.model_validate(block_data)
        block_class = block_module(block_data["task"]).BLOCK
        model: TaskBlock = block_class.model_validate(block_data)
    except ValidationError as error:
        raise shape_error(error, tree, block_class, ("synthesis",)) from None
    return model


# Limits of the values of a task: beyond them numbers overflow and solutions are meaningless.


LARGEST_VALUES: Final = {LENGTH: 1e6, NUMBER: 1e6, SPEED: 1e6, ANGULAR_SPEED: 1e6, ANGLE: 1e3}  # SI, rad
# sizes must be at least SMALLEST; coordinates, offsets and angles may be arbitrarily close to zero
# k is checked by its task, which knows its limits
SIZE_DIMENSIONS: Final = (LENGTH, SPEED, ANGULAR_SPEED)
RATIO_KEYS: Final = ("ratio", "frame_ratio", "rod_ratio", "pressure")
COORDINATE_KEYS: Final = ("e", "xA", "yA")
FUNCTION_KEYS: Final = ("table", "x")  # values of a function, not of a mechanism


class BoundedReader(ValueReader):
    """Reader of numbers that rejects dimensions which no mechanism can have.

    Attributes:
        others: trial values (SI) used in place of those of the file, by path.
        given: values read so far (SI) and their dimensions, by path.
    """

    def __init__(
        self, parameters: Mapping[str, PhysicalValue], units: UnitSystem, others: Mapping[Path, float] | None = None
    ) -> None:
        super().__init__(parameters, units)
        self.others = others or {}
        self.given: dict[Path, tuple[float, Dimension]] = {}

    def read_si(self, value: Any, want: Dimension, path: Path) -> float:
        return self.others[path] if path in self.others else super().read_si(value, want, path)

    def limit(self, want: Dimension, path: Path) -> float:
        limit = super().limit(want, path)
        return limit if _is_exempt(path) else LARGEST_VALUES.get(want, limit)

    def number(self, value: Any, want: Dimension, path: Path) -> float:
        """Return a value in SI. Raises ProblemError if no mechanism can have such a value."""
        number = super().number(value, want, path)
        self.given[path] = number, want
        key = path[-1] if path else ""
        sized = isinstance(key, str) and key not in COORDINATE_KEYS and (want in SIZE_DIMENSIONS or key in RATIO_KEYS)
        if not sized or _is_exempt(path) or number >= SMALLEST:
            return number
        raise self.too_small(value, SMALLEST, want, path)


def _is_exempt(path: Path) -> bool:
    return bool(path) and (path[-1] == "k" or path[0] in FUNCTION_KEYS)
