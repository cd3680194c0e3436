"""Where labels go: beside their anchor, or farther off with a thin line to it, where they cover nothing."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from tmm_cli.draw import script
from tmm_cli.draw.boxes import Boxes, around, asides, crossing, gaps, nearest, runs
from tmm_cli.draw.drawing import POINT
from tmm_cli.draw.ground import LINE, Ground, over

RINGS = (1.2, 2.2, 3.4, 5.5, 8.0, 11.0, 15.0, 20.0, 26.0, 34.0, 44.0, 56.0, 70.0)  # mm from the anchor to the label
ASIDE = (1.0, 2.2, 3.4, 5.5, 8.0, 11.0, 16.0, 22.0, 30.0, 40.0)  # mm from a line to its label
ALONG = (0.5, 0.42, 0.58, 0.34, 0.66, 0.26, 0.74, 0.18, 0.82)  # where a text stands beside a line, shares of its length
DIRECTIONS = 16
FIRST = 3  # rings that are looked at together first, later ones if there is nothing free
LEADER = 4.0  # mm from which a line leads from a place to its label
SHORT = 0.5  # mm by which it ends before the label
FARTHER, LED, MIDDLE = 0.35, 2.0, 3.0  # prices: of a mm from the anchor, of a leader, of leaving a line's middle
MISTAKEN, CROSSED = 6.0, 0.2  # of standing nearer to what has another name, of a line that a leader crosses
ROUNDS = 3  # in which labels are put again, given where the others are, if they cost more than this:
CONTENT = 1.5
SAME = 0.5  # mm: nearer places are one

Item = TypeVar("Item")


@dataclass(frozen=True)
class Label:
    """A text asked for at an anchor (mm on paper), `size` points high; line: it stands beside it, wherever along it."""

    text: script.Words
    anchor: complex
    size: float
    colour: str
    style: str = "normal"
    line: tuple[complex, complex] | None = None


@dataclass(frozen=True)
class Placed:
    """A label at its middle; leader: from its anchor, where it stands far off."""

    label: Label
    middle: complex
    leader: tuple[complex, complex] | None


@dataclass(frozen=True)
class Places:
    """Boxes for a label, the feet of their leaders, and what each costs by what is drawn and by its distance."""

    middles: NDArray[Any]
    boxes: Boxes
    feet: NDArray[Any]
    ends: NDArray[Any]  # of leaders, those of near labels at their feet
    price: NDArray[Any]


class Choice:
    """Places for one label; those farther off are looked at only while nothing nearer is free."""

    def __init__(self, ground: Ground, label: Label, rivals: NDArray[Any]) -> None:
        self.ground, self.label, self.size = ground, label, extent(label.text, label.size)
        self.rivals = rivals[np.abs(rivals - label.anchor) > SAME]
        self._far = self._tiers()
        self._known: list[Places] = []

    def _tiers(self) -> Iterator[Places]:
        for feet, middles, asked in (beside if self.label.line else about_anchor)(self.label, *self.size):
            boxes = around(middles, *self.size)
            off = nearest(boxes, feet) - feet
            away = np.abs(off)
            led = away > LEADER
            ends = np.where(led, feet + off * (1 - SHORT / np.maximum(away, SHORT)), feet)
            price = asked + LED * led + self.ground.price(boxes) + self._mistaken(middles, boxes, away, led)
            price[led] += self._crossing(feet[led], ends[led])
            yield Places(middles, boxes, feet, ends, price)

    def _crossing(self, feet: NDArray[Any], ends: NDArray[Any]) -> NDArray[Any]:
        """The price of leaders that run through texts, or over lines."""
        if not len(feet):
            return np.zeros(0)
        both, texts = np.concatenate([feet, ends]), np.array(self.ground.boxes)
        lines = self.ground.solid.near((both.real.min(), both.real.max(), both.imag.min(), both.imag.max()))
        through = runs(texts, feet, ends) > 0 if len(texts) else np.zeros((0, len(feet)))
        found: NDArray[Any] = LINE * through.sum(axis=0) + CROSSED * crossing(feet, ends, *lines.T).sum(axis=1)
        return found

    def _mistaken(self, middles: NDArray[Any], boxes: Boxes, away: NDArray[Any], led: NDArray[Any]) -> NDArray[Any]:
        """The price of standing nearer to another lettered place, or to another line, than to one's own."""
        if self.label.line is not None:
            others = [line for line in self.ground.lines if line != self.label.line]
            if not others:
                return np.zeros(len(middles))
            here = asides(middles, *np.array([self.label.line]).T)[:, 0]
            nearer = asides(middles, *np.array(others).T).min(axis=1) < here + 0.5
        elif len(self.rivals):
            nearer = gaps(boxes, self.rivals).min(axis=1) < away + 0.8
        else:
            return np.zeros(len(middles))
        return np.where(nearer, np.where(led, MISTAKEN / 3, MISTAKEN), 0.0)

    @cached_property
    def need(self) -> float:
        """The least that this label must cost: the more, the less choice it has."""
        first = self._tier(0)
        assert first is not None
        return float(np.sort(first.price)[:4].sum())

    def _tier(self, number: int) -> Places | None:
        if number == len(self._known):
            found = next(self._far, None)
            if found is None:
                return None
            self._known.append(found)
        return self._known[number]

    def best(self, taken: Boxes, leaders: NDArray[Any]) -> tuple[float, Places, int]:
        """The cheapest place, given the boxes of other labels and their leaders (number, ends)."""
        best: tuple[float, Places, int] | None = None
        number = 0
        while (places := self._tier(number)) is not None and (best is None or best[0] > LINE / 2):
            cost = places.price + over(places.boxes, taken)
            if len(leaders):
                cost = cost + LINE * (runs(places.boxes, *leaders.T) > 0).sum(axis=1)
            if len(taken):
                led = places.ends != places.feet
                cost[led] += LINE * (runs(taken, places.feet[led], places.ends[led]) > 0).sum(axis=0)
            k = int(np.argmin(cost))
            if best is None or cost[k] < best[0]:
                best = float(cost[k]), places, k
            number += 1
        assert best is not None
        return best


def place(ground: Ground, labels: Sequence[Label]) -> list[Placed]:
    """Where labels cover the least: those with the least choice first; then each once more, given the others."""
    anchors = np.array([label.anchor for label in labels if label.line is None], complex)
    rivals = np.concatenate([anchors, np.array(ground.rivals, complex)])
    choices = [Choice(ground, label, rivals) for label in labels]
    boxes, leaders = np.full((len(labels), 4), np.nan), np.full((len(labels), 2), np.nan, complex)
    middles, costs = [label.anchor for label in labels], [0.0] * len(labels)
    order = sorted(range(len(labels)), key=lambda k: -choices[k].need)
    for turn in range(ROUNDS):
        moved = False
        for k in order if not turn else [k for k in order if costs[k] > CONTENT]:
            others = np.arange(len(labels)) != k
            taken = boxes[others & np.isfinite(boxes[:, 0])]
            led = leaders[others & np.isfinite(leaders[:, 0])]
            costs[k], places, best = choices[k].best(taken, led)
            moved = moved or abs(places.middles[best] - middles[k]) > SAME
            middles[k], boxes[k] = complex(places.middles[best]), places.boxes[best]
            foot, end = places.feet[best], places.ends[best]
            leaders[k] = (foot, end) if foot != end else (np.nan, np.nan)
        if turn and not moved:
            break
    return [
        Placed(label, middle, (complex(foot), complex(end)) if np.isfinite(foot) else None)
        for label, middle, (foot, end) in zip(labels, middles, leaders, strict=True)
    ]


Tier = tuple[NDArray[Any], NDArray[Any], NDArray[Any]]  # feet of leaders, middles of boxes, prices


@cache
def _directions(number: int, between: bool) -> NDArray[Any]:
    """Unit vectors all round, or those between them."""
    found: NDArray[Any] = np.exp(1j * (2 * np.pi * (np.arange(number) + 0.5 * between) / number + np.pi / 4))
    return found


def about_anchor(label: Label, width: float, height: float) -> Iterator[Tier]:
    """Places about an anchor: the box touches a circle about it."""
    for start, stop in ((0, FIRST), *((n, n + 2) for n in range(FIRST, len(RINGS), 2))):
        found = []
        for ring, reach in enumerate(RINGS[start:stop], start):
            along = _directions(DIRECTIONS * (1 + (reach > LEADER)), ring % 2 == 1)
            off = reach * along + along.real * width / 2 + 1j * along.imag * height / 2
            found.append((label.anchor + off, np.full(len(along), FARTHER * reach)))
        middles, prices = (np.concatenate(part) for part in zip(*found, strict=True))
        yield np.full(len(middles), label.anchor), middles, prices


def beside(label: Label, width: float, height: float) -> Iterator[Tier]:
    """Places beside a line, above it first."""
    assert label.line is not None
    start, end = label.line
    span = (end - start) / (abs(end - start) or 1.0)
    up = 1j * span if (1j * span).imag >= 0 else -1j * span
    shares = np.repeat(ALONG, 2)
    out = np.tile([up, -up], len(ALONG))
    feet = start + shares * (end - start)
    half = np.abs(out.real) * width / 2 + np.abs(out.imag) * height / 2
    for reach in ASIDE:
        yield feet, feet + (reach + half) * out, 1.5 * reach + MIDDLE * np.abs(shares - 0.5)


def gathered(placed: Iterable[tuple[complex, Item]]) -> list[tuple[complex, list[Item]]]:
    """Items by their place (mm): those that coincide on paper stand together."""
    found: list[tuple[complex, list[Item]]] = []
    for at, item in placed:
        same = next((items for place, items in found if abs(place - at) < SAME), None)
        if same is None:
            found.append((at, [item]))
        else:
            same.append(item)
    return found


def extent(text: script.Words, size: float) -> tuple[float, float]:
    """Width and height of a text on paper, mm, with a little air at its sides; size: points."""
    high = 1.0 if isinstance(text, str) else 1.3  # letters below and above the line
    return script.width(text, size * POINT) + 0.6, high * size * POINT
