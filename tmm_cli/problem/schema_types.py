"""Types of the fields in the models of a problem file: names, values with units, positions on a link."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, WithJsonSchema
from pydantic_core import PydanticCustomError

MAX_LINKS = 100
MAX_POSITIONS = 100_000


def checked_value(raw: Any) -> Any:
    """Validate a number, or a text that may be an expression."""
    if isinstance(raw, bool) or not isinstance(raw, int | float | str):
        raise PydanticCustomError("value", "expected a number, a number with a unit, or an expression with parameters")
    return raw


def checked_name(raw: Any) -> str:
    """Validate a name and return it as text; whole numbers may be names."""
    if isinstance(raw, int) and not isinstance(raw, bool):
        return str(raw)
    if not isinstance(raw, str) or not raw.strip():
        raise PydanticCustomError("name", "expected a name")
    if len(raw) > 40:
        raise PydanticCustomError("name", "a name can have at most 40 characters")
    return raw


def checked_vector(raw: Any) -> Any:
    """Validate a list of two coordinates."""
    if not isinstance(raw, list) or len(raw) != 2:
        raise PydanticCustomError("vector", "expected two coordinates [x, y]")
    return [checked_value(item) for item in raw]


VALUE = {"anyOf": [{"type": "number"}, {"type": "string"}]}
Value = Annotated[Any, BeforeValidator(checked_value), WithJsonSchema(VALUE)]
NAMES = [{"type": "string"}, {"type": "integer"}]
Name = Annotated[str, BeforeValidator(checked_name), WithJsonSchema({"anyOf": NAMES})]
Vector = Annotated[
    Any,
    BeforeValidator(checked_vector),
    WithJsonSchema({"type": "array", "items": VALUE, "minItems": 2, "maxItems": 2}),
]


class Strict(BaseModel):
    """Base class of all models of a file; it refuses unknown keys."""

    # built when it first validates: a model that is part of another needs no validator of its own
    model_config = ConfigDict(
        extra="forbid",
        frozen=True,
        populate_by_name=True,
        defer_build=True,
        model_title_generator=lambda model: model.__name__.removesuffix("Keys"),
    )


class FileHead(Strict):
    """Keys that every problem file may have."""

    tmm: Literal[1] = Field(description="version of the file format: write tmm: 1")
    lang: Literal["en", "ru", "sr"] = Field(default="en", description="language of drawings, tables and messages")
    title: str = Field(default="", max_length=200)
    description: str = Field(default="", max_length=4000)


class OnLine(Strict):
    """A position on the line through two points of the link.

    `at` is 0 at the first point and 1 at the second, or a distance from the first; `side` is the offset from the line.
    """

    on: Name = Field(description="two points of the link, written together: CD (or C-D)")
    at: Value = Field(
        default=0.5,
        description=(
            "position between the two points, as a fraction of their distance (0.5 or 50 %) or as a distance "
            "from the first (110 mm)"
        ),
    )
    side: Value = Field(default=0, description="distance to the left of the line")


def _checked_place(raw: Any) -> Any:
    if isinstance(raw, str):
        return checked_name(raw)
    return OnLine.model_validate(raw) if isinstance(raw, dict) else checked_vector(raw)


Place = Annotated[str | list[Any] | OnLine, BeforeValidator(_checked_place)]
