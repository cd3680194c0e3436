"""Ways to compute a linkage, the product's own and its rivals, in one form: a new one is a file and a line here."""

from __future__ import annotations

from tmm_cli.accuracy import board, closed, differences, loops, multibody, precision
from tmm_cli.accuracy.case import QUANTITIES, Answers, Case, Method, Quantity, errors

__all__ = ["METHODS", "OURS", "QUANTITIES", "Answers", "Case", "Method", "Quantity", "errors"]

OURS = Method("groups", "groups, closed form", closed.prepare)
METHODS: tuple[Method, ...] = (
    OURS,
    *(Method(f"newton-{k}", "Newton on loop closure", loops.prepare(10.0**-k), 10.0**-k) for k in range(2, 16)),
    Method("multibody", "whole Jacobian, multipliers", multibody.prepare),
    *(Method(f"differences-{k}", "differencing", differences.prepare(10.0**-k), 10.0**-k) for k in range(1, 9)),
    Method("single", "groups, single precision", precision.single),
    Method("extended", "groups, extended precision", precision.extended),
    *(Method(f"board-{mm:.2f}", "drawing board", board.prepare(mm), mm, timed=False) for mm in (0.25, 0.5)),
)
