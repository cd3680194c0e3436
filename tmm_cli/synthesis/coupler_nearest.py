"""Why a four-bar does not guide a coupler as it should, and the nearest choice with which one does."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.burmester import Dyads, by_turn, marks
from tmm_cli.synthesis.coupler_dyads import (
    QUICK,
    SIDES,
    TURNS,
    Asked,
    Side,
    W,
    dyad,
    exists,
    fair,
    of_turn,
    reach,
    rows,
)  # fmt: skip
from tmm_cli.synthesis.coupler_points import by_points, pair, parted, sound
from tmm_cli.synthesis.coupler_usable import usable_turn
from tmm_cli.synthesis.nearest_positions import LESS, limit, soluble
from tmm_cli.synthesis.nearest_turns import by_both_turns
from tmm_cli.synthesis.record import Infeasible, Shown

GRID: Final = np.radians(0.1)  # of turns that are tried
COARSE: Final = np.radians(0.5)  # the same, where the other link is free
INWARDS: Final = 1e-6  # rad, or a share of a length, from where there is a sound four-bar first
ROUNDED: Final = 1e-5  # what six digits may add to a length
DEAD: Final = 1e-6  # rad of transmission, more than rounding makes of none, as in a kite whose C lies on A
SHARE: Final = 0.02  # by which a length is changed, and
TIMES: Final = 20.0  # how far
SWAPPED: Final = ("sides", "length", "point", "turn", "turns", "turns_no_box")  # words that name DC as driver too


def refuse_turn(asked: Asked, name: str, given: Mapping[str, Dyads]) -> None:
    """No link turns as asked: raises Infeasible with the nearest turn that is sound, or that there is at all."""
    key, reason = f"{name}_turn", f"{W}.no_turn"
    values: dict[str, Shown] = {}
    own = given[name]
    if np.isfinite(reach(asked, own)):
        length = float(abs(asked.poses.on_frame(own.pin)[..., 0] - own.pivot))
        reason, values = f"{W}.far_turn", {"length": (length, "length"), "name": (name, "word")}
    others = [found for other, found in given.items() if other != name and bool(exists(asked, found))]
    rest = others[0] if others else None
    if asked.keep:
        told = _nearest(lambda turns: exists(asked, of_turn(asked, name, turns)), asked.sides[name].turn, GRID)
    else:
        told = _turn(asked, name, rest) if others or len(given) == 1 else None
    if told is not None:
        usable = {} if asked.keep else _usable(asked, name, rest, told)
        raise Infeasible(key, reason, f"{W}.nearest_turn{'_usable' * bool(usable)}", values | {"turn": told} | usable)
    words, told_values = by_both_turns(asked)
    words += "_usable" * ("usable" in told_values) + "_alone" * (words == "turns")
    raise Infeasible(key, reason, f"{W}.{words}", values | told_values)


def refuse_point(asked: Asked, one: Dyads, other: Dyads, names: str) -> None:
    """Both pins, or both pivots, are one: raises Infeasible with the nearest choice of one link that parts them."""
    words, values = (_by_turns if len(asked.places) == 4 else parted)(asked, one, other)
    words += "_usable" * ("usable" in values) + "_alone" * (words in SWAPPED)
    side = asked.sides.get("DC", Side())
    key = "positions" if side == Side() else "DC_turn" if side.turn is not None else "D_near"
    key = "C" if side.pin is not None else "D" if side.pivot is not None else key
    raise Infeasible(key, f"{W}.one_point", f"{W}.{words}", values | {"names": (names, "word")})


def refuse_defect(asked: Asked, one: Dyads, other: Dyads, defect: str) -> None:
    """Raises Infeasible with the defect by its name, and what helps."""
    count = len(asked.places)
    find = {2: _by_lengths, 3: by_points, 4: _by_turns}[count]
    words, values = find(asked, one, other)
    swap = bool(asked.sides) and int(marks(asked.poses, other, one).defect) == 0
    if asked.within is not None and words == "turns":
        words = "turns_no_box"
    if "usable" in values:
        words = f"{words}_usable"
    if swap:
        words = f"{words}_swap" if words.removesuffix("_usable") in SWAPPED else "swap"
        values = values | {"swap": (_exchanged(asked), "word")}
    raise Infeasible("positions", f"{W}.has_{defect}", f"{W}.{words}", values)


def _exchanged(asked: Asked) -> str:
    """Which keys of AB and DC are to be exchanged that DC drives."""
    keys = []
    for name, other in (("AB", "DC"), ("DC", "AB")):
        side, rest = asked.sides.get(name, Side()), asked.sides.get(other, Side())
        given = {
            (name[1], other[1]): side.pin is not None, (name[0], other[0]): side.pivot is not None,
            (name, other): side.length is not None, (f"{name}_side", f"{other}_side"): side.side != rest.side,
            (f"{name}_turn", f"{other}_turn"): side.turn is not None,
            (f"{name}_branch", f"{other}_branch"): side.branch != rest.branch,
            (f"{name[0]}_near", f"{other[0]}_near"): side.near is not None,
        }  # fmt: skip
        keys += [f"{new} as {old} is now" for (old, new), here in given.items() if here]
    return ", ".join(keys)


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
        return _nearest(lambda turns: sound(asked, *pair(name, of_turn(asked, name, turns), other)), side.turn, GRID)
    rest = _others(asked, name)

    def good(turns: Any) -> Any:
        own = by_turn(asked.poses, turns, side.branch)[:, None]
        both = pair(name, own, rest[None, :])
        with np.errstate(all="ignore"):
            return np.any(sound(asked, *both) & fair(asked, *both), axis=-1)

    def with_turn(turn: float) -> Asked:
        return replace(asked, sides={**asked.sides, name: replace(side, turn=turn)})

    told = _nearest(good, side.turn, COARSE)
    if told is None or not soluble(with_turn(told[0])):
        return told
    given, turn = float(side.turn), float(told[0])
    sign = float(np.sign(turn - given))
    outside = turn
    while sign * (outside - given) > 0 and soluble(with_turn(outside), QUICK):
        turn, outside = outside, outside - sign * COARSE
    edge = limit(with_turn, turn, outside, LESS / 2 * max(abs(turn), abs(turn - given)))
    edges = (edge + sign * INWARDS * more for more in (1.0, 4.0, 16.0, 64.0))
    return next((edge for edge in edges if soluble(with_turn(edge))), edge), "angle", "least" if sign > 0 else "most"


def _by_turns(asked: Asked, one: Dyads, other: Dyads) -> tuple[str, dict[str, Shown]]:
    """Four positions: another turn of AB or DC, the one that is nearer to what was asked."""
    found = []
    for name, rest in (("AB", other), ("DC", one)):
        if name in asked.sides and asked.sides[name].turn is not None:
            fixed = rest if len(asked.sides) == 2 else None
            told = _turn(asked, name, fixed)
            if told is not None:
                found.append((abs(told[0] - float(asked.sides[name].turn)), name, told, fixed))
    if not found:
        return by_both_turns(asked)
    _, name, told, fixed = min(found, key=lambda row: row[0])
    usable = _usable(asked, name, fixed, told)
    return "turn", {"turn": told, "name": (f"{name}_turn", "word")} | usable


def _usable(asked: Asked, name: str, other: Dyads | None, told: Shown) -> dict[str, Shown]:
    return usable_turn(asked, name, _others(asked, name) if other is None else other, told)


def _others(asked: Asked, name: str) -> Dyads:
    """Links of the curves beside the one of that name."""
    grid = -np.pi + 2 * np.pi * (np.arange(TURNS) + 0.5) / TURNS
    return rows(asked, {}, grid, None, "DC" if name == "AB" else "AB")[0]


def _by_lengths(asked: Asked, one: Dyads, other: Dyads) -> tuple[str, dict[str, Shown]]:
    """Two positions: other sides of the chords, else another length, else another pin or pivot."""

    def works(tried: Asked) -> bool:
        try:
            return bool(sound(tried, dyad(tried, "AB"), dyad(tried, "DC"), least=DEAD))
        except Infeasible:
            return False

    for first in SIDES:
        for second in SIDES:
            turned = {name: replace(asked.sides[name], side=x) for name, x in (("AB", first), ("DC", second))}
            if works(replace(asked, sides=turned)):
                return "sides", {"one": (first, "word"), "other": (second, "word")}
    for share in np.arange(SHARE, np.log(TIMES), SHARE):
        for name in ("AB", "DC"):
            for sign in (1.0, -1.0):
                edge = _length(asked, name, sign, float(share), works)
                if edge is not None:
                    return "length", {"length": edge, "name": (name, "word")}
    return by_points(asked, one, other)


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
    whole = good(inside + INWARDS + ROUNDED)
    return value, "length", "exact" if not whole else "least" if sign > 0 else "most"
