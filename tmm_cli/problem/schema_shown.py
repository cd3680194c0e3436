"""The shape of the block `shows`: properties of a mechanism as numbers, with what they should be."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from tmm_cli.problem.schema_parts import Name, Strict, Value

Number = Annotated[int, Field(ge=0)]
Quantity = Annotated[str, Field(min_length=1, max_length=60)]


class Shown(Strict):
    """A quantity by the name that the tables give it, as one number."""

    of: Quantity = Field(description="what: psi, k, W, x of E, v of 5 on 0, phi of 3, M_b, R_34; of vectors the size")
    at: Number | None = Field(default=None, description="in which position")
    between: Annotated[list[Number], Field(min_length=2, max_length=2)] | None = Field(
        default=None, description="instead: its change from one position to another"
    )
    over: Literal["largest", "least", "range"] | None = Field(
        default=None, description="instead: over the way of the driver, its turn or the positions asked"
    )
    within: Value | None = Field(
        default=None, description="with `at`: the way of the driver about there, on which it changes by no more"
    )
    per: Value | None = Field(
        default=None,
        description="divided by another quantity, place by place for largest and least, or by a value",
    )
    set: dict[Name, Value] = Field(default_factory=dict, max_length=50, description="with these parameters instead")
    without: Name | None = Field(default=None, description="of the structure: when this hinge has broken")
    expected: Value | None = Field(default=None, description="what it should be, from elsewhere: a run compares it")


Shows = Annotated[dict[Annotated[str, Field(max_length=120)], Shown], Field(max_length=50)]
