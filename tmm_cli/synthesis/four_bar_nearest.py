"""The nearest k, or the nearest turn of the rocker's extreme positions, with which a four-bar by k has a pivot that is
chosen by a length, or as high as D.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.crank_slider import k_of
from tmm_cli.synthesis.four_bar_arcs import ARC, Asked, Found, arcs, at, places
from tmm_cli.synthesis.four_bar_level import level_places
from tmm_cli.synthesis.record import Infeasible, Shown

W: Final = "synthesis_four_bar_by_k"
SCAN: Final = 100  # values of theta that are tried on either side
INWARDS: Final = 1e-6  # rad of theta, from where there is such a pivot first: an end of an arc
TURNED: Final = 5e-5  # rad, so when both positions are turned; or so many times that, where
MORE: Final = 2.0 ** np.arange(9)
ROUNDED: Final = 1e-5  # of each of them, which six digits may add to it, leaves no such pivot else
LEAST: Final = 1e-3  # rad: the least theta that is tried


def gap(asked: Asked, equation: Callable[[Found, Asked], Any]) -> float:
    """What is nearest to none of what is to vanish along the arcs; 0 where it does somewhere."""
    rows = [equation(at(asked, places(asked, side), side), asked) for side in arcs(asked)]
    if any(np.min(row) <= 0 <= np.max(row) for row in rows):
        return 0.0
    every = np.concatenate([*rows, [np.inf]])
    return float(every[np.argmin(np.abs(every))])


def nearest_k(asked: Asked, equation: Callable[[Found, Asked], Any]) -> Shown | None:
    """The nearest k for which an arc has the pivot; None: there is none."""

    def good(theta: float) -> bool:
        return gap(replace(asked, k=float(k_of(theta))), equation) == 0

    theta, most = float(asked.theta), np.pi / 2 + float(asked.swing) / 2 - 2 * ARC
    tried = np.unique([*np.linspace(LEAST, most, SCAN), *(theta + (most - theta) * np.linspace(0, 1, SCAN)[1:])])
    tried = tried[(tried >= LEAST) & (tried <= most)]
    inside = next((float(x) for x in tried[np.argsort(np.abs(tried - theta))] if good(float(x))), None)
    if inside is None:
        return None
    outside, up = theta, inside > theta
    if theta > most and good(most):
        inside = outside = most
    for _ in range(40):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if good(middle) else (inside, middle)
    return float(k_of(inside + (INWARDS if up else -INWARDS))), "number", "least" if up else "most"


def not_level(asked: Asked, equation: Callable[[Found, Asked], Any]) -> Infeasible:
    """No pivot is as high as D: how near they come, and the nearest k for which one is, or the nearest turn of both
    extreme positions.
    """
    offset = gap(asked, equation)
    values: dict[str, Shown] = {"offset": (abs(offset), "length")}
    words = "level_higher" if offset > 0 else "level_lower"
    if (k := nearest_k(asked, equation)) is not None:
        values["k"] = k
        return Infeasible("choose", f"{W}.level_none", f"{W}.{words}_{'more' if k[2] == 'least' else 'less'}", values)
    turn = _turn(asked)
    if turn is None:
        return Infeasible("choose", f"{W}.level_none", f"{W}.{words}", values)
    side = "least" if turn > 0 else "most"
    for name in ("psi1", "psi2"):
        values[name] = (float(getattr(asked, name)) + turn, "angle", side)
    return Infeasible("choose", f"{W}.level_none", f"{W}.{words}_turned", values | {"turn": (abs(turn), "angle")})


def _turn(asked: Asked) -> float | None:
    """By how much both extreme positions are to be turned (rad) that a pivot is as high as D; None: by no amount."""
    off = np.concatenate([np.angle(at(asked, places(asked, s), s).a - asked.support) for s in arcs(asked)])
    off = -(off - np.pi * np.round(off / np.pi))  # A may be on either side of D
    for turn in off[np.argsort(np.abs(off))][:: max(1, len(off) // SCAN)]:
        for more in MORE:
            told = float(turn + np.copysign(TURNED * more, turn))
            ends = [float(psi) + told for psi in (asked.psi1, asked.psi2)]
            added = [float(np.copysign(ROUNDED * abs(psi), turn)) for psi in ends]
            if all(
                _level(replace(asked, psi1=ends[0] + one, psi2=ends[1] + other))
                for one in (0.0, added[0]) for other in (0.0, added[1])
            ):  # fmt: skip
                return told
    return None


def _level(asked: Asked) -> bool:
    """Whether a pivot is as high as D."""
    return any(_on(asked, w, side) for side in arcs(asked) for w in level_places(asked))


def _on(asked: Asked, w: Any, side: int) -> bool:
    """Whether a place whose pivot is level, on one of the circles, is on this arc."""
    low, high = places(asked, side)[[0, -1]]
    if not low < w < high:
        return False
    found = at(asked, float(w), side)
    return bool(abs(found.a.imag - np.imag(asked.support)) < 1e-6 * (found.l2 + asked.l3))
