"""What can be had instead of a four-bar by k that cannot: other extreme positions, or another choice of the pivot A."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

import numpy as np

from tmm_cli.synthesis.crank_slider import k_of
from tmm_cli.synthesis.four_bar_arcs import ARC, Asked, arcs, at, places, whole
from tmm_cli.synthesis.record import SMALLEST, Shown

SOUND: Final = np.radians(80)  # the largest pressure angle of a pivot that is told instead of one with a dead rocker
USUAL: Final = np.radians(45)  # so of a turning link, where the swing leaves room for it
LEAST: Final = 1e-3  # rad: the least theta that is tried
SCAN: Final = 60  # values of theta that are tried
HALVINGS: Final = 40
FEW: Final = 0.01


def swings(asked: Asked) -> list[tuple[float, float]]:
    """Ranges of psi2 (rad) from psi1 onwards that k and the sense leave, that on the side of psi2 first.

    From the bounds of both arcs (see `four_bar_arcs`): with A on D's side theta < pi/2 + psi/2, beyond C1C2 psi < pi -
    2 theta. The least swing moves C by what has a size.
    """
    theta, psi1, least = float(asked.theta), float(asked.psi1), 2 * SMALLEST / float(asked.l3)
    way = -1 if asked.psi2 < asked.psi1 else 1
    found = []
    for side in (way, -way):
        low, high = max(least, 2 * theta - np.pi + 2 * ARC), np.pi - 2 * ARC
        if asked.sense == -side:
            low, high = least, np.pi - 2 * theta - 2 * ARC
        if low < high:
            found.append((psi1 + side * low, psi1 + side * high))
    return found


def nearest_end(asked: Asked, ranges: list[tuple[float, float]], good: Callable[[Asked], bool]) -> Shown | None:
    """The psi2 of these ranges nearest to the asked one with which A is what it was chosen to be; None: there is none.

    Within FEW of an end of a range arcs are so short that a length hardly differs on them.
    """
    few = ((1 - FEW) * near + FEW * far for near, far in ranges)
    tried = np.concatenate([np.linspace(start, far, SCAN) for start, (_, far) in zip(few, ranges, strict=True)])
    tried = tried[np.argsort(np.abs(tried - float(asked.psi2)), kind="stable")]
    psi2 = next((float(psi) for psi in tried if good(replace(asked, psi2=float(psi)))), None)
    if psi2 is None:
        return None
    up, step = psi2 > asked.psi2, np.pi / SCAN
    inside, outside = psi2, psi2 - (step if up else -step)
    if good(replace(asked, psi2=outside)):
        return psi2, "angle", "least" if up else "most"
    for _ in range(HALVINGS):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if good(replace(asked, psi2=middle)) else (inside, middle)
    return inside + (SMALLEST if up else -SMALLEST), "angle", "least" if up else "most"


def frame_on_line(asked: Asked) -> dict[str, Shown]:
    """With k = 1: l4 (m) of the pivot with the usual pressure angle (rad), which falls towards psi/2 along the line; of
    one between that and a right angle for a wide swing.
    """
    half = float(asked.swing) / 2
    most = max(float(USUAL), (half + np.pi / 2) / 2)
    line = replace(asked, k=1.0, sense=0)
    along = at(line, places(line, -1), -1)
    here = int(np.argmax(along.pressure <= most))
    angle = np.radians(np.ceil(np.degrees(float(along.pressure[here]))))
    return {"frame": (float(along.l4[here]), "length"), "usable": (float(angle), "angle")}


def length_and_k(asked: Asked) -> dict[str, Shown]:
    """Of l1, l2 or l4, whichever A is chosen by, the value (m) and the k that together are nearest to what is asked and
    have a pivot whose rocker is not dead; {}: there is none.
    """
    given, size = float(getattr(asked, asked.choose)), float(asked.l3)
    found = []
    for theta in np.linspace(LEAST, np.pi / 2 + float(asked.swing) / 2 - 2 * ARC, SCAN):
        one = replace(asked, k=float(k_of(theta)))
        rows = [at(one, whole(one, side)[1:-1], side) for side in arcs(one)]
        for f in rows:
            lengths = np.broadcast_to(getattr(f, asked.choose), f.pressure.shape)[f.pressure <= SOUND]
            if lengths.size:
                length = float(lengths[np.argmin(np.abs(lengths - given))])
                found.append((abs(length - given) / size + abs(np.log(one.k / asked.k)), length, one.k))
    if not found:
        return {}
    _, length, k = min(found)
    return {"name": (asked.choose, "word"), "length": (length, "length"), "with_k": (k, "number")}


def largest_k(asked: Asked, good: Callable[[Asked], bool]) -> float | None:
    """The largest k below the asked one, or the bound of the swing, that is good; None: no k is."""
    most = min(float(asked.theta), np.pi / 2 + float(asked.swing) / 2 - ARC)
    outside = np.nan
    for theta in np.linspace(most, LEAST, SCAN):
        if good(replace(asked, k=float(k_of(theta)))):
            break
        outside = float(theta)
    else:
        return None
    inside = float(theta)
    for _ in range(HALVINGS if np.isfinite(outside) else 0):
        middle = (inside + outside) / 2
        inside, outside = (middle, outside) if good(replace(asked, k=float(k_of(middle)))) else (inside, middle)
    return float(k_of(inside))


def nearest_frame(asked: Asked) -> dict[str, Shown]:
    """Where no pivot is as high as D: of those whose rocker is not dead, the one that is nearest to that."""
    a, pressure = (
        np.concatenate([np.atleast_1d(getattr(at(asked, places(asked, side), side), name)) for side in arcs(asked)])
        for name in ("a", "pressure")
    )
    here = complex(a[np.argmin(np.where(pressure <= SOUND, np.abs(a.imag), np.inf))])
    return {"x": (here.real, "length"), "y": (here.imag, "length")}
