"""Four positions that no four-bar guides through: one of them put where a four-bar through the other three brings it.

Such a four-bar there always is: any two pins with their centres of the circles through three places. Many are tried,
and the coupler of the one that comes nearest to the given position is drawn on towards that as far as there is one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.burmester import Dyads, Poses, centre, marks
from tmm_cli.synthesis.coupler_dyads import LONGEST, QUICK, SHORTEST, Asked, fair
from tmm_cli.synthesis.record import Shown

PINS: Final = np.linspace(-1.4, 1.4, 11)  # over the size of the task, along both axes of the coupler
MOST: Final = 4000  # four-bars that are moved, of each three positions
SHARES: Final = np.linspace(0.15, 0.85, 48)  # of the way from the position before to the next: well apart from both
BEYOND: Final = np.radians(100)  # how far past the last of three positions the fourth may lie
TRANSMISSION: Final = np.radians(5)  # the least that will do
TRIED: Final = 6  # nearest ones
DRAWN: Final = 1 / 64  # share of the way towards the given position to which the edge is found


def whole_position(
    asked: Asked, solves: Callable[[Asked], bool], quickly: Callable[..., bool]
) -> dict[str, Shown] | None:
    """Which position, and its place and angle; None: none was found."""
    found = sorted((row for k in (1, 2, 3) for row in _nearest(asked, k)), key=lambda row: row[0])[:TRIED]
    for _, k, place, angle in found:

        def there(share: float, k: int = k, place: complex = place, angle: float = angle) -> Asked:
            places, angles = list(asked.places), list(asked.angles)
            places[k] = asked.places[k] + share * (place - complex(asked.places[k]))
            angles[k] = asked.angles[k] + share * (angle - float(asked.angles[k]))
            return replace(asked, places=tuple(places), angles=tuple(angles))

        if not quickly(there(1.0)):
            continue
        inside, outside = 1.0, 0.0
        while inside - outside > DRAWN:
            middle = (inside + outside) / 2
            inside, outside = (middle, outside) if quickly(there(middle), QUICK) else (inside, middle)
        share = next((s for s in (inside + DRAWN, 1.0) if s <= 1.0 and solves(there(s))), 1.0)
        new = there(share)
        return {
            "which": (str(k + 1), "word"), "x": (float(complex(new.places[k]).real), "length"),
            "y": (float(complex(new.places[k]).imag), "length"), "angle": (float(new.angles[k]), "angle"),
        }  # fmt: skip
    return None


def _nearest(asked: Asked, k: int) -> list[tuple[float, int, complex, float]]:
    """How far off (rad, shares of the size), the position's number, place (m) and angle (rad), the nearest first."""
    rest = [n for n in range(4) if n != k]
    poses = Poses(asked.poses.places[rest], asked.poses.angles[rest])
    pins = asked.size * (PINS[:, None] + 1j * PINS).ravel()
    with np.errstate(all="ignore"):
        pivots = centre(poses.on_frame(pins))
        lengths = np.abs(poses.on_frame(pins)[..., 0] - pivots) / asked.size
        good = np.isfinite(pivots) & (lengths > SHORTEST) & (lengths < LONGEST) & (asked.outside(pivots) <= 0)
        links = Dyads(pivots[good], np.asarray(pins[good], np.clongdouble))
        one, other = Dyads(links.pivot[:, None], links.pin[:, None]), links
        of = marks(poses, one, other)
        sound = (of.defect == 0) & (of.least > TRANSMISSION) & fair(asked, one, other)
        rows, columns = np.nonzero(sound)
        every = 1 + len(rows) // MOST
        rows, columns = rows[::every], columns[::every]
        if not len(rows):
            return []
        place, angle, least = _moved(poses, links[rows], links[columns], of.way[rows, columns], k)
    turned = np.angle(np.exp(1j * (angle - float(asked.angles[k]))))
    away = np.abs(turned) + np.abs(place - complex(asked.places[k])) / asked.size
    away = np.where(least > TRANSMISSION, away, np.inf)
    best = np.argsort(np.min(away, axis=1))[:TRIED]
    at = np.argmin(away[best], axis=1)
    return [
        (float(away[i, j]), k, complex(place[i, j]), float(asked.angles[k]) + float(turned[i, j]))
        for i, j in zip(best, at, strict=True) if np.isfinite(away[i, j])
    ]  # fmt: skip


def _moved(poses: Poses, one: Dyads, other: Dyads, way: Any, k: int) -> tuple[Any, Any, Any]:
    """Of four-bars, places (m) and angles (rad) of the coupler, and the transmission angles, (four-bars, places).

    They are moved along the part of their way where position k belongs.
    """
    b, c = (np.asarray(poses.on_frame(x.pin), complex) for x in (one, other))
    a, d = (np.asarray(x.pivot, complex)[:, None] for x in (one, other))
    sense = np.sign(np.asarray(way, float))
    turn = np.angle((b[:, 1:] - a) / (b[:, :-1] - a))
    turn = np.mod(sense[:, None] * turn, 2 * np.pi)  # from each of the three to the next, in the sense of the driver
    low = np.zeros(len(sense)) if k == 1 else turn[:, 0] if k == 2 else turn.sum(axis=1)
    high = turn[:, 0] if k == 1 else turn.sum(axis=1) if k == 2 else np.minimum(low + BEYOND, 2 * np.pi)
    phi = low[:, None] + (high - low)[:, None] * SHARES
    pin = a + (b[:, :1] - a) * np.exp(1j * sense[:, None] * phi)
    l2, l3 = np.abs(c - b)[:, :1], np.abs(c - d)[:, :1]
    side = np.sign(((c - b) * np.conj(d - b)).imag)[:, :1]  # of BD on which C lies
    base = d - pin
    gap = np.abs(base)
    cosine = (l2 * l2 + gap * gap - l3 * l3) / (2 * l2 * gap)
    coupler = base / gap * (cosine + 1j * np.sqrt(1 - cosine * cosine) * side)
    own = np.asarray(other.pin - one.pin, complex)[:, None]
    z = coupler / (own / np.abs(own))
    transmission = np.arcsin(np.clip(gap * np.sqrt(1 - cosine * cosine) / l3, 0, 1))
    place = pin - np.asarray(one.pin, complex)[:, None] * z
    return place, np.angle(z), np.where(np.isfinite(transmission), transmission, -1.0)
