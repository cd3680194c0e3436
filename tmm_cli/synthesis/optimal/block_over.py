"""Where the driver goes in an optimal synthesis: round a cycle, along its stroke, through the positions of the file, or
from one place to another.
"""

from __future__ import annotations

from functools import reduce
from typing import Any

import numpy as np

from tmm_cli.language import _
from tmm_cli.linkage import Driver
from tmm_cli.problem.errors import ProblemError, quote
from tmm_cli.problem.record import Problem
from tmm_cli.problem.tree import Path
from tmm_cli.problem.units import UnitSystem
from tmm_cli.problem.values import ValueReader
from tmm_cli.quantities import ANGLE, LENGTH, Dimension
from tmm_cli.synthesis.optimal.block_ranges import two
from tmm_cli.variants.variant import Variant

Ends = tuple[Any, Any] | None
Over = str | tuple[float, float]


def asked_over(over: Any, driver: Driver, sense: ValueReader) -> Over:
    """What the key `over` says, with places in SI; what is usual where it is left out. Raises ProblemError."""
    turns, stroked = driver.kind == "turn", driver.stroke is not None
    ways = {"cycle": turns and not stroked, "stroke": stroked, "positions": True}
    possible = [way for way, has in ways.items() if has]
    if over is None:
        return possible[0]
    if isinstance(over, str):
        if over not in possible:
            raise ProblemError(
                _("the driver has no {over}").format(over=over), path=("over",), found=quote(over),
                allowed=", ".join([*possible, "[from, to]"]),
            )  # fmt: skip
        return over
    low, high = (float(sense.number(value, _dimension(driver), ("over", n))) for n, value in enumerate(over))
    if not low < high or (turns and high - low > 2 * np.pi * (1 + 1e-12)):
        raise ProblemError(
            _("the lower end comes first, the other one at most a turn after it"), path=("over",), found=two(*over),
            allowed="[from, to]",
        )  # fmt: skip
    return low, high


def driven(problem: Problem, over: Over) -> Variant:
    """The linkage of a file with the way of its driver. Raises ProblemError."""
    ends, stroke = _ends(problem, over), problem.linkage.driver.stroke
    if ends is not None and stroke is not None and not (stroke[0] <= ends[0] and ends[1] <= stroke[1]):
        raise _not_there(("over",), over, problem.linkage.driver, stroke, problem.units)
    return Variant(problem.linkage, problem.request, ends)


def _ends(problem: Problem, over: Over) -> Ends:
    driver, places = problem.linkage.driver, problem.request.places
    if over == "cycle":
        return None
    if over == "stroke" or (over == "positions" and driver.stroke is not None and not places):
        return driver.stroke
    if over == "positions":
        over = (reduce(np.minimum, places), reduce(np.maximum, places)) if places else (0.0, 0.0)
        if not over[0] < over[1]:
            raise ProblemError(
                _("how far the driver goes is wanted"), path=("over",),
                allowed=_("over: [from, to]; or positions: {at: [...]}, or driver: {stroke: [from, to]}"),
            )  # fmt: skip
    assert not isinstance(over, str)
    if driver.kind != "turn" or driver.stroke is not None or (driver.acceleration and places):
        return over  # an accelerated crank comes to a place a turn farther on with another speed
    turns = round(float(problem.linkage.sketch.at - (over[0] + over[1]) / 2) / (2 * np.pi))
    return over[0] + 2 * np.pi * turns, over[1] + 2 * np.pi * turns  # about the sketch, whose assembly it has


def place_of(value: Any, variant: Variant, sense: ValueReader, path: Path) -> Any:
    """A place on the driver's way, whole turns away where that brings it there. Raises ProblemError."""
    driver = variant.linkage.driver
    place: Any = sense.number(value, _dimension(driver), path)
    if variant.ends is None:
        return place
    low, high = (float(end) for end in variant.ends)
    slack = 1e-9 * (high - low)
    if driver.kind == "turn" and not low - slack <= place <= high + slack:
        place = place + 2 * np.pi * np.ceil(float(low - slack - place) / (2 * np.pi))
    if not low - slack <= place <= high + slack:
        raise _not_there(path, value, driver, (low, high), sense.units)
    return place


def _dimension(driver: Driver) -> Dimension:
    return ANGLE if driver.kind == "turn" else LENGTH


def _not_there(path: Path, found: Any, driver: Driver, ends: tuple[Any, Any], units: UnitSystem) -> ProblemError:
    dimension = _dimension(driver)
    low, high = (f"{units.from_si(float(end), dimension):.6g}" for end in ends)
    return ProblemError(
        _("the driver does not go there"), path=path, found=quote(found) if isinstance(found, str) else None,
        allowed=_("places of its way, {low} to {high} {unit}").format(
            low=low, high=high, unit=units.symbol(dimension)
        ),
    )  # fmt: skip
