"""Which position it is and where the driver stands, in words: for tables and drawings."""

from __future__ import annotations

import math

from tmm_cli.problem.dimensions import ANGLE, LENGTH
from tmm_cli.problem.record import Problem
from tmm_cli.words import say


def place(problem: Problem, q: float, number: int | None) -> str:
    """The driver's place q (rad or m) in the units of the file; the place of the sketch has no number."""
    crank = problem.linkage.driver.kind == "turn"
    measure = ANGLE if crank else LENGTH
    value = problem.units.from_si(q % math.tau if crank else q, measure)
    at = f"{round(value, 9) + 0.0:.6g} {problem.units.symbol(measure)}"
    where = say("scheme.at_crank" if crank else "scheme.at_slider", place=at)
    if number is None:
        return say("assemblies.at_sketch", where=where)
    return say("assemblies.at_position", number=number, where=where)
