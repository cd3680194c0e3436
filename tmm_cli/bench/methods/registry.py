"""Ways to compute a linkage, the product's own and its rivals, in one form: a new one is a file and a line here."""

from __future__ import annotations

from tmm_cli.bench.methods import board, differences, loops, multibody, precision, taped
from tmm_cli.bench.methods.case import Method

OURS = Method("closed", "closed", precision.double)
TAPED = Method("taped", "taped", taped.prepare)
METHODS: tuple[Method, ...] = (
    OURS,
    TAPED,
    *(Method(f"newton-{k}", "newton", loops.prepare(10.0**-k), 10.0**-k) for k in range(2, 16)),
    Method("multibody", "multibody", multibody.prepare),
    *(Method(f"differences-{k}", "differences", differences.prepare(10.0**-k), 10.0**-k) for k in range(1, 9)),
    Method("single", "single", precision.single),
    Method("extended", "extended", precision.extended),
    *(Method(f"board-{mm:.2f}", "board", board.prepare(mm), mm, timed=False) for mm in (0.25, 0.5)),
)
LEFT_OUT = ("newton-3", "newton-5", "newton-7", "newton-9", "newton-11", "newton-13", "differences-5", "differences-7")
FEWER = tuple(method for method in METHODS if method.name not in LEFT_OUT)
