"""Four-bar by k and both extreme positions of its rocker: keys of the task."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from tmm_cli.language import _
from tmm_cli.mechanics.quantities import LENGTH
from tmm_cli.problem import ProblemError, Value, ValueReader, Vector
from tmm_cli.synthesis.blocks import Block, numbers
from tmm_cli.synthesis.four_bar_by_k.arcs import FourBarByKTask
from tmm_cli.synthesis.four_bar_by_k.solver import QUANTITIES

CHOICES = {"best transmission": "best", "supports level": "level"}
WAYS = ("choose", "pressure", "l1", "l2", "l4", "near", "xA", "yA")


class Shape(Block):
    """A four-bar by k, its rocker and both extreme angles of that; one way to choose the crank's pivot A."""

    task: Literal["four-bar-by-k"]
    l3: Value = Field(description="rocker DC")
    psi1: Value = Field(description="angle of DC where the crank lies over the coupler")
    psi2: Value = Field(description="angle of DC where the crank is in line with the coupler")
    k: Value = Field(description="coefficient of change of mean speed, 1 or more")
    support: Vector = Field(default=(0, 0), description="D; [0, 0]")
    choose: Literal["best transmission", "supports level"] | None = Field(
        default=None, description="how A is chosen; best transmission"
    )
    pressure: Value | None = Field(
        default=None, description="or: the largest pressure angle; of two pivots the one of the smaller mechanism"
    )
    l1: Value | None = Field(default=None, description="or: the crank AB")
    l2: Value | None = Field(default=None, description="or: the coupler BC")
    l4: Value | None = Field(default=None, description="or: the frame AD")
    near: Vector | None = Field(default=None, description="or: a place; A is the nearest pivot to it")
    xA: Value | None = Field(default=None, description="or: x of A")  # noqa: N815  as the parameter is called
    yA: Value | None = Field(default=None, description="or: the height of A, its y")  # noqa: N815
    turns: Literal["ccw", "cw"] | None = Field(
        default=None, description="sense of the crank whose slow stroke leads from psi1 to psi2; any"
    )


def read(shape: Shape, values: ValueReader) -> FourBarByKTask:
    """The task in SI. Raises ProblemError."""
    ways = [name for name in WAYS if getattr(shape, name) is not None]
    if len(ways) > 1:
        raise ProblemError(
            _("the pivot A is chosen in one way"),
            found=_(" and ").join(ways),
            allowed=_("one of {ways}").format(ways=", ".join(WAYS)),
            key=True,
        )
    found = numbers(shape, values, QUANTITIES)
    for key in ("support", "near"):
        if getattr(shape, key) is not None:
            found[key] = values.vector(getattr(shape, key), LENGTH, (key,))
    way = ways[0] if ways else "choose"
    choice = CHOICES[shape.choose or "best transmission"] if way == "choose" else way
    return FourBarByKTask(**found, choose=choice, sense={"ccw": 1, "cw": -1, None: 0}[shape.turns])
