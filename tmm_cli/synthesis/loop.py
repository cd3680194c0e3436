"""The four-bar loop A B C D of a linkage (A, D on the frame, AB driven), placed at wanted angles of its input."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_cli.linkage import FRAME, Linkage
from tmm_cli.motion import Law, Motion, move

if TYPE_CHECKING:
    from tmm_cli.pipeline import Results

PLACES = Law(0.0, 1.0, 0.0, 1)  # only places are asked for


@dataclass(frozen=True)
class Loop:
    """Names of its pins and its coupler."""

    a: str
    b: str
    c: str
    d: str
    coupler: str


def loop_of(linkage: Linkage) -> Loop | None:
    """The four-bar that the crank drives; None where there is none."""
    crank = linkage.driver.link
    a = linkage.shared(FRAME, crank)
    if a is None or linkage.driver.kind != "turn":
        return None
    for coupler in linkage.moving:
        b = linkage.shared(crank, coupler)
        for output in linkage.moving if b is not None and coupler != crank else ():
            c, d = linkage.shared(coupler, output), linkage.shared(FRAME, output)
            if output not in (crank, coupler) and b is not None and c is not None and d is not None:
                return Loop(a, b, c, d, coupler)
    return None


def at_input(results: Results, loop: Loop, phi: Any) -> Motion:
    """Places of the linkage where AB stands at angles phi (rad) from AD."""
    linkage = results.linkage
    frame, crank = linkage.links[FRAME].points, linkage.links[linkage.driver.link].points
    base = np.angle(frame[loop.d] - frame[loop.a]) - np.angle(crank[loop.b] - crank[loop.a])
    return move(linkage, results.kernels, np.atleast_1d(phi) + base, PLACES, 0)


def pins(results: Results, phi: Any) -> tuple[Any, Any, Any, Any] | None:
    """A, B, C, D (m; A, D single, B, C a place for each angle), nan where it cannot be assembled."""
    loop = loop_of(results.linkage)
    if loop is None or not results.kernels:
        return None
    motion, frame = at_input(results, loop, phi), results.linkage.links[FRAME].points
    return frame[loop.a], motion.spot(loop.b), motion.spot(loop.c), frame[loop.d]


def output_angles(results: Results, phi: Any, near: Any) -> Any:
    """Angles of DC from AD (rad) at those phi of AB, of all whole turns the one nearest to `near`."""
    found = pins(results, phi)
    if found is None:
        return np.full(np.shape(near), np.nan)
    a, _, c, d = found
    return near + np.angle((c - d) / (d - a) * np.exp(-1j * np.asarray(near)))


def transmission(results: Results, phi: Any) -> Any:
    """Transmission angles (rad, acute) at those phi of AB."""
    found = pins(results, phi)
    if found is None:
        return np.full(np.shape(phi), np.nan)
    _, b, c, d = found
    turned = (c - b) * np.conj(c - d)
    return np.arctan2(np.abs(turned.imag), np.abs(turned.real))
