"""Keys of the task four-bar-by-angles: pairs of angles, or a function, read into the record of the task."""

from __future__ import annotations

from itertools import pairwise
from typing import Any, Literal

import numpy as np
from pydantic import Field

from tmm_cli.language import N_, _, translated
from tmm_cli.mechanics.quantities import ANGLE, NUMBER
from tmm_cli.problem import ProblemError, Value, ValueReader, Vector, nearest_name, quote
from tmm_cli.synthesis.blocks import UNDETERMINED, Range, TaskBlock, read_numbers
from tmm_cli.synthesis.four_bar_by_angles.angle_pairs import (
    LENGTHS,
    LIMITS,
    ZEROS,
    AnglePairsTask,
)
from tmm_cli.synthesis.four_bar_by_angles.generated_function import ANGLES, FUNCTIONS, GeneratedFunction

DOMAINS = {
    "log10(x)": N_("x greater than 0"),
    "ln(x)": N_("x greater than 0"),
    "sqrt(x)": N_("x not less than 0"),
    "x^1.5": N_("x not less than 0"),
    "1/x": N_("a range of x that does not contain 0"),
}
MOST = 361  # pairs of angles
MOST_RATIO = 1000.0  # of links
OF_FUNCTION = ("function", "table", "x", "input", "output", "points")


class FourBarByAnglesBlock(TaskBlock):
    """Keys of the task `four-bar-by-angles`: pairs of input and output angles, or a function."""

    task: Literal["four-bar-by-angles"]
    pairs: list[Vector] | None = Field(
        default=None,
        min_length=2,
        max_length=MOST,
        description=(
            "pairs [input angle, output angle], measured from AD, in the order in which they are reached; more "
            "than 5 pairs are fitted by least squares"
        ),
    )
    l1: Value | None = Field(
        default=None,
        description=(
            "length of the input link (l1), the coupler (l2) or the output link (l3); one length determines "
            "the size of the four-bar"
        ),
    )
    l2: Value | None = None
    l3: Value | None = None
    l4: Value | None = Field(
        default=None,
        description=(
            "length of the frame; with two pairs, two of l1, l3, l4 may be given, with three pairs, l4 and one "
            "of l1, l3"
        ),
    )
    phi0: Value | None = Field(
        default=None,
        description=(
            "initial angle of the input link, measured from AD; default 0; with 4 or more pairs of angles it "
            "is computed"
        ),
    )
    psi0: Value | None = Field(
        default=None,
        description="zero angle of the output link, measured from AD; default 0; with 5 or more pairs it is computed",
    )
    function: str | None = Field(default=None, max_length=40, description="y: " + ", ".join(FUNCTIONS))
    table: list[Vector] | None = Field(
        default=None, min_length=2, max_length=10_000, description="table of y with rows [x, y], instead of function"
    )
    x: Range | None = Field(default=None, description="range of x, [from, to], for a function")
    input: Range | None = Field(default=None, description="[from, to]: input angles at both ends of the range of x")
    output: Range | None = Field(default=None, description="[from, to]: output angles at both ends of the range of x")
    points: int | None = Field(
        default=None,
        ge=2,
        le=MOST,
        description=(
            "number of precision points (Chebyshev spacing); default 3; more than 5 are fitted by least squares"
        ),
    )
    choose: Literal["transmission", "crank", 1, 2, 3, 4, 5, 6] | None = Field(
        default=None,
        description=(
            "which solution to take if there are several: `transmission` (best transmission angle), `crank` "
            "(one with a crank), or its number; default `transmission`, and with a least-squares fit the least error"
        ),
    )
    transmission: Value | None = Field(
        default=None,
        description=(
            "required smallest transmission angle over the range: chooses among the solutions, and bounds a "
            "least-squares fit"
        ),
    )
    link_ratio: Value | None = Field(
        default=None,
        description="largest ratio of the longest to the shortest link of a least-squares fit; default 10",
    )
    defects: Literal["refuse", "keep"] = Field(
        default="refuse", description="what to do with solutions that have branch or order defects: refuse or keep"
    )


BLOCK = FourBarByAnglesBlock


def read(block: FourBarByAnglesBlock, values: ValueReader) -> AnglePairsTask:
    """Convert the keys of the task to quantities in SI and radians. Raises ProblemError."""
    lengths = read_numbers(block, values, LENGTHS)
    function = None
    if block.pairs is None:
        function = _read_function(block, values)
        phi, psi = function.precision_points(block.points or 3)
        pairs = list(zip(phi.tolist(), psi.tolist(), strict=True))
    else:
        if extra := [key for key in OF_FUNCTION if getattr(block, key) is not None]:
            raise ProblemError(
                _("pairs and a function cannot be given together"),
                path=(extra[0],),
                allowed=_("either pairs or a function"),
                key=True,
            )
        pairs = [
            (values.number(a, ANGLE, ("pairs", k, 0)), values.number(b, ANGLE, ("pairs", k, 1)))
            for k, (a, b) in enumerate(block.pairs)
        ]
    count = len(pairs)
    _check_lengths(lengths, count)
    zeros = {"phi0": None, "psi0": None} | read_numbers(block, values, ZEROS)
    _complete_zero_angles(zeros, count, lengths)
    phi, psi = zip(*pairs, strict=True)
    limits = read_numbers(block, values, LIMITS)
    _check_limits(block, limits)
    choose, keep = str(block.choose or ""), block.defects == "keep"
    return AnglePairsTask(
        tuple(phi), tuple(psi), lengths, zeros["phi0"], zeros["psi0"], choose, keep, function, **limits
    )


def _check_limits(block: FourBarByAnglesBlock, limits: dict[str, float]) -> None:
    for key, low, high, allowed in (
        ("link_ratio", 1.0, MOST_RATIO, _("a number greater than 1, at most {most}").format(most=f"{MOST_RATIO:.0f}")),
        ("transmission", 0.0, np.pi / 2, _("an angle greater than 0 and less than 90 deg")),
    ):
        if key in limits and not low < limits[key] <= high - (key == "transmission") * 1e-9:
            found = quote(getattr(block, key))
            raise ProblemError(_("this limit is outside its range"), path=(key,), found=found, allowed=allowed)


def _check_lengths(lengths: dict[str, float], count: int) -> None:
    two = len(lengths) == 2 and "l2" not in lengths and (count == 2 or (count == 3 and "l4" in lengths))
    other = {2: _("; or two of l1, l3, l4"), 3: _("; or l4 and one of l1, l3")}.get(count, "")
    if len(lengths) != 1 and not two:
        raise ProblemError(
            _("give exactly one length: it determines the size of the four-bar"),
            found=", ".join(lengths) or _("none"),
            allowed=_("one of {ways}").format(ways="l1, l2, l3, l4") + other,
            key=True,
        )


def _complete_zero_angles(zeros: dict[str, Any], count: int, lengths: dict[str, float]) -> None:
    """Set zero angles to 0 if they are neither given nor determined by the pairs of angles.

    Four pairs determine one zero angle, five or more pairs both; these remain None. Raises ProblemError.
    """
    given_keys = [key for key, value in zeros.items() if value is not None]
    if count == 3 and len(lengths) == 2:
        determined, other = ("psi0", "phi0") if "l1" in lengths else ("phi0", "psi0")
        if determined in given_keys:
            raise ProblemError(
                _("three pairs and two lengths also determine {angle}").format(angle=determined),
                path=(determined,),
                found=", ".join(given_keys),
                allowed=other,
                key=True,
            )
        zeros[other] = zeros[other] or 0.0
    elif count == 5 and len(given_keys) == 1:
        raise ProblemError(
            _("5 pairs also determine both zero angles"),
            path=(given_keys[0],),
            found=given_keys[0],
            allowed=_("neither phi0 nor psi0; or both, for a least-squares fit"),
            key=True,
        )
    elif count < 4:
        zeros.update({key: value or 0.0 for key, value in zeros.items()})
    elif count == 4 and not given_keys:
        zeros["psi0"] = 0.0


def _read_function(block: FourBarByAnglesBlock, values: ValueReader) -> GeneratedFunction:
    missing = [key for key in ("input", "output") if getattr(block, key) is None]
    if (block.function is None) == (block.table is None) or missing:
        given_keys = [key for key in OF_FUNCTION if getattr(block, key) is not None]
        raise ProblemError(
            translated(UNDETERMINED),
            found=", ".join(given_keys) or _("none"),
            allowed=_("pairs; or function (or table), x, input, output"),
            key=True,
        )
    name = (block.function or "").replace(" ", "")
    if block.function is not None and name not in FUNCTIONS:
        raise ProblemError(
            _("unknown function"),
            path=("function",),
            found=quote(block.function),
            allowed=_("{functions}; or table: [[x, y], ...]").format(functions=", ".join(FUNCTIONS)),
            near=nearest_name(name, FUNCTIONS),
        )
    ends: dict[str, Any] = {
        key: tuple(values.number(v, ANGLE, (key, k)) for k, v in enumerate(getattr(block, key)))
        for key in ("input", "output")
    }
    of_x = ANGLE if name in ANGLES else NUMBER
    rows = tuple(
        (values.number(a, NUMBER, ("table", k, 0)), values.number(b, NUMBER, ("table", k, 1)))
        for k, (a, b) in enumerate(block.table or ())
    )
    if rows and any(b[0] <= a[0] for a, b in pairwise(rows)):
        raise ProblemError(
            _("x must increase from row to row"), path=("table",), allowed=_("rows in order of increasing x")
        )
    if block.x is not None:
        x = tuple(values.number(v, of_x, ("x", k)) for k, v in enumerate(block.x))
    elif rows:
        x = (rows[0][0], rows[-1][0])
    else:
        raise ProblemError(_("the range of x is missing"), path=("function",), allowed="x: [from, to]", key=True)
    function = GeneratedFunction((x[0], x[1]), ends["input"], ends["output"], name, rows)
    _check_function(function)
    return function


def _check_function(function: GeneratedFunction) -> None:
    with np.errstate(all="ignore"):
        y = function.value(np.linspace(*function.x, 101))
    if function.x[0] == function.x[1] or function.phi[0] == function.phi[1]:
        key = "x" if function.x[0] == function.x[1] else "input"
        raise ProblemError(
            _("this range is empty: both ends are equal"), path=(key,), allowed=_("two different values [from, to]")
        )
    if not np.all(np.isfinite(y)) or y[0] == y[-1]:
        differing = _("a range with different values of the function at its ends")
        domain = translated(DOMAINS.get(function.name, N_("a different range of x")))
        raise ProblemError(
            _("the function is undefined in this range, or has equal values at both ends"),
            path=("x",),
            allowed=differing if np.all(np.isfinite(y)) else domain,
        )
