"""Turns of both links of four positions whose four-bar is sound, as near as can be to what was asked of the links."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.burmester import Dyads, by_turn
from tmm_cli.synthesis.coupler_dyads import TURNS, Asked, Side, fair
from tmm_cli.synthesis.coupler_points import sound
from tmm_cli.synthesis.coupler_usable import DEGREE, enough, transmission, whole
from tmm_cli.synthesis.record import Shown

BRANCH: Final = np.radians(0.5)  # what another branch counts beside a turn
PAIRS: Final = 6  # of links that are drawn nearer to what was asked, by
ROUNDS: Final = 28  # tables of turns round the best, each half as wide as the one before
TABLE: Final = np.linspace(-2, 2, 9)
LINE: Final = np.linspace(0, 1, 129)  # then turns of one link on the way to what was asked
HALVINGS: Final = 40
DEAD: Final = 2e-7  # rad of transmission, more than rounding makes of none
LINES: Final = 40  # rounds of them at most, until
SETTLED: Final = 1e-8  # rad: they no longer move


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
        found.append(_Pair(asked, (int(branches[i]), int(branches[j]))).by_tables(turns[i], turns[j]))
    _, pair, one, other = min(found, key=lambda row: row[0])
    one, other = pair.by_lines(one, other)
    return "turns", _usable(asked, links, turns, branches, cost) | {
        "one": (one, "angle", "exact"), "first": (str(pair.branches[0] + 1), "word"),
        "other": (other, "angle", "exact"), "second": (str(pair.branches[1] + 1), "word"),
    }  # fmt: skip


def _usable(asked: Asked, links: Dyads, turns: Any, branches: Any, cost: Any) -> dict[str, Shown]:
    """The nearest pair of some links with a transmission angle that will do."""
    rows, columns = np.nonzero(np.isfinite(cost))
    one, other = (Dyads(links.pivot[at], links.pin[at]) for at in (rows, columns))
    least = transmission(asked, one, other)
    if not np.max(least) > DEGREE:
        return {}
    k = int(np.argmin(np.where(least >= enough(least), cost[rows, columns], np.inf)))
    i, j = rows[k], columns[k]
    return {
        "usable": (float(turns[i]), "angle"), "usable_first": (str(branches[i] + 1), "word"),
        "usable_other": (float(turns[j]), "angle"), "usable_second": (str(branches[j] + 1), "word"),
        "transmission": (whole(float(least[k])), "angle"),
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


@dataclass(frozen=True)
class _Pair:
    """Pairs of links on these branches."""

    asked: Asked
    branches: tuple[int, int]

    def tried(self, one: Any, other: Any) -> tuple[Any, Any]:
        """Whether pairs of these turns (rad) are sound, and how far they are from what was asked."""
        turns = np.asarray(one), np.asarray(other)
        links = [by_turn(self.asked.poses, turn, branch) for turn, branch in zip(turns, self.branches, strict=True)]
        away = [
            _away(self.asked, name, turn, branch, link)
            for name, turn, branch, link in zip(("AB", "DC"), turns, self.branches, links, strict=True)
        ]
        return sound(self.asked, links[0], links[1], least=DEAD), away[0] + away[1]

    def by_tables(self, one: float, other: float) -> tuple[float, _Pair, float, float]:
        """A sound pair that is nearer than one that is given, if there is one round it; first how far it is."""
        step, least = np.pi / TURNS, np.inf
        for _ in range(ROUNDS):
            rows, columns = one + step * TABLE[:, None], other + step * TABLE[None, :]
            here, away = self.tried(rows, columns)
            away = np.where(here, away, np.inf)
            i, j = np.unravel_index(int(np.argmin(away)), away.shape)
            if here[i, j]:
                one, other, least = float(rows[i, 0]), float(columns[0, j]), float(away[i, j])
            step /= 2
        return least, self, one, other

    def by_lines(self, one: float, other: float) -> tuple[float, float]:
        """The same pair drawn on along one turn and the other by turns: a table stops in a narrow corner."""
        if not self.tried(one, other)[0]:
            return one, other
        given = [self.asked.sides.get(name, Side()).turn for name in ("AB", "DC")]
        for _ in range(LINES):
            before = one, other
            one = _along(lambda at, fixed=other: self.tried(at, fixed)[0], one, given[0])  # type: ignore[misc]
            other = _along(lambda at, fixed=one: self.tried(fixed, at)[0], other, given[1])  # type: ignore[misc]
            if max(abs(one - before[0]), abs(other - before[1])) < SETTLED:
                break
        return one, other


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
