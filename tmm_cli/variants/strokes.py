"""Strokes of the output in many variants, for loads that act in them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tmm_cli.groups.base import Kernel
from tmm_cli.linkage import Linkage
from tmm_cli.motion import Law, move, towards
from tmm_cli.strokes import Stroke, Strokes, output_place, output_slope, resisted
from tmm_cli.variants.way import Places, Way
from tmm_cli.vectors import Real

SCAN = 180  # places in a turn
MOST = 8  # strokes in a cycle
ROUNDS = 12  # of looking for the end of a stroke: halves and chords by turns
EVEN = 1e-6  # rad: strokes that differ by less last equally long

Elements = Callable[[Real], tuple[Linkage, tuple[Kernel, ...]]]


def find_strokes(elements: Elements, way: Way, ordinary: Linkage, link: str | None) -> Strokes | None:
    """Strokes as arrays (variants,), a working one first; those that a variant has not have a negative length.

    elements: linkage and groups for places (variants, places). As tmm_cli.strokes, with no dwells and no search for
    ends that rounding makes.
    """
    if link is None:
        return None
    kind = "slide" if ordinary.slides_on_frame(link) else "swing"

    def moved(q: Real, order: int) -> tuple[Real, Real | None]:
        flat, kernels = elements(q)
        motion = move(flat, towards(kernels, [link]), q.ravel(), Law(0.0, 1.0, 0.0, 1), order, blank=False)
        slope = output_slope(motion, link).reshape(q.shape) if order else None
        return output_place(motion, link).reshape(q.shape), slope

    cycle = float(way.span[0, 0])
    sense = ordinary.driver.sense
    shares = np.arange(SCAN * max(1, round(cycle / (2 * np.pi)))) / (SCAN * max(1, round(cycle / (2 * np.pi))))
    with np.errstate(all="ignore"):
        q = way.at(Places(shares, np.zeros(0)))
        _, slope = moved(q, 1)
        assert slope is not None
        turns = slope * np.roll(slope, -1, axis=1) < 0
        count = int(min(MOST, np.max(np.sum(turns, axis=1), initial=0)))
        if not count:
            return None
        order = np.argsort(~turns, axis=1, kind="stable")[:, :count]
        there = np.take_along_axis(turns, order, axis=1)
        ends = _ends(lambda x: moved(x, 1)[1], np.take_along_axis(q, order, axis=1), q[0, 1] - q[0, 0])
        ends = np.where(there, ends, np.nan)[:, ::sense]
        number = np.sum(there, axis=1)
        if sense < 0:  # nan first then: the ends that are there go before them
            ends = np.take_along_axis(ends, np.argsort(np.isnan(ends), axis=1, kind="stable"), axis=1)
        after = np.take_along_axis(ends, (np.arange(count)[None, :] + 1) % np.maximum(number, 1)[:, None], axis=1)
        lengths = np.mod(sense * (after - ends), cycle)
        places = ends[:, :, None] + sense * lengths[:, :, None] * np.linspace(0, 1, 33 if kind == "swing" else 2)
        run, _ = moved(places.reshape(len(q), -1), 0)
        run = run.reshape(places.shape)
        if kind == "swing":
            run = np.unwrap(run, axis=2)
        runs = run[:, :, -1] - run[:, :, 0]
        forward = np.nansum(np.where(runs > 0, lengths, 0.0), axis=1)
        back = np.nansum(np.where(runs < 0, lengths, 0.0), axis=1)
        slower = np.where(forward > back, 1.0, -1.0)
        asked = ordinary.output.working if ordinary.output else "auto"
        if asked != "auto":
            slower = np.full(len(q), 1.0 if asked == "forward" else -1.0)
        else:
            even = np.sign(resisted(ordinary, link)) or 1.0
            slower = np.where(np.abs(forward - back) < EVEN, even, slower)
        works = np.where(np.isnan(lengths), -1.0, np.where(np.sign(runs) == slower[:, None], lengths, -1.0))
    first = np.argsort(-works, axis=1, kind="stable")
    columns = [np.take_along_axis(a, first, axis=1) for a in (ends, works, run[:, :, 0], runs)]
    return Strokes(link, kind, tuple(_arrays([c[:, k] for c in columns]) for k in range(count)), "", cycle)


def _arrays(columns: Sequence[Any]) -> Stroke:
    """A stroke whose start, length, low and run are arrays."""
    start, length, low, run = columns
    return Stroke(start, length, low, run, working=True)


def spread(strokes: Strokes | None, places: int) -> Strokes | None:
    """The same with an element for each variant and place."""
    if strokes is None:
        return None
    own = [[np.repeat(part, places) for part in (s.start, s.length, s.low, s.run)] for s in strokes.strokes]
    return replace(strokes, strokes=tuple(_arrays(columns) for columns in own))


def _ends(slope: Callable[[Real], Real | None], low: Real, step: float) -> Real:
    """Where the slope changes its sign between low and low + step, (variants, ends)."""
    a, b = low, low + step
    fa, fb = slope(a), slope(b)
    assert fa is not None and fb is not None
    for k in range(ROUNDS):
        middle = a - fa * (b - a) / (fb - fa) if k % 3 else (a + b) / 2
        middle = np.clip(np.where(np.isfinite(middle), middle, (a + b) / 2), a, b)
        f = slope(middle)
        assert f is not None
        left = np.sign(f) == np.sign(fa)
        a, fa = np.where(left, middle, a), np.where(left, f, fa)
        b, fb = np.where(left, b, middle), np.where(left, fb, f)
    found: Real = np.where(np.abs(fa) < np.abs(fb), a, b)
    return found
