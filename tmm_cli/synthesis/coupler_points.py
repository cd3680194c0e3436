"""The nearest other pin or pivot of a link with which a four-bar guides a coupler through two or three positions."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

import numpy as np

from tmm_cli.synthesis.burmester import Dyads, beside, centre, marks
from tmm_cli.synthesis.coupler_dyads import FAR, SAME, SIDES, Asked, Side, dyad, exists
from tmm_cli.synthesis.record import Infeasible, Shown

RINGS: Final = np.geomspace(0.01, 3.0, 80)  # about a given point, over the size of the task, and
ROUND: Final = 48  # places on each
ROOM: Final = 1e-4  # of a ring: so far around a place the four-bar must be sound too
HALVINGS: Final = 40
ROUNDS: Final = 24  # of directions, each half as far apart as in the one before,
FAN: Final = np.linspace(-1, 1, 9)
INWARDS: Final = 1e-6  # of the size, from where there is a sound four-bar first
ROUNDED: Final = 1e-5  # what six digits may add to a value
LONGEST: Final = 50.0  # reach, over the size of the task, that is told for a point whose places lie on a line


def sound(asked: Asked, one: Any, other: Any, far: float = FAR, least: float = 0.0) -> Any:
    """Whether four-bars are without defects, of a sensible size and of some transmission (rad), broadcast together."""
    with np.errstate(all="ignore"):
        gaps = np.minimum(np.abs(one.pin - other.pin), np.abs(one.pivot - other.pivot))
        found = marks(asked.poses, one, other)
        good = (found.defect == 0) & (found.least >= least) & (gaps > SAME * asked.size)
        return good & exists(asked, one, far) & exists(asked, other, far)


def pair(name: str, own: Dyads, other: Dyads) -> tuple[Dyads, Dyads]:
    """AB and DC from the dyad of that name and the other."""
    return (own, other) if name == "AB" else (other, own)


def by_points(asked: Asked, one: Dyads, other: Dyads) -> tuple[str, dict[str, Shown]]:
    """Another pin or pivot, the one that is nearer to what was asked."""
    found = []
    for name, rest in (("DC", one), ("AB", other)):
        near = _nearest(asked, name, _with(asked, name, rest))
        if near is not None:
            found.append((near[0], _letter(asked.sides[name], name), near[1]))
    if not found:
        return "other_points", {}
    _, letter, values = min(found, key=lambda row: row[0])
    return "point", values | {"point": (letter, "word")}


def off_line(asked: Asked, name: str) -> dict[str, Shown] | None:
    """The nearest place of a point, whose places lie on a line, with a sound four-bar that reaches LONGEST sizes."""
    try:
        rest = dyad(asked, "DC" if name == "AB" else "AB")
    except Infeasible:
        return None
    near = _nearest(asked, name, _with(asked, name, rest, LONGEST))
    if near is None:
        return None
    return near[1] | {"point": (_letter(asked.sides[name], name), "word"), "sizes": (f"{LONGEST:g}", "word")}


def _letter(side: Side, name: str) -> str:
    return name[1] if side.pin is not None else name[0]


def _with(asked: Asked, name: str, rest: Dyads, far: float = FAR) -> Callable[[Any], Any]:
    """Whether the four-bar of other places of the point (m) is sound."""
    side = asked.sides[name]

    def good(points: Any) -> Any:
        points = np.asarray(points, np.clongdouble)
        places = asked.poses.on_frame(points) if side.pin is not None else asked.poses.in_plane(points)
        with np.errstate(all="ignore"):
            end = centre(places) if len(asked.places) == 3 else beside(places, side.length, SIDES[side.side])
        own = Dyads(end, points) if side.pin is not None else Dyads(points, end)
        found = sound(asked, *pair(name, own, rest), far)
        return found if not asked.keep else exists(asked, own, far)

    return good


def _nearest(asked: Asked, name: str, good: Callable[[Any], Any]) -> tuple[float, dict[str, Shown]] | None:
    """Distance (m) and coordinates of the nearest place that is good: of the first ring with a good place, drawn in
    along its direction and its neighbours until it is not good."""
    side = asked.sides[name]
    given = complex(side.pin if side.pin is not None else side.pivot)
    angles = 2 * np.pi * np.arange(ROUND) / ROUND
    radii = asked.size * RINGS[:, None, None]
    around = ROOM * np.array([0, 1, 1j, -1, -1j])
    here = np.all(good(given + radii * (np.exp(1j * angles)[:, None] + around)), axis=-1)
    if not np.any(here):
        return None
    ring = int(np.argmax(np.any(here, axis=-1)))
    outer, inner = (asked.size * RINGS[ring], asked.size * RINGS[ring - 1] if ring else 0.0)
    angles = angles[here[ring]]
    reach = _drawn(good, given, angles, outer, inner)
    angle, radius = float(angles[np.argmin(reach)]), float(np.min(reach))
    step = 2 * np.pi / ROUND
    for _ in range(ROUNDS):
        fan = angle + step * FAN
        fan = fan[good(given + radius * np.exp(1j * fan))]
        if len(fan):
            reach = _drawn(good, given, fan, radius, 0.0)
            angle, radius = float(fan[np.argmin(reach)]), float(np.min(reach))
        step /= 2
    for inwards in INWARDS * np.array([1.0, 4.0, 16.0, 64.0]):
        place = given + (radius + inwards * asked.size) * np.exp(1j * angle)
        if good(place):
            break
    way = np.array([place.real - given.real, place.imag - given.imag])
    signs = np.where(way < 0, -1.0, 1.0)
    more = ROUNDED * np.array([abs(place.real), abs(place.imag)]) * signs
    whole = bool(np.all(good(place + np.array([more[0], 1j * more[1], more[0] + 1j * more[1]]))))
    ends = ["exact" if not whole else "least" if sign > 0 else "most" for sign in signs]
    return abs(place - given), {
        "x": (float(place.real), "length", ends[0]), "y": (float(place.imag), "length", ends[1])
    }  # fmt: skip


def _drawn(good: Callable[[Any], Any], given: complex, angles: Any, outer: float, inner: float) -> Any:
    """Least radii in these directions, all good at the outer one."""
    inside, outside = np.full(len(angles), outer), np.full(len(angles), inner)
    for _ in range(HALVINGS):
        middle = (inside + outside) / 2
        here = good(given + middle * np.exp(1j * angles))
        inside, outside = np.where(here, middle, inside), np.where(here, outside, middle)
    return inside
