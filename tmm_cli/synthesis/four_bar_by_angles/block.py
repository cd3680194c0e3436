"""Four-bar by pairs of angles, or by a function: keys of the task."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, Literal

import numpy as np
from pydantic import Field

from tmm_cli.language import _, translated
from tmm_cli.mechanics.quantities import ANGLE, NUMBER
from tmm_cli.problem import ProblemError, Value, ValueReader, Vector, nearest, quote
from tmm_cli.synthesis.blocks import UNDETERMINED, Block, Range, numbers
from tmm_cli.synthesis.four_bar_by_angles.pairs import ANGLES, FUNCTIONS, LENGTHS, ZEROS, AnglePairsTask, Function

DOMAINS = {
    "log10(x)": "x more than 0",
    "ln(x)": "x more than 0",
    "sqrt(x)": "x of 0 or more",
    "x^1.5": "x of 0 or more",
    "1/x": "x on one side of 0",
}
MOST = 361  # pairs of angles
OF_FUNCTION = ("function", "table", "x", "input", "output", "points")


class Shape(Block):
    """A four-bar by pairs of input and output angles, or by a function at some points."""

    task: Literal["four-bar-by-angles"]
    pairs: list[Vector] | None = Field(
        default=None,
        min_length=2,
        max_length=MOST,
        description="[input, output] angles from AD, in order; over 5: least squares",
    )
    l1: Value | None = Field(default=None, description="one length gives the size; l1 input, l2 coupler, l3 output")
    l2: Value | None = None
    l3: Value | None = None
    l4: Value | None = Field(
        default=None, description="frame; two of l1, l3, l4 with two pairs, l4 and l1 or l3 with three"
    )
    phi0: Value | None = Field(default=None, description="zero of input angles, from AD; 0; 4 and more pairs find it")
    psi0: Value | None = Field(default=None, description="zero of output angles, from AD; 0; 5 and more pairs find it")
    function: str | None = Field(default=None, max_length=40, description="y: " + ", ".join(FUNCTIONS))
    table: list[Vector] | None = Field(default=None, min_length=2, max_length=10_000, description="or rows [x, y]")
    x: Range | None = Field(default=None, description="[from, to], with a function")
    input: Range | None = Field(default=None, description="[from, to]: input angles for x")
    output: Range | None = Field(default=None, description="[from, to]: output angles for y")
    points: int | None = Field(
        default=None, ge=2, le=MOST, description="with Chebyshev's spacing; 3; over 5: least squares"
    )
    choose: Literal["transmission", "crank", 1, 2, 3] = Field(
        default="transmission", description="of several solutions: best transmission, a crank if there is one, a number"
    )
    defects: Literal["refuse", "keep"] = Field(default="refuse", description="branch and order defects")


def read(shape: Shape, values: ValueReader) -> AnglePairsTask:
    """The task in SI. Raises ProblemError."""
    lengths = numbers(shape, values, LENGTHS)
    function = None
    if shape.pairs is None:
        function = _function(shape, values)
        phi, psi = function.precision(shape.points or 3)
        pairs = list(zip(phi.tolist(), psi.tolist(), strict=True))
    else:
        if extra := [key for key in OF_FUNCTION if getattr(shape, key) is not None]:
            raise ProblemError(
                _("pairs and a function are two tasks"), path=(extra[0],), allowed=_("one of the two"), key=True
            )
        pairs = [
            (values.number(a, ANGLE, ("pairs", k, 0)), values.number(b, ANGLE, ("pairs", k, 1)))
            for k, (a, b) in enumerate(shape.pairs)
        ]
    count = len(pairs)
    _lengths(lengths, count)
    zeros = {"phi0": None, "psi0": None} | numbers(shape, values, ZEROS)
    _zeros(zeros, count, lengths)
    phi, psi = zip(*pairs, strict=True)
    choose, keep = str(shape.choose), shape.defects == "keep"
    return AnglePairsTask(tuple(phi), tuple(psi), lengths, zeros["phi0"], zeros["psi0"], choose, keep, function)


def _lengths(lengths: dict[str, float], count: int) -> None:
    two = len(lengths) == 2 and "l2" not in lengths and (count == 2 or (count == 3 and "l4" in lengths))
    other = {2: "; or two of l1, l3, l4", 3: "; or l4 and one of l1, l3"}.get(count, "")
    if len(lengths) != 1 and not two:
        raise ProblemError(
            _("one length gives the size of the four-bar"),
            found=", ".join(lengths) or _("none"),
            allowed=_("one of {ways}").format(ways="l1, l2, l3, l4") + other,
            key=True,
        )


def _zeros(zeros: dict[str, Any], count: int, lengths: dict[str, float]) -> None:
    """The zero angles that are to be found stay None, others are 0: 4 pairs find one, more both that are not given."""
    given = [key for key, value in zeros.items() if value is not None]
    if count == 3 and len(lengths) == 2:
        found, other = ("psi0", "phi0") if "l1" in lengths else ("phi0", "psi0")
        if found in given:
            raise ProblemError(
                f"three pairs and two lengths determine {found} too",
                path=(found,),
                found=", ".join(given),
                allowed=other,
                key=True,
            )
        zeros[other] = zeros[other] or 0.0
    elif count == 5 and len(given) == 1:
        raise ProblemError(
            _("5 pairs determine zero angles too"),
            path=(given[0],),
            found=given[0],
            allowed=_("neither phi0 nor psi0; or both, for the least squares of errors"),
            key=True,
        )
    elif count < 4:
        zeros.update({key: value or 0.0 for key, value in zeros.items()})
    elif count == 4 and not given:
        zeros["psi0"] = 0.0


def _function(shape: Shape, values: ValueReader) -> Function:
    missing = [key for key in ("input", "output") if getattr(shape, key) is None]
    if (shape.function is None) == (shape.table is None) or missing:
        given = [key for key in OF_FUNCTION if getattr(shape, key) is not None]
        raise ProblemError(
            translated(UNDETERMINED),
            found=", ".join(given) or _("none"),
            allowed=_("pairs; or function (or table), x, input, output"),
            key=True,
        )
    name = (shape.function or "").replace(" ", "")
    if shape.function is not None and name not in FUNCTIONS:
        raise ProblemError(
            _("this function is not known here"),
            path=("function",),
            found=quote(shape.function),
            allowed=_("{functions}; or table: [[x, y], ...]").format(functions=", ".join(FUNCTIONS)),
            near=nearest(name, FUNCTIONS),
        )
    ends: dict[str, Any] = {
        key: tuple(values.number(v, ANGLE, (key, k)) for k, v in enumerate(getattr(shape, key)))
        for key in ("input", "output")
    }
    of_x = ANGLE if name in ANGLES else NUMBER
    rows = tuple(
        (values.number(a, NUMBER, ("table", k, 0)), values.number(b, NUMBER, ("table", k, 1)))
        for k, (a, b) in enumerate(shape.table or ())
    )
    if rows and any(b[0] <= a[0] for a, b in pairwise(rows)):
        raise ProblemError(_("x must grow from row to row"), path=("table",), allowed=_("rows in the order of x"))
    if shape.x is not None:
        x = tuple(values.number(v, of_x, ("x", k)) for k, v in enumerate(shape.x))
    elif rows:
        x = (rows[0][0], rows[-1][0])
    else:
        raise ProblemError(_("the range of x is missing"), path=("function",), allowed="x: [from, to]", key=True)
    found = Function((x[0], x[1]), ends["input"], ends["output"], name, rows)
    _sound(found)
    return found


def _sound(function: Function) -> None:
    with np.errstate(all="ignore"):
        y = function.value(np.linspace(*function.x, 101))
    if function.x[0] == function.x[1] or function.phi[0] == function.phi[1]:
        key = "x" if function.x[0] == function.x[1] else "input"
        raise ProblemError(_("this range is empty"), path=(key,), allowed=_("two different ends"))
    if not np.all(np.isfinite(y)) or y[0] == y[-1]:
        other = "two ends at which the function differs"
        raise ProblemError(
            _("the function has no values there, or the same at both ends"),
            path=("x",),
            allowed=other if np.all(np.isfinite(y)) else DOMAINS.get(function.name, "another range"),
        )
