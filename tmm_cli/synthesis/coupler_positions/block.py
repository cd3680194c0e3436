"""Four-bar by positions of its coupler: keys of the task."""

from __future__ import annotations

from math import sin
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field
from pydantic_core import PydanticCustomError

from tmm_cli.language import _
from tmm_cli.mechanics.numerics import SAME_POSITION
from tmm_cli.mechanics.quantities import ANGLE, LENGTH
from tmm_cli.problem import ProblemError, Value, ValueReader, Vector, planar
from tmm_cli.synthesis.blocks import Block, one_of
from tmm_cli.synthesis.coupler_positions.burmester import CouplerPositionsTask, Side


def _position(found: Any) -> Any:
    if not isinstance(found, list) or len(found) != 3 or any(isinstance(x, list | dict | bool) for x in found):
        raise PydanticCustomError("position", "a place and an angle [x, y, angle] are wanted")
    return found


Position = Annotated[list[Value], BeforeValidator(_position)]
Where = Literal["left", "right"]
DYADS = ("AB", "DC")


class Shape(Block):
    """A four-bar ABCD (AB drives) whose coupler takes 2, 3 or 4 positions."""

    task: Literal["coupler-positions"]
    positions: list[Position] = Field(
        min_length=2, max_length=4, description="[x, y, angle] of the coupler's axes, 2 to 4, in order"
    )
    B: Vector | None = Field(default=None, description="pin of AB in the coupler's axes; or its pivot A")
    C: Vector | None = Field(default=None, description="pin of DC in the coupler's axes; or its pivot D")
    A: Vector | None = Field(default=None, description="pivot of AB on the frame")
    D: Vector | None = Field(default=None, description="pivot of DC on the frame")
    AB: Value | None = Field(default=None, description="length, with two positions")
    DC: Value | None = Field(default=None, description="length, with two positions")
    AB_side: Where = Field(default="left", description="of the way from place 1 to 2, with two positions")
    DC_side: Where = "left"
    AB_turn: Value | None = Field(default=None, description="turn of AB from 1 to 2, with four; best transmission")
    DC_turn: Value | None = Field(default=None, description="turn of DC from 1 to 2, with four; best transmission")
    A_near: Vector | None = Field(
        default=None, description="or, with four, a place: the pivot of the curve nearest to it"
    )
    D_near: Vector | None = Field(default=None, description="the same of D")
    pivots_within: list[Vector] | None = Field(
        default=None, min_length=2, max_length=2, description="with four, opposite corners of a box for free pivots"
    )
    AB_branch: Literal[1, 2] = Field(default=1, description="which of the two links of that turn")
    DC_branch: Literal[1, 2] = 1
    defects: Literal["refuse", "keep"] = Field(default="refuse", description="branch, order and circuit defects")


def read(shape: Shape, values: ValueReader) -> CouplerPositionsTask:
    """The task in SI. Raises ProblemError."""
    count = len(shape.positions)
    poses = [
        (
            planar(*(values.number(pose[i], LENGTH, ("positions", k, i)) for i in (0, 1))),
            values.number(pose[2], ANGLE, ("positions", k, 2)),
        )
        for k, pose in enumerate(shape.positions)
    ]
    for k, (place, angle) in enumerate(poses):
        same = [m for m in range(k) if poses[m][0] == place and abs(sin((poses[m][1] - angle) / 2)) < SAME_POSITION]
        if same:
            raise ProblemError(
                _("this position is there already"),
                path=("positions", k),
                found=_("position {number}").format(number=same[0] + 1),
                allowed=_("any other position, as one turned by 20 deg"),
            )
    sides = {name: side for name in DYADS if (side := _side(shape, values, name, count)) is not None}
    places, angles = zip(*poses, strict=True)
    return CouplerPositionsTask(
        tuple(places), tuple(angles), sides, shape.defects == "keep", _box(shape, values, count, sides)
    )


def _box(shape: Shape, values: ValueReader, count: int, sides: dict[str, Side]) -> tuple[complex, complex] | None:
    """Corners of the box for free pivots."""
    if shape.pivots_within is None:
        return None
    if count != 4 or len(sides) == 2:
        why = _("{count} positions").format(count=count) if count != 4 else _("both links are given")
        raise ProblemError(
            _("a box is for pivots that are free"),
            path=("pivots_within",),
            found=why,
            allowed=_("four positions, and AB or DC free"),
            key=True,
        )
    one, other = (values.vector(v, LENGTH, ("pivots_within", k)) for k, v in enumerate(shape.pivots_within))
    return one, other


def _side(shape: Shape, values: ValueReader, name: str, count: int) -> Side | None:
    """What is given of a dyad, which must be just what the count of positions needs."""
    pivot, pin, turn, near = name[0], name[1], f"{name}_turn", f"{name[0]}_near"
    sets = {2: ((pin, name), (pivot, name)), 3: ((pin,), (pivot,)), 4: ((turn,), (near,), ())}[count]
    refusal = _("these keys do not determine {link} with {count} positions").format(link=name, count=count)
    given = one_of(shape, sets, (pivot, pin, name, turn, near), refusal)
    if not given:
        return None
    found: dict[str, Any] = {
        field: values.vector(getattr(shape, key), LENGTH, (key,))
        for field, key in (("pivot", pivot), ("pin", pin), ("near", near))
        if key in given
    }
    for field, key, want in (("length", name, LENGTH), ("turn", turn, ANGLE)):
        if key in given:
            found[field] = values.number(getattr(shape, key), want, (key,))
    return Side(side=getattr(shape, f"{name}_side"), branch=getattr(shape, f"{name}_branch") - 1, **found)
