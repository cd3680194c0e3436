"""The construction of a coupler's guidance: positions, bisectors, pivots; Burmester's curves for four positions."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.burmester import Dyads, Poses, by_turn
from tmm_cli.synthesis.construction import Arc, Construction, Curve, Segment, Spot, Style

FINE: Final = 1441  # turns at which the curves are computed
BEYOND: Final = 0.12  # of the sheet's size, on each side, where curves end


def construction(poses: Poses, one: Dyads, other: Dyads, words: str) -> Construction:
    """The four-bar in its first position, the others thin, arcs of pins and bisectors of their chords."""
    segments: list[Segment] = []
    spots: list[Spot] = []
    arcs: list[Arc] = []
    rows = [(np.asarray(poses.on_frame(x.pin), complex), complex(x.pivot)) for x in (one, other)]
    count = len(poses.places)
    for (places, pivot), (name, pin) in zip(rows, (("A", "B"), ("D", "C")), strict=True):
        radius = abs(places[0] - pivot)
        turns = np.unwrap(np.angle(places - pivot))
        arcs.append(Arc(pivot, float(radius), float(turns.min()), float(turns.max()), "thin"))
        segments.append(Segment(pivot, complex(places[0]), "link", "l1" if name == "A" else "l3"))
        spots += [Spot(name, pivot, "support"), Spot(f"{pin}1", complex(places[0]), "hinge")]
        for k in range(1, count):
            before, here = complex(places[k - 1]), complex(places[k])
            spots.append(Spot(f"{pin}{k + 1}", here, "dot"))
            if count < 4:
                segments += [Segment(before, here, "thin"), Segment((before + here) / 2, pivot, "dashed")]
    (b, a), (c, d) = rows
    segments += [Segment(a, d, "axis", "l4"), Segment(complex(b[0]), complex(c[0]), "link", "l2")]
    for k in range(count):
        p = complex(poses.places[k])
        if k:
            segments.append(Segment(complex(b[k]), complex(c[k]), "link2"))
        segments += [Segment(complex(b[k]), p, "thin"), Segment(p, complex(c[k]), "thin")]
        spots.append(Spot(f"P{k + 1}", p, "dot"))
    ends = np.array([s.at for s in spots])
    curves = _curves(poses, ends) if count == 4 else ()
    notes = (f"{words}.curves",) if curves else (f"{words}.bisectors",)
    title = f"{words}.construction_4" if count == 4 else f"{words}.construction"
    return Construction(title, tuple(segments), tuple(arcs), tuple(spots), notes, curves)


def _curves(poses: Poses, around: Any) -> tuple[Curve, ...]:
    """Centre points (bold) and circle points in position 1 (dashed), near what else is drawn."""
    step = 2 * np.pi / FINE
    turns = -np.pi + step * (np.arange(FINE) + 0.37)  # not just 0 or a turn of the plane: no link is told by these
    size = max(np.ptp(around.real), np.ptp(around.imag))
    box = (around.real.min() - BEYOND * size, around.real.max() + BEYOND * size,
           around.imag.min() - BEYOND * size, around.imag.max() + BEYOND * size)  # fmt: skip
    found: list[Curve] = []
    for branch in (0, 1):
        dyads = by_turn(poses, turns, branch)
        kinds: tuple[tuple[Any, Style, str], ...] = (
            (dyads.pivot, "bold", "m"), (poses.on_frame(dyads.pin)[..., 0], "dashed", "k1"),
        )  # fmt: skip
        for places, style, name in kinds:
            for number, part in enumerate(_parts(np.asarray(places, complex), box, 0.1 * size)):
                found.append(Curve(tuple(complex(p) for p in part), style, name if number == 0 else ""))
    return tuple(found)


def _parts(places: Any, box: tuple[float, float, float, float], gap: float) -> list[Any]:
    """Pieces of a curve inside a box, cut where neighbours are far apart."""
    with np.errstate(all="ignore"):
        inside = (places.real > box[0]) & (places.real < box[1]) & (places.imag > box[2]) & (places.imag < box[3])
        near = inside[1:] & inside[:-1] & (np.abs(np.diff(places)) < gap)
    cuts = np.flatnonzero(~near) + 1
    return [part for part in np.split(places, cuts) if len(part) > 2]
