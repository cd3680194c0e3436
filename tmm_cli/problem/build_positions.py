"""Positions of a problem file."""

from __future__ import annotations

from tmm_cli.errors import _
from tmm_cli.linkage import Driver, Request
from tmm_cli.problem import schema
from tmm_cli.problem.errors import ProblemError
from tmm_cli.problem.values import ValueReader
from tmm_cli.quantities import ANGLE, LENGTH

MAX_WORK = 2_000_000  # positions times links


def build_request(shape: schema.File, driver: Driver, values: ValueReader) -> Request:
    """Which positions the file asks for."""
    given = shape.positions
    wanted = ANGLE if driver.kind == "turn" else LENGTH
    places = tuple(
        values.number(v, wanted, ("positions", "at", k)) for k, v in enumerate(given.at or ())
    )  # fmt: skip
    count = len(places) or given.count
    if count * len(shape.links) > MAX_WORK:
        raise ProblemError(
            _("too many positions for so many links"), path=("positions", "count"), found=str(count),
            allowed=_("at most {most}").format(most=MAX_WORK // len(shape.links)),
        )  # fmt: skip
    for k, number in enumerate(given.detail):
        if not 0 <= number < count:
            raise ProblemError(
                _("there is no such position"), path=("positions", "detail", k), found=str(number),
                allowed=_("0 to {last}").format(last=count - 1),
            )  # fmt: skip
    if given.from_ is None:
        return Request(count, 0.0, places, tuple(given.detail))
    if driver.kind == "slide" and not places:
        raise ProblemError(
            _("positions of a driven slider go from one end of its way to the other"), path=("positions", "from"),
            found=str(given.from_), allowed=_("driver: {stroke: [first, last]}, or positions: {at: [...]}"), key=True,
        )  # fmt: skip
    if given.from_ == "working stroke":
        return Request(count, "working stroke", places, tuple(given.detail))
    start = values.number(given.from_, wanted, ("positions", "from"))
    return Request(count, start, places, tuple(given.detail))
