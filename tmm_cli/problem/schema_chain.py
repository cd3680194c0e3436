"""The shape of a problem file that gives a chain in space by its pairs alone."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, WithJsonSchema
from pydantic_core import PydanticCustomError

from tmm_cli.problem.schema import MAX_LINKS, Name, Strict, _name

MAX_PAIRS = 300
MAX_MOBILITY = 6 * MAX_LINKS
_NAME = {"anyOf": [{"type": "string"}, {"type": "integer"}]}

Kind = Literal[
    "turning", "sliding", "screw", "cylindrical", "spherical with a pin", "universal", "spherical", "planar",
    "sphere in cylinder", "cylinder on plane", "sphere on plane",
]  # fmt: skip


def _two(found: Any) -> list[str]:
    if not isinstance(found, list) or len(found) != 2:
        raise PydanticCustomError("two", "two links [1, 2] are wanted")
    return [_name(item) for item in found]


def _links(found: Any) -> int | list[str]:
    if isinstance(found, list):
        if not 1 <= len(found) <= MAX_LINKS:
            raise PydanticCustomError("links", f"1 to {MAX_LINKS} links are wanted")
        return [_name(item) for item in found]
    return _whole(found, 1, MAX_LINKS, "how many links there are, or a list of their names")


def _local(found: Any) -> int | dict[str, int]:
    if isinstance(found, dict):
        return {_name(link): _whole(many, 0, MAX_MOBILITY, "a number of freedoms") for link, many in found.items()}
    return _whole(found, 0, MAX_MOBILITY, "a number of freedoms, or links with theirs")


def _whole(found: Any, least: int, most: int, what: str) -> int:
    if isinstance(found, bool) or not isinstance(found, int) or not least <= found <= most:
        raise PydanticCustomError("whole", f"{what}: a whole number from {least} to {most} is wanted")
    return found


class SpatialPair(Strict):
    """A pair of two links."""

    between: Annotated[
        Any, BeforeValidator(_two), WithJsonSchema({"type": "array", "items": _NAME, "minItems": 2, "maxItems": 2})
    ] = Field(description="the two links; the frame is 0")
    kind: Kind | None = Field(default=None, description="its kind, which says the freedoms")
    freedoms: int | None = Field(default=None, ge=1, le=5, description="instead of kind: 1 to 5 freedoms")


class Spatial(Strict):
    """A chain in space, given by pairs alone."""

    links: Annotated[
        Any,
        BeforeValidator(_links),
        WithJsonSchema({"anyOf": [{"type": "integer"}, {"type": "array", "items": _NAME}]}),
    ] = Field(default=None, description="moving links, names or how many; those of the pairs when left out")
    pairs: dict[Name, SpatialPair] = Field(min_length=1, max_length=MAX_PAIRS)
    output: Name | None = Field(default=None, description="the link that is held for the manoeuvrability")
    local: Annotated[
        Any,
        BeforeValidator(_local),
        WithJsonSchema(
            {"anyOf": [{"type": "integer"}, {"type": "object", "additionalProperties": {"type": "integer"}}]}
        ),
    ] = Field(default=None, description="local freedoms Wm, all of them or by link; found from the pairs when left out")
    wanted: int | None = Field(
        default=None, ge=0, le=MAX_MOBILITY, description="mobility Wo that it is meant to have, for q = Wo + Wm - W"
    )


class SpatialStructure(Strict):
    """What is counted without dimensions."""

    spatial: Spatial


class SpatialFile(Strict):
    """A chain in space without dimensions: only its structure is counted."""

    tmm: Literal[1] = Field(description="version of this format")
    title: str = Field(default="", max_length=200)
    description: str = Field(default="", max_length=4000)
    structure: SpatialStructure
