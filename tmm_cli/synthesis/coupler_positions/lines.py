"""Burmester's curves as lines to be drawn: along their smooth parameter, dense where they bend, and their frame."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.coupler_positions.burmester import Poses, equal_angles
from tmm_cli.synthesis.coupler_positions.curve import FULL, Curve, curve, denser

FIRST: Final = 720  # steps of a loop that are looked at first;
ROUNDS: Final = 24  # then between those that are far apart, or where the curve bends between them
APART: Final = 0.01  # of the size of the mechanism, or of how far off the place is
BEND: Final = 0.05  # rad: a corner that is seen
SHORT: Final = 2e-4  # of the size: corners that are not seen
CLOSE: Final = 1e-15  # of a turn: parameters that cannot be told apart
BREAK: Final = 0.1  # of the size: neighbours that are still so far apart lie on both sides of infinity
FAR: Final = 4.0  # sizes of the mechanism in which curves are followed: more than its sheet holds
AROUND: Final = 0.3  # how far beyond the four-bar the drawing of the curves goes, in its size
RETURN: Final = 1.5  # in the same: a curve that comes back from no farther off is shown whole

Places = tuple[complex, ...]


def lines(poses: Poses, about: Sequence[complex]) -> tuple[list[Places], list[Places]]:
    """Centre points and circle points in position 1 (m), near places of a mechanism; none where all angles are one."""
    if equal_angles(poses.angles):
        return [], []
    found, box = curve(poses), np.array(about)
    middle = complex(box.real.max() + box.real.min(), box.imag.max() + box.imag.min()) / 2
    size = float(max(np.ptp(box.real), np.ptp(box.imag)))

    def pivots(loop: int, t: Any) -> Any:
        return (np.asarray(found.at(loop, t).pivot, complex) - middle) / size

    def pins(loop: int, t: Any) -> Any:
        return (np.asarray(poses.on_frame(found.at(loop, t).pin)[..., 0], complex) - middle) / size

    kinds = pivots, pins
    rows = [[tuple((middle + size * part).tolist()) for part in _parts(found, at)] for at in kinds]
    return rows[0], rows[1]


def _parts(found: Curve, at: Callable[[int, Any], Any]) -> Iterator[Any]:
    """Pieces of a curve (sizes of the mechanism, its middle at 0): from edge to edge, or whole loops."""
    for loop in range(len(found)):
        with np.errstate(all="ignore"):
            places = _dense(lambda t, loop=loop: at(loop, t))  # type: ignore[misc]
            broken = ~(np.abs(np.diff(places)) < BREAK * np.maximum(1, np.abs(places[1:])))
            broken |= ~(_near(places[1:]) | _near(places[:-1]))
        parts = [part for part in np.split(places, np.flatnonzero(broken) + 1) if len(part) > 1]
        if len(parts) > 1 and not (broken[0] or broken[-1]):  # the loop starts in the middle of a piece
            parts = [np.concatenate([parts[-1], parts[0][1:]]), *parts[1:-1]]
        yield from parts


def _dense(at: Callable[[Any], Any]) -> Any:
    """Places all round a loop, as near to each other as a drawing needs."""

    def wide(t: Any) -> Any:
        places = at(t)
        steps, reach = np.diff(places), np.maximum(1, np.abs(places))
        found = ~(np.abs(steps) < APART * np.minimum(reach[1:], reach[:-1]))
        bends = np.abs(np.angle(steps[1:] / steps[:-1])) > BEND
        seen = np.abs(steps) > SHORT
        found[1:] |= bends & seen[1:]
        found[:-1] |= bends & seen[:-1]
        return found & (_near(places[1:]) | _near(places[:-1])) & (np.diff(t) > CLOSE * FULL)

    places = at(denser(wide, FIRST, ROUNDS))
    return places[np.isfinite(places)]


def _near(places: Any) -> Any:
    return np.isfinite(places) & (np.abs(places.real) < FAR) & (np.abs(places.imag) < FAR)


def frame(bar: Sequence[complex], found: Sequence[Places]) -> Places:
    """Places (m) that the sheet of the curves holds: a four-bar, curves beside it, and ways of these that come back."""
    places = np.array(bar)
    low, high = (complex(f(places.real), f(places.imag)) for f in (np.min, np.max))
    size = max((high - low).real, (high - low).imag)
    held = [places]
    for line in found:
        z = np.array(line)
        off = np.maximum.reduce([low.real - z.real, z.real - high.real, low.imag - z.imag, z.imag - high.imag]) / size
        held.append(z[off < AROUND])
        closed = abs(z[0] - z[-1]) < BREAK * size
        cuts = np.flatnonzero((off[1:] < AROUND) != (off[:-1] < AROUND)) + 1
        runs = np.split(np.arange(len(z)), cuts)
        for number, run in enumerate(runs):
            ends = number in (0, len(runs) - 1)
            if np.max(off[run]) < RETURN and (closed or not ends) and len(runs) > 1:
                held.append(z[run])
    every = np.concatenate(held)
    return tuple(complex(f(every.real), f(every.imag)) for f in (np.min, np.max))
