"""The block `synthesis:` of a problem file: shape and sense, one file a task (see tmm_cli.synthesis).

A task's file has `Shape(Block)`, its keys, and `asked(shape, sense)`, which makes the task's record of them; and
`parameters(shape)`, kinds by name, where what is found depends on what is asked.
"""

from __future__ import annotations

from importlib import import_module
from typing import Annotated, Any, Literal, get_args, get_origin

from pydantic import BaseModel, BeforeValidator, Field, WithJsonSchema, create_model
from pydantic_core import PydanticCustomError

from tmm_cli.problem.schema import VALUE, Name, Strict, Value, checked_value
from tmm_cli.synthesis import TASKS


def _range(found: Any) -> Any:
    if not isinstance(found, list) or len(found) != 2:
        raise PydanticCustomError("range", "two numbers [from, to] are wanted")
    return [checked_value(item) for item in found]


Range = Annotated[
    Any, BeforeValidator(_range), WithJsonSchema({"type": "array", "items": VALUE, "minItems": 2, "maxItems": 2})
]


class Block(Strict):
    """What all tasks have. names: other names of the parameters that are found."""

    task: str = Field(description="one of: " + ", ".join(TASKS))
    names: dict[Name, Name] = Field(
        default_factory=dict, max_length=50, description="other names for what is found, {r: OA, l: AB}"
    )


def _named() -> type[BaseModel]:
    kind: Any = Literal[tuple(TASKS)]
    return create_model("Task", task=(kind, ...))


def reader(task: str) -> Any:
    """The module of a task's shape; only that of the file's own task is imported."""
    return import_module(f"{__name__}.{TASKS[task]}")


def shaped(found: Any) -> Block:
    """The block in the shape of its task."""
    if not isinstance(found, dict):
        raise PydanticCustomError("dict_type", "keys with values are wanted")
    if not _known(found.get("task")):
        _named().model_validate({"task": found["task"]} if "task" in found else {})
    block: Block = reader(found["task"]).Shape.model_validate(found)
    return block


def _known(name: Any) -> bool:
    """Whether it is a task's name; a list or a block has no place among names."""
    return isinstance(name, str) and name in TASKS


class SynthesisFile(Strict):
    """A problem file without a linkage, for `tmm synthesis` alone."""

    tmm: Literal[1] = Field(description="version of this format")
    title: str = Field(default="", max_length=200)
    description: str = Field(default="", max_length=4000)
    units: dict[str, str] = Field(default_factory=dict)
    parameters: dict[Name, Value] = Field(default_factory=dict, max_length=500)
    synthesis: Annotated[Any, BeforeValidator(shaped)]


def model(block: Any, path: tuple[str | int, ...]) -> type[BaseModel] | None:
    """The model at a path inside the block, for messages."""
    task = block.get("task") if isinstance(block, dict) else None
    here: type[BaseModel] | None = reader(str(task)).Shape if _known(task) else Block
    named = False  # whether the next key is one of the user's own names
    for step in path:
        if isinstance(step, int) or here is None or named:
            named = False
            continue
        field = here.model_fields.get(step)
        here = None if field is None else _inner(field.annotation)
        named = field is not None and get_origin(field.annotation) is dict
    return here


def _inner(annotation: Any) -> type[BaseModel] | None:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return annotation
    return next((found for part in get_args(annotation) if (found := _inner(part)) is not None), None)
