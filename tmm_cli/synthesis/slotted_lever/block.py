"""Slotted lever by k and its extreme positions: keys of the task."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from tmm_cli.language import _
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.schema_parts import Value, Vector
from tmm_cli.problem.values import ValueReader
from tmm_cli.quantities import ANGLE, LENGTH
from tmm_cli.synthesis.blocks import Block, Range, numbers, one_of
from tmm_cli.synthesis.slotted_lever.solver import QUANTITIES, Task

ENDS = (("B1", "B2"), ("CB",))
SWINGS = (("k",), ("swing",))
FRAMES = (("OC",), ("OA",), ("within",))


class Shape(Block):
    """A slotted lever by the extreme places of its end B (or its length) and k (or its swing)."""

    task: Literal["slotted-lever"]
    B1: Vector | None = Field(default=None, description="extreme place of the lever's end B")
    B2: Vector | None = Field(default=None, description="the other one")
    C: Literal["left", "right"] | None = Field(
        default=None, description="on which side of the way from B1 to B2 the lever's hinge lies; right"
    )
    CB: Value | None = Field(default=None, description="length of the lever, instead of its places")
    support: Vector | None = Field(default=None, description="with CB, the hinge C; [0, 0]")
    axis: Value | None = Field(default=None, description="with CB, direction from C to O; 90 deg")
    k: Value | None = Field(default=None, description="coefficient of change of mean speed, more than 1")
    swing: Value | None = Field(default=None, description="swing of the lever, instead of k")
    OC: Value | None = Field(default=None, description="distance of the fixed hinges")
    OA: Value | None = Field(default=None, description="or the crank")
    within: Range | None = Field(default=None, description="or bounds of OC")
    choose: Literal["least force", "shortest"] | None = Field(
        default=None,
        description="OC within its bounds: the longest that leaves the stone on CB (least force), or the shortest",
    )


def read(shape: Shape, values: ValueReader) -> Task:
    """The task in SI. Raises ProblemError."""
    ends, *__ = (one_of(shape, sets) for sets in (ENDS, SWINGS, FRAMES))
    _only_with(shape, {"C": ("B1", "B2"), "support": ("CB",), "axis": ("CB",), "choose": ("within",)})
    found = numbers(shape, values, QUANTITIES)
    if ends == ("CB",):
        found["c"] = values.vector(shape.support or [0, 0], LENGTH, ("support",))
        found["axis"] = values.number("90 deg" if shape.axis is None else shape.axis, ANGLE, ("axis",))
    else:
        found |= {name.lower(): values.vector(getattr(shape, name), LENGTH, (name,)) for name in ends}
    if shape.within is not None:
        low, high = (values.number(v, LENGTH, ("within", n)) for n, v in enumerate(shape.within))
        found["within"] = (low, high)
    choose = "shortest" if shape.choose == "shortest" else "force"
    return Task(**found, side=1 if shape.C == "left" else -1, choose=choose)


def _only_with(shape: Shape, needs: dict[str, tuple[str, ...]]) -> None:
    for key, others in needs.items():
        lacking = [other for other in others if getattr(shape, other) is None]
        if getattr(shape, key) is not None and lacking:
            raise ProblemError(
                _("{key} goes with {others} only").format(key=key, others=_(" and ").join(others)), path=(key,),
                found=_("{key} without {lacking}").format(key=key, lacking=_(" and ").join(lacking)),
                allowed=_("{others}, or no {key}").format(others=_(" and ").join(others), key=key),
                key=True,
            )  # fmt: skip
