"""Turns of both links of four positions whose four-bar is sound, as near as can be to what was asked of the links."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.burmester import Dyads, by_turn
from tmm_cli.synthesis.coupler_dyads import TURNS, Asked, Side, fair
from tmm_cli.synthesis.coupler_points import sound
from tmm_cli.synthesis.record import Shown

BRANCH: Final = np.radians(0.5)  # what another branch counts beside a turn
PAIRS: Final = 6  # of links that are drawn nearer to what was asked, by
ROUNDS: Final = 28  # tables of turns round the best, each half as wide as the one before
TABLE: Final = np.linspace(-2, 2, 9)
LINE: Final = np.linspace(0, 1, 129)  # then turns of one link on the way to what was asked
HALVINGS: Final = 40
DEAD: Final = 1e-5  # rad of transmission: so much is left
INWARDS: Final = (1e-6, 4e-6, 1.6e-5, 0.0)  # rad, from where there is a sound four-bar first
ROUNDED: Final = 1e-5  # what six digits may add to a value


def by_both_turns(asked: Asked) -> tuple[str, dict[str, Shown]]:
    """Words and values: the pair of links on Burmester's curves without defects that is nearest to what was asked."""
    if not asked.sides:  # the search for the best found none
        return "other_positions", {}
    grid = -np.pi + 2 * np.pi * (np.arange(TURNS) + 0.5) / TURNS
    turns, branches = np.tile(grid, 2), np.repeat([0, 1], TURNS)
    links = by_turn(asked.poses, turns, branches)
    good = sound(asked, links[:, None], links[None, :]) & fair(asked, links[:, None], links[None, :])
    if not np.any(good):
        return "other_positions", {}
    away = [_away(asked, name, turns, branches, links) for name in ("AB", "DC")]
    cost = np.where(good, away[0][:, None] + away[1][None, :], np.inf)
    found = []
    for at in np.argsort(cost, axis=None)[: min(PAIRS, int(good.sum()))]:
        i, j = np.unravel_index(int(at), cost.shape)
        found.append(_drawn_in(asked, (turns[i], turns[j]), (int(branches[i]), int(branches[j]))))
    _, (one, other), (first, second) = min(found, key=lambda row: row[0])
    return "turns", {
        "one": one, "first": (str(first + 1), "word"), "other": other, "second": (str(second + 1), "word")
    }  # fmt: skip


def _turned(turn: Any, given: Any) -> Any:
    """From a given turn to another, the short way round."""
    return np.angle(np.exp(1j * (turn - float(given))))


def _away(asked: Asked, name: str, turns: Any, branches: Any, links: Dyads) -> Any:
    """How far links are from what was asked of one: rad, or a share of the size of the task for a wanted pivot."""
    side = asked.sides.get(name, Side())
    if side.turn is not None:
        return np.abs(_turned(turns, side.turn)) + BRANCH * (np.asarray(branches) != side.branch)
    if side.near is not None:
        return np.abs(np.asarray(links.pivot, complex) - complex(side.near)) / asked.size
    return np.zeros(np.shape(turns))


def _drawn_in(
    asked: Asked, turns: tuple[float, float], branches: tuple[int, int]
) -> tuple[float, list[Shown], tuple[int, int]]:
    """How far a pair of links is from what was asked once it is as near as it can be, and its turns; its branches."""

    def tried(one: Any, other: Any) -> tuple[Any, Any]:
        """Whether pairs are sound, and how far they are from what was asked."""
        both = [by_turn(asked.poses, turn, branch) for turn, branch in zip((one, other), branches, strict=True)]
        away = [
            _away(asked, name, turn, branch, links)
            for name, turn, branch, links in zip(("AB", "DC"), (one, other), branches, both, strict=True)
        ]
        return sound(asked, both[0], both[1], least=DEAD), away[0] + away[1]

    def good(one: Any, other: Any) -> Any:
        return tried(np.asarray(one), np.asarray(other))[0]

    (one, other), step = turns, 2 * np.pi / TURNS / 2
    for _ in range(ROUNDS):
        rows, columns = one + step * TABLE[:, None], other + step * TABLE[None, :]
        here, away = tried(rows, columns)
        i, j = np.unravel_index(int(np.argmin(np.where(here, away, np.inf))), here.shape)
        if here[i, j]:
            one, other = float(rows[i, 0]), float(columns[0, j])
        step /= 2
    given = [asked.sides.get(name, Side()).turn for name in ("AB", "DC")]
    if good(one, other):
        for _ in range(2):  # a table stops where the way round a corner is too narrow for it
            one = _along(lambda at, fixed=other: good(at, fixed), one, given[0])  # type: ignore[misc]
            other = _along(lambda at, fixed=one: good(fixed, at), other, given[1])  # type: ignore[misc]
    cost = float(tried(np.asarray(one), np.asarray(other))[1])
    signs = [0.0 if turn is None else float(np.sign(_turned(at, turn))) for at, turn in zip(
        (one, other), given, strict=True)]  # fmt: skip
    inwards = next((x for x in INWARDS if good(one + x * signs[0], other + x * signs[1])), 0.0)
    one, other = one + inwards * signs[0], other + inwards * signs[1]
    more = [ROUNDED * abs(at) * sign for at, sign in zip((one, other), signs, strict=True)]
    whole = all(good(one + i * more[0], other + j * more[1]) for i in (0, 1) for j in (0, 1))
    ends = ["exact" if not whole or not sign else "least" if sign > 0 else "most" for sign in signs]
    return cost, [(float(at), "angle", end) for at, end in zip((one, other), ends, strict=True)], branches


def _along(good: Callable[[Any], Any], turn: float, given: Any) -> float:
    """The turn nearest to the given one that is good on the way from it to one that is."""
    if given is None:
        return turn
    at = turn - _turned(turn, given) * (1 - LINE)
    first = int(np.argmax(good(at)))
    if first == 0:
        return float(at[0])
    inside, outside = float(at[first]), float(at[first - 1])
    for _ in range(HALVINGS):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if good(middle) else (inside, middle)
    return inside
