"""The shape of a problem file that gives a chain in space by its pairs alone."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from tmm_cli.problem.schema_parts import MAX_LINKS, FileHead, Name, Strict
from tmm_cli.problem.schema_shown import Shows

MAX_PAIRS = 300
MAX_MOBILITY = 6 * MAX_LINKS

Kind = Literal[
    "turning", "sliding", "screw", "cylindrical", "spherical with a pin", "universal", "spherical", "planar",
    "sphere in cylinder", "cylinder on plane", "sphere on plane",
]  # fmt: skip


Freedoms = Annotated[int, Field(ge=0, le=MAX_MOBILITY)]


class SpatialPair(Strict):
    """A pair of two links."""

    between: list[Name] = Field(min_length=2, max_length=2, description="the two links; the frame is 0")
    kind: Kind | None = Field(default=None, description="its kind, which says the freedoms")
    freedoms: int | None = Field(default=None, ge=1, le=5, description="instead of kind: 1 to 5 freedoms")


class Spatial(Strict):
    """A chain in space, given by pairs alone."""

    links: Annotated[int, Field(ge=1, le=MAX_LINKS)] | Annotated[list[Name], Field(max_length=MAX_LINKS)] | None = (
        Field(default=None, description="moving links, names or how many; those of the pairs when left out")
    )
    pairs: dict[Name, SpatialPair] = Field(min_length=1, max_length=MAX_PAIRS)
    output: Name | None = Field(default=None, description="the link that is held for the manoeuvrability")
    local: Freedoms | dict[Name, Freedoms] | None = Field(
        default=None, description="local freedoms Wm, all of them or by link; found from the pairs when left out"
    )
    wanted: Freedoms | None = Field(
        default=None, description="mobility Wo that it is meant to have, for q = Wo + Wm - W"
    )


class SpatialStructure(Strict):
    """What is counted without dimensions."""

    spatial: Spatial


class SpatialFile(FileHead):
    """A chain in space without dimensions: only its structure is counted."""

    reference: str = Field(default="", max_length=100, description="of the mechanism in a book or a list")
    shows: Shows = Field(default={}, description="W, Wm, q or m: {mobility: {of: W, expected: 9}}")
    structure: SpatialStructure
