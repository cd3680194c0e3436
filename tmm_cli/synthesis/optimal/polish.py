"""Local polish: sequential quadratic programming by scipy (D. Kraft's SLSQP) with central differences.

The largest of several pieces is minimised as a bound t above all of them, so that minimax has a smooth form. Places are
counted from the start, in steps after which the steepest piece would be gone if it went on as it begins: the method
takes the first curvature for 1, and where pieces are steep its first steps would leave the valley that was found.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from tmm_cli.vectors import Real

STEP = 2e-6  # of a derivative, in shares of the range
DONE = 1e-11  # of the objective: what a further step may still bring
MOST = 60  # steps
IDLE = 3  # steps that bring no more, as where a piece is pointed and its slope promises what no step holds
TOO_FAR = 1e6  # a piece's value where a step leads to what cannot be assembled, against about 1 at the start
WEIGHT = 10.0  # of what is violated beside the objective, where steps are compared


@dataclass(frozen=True)
class Local:
    """What a problem gives for variants (v): pieces of the objective, inequalities >= 0, equalities, each (v, n)."""

    pieces: Real
    least: Real
    equal: Real


class _End(Exception):  # noqa: N818  where the steps end
    """The first candidate cannot be assembled, or steps bring no more."""


class _Differences:
    """Values and slopes of a Local's parts at a place, each (values,) and (values, n), kept for the next call."""

    def __init__(self, evaluate: Callable[[Real], Local], size: int) -> None:
        self.evaluate, self.size = evaluate, size
        self.at: Real = np.full(size, np.nan)
        self.found: tuple[tuple[Real, Real], ...] = ()

    def __call__(self, x: Real) -> tuple[tuple[Real, Real], ...]:
        """Where something cannot be assembled, a step too far: values out of all proportion. Raises _End at once."""
        n = self.size
        if not np.array_equal(x, self.at):
            ends = np.clip(x + np.vstack([np.zeros(n), STEP * np.eye(n), -STEP * np.eye(n)]), 0, 1)
            local = self.evaluate(ends)
            run = np.diag(ends[1 : n + 1] - ends[n + 1 :])[:, None]
            parts = (local.pieces, local.least, local.equal)
            found = tuple((y[0], ((y[1 : n + 1] - y[n + 1 :]) / run).T) for y in parts)
            if not all(np.all(np.isfinite(part)) for both in found for part in both):
                if not self.found:
                    raise _End
                (pieces, slopes), *others = self.found
                return (np.full_like(pieces, TOO_FAR), slopes), *others
            self.at, self.found = x.copy(), found
        return self.found


def polish(evaluate: Callable[[Real], Local], x: Real) -> Real:
    """The nearest best place in 0..1 from x (n,)."""
    from scipy.optimize import minimize

    n, differences = len(x), _Differences(evaluate, len(x))
    steps: list[tuple[float, Real]] = []  # how bad each is, and where
    idle = 0
    scale = 1.0

    def place(z: Real) -> Real:
        return np.clip(x + scale * z[:n], 0, 1)

    def near(z: Real) -> tuple[tuple[Real, Real], ...]:
        return tuple((values, scale * slopes) for values, slopes in differences(place(z)))

    def take(z: Real) -> None:
        """Notes a step; raises _End."""
        nonlocal idle
        f, c, e = (values for values, slopes in near(z))
        bad = float(np.max(f) + WEIGHT * (np.sum(np.maximum(-c, 0)) + np.sum(np.abs(e))))
        idle = idle + 1 if steps and not bad < min(step[0] for step in steps) - DONE else 0
        steps.append((bad, place(z)))
        if idle > IDLE:
            raise _End

    def above(z: Real) -> Real:
        """t over every piece, and the inequalities."""
        pieces, least, __ = near(z)
        return np.append(z[n] - pieces[0], least[0])

    def above_slope(z: Real) -> Real:
        f, c = (slopes for values, slopes in near(z)[:2])
        return np.vstack([np.hstack([-f, np.ones((len(f), 1))]), np.hstack([c, np.zeros((len(c), 1))])])

    def even_slope(z: Real) -> Real:
        e = near(z)[2][1]
        return np.hstack([e, np.zeros((len(e), 1))])

    try:
        start = np.zeros(n)
        take(start)
        f, e = near(start)[0][0], near(start)[2][0]
        size, steepest = float(np.max(np.abs(f))), float(np.max(np.abs(near(start)[0][1])))
        scale = size / steepest if 0 < size < steepest else 1.0
        constraints = [{"type": "ineq", "fun": above, "jac": above_slope}]
        if len(e):
            constraints.append({"type": "eq", "fun": lambda z: near(z)[2][0], "jac": even_slope})
        bounds = [(-own / scale, (1 - own) / scale) for own in x]
        found = minimize(
            lambda z: z[n], np.append(start, np.max(f)), jac=lambda z: np.eye(n + 1)[n], method="SLSQP",
            bounds=[*bounds, (None, None)], constraints=constraints, callback=take,
            options={"ftol": DONE, "maxiter": MOST},
        )  # fmt: skip
        take(found.x)
    except _End:
        pass
    return min(steps, key=lambda step: step[0])[1] if steps else x
