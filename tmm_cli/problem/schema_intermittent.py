"""The shape of the block `intermittent`: wheels that a link takes along on some strokes and that stand on others."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from tmm_cli.problem.schema_parts import Name, Strict, Value

Values = Annotated[dict[Name, Value], Field(max_length=50)]
Settings = Annotated[list[Values], Field(min_length=1, max_length=12)]


class Wheel(Strict):
    """A ratchet wheel, a shaft on a one-way clutch, or a flange with slots, on the axis of the link that moves it."""

    moves_with: Name = Field(description="the link that takes it along; it turns on the frame")
    when: Literal["forward", "backward", "working stroke", "idle stroke"] = Field(
        description="while that link turns forward (counterclockwise) or backward, or in strokes of the output"
    )
    settings: Settings = Field(
        default=[{}], description="values of parameters that take turns, one a cycle of the driver: [{}, {R: 125}]"
    )


Wheels = Annotated[dict[Name, Wheel], Field(max_length=4)]  # a setting of a class III press takes 0.4 s
