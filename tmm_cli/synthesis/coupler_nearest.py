"""Why a four-bar does not guide a coupler as it should, and the nearest choice with which one does."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.burmester import Dyads, by_turn, centre, marks
from tmm_cli.synthesis.coupler_dyads import FAR, SIDES, TURNS, Asked, Side, W, dyad, exists, fair, of_turn, reach, rows
from tmm_cli.synthesis.coupler_dyads import NEAR as CLOSE
from tmm_cli.synthesis.record import Infeasible, Shown

USABLE: Final = np.radians(1.0)  # of least transmission: a choice that is told gives a four-bar that moves
GRID: Final = np.radians(0.1)  # of turns that are tried
COARSE: Final = np.radians(0.5)  # the same, where the other link is free
INWARDS: Final = 1e-6  # rad, or a share of a length, from where there is a sound four-bar first
RINGS: Final = np.geomspace(0.01, 3.0, 80)  # about a given point, over the size of the task, and
ROUND: Final = 48  # places on each
ROOM: Final = 1e-4  # of a ring: so far around a place the four-bar must be sound too
SHARE: Final = 0.02  # by which a length is changed, and
TIMES: Final = 20.0  # how far


def refuse_turn(asked: Asked, name: str, given: Mapping[str, Dyads]) -> None:
    """No link turns as asked: raises Infeasible with the nearest turn that is sound, or that there is at all."""
    key, reason = f"{name}_turn", f"{W}.no_turn"
    values: dict[str, Shown] = {}
    own = given[name]
    if np.isfinite(reach(asked, own)):
        length = float(abs(asked.poses.on_frame(own.pin)[..., 0] - own.pivot))
        reason, values = f"{W}.far_turn", {"length": (length, "length"), "name": (name, "word")}
    others = [found for other, found in given.items() if other != name and bool(exists(asked, found))]
    if asked.keep:
        told = _nearest(lambda turns: exists(asked, of_turn(asked, name, turns), CLOSE), asked.sides[name].turn, GRID)
    else:
        told = _turn(asked, name, others[0] if others else None) if others or len(given) == 1 else None
    if told is not None:
        raise Infeasible(key, reason, f"{W}.nearest_turn", values | {"turn": told})
    words, told_values = _by_both_turns(asked)
    raise Infeasible(key, reason, f"{W}.{words}", values | told_values)


def refuse_defect(asked: Asked, one: Dyads, other: Dyads, defect: str) -> None:
    """Raises Infeasible with the defect by its name, and what helps."""
    count = len(asked.places)
    find = {2: _by_lengths, 3: _by_points, 4: _by_turns}[count]
    words, values = find(asked, one, other)
    swap = int(marks(asked.poses, other, one).defect) == 0
    if asked.within is not None and words == "turns":
        words = "wider_box"
    if swap:
        words = f"{words}_swap" if words in ("sides", "length", "point", "turn", "turns") else "swap"
    raise Infeasible("positions", f"{W}.has_{defect}", f"{W}.{words}", values)


def _sound(asked: Asked, one: Any, other: Any) -> Any:
    """Whether four-bars are without defects and not all but dead, broadcast together."""
    with np.errstate(all="ignore"):
        far = CLOSE if len(asked.places) == 4 else FAR
        found = marks(asked.poses, one, other)
        moves = (found.defect == 0) & (found.least > USABLE)
        return moves & exists(asked, one, far) & exists(asked, other, far)


def _pair(name: str, own: Dyads, other: Dyads) -> tuple[Dyads, Dyads]:
    return (own, other) if name == "AB" else (other, own)


def _nearest(good: Callable[[Any], Any], given: Any, step: float) -> Shown | None:
    """The turn (rad) nearest to a given one that is good, to the edge between it and what is not."""
    steps = step * np.arange(1, round(np.pi / step) + 1)
    at = float(given) + np.stack([steps, -steps], axis=-1).ravel()
    here = np.flatnonzero(good(at))
    if not here.size:
        return None
    turn = float(at[here[0]])
    sign = float(np.sign(turn - float(given)))
    inside, outside = turn, turn - sign * step
    for _ in range(40):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if good(np.array([middle]))[0] else (inside, middle)
    return inside + sign * INWARDS, "angle", "least" if sign > 0 else "most"


def _turn(asked: Asked, name: str, other: Dyads | None) -> Shown | None:
    """The nearest turn of a link whose four-bar is sound with the other link, or with some other link of the curves."""
    side = asked.sides[name]
    if side.turn is None:
        return None
    if other is not None:
        return _nearest(lambda turns: _sound(asked, *_pair(name, of_turn(asked, name, turns), other)), side.turn, GRID)
    grid = -np.pi + 2 * np.pi * (np.arange(TURNS) + 0.5) / TURNS
    rest, _ = rows(asked, {}, grid, None, "DC" if name == "AB" else "AB")

    def good(turns: Any) -> Any:
        own = by_turn(asked.poses, turns, side.branch)[:, None]
        pair = _pair(name, own, rest[None, :])
        with np.errstate(all="ignore"):
            return np.any(_sound(asked, *pair) & fair(asked, *pair), axis=-1)

    return _nearest(good, side.turn, COARSE)


def _by_turns(asked: Asked, one: Dyads, other: Dyads) -> tuple[str, dict[str, Shown]]:
    """Four positions: another turn of AB or DC, the one that is nearer to what was asked."""
    found = []
    for name, rest in (("AB", other), ("DC", one)):
        if name in asked.sides and asked.sides[name].turn is not None:
            told = _turn(asked, name, rest if len(asked.sides) == 2 else None)
            if told is not None:
                found.append((abs(told[0] - float(asked.sides[name].turn)), name, told))
    if not found:
        return _by_both_turns(asked)
    _, name, told = min(found, key=lambda row: row[0])
    return "turn", {"turn": told, "name": (f"{name}_turn", "word")}


def _by_both_turns(asked: Asked) -> tuple[str, dict[str, Shown]]:
    """Four positions: the pair of links on Burmester's curves without defects that is nearest to what was asked."""
    grid = -np.pi + 2 * np.pi * (np.arange(TURNS) + 0.5) / TURNS
    turns, branches = np.tile(grid, 2), np.repeat([0, 1], TURNS)
    halves = [by_turn(asked.poses, grid, branch) for branch in (0, 1)]
    links = Dyads(*(np.concatenate([getattr(x, key) for x in halves]) for key in ("pivot", "pin")))
    good = _sound(asked, links[:, None], links[None, :]) & fair(asked, links[:, None], links[None, :])
    if not np.any(good):
        return "other_positions", {}
    away = []
    for name in ("AB", "DC"):
        side = asked.sides.get(name, Side())
        if side.turn is not None:
            away.append(np.abs(turns - float(side.turn)) + COARSE * (branches != side.branch))
        elif side.near is not None:
            away.append(np.abs(np.asarray(links.pivot, complex) - complex(side.near)) / asked.size)
        else:
            away.append(np.zeros(len(turns)))
    cost = np.where(good, away[0][:, None] + away[1][None, :], np.inf)
    i, j = np.unravel_index(int(np.argmin(cost)), cost.shape)
    return "turns", {
        "one": (float(turns[i]), "angle"), "first": (str(branches[i] + 1), "word"),
        "other": (float(turns[j]), "angle"), "second": (str(branches[j] + 1), "word"),
    }  # fmt: skip


def _by_points(asked: Asked, one: Dyads, other: Dyads) -> tuple[str, dict[str, Shown]]:
    """Three positions: another pin or pivot, the one that is nearer to what was asked."""
    ring = np.exp(2j * np.pi * np.arange(ROUND) / ROUND)
    around = ROOM * np.array([0, 1, 1j, -1, -1j])
    found = []
    for name, rest in (("DC", one), ("AB", other)):
        side = asked.sides[name]
        is_pin = side.pin is not None
        given = complex(side.pin if is_pin else side.pivot)
        radii = asked.size * RINGS[:, None, None]
        points = np.asarray(given + radii * (ring[:, None] + around), np.clongdouble)
        places = asked.poses.on_frame(points) if is_pin else asked.poses.in_plane(points)
        own = Dyads(centre(places), points) if is_pin else Dyads(points, centre(places))
        good = np.all(_sound(asked, *_pair(name, own, rest)), axis=-1)
        if np.any(good):
            k = int(np.argmax(np.any(good, axis=-1)))
            place = complex(points[k, int(np.argmax(good[k])), 0])
            found.append((abs(place - given), name[1] if is_pin else name[0], place))
    if not found:
        return "other_points", {}
    _, letter, place = min(found, key=lambda row: row[0])
    return "point", {"x": (place.real, "length"), "y": (place.imag, "length"), "point": (letter, "word")}


def _by_lengths(asked: Asked, one: Dyads, other: Dyads) -> tuple[str, dict[str, Shown]]:
    """Two positions: other sides of the chords, else another length."""

    def sound(tried: Asked) -> bool:
        try:
            return bool(_sound(tried, dyad(tried, "AB"), dyad(tried, "DC")))
        except Infeasible:
            return False

    for first in SIDES:
        for second in SIDES:
            turned = {name: replace(asked.sides[name], side=x) for name, x in (("AB", first), ("DC", second))}
            if sound(replace(asked, sides=turned)):
                return "sides", {"one": (first, "word"), "other": (second, "word")}
    for share in np.arange(SHARE, np.log(TIMES), SHARE):
        for name in ("AB", "DC"):
            for sign in (1.0, -1.0):
                edge = _length(asked, name, sign, float(share), sound)
                if edge is not None:
                    return "length", {"length": edge, "name": (name, "word")}
    return "other_points", {}


def _length(asked: Asked, name: str, sign: float, share: float, sound: Callable[[Asked], bool]) -> Shown | None:
    """The edge of the sound lengths (m) of a link between two shares of its change; None: it is not sound there."""
    side: Side = asked.sides[name]

    def good(change: float) -> bool:
        changed = replace(side, length=side.length * float(np.exp(sign * change)))
        return sound(replace(asked, sides={**asked.sides, name: changed}))

    if not good(share):
        return None
    inside, outside = share, share - SHARE
    for _ in range(40):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if good(middle) else (inside, middle)
    value = float(side.length) * float(np.exp(sign * (inside + INWARDS)))
    return value, "length", "least" if sign > 0 else "most"
