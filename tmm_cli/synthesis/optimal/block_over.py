"""Where the driver goes in an optimal synthesis: round a cycle, along its stroke, through the positions of the file, or
from one place to another.
"""

from __future__ import annotations

from functools import reduce
from typing import Any

import numpy as np

from tmm_cli.errors import _
from tmm_cli.linkage import Driver
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.record import Problem
from tmm_cli.problem.values import ValueReader
from tmm_cli.quantities import ANGLE, LENGTH
from tmm_cli.synthesis.optimal.block_ranges import two
from tmm_cli.variants.variant import Variant

Ends = tuple[Any, Any] | None
Over = str | tuple[float, float]


def asked_over(over: Any, driver: Driver, sense: ValueReader) -> Over:
    """What the key `over` says, with places in SI; what is usual where it is left out. Raises ProblemError."""
    stroked = driver.stroke is not None
    if over is None:
        return "stroke" if stroked else "cycle" if driver.kind == "turn" else "positions"
    if over == "stroke" and not stroked:
        raise ProblemError(
            _("the driver has no stroke"), path=("over",), found=quote(over),
            allowed=_("driver: {stroke: [from, to]}; or over: cycle, positions or [from, to]"),
        )  # fmt: skip
    if over == "cycle" and (stroked or driver.kind == "slide"):
        raise ProblemError(
            _("the driver does not turn on and on"), path=("over",), found=quote(over),
            allowed=_("stroke, positions or [from, to]") if stroked else _("positions or [from, to]"),
        )  # fmt: skip
    if isinstance(over, str):
        return over
    dimension = ANGLE if driver.kind == "turn" else LENGTH
    low, high = (float(sense.number(value, dimension, ("over", n))) for n, value in enumerate(over))
    if not low < high:
        raise ProblemError(
            _("the lower end comes first"), path=("over",), found=two(*over), allowed="[from, to]"
        )  # fmt: skip
    if driver.kind == "turn" and high - low > 2 * np.pi * (1 + 1e-12):
        raise ProblemError(
            _("this is more than a turn"), path=("over",), found=two(*over), allowed=_("a turn; or over: cycle")
        )
    return low, high


def driven(problem: Problem, over: Over) -> Variant:
    """The linkage of a file with the way of its driver. Raises ProblemError."""
    linkage, request = problem.linkage, problem.request
    ends = _ends(problem, over)
    stroke = linkage.driver.stroke
    if ends is not None and stroke is not None and not (stroke[0] <= ends[0] and ends[1] <= stroke[1]):
        dimension = ANGLE if linkage.driver.kind == "turn" else LENGTH
        low, high = (f"{problem.units.from_si(float(end), dimension):.6g}" for end in stroke)
        raise ProblemError(
            _("the driver does not go there"), path=("over",), found=quote(over) if isinstance(over, str) else None,
            allowed=_("places of its stroke, {low} to {high} {unit}").format(
                low=low, high=high, unit=problem.units.symbol(dimension)
            ),
        )  # fmt: skip
    return Variant(linkage, request, ends)


def _ends(problem: Problem, over: Over) -> Ends:
    driver, places = problem.linkage.driver, problem.request.places
    if over == "cycle":
        return None
    if over == "stroke" or (over == "positions" and driver.stroke is not None and not places):
        return driver.stroke
    if over == "positions":
        if len(places) < 2:
            raise ProblemError(
                _("how far the driver goes is wanted"), path=("over",),
                allowed=_("over: [from, to]; or positions: {at: [...]}, or driver: {stroke: [from, to]}"),
            )  # fmt: skip
        over = reduce(np.minimum, places), reduce(np.maximum, places)
        if not over[0] < over[1]:
            raise ProblemError(
                _("the positions are one place"), path=("over",),
                allowed=_("over: [from, to]; or positions: {at: [...]}"),
            )  # fmt: skip
    assert not isinstance(over, str)
    if driver.kind != "turn" or driver.stroke is not None or (driver.acceleration and places):
        return over  # an accelerated crank comes to a place a turn farther on with another speed
    turns = round(float(problem.linkage.sketch.at - (over[0] + over[1]) / 2) / (2 * np.pi))
    return over[0] + 2 * np.pi * turns, over[1] + 2 * np.pi * turns  # about the sketch, whose assembly it has


def within(place: float, ends: Ends, *, turns: bool) -> float | None:
    """A place of the driver, whole turns away where that brings it between the ends; None: it does not go there."""
    if ends is None:
        return place
    low, high = float(ends[0]), float(ends[1])
    slack = 1e-9 * (high - low)
    if turns and not low - slack <= place <= high + slack:
        place += 2 * np.pi * np.ceil((low - slack - place) / (2 * np.pi))
    return place if low - slack <= place <= high + slack else None
