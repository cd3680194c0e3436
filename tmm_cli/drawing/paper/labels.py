"""Placement of labels so that they cover nothing: beside their points, or farther away with a leader line."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, fields, replace
from itertools import count, pairwise
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from tmm_cli.drawing.paper.boxes import (
    Boxes,
    box_distances,
    boxes_about,
    distances_to_segments,
    lengths_inside,
    nearest_in_boxes,
    segments_cross,
)
from tmm_cli.drawing.paper.occupied_area import LINE_PRICE, OccupiedArea, PriceRaster, overlap_price
from tmm_cli.drawing.paper.record import POINT
from tmm_cli.drawing.paper.texts import Words, script_width

ANCHOR_DISTANCES = (
    1.2,
    2.2,
    3.4,
    5.5,
    8.0,
    11.0,
    15.0,
    20.0,
    26.0,
    34.0,
    44.0,
    56.0,
    70.0,
)  # mm from the anchor to the label
LINE_DISTANCES = (1.0, 2.2, 3.4, 5.5, 8.0, 11.0, 16.0, 22.0, 30.0, 40.0)  # mm from a line to its label
LINE_SHARES = (
    0.5,
    0.42,
    0.58,
    0.34,
    0.66,
    0.26,
    0.74,
    0.18,
    0.82,
)  # positions of a text beside a line, shares of the length
DIRECTIONS = 16
RING_TIERS = (0, 3, 6, 9, 13)  # rings between these numbers are evaluated together, later ones only if nothing is free
MOST_DISTANCES = 1_000_000  # distances from candidates to other anchors held in memory at once: 8 MB for each array
LEADERS_KEPT = 24  # the cheapest candidates with leaders, whose crossings are computed
LEADER_FROM = 4.0  # mm between anchor and label from which on a leader is drawn
LEADER_GAP = 0.5  # mm between the end of a leader and its label
DISTANCE_PRICE = 0.35  # of each mm between a label and its anchor
LEADER_PRICE = 2.0  # of a leader
OFF_MIDDLE_PRICE = 3.0  # of a label away from the middle of its line
AMBIGUITY_PRICE = 6.0  # of a label closer to another named place than to its own
CROSSING_PRICE = 0.2  # of each line that a leader crosses
PLACEMENT_ROUNDS = 3  # of placing labels again, given the others, if they cost more than ACCEPTED_COST
ACCEPTED_COST = 6.0
SAME_PLACE = 0.5  # mm: closer points coincide

Item = TypeVar("Item")


@dataclass(frozen=True)
class Label:
    """A label to be placed.

    Attributes:
        text: the text.
        anchor: point that it names, mm.
        size: font size, points.
        colour: colour of the text.
        style: "normal" or "italic".
        line: line (mm) that it names instead of a point; the label may be anywhere beside it.
    """

    text: Words
    anchor: complex
    size: float
    colour: str
    style: str = "normal"
    line: tuple[complex, complex] | None = None


@dataclass(frozen=True)
class PlacedLabel:
    """A placed label.

    Attributes:
        label: the label.
        middle: middle of its text, mm.
        leader: ends of its leader line (mm), or None if it is near its point.
    """

    label: Label
    middle: complex
    leader: tuple[complex, complex] | None


@dataclass(frozen=True)
class LabelCandidates:
    """Possible positions of a label, with the cost of each.

    Attributes:
        middles: middles of the text, mm.
        boxes: bounding boxes of the text, mm.
        feet: starts of the leader lines, at the named point or line, mm.
        ends: ends of the leader lines, at the text, mm.
        led: True where a leader line is needed.
        price: cost. It grows with the distance from the named point and with the lines and texts that are covered. It
            is
            also higher if the label could be taken for that of another point.
    """

    middles: NDArray[Any]
    boxes: Boxes
    feet: NDArray[Any]
    ends: NDArray[Any]
    led: NDArray[Any]
    price: NDArray[Any]

    def part(self, selection: slice | NDArray[Any]) -> LabelCandidates:
        """Return only the selected positions, with their costs."""
        return LabelCandidates(*(getattr(self, column.name)[selection] for column in fields(self)))


class LabelPlacer:
    """Search for the positions of labels with the least cost."""

    def __init__(self, canvas: OccupiedArea, labels: Sequence[Label]) -> None:
        self.canvas, self.labels, self.raster = canvas, labels, PriceRaster(canvas)
        anchors = [label.anchor for label in labels if label.line is None]
        self.rivals = np.array([*dict.fromkeys([*anchors, *canvas.rivals])], complex)
        self.texts = np.reshape(np.array(canvas.boxes), (-1, 4))
        sizes = [text_extent(label.text, label.size) for label in labels]
        self.tiers = [
            (candidates_beside if label.line else candidates_about)(label, *size)
            for label, size in zip(labels, sizes, strict=True)
        ]
        self.sizes = np.array(sizes)
        self.known: list[list[LabelCandidates]] = [[] for __ in labels]
        wanting: Sequence[int] = range(len(labels))
        together = max(1, MOST_DISTANCES // (DIRECTIONS * RING_TIERS[1] * (len(self.rivals) + 1)))
        while wanting:
            for first in range(0, len(wanting), together):
                self._evaluate_next_ring(wanting[first : first + together])
            wanting = [
                k for k in wanting if self.has_farther_candidates(k) and self.known[k][-1].price.min() > LINE_PRICE / 2
            ]

    def _evaluate_next_ring(self, numbers: Sequence[int]) -> None:
        """Compute the costs of the next possible positions of several labels, on a ring farther from their points."""
        rings = [next(self.tiers[k]) for k in numbers]
        feet, middles, price = (np.concatenate(arrays) for arrays in zip(*rings, strict=True))
        lengths = [len(tier[0]) for tier in rings]
        whose = np.repeat(np.array(numbers), lengths)
        wide, high = self.sizes[whose].T
        boxes = boxes_about(middles, wide, high)
        off = nearest_in_boxes(boxes, feet) - feet
        away = np.abs(off)
        led = away > LEADER_FROM
        ends = np.where(led, feet + off * (1 - LEADER_GAP / np.maximum(away, LEADER_GAP)), feet)
        price = (
            price
            + LEADER_PRICE * led
            + self.raster.price(boxes)
            + self._confusion_price(whose, middles, boxes, away, led)
        )
        candidates, stops = LabelCandidates(middles, boxes, feet, ends, led, price), np.cumsum([0, *lengths])
        for k, start, stop in zip(numbers, stops[:-1], stops[1:], strict=True):
            self.known[k].append(self._add_leader_prices(candidates.part(slice(start, stop))))

    def has_farther_candidates(self, k: int) -> bool:
        """Return True if label k has possible positions, farther from its point, whose costs are not computed yet."""
        return len(self.known[k]) < (len(LINE_DISTANCES) if self.labels[k].line else len(RING_CANDIDATES))

    def _add_leader_prices(self, candidates: LabelCandidates) -> LabelCandidates:
        """Add the cost of the lines and texts that leader lines cross.

        Of the positions that need a leader line, only the cheapest ones are kept.
        """
        if not candidates.led.any():
            return candidates
        best = np.argsort(candidates.price, kind="stable")[:LEADERS_KEPT]
        kept = candidates.part(best)
        both = np.concatenate([kept.feet, kept.ends])
        lines = self.canvas.solid.near((both.real.min(), both.real.max(), both.imag.min(), both.imag.max()))
        crossed = segments_cross(kept.feet, kept.ends, *lines.T).sum(axis=1)
        through = (lengths_inside(self.texts, kept.feet, kept.ends) > 0).sum(axis=0)
        return replace(kept, price=kept.price + CROSSING_PRICE * crossed + LINE_PRICE * through)

    def _confusion_price(
        self, whose: NDArray[Any], middles: NDArray[Any], boxes: Boxes, away: NDArray[Any], led: NDArray[Any]
    ) -> NDArray[Any]:
        """Return the cost of positions at which a label is nearer to another named point or line than to its own."""
        nearer = np.zeros(len(middles), bool)
        if len(self.rivals) and not led.all():  # a leader makes a label unambiguous
            off = box_distances(boxes, self.rivals)
            is_anchor = (
                np.abs(np.array([label.anchor for label in self.labels])[whose][:, None] - self.rivals) <= SAME_PLACE
            )
            nearer = np.where(is_anchor, np.inf, off).min(axis=1) < away + 0.8
        for k in {int(k) for k in whose if self.labels[k].line is not None}:
            line, on_line = self.labels[k].line, whose == k
            others = [other for other in self.canvas.lines if other != line]
            near = distances_to_segments(middles[on_line], *np.array([line, *others]).T)
            nearer[on_line] = near[:, 1:].min(axis=1, initial=np.inf) < near[:, 0] + 0.5
        return np.where(nearer, np.where(led, 0.0, AMBIGUITY_PRICE), 0.0)

    def best(self, k: int, taken: Boxes, leaders: NDArray[Any]) -> tuple[float, LabelCandidates]:
        """Return the least cost of label k, and the position with this cost.

        Positions farther from the named point are evaluated only if none of the nearer ones is free.

        Args:
            k: index of the label.
            taken: bounding boxes of the other labels, mm.
            leaders: ends of the leader lines of the other labels, mm.
        """
        best: tuple[float, LabelCandidates] | None = None
        for number in count():
            if best is not None and best[0] <= LINE_PRICE / 2:
                break
            if number == len(self.known[k]):
                if not self.has_farther_candidates(k):
                    break
                self._evaluate_next_ring([k])
            candidates = self.known[k][number]
            cost = candidates.price + overlap_price(candidates.boxes, taken)
            if len(leaders):
                cost += LINE_PRICE * (lengths_inside(candidates.boxes, *leaders.T) > 0).sum(axis=1)
            if candidates.led.any():
                cost += LINE_PRICE * (lengths_inside(taken, candidates.feet, candidates.ends) > 0).sum(axis=0)
            least = int(np.argmin(cost))
            if best is None or cost[least] < best[0]:
                best = float(cost[least]), candidates.part(slice(least, least + 1))
        assert best is not None
        return best


def place_labels(canvas: OccupiedArea, labels: Sequence[Label]) -> list[PlacedLabel]:
    """Place labels where they cover least of the drawing.

    Labels with the fewest good positions are placed first. Then each label is placed again with all others fixed, until
    no label moves.

    Args:
        canvas: lines and texts drawn so far.
        labels: labels to be placed.

    Returns:
        The labels with their positions, in the order of `labels`.
    """
    if not labels:
        return []
    placer = LabelPlacer(canvas, labels)
    boxes, leaders = np.full((len(labels), 4), np.nan), np.full((len(labels), 2), np.nan, complex)
    middles, costs = [label.anchor for label in labels], [math.inf] * len(labels)
    order = sorted(range(len(labels)), key=lambda k: -float(np.sort(placer.known[k][0].price)[:4].sum()))
    for __ in range(PLACEMENT_ROUNDS):
        moved = False
        for k in [k for k in order if costs[k] > ACCEPTED_COST]:
            boxes[k], leaders[k] = np.nan, np.nan
            costs[k], candidate = placer.best(k, boxes[~np.isnan(boxes[:, 0])], leaders[~np.isnan(leaders[:, 0])])
            moved = moved or abs(candidate.middles[0] - middles[k]) > SAME_PLACE
            middles[k], boxes[k] = complex(candidate.middles[0]), candidate.boxes[0]
            if candidate.led[0]:
                leaders[k] = candidate.feet[0], candidate.ends[0]
        if not moved:
            break
    return [
        PlacedLabel(label, middle, (complex(foot), complex(end)) if np.isfinite(foot) else None)
        for label, middle, (foot, end) in zip(labels, middles, leaders, strict=True)
    ]


CandidateTier = tuple[NDArray[Any], NDArray[Any], NDArray[Any]]  # feet of leaders, middles of boxes, prices


def _ring_candidates(number: int) -> tuple[NDArray[Any], NDArray[Any]]:
    """Return the possible positions of a label on one ring around its point, as unit vectors and distances (mm)."""
    many = DIRECTIONS * (1 + (ANCHOR_DISTANCES[number] > LEADER_FROM))
    turns = (np.arange(many) + 0.5 * (number % 2)) / many
    return np.exp(1j * (2 * np.pi * turns + np.pi / 4)), np.full(many, ANCHOR_DISTANCES[number])


RING_CANDIDATES = [
    tuple(np.concatenate(part) for part in zip(*map(_ring_candidates, range(*ends)), strict=True))
    for ends in pairwise(RING_TIERS)
]


def candidates_about(label: Label, width: float, height: float) -> Iterator[CandidateTier]:
    """Yield possible positions of a label around its point, ring by ring, the nearest first."""
    for along, reach in RING_CANDIDATES:
        off = reach * along + along.real * width / 2 + 1j * along.imag * height / 2
        yield np.full(len(along), label.anchor), label.anchor + off, DISTANCE_PRICE * reach


def candidates_beside(label: Label, width: float, height: float) -> Iterator[CandidateTier]:
    """Yield possible positions of a label on both sides of the line that it names, the nearest first."""
    assert label.line is not None
    start, end = label.line
    span = (end - start) / (abs(end - start) or 1.0)
    up = 1j * span if (1j * span).imag >= 0 else -1j * span
    shares, out = np.repeat(LINE_SHARES, 2), np.tile([up, -up], len(LINE_SHARES))
    feet = start + shares * (end - start)
    half = np.abs(out.real) * width / 2 + np.abs(out.imag) * height / 2
    for reach in LINE_DISTANCES:
        yield feet, feet + (reach + half) * out, 1.5 * reach + OFF_MIDDLE_PRICE * np.abs(shares - 0.5)


def gather_coincident(placed: Iterable[tuple[complex, Item]]) -> list[tuple[complex, list[Item]]]:
    """Group items by their points (mm). Items whose points coincide on paper form one group."""
    groups: list[tuple[complex, list[Item]]] = []
    for at, item in placed:
        same = next((items for place, items in groups if abs(place - at) < SAME_PLACE), None)
        if same is None:
            groups.append((at, [item]))
        else:
            same.append(item)
    return groups


def text_extent(text: Words, size: float) -> tuple[float, float]:
    """Return width and height (mm) of a text of `size` points, with a small margin at both ends."""
    high = 1.0 if isinstance(text, str) else 1.3  # with indices below and above the line
    return script_width(text, size * POINT) + 0.6, high * size * POINT
