"""Turns of links beyond the nearest sound one, whose four-bar has a transmission angle that will do.

At the nearest one, which is an edge, it may be none at all.
"""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.burmester import Dyads, by_turn, marks
from tmm_cli.synthesis.coupler_dyads import Asked, fair
from tmm_cli.synthesis.coupler_points import pair, sound
from tmm_cli.synthesis.record import Shown

DEGREE: Final = float(np.radians(1))
ENOUGH: Final = 30 * DEGREE  # of least transmission, or
NEARLY: Final = 0.9  # of the best one
TRIED: Final = 90  # whole degrees beyond the nearest turn


def transmission(asked: Asked, one: Dyads, other: Dyads) -> Any:
    """Least transmission angles (rad) of four-bars without defects; -inf of the others."""
    with np.errstate(all="ignore"):
        good = sound(asked, one, other) & fair(asked, one, other)
        return np.where(good, marks(asked.poses, one, other).least, -np.inf)


def usable_turn(asked: Asked, name: str, rest: Dyads, told: Shown) -> dict[str, Shown]:
    """The nearest turn of a link in whole degrees beyond the one told, and its least transmission; none: nothing.

    rest: other links of the curves, any of which will do.
    """
    side = asked.sides[name]
    sign = 1.0 if told[2:] == ("least",) else -1.0
    turns = DEGREE * sign * (np.ceil(sign * float(told[0]) / DEGREE) + np.arange(TRIED))
    turns = turns[np.abs(turns - float(side.turn)) < np.pi]
    own = by_turn(asked.poses, turns, side.branch)
    both = pair(
        name, Dyads(own.pivot[:, None], own.pin[:, None]), Dyads(*(np.atleast_1d(x) for x in (rest.pivot, rest.pin)))
    )
    least = np.max(transmission(asked, *both), axis=1, initial=-np.inf)
    if not np.max(least, initial=-np.inf) > DEGREE:
        return {}
    k = int(np.argmax(least >= enough(least)))
    return {"usable": (float(turns[k]), "angle"), "transmission": (whole(float(least[k])), "angle")}


def enough(least: Any) -> float:
    """What will do of some least transmission angles (rad)."""
    return min(ENOUGH, NEARLY * float(np.max(least)))


def whole(angle: float) -> float:
    """The whole degrees in an angle (rad)."""
    return DEGREE * float(np.floor(angle / DEGREE + 1e-9))
