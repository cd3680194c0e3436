"""Positions of a problem file."""

from __future__ import annotations

from typing import Any

from tmm_cli.linkage import Driver, Request
from tmm_cli.problem import schema
from tmm_cli.problem.errors import Path, ProblemError, quote
from tmm_cli.problem.sense import Sense
from tmm_cli.problem.units import ANGLE, LENGTH

MAX_WORK = 2_000_000  # positions times links


def build_request(shape: schema.File, driver: Driver, sense: Sense) -> Request:
    """Which positions the file asks for."""
    given = shape.positions
    wanted = ANGLE if driver.kind == "turn" else LENGTH
    places = tuple(
        sense.number(v, wanted, ("positions", "at", k)) for k, v in enumerate(given.at or ())
    )  # fmt: skip
    count = len(places) or given.count
    if count * len(shape.links) > MAX_WORK:
        raise ProblemError(
            "too many positions for so many links", path=("positions", "count"), found=str(count),
            allowed=f"at most {MAX_WORK // len(shape.links)}",
        )  # fmt: skip
    for k, number in enumerate(given.detail):
        if not 0 <= number < count:
            raise ProblemError(
                "there is no such position", path=("positions", "detail", k), found=str(number),
                allowed=f"0 to {count - 1}",
            )  # fmt: skip
    if given.from_ is None:
        return Request(count, 0.0, places, tuple(given.detail))
    if driver.kind == "slide" and not places:
        raise ProblemError(
            "positions of a driven slider go from one end of its way to the other", path=("positions", "from"),
            found=quote(given.from_) if isinstance(given.from_, str) else str(given.from_),
            allowed="driver: {stroke: [first, last]}, or positions: {at: [...]}", key=True,
        )  # fmt: skip
    if given.from_ == "working stroke":
        return Request(count, "working stroke", places, tuple(given.detail))
    start = sense.number(_value(given.from_, ("positions", "from")), wanted, ("positions", "from"))
    return Request(count, start, places, tuple(given.detail))


def _value(value: Any, path: Path) -> Any:
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise ProblemError("an angle or `working stroke` is wanted", path=path, found=quote(value))
    return value
