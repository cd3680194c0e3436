"""Whether an optimal synthesis asks for what its linkage has: parameters that count, outputs with strokes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from tmm_cli.stack import numbers
from tmm_cli.strokes import output_link
from tmm_cli.synthesis.goals import STROKES, Goal
from tmm_cli.synthesis.record import Infeasible

if TYPE_CHECKING:
    from tmm_cli.synthesis.candidates import Search

W = "synthesis_optimal"
At = tuple[str | int, ...]


def asked_goals(search: Search) -> list[tuple[At, Goal]]:
    """Objective and constraints with their places in what is asked."""
    return [(("objective",), search.goals[0]), *((limit.at, limit.goal) for limit in search.asked.limits)]


def check_use(search: Search) -> None:
    """Every parameter changes something. Raises Infeasible."""
    before = dict(numbers(search.variant))
    for k, name in enumerate(search.asked.low):
        other = list(search.first)
        low, high = float(search.low[k]), float(search.high[k])
        other[k] = low if abs(other[k] - low) > abs(other[k] - high) else high
        if dict(numbers(search.asked.make(other))) == before:
            raise Infeasible(("vary", name), f"{W}.unused", f"{W}.used")


def check_output(search: Search) -> None:
    """What belongs to an output wants one that has it. Raises Infeasible."""
    for at, goal in asked_goals(search):
        if goal.of in STROKES and output_link(search.linkage, search.groups) is None:
            raise Infeasible(at, f"{W}.no_output", f"{W}.an_output")
        if goal.of == "speed" and not goal.slides(search.linkage, search.groups):
            raise Infeasible(at, f"{W}.swings", f"{W}.slider")
